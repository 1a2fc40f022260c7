// SPDX-License-Identifier: GPL-2.0-or-later
// Known fields on every kind of element in the plane, drawn and read back through the colour map;
// contours and edges where they belong; energies of a known strain.
#include "render/figures/surface_draw.h"

#include "plane.h"

#include "base/memory.h"
#include "canvas_read.h"
#include "io/mesh/shape_functions.h"
#include "near.h"

enum { SIZE = 300, NODES = 18 };

static const Color BLACK = {0, 0, 0, 1};

// Two elements of a kind, each on nodes of its own: an affine one, and its mirror image across the
// side x + z / 4 = 0.5 (quadrilaterals), or across the diagonal (triangles).
typedef struct Patch {
    FieldFrame frame;
    double position[3 * NODES], displacement[3 * NODES], velocity[3 * NODES];
    double elastic[3 * NODES], stress[3 * NODES], value[NODES], place[NODES][2];
    int32_t first[3], nodes[NODES];
    uint8_t kinds[2];
} Patch;

static void patch_place(ElementKind kind, int32_t e, int32_t a, double place[2])
{
    bool triangle = kind == ELEMENT_T3 || kind == ELEMENT_T6;
    const double *at = shape_node(kind, a);
    double xi = at[0], eta = at[1];
    if (!triangle) {
        xi = (xi + 1) / 2;
        eta = (eta + 1) / 2;
    } else if (e == 1) {   // the other half of the square
        xi = 1 - xi;
        eta = 1 - eta;
    }
    place[0] = triangle ? 0.1 + 0.7 * xi : 0.05 + 0.4 * xi + 0.4 * e;
    place[1] = 0.1 + 0.6 * eta;
    place[0] += 0.1 * place[1];   // a parallelogram
}

static Block patch_make(ElementKind kind, Patch *patch)
{
    int32_t count = element_node_count(kind);
    *patch = (Patch){.first = {0, count, 2 * count}, .kinds = {(uint8_t)kind, (uint8_t)kind}};
    for (int32_t e = 0; e < 2; e++)
        for (int32_t a = 0; a < count; a++) {
            int32_t node = e * count + a;
            patch->nodes[node] = node;
            patch_place(kind, e, a, patch->place[node]);
            for (int d = 0; d < 2; d++) patch->position[3 * node + d] = patch->place[node][d];
        }
    patch->frame = (FieldFrame){.dim = 2,
                                .stresses = 3,
                                .node_count = 2 * count,
                                .position = patch->position,
                                .displacement = patch->displacement,
                                .velocity = patch->velocity,
                                .stress_elastic = patch->elastic,
                                .stress = patch->stress,
                                .element_count = 2,
                                .kind = patch->kinds,
                                .first_node = patch->first,
                                .element_nodes = patch->nodes};
    return (Block){.frame = patch->frame, .value = patch->value, .place = patch->place};
}

// A field that the element can hold: linear, or quadratic; from 0 to 1 on the unit square.
static double field_at(ElementKind kind, double x, double z)
{
    bool linear = kind == ELEMENT_T3 || kind == ELEMENT_Q4;
    return linear ? 0.6 * x + 0.4 * z : 0.5 * x * x + 0.3 * z * z + 0.2 * x * z;
}

static Axes square_axes(void)
{
    return (Axes){.box = {0, 0, SIZE, SIZE}, .x = {.high = 1}, .y = {.high = 1}};
}

// With edges.
static void surface_of(const Block *block, const Axes *axes, Surface *surface)
{
    static const SpaceCut whole = {0};
    Error err = {0};
    assert_true(surface_build(block, &whole, true, surface_parts(block, axes), surface, &err));
}

// The place in the map of the colour that is nearest to this one.
static double invert(const uint8_t *map, const uint8_t *pixel)
{
    int32_t best = 0, least = INT32_MAX;
    for (int32_t k = 0; k < MAP_SIZE; k++) {
        int32_t away = 0;
        for (int c = 0; c < 3; c++) away += abs(map[3 * k + c] - pixel[c]);
        if (away < least) best = k;
        if (away < least) least = away;
    }
    assert_true(least <= 1);
    return (double)best / (MAP_SIZE - 1);
}

// Whether (x, z) lies in the patch, at least `margin` from its border.
static bool is_inside(ElementKind kind, double x, double z, double margin)
{
    bool triangle = kind == ELEMENT_T3 || kind == ELEMENT_T6;
    double across = x - 0.1 * z, low = triangle ? 0.1 : 0.05, high = triangle ? 0.8 : 0.85;
    return across > low + margin && across < high - margin && z > 0.1 + margin && z < 0.7 - margin;
}

