// SPDX-License-Identifier: GPL-2.0-or-later
// The different texts of a column; an array of numbers holds their indices. Called by table.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_WORDS_H
#define AMONTONS_STUDY_SWEEP_SHOWING_WORDS_H

#include "base/error.h"

#include <stdint.h>

typedef struct WordList {
    int32_t count, capacity;
    char **words;   // [capacity]; owned, and so is each
    int32_t *slots;   // [2 capacity], by hash: 1 + the index of a word, 0: free; owned
} WordList;

// *index: of `word`, which is added where the list lacks it.
bool words_index(WordList *list, const char *word, double *index, Error *err);
// The words in their order with `|` between them; the caller's to free (memory_free).
char *words_join(const WordList *list, Error *err);
void words_destroy(WordList *list);   // zeroed is fine

#endif
