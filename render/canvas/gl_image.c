// SPDX-License-Identifier: GPL-2.0-or-later
// Pixels are unsigned integers from the table to memory: no blending, no filter, no rounding. What
// a source has opened stays open until the program ends, as modules do: a context and its shaders
// take longer than an image. One thread draws at a time.
#include "render/canvas/gl_image.h"

#include "render/canvas/gl_names.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

enum { TOKEN_SIZE = 16 };   // pixels a side of the buffer OSMesa insists on, never drawn into
enum { UNIT_COLORS, UNIT_VALUES, UNIT_TARGET, UNIT_DEPTH, UNITS };   // textures

// clang-format off
// All of OpenGL that is used: return type, name, arguments.
#define GL_CALLS(X) \
    X(void, ActiveTexture, (GLenum)) \
    X(void, AttachShader, (GLuint, GLuint)) \
    X(void, BindBuffer, (GLenum, GLuint)) \
    X(void, BindFramebuffer, (GLenum, GLuint)) \
    X(void, BindTexture, (GLenum, GLuint)) \
    X(void, BindVertexArray, (GLuint)) \
    X(void, BufferData, (GLenum, GLsizeiptr, const void *, GLenum)) \
    X(GLenum, CheckFramebufferStatus, (GLenum)) \
    X(void, Clear, (GLbitfield)) \
    X(void, CompileShader, (GLuint)) \
    X(GLuint, CreateProgram, (void)) \
    X(GLuint, CreateShader, (GLenum)) \
    X(void, DrawArrays, (GLenum, GLint, GLsizei)) \
    X(void, Enable, (GLenum)) \
    X(void, EnableVertexAttribArray, (GLuint)) \
    X(void, FramebufferTexture2D, (GLenum, GLenum, GLenum, GLuint, GLint)) \
    X(void, GenBuffers, (GLsizei, GLuint *)) \
    X(void, GenFramebuffers, (GLsizei, GLuint *)) \
    X(void, GenTextures, (GLsizei, GLuint *)) \
    X(void, GenVertexArrays, (GLsizei, GLuint *)) \
    X(GLenum, GetError, (void)) \
    X(void, GetIntegerv, (GLenum, GLint *)) \
    X(void, GetProgramInfoLog, (GLuint, GLsizei, GLsizei *, GLchar *)) \
    X(void, GetProgramiv, (GLuint, GLenum, GLint *)) \
    X(GLint, GetUniformLocation, (GLuint, const GLchar *)) \
    X(void, LinkProgram, (GLuint)) \
    X(void, PixelStorei, (GLenum, GLint)) \
    X(void, ReadPixels, (GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void *)) \
    X(void, ShaderSource, (GLuint, GLsizei, const GLchar *const *, const GLint *)) \
    X(void, TexImage2D, \
      (GLenum, GLint, GLint, GLsizei, GLsizei, GLint, GLenum, GLenum, const void *)) \
    X(void, TexParameteri, (GLenum, GLenum, GLint)) \
    X(void, Uniform1f, (GLint, GLfloat)) \
    X(void, Uniform1i, (GLint, GLint)) \
    X(void, Uniform1ui, (GLint, GLuint)) \
    X(void, Uniform2f, (GLint, GLfloat, GLfloat)) \
    X(void, UseProgram, (GLuint)) \
    X(void, VertexAttribPointer, (GLuint, GLint, GLenum, GLboolean, GLsizei, const void *)) \
    X(void, Viewport, (GLint, GLint, GLsizei, GLsizei))
// clang-format on

typedef enum GlKind { BY_CORNERS, BY_VALUES, PROGRAMS } GlKind;

typedef void (*GlFunction)(void);

// OpenGL context of OSMesa or EGL, and the calls that it needs.
typedef struct GlContext {
    void *library;   // as dlopen gives it; never closed
    GlFunction (*find)(const char *name);
    OSMesaContext mesa;
    GLboolean (*mesa_use)(OSMesaContext, void *, GLenum, GLsizei, GLsizei);
    EGLDisplay display;
    EGLContext egl;
    EGLBoolean (*egl_use)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
    uint8_t token[TOKEN_SIZE * TOKEN_SIZE * 4];
} GlContext;

typedef struct Gl {
#define X(type, name, arguments) type(*name) arguments;
    GL_CALLS(X)
#undef X
    GlContext context;
    GLuint program[PROGRAMS], texture[UNITS];   // a program is made when it is needed
    bool tried, ready;
    pid_t process;   // that it was opened in
    Error failure;   // of the only try
} Gl;

static Gl opened[GL_SOURCES];   // zeroed: not tried
static pthread_mutex_t drawing = PTHREAD_MUTEX_INITIALIZER;

// --- a context -----------------------------------------------------------------------------------