static void draw_and_read(ElementKind kind)
{
    const CanvasDef def = {.width = SIZE, .height = SIZE, .dpi = 100};
    Error err = {0};
    Patch patch;
    Block block = patch_make(kind, &patch);
    Axes axes = square_axes();
    uint8_t map[3 * MAP_SIZE], *pixels = NULL;
    int32_t seen = 0;
    for (int32_t i = 0; i < block.frame.node_count; i++)
        patch.value[i] = field_at(kind, patch.place[i][0], patch.place[i][1]);
    Canvas *canvas = canvas_create(&def, &err);
    assert_non_null(canvas);
    color_map_fill(map);
    Surface surface;
    surface_of(&block, &axes, &surface);
    assert_true(surface_colors(canvas, &block, &axes, &surface, 0, 1, NULL, &err));
    surface_destroy(&surface);
    assert_true(canvas_read(canvas, &pixels, &err));
    for (int32_t row = 0; row < SIZE; row++)
        for (int32_t column = 0; column < SIZE; column++) {
            const uint8_t *pixel = pixels + 3 * (row * SIZE + column);
            double x = (column + 0.5) / SIZE, z = 1 - (row + 0.5) / SIZE;
            if (is_inside(kind, x, z, 1e-6)) {
                seen++;
                // half a step of the map, and the lattice's straight parts
                assert_true(fabs(invert(map, pixel) - field_at(kind, x, z)) < 0.5 / 255 + 0.001);
            } else if (!is_inside(kind, x, z, -1e-6)) {
                assert_true(pixel[0] == 255 && pixel[1] == 255 && pixel[2] == 255);
            }
        }
    assert_true(seen > 0.35 * SIZE * SIZE);
    memory_free(pixels);
    canvas_destroy(canvas);
}

TEST(every_element_shows_its_field)
{
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) draw_and_read((ElementKind)kind);
}

// Ink lies on the curve field = 0.3, all along it, and nowhere else.
TEST(contours_follow_the_level)
{
    Error err = {0};
    Patch patch;
    Block block = patch_make(ELEMENT_T6, &patch);
    const PictureStyle style = {.dpi = SIZE / 86. * 25.4};
    const PageDef def = {.style = &style, .height = 1};
    Page page = {0};
    Axes axes = square_axes();
    Stroke stroke = {.color = BLACK, .width = 1};
    uint8_t *pixels = NULL;
    int32_t rows = 0;
    for (int32_t i = 0; i < block.frame.node_count; i++)
        patch.value[i] = field_at(ELEMENT_T6, patch.place[i][0], patch.place[i][1]);
    assert_true(page_begin(&page, &def, &err));
    Surface surface;
    surface_of(&block, &axes, &surface);
    surface_contour(page.canvas, &block, &axes, &surface, 0.3, &stroke, NULL);
    surface_destroy(&surface);
    assert_true(canvas_read(page.canvas, &pixels, &err));
    for (int32_t row = 0; row < SIZE; row++) {
        bool inked = false;
        for (int32_t column = 0; column < SIZE; column++) {
            double x = (column + 0.5) / SIZE, z = 1 - (row + 0.5) / SIZE;
            if (pixels[3 * (row * SIZE + column)] > 200) continue;
            inked = true;
            assert_true(fabs(field_at(ELEMENT_T6, x, z) - 0.3) < 0.006);   // a pixel: 1/300
        }
        rows += inked;
    }
    assert_in_range(rows, 130, 185);   // the curve rises from z = 0.11 to 0.7, but for its flat end
    memory_free(pixels);
    page_destroy(&page);
}

// The outline has only sides of one element alone: both have all, as they share no node here; with
// common nodes the inner side is gone.
TEST(the_outline_is_what_one_element_has)
{
    static const double places[6][2] = {{0.1, 0.1}, {0.5, 0.1}, {0.9, 0.1},
                                        {0.1, 0.9}, {0.5, 0.9}, {0.9, 0.9}};
    int32_t first[3] = {0, 4, 8}, nodes[8] = {0, 1, 4, 3, 1, 2, 5, 4};
    uint8_t kinds[2] = {ELEMENT_Q4, ELEMENT_Q4}, *pixels = NULL;
    double place[6][2], value[6] = {0}, position[18] = {0};
    memcpy(place, places, sizeof place);
    Block block = {.frame = {.dim = 2,
                             .stresses = 3,
                             .node_count = 6,
                             .position = position,
                             .element_count = 2,
                             .kind = kinds,
                             .first_node = first,
                             .element_nodes = nodes},
                   .value = value,
                   .place = place};
    const PictureStyle style = {.dpi = SIZE / 86. * 25.4};
    const PageDef def = {.style = &style, .height = 1};
    Stroke stroke = {.color = BLACK, .width = 2};
    Axes axes = square_axes();
    Page page = {0};
    Error err = {0};
    assert_true(page_begin(&page, &def, &err));
    Surface surface;
    surface_of(&block, &axes, &surface);
    surface_lines(page.canvas, &block, &axes, &surface.outline, &stroke, NULL);
    assert_true(canvas_read(page.canvas, &pixels, &err));
    const uint8_t *middle = pixels + 3 * SIZE * (SIZE / 2);
    assert_true(middle[3 * 30] < 50 && middle[3 * 150] == 255 && middle[3 * 270] < 50);
    memory_free(pixels);
    surface_lines(page.canvas, &block, &axes, &surface.edges, &stroke, NULL);
    surface_destroy(&surface);
    assert_true(canvas_read(page.canvas, &pixels, &err));
    assert_true(pixels[3 * (SIZE * (SIZE / 2) + 150)] < 50);
    memory_free(pixels);
    page_destroy(&page);
}

