// SPDX-License-Identifier: GPL-2.0-or-later
// The value of a design from its points, by hand; and how designs are written and found.
#include "study/search/designs.h"

#include "base/memory.h"
#include "near.h"
#include "study/search/optimise.h"

static Study study = {
    .axis_count = 1,
    .axes = {{.count = 2}},
    .search = {.key_count = 2,
               .keys = {{"mesh.set.n", SEARCH_WHOLE, 1, 12}, {"rod.height", SEARCH_LOG, 0.01, 1}}}};

FIXTURE(begin)
{
    static Designs designs;
    Error err = {0};
    study.search.over = OVER_WORST;
    assert_true(designs_create(&study, 0, NULL, &designs, &err));
    *state = &designs;
    return 0;
}

FIXTURE(end)
{
    designs_destroy(*state);
    return 0;
}

static void give(Designs *designs, int32_t design, double a, double b)
{
    PointValue *points = &designs->points[2 * design];
    points[0] = (PointValue){.value = a, .bar = NAN, .known_to = 0.01};
    points[1] = (PointValue){.value = b, .bar = NAN, .known_to = 0.03};
    designs_judge(designs, design);
}

// 0.30 +- 0.01 and 0.31 +- 0.03: the lower may be as low as 0.28 and is at most 0.31.
TEST_BETWEEN(test_the_worst, begin, end)
{
    Designs *designs = *state;
    double x[] = {4, 0.1};
    int32_t d = designs_add(designs, x, 0);
    assert_true(isnan(designs->list[d].value) && designs_best(designs) == -1);
    give(designs, d, 0.30, 0.31);
    assert_near("value", designs->list[d].value, 0.30, 1e-15);
    assert_near("bar", designs->list[d].bar, 0.02, 1e-15);
    assert_int_equal(designs->list[d].deciding, 0);
    designs->lowest = true;   // the worst of lowest values is the highest
    designs_judge(designs, d);
    assert_near("value", designs->list[d].value, 0.31, 1e-15);
    assert_near("bar", designs->list[d].bar, 0.03, 1e-15);
    assert_int_equal(designs->list[d].deciding, 1);
    designs->points[2 * d].value = NAN;   // one has none: the design has none
    designs_judge(designs, d);
    assert_true(isnan(designs->list[d].value));
}

TEST_BETWEEN(test_the_mean, begin, end)
{
    Designs *designs = *state;
    double x[] = {4, 0.1};
    study.search.over = OVER_MEAN;
    give(designs, designs_add(designs, x, 0), 0.30, 0.32);
    assert_near("value", designs->list[0].value, 0.31, 1e-15);
    assert_near("bar", designs->list[0].bar, hypot(0.01, 0.03) / 2, 1e-15);
}

// 0.30 and 0.32: each is 0.01 from the mean, and moves the deviation by half of what it moves.
TEST_BETWEEN(test_the_deviation, begin, end)
{
    Designs *designs = *state;
    double x[] = {4, 0.1};
    study.search.over = OVER_DEVIATION;
    give(designs, designs_add(designs, x, 0), 0.30, 0.32);
    assert_near("value", designs->list[0].value, 0.01, 1e-15);
    assert_near("bar", designs->list[0].bar, hypot(0.01, 0.03) / 2, 1e-15);
    give(designs, 0, 0.31, 0.31);   // no direction to move in: as if all had a part in it
    assert_near("value", designs->list[0].value, 0, 1e-15);
    assert_near("bar", designs->list[0].bar, hypot(0.01, 0.03) / 2, 1e-15);
}

// (0.30, 0.32), (0.31, 0.31), (0.29, 0.33); (0.30, 0.31), which the first two are not worse than.
TEST_BETWEEN(test_the_front, begin, end)
{
    Designs *designs = *state;
    double x[][2] = {{1, 0.1}, {2, 0.1}, {3, 0.1}, {4, 0.1}, {5, 0.1}};
    study.search.over = OVER_FRONT;
    for (int32_t k = 0; k < 5; k++) designs_add(designs, x[k], k);
    give(designs, 0, 0.30, 0.32);
    give(designs, 1, 0.31, 0.31);
    give(designs, 2, 0.29, 0.33);
    give(designs, 3, 0.30, 0.31);
    give(designs, 4, NAN, 0.5);
    for (int32_t k = 0; k < 5; k++) assert_int_equal(pareto_front_holds(designs, k), k < 3);
    assert_near("mean", designs->list[0].value, 0.31, 1e-15);
    designs->aim = 1;
    designs_judge(designs, 2);
    assert_near("one aim", designs->list[2].value, 0.33, 1e-15);
    study.rank.lowest = true;
    for (int32_t k = 0; k < 4; k++) assert_int_equal(pareto_front_holds(designs, k), k > 1);
    study.rank.lowest = false, designs->aim = -1;
}

