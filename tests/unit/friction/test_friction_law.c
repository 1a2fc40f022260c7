// SPDX-License-Identifier: GPL-2.0-or-later
// The laws against their formulas, slopes against finite differences.
#include "friction/friction_law.h"

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
    assert_near("half way", friction_coefficient(&linear, 0.025), 0.4, 1e-15);
    assert_near("at v_c", friction_coefficient(&linear, 0.05), 0.2, 1e-15);
    assert_near("fast", friction_coefficient(&linear, 3), 0.2, 0);
    FrictionLaw exponential = law_of(FRICTION_EXPONENTIAL_WEAKENING);
    assert_near("at v_c", friction_coefficient(&exponential, 0.05), 0.2 + 0.4 / M_E, 1e-15);
    assert_near("fast", friction_coefficient(&exponential, 5), 0.2, 1e-15);
    FrictionLaw coulomb = law_of(FRICTION_COULOMB);
    assert_near("fast", friction_coefficient(&coulomb, 5), 0.6, 0);
    for (int k = 0; k < 3; k++) {
        FrictionLaw law = law_of(KINDS[k]);
        assert_near("threshold", friction_coefficient(&law, 0), 0.6, 0);
    }
}

TEST(test_slopes)
{
    const double speeds[] = {0.001, 0.01, 0.03, 0.049, 0.051, 0.2, 0.4}, h = 1e-7;
    for (int k = 0; k < 3; k++) {
        FrictionLaw law = law_of(KINDS[k]);
        double before = friction_coefficient(&law, 0);
        for (size_t s = 0; s < sizeof speeds / sizeof *speeds; s++) {
            double v = speeds[s], mu = friction_coefficient(&law, v);
            double slope = (friction_coefficient(&law, v + h) - friction_coefficient(&law, v - h)) /
                           (2 * h);
            assert_near("slope", friction_slope(&law, v), slope, 1e-7);
            assert_int_equal(friction_weakens(&law, v), slope < -1e-6);
            assert_true(mu <= before);   // never grows with speed
            before = mu;
        }
        double jump = friction_coefficient(&law, 0.05 + 1e-12) -
                      friction_coefficient(&law, 0.05 - 1e-12);
        assert_near("continuous at v_c", jump, 0, 1e-10);
    }
    FrictionLaw linear = law_of(FRICTION_LINEAR_WEAKENING);
    assert_near("beyond the kink", friction_slope(&linear, 0.05), 0, 0);
    for (int k = 0; k < 3; k++) {   // at the spent speed 1 % of the drop is left, at most
        FrictionLaw law = law_of(KINDS[k]);
        double spent = friction_spent_speed(&law);
        double left = friction_coefficient(&law, spent) - friction_coefficient(&law, 100 * spent);
        assert_true(left <= 0.01 * friction_drop(&law));
    }
}

// Either side of a kink as a curve of its own: the law where the law is on that side, elsewhere the
// same straight line, which is what the linear law has on both sides.
TEST(test_branches)
{
    for (int k = 0; k < 3; k++) {
        FrictionLaw law = law_of(KINDS[k]);
        double kink = friction_kink(&law, 0), slope;
        assert_int_equal(isfinite(kink), KINDS[k] == FRICTION_LINEAR_WEAKENING);
        for (double v = 0.003; v < 0.2; v += 0.01) {
            double mu = friction_branch(&law, v >= kink, v, &slope);
            assert_near("mu", mu, friction_coefficient(&law, v), 0);
            assert_near("slope", slope, friction_slope(&law, v), 0);
            if (!isfinite(kink)) continue;
            assert_near("before", friction_branch(&law, false, v, &slope), 0.6 - 8 * v, 1e-14);
            assert_near("before", slope, -8, 1e-14);
            assert_near("beyond", friction_branch(&law, true, v, &slope), 0.2, 1e-14);
            assert_near("beyond", slope, 0, 0);
        }
    }
}

// The drop from rest to fast slip, and the slip that it can drive.
TEST(test_drop)
{
    for (int k = 0; k < 3; k++) {
        FrictionLaw law = law_of(KINDS[k]);
        double drop = friction_coefficient(&law, 0) - friction_coefficient(&law, 1e9);
        assert_near("drop", friction_drop(&law), drop, 1e-15);
        assert_int_equal(friction_has_drop(&law), drop > 0);
        double driven = (drop > 0 ? drop : 0.6) * 3 * 0.5 / 20;
        assert_near("slip", friction_slip(&law, 3, 0.5, 20), driven, 1e-15);
    }
    FrictionLaw none = friction_constant(0), rough = friction_constant(0.7);
    assert_near("mu", friction_coefficient(&rough, 5), 0.7, 0);
    assert_near("slip without friction", friction_slip(&none, 3, 0.5, 20), 3 * 0.5 / 20, 1e-15);
}

// A kind that there is not is called so, and counts as one that does not weaken.
TEST(test_names)
{
    FrictionLaw none = law_of((FrictionKind)99), linear = law_of(FRICTION_LINEAR_WEAKENING);
    assert_string_equal(friction_law_name(&none), "unknown");
    assert_string_equal(friction_law_name(&linear), "linear-weakening");
    assert_true(friction_drop(&none) == 0 && !friction_has_drop(&none));
}

// phi = max(0, 1 - v/v_c), and mu = mu_K + (mu_S - mu_K) phi wherever something weakens.
TEST(test_contact_density)
{
    FrictionLaw linear = law_of(FRICTION_LINEAR_WEAKENING);
    for (double v = 0; v < 0.2; v += 0.007)
        assert_near("phi", friction_contact_density(&linear, v), fmax(0, 1 - v / 0.05), 1e-14);
    FrictionLaw exponential = law_of(FRICTION_EXPONENTIAL_WEAKENING);
    assert_near("phi", friction_contact_density(&exponential, 0.1), exp(-2), 1e-15);
    FrictionLaw coulomb = law_of(FRICTION_COULOMB), level = linear;
    level.mu_kinetic = level.mu_static;
    assert_near("nothing weakens", friction_contact_density(&coulomb, 1), 1, 0);
    assert_near("nothing weakens", friction_contact_density(&level, 1), 1, 0);
}

// A law times a factor, at every speed; and what stands for several laws together.
TEST(test_scaled_and_spread)
{
    FrictionLaw each[4];
    for (int k = 0; k < 3; k++) {
        FrictionLaw law = law_of(KINDS[k]);
        each[k] = friction_scaled(&law, 0.5 + k);
        for (double v = 0; v < 0.2; v += 0.013) {
            double mu = (0.5 + k) * friction_coefficient(&law, v);
            assert_near("mu", friction_coefficient(&each[k], v), mu, 1e-15);
            assert_near("slope", friction_slope(&each[k], v), (0.5 + k) * friction_slope(&law, v),
                        1e-13);
        }
    }
    each[3] = friction_constant(0);
    each[0].critical_velocity = 0.01;
    FrictionLaw all = friction_spread(each, 4);
    assert_near("mu_S", all.mu_static, 1.5, 1e-15);   // Coulomb, 2.5 times 0.6
    assert_near("drop", friction_drop(&all), 0.6, 1e-15);   // exponential, 1.5 times 0.4
    assert_near("v_c", all.critical_velocity, 0.01, 0);
    for (int32_t i = 0; i < 4; i++) assert_ptr_equal(friction_at(&all, i), &each[i]);
    assert_ptr_equal(friction_at(&each[1], 3), &each[1]);
    assert_false(friction_everywhere(&all, 4));
    assert_true(friction_everywhere(&all, 3));
}
