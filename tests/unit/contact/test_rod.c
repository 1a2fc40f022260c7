// SPDX-License-Identifier: GPL-2.0-or-later
// The rod's springs against the formula of rod.h worked out by hand, its bound against a step done
// by hand, and the force as a sum.
#include "contact/rod.h"

#include "base/memory.h"
#include "near.h"

// Two contact nodes, three rod nodes with shares 1, 1/e and 1/2.
static double shares[3], heights[3] = {0.1, 0.2, 0.3};

static Interface interface_by_hand(void)
{
    shares[0] = 1;
    shares[1] = exp(-1);
    shares[2] = 0.5;
    return (Interface){.dim = 2,
                       .contact_count = 2,
                       .rod_count = 3,
                       .count = 7,
                       .rod_share = shares,
                       .rod_z = heights};
}

TEST(test_softness)
{
    Error err = {0};
    Interface interface = interface_by_hand();
    Rod rod;
    assert_true(rod_build(&interface, ROD_PUSHES, 0.5, &rod, &err));
    for (int32_t j = 0; j < 3; j++) assert_true(rod.softness[j] == 0 && rod.origin[j] == 0);
    rod_soften(&interface, (RodGround[]){{8, 2}, {8, 2}}, &rod);
    assert_true(rod.softness[0] == 0);   // wholly inside: rigid
    assert_near("ln(1/w) = 1", rod.softness[1], 0.5 / acos(-1.0), 1e-15);
    assert_near("ln 2", rod.softness[2], 0.5 * log(2) / acos(-1.0), 1e-15);
    assert_near("lag", rod.lag[1], 0.25, 0);
    assert_true(rod.lag[0] == 0);
    // The lowest node on a ground of its own, half as stiff.
    interface.rod_share[0] = 0.5;
    rod_soften(&interface, (RodGround[]){{4, 3}, {8, 2}}, &rod);
    assert_near("lower", rod.softness[0], 2 * rod.softness[2], 1e-15);
    assert_near("its lag", rod.lag[0], 0.75, 0);
    assert_near("the others'", rod.lag[2], 0.25, 0);
    rod_destroy(&rod);
    rod_destroy(&rod);
}

// A rigid node must be at origin + V t when the stage ends. A soft one feels no force at the bound:
// there r softness = way - reach v + lag (V - v) is 0, and one unit of velocity less makes it
// (reach + lag)/softness.
TEST(test_bound)
{
    Error err = {0};
    Interface interface = interface_by_hand();
    Rod rod;
    double position = 0.75, time = 3, reach = 0.5;
    assert_true(rod_build(&interface, ROD_IS_BONDED, 0.5, &rod, &err));
    rod_soften(&interface, (RodGround[]){{8, 2}, {8, 2}}, &rod);
    for (int32_t j = 0; j < 3; j++) rod.origin[j] = 0.25 * j;
    double rigid = rod_bound(&rod, 0, position, time, reach);
    assert_near("rigid", position + reach * rigid, 0 + 0.5 * time, 1e-15);
    for (int32_t j = 1; j < 3; j++) {
        double bound = rod_bound(&rod, j, position, time, reach);
        double way = rod.origin[j] + 0.5 * time - position;
        assert_near("no force", way - reach * bound + rod.lag[j] * (0.5 - bound), 0, 1e-15);
    }
    rod_destroy(&rod);
}

TEST(test_force)
{
    Interface interface = interface_by_hand();
    const double reaction[] = {100, 100, 100, 100, 1, -0.25, 4};
    assert_near("force", rod_force(&interface, reaction), 4.75, 0);
}

TEST(test_memory)
{
    Interface interface = interface_by_hand();
    int64_t live = memory_counters().live;
    for (int64_t k = 0; k < 2; k++) {
        Error err = {0};
        Rod rod;
        memory_fail_after(k);
        assert_false(rod_build(&interface, ROD_PUSHES, 1, &rod, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, ERROR_MEMORY);
        rod_destroy(&rod);
        assert_int_equal(memory_counters().live, live);
    }
}
