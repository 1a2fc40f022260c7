// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/files/open_file.h"

#include "base/system.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Names the kind of something that is not a file; NULL: it is a file.
static const char *kind_of(const struct stat *status)
{
    switch (status->st_mode & S_IFMT) {
    case S_IFREG:
        return NULL;
    case S_IFDIR:
        return "a folder";
    case S_IFIFO:
        return "a pipe (FIFO)";
    case S_IFSOCK:
        return "a socket";
    default:
        return "a device";
    }
}

// --- to read ------------------------------------------------------------------------------------

// A pipe without a name in any folder: its other end is open.
static bool is_of_shell(const char *path, const struct stat *status)
{
    return system_is_shell_pipe(path, status->st_mode);
}

bool open_check_named(const char *path, Error *err)
{
    if (!system_is_descriptor(path)) return true;
    return REFUSE(err,
                  "%s is a pipe or file that is open already, which may be named on the command "
                  "line alone; a file names others by their own paths",
                  path);
}

bool open_check(const char *path, Error *err)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return FAULT(err, errno == ENOENT || errno == ENOTDIR ? ERROR_INPUT : ERROR_FILE,
                     "cannot read %s: %s", path, strerror(errno));
    if (kind_of(&status) && !is_of_shell(path, &status))
        return REFUSE(err, "%s is %s, not a file", path, kind_of(&status));
    return true;
}

// O_NONBLOCK: what was a file a moment ago is not waited for either.
int open_to_read(const char *path, Error *err)
{
    struct stat status;
    int file = -1;
    TRY(open_check(path, err));
    file = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0 || fstat(file, &status) != 0)
        FAIL(err, ERROR_FILE, "cannot read %s: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode) && !is_of_shell(path, &status))
        FAIL(err, ERROR_INPUT, "%s is %s, not a file", path, kind_of(&status));
    fcntl(file, F_SETFL, 0);
    return file;
cleanup:
    if (file >= 0) close(file);
    return -1;
}

FILE *open_stream(const char *path, Error *err)
{
    FILE *stream = NULL;
    int file = open_to_read(path, err);
    if (file < 0) return NULL;
    if (!(stream = fdopen(file, "rb"))) {
        close(file);
        FAIL(err, ERROR_FILE, "cannot read %s: %s", path, strerror(errno));
    }
cleanup:
    return stream;
}

// --- to write -----------------------------------------------------------------------------------

bool open_is_there(const char *path)
{
    struct stat status;
    return lstat(path, &status) == 0;
}

bool open_holds_something(const char *path)
{
    struct stat status;
    return lstat(path, &status) == 0 && !(S_ISREG(status.st_mode) && status.st_size == 0);
}

static int refuse(const char *path, const char *what, char why[OPEN_WHY_SIZE])
{
    snprintf(why, OPEN_WHY_SIZE, "%.250s is %s: move it away", path, what);
    errno = EEXIST;
    return -1;
}

int open_to_write(const char *path, OpenAs as, char why[OPEN_WHY_SIZE])
{
    for (int turn = 0;; turn++) {   // what was there may go meanwhile
        int file = -1;
        if (as != OPEN_THERE) {
            file = open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
            if (file >= 0) return file;
            if (errno != EEXIST) {
                snprintf(why, OPEN_WHY_SIZE, "%s", strerror(errno));
                return -1;
            }
        }

        // One that is there. O_NONBLOCK: a pipe is not waited for.
        struct stat status;
        file = open(path, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
        if (file >= 0) {
            const char *against = "not to be looked at";   // why it must not be written to, or NULL
            if (fstat(file, &status) == 0)
                against = !S_ISREG(status.st_mode) ? kind_of(&status)
                          : status.st_nlink > 1    ? "a file with a second name (a hard link)"
                                                   : NULL;
            if (!against) return file;
            close(file);
            return refuse(path, against, why);
        }
        int cause = errno;
        snprintf(why, OPEN_WHY_SIZE, "%s", strerror(cause));
        if (lstat(path, &status) == 0 && S_ISLNK(status.st_mode))
            return refuse(path, "a symbolic link, which is not followed", why);
        if (lstat(path, &status) == 0 && kind_of(&status))
            return refuse(path, kind_of(&status), why);
        errno = cause;
        if (cause != ENOENT || as == OPEN_THERE || turn > 9) return -1;
    }
}
