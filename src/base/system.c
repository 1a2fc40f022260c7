// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/system.h"

#include <dlfcn.h>
#include <libgen.h>
#include <limits.h>
#include <link.h>
#include <linux/magic.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

int32_t system_processors(void)
{
    cpu_set_t allowed;
    return sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
}

bool system_program_path(char *path, size_t size)
{
    ssize_t length = readlink("/proc/self/exe", path, size - 1);
    path[length > 0 ? length : 0] = 0;
    return length > 0;
}

// glibc knows the path of every shared object but the program's own, which has an empty name.
static bool find_object_path(const void *address, char *path, size_t size)
{
    Dl_info info;
    void *map = NULL;
    if (dladdr1(address, &info, &map, RTLD_DL_LINKMAP) == 0 || !map) return false;
    const char *name = ((const struct link_map *)map)->l_name;
    snprintf(path, size, "%s", name);
    return name[0] != 0;
}

bool system_folder(char *folder, size_t size, Error *err)
{
    static const char here = 0;   // an address in this object
    char path[PATH_MAX] = {0};
    if (!find_object_path(&here, path, sizeof path) && !system_program_path(path, sizeof path))
        return FAULT(err, ERROR_LIBRARY, "cannot tell where the program stands (/proc/self/exe)");
    snprintf(folder, size, "%s", dirname(path));
    return true;
}

bool system_find(const char *const *names, int32_t count, char *path, size_t size)
{
    Error unseen = {0};   // no folder: nothing is found in it
    char folder[PATH_MAX] = {0};
    path[0] = 0;
    if (!system_folder(folder, sizeof folder, &unseen)) return false;
    for (int32_t k = 0; k < count; k++) {
        int length = snprintf(path, size, "%s/%s", folder, names[k]);
        if (length > 0 && (size_t)length < size && access(path, F_OK) == 0) return true;
    }
    path[0] = 0;
    return false;
}

int64_t system_address_space(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file) return 0;
    if (fscanf(file, "%ld", &pages) != 1) pages = 0;
    fclose(file);
    return (int64_t)pages * sysconf(_SC_PAGESIZE);
}

double system_memory(void)
{
    struct rlimit room;
    double have = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    bool limited = getrlimit(RLIMIT_AS, &room) == 0 && room.rlim_cur != RLIM_INFINITY;
    return limited && (double)room.rlim_cur < have ? (double)room.rlim_cur : have;
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
    madvise(array, bytes, MADV_HUGEPAGE);
}

bool system_is_descriptor(const char *path)
{
    static const char *const folders[] = {"/dev/fd/", "/proc/self/fd/"};
    for (size_t k = 0; k < sizeof folders / sizeof *folders; k++) {
        size_t length = strlen(folders[k]);
        if (strncmp(path, folders[k], length) != 0) continue;
        return path[length] && !path[length + strspn(path + length, "0123456789")];
    }
    return strcmp(path, "/dev/stdin") == 0;
}

bool system_is_shell_pipe(const char *path, mode_t mode)
{
    struct statfs system;
    return S_ISFIFO(mode) && system_is_descriptor(path) && statfs(path, &system) == 0 &&
           system.f_type == PIPEFS_MAGIC;
}
