// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/state_scale.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

enum { COUNTED_MOST = 200000 };   // of a long history every second row, or third, ...

// As it is written in formulas: a Greek letter by its name.
static const char *letter_of(const char *name)
{
    static const char *const greek[][2] = {
        {"theta", "~{\u03b8}"}, {"phi", "~{\u03c6}"}, {"chi", "~{\u03c7}"}, {"psi", "~{\u03c8}"}};
    for (size_t k = 0; k < sizeof greek / sizeof *greek; ++k)
        if (strcmp(greek[k][0], name) == 0) return greek[k][1];
    return name;
}

ValueWords state_words(const ResultView *view, char name[VIEW_STATE_SIZE])
{
    bool time = strcmp(view->state_unit, "time") == 0;
    result_view_state_name(view, name);
    return (ValueWords){.words = letter_of(name),
                        .si = time ? "s" : "",
                        .normalised = time ? "~{t}_{0}" : "",
                        .in_si = view->si,
                        .decades = strcmp(view->state_unit, "1") != 0};
}

bool state_scale(const ResultView *view, const double range[2], const double *states,
                 const PictureStyle *style, Colorbar *bar, Error *err)
{
    char name[VIEW_STATE_SIZE];
    ValueWords words = state_words(view, name);
    int64_t total = view->rows * view->nodes, every = 1 + total / COUNTED_MOST, count = 0;
    WeighedValue *values = NEW_ARRAY(WeighedValue, total / every + view->nodes, err);
    TRY(values);
    for (int64_t row = 0; row < view->rows; row += every)
        for (int32_t i = 0; i < view->nodes && view->U[row] >= range[0] && view->U[row] <= range[1];
             ++i)
            values[count++] = (WeighedValue){states[row * view->nodes + i], 1};
    TRY(value_bar_fit(values, count, &words, style, bar, err));
cleanup:
    memory_free(values);
    return error_is_clean(err);
}
