// SPDX-License-Identifier: GPL-2.0-or-later
// Orders by nested dissection: every unknown once, the border last as given, and fewer entries in
// the factor than in the order of a grid, counted by symbolic elimination here.
#include "algebra/sparse_order.h"

#include "base/memory.h"
#include "near.h"
#include "random_numbers.h"

#include <stdlib.h>

enum { NODE = 2 };   // unknowns of a node of the grid

typedef struct Grid {
    int32_t side, size;
    SparsePattern pattern;
    double *place;
} Grid;

// side^3 nodes, each coupled with its 26 neighbours; node numbers go along x first. Coordinates are
// off by rounding, as those of a mesh are.
static void make_grid(Random *random, int32_t side, Grid *grid)
{
    Error err = {0};
    int32_t nodes = side * side * side, size = NODE * nodes, filled = 0;
    *grid = (Grid){.side = side, .size = size};
    grid->pattern = (SparsePattern){.size = size,
                                    .start = NEW_ARRAY(int32_t, size + 1, &err),
                                    .index = NEW_ARRAY(int32_t, 27 * NODE * size, &err)};
    grid->place = NEW_ARRAY(double, 3 * size, &err);
    assert_true(error_is_clean(&err));
    for (int32_t row = 0; row < size; row++) {
        int32_t node = row / NODE, at[] = {node % side, node / side % side, node / side / side};
        for (int c = 0; c < 3; c++)
            grid->place[3 * row + c] = row % NODE > 0
                                           ? grid->place[3 * (row - 1) + c]
                                           : at[c] / 7.0 + random_between(random, 0, 1e-14);
        for (int32_t other = 0; other < nodes; other++) {
            int32_t to[] = {other % side, other / side % side, other / side / side};
            if (abs(to[0] - at[0]) > 1 || abs(to[1] - at[1]) > 1 || abs(to[2] - at[2]) > 1)
                continue;
            for (int32_t d = 0; d < NODE; d++) grid->pattern.index[filled++] = NODE * other + d;
        }
        grid->pattern.start[row + 1] = filled;
    }
}

static void free_grid(Grid *grid)
{
    sparse_pattern_destroy(&grid->pattern);
    memory_free(grid->place);
}

// Entries of L below the diagonal: the rows of a column pass to the column of the first of them.
static int64_t count_entries(const SparsePattern *pattern, const int32_t *order)
{
    int32_t size = pattern->size;
    int32_t *at = calloc((size_t)size, sizeof *at);
    uint8_t *filled = calloc((size_t)size * (size_t)size, 1);   // [column][row], in the order
    int64_t entries = 0;
    for (int32_t k = 0; k < size; k++) at[order[k]] = k;
    for (int32_t k = 0; k < size; k++)
        for (int32_t e = pattern->start[k]; e < pattern->start[k + 1]; e++)
            filled[(int64_t)at[k] * size + at[pattern->index[e]]] = 1;
    for (int64_t column = 0; column < size; column++) {
        int64_t parent = 0;
        for (int64_t row = column + 1; row < size; row++) {
            if (!filled[column * size + row]) continue;
            entries++;
            if (parent == 0) parent = row;
            filled[parent * size + row] = 1;
        }
    }
    free(at), free(filled);
    return entries;
}

static void check_order(const SparsePattern *pattern, const int32_t *border, int32_t border_count,
                        const int32_t *order)
{
    int32_t size = pattern->size, seen[5000] = {0};
    for (int32_t k = 0; k < size; k++) {
        assert_true(order[k] >= 0 && order[k] < size);
        assert_int_equal(seen[order[k]]++, 0);
    }
    for (int32_t j = 0; j < border_count; j++)
        assert_int_equal(order[size - border_count + j], border[j]);
}

// In the order in which nodes are numbered L is a band of some side^2 entries a column, of
// nested dissection it has O(side) of them: on 12^3 nodes 0.58 of the band.
TEST(test_cube)
{
    Error err = {0};
    Random random = {.state = 21};
    Grid grid;
    make_grid(&random, 12, &grid);
    int32_t *order = NEW_ARRAY(int32_t, grid.size, &err), none = 0;
    int32_t *natural = NEW_ARRAY(int32_t, grid.size, &err);
    for (int32_t k = 0; k < grid.size; k++) natural[k] = k;
    assert_true(sparse_order_dissect(&grid.pattern, grid.place, &none, 0, order, &err));
    check_order(&grid.pattern, &none, 0, order);
    int64_t entries = count_entries(&grid.pattern, order);
    int64_t band = count_entries(&grid.pattern, natural);
    assert_in_range(entries, 1, 6 * band / 10);

    // The same order wherever the block lies, and however large it is.
    int32_t *again = NEW_ARRAY(int32_t, grid.size, &err);
    for (int32_t k = 0; k < 3 * grid.size; k++) grid.place[k] = 1e-3 * grid.place[k] - 4e-3;
    assert_true(sparse_order_dissect(&grid.pattern, grid.place, &none, 0, again, &err));
    assert_memory_equal(again, order, (size_t)grid.size * sizeof *order);
    memory_free_all(order, natural, again);
    free_grid(&grid);
}

// The bottom of the cube is the border, in whatever order; the rest is cut with it left out.
TEST(test_border_is_last)
{
    Error err = {0};
    Random random = {.state = 22};
    Grid grid;
    make_grid(&random, 8, &grid);
    int32_t border[NODE * 64], count = NODE * 64, *order = NEW_ARRAY(int32_t, grid.size, &err);
    for (int32_t k = 0; k < count; k++) border[k] = k;
    for (int32_t k = 0; k < count; k++) {
        int32_t other = k + random_index(&random, count - k), kept = border[k];
        border[k] = border[other];
        border[other] = kept;
    }
    assert_true(sparse_order_dissect(&grid.pattern, grid.place, border, count, order, &err));
    check_order(&grid.pattern, border, count, order);
    memory_free(order);
    free_grid(&grid);
}

// Places that say nothing: all in one, all on a line, or at random; and nothing but border.
TEST(test_any_places)
{
    Error err = {0};
    Random random = {.state = 23};
    Grid grid;
    make_grid(&random, 6, &grid);
    int32_t *order = NEW_ARRAY(int32_t, grid.size, &err),
            *all = NEW_ARRAY(int32_t, grid.size, &err);
    for (int kind = 0; kind < 4; kind++) {
        for (int32_t k = 0; k < 3 * grid.size; k++)
            grid.place[k] = kind == 0                ? 0.25
                            : kind == 1 && k % 3 > 0 ? 0
                            : kind == 2              ? random_index(&random, 3)
                                                     : random_between(&random, -1, 1);
        assert_true(sparse_order_dissect(&grid.pattern, grid.place, all, 0, order, &err));
        check_order(&grid.pattern, all, 0, order);
    }
    for (int32_t k = 0; k < grid.size; k++) all[k] = grid.size - 1 - k;
    assert_true(sparse_order_dissect(&grid.pattern, grid.place, all, grid.size, order, &err));
    check_order(&grid.pattern, all, grid.size, order);
    memory_free_all(order, all);
    free_grid(&grid);
}

TEST(test_memory_faults)
{
    Random random = {.state = 24};
    Error clean = {0};
    Grid grid;
    make_grid(&random, 3, &grid);
    int32_t *order = NEW_ARRAY(int32_t, grid.size, &clean), none = 0;
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        memory_fail_after(k);
        done = sparse_order_dissect(&grid.pattern, grid.place, &none, 0, order, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 30);
    }
    memory_free(order);
    free_grid(&grid);
}
