// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of a block whose material has branches: against a Runge-Kutta solution of the dense
// equations with their stretches as unknowns, the ledger, and the two limits of a relaxation time.
#include "stepping/sdirk.h"

#include "plane.h"
#include "stepper.h"

enum { BRANCHES = 2 };
static const Branch BRANCH[BRANCHES] = {{.time = 0.15, .shear = 0.5, .bulk = 0.4},
                                        {.time = 2, .shear = 0.3}};

// A frictionless block of plane strain, loaded askew at t = 0, with branches and little viscosity.
static RigDef branched_def(void)
{
    RigDef def = smooth_def();
    def.material.plane_strain = true;
    def.material.eta1 = def.material.eta2 = 0.1;
    def.material.branch_count = BRANCHES;
    memcpy(def.material.branch, BRANCH, sizeof BRANCH);
    return def;
}

// K of an elastic body, dense, on the mesh of the rig.
static double *elastic_matrix(const BlockRig *rig, double shear, double bulk)
{
    Error err = {0};
    Bulk made;
    Material material = {.young = 9 * bulk * shear / (3 * bulk + shear),
                         .poisson = (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear),
                         .density = 1,
                         .plane_strain = true};
    assert_true(bulk_create(&rig->mesh, &made, &err) &&
                bulk_assemble(&rig->mesh, &material, &made, &err));
    double *dense = rig_dense(rig, made.stiffness);
    bulk_destroy(&made);
    return dense;
}

// M u'' + C u' + K u + sum_k K_k e_k = f with contact normals at 0, e_k' = u' - e_k/tau_k.
typedef struct Reference {
    int32_t n;
    double *k, *c, *branch[BRANCHES];
    double *x;   // [(2 + BRANCHES) * n] u, v, e_k
    const BlockRig *rig;
} Reference;

static Reference reference_create(const BlockRig *rig)
{
    Reference ref = {.n = rig->bulk.dof_count, .rig = rig};
    ref.k = rig_dense(rig, rig->bulk.stiffness);
    ref.c = rig_dense(rig, rig->bulk.damping);
    // An elastic body of moduli G and K has G A + K B.
    double *one = elastic_matrix(rig, 1, 1), *two = elastic_matrix(rig, 1, 2);
    for (int32_t b = 0; b < BRANCHES; b++) {
        ref.branch[b] = hand_matrix(ref.n, ref.n);
        for (int32_t i = 0; i < ref.n * ref.n; i++)
            ref.branch[b][i] = BRANCH[b].shear * (2 * one[i] - two[i]) +
                               BRANCH[b].bulk * (two[i] - one[i]);
    }
    free(one);
    free(two);
    ref.x = hand_matrix(ref.n, 2 + BRANCHES);
    return ref;
}

static void reference_destroy(Reference *ref)
{
    free(ref->k);
    free(ref->c);
    for (int32_t b = 0; b < BRANCHES; b++) free(ref->branch[b]);
    free(ref->x);
}

static void reference_rate(const Reference *ref, const double *x, double *rate)
{
    int32_t n = ref->n;
    double *force = hand_matrix(n, 1), *a = rate + n;
    const double *v = x + n;
    memcpy(a, ref->rig->bulk.load, (size_t)n * sizeof *a);
    for (int32_t term = 0; term < 2 + BRANCHES; term++) {
        const double *matrix = term == 0 ? ref->k : term == 1 ? ref->c : ref->branch[term - 2];
        hand_apply(matrix, n, n, x + term * n, force);
        for (int32_t i = 0; i < n; i++) a[i] -= force[i];
    }
    for (int32_t i = 0; i < n; i++) a[i] /= ref->rig->bulk.mass[i];
    for (int32_t i = 0; i < ref->rig->interface.contact_count; i++)
        a[ref->rig->interface.dofs[plane_normal(i)]] = 0;
    memcpy(rate, v, (size_t)n * sizeof *rate);
    for (int32_t b = 0; b < BRANCHES; b++)
        for (int32_t i = 0; i < n; i++)
            rate[(2 + b) * n + i] = v[i] - x[(2 + b) * n + i] / BRANCH[b].time;
    free(force);
}

// The classical fourth-order scheme.
static void reference_run(Reference *ref, double duration, int32_t steps)
{
    static const double nodes[] = {0, 0.5, 0.5, 1}, weights[] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
    int32_t size = (2 + BRANCHES) * ref->n;
    double dt = duration / steps;
    double *at = hand_matrix(size, 1), *rate = hand_matrix(size, 1), *sum = hand_matrix(size, 1);
    for (int32_t s = 0; s < steps; s++) {
        memset(sum, 0, (size_t)size * sizeof *sum);
        memset(rate, 0, (size_t)size * sizeof *rate);
        for (int stage = 0; stage < 4; stage++) {
            for (int32_t i = 0; i < size; i++) at[i] = ref->x[i] + nodes[stage] * dt * rate[i];
            reference_rate(ref, at, rate);
            for (int32_t i = 0; i < size; i++) sum[i] += weights[stage] * dt * rate[i];
        }
        for (int32_t i = 0; i < size; i++) ref->x[i] += sum[i];
    }
    free(at);
    free(rate);
    free(sum);
}

