// SPDX-License-Identifier: GPL-2.0-or-later
// Values a pixel and triangles through a table of colours, in a plane and in space, by OSMesa and
// by EGL where each is.
#include "render/canvas/gl_image.h"

#include "random_numbers.h"

#include <dlfcn.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

enum { WIDTH = 40, HEIGHT = 30, STRIDE = 48, COLORS = 101, BELOW = 7, FIRST = 1000 };

static const uint32_t UNTOUCHED = 0xeeeeeeee;

static uint32_t colors[COLORS], pixels[HEIGHT * STRIDE];

static GlImageDef image_def(void)
{
    for (uint32_t k = 0; k < COLORS; ++k) colors[k] = FIRST + k;
    memset(pixels, 0xee, sizeof pixels);
    return (GlImageDef){.width = WIDTH,
                        .height = HEIGHT,
                        .stride = STRIDE,
                        .colors = colors,
                        .color_count = COLORS,
                        .below = BELOW};
}

// OSMesa (gone from Mesa 25.1) or a driver for EGL may be missing: then there is nothing to test.
static void skip_without(GlSource source)
{
    Error err = {0};
    GlImageDef def = image_def();
    const GlCorner none[3] = {{0}};
    def.corners = none;
    def.corner_count = 3;
    if (source == GL_OSMESA) {
        if (dlopen("libOSMesa.so.8", RTLD_LAZY | RTLD_LOCAL)) return;
        print_message("skipped: %s\n", dlerror());
    } else {
        if (gl_image_draw(source, &def, pixels, &err)) return;
        print_message("skipped: %s\n", err.message);
    }
    skip();
}

// Every bit is the table's; what a row has beyond the image is left alone.
static void draw_values(GlSource source)
{
    Error err = {0};
    GlImageDef def = image_def();
    float values[HEIGHT * WIDTH];
    for (int32_t k = 0; k < HEIGHT * WIDTH; ++k) values[k] = (float)(k % COLORS) / (COLORS - 1);
    values[0] = 5;
    values[1] = -1;
    values[2] = -2;
    values[3] = NAN;
    values[WIDTH] = 0.126F;
    def.values = values;
    def.columns = WIDTH;
    def.rows = HEIGHT;
    assert_true(gl_image_draw(source, &def, pixels, &err));
    assert_int_equal(pixels[0], FIRST + COLORS - 1);
    assert_int_equal(pixels[1], BELOW);
    assert_int_equal(pixels[2], UNTOUCHED);
    assert_int_equal(pixels[3], UNTOUCHED);
    assert_int_equal(pixels[STRIDE], FIRST + 13);
    for (int32_t k = 4; k < HEIGHT * WIDTH; ++k)
        if (k != WIDTH)
            assert_int_equal(pixels[k / WIDTH * STRIDE + k % WIDTH], FIRST + k % COLORS);
    for (int32_t k = WIDTH; k < STRIDE; ++k) assert_int_equal(pixels[k], UNTOUCHED);
}

// value = x / 40 + y / 60 - 0.2 over the half of the image left of its diagonal: from -0.2, drawn
// as 0, to 0.8.
static void draw_triangle(GlSource source)
{
    Error err = {0};
    GlImageDef def = image_def();
    const GlCorner corners[3] = {{0, 0, -0.2F, 0}, {WIDTH, 0, 0.8F, 0}, {0, HEIGHT, 0.3F, 0}};
    def.corners = corners;
    def.corner_count = 3;
    assert_true(gl_image_draw(source, &def, pixels, &err));
    for (int32_t row = 0; row < HEIGHT; ++row)
        for (int32_t column = 0; column < WIDTH; ++column) {
            double x = column + 0.5, y = row + 0.5, side = x / WIDTH + y / HEIGHT;
            double place = (COLORS - 1) * fmax(x / 40 + y / 60 - 0.2, 0);
            double pixel = pixels[row * STRIDE + column];
            if (side < 1 - 1e-3) assert_true(fabs(pixel - FIRST - place) < 0.501);
            if (side > 1 + 1e-3) assert_true(pixel == UNTOUCHED);
        }
}

