// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/text/html_writer.h"

#include "base/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 3 * 1000 };

void html_markup(TextWriter *html, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(html->out, format, arguments);
    va_end(arguments);
}

void html_raw(TextWriter *html, const char *markup)
{
    fputs(markup, html->out);
}

void html_text(TextWriter *html, const char *text)
{
    static const char letters[] = "&<>\"'";
    static const char *const escapes[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
    while (*text) {
        int32_t length = text_utf8_length(text);
        const char *escaped = NULL, *found = strchr(letters, *text);
        bool control = (unsigned char)*text < ' ' && *text != '\n' && *text != '\t';
        if (found)
            escaped = escapes[found - letters];
        else if (length == 0 || control || *text == 127)
            escaped = "\uFFFD";
        fwrite(escaped ? escaped : text, 1, escaped ? strlen(escaped) : (size_t)length, html->out);
        text += length ? length : 1;
    }
}

void html_around(TextWriter *html, const char *before, const char *text, const char *after)
{
    html_raw(html, before);
    html_text(html, text);
    html_raw(html, after);
}

void html_number(TextWriter *html, double value, int32_t digits)
{
    char words[40];
    if (!isfinite(value)) {
        html_raw(html, "\u2013");
        return;
    }
    snprintf(words, sizeof words, "%.*g", digits, fabs(value));
    char *power = strchr(words, 'e');
    if (power) *power = 0;
    html_markup(html, "%s%s", value < 0 ? "\u2212" : "", words);
    if (!power) return;
    int exponent = atoi(power + 1);
    html_markup(html, "\u202f\u00d7\u202f10<sup>%s%d</sup>", exponent < 0 ? "\u2212" : "",
                abs(exponent));
}

void html_base64(const uint8_t *bytes, int64_t size, char *text)
{
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int64_t k = 0; k < size; k += 3) {
        int64_t left = size - k;
        uint32_t three = (uint32_t)bytes[k] << 16 | (left > 1 ? (uint32_t)bytes[k + 1] << 8 : 0) |
                         (left > 2 ? bytes[k + 2] : 0);
        *text++ = letters[three >> 18];
        *text++ = letters[three >> 12 & 63];
        *text++ = left > 1 ? letters[three >> 6 & 63] : '=';
        *text++ = left > 2 ? letters[three & 63] : '=';
    }
    *text = 0;
}

void html_data(TextWriter *html, const char *type, const void *bytes, int64_t size)
{
    char text[4 * CHUNK / 3 + 1];
    html_markup(html, "data:%s;base64,", type);
    for (int64_t at = 0; at < size; at += CHUNK) {
        int64_t count = size - at < CHUNK ? size - at : CHUNK;
        html_base64((const uint8_t *)bytes + at, count, text);
        html_raw(html, text);
    }
}
