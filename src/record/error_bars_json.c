// SPDX-License-Identifier: GPL-2.0-or-later
// Error bars as `accuracy` of run.json.
#include "record/error_bars.h"

#include <math.h>

static const double BRANCH_WIDTH = 0.005;   // of mu: the next branch is twice as far and more

// The runs of a level by the branch that their answer lies on, into `sorted` [LEVEL_RUNS_MAX].
static int32_t sort_runs(const Level *level, AnswerKind kind, SeriesItem *sorted)
{
    int32_t count = 0;
    for (int32_t k = 0; k < level->run_count; k++) {
        double value = level->runs[k].answer[kind].value;
        if (!isnan(value)) sorted[count++] = (SeriesItem){.value = value};
    }
    series_sort(sorted, count);
    return count;
}

static void write_bars(const ErrorBar answer[ANSWER_KINDS], JsonWriter *json)
{
    for (AnswerKind kind = 0; kind < ANSWER_KINDS; kind++) {
        const ErrorBar *bar = &answer[kind];
        json_begin_object(json, ANSWER_NAMES[kind]);
        json_numbers_of(json, {"value", bar->value}, {"bar", bar->bar});
        error_parts_write(&bar->parts, json);
        json_end(json);
    }
}

static void write_runs(const Level *level, JsonWriter *json)
{
    json_begin_list(json, "runs");
    for (int32_t k = 0; k < level->run_count; k++) {
        const LevelRun *run = &level->runs[k];
        json_begin_object(json, NULL);
        json_numbers_of(json, {"pressure", run->pressure}, {"mu_M", run->answer[ANSWER_MU_M].value},
                        {"mu_hold", run->answer[ANSWER_MU_HOLD].value}, {"peaks", run->peaks},
                        {"period", run->period});
        json_text(json, "run_in", run_in_name(run->run_in));
        json_integer(json, "steps", run->steps);
        json_end(json);
    }
    json_end(json);
}

// Values to which the runs of the last level come, and which part of them.
static void write_branches(const Levels *levels, JsonWriter *json)
{
    SeriesItem sorted[LEVEL_RUNS_MAX];
    SeriesBranch branch;
    const Level *last = levels_last(levels);
    int32_t count = last ? sort_runs(last, levels->asked, sorted) : 0;
    json_begin_list(json, "branches");
    for (int32_t k = 0; k < count;) {
        k = series_branch(sorted, count, k, BRANCH_WIDTH, &branch);
        json_object_of(json, NULL, {"mu", branch.mean}, {"share", (double)branch.count / count});
    }
    json_end(json);
}

// All values are null if no run was cut.
static void write_cut(const LevelCut *cut, JsonWriter *json)
{
    static const LevelCut none = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    if (cut->mesh == 0) cut = &none;
    json_object_of(json, "cut", {"mesh", cut->mesh}, {"run", cut->run},
                   {"contact_nodes", cut->contact_nodes}, {"U", cut->U}, {"part", cut->part},
                   {"seconds", cut->seconds}, {"seconds_expected", cut->seconds_expected},
                   {"mu_M", cut->mu_M}, {"mu_hold", cut->mu_hold});
}

void levels_write_json(const Levels *levels, JsonWriter *json)
{
    json_begin_object(json, "accuracy");
    json_number(json, "wanted", levels->wanted);
    json_boolean(json, "met", levels->met);
    json_text(json, "of", ANSWER_NAMES[levels->asked]);
    json_text(json, "ended", levels->ended);
    write_cut(&levels->cut, json);
    json_number(json, "observed_order", levels_order(levels));
    write_branches(levels, json);
    json_begin_list(json, "levels");
    for (int32_t l = 0; l < levels->count; l++) {
        const Level *level = &levels->list[l];
        json_begin_object(json, NULL);
        json_numbers_of(json, {"refine", level->refine}, {"contact_nodes", level->contact_nodes},
                        {"seconds", level->seconds}, {"seconds_expected", level->seconds_expected});
        json_boolean(json, "undamped", level->undamped);
        json_boolean(json, "other_drops", level->other_drops);
        json_numbers_of(json, {"slip_cells", level->slip_cells}, {"end_wait", level->end_wait});
        write_bars(level->answer, json);
        write_runs(level, json);
        json_end(json);
    }
    json_end(json);
    json_end(json);
}
