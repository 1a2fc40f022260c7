// SPDX-License-Identifier: GPL-2.0-or-later
// A list of system calls that are allowed, some with certain arguments; all others fail. The filter
// is a program of Linux's packet filter over struct seccomp_data (seccomp(2)). What glibc replaces
// by an older call where it is missing (clone3, openat2) is told as missing, since its arguments
// lie in memory, where a filter cannot look.
#include "base/shut_in.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { DESCRIPTORS_MAX = 1 << 16 };   // that are closed one by one

#if defined __x86_64__
#define ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined __aarch64__
#define ARCHITECTURE AUDIT_ARCH_AARCH64
#endif

#ifdef ARCHITECTURE

// Allowed whatever the arguments. A number that this system's headers do not know is left out.
static const int ALLOWED[] = {
    // memory
    SYS_brk, SYS_mmap, SYS_munmap, SYS_mremap, SYS_mprotect, SYS_madvise, SYS_memfd_create,
    // files that are open, and their names
    SYS_read, SYS_write, SYS_readv, SYS_writev, SYS_pread64, SYS_lseek, SYS_close, SYS_fstat,
    SYS_newfstatat, SYS_statx, SYS_fstatfs, SYS_statfs, SYS_readlinkat, SYS_faccessat, SYS_getcwd,
    SYS_dup, SYS_dup3, SYS_ppoll, SYS_fadvise64,
#ifdef SYS_faccessat2
    SYS_faccessat2,
#endif
#ifdef SYS_stat   // calls that only the older architecture has
    SYS_stat, SYS_lstat, SYS_access, SYS_readlink, SYS_poll, SYS_dup2, SYS_time, SYS_arch_prctl,
    SYS_getrlimit,
#endif
    // threads of this process
    SYS_futex, SYS_set_robust_list, SYS_set_tid_address, SYS_sched_yield, SYS_sched_getaffinity,
    SYS_sched_getparam, SYS_sched_getscheduler, SYS_gettid, SYS_exit, SYS_exit_group,
    SYS_membarrier,
#ifdef SYS_rseq
    SYS_rseq,
#endif
    // signals to itself, clocks, and what it is
    SYS_rt_sigaction, SYS_rt_sigprocmask, SYS_rt_sigreturn, SYS_sigaltstack, SYS_restart_syscall,
    SYS_clock_gettime, SYS_clock_getres, SYS_clock_nanosleep, SYS_nanosleep, SYS_gettimeofday,
    SYS_getrusage, SYS_times, SYS_sysinfo, SYS_uname, SYS_getrandom, SYS_getpid, SYS_getppid,
    SYS_getuid, SYS_geteuid, SYS_getgid, SYS_getegid};

// Told as missing.
static const int MISSING[] = {
#ifdef SYS_clone3
    SYS_clone3,
#endif
#ifdef SYS_openat2
    SYS_openat2,
#endif
};

// WRITES: flags of open. X32: a bit of the calls of another convention of the same processor.
enum {
    WRITES = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY),
    X32 = 0x40000000,
    PROGRAM_MAX = 300
};

typedef struct Filter {
    struct sock_filter program[PROGRAM_MAX];
    unsigned short length;
} Filter;

static void add(Filter *filter, uint16_t code, uint32_t value, uint8_t if_true, uint8_t if_false)
{
    if (filter->length < PROGRAM_MAX)
        filter->program[filter->length++] = (struct sock_filter){code, if_true, if_false, value};
}

static void load(Filter *filter, size_t offset)
{
    add(filter, BPF_LD | BPF_W | BPF_ABS, (uint32_t)offset, 0, 0);
}

static void answer(Filter *filter, uint32_t value)
{
    add(filter, BPF_RET | BPF_K, value, 0, 0);
}

static const uint32_t REFUSE = SECCOMP_RET_ERRNO | EPERM, ALLOW = SECCOMP_RET_ALLOW;

// Call `number`, whose argument `which` decides: allowed where `code` (BPF_JEQ, BPF_JSET) holds of
// it and `value`, or where it does not (`holds` false).
static void add_if(Filter *filter, long number, int which, uint16_t code, uint32_t value,
                   bool holds)
{
    add(filter, BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)number, 0, 4);
    // The lower half of the argument: all that counts of an int, on processors that store it first.
    load(filter, offsetof(struct seccomp_data, args) + (size_t)which * sizeof(uint64_t));
    add(filter, BPF_JMP | code | BPF_K, value, holds ? 0 : 1, holds ? 1 : 0);
    answer(filter, ALLOW);
    answer(filter, REFUSE);
}

bool shut_in(void)
{
    Filter made = {.length = 0}, *filter = &made;
    load(filter, offsetof(struct seccomp_data, arch));
    add(filter, BPF_JMP | BPF_JEQ | BPF_K, ARCHITECTURE, 1, 0);
    answer(filter, REFUSE);
    load(filter, offsetof(struct seccomp_data, nr));
    add(filter, BPF_JMP | BPF_JGE | BPF_K, X32, 0, 1);
    answer(filter, REFUSE);
    for (size_t k = 0; k < sizeof ALLOWED / sizeof *ALLOWED; k++) {
        add(filter, BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)ALLOWED[k], 0, 1);
        answer(filter, ALLOW);
    }
    for (size_t k = 0; k < sizeof MISSING / sizeof *MISSING; k++) {
        add(filter, BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)MISSING[k], 0, 1);
        answer(filter, SECCOMP_RET_ERRNO | ENOSYS);
    }
    add_if(filter, SYS_openat, 2, BPF_JSET, WRITES, false);
#ifdef SYS_open
    add_if(filter, SYS_open, 1, BPF_JSET, WRITES, false);
#endif
    add_if(filter, SYS_clone, 0, BPF_JSET, CLONE_THREAD, true);
    add_if(filter, SYS_tgkill, 0, BPF_JEQ, (uint32_t)getpid(), true);
    add_if(filter, SYS_prlimit64, 0, BPF_JEQ, 0, true);
    add_if(filter, SYS_ioctl, 1, BPF_JEQ, TCGETS, true);
    add_if(filter, SYS_fcntl, 1, BPF_JEQ, F_GETFL, true);
    answer(filter, REFUSE);

    struct sock_fprog program = {made.length, made.program};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
        prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0)
        return true;
    setrlimit(RLIMIT_NPROC, &(struct rlimit){0, 0});
    return false;
}

#else

bool shut_in(void)
{
    setrlimit(RLIMIT_NPROC, &(struct rlimit){0, 0});
    return false;
}

#endif

void shut_in_close(int first, int last)
{
    if (last < first) return;
#ifdef SYS_close_range
    if (syscall(SYS_close_range, (unsigned)first, (unsigned)last, 0) == 0) return;
#endif
    long most = sysconf(_SC_OPEN_MAX);
    if (most < 0 || most > DESCRIPTORS_MAX) most = DESCRIPTORS_MAX;
    for (int k = first; k <= last && k < most; k++) close(k);
}
