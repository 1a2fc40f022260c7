// SPDX-License-Identifier: GPL-2.0-or-later
#include "cli/say.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

// Bytes of the UTF-8 character at `text`, and its number; 0: it is none. Overlong forms are of no
// account here: what they stand for is judged.
static int read_character(const unsigned char *text, unsigned *code)
{
    int length = *text < 0x80 ? 1 : *text < 0xC2 ? 0 : *text < 0xE0 ? 2 : *text < 0xF0 ? 3 : 4;
    if (*text > 0xF4) length = 0;
    *code = length < 2 ? *text : *text & (0xFFU >> (length + 1));
    for (int k = 1; k < length; k++) {
        if ((text[k] & 0xC0) != 0x80) return 0;
        *code = *code << 6 | (text[k] & 0x3FU);
    }
    return length;
}

// Prints what a terminal does not obey as it is, all else as bytes. In one piece: lines of
// processes that write into one file do not mix.
static int put_formatted(FILE *stream, const char *format, va_list arguments)
{
    char *text = NULL, *shown = NULL;
    size_t size = 0;
    int written = vasprintf(&text, format, arguments);
    if (written < 0) return fputs("amontons: no memory for what was to be said here\n", stream);
    const unsigned char *next = (const unsigned char *)text;
    FILE *out = open_memstream(&shown, &size);
    while (out && *next) {
        unsigned code = 0;
        int length = read_character(next, &code);
        bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
        bool turns = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
        bool harmless = length > 0 && !turns && (!control || code == '\n' || code == '\t');
        for (int k = 0; k < (length > 0 ? length : 1); k++, next++)
            fprintf(out, harmless ? "%c" : "\\x%02x", *next);
    }
    if (out) fclose(out);
    if (out && shown) fwrite(shown, 1, size, stream);
    free(shown);
    free(text);
    return written;
}

int say(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = put_formatted(stdout, format, arguments);
    va_end(arguments);
    return length;
}

void tell(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tell_list(format, arguments);
    va_end(arguments);
}

void tell_list(const char *format, va_list arguments)
{
    put_formatted(stderr, format, arguments);
}

// \r goes to the line's beginning, ESC [K clears what is left behind it.
void tell_over(const char *line, int width)
{
    fputc('\r', stderr);
    tell("%.*s", width, line);
    fputs("\033[K", stderr);
    fflush(stderr);
}
