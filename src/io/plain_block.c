// SPDX-License-Identifier: GPL-2.0-or-later
// gmsh does not place the nodes of a curve at k / n of it: it integrates the curve's slope, which
// it takes from differences, and looks up where the integral has grown by another n-th. So they lie
// some 1e-12 of the length beside. The same steps are done here in the same order, since a mesh has
// to have the same bits whichever way it was made. Nodes inside are transfinite interpolation:
//
//     4 ---- top ---- 3      x = (1 - u) x_rod + u x_leading + (1 - v) x_contact + v x_top
//    rod   column i leading        - the same of the corners;  z alike
//     1 -- contact -- 2      u, v: the lengths of contact and leading face up to there, over all
#include "io/plain_block.h"

#include "base/memory.h"
#include "io/mesh_source.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double EXTENT_MIN = 1e-6, EXTENT_MAX = 1e6, CELLS_MAX = 1e7;

// The meshes/block.geo that this file knows, by mesh_source_hash. One that was edited is meshed by
// gmsh, and the test io.plain_block fails with its hash: written here, the test compares again.
static const char BLOCK_GEO[] = "662d0bfffc337430667dbc9046a0caa3";

// --- what is asked for --------------------------------------------------------------------------

typedef struct PlainBlock {
    double length, height;
    double nx, nz;   // cells, whole numbers, `refine` in them
    double refine;
} PlainBlock;

// The defaults of meshes/block.geo.
static const PlainBlock DEFAULTS = {.length = 1, .height = 0.5, .nx = 40, .nz = 40, .refine = 1};

// What a plain block has beside: these may be given, but not otherwise.
static const MeshParameter PLAIN[] = {
    {.name = "shape", .text = "quad"}, {.name = "layout", .text = "regular"},
    {.name = "order", .value = 1},     {.name = "incomplete", .value = 0},
    {.name = "crown", .value = 0},     {.name = "edge_radius", .value = 0},
    {.name = "grade_x", .value = 1},   {.name = "grade_z", .value = 1}};

static bool is_plain(const MeshParameter *given)
{
    for (size_t k = 0; k < sizeof PLAIN / sizeof PLAIN[0]; k++)
        if (strcmp(given->name, PLAIN[k].name) == 0)
            return strcmp(given->text, PLAIN[k].text) == 0 && given->value == PLAIN[k].value;
    return false;
}

static double *number_of(const char *name, PlainBlock *block)
{
    if (strcmp(name, "length") == 0) return &block->length;
    if (strcmp(name, "height") == 0) return &block->height;
    if (strcmp(name, "nx") == 0) return &block->nx;
    if (strcmp(name, "nz") == 0) return &block->nz;
    if (strcmp(name, "refine") == 0) return &block->refine;
    return NULL;
}

static double refined(double cells, double refine)
{
    return refine * cells < 1 ? 1 : floor(refine * cells + 0.5);
}

// false: not plain, or not allowed.
static bool read_parameters(const MeshParameter *parameters, int32_t count, PlainBlock *block)
{
    *block = DEFAULTS;
    for (int32_t k = 0; k < count; k++) {
        double *number = number_of(parameters[k].name, block);
        if (number)
            *number = parameters[k].value;
        else if (!is_plain(&parameters[k]))
            return false;
    }
    bool whole = floor(block->nx) == block->nx && floor(block->nz) == block->nz;
    if (!whole || !(block->nx >= 1 && block->nz >= 1 && block->refine > 0)) return false;
    block->nx = refined(block->nx, block->refine);
    block->nz = refined(block->nz, block->refine);
    return block->length >= EXTENT_MIN && block->length <= EXTENT_MAX &&
           block->height >= EXTENT_MIN && block->height <= EXTENT_MAX &&
           block->nx * block->nz <= CELLS_MAX;
}

// --- the curves ---------------------------------------------------------------------------------

// gmsh halves the curve so often at least, and an even one not more often. SLOPE_STEP: half of what
// its slope is a difference over, in units of the curve.
enum { PARTS = 128 };
static const double SLOPE_STEP = 1e-5;

typedef struct Course {
    double slope[PARTS + 1];   // d/dt of what is integrated, at t = k / PARTS
    double integral[PARTS + 1];   // from 0 to there
} Course;

