// SPDX-License-Identifier: GPL-2.0-or-later
// The laws against their formulas, slopes against finite differences.
#include "friction_by_hand.h"

#include "near.h"

static const FrictionKind KINDS[] = {FRICTION_LINEAR_WEAKENING, FRICTION_EXPONENTIAL_WEAKENING,
                                     FRICTION_COULOMB};

static FrictionLaw law_of(FrictionKind kind)
{
    return (FrictionLaw){
        .kind = kind, .mu_static = 0.6, .mu_kinetic = 0.2, .critical_velocity = 0.05};
}

TEST(test_values)
{
    FrictionLaw linear = law_of(FRICTION_LINEAR_WEAKENING);
    assert_near("half way", friction_coefficient(NODE_OF(&linear), 0.025), 0.4, 1e-15);
    assert_near("at v_c", friction_coefficient(NODE_OF(&linear), 0.05), 0.2, 1e-15);
    assert_near("fast", friction_coefficient(NODE_OF(&linear), 3), 0.2, 0);
    FrictionLaw exponential = law_of(FRICTION_EXPONENTIAL_WEAKENING);
    assert_near("at v_c", friction_coefficient(NODE_OF(&exponential), 0.05), 0.2 + 0.4 / M_E,
                1e-15);
    assert_near("fast", friction_coefficient(NODE_OF(&exponential), 5), 0.2, 1e-15);
    FrictionLaw coulomb = law_of(FRICTION_COULOMB);
    assert_near("fast", friction_coefficient(NODE_OF(&coulomb), 5), 0.6, 0);
    for (int k = 0; k < 3; k++) {
        FrictionLaw law = law_of(KINDS[k]);
        assert_near("threshold", friction_coefficient(NODE_OF(&law), 0), 0.6, 0);
    }
}

TEST(test_slopes)
{
    const double speeds[] = {0.001, 0.01, 0.03, 0.049, 0.051, 0.2, 0.4}, h = 1e-7;
    for (int k = 0; k < 3; k++) {
        FrictionLaw law = law_of(KINDS[k]);
        double before = friction_coefficient(NODE_OF(&law), 0);
        for (size_t s = 0; s < sizeof speeds / sizeof *speeds; s++) {
            double v = speeds[s], mu = friction_coefficient(NODE_OF(&law), v);
            double slope = (friction_coefficient(NODE_OF(&law), v + h) -
                            friction_coefficient(NODE_OF(&law), v - h)) /
                           (2 * h);
            assert_near("slope", friction_slope(NODE_OF(&law), v), slope, 1e-7);
            assert_int_equal(friction_weakens(NODE_OF(&law), v), slope < -1e-6);
            assert_true(mu <= before);   // never grows with speed
            before = mu;
        }
        double jump = friction_coefficient(NODE_OF(&law), 0.05 + 1e-12) -
                      friction_coefficient(NODE_OF(&law), 0.05 - 1e-12);
        assert_near("continuous at v_c", jump, 0, 1e-10);
    }
    FrictionLaw linear = law_of(FRICTION_LINEAR_WEAKENING);
    assert_near("beyond the kink", friction_slope(NODE_OF(&linear), 0.05), 0, 0);
    for (int k = 0; k < 3; k++) {   // at the spent speed 1 % of the drop is left, at most
        FrictionLaw law = law_of(KINDS[k]);
        double spent = friction_spent_speed(NODE_OF(&law));
        double left = friction_coefficient(NODE_OF(&law), spent) -
                      friction_coefficient(NODE_OF(&law), 100 * spent);
        assert_true(left <= 0.01 * friction_drop(NODE_OF(&law)));
    }
}

// A law times a factor, at every speed; and what stands for several nodes together.
TEST(test_nodes)
{
    FrictionLaw laws[3];
    FrictionNode each[4];
    for (int k = 0; k < 3; k++) {
        laws[k] = law_of(KINDS[k]);
        each[k] = friction_node(&laws[k], 0.5 + k);
        for (double v = 0; v < 0.2; v += 0.013) {
            double mu = (0.5 + k) * friction_coefficient(NODE_OF(&laws[k]), v);
            double slope = (0.5 + k) * friction_slope(NODE_OF(&laws[k]), v);
            assert_near("mu", friction_coefficient(&each[k], v), mu, 1e-15);
            assert_near("slope", friction_slope(&each[k], v), slope, 1e-13);
        }
        assert_near("at rest", friction_coefficient(&each[k], 0), 0.6 * (0.5 + k), 1e-15);
    }
    each[3] = friction_constant(0);
    laws[0].critical_velocity = 0.01;
    Friction all = friction_of_nodes(each, 4);
    assert_near("mu_S", all.mu_static, 1.5, 1e-15);   // Coulomb, 2.5 times 0.6
    assert_near("drop", all.drop, 0.6, 1e-15);   // exponential, 1.5 times 0.4
    assert_near("v_c", all.critical_velocity, 0.01, 0);
    for (int32_t i = 0; i < 4; i++) assert_ptr_equal(friction_at(&all, i), &each[i]);
    Friction same = friction_everywhere(each[1]);
    assert_ptr_equal(friction_at(&same, 3), &same.whole);
}
