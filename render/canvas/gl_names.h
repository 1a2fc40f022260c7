// SPDX-License-Identifier: GPL-2.0-or-later
// The few names of OpenGL 3.3, OSMesa and EGL that gl_image.c uses, with the values and types that
// Khronos' registry (OpenGL 3.3 core, EGL 1.5, EGL_MESA_platform_surfaceless) and Mesa's OSMesa 8
// fix for ever. Their libraries are opened when an image is drawn; with this header their packages
// of headers, of which no system offers all, are not needed to compile either.
#ifndef AMONTONS_RENDER_CANVAS_GL_NAMES_H
#define AMONTONS_RENDER_CANVAS_GL_NAMES_H

#include <stddef.h>
#include <stdint.h>

// --- OpenGL --------------------------------------------------------------------------------------

typedef unsigned int GLenum, GLuint, GLbitfield;
typedef int GLint, GLsizei;
typedef unsigned char GLboolean;
typedef char GLchar;
typedef float GLfloat;
typedef ptrdiff_t GLsizeiptr;

enum {
    GL_FALSE = 0,
    GL_NO_ERROR = 0,
    GL_OUT_OF_MEMORY = 0x0505,

    GL_UNSIGNED_BYTE = 0x1401,
    GL_UNSIGNED_INT = 0x1405,
    GL_FLOAT = 0x1406,
    GL_RED = 0x1903,
    GL_RGBA = 0x1908,
    GL_RED_INTEGER = 0x8d94,
    GL_DEPTH_COMPONENT = 0x1902,
    GL_DEPTH_COMPONENT32F = 0x8cac,
    GL_R32F = 0x822e,
    GL_R32UI = 0x8236,

    GL_TRIANGLES = 0x0004,
    GL_ARRAY_BUFFER = 0x8892,
    GL_STREAM_DRAW = 0x88e0,
    GL_FRAGMENT_SHADER = 0x8b30,
    GL_VERTEX_SHADER = 0x8b31,
    GL_LINK_STATUS = 0x8b82,

    GL_TEXTURE_2D = 0x0de1,
    GL_NEAREST = 0x2600,
    GL_TEXTURE_MAG_FILTER = 0x2800,
    GL_TEXTURE_MIN_FILTER = 0x2801,
    GL_TEXTURE0 = 0x84c0,
    GL_MAX_TEXTURE_SIZE = 0x0d33,
    GL_UNPACK_ROW_LENGTH = 0x0cf2,
    GL_UNPACK_ALIGNMENT = 0x0cf5,
    GL_PACK_ROW_LENGTH = 0x0d02,

    GL_FRAMEBUFFER = 0x8d40,
    GL_FRAMEBUFFER_COMPLETE = 0x8cd5,
    GL_COLOR_ATTACHMENT0 = 0x8ce0,
    GL_DEPTH_ATTACHMENT = 0x8d00,
    GL_DEPTH_BUFFER_BIT = 0x0100,
    GL_DEPTH_TEST = 0x0b71,
};

// --- OSMesa --------------------------------------------------------------------------------------

typedef struct osmesa_context *OSMesaContext;

enum {
    OSMESA_FORMAT = 0x22,
    OSMESA_RGBA = GL_RGBA,
    OSMESA_DEPTH_BITS = 0x30,
    OSMESA_PROFILE = 0x33,
    OSMESA_CORE_PROFILE = 0x34,
    OSMESA_CONTEXT_MAJOR_VERSION = 0x36,
    OSMESA_CONTEXT_MINOR_VERSION = 0x37,
};

// --- EGL -----------------------------------------------------------------------------------------

typedef unsigned int EGLBoolean, EGLenum;
typedef int32_t EGLint;
typedef intptr_t EGLAttrib;
typedef void *EGLDisplay, *EGLConfig, *EGLContext, *EGLSurface;   // NULL: none

enum {
    EGL_NONE = 0x3038,
    EGL_CONTEXT_MAJOR_VERSION = 0x3098,
    EGL_CONTEXT_MINOR_VERSION = 0x30fb,
    EGL_CONTEXT_OPENGL_PROFILE_MASK = 0x30fd,
    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT = 0x0001,
    EGL_OPENGL_API = 0x30a2,
    EGL_PLATFORM_SURFACELESS_MESA = 0x31dd,
};

#endif