TEST_BETWEEN(test_the_best, begin, end)
{
    Designs *designs = *state;
    double x[][2] = {{1, 0.1}, {2, 0.1}, {3, 0.1}};
    for (int32_t k = 0; k < 3; k++) designs_add(designs, x[k], k);
    give(designs, 0, 0.30, 0.40);
    give(designs, 1, 0.35, 0.36);
    assert_int_equal(designs_best(designs), 1);   // by its worst
    designs->lowest = true;
    for (int32_t k = 0; k < 2; k++) designs_judge(designs, k);
    assert_int_equal(designs_best(designs), 1);
    study.search.over = OVER_MEAN;
    for (int32_t k = 0; k < 2; k++) designs_judge(designs, k);
    assert_int_equal(designs_best(designs), 0);
    assert_int_equal(designs_find(designs, x[2]), 2);
    x[2][1] = 0.2;
    assert_int_equal(designs_find(designs, x[2]), -1);
}

// Keys 1 to 12 in whole numbers and 0.01 to 1 by ratios: a per cent of the second is a ratio of
// 1.047.
TEST_BETWEEN(test_near_designs_are_one, begin, end)
{
    Designs *designs = *state;
    double x[][2] = {{3, 0.1}, {3, 0.104}, {3, 0.106}, {4, 0.1}};
    designs_add(designs, x[0], 0);
    assert_int_equal(designs_find(designs, x[1]), -1);
    designs->near[0] = 0.5;   // whole numbers are told apart in any case
    designs->near[1] = 0.01;
    assert_int_equal(designs_find(designs, x[1]), 0);
    assert_int_equal(designs_find(designs, x[2]), -1);
    assert_int_equal(designs_find(designs, x[3]), -1);
}

// 0.32 +- 0.04, 0.30 +- 0.01, 0.285 +- 0.1, and 0.40 of which no bar is known. The highest for sure
// is the second (0.29); with a smaller bar the first might be it. Of the lowest: sure of 0.36,
// 0.31, 0.385, 0.80; the third might be it, at 0.285.
TEST_BETWEEN(test_the_best_is_sure, begin, end)
{
    Designs *designs = *state;
    static const double values[] = {0.32, 0.30, 0.285, 0.40}, bars[] = {0.04, 0.01, 0.1, NAN};
    static const bool lead[2][4] = {{true, true, false, true}, {false, true, true, false}};
    double x[] = {1, 0.1};
    for (int32_t d = 0; d < 4; d++) {
        designs_add(designs, x, d);
        for (int32_t c = 0; c < 2; c++)
            designs_points(designs, d)[c] =
                (PointValue){.value = values[d], .bar = bars[d], .known_to = bars[d]};
        designs_judge(designs, d);
    }
    for (int32_t lowest = 0; lowest < 2; lowest++) {
        designs->lowest = lowest;
        assert_int_equal(designs_best(designs), 1);
        for (int32_t d = 0; d < 4; d++)
            assert_int_equal(designs_may_lead(designs, 1, d), lead[lowest][d]);
    }
    assert_near("without a bar", design_sure(designs, &designs->list[3]), 0.80, 1e-15);
    designs->has_bars = false;
    assert_near("no bars at all", design_sure(designs, &designs->list[0]), 0.32, 0);
}

TEST_BETWEEN(test_written, begin, end)
{
    Designs *designs = *state;
    Error err = {0};
    double x[] = {3.7, 0.0123456}, outside[] = {12.4, 1.0000001};
    char words[OPTIMISE_WORDS_SIZE];
    designs_round(&study, x);
    assert_near("whole", x[0], 4, 0);
    assert_near("three digits", x[1], 0.0123, 0);
    designs_round(&study, outside);
    assert_true(outside[0] == 12 && outside[1] == 1);
    designs_add(designs, x, 0);
    designs_add(designs, outside, 1);
    designs->list[1].accuracy = 0.015;
    char *text = designs_text(designs, designs->list, 2, &err);
    assert_string_equal(text, "[{mesh.set.n: 4, rod.height: 0.0123}, "
                              "{mesh.set.n: 12, rod.height: 1, accuracy.mu: 0.015}]");
    memory_free(text);
    design_words(&study, &designs->list[0], words);
    assert_string_equal(words, "mesh.set.n=4 rod.height=0.0123");
}
