// SPDX-License-Identifier: GPL-2.0-or-later
// The first loading of made-up runs: what comes before the first sliding is kept apart from what
// comes after it.
#include "answers/first_loading.h"

#include "drops_by_hand.h"

#include <math.h>

static const double HALF[] = {9, 9, 9, 0, 0};

TEST(test_before_it_slides)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    FirstLoading none = first_loading_of(&hand.drops);
    assert_true(!none.slid && none.precursors == 0 && isnan(none.mu.value));
    drop(&hand, 0.3, 0.299, PART);
    drop(&hand, 0.35, 0.349, HALF);
    FirstLoading first = first_loading_of(&hand.drops);
    assert_true(!first.slid && isnan(first.mu.value) && isnan(first.critical_length));
    assert_int_equal(first.precursors, 2);
    hand_drops_end(&hand);
}

// One precursor comes to the trailing node alone and one to the middle, then the block slides; the
// later cycles have one precursor each. U of step t is t/10.
TEST(test_beside_the_regime)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    hand.run.hand.seen.trailing = -0.1;
    drop(&hand, 0.3, 0.299, PART);
    drop(&hand, 0.35, 0.349, HALF);
    drop(&hand, 0.4, 0.2, ACROSS);
    for (int32_t k = 0; k < 3; k++) {
        drop(&hand, 0.28, 0.279, HALF);
        drop(&hand, 0.33, 0.2, ACROSS);
    }
    FirstLoading first = first_loading_of(&hand.drops);
    assert_true(first.slid);
    assert_near("mu", first.mu.value, 0.4, 0);
    assert_near("U", first.U, 1.1, 1e-15);
    assert_true(isnan(first.mu.error));   // one value has no scatter of its own
    assert_int_equal(first.precursors, 2);
    assert_near("l_c", first.critical_length, 0.25 + 0.1, 1e-15);
    assert_near("longest", first.longest, 0.5 + 0.1, 1e-15);
    LaterCycles later = later_cycles_of(&hand.drops, 1);
    assert_int_equal(later.count, 3);
    assert_near("from peak to peak", later.way, 1, 1e-15);
    assert_near("precursors", later.precursors, 1, 0);
    assert_near("longest", later.longest, 0.6, 1e-15);
    hand_drops_end(&hand);
}

// Slip turned fast behind the front; then over three quarters of the contact, of which a third was
// behind it: the front says nothing of when the block slid.
TEST(test_slip_that_turns_fast_elsewhere)
{
    const double elsewhere[] = {0.5, 0.5, 0, 0.5, 0.5};
    for (int32_t k = 0; k < 2; k++) {
        HandDrops hand;
        hand_drops_begin(&hand, 1);
        see(&hand, 0.2, REST);
        see(&hand, 0.4, k == 0 ? SLOW : elsewhere);
        see(&hand, 0.4, ACROSS);
        see(&hand, 0.1, REST);
        FirstLoading first = first_loading_of(&hand.drops);
        assert_true(first.slid && isnan(first.critical_length) == (k == 1));
        hand_drops_end(&hand);
    }
}

// The load gained since the last precursor: one of them more or less changes the peak by a part of
// it.
TEST(test_since_the_last_precursor)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    drop(&hand, 0.3, 0.299, HALF);
    drop(&hand, 0.35, 0.349, HALF);
    drop(&hand, 0.4, 0.2, ACROSS);
    assert_near("since", first_loading_of(&hand.drops).since_precursor, 0.05, 1e-15);
    hand_drops_end(&hand);
    hand_drops_begin(&hand, 1);
    drop(&hand, 0.4, 0.2, ACROSS);
    assert_near("none", first_loading_of(&hand.drops).since_precursor, 0, 0);
    hand_drops_end(&hand);
}

// A block that slid from t = 0 on has no first loading: nothing had held before.
TEST(test_sliding_from_the_start)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    for (int32_t k = 0; k < 3; k++) see(&hand, 0.2, ACROSS);
    see(&hand, 0.2, REST);
    drop(&hand, 0.4, 0.2, ACROSS);
    FirstLoading first = first_loading_of(&hand.drops);
    assert_true(!first.slid && isnan(first.mu.value));
    assert_int_equal(first.precursors, 0);
    hand_drops_end(&hand);
}
