// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/files/folder.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool folder_make(const char *path, Error *err)
{
    char part[PATH_MAX];
    struct stat what;
    if (snprintf(part, sizeof part, "%s", path) >= (int)sizeof part)
        return REFUSE(err, "the path of the folder %.80s... is too long", path);
    for (char *slash = part + 1; *slash; slash++) {
        if (*slash != '/') continue;
        *slash = 0;
        mkdir(part, 0777);   // a failure shows when the last one is made
        *slash = '/';
    }
    if (mkdir(part, 0777) != 0 && errno != EEXIST) {
        bool wrong_name = errno == ENAMETOOLONG || errno == ENOTDIR;   // no disk can help it
        return FAULT(err, wrong_name ? ERROR_INPUT : ERROR_FILE, "cannot make the folder %s: %s",
                     path, strerror(errno));
    }
    if (stat(part, &what) == 0 && !S_ISDIR(what.st_mode))
        return REFUSE(
            err, "%s is a file, not a folder: choose another folder (-o), or move it away", path);
    return true;
}

// Both by their real paths: one ".." for each name of the folder's that is not the file's too.
void folder_relative(const char *folder, const char *file, char *path, int32_t size)
{
    char from[PATH_MAX + 1], to[PATH_MAX];
    snprintf(path, (size_t)size, "%s", file);
    if (!realpath(folder, from) || !realpath(file, to)) return;
    size_t shared = 0, used = 0;   // bytes, up to the last slash behind which names differ
    if (from[1]) snprintf(from + strlen(from), 2, "/");
    for (size_t k = 0; from[k] && from[k] == to[k]; k++)
        if (from[k] == '/') shared = k + 1;
    for (const char *rest = from + shared; (rest = strchr(rest, '/')); rest++)
        if (used + 3 < (size_t)size) used += (size_t)sprintf(path + used, "../");
    snprintf(path + used, (size_t)size - used, "%s", to + shared);
}

bool folder_beside(const char *file, const char *given, char *path, int32_t size)
{
    const char *slash = file && *given != '/' ? strrchr(file, '/') : NULL;
    int length = slash ? (int)(slash - file) + 1 : 0;
    return snprintf(path, (size_t)size, "%.*s%s", length, slash ? file : "", given) < size;
}

// --- inside of a folder of ours ------------------------------------------------------------------
// Goes from folder to folder by descriptors, so that what was looked at is what is entered.

typedef struct Walk {
    const char *rest;   // of the name
    int32_t depth;   // of the next part's folder below the root
    char part[NAME_MAX + 1];
} Walk;

// Takes the next part of the name. false: there is none (errno 0), it is too long, or leads out.
static bool take_part(Walk *walk)
{
    size_t length = 0;
    errno = 0;
    do {
        walk->rest += length;
        walk->rest += strspn(walk->rest, "/");
        length = strcspn(walk->rest, "/");
    } while (length == 1 && walk->rest[0] == '.');
    if (length == 0) return false;
    if (length > NAME_MAX) {
        errno = ENAMETOOLONG;
        return false;
    }
    memcpy(walk->part, walk->rest, length);
    walk->part[length] = 0;
    walk->rest += length;
    walk->depth += strcmp(walk->part, "..") == 0 ? -1 : 1;
    if (walk->depth < 0) errno = EXDEV;
    return walk->depth >= 0;
}

static int open_root(const char *root)
{
    return open(root, O_PATH | O_DIRECTORY | O_CLOEXEC);
}

// The folder `part` of the folder `at`, which is closed.
static int enter(int at, const char *part)
{
    int next = openat(at, part, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC), cause = errno;
    close(at);
    errno = cause;
    return next;
}

static bool is_link(int at, const char *part)
{
    struct stat status;
    return fstatat(at, part, &status, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(status.st_mode);
}

int folder_open_inside(const char *root, const char *name, bool make)
{
    Walk walk = {.rest = name};
    int at = *name == '/' ? -1 : open_root(root);
    if (*name == '/') errno = EXDEV;
    while (at >= 0 && take_part(&walk)) {
        if (make) mkdirat(at, walk.part, 0777);   // a failure shows when it is entered
        bool link = is_link(at, walk.part);
        at = enter(at, walk.part);
        if (at < 0 && link) errno = ELOOP;
    }
    if (at < 0 || errno == 0) return at;
    int cause = errno;
    close(at);
    errno = cause;
    return -1;
}

static bool refuse_outside(const char *root, const char *name, Error *err)
{
    return REFUSE(err,
                  "%.250s leads out of %.250s, whose files name it: only what lies inside is read "
                  "or written there",
                  name, root);
}

static bool refuse_link(const char *root, const char *name, const char *rest, Error *err)
{
    return REFUSE(err,
                  "%.250s/%.*s is a symbolic link, and inside of a result none is followed: put in "
                  "its place what it leads to, or move it away",
                  root, (int)(rest - name), name);
}

bool folder_check_inside(const char *root, const char *name, Error *err)
{
    Walk walk = {.rest = name};
    if (*name == '/') return refuse_outside(root, name, err);
    int at = open_root(root);
    while (at >= 0 && take_part(&walk)) {
        if (is_link(at, walk.part)) {
            close(at);
            return refuse_link(root, name, walk.rest, err);
        }
        at = enter(at, walk.part);   // the last part, a file, is not entered
    }
    if (at >= 0) close(at);
    return walk.depth >= 0 || refuse_outside(root, name, err);
}

bool folder_make_inside(const char *root, const char *name, Error *err)
{
    if (!folder_make(root, err) || !folder_check_inside(root, name, err)) return false;
    int at = folder_open_inside(root, name, true);
    bool is_file = at < 0 && (errno == ENOTDIR || errno == EEXIST);
    if (is_file) return REFUSE(err, "%s/%s is a file, not a folder: move it away", root, name);
    if (at < 0)
        return FAULT(err, errno == ENAMETOOLONG ? ERROR_INPUT : ERROR_FILE,
                     "cannot make the folder %s/%s: %s", root, name, strerror(errno));
    close(at);
    return true;
}