static double point_at(double from, double to, double t)
{
    return from + t * (to - from);
}

static double slope_at(double from, double to, double t)
{
    double before = t < SLOPE_STEP ? 0 : SLOPE_STEP, behind = t > 1 - SLOPE_STEP ? 0 : SLOPE_STEP;
    return fabs((point_at(from, to, t + behind) - point_at(from, to, t - before)) /
                (before + behind));
}

static void integrate(Course *course)
{
    course->integral[0] = 0;
    for (int32_t k = 0; k < PARTS; k++)
        course->integral[k + 1] = course->integral[k] +
                                  0.5 * (course->slope[k] + course->slope[k + 1]) * (1.0 / PARTS);
}

// Nodes at[0] = from ... at[cells] = to.
static void place_nodes(double from, double to, int32_t cells, double *at)
{
    Course course;
    for (int32_t k = 0; k <= PARTS; k++) course.slope[k] = slope_at(from, to, k * (1.0 / PARTS));
    integrate(&course);
    double length = course.integral[PARTS];
    for (int32_t k = 0; k <= PARTS; k++) course.slope[k] /= length;
    integrate(&course);
    double share = course.integral[PARTS] / cells;
    at[0] = from;
    at[cells] = to;
    for (int32_t k = 1, part = 0; k < cells; k++) {
        double wanted = k * share;
        while (course.integral[part + 1] < wanted) part++;
        double rise = course.integral[part + 1] - course.integral[part];
        at[k] = point_at(
            from, to, part * (1.0 / PARTS) + 1.0 / PARTS / rise * (wanted - course.integral[part]));
    }
}

// --- nodes --------------------------------------------------------------------------------------

// Curves as the .geo has them, around the block: contact, leading face, top, rod. Curve c leads
// from corner c to corner c + 1. gmsh numbers corners first, then along curves, then by columns.
enum { CURVES = 4 };

typedef struct Grid {
    int32_t cells[CURVES];   // of each curve: nx, nz, nx, nz
    int32_t first[CURVES + 1];   // the first node between its ends; [CURVES]: the first one inside
    double axis[2];   // gmsh's, along x and z
    double *position;   // [node_count * 2] of the mesh; not owned
} Grid;

static Grid grid_of(const PlainBlock *block)
{
    int32_t nx = (int32_t)block->nx, nz = (int32_t)block->nz;
    Grid grid = {.cells = {nx, nz, nx, nz}, .first = {CURVES}};
    for (int32_t c = 0; c < CURVES; c++) grid.first[c + 1] = grid.first[c] + grid.cells[c] - 1;
    return grid;
}

static int32_t curve_node(const Grid *grid, int32_t curve, int32_t k)
{
    if (k == 0) return curve;
    return k == grid->cells[curve] ? (curve + 1) % CURVES : grid->first[curve] + k - 1;
}

// Column i, row j.
static int32_t grid_node(const Grid *grid, int32_t i, int32_t j)
{
    int32_t nx = grid->cells[0], nz = grid->cells[1];
    if (j == 0) return curve_node(grid, 0, i);
    if (i == nx) return curve_node(grid, 1, j);
    if (j == nz) return curve_node(grid, 2, nx - i);
    if (i == 0) return curve_node(grid, 3, nz - j);
    return grid->first[CURVES] + (i - 1) * (nz - 1) + j - 1;
}

// Along each curve one coordinate grows or falls, the other stays.
static bool place_curves(const PlainBlock *block, const Grid *grid, Error *err)
{
    const double corner[CURVES + 1][2] = {
        {0, 0}, {block->length, 0}, {block->length, block->height}, {0, block->height}, {0, 0}};
    int32_t most = grid->cells[0] > grid->cells[1] ? grid->cells[0] : grid->cells[1];
    double *at = NEW_ARRAY(double, most + 1, err);
    for (int32_t c = 0; at && c < CURVES; c++) {
        int32_t along = c % 2;
        place_nodes(corner[c][along], corner[c + 1][along], grid->cells[c], at);
        for (int32_t k = 0; k < grid->cells[c]; k++) {
            double *position = grid->position + 2 * curve_node(grid, c, k);
            position[along] = at[k];
            position[1 - along] = corner[c][1 - along];
        }
    }
    memory_free(at);
    return at != NULL;
}

