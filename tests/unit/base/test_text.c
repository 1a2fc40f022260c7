// SPDX-License-Identifier: GPL-2.0-or-later
// Distances against counts done by hand and against the slow recursive definition.
#include "base/text.h"

#include "near.h"
#include "random_numbers.h"

static void test_distances(void **state)
{
    (void)state;
    const struct {
        const char *a, *b;
        int32_t distance;
    } known[] = {{"", "", 0},
                 {"top", "", 3},
                 {"", "top", 3},
                 {"top", "top", 0},
                 {"top", "Top", 0},
                 {"top", "tpo", 1},
                 {"top", "stop", 1},
                 {"top", "to", 1},
                 {"top", "tip", 1},
                 {"rod", "contact", 6},
                 {"kitten", "sitting", 3},
                 {"ca", "abc", 3} /* a swap is not edited again */};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        assert_int_equal(text_distance(known[k].a, known[k].b), known[k].distance);
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

// The definition itself, exponential in the lengths.
static int32_t slow_distance(const char *a, int32_t m, const char *b, int32_t n)
{
    if (m == 0) return n;
    if (n == 0) return m;
    int32_t best = slow_distance(a, m - 1, b, n - 1) + (a[m - 1] != b[n - 1]);
    best = least(best, slow_distance(a, m - 1, b, n) + 1);
    best = least(best, slow_distance(a, m, b, n - 1) + 1);
    if (m > 1 && n > 1 && a[m - 1] == b[n - 2] && a[m - 2] == b[n - 1])
        best = least(best, slow_distance(a, m - 2, b, n - 2) + 1);
    return best;
}

static void test_random_distances(void **state)
{
    (void)state;
    Random random = {.state = 5};
    for (int32_t trial = 0; trial < 200; trial++) {
        char words[2][8] = {{0}};
        int32_t length[2];
        for (int w = 0; w < 2; w++) {
            length[w] = random_index(&random, 7);
            for (int32_t k = 0; k < length[w]; k++)
                words[w][k] = (char)('a' + random_index(&random, 3));
        }
        assert_int_equal(text_distance(words[0], words[1]),
                         slow_distance(words[0], length[0], words[1], length[1]));
        assert_int_equal(text_distance(words[0], words[1]), text_distance(words[1], words[0]));
    }
}

static void test_long_names_are_cut(void **state)
{
    (void)state;
    char a[400], b[400];
    memset(a, 'a', sizeof a);
    memset(b, 'a', sizeof b);
    a[399] = 0;
    b[130] = 0;
    assert_int_equal(text_distance(a, b), 0);   // both are cut at 127
    assert_int_equal(text_distance(a, ""), 127);
}

static void test_nearest(void **state)
{
    (void)state;
    const char *const names[] = {"top", "contact", "rod", "leading", "body"};
    assert_int_equal(text_nearest("tpo", names, 5), 0);
    assert_int_equal(text_nearest("CONTACTS", names, 5), 1);
    assert_int_equal(text_nearest("leadin", names, 5), 3);
    assert_int_equal(text_nearest("bdy", names, 5), 4);
    assert_int_equal(text_nearest("elephant", names, 5), -1);
    assert_int_equal(text_nearest("xyz", names, 5), -1);
    assert_int_equal(text_nearest("top", names, 0), -1);
    const char *const alike[] = {"pad_1", "pad_2", "pad_3"};
    assert_int_equal(text_nearest("pad_2", alike, 3), 1);   // exact beats near
    assert_int_equal(text_nearest("pad_9", alike, 3), 0);   // the first of equals
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distances),
        cmocka_unit_test(test_random_distances),
        cmocka_unit_test(test_long_names_are_cut),
        cmocka_unit_test(test_nearest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
