// SPDX-License-Identifier: GPL-2.0-or-later
// Definiteness of S - W on what can move, against eigenvalues of matrices condensed by hand, and
// against the closed form where a single node slips.
#include "stepping/certificate.h"

#include "certificate_rig.h"
#include "own_laws.h"
#include "plane.h"

typedef struct Fixture {
    CertificateRig built;
    double *schur;   // [count^2] of C alone
} Fixture;

static void fixture_build(const RigDef *def, Fixture *fixture)
{
    certificate_rig_build(def, 1, 1e-3, &fixture->built);
    BlockRig *rig = &fixture->built.rig;
    double *c = rig_dense(rig, rig->bulk.damping);
    fixture->schur = hand_matrix(rig->interface.count, rig->interface.count);
    hand_schur(c, rig->bulk.dof_count, rig->interface.dofs, rig->interface.count, fixture->schur);
    free(c);
}

static void fixture_destroy(Fixture *fixture)
{
    free(fixture->schur);
    certificate_rig_destroy(&fixture->built);
}

// The least eigenvalue of (schur - W) on the moving unknowns; *weakening: whether W is not 0.
static double least_eigenvalue(const Fixture *fixture, const double *schur, bool *weakening)
{
    const Interface *interface = &fixture->built.rig.interface;
    const State *seen = &fixture->built.seen;
    double a[32 * 32], values[32], w[32] = {0};
    int32_t moving[32], count = 0, size = interface->count;
    *weakening = false;
    for (int32_t k = 0; k < size; k++) {
        int32_t i = k / 2;
        bool contact = k < 2 * interface->contact_count, tangent = contact && k % 2 == 0;
        uint8_t status = contact ? seen->status[i] : CONTACT_OPEN;
        if (!contact && seen->rod_touches[k - 2 * interface->contact_count]) continue;
        if (status == CONTACT_STICK || (status != CONTACT_OPEN && !tangent)) continue;
        double speed = fabs(seen->slip_rate[k]);
        const FrictionNode *node = friction_at(&fixture->built.rig.friction, i);
        const FrictionLaw *law = node->law;
        if (status != CONTACT_OPEN && friction_is_own(law)) {
            w[count] = -friction_slope(node, speed) * seen->reaction[k + 1];
            *weakening = *weakening || w[count] > 0;
        } else if (status != CONTACT_OPEN && speed < law->critical_velocity) {
            w[count] = node->factor * (law->mu_static - law->mu_kinetic) / law->critical_velocity *
                       seen->reaction[k + 1];
            *weakening = true;
        }
        moving[count++] = k;
    }
    if (count == 0) return INFINITY;
    for (int32_t p = 0; p < count; p++)
        for (int32_t q = 0; q < count; q++)
            a[q * count + p] = schur[moving[q] * size + moving[p]] - (p == q ? w[p] : 0);
    hand_eigenvalues(a, count, values);
    return values[0];
}

static void random_state(Random *random, double pressure, Fixture *fixture)
{
    const Interface *interface = &fixture->built.rig.interface;
    State *seen = &fixture->built.seen;
    double v_c = fixture->built.rig.law.critical_velocity;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        seen->status[i] = (uint8_t)random_index(random, 4);
        seen->reaction[plane_normal(i)] =
            seen->status[i] == CONTACT_OPEN ? 0 : pressure * random_between(random, 0.2, 1);
        double speed = v_c * random_between(random, 0.01, 1.5);
        seen->slip_rate[plane_tangent(i)] = speed *
                                            (seen->status[i] == CONTACT_SLIP_BACKWARD ? -1 : 1);
    }
    for (int32_t j = 0; j < interface->rod_count; j++)
        seen->rod_touches[j] = (uint8_t)random_index(random, 2);
}

static void check_random_states(const RigDef *def, double scale)
{
    Random random = {.state = 41};
    Fixture fixture;
    fixture_build(def, &fixture);
    int32_t held = 0, cases = 0;
    for (int32_t trial = 0; trial < 300; trial++) {
        random_state(&random, scale * random_between(&random, 0.1, 3), &fixture);
        bool weakens;
        double least = least_eigenvalue(&fixture, fixture.schur, &weakens);
        bool holds = certificate_holds(&fixture.built.certificate, &fixture.built.seen, 0);
        assert_int_equal(holds, !weakens || least > 0);
        held += weakens && holds;
        cases += weakens;
    }
    assert_true(cases > 200 && held > 40 && held < cases - 40);
    assert_true(fixture.built.certificate.checks > 200);
    fixture_destroy(&fixture);
}

