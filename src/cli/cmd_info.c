// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons info`: what a file holds, before anything is computed with it. The library finds out
// what kind of file it is and writes the text.
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/say.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int command_info(const Command *command, int argc, char **argv)
{
    const char *file = NULL, *picture = NULL;
    OptionWords settings = {0};
    bool overwrite = false, trust = false;
    Error err = {0};
    const Option options[] = {
        {"set", 0, "KEY=VALUE",
         "Use this value for a key of the scene, or for a parameter of the .geo; may be given "
         "several times",
         .words = &settings},
        {"picture", 0, "FILE.png",
         "Draw the mesh, and for a scene where the rod is; friction.png: mu of the scene over slip "
         "rate, material.png: its moduli over frequency, with their data. Also .pdf, .svg",
         .word = &picture},
        option_overwrite(&overwrite),
        option_trust(&trust),
        {0}};
    int status = options_read(command, options, argc, argv, &file);
    if (status == 0) status = option_may_write(picture, overwrite);
    if (status != 0) return status;
    InfoOptions wanted = {.overrides = settings.list,
                          .override_count = settings.count,
                          .picture = picture,
                          .overwrite = overwrite,
                          .trust = trust};
    char *said = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&said, &size);
    if (!out) return report_misuse("no memory to say anything");
    bool done = strcmp(file, "keys") == 0 ? amontons_scene_reference(out, &err)
                                          : amontons_info(file, &wanted, out, &err);
    fclose(out);
    say("%s", said);
    free(said);
    if (done && picture) say("picture: %s\n", picture);
    return done ? 0 : report_error(&err);
}
