// SPDX-License-Identifier: GPL-2.0-or-later
// The first loading, which an experiment measures: from where the rod starts to the first sliding
// of the whole block. It begins from a block that nobody has pushed, so that its peak and its
// precursors are not those of later cycles, which are given beside it.
#ifndef AMONTONS_ANSWERS_FIRST_LOADING_H
#define AMONTONS_ANSWERS_FIRST_LOADING_H

#include "io/text/json_writer.h"
#include "record/drops.h"

typedef struct ErrorParts {   // NaN: not known
    double mesh, branches, drops;
} ErrorParts;

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

FirstLoading first_loading_of(const Drops *drops);
LaterCycles later_cycles_of(const Drops *drops, int32_t first);   // from drop number `first` on

// Objects `first` and `later_cycles` of results. length: L.
void first_loading_write_json(const FirstLoading *first, const LaterCycles *later,
                              const Events *events, double length, JsonWriter *json);

#endif
