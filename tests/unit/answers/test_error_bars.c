// SPDX-License-Identifier: GPL-2.0-or-later
// Error bars from runs on several meshes, against sums by hand. Limit, weights and error by meshes
// are those of generalised least squares with numpy.linalg.inv, of levels whose values have the
// covariance ((s / n_i)^2 + w_i^2 + r_i^2 / N_i) delta_ij + s^2 / (n_i n_j), s = 0.05 of the last
// level's value times nodes over cells that slip (all, where it is not known how many do), 0.2 of
// it at least, w what its last nodes hold up, r_i the spread of runs on levels as fine and finer,
// with chi^2 = 1 of one level more, times Student's factor.
#include "answers/error_bars.h"

#include "drops_by_hand.h"
#include "near.h"

static void begin(Levels *levels, double refine, int32_t contact_nodes)
{
    levels->list[levels->count++] = (Level){.refine = refine,
                                            .contact_nodes = contact_nodes,
                                            .nodes_along = contact_nodes,
                                            .slip_cells = NAN};
}

static void add(Levels *levels, double mu_M, double mu_hold, double error)
{
    Answers answers = {.mu_M = {mu_M, error}, .mu_hold = {mu_hold, error}, .peaks_counted = 8};
    levels_add_run(levels, 1, 1, &answers, 100);
}

// One level: mean, spread 0.02 / sqrt(2), and no mesh part.
TEST(test_one_level)
{
    Levels levels = {0};
    begin(&levels, 0.5, 21);
    add(&levels, 0.29, 0.2, 0.003);
    add(&levels, 0.31, 0.2, 0.004);
    const ErrorBar *mu_M = levels_answer(&levels, ANSWER_MU_M);
    assert_near("mean", mu_M->value, 0.3, 1e-15);
    assert_true(isnan(mu_M->parts.mesh));
    assert_near("drops", mu_M->parts.drops, 0.005 / 2, 1e-15);
    assert_near("branches", mu_M->parts.branches, 2 * 0.02 / sqrt(2) / sqrt(2), 1e-15);
    assert_true(isnan(mu_M->bar));   // and so no bar
    assert_true(isnan(levels_order(&levels)));
    double usual = 0.5 * 0.3 / 21;
    assert_near("known to", levels_known_to(&levels, ANSWER_MU_M),
                hypot(usual, hypot(mu_M->parts.branches, mu_M->parts.drops)), 1e-15);
}

// A run that stands alone: the usual scatter of its mesh, and the error that its drops leave.
TEST(test_without_a_bar)
{
    Level level = {.contact_nodes = 40, .nodes_along = 40, .slip_cells = 10};
    Answers answers = {.mu_M = {0.3, 0.004}, .mu_hold = {0.2, NAN}, .mu_max = 0.4};
    double usual = 0.5 / 40;
    level_answer_for(&level, &answers);
    assert_near("mu_M", answers.mu_M_known_to, hypot(usual * 0.3, 0.004), 1e-15);
    assert_near("mu_hold", answers.mu_hold_known_to, usual * 0.2, 1e-15);
    assert_near("mu_max", answers.mu_max_known_to, usual * 0.4, 1e-15);
    answers.first_loading = (FirstLoading){.mu.value = 0.35, .since_precursor = 0.02};
    level_answer_for(&level, &answers);
    assert_near("first", answers.first_loading.known_to, hypot(usual * 0.35, 0.3 * 0.02), 1e-15);
    level.space = true;   // validation/space/priors.md: 0.9 of mu over nodes along the contact
    level_answer_for(&level, &answers);
    assert_near("in space", answers.mu_hold_known_to, 0.9 / 40 * 0.2, 1e-15);
    level = (Level){.contact_nodes = 4001, .nodes_along = 4001, .slip_cells = 2000};
    level_answer_for(&level, &answers);
    assert_near("least", answers.mu_hold_known_to, 0.002 * 0.2, 1e-15);
    level.undamped = true;
    level_answer_for(&level, &answers);
    assert_true(isnan(answers.mu_M_known_to) && isnan(answers.mu_max_known_to));
}

