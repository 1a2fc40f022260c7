// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the changes that a study makes to its base scene: `cases`, `vary` with its ranges, --set
// and `set`. Called by study_read and study_search.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_VARY_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_VARY_H

#include "study/sweep/reading/study.h"

// Fills columns, cases, axes, overrides, `set` and point_count. overrides: [override_count].
bool study_read_vary(Study *study, const char *const *overrides, int32_t override_count,
                     Error *err);
// Adds further cases to a study that searches, from the list of maps in `text`.
bool study_add_designs(Study *study, const char *text, Error *err);
// A key as one would type it after --set: one of the scene's, a map of them, or mesh.set.NAME.
bool study_check_key(const YamlDocument *document, YamlNode item, Error *err);

#endif
