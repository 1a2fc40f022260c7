// SPDX-License-Identifier: GPL-2.0-or-later
// The spring that steady slip at V needs, against (b - a) N/D_c and its like; how fast it forgets.
#include "friction/friction_start.h"

#include "own_laws.h"
#include "path_by_hand.h"

static const double V = 1e-4;

static void take(Rig *rig, FrictionLaw law, FrictionNode *node)
{
    start(rig);
    rig->law = law_with_state(law);
    rig->model.friction = FRICTION_OF(&rig->law);
    rig->model.scales.slip_velocity = V;
    *node = rig->model.friction.whole;
    rig->path.nodes = node;
}

TEST(test_critical_spring)
{
    Rig rig;
    FrictionNode node;
    for (int32_t slip_law = 0; slip_law < 2; slip_law++) {
        take(&rig,
             (FrictionLaw){.kind = FRICTION_RATE_STATE,
                           .direct_effect = 0.01,
                           .evolution_effect = 0.015,
                           .slip_distance = 2e-3,
                           .mu_reference = 0.3,
                           .reference_velocity = 1e-6,
                           .slip_law = slip_law == 1},
             &node);
        assert_near("(b - a) N/D_c", stability_critical_spring(&rig.path, 0, 4), 0.005 * 4 / 2e-3,
                    1e-5);
        assert_near("V/D_c", friction_forgets(&node, V), V / 2e-3, 1e-7);
    }
    rig.law.evolution_effect = 0.008;
    assert_near("it strengthens", stability_critical_spring(&rig.path, 0, 4), 0, 0);
    // phi = 1/(1 + V t_h/D_c) = 1/3.
    take(&rig,
         (FrictionLaw){.kind = FRICTION_SLIP_WEAKENING,
                       .mu_static = 0.5,
                       .mu_kinetic = 0.2,
                       .healing_time = 40,
                       .slip_distance = 2e-3},
         &node);
    assert_near("drop phi N/D_c", stability_critical_spring(&rig.path, 0, 4), 0.3 / 3 * 4 / 2e-3,
                1e-4);
    assert_near("1/t_h + V/D_c", friction_forgets(&node, V), 1.0 / 40 + V / 2e-3, 1e-7);
    take(&rig,
         (FrictionLaw){.kind = FRICTION_AGEING,
                       .mu_static = 0.5,
                       .mu_kinetic = 0.2,
                       .critical_velocity = 1e-2,
                       .healing = 0.02,
                       .healing_time = 10,
                       .slip_distance = 2e-3},
         &node);
    assert_true(isnan(stability_critical_spring(&rig.path, 0, 4)));
    rig.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.5};
    assert_true(isnan(stability_critical_spring(&rig.path, 0, 4)));
}