typedef struct Symbol {
    const char *name;
    void *function;   // where a pointer to it is to stand
} Symbol;

// symbols: without a name at the end. POSIX: a function from an object's address.
static bool library_open(GlContext *context, const char *name, const Symbol *symbols, Error *err)
{
    context->library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (!context->library) return FAULT(err, ERROR_LIBRARY, "%s", dlerror());
    for (; symbols->name; ++symbols) {
        void *address = dlsym(context->library, symbols->name);
        if (!address) return FAULT(err, ERROR_LIBRARY, "%s", dlerror());
        memcpy(symbols->function, &address, sizeof address);
    }
    return true;
}

// 3.3 core is what the shaders need; a driver may give a later version.
static bool mesa_open(GlContext *context, Error *err)
{
    static const int wanted[][2] = {
        {OSMESA_FORMAT, OSMESA_RGBA},          {OSMESA_DEPTH_BITS, 0},
        {OSMESA_PROFILE, OSMESA_CORE_PROFILE}, {OSMESA_CONTEXT_MAJOR_VERSION, 3},
        {OSMESA_CONTEXT_MINOR_VERSION, 3},     {0}};
    OSMesaContext (*create)(const int *, OSMesaContext) = NULL;
    const Symbol symbols[] = {{"OSMesaGetProcAddress", &context->find},
                              {"OSMesaMakeCurrent", &context->mesa_use},
                              {"OSMesaCreateContextAttribs", &create},
                              {0}};
    if (!library_open(context, "libOSMesa.so.8", symbols, err)) return false;
    context->mesa = create(wanted[0], NULL);
    if (!context->mesa) return FAULT(err, ERROR_LIBRARY, "OSMesa gives no OpenGL 3.3 core context");
    return true;
}

static bool egl_open(GlContext *context, Error *err)
{
    static const EGLint wanted[][2] = {
        {EGL_CONTEXT_MAJOR_VERSION, 3},
        {EGL_CONTEXT_MINOR_VERSION, 3},
        {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT},
        {EGL_NONE}};
    EGLDisplay (*display)(EGLenum, void *, const EGLAttrib *) = NULL;
    EGLBoolean (*begin)(EGLDisplay, EGLint *, EGLint *) = NULL, (*bind)(EGLenum) = NULL;
    EGLContext (*create)(EGLDisplay, EGLConfig, EGLContext, const EGLint *) = NULL;
    const Symbol symbols[] = {{"eglGetProcAddress", &context->find},
                              {"eglMakeCurrent", &context->egl_use},
                              {"eglGetPlatformDisplay", &display},
                              {"eglInitialize", &begin},
                              {"eglBindAPI", &bind},
                              {"eglCreateContext", &create},
                              {0}};
    if (!library_open(context, "libEGL.so.1", symbols, err)) return false;
    context->display = display(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL);
    if (!context->display || !begin(context->display, NULL, NULL) || !bind(EGL_OPENGL_API))
        return FAULT(err, ERROR_LIBRARY, "EGL draws nothing without a surface here");
    context->egl = create(context->display, NULL, NULL, wanted[0]);
    if (!context->egl) return FAULT(err, ERROR_LIBRARY, "EGL gives no OpenGL 3.3 core context");
    return true;
}

// Makes the context this thread's, or nobody's.
static bool context_use(GlContext *context, bool use)
{
    if (context->mesa)
        return use ? context->mesa_use(context->mesa, context->token, GL_UNSIGNED_BYTE, TOKEN_SIZE,
                                       TOKEN_SIZE)
                   : context->mesa_use(NULL, NULL, 0, 0, 0);
    return context->egl_use(context->display, NULL, NULL, use ? context->egl : NULL);
}

// --- shaders and buffers -------------------------------------------------------------------------

// Rows are read back from the bottom: y downwards in both makes the first row the top one.
static const char VERSION[] = "#version 330 core\n",
                  VERTEX_SOURCE[] =
                      "uniform vec2 size;\n"
                      "layout(location = 0) in vec4 corner;\n"
                      "out float at;\n"
                      "void main() {\n"
                      "    at = corner.z;\n"
                      "    gl_Position = vec4(2.0 * corner.xyw / vec3(size, 1.0) - 1.0, 1.0);\n"
                      "}\n";

// Value of a pixel: between corners, or from a table of values. There NaN shows nothing: it is
// known by its bits, as a driver may compile comparisons as if there were no NaN (Mesa 26 does).
static const char *const VALUE_SOURCE[PROGRAMS] = {
    [BY_CORNERS] = "in float at;\n"
                   "float value_here() { return max(at, 0.0); }\n",
    [BY_VALUES] = "uniform vec2 scale;\n"   // values over pixels
                  "uniform sampler2D values;\n"
                  "float value_here() {\n"
                  "    float value = texelFetch(values, ivec2(gl_FragCoord.xy * scale), 0).r;\n"
                  "    bool number = (floatBitsToUint(value) & 0x7fffffffu) <= 0x7f800000u;\n"
                  "    if (!number || value < -1.5) discard;\n"
                  "    return value;\n"
                  "}\n"};