// A tilted triangle goes through an upright one at x = WIDTH / 2, whichever is drawn first. Without
// `depth` the second is drawn over the first.
static void draw_in_space(GlSource source)
{
    enum { END = 2 * WIDTH };   // both triangles are larger than the image
    static float depth[HEIGHT * WIDTH];
    static const GlCorner corners[2][3] = {
        {{0, 0, 0.1F, 0.2F}, {END, 0, 0.1F, 1.4F}, {0, END, 0.1F, 0.2F}},   // 0.2 + 0.6 x / WIDTH
        {{0, 0, 0.7F, 0.5F}, {END, 0, 0.7F, 0.5F}, {0, END, 0.7F, 0.5F}}};
    for (int32_t first = 0; first < 2; ++first) {
        Error err = {0};
        GlImageDef def = image_def();
        GlCorner both[6];
        memcpy(both, corners[first], sizeof corners[0]);
        memcpy(both + 3, corners[1 - first], sizeof corners[0]);
        def.corners = both;
        def.corner_count = 6;
        def.depth = depth;
        memset(depth, 0xee, sizeof depth);
        assert_true(gl_image_draw(source, &def, pixels, &err));
        for (int32_t k = 0; k < HEIGHT * WIDTH; ++k) {
            int32_t row = k / WIDTH, column = k % WIDTH;
            double x = column + 0.5, tilted = 0.2 + 0.6 * x / WIDTH;
            assert_int_equal(pixels[row * STRIDE + column], FIRST + (x < WIDTH / 2 ? 10 : 70));
            assert_true(fabs((double)depth[k] - fmin(tilted, 0.5)) < 1e-6);
        }
        def.depth = NULL;
        assert_true(gl_image_draw(source, &def, pixels, &err));
        assert_int_equal(pixels[0], FIRST + (first == 0 ? 70 : 10));
    }
    Error err = {0};
    GlImageDef def = image_def();   // of no triangles
    def.depth = depth;
    assert_true(gl_image_draw(source, &def, pixels, &err));
    assert_true(depth[0] == 1 && depth[HEIGHT * WIDTH - 1] == 1);
    assert_int_equal(pixels[0], UNTOUCHED);
}

static void osmesa_draws(void **state)
{
    (void)state;
    skip_without(GL_OSMESA);
    draw_values(GL_OSMESA);
    draw_in_space(GL_OSMESA);
    draw_triangle(GL_OSMESA);
}

static void egl_draws_without_a_surface(void **state)
{
    (void)state;
    skip_without(GL_EGL);
    draw_triangle(GL_EGL);
    draw_in_space(GL_EGL);
    draw_values(GL_EGL);
}

// The first source that is there, as pictures take it.
static void what_is_there_draws(void **state)
{
    (void)state;
    draw_values(GL_OSMESA);
    draw_in_space(GL_OSMESA);
    draw_triangle(GL_OSMESA);
}

