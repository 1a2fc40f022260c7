// SPDX-License-Identifier: GPL-2.0-or-later
// Designs of a search, and their values. Shared by the files of this folder.
#ifndef AMONTONS_STUDY_SEARCH_DESIGNS_H
#define AMONTONS_STUDY_SEARCH_DESIGNS_H

#include "amontons_optimise.h"
#include "study/sweep/computing/point.h"

enum { DESIGNS_MAX = STUDY_DESIGNS_MAX + 200 };   // with the start and those along keys

typedef struct Design {
    double x[STUDY_SEARCH_MAX];   // values of the keys that are searched
    int32_t choice;   // number of the chooser's; -1: not chosen by it
    int32_t point;   // of the sweep, the first of its conditions; -1: not computed yet
    double accuracy;   // accuracy.mu; 0: the study's
    bool settled;   // a smaller accuracy is of no use, as the time of a run decides
    bool confirmed, is_finer;   // it was the best, and so computed once more; with a smaller bar
    double value, bar;   // what is searched for, of a fit the misfit; NaN: none; its error
    bool has_bar;   // an error bar, with the mesh's part; else what is usual of such a mesh
    int32_t deciding;   // point of `vary` whose value it is; 0: of none alone
} Design;

typedef struct Designs {
    const Study *study;   // not owned
    bool lowest;   // is best
    bool has_bars;   // a design has an error bar: what is sure of each counts
    int32_t count;
    int32_t aim;   // of a front: an aim, whose value counts alone; -1: the mean of all conditions
    int32_t aims;   // conditions, and once more for each result of `also`
    int32_t conditions;   // at which each design is computed: points of `vary`, or ...
    char *const *texts;   // ... [conditions] "load.pressure: 0.003", not owned; NULL: `vary`
    char *const *origins;   // [conditions] where each text was read, not owned; NULL: not known
    Design *list;   // [DESIGNS_MAX] owned
    PointValue *points;   // [DESIGNS_MAX * aims] owned
    double near[STUDY_SEARCH_MAX];   // designs that differ by less are one; parts of a key's range
} Designs;

// conditions, texts: of what was measured; 0, NULL: the points of `vary`.
bool designs_create(const Study *study, int32_t conditions, char *const *texts, Designs *designs,
                    Error *err);
void designs_destroy(Designs *designs);   // zeroed is fine

// Adds one; its index. x: as from the chooser or a section, rounded here to what is written.
int32_t designs_add(Designs *designs, const double *x, int32_t choice);
// The first design that differs from x by no more than `near` in any key; -1: none.
int32_t designs_find(const Designs *designs, const double *x);
// Whole numbers, three digits; of a fit five.
void designs_round(const Study *study, double *x);
// "[{mesh.set.n: 4, ...}, ...]" of [count] designs (memory_free): one a design, or one for each of
// its `texts`.
char *designs_text(const Designs *designs, const Design *list, int32_t count, Error *err);
void design_words(const Study *study, const Design *design, char words[OPTIMISE_WORDS_SIZE]);

PointValue *designs_points(const Designs *designs, int32_t design);   // [aims]
// Result that an aim is of, and if its least value is best.
StudyAim designs_aim(const Designs *designs, int32_t aim);
// value and bar of a design from its points, by `over`; NaN where a point has none.
void designs_judge(Designs *designs, int32_t design);
int32_t designs_best(const Designs *designs);   // -1: none has a value
// Value that a design is sure to reach: the end of its bar on the worse side. If other designs have
// bars and this one has none, its bar is taken as large as its value. Without any bars: the value.
double design_sure(const Designs *designs, const Design *design);
// True if a is better than b by the sure ends of their bars.
bool design_is_better(const Designs *designs, const Design *a, const Design *b);
// True if design `d` may be as good as `best`, with the bars of both.
bool designs_may_equal(const Designs *designs, int32_t best, int32_t d);
// True if it may be better, its value given: this is not below the sure end of `best`'s bar.
bool designs_may_lead(const Designs *designs, int32_t best, int32_t d);

#endif
