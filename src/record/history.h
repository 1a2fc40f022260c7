// SPDX-License-Identifier: GPL-2.0-or-later
// history.h5: every accepted step, appended as it comes and flushed now and then, so that a killed
// run leaves what it had. Names and shapes: io/hdf5/result_file. A Recorder of run/simulation.
#ifndef AMONTONS_RECORD_HISTORY_H
#define AMONTONS_RECORD_HISTORY_H

#include "io/hdf5/result_file.h"
#include "record/contact_arrays.h"
#include "record/drops.h"
#include "record/probes.h"

// A saved state recognises its history by these.
typedef struct HistoryEnd {
    bool kept;   // there is a history
    int64_t rows;   // steps recorded
    double last[RESULT_SERIES_COUNT];   // the last one's value of each series that is one column
} HistoryEnd;

typedef struct History {
    ArrayFile *file;   // NULL: no history is kept; owned
    HistoryEnd end;
    bool written[RESULT_SERIES_COUNT];   // which series there are
    double flush_at;   // wall time of the next flush, s
    double *status;   // [contact_count] as numbers, of the step under way; owned
    double *pad;   // [contact_count] the nodes' pads as stored; owned
    double *line;   // [contact_count] 1: of the contact's line; NULL in the plane; owned
    int32_t pad_count;
    PadSum *pad_sums;   // [pad_count] of the step under way; owned
    double *pad_rows;   // [series of pads][pad_count] of it; owned
    double *pad_length;   // [pad_count] sum of the nodes' weights; owned
    const ContactArrays *contact;   // of the step under way; not owned
    Probes *probes;   // read at each step that is recorded; NULL: there are none; not owned
} History;

// head: numbers and texts of the file; its node arrays are filled here from `interface`.
bool history_create(const char *folder, ResultHead *head, const Interface *interface,
                    const ContactArrays *contact, History *history, Error *err);
// Closes what is open and leaves the .part file when the history was not finished.
void history_destroy(History *history);
bool history_record(void *self, const Observation *seen, Error *err);   // a Recorder

void history_end_archive(HistoryEnd *end, Archive *archive);
// The history of RESULT, or `file`, has as many steps or more, and that one among them; else
// ERROR_INPUT. Nothing is changed.
bool history_has_end(ArrayFile *file, const HistoryEnd *end, Error *err);
// Cuts it back to `end`. A state saved without a history is no state of one.
bool history_take_back(History *history, const HistoryEnd *end, Error *err);
bool history_sync(History *history, Error *err);   // all steps onto the disk; fine without a file

// Writes tables of peaks and events, mu_M and l_c; then the file gets its final name. Peaks count
// from drop number `counted` of the list on. mu_M and l_c (length) NaN: there is none.
bool history_finish(History *history, const Drops *drops, int32_t counted, double mu_M, double l_c,
                    Error *err);

#endif
