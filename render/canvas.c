// SPDX-License-Identifier: GPL-2.0-or-later
// One vertex layout and one program for all three kinds of paint; vertices gather in a batch that
// is drawn when the paint, the clip or a texture changes.
#include "render/canvas.h"

#include "base/memory.h"

#include <GL/gl.h>
#include <GL/glext.h>

#include <math.h>
#include <stddef.h>

enum { SAMPLES_WANTED = 8, BATCH_VERTICES = 3 * 4096, HEAT_VERTICES = 6 };

struct Canvas {
    int32_t width, height;   // pixels
    GLuint drawn[2], resolved[2];   // frame buffer and its colour: with samples, and without
    GLuint program, layout, buffer;   // shaders, vertex array, vertex buffer
    GLuint glyphs, map, heat;   // textures
    Vertex *batch;   // [BATCH_VERTICES] not yet drawn; owned
    int64_t batched;   // of these, filled
    PaintKind kind;   // of the batch
    Error failure;   // the first one
};

static const char VERTEX_SOURCE[] =
    "#version 330 core\n"
    "uniform vec2 size;\n"
    "layout(location = 0) in vec2 position;\n"
    "layout(location = 1) in vec2 texel;\n"
    "layout(location = 2) in vec4 color;\n"
    "out vec2 at;\n"
    "out vec4 tint;\n"
    "void main() {\n"
    "    at = texel;\n"
    "    tint = color;\n"
    // Rows are read back from the bottom: y downwards in both makes the first row the top one.
    "    gl_Position = vec4(2.0 * position / size - 1.0, 0.0, 1.0);\n"
    "}\n";

static const char FRAGMENT_SOURCE[] =
    "#version 330 core\n"
    "uniform int kind;\n"
    "uniform vec4 below;\n"
    "uniform sampler2D glyphs;\n"
    "uniform sampler2D map;\n"
    "uniform sampler2D heat;\n"
    "in vec2 at;\n"
    "in vec4 tint;\n"
    "out vec4 color;\n"
    "void main() {\n"
    "    if (kind == 0) {\n"
    "        color = tint;\n"
    "    } else if (kind == 1) {\n"
    "        color = vec4(tint.rgb, tint.a * texelFetch(glyphs, ivec2(floor(at)), 0).r);\n"
    "    } else {\n"
    "        float value = texture(heat, at).r;\n"
    "        if (value < -1.5) discard;\n"
    "        float last = float(textureSize(map, 0).x - 1);\n"
    "        float place = (clamp(value, 0.0, 1.0) * last + 0.5) / (last + 1.0);\n"
    "        color = value < 0.0 ? below : vec4(texture(map, vec2(place, 0.5)).rgb, 1.0);\n"
    "    }\n"
    "}\n";

// --- what OpenGL needs before the first triangle -------------------------------------------------
// Compiles one stage into `program`; what the compiler says goes into the error.
static bool shader_compile(GLuint program, GLenum stage, const char *source, Error *err)
{
    GLint done = GL_FALSE;
    GLchar said[500] = "";
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &source, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (!done) {
        glGetShaderInfoLog(shader, sizeof said, NULL, said);
        FAIL(err, ERROR_LIBRARY, "OpenGL does not compile a shader: %s", said);
    }
    glAttachShader(program, shader);
cleanup:
    glDeleteShader(shader);   // lives on in the program
    return error_is_clean(err);
}

// Texture units are fixed: 0 the glyph sheet, 1 the colour map, 2 the heat texture.
static bool program_create(Canvas *canvas, Error *err)
{
    GLint done = GL_FALSE;
    GLuint program = canvas->program = glCreateProgram();
    TRY(shader_compile(program, GL_VERTEX_SHADER, VERTEX_SOURCE, err));
    TRY(shader_compile(program, GL_FRAGMENT_SHADER, FRAGMENT_SOURCE, err));
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &done);
    if (!done) FAIL(err, ERROR_LIBRARY, "OpenGL does not link the shaders");
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "size"), (GLfloat)canvas->width,
                (GLfloat)canvas->height);
    glUniform1i(glGetUniformLocation(program, "glyphs"), 0);
    glUniform1i(glGetUniformLocation(program, "map"), 1);
    glUniform1i(glGetUniformLocation(program, "heat"), 2);
cleanup:
    return error_is_clean(err);
}

// Tells OpenGL where in a Vertex the shader's input number `place` lies.
static void attribute_set(GLuint place, GLint numbers, size_t offset)
{
    glEnableVertexAttribArray(place);
    glVertexAttribPointer(place, numbers, GL_FLOAT, GL_FALSE, sizeof(Vertex), (const void *)offset);
}

