// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/result/figure_file.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/files/folder.h"
#include "run/result/pictures.h"

#include <math.h>
#include <stdio.h>

enum { TEXT_NUMBERS_MAX = 8000, NAME_SIZE = 24 };

static bool figure_path(const Figure *figure, const char *ending, char path[AMONTONS_PATH_SIZE],
                        Error *err)
{
    if (snprintf(path, AMONTONS_PATH_SIZE, "%s/figures/%s.%s", figure->folder, figure->name,
                 ending) >= AMONTONS_PATH_SIZE)
        return REFUSE(err, "the path of the folder %s is too long", figure->folder);
    return true;
}

bool figure_begin(Figure *figure, Error *err)
{
    char path[AMONTONS_PATH_SIZE], name[AMONTONS_PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/figures", figure->folder) >= (int)sizeof path)
        return REFUSE(err, "the path of the folder %s is too long", figure->folder);
    if (!folder_make_inside(figure->folder, "figures", err)) return false;
    if (!figure_path(figure, "json", name, err)) return false;
    if (!(figure->json = json_create(name, err))) return false;
    json_begin_object(figure->json, NULL);
    json_text(figure->json, "title", figure->title);
    json_begin_object(figure->json, "page");   // what it shows is said where it is printed
    json_text(figure->json, "title", "none");
    if (figure->compare) {
        char file[AMONTONS_PATH_SIZE];
        folder_relative(path, figure->compare, file, sizeof file);
        json_text(figure->json, "compare", file);
    }
    json_end(figure->json);
    return true;
}

bool figure_end(Figure *figure, Error *err)
{
    char path[AMONTONS_PATH_SIZE], picture[AMONTONS_PATH_SIZE];
    const char *ending = figure->style && figure->style->format ? figure->style->format : "png";
    if (!error_is_clean(err)) {
        json_abandon(figure->json);
        array_file_abandon(figure->arrays);
        return false;
    }
    json_end(figure->json);
    ArrayFile *arrays = figure->arrays;
    figure->arrays = NULL;
    bool written = json_finish(figure->json, err);
    if (!array_file_close(arrays, err) || !written) return false;   // closed in any case
    Error no_pictures = {0};   // in this build: the description stays, for one that has them
    if (!module_check("render", &no_pictures)) return true;
    return figure_path(figure, "json", path, err) && figure_path(figure, ending, picture, err) &&
           pictures_draw_plot(path, picture, figure->style, err);
}

bool figure_write_numbers(Figure *figure, const char *key, const double *values, int32_t count,
                          Error *err)
{
    if (figure->folder && figure->written + count > TEXT_NUMBERS_MAX) {
        // A long array becomes a column of figures/NAME.h5, and the text says which.
        char path[AMONTONS_PATH_SIZE], name[NAME_SIZE], place[AMONTONS_PATH_SIZE];
        ArraySeries series = {.name = name,
                              .type = ARRAY_FLOAT64,
                              .width = 1,
                              .unit = "of the scene",
                              .description = "drawn by the file of the same name"};
        snprintf(name, sizeof name, "%.12s_%d", key, figure->stored++);
        if (!figure->arrays && !figure_path(figure, "h5", path, err)) return false;
        if (!figure->arrays && !(figure->arrays = array_file_create(path, err))) return false;
        if (!array_file_write(figure->arrays, &series, values, 0, count, err)) return false;
        snprintf(place, sizeof place, "%.200s.h5:%s", figure->name, name);
        json_text(figure->json, key, place);
        return true;
    }
    figure->written += count;
    json_number_list(figure->json, key, values, count);
    return true;
}

void figure_write_axis(Figure *figure, const char *name, const char *words, const char *unit,
                       const char *column, const char *scale)
{
    json_begin_object(figure->json, name);
    json_text(figure->json, "label", words);
    if (unit) json_text(figure->json, "unit", unit);
    if (column) json_text(figure->json, "column", column);
    if (scale) json_text(figure->json, "scale", scale);
    json_end(figure->json);
}

bool figure_write_curve(Figure *figure, const Curve *curve, Error *err)
{
    JsonWriter *json = figure->json;
    const double *value = curve->lying ? curve->x : curve->y;
    double *ends = NULL;   // of error bars
    json_begin_object(json, NULL);
    json_text(json, "label", curve->label);
    TRY(figure_write_numbers(figure, "x", curve->x, curve->count, err));
    TRY(figure_write_numbers(figure, "y", curve->y, curve->count, err));
    if (curve->error) {
        TRY(ends = NEW_ARRAY(double, curve->count, err));
        for (int32_t k = 0; k < curve->count; k++) ends[k] = value[k] - curve->error[k];
        TRY(figure_write_numbers(figure, "low", ends, curve->count, err));
        for (int32_t k = 0; k < curve->count; k++) ends[k] = value[k] + curve->error[k];
        TRY(figure_write_numbers(figure, "high", ends, curve->count, err));
    }
    json_integer(json, "color", curve->color);
    json_text(json, "marker", curve->marker ? curve->marker : "none");
    json_boolean(json, "filled", curve->filled);
    json_text(json, "line", curve->line);
    json_end(json);
cleanup:
    memory_free(ends);
    return error_is_clean(err);
}

bool figure_write_entry(Figure *figure, const Curve *curve, Error *err)
{
    static const double nowhere = NAN;
    Curve entry = *curve;
    entry.count = 1;
    entry.x = entry.y = &nowhere;
    entry.error = NULL;
    return figure_write_curve(figure, &entry, err);
}

bool figure_write_doubts(Figure *figure, int32_t doubts, bool map, Error *err)
{
    Curve open = {.label = "open: warned", .line = "none", .marker = "circle"};
    Curve bare = {.label = map ? "error not known" : "without a bar: error not known",
                  .line = "none",
                  .marker = map ? "square" : NULL};
    if (doubts & DOUBT_WARNED && !figure_write_entry(figure, &open, err)) return false;
    if (doubts & DOUBT_NO_ERROR && !figure_write_entry(figure, &bare, err)) return false;
    return true;
}