// k p around eta: both answers are common.
TEST(test_random_states)
{
    RigDef def = rig_def();
    def.rod_width = 0.5;   // two rod nodes
    check_random_states(&def, def.law.critical_velocity / 0.28);
}

// A law that weakens, twice as steeply as it then strengthens: of random speeds a third has either,
// and what strengthens helps the others to hold.
TEST(test_strengthening)
{
    RigDef def = rig_def();
    def.rod_width = 0.5;
    const double velocity[] = {0, 1.7e-4, 3.4e-4, 6e-4}, mu[] = {0.38, 0.24, 0.1, 0.2};
    def.law = own_table(4, velocity, mu, true);
    assert_near("v_c", def.law.critical_velocity, 3.4e-4, 1e-12);
    check_random_states(&def, 3.4e-4 / 0.28);
}

// Every node with a law of its own: weakening at half or twice the rate, not at all, strengthening.
TEST(test_laws_by_node)
{
    enum { NODES_MAX = 16 };
    FrictionNode each[NODES_MAX];
    RigDef def = rig_def();
    def.rod_width = 0.5;
    const double velocity[] = {0, 1.7e-4, 3.4e-4, 6e-4}, mu[] = {0.38, 0.24, 0.1, 0.2};
    FrictionLaw linear = def.law, table = own_table(4, velocity, mu, true);
    for (int32_t i = 0; i < NODES_MAX; i++) {
        each[i] = i % 4 == 0   ? friction_node(&linear, 0.5)
                  : i % 4 == 1 ? friction_node(&linear, 2)
                  : i % 4 == 2 ? friction_constant(0.4)
                               : friction_node(&table, 1.5);
    }
    Friction friction = friction_of_nodes(each, NODES_MAX);
    def.friction = &friction;
    check_random_states(&def, 3.4e-4 / 0.28);
}

// One slipping node: lost exactly where (mu_S - mu_K) p w / v_c reaches S_C,tt.
TEST(test_one_node)
{
    RigDef def = rig_def();
    def.rod_width = 0;
    Fixture fixture;
    fixture_build(&def, &fixture);
    State *seen = &fixture.built.seen;
    int32_t size = fixture.built.rig.interface.count;
    for (int32_t i = 0; i < 5; i++) {
        int32_t t = plane_tangent(i);
        double limit = fixture.schur[t * size + t] * def.law.critical_velocity / 0.28;
        seen->status[i] = CONTACT_SLIP_BACKWARD;
        seen->slip_rate[t] = -0.5 * def.law.critical_velocity;
        seen->reaction[t + 1] = limit * (1 - 1e-9);
        assert_true(certificate_holds(&fixture.built.certificate, seen, 0));
        seen->reaction[t + 1] = limit * (1 + 1e-9);
        assert_false(certificate_holds(&fixture.built.certificate, seen, 0));
        seen->slip_rate[t] = -1.1 * def.law.critical_velocity;   // past the weakening branch
        assert_true(certificate_holds(&fixture.built.certificate, seen, 0));
        seen->slip_rate[t] = 0;
        seen->status[i] = CONTACT_STICK;
        assert_true(certificate_holds(&fixture.built.certificate, seen, 0));
    }
    fixture_destroy(&fixture);
}

// Without viscosity nothing that weakens is certified, but a step may still resolve it.
TEST(test_no_viscosity)
{
    RigDef def = rig_def();
    def.material.eta1 = def.material.eta2 = 0;
    CertificateRig on;
    certificate_rig_build(&def, 0.1, 0.05, &on);
    assert_true(certificate_holds(&on.certificate, &on.seen, 0));   // all stick
    on.seen.status[2] = CONTACT_SLIP_FORWARD;
    on.seen.slip_rate[plane_tangent(2)] = 1e-6;
    on.seen.reaction[plane_normal(2)] = 1e-9;
    assert_false(certificate_holds(&on.certificate, &on.seen, 0));
    assert_true(
        certificate_step_resolves(&on.certificate, &on.seen, certificate_rig_level(&on, 0), 0));
    certificate_rig_destroy(&on);
}
