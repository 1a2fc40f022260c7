// SPDX-License-Identifier: GPL-2.0-or-later
// Nested dissection (George, SIAM J. Numer. Anal. 10, 1973): a set of points is cut in two by a
// plane, those of one half that have a neighbour in the other are eliminated last, and each half is
// cut in turn. Of the planes across the axes, each through the middle of the set, the one with the
// fewest such points is taken. On cubes of finite elements factors then have half of the entries
// that an order of minimum degree leaves, and take a third to a quarter of the operations; in the
// plane minimum degree is better.
//
// Unknowns at one place are one point. Points are sorted along each axis once; a cut keeps the
// order of these lists, so that no list is sorted again.
#include "algebra/sparse_order.h"

#include "base/memory.h"
#include "base/order.h"

#include <stdlib.h>
#include <string.h>

enum { AXES = 3, LEAF = 16 };   // a set of so few points is cut no further

// Coordinates that differ by less, of the whole extent, are one: planes of a grid stay whole.
static const double ALIKE = 1e-9;

typedef enum Side { FIRST, SECOND, SEPARATOR, SIDES } Side;

typedef struct Dissection {
    const SparsePattern *pattern;
    int32_t points;
    int32_t *first;   // [points + 1] of each point's unknowns in `unknown`; owned
    int32_t *unknown;   // [size] of the interior, those of a point together; owned
    int32_t *point;   // [size] of each unknown, -1: on the border; owned
    int32_t *rank[AXES];   // [points] place among the coordinates along an axis, the same for
        // equal ones; owned
    int32_t *sorted[AXES];   // [points] along an axis, those of a set together; owned
    int32_t *set;   // [points] number of the set that a point is in; owned
    int32_t sets;   // numbers given so far
    uint8_t *side;   // [points] Side of the cut at hand; owned
    int32_t *work;   // [points]; owned
    int32_t *order, ordered;   // [size] the result, and how many unknowns it has so far
} Dissection;

static void dissection_destroy(Dissection *cut)
{
    for (int axis = 0; axis < AXES; axis++) memory_free_all(cut->rank[axis], cut->sorted[axis]);
    memory_free_all(cut->first, cut->unknown, cut->point, cut->set, cut->side, cut->work);
}

typedef struct Coordinate {
    double at;   // first, as order_doubles sorts by it
    int32_t entry;   // of the list of unknowns
} Coordinate;

typedef struct Ranked {
    int32_t rank[AXES];   // that of the axis first
    int32_t which;   // unknown or point
} Ranked;

static int order_ranked(const void *left, const void *right)
{
    const Ranked *a = left, *b = right;
    for (int k = 0; k < AXES; k++)
        if (a->rank[k] != b->rank[k]) return a->rank[k] < b->rank[k] ? -1 : 1;
    return (a->which > b->which) - (a->which < b->which);
}

// Unknowns at one place become a point, and points are sorted along each axis.
static bool list_points(const double *place, Dissection *cut, Error *err)
{
    int32_t size = cut->pattern->size, inside = 0;
    Coordinate *along = NEW_ARRAY(Coordinate, size, err);
    Ranked *list = NEW_ARRAY(Ranked, size, err);
    if (!along || !list) goto cleanup;
    for (int32_t k = 0; k < size; k++)
        if (cut->point[k] >= 0) list[inside++].which = k;
    for (int axis = 0; axis < AXES; axis++) {
        for (int32_t k = 0; k < inside; k++)
            along[k] = (Coordinate){place[(int64_t)AXES * list[k].which + axis], k};
        qsort(along, (size_t)inside, sizeof *along, order_doubles);
        double extent = inside > 0 ? along[inside - 1].at - along[0].at : 0;
        for (int32_t k = 0, rank = 0; k < inside; k++) {
            if (k > 0 && along[k].at - along[k - 1].at > ALIKE * extent) rank++;
            list[along[k].entry].rank[axis] = rank;
        }
    }

    // Points in the order of their places.
    qsort(list, (size_t)inside, sizeof *list, order_ranked);
    for (int32_t k = 0; k < inside; k++) {
        if (k == 0 || memcmp(list[k].rank, list[k - 1].rank, sizeof list->rank) != 0) {
            for (int axis = 0; axis < AXES; axis++)
                cut->rank[axis][cut->points] = list[k].rank[axis];
            cut->first[cut->points++] = k;
        }
        cut->unknown[k] = list[k].which;
        cut->point[list[k].which] = cut->points - 1;
    }
    cut->first[cut->points] = inside;
    for (int axis = 0; axis < AXES; axis++) {
        for (int32_t p = 0; p < cut->points; p++) {
            list[p].which = p;
            for (int k = 0; k < AXES; k++) list[p].rank[k] = cut->rank[(axis + k) % AXES][p];
        }
        qsort(list, (size_t)cut->points, sizeof *list, order_ranked);
        for (int32_t p = 0; p < cut->points; p++) cut->sorted[axis][p] = list[p].which;
    }
cleanup:
    memory_free_all(along, list);
    return error_is_clean(err);
}