static const char FRAGMENT_SOURCE[] =
    "uniform uint below;\n"
    "uniform float last;\n"   // color
    "uniform usampler2D colors;\n"
    "out uint color;\n"
    "void main() {\n"
    "    float value = value_here();\n"
    "    int place = int(clamp(value, 0.0, 1.0) * last + 0.5);\n"
    "    color = value < 0.0 ? below : texelFetch(colors, ivec2(place, 0), 0).r;\n"
    "}\n";

static void shader_add(const Gl *gl, GLuint program, GLenum stage, const char *source[3])
{
    GLuint shader = gl->CreateShader(stage);
    gl->ShaderSource(shader, 3, source, NULL);
    gl->CompileShader(shader);
    gl->AttachShader(program, shader);
}

// Errors of a compiler show when its shader is linked.
static bool program_use(Gl *gl, GlKind kind, Error *err)
{
    GLint done = GL_FALSE;
    GLchar said[300] = "";
    GLuint program = gl->program[kind];
    if (program == 0) {
        program = gl->CreateProgram();
        shader_add(gl, program, GL_VERTEX_SHADER, (const char *[]){VERSION, VERTEX_SOURCE, ""});
        shader_add(gl, program, GL_FRAGMENT_SHADER,
                   (const char *[]){VERSION, VALUE_SOURCE[kind], FRAGMENT_SOURCE});
        gl->LinkProgram(program);
        gl->GetProgramiv(program, GL_LINK_STATUS, &done);
        gl->GetProgramInfoLog(program, sizeof said, NULL, said);
        if (!done) return FAULT(err, ERROR_LIBRARY, "OpenGL does not take the shaders: %s", said);
        gl->program[kind] = program;
    }
    gl->UseProgram(program);
    return true;
}

static bool gl_open(Gl *gl, GlSource source, Error *err)
{
    if (!(source == GL_OSMESA ? mesa_open(&gl->context, err) : egl_open(&gl->context, err)))
        return false;
    if (!context_use(&gl->context, true))
        return FAULT(err, ERROR_LIBRARY, "OpenGL's context cannot be used");
#define X(type, name, arguments)                                                                   \
    gl->name = (type(*) arguments)gl->context.find("gl" #name);                                    \
    if (!gl->name) return FAULT(err, ERROR_LIBRARY, "OpenGL has no gl%s", #name);
    GL_CALLS(X)
#undef X

    // One vertex buffer, a texture a unit, a frame buffer; all stay bound.
    GLuint layout = 0, corners = 0, frame = 0;
    gl->GenVertexArrays(1, &layout);
    gl->BindVertexArray(layout);
    gl->GenBuffers(1, &corners);
    gl->BindBuffer(GL_ARRAY_BUFFER, corners);
    gl->EnableVertexAttribArray(0);
    gl->VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(GlCorner), NULL);
    gl->GenTextures(UNITS, gl->texture);
    for (GLenum unit = 0; unit < UNITS; ++unit) {
        gl->ActiveTexture(GL_TEXTURE0 + unit);
        gl->BindTexture(GL_TEXTURE_2D, gl->texture[unit]);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    gl->GenFramebuffers(1, &frame);
    gl->BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl->Enable(GL_DEPTH_TEST);   // it lets all pass where the frame has no depth
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);

    gl->ready = true;
    gl->process = getpid();
    context_use(&gl->context, false);
    return true;
}

// --- an image ------------------------------------------------------------------------------------

// The drawing goes over the pixels that are in memory.
static bool target_make(const Gl *gl, const GlImageDef *def, const uint32_t *pixels, Error *err)
{
    GLint most = 0, columns = def->values ? def->columns : 1, rows = def->values ? def->rows : 1;
    gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (def->width > most || def->height > most || columns > most || rows > most)
        return FAULT(err, ERROR_LIBRARY,
                     "OpenGL draws at most %d by %d pixels or values, not %d by %d of %d by %d",
                     most, most, def->width, def->height, columns, rows);
    gl->ActiveTexture(GL_TEXTURE0 + UNIT_TARGET);
    gl->PixelStorei(GL_UNPACK_ROW_LENGTH, def->stride);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, def->width, def->height, 0, GL_RED_INTEGER,
                   GL_UNSIGNED_INT, pixels);
    gl->PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                             gl->texture[UNIT_TARGET], 0);
    gl->ActiveTexture(GL_TEXTURE0 + UNIT_DEPTH);
    if (def->depth)
        gl->TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, def->width, def->height, 0,
                       GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                             def->depth ? gl->texture[UNIT_DEPTH] : 0, 0);
    // An image that cannot be had leaves the texture as it was before.
    if (gl->GetError() || gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return FAULT(err, ERROR_LIBRARY, "OpenGL gives no image of %d by %d pixels", def->width,
                     def->height);
    gl->Viewport(0, 0, def->width, def->height);
    gl->Clear(GL_DEPTH_BUFFER_BIT);
    return true;
}

