// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/figure_file.h"

#include "base/memory.h"
#include "io/folder.h"
#include "scene/keys.h"
#include "study/sweep/study_point.h"

#include <math.h>
#include <string.h>

// --- words --------------------------------------------------------------------------------------

const char *figure_last_word(const char *key)
{
    const char *dot = strrchr(key, '.');
    return dot ? dot + 1 : key;
}

FigureLabel figure_record_label(const StudyRecord *record)
{
    FigureLabel label = {0};
    static const struct {
        const char *path, *label;
    } known[] = {
        {"results.mu_M", "~{\u03bc}_{M}"},
        {"results.mu_max", "largest ~{\u03bc}"},
        {"results.mu_hold", "~{\u03bc}_{hold}"},
        {"results.peaks.0.mu", "first peak of ~{\u03bc}"},
        {"results.l_c_over_L", "~{l}_{c} / ~{L}"},
        {"results.l_sc_over_L", "~{l}_{sc} / ~{L}"},
    };
    snprintf(label.words, FIGURE_LABEL_SIZE, "%.80s", record->name);
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (strcmp(record->path, known[k].path) == 0)
            snprintf(label.words, FIGURE_LABEL_SIZE, "%s", known[k].label);
    return label;
}

FigureLabel figure_key_label(const char *name, const Scene *scene)
{
    FigureLabel label = {0};
    static const struct {
        const char *dimension, *si, *normalised;
    } units[] = {{"length", "m", "~{L}_{0}"},
                 {"time", "s", "~{t}_{0}"},
                 {"velocity", "m/s", "(~{L}_{0} / ~{t}_{0})"},
                 {"stress", "Pa", "~{E}"},
                 {"density", "kg/m^{3}", NULL},
                 {"viscosity", "Pa s", NULL}};
    int32_t count = 0, index = scene_key_index(name);
    const SceneKey *keys = scene_keys(&count);
    snprintf(label.words, FIGURE_LABEL_SIZE, "%.60s", figure_last_word(name));
    if (index < 0 || keys[index].type != KEY_NUMBER) return label;
    for (size_t k = 0; k < sizeof units / sizeof units[0]; k++) {
        if (strcmp(keys[index].unit, units[k].dimension) != 0) continue;
        if (scene->units == UNITS_SI)
            label.unit = units[k].si;
        else if (units[k].normalised)
            snprintf(label.words, FIGURE_LABEL_SIZE, "%.60s / %s", figure_last_word(name),
                     units[k].normalised);
    }
    return label;
}

// --- the description ----------------------------------------------------------------------------

static void figure_path(const Figure *figure, const char *ending, char path[POINT_PATH_SIZE])
{
    snprintf(path, POINT_PATH_SIZE, "%s/figures/%s.%s", figure->sweep->folder, figure->name,
             ending);
}

bool figure_begin(Figure *figure, Error *err)
{
    char path[POINT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/figures", figure->sweep->folder);
    TRY(folder_make(path, err));
    TRY((figure->scene = NEW_ARRAY(Scene, 1, err)));
    TRY(point_scene(figure->sweep, 0, figure->scene, err));
    figure_path(figure, "json", path);
    TRY((figure->json = json_create(path, err)));
    json_begin_object(figure->json, NULL);
    json_text(figure->json, "title", figure->sweep->study.title);
cleanup:
    return error_is_clean(err);
}

bool figure_end(Figure *figure, Error *err)
{
    char path[POINT_PATH_SIZE], png[POINT_PATH_SIZE];
    JsonWriter *json = figure->json;
    memory_free(figure->scene);
    figure_path(figure, "json", path);
    figure_path(figure, "png", png);
    if (!error_is_clean(err)) {
        json_abandon(json);
        return false;
    }
    json_end(json);
    if (json_finish(json, err)) amontons_render_plot_file(path, png, NULL, err);
    return error_is_clean(err);
}

static void write_numbers(JsonWriter *json, const char *key, const double *values, int32_t count)
{
    json_begin_list(json, key);
    for (int32_t k = 0; k < count; k++) json_number(json, NULL, values[k]);
    json_end(json);
}

void figure_write_axis(Figure *figure, const char *name, const FigureLabel *label, bool is_log)
{
    json_begin_object(figure->json, name);
    json_text(figure->json, "label", label->words);
    if (label->unit) json_text(figure->json, "unit", label->unit);
    json_text(figure->json, "scale", is_log ? "log" : "linear");
    json_end(figure->json);
}

// Of error bars: `low` or `high`.
static void write_bars(JsonWriter *json, const Curve *curve, const char *key, double sign)
{
    const double *value = curve->lying ? curve->x : curve->y;
    json_begin_list(json, key);
    for (int32_t k = 0; k < curve->count; k++)
        json_number(json, NULL, value[k] + sign * curve->error[k]);
    json_end(json);
}

void figure_write_curve(JsonWriter *json, const Curve *curve)
{
    json_begin_object(json, NULL);
    json_text(json, "label", curve->label);
    write_numbers(json, "x", curve->x, curve->count);
    write_numbers(json, "y", curve->y, curve->count);
    if (curve->error) write_bars(json, curve, "low", -1);
    if (curve->error) write_bars(json, curve, "high", 1);
    json_integer(json, "color", curve->color);
    json_text(json, "marker", curve->marked ? "circle" : "none");
    json_boolean(json, "filled", curve->filled);
    json_text(json, "line", curve->line);
    json_end(json);
}

// --- doubts -------------------------------------------------------------------------------------

static const uint32_t ERROR_NOT_KNOWN = (uint32_t)1 << WARNED_KINDS_MAX;

uint32_t figure_doubts(const SweepTable *table, int32_t point, bool has_error, double error)
{
    return table->warned.of[point] | (has_error && isnan(error) ? ERROR_NOT_KNOWN : 0);
}

void figure_write_doubts(Figure *figure, const Warned *warned, uint32_t doubts)
{
    const double nowhere = NAN;
    char names[2][WARNED_NAME_SIZE] = {"", ""}, label[2 * WARNED_NAME_SIZE];
    int32_t count = 0;
    for (int32_t k = 0; k <= WARNED_KINDS_MAX; k++) {
        char name[WARNED_NAME_SIZE] = "error not known";
        if (!(doubts >> k & 1)) continue;
        if (k < WARNED_KINDS_MAX) warned_name(warned, k, name);
        if (strcmp(name, names[0]) == 0 || strcmp(name, names[1]) == 0) continue;
        if (count < 2) memcpy(names[count], name, sizeof name);
        count++;
    }
    for (int32_t k = 0; k < count && k < 2; k++) {
        snprintf(label, sizeof label, "open: %.47s%s", names[k],
                 k == 1 && count > 2 ? ", others" : "");
        Curve marks = {.label = label, .line = "none", .count = 1, .marked = true};
        marks.x = marks.y = &nowhere;
        figure_write_curve(figure->json, &marks);
    }
}
