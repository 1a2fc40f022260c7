// SPDX-License-Identifier: GPL-2.0-or-later
// Nodes of a patch's sides are those of its curves; inside is transfinite interpolation:
//
//     4 ---- above --- 3     x = (1 - u) x_left + u x_right + (1 - v) x_below + v x_above
//    left   column i  right        - the same of the corners;  z alike
//     1 ---- below --- 2     u, v: the lengths of the sides below and right up to there, over all
//
// gmsh numbers points first, then the nodes inside of curves, then those inside of patches, column
// by column; of elements those of curves that are in a group, then those of patches.
#include "io/plain_model.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double EXTENT_MAX = 1e6;

enum { BELOW, RIGHT, ABOVE, LEFT };

typedef struct Layout {
    const PlainModel *model;
    int32_t *inside_curve;   // [curve_count] the first node between a curve's ends; owned
    int32_t *inside_patch;   // [patch_count] the first node inside a patch; owned
    int32_t node_count, element_count;
    int32_t most_cells, most_nodes;   // of a curve; of a patch with its sides
} Layout;

// The nodes of one patch: at(grid, i, j) in column i and row j.
typedef struct Grid {
    int32_t columns, rows;
    int32_t *node;   // [(columns + 1) * (rows + 1)] column by column; owned
} Grid;

static int32_t at(const Grid *grid, int32_t i, int32_t j)
{
    return grid->node[(int64_t)i * (grid->rows + 1) + j];
}

// --- the model ----------------------------------------------------------------------------------

bool plain_model_create(int32_t points, int32_t curves, int32_t patches, int32_t groups,
                        PlainModel *model, Error *err)
{
    *model = (PlainModel){.point_count = points,
                          .curve_count = curves,
                          .patch_count = patches,
                          .group_count = groups};
    TRY((model->point = memory_array(points, sizeof *model->point, err)));
    TRY((model->curve = NEW_ARRAY(PlainCurve, curves, err)));
    TRY((model->patch = NEW_ARRAY(PlainPatch, patches, err)));
    TRY((model->group = NEW_ARRAY(PlainGroup, groups, err)));
cleanup:
    return error_is_clean(err);
}

void plain_model_destroy(PlainModel *model)
{
    memory_free(model->point);
    memory_free(model->curve);
    memory_free(model->patch);
    memory_free(model->group);
    *model = (PlainModel){0};
}

bool plain_take(const MeshParameter *given, int32_t given_count, MeshParameter *known,
                int32_t known_count)
{
    for (int32_t k = 0; k < given_count; k++) {
        int32_t at = 0;
        while (at < known_count && strcmp(known[at].name, given[k].name) != 0) at++;
        if (at == known_count || !known[at].text[0] != !given[k].text[0]) return false;
        known[at] = given[k];
    }
    return true;
}

bool plain_unchanged(const MeshParameter *known, const MeshParameter *defaults, int32_t first,
                     int32_t end)
{
    for (int32_t k = first; k < end; k++)
        if (known[k].value != defaults[k].value || strcmp(known[k].text, defaults[k].text) != 0)
            return false;
    return true;
}

double plain_refined(double cells, double refine)
{
    return refine * cells < 1 ? 1 : floor(refine * cells + 0.5);
}

bool plain_is_extent(double length)
{
    return length >= PLAIN_EXTENT_MIN && length <= EXTENT_MAX;
}

// --- numbers ------------------------------------------------------------------------------------

static const PlainCurve *side_curve(const PlainModel *model, int32_t patch, int32_t side)
{
    return &model->curve[model->patch[patch].side[side]];
}

static int32_t columns_of(const PlainModel *model, int32_t patch)
{
    return side_curve(model, patch, BELOW)->spacing.cells;
}

static int32_t rows_of(const PlainModel *model, int32_t patch)
{
    return side_curve(model, patch, RIGHT)->spacing.cells;
}

static int32_t curve_node(const Layout *layout, int32_t curve, int32_t k)
{
    const PlainCurve *of = &layout->model->curve[curve];
    if (k == 0) return of->point[0];
    return k == of->spacing.cells ? of->point[1] : layout->inside_curve[curve] + k - 1;
}

// The side's k-th node to the right or upwards, whichever way its curve runs.
static int32_t side_node(const Layout *layout, int32_t patch, int32_t side, int32_t k)
{
    const PlainModel *model = layout->model;
    const PlainCurve *curve = side_curve(model, patch, side);
    int32_t axis = side % 2;
    bool back = model->point[curve->point[1]][axis] < model->point[curve->point[0]][axis];
    return curve_node(layout, model->patch[patch].side[side], back ? curve->spacing.cells - k : k);
}

