// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers and names as commands say them. Part of amontons.h.
#ifndef AMONTONS_WORDS_H
#define AMONTONS_WORDS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ESTIMATE_SIZE = 64 };
// A value in the digits that are known of it, and one more: "0.3296 +- 0.0029" with an error bar
// (NaN: none), else down to the first digit of `known_to`, "0.27" where that is 0.013; two digits
// where that is NaN, too, six where it is 0.
void amontons_estimate(double value, double bar, double known_to, char text[ESTIMATE_SIZE]);
// Says how far a value without an error bar is known: "one mesh: known to about 5 %".
void amontons_known_to(double value, double known_to, char text[ESTIMATE_SIZE]);
// The index of the one of `names` that a mistyped `word` probably means; -1: none is near.
int32_t amontons_nearest_name(const char *word, const char *const *names, int32_t count);

#ifdef __cplusplus
}
#endif

#endif
