// SPDX-License-Identifier: GPL-2.0-or-later
// The scenes of a study, one for each point.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_POINT_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_POINT_H

#include "study/sweep/reading/study.h"

typedef struct PointChoice {
    int32_t point;   // 0 to point_count - 1: cases outermost, then the keys of `vary` in order
    const StudyCase *trial;   // in place of the case of `point`; NULL: its own
    bool baseline;   // with the keys of rank.baseline: what `point` is measured against
} PointChoice;

bool study_scene(const Study *study, const PointChoice *choice, Scene *scene, Error *err);

// The value of a column's key in a scene, as text; *number is NaN where it is no number.
void study_scene_value(const Scene *scene, const char *key, char *words, int32_t size,
                       double *number);

// Adds "load.pressure=0.003" to `words`, which has room for `size` bytes.
void study_add_words(const Scene *scene, const char *key, char *words, int32_t size);

#endif