static void fill_grid(const Layout *layout, int32_t patch, Grid *grid)
{
    int32_t columns = columns_of(layout->model, patch), rows = rows_of(layout->model, patch);
    int32_t *node = grid->node, inside = layout->inside_patch[patch];
    *grid = (Grid){.columns = columns, .rows = rows, .node = node};
    for (int32_t j = 0; j <= rows; j++) *node++ = side_node(layout, patch, LEFT, j);
    for (int32_t i = 1; i < columns; i++) {
        *node++ = side_node(layout, patch, BELOW, i);
        for (int32_t j = 1; j < rows; j++) *node++ = inside++;
        *node++ = side_node(layout, patch, ABOVE, i);
    }
    for (int32_t j = 0; j <= rows; j++) *node++ = side_node(layout, patch, RIGHT, j);
}

static void layout_destroy(Layout *layout)
{
    memory_free(layout->inside_curve);
    memory_free(layout->inside_patch);
}

static bool number_nodes(const PlainModel *model, Layout *layout, Error *err)
{
    int32_t next = model->point_count;
    *layout = (Layout){.model = model};
    TRY((layout->inside_curve = NEW_ARRAY(int32_t, model->curve_count, err)));
    TRY((layout->inside_patch = NEW_ARRAY(int32_t, model->patch_count, err)));
    for (int32_t c = 0; c < model->curve_count; c++) {
        int32_t cells = model->curve[c].spacing.cells;
        layout->inside_curve[c] = next;
        next += cells - 1;
        if (cells > layout->most_cells) layout->most_cells = cells;
    }
    for (int32_t p = 0; p < model->patch_count; p++) {
        int32_t columns = columns_of(model, p), rows = rows_of(model, p);
        int32_t nodes = (columns + 1) * (rows + 1);
        layout->inside_patch[p] = next;
        next += (columns - 1) * (rows - 1);
        layout->element_count += columns * rows;
        if (nodes > layout->most_nodes) layout->most_nodes = nodes;
    }
    layout->node_count = next;
cleanup:
    return error_is_clean(err);
}

// --- positions ----------------------------------------------------------------------------------

static bool is_same(const CurveSpacing *one, const CurveSpacing *other)
{
    return one->cells == other->cells && one->law == other->law && one->ratio == other->ratio;
}

// Along each curve one coordinate grows or falls, the other stays. Neighbours that go the same way
// between the same ends (up the block) have their nodes in common.
static bool place_curves(const Layout *layout, double *along, double *position, Error *err)
{
    const PlainModel *model = layout->model;
    double ends[2] = {NAN, NAN};
    for (int32_t c = 0; c < model->curve_count; c++) {
        const PlainCurve *curve = &model->curve[c];
        const double *from = model->point[curve->point[0]], *to = model->point[curve->point[1]];
        int32_t axis = from[0] == to[0] ? 1 : 0;
        bool known = from[axis] == ends[0] && to[axis] == ends[1] &&
                     is_same(&curve->spacing, &curve[-1].spacing);
        if (!known) TRY(curve_place_nodes(from[axis], to[axis], &curve->spacing, along, err));
        ends[0] = from[axis];
        ends[1] = to[axis];
        for (int32_t k = 0; k <= curve->spacing.cells; k++) {
            double *node = position + 2 * (int64_t)curve_node(layout, c, k);
            node[axis] = along[k];
            node[1 - axis] = from[1 - axis];
        }
    }
cleanup:
    return error_is_clean(err);
}

// u[i], v[j]: how much of the sides below and right lies before column i and row j, of 1.
static void list_shares(const Grid *grid, const double *position, double *u, double *v)
{
    u[0] = v[0] = 0;
    for (int32_t i = 0; i < grid->columns; i++)
        u[i + 1] = u[i] + fabs(position[2 * at(grid, i, 0)] - position[2 * at(grid, i + 1, 0)]);
    for (int32_t j = 0; j < grid->rows; j++)
        v[j + 1] = v[j] + fabs(position[2 * at(grid, grid->columns, j) + 1] -
                               position[2 * at(grid, grid->columns, j + 1) + 1]);
    for (int32_t i = 1; i < grid->columns; i++) u[i] /= u[grid->columns];
    for (int32_t j = 1; j < grid->rows; j++) v[j] /= v[grid->rows];
}

