// SPDX-License-Identifier: GPL-2.0-or-later
// Names are added by one write each, at the end: several processes may add to one list.
#include "io/files/own_list.h"

#include "base/transfer.h"
#include "io/files/open_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = PATH_MAX + 32 };

static const char HEAD[] = "# Files that amontons wrote here; --overwrite removes these alone.\n";

// True if a list may hold this name: see own_list_next.
static bool is_a_name(const char *name)
{
    int32_t slashes = 0;
    if (*name == '.' || *name == '/' || *name == '#' || !*name) return false;
    for (const char *at = name; *at; at++) {
        if ((unsigned char)*at < ' ') return false;
        if (*at == '/' && (at[1] == '.' || at[1] == '/' || !at[1] || ++slashes > 1)) return false;
    }
    return true;
}

static void list_path(const char *folder, char path[PATH_SIZE])
{
    size_t end = strlen(folder);
    bool slash = end > 0 && folder[end - 1] == '/';
    snprintf(path, PATH_SIZE, "%.*s%s" OWN_LIST_NAME, PATH_MAX, folder, slash ? "" : "/");
}

bool own_list_is_in(const char *folder)
{
    char path[PATH_SIZE];
    struct stat status;
    list_path(folder, path);
    return lstat(path, &status) == 0 && S_ISREG(status.st_mode);
}

// The folder whose list is asked about `path`: its own, or the one above that. Returns how that
// list names the path, a part of `path`; NULL: neither has a list. The folder of a result may be a
// link, and its list counts. A link in a folder that has a list leads elsewhere: no list counts
// there, not even the one behind it.
static const char *find_list(const char *path, char folder[PATH_SIZE])
{
    struct stat status;
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    if (!slash || slash - path >= PATH_MAX) {
        snprintf(folder, PATH_SIZE, ".");
        return !slash && own_list_is_in(folder) ? name : NULL;
    }
    snprintf(folder, PATH_SIZE, "%.*s", slash > path ? (int)(slash - path) : 1, path);
    bool own = own_list_is_in(folder);
    char outer[PATH_SIZE], *above = strrchr(folder, '/'), *last = above ? above + 1 : folder;
    bool link = lstat(folder, &status) == 0 && S_ISLNK(status.st_mode);
    if (own && !link) return name;
    const char *name_above = path + (last - folder);
    snprintf(outer, sizeof outer, "%.*s", above ? (int)(above - folder) + 1 : 1,
             above ? path : ".");
    bool in_ours = is_a_name(last) && own_list_is_in(outer);
    if (link) return own && !in_ours ? name : NULL;
    memcpy(folder, outer, sizeof outer);
    return in_ours ? name_above : NULL;
}

bool own_list_check(const char *folder, Error *err)
{
    static const char ours[] = "amontons.";
    DIR *directory = own_list_is_in(folder) ? NULL : opendir(folder);
    if (!directory) return true;   // what cannot be looked at shows when it is written to
    for (const struct dirent *entry; (entry = readdir(directory));) {
        if (*entry->d_name == '.' || strncmp(entry->d_name, ours, sizeof ours - 1) == 0) continue;
        FAIL(err, ERROR_INPUT,
             "%s holds files (%.80s) and no " OWN_LIST_NAME
             ", the list of what amontons wrote there: choose a new or an empty folder (-o)",
             folder, entry->d_name);
    }
cleanup:
    closedir(directory);
    return error_is_clean(err);
}

bool own_list_make(const char *folder, Error *err)
{
    char path[PATH_SIZE], why[OPEN_WHY_SIZE];
    if (own_list_is_in(folder)) return true;
    list_path(folder, path);
    int file = open_to_write(path, OPEN_KEPT, why);
    if (file < 0) return FAULT(err, ERROR_FILE, "cannot write %s: %s", path, why);
    int cause = transfer_write(file, HEAD, sizeof HEAD - 1, -1);
    if (cause) unlink(path);
    close(file);
    return cause == 0 || FAULT(err, ERROR_FILE, "cannot write %s: %s", path, strerror(cause));
}

FILE *own_list_open(const char *folder, Error *err)
{
    char path[PATH_SIZE];
    list_path(folder, path);
    return own_list_is_in(folder) ? open_stream(path, err) : NULL;
}

// A line that is longer than a name may be comes in pieces, and none of them is a name.
bool own_list_next(FILE *list, char name[OWN_NAME_SIZE])
{
    for (bool inside = false; fgets(name, OWN_NAME_SIZE, list);) {
        char *end = strchr(name, '\n');
        bool whole = !inside && (end || feof(list));
        inside = !end;
        if (end) *end = 0;
        if (whole && is_a_name(name)) return true;
    }
    return false;
}

// Reads piece by piece, each beginning with the end of the one before: files are written in the
// loop of steps, which allocates nothing.
bool own_list_has(const char *path, bool *has, Error *err)
{
    char folder[PATH_SIZE], list[PATH_SIZE], line[PATH_SIZE], bytes[2 * PATH_SIZE];
    const char *name = find_list(path, folder);
    *has = false;
    if (!name || !is_a_name(name)) return true;
    list_path(folder, list);
    size_t length = (size_t)snprintf(line, sizeof line, "\n%s\n", name), kept = 1;
    int file = open_to_read(list, err);
    if (file < 0) return false;
    bytes[0] = '\n';   // before the first line, too
    for (int64_t got; (got = transfer_read(file, bytes + kept, PATH_SIZE, -1)) > 0;) {
        size_t filled = kept + (size_t)got;
        if ((*has = memmem(bytes, filled, line, length))) break;
        kept = filled < length ? filled : length;
        memmove(bytes, bytes + filled - kept, kept);
    }
    close(file);
    return true;
}

bool own_list_refuse_taken(const char *path, Error *err)
{
    bool ours = false;
    if (!open_holds_something(path)) return true;
    if (!own_list_has(path, &ours, err)) return false;
    return ours || REFUSE(err,
                          "%s is there, and is not in the list of what amontons wrote "
                          "(" OWN_LIST_NAME "): choose another folder (-o), or move it away",
                          path);
}

// A line that a full disk cut is taken back: the next one would be joined to it.
bool own_list_add(const char *path, Error *err)
{
    char folder[PATH_SIZE], list[PATH_SIZE], line[PATH_SIZE], why[OPEN_WHY_SIZE];
    const char *name = find_list(path, folder);
    if (!name || !is_a_name(name)) return true;
    list_path(folder, list);
    int length = snprintf(line, sizeof line, "%s\n", name);
    int file = open_to_write(list, OPEN_THERE, why);
    if (file < 0) return FAULT(err, ERROR_FILE, "cannot write %s: %s", list, why);
    fcntl(file, F_SETFL, O_APPEND);
    off_t end = lseek(file, 0, SEEK_END);
    int cause = transfer_write(file, line, length, -1);
    if (cause && ftruncate(file, end) != 0) cause = errno;
    close(file);
    return cause == 0 || FAULT(err, ERROR_FILE, "cannot write %s: %s", list, strerror(cause));
}
