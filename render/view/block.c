// SPDX-License-Identifier: GPL-2.0-or-later
// Energies need strains, which are not stored: they are taken at the nodes of each element from the
// slopes of the shape functions, and the mean over the elements around a node is what it has, as
// fem/recovery does it for the stresses.
#include "render/view/block.h"

#include "base/memory.h"
#include "io/files/folder.h"
#include "io/mesh/shape_functions.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double FOLDED = 0.2;   // of an element's size at a corner that must be left when drawn
static const double MOMENT_SLACK = 0.01;   // of the history, by which a moment may be outside
static const double SHOWN = 0.05;   // largest drawn deformation over the block's larger extent

BlockWords block_words(BlockQuantity quantity)
{
    static const BlockWords words[BLOCK_QUANTITY_COUNT] = {
#define X(symbol, name, words, si, normalised) {name, words, si, normalised},
        BLOCK_QUANTITIES(X)
#undef X
    };
    return words[quantity];
}

bool block_quantity_find(const char *name, BlockQuantity *quantity, Error *err)
{
    char names[200] = "";
    *quantity = BLOCK_VON_MISES;
    if (!name) return true;
    for (int32_t k = 0; k < BLOCK_QUANTITY_COUNT; ++k) {
        *quantity = (BlockQuantity)k;
        if (strcmp(block_words(*quantity).name, name) == 0) return true;
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", k ? ", " : "",
                 block_words(*quantity).name);
    }
    return REFUSE(err, "there is no field called \"%.40s\"; known are: %s", name, names);
}

// --- times ---------------------------------------------------------------------------------------

bool block_is_stored(const char *folder)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/fields.pvd", folder);
    return access(path, R_OK) == 0;
}

bool block_source_open(BlockSource *source, Error *err)
{
    const ResultView *view = source->view;
    TRY(field_times_read(source->folder, &source->times, &source->count, err));
    TRY(source->row = NEW_ARRAY(int64_t, source->count, err));
    int64_t row = 0;
    for (int32_t k = 0; k < source->count; ++k) {
        double t = source->times[k].t;
        while (row + 1 < view->rows && fabs(view->t[row + 1] - t) <= fabs(view->t[row] - t)) ++row;
        source->row[k] = row;
    }
cleanup:
    if (!error_is_clean(err)) block_source_close(source);
    return error_is_clean(err);
}

void block_source_close(BlockSource *source)
{
    memory_free_all(source->times, source->row);
    *source = (BlockSource){0};
}

bool block_moment_read(const char *at, bool *is_U, double *value, Error *err)
{
    char *end = NULL;
    *is_U = strncmp(at, "U=", 2) == 0;
    bool known = *is_U || strncmp(at, "t=", 2) == 0;
    *value = known ? strtod(at + 2, &end) : NAN;
    if (!end || end == at + 2 || *end || !isfinite(*value))
        return REFUSE(err, "a time is given as U=0.0117 or t=120, not as \"%.40s\"", at);
    return true;
}

bool block_moment_seen(const ResultView *view, const char *at, bool *is_U, double *value,
                       Error *err)
{
    double low = view->t[0], high = view->t[view->rows - 1];
    if (!block_moment_read(at, is_U, value, err)) return false;
    if (*is_U) result_view_range(view, &low, &high);
    double slack = MOMENT_SLACK * (high - low);
    if (*value >= low - slack && *value <= high + slack) return true;
    return REFUSE(err, "%.40s is outside of the history, which goes from %.6g to %.6g", at, low,
                  high);
}

bool block_time_find(const BlockSource *source, const char *at, int32_t *index, Error *err)
{
    bool by_U = false;
    double wanted = 0, nearest = INFINITY;
    if (!block_moment_seen(source->view, at, &by_U, &wanted, err)) return false;
    for (int32_t k = 0; k < source->count; ++k) {
        double away = fabs((by_U ? source->view->U[source->row[k]] : source->times[k].t) - wanted);
        if (!(away < nearest)) continue;
        nearest = away;
        *index = k;
    }
    return true;
}