// The spread of runs on the second level is its own, 2 * 0.02^2 over one freedom; on the first that
// of both, 2 * 0.01^2 more over two.
TEST(test_two_levels)
{
    Levels levels = {0};
    begin(&levels, 1, 20);
    add(&levels, 0.29, 0.2, NAN);
    add(&levels, 0.31, 0.2, NAN);
    begin(&levels, 2, 40);
    add(&levels, 0.30, 0.2, NAN);
    add(&levels, 0.34, 0.2, NAN);
    const ErrorBar *mu_M = levels_answer(&levels, ANSWER_MU_M);
    assert_near("value", mu_M->value, 0.3079764338102682, 1e-15);   // of 0.30 and 0.32
    assert_near("mesh", mu_M->parts.mesh, 0.012568480740596666, 1e-15);
    assert_near("branches", mu_M->parts.branches, 0.024817520930091156, 1e-15);
    assert_near("drops", mu_M->parts.drops, 0, 0);
    assert_near("bar", mu_M->bar, hypot(mu_M->parts.mesh, mu_M->parts.branches), 1e-15);
    const ErrorBar *hold = levels_answer(&levels, ANSWER_MU_HOLD);   // both meshes agree
    assert_near("hold", hold->value, 0.2, 1e-15);
    assert_near("scatter", hold->parts.mesh, 0.0043, 1e-15);
    levels.list[0].slip_cells = 9.5, levels.list[1].slip_cells = 19.5;   // half of all cells
    levels_estimate(&levels);
    assert_near("enough cells", hold->parts.mesh, 0.0043, 1e-15);
    levels.list[0].slip_cells = 0.5, levels.list[1].slip_cells = 1;   // a fortieth: a long bar
    levels_estimate(&levels);
    assert_near("one cell", hold->parts.mesh, 0.043, 1e-15);
    assert_near("on the last", levels_cells(&levels), 1, 1e-15);
    levels.list[0].slip_cells = levels.list[1].slip_cells = NAN;
    assert_near("all", levels_cells(&levels), 58.0 / 60 * 40, 1e-13);   // but one a mesh
    levels.list[0].nodes_along = 1000;
    levels.list[1].nodes_along = 2000;   // steps leave more than cells
    levels_estimate(&levels);
    assert_near("least", levels_answer(&levels, ANSWER_MU_HOLD)->parts.mesh, 0.002 * 0.2, 1e-15);
    Answers answers = {.mu_max = 1};
    levels_answer_for(&levels, &answers);
    assert_true(answers.mu_M.value == mu_M->value && answers.mu_M.error == mu_M->bar);
    assert_true(answers.mu_hold_parts.mesh == hold->parts.mesh && answers.mu_max == 1);
    assert_true(answers.mu_M_known_to == mu_M->bar && answers.mu_hold_known_to == hold->bar);
    levels.list[0].nodes_along = 2000;   // no finer than the first: nothing is known
    levels_estimate(&levels);
    assert_true(isnan(levels_answer(&levels, ANSWER_MU_HOLD)->parts.mesh));
}

// Differences of 0.08 and 0.02, the second between cells of 2 and 1: order 2.
TEST(test_three_levels)
{
    Levels levels = {0};
    double values[] = {0.2, 0.28, 0.30};
    int32_t nodes[] = {20, 30, 60};
    for (int32_t k = 0; k < 3; k++) {
        begin(&levels, 1 + k, nodes[k]);
        add(&levels, values[k], 0.1, NAN);
    }
    const ErrorBar *mu_M = levels_answer(&levels, ANSWER_MU_M);
    assert_near("value", mu_M->value, 0.3072, 1e-15);
    assert_near("mesh", mu_M->parts.mesh, 0.06805695309077535, 1e-15);
    assert_true(isnan(mu_M->parts.branches));   // no two runs
    assert_near("order", levels_order(&levels), 2, 1e-12);
}

// A run in which the block never slid as a whole: the request is about mu_hold.
TEST(test_without_mu_M)
{
    Levels levels = {0};
    begin(&levels, 1, 21);
    add(&levels, 0.3, 0.2, NAN);
    assert_true(levels.asked == ANSWER_MU_M);
    levels.of_hold = true;
    levels_estimate(&levels);
    assert_true(levels.asked == ANSWER_MU_HOLD);
    levels.of_hold = false;
    levels_estimate(&levels);
    add(&levels, NAN, 0.22, NAN);
    assert_true(levels.asked == ANSWER_MU_HOLD);
    assert_true(isnan(levels_answer(&levels, ANSWER_MU_M)->bar));   // no value, no bar
    assert_near("lowest", levels_answer(&levels, ANSWER_MU_HOLD)->value, 0.2, 1e-15);
}