static void corners_draw(const Gl *gl, const GlCorner *corners, int64_t count)
{
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)count * (GLsizeiptr)sizeof *corners, corners,
                   GL_STREAM_DRAW);
    gl->DrawArrays(GL_TRIANGLES, 0, (GLsizei)count);
}

static GLint uniform(const Gl *gl, GlKind kind, const char *name)
{
    return gl->GetUniformLocation(gl->program[kind], name);
}

// Values that are a texture fill the image by one triangle that is larger than it.
static bool image_draw(Gl *gl, const GlImageDef *def, uint32_t *pixels, Error *err)
{
    float width = (float)def->width, height = (float)def->height;
    GLenum status = GL_NO_ERROR;
    GlKind kind = def->values ? BY_VALUES : BY_CORNERS;
    const GlCorner all[3] = {{0}, {.x = 2 * width}, {.y = 2 * height}};
    if (!target_make(gl, def, pixels, err) || !program_use(gl, kind, err)) return false;
    gl->ActiveTexture(GL_TEXTURE0 + UNIT_COLORS);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, def->color_count, 1, 0, GL_RED_INTEGER,
                   GL_UNSIGNED_INT, def->colors);
    gl->Uniform1i(uniform(gl, kind, "colors"), UNIT_COLORS);
    gl->Uniform1f(uniform(gl, kind, "last"), (float)(def->color_count - 1));
    gl->Uniform1ui(uniform(gl, kind, "below"), def->below);
    gl->Uniform2f(uniform(gl, kind, "size"), width, height);
    if (def->values) {
        gl->ActiveTexture(GL_TEXTURE0 + UNIT_VALUES);
        gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, def->columns, def->rows, 0, GL_RED, GL_FLOAT,
                       def->values);
        gl->Uniform1i(uniform(gl, BY_VALUES, "values"), UNIT_VALUES);
        gl->Uniform2f(uniform(gl, BY_VALUES, "scale"), (float)def->columns / (float)def->width,
                      (float)def->rows / (float)def->height);
    }
    if (def->values)
        corners_draw(gl, all, 3);
    else
        corners_draw(gl, def->corners, def->corner_count);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, def->stride);
    gl->ReadPixels(0, 0, def->width, def->height, GL_RED_INTEGER, GL_UNSIGNED_INT, pixels);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, 0);
    if (def->depth)
        gl->ReadPixels(0, 0, def->width, def->height, GL_DEPTH_COMPONENT, GL_FLOAT, def->depth);
    status = gl->GetError();
    if (status)
        return FAULT(err, status == GL_OUT_OF_MEMORY ? ERROR_MEMORY : ERROR_LIBRARY,
                     "OpenGL fails to draw (0x%x)", status);
    return true;
}

bool gl_image_draw(GlSource first, const GlImageDef *def, uint32_t *pixels, Error *err)
{
    Gl *gl = NULL;
    const char *said[GL_SOURCES] = {"not tried", "not tried"};
    pthread_mutex_lock(&drawing);

    // The first source that works, from `first` on; why none does, by each of them. In a process
    // that was forked after Mesa's threads began these are missing, and it would wait for them for
    // ever: there the next source is taken.
    for (GlSource source = first; source < GL_SOURCES && !gl; ++source) {
        Gl *candidate = &opened[source];
        if (!candidate->tried) gl_open(candidate, source, &candidate->failure);
        candidate->tried = true;
        if (candidate->ready && candidate->process == getpid()) gl = candidate;
        said[source] = candidate->ready ? "in use before this process was forked"
                                        : candidate->failure.message;
    }
    if (!gl)
        FAIL(err, ERROR_LIBRARY,
             "maps and fields need OpenGL, by OSMesa (package libosmesa6) or by EGL (libegl1 and "
             "libgl1-mesa-dri): %s; %s",
             said[GL_OSMESA], said[GL_EGL]);
    if (!context_use(&gl->context, true))
        FAIL(err, ERROR_LIBRARY, "OpenGL's context cannot be used");
    image_draw(gl, def, pixels, err);
    while (gl->GetError() != GL_NO_ERROR) {
    }   // none is left for the next image
    context_use(&gl->context, false);
cleanup:
    pthread_mutex_unlock(&drawing);
    return error_is_clean(err);
}
