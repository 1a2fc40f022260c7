// SPDX-License-Identifier: GPL-2.0-or-later
// A coefficient that is negative between the speeds at which a law was looked at ends the run.
#include "record/contact_arrays.h"

#include "own_laws.h"
#include "seen_by_hand.h"

TEST(test_negative_between_the_speeds_looked_at)
{
    static const double fine[SEEN_NODES] = {0, 3.1, 3.2}, falls[SEEN_NODES] = {0, 3.1234567};
    Error err = {0};
    HandSeen hand;
    ContactArrays arrays;
    double theta[SEEN_NODES * STATES_MAX] = {0};
    FrictionLaw law = own_formula("0.3 - 0.5 * exp(-((v - 3.1234567) / 1e-5)^2)", 10);
    Friction friction = FRICTION_OF(&law);
    hand_seen_init(&hand);
    hand.state.theta = theta;
    assert_true(contact_arrays_create(&hand.interface, &friction, &arrays, &err));
    assert_true(contact_arrays_record(&arrays, hand_seen(&hand, 1, fine), &err));
    assert_false(contact_arrays_record(&arrays, hand_seen(&hand, 2, falls), &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    assert_non_null(strstr(err.message, "a coefficient of -0.2, at contact node 1"));
    contact_arrays_destroy(&arrays);
}