// A mesh on which the block never slid as a whole says nothing of mu_M: the bar is that of the
// other two, and they are two.
TEST(test_a_level_without_an_answer)
{
    Levels levels = {0};
    begin(&levels, 1, 20);
    add(&levels, 0.29, 0.2, NAN);
    add(&levels, 0.31, 0.2, NAN);
    begin(&levels, 1.5, 30);
    add(&levels, NAN, 0.2, NAN);
    add(&levels, 0.2, 0.2, NAN);
    assert_true(levels.asked == ANSWER_MU_HOLD);
    begin(&levels, 2, 40);
    add(&levels, 0.30, 0.2, NAN);
    add(&levels, 0.34, 0.2, NAN);
    const ErrorBar *mu_M = levels_answer(&levels, ANSWER_MU_M);
    assert_near("value", mu_M->value, 0.3079764338102682, 1e-15);   // as without it, but for s
    assert_near("mesh", mu_M->parts.mesh, 0.012568480740596666, 1e-15);
    assert_near("branches", mu_M->parts.branches, 0.024817520930091156, 1e-15);
    assert_int_equal(levels_known(&levels, ANSWER_MU_M), 2);
    assert_int_equal(levels_known(&levels, ANSWER_MU_HOLD), 3);
    levels.list[2].end_wait = 0.02;   // so much mu rises while the last nodes hold
    levels_estimate(&levels);
    assert_near("wait", levels_answer(&levels, ANSWER_MU_M)->parts.mesh,
                hypot(0.09260821331824153, 3 * 0.02), 1e-15);
    assert_near("held up", levels_answer(&levels, ANSWER_MU_M)->value, 0.30498160246301725, 1e-15);
    assert_int_equal(levels_known(&levels, ANSWER_MU_M), 1);   // 0.06 of 0.32: held up
    levels.list[2].end_wait = 0;
    levels.list[0].undamped = true;   // cells too long for slip
    assert_int_equal(levels_known(&levels, ANSWER_MU_M), 1);
    levels_estimate(&levels);
    assert_true(isnan(levels_answer(&levels, ANSWER_MU_M)->parts.mesh));
    levels.list[0].undamped = false;
    levels.list[2].undamped = true;
    levels_estimate(&levels);
    assert_true(isnan(levels_answer(&levels, ANSWER_MU_M)->parts.mesh));
    assert_near("value", levels_answer(&levels, ANSWER_MU_M)->value, 0.32, 1e-15);
    levels.list[2].undamped = false;
    levels.list[0].runs[0].answer[ANSWER_MU_M].value = NAN;   // one is left: nothing is known
    levels_estimate(&levels);
    assert_true(isnan(levels_answer(&levels, ANSWER_MU_M)->parts.mesh));
}

// The spread of runs is that of meshes at least as fine: the coarse ones' is not that of the fine.
TEST(test_spread_by_level)
{
    Levels levels = {0};
    begin(&levels, 1, 20);
    add(&levels, 0.40, 0.2, NAN);
    add(&levels, 0.46, 0.2, NAN);
    begin(&levels, 2, 40);
    add(&levels, 0.419, 0.2, NAN);
    add(&levels, 0.421, 0.2, NAN);
    begin(&levels, 4, 80);   // one run: as the finest with several
    add(&levels, 0.421, 0.2, NAN);
    const ErrorBar *mu_M = levels_answer(&levels, ANSWER_MU_M);
    // By numpy, with spreads of 0.0300 (four runs), 0.00141 and 0.00141; with 0.0300 for all it was
    // 0.4240 +- 0.0276.
    assert_near("value", mu_M->value, 0.4207612844542087, 1e-14);
    assert_near("mesh", mu_M->parts.mesh, 0.0033007373743596767, 1e-14);
    assert_near("branches", mu_M->parts.branches, 0.0022879927858744506, 1e-14);
}

static void add_drops(Levels *levels, uint64_t pads, int32_t drops)
{
    for (int32_t k = 0; k < drops; k++)
        patterns_add(&levels->list[levels->count - 1].patterns, pads);
}

