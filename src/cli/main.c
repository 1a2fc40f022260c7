// SPDX-License-Identifier: GPL-2.0-or-later
// The program. Libraries read their variables while they are loaded: so the process is prepared
// first, and the module with all commands (cli/commands.c), which needs OpenBLAS and OpenMP, is
// opened then. What a host of the library has is left alone; this is a process of our own.
#include <dlfcn.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

// Bytes that a run needs: address space for the program and HDF5, and stack for the matrices of an
// element in space (81 unknowns; a run ends in a fault with 384 kB, and does well with 512).
static const rlim_t ROOM_LEAST = (rlim_t)190 << 20, STACK_LEAST = (rlim_t)1 << 20;

// Names the process that has set KERNELS and executed itself.
static const char AGAIN[] = "AMONTONS_AGAIN", KERNELS[] = "OPENBLAS_CORETYPE";

// Read while libraries are loaded, then as they were before: a job that a sweep submits shall not
// inherit them. OpenBLAS would start a thread for each processor, which the small matrices here do
// not need; libgomp complains of what it does not understand.
static const char *const ONE_THREAD[] = {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"};
enum { VARIABLES = sizeof ONE_THREAD / sizeof ONE_THREAD[0] };

typedef void AnyFunction(void);
typedef struct Commands {
    int (*run)(int argc, char **argv);
    const char *(*better_kernels)(void);
} Commands;

// With less room than the libraries take (ulimit -v) OpenBLAS would end the program with its own
// words.
static bool meets_limit(int asked, struct rlimit limit, rlim_t least, const char *what)
{
    if (asked != 0 || limit.rlim_cur >= least) return true;
    fprintf(stderr, "amontons: error: only %lu kB of %s); to start takes %lu kB\n",
            (unsigned long)limit.rlim_cur >> 10, what, (unsigned long)least >> 10);
    return false;
}

// POSIX: what dlsym gives may be a function.
static AnyFunction *find_function(void *module, const char *name)
{
    AnyFunction *function = NULL;
    void *address = dlsym(module, name);
    if (!address) fprintf(stderr, "amontons: error: %s\n", dlerror());
    memcpy(&function, &address, sizeof function);
    return function;
}

// Opens the module and its libraries in an environment that tells them to start no threads.
static bool load_commands(Commands *commands)
{
    char *before[VARIABLES];
    for (int k = 0; k < VARIABLES; k++) {
        const char *value = getenv(ONE_THREAD[k]);
        before[k] = value ? strdup(value) : NULL;
        setenv(ONE_THREAD[k], "1", 1);
    }

    // In the build tree the module stands beside the program, else in the folder of the modules.
    static const char *const places[] = {"", AMONTONS_MODULES_FROM_PROGRAM "/"};
    char program[PATH_MAX] = {0}, path[2 * PATH_MAX];
    void *module = NULL;
    if (readlink("/proc/self/exe", program, sizeof program - 1) < 0) {
        fprintf(stderr, "amontons: error: cannot tell where the program is (/proc/self/exe)\n");
    } else {
        const char *folder = dirname(program);
        for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
            snprintf(path, sizeof path, "%s/%samontons_commands.so", folder, places[k]);
            if (access(path, F_OK) == 0) break;
        }
        module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        if (!module) fprintf(stderr, "amontons: error: %s\n", dlerror());
    }
    for (int k = 0; k < VARIABLES; k++) {
        if (before[k])
            setenv(ONE_THREAD[k], before[k], 1);
        else
            unsetenv(ONE_THREAD[k]);
        free(before[k]);
    }
    if (!module) return false;
    commands->run = (int (*)(int, char **))find_function(module, "amontons_command");
    commands->better_kernels =
        (const char *(*)(void))find_function(module, "amontons_better_kernels");
    return commands->run && commands->better_kernels;
}

int main(int argc, char **argv)
{
    Commands commands;
    const char *by = getenv(AGAIN);   // the process that has executed itself
    bool again = by && atol(by) == (long)getpid();
    unsetenv(AGAIN);

    // A process may be started with standard streams closed; the first files that it opens would
    // then be taken for them, and progress lines written into a result.
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDWR) < 0) _exit(1);
    signal(SIGXFSZ, SIG_IGN);   // a file that reaches its limit (ulimit -f) is an error with words
    signal(SIGCHLD, SIG_DFL);   // base/process; who starts this may ignore it

    // Limits of the system. Where few files may be open, gmsh and others find nothing in one that
    // they cannot open, and blame that.
    enum { OPEN_LEAST = 16 };
    struct rlimit room = {0}, stack = {0}, files = {0};
    int asked_room = getrlimit(RLIMIT_AS, &room), asked_stack = getrlimit(RLIMIT_STACK, &stack);
    if (!meets_limit(asked_room, room, ROOM_LEAST, "memory are allowed (ulimit -v") ||
        !meets_limit(asked_stack, stack, STACK_LEAST, "stack are allowed (ulimit -s"))
        return 1;
    if (getrlimit(RLIMIT_NOFILE, &files) == 0 && files.rlim_cur < OPEN_LEAST) {
        fprintf(stderr, "amontons: error: only %lu files may be open (ulimit -n); it takes %d\n",
                (unsigned long)files.rlim_cur, (int)OPEN_LEAST);
        return 1;
    }
    if (!load_commands(&commands)) return 1;

    // OpenBLAS chooses its kernels while it is loaded, by family and model of the processor: 0.3.21
    // takes those for SSE3, a fifth as fast, where it does not know these. Then the program sets
    // the variable that chooses and executes itself, once. Where that fails it goes on as it is.
    char path[PATH_MAX] = {0}, number[32];
    if (again) unsetenv(KERNELS);   // read by now; whoever had chosen it would have kept us from it
    const char *better = again || getenv(KERNELS) ? NULL : commands.better_kernels();
    if (better && readlink("/proc/self/exe", path, sizeof path - 1) >= 0) {
        snprintf(number, sizeof number, "%ld", (long)getpid());
        setenv(AGAIN, number, 1);
        setenv(KERNELS, better, 1);
        execv(path, argv);
        unsetenv(AGAIN);
        unsetenv(KERNELS);
    }
    setenv("LP_NUM_THREADS", "0", 0);   // of OSMesa, which hangs where it may start none
    return commands.run(argc, argv);
}
