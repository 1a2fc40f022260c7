// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the results that a study asks for: the columns of its table (`record`), the best of its
// points (`rank`) and figures (`plot`). Called by study_read, by search/measurements for names of
// results, and by what draws a plot.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_WANTED_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_WANTED_H

#include "study/sweep/reading/study.h"

bool study_read_wanted(Study *study, Error *err);
// The path in run.json of what `record` calls `name`; NULL: no name of its list, nor a path of
// results.
const char *study_record_path(const char *name);

const char *plot_key_name(PlotKey key);   // "x"; static storage
// One plot, also that of `amontons render --plot`. Does not check what the names stand for.
bool plot_read(const YamlDocument *file, YamlNode map, StudyPlot *plot, Error *err);

#endif