// u = (a x + b z, c x + d z): one strain everywhere, on every kind of element.
TEST(energies_of_one_strain)
{
    const double a = 0.02, b = 0.03, c = -0.01, d = 0.05, stress[3] = {2, -3, 0.7};
    const double work = stress[0] * a + stress[1] * d + stress[2] * (b + c);
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        Error err = {0};
        Patch patch;
        Block block = patch_make((ElementKind)kind, &patch);
        for (int32_t i = 0; i < block.frame.node_count; i++) {
            double x = patch.place[i][0], z = patch.place[i][1];
            patch.displacement[3 * i] = a * x + b * z;
            patch.displacement[3 * i + 1] = c * x + d * z;
            for (int k = 0; k < 2; k++)
                patch.velocity[3 * i + k] = 10 * patch.displacement[3 * i + k];
            for (int k = 0; k < 3; k++) {
                patch.elastic[3 * i + k] = stress[k];
                patch.stress[3 * i + k] = 1.5 * stress[k];
            }
        }
        assert_true(block_take(&block, BLOCK_ENERGY, &err));
        for (int32_t i = 0; i < block.frame.node_count; i++)
            assert_near("energy", patch.value[i], work / 2, 1e-12);
        assert_true(block_take(&block, BLOCK_DISSIPATION, &err));
        for (int32_t i = 0; i < block.frame.node_count; i++)
            assert_near("energy", patch.value[i], 0.5 * 10 * work, 1e-11);
    }
}

// The block as a whole stays where it is; what it is deformed by is drawn magnified.
TEST(deformation_is_without_the_push)
{
    Patch patch;
    Block block = patch_make(ELEMENT_Q4, &patch);
    for (int32_t i = 0; i < block.frame.node_count; i++) {
        patch.displacement[3 * i] = 3 + 1e-4 * patch.position[3 * i];
        patch.displacement[3 * i + 1] = -2e-4 * patch.position[3 * i + 1];
    }
    double factor = block_magnification(&block);   // 1.4e-4 moved at most, extent 0.87
    assert_true(factor == 200);
    block_deform(&block, factor);
    double middle = 0;
    for (int32_t i = 0; i < block.frame.node_count; i++) {
        middle += (block.place[i][0] - patch.position[3 * i]) / block.frame.node_count;
        assert_near("z", block.place[i][1], patch.position[3 * i + 1] * (1 - 0.04), 1e-12);
    }
    assert_near("mean x", middle, 0, 1e-10);
}

TEST(times_are_found)
{
    FieldTime stored[4] = {{.t = 0}, {.t = 10}, {.t = 20}, {.t = 40}};
    int64_t rows[4] = {0, 1, 2, 3};
    double U[4] = {0, 0.1, 0.2, 0.4}, t[4] = {0, 10, 20, 40};
    ResultView view = {.U = U, .t = t, .rows = 4};
    const BlockSource source = {.view = &view, .count = 4, .times = stored, .row = rows};
    const struct {
        const char *at;
        int32_t index;
    } good[] = {{"U=0.14", 1}, {"U=0.403", 3}, {"t=31", 3}, {"t=-0.1", 0}};
    const char *const bad[] = {"0.1", "U=", "U=x", "t=1 s", "u=1", "U=nan", "U=1", "t=-5"};
    int32_t index = -1;
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        Error err = {0};
        assert_true(block_time_find(&source, good[k].at, &index, &err));
        assert_int_equal(index, good[k].index);
    }
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        Error err = {0};
        assert_false(block_time_find(&source, bad[k], &index, &err));
        assert_int_equal(err.code, ERROR_INPUT);
    }
    assert_int_equal(block_time_before(&source, 0.3), 2);
    assert_int_equal(block_time_before(&source, -1), 0);
}
