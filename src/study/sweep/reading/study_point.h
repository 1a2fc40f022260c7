// SPDX-License-Identifier: GPL-2.0-or-later
// The scenes of a study, one for each point.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_POINT_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_POINT_H

#include "study/sweep/reading/study.h"

// The scene of `point`, 0 to point_count - 1: cases outermost, then the keys of `vary` in order.
bool study_point_scene(const Study *study, int32_t point, Scene *scene, Error *err);
// The scene of a case that the study does not have, at the point `condition` of `vary`.
bool study_trial_scene(const Study *study, const StudyCase *trial, int32_t condition, Scene *scene,
                       Error *err);
// The scene that is measured against: `point` with the keys of rank.baseline.
bool study_baseline_scene(const Study *study, int32_t point, Scene *scene, Error *err);

// The value of a column's key in a scene, as text; *number is NaN where it is no number.
void study_scene_value(const Scene *scene, const char *key, char *words, int32_t size,
                       double *number);

// Adds "load.pressure=0.003" to `words`, which has room for `size` bytes.
void study_add_words(const Scene *scene, const char *key, char *words, int32_t size);

#endif
