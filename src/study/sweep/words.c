// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/words.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

static bool make_room(WordList *list, Error *err)
{
    if (list->count < list->capacity) return true;
    int32_t capacity = list->capacity > 0 ? 2 * list->capacity : 8;
    char **words = memory_array(capacity, sizeof *words, err);
    if (!words) return false;
    if (list->count > 0) memcpy(words, list->words, (size_t)list->count * sizeof *words);
    memory_free(list->words);
    list->words = words;
    list->capacity = capacity;
    return true;
}

bool words_index(WordList *list, const char *word, double *index, Error *err)
{
    for (int32_t k = 0; k < list->count; k++) {
        *index = k;
        if (strcmp(list->words[k], word) == 0) return true;
    }
    size_t size = strlen(word) + 1;
    if (!make_room(list, err)) return false;
    char *copy = NEW_ARRAY(char, (int64_t)size, err);
    if (!copy) return false;
    memcpy(copy, word, size);
    *index = list->count;
    list->words[list->count++] = copy;
    return true;
}

char *words_join(const WordList *list, Error *err)
{
    int64_t size = 1, used = 0;
    for (int32_t k = 0; k < list->count; k++) size += (int64_t)strlen(list->words[k]) + 1;
    char *text = NEW_ARRAY(char, size, err);
    for (int32_t k = 0; text && k < list->count; k++)
        used += snprintf(text + used, (size_t)(size - used), "%s%s", k ? "|" : "", list->words[k]);
    return text;
}

void words_destroy(WordList *list)
{
    for (int32_t k = 0; k < list->count; k++) memory_free(list->words[k]);
    memory_free(list->words);
    *list = (WordList){0};
}
