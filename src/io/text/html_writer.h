// SPDX-License-Identifier: GPL-2.0-or-later
// Writes an HTML page. Markup and text are two calls, so that text of a stranger's scene can never
// become markup. Called by page/ and by render/frames/frames.
#ifndef AMONTONS_IO_TEXT_HTML_WRITER_H
#define AMONTONS_IO_TEXT_HTML_WRITER_H

#include "io/text/text_writer.h"

#include <stdint.h>

// Markup of our own. Only numbers and names of ours may be arguments.
void html_markup(TextWriter *html, const char *format, ...) __attribute__((format(printf, 2, 3)));
void html_raw(TextWriter *html, const char *markup);   // as it is, of any length
// Text and values of attributes: & < > " ' are escaped, what is no UTF-8 or not printable becomes
// U+FFFD.
void html_text(TextWriter *html, const char *text);
// Text between markup of our own.
void html_around(TextWriter *html, const char *before, const char *text, const char *after);
// A value as people read it: to `digits`, U+2212 for minus, "1.1 x 10^-4" with the power raised.
void html_number(TextWriter *html, double value, int32_t digits);
// "data:TYPE;base64,...": a file inside of the page.
void html_data(TextWriter *html, const char *type, const void *bytes, int64_t size);

// Base64 (RFC 4648) of `size` bytes, and a zero byte: 4 * ((size + 2) / 3) + 1 of them.
void html_base64(const uint8_t *bytes, int64_t size, char *text);

#endif
