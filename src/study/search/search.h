// SPDX-License-Identifier: GPL-2.0-or-later
// A search under way: designs that a library chooses by the values of those before, computed in
// rounds of one sweep. What a design is worth says whoever searches. Shared by optimise and fit.
#ifndef AMONTONS_STUDY_SEARCH_SEARCH_H
#define AMONTONS_STUDY_SEARCH_SEARCH_H

#include "study/search/chooser.h"
#include "study/search/designs.h"
#include "study/sweep/sweep.h"

typedef struct Search Search;

// Judge of the value of designs. context: the judge's own.
typedef struct SearchJudge {
    // Condition `c` of design `d`; report: its run.json; NULL: it failed, or was not computed.
    bool (*take)(Search *search, int32_t d, int32_t c, const char *report, Error *err);
    void (*judge)(Search *search, int32_t d);   // sets its value, when all conditions are taken
    void *context;
} SearchJudge;

struct Search {
    const SweepOptions *options;   // the caller's; not owned
    Sweep *sweep;   // owned, as all below
    const Study *study;   // the sweep's
    Designs designs;
    SearchJudge judge;
    Scene *scene;   // of one design
    const ChooserModule *module;
    Chooser *chooser;
    int32_t start;   // design of the scene as it is; -1: none
    int32_t side_by_side;   // designs of a round
    bool exhausted;   // the chooser found no new design, so there are fewer than was asked for
    int32_t refused;   // designs whose scene was
    Error refusal;   // the first of them
    int32_t failed;   // points
    char failure[ERROR_MESSAGE_SIZE / 2];   // what the first of them says
};

double search_scaled(const SearchKey *key, double value);   // the logarithm, of `log`
double search_unscaled(const SearchKey *key, double scaled);

// Reads the study, which is to be one that fits or one that does not. search: zeroed.
bool search_open(Search *search, const char *path, const SweepOptions *options, bool fits,
                 Error *err);
// Designs, chooser and start; judge, conditions and texts (designs_create) are known.
bool search_begin(Search *search, int32_t conditions, char *const *texts, Error *err);
// `count` more designs, by a chooser that knows all those so far; before the first also the start.
bool search_designs(Search *search, int32_t count, Error *err);
// Adds a design if it is new and allowed; x is rounded. *added: its index, -1: not added.
bool search_add(Search *search, double *x, int32_t *added, Error *err);
// Computes designs, [count]; new ones, or others once more with another accuracy.
bool search_compute(Search *search, const int32_t *which, int32_t count, Error *err);
// Computes all designs from number `first` on.
bool search_compute_from(Search *search, int32_t first, Error *err);
// The table, also of a search that was stopped, and the figures of the study where it was not.
void search_close(Search *search, Error *err);

#endif