// share[k]: how much of curve 0 or 1 lies before its node k, of 1.
static void list_shares(const Grid *grid, int32_t curve, double *share)
{
    int32_t cells = grid->cells[curve];
    share[0] = 0;
    for (int32_t k = 0; k < cells; k++)
        share[k + 1] = share[k] + fabs(grid->position[2 * curve_node(grid, curve, k) + curve] -
                                       grid->position[2 * curve_node(grid, curve, k + 1) + curve]);
    for (int32_t k = 1; k < cells; k++) share[k] /= share[cells];
}

// gmsh interpolates coordinates along two axes whose lengths are 1 but for rounding: it makes them
// unit vectors by products with 1 / length, from the normal of three points of the curves. In a
// block so small that a normal is below 1e-4 times the diagonal of a cube of side 2 (which stands
// for a model that was not measured yet) it takes the next points, at last singular values, which
// give 1.
static void measure_axes(const PlainBlock *block, double axis[2])
{
    static const double parts[] = {0.333, 0.666, 1};   // of the height, where the third point is
    double least = sqrt(1e-8) * sqrt(12);
    axis[0] = axis[1] = 1;
    for (int32_t k = 0; k < 3; k++) {
        double base = 0.666 * block->length - 0.333 * block->length;
        double normal = base * (parts[k] * block->height);
        if (!(normal > least)) continue;
        axis[1] = normal * (1 / normal);
        axis[0] = axis[1] * normal * (1 / (axis[1] * normal));
        break;
    }
}

static void place_inside(const Grid *grid, int32_t i, int32_t j, double u, double v)
{
    int32_t nx = grid->cells[0], nz = grid->cells[1];
    const double *p = grid->position;
    for (int32_t d = 0; d < 2; d++) {
        double a = grid->axis[d];
        double contact = a * p[2 * curve_node(grid, 0, i) + d];
        double leading = a * p[2 * curve_node(grid, 1, j) + d];
        double top = a * p[2 * curve_node(grid, 2, nx - i) + d];
        double rod = a * p[2 * curve_node(grid, 3, nz - j) + d];
        double between = (1 - u) * rod + u * leading + (1 - v) * contact + v * top -
                         ((1 - u) * (1 - v) * (a * p[d]) + u * (1 - v) * (a * p[2 + d]) +
                          u * v * (a * p[4 + d]) + (1 - u) * v * (a * p[6 + d]));
        grid->position[2 * grid_node(grid, i, j) + d] = a * between;
    }
}

static bool place_all(const PlainBlock *block, const Grid *grid, Error *err)
{
    int32_t nx = grid->cells[0], nz = grid->cells[1];
    double *u = NEW_ARRAY(double, nx + 1, err), *v = NEW_ARRAY(double, nz + 1, err);
    TRY(u && v && place_curves(block, grid, err));
    list_shares(grid, 0, u);
    list_shares(grid, 1, v);
    for (int32_t i = 1; i < nx; i++)
        for (int32_t j = 1; j < nz; j++) place_inside(grid, i, j, u[i], v[j]);
cleanup:
    memory_free(u);
    memory_free(v);
    return error_is_clean(err);
}

// --- elements and groups ------------------------------------------------------------------------

// Column by column; gmsh numbers the edges of the curves before them.
static void list_elements(const Grid *grid, MeshFile *mesh)
{
    int32_t nx = grid->cells[0], nz = grid->cells[1], e = 0;
    for (int32_t i = 0; i < nx; i++)
        for (int32_t j = 0; j < nz; j++, e++) {
            int32_t *nodes = mesh->element_nodes + (size_t)4 * (size_t)e;
            nodes[0] = grid_node(grid, i, j);
            nodes[1] = grid_node(grid, i + 1, j);
            nodes[2] = grid_node(grid, i + 1, j + 1);
            nodes[3] = grid_node(grid, i, j + 1);
            mesh->kind[e] = ELEMENT_Q4;
            mesh->first_node[e + 1] = 4 * (e + 1);
            mesh->element_number[e] = 2 * ((int64_t)nx + nz) + e + 1;
        }
}

