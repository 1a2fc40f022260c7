// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/search_figure.h"

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
    return label_of_key(search->study->search.keys[k].key, search->sweep->scene->units == UNITS_SI);
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
    figure_write_axis(&figure, "x", &frame->x, frame->x_scale);
    figure_write_axis(&figure, "y", &frame->y, frame->y_scale);
    json_begin_list(figure.json, "series");
    for (int32_t k = 0; k < count && error_is_clean(err); k++)
        figure_write_curve(&figure, &curves[k], err);
    json_end(figure.json);
    figure_end(&figure, err);
    return error_is_clean(err);
}
