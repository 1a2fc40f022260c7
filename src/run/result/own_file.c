// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/result/own_file.h"

#include "render/render.h"

#include <ctype.h>
#include <string.h>

// run.json and the checkpoint first, the history last (run/result/result_folder).
static const char *const RESULT_FILES[] = {
    "run.json",   CHECKPOINT_FILE,  "history.h5",   "fields.pvd",   "static.json", "static.h5",
    "static.vtu", "stability.json", "stability.h5", "model1d.json", "model1d.h5",  "report.html"};
static const char *const FIELDS[] = {"bulk_", ".vtu", "interface_", ".vtp"};

#define FIGURE_FILE(id, name, words)                                                               \
    name ".png", name ".pdf", name ".svg", name ".csv", name "-compared.csv",
#define FIELD_FILE(id, name, ...) FIGURE_FILE(id, "field-" name, )   // of a quantity
#define CONTACT_FILE(id, name, ...) FIGURE_FILE(id, "contact-plane-" name, )
static const char *const FIGURES[] = {RENDER_FIGURES(FIGURE_FILE) BLOCK_QUANTITIES(FIELD_FILE)
                                          CONTACT_QUANTITIES(CONTACT_FILE)
                                              FIGURE_FILE(, "panels", ) "accuracy.png",
                                      "accuracy.json"};

const char *own_file_name(int32_t k)
{
    return k < (int32_t)(sizeof RESULT_FILES / sizeof *RESULT_FILES) ? RESULT_FILES[k] : NULL;
}

bool own_file_is_figure(const char *name)
{
    for (size_t k = 0; k < sizeof FIGURES / sizeof FIGURES[0]; k++)
        if (strcmp(FIGURES[k], name) == 0) return true;
    return false;
}

bool own_file_is_field(const char *name)
{
    for (size_t k = 0; k < sizeof FIELDS / sizeof FIELDS[0]; k += 2) {
        size_t length = strlen(FIELDS[k]), digits = 0;
        if (strncmp(name, FIELDS[k], length) != 0) continue;
        while (isdigit((unsigned char)name[length + digits])) digits++;
        if (digits >= 6 && strcmp(name + length + digits, FIELDS[k + 1]) == 0) return true;
    }
    return false;
}
