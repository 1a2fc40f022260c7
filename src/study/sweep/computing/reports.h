// SPDX-License-Identifier: GPL-2.0-or-later
// Holds the results of a study's runs in one file instead of a folder for each (`keep: table`):
// DIR/reports has one line for each point, "HASH CHECKSUM JSON". Only the sweep itself writes it,
// under its lock. Called by sweep, point and share.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_REPORTS_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_REPORTS_H

#include "base/error.h"

// Place of a report in the file; size 0: it has none.
typedef struct ReportPlace {
    int64_t at;   // bytes
    int32_t size;
} ReportPlace;

typedef struct Reports {
    bool open;   // false: points have folders
    int file;   // descriptor, valid while open
    int64_t end;   // bytes
} Reports;

// A line that was found. Of lines with one hash the last counts.
typedef void (*ReportFound)(void *context, const char *hash, ReportPlace place);

// Opens or makes the file and goes through what is in it; anew: it is emptied first. A line that a
// kill cut off goes. ERROR_FILE says what failed, here and below.
bool reports_open(Reports *reports, const char *path, bool anew, Error *err);
bool reports_list(Reports *reports, ReportFound found, void *context, Error *err);
// json: one line. *place: where it stands.
bool reports_add(Reports *reports, const char *hash, const char *json, ReportPlace *place,
                 Error *err);
char *reports_read(const Reports *reports, ReportPlace place, Error *err);   // memory_free
void reports_close(Reports *reports);   // zeroed is fine

#endif
