// SPDX-License-Identifier: GPL-2.0-or-later
// A refined point is an ordinary point with another accuracy.mu: it has a hash and a folder of its
// own, so that the same command finds it again, and goes the same way to the same table.
#include "study/sweep/refine.h"

#include "base/memory.h"
#include "io/text/json_reader.h"
#include "study/sweep/computing/tally.h"
#include "study/sweep/showing/rank.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SMALLER = 0.9;   // of the error before: a round was of use

// Looks for what an earlier sweep left. *chosen: there is a next accuracy.
static bool choose(Sweep *sweep, const RankRow *row, bool *chosen, Error *err)
{
    int32_t k = row->point;
    SweepPoint *point = &sweep->points[k];
    char *report = NULL;
    const Scene *scene = point_scene(sweep, k, err);
    TRY(scene);

    // Half the error bar that was asked for or, where that is smaller, of the one that came out,
    // relative; two digits read well in a table. Not below the limit; 0: the point is there
    // already.
    double asked = scene->accuracy.mu;
    double came_out = row->error / fabs(row->value);
    char digits[20];
    if (came_out < asked) asked = came_out;
    snprintf(digits, sizeof digits, "%.2g", asked / 2);
    double accuracy =
        asked > sweep->study.rank.refine ? fmax(strtod(digits, NULL), sweep->study.rank.refine) : 0;

    TRY((*chosen = accuracy > 0));
    point->accuracy = accuracy;
    TRY(point_scene(sweep, k, err));   // with it
    TRY(point_hash(sweep, scene, point->hash, err));
    report = point_report(sweep, k, err);
    TRY(error_is_clean(err));
    point->status = sweep->options->fresh ? POINT_PENDING : point_status(report);
    point->reused = point->status != POINT_PENDING;
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

// Those shown, and others that might be among them.
static bool is_open(const Sweep *sweep, const RankRow *row)
{
    return row->from < row->to && row->from <= sweep->study.rank.top &&
           !sweep->points[row->point].settled;
}

bool refine_begin(Sweep *sweep, SweepPoint **before, int32_t *count, Error *err)
{
    SweepTable table = {0};
    Ranking ranking = {0};
    int32_t points = sweep->study.point_count;
    TRY((*before = NEW_ARRAY(SweepPoint, points, err)));
    memcpy(*before, sweep->points, (size_t)points * sizeof **before);
    TRY(table_write(sweep, &table, err));
    TRY(ranking_make(sweep, &table, &ranking, err));
    sweep->mesh = (PointMesh){0};
    *count = 0;
    for (int32_t k = 0; k < ranking.ranked; k++) {
        bool chosen = false;
        if (!is_open(sweep, &ranking.rows[k])) continue;
        TRY(choose(sweep, &ranking.rows[k], &chosen, err));
        *count += chosen;
    }
    TRY(points_find_same(sweep, err));   // those of an earlier round count
    for (int32_t k = 0; k < points; k++) sweep->planned += sweep_is_waiting(sweep, k);
cleanup:
    table_destroy(&table);
    ranking_destroy(&ranking);
    return error_is_clean(err);
}

// Reads the ranked result from a point's run.json.
static PointValue read_ranked(const Sweep *sweep, int32_t k, Error *err)
{
    char *report = point_report(sweep, k, err);
    PointValue ranked = point_value(report, sweep->study.records[sweep->study.rank.record].path);
    memory_free(report);
    return ranked;
}

bool refine_end(Sweep *sweep, const SweepPoint *before, Error *err)
{
    for (int32_t k = 0; k < sweep->study.point_count; k++) {
        SweepPoint *point = &sweep->points[k];
        SweepPoint refined = *point;
        PointValue found = point_value(NULL, "");
        if (strcmp(refined.hash, before[k].hash) == 0) continue;
        if (refined.status == POINT_DONE) found = read_ranked(sweep, k, err);
        *point = before[k];
        PointValue last = read_ranked(sweep, k, err);
        if (!error_is_clean(err)) return false;
        double error = isnan(last.error) ? INFINITY : last.error;
        if (found.error < error) {
            double moved = fabs(found.value - last.value) / error;
            *point = refined;
            point->refined = true;
            point->moved = fmax(before[k].moved, moved);   // fmax of NaN and a number is the number
        }
        point->settled = !(found.error < SMALLER * error);
    }
    return points_find_same(sweep, err);
}
