// SPDX-License-Identifier: GPL-2.0-or-later
// Lines are only ever added, each by one write; so whoever is killed leaves at most one that has no
// end. A line is "hash checksum json": one whose checksum does not hold is none, and its point is
// computed again.
#include "study/sweep/computing/reports.h"

#include "base/hash.h"
#include "base/memory.h"
#include "io/files/open_file.h"
#include "io/files/own_list.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

enum { HASH_LENGTH = HASH_TEXT_SIZE - 1, HEAD_LENGTH = 2 * (HASH_LENGTH + 1) };

bool reports_open(Reports *reports, const char *path, bool anew, Error *err)
{
    char why[OPEN_WHY_SIZE];
    *reports = (Reports){0};
    bool listed = false;
    if (!own_list_has(path, &listed, err) || !(listed || own_list_add(path, err))) return false;
    int file = open_to_write(path, OPEN_KEPT, why);
    if (file < 0) return FAULT(err, ERROR_FILE, "cannot write %s: %s", path, why);
    fcntl(file, F_SETFL, O_APPEND);
    if (anew && ftruncate(file, 0) != 0) {
        int cause = errno;
        close(file);
        return FAULT(err, ERROR_FILE, "cannot write %s: %s", path, strerror(cause));
    }
    *reports = (Reports){.open = true, .file = file};
    return true;
}

// "hash checksum ", without a zero at its end.
static void write_head(const char *hash, const char *json, size_t size, char head[HEAD_LENGTH + 1])
{
    char checksum[HASH_TEXT_SIZE];
    Hash sum = hash_start();
    hash_bytes(&sum, hash, HASH_LENGTH);
    hash_bytes(&sum, json, size);
    hash_write(&sum, checksum);
    snprintf(head, HEAD_LENGTH + 1, "%.32s %s ", hash, checksum);
}

bool reports_list(Reports *reports, ReportFound found, void *context, Error *err)
{
    char *line = NULL;
    size_t room = 0;
    int copy = dup(reports->file);   // fclose closes it
    FILE *file = copy >= 0 ? fdopen(copy, "r") : NULL;
    if (!file) FAIL(err, ERROR_FILE, "cannot read the reports: %s", strerror(errno));
    rewind(file);
    for (ssize_t length; (length = getline(&line, &room, file)) > 0; reports->end += length) {
        if (line[length - 1] != '\n') break;
        ReportPlace place = {reports->end + HEAD_LENGTH, (int32_t)length - HEAD_LENGTH - 1};
        char head[HEAD_LENGTH + 1];
        if (place.size <= 0) continue;
        write_head(line, line + HEAD_LENGTH, (size_t)place.size, head);
        if (memcmp(line, head, HEAD_LENGTH) != 0) continue;
        line[HASH_LENGTH] = 0;
        found(context, line, place);
    }
    if (ftruncate(reports->file, reports->end) != 0)
        FAIL(err, ERROR_FILE, "cannot cut off the reports: %s", strerror(errno));
cleanup:
    free(line);
    if (file)
        fclose(file);
    else if (copy >= 0)
        close(copy);
    return error_is_clean(err);
}

bool reports_add(Reports *reports, const char *hash, const char *json, ReportPlace *place,
                 Error *err)
{
    size_t size = strlen(json);
    char head[HEAD_LENGTH + 1];
    struct iovec parts[] = {{head, HEAD_LENGTH}, {(void *)json, size}, {"\n", 1}};
    ssize_t length = (ssize_t)(HEAD_LENGTH + size + 1), written;
    write_head(hash, json, size, head);
    while ((written = writev(reports->file, parts, 3)) < 0 && errno == EINTR) continue;
    if (written != length) {
        int cause = written < 0 ? errno : ENOSPC;
        bool cut = written <= 0 || ftruncate(reports->file, reports->end) == 0;
        return FAULT(err, ERROR_FILE, "cannot write the reports of points: %s%s", strerror(cause),
                     cut ? "" : ", and half a line stays");
    }
    *place = (ReportPlace){reports->end + HEAD_LENGTH, (int32_t)size};
    reports->end += length;
    return true;
}

char *reports_read(const Reports *reports, ReportPlace place, Error *err)
{
    char *json = memory_array((int64_t)place.size + 1, 1, err);
    if (!json) goto cleanup;
    if (pread(reports->file, json, (size_t)place.size, place.at) == place.size) return json;
    error_set(err, ERROR_FILE, __FILE__, __LINE__, "cannot read the reports of points: %s",
              strerror(errno));
cleanup:
    memory_free(json);
    return NULL;
}

void reports_close(Reports *reports)
{
    if (reports->open) {
        fsync(reports->file);   // a failure costs what a power cut may cost
        close(reports->file);
    }
    *reports = (Reports){0};
}
