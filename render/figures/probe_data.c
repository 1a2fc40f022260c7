// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/probe_data.h"

#include <stdio.h>
#include <string.h>

static const struct {
    ProbeWords words;
    ResultSeries series;
} QUANTITIES[PROBE_QUANTITY_COUNT] = {
#define X(symbol, name, series, letter, si, normalised) {{name, letter, si, normalised}, series},
    PROBE_QUANTITIES(X)
#undef X
};

ProbeWords probe_words(ProbeQuantity quantity)
{
    return QUANTITIES[quantity].words;
}

bool probe_quantity_find(const char *name, ProbeQuantity *quantity, Error *err)
{
    char names[100] = "";
    *quantity = PROBE_STRAIN;
    for (int32_t k = 0; name && k < PROBE_QUANTITY_COUNT; ++k) {
        size_t used = strlen(names);
        *quantity = (ProbeQuantity)k;
        if (strcmp(name, QUANTITIES[k].words.name) == 0) return true;
        snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "",
                 QUANTITIES[k].words.name);
    }
    return !name || REFUSE(err, "probes show nothing called \"%.40s\"; known are: %s", name, names);
}

static bool in_space(const ResultView *view)
{
    return view->number[NUMBER_FORMAT] > 1;
}

static bool is_vector(ProbeQuantity quantity)
{
    return quantity == PROBE_DISPLACEMENT || quantity == PROBE_VELOCITY;
}

int32_t probe_components(const ResultView *view, ProbeQuantity quantity)
{
    if (is_vector(quantity)) return in_space(view) ? 3 : 2;
    return in_space(view) ? 6 : 3;
}

const char *probe_component(const ResultView *view, ProbeQuantity quantity, int32_t c)
{
    static const char *const axes[2][3] = {{"x", "z", ""}, {"x", "y", "z"}};
    static const char *const pairs[2][PROBE_COMPONENTS_MAX] = {
        {"xx", "zz", "xz", "", "", ""}, {"xx", "yy", "zz", "xy", "yz", "xz"}};
    return is_vector(quantity) ? axes[in_space(view)][c] : pairs[in_space(view)][c];
}

void probe_name(const ResultView *view, int32_t probe, char name[PROBE_NAME_SIZE])
{
    int length = 0;
    const char *own = result_view_name(view->probe_names, probe, &length);
    snprintf(name, PROBE_NAME_SIZE, "%.*s", length, length > 0 ? own : "");
}

void probe_column(const ResultView *view, int32_t probe, ProbeQuantity quantity, int32_t c,
                  char name[PROBE_COLUMN_SIZE])
{
    char own[PROBE_NAME_SIZE];
    probe_name(view, probe, own);
    snprintf(name, PROBE_COLUMN_SIZE, "%s %s_%s", own, QUANTITIES[quantity].words.name,
             probe_component(view, quantity, c));
}

bool probe_read(ResultView *view, ProbeQuantity quantity, double **values, Error *err)
{
    int64_t rows = 0;
    int32_t width = 0;
    if (view->probes == 0)
        return REFUSE(err, "the result has no probes: a scene gives them as output.probes");
    if (!result_file_read_series(view->file, QUANTITIES[quantity].series, values, &rows, &width,
                                 err))
        return false;
    if (width != view->probes * probe_components(view, quantity))
        return FAULT(err, ERROR_FILE, "%s has %d columns, but there are %d probes",
                     result_series_name(QUANTITIES[quantity].series), width, view->probes);
    if (rows < view->rows) view->rows = rows;
    return true;
}

// The name of a probe's column, with its unit where the result is in SI.
void probe_column_csv(TextWriter *csv, const ResultView *view, int32_t probe,
                      ProbeQuantity quantity, int32_t c)
{
    char name[PROBE_COLUMN_SIZE];
    probe_column(view, probe, quantity, c, name);
    csv_heading(csv, name, view->si ? probe_words(quantity).si : NULL);
}
