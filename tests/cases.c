// SPDX-License-Identifier: GPL-2.0-or-later
// The main() of every test whose file has none: runs what registered itself before it began.
#include "cases.h"

enum { CASES_MAX = 64 };
static struct CMUnitTest cases[CASES_MAX];
static size_t count;
static CMFixtureFunction group_before, group_after;

void add_case(const struct CMUnitTest *test)
{
    if (count < CASES_MAX) cases[count] = *test;
    count++;
}

void set_group(CMFixtureFunction before, CMFixtureFunction after)
{
    group_before = before;
    group_after = after;
}

// No test at all is no success.
int main(void)
{
    if (count == 0 || count > CASES_MAX) return 99;
    return _cmocka_run_group_tests("tests", cases, count, group_before, group_after);
}
