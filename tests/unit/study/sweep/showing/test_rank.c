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
