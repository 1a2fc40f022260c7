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
    int32_t *start;   // [points + 1] of each point's unknowns in `unknown`; owned
    int32_t *unknown;   // [size] of the interior, those of a point together; owned
    int32_t *point;   // [size] of each unknown, -1: on the border; owned
    int32_t *rank[AXES];   // [points] place among the coordinates along an axis, the same for
        // equal ones; owned
    int32_t *sorted[AXES];   // [points] along an axis, those of a set together; owned
    int32_t *set;   // [points] number of the set that a point is in; owned
    int32_t sets;   // numbers given so far
    uint8_t *side;   // [points] Side of the plane that cuts the set at hand; owned
    int32_t *work;   // [points]; owned
    int32_t *order, ordered;   // [size] the result, and how many unknowns it has so far
} Dissection;

static void dissection_destroy(Dissection *all)
{
    for (int axis = 0; axis < AXES; axis++) memory_free_all(all->rank[axis], all->sorted[axis]);
    memory_free_all(all->start, all->unknown, all->point, all->set, all->side, all->work);
}

typedef struct Coordinate {
    double at;   // the first field, as order_doubles sorts by it
    int32_t entry;   // of the list of unknowns
} Coordinate;

typedef struct Ranked {
    int32_t rank[AXES];   // in the order of their weight
    int32_t which;   // unknown or point
} Ranked;

static int order_ranked(const void *left, const void *right)
{
    const Ranked *a = left, *b = right;
    for (int k = 0; k < AXES; k++)
        if (a->rank[k] != b->rank[k]) return a->rank[k] < b->rank[k] ? -1 : 1;
    return (a->which > b->which) - (a->which < b->which);
}

// Unknowns at one place become a point.
static bool list_points(const double *place, Dissection *all, Error *err)
{
    int32_t size = all->pattern->size, inside = 0;
    Coordinate *along = NEW_ARRAY(Coordinate, size, err);
    Ranked *list = NEW_ARRAY(Ranked, size, err);
    if (!along || !list) goto cleanup;
    for (int32_t k = 0; k < size; k++)
        if (all->point[k] >= 0) list[inside++].which = k;
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
    qsort(list, (size_t)inside, sizeof *list, order_ranked);
    for (int32_t k = 0; k < inside; k++) {
        if (k == 0 || memcmp(list[k].rank, list[k - 1].rank, sizeof list->rank) != 0) {
            for (int axis = 0; axis < AXES; axis++)
                all->rank[axis][all->points] = list[k].rank[axis];
            all->start[all->points++] = k;
        }
        all->unknown[k] = list[k].which;
        all->point[list[k].which] = all->points - 1;
    }
    all->start[all->points] = inside;
cleanup:
    memory_free_all(along, list);
    return error_is_clean(err);
}

static bool sort_points_along_axes(Dissection *all, Error *err)
{
    Ranked *list = NEW_ARRAY(Ranked, all->points, err);
    if (!list) return false;
    for (int axis = 0; axis < AXES; axis++) {
        for (int32_t p = 0; p < all->points; p++) {
            list[p].which = p;
            for (int k = 0; k < AXES; k++) list[p].rank[k] = all->rank[(axis + k) % AXES][p];
        }
        qsort(list, (size_t)all->points, sizeof *list, order_ranked);
        for (int32_t p = 0; p < all->points; p++) all->sorted[axis][p] = list[p].which;
    }
    memory_free(list);
    return true;
}

// A plane across an axis: points whose rank is below `rank` lie in the first half of a set. `half`:
// the half whose points at the plane are the separator.
typedef struct Plane {
    int axis;
    int32_t rank;
    Side half;
} Plane;

// True if a point of a set has a neighbour in it on the other side of the plane.
static bool reaches_over(const Dissection *all, int32_t point, int axis, int32_t plane_rank)
{
    const SparsePattern *pattern = all->pattern;
    const int32_t *rank = all->rank[axis];
    int32_t row = all->unknown[all->start[point]];
    for (int32_t k = pattern->start[row]; k < pattern->start[row + 1]; k++) {
        int32_t other = all->point[pattern->index[k]];
        if (other < 0 || all->set[other] != all->set[point]) continue;
        if ((rank[other] < plane_rank) != (rank[point] < plane_rank)) return true;
    }
    return false;
}

