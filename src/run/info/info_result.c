// SPDX-License-Identifier: GPL-2.0-or-later
// A result in text: run.json says how the run ended, history.h5 what happened.
#include "run/info/info.h"

#include "base/child_process.h"
#include "base/memory.h"
#include "base/text.h"
#include "io/files/text_file.h"
#include "io/hdf5/result_file.h"
#include "io/text/json_reader.h"
#include "record/events.h"
#include "run/result/result_folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 1100, EVENTS_SHOWN_MAX = 200, REPORT_BYTES_MAX = 1 << 28 };
enum { HISTORY_SECONDS_MAX = 5 };   // of processor time

// "  label   value" for each of these entries of run.json that is there.
static const struct {
    const char *path, *label;
} entries[] = {
    {"status", "status"},
    {"failure", "failure"},
    {"message", "message"},
    {"results.mu_M", "mu_M"},
    {"results.mu_M_spread", "mu_M spread"},
    {"results.mu_hold", "mu_hold"},
    {"results.mu_max", "mu_max"},
    {"results.l_c_over_L", "l_c / L"},
    {"results.l_sc_over_L", "l_sc / L"},
    {"results.slip_cells", "slip cells"},
    {"base.slip_over_contact", "slip over base / L"},
    {"base.dundurs_alpha", "Dundurs' alpha"},
    {"base.dundurs_beta", "Dundurs' beta"},
    {"base.shear_impedance_over_block", "rho c_S over block"},
    {"steps.accepted", "accepted steps"},
    {"steps.rejected", "rejected steps"},
    {"timing_s.total", "time taken, s"},
    {"errors.energy", "energy error"},
    {"errors.complementarity", "complementarity"},
    {"errors.moment", "moment error"},
};

