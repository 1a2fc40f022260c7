// SPDX-License-Identifier: GPL-2.0-or-later
// Ranges of values, in numbers and in words.
#include "scene/keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct Range {
    double low, high;   // high is allowed
    bool low_allowed;
    const char *words;
} Range;

static const Range ranges[] = {
#define X(range, low, low_allowed, high, words) [range] = {low, high, low_allowed, words},
    SCENE_RANGES(X)
#undef X
};

// Never for what is not finite.
bool scene_range_holds(SceneRange range, double value)
{
    const Range *within = &ranges[range];
    if (!isfinite(value)) return false;
    if (value < within->low || value > within->high) return false;
    return value != within->low || within->low_allowed;
}

const char *scene_range_words(SceneRange range)
{
    return ranges[range].words;
}

// The list of choices is joined behind the words; what does not fit into `size` is cut.
void scene_key_allowed(const SceneKey *key, char *words, int32_t size)
{
    static const char *const by_type[] = {
        [KEY_FLAG] = "true or false",
        [KEY_TEXT] = "a text of at most 511 bytes",
        [KEY_NAME] = "a name of 1 to 63 bytes",
        [KEY_CHOICE] = "one of ",
        [KEY_NUMBERS] = "a list of at most 64 numbers, each ",
        [KEY_NAMES] = "a name or a list of at most 32 names",
        [KEY_PARAMETERS] = "a map of at most 32 parameters, each a number or a word",
        [KEY_BRANCHES] = "a list of at most 20 maps {time: TIME, shear: STRESS, bulk: STRESS}",
        [KEY_FIELDS] = "none, film, or a map of every_U, every_t, every_step, at_events, film",
    };
    const char *text = key->type == KEY_NUMBER  ? ranges[key->range].words
                       : key->type == KEY_ITEMS ? key->items->allowed
                                                : by_type[key->type];
    bool names = key->type == KEY_NAMES && key->choices, none = scene_key_may_be_none(key);
    snprintf(words, (size_t)size, "%s%s%s", none ? "none, or " : "", names ? "a list of: " : text,
             key->type == KEY_NUMBERS ? ranges[key->range].words : "");
    int32_t used = (int32_t)strlen(words);
    for (int32_t k = 0; key->choices && key->choices[k] && used < size; k++)
        used +=
            snprintf(words + used, (size_t)(size - used), "%s%s", k ? ", " : "", key->choices[k]);
}
