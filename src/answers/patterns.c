// SPDX-License-Identifier: GPL-2.0-or-later
#include "answers/patterns.h"

static const double CHANCE = 0.05;

void patterns_add(Patterns *patterns, uint64_t pads)
{
    int32_t k = 0;
    patterns->drops++;
    while (k < patterns->count && patterns->list[k].pads != pads) k++;
    if (k == PATTERNS_MAX) return;
    if (k == patterns->count) patterns->list[patterns->count++] = (Pattern){.pads = pads};
    patterns->list[k].drops++;
}

void patterns_add_drops(Patterns *patterns, const Drops *drops, int32_t first)
{
    for (int32_t k = first; k < drops->count; k++) {
        const uint8_t *slid = &drops->slid[(int64_t)k * drops->pad_count];
        uint64_t pads = 0;
        if (!drop_is(&drops->list[k], DROP_LOAD)) continue;
        for (int32_t p = 0; p < drops->pad_count; p++) pads |= (uint64_t)(slid[p] != 0) << p % 64;
        patterns_add(patterns, pads);
    }
}

// All drops with a pattern are among those of `one`: the chance of that where both have it alike.
static bool lacks(const Patterns *other, const Patterns *one)
{
    for (int32_t k = 0; k < one->count; k++) {
        double chance = 1;
        bool has = other->count == PATTERNS_MAX;   // it may be one of those that are not listed
        for (int32_t i = 0; i < other->count; i++)
            has = has || other->list[i].pads == one->list[k].pads;
        if (has) continue;
        for (int32_t i = 0; i < one->list[k].drops; i++)
            chance *= (double)(one->drops - i) / (one->drops + other->drops - i);
        if (chance < CHANCE) return true;
    }
    return false;
}

bool patterns_differ(const Patterns *one, const Patterns *other)
{
    return lacks(one, other) || lacks(other, one);
}
