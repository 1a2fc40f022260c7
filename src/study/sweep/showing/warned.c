// SPDX-License-Identifier: GPL-2.0-or-later
// Two sentences are compared letter by letter, a number in one with the number at its place in the
// other. Each kind keeps the range of every number, so that one sentence speaks for all its points.
#include "study/sweep/showing/warned.h"

#include "base/memory.h"
#include "base/text.h"

#include <ctype.h>
#include <math.h>

enum { LISTED_MAX = 12 };   // points named below a sentence

// The bytes of the number at `at`, also of one in a name (pad_2); 0: none begins there.
static int32_t number_at(const char *at, double *value)
{
    return isdigit((unsigned char)*at) ? text_number(at, value) : 0;
}

// Whether the sentences differ in numbers alone.
static bool alike(const char *one, const char *other)
{
    const char *a = one, *b = other;
    double ignored = 0;
    while (*a && *b) {
        int32_t first = number_at(a, &ignored), second = number_at(b, &ignored);
        if ((first == 0) != (second == 0) || (first == 0 && *a != *b)) return false;
        a += first > 0 ? first : 1;
        b += second > 0 ? second : 1;
    }
    return !*a && !*b;
}

bool warned_make(int32_t points, Warned *warned, Error *err)
{
    *warned = (Warned){.all = points};
    warned->of = NEW_ARRAY(uint32_t, points, err);
    return warned->of != NULL;
}

// A kind that finds no room counts as the last one.
void warned_add(Warned *warned, int32_t point, const char *sentence)
{
    int32_t k = 0;
    while (k < warned->count && !alike(warned->kinds[k].text, sentence)) k++;
    if (k == WARNED_KINDS_MAX) k--;
    WarnedKind *kind = &warned->kinds[k];
    if (k == warned->count) {
        *kind = (WarnedKind){0};
        snprintf(kind->text, sizeof kind->text, "%s", sentence);
        for (int32_t n = 0; n < WARNED_NUMBERS_MAX; n++) {
            kind->low[n] = INFINITY;
            kind->high[n] = -INFINITY;
        }
        warned->count++;
    }
    warned->points += warned->of[point] == 0;
    kind->points += !(warned->of[point] >> k & 1);
    warned->of[point] |= (uint32_t)1 << k;
    if (!alike(kind->text, sentence)) return;

    // The range of each of its numbers, so that one sentence speaks for all.
    int32_t number = 0, length = 0;
    double value = 0;
    for (const char *at = sentence; *at && number < WARNED_NUMBERS_MAX; at += length ? length : 1) {
        length = number_at(at, &value);
        if (length == 0) continue;
        kind->low[number] = fmin(kind->low[number], value);
        kind->high[number] = fmax(kind->high[number], value);
        number++;
    }
}

// --- on the terminal ----------------------------------------------------------------------------

void warned_print(const Warned *warned, FILE *out)
{
    for (int32_t w = 0; w < warned->count; w++) {
        const WarnedKind *kind = &warned->kinds[w];
        fprintf(out, "%s%d of %d points: ", w ? "" : "\n", kind->points, warned->all);

        // The sentence with "3 to 41" where its numbers differ.
        int32_t number = 0, listed = 0;
        double value = 0;
        for (const char *at = kind->text; *at;) {
            int32_t length = number_at(at, &value);
            bool varies = length > 0 && number < WARNED_NUMBERS_MAX &&
                          kind->low[number] < kind->high[number];
            if (varies)
                fprintf(out, "%.6g to %.6g", kind->low[number], kind->high[number]);
            else
                fprintf(out, "%.*s", length > 0 ? length : 1, at);
            number += length > 0;
            at += length > 0 ? length : 1;
        }
        fprintf(out, "\n");

        // "  points 3, 9, 12 to 15", as sweep.csv numbers them.
        for (int32_t k = 0; k < warned->all; k++) {
            int32_t last = k;
            if (!(warned->of[k] >> w & 1)) continue;
            while (last + 1 < warned->all && warned->of[last + 1] >> w & 1) last++;
            if (listed == LISTED_MAX) {
                fprintf(out, ", ...");
                break;
            }
            fprintf(out, "%s%d", listed++ ? ", " : "  points ", k);
            if (last > k) fprintf(out, " to %d", last);
            k = last;
        }
        fprintf(out, "\n");
    }
}

void warned_destroy(Warned *warned)
{
    memory_free(warned->of);
    *warned = (Warned){0};
}
