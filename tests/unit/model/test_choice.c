// SPDX-License-Identifier: GPL-2.0-or-later
// What reduction.use: auto goes by: what must hold of any machine, and any constants that make
// sense.
#include "model/choice.h"

#include "near.h"

// A block of `side` x `side` cells of order 1, and a run of so many stages.
static ChoiceSizes block(double side, double stages)
{
    return (ChoiceSizes){.unknowns = 2 * (side + 1) * (side + 1),
                         .interface = 2 * (side + 1) + 0.1 * side,
                         .stages = stages,
                         .parts = 1,
                         .runs = 1};
}

static bool reduces(const ChoiceSizes *sizes)
{
    ExpectedCost cost = choice_expect(sizes);
    return choice_reduces(sizes, &cost);
}

TEST(test_short_and_long_runs)
{
    for (double side = 60; side <= 200; side += 20) {
        ChoiceSizes brief = block(side, 100), with_slidings = block(side, 3000);
        assert_false(reduces(&brief));
        assert_true(reduces(&with_slidings));
    }
}

// What is decided for some number of stages is decided for more of them.
TEST(test_once_it_pays_it_pays)
{
    for (double side = 30; side <= 250; side += 20) {
        bool before = false;
        for (double stages = 50; stages < 1e5; stages *= 1.5) {
            ChoiceSizes sizes = block(side, stages);
            bool now = reduces(&sizes);
            assert_true(now || !before);
            before = now;
        }
        assert_true(before);
    }
}

TEST(test_held)
{
    ChoiceSizes brief = block(160, 100);
    assert_false(reduces(&brief));
    brief.held = true;
    assert_true(reduces(&brief));
}

TEST(test_many_runs)
{
    ChoiceSizes brief = block(160, 100);
    brief.runs = 20;
    assert_true(reduces(&brief));
    ExpectedCost one = choice_expect(&brief);
    brief.runs = 1;
    ExpectedCost same = choice_expect(&brief);
    assert_true(one.reduction == same.reduction && one.full == same.full);   // of all, of one
}

// Small ones are reduced in any case: tests and sweeps of small blocks do not depend on seconds.
TEST(test_not_worth_asking)
{
    for (double side = 2; side <= 20; side++) {
        ChoiceSizes none = block(side, 0);
        assert_true(reduces(&none));
    }
}

// 320 x 320 cells are to be reduced within 6 GB; beyond memory there is no choice.
TEST(test_memory)
{
    ChoiceSizes large = block(320, 1e4), huge = block(700, 1e6);
    assert_true(reduces(&large));
    assert_false(reduces(&huge));
}
