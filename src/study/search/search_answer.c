// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/search_answer.h"

#include "io/files/part_file.h"
#include "io/text/json_writer.h"
#include "scene/keys.h"

#include <stdlib.h>

bool search_answer_begin(SearchAnswer *answer, Error *err)
{
    *answer = (SearchAnswer){0};
    answer->out = open_memstream(&answer->text, &answer->size);
    return answer->out || FAULT(err, ERROR_MEMORY, "no memory for the answer");
}

bool search_answer_end(const Search *search, SearchAnswer *answer, Error *err)
{
    char path[POINT_PATH_SIZE];
    if (fclose(answer->out) != 0) FAIL(err, ERROR_MEMORY, "no memory for the answer");
    if (search->options->out) fputs(answer->text, search->options->out);
    snprintf(path, sizeof path, "%s/answer.txt", search->options->folder);
    TRY(part_file_put(path, false, answer->text, (int64_t)answer->size, err));
cleanup:
    free(answer->text);
    return error_is_clean(err);
}

void search_print_exhausted(const Search *search, FILE *out)
{
    if (search->exhausted)
        fprintf(out,
                "  fewer designs than asked for: all others that were tried are so near one that "
                "was computed that they count as it, or are not allowed\n");
}

// JSON is YAML.
bool search_leave_best(const Search *search, int32_t design, int32_t condition, Error *err)
{
    const char *folder = search->options->folder;
    char path[POINT_PATH_SIZE], picture[POINT_PATH_SIZE];
    int32_t point = search->designs.list[design].point + condition;
    JsonWriter *json = NULL;
    SearchAnswer nowhere;   // what is said of the mesh beside its picture
    if (!search_answer_begin(&nowhere, err)) return false;
    snprintf(path, sizeof path, "%s/best.yaml", folder);
    snprintf(picture, sizeof picture, "%s/figures/best.png", folder);
    const Scene *scene = point_scene(search->sweep, point, err);
    TRY(scene);
    TRY(json = json_create(path, err));
    scene_write_json(scene, json, NULL, folder);
    TRY(json_finish(json, err));
    TRY(amontons_info(path, &(InfoOptions){.picture = picture}, nowhere.out, err));
cleanup:
    fclose(nowhere.out);
    free(nowhere.text);
    return error_is_clean(err);
}

// --- figures ------------------------------------------------------------------------------------

Curve search_dots(const char *label, int32_t count, const double *x, const double *y)
{
    return (Curve){.label = label,
                   .line = "none",
                   .marker = "circle",
                   .color = COLOR_DESIGNS,
                   .count = count,
                   .filled = true,
                   .x = x,
                   .y = y};
}

Curve search_line(const char *label, int32_t count, const double *x, const double *y)
{
    return (Curve){
        .label = label, .line = "solid", .color = COLOR_LINE, .count = count, .x = x, .y = y};
}

QuantityLabel search_key_label(const Search *search, int32_t k)
{
    return quantity_label(search->study->search.keys[k].key,
                          search->sweep->scene->units == UNITS_SI);
}

const char *search_key_scale(const Search *search, int32_t k)
{
    return search->study->search.keys[k].scale == SEARCH_LOG ? "log" : "linear";
}

bool search_draw(const Search *search, const Frame *frame, const Curve *curves, int32_t count,
                 Error *err)
{
    Figure figure = {
        .folder = search->options->folder, .name = frame->name, .title = search->study->title};
    if (!figure_begin(&figure, err)) return false;
    figure_write_axis(&figure, "x", frame->x.words, frame->x.unit, frame->x.column, frame->x_scale);
    figure_write_axis(&figure, "y", frame->y.words, frame->y.unit, frame->y.column, frame->y_scale);
    json_begin_list(figure.json, "series");
    for (int32_t k = 0; k < count && error_is_clean(err); k++)
        figure_write_curve(&figure, &curves[k], err);
    json_end(figure.json);
    figure_end(&figure, err);
    return error_is_clean(err);
}