//     location 0: x, y in pixels   1: u, v of a texture   2: red, green, blue, alpha
static void layout_create(Canvas *canvas)
{
    glGenVertexArrays(1, &canvas->layout);
    glBindVertexArray(canvas->layout);
    glGenBuffers(1, &canvas->buffer);
    glBindBuffer(GL_ARRAY_BUFFER, canvas->buffer);
    attribute_set(0, 2, offsetof(Vertex, x));
    attribute_set(1, 2, offsetof(Vertex, u));
    attribute_set(2, 4, offsetof(Vertex, color));
}

// An empty texture on its own unit, where it stays bound for the canvas's life.
static GLuint texture_create(GLenum unit, GLint filter)
{
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glActiveTexture(unit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

// A frame buffer object (pair[0]) with one colour buffer (pair[1]).
static bool target_create(const Canvas *canvas, GLint samples, GLuint pair[2], Error *err)
{
    glGenFramebuffers(1, &pair[0]);
    glBindFramebuffer(GL_FRAMEBUFFER, pair[0]);
    glGenRenderbuffers(1, &pair[1]);
    glBindRenderbuffer(GL_RENDERBUFFER, pair[1]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, canvas->width,
                                     canvas->height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pair[1]);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        FAIL(err, ERROR_LIBRARY, "OpenGL gives no buffer of %d by %d pixels", canvas->width,
             canvas->height);
cleanup:
    return error_is_clean(err);
}

// Drawing goes into a buffer with several samples a pixel, which canvas_read averages into a plain
// one: that is all the antialiasing there is. Glyphs bring their own, from FreeType.
static bool targets_create(Canvas *canvas, Error *err)
{
    GLint samples = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &samples);
    if (samples > SAMPLES_WANTED) samples = SAMPLES_WANTED;
    TRY(target_create(canvas, 0, canvas->resolved, err));
    TRY(target_create(canvas, samples, canvas->drawn, err));
    glViewport(0, 0, canvas->width, canvas->height);
    glClearColor(1, 1, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
cleanup:
    return error_is_clean(err);
}

// The context must be current. Rows are packed without padding, both ways: pixels go to libpng as
// they are read.
Canvas *canvas_create(int32_t width, int32_t height, Error *err)
{
    Canvas *canvas = NULL;
    if (width < CANVAS_SIZE_MIN || width > CANVAS_SIZE_MAX || height < CANVAS_SIZE_MIN ||
        height > CANVAS_SIZE_MAX)
        FAIL(err, ERROR_INPUT, "a picture of %d by %d pixels: each must be from %d to %d", width,
             height, CANVAS_SIZE_MIN, CANVAS_SIZE_MAX);
    TRY(canvas = NEW_ARRAY(Canvas, 1, err));
    canvas->width = width;
    canvas->height = height;
    TRY(canvas->batch = NEW_ARRAY(Vertex, BATCH_VERTICES, err));
    TRY(targets_create(canvas, err));
    TRY(program_create(canvas, err));
    layout_create(canvas);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    canvas->glyphs = texture_create(GL_TEXTURE0, GL_NEAREST);
    canvas->map = texture_create(GL_TEXTURE1, GL_LINEAR);
    canvas->heat = texture_create(GL_TEXTURE2, GL_NEAREST);
    return canvas;
cleanup:
    canvas_destroy(canvas);
    return NULL;
}

void canvas_destroy(Canvas *canvas)
{
    if (!canvas) return;
    glDeleteTextures(1, &canvas->glyphs);   // names that are 0 are passed over
    glDeleteTextures(1, &canvas->map);
    glDeleteTextures(1, &canvas->heat);
    glDeleteBuffers(1, &canvas->buffer);
    glDeleteVertexArrays(1, &canvas->layout);
    glDeleteProgram(canvas->program);
    glDeleteFramebuffers(1, &canvas->drawn[0]);
    glDeleteRenderbuffers(1, &canvas->drawn[1]);
    glDeleteFramebuffers(1, &canvas->resolved[0]);
    glDeleteRenderbuffers(1, &canvas->resolved[1]);
    memory_free(canvas->batch);
    memory_free(canvas);
}

int32_t canvas_width(const Canvas *canvas)
{
    return canvas->width;
}

int32_t canvas_height(const Canvas *canvas)
{
    return canvas->height;
}

Error *canvas_failure(Canvas *canvas)
{
    return &canvas->failure;
}

// --- drawing -------------------------------------------------------------------------------------
// Hands what has gathered to OpenGL. Whoever changes a texture or the clip calls it first.
static void batch_draw(Canvas *canvas)
{
    if (canvas->batched == 0) return;
    glUniform1i(glGetUniformLocation(canvas->program, "kind"), (GLint)canvas->kind);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)((size_t)canvas->batched * sizeof(Vertex)),
                 canvas->batch, GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, (GLsizei)canvas->batched);
    canvas->batched = 0;
}