// Entries that are missing in run.json (a failed run has no mu_M) are left out. The file may be
// long: each event is in it, and no tree is made of it.
static bool write_run(const char *folder, FILE *out, Error *err)
{
    char path[PATH_SIZE], *text = NULL;
    int32_t size = 0, lines = 1;
    snprintf(path, sizeof path, "%s/run.json", folder);
    if (access(path, F_OK) != 0) {
        fprintf(out, "  no run.json: the run was killed, or is still under way\n");
        snprintf(path, sizeof path, "%s/%s", folder, CHECKPOINT_FILE);
        if (access(path, F_OK) == 0)
            fprintf(out, "  %s: `run --resume` goes on\n", CHECKPOINT_FILE);
        return true;
    }
    TRY(text_file_read(path, REPORT_BYTES_MAX, &text, &size, err));
    if (!json_is_whole(text)) {
        for (const char *at = text; *at; at++) lines += *at == '\n';
        FAIL(err, ERROR_INPUT, "%s:%d: ends before its last bracket: no run.json of ours", path,
             lines);
    }
    for (size_t k = 0; k < sizeof entries / sizeof entries[0]; k++) {
        if (!json_may_hold(text, entries[k].path)) continue;
        const char *entry = entries[k].path;
        char beside[PATH_SIZE], words[ERROR_MESSAGE_SIZE];
        double value = NAN, known_to = NAN, error = NAN;
        fprintf(out, "  %-18s ", entries[k].label);
        snprintf(beside, sizeof beside, "%s_known_to", entry);
        if (json_find_number(text, beside, &known_to)) {
            // A result of which run.json tells how far it is known.
            snprintf(beside, sizeof beside, "%s_error", entry);
            json_find_number(text, beside, &error);
            json_find_number(text, entry, &value);
            bool has_bar = error == known_to;
            text_estimate(value, has_bar ? error : (double)NAN, known_to, words);
            fputs(words, out);
            if (!has_bar && !isnan(value)) {
                text_known_to(value, known_to, words);
                fprintf(out, ", %s (on this mesh %.6g)", words, value);
            }
        } else if (json_find_text(text, entry, words, sizeof words)) {
            fputs(words, out);
        } else if (!json_find_number(text, entry, &value) || isnan(value)) {
            fputs("none", out);
        } else {   // to six digits where it is not whole
            fprintf(out, fabs(value) < 1e15 && value == floor(value) ? "%.0f" : "%.6g", value);
        }
        fputc('\n', out);
    }
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

enum { KIND, U_START, U_STOP, REACH, PEAK_RATE, EVENT_COLUMNS };

// Reads history.h5, or history.h5.part where the run was killed: io/hdf5/result_file opens
// whichever is there. context is the folder's name. Also called in a child process, whose reply is
// `out`.
static bool write_history(void *context, FILE *out, Error *err)
{
    const char *folder = context;
    static const ResultTable tables[EVENT_COLUMNS] = {EVENTS_KIND, EVENTS_U_START, EVENTS_U_STOP,
                                                      EVENTS_REACH, EVENTS_PEAK_RATE};
    double *rod = NULL, *mu = NULL, *column[EVENT_COLUMNS] = {0};
    int64_t rows = 0, mu_rows = 0;
    int32_t width = 0, nodes = 0, events = 0;
    double *x = NULL;
    char title[600] = "";
    ArrayFile *file = result_file_open(folder, err);
    TRY(file);
    TRY(result_file_text(file, "title", title, sizeof title, err));
    TRY(result_file_read_series(file, SERIES_ROD, &rod, &rows, &width, err));
    TRY(result_file_read_series(file, SERIES_MU, &mu, &mu_rows, &width, err));
    TRY(result_file_read_nodes(file, NODES_X, &x, &nodes, err));
    TRY(result_file_read_tables(file, tables, EVENT_COLUMNS, column, &events, err));
    double mu_max = -INFINITY;
    for (int64_t i = 0; i < mu_rows; i++) mu_max = fmax(mu_max, mu[i]);
    fprintf(out, "  %-18s %s\n  %-18s %lld states at %d contact nodes", "title", title, "history",
            (long long)rows, nodes);
    if (rows > 0) fprintf(out, ", U from %.6g to %.6g", rod[0], rod[rows - 1]);
    if (mu_rows > 0) fprintf(out, ", largest mu %.6g", mu_max);
    fprintf(out, "\n");
    if (events > 0)
        fprintf(out, "\n  %-14s %12s %12s %12s %14s\n", "event", "U start", "U stop", "reach",
                "peak slip rate");
    for (int32_t i = 0; i < events && i < EVENTS_SHOWN_MAX; i++)
        fprintf(out, "  %-14s %12.6g %12.6g %12.6g %14.4g\n", event_words(column[KIND][i]),
                column[U_START][i], column[U_STOP][i], column[REACH][i], column[PEAK_RATE][i]);
    if (events > EVENTS_SHOWN_MAX) fprintf(out, "  ... and %d more\n", events - EVENTS_SHOWN_MAX);
cleanup:
    if (file) array_file_close(file, err);
    memory_free_all(rod, mu, x);
    for (int32_t k = 0; k < EVENT_COLUMNS; k++) memory_free(column[k]);
    return error_is_clean(err);
}

// The history is missing where the scene did not ask for it.
bool info_result(const char *folder, FILE *out, Error *err)
{
    static const char *const histories[] = {"history.h5", "history.h5.part", "run.json"};
    bool there[3];
    for (int32_t k = 0; k < 3; k++) {
        char path[PATH_SIZE];
        snprintf(path, sizeof path, "%s/%s", folder, histories[k]);
        there[k] = access(path, F_OK) == 0;
    }
    if (!there[0] && !there[1] && !there[2])
        return REFUSE(err, "%s: not a result folder: no run.json and no history.h5 in it", folder);
    fprintf(out, "result %s\n", folder);
    if (!write_run(folder, out, err)) return false;
    if (!there[0] && !there[1]) return true;
    if (!child_is_wanted()) return write_history((void *)folder, out, err);

    // A stranger's history may crash HDF5, or keep it busy for ever. Ours takes milliseconds: only
    // columns of one number a state are read.
    ChildReply reply = {0};
    ChildWork work = {.path = folder,
                      .reader = "HDF5",
                      .seconds = HISTORY_SECONDS_MAX,
                      .advice = "its history is damaged",
                      .read = write_history,
                      .context = (void *)folder};
    TRY(child_read(&work, &reply, err));
    fwrite(reply.bytes, 1, (size_t)reply.size, out);   // the caller looks at the stream's state
cleanup:
    child_destroy(&reply);
    return error_is_clean(err);
}
