// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/transfer.h"

#include <errno.h>
#include <unistd.h>

int64_t transfer_read(int descriptor, void *bytes, int64_t size, int64_t at)
{
    int64_t got = 0;
    errno = 0;
    while (got < size) {
        char *next = (char *)bytes + got;
        size_t left = (size_t)(size - got);
        ssize_t count = at < 0 ? read(descriptor, next, left)
                               : pread(descriptor, next, left, (off_t)(at + got));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        errno = 0;
        got += count;
    }
    return got;
}

int transfer_write(int descriptor, const void *bytes, int64_t size, int64_t at)
{
    for (int64_t done = 0; done < size;) {
        const char *next = (const char *)bytes + done;
        size_t left = (size_t)(size - done);
        ssize_t count = at < 0 ? write(descriptor, next, left)
                               : pwrite(descriptor, next, left, (off_t)(at + done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return count < 0 ? errno : ENOSPC;
        done += count;
    }
    return 0;
}

int transfer_sync(int descriptor)
{
    return fdatasync(descriptor) != 0 && errno != EINVAL ? errno : 0;
}