// Whether a point of the set has a neighbour in it whose rank is on the other side of `middle`.
static bool reaches_over(const Dissection *cut, int32_t point, const int32_t *rank, int32_t middle)
{
    const SparsePattern *pattern = cut->pattern;
    int32_t row = cut->unknown[cut->first[point]];
    for (int32_t k = pattern->start[row]; k < pattern->start[row + 1]; k++) {
        int32_t other = cut->point[pattern->index[k]];
        if (other < 0 || cut->set[other] != cut->set[point]) continue;
        if ((rank[other] < middle) != (rank[point] < middle)) return true;
    }
    return false;
}

static void append(Dissection *cut, const int32_t *points, int32_t count)
{
    for (int32_t p = 0; p < count; p++)
        for (int32_t k = cut->first[points[p]]; k < cut->first[points[p] + 1]; k++)
            cut->order[cut->ordered++] = cut->unknown[k];
}

// Appends the points sorted[.][begin .. begin + count), which are one set, in their order.
static void dissect(Dissection *cut, int32_t begin, int32_t count)
{
    // A cut through the middle of each axis, between two coordinates. The separator is what one of
    // the halves has at the cut.
    int32_t fewest = count, best = -1, best_middle = 0;
    Side best_half = FIRST;
    for (int axis = 0; axis < AXES && count > LEAF; axis++) {
        const int32_t *list = cut->sorted[axis] + begin, *rank = cut->rank[axis];
        int32_t below = count / 2, above = below, at_cut[2] = {0};
        while (below > 0 && rank[list[below - 1]] == rank[list[count / 2]]) below--;
        while (above < count && rank[list[above]] == rank[list[count / 2]]) above++;
        bool lower = above == count || (below > 0 && count / 2 - below <= above - count / 2);
        int32_t first = lower ? below : above;
        if (first == 0 || first == count) continue;   // all have one coordinate
        int32_t middle = rank[list[first]];
        for (int32_t p = 0; p < count; p++)
            at_cut[p >= first] += reaches_over(cut, list[p], rank, middle);
        for (int half = 0; half < 2; half++) {
            if (at_cut[half] >= fewest) continue;
            fewest = at_cut[half];
            best = axis;
            best_middle = middle;
            best_half = (Side)half;
        }
    }
    if (best < 0) {
        append(cut, cut->sorted[0] + begin, count);
        return;
    }

    // Each list is cut in three, its order kept.
    const int32_t *rank = cut->rank[best];
    int32_t size[SIDES] = {0};
    for (int32_t p = 0; p < count; p++) {
        int32_t point = cut->sorted[best][begin + p];
        Side side = rank[point] < best_middle ? FIRST : SECOND;
        if (side == best_half && reaches_over(cut, point, rank, best_middle)) side = SEPARATOR;
        cut->side[point] = (uint8_t)side;
        size[side]++;
    }
    for (int axis = 0; axis < AXES; axis++) {
        int32_t *list = cut->sorted[axis] + begin;
        int32_t next[SIDES] = {0, size[FIRST], size[FIRST] + size[SECOND]};
        for (int32_t p = 0; p < count; p++) cut->work[next[cut->side[list[p]]]++] = list[p];
        memcpy(list, cut->work, (size_t)count * sizeof *list);
    }
    for (int side = FIRST, p = 0; side < SIDES; side++) {
        cut->sets++;
        for (int32_t end = p + size[side]; p < end; p++)
            cut->set[cut->sorted[0][begin + p]] = cut->sets;
    }
    dissect(cut, begin, size[FIRST]);
    dissect(cut, begin + size[FIRST], size[SECOND]);
    append(cut, cut->sorted[0] + begin + size[FIRST] + size[SECOND], size[SEPARATOR]);
}

bool sparse_order_dissect(const SparsePattern *pattern, const double *place, const int32_t *border,
                          int32_t border_count, int32_t *order, Error *err)
{
    int32_t size = pattern->size;
    Dissection cut = {.pattern = pattern, .order = order};
    cut.first = NEW_ARRAY(int32_t, (int64_t)size + 1, err);
    cut.unknown = NEW_ARRAY(int32_t, size, err);
    cut.point = NEW_ARRAY(int32_t, size, err);
    cut.set = NEW_ARRAY(int32_t, size, err);
    cut.side = NEW_ARRAY(uint8_t, size, err);
    cut.work = NEW_ARRAY(int32_t, size, err);
    for (int axis = 0; axis < AXES; axis++) {
        cut.rank[axis] = NEW_ARRAY(int32_t, size, err);
        cut.sorted[axis] = NEW_ARRAY(int32_t, size, err);
    }
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t j = 0; j < border_count; j++) cut.point[border[j]] = -1;
    if (!list_points(place, &cut, err)) goto cleanup;
    dissect(&cut, 0, cut.points);
    memcpy(order + cut.ordered, border, (size_t)border_count * sizeof *border);
cleanup:
    dissection_destroy(&cut);
    return error_is_clean(err);
}