// Two feet that go by turns on coarse meshes, and on fine ones the leading one also by itself:
// coarse meshes do not count, one between those that do does; and then, as on several pads in any
// case, the finest is four times as fine as the first.
TEST(test_other_drops)
{
    Levels levels = {0};
    for (int32_t k = 0; k < 5; k++) {
        begin(&levels, 1 + 0.25 * k, 40 + 10 * k);
        if (k == 3) add_drops(&levels, 1, 4), add_drops(&levels, 3, 4);
        if (k != 3) add_drops(&levels, 2, 8);
        add(&levels, 0.5, k == 3 ? 0.38 : 0.424, NAN);
    }
    assert_false(levels.list[0].other_drops);   // the last is as the first
    assert_false(levels_may_differ(&levels));
    levels.list[4].pads = 2;
    assert_near("two", levels_confirm_left(&levels), 2, 0);
    assert_true(levels_may_differ(&levels));
    assert_true(levels_answer(&levels, ANSWER_MU_HOLD)->value > 0.4);
    begin(&levels, 3, 120);
    add_drops(&levels, 1, 4), add_drops(&levels, 3, 4);
    add(&levels, 0.5, 0.38, NAN);
    const ErrorBar *hold = levels_answer(&levels, ANSWER_MU_HOLD);
    assert_true(levels.list[2].other_drops && !levels.list[3].other_drops);
    assert_true(!levels.list[4].other_drops && !levels.list[5].other_drops);
    assert_int_equal(levels_known(&levels, ANSWER_MU_HOLD), 3);
    assert_near("four times", levels_confirm_left(&levels), 4. / 3, 1e-15);
    assert_near("of those that count", levels_span_left(&levels, ANSWER_MU_HOLD), 3.5 / 3, 1e-15);
    levels.count--;
    levels.list[4] = levels.list[5];   // all before are others: its own value, with what is usual
    levels_estimate(&levels);
    levels.list[3].patterns = levels.list[0].patterns;
    levels_estimate(&levels);
    hold = levels_answer(&levels, ANSWER_MU_HOLD);
    assert_near("alone", hold->value, 0.38, 1e-15);
    assert_near("its bar", hold->bar, 12.71 * sqrt(2) * 0.2 / 120 * 0.38, 1e-12);
    assert_true(levels_reach(&levels, 1) && !levels_reach(&levels, 0.9));
}

// The last mesh is another world than those before it: the bar holds its value, too, and says so.
// A run whose contact does not all go along has no answer.
TEST(test_last_mesh_apart)
{
    Levels levels = {0};
    Answers answers = {.mu_M = {0.3, NAN}, .mu_hold = {0.2, NAN}};
    for (int32_t k = 0; k < 8; k++) {
        begin(&levels, 1 + k, 100 + k);
        add(&levels, 0.3, 0.2, NAN);
    }
    assert_false(levels_answer(&levels, ANSWER_MU_HOLD)->apart);
    begin(&levels, 9, 108);
    add(&levels, 0.3, 0.23, NAN);
    const ErrorBar *hold = levels_answer(&levels, ANSWER_MU_HOLD);
    assert_true(hold->apart && !levels_answer(&levels, ANSWER_MU_M)->apart);
    assert_near("as far", hold->bar, 0.23 - hold->value, 1e-15);
    assert_near("its part", hold->parts.mesh, hold->bar, 1e-15);
    assert_false(levels_run_in(&levels));
    answers.regime.run_in = RUN_IN_LAGS;
    levels_add_run(&levels, 1, 1, &answers, 100);
    assert_true(levels_run_in(&levels));
    assert_true(isnan(levels_answer(&levels, ANSWER_MU_HOLD)->value));
}

// Meshes behind a bar that is met differ by a factor of two in cell size; one without an answer
// has no part in that.
TEST(test_span)
{
    Levels levels = {0};
    begin(&levels, 0.5, 20);
    add(&levels, NAN, 0.2, NAN);
    assert_near("one", levels_span_left(&levels, ANSWER_MU_HOLD), 2, 0);
    begin(&levels, 0.6, 24);
    add(&levels, 0.3, 0.2, NAN);
    assert_near("two", levels_span_left(&levels, ANSWER_MU_HOLD), 2 * 0.5 / 0.6, 1e-15);
    assert_near("mu_M", levels_span_left(&levels, ANSWER_MU_M), 2, 0);
    double step = pow(2, 0.25);
    begin(&levels, 0.5 * step * step * step * step, 40);   // 1, but for rounding
    add(&levels, 0.3, 0.2, NAN);
    assert_near("twice", levels_span_left(&levels, ANSWER_MU_HOLD), 1, 0);
    assert_near("mu_M", levels_span_left(&levels, ANSWER_MU_M), 1.2, 1e-14);
    begin(&levels, 4, 160);
    add(&levels, 0.3, 0.2, NAN);
    assert_near("more", levels_span_left(&levels, ANSWER_MU_M), 1, 0);
}

