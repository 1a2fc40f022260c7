// SPDX-License-Identifier: GPL-2.0-or-later
// Error bars as `accuracy` of run.json.
#include "answers/error_bars.h"

#include "answers/statistics.h"

#include <math.h>

static const double BRANCH_WIDTH = 0.005;   // of mu: the next branch is twice as far and more

void levels_write_json(const Levels *levels, JsonWriter *json)
{
    json_begin_object(json, "accuracy");
    json_number(json, "wanted", levels->wanted);
    json_boolean(json, "met", levels->met);
    json_text(json, "of", ANSWER_NAMES[levels->asked]);
    json_text(json, "ended", levels->ended);

    // All values of the run that was cut are null if none was.
    static const LevelCut none = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    const LevelCut *cut = levels->cut.mesh == 0 ? &none : &levels->cut;
    json_object_of(json, "cut", {"mesh", cut->mesh}, {"run", cut->run},
                   {"contact_nodes", cut->contact_nodes}, {"U", cut->U}, {"part", cut->part},
                   {"seconds", cut->seconds}, {"seconds_expected", cut->seconds_expected},
                   {"mu_M", cut->mu_M}, {"mu_hold", cut->mu_hold});
    json_number(json, "observed_order", levels_order(levels));

    // Values to which the runs of the last level come, and which part of them.
    SeriesItem sorted[LEVEL_RUNS_MAX];
    const Level *last = levels_last(levels);
    int32_t count = 0;
    for (int32_t k = 0; last && k < last->run_count; k++) {
        double value = last->runs[k].answer[levels->asked].value;
        if (!isnan(value)) sorted[count++] = (SeriesItem){.value = value};
    }
    series_sort(sorted, count);
    json_begin_list(json, "branches");
    for (int32_t k = 0; k < count;) {
        SeriesBranch branch;
        k = series_branch(sorted, count, k, BRANCH_WIDTH, &branch);
        json_object_of(json, NULL, {"mu", branch.mean}, {"share", (double)branch.count / count});
    }
    json_end(json);

    json_begin_list(json, "levels");
    for (int32_t l = 0; l < levels->count; l++) {
        const Level *level = &levels->list[l];
        json_begin_object(json, NULL);
        json_numbers_of(json, {"refine", level->refine}, {"contact_nodes", level->contact_nodes},
                        {"seconds", level->seconds}, {"seconds_expected", level->seconds_expected});
        json_boolean(json, "undamped", level->undamped);
        json_boolean(json, "other_drops", level->other_drops);
        json_numbers_of(json, {"slip_cells", level->slip_cells}, {"end_wait", level->end_wait});
        for (AnswerKind kind = 0; kind < ANSWER_KINDS; kind++) {
            const ErrorBar *bar = &level->answer[kind];
            json_begin_object(json, ANSWER_NAMES[kind]);
            json_numbers_of(json, {"value", bar->value}, {"bar", bar->bar});
            error_parts_write(&bar->parts, json);
            json_end(json);
        }
        json_begin_list(json, "runs");
        for (int32_t k = 0; k < level->run_count; k++) {
            const LevelRun *run = &level->runs[k];
            json_begin_object(json, NULL);
            json_numbers_of(json, {"pressure", run->pressure},
                            {"mu_M", run->answer[ANSWER_MU_M].value},
                            {"mu_hold", run->answer[ANSWER_MU_HOLD].value},
                            {"mu_first", run->answer[ANSWER_MU_FIRST].value}, {"peaks", run->peaks},
                            {"period", run->period});
            json_text(json, "run_in", run_in_name(run->run_in));
            json_integer(json, "steps", run->steps);
            json_end(json);
        }
        json_end(json);
        json_end(json);
    }
    json_end(json);
    json_end(json);
}
