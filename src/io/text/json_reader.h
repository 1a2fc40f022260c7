// SPDX-License-Identifier: GPL-2.0-or-later
// Looks single values up in a JSON text of our own (io/text/json_writer): nothing is kept, what is
// not asked for is skipped. Called by study/sweep, run/info/info and page/ for run.json,
// which may hold thousands of events.
#ifndef AMONTONS_IO_TEXT_JSON_READER_H
#define AMONTONS_IO_TEXT_JSON_READER_H

#include <stdbool.h>
#include <stdint.h>

// `path`: keys and list indices with dots between, as in "results.peaks.0.mu". All return false
// when there is no such value, or the text is not JSON as far as it was read.

// A number, or a boolean as 1 or 0, or null as NaN.
bool json_find_number(const char *text, const char *path, double *value);
// True if such a value can stand at `path`: a list index stands for every item, and an empty list
// may hold anything.
bool json_may_hold(const char *text, const char *path);
// The key of the item number `index` of the object at `path`, cut to `size` bytes.
bool json_find_key(const char *text, const char *path, int32_t index, char *key, int32_t size);
// A text, cut to `size` bytes; \u escapes beyond ASCII become `?`.
bool json_find_text(const char *text, const char *path, char *value, int32_t size);
// The value at `path` as it stands in the text: *length bytes from the pointer on. NULL: none.
const char *json_find_raw(const char *text, const char *path, int32_t *length);
// Shortens `text` in place: the value at `path`, where there is one, becomes null; space outside of
// texts goes.
void json_drop(char *text, const char *path);
void json_compact(char *text);
// The brackets of the whole text match: it was not cut off.
bool json_is_whole(const char *text);

#endif