// gmsh interpolates coordinates along two axes whose lengths are 1 but for rounding: it makes them
// unit vectors by products with 1 / length, from the normal of three points of the sides, at 0.333
// and 0.666 of each. Where a normal is below 1e-4 times the diagonal of a cube of side 2 (which
// stands for a model that was not measured yet) it takes the next points, at last singular values,
// which give 1.
static void measure_axes(const PlainModel *model, int32_t patch, double axis[2])
{
    static const double parts[] = {0.333, 0.666};
    double least = sqrt(1e-8) * sqrt(12), first[2] = {0}, along[2] = {0};
    axis[0] = axis[1] = 1;
    for (int32_t k = 0; k < 2 * PATCH_SIDES; k++) {
        const PlainCurve *curve = side_curve(model, patch, k / 2);
        const double *from = model->point[curve->point[0]], *to = model->point[curve->point[1]];
        double off[2], *into = k == 0 ? first : k == 1 ? along : off;
        for (int32_t d = 0; d < 2; d++)
            into[d] = from[d] + parts[k % 2] * (to[d] - from[d]) - (k ? first[d] : 0);
        if (k < 2) continue;
        double normal = along[0] * off[1] - along[1] * off[0];
        if (!(normal > least)) continue;
        axis[1] = normal * (1 / normal);
        axis[0] = axis[1] * normal * (1 / (axis[1] * normal));
        break;
    }
}

// Of the nodes inside, the coordinate d along an axis of length a.
static void interpolate(const Grid *grid, int32_t d, double a, const double *u, const double *v,
                        double *position)
{
    int32_t columns = grid->columns, rows = grid->rows;
    double corner[] = {
        a * position[2 * at(grid, 0, 0) + d], a * position[2 * at(grid, columns, 0) + d],
        a * position[2 * at(grid, columns, rows) + d], a * position[2 * at(grid, 0, rows) + d]};
    for (int32_t i = 1; i < columns; i++) {
        double below = a * position[2 * at(grid, i, 0) + d];
        double above = a * position[2 * at(grid, i, rows) + d], s = u[i];
        for (int32_t j = 1; j < rows; j++) {
            double left = a * position[2 * at(grid, 0, j) + d];
            double right = a * position[2 * at(grid, columns, j) + d], t = v[j];
            double between = (1 - s) * left + s * right + (1 - t) * below + t * above -
                             ((1 - s) * (1 - t) * corner[0] + s * (1 - t) * corner[1] +
                              s * t * corner[2] + (1 - s) * t * corner[3]);
            position[2 * at(grid, i, j) + d] = a * between;
        }
    }
}

// --- elements and groups ------------------------------------------------------------------------

static int64_t count_edges(const PlainModel *model)
{
    int64_t edges = 0;
    for (int32_t g = 0; g < model->group_count; g++)
        for (int32_t k = 0; model->group[g].dimension == 1 && k < model->group[g].count; k++)
            edges += model->curve[model->group[g].first + k].spacing.cells;
    return edges;
}

// before: edges in groups, which gmsh numbers first. *e: the elements of the patches before.
static void list_elements(const Grid *grid, int64_t before, MeshFile *mesh, int32_t *e)
{
    for (int32_t i = 0; i < grid->columns; i++)
        for (int32_t j = 0; j < grid->rows; j++, (*e)++) {
            int32_t *nodes = mesh->element_nodes + 4 * (int64_t)*e;
            nodes[0] = at(grid, i, j);
            nodes[1] = at(grid, i + 1, j);
            nodes[2] = at(grid, i + 1, j + 1);
            nodes[3] = at(grid, i, j + 1);
            mesh->kind[*e] = ELEMENT_Q4;
            mesh->first_node[*e + 1] = 4 * (*e + 1);
            mesh->element_number[*e] = before + *e + 1;
        }
}

static bool fill_mesh(const Layout *layout, MeshFile *mesh, Error *err)
{
    const PlainModel *model = layout->model;
    Grid grid = {.node = NEW_ARRAY(int32_t, layout->most_nodes, err)};
    double *u = NEW_ARRAY(double, layout->most_cells + 1, err);
    double *v = NEW_ARRAY(double, layout->most_cells + 1, err), axis[2];
    int64_t edges = count_edges(model);
    TRY(grid.node && u && v && place_curves(layout, u, mesh->position, err));
    for (int32_t p = 0, e = 0; p < model->patch_count; p++) {
        fill_grid(layout, p, &grid);
        list_shares(&grid, mesh->position, u, v);
        measure_axes(model, p, axis);
        for (int32_t d = 0; d < 2; d++) interpolate(&grid, d, axis[d], u, v, mesh->position);
        list_elements(&grid, edges, mesh, &e);
    }
cleanup:
    memory_free(grid.node);
    memory_free(u);
    memory_free(v);
    return error_is_clean(err);
}