static bool fill_curve(const Grid *grid, int32_t curve, MeshGroup *group, Error *err)
{
    int32_t cells = grid->cells[curve], other = (curve + 1) % CURVES;
    TRY((group->edge_nodes = NEW_ARRAY(int32_t, 2 * (int64_t)cells, err)));
    TRY((group->nodes = NEW_ARRAY(int32_t, (int64_t)cells + 1, err)));
    group->edge_count = cells;
    group->nodes_per_edge = 2;
    group->node_count = cells + 1;
    for (int32_t k = 0; k < cells; k++) {
        group->edge_nodes[2 * k] = curve_node(grid, curve, k);
        group->edge_nodes[2 * k + 1] = curve_node(grid, curve, k + 1);
    }
    group->nodes[0] = curve < other ? curve : other;
    group->nodes[1] = curve < other ? other : curve;
    for (int32_t k = 1; k < cells; k++) group->nodes[k + 1] = curve_node(grid, curve, k);
cleanup:
    return error_is_clean(err);
}

// In the order of io/mesh_file.h; gmsh gives the first number to the body.
static bool list_groups(const Grid *grid, MeshFile *mesh, Error *err)
{
    static const char *const names[CURVES] = {"contact", "leading", "top", "rod"};
    TRY((mesh->groups = NEW_ARRAY(MeshGroup, CURVES + 1, err)));
    mesh->group_count = CURVES + 1;
    for (int32_t c = 0; c < CURVES; c++) {
        MeshGroup *group = &mesh->groups[c];
        *group = (MeshGroup){.dimension = 1, .number = c + 2};
        snprintf(group->name, sizeof group->name, "%s", names[c]);
        TRY(fill_curve(grid, c, group, err));
    }
    MeshGroup *body = &mesh->groups[CURVES];
    *body = (MeshGroup){.name = "body", .dimension = 2, .number = 1};
    TRY((body->elements = NEW_ARRAY(int32_t, mesh->element_count, err)));
    body->element_count = mesh->element_count;
    for (int32_t e = 0; e < mesh->element_count; e++) body->elements[e] = e;
cleanup:
    return error_is_clean(err);
}

static bool make_block(const PlainBlock *block, MeshFile *mesh, Error *err)
{
    Grid grid = grid_of(block);
    int32_t nx = grid.cells[0], nz = grid.cells[1];
    int64_t nodes = ((int64_t)nx + 1) * (nz + 1), elements = (int64_t)nx * nz;
    TRY((mesh->position = NEW_ARRAY(double, 2 * nodes, err)));
    TRY((mesh->node_number = NEW_ARRAY(int64_t, nodes, err)));
    TRY((mesh->element_number = NEW_ARRAY(int64_t, elements, err)));
    TRY((mesh->kind = NEW_ARRAY(uint8_t, elements, err)));
    TRY((mesh->first_node = NEW_ARRAY(int32_t, elements + 1, err)));
    TRY((mesh->element_nodes = NEW_ARRAY(int32_t, 4 * elements, err)));
    mesh->origin = MESH_OF_ROWS;
    mesh->node_count = (int32_t)nodes;
    mesh->element_count = (int32_t)elements;
    for (int32_t k = 0; k < mesh->node_count; k++) mesh->node_number[k] = k + 1;
    grid.position = mesh->position;
    measure_axes(block, grid.axis);
    TRY(place_all(block, &grid, err));
    list_elements(&grid, mesh);
    TRY(list_groups(&grid, mesh, err));
cleanup:
    return error_is_clean(err);
}

static bool is_block_geo(const char *path, bool *is, Error *err)
{
    char text[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    bool whole = false;
    TRY(mesh_source_hash(path, NULL, 0, &hash, &whole, err));
    hash_write(&hash, text);
    *is = whole && strcmp(text, BLOCK_GEO) == 0;
cleanup:
    return error_is_clean(err);
}

bool plain_block_make(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                      MeshFile *mesh, bool *made, Error *err)
{
    PlainBlock block;
    *made = false;
    if (!read_parameters(parameters, parameter_count, &block)) return true;
    TRY(is_block_geo(path, made, err));
    if (*made) TRY(make_block(&block, mesh, err));
cleanup:
    return error_is_clean(err);
}
