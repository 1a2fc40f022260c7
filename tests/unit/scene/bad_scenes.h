// SPDX-License-Identifier: GPL-2.0-or-later
// Bad scenes: each error must stand at the right place and say what is wrong and what is allowed.
#ifndef AMONTONS_TESTS_BAD_SCENES_H
#define AMONTONS_TESTS_BAD_SCENES_H

#include "near.h"
#include "scene_of_text.h"
#include "unit/scene/scene_texts.h"

typedef struct BadScene {
    int32_t line;   // of the good scene, replaced
    const char *text;
    const char *place;   // the message starts so
    const char *words[3];   // and holds these
} BadScene;

static inline void assert_bad(const BadScene *bad, const char *text)
{
    static Scene scene;
    Error err = {0};
    assert_false(scene_of_text("s.yaml", text, &scene, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    bool right = strncmp(err.message, bad->place, strlen(bad->place)) == 0;
    for (int i = 0; i < 3 && bad->words[i]; i++)
        right &= strstr(err.message, bad->words[i]) != NULL;
    if (!right) fail_msg("line %d `%s` gave\n%s", bad->line, bad->text, err.message);
}

static inline void assert_all_bad(const BadScene *cases, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        char text[SCENE_TEXT_MAX];
        scene_text_with(cases[k].line, cases[k].text, text);
        assert_bad(&cases[k], text);
    }
}

#endif
