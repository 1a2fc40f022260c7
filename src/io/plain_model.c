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

enum { BELOW, RIGHT, ABOVE, LEFT };

typedef struct Layout {
    const PlainModel *model;
    int32_t *inside_curve;   // [curve_count + 1] the first node between a curve's ends; owned
    int32_t *inside_patch;   // [patch_count + 1] the first node inside a patch; owned
    int32_t most_cells;   // of a curve
    double *position;   // [node_count * 2] of the mesh; not owned
} Layout;

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

// 0: the curve runs along x, 1: along z.
static int32_t axis_of(const PlainModel *model, const PlainCurve *curve)
{
    return model->point[curve->point[0]][0] == model->point[curve->point[1]][0] ? 1 : 0;
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

// Column i, row j of a patch.
static int32_t patch_node(const Layout *layout, int32_t patch, int32_t i, int32_t j)
{
    int32_t columns = columns_of(layout->model, patch), rows = rows_of(layout->model, patch);
    if (j == 0) return side_node(layout, patch, BELOW, i);
    if (i == columns) return side_node(layout, patch, RIGHT, j);
    if (j == rows) return side_node(layout, patch, ABOVE, i);
    if (i == 0) return side_node(layout, patch, LEFT, j);
    return layout->inside_patch[patch] + (i - 1) * (rows - 1) + j - 1;
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
    TRY((layout->inside_curve = NEW_ARRAY(int32_t, model->curve_count + 1, err)));
    TRY((layout->inside_patch = NEW_ARRAY(int32_t, model->patch_count + 1, err)));
    for (int32_t c = 0; c < model->curve_count; c++) {
        int32_t cells = model->curve[c].spacing.cells;
        layout->inside_curve[c] = next;
        next += cells - 1;
        if (cells > layout->most_cells) layout->most_cells = cells;
    }
    layout->inside_curve[model->curve_count] = next;
    for (int32_t p = 0; p < model->patch_count; p++) {
        layout->inside_patch[p] = next;
        next += (columns_of(model, p) - 1) * (rows_of(model, p) - 1);
    }
    layout->inside_patch[model->patch_count] = next;
cleanup:
    return error_is_clean(err);
}

// --- positions ----------------------------------------------------------------------------------

// Along each curve one coordinate grows or falls, the other stays.
static bool place_curves(const Layout *layout, double *at, Error *err)
{
    const PlainModel *model = layout->model;
    for (int32_t c = 0; c < model->curve_count; c++) {
        const PlainCurve *curve = &model->curve[c];
        const double *from = model->point[curve->point[0]], *to = model->point[curve->point[1]];
        int32_t axis = axis_of(model, curve);
        TRY(curve_place_nodes(from[axis], to[axis], &curve->spacing, at, err));
        for (int32_t k = 0; k <= curve->spacing.cells; k++) {
            double *position = layout->position + 2 * curve_node(layout, c, k);
            position[axis] = at[k];
            position[1 - axis] = from[1 - axis];
        }
    }
cleanup:
    return error_is_clean(err);
}

// share[k]: how much of a side below (0) or right (1) lies before its node k, of 1.
static void list_shares(const Layout *layout, int32_t patch, int32_t side, double *share)
{
    int32_t cells = side_curve(layout->model, patch, side)->spacing.cells;
    share[0] = 0;
    for (int32_t k = 0; k < cells; k++) {
        const double *p = layout->position + 2 * side_node(layout, patch, side, k) + side;
        const double *q = layout->position + 2 * side_node(layout, patch, side, k + 1) + side;
        share[k + 1] = share[k] + fabs(*p - *q);
    }
    for (int32_t k = 1; k < cells; k++) share[k] /= share[cells];
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

// The nodes of column i between its ends. axis: [2] of the patch.
static void place_column(const Layout *layout, int32_t patch, int32_t i, double u, const double *v,
                         const double *axis)
{
    int32_t columns = columns_of(layout->model, patch), rows = rows_of(layout->model, patch);
    const double *at = layout->position;
    for (int32_t j = 1; j < rows; j++)
        for (int32_t d = 0; d < 2; d++) {
            double a = axis[d], w = v[j];
            double below = a * at[2 * patch_node(layout, patch, i, 0) + d];
            double right = a * at[2 * patch_node(layout, patch, columns, j) + d];
            double above = a * at[2 * patch_node(layout, patch, i, rows) + d];
            double left = a * at[2 * patch_node(layout, patch, 0, j) + d];
            double corner[] = {a * at[2 * patch_node(layout, patch, 0, 0) + d],
                               a * at[2 * patch_node(layout, patch, columns, 0) + d],
                               a * at[2 * patch_node(layout, patch, columns, rows) + d],
                               a * at[2 * patch_node(layout, patch, 0, rows) + d]};
            double between = (1 - u) * left + u * right + (1 - w) * below + w * above -
                             ((1 - u) * (1 - w) * corner[0] + u * (1 - w) * corner[1] +
                              u * w * corner[2] + (1 - u) * w * corner[3]);
            layout->position[2 * patch_node(layout, patch, i, j) + d] = a * between;
        }
}

static bool place_nodes(const Layout *layout, Error *err)
{
    const PlainModel *model = layout->model;
    double *u = NEW_ARRAY(double, layout->most_cells + 1, err);
    double *v = NEW_ARRAY(double, layout->most_cells + 1, err), axis[2];
    TRY(u && v && place_curves(layout, u, err));
    for (int32_t p = 0; p < model->patch_count; p++) {
        list_shares(layout, p, BELOW, u);
        list_shares(layout, p, RIGHT, v);
        measure_axes(model, p, axis);
        for (int32_t i = 1; i < columns_of(model, p); i++)
            place_column(layout, p, i, u[i], v, axis);
    }
cleanup:
    memory_free(u);
    memory_free(v);
    return error_is_clean(err);
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

static void list_elements(const Layout *layout, MeshFile *mesh)
{
    const PlainModel *model = layout->model;
    int64_t before = count_edges(model);
    int32_t e = 0;
    for (int32_t p = 0; p < model->patch_count; p++)
        for (int32_t i = 0; i < columns_of(model, p); i++)
            for (int32_t j = 0; j < rows_of(model, p); j++, e++) {
                int32_t *nodes = mesh->element_nodes + 4 * (int64_t)e;
                nodes[0] = patch_node(layout, p, i, j);
                nodes[1] = patch_node(layout, p, i + 1, j);
                nodes[2] = patch_node(layout, p, i + 1, j + 1);
                nodes[3] = patch_node(layout, p, i, j + 1);
                mesh->kind[e] = ELEMENT_Q4;
                mesh->first_node[e + 1] = 4 * (e + 1);
                mesh->element_number[e] = before + e + 1;
            }
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
    int32_t elements = 0;
    TRY(number_nodes(model, &layout, err));
    int32_t nodes = layout.inside_patch[model->patch_count];
    for (int32_t p = 0; p < model->patch_count; p++) elements += patch_cells(model, p);
    TRY((mesh->position = NEW_ARRAY(double, 2 * (int64_t)nodes, err)));
    TRY((mesh->node_number = NEW_ARRAY(int64_t, nodes, err)));
    TRY((mesh->element_number = NEW_ARRAY(int64_t, elements, err)));
    TRY((mesh->kind = NEW_ARRAY(uint8_t, elements, err)));
    TRY((mesh->first_node = NEW_ARRAY(int32_t, (int64_t)elements + 1, err)));
    TRY((mesh->element_nodes = NEW_ARRAY(int32_t, 4 * (int64_t)elements, err)));
    mesh->origin = MESH_OF_ROWS;
    mesh->node_count = nodes;
    mesh->element_count = elements;
    for (int32_t k = 0; k < nodes; k++) mesh->node_number[k] = k + 1;
    layout.position = mesh->position;
    TRY(place_nodes(&layout, err));
    list_elements(&layout, mesh);
    TRY(list_groups(&layout, mesh, err));
cleanup:
    layout_destroy(&layout);
    return error_is_clean(err);
}
