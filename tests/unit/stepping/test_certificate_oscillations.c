// SPDX-License-Identifier: GPL-2.0-or-later
// How much an oscillation grows in half a period, against all eigenvalues of the block with its
// slip set: lambda^2 M + lambda (C - W) + K on what moves, written out and handed to LAPACK.
#include "stepping/certificate.h"

#include "certificate_rig.h"
#include "plane.h"

enum { DOFS_MAX = 64 };

typedef struct Fixture {
    CertificateRig built;
    double *damping, *stiffness;   // dense, of the mesh
} Fixture;

static void fixture_build(double length, Fixture *fixture)
{
    Error err = {0};
    RigDef def = rig_def();
    def.block.length = length;
    def.block.height = 0.5 * length;
    def.rod_width = 0;
    certificate_rig_build(&def, 400 * length, 4e-4 * length, &fixture->built);
    BlockRig *rig = &fixture->built.rig;
    fixture->damping = rig_dense(rig, rig->bulk.damping);
    fixture->stiffness = rig_dense(rig, rig->bulk.stiffness);
    // Those between are the certificate's affair: without them it clears what grows.
    assert_non_null(dt_level_operator(&fixture->built.dt_levels, 0, PART_WHOLE, &err));
    assert_non_null(dt_level_operator(&fixture->built.dt_levels,
                                      fixture->built.dt_levels.level_count - 1, PART_WHOLE, &err));
}

static void fixture_destroy(Fixture *fixture)
{
    free(fixture->damping);
    free(fixture->stiffness);
    certificate_rig_destroy(&fixture->built);
}

// The first `lifted` nodes are open, the next ones up to `last` slip, of weakening `weak` each.
static void slip_up_to(Fixture *fixture, int32_t lifted, int32_t last, double weak)
{
    const FrictionLaw *law = &fixture->built.rig.law;
    double slope = (law->mu_static - law->mu_kinetic) / law->critical_velocity;
    for (int32_t i = 0; i < fixture->built.seen.contact_count; i++) {
        fixture->built.seen.status[i] = i <= last ? CONTACT_SLIP_FORWARD : CONTACT_STICK;
        fixture->built.seen.slip_rate[plane_tangent(i)] = i <= last ? 0.1 * law->critical_velocity
                                                                    : 0;
        fixture->built.seen.reaction[plane_normal(i)] = weak / slope;
        if (i >= lifted) continue;
        fixture->built.seen.status[i] = CONTACT_OPEN;
        fixture->built.seen.reaction[plane_normal(i)] = 0;
    }
}

// The largest Re lambda/|lambda| there is, from the companion matrix.
static double least_angle(const Fixture *fixture, double weak)
{
    const BlockRig *rig = &fixture->built.rig;
    int32_t n = rig->bulk.dof_count, moving[DOFS_MAX], count = 0;
    bool held[DOFS_MAX] = {false}, slips[DOFS_MAX] = {false};
    for (int32_t i = 0; i < rig->interface.contact_count; i++) {
        uint8_t status = fixture->built.seen.status[i];
        held[rig->interface.dofs[2 * i + 1]] = status != CONTACT_OPEN;
        held[rig->interface.dofs[2 * i]] = status == CONTACT_STICK;
        slips[rig->interface.dofs[2 * i]] = status == CONTACT_SLIP_FORWARD;
    }
    for (int32_t dof = 0; dof < n; dof++)
        if (!held[dof]) moving[count++] = dof;
    int32_t size = 2 * count;
    double *a = hand_matrix(size, size), *vectors = hand_matrix(size, size);
    double *re = hand_matrix(size, 2), *im = re + size;
    double *work = hand_matrix((int32_t)DENSE_EIGEN_WORK(size), 1);
    for (int32_t q = 0; q < count; q++) {
        a[(count + q) * size + q] = 1;   // u' = v, v' = -M^-1 (K u + (C - W) v)
        for (int32_t p = 0; p < count; p++) {
            double mass = rig->bulk.mass[moving[p]];
            int32_t at = moving[q] * n + moving[p];
            double damping = fixture->damping[at] - (p == q && slips[moving[p]] ? weak : 0);
            a[q * size + count + p] = -fixture->stiffness[at] / mass;
            a[(count + q) * size + count + p] = -damping / mass;
        }
    }
    assert_true(dense_eigen_general(a, size, re, im, vectors, work));
    double least = -1;
    for (int32_t k = 0; k < size; k++) least = fmax(least, re[k] / hypot(re[k], im[k]));
    free(a);
    free(vectors);
    free(re);
    free(work);
    return least;
}

static bool oscillates_less(Fixture *fixture, double growth)
{
    return certificate_oscillates_less(
        &fixture->built.certificate, &fixture->built.seen, &fixture->built.dt_levels,
        (LevelRange){0, fixture->built.dt_levels.level_count}, growth);
}

// States that are cleared grow by less, and all that grow by much less are cleared.
TEST(test_against_eigenvalues)
{
    int32_t cleared = 0, oscillating = 0, refused = 0;
    for (int32_t trial = 0; trial < 6; trial++) {
        double length = trial % 2 ? 10 : 1;
        int32_t lifted = trial / 2;
        Fixture fixture;
        fixture_build(length, &fixture);
        double unit = fixture.damping[0];
        for (int32_t last = 1; last < fixture.built.seen.contact_count; last++) {
            for (double weak = 0.02 * unit; weak < 5 * unit; weak *= 1.1) {
                slip_up_to(&fixture, lifted, last, weak);
                double angle = least_angle(&fixture, weak);
                for (double growth = 1.5; growth < 1e4; growth *= 5) {
                    double ratio = log(growth) / M_PI, allowed = ratio / sqrt(1 + ratio * ratio);
                    bool less = oscillates_less(&fixture, growth);
                    if (less) assert_true(angle < allowed);
                    if (angle < 0) assert_true(less || allowed < 0.3);
                    cleared += less;
                    oscillating += less && angle > 0;
                    refused += !less;
                }
            }
        }
        fixture_destroy(&fixture);
    }
    print_message("%d cleared, %d of them oscillate and grow; %d refused\n", cleared, oscillating,
                  refused);
    assert_true(oscillating > 50 && refused > 50);
}
