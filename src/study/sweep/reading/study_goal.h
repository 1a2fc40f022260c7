// SPDX-License-Identifier: GPL-2.0-or-later
// Search of a study and its aim: a part of Study, read by study_search.
//
// One that searches (study/search) has `search`, and `where` and `best` where they are wanted, in
// place of `cases`: designs, each computed at all points of `vary`.
//
//     search: {mesh.set.n: {whole: [1, 12]}, mesh.set.pad_height: {log: [0.01, 0.2]}}
//     where: [{value: = mesh.set.n * mesh.set.pad_height, most: 0.6}]
//     best: {over: worst, designs: 40, seed: 1}   # or mean, deviation, front
//
// Or it fits measurements (study/search/fit):
//
//     fit: {measured: measured.csv, sure: 95%, designs: 40, seed: 1}
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_GOAL_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_GOAL_H

#include "io/text/yaml_document.h"
#include "study/sweep/reading/plot_words.h"

enum {
    STUDY_SEARCH_MAX = 12,   // keys that are searched
    STUDY_LIMITS_MAX = 16,
    STUDY_DESIGNS_MAX = 1000,
};

typedef enum SearchScale { SEARCH_LINEAR, SEARCH_LOG, SEARCH_WHOLE } SearchScale;

typedef struct SearchKey {
    char key[STUDY_NAME_SIZE];
    SearchScale scale;
    double least, most;
    char unit[12];   // " m": numbers are handed to the scene with it; "": as they are
} SearchKey;

// Limits of one formula of `where`: a design is computed only if the value is between them.
typedef struct SearchLimit {
    YamlNode formula;
    double least, most;   // infinite: no limit
} SearchLimit;

// How the value of a design follows from its values at the points of `vary`.
typedef enum SearchOver {
    OVER_WORST,
    OVER_MEAN,
    OVER_DEVIATION,   // the standard deviation: least is best
    OVER_FRONT,   // each point is an aim of its own (study/search/pareto_front)
} SearchOver;

typedef struct StudySearch {
    YamlNode node;   // of `search`; YAML_NO_NODE: the study does not search
    int32_t key_count, limit_count;
    SearchKey keys[STUDY_SEARCH_MAX];
    SearchLimit limits[STUDY_LIMITS_MAX];
    SearchOver over;
    int32_t designs;   // that are chosen by the search
    uint32_t seed;
    bool fits;   // measurements: it has `fit`, not `best`
    YamlNode measured;   // of `fit`: a path, or a list of them
    double sure;   // of its regions: 0.95
} StudySearch;

#endif
