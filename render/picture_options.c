// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/picture_options.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum OptionKind { OPTION_NUMBER, OPTION_WORD, OPTION_TEXT, OPTION_RANGE } OptionKind;

typedef struct PictureOption {
    const char *name;
    OptionKind kind;
    double low, high;   // of a number
    const char *figures;   // that take it, with blanks between; "": all
    int32_t taker;   // films and pages do, too
    const char *words;   // that are allowed, likewise
    size_t offset;   // of the member of PictureStyle: a double for a number, else a text
} PictureOption;

static const PictureOption OPTIONS[] = {
#define X(name, kind, low, high, figures, taker, words, argument, meaning)                         \
    {#name, OPTION_##kind, low, high, figures, taker, words, offsetof(PictureStyle, name)},
    PICTURE_OPTIONS(X)
#undef X
};

enum { OPTIONS_COUNT = sizeof OPTIONS / sizeof *OPTIONS, NAMES_SIZE = 200 };

static bool is_among(const char *words, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = words; *at; at += strcspn(at, " "), at += *at == ' ')
        if (length > 0 && strcspn(at, " ") == length && strncmp(at, word, length) == 0) return true;
    return false;
}

// One end; *rest: behind it.
static double read_end(const char *text, const char **rest, bool *is_part)
{
    char *end = NULL;
    double value = strtod(text, &end);
    *is_part = end != text && *end == '%';
    *rest = end + *is_part;
    if (end == text || !isfinite(value) || (*is_part && !(value >= 0 && value <= 100))) return NAN;
    return *is_part ? value / 100 : value;
}

bool picture_option_set(PictureStyle *style, const char *name, const char *value, Error *err)
{
    const PictureOption *option = NULL;
    char names[NAMES_SIZE] = "";
    for (int32_t k = 0; k < OPTIONS_COUNT && !option; ++k) {
        size_t used = strlen(names);
        if (strcmp(OPTIONS[k].name, name) == 0) option = &OPTIONS[k];
        snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "", OPTIONS[k].name);
    }
    if (!option)
        return REFUSE(err, "a picture has no option \"%.40s\"; known are: %s", name, names);
    void *place = (char *)style + option->offset;
    if (option->kind == OPTION_NUMBER) {
        char *end = NULL;
        double number = strtod(value, &end);
        if (!*value || *end || !(number >= option->low && number <= option->high))
            return REFUSE(err, "%s %.40s: a number from %g to %g is allowed", option->name, value,
                          option->low, option->high);
        *(double *)place = number;
        return true;
    }
    if (option->kind == OPTION_WORD && !is_among(option->words, value))
        return REFUSE(err, "%s %.40s: one of these is allowed: %s", name, value, option->words);
    if (option->kind == OPTION_RANGE) {
        const char *rest = NULL;
        bool part[2];
        double low = read_end(value, &rest, &part[0]);
        double high = *rest == ',' ? read_end(rest + 1, &rest, &part[1]) : NAN;
        if (!isfinite(low + high) || *rest || (part[0] == part[1] && !(high > low)))
            return REFUSE(err, "%s %.40s: two rising numbers are allowed, or percents: 1%%,99%%",
                          option->name, value);
    }
    *(const char **)place = value;
    return error_is_clean(err);
}

// One option, given or not: some of the figures takes it.
static bool is_taken(const char *name, const char *takers, const char *const *figures,
                     int32_t count, Error *err)
{
    for (int32_t k = 0; k < count; ++k)
        if (!*takers || is_among(takers, figures[k])) return true;
    char list[NAMES_SIZE];   // with commas between
    size_t used = 0;
    for (const char *at = takers; *at && used + 3 < sizeof list; ++at) {
        if (*at == ' ') list[used++] = ',';
        list[used++] = *at;
    }
    list[used] = 0;
    return REFUSE(err, "%s has no meaning for %s%s: it is an option of %s", name, figures[0],
                  count > 1 ? " and the others that are asked for" : "", list);
}

static bool is_given(const PictureStyle *style, const PictureOption *option)
{
    const void *place = (const char *)style + option->offset;
    return option->kind == OPTION_NUMBER ? *(const double *)place > 0
                                         : *(const char *const *)place != NULL;
}

bool picture_options_fit(const PictureStyle *style, const FieldChoice *field,
                         const char *const *figures, int32_t count, Error *err)
{
    for (int32_t k = 0; k < OPTIONS_COUNT; ++k)
        if (is_given(style, &OPTIONS[k]) &&
            !is_taken(OPTIONS[k].name, OPTIONS[k].figures, figures, count, err))
            return false;
#define X(name, takers)                                                                            \
    if (field && field->name && !is_taken(#name, takers, figures, count, err)) return false;
    FIELD_OPTIONS(X)
#undef X
    return true;
}

bool picture_options_fit_taker(const PictureStyle *style, int32_t taker, Error *err)
{
    for (int32_t k = 0; k < OPTIONS_COUNT; ++k)
        if (OPTIONS[k].taker < taker && is_given(style, &OPTIONS[k]))
            return REFUSE(err, "%s has no meaning for a %s", OPTIONS[k].name,
                          taker == TAKEN_BY_FILMS ? "film" : "page");
    return true;
}

void picture_style_complete(PictureStyle *style, const PictureStyle *base)
{
    for (int32_t k = 0; k < OPTIONS_COUNT; ++k) {
        void *own = (char *)style + OPTIONS[k].offset;
        const void *other = (const char *)base + OPTIONS[k].offset;
        if (OPTIONS[k].kind != OPTION_NUMBER) {
            if (!*(const char **)own) *(const char **)own = *(const char *const *)other;
        } else if (!(*(double *)own > 0)) {
            *(double *)own = *(const double *)other;
        }
    }
}

double picture_limit(const PictureStyle *style, int32_t end, bool *is_part)
{
    const char *rest = NULL;
    *is_part = false;
    if (!style->limits) return NAN;
    double value = read_end(style->limits, &rest, is_part);
    return end == 0 || *rest != ',' ? value : read_end(rest + 1, &rest, is_part);
}
