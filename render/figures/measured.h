// SPDX-License-Identifier: GPL-2.0-or-later
// Measurements from a table (io/text/csv_reader), to be drawn beside a result. Called by the
// figures.
//
// The first line names the columns, with units behind them; columns of other names are left alone
// (a `source`, a remark). Which columns there are says what was measured, and which figure has it:
//
//     U (mm), F_T/F_N, error          force: the load ratio over the rod's way, or over `t (s)`
//     U/L, x/L                         slip-map: how far slip has come
//     t (ms), x (mm), A/A_0            contact-area, or contact-density: area over that at rest
//     F_T/F_N, l (mm)                  precursors: how long slip is at that load ratio
//     U (mm), gauge1 strain_xx         probes: what the probe gauge1 saw; several columns
//     x/L, v/c_R                       front-speed: how fast the front of slip runs over x
//
// `mu` is F_T/F_N; so are the columns F_T and F_N, each with its unit or both without. A quantity
// stands once: U (mm) beside U/L is refused. `error` is what one reads or measures the last of
// these to, in its unit.
#ifndef AMONTONS_RENDER_FIGURES_MEASURED_H
#define AMONTONS_RENDER_FIGURES_MEASURED_H

#include "render/canvas/axes.h"
#include "render/canvas/key.h"
#include "render/figures/computed.h"
#include "render/figures/probe_data.h"

enum { MEASURED_WORDS_SIZE = 200 };

// A word of the column `event`, beside those of events (render/view/result_view).
#define MEASURED_FARTHEST "farthest so far"

// Names and units of each kind in tables, and the number that its misfit is over.
typedef struct MeasuredWords {
    const char *at, *at_unit, *value, *unit;   // units: in SI; NULL: none
    const char *over, *over_words;   // in a table and in a legend; "": the misfit is over nothing
    ResultNumber number;
} MeasuredWords;
extern const MeasuredWords MEASURED_WORDS[MEASURED_KINDS];

typedef struct Measured {
    MeasuredKind kind;
    const char *path;   // borrowed
    int32_t count;
    double *at;   // [count] U; of MEASURED_LENGTH F_T/F_N, of MEASURED_SPEED x; owned, as the rest
    double *x;   // [count] of MEASURED_AREA; of MEASURED_LENGTH the load of the event beside which
        // it stands; of MEASURED_PROBE which column: the number of the
        // probe times PROBE_COMPONENTS_MAX, plus that of the component
    ProbeQuantity quantity;   // of MEASURED_PROBE
    double *value;   // [count] 1, length or velocity
    double *error;   // [count] NaN: not given
    double *computed;   // [count] NaN: not covered
    bool matched;   // lengths stand beside events, those nearest in load; else beside the curve
    int32_t compared;   // points that the result covers
    double misfit, in_errors;   // as below; NaN: not known
    char words[MEASURED_WORDS_SIZE];   // for a legend: the file's name and the misfit
} Measured;

// Reads the values that the file has for `kind`, and computes those of the result there; count 0:
// nothing, or no file is given (path NULL). The misfit is the root of the mean square of measured
// less computed values, over the points that the result covers; it is in units of the errors too
// where all points have one.
bool measured_read(const char *path, MeasuredKind kind, ResultView *view, Measured *measured,
                   Error *err);
void measured_destroy(Measured *measured);   // zeroed is fine
// Finds if the file has `kind`.
bool measured_has(const char *path, MeasuredKind kind, const ResultView *view, bool *has,
                  Error *err);

// Adds it to the entries of a key, if there is any; returns how many these are then.
int32_t measured_key(const Measured *measured, KeyMark mark, KeyEntry *entries, int32_t count);
// Discs with bars as long as the errors on both sides. component: of MEASURED_PROBE, in the colours
// of the probes; -1: all, in a colour of their own.
void measured_draw(const Page *page, const Measured *measured, int32_t component, const Axes *axes);

#endif
