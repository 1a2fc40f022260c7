// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/files/own_mark.h"

#include "io/files/open_file.h"

#include <errno.h>
#include <fnmatch.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// REACH: bytes at the beginning and at the end in which a mark is looked for; films have it behind
// an index that grows with them, PDF and SVG at the end.
enum { REACH = 1 << 20, WINDOW = 1 << 14, MARK_MAX = 64 };

typedef struct Mark {
    const char *pattern, *bytes;
    size_t size;
} Mark;

#define MARK_ROW(pattern, mark) {pattern, mark, sizeof(mark) - 1},
static const Mark MARKS[] = {OWN_MARKS(MARK_ROW)};

// The last names of `path`, as many as the pattern has.
static const char *names_of(const char *path, const char *pattern)
{
    const char *end = path + strlen(path);
    int32_t names = strchr(pattern, '/') ? 2 : 1;
    while (end > path && !(end[-1] == '/' && --names == 0)) end--;
    return end;
}

static const Mark *mark_of(const char *path)
{
    for (size_t k = 0; k < sizeof MARKS / sizeof *MARKS; k++) {
        const char *pattern = MARKS[k].pattern;
        if (fnmatch(pattern, names_of(path, pattern), FNM_PATHNAME | FNM_EXTMATCH) == 0)
            return &MARKS[k];
    }
    return NULL;
}

// Between `from` and `end`, window by window; each begins with the end of the one before.
static bool holds(int file, const Mark *mark, off_t from, off_t end)
{
    char bytes[WINDOW + MARK_MAX];
    size_t kept = 0;
    while (from < end) {
        ssize_t got = pread(file, bytes + kept, WINDOW, from);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        size_t filled = kept + (size_t)got;
        if (memmem(bytes, filled, mark->bytes, mark->size)) return true;
        kept = filled < mark->size ? filled : mark->size;
        memmove(bytes, bytes + filled - kept, kept);
        from += got;
    }
    return false;
}

static bool is_marked(const char *path, const Mark *mark)
{
    struct stat status;
    Error unseen = {0};
    if (!mark || lstat(path, &status) != 0 || !S_ISREG(status.st_mode)) return false;
    if (status.st_size == 0 || mark->size == 0) return true;
    int file = open_to_read(path, &unseen);
    if (file < 0) return false;
    off_t size = status.st_size, last = size > REACH ? size - REACH : 0;
    bool found = holds(file, mark, 0, size < REACH ? size : REACH) ||
                 (last > 0 && holds(file, mark, last, size));
    close(file);
    return found;
}

bool own_mark_is_in(const char *path)
{
    return is_marked(path, mark_of(path));
}

bool own_mark_check(const char *path, Error *err)
{
    const Mark *mark = mark_of(path);
    struct stat status;   // a folder's name cannot be given to a file
    bool taken = mark && lstat(path, &status) == 0 && !S_ISDIR(status.st_mode);
    if (taken && !is_marked(path, mark))
        return REFUSE(err,
                      "%s is there, and nothing says that amontons wrote it: name another file or "
                      "folder (-o), or move it away",
                      path);
    return true;
}
