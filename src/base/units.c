// SPDX-License-Identifier: GPL-2.0-or-later
// A unit is five integer powers: of ten, of sixty, and of length, mass and time. Powers of ten are
// kept whole so that "10 um/s" is the double nearest to 1e-5.
#include "base/units.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct Unit {
    const char *name;
    int32_t ten, sixty;   // powers of ten and of 60 that lead to SI base units
    int32_t powers[3];   // of metre, kilogram, second
    const char *examples;   // of a dimension only
} Unit;

static const Unit dimensions[] = {
    {"1", 0, 0, {0, 0, 0}, ""},
    {"length", 0, 0, {1, 0, 0}, "m, mm, um"},
    {"time", 0, 0, {0, 0, 1}, "s, ms, us"},
    {"velocity", 0, 0, {1, 0, -1}, "m/s, mm/s, um/s"},
    {"stress", 0, 0, {-1, 1, -2}, "Pa, kPa, MPa, GPa"},
    {"density", 0, 0, {-3, 1, 0}, "kg/m3, g/cm3"},
    {"viscosity", 0, 0, {-1, 1, -1}, "Pa s, kPa s, MPa s"},
    {"force", 0, 0, {1, 1, -2}, "N, kN, mN"},
    {"force/length", 0, 0, {0, 1, -2}, "N/m, kN/m, N/mm"},
    {"area", 0, 0, {2, 0, 0}, "m2, cm2, mm2"},
    {"frequency", 0, 0, {0, 0, -1}, "Hz, kHz, rad/s"},
};

static const Unit bases[] = {
    {"m", 0, 0, {1, 0, 0}, NULL},     {"s", 0, 0, {0, 0, 1}, NULL},
    {"g", -3, 0, {0, 1, 0}, NULL},    {"N", 0, 0, {1, 1, -2}, NULL},
    {"Pa", 0, 0, {-1, 1, -2}, NULL},  {"J", 0, 0, {2, 1, -2}, NULL},
    {"min", 0, 1, {0, 0, 1}, NULL},   {"h", 0, 2, {0, 0, 1}, NULL},
    {"bar", 5, 0, {-1, 1, -2}, NULL}, {"Hz", 0, 0, {0, 0, -1}, NULL},
    {"rad", 0, 0, {0, 0, 0}, NULL},
};

static const struct {
    const char *name;
    int32_t ten;
} prefixes[] = {{"n", -9}, {"u", -6}, {"\xC2\xB5", -6}, {"\xCE\xBC", -6}, {"\xB5", -6},
                {"m", -3}, {"c", -2}, {"k", 3},         {"M", 6},         {"G", 9}};

enum {
    DIMENSION_COUNT = sizeof dimensions / sizeof dimensions[0],
    BASE_COUNT = sizeof bases / sizeof bases[0],
    PREFIX_COUNT = sizeof prefixes / sizeof prefixes[0],
    POWER_MAX = 4,
    UNIT_SIZE = 60,
};

static const Unit *find_dimension(const char *name)
{
    for (int32_t k = 0; k < DIMENSION_COUNT; k++)
        if (strcmp(dimensions[k].name, name) == 0) return &dimensions[k];
    return &dimensions[0];
}

static const Unit *find_base(const char *word, size_t length)
{
    for (int32_t k = 0; k < BASE_COUNT; k++)
        if (strlen(bases[k].name) == length && strncmp(bases[k].name, word, length) == 0)
            return &bases[k];
    return NULL;
}

// One word with its power, as in "m^3", "m3" or "s-1"; *text moves behind it.
static bool read_factor(const char **text, int32_t sign, Unit *product)
{
    size_t length = 0;
    while (isalpha((unsigned char)(*text)[length]) || (unsigned char)(*text)[length] >= 0x80)
        length++;

    // "mPa": the whole word first, so that "m" is a metre and "Pa" no peta-a.
    int32_t ten = 0;
    const Unit *base = find_base(*text, length);
    for (int32_t k = 0; !base && k < PREFIX_COUNT; k++) {
        size_t size = strlen(prefixes[k].name);
        if (length <= size || strncmp(*text, prefixes[k].name, size) != 0) continue;
        base = find_base(*text + size, length - size);
        ten = prefixes[k].ten;
    }
    if (!base) return false;
    ten += base->ten;

    // A power may follow, with or without ^.
    *text += length;
    if (**text == '^') (*text)++;
    long power = 1;
    if (isdigit((unsigned char)**text) || **text == '-') {
        char *end = NULL;
        power = strtol(*text, &end, 10);
        if (end == *text || power == 0 || labs(power) > POWER_MAX) return false;
        *text = end;
    }
    product->ten += ten * (int32_t)power * sign;
    product->sixty += base->sixty * (int32_t)power * sign;
    for (int32_t i = 0; i < 3; i++) product->powers[i] += base->powers[i] * (int32_t)power * sign;
    return true;
}

