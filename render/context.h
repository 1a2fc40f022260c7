// SPDX-License-Identifier: GPL-2.0-or-later
// An OpenGL 3.3 core context without a window. The one place that knows OSMesa: where Mesa no
// longer ships it (from 25.1 on), another context.c with these two functions takes its place.
// Called by render.c; everything else is plain OpenGL.
#ifndef AMONTONS_RENDER_CONTEXT_H
#define AMONTONS_RENDER_CONTEXT_H

#include "base/error.h"

typedef struct RenderContext RenderContext;

// Creates a context and makes it current on this thread. Its own frame buffer is a token: pictures
// are drawn into frame buffer objects of the canvas. NULL with ERROR_LIBRARY when there is none.
RenderContext *context_create(Error *err);
void context_destroy(RenderContext *context);   // NULL is fine

#endif
