// SPDX-License-Identifier: GPL-2.0-or-later
// Optimal string alignment: the edit distance of Damerau and Levenshtein in which no part of a word
// is edited twice (Navarro, ACM Computing Surveys 33, 2001).
#include "base/text.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_MAX_LENGTH = 127, DECIMALS_MAX = 12 };
static const double ROUNDS_UP = 0.995;   // from here on two digits become the next power of ten

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

// Longer names are compared by their first NAME_MAX_LENGTH letters: rows are on the stack.
static int32_t name_length(const char *name)
{
    return (int32_t)strnlen(name, NAME_MAX_LENGTH);
}

// Dynamic programme over prefixes; three rows are enough for swaps of neighbours.
int32_t text_distance(const char *a, const char *b)
{
    int32_t a_length = name_length(a), b_length = name_length(b);
    int32_t rows[3][NAME_MAX_LENGTH + 1];
    for (int32_t j = 0; j <= b_length; j++) rows[0][j] = j;
    for (int32_t i = 1; i <= a_length; i++) {
        int32_t *now = rows[i % 3];
        const int32_t *before = rows[(i + 2) % 3], *two_before = rows[(i + 1) % 3];
        now[0] = i;
        for (int32_t j = 1; j <= b_length; j++) {
            int32_t differs = tolower((unsigned char)a[i - 1]) != tolower((unsigned char)b[j - 1]);
            int32_t best = smaller(before[j] + 1, smaller(now[j - 1] + 1, before[j - 1] + differs));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                best = smaller(best, two_before[j - 2] + 1);
            now[j] = best;
        }
    }
    return rows[a_length % 3][b_length];
}

// A third of the longer name, rounded up: one mistake in three letters, two in six. Of names
// equally near the first in the list.
int32_t text_nearest(const char *given, const char *const *names, int32_t count)
{
    int32_t nearest = -1, nearest_distance = 0;
    for (int32_t k = 0; k < count; k++) {
        int32_t distance = text_distance(given, names[k]);
        int32_t longer = name_length(given) > name_length(names[k]) ? name_length(given)
                                                                    : name_length(names[k]);
        if (3 * distance > longer + 2) continue;
        if (nearest >= 0 && distance >= nearest_distance) continue;
        nearest = k;
        nearest_distance = distance;
    }
    return nearest;
}

const char *text_hint(const char *given, const char *const *names, int32_t count,
                      const char *otherwise, char hint[TEXT_HINT_SIZE])
{
    int32_t nearest = text_nearest(given, names, count);
    if (nearest < 0) return otherwise;
    snprintf(hint, TEXT_HINT_SIZE, "; did you mean `%.130s`?", names[nearest]);
    return hint;
}

// The first byte says how many follow and, in the four cases below, narrows the range of the next
// (RFC 3629, section 4). A text that ends within a character ends with a zero byte, which is no
// continuation: nothing is read beyond it.
int32_t text_utf8_length(const char *text)
{
    const unsigned char *byte = (const unsigned char *)text;
    unsigned char first = byte[0], low = 0x80, high = 0xBF;
    if (first < 0x80) return 1;
    int32_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
    if (first == 0xE0) low = 0xA0;
    if (first == 0xED) high = 0x9F;
    if (first == 0xF0) low = 0x90;
    if (first == 0xF4) high = 0x8F;
    for (int32_t k = 1; k < length; k++) {
        if (byte[k] < low || byte[k] > high) return 0;
        low = 0x80;
        high = 0xBF;
    }
    return length;
}

int32_t text_number(const char *text, double *value)
{
    const char *at = text + (*text == '+' || *text == '-');
    bool hexadecimal = at[0] == '0' && (at[1] == 'x' || at[1] == 'X');
    char *end = NULL;
    if (!isdigit((unsigned char)at[*at == '.']) || hexadecimal) return 0;
    *value = strtod(text, &end);
    return (int32_t)(end - text);
}

void text_estimate(double value, double bar, double known_to, char text[ESTIMATE_SIZE])
{
    // Digits behind the point down to `place`, a power of ten's exponent; one at least is not 0.
    bool has_bar = isfinite(bar);
    double place = has_bar ? floor(log10(bar / ROUNDS_UP)) - 1 : floor(log10(known_to));
    double first = value != 0 ? floor(log10(fabs(value))) : 0;
    double last = isfinite(place) ? fmin(place, first) : first - (value != 0);
    int decimals = (int)fmin(fmax(-last, 0), DECIMALS_MAX);

    if (isnan(value))
        snprintf(text, ESTIMATE_SIZE, "none");
    else if (!has_bar && known_to == 0)
        snprintf(text, ESTIMATE_SIZE, "%.6g", value);
    else if (has_bar)
        snprintf(text, ESTIMATE_SIZE, "%.*f +- %.*f", decimals, value, decimals, bar);
    else
        snprintf(text, ESTIMATE_SIZE, "%.*f", decimals, value);
}

void text_known_to(double value, double known_to, char text[ESTIMATE_SIZE])
{
    double percent = 100 * known_to / fabs(value);
    if (isfinite(percent))
        snprintf(text, ESTIMATE_SIZE, "one mesh: known to about %.*g %%", percent < 10 ? 1 : 2,
                 percent);
    else
        snprintf(text, ESTIMATE_SIZE, "one mesh, and how far it is known is not");
}

// 17 are always enough (IEEE 754 double).
void text_shortest(double value, int32_t least, char text[NUMBER_TEXT_SIZE])
{
    do snprintf(text, NUMBER_TEXT_SIZE, "%.*g", least++, value);
    while (least <= 17 && strtod(text, NULL) != value);
}

bool text_ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), size = strlen(ending);
    return length >= size && strcmp(text + length - size, ending) == 0;
}

int32_t text_find_unshown(const char *text, uint32_t *code)
{
    for (int32_t at = 0, length; text[at]; at += length) {
        const unsigned char *byte = (const unsigned char *)text + at;
        length = text_utf8_length(text + at);
        *code = length < 2 ? *byte : *byte & (0xFFU >> (length + 1));
        for (int32_t k = 1; k < length; k++) *code = *code << 6 | (byte[k] & 0x3FU);
        bool control = (*code < 0x20 && !strchr("\t\n\r", (int)*code)) ||
                       (*code >= 0x7F && *code < 0xA0);
        bool none = (*code >= 0xFDD0 && *code <= 0xFDEF) || (*code & 0xFFFE) == 0xFFFE;
        if (length == 0 || control || none) return at;
    }
    return -1;
}
