// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/accuracy.h"

#include "amontons.h"
#include "base/text.h"
#include "io/files/own_list.h"
#include "run/result/figure_file.h"

#include <math.h>
#include <stdio.h>

enum { ESTIMATES_SIZE = 40 * LEVELS_MAX };

static const ErrorBar *answer_of(const Levels *levels, int32_t level)
{
    return &levels->list[level].answer[levels->asked];
}

bool accuracy_figure(const Levels *levels, const char *title, const char *folder, Error *err)
{
    enum { POINTS_MAX = LEVELS_MAX * LEVEL_RUNS_MAX };
    double x[POINTS_MAX], y[POINTS_MAX], nodes[LEVELS_MAX], value[LEVELS_MAX], bar[LEVELS_MAX];
    int32_t count = 0;
    for (int32_t l = 0; l < levels->count; l++) {
        const Level *level = &levels->list[l];
        const ErrorBar *answer = answer_of(levels, l);
        for (int32_t k = 0; k < level->run_count; k++) {
            x[count] = level->contact_nodes;
            y[count++] = level->runs[k].answer[levels->asked].value;
        }
        nodes[l] = level->contact_nodes;
        value[l] = answer->value;
        bar[l] = answer->parts.mesh >= 0 ? answer->bar : 0;   // without a mesh part there is none
    }
    Curve means = {"estimate so far, error bar",
                   "thin",
                   "square",
                   1,
                   levels->count,
                   true,
                   nodes,
                   value,
                   bar,
                   false};
    Curve runs = {"a run", "none", "circle", 0, count, false, x, y, NULL, false};
    Figure figure = {.folder = folder, .name = "accuracy", .title = title};
    if (!figure_begin(&figure, err)) return false;
    figure_write_axis(&figure, "x", "contact nodes", NULL, NULL, "log");
    figure_write_axis(&figure, "y",
                      levels->asked == ANSWER_MU_M ? "~{\u03bc}_{M}" : "~{\u03bc}_{hold}", NULL,
                      NULL, NULL);
    json_begin_list(figure.json, "series");
    if (figure_write_curve(&figure, &means, err)) figure_write_curve(&figure, &runs, err);
    json_end(figure.json);
    return figure_end(&figure, err);
}

void accuracy_stopped(Levels *levels, const char *title, const char *folder, Error *err)
{
    Error stopped = *err, failed = {0};
    char estimates[ESTIMATES_SIZE];
    while (levels->count > 0 && levels->list[levels->count - 1].run_count == 0) levels->count--;
    if (levels->count == 0 || isnan(answer_of(levels, levels->count - 1)->value)) {
        error_context(err, "no run has ended yet, nothing was written");
        return;
    }
    bool kept = folder && own_list_make(folder, &failed) &&
                accuracy_figure(levels, title, folder, &failed);

    // The estimate after each mesh: "0.3320 on 21 contact nodes, 0.3301 +- 0.004 on 29". One mesh
    // alone has no bar.
    for (int32_t l = 0, used = 0; l < levels->count && used < ESTIMATES_SIZE; l++) {
        Levels until = *levels;
        char value[ESTIMATE_SIZE];
        until.count = l + 1;
        text_estimate(answer_of(levels, l)->value, answer_of(levels, l)->bar,
                      levels_known_to(&until, levels->asked), value);
        used += snprintf(estimates + used, (size_t)(ESTIMATES_SIZE - used), "%s%s on %d%s",
                         l > 0 ? ", " : "", value, levels->list[l].contact_nodes,
                         l > 0 ? "" : " contact nodes");
    }
    *err = (Error){0};
    (void)FAULT(
        err, ERROR_INTERRUPT,
        "%s; so far %s = %s%s%s%s; it does not go on from here: the same command begins anew; "
        "with --within TIME it keeps what it has when time is up",
        stopped.message, ANSWER_NAMES[levels->asked], estimates, kept ? " (" : "",
        kept ? folder : "", kept ? "/figures/accuracy.json)" : "");
}
