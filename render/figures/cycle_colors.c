// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/cycle_colors.h"

#include "render/figures/stack.h"

#include <stdio.h>

static const Color FIRST = {0.05f, 0.27f, 0.55f, 1}, LAST = {0.96f, 0.62f, 0.14f, 1};

Color cycle_color(int32_t k, int32_t count)
{
    if (count <= CYCLE_KEYS) return stack_color(k - 1);
    float part = (float)(k - 1) / (float)(count - 1);
    return (Color){FIRST.red + part * (LAST.red - FIRST.red),
                   FIRST.green + part * (LAST.green - FIRST.green),
                   FIRST.blue + part * (LAST.blue - FIRST.blue), 1};
}

int32_t cycle_key(int32_t count, CycleWords words, KeyEntry *entries, int32_t used)
{
    bool each = count <= CYCLE_KEYS;
    for (int32_t i = 0; i < (each ? count : 2); ++i) {
        int32_t cycle = each ? i + 1 : i == 0 ? 1 : count;
        const char *before = each || i == 0 ? "" : "and so on to ";
        if (cycle == 1)
            snprintf(words[i], CYCLE_WORDS_SIZE, "first loading");
        else
            snprintf(words[i], CYCLE_WORDS_SIZE, "%scycle %d", before, cycle);
        entries[used++] = (KeyEntry){KEY_LINE, cycle_color(cycle, count), words[i]};
    }
    return used;
}
