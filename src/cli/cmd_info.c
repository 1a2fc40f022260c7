// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons info`: what a file holds, before anything is computed with it. The library finds out
// what kind of file it is and writes the text.
#include "cli/commands.h"

#include <stdio.h>
#include <string.h>

enum { OVERRIDES_MAX = 200, OPTION_SET = 1000, OPTION_PICTURE };

typedef struct Options {
    const char *file;
    const char *picture;
    const char *overrides[OVERRIDES_MAX];
    int32_t override_count;
    bool too_many, too_many_overrides;
} Options;

// Gathers words; command_info judges them.
static error_t take_option(int key, char *word, struct argp_state *state)
{
    Options *options = state->input;
    switch (key) {
    case OPTION_SET:
        if (options->override_count == OVERRIDES_MAX)
            options->too_many_overrides = true;
        else
            options->overrides[options->override_count++] = word;
        return 0;
    case OPTION_PICTURE:
        options->picture = word;
        return 0;
    case ARGP_KEY_ARG:
        if (options->file) options->too_many = true;
        options->file = word;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

// `keys` is no file: the reference of all keys is printed.
int command_info(int argc, char **argv)
{
    static const struct argp_option known[] = {
        {"set", OPTION_SET, "KEY=VALUE", 0,
         "Use this value: of a scene's key, or of a parameter of a .geo; may be given several "
         "times",
         0},
        {"picture", OPTION_PICTURE, "FILE.png", 0,
         "Draw the mesh, of a scene with the place of the rod", 0},
        {0}};
    static const struct argp argp = {
        .options = known,
        .parser = take_option,
        .args_doc = "FILE\nkeys",
        .doc = "Says what FILE holds: a mesh (.msh, or .geo), a scene "
               "(.yaml, all values after defaults), or a result folder."
               "\vThe word `keys` in the place of FILE prints every key that a scene may have, "
               "with default, range and meaning. Examples:\n\n"
               "  amontons info meshes/pads.geo --set n=4 --picture pads.png\n"
               "  amontons info scene.yaml --picture mesh.png\n"
               "  amontons info fig1-result\n"
               "  amontons info keys"};
    Options options = {0};
    Error err = {0};
    options_parse(&argp, argc, argv, "amontons info", &options);
    if (!options.file)
        return report_misuse("info needs a file, as in `amontons info validation/paper/fig1.yaml`");
    if (options.too_many) return report_misuse("info takes one file");
    if (options.too_many_overrides)
        return report_misuse("--set is given more than %d times", OVERRIDES_MAX);
    InfoOptions wanted = {.overrides = options.overrides,
                          .override_count = options.override_count,
                          .picture = options.picture};
    bool done = strcmp(options.file, "keys") == 0
                    ? amontons_scene_reference(stdout, &err)
                    : amontons_info(options.file, &wanted, stdout, &err);
    if (done && options.picture) printf("picture: %s\n", options.picture);
    return done ? 0 : report_error(&err);
}
