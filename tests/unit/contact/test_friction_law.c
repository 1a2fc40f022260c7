// SPDX-License-Identifier: GPL-2.0-or-later
// The laws against their formulas, slopes against finite differences.
#include "contact/friction_law.h"

#include "near.h"

static const FrictionKind KINDS[] = {FRICTION_LINEAR_WEAKENING, FRICTION_EXPONENTIAL_WEAKENING,
                                     FRICTION_COULOMB};

static FrictionLaw law_of(FrictionKind kind)
{
    return (FrictionLaw){
        .kind = kind, .mu_static = 0.6, .mu_kinetic = 0.2, .critical_velocity = 0.05};
}

static void test_values(void **state)
{
    (void)state;
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

static void test_slopes(void **state)
{
    (void)state;
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
        assert_true(left <= 0.01 * (law.mu_static - law.mu_kinetic));
    }
}

// phi = max(0, 1 - v/v_c), and mu = mu_K + (mu_S - mu_K) phi wherever something weakens.
static void test_contact_density(void **state)
{
    (void)state;
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

static void test_default_is_set_a(void **state)
{
    (void)state;
    FrictionLaw law = friction_law_default();
    assert_int_equal(law.kind, FRICTION_LINEAR_WEAKENING);
    assert_true(law.mu_static == 0.38 && law.mu_kinetic == 0.1 && law.critical_velocity == 3.4e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_slopes),
        cmocka_unit_test(test_contact_density),
        cmocka_unit_test(test_default_is_set_a),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