// A picture is the same bytes whatever has drawn it: a table of values, then triangles of any shape
// over it whose values pass both ends of the colours; then these in space.
static void both_sources_draw_the_same(void **state)
{
    enum { TRIANGLES = 200 };
    static uint32_t drawn[GL_SOURCES][HEIGHT * STRIDE], nearest[GL_SOURCES][HEIGHT * STRIDE];
    static float depth[GL_SOURCES][HEIGHT * WIDTH];
    static float values[HEIGHT * WIDTH];
    static GlCorner corners[3 * TRIANGLES];
    Random random = {1};
    (void)state;
    skip_without(GL_OSMESA);
    skip_without(GL_EGL);
    for (int32_t k = 0; k < HEIGHT * WIDTH; ++k)
        values[k] = (float)random_between(&random, -1.8, 1.4);
    for (int32_t k = 0; k < 3 * TRIANGLES; ++k)   // over the left half
        corners[k] = (GlCorner){
            (float)random_between(&random, 0, WIDTH / 2), (float)random_between(&random, 0, HEIGHT),
            (float)random_between(&random, -0.2, 1.2), (float)random_between(&random, 0, 1)};
    for (GlSource source = 0; source < GL_SOURCES; ++source) {
        Error err = {0};
        GlImageDef table = image_def(), triangles = image_def();
        table.values = values;
        table.columns = WIDTH;
        table.rows = HEIGHT;
        triangles.corners = corners;
        triangles.corner_count = 3 * TRIANGLES;
        for (int32_t k = 0; k < HEIGHT * STRIDE; ++k) drawn[source][k] = UNTOUCHED;
        assert_true(gl_image_draw(source, &table, drawn[source], &err));
        assert_true(gl_image_draw(source, &triangles, drawn[source], &err));
        triangles.depth = depth[source];
        assert_true(gl_image_draw(source, &triangles, nearest[source], &err));
    }
    assert_memory_equal(drawn[GL_OSMESA], drawn[GL_EGL], sizeof drawn[GL_EGL]);
    assert_memory_equal(nearest[GL_OSMESA], nearest[GL_EGL], sizeof nearest[GL_EGL]);
    assert_memory_equal(depth[GL_OSMESA], depth[GL_EGL], sizeof depth[GL_EGL]);
    assert_memory_not_equal(drawn[GL_EGL], nearest[GL_EGL], sizeof nearest[GL_EGL]);
}

// A process that is forked after images does not wait for ever for threads that are not there: it
// draws by the source that is left, or says that there is none.
static void a_forked_process_ends(void **state)
{
    what_is_there_draws(state);
    pid_t child = fork();
    if (child == 0) {
        Error err = {0};
        GlImageDef def = image_def();
        const GlCorner corners[3] = {{0}, {.x = 2 * WIDTH}, {.y = 2 * HEIGHT}};
        def.corners = corners;
        def.corner_count = 3;
        alarm(20);
        bool drawn = gl_image_draw(GL_OSMESA, &def, pixels, &err);
        _exit(drawn ? pixels[0] != FIRST : !strstr(err.message, "before this process was forked"));
    }
    int status = -1;
    assert_true(waitpid(child, &status, 0) == child);
    assert_int_equal(status, 0);
}

static void no_corners_no_pixels(void **state)
{
    (void)state;
    Error err = {0};
    GlImageDef def = image_def();
    assert_true(gl_image_draw(GL_OSMESA, &def, pixels, &err));
    assert_int_equal(pixels[0], UNTOUCHED);
}

static void what_is_too_large_is_an_error(void **state)
{
    (void)state;
    Error err = {0};
    GlImageDef def = image_def();
    def.width = 1 << 28;
    assert_false(gl_image_draw(GL_OSMESA, &def, pixels, &err));
    assert_int_equal(err.code, ERROR_LIBRARY);
    what_is_there_draws(NULL);   // and the next one is drawn
}

static void no_source_no_image(void **state)
{
    (void)state;
    Error err = {0};
    GlImageDef def = image_def();
    assert_false(gl_image_draw(GL_SOURCES, &def, pixels, &err));
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.message, "libosmesa6"));
    assert_non_null(strstr(err.message, "libegl1"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_forked_process_ends),
        cmocka_unit_test(osmesa_draws),
        cmocka_unit_test(egl_draws_without_a_surface),
        cmocka_unit_test(both_sources_draw_the_same),
        cmocka_unit_test(no_corners_no_pixels),
        cmocka_unit_test(what_is_too_large_is_an_error),
        cmocka_unit_test(no_source_no_image),
        cmocka_unit_test(a_forked_process_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
