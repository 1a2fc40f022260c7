// SPDX-License-Identifier: GPL-2.0-or-later
#include "amontons.h"
#include "base/text.h"

int32_t amontons_nearest_name(const char *word, const char *const *names, int32_t count)
{
    return text_nearest(word, names, count);
}
