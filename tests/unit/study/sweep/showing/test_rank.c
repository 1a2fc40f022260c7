// SPDX-License-Identifier: GPL-2.0-or-later
// Ranks that points may have, against their definition: every point compared with every other.
#include "study/sweep/showing/rank.h"

#include "base/memory.h"
#include "cases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 1500 };

typedef struct Ranked {
    Sweep sweep;
    SweepTable table;
    TableColumn columns[2];   // values, errors
    double values[POINTS], errors[POINTS];
    SweepPoint points[POINTS];
} Ranked;

// error: of most; some have none, some a hundred times as much; many values are alike.
static Ranked *make(double error)
{
    Error err = {0};
    Ranked *made = NEW_ARRAY(Ranked, 1, &err);
    assert_non_null(made);
    made->sweep.study.point_count = POINTS;
    made->sweep.study.rank.against = AGAINST_FIRST;
    made->sweep.points = made->points;
    made->table.columns = made->columns;
    made->table.error[0] = made->table.known_to[0] = 1;
    made->columns[0].values = made->values;
    made->columns[1].values = made->errors;
    srand(7);
    for (int32_t k = 0; k < POINTS; k++) {
        int32_t kind = rand() % 20;
        made->points[k].same_as = k;
        made->values[k] = kind == 0 ? (double)NAN : (double)(rand() % 1000) / 1000;
        made->errors[k] = kind == 1 ? (double)NAN
                                    : error * (kind == 2 ? 100 : 1) * (rand() % 5) / 5;
    }
    return made;
}

static void check(const Ranked *made, const Ranking *ranking)
{
    for (int32_t i = 0; i < ranking->ranked; i++) {
        const RankRow *row = &ranking->rows[i];
        int32_t from = 1, to = ranking->ranked;
        for (int32_t k = 0; k < POINTS; k++) {
            double way = made->values[k] - made->values[row->point];
            double error = made->errors[k], own = made->errors[row->point];
            bool decided = way * way > error * error + own * own;
            from += decided && way > 0;
            to -= decided && way < 0;
        }
        if (row->from != from || row->to != to)
            fail_msg("row %d: %d to %d, not %d to %d", i, row->from, row->to, from, to);
    }
}

TEST(test_ranks)
{
    static const double errors[] = {0, 1e-3, 0.02, 5};
    for (size_t k = 0; k < sizeof errors / sizeof errors[0]; k++) {
        Error err = {0};
        Ranked *made = make(errors[k]);
        Ranking ranking = {0};
        assert_true(ranking_make(&made->sweep, &made->table, &ranking, &err));
        assert_in_range(ranking.ranked, POINTS * 9 / 10, POINTS - 1);
        check(made, &ranking);
        ranking_destroy(&ranking);
        memory_free(made);
    }
}

// Three points, one computed again: it moved by 2.5 of its bars before, so those of the others
// count 2.5 times, and what they decided alone is open.
TEST(test_refined)
{
    Error err = {0};
    Ranking ranking = {0};
    double values[] = {0.30, 0.29, 0.25}, errors[] = {0.002, 0.004, 0.004};
    SweepPoint points[3] = {{.same_as = 0}, {.same_as = 1}, {.same_as = 2}};
    Sweep sweep = {.points = points, .study = {.point_count = 3, .rank.against = AGAINST_FIRST}};
    TableColumn columns[] = {{.values = values}, {.values = errors}};
    SweepTable table = {.columns = columns, .error = {1}, .known_to = {1}};
    assert_true(ranking_make(&sweep, &table, &ranking, &err));
    assert_int_equal(ranking.rows[0].to, 1);
    ranking_destroy(&ranking);
    points[0].refined = true;
    points[0].moved = 2.5;
    assert_true(ranking_make(&sweep, &table, &ranking, &err));
    assert_int_equal(ranking.refined, 1);
    assert_true(ranking.rows[0].error == 0.002 && ranking.rows[1].error == 0.01);
    assert_true(ranking.rows[1].bar == 0.004);   // as it is told
    assert_int_equal(ranking.rows[0].to, 2);
    assert_int_equal(ranking.rows[2].from, 3);
    ranking_destroy(&ranking);
    points[0].moved = 0.5;   // within its bar: bars count as they are
    assert_true(ranking_make(&sweep, &table, &ranking, &err));
    assert_int_equal(ranking.rows[0].to, 1);
    ranking_destroy(&ranking);
}
