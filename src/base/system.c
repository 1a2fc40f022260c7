// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/system.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef __linux__
#include <linux/magic.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/vfs.h>
#endif
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif
#ifdef __GLIBC__
#include <link.h>
#include <malloc.h>
#endif

// --- processes -----------------------------------------------------------------------------------

void system_end_with_parent(void)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}

int system_pipe(int ends[2])
{
#ifdef __linux__
    return pipe2(ends, O_CLOEXEC);
#else
    if (pipe(ends) != 0) return -1;
    for (int k = 0; k < 2; k++) fcntl(ends[k], F_SETFD, FD_CLOEXEC);
    return 0;
#endif
}

int32_t system_processors(void)
{
#ifdef __linux__
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
    return 1;
#else
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count > 0 ? (int32_t)count : 1;
#endif
}

// --- places --------------------------------------------------------------------------------------

bool system_program_path(char *path, size_t size)
{
    path[0] = 0;
#ifdef __APPLE__
    uint32_t room = (uint32_t)size;
    return _NSGetExecutablePath(path, &room) == 0;
#else
    ssize_t length = readlink("/proc/self/exe", path, size - 1);
    path[length > 0 ? length : 0] = 0;
    return length > 0;
#endif
}

// glibc knows the path of every shared object but the program's own, which has an empty name; the
// others give the program's, too.
bool system_object_path(const void *address, char *path, size_t size)
{
    Dl_info info;
#ifdef __GLIBC__
    void *map = NULL;
    if (dladdr1(address, &info, &map, RTLD_DL_LINKMAP) == 0 || !map) return false;
    const char *name = ((const struct link_map *)map)->l_name;
#else
    if (dladdr(address, &info) == 0 || !info.dli_fname) return false;
    const char *name = info.dli_fname;
#endif
    snprintf(path, size, "%s", name);
    return name[0] != 0;
}

// --- memory --------------------------------------------------------------------------------------

int64_t system_address_space(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file) return 0;
    if (fscanf(file, "%ld", &pages) != 1) pages = 0;
    fclose(file);
    return (int64_t)pages * sysconf(_SC_PAGESIZE);
}

bool system_has_room(size_t bytes)
{
    void *room = mmap(NULL, bytes, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) return false;
    munmap(room, bytes);
    return true;
}

void system_use_large_pages(void *array, size_t bytes)
{
#ifdef MADV_HUGEPAGE
    madvise(array, bytes, MADV_HUGEPAGE);
#else
    (void)array, (void)bytes;
#endif
}

void system_give_back_memory(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

// --- files ---------------------------------------------------------------------------------------

bool system_is_shell_pipe(const char *path, mode_t mode)
{
#ifdef __linux__
    struct statfs system;
    return S_ISFIFO(mode) && statfs(path, &system) == 0 && system.f_type == PIPEFS_MAGIC;
#else
    return S_ISFIFO(mode) && strncmp(path, "/dev/fd/", 8) == 0;
#endif
}

#ifdef __APPLE__
typedef struct Stream {
    void *context;
    SystemWrite write;
} Stream;

static int stream_write(void *self, const char *bytes, int count)
{
    Stream *stream = self;
    return (int)stream->write(stream->context, bytes, (size_t)count);
}

static int stream_close(void *self)
{
    free(self);
    return 0;
}

FILE *system_stream(void *context, SystemWrite write)
{
    Stream *stream = malloc(sizeof *stream);   // of the stream, as the C library's own
    if (!stream) return NULL;
    *stream = (Stream){context, write};
    FILE *file = funopen(stream, NULL, stream_write, NULL, stream_close);
    if (!file) free(stream);
    return file;
}
#else
FILE *system_stream(void *context, SystemWrite write)
{
    return fopencookie(context, "w", (cookie_io_functions_t){.write = write});
}
#endif

// --- order ---------------------------------------------------------------------------------------

#ifdef __APPLE__
typedef struct Sorting {
    int (*compare)(const void *, const void *, void *);
    void *context;
} Sorting;

static int compare_two(void *self, const void *a, const void *b)
{
    Sorting *sorting = self;
    return sorting->compare(a, b, sorting->context);
}
#endif

void system_sort(void *items, size_t count, size_t size,
                 int (*compare)(const void *, const void *, void *), void *context)
{
#ifdef __APPLE__
    Sorting sorting = {compare, context};
    qsort_r(items, count, size, &sorting, compare_two);
#else
    qsort_r(items, count, size, compare, context);   // musl: since 1.2.3
#endif
}
