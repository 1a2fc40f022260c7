// SPDX-License-Identifier: GPL-2.0-or-later
// Finds the command that the first word asks for.
#include "amontons.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/say.h"
#include "cli_help.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// The commands stand in the order in which `--help` lists them.
static const Command commands[] = {
    {"run", command_run, "SCENE", "simulates a scene and writes a result folder", "scene",
     "amontons run validation/paper/fig1.yaml", run_txt, NULL},
    {"static", command_static, "SCENE", "finds the equilibrium under a given load", "scene",
     "amontons static validation/freefem/friction.yaml", static_txt, NULL},
    {"stability", command_stability, "SCENE", "finds where slow slip loses stability: l_c, mu_M",
     "scene", "amontons stability validation/paper/fig1.yaml", stability_txt, NULL},
    {"model1d", command_model1d, "SCENE",
     "computes the 1D model of the paper: theory and simulation", "scene",
     "amontons model1d validation/paper/fig1.yaml", model1d_txt, NULL},
    {"sweep", command_sweep, "STUDY", "computes many runs over varied keys, into one table",
     "study", "amontons sweep validation/paper/fig2a.yaml", sweep_txt, NULL},
    {"optimise", command_search, "STUDY", "searches the best design of a study", "study",
     "amontons optimise docs/examples/best_pads.yaml", optimise_txt, NULL},
    {"fit", command_search, "STUDY", "finds the numbers of a scene that measurements speak for",
     "study", "amontons fit docs/examples/viscosity.yaml", fit_txt, NULL},
    {"render", command_render, "RESULT\nSWEEP\nPLOT.yaml",
     "draws the pictures of a stored result again", "result folder", "amontons render fig1-result",
     render_txt, NULL},
    {"compare", command_compare, "RESULT FILE.csv",
     "draws measurements beside a result, and says the misfit", "result folder",
     "amontons compare fig1-result measured.csv", compare_txt, NULL},
    {"report", command_report, "RESULT...", "writes a page about a run, a sweep or several runs",
     "result folder", "amontons report fig1-result", report_txt, NULL},
    {"film", command_film, "RESULT", "films a stored result: block, slip, force", "result folder",
     "amontons film fig1-result -o fig1.mp4", film_txt, NULL},
    {"info", command_info, "FILE\nkeys", "prints what a mesh, a scene or a result holds", "file",
     "amontons info validation/paper/fig1.yaml", info_txt, NULL},
    {"cache", command_cache, NULL, "says how large the cache is, or cleans it", NULL, NULL,
     cache_txt, NULL},
};

enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

// The exit status: 0, as help was asked for.
static int print_help(void)
{
    say("usage: amontons COMMAND [OPTION ...] [ARGUMENT ...]\n"
        "\n"
        "When and how an elastic block pushed by a rod starts to slide.\n"
        "\n");
    for (int32_t k = 0; k < COMMAND_COUNT; k++) {
        const char *forms = commands[k].argument ? commands[k].argument : "";
        say("  %-10s %-8.*s %s\n", commands[k].name, (int)strcspn(forms, "\n."), forms,
            commands[k].sentence);   // the first of several forms; also of "RESULT..."
    }
    say("\n"
        "  amontons help COMMAND     more about a command (also: amontons COMMAND --help)\n"
        "  amontons info keys        every key that a scene may have\n"
        "  amontons --version        the version, and where meshes and example scenes lie\n"
        "\n"
        "A first simulation, in the folder that --version names, with a coarse mesh so that it "
        "ends soon:\n"
        "\n"
        "  amontons run validation/paper/fig1.yaml --set mesh.set.nx=20 --set mesh.set.nz=20 "
        "-o ~/first\n"
        "\n"
        "Exit status: 0 done, 1 the computation failed, 2 the input is wrong.\n");
    return 0;
}

// The exit status.
static int print_version(void)
{
    const char *revision = amontons_revision();
    char folder[AMONTONS_PATH_SIZE];
    say("amontons %s%s%s%s\n", amontons_version(), *revision ? " (" : "", revision,
        *revision ? ")" : "");
    say("built with %s\n", amontons_libraries());
    const char *possible, *kernels = amontons_kernels(&possible);
    say("computes with OpenBLAS's %s kernels", kernels);
    if (possible) say(", as OPENBLAS_CORETYPE asks; this processor could run %s", possible);
    say("\n");
    if (amontons_data_folder(folder)) say("meshes and example scenes: %s\n", folder);
    return 0;
}

// The first word decides; everything behind it is the command's own to read. The exit status.
static int run_command(int argc, char **argv)
{
    const char *word = argc > 1 ? argv[1] : NULL;
    if (!word) return report_misuse("no command is given; `amontons --help` lists the commands");
    if (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0) return print_version();
    bool wants_help = strcmp(word, "help") == 0 || strcmp(word, "--help") == 0 ||
                      strcmp(word, "-h") == 0 || strcmp(word, "-?") == 0;
    if (wants_help && argc <= 2) return print_help();

    // `amontons help COMMAND` is `amontons COMMAND --help`.
    const char *name = wants_help ? argv[2] : word;
    char help[] = "--help", *help_words[] = {(char *)name, help, NULL};
    const Command *command = NULL;
    const char *names[COMMAND_COUNT];
    for (int32_t k = 0; k < COMMAND_COUNT; k++) {
        names[k] = commands[k].name;
        if (strcmp(names[k], name) == 0) command = &commands[k];
    }
    if (!command) {
        int32_t nearest = amontons_nearest_name(name, names, COMMAND_COUNT);
        if (nearest >= 0)
            return report_misuse("unknown command `%s`; did you mean `%s`? (`amontons --help` "
                                 "lists the commands)",
                                 name, names[nearest]);
        return report_misuse("unknown command `%s` (`amontons --help` lists the commands)", name);
    }
    return wants_help ? command->run(command, 2, help_words)
                      : command->run(command, argc - 1, argv + 1);
}

const char *amontons_better_kernels(void)
{
    const char *possible;
    amontons_kernels(&possible);
    return possible;
}

// A full disk or a closed pipe may show only when the last output is written: a command whose
// answer is lost has failed.
int amontons_command(int argc, char **argv)
{
    amontons_use_child_processes(true);
    int status = run_command(argc, argv);
    guard_end(false);
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    if (written || status != 0) return status;
    tell("amontons: error: cannot write to standard output\n");
    return 1;
}
