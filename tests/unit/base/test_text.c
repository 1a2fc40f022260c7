// SPDX-License-Identifier: GPL-2.0-or-later
// Distances against counts done by hand and against the slow recursive definition.
#include "base/text.h"

#include "near.h"
#include "random_numbers.h"

#include <stdbool.h>

TEST(test_distances)
{
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

TEST(test_estimates)
{
    const struct {
        double value, bar, known_to;
        const char *text;
    } known[] = {{0.32956, 0.00291, 0.00291, "0.3296 +- 0.0029"},
                 {0.54853, 0.0113, 0.0113, "0.549 +- 0.011"},
                 {0.65039, 0.00997, 0.00997, "0.650 +- 0.010"},
                 {0.65039, 0.00994, 0.00994, "0.6504 +- 0.0099"},
                 {0.65125, 0.2, 0.2, "0.65 +- 0.20"},
                 {123.4, 12.3, 12.3, "123 +- 12"},
                 {0.2656, NAN, 0.013, "0.27"},   // the first digit that is not sure is the last
                 {0.32737, NAN, 0.0027, "0.327"},
                 {0.32737, NAN, 0.001, "0.327"},
                 {0.32737, NAN, 0.00099, "0.3274"},
                 {0.64885, NAN, 0.0101, "0.65"},
                 {0.02, NAN, 0.5, "0.02"},   // one digit at least
                 {0.32737, NAN, NAN, "0.33"},   // nothing is known: two, which the words say
                 {1.0261, NAN, NAN, "1.0"},
                 {0.3273721, NAN, 0, "0.327372"},
                 {0, NAN, NAN, "0"},
                 {-0.32737, NAN, 0.005, "-0.327"},
                 {NAN, 0.1, 0.1, "none"}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        char text[ESTIMATE_SIZE];
        text_estimate(known[k].value, known[k].bar, known[k].known_to, text);
        assert_string_equal(text, known[k].text);
    }
}

TEST(test_known_to)
{
    const struct {
        double value, known_to;
        const char *text;
    } known[] = {{0.2656, 0.0133, "one mesh: known to about 5 %"},
                 {-0.2656, 0.00133, "one mesh: known to about 0.5 %"},
                 {0.2, 0.024, "one mesh: known to about 12 %"},
                 {0.2, NAN, "one mesh, and how far it is known is not"}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        char text[ESTIMATE_SIZE];
        text_known_to(known[k].value, known[k].known_to, text);
        assert_string_equal(text, known[k].text);
    }
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

TEST(test_random_distances)
{
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

TEST(test_long_names_are_cut)
{
    char a[400], b[400];
    memset(a, 'a', sizeof a);
    memset(b, 'a', sizeof b);
    a[399] = 0;
    b[130] = 0;
    assert_int_equal(text_distance(a, b), 0);   // both are cut at 127
    assert_int_equal(text_distance(a, ""), 127);
}

TEST(test_nearest)
{
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

// Decodes without any rule but the bit patterns, then asks whether that was the shortest way.
static int32_t slow_utf8_length(const unsigned char *text)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    int32_t ones = 0;
    while (ones < 8 && text[0] & (0x80 >> ones)) ones++;
    if (ones == 0) return 1;
    if (ones == 1 || ones > 4) return 0;
    uint32_t code = text[0] & (0x7Fu >> ones);
    for (int32_t k = 1; k < ones; k++) {
        if (text[k] >> 6 != 2) return 0;
        code = code * 64 + text[k] % 64;
    }
    bool surrogate = code / 0x800 == 0xD800 / 0x800;
    return code >= least[ones] && code <= 0x10FFFF && !surrogate ? ones : 0;
}

// Every first byte with bytes at the edges of all ranges behind it, and with the text's end there.
TEST(test_utf8)
{
    static const unsigned char edges[] = {0,    'a',  0x7F, 0x80, 0x8F, 0x90,
                                          0x9F, 0xA0, 0xBF, 0xC0, 0xFF};
    enum { EDGES = sizeof edges };
    for (int32_t first = 1; first < 256; first++) {
        for (int32_t k = 0; k < EDGES * EDGES * EDGES; k++) {
            unsigned char text[5] = {(unsigned char)first, edges[k % EDGES],
                                     edges[k / EDGES % EDGES], edges[k / EDGES / EDGES], 0};
            assert_int_equal(text_utf8_length((const char *)text), slow_utf8_length(text));
        }
    }
    assert_int_equal(text_utf8_length("\xE2\x82\xAC"), 3);   // the euro sign
    assert_int_equal(text_utf8_length("\xC0\x80"), 0);   // a zero in two bytes
    assert_int_equal(text_utf8_length(""), 1);
}

// Each character in turn behind a word, against the ranges as XML 1.0 and Cairo have them.
TEST(test_unshown)
{
    for (uint32_t code = 1; code <= 0x10FFFF; code++) {
        char text[8] = "ab";
        uint32_t found = 0;
        unsigned char *byte = (unsigned char *)text + 2;
        if (code >= 0xD800 && code <= 0xDFFF) continue;
        if (code < 0x80) {
            byte[0] = (unsigned char)code;
        } else if (code < 0x800) {
            byte[0] = (unsigned char)(0xC0 | code >> 6);
            byte[1] = (unsigned char)(0x80 | (code & 63));
        } else if (code < 0x10000) {
            byte[0] = (unsigned char)(0xE0 | code >> 12);
            byte[1] = (unsigned char)(0x80 | (code >> 6 & 63));
            byte[2] = (unsigned char)(0x80 | (code & 63));
        } else {
            byte[0] = (unsigned char)(0xF0 | code >> 18);
            byte[1] = (unsigned char)(0x80 | (code >> 12 & 63));
            byte[2] = (unsigned char)(0x80 | (code >> 6 & 63));
            byte[3] = (unsigned char)(0x80 | (code & 63));
        }
        bool xml = code == 9 || code == 10 || code == 13 || (code >= 32 && code <= 0xFFFD) ||
                   code >= 0x10000;
        bool cairo = (code < 0xFDD0 || code > 0xFDEF) && (code & 0xFFFE) != 0xFFFE;
        bool obeyed = code >= 0x7F && code <= 0x9F;   // by a terminal
        int32_t at = text_find_unshown(text, &found);
        assert_int_equal(at, xml && cairo && !obeyed ? -1 : 2);
        if (at >= 0) assert_int_equal(found, code);
    }
    uint32_t found = 0;
    assert_int_equal(text_find_unshown("\xC3\xA9\xE9", &found), 2);   // no UTF-8
    assert_int_equal(found, 0xE9);
}

TEST(test_number)
{
    static const struct {
        const char *text;
        int32_t length;
        double value;
    } known[] = {{"10 um", 2, 10}, {"-.5e1x", 5, -5}, {"+3", 2, 3},   {"1e999", 5, INFINITY},
                 {"0", 1, 0},      {"0x10", 0, 0},    {"-0X1", 0, 0}, {"inf", 0, 0},
                 {"nan", 0, 0},    {".", 0, 0},       {"-", 0, 0},    {"", 0, 0},
                 {" 1", 0, 0},     {"1e", 1, 1},      {"..5", 0, 0}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        double value = 0;
        assert_int_equal(text_number(known[k].text, &value), known[k].length);
        assert_true(value == known[k].value);
    }
}
