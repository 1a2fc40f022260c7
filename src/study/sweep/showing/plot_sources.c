// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/showing/plot_sources.h"

#include "base/memory.h"
#include "base/order.h"
#include "study/sweep/showing/figure_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DOUBTS_MAX = 31 };   // names; the last one stands for all that are more

static const double LOG_SUITS = 0.75;   // scatter of ratios (their logarithms) over that of steps

// ERROR_INPUT: too many.
static bool find_values(const Source *source, const Quantity *key, const char *name, Values *values,
                        Error *err)
{
    *values = (Values){.key = key};
    values->count = key ? 0 : 1;
    for (int32_t k = 0; key && k < source->table.count; k++) {
        int32_t at = 0;
        while (at < values->count && values->value[at] != key->values[k]) at++;
        if (at < values->count || isnan(key->values[k])) continue;
        if (values->count == VALUES_MAX)
            return REFUSE(err, "plot: %s has more than %d values: too many curves or panels", name,
                          VALUES_MAX);
        values->value[values->count++] = key->values[k];
    }
    return true;
}

static bool find_quantities(Source *source, const StudyPlot *plot, Error *err)
{
    for (PlotKey key = PLOT_X; key < PLOT_KEYS; key++) {
        if (!plot->text[key][0]) continue;
        source->quantity[key] =
            plot_table_find(&source->table, plot->text[key], &source->made[key], err);
        if (!source->quantity[key]) return false;
        if (key < PLOT_SERIES && source->quantity[key]->words.count > 0)
            return REFUSE(err,
                          "plot: %s has words, not numbers: it can be the `series` or the `panels`",
                          plot->text[key]);
    }
    return error_is_clean(err);
}

// Bits of the sweep's own names of warnings become those of all sweeps' names. The errors that
// count are those of what is shown: of y, or of a map's colour.
static bool find_doubts(Source *source, bool is_map, WordList *doubts, Error *err)
{
    const PlotTable *table = &source->table;
    const Quantity *shown = source->quantity[is_map ? PLOT_COLOR : PLOT_Y];
    double place[DOUBTS_MAX];
    int32_t kinds = table->kinds.count < DOUBTS_MAX ? table->kinds.count : DOUBTS_MAX;
    if (!(source->doubts = NEW_ARRAY(uint32_t, table->count, err))) return false;
    for (int32_t kind = 0; kind < kinds; kind++)
        if (!words_index(doubts, table->kinds.words[kind], &place[kind], err)) return false;
    for (int32_t k = 0; k < table->count; k++) {
        for (int32_t kind = 0; kind < kinds; kind++)
            if ((uint32_t)table->warned[k] >> kind & 1)
                source->doubts[k] |= (uint32_t)1 << (int32_t)fmin(place[kind], DOUBTS_MAX - 1);
        if (shown->errors && isnan(shown->errors[k])) source->doubts[k] |= DOUBT_NO_ERROR;
    }
    return true;
}

bool source_open(const char *folder, const StudyPlot *plot, WordList *doubts, Source *source,
                 Error *err)
{
    return plot_table_open(folder, &source->table, err) && find_quantities(source, plot, err) &&
           find_doubts(source, plot->text[PLOT_COLOR][0], doubts, err) &&
           find_values(source, source->quantity[PLOT_SERIES], plot->text[PLOT_SERIES],
                       &source->series, err) &&
           find_values(source, source->quantity[PLOT_PANELS], plot->text[PLOT_PANELS],
                       &source->panels, err);
}

void source_close(Source *source)
{
    for (int32_t k = 0; k < PLOT_KEYS; k++) quantity_destroy(&source->made[k]);
    memory_free(source->doubts);
    plot_table_close(&source->table);
}

bool values_hold(const Values *values, int32_t which, int32_t point)
{
    return !values->key || values->key->values[point] == values->value[which];
}

void values_label(const Values *values, int32_t which, const char *name,
                  char label[GROUP_LABEL_SIZE])
{
    const char *word = label_last_word(name);
    label[0] = 0;
    if (!values->key) return;
    if (values->key->words.count > 0)
        snprintf(label, GROUP_LABEL_SIZE, "%.40s = %.40s", word,
                 values->key->words.words[(int32_t)values->value[which]]);
    else {
        // "~{L} / ~{L}_{0} = 0.25", in SI "~{L} = 0.25 m"; without a symbol the last word of the
        // key.
        const QuantityLabel *key = &values->key->label;
        const char *mark = strstr(key->words, "~{");
        if (mark && !strstr(mark, "(of")) word = mark;
        snprintf(label, GROUP_LABEL_SIZE, "%.60s = %.4g%s%s", word, values->value[which],
                 key->unit ? " " : "", key->unit ? key->unit : "");
    }
}

// --- scale --------------------------------------------------------------------------------------

// Standard deviation over mean of the differences of [count] rising values, or of the logarithms of
// their ratios.
static double step_scatter(const double *values, int32_t count, bool of_ratios)
{
    double sum = 0, squares = 0, steps = count - 1;
    for (int32_t k = 0; k + 1 < count; k++) {
        double step = of_ratios ? log(values[k + 1] / values[k]) : values[k + 1] - values[k];
        sum += step;
        squares += step * step;
    }
    double mean = sum / steps;
    return sqrt(fmax(squares / steps - mean * mean, 0)) / mean;
}

bool values_suit_log(const double *values, int32_t count, bool *suits, Error *err)
{
    int32_t kept = 0;
    double *sorted = NEW_ARRAY(double, count, err);
    *suits = false;
    if (!sorted) return false;
    for (int32_t k = 0; k < count; k++)
        if (isfinite(values[k])) sorted[kept++] = values[k];
    qsort(sorted, (size_t)kept, sizeof *sorted, order_doubles);
    int32_t found = kept > 0;
    for (int32_t k = 1; k < kept; k++)
        if (sorted[k] > sorted[found - 1]) sorted[found++] = sorted[k];
    if (found > 2 && sorted[0] > 0)
        *suits = step_scatter(sorted, found, true) < LOG_SUITS * step_scatter(sorted, found, false);
    memory_free(sorted);
    return true;
}
