// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/showing/words.h"

#include "base/hash.h"
#include "base/memory.h"

#include <stdio.h>
#include <string.h>

// Where `word` is, or would be: open addressing, at most half of the slots are taken.
static int32_t *find_slot(const WordList *list, const char *word)
{
    Hash hash = hash_start();
    hash_text(&hash, word);
    uint32_t last = 2 * (uint32_t)list->capacity - 1, at = (uint32_t)hash.low & last;
    while (list->slots[at] && strcmp(list->words[list->slots[at] - 1], word) != 0)
        at = (at + 1) & last;
    return &list->slots[at];
}

// A list as long as its sweep (sentences with numbers in them) is not gone through for every point.
bool words_index(WordList *list, const char *word, double *index, Error *err)
{
    if (!list->slots || list->count == list->capacity) {   // the capacity is a power of 2
        if (!memory_grow(&list->words, list->count, &list->capacity, sizeof *list->words, err))
            return false;
        memory_free(list->slots);
        list->slots = NEW_ARRAY(int32_t, 2 * (int64_t)list->capacity, err);
        if (!list->slots) return false;
        for (int32_t k = 0; k < list->count; k++) *find_slot(list, list->words[k]) = k + 1;
    }
    int32_t *slot = find_slot(list, word);
    if (*slot == 0) {
        char *copy = memory_text(word, err);
        if (!copy) return false;
        list->words[list->count++] = copy;
        *slot = list->count;
    }
    *index = *slot - 1;
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
    memory_free_all(list->words, list->slots);
    *list = (WordList){0};
}
