// SPDX-License-Identifier: GPL-2.0-or-later
// Sentences of many runs told as one, against the sentence that a reader would write; and the lists
// of words of a table.
#include "study/sweep/showing/warned.h"

#include "base/memory.h"
#include "cases.h"
#include "study/sweep/showing/words.h"

#include <stdlib.h>
#include <string.h>

static void add(Warned *warned, int32_t point, const char *format, double a, double b)
{
    char sentence[RUN_WARNING_SIZE];
    snprintf(sentence, sizeof sentence, format, a, b);
    warned_add(warned, point, sentence);
}

// Returns what warned_print writes; freed by the caller.
static char *print(const Warned *warned)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    warned_print(warned, out);
    fclose(out);
    return text;
}

TEST(test_kinds)
{
    static const char nodes[] = "pad_2 is not resolved: at %g of 41 nodes, %g times";
    Error err = {0};
    Warned warned;
    assert_true(warned_make(12, &warned, &err));
    add(&warned, 1, nodes, 3, 0.5);
    add(&warned, 2, nodes, 41, 0.5);
    add(&warned, 2, "too few drops: %g, error %g", 4, 1e-3);
    add(&warned, 3, "pad_3 is not resolved: at %g of 41 nodes, %g times", 7, 0.5);
    add(&warned, 9, "too few drops: %g, error %g", 4, 1e-3);
    add(&warned, 9, "too few drops: %g, error %g", 4, 1e-3);   // twice at one point counts once
    add(&warned, 11, "a rod is not resolved: at %g of 41 nodes, %g times", 1, 1);   // another word
    assert_int_equal(warned.count, 3);
    assert_int_equal(warned.points, 5);
    char *text = print(&warned);
    assert_string_equal(text,
                        "\n3 of 12 points: pad_2 to 3 is not resolved: at 3 to 41 of 41 nodes, 0.5 "
                        "times\n  points 1 to 3\n"
                        "2 of 12 points: too few drops: 4, error 0.001\n  points 2, 9\n"
                        "1 of 12 points: a rod is not resolved: at 1 of 41 nodes, 1 times\n"
                        "  points 11\n");
    free(text);
    warned_destroy(&warned);
}

// A sentence without a colon, too many kinds, too many numbers, too many points to list.
TEST(test_limits)
{
    Error err = {0};
    Warned warned;
    char words[100] = "";
    assert_true(warned_make(100, &warned, &err));
    while (strlen(words) + 6 < sizeof words) strcat(words, "abcd ");
    warned_add(&warned, 0, words);
    for (int32_t k = 0; k < 32; k++) {   // A to `: before a
        words[0] = (char)('A' + k);
        warned_add(&warned, 2 * k, words);
    }
    assert_int_equal(warned.count, WARNED_KINDS_MAX);
    assert_int_equal(warned.kinds[WARNED_KINDS_MAX - 1].points, 32 - WARNED_KINDS_MAX + 2);
    add(&warned, 0, "1 2 3 4 5 6 7 8 9 10 %g %g", 0, 1);
    add(&warned, 0, "", 0, 0);
    char *text = print(&warned);
    assert_non_null(strstr(text, ", ...\n"));
    free(text);
    warned_destroy(&warned);
}

TEST(test_words)
{
    Error err = {0};
    WordList list = {0};
    char word[20];
    double index = -1;
    for (int32_t k = 0; k < 300; k++) {
        snprintf(word, sizeof word, "w%d", k % 100);
        assert_true(words_index(&list, word, &index, &err));
        assert_true(index == k % 100);
    }
    char *text = words_join(&list, &err);
    assert_true(strncmp(text, "w0|w1|w2|", 9) == 0 && strlen(text) == 10 * 3 + 90 * 4 - 1);
    memory_free(text);
    words_destroy(&list);
    text = words_join(&list, &err);
    assert_string_equal(text, "");
    memory_free(text);
}
