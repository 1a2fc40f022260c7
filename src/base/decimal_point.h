// SPDX-License-Identifier: GPL-2.0-or-later
// Scenes, results and messages have numbers with a point, whatever the host's LC_NUMERIC says
// (graphical toolkits set it to the user's). While a public function is at work its thread has "C"
// for numbers; the rest of the locale, and the process's, stay as they are. Called at the beginning
// of every public function that can fail, and of every thread.
#ifndef AMONTONS_BASE_DECIMAL_POINT_H
#define AMONTONS_BASE_DECIMAL_POINT_H

#include <locale.h>
#include <stdbool.h>

typedef struct DecimalPoint {
    locale_t before, own;   // of the thread; own: made for the call, or 0: nothing was to change
} DecimalPoint;

DecimalPoint decimal_point_begin(void);
void decimal_point_end(DecimalPoint *point);
// false: memory is short, numbers would be misread.
bool decimal_point_is_set(void);

// The point holds to the end of the enclosing block.
#define NUMBERS_HAVE_A_POINT                                                                       \
    __attribute__((cleanup(decimal_point_end), unused))                                            \
    DecimalPoint decimal_point_here = decimal_point_begin()

#endif