// The first sliding is one value a run: the scatter of a single run is part of its bar, however
// many runs there are. It is there before run-in is over, and nobody asks for its bar.
TEST(test_first_sliding)
{
    Levels levels = {0};
    begin(&levels, 0.5, 21);
    for (int32_t k = 0; k < 2; k++) {
        Answers answers = {.mu_M = {0.3, NAN},
                           .mu_hold = {0.3, NAN},
                           .first_loading = {.slid = true, .mu = {k ? 0.36 : 0.34, NAN}},
                           .regime = {.run_in = RUN_IN_STUCK}};
        levels_add_run(&levels, 1, 1, &answers, 100);
    }
    const ErrorBar *first = levels_answer(&levels, ANSWER_MU_FIRST);
    double spread = 0.02 / sqrt(2);
    assert_near("mean", first->value, 0.35, 1e-15);
    assert_near("branches", first->parts.branches, 2 * spread * sqrt(1 + 0.5), 1e-15);
    assert_true(isnan(first->parts.mesh) && isnan(first->bar));
    assert_true(levels.asked != ANSWER_MU_FIRST);
    begin(&levels, 1, 42);
    Answers answers = {.first_loading = {.slid = true, .mu = {0.35, NAN}}};
    levels_add_run(&levels, 1, 1, &answers, 100);
    first = levels_answer(&levels, ANSWER_MU_FIRST);
    assert_near("bar", first->bar, hypot(first->parts.mesh, first->parts.branches), 1e-15);
    assert_true(first->parts.branches > 2 * spread);
    levels_answer_for(&levels, &answers);
    assert_near("value", answers.first_loading.mu.value, first->value, 0);
    assert_near("its error", answers.first_loading.mu.error, first->bar, 0);
    assert_near("known to", answers.first_loading.known_to, first->bar, 0);
}

// --- which pads slid ----------------------------------------------------------------------------

// Which pads slid, of drops by hand; and when two lists differ, by chances of Fisher's test: 4 of 8
// drops that 8 others lack are 70 / 1820 of 1.
static Patterns patterns_of(uint64_t pads, int32_t drops, uint64_t others, int32_t more)
{
    Patterns patterns = {0};
    for (int32_t k = 0; k < drops; k++) patterns_add(&patterns, pads);
    for (int32_t k = 0; k < more; k++) patterns_add(&patterns, others);
    return patterns;
}

static bool differ(Patterns one, Patterns other)
{
    assert_int_equal(patterns_differ(&one, &other), patterns_differ(&other, &one));
    return patterns_differ(&one, &other);
}

TEST(test_differ)
{
    assert_true(differ(patterns_of(3, 8, 0, 0), patterns_of(3, 4, 2, 4)));   // 0.038
    assert_false(differ(patterns_of(3, 8, 0, 0), patterns_of(3, 5, 2, 3)));   // 0.1
    assert_true(differ(patterns_of(3, 16, 0, 0), patterns_of(3, 5, 2, 3)));   // 0.028
    assert_true(differ(patterns_of(3, 8, 0, 0), patterns_of(1, 8, 0, 0)));
    assert_false(differ(patterns_of(3, 7, 1, 1), patterns_of(3, 2, 1, 6)));   // both have both
    assert_false(differ(patterns_of(3, 8, 0, 0), (Patterns){0}));
    Patterns many = {0}, more = patterns_of(1000, 8, 0, 0);   // of more kinds than are listed
    for (uint64_t k = 0; k < 2 * PATTERNS_MAX; k++) patterns_add(&many, k);
    assert_true(many.count == PATTERNS_MAX && many.drops == 2 * PATTERNS_MAX);
    assert_false(patterns_differ(&many, &more));
}

TEST(test_of_drops)
{
    static const double right[] = {0, 0, 0, 9, 9};
    HandDrops hand;
    Patterns patterns = {0};
    hand_drops_begin(&hand, 2);
    drop(&hand, 0.5, 0.1, ACROSS);
    for (int32_t k = 0; k < 3; k++) drop(&hand, 0.3, 0.1, k == 1 ? right : LEFT);
    drop(&hand, 0.3, 0.299, LEFT);   // no load drop
    patterns_add_drops(&patterns, &hand.drops, 1);
    assert_int_equal(patterns.drops, 3);
    assert_true(patterns.count == 2 && patterns.list[0].pads == 1 && patterns.list[1].pads == 2);
    assert_true(patterns.list[0].drops == 2 && patterns.list[1].drops == 1);
    hand_drops_end(&hand);
}
