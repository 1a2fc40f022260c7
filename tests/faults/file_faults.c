// SPDX-License-Identifier: GPL-2.0-or-later
// Preloaded into the program (LD_PRELOAD), or linked into a test, lets one call to the system fail:
// the variable FILE_FAULT=write:12 the twelfth write of the process and its children, with ENOSPC
// (sync: EIO); write:12+ that one and every later one, as on a full disk. An interrupt is a read,
// write or wait that a signal ended before it began (EINTR). FILE_FAULT=count:PATH: none fails, and
// the file has a line for each call when the first process ends: its kind, its number, and a number
// that stands for who called it (the return addresses up to main, and those of the parents).
//
// Memory is that of our allocator, which alone calls aligned_alloc (base/memory).
//
// Writes to standard error never fail. Calls of a program and its libraries are seen, not
// what the C library calls within itself: a stream's buffer is written out by fwrite, fflush or
// fclose.
#include "faults/file_faults.h"

#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define KINDS(X)                                                                                   \
    X(OPEN, "open")                                                                                \
    X(WRITE, "write")                                                                              \
    X(SYNC, "sync")                                                                                \
    X(RENAME, "rename")                                                                            \
    X(FOLDER, "mkdir")                                                                             \
    X(LENGTH, "truncate")                                                                          \
    X(CLOSE, "close")                                                                              \
    X(PROCESS, "process") X(MEMORY, "memory") X(READ, "read") X(INTERRUPT, "interrupt")

enum {
#define X(symbol, name) symbol,
    KINDS(X) KIND_COUNT
#undef X
};

static const char *const names[] = {
#define X(symbol, name) name,
    KINDS(X)
#undef X
};

enum { CALLS_MAX = 20000, DEPTH = 60 };

typedef struct Calls {
    atomic_int count[KIND_COUNT];
    uint64_t callers[KIND_COUNT][CALLS_MAX];
} Calls;

static Calls *calls;   // shared with children
static const char *wanted;   // NULL: no fault
static bool listing;

// FNV-1a over the return addresses; 1: this library's own frames.
static uint64_t hash_callers(void)
{
    void *address[DEPTH];
    uint64_t hash = 14695981039346656037u;
    int depth = backtrace(address, DEPTH);
    for (int k = 1; k < depth; k++) hash = (hash ^ (uintptr_t)address[k]) * 1099511628211u;
    return hash;
}

// Whether this call shall fail.
static bool is_due(int kind)
{
    size_t length = strlen(names[kind]);
    if (!calls || !wanted) return false;
    int count = atomic_fetch_add(&calls->count[kind], 1) + 1;
    if (listing && count <= CALLS_MAX) calls->callers[kind][count - 1] = hash_callers();
    if (strncmp(wanted, names[kind], length) != 0 || wanted[length] != ':') return false;
    int first = atoi(wanted + length + 1);
    bool due = count == first || (count > first && wanted[strlen(wanted) - 1] == '+');
    static const int causes[KIND_COUNT] = {
        [SYNC] = EIO, [READ] = EIO, [PROCESS] = EAGAIN, [MEMORY] = ENOMEM, [INTERRUPT] = EINTR};
    if (due) errno = causes[kind] ? causes[kind] : ENOSPC;
    return due;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

void file_faults_start(const char *fault)
{
    void *first[1];
    wanted = NULL;
    memset(calls, 0, sizeof *calls);
    listing = fault && strncmp(fault, "count:", 6) == 0;
    if (listing) backtrace(first, 1);   // loads what it needs
    wanted = fault;
}

void file_faults_end(void)
{
    wanted = listing ? wanted : NULL;
}

__attribute__((constructor)) static void begin(void)
{
    void *shared =
        mmap(NULL, sizeof(Calls), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) return;
    calls = shared;
    file_faults_start(getenv("FILE_FAULT"));
}

// Whether no earlier call of its kind came from the same callers.
static bool is_first(int kind, int k)
{
    for (int before = 0; before < k; before++)
        if (calls->callers[kind][before] == calls->callers[kind][k]) return false;
    return true;
}

int file_faults_list(char (*faults)[FILE_FAULT_SIZE], int room)
{
    int count = 0;
    for (int kind = 0; kind < KIND_COUNT; kind++)
        for (int k = 0; k < calls->count[kind] && k < CALLS_MAX && count < room; k++)
            if (is_first(kind, k))
                snprintf(faults[count++], FILE_FAULT_SIZE, "%s:%d", names[kind], k + 1);
    return count;
}

__attribute__((destructor)) static void end(void)
{
    if (!calls || !listing) return;
    FILE *file = REAL(fopen)(wanted + 6, "w");
    for (int kind = 0; file && kind < KIND_COUNT; kind++)
        for (int k = 0; k < calls->count[kind] && k < CALLS_MAX; k++)
            fprintf(file, "%s %d %llx\n", names[kind], k + 1,
                    (unsigned long long)calls->callers[kind][k]);
    if (file) REAL(fclose)(file);
}

// --- open ---------------------------------------------------------------------------------------

static int mode_of(int flags, va_list rest)
{
    return flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, int) : 0;
}

