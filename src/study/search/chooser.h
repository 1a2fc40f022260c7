// SPDX-License-Identifier: GPL-2.0-or-later
// Chooses designs one by one, by the values of those before: dlib's global search (an upper bound
// from the steepest slopes met so far, in turn with a trust region about the best), in a module
// opened on first use. Values may be noisy, and may be told in any order. Called by search.
#ifndef AMONTONS_STUDY_SEARCH_CHOOSER_H
#define AMONTONS_STUDY_SEARCH_CHOOSER_H

#include "base/error.h"

#include <stdint.h>

typedef struct ChooserSpace {
    int32_t count;   // keys
    const double *least, *most;   // [count]
    const bool *whole;   // [count] whole numbers
    uint32_t seed;
    int32_t known;   // values that are known to begin with
    const double *places, *values;   // [known * count], [known]
} ChooserSpace;

typedef struct Chooser Chooser;   // the module's own

// The module's one entry, "amontons_chooser_module": a table that lasts as long as the program. No
// call throws; false: ERROR_LIBRARY, with dlib's words.
typedef struct ChooserModule {
    Chooser *(*create)(const ChooserSpace *space, Error *err);
    bool (*choose)(Chooser *chooser, double *x, int32_t *number, Error *err);   // x: [count]
    // Tells the value of the choice `number`, the larger the better; finite. Called once for each.
    bool (*tell)(Chooser *chooser, int32_t number, double value, Error *err);
    void (*destroy)(Chooser *chooser);   // NULL is fine
} ChooserModule;
typedef const ChooserModule *(*ChooserModuleFunction)(void);

#endif
