// SPDX-License-Identifier: GPL-2.0-or-later
// Data of a plot from each sweep: its quantities, and which points belong together. Called by
// figure_plot.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_PLOT_SOURCES_H
#define AMONTONS_STUDY_SWEEP_SHOWING_PLOT_SOURCES_H

#include "study/sweep/showing/plot_table.h"

enum { SOURCES_MAX = 1 + PLOT_WITH_MAX, VALUES_MAX = 24, GROUP_LABEL_SIZE = 96 };

// The different values of a key, in the order of the points; one without value where none is asked.
typedef struct Values {
    const Quantity *key;   // NULL: all points belong together
    int32_t count;
    double value[VALUES_MAX];
} Values;

// One sweep.
typedef struct Source {
    PlotTable table;   // owned, as the next
    Quantity made[PLOT_KEYS];   // of formulas
    const Quantity *quantity[PLOT_KEYS];   // NULL: not asked for
    Values series, panels;
    uint32_t *doubts;   // [table.count] bits: of the names in source_open, and the last one: error
        // not known; owned
} Source;

// doubts: names of what its runs are warned of are added where they lack. ERROR_INPUT: a name that
// the table does not have, words where numbers are needed, too many values of a key.
bool source_open(const char *folder, const StudyPlot *plot, WordList *doubts, Source *source,
                 Error *err);
void source_close(Source *source);   // zeroed is fine

bool values_hold(const Values *values, int32_t which, int32_t point);   // of the which-th value?
// "length = 0.25", "kind = push"; empty where there is no key. name: of the key.
void values_label(const Values *values, int32_t which, const char *name,
                  char label[GROUP_LABEL_SIZE]);
// Whether a logarithmic axis suits [count] values: above 0, and nearer to equal ratios than to
// equal differences.
bool values_suit_log(const double *values, int32_t count, bool *suits, Error *err);

#endif