// Vertices are copied into the batch; three at a time, so that no triangle is torn in two.
void canvas_triangles(Canvas *canvas, PaintKind kind, const Vertex *vertices, int64_t count)
{
    if (kind != canvas->kind) batch_draw(canvas);
    canvas->kind = kind;
    for (int64_t k = 0; k + 2 < count; k += 3) {
        if (canvas->batched + 3 > BATCH_VERTICES) batch_draw(canvas);
        for (int64_t corner = 0; corner < 3; ++corner)
            canvas->batch[canvas->batched++] = vertices[k + corner];
    }
}

// Whole pixels; NULL: all of the canvas. What has gathered is drawn under the old clip.
void canvas_clip(Canvas *canvas, const Box *box)
{
    batch_draw(canvas);
    if (!box) {
        glDisable(GL_SCISSOR_TEST);
        return;
    }
    GLint left = (GLint)lround(box->left), top = (GLint)lround(box->top);
    GLint right = (GLint)lround(box->right), bottom = (GLint)lround(box->bottom);
    glEnable(GL_SCISSOR_TEST);
    glScissor(left, top, right > left ? right - left : 0, bottom > top ? bottom - top : 0);
}

void canvas_set_glyphs(Canvas *canvas, const uint8_t *sheet)
{
    batch_draw(canvas);
    glActiveTexture(GL_TEXTURE0);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, GLYPH_SHEET_SIZE, GLYPH_SHEET_SIZE, 0, GL_RED,
                 GL_UNSIGNED_BYTE, sheet);
}

// MAP_SIZE colours from low to high; `below` for values under 0, see the fragment shader.
void canvas_set_map(Canvas *canvas, const uint8_t *colors, Color below)
{
    batch_draw(canvas);
    glActiveTexture(GL_TEXTURE1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, MAP_SIZE, 1, 0, GL_RGB, GL_UNSIGNED_BYTE, colors);
    glUniform4f(glGetUniformLocation(canvas->program, "below"), below.red, below.green, below.blue,
                below.alpha);
}

// One texel a value, not interpolated: a pixel shows a number that was computed, never a mixture.
// Faults are kept and reported by canvas_read.
void canvas_heat(Canvas *canvas, const Box *box, const float *values, int32_t columns, int32_t rows)
{
    Error *err = &canvas->failure;
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (columns > limit || rows > limit) {
        error_set(err, ERROR_LIBRARY, __FILE__, __LINE__,
                  "a map of %d by %d values: OpenGL takes %d a side", columns, rows, limit);
        return;
    }
    batch_draw(canvas);
    glActiveTexture(GL_TEXTURE2);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, columns, rows, 0, GL_RED, GL_FLOAT, values);
    Vertex corner[4] = {0};
    for (int32_t k = 0; k < 4; ++k) {
        corner[k].u = (float)(k & 1);
        corner[k].v = (float)(k >> 1);
        corner[k].x = (float)(k & 1 ? box->right : box->left);
        corner[k].y = (float)(k >> 1 ? box->bottom : box->top);
    }
    Vertex vertices[HEAT_VERTICES] = {corner[0], corner[1], corner[2],
                                      corner[2], corner[1], corner[3]};
    canvas_triangles(canvas, PAINT_HEAT, vertices, HEAT_VERTICES);
    batch_draw(canvas);
}

// Samples are resolved into a plain frame buffer first: they cannot be read themselves. pixels:
// [height * width * 3], top row first, the caller's.
bool canvas_read(Canvas *canvas, uint8_t **pixels, Error *err)
{
    *pixels = NULL;
    batch_draw(canvas);
    if (!error_is_clean(&canvas->failure)) {
        *err = canvas->failure;
        goto cleanup;
    }
    TRY(*pixels = NEW_ARRAY(uint8_t, (int64_t)canvas->width * canvas->height * 3, err));
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, canvas->drawn[0]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, canvas->resolved[0]);
    glBlitFramebuffer(0, 0, canvas->width, canvas->height, 0, 0, canvas->width, canvas->height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, canvas->resolved[0]);
    glReadPixels(0, 0, canvas->width, canvas->height, GL_RGB, GL_UNSIGNED_BYTE, *pixels);
    glBindFramebuffer(GL_FRAMEBUFFER, canvas->drawn[0]);
    GLenum fault = glGetError();
    if (fault != GL_NO_ERROR) FAIL(err, ERROR_LIBRARY, "OpenGL reports fault 0x%x", fault);
cleanup:
    if (!error_is_clean(err)) {
        memory_free(*pixels);
        *pixels = NULL;
    }
    return error_is_clean(err);
}
