// SPDX-License-Identifier: GPL-2.0-or-later
#include "cli/scene_words.h"

enum { OWN_MAX = 8, COMMON_COUNT = 5 };

int scene_words_read(const Command *command, const Option *own, int argc, char **argv,
                     SceneWords *words)
{
    Option options[COMMON_COUNT + OWN_MAX + 1] = {
        {"output", 'o', "DIR", "The folder for the results", .word = &words->folder},
        {"set", 0, "KEY=VALUE", "Use this value instead of the scene's; may be given several times",
         .words = &words->settings},
        {"overwrite", 0, NULL, "Replace an earlier result in DIR", .flag = &words->overwrite},
        {"quiet", 'q', NULL, "Print nothing but warnings and errors", .flag = &words->quiet},
        option_trust(&words->trust)};
    for (int32_t k = 0; k < OWN_MAX && own[k].name; k++) options[COMMON_COUNT + k] = own[k];
    int status = options_read(command, options, argc, argv, &words->scene);
    if (status == 0 && words->folder && !*words->folder)
        return report_misuse("-o: the folder has no name");
    return status;
}

// *scene is the caller's to destroy.
int scene_words_open(const SceneWords *words, Scene **scene)
{
    Error err = {0};
    *scene = NULL;
    bool (*read)(const char *, const char *const *, int32_t, Scene **, Error *) =
        words->trust ? amontons_scene_read_trusted : amontons_scene_read;
    if (read(words->scene, words->settings.list, words->settings.count, scene, &err)) return 0;
    return report_error(&err);
}