static int32_t patch_cells(const PlainModel *model, int32_t patch)
{
    return columns_of(model, patch) * rows_of(model, patch);
}

static bool fill_patches(const PlainModel *model, const PlainGroup *from, MeshGroup *group,
                         Error *err)
{
    int32_t before = 0, count = 0;
    for (int32_t p = 0; p < from->first; p++) before += patch_cells(model, p);
    for (int32_t k = 0; k < from->count; k++) count += patch_cells(model, from->first + k);
    TRY((group->elements = NEW_ARRAY(int32_t, count, err)));
    group->element_count = count;
    for (int32_t k = 0; k < count; k++) group->elements[k] = before + k;
cleanup:
    return error_is_clean(err);
}

// Points ascend already where a group's curves follow each other; else their two are exchanged.
static bool fill_curves(const Layout *layout, const PlainGroup *from, MeshGroup *group, Error *err)
{
    const PlainCurve *curves = layout->model->curve + from->first;
    int32_t edges = 0, ends = 0, inside = 0;
    for (int32_t c = 0; c < from->count; c++) edges += curves[c].spacing.cells;
    TRY((group->edge_nodes = NEW_ARRAY(int32_t, 2 * (int64_t)edges, err)));
    TRY((group->nodes = NEW_ARRAY(int32_t, (int64_t)edges + 1, err)));
    group->nodes_per_edge = 2;
    group->node_count = edges + 1;
    inside = from->count + 1;
    for (int32_t c = 0; c < from->count; c++)
        for (int32_t k = 0; k < curves[c].spacing.cells; k++) {
            int32_t *edge = group->edge_nodes + 2 * (int64_t)group->edge_count++;
            edge[0] = curve_node(layout, from->first + c, k);
            edge[1] = curve_node(layout, from->first + c, k + 1);
            group->nodes[k == 0 ? ends++ : inside++] = edge[0];
        }
    int32_t last = curves[from->count - 1].point[1], before = group->nodes[ends - 1];
    group->nodes[ends] = last > before ? last : before;
    if (last < before) group->nodes[ends - 1] = last;
cleanup:
    return error_is_clean(err);
}

static bool list_groups(const Layout *layout, MeshFile *mesh, Error *err)
{
    const PlainModel *model = layout->model;
    TRY((mesh->groups = NEW_ARRAY(MeshGroup, model->group_count, err)));
    mesh->group_count = model->group_count;
    for (int32_t g = 0; g < model->group_count; g++) {
        const PlainGroup *from = &model->group[g];
        MeshGroup *group = &mesh->groups[g];
        *group = (MeshGroup){.dimension = from->dimension, .number = from->number};
        snprintf(group->name, sizeof group->name, "%s", from->name);
        if (from->dimension == 1)
            TRY(fill_curves(layout, from, group, err));
        else
            TRY(fill_patches(model, from, group, err));
    }
cleanup:
    return error_is_clean(err);
}

bool plain_model_mesh(const PlainModel *model, MeshFile *mesh, Error *err)
{
    Layout layout;
    TRY(number_nodes(model, &layout, err));
    int64_t nodes = layout.node_count, elements = layout.element_count;
    TRY((mesh->position = NEW_ARRAY(double, 2 * nodes, err)));
    TRY((mesh->node_number = NEW_ARRAY(int64_t, nodes, err)));
    TRY((mesh->element_number = NEW_ARRAY(int64_t, elements, err)));
    TRY((mesh->kind = NEW_ARRAY(uint8_t, elements, err)));
    TRY((mesh->first_node = NEW_ARRAY(int32_t, elements + 1, err)));
    TRY((mesh->element_nodes = NEW_ARRAY(int32_t, 4 * elements, err)));
    mesh->origin = MESH_OF_ROWS;
    mesh->node_count = layout.node_count;
    mesh->element_count = layout.element_count;
    for (int32_t k = 0; k < mesh->node_count; k++) mesh->node_number[k] = k + 1;
    TRY(fill_mesh(&layout, mesh, err));
    TRY(list_groups(&layout, mesh, err));
cleanup:
    layout_destroy(&layout);
    return error_is_clean(err);
}