static double largest_difference(const double *a, const double *b, int32_t n)
{
    double worst = 0;
    for (int32_t i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
    return worst;
}

// u, v and the stretches of both branches.
TEST(test_order)
{
    RigDef def = branched_def();
    Stepper stepper;
    double errors[2][2 + BRANCHES];
    for (int32_t k = 0; k < 2; k++) {
        stepper_build(&def, 0.02, &stepper);
        Reference ref = reference_create(&stepper.rig);
        reference_run(&ref, 1, 2000);
        for (int32_t s = 0; s < 50 << k; s++) {
            StepOutcome outcome = do_step(&stepper, k);
            assert_near("residual", outcome.residual, 0, 2e-15);
        }
        const double *got[] = {stepper.now.displacement, stepper.now.velocity, stepper.now.stretch,
                               stepper.now.stretch + ref.n};
        for (int32_t w = 0; w < 2 + BRANCHES; w++) {
            int32_t own = w;   // in the spectrum's order of times
            if (w >= 2 && stepper.rig.bulk.spectrum.time[w - 2] != BRANCH[w - 2].time) own = 5 - w;
            errors[k][w] = largest_difference(got[w], ref.x + own * ref.n, ref.n);
        }
        reference_destroy(&ref);
        stepper_destroy(&stepper);
    }
    for (int32_t w = 0; w < 2 + BRANCHES; w++)
        assert_near("order", log2(errors[0][w] / errors[1][w]), 2, 0.1);
    assert_true(errors[1][0] < 1e-3 * 3e-3);   // of the motion
}

// The ledger's imbalance goes down with the square of the step, and branches take their part
// of the energy: without viscosity all that is dissipated, each what its own spring and time say.
TEST(test_energy_order)
{
    RigDef def = branched_def();
    Stepper stepper;
    double missing[3];
    def.material.eta1 = def.material.eta2 = 0;
    for (int32_t k = 0; k < 3; k++) {
        stepper_build(&def, 0.02, &stepper);
        for (int32_t s = 0; s < 400; s++) do_step(&stepper, 6);   // past the jump of the load
        EnergyLedger ledger = energy_open(&stepper.now);
        for (int32_t s = 0; s < 50 << k; s++) {
            StepOutcome outcome = do_step(&stepper, k);
            sdirk_add_energy(&stepper.scheme, &outcome, dt_level_step(&stepper.dt_levels, k),
                             &ledger);
        }
        energy_store(&stepper.now, &ledger);
        assert_true(ledger.viscous > 0.05 * ledger.elastic);
        double dissipated = 0;
        for (int32_t b = 0; b < stepper.rig.bulk.spectrum.count; b++) {
            assert_true(ledger.branch[b].stored > 0 && ledger.branch[b].dissipated > 0);
            assert_near("stored", ledger.branch[b].stored, state_branch_energy(&stepper.now, b), 0);
            dissipated += ledger.branch[b].dissipated;
        }
        assert_near("dissipated", dissipated / ledger.viscous, 1, 1e-9);
        missing[k] = energy_imbalance(&ledger);
        stepper_destroy(&stepper);
    }
    assert_near("order", log2(missing[0] / missing[1]), 2, 0.15);
    assert_near("order", log2(missing[1] / missing[2]), 2, 0.1);
}

// u after 50 steps of 0.02, with friction, a rod and no branches but the given one.
static double *moved(const RigDef *def)
{
    Stepper stepper;
    stepper_build(def, 0.02, &stepper);
    int32_t n = stepper.now.dof_count;
    double *u = hand_matrix(n, 1);
    for (int32_t s = 0; s < 50; s++) do_step(&stepper, 0);
    memcpy(u, stepper.now.displacement, (size_t)n * sizeof *u);
    stepper_destroy(&stepper);
    return u;
}

static void check_same(const RigDef *one, const RigDef *other, double tolerance)
{
    double *left = moved(one), *right = moved(other);
    assert_all_near("displacement", left, right, 30, tolerance);
    free(left);
    free(right);
}

// tau -> 0: 2 G tau and (K - 2 G/3) tau are viscosities; tau -> infinity: G and K are moduli. With
// friction, slip and a rod.
TEST(test_limits)
{
    const double shear = 0.3, bulk = 0.5, soon = 1e-9, late = 1e9;
    RigDef def = rig_def(), like = rig_def();
    def.material.plane_strain = like.material.plane_strain = true;
    def.rod_kind = like.rod_kind = ROD_PUSHES;
    def.rod_velocity = like.rod_velocity = 2e-3;
    def.material.branch_count = 1;
    def.material.branch[0] = (Branch){.time = soon, .shear = shear / soon, .bulk = bulk / soon};
    like.material.eta1 += 2 * shear;
    like.material.eta2 += bulk - 2 * shear / 3;
    check_same(&def, &like, 1e-6);
    def.material.branch[0] = (Branch){.time = late, .shear = shear, .bulk = bulk};
    like.material = def.material;
    like.material = material_at_once(&def.material);
    check_same(&def, &like, 1e-8);
}
