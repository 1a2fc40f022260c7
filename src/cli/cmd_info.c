// SPDX-License-Identifier: GPL-2.0-or-later
#include "cli/commands.h"

#include <stdio.h>
#include <string.h>

typedef struct InfoOptions {
    const char *file;
    bool too_many;
} InfoOptions;

static error_t take_option(int key, char *word, struct argp_state *state)
{
    InfoOptions *options = state->input;
    if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
    if (options->file) options->too_many = true;
    options->file = word;
    return 0;
}

int command_info(int argc, char **argv)
{
    static const struct argp argp = {
        .parser = take_option,
        .args_doc = "FILE\nkeys",
        .doc = "Says what FILE holds: a mesh (.msh, or a .geo as its defaults mesh it), a scene "
               "(.yaml, all values after defaults), or a result folder."
               "\vThe word `keys` in the place of FILE prints every key that a scene may have, "
               "with default, range and meaning. Examples:\n\n"
               "  amontons info meshes/block.geo\n"
               "  amontons info fig1-result\n"
               "  amontons info keys"};
    InfoOptions options = {0};
    Error err = {0};
    options_parse(&argp, argc, argv, "amontons info", &options);
    if (!options.file)
        return report_misuse("info needs a file, as in `amontons info validation/paper/fig1.yaml`");
    if (options.too_many) return report_misuse("info takes one file");
    bool done = strcmp(options.file, "keys") == 0 ? amontons_scene_reference(stdout, &err)
                                                  : amontons_info(options.file, stdout, &err);
    return done ? 0 : report_error(&err);
}
