// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/accuracy.h"

#include "amontons.h"
#include "base/text.h"
#include "io/files/folder.h"
#include "io/files/own_list.h"
#include "io/text/json_writer.h"

#include <math.h>
#include <stdio.h>

enum { FIGURE_PATH_SIZE = AMONTONS_PATH_SIZE + 32, ESTIMATES_SIZE = 40 * LEVELS_MAX };

static const ErrorBar *answer_of(const Levels *levels, int32_t level)
{
    return &levels->list[level].answer[levels->asked];
}

// The points of each run, `means` false, or the estimate after each level with its bar: a level
// without a mesh part has none, its ends are the value.
static void write_points(const Levels *levels, bool means, JsonWriter *json)
{
    enum { POINTS_MAX = LEVELS_MAX * LEVEL_RUNS_MAX };
    double x[POINTS_MAX], y[POINTS_MAX], low[LEVELS_MAX], high[LEVELS_MAX];
    int32_t count = 0;
    for (int32_t l = 0; l < levels->count; l++) {
        const Level *level = &levels->list[l];
        const ErrorBar *answer = answer_of(levels, l);
        for (int32_t k = 0; !means && k < level->run_count; k++) {
            x[count] = level->contact_nodes;
            y[count++] = level->runs[k].answer[levels->asked].value;
        }
        if (!means) continue;
        double bar = answer->parts.mesh >= 0 ? answer->bar : 0;
        x[count] = level->contact_nodes;
        y[count] = answer->value;
        low[count] = answer->value - bar;
        high[count++] = answer->value + bar;
    }
    json_begin_object(json, NULL);
    json_text(json, "label", means ? "estimate so far, error bar" : "a run");
    json_number_list(json, "x", x, count);
    json_number_list(json, "y", y, count);
    if (means) json_number_list(json, "low", low, count);
    if (means) json_number_list(json, "high", high, count);
    json_integer(json, "color", means);
    json_text(json, "marker", means ? "square" : "circle");
    if (!means) json_boolean(json, "filled", false);
    json_text(json, "line", means ? "thin" : "none");
    json_end(json);
}

bool accuracy_figure(const Levels *levels, const char *title, const char *folder, Error *err)
{
    char path[FIGURE_PATH_SIZE], png[FIGURE_PATH_SIZE];
    snprintf(path, sizeof path, "%s/figures", folder);
    if (!folder_make(path, err)) return false;
    snprintf(path, sizeof path, "%s/figures/accuracy.json", folder);
    snprintf(png, sizeof png, "%s/figures/accuracy.png", folder);
    JsonWriter *json = json_create(path, err);
    if (!json) return false;
    json_begin_object(json, NULL);
    json_text(json, "title", title);
    json_begin_object(json, "page");
    json_text(json, "title", "none");
    json_end(json);
    json_begin_object(json, "x");
    json_text(json, "label", "contact nodes");
    json_text(json, "scale", "log");
    json_end(json);
    json_begin_object(json, "y");
    json_text(json, "label", levels->asked == ANSWER_MU_M ? "~{\u03bc}_{M}" : "~{\u03bc}_{hold}");
    json_end(json);
    json_begin_list(json, "series");
    write_points(levels, true, json);
    write_points(levels, false, json);
    json_end(json);
    json_end(json);
    return json_finish(json, err) && amontons_render_plot_file(path, png, NULL, err);
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
