// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/repetition.h"

int32_t repetition_count(int32_t count, int32_t period, ItemsAgree *agree, const void *series)
{
    int32_t first = count > 1 ? 1 : 0, last = count - 1, agreeing = period;
    for (int32_t k = last - period; k >= first; k--) {
        if (!agree(series, k, last - (last - k) % period)) break;
        agreeing++;
    }
    return agreeing;
}
