// SPDX-License-Identifier: GPL-2.0-or-later
// Readings of the probes of a result, by quantities and components. Called by figure_probes,
// figure_data and measured.
#ifndef AMONTONS_RENDER_FIGURES_PROBE_DATA_H
#define AMONTONS_RENDER_FIGURES_PROBE_DATA_H

#include "io/text/csv_writer.h"
#include "render/view/result_view.h"

// X(symbol, name, series, symbol in pictures, unit in SI, unit in normalised scenes)
#define PROBE_QUANTITIES(X)                                                                        \
    X(PROBE_STRAIN, "strain", SERIES_PROBE_STRAIN, "~{\u03b5}", "", "")                            \
    X(PROBE_STRESS, "stress", SERIES_PROBE_STRESS, "~{\u03c3}", "Pa", "~{E}")                      \
    X(PROBE_DISPLACEMENT, "displacement", SERIES_PROBE_DISPLACEMENT, "~{u}", "m", "~{L}_{0}")      \
    X(PROBE_VELOCITY, "velocity", SERIES_PROBE_VELOCITY, "~{v}", "m/s", "(~{L}_{0} / ~{t}_{0})")

typedef enum ProbeQuantity {
#define X(symbol, ...) symbol,
    PROBE_QUANTITIES(X) PROBE_QUANTITY_COUNT
#undef X
} ProbeQuantity;

enum { PROBE_COMPONENTS_MAX = 6, PROBE_NAME_SIZE = 64 };

typedef struct ProbeWords {
    const char *name, *symbol, *si, *normalised;
} ProbeWords;
ProbeWords probe_words(ProbeQuantity quantity);

// The quantity called `name`, NULL the first; ERROR_INPUT names those there are.
bool probe_quantity_find(const char *name, ProbeQuantity *quantity, Error *err);

// Number of its components, and the name of component c: "xx", "z".
int32_t probe_components(const ResultView *view, ProbeQuantity quantity);
const char *probe_component(const ResultView *view, ProbeQuantity quantity, int32_t c);

void probe_name(const ResultView *view, int32_t probe, char name[PROBE_NAME_SIZE]);

// Name of the column of a table with component c of a probe: "gauge1 strain_xx".
enum { PROBE_COLUMN_SIZE = PROBE_NAME_SIZE + 24 };
void probe_column(const ResultView *view, int32_t probe, ProbeQuantity quantity, int32_t c,
                  char name[PROBE_COLUMN_SIZE]);
// Writes that name to a header of a csv file, with the unit where the result is in SI.
void probe_column_csv(TextWriter *csv, const ResultView *view, int32_t probe,
                      ProbeQuantity quantity, int32_t c);

// *values [rows][probes][components], the caller's; `rows` may shrink. ERROR_INPUT: there are no
// probes.
bool probe_read(ResultView *view, ProbeQuantity quantity, double **values, Error *err);

#endif
