// SPDX-License-Identifier: GPL-2.0-or-later
// Answers of a run about the load ratio mu = F_T / F_N, defined here and nowhere else. The load
// drops (record/drops) come to repeat with a period, or they do not (answers/statistics): those of
// this regime count, the start's do not.
//   mu_M      macroscopic static friction coefficient: mean of the peaks before bulk sliding. In a
//             period it is that of whole rounds
//   mu_hold   holding coefficient, what the contact holds for sure: the lowest load drop that
//             repeats; where none does the lowest decile (one in ten comes earlier), as the lowest
//             would sink with every drop waited for
//   mu_max    the largest mu of all steps
// Errors are bars that hold in 19 of 20 cases. A run alone knows the part that its finite number of
// drops leaves open; what mesh and branches add takes several runs (answers/error_bars).
#ifndef AMONTONS_ANSWERS_ANSWERS_H
#define AMONTONS_ANSWERS_ANSWERS_H

#include "answers/regime.h"
#include "io/text/json_writer.h"
#include "record/drops.h"
#include "record/steady.h"

// Standard errors in an error bar: 95 % of normal deviates.
enum { ERROR_BAR = 2 };

typedef struct ErrorParts {   // NaN: not known
    double mesh, branches, drops;
} ErrorParts;

// The first loading, which an experiment measures: from where the rod starts to the first sliding
// of the whole block. It begins from a block that nobody has pushed, so that its peak and its
// precursors are not those of later cycles, which are given beside it.
typedef struct FirstLoading {
    bool slid;   // the block came to slide as a whole, from rest
    Estimate mu;   // the largest mu before it did; one value, whose error only several runs tell
    ErrorParts parts;   // of this error
    double known_to;   // as Answers has it of mu_M, and what one precursor more or less changes
    // Rise of mu up to its largest since the last precursor before that began; 0: none was.
    double since_precursor;
    double U;   // where mu was so large, length
    int32_t precursors;   // bounded rapid events before it; so far, where it has not slid
    double longest;   // length of the longest of them, length; 0: none
    // l_c of the first sliding, length; NaN: as of a Drop, or more than half of what slipped when
    // slip turned fast was elsewhere than behind the front
    double critical_length;
    double critical_part;   // A_c/A of it
} FirstLoading;

// Cycles that count for mu_M, but for the first loading. NaN: there is none.
typedef struct LaterCycles {
    int32_t count;
    double way;   // of the rod from peak to peak, length
    double precursors;   // bounded rapid events in a cycle
    double longest;   // length of the longest precursor of a cycle, length
} LaterCycles;   // means over the cycles

typedef struct Answers {
    Regime regime;   // of the load drops
    int32_t first;   // number in drops->list of the first drop that counts
    bool enough;   // more drops would tell nothing new: run-in is over, and they repeat or 30 and
        // more have a mean known to 2 %
    bool steady;   // mu_M is that of steady sliding (record/steady)
    Estimate mu_M;   // error: twice the standard error
    ErrorParts mu_M_parts, mu_hold_parts;   // of the errors
    double mu_M_low, mu_M_high;   // smallest and largest peak that counts; NaN: none
    double mu_M_spread;   // their difference; NaN: fewer than two
    int32_t peaks, peaks_counted;   // bulk slidings; those that count
    int32_t period;   // bulk slidings in a round; 0: load drops do not repeat, or none is one
    Estimate mu_hold;   // error: half the range of the lowest branch, or twice the standard error
    Estimate mu_drops;   // mean of the load drops; error: twice the standard error
    double mu_max, mu_max_jump;   // how far it is above both of its neighbours in time
    // Usual distance of other meshes and runs from these: the bar, where one is known; else the
    // error that nine of ten meshes keep (answers/error_bars). NaN: cells are too long for slip.
    double mu_M_known_to, mu_hold_known_to, mu_max_known_to;
    double critical_length;   // mean l_c of the peaks that count, length; NaN: none
    double critical_part;   // mean A_c/A of them; NaN: none
    double subcritical_length;   // mean l_sc of those that have one
    FirstLoading first_loading;
    LaterCycles later_cycles;
} Answers;

Answers answers_of(const Drops *drops);
FirstLoading first_loading_of(const Drops *drops);
LaterCycles later_cycles_of(const Drops *drops, int32_t first);   // from drop number `first` on

// Where no bulk sliding counts mu_M is that of steady sliding, its error half the range in which it
// keeps; other meshes have another, as with load drops.
void steady_answer(const Steady *steady, Answers *answers);
// The meaning of mu_M: "peaks", "steady sliding", or "none: " and why.
const char *steady_words(const Steady *steady, const Answers *answers);   // static storage

void error_parts_write(const ErrorParts *parts, JsonWriter *json);   // into the open object

// Into results: answers, peaks, drops, pad_slidings; peaks alone. length: L.
void answers_write_json(const Answers *answers, const Drops *drops, double length,
                        JsonWriter *json);
void answers_write_peaks(const Answers *answers, const Drops *drops, double length,
                         JsonWriter *json);
// Into results: mu_M_is, mu_steady, its error and from where on.
void steady_write_json(const Steady *steady, const Answers *answers, JsonWriter *json);

#endif
