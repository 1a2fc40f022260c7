// SPDX-License-Identifier: GPL-2.0-or-later
// A result in text: run.json says how the run ended (JSON is YAML, so the YAML reader reads it),
// history.h5 what happened.
#include "run/info.h"

#include "base/memory.h"
#include "io/result_file.h"
#include "io/yaml_document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 1100, EVENTS_SHOWN_MAX = 200 };

// "  label   value +- error" for each of these entries of run.json that is there; the error is that
// of `path`_error.
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
    {"steps.accepted", "accepted steps"},
    {"steps.rejected", "rejected steps"},
    {"timing_s.total", "time taken, s"},
    {"errors.energy", "energy error"},
    {"errors.complementarity", "complementarity"},
    {"errors.moment", "moment error"},
};

// A number with a point to six digits; all else as it stands.
static void write_value(const char *text, FILE *out)
{
    char *end = NULL;
    double number = strtod(text, &end);
    if (strchr(text, '.') && *end == 0)
        fprintf(out, "%.6g", number);
    else
        fputs(text, out);
}

// What is missing in run.json (a failed run has no mu_M) is left out.
static bool write_run(const char *folder, FILE *out, Error *err)
{
    char path[PATH_SIZE];
    YamlDocument *run = NULL;
    snprintf(path, sizeof path, "%s/run.json", folder);
    if (access(path, F_OK) != 0) {
        fprintf(out, "  no run.json: the run was killed, or is still under way\n");
        return true;
    }
    TRY(yaml_read(path, &run, err));
    for (size_t k = 0; k < sizeof entries / sizeof entries[0]; k++) {
        YamlNode node = yaml_look_up(run, entries[k].path);
        if (node == YAML_NO_NODE) continue;
        fprintf(out, "  %-18s ", entries[k].label);
        write_value(yaml_kind(run, node) == YAML_SCALAR ? yaml_text(run, node) : "none", out);
        snprintf(path, sizeof path, "%s_error", entries[k].path);
        node = yaml_look_up(run, path);
        if (node != YAML_NO_NODE && yaml_kind(run, node) == YAML_SCALAR)
            fprintf(out, " +- %.1g", strtod(yaml_text(run, node), NULL));
        fputc('\n', out);
    }
cleanup:
    yaml_destroy(run);
    return error_is_clean(err);
}

typedef struct EventTable {
    double *kind, *start, *stop, *reach, *rate;   // [count]; owned
    int32_t count;
} EventTable;

// All columns of a table must have as many rows: a damaged file is told, not read beyond its end.
static bool read_events(ArrayFile *file, EventTable *table, Error *err)
{
    double **const columns[] = {&table->kind, &table->start, &table->stop, &table->reach,
                                &table->rate};
    static const ResultTable names[] = {EVENTS_KIND, EVENTS_U_START, EVENTS_U_STOP, EVENTS_REACH,
                                        EVENTS_PEAK_RATE};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        int32_t rows = 0;
        TRY(result_file_read_table(file, names[k], columns[k], &rows, err));
        if (k > 0 && rows != table->count)
            FAIL(err, ERROR_FILE, "the events of the history have columns of %d and %d rows",
                 table->count, rows);
        table->count = rows;
    }
cleanup:
    return error_is_clean(err);
}

static void write_events(const EventTable *table, FILE *out)
{
    static const char *const kinds[] = {"quasi-static", "bounded rapid", "leading rapid"};
    if (table->count == 0) return;
    fprintf(out, "\n  %-14s %12s %12s %12s %14s\n", "event", "U start", "U stop", "reach",
            "peak slip rate");
    for (int32_t i = 0; i < table->count && i < EVENTS_SHOWN_MAX; i++) {
        double kind = table->kind[i];
        bool known = kind >= 0 && kind < 3;
        fprintf(out, "  %-14s %12.6g %12.6g %12.6g %14.4g\n", known ? kinds[(int)kind] : "unknown",
                table->start[i], table->stop[i], table->reach[i], table->rate[i]);
    }
    if (table->count > EVENTS_SHOWN_MAX)
        fprintf(out, "  ... and %d more\n", table->count - EVENTS_SHOWN_MAX);
}

// Of history.h5, or of history.h5.part where the run was killed: io/result_file opens whichever is
// there.
static bool write_history(const char *folder, FILE *out, Error *err)
{
    double *rod = NULL, *mu = NULL;
    EventTable events = {0};
    int64_t rows = 0, mu_rows = 0;
    int32_t width = 0, nodes = 0;
    double *x = NULL;
    char title[600] = "";
    ArrayFile *file = result_file_open(folder, err);
    TRY(file);
    TRY(result_file_text(file, "title", title, sizeof title, err));
    TRY(result_file_read_series(file, SERIES_ROD, &rod, &rows, &width, err));
    TRY(result_file_read_series(file, SERIES_MU, &mu, &mu_rows, &width, err));
    TRY(result_file_read_nodes(file, NODES_X, &x, &nodes, err));
    TRY(read_events(file, &events, err));
    double mu_max = -INFINITY;
    for (int64_t i = 0; i < mu_rows; i++) mu_max = fmax(mu_max, mu[i]);
    fprintf(out, "  %-18s %s\n  %-18s %lld states at %d contact nodes", "title", title, "history",
            (long long)rows, nodes);
    if (rows > 0) fprintf(out, ", U from %.6g to %.6g", rod[0], rod[rows - 1]);
    if (mu_rows > 0) fprintf(out, ", largest mu %.6g", mu_max);
    fprintf(out, "\n");
    write_events(&events, out);
cleanup:
    if (file) array_file_close(file, err);
    double *const owned[] = {rod,         mu,           x,          events.kind, events.start,
                             events.stop, events.reach, events.rate};
    for (size_t k = 0; k < sizeof owned / sizeof owned[0]; k++) memory_free(owned[k]);
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
        FAIL(err, ERROR_INPUT, "%s: not a result folder: no run.json and no history.h5 in it",
             folder);
    fprintf(out, "result %s\n", folder);
    TRY(write_run(folder, out, err));
    if (there[0] || there[1]) TRY(write_history(folder, out, err));
cleanup:
    return error_is_clean(err);
}
