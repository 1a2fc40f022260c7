// SPDX-License-Identifier: GPL-2.0-or-later
// Suggestions for mistyped names, wherever a name from a user is looked up; numbers and characters
// for all that reads or writes text.
#ifndef AMONTONS_BASE_TEXT_H
#define AMONTONS_BASE_TEXT_H

#include "amontons_words.h"

#include <stdbool.h>
#include <stdint.h>

// Number of single-character insertions, deletions, substitutions and swaps of neighbours that turn
// `a` into `b` (optimal string alignment). Names longer than 127 bytes are cut there.
int32_t text_distance(const char *a, const char *b);

// The index of the name nearest to `given`, or -1 when none is near enough to be a likely typing
// mistake (more than a third of the longer name differs). names: [count].
int32_t text_nearest(const char *given, const char *const *names, int32_t count);

// "; did you mean `NAME`?" of the nearest name; `otherwise` where none is near. Static storage, or
// `hint`.
enum { TEXT_HINT_SIZE = 160 };
const char *text_hint(const char *given, const char *const *names, int32_t count,
                      const char *otherwise, char hint[TEXT_HINT_SIZE]);

// A value in the digits that are known of it, and one more. With an error bar (NaN: none) two
// digits of that, "0.3296 +- 0.0029"; else down to the first digit of `known_to`, "0.27" where
// that is 0.013; six digits where it is 0, two where it is NaN. "none": the value is NaN.
void text_estimate(double value, double bar, double known_to, char text[ESTIMATE_SIZE]);

// Says how far a value without an error bar is known: "one mesh: known to about 5 %".
void text_known_to(double value, double known_to, char text[ESTIMATE_SIZE]);

// The fewest digits, `least` at least, that read back as the same finite number.
enum { NUMBER_TEXT_SIZE = 32 };
void text_shortest(double value, int32_t least, char text[NUMBER_TEXT_SIZE]);

bool text_ends_with(const char *text, const char *ending);

// The decimal number that `text` begins with, and the bytes it takes; 0: it begins with none.
// strtod alone would take "inf", "nan" and "0x10" too. 1e999 is a number, infinite.
int32_t text_number(const char *text, double *value);

// Bytes of the UTF-8 character at `text`, which ends with a zero byte; 0 when it is none (RFC 3629:
// no overlong forms, no surrogates, nothing past U+10FFFF). The zero byte itself is a character.
int32_t text_utf8_length(const char *text);

// The place of the first character that no page (XML), picture or terminal can show: a control
// character but a tab and the ends of lines, or one of Unicode's that are none (U+FFFE); -1: there
// is none. *code: its number; of bytes that are no UTF-8 the first.
int32_t text_find_unshown(const char *text, uint32_t *code);

#endif
