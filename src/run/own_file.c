// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/own_file.h"

#include "render/render.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Pictures and pages name their writer; of the other files, what stands at the beginning of each.
static const char WRITER[] = "amontons ", REPORT[] = "\"status\": \"";
static const struct {
    const char *name, *mark;
} OWN_FILES[] = {{"run.json", REPORT},
                 {CHECKPOINT_FILE, "amontons-state"},
                 {"history.h5", "series"},
                 {"fields.pvd", "file=\"fields/"},
                 {"static.json", REPORT},
                 {"static.h5", "contact"},
                 {"static.vtu", "stress_elastic"},
                 {"stability.json", REPORT},
                 {"stability.h5", "critical"},
                 {"model1d.json", REPORT},
                 {"model1d.h5", "profile"},
                 {"report.html", WRITER},
                 {"accuracy.json", "\"contact nodes\""},
                 {"sweep.csv", "point,"},
                 {"sweep.h5", "result"},
                 {"ranking.csv", "rank,"}};
static const char *const FIELDS[][3] = {{"bulk_", ".vtu", "stress_elastic"},
                                        {"interface_", ".vtp", "slip_rate"}};

#define FIGURE_FILE(id, name, words) name ".png", name ".pdf", name ".svg",
#define FIELD_FILE(id, name, ...) FIGURE_FILE(id, "field-" name, )   // of a quantity
static const char *const FIGURES[] = {
    RENDER_FIGURES(FIGURE_FILE) BLOCK_QUANTITIES(FIELD_FILE) "accuracy.png", "accuracy.json"};

// What stands behind accuracy.json is no file of a run.
const char *own_file_name(int32_t k)
{
    return strcmp(OWN_FILES[k].name, "accuracy.json") != 0 ? OWN_FILES[k].name : NULL;
}

bool own_file_is_figure(const char *name)
{
    for (size_t k = 0; k < sizeof FIGURES / sizeof FIGURES[0]; k++)
        if (strcmp(FIGURES[k], name) == 0) return true;
    return false;
}

// The mark of a field's file; NULL: it is none.
static const char *field_mark(const char *name)
{
    for (size_t k = 0; k < sizeof FIELDS / sizeof FIELDS[0]; k++) {
        size_t length = strlen(FIELDS[k][0]), digits = 0;
        if (strncmp(name, FIELDS[k][0], length) != 0) continue;
        while (isdigit((unsigned char)name[length + digits])) digits++;
        if (digits >= 6 && strcmp(name + length + digits, FIELDS[k][1]) == 0) return FIELDS[k][2];
    }
    return NULL;
}

bool own_file_is_field(const char *name)
{
    return field_mark(name) != NULL;
}

static const char *mark_of(const char *name)
{
    for (size_t k = 0; k < sizeof OWN_FILES / sizeof OWN_FILES[0]; k++)
        if (strcmp(OWN_FILES[k].name, name) == 0) return OWN_FILES[k].mark;
    return own_file_is_field(name) ? field_mark(name) : WRITER;
}

// Looked for in the first and in the last bytes: PDF and SVG name their writer at the end.
bool own_file_is_ours(const char *path)
{
    enum { REACH = 1 << 12 };
    char bytes[REACH];
    struct stat status;
    const char *slash = strrchr(path, '/'), *mark = mark_of(slash ? slash + 1 : path);
    int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);   // a pipe is not waited for
    bool found = false;
    if (file < 0) return false;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
        off_t last = status.st_size > REACH ? status.st_size - REACH : 0;
        for (int end = 0; end < 2 && !found; end++) {
            ssize_t size;
            while ((size = pread(file, bytes, REACH, end ? last : 0)) < 0 && errno == EINTR)
                continue;
            found = size == 0 || (size > 0 && memmem(bytes, (size_t)size, mark, strlen(mark)));
        }
    }
    close(file);
    return found;
}
