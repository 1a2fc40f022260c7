// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/decimal_point.h"

#include <string.h>

bool decimal_point_is_set(void)
{
    return strcmp(localeconv()->decimal_point, ".") == 0;
}

DecimalPoint decimal_point_begin(void)
{
    DecimalPoint point = {0};
    if (decimal_point_is_set()) return point;
    locale_t copy = duplocale(uselocale((locale_t)0));
    point.own = copy ? newlocale(LC_NUMERIC_MASK, "C", copy) : (locale_t)0;
    if (point.own)
        point.before = uselocale(point.own);
    else if (copy)
        freelocale(copy);
    return point;
}

void decimal_point_end(DecimalPoint *point)
{
    if (!point->own) return;
    uselocale(point->before);
    freelocale(point->own);
}