// Powers and products as they are printed, superscripts and a dot, and as they are typed.
static const char *const PRINTED[][2] = {
    {"\xC2\xB9", "1"},     {"\xC2\xB2", "2"}, {"\xC2\xB3", "3"},    {"\xE2\x81\xBB", "-"},
    {"\xE2\x88\x92", "-"}, {"\xC2\xB7", " "}, {"\xE2\x8B\x85", " "}};

// All of `printed` is a unit.
static bool read_unit(const char *printed, Unit *product)
{
    int32_t sign = 1;
    char typed[UNIT_SIZE];   // with letters of the keyboard in the place of PRINTED
    const char *text = typed;
    size_t length = 0, count = sizeof PRINTED / sizeof *PRINTED;
    *product = (Unit){0};
    while (*printed) {
        size_t k = 0;
        while (k < count && strncmp(printed, PRINTED[k][0], strlen(PRINTED[k][0])) != 0) k++;
        if (length + 1 == UNIT_SIZE) return false;   // longer than any unit
        typed[length++] = k < count ? *PRINTED[k][1] : *printed;
        printed += k < count ? strlen(PRINTED[k][0]) : 1;
    }
    typed[length] = 0;
    product->ten = strcmp(text, "%") == 0 ? -2 : 0;   // numbers: "mu (-)", "mu/1", "mu (%)"
    if (strcmp(text, "-") == 0 || strcmp(text, "1") == 0 || strcmp(text, "%") == 0) return true;
    if (strncmp(text, "1/", 2) == 0) {   // 1/s
        sign = -1;
        text += 2;
    }
    for (;;) {
        if (!read_factor(&text, sign, product)) return false;
        text += strspn(text, " ");
        if (!*text) return true;
        if (*text == '/' && sign < 0) return false;   // a/b/c is read two ways
        if (*text == '/') sign = -1;
        text += strspn(text, "/.*") ? 1 : 0;
        text += strspn(text, " ");
    }
}

static double times_power(double value, double base, int32_t power)
{
    double factor = pow(base, abs(power));
    return power < 0 ? value / factor : value * factor;
}

bool unit_to_si(const char *suffix, const char *dimension, double *value)
{
    Unit unit;
    if (!read_unit(suffix, &unit)) return false;
    const Unit *wanted = dimension ? find_dimension(dimension) : &unit;
    if (memcmp(unit.powers, wanted->powers, sizeof unit.powers) != 0) return false;
    *value = times_power(times_power(*value, 10, unit.ten), 60, unit.sixty);
    return true;
}

bool unit_ratio(const char *a, const char *b, double *ratio)
{
    Unit over, under;
    if (!read_unit(a, &over) || !read_unit(b, &under) ||
        memcmp(over.powers, under.powers, sizeof over.powers) != 0)
        return false;
    *ratio = times_power(times_power(1, 10, over.ten - under.ten), 60, over.sixty - under.sixty);
    return true;
}

const char *unit_quotient(const char *suffix, const char *dimension, bool *times)
{
    Unit unit;
    if (!read_unit(suffix, &unit)) return NULL;
    const Unit *wanted = find_dimension(dimension);
    for (int32_t d = 1; d < DIMENSION_COUNT; d++)
        for (int32_t sign = 1; sign >= -1; sign -= 2) {
            bool fits = true;
            for (int32_t i = 0; i < 3; i++)
                fits = fits && unit.powers[i] - wanted->powers[i] == sign * dimensions[d].powers[i];
            *times = sign < 0;
            if (fits) return dimensions[d].name;
        }
    return NULL;
}

const char *unit_examples(const char *dimension)
{
    return find_dimension(dimension)->examples;
}