int32_t block_time_before(const BlockSource *source, double U)
{
    int32_t index = 0;
    for (int32_t k = 0; k < source->count; ++k)
        if (source->view->U[source->row[k]] <= U) index = k;
    return index;
}

static void frame_extent(const FieldFrame *frame, double low[3], double high[3])
{
    for (int32_t d = 0; d < 3; ++d) {
        low[d] = INFINITY;
        high[d] = -INFINITY;
        for (int64_t i = 0; i < frame->node_count; ++i) {
            low[d] = fmin(low[d], frame->position[3 * i + d]);
            high[d] = fmax(high[d], frame->position[3 * i + d]);
        }
    }
}

void block_destroy(Block *block)
{
    field_frame_destroy(&block->frame);
    memory_free_all(block->value, block->place, block->moved);
    *block = (Block){0};
}

// --- quantities ----------------------------------------------------------------------------------

// Axes that a strain or a stress belongs to, in the order of the arrays.
static const uint8_t strain_axes[2][6][2] = {{{0, 0}, {1, 1}, {0, 1}},
                                             {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

// factor * (stress less `other`) : strain of `vectors`, the mean over elements. other: NULL: 0.
static bool take_work(Block *block, const double *stress, const double *other,
                      const double *vectors, double factor, Error *err)
{
    const FieldFrame *frame = &block->frame;
    int32_t width = frame->stresses, dim = frame->dim;
    double *strain = NEW_ARRAY(double, (int64_t)width * frame->node_count, err);
    int32_t *shares = NEW_ARRAY(int32_t, frame->node_count, err);
    TRY(strain && shares);

    // The strain at the nodes of each element is added to theirs, shear twice.
    for (int32_t e = 0; e < frame->element_count; ++e) {
        const int32_t *nodes = frame->element_nodes + frame->first_node[e];
        ElementKind kind = (ElementKind)frame->kind[e];
        int32_t count = element_node_count(kind);
        MeshPlace position[ELEMENT_NODES_MAX], gradient[ELEMENT_NODES_MAX];
        for (int32_t a = 0; a < count; ++a)
            memcpy(position[a], frame->position + 3 * (int64_t)nodes[a], sizeof position[a]);
        for (int32_t at = 0; at < count; ++at) {
            double slope[3][3] = {{0}};   // of component, along axis
            ShapeValues shape = shape_at(kind, shape_node(kind, at));
            shape_gradients(kind, &shape, (const MeshPlace *)position, gradient);
            for (int32_t a = 0; a < count; ++a)
                for (int32_t d = 0; d < dim; ++d)
                    for (int32_t k = 0; k < dim; ++k)
                        slope[d][k] += gradient[a][k] * vectors[3 * (int64_t)nodes[a] + d];
            for (int32_t k = 0; k < width; ++k) {
                int32_t a = strain_axes[dim - 2][k][0], b = strain_axes[dim - 2][k][1];
                strain[(int64_t)width * nodes[at] + k] += a == b ? slope[a][a]
                                                                 : slope[a][b] + slope[b][a];
            }
            ++shares[nodes[at]];
        }
    }

    for (int64_t i = 0; i < frame->node_count; ++i) {
        double work = 0;
        for (int64_t k = width * i; k < width * (i + 1); ++k)
            work += (stress[k] - (other ? other[k] : 0)) * strain[k];
        block->value[i] = factor * work / fmax(shares[i], 1);
    }
cleanup:
    memory_free_all(strain, shares);
    return error_is_clean(err);
}

static double size_of(const double vector[3])
{
    return hypot(hypot(vector[0], vector[1]), vector[2]);
}

// Component (a, b) of stresses; axes 0 to 2 are x, y, z, of which the plane has no y.
static double stress_at(const FieldFrame *frame, const double *stress, int32_t a, int32_t b)
{
    int32_t plane = frame->dim == 2;
    for (int32_t k = 0; k < frame->stresses; ++k) {
        const uint8_t *axes = strain_axes[frame->dim - 2][k];
        if (axes[0] == a - (plane && a == 2) && axes[1] == b - (plane && b == 2)) return stress[k];
    }
    return 0;
}

bool block_take(Block *block, BlockQuantity quantity, Error *err)
{
    const FieldFrame *frame = &block->frame;
    int32_t dim = frame->dim;
    bool across = quantity == BLOCK_STRESS_YY || quantity == BLOCK_STRESS_XY ||
                  quantity == BLOCK_STRESS_YZ;
    if (across && dim == 2)
        return REFUSE(err, "%s is there in space only", block_words(quantity).name);
    if (quantity == BLOCK_ENERGY)
        return take_work(block, frame->stress_elastic, NULL, frame->displacement, 0.5, err);
    if (quantity == BLOCK_DISSIPATION)
        return take_work(block, frame->stress, frame->stress_elastic, frame->velocity, 1, err);
    for (int64_t i = 0; i < frame->node_count; ++i) {
        const double *stress = frame->stress + frame->stresses * i;
        double mean = 0;
        for (int32_t d = 0; d < dim; ++d) mean += stress[d] / dim;
        const double values[] = {[BLOCK_VON_MISES] = frame->von_mises[i],
                                 [BLOCK_STRESS_XX] = stress_at(frame, stress, 0, 0),
                                 [BLOCK_STRESS_YY] = stress_at(frame, stress, 1, 1),
                                 [BLOCK_STRESS_ZZ] = stress_at(frame, stress, 2, 2),
                                 [BLOCK_STRESS_XZ] = stress_at(frame, stress, 0, 2),
                                 [BLOCK_STRESS_XY] = stress_at(frame, stress, 0, 1),
                                 [BLOCK_STRESS_YZ] = stress_at(frame, stress, 1, 2),
                                 [BLOCK_PRESSURE] = -mean,
                                 [BLOCK_VELOCITY] = size_of(frame->velocity + 3 * i),
                                 [BLOCK_DISPLACEMENT] = size_of(frame->displacement + 3 * i)};
        block->value[i] = values[quantity];
    }
    return true;
}

bool block_read(const BlockSource *source, int32_t index, Block *block, Error *err)
{
    char path[PATH_MAX];
    *block = (Block){.t = source->times[index].t, .row = source->row[index]};
    block->U = source->view->U[block->row];
    snprintf(path, sizeof path, "%s/%s", source->folder, source->times[index].file);
    TRY(folder_check_inside(source->folder, source->times[index].file, err));
    TRY(field_frame_read(path, &block->frame, err));
    if (source->depth > 0) TRY(field_frame_crop(&block->frame, source->depth, err));
    TRY(block->value = NEW_ARRAY(double, block->frame.node_count, err));
    TRY(block->place = memory_array(block->frame.node_count, sizeof *block->place, err));
    if (block->frame.dim > 2) {
        TRY(block->moved = memory_array(block->frame.node_count, sizeof *block->moved, err));
        frame_extent(&block->frame, block->low, block->high);
        block->camera = camera_before(block->low, block->high);
    }
    block_deform(block, 0);
    TRY(block_take(block, source->quantity, err));
cleanup:
    if (!error_is_clean(err)) block_destroy(block);
    return error_is_clean(err);
}

// --- deformation ---------------------------------------------------------------------------------

static double mean_along_x(const FieldFrame *frame)
{
    double sum = 0;
    for (int64_t i = 0; i < frame->node_count; ++i) sum += frame->displacement[3 * i];
    return sum / frame->node_count;
}

// The determinant at a place of an element, deformed.
static double size_at(const FieldFrame *frame, int32_t e, const ShapeValues *shape,
                      double magnification)
{
    const int32_t *nodes = frame->element_nodes + frame->first_node[e];
    ElementKind kind = (ElementKind)frame->kind[e];
    MeshPlace place[ELEMENT_NODES_MAX];
    for (int32_t a = 0; a < element_node_count(kind); ++a)
        for (int32_t d = 0; d < frame->dim; ++d) {
            int64_t at = 3 * (int64_t)nodes[a] + d;
            place[a][d] = frame->position[at] + magnification * frame->displacement[at];
        }
    return shape_jacobian(kind, shape, (const MeshPlace *)place);
}

// True if an element drawn so would be thinner than FOLDED of what it is at a corner, or folded.
static bool deformation_folds(const FieldFrame *frame, double magnification)
{
    ShapeValues shape[ELEMENT_NODES_MAX];
    for (int32_t e = 0; e < frame->element_count; ++e) {
        ElementKind kind = (ElementKind)frame->kind[e];
        int32_t corners = element_corner_count(kind);
        for (int32_t k = 0; k < corners && (e == 0 || frame->kind[e - 1] != frame->kind[e]); ++k)
            shape[k] = shape_at(kind, shape_node(kind, k));
        for (int32_t k = 0; k < corners; ++k) {
            double before = size_at(frame, e, &shape[k], 0);
            double after = size_at(frame, e, &shape[k], magnification);
            if (!(after * before > FOLDED * before * before)) return true;
        }
    }
    return false;
}

// The largest number of 1, 2, 5, 10, ... with which the block moves by SHOWN of its extent at most,
// or the next smaller one with which nothing folds.
double block_magnification(const Block *block)
{
    static const double handy[] = {5, 2, 1};
    const FieldFrame *frame = &block->frame;
    double mean = mean_along_x(frame), moved = 0, low[3], high[3], extent = 0;
    frame_extent(frame, low, high);
    for (int32_t d = 0; d < frame->dim; ++d) {
        extent = fmax(extent, high[d] - low[d]);
        for (int64_t i = 0; i < frame->node_count; ++i)
            moved = fmax(moved, fabs(frame->displacement[3 * i + d] - (d == 0 ? mean : 0)));
    }
    double most = SHOWN * extent / moved;
    if (!(most > 1) || !isfinite(most)) return 1;
    double power = pow(10, floor(log10(most))), wanted = power;
    for (int32_t k = 2; k >= 0; --k)
        if (handy[k] * power <= most) wanted = handy[k] * power;
    while (wanted > 1 && deformation_folds(frame, wanted)) {
        power = pow(10, floor(log10(wanted) + 0.1));
        wanted = round(wanted / power) >= 5 ? 2 * power : wanted / 2;
    }
    return wanted;
}

// Finds where the camera sees a node that was moved.
static void see_node(Block *block, int64_t i)
{
    double seen[3];
    camera_see(&block->camera, block->moved[i], seen);
    block->place[i][0] = seen[0];
    block->place[i][1] = seen[1];
}

void block_mix(Block *block, const Block *other, double part)
{
    for (int64_t i = 0; i < block->frame.node_count; ++i) {
        double *to = block->moved ? block->moved[i] : block->place[i];
        const double *from = block->moved ? other->moved[i] : other->place[i];
        block->value[i] += part * (other->value[i] - block->value[i]);
        for (int32_t d = 0; d < block->frame.dim; ++d) to[d] += part * (from[d] - to[d]);
        if (block->moved) see_node(block, i);
    }
}

void block_deform(Block *block, double magnification)
{
    const FieldFrame *frame = &block->frame;
    double mean[3] = {mean_along_x(frame), 0, 0};
    for (int64_t i = 0; i < frame->node_count; ++i) {
        double *to = block->moved ? block->moved[i] : block->place[i];
        for (int32_t d = 0; d < frame->dim; ++d)
            to[d] = frame->position[3 * i + d] +
                    magnification * (frame->displacement[3 * i + d] - mean[d]);
        if (block->moved) see_node(block, i);
    }
}