int open(const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    int mode = mode_of(flags, rest);
    va_end(rest);
    return is_due(OPEN) ? -1 : REAL(open)(path, flags, mode);
}

int open64(const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    int mode = mode_of(flags, rest);
    va_end(rest);
    return is_due(OPEN) ? -1 : REAL(open64)(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    int mode = mode_of(flags, rest);
    va_end(rest);
    return is_due(OPEN) ? -1 : REAL(openat)(folder, path, flags, mode);
}

FILE *fopen(const char *path, const char *mode)
{
    return is_due(OPEN) ? NULL : REAL(fopen)(path, mode);
}

FILE *fopen64(const char *path, const char *mode)
{
    return is_due(OPEN) ? NULL : REAL(fopen64)(path, mode);
}

int memfd_create(const char *name, unsigned int flags)
{
    return is_due(OPEN) ? -1 : REAL(memfd_create)(name, flags);
}

enum { STREAM_FAILED = 0x20 };   // what ferror() looks at in glibc

// --- write --------------------------------------------------------------------------------------

ssize_t write(int file, const void *bytes, size_t size)
{
    return is_due(WRITE) || is_due(INTERRUPT) ? -1 : REAL(write)(file, bytes, size);
}

ssize_t pwrite(int file, const void *bytes, size_t size, off_t at)
{
    return is_due(WRITE) || is_due(INTERRUPT) ? -1 : REAL(pwrite)(file, bytes, size, at);
}

ssize_t pwrite64(int file, const void *bytes, size_t size, off64_t at)
{
    return is_due(WRITE) || is_due(INTERRUPT) ? -1 : REAL(pwrite64)(file, bytes, size, at);
}

size_t fwrite(const void *bytes, size_t size, size_t count, FILE *file)
{
    if (file == stderr || !is_due(WRITE)) return REAL(fwrite)(bytes, size, count, file);
    file->_flags |= STREAM_FAILED;
    return 0;
}

int fflush(FILE *file)
{
    if (!is_due(WRITE)) return REAL(fflush)(file);
    if (file) file->_flags |= STREAM_FAILED;
    return EOF;
}

// --- read ---------------------------------------------------------------------------------------

ssize_t read(int file, void *bytes, size_t size)
{
    return is_due(READ) || is_due(INTERRUPT) ? -1 : REAL(read)(file, bytes, size);
}

ssize_t pread(int file, void *bytes, size_t size, off_t at)
{
    return is_due(READ) || is_due(INTERRUPT) ? -1 : REAL(pread)(file, bytes, size, at);
}

ssize_t pread64(int file, void *bytes, size_t size, off64_t at)
{
    return is_due(READ) || is_due(INTERRUPT) ? -1 : REAL(pread64)(file, bytes, size, at);
}

size_t fread(void *bytes, size_t size, size_t count, FILE *file)
{
    if (!is_due(READ)) return REAL(fread)(bytes, size, count, file);
    file->_flags |= STREAM_FAILED;
    return 0;
}

// --- the rest -----------------------------------------------------------------------------------

int fsync(int file)
{
    return is_due(SYNC) ? -1 : REAL(fsync)(file);
}

int fdatasync(int file)
{
    return is_due(SYNC) ? -1 : REAL(fdatasync)(file);
}

int rename(const char *from, const char *to)
{
    return is_due(RENAME) ? -1 : REAL(rename)(from, to);
}

int mkdir(const char *path, mode_t mode)
{
    return is_due(FOLDER) ? -1 : REAL(mkdir)(path, mode);
}

int ftruncate(int file, off_t length)
{
    return is_due(LENGTH) ? -1 : REAL(ftruncate)(file, length);
}

int ftruncate64(int file, off64_t length)
{
    return is_due(LENGTH) ? -1 : REAL(ftruncate64)(file, length);
}

// The descriptor is free afterwards, as Linux has it.
int close(int file)
{
    bool due = is_due(CLOSE);
    int cause = errno, status = REAL(close)(file);
    if (due) errno = cause;
    return due ? -1 : status;
}

int fclose(FILE *file)
{
    bool due = is_due(CLOSE);
    int cause = errno, status = REAL(fclose)(file);
    if (due) errno = cause;
    return due ? EOF : status;
}

pid_t fork(void)
{
    return is_due(PROCESS) ? -1 : REAL(fork)();
}

int pipe(int ends[2])
{
    return is_due(PROCESS) ? -1 : REAL(pipe)(ends);
}

pid_t waitpid(pid_t process, int *ending, int options)
{
    return is_due(INTERRUPT) ? -1 : REAL(waitpid)(process, ending, options);
}

pid_t wait4(pid_t process, int *ending, int options, struct rusage *used)
{
    return is_due(INTERRUPT) ? -1 : REAL(wait4)(process, ending, options, used);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return is_due(MEMORY) ? NULL : REAL(aligned_alloc)(alignment, size);
}
