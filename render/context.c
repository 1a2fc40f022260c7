// SPDX-License-Identifier: GPL-2.0-or-later
// OSMesa (Mesa's off-screen OpenGL) is known here and nowhere else: Mesa 25.1 dropped it, and
// another way to a context, EGL for instance, takes this file's place. Pictures are drawn into
// frame buffers of the canvas's own; the buffer given to OSMesa is only what it insists on.
#include "render/context.h"

#include "base/memory.h"

#include <GL/osmesa.h>
#include <pthread.h>

enum { TOKEN_SIZE = 16 };   // pixels a side of the buffer OSMesa insists on

struct RenderContext {
    OSMesaContext mesa;   // owned
    uint8_t token[TOKEN_SIZE * TOKEN_SIZE * 4];   // never drawn into
};

// Mesa shares states between contexts: one thread draws at a time. Recursive: a thread may have
// several contexts.
static pthread_mutex_t drawing = PTHREAD_RECURSIVE_MUTEX_INITIALIZER_NP;

// 3.3 core is what the shaders need; a driver may give a later version.
RenderContext *context_create(Error *err)
{
    static const int wanted[] = {OSMESA_FORMAT,
                                 OSMESA_RGBA,
                                 OSMESA_DEPTH_BITS,
                                 0,
                                 OSMESA_PROFILE,
                                 OSMESA_CORE_PROFILE,
                                 OSMESA_CONTEXT_MAJOR_VERSION,
                                 3,
                                 OSMESA_CONTEXT_MINOR_VERSION,
                                 3,
                                 0};
    RenderContext *context = NULL;
    TRY(context = NEW_ARRAY(RenderContext, 1, err));
    pthread_mutex_lock(&drawing);
    context->mesa = OSMesaCreateContextAttribs(wanted, NULL);
    if (!context->mesa) FAIL(err, ERROR_LIBRARY, "OSMesa gives no OpenGL 3.3 core context");
    if (!OSMesaMakeCurrent(context->mesa, context->token, GL_UNSIGNED_BYTE, TOKEN_SIZE, TOKEN_SIZE))
        FAIL(err, ERROR_LIBRARY, "OSMesa does not make its context current");
    return context;
cleanup:
    context_destroy(context);
    return NULL;
}

void context_destroy(RenderContext *context)
{
    if (!context) return;
    if (context->mesa) OSMesaDestroyContext(context->mesa);
    memory_free(context);
    pthread_mutex_unlock(&drawing);
}