// The plane with the fewest points in its separator, of those through the middle of the set
// sorted[.][begin .. begin + count). Returns false if none cuts the set, or it is small.
static bool choose_plane(const Dissection *all, int32_t begin, int32_t count, Plane *best)
{
    int32_t fewest = count;
    for (int axis = 0; axis < AXES && count > LEAF; axis++) {
        // Between two coordinates: that of the point in the middle and the next lower or higher.
        const int32_t *list = all->sorted[axis] + begin, *rank = all->rank[axis];
        int32_t below = count / 2, above = below, at_plane[2] = {0};
        while (below > 0 && rank[list[below - 1]] == rank[list[count / 2]]) below--;
        while (above < count && rank[list[above]] == rank[list[count / 2]]) above++;
        bool lower = above == count || (below > 0 && count / 2 - below <= above - count / 2);
        int32_t first = lower ? below : above;
        if (first == 0 || first == count) continue;   // all have one coordinate
        int32_t plane_rank = rank[list[first]];
        for (int32_t p = 0; p < count; p++)
            at_plane[p >= first] += reaches_over(all, list[p], axis, plane_rank);
        for (int half = FIRST; half <= SECOND; half++) {
            if (at_plane[half] >= fewest) continue;
            fewest = at_plane[half];
            *best = (Plane){axis, plane_rank, (Side)half};
        }
    }
    return fewest < count;
}

// Appends the unknowns of the points to the result.
static void append(Dissection *all, const int32_t *points, int32_t count)
{
    for (int32_t p = 0; p < count; p++)
        for (int32_t k = all->start[points[p]]; k < all->start[points[p] + 1]; k++)
            all->order[all->ordered++] = all->unknown[k];
}

// Appends the set sorted[.][begin .. begin + count): its first half, its second, their separator.
static void dissect(Dissection *all, int32_t begin, int32_t count)
{
    Plane plane = {0};   // gcc 12 does not see that choose_plane sets it
    if (!choose_plane(all, begin, count, &plane)) {
        append(all, all->sorted[0] + begin, count);
        return;
    }
    int32_t size[SIDES] = {0};
    for (int32_t p = 0; p < count; p++) {
        int32_t point = all->sorted[plane.axis][begin + p];
        Side side = all->rank[plane.axis][point] < plane.rank ? FIRST : SECOND;
        if (side == plane.half && reaches_over(all, point, plane.axis, plane.rank))
            side = SEPARATOR;
        all->side[point] = (uint8_t)side;
        size[side]++;
    }
    for (int axis = 0; axis < AXES; axis++) {
        int32_t *list = all->sorted[axis] + begin;
        int32_t next[SIDES] = {0, size[FIRST], size[FIRST] + size[SECOND]};
        for (int32_t p = 0; p < count; p++) all->work[next[all->side[list[p]]]++] = list[p];
        memcpy(list, all->work, (size_t)count * sizeof *list);
    }
    for (int side = FIRST, p = 0; side < SIDES; side++) {
        all->sets++;
        for (int32_t end = p + size[side]; p < end; p++)
            all->set[all->sorted[0][begin + p]] = all->sets;
    }
    dissect(all, begin, size[FIRST]);
    dissect(all, begin + size[FIRST], size[SECOND]);
    append(all, all->sorted[0] + begin + size[FIRST] + size[SECOND], size[SEPARATOR]);
}

bool sparse_order_dissect(const SparsePattern *pattern, const double *place, const int32_t *border,
                          int32_t border_count, int32_t *order, Error *err)
{
    int32_t size = pattern->size;
    Dissection all = {.pattern = pattern, .order = order};
    all.start = NEW_ARRAY(int32_t, (int64_t)size + 1, err);
    all.unknown = NEW_ARRAY(int32_t, size, err);
    all.point = NEW_ARRAY(int32_t, size, err);
    all.set = NEW_ARRAY(int32_t, size, err);
    all.side = NEW_ARRAY(uint8_t, size, err);
    all.work = NEW_ARRAY(int32_t, size, err);
    for (int axis = 0; axis < AXES; axis++) {
        all.rank[axis] = NEW_ARRAY(int32_t, size, err);
        all.sorted[axis] = NEW_ARRAY(int32_t, size, err);
    }
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t j = 0; j < border_count; j++) all.point[border[j]] = -1;
    if (!list_points(place, &all, err) || !sort_points_along_axes(&all, err)) goto cleanup;
    dissect(&all, 0, all.points);
    memcpy(order + all.ordered, border, (size_t)border_count * sizeof *border);
cleanup:
    dissection_destroy(&all);
    return error_is_clean(err);
}
