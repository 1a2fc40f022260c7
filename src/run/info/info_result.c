// SPDX-License-Identifier: GPL-2.0-or-later
// A result in text: how the run ended, from run.json.
#include "run/info/info.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/text_file.h"
#include "io/text/json_reader.h"
#include "run/result/result_folder.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 1100, REPORT_BYTES_MAX = 1 << 28 };

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

bool info_result(const char *folder, FILE *out, Error *err)
{
    static const char *const files[] = {"history.h5", "history.h5.part", "run.json"};
    bool there = false;
    for (int32_t k = 0; k < 3; k++) {
        char path[PATH_SIZE];
        snprintf(path, sizeof path, "%s/%s", folder, files[k]);
        there = there || access(path, F_OK) == 0;
    }
    if (!there)
        return REFUSE(err, "%s: not a result folder: no run.json and no history.h5 in it", folder);
    fprintf(out, "result %s\n", folder);
    return write_run(folder, out, err);
}
