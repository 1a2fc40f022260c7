// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of friction that remembers against all growth rates of a block, its states
// included, from dense matrices and differences of the laws: where it holds, all that does not
// decay has |lambda| < 1/h. Pressure does not follow slip in either.
#include "base/memory.h"
#include "contact/friction_make.h"
#include "contact/friction_state.h"

#include "certificate_rig.h"
#include "dense_by_hand.h"
#include "random_numbers.h"

enum { CONTACTS = 5, TRIALS = 400 };

typedef struct Fixture {
    CertificateRig built;
    FrictionLaw laws[CONTACTS];
    Random random;
    int32_t *free, free_count;   // unknowns of the bulk that move
    int32_t *place;   // of an unknown among them; -1: it is held
} Fixture;

static double log_between(Random *random, double low, double high)
{
    return exp(random_between(random, log(low), log(high)));
}

static FrictionLaw random_law(Random *random)
{
    static const FrictionKind kinds[] = {FRICTION_AGEING, FRICTION_SLIP_WEAKENING,
                                         FRICTION_RATE_STATE, FRICTION_RATE_STATE};
    int32_t k = random_index(random, 4);
    FrictionLaw law = {.kind = kinds[k]};
    FrictionMemory memory = {.kind = k < 2 ? (MemoryKind)k : MEMORY_RATE_STATE,
                             .states = 1,
                             .creeps = k > 1,
                             .factor = 1,
                             .mu_static = 0.38,
                             .mu_kinetic = 0.1,
                             .critical_velocity = log_between(random, 1e-4, 1e-2),
                             .slip_distance = log_between(random, 1e-5, 1e-2),
                             .healing_time = log_between(random, 1, 1e3),
                             .healing = log_between(random, 3e-3, 0.1),
                             .direct = log_between(random, 3e-3, 0.03),
                             .reference = 0.3,
                             .reference_velocity = 1e-5,
                             .slip_law = k == 3};
    friction_make_memory(&memory, &law);
    return law;
}

// Statuses, slip rates, states and pressures at random; not far from steady slip.
static void randomise(Fixture *fixture)
{
    Random *random = &fixture->random;
    State *seen = &fixture->built.seen;
    const Interface *interface = &fixture->built.rig.interface;
    for (int32_t i = 0; i < CONTACTS; i++) {
        fixture->laws[i] = random_law(random);
        int32_t t = interface_tangent(interface, i);
        double speed = log_between(random, 1e-7, 1e-2);
        double steady = memory_steady(&fixture->laws[i].own.memory, speed);
        bool forward = random_index(random, 2) == 0;
        seen->status[i] = random_index(random, 4) == 0 ? CONTACT_STICK
                          : forward                    ? CONTACT_SLIP_FORWARD
                                                       : CONTACT_SLIP_BACKWARD;
        seen->slip_rate[t] = seen->status[i] == CONTACT_STICK ? 0 : forward ? speed : -speed;
        seen->theta[i * STATES_MAX] = fixture->laws[i].kind == FRICTION_RATE_STATE
                             ? steady + random_between(random, -2, 2)
                             : steady * random_between(random, 0.3, 1);
        seen->reaction[t + 1] = log_between(random, 1e-4, 3e-3);
    }
    memset(seen->rod_touches, 1, (size_t)interface->rod_count);
    fixture->built.rig.law = friction_spread(fixture->laws, CONTACTS);
}

static void list_free(Fixture *fixture)
{
    const BlockRig *rig = &fixture->built.rig;
    const State *seen = &fixture->built.seen;
    for (int32_t k = 0; k < rig->bulk.dof_count; k++)
        fixture->place[k] = rig->bulk.held[k] ? -1 : 0;
    for (int32_t i = 0; i < CONTACTS; i++) {
        int32_t t = interface_tangent(&rig->interface, i);
        fixture->place[rig->interface.dofs[t + 1]] = -1;
        if (seen->status[i] == CONTACT_STICK) fixture->place[rig->interface.dofs[t]] = -1;
    }
    for (int32_t j = 0; j < rig->interface.rod_count; j++)
        fixture->place[rig->interface.dofs[interface_rod(&rig->interface, j)]] = -1;
    fixture->free_count = 0;
    for (int32_t k = 0; k < rig->bulk.dof_count; k++) {
        if (fixture->place[k] < 0) continue;
        fixture->place[k] = fixture->free_count;
        fixture->free[fixture->free_count++] = k;
    }
}

// Of f at x, by differences.
static double slope_of(double (*f)(const FrictionLaw *, double, double), const FrictionLaw *law,
                       double x, double other, double h)
{
    return (f(law, x + h, other) - f(law, x - h, other)) / (2 * h);
}
static FrictionRates rates_at(const FrictionLaw *law, double speed, double theta)
{
    FrictionRates rates;
    friction_rates(law, speed, &theta, &rates);
    return rates;
}
static double mu_by_speed(const FrictionLaw *law, double speed, double theta)
{
    return rates_at(law, speed, theta).mu;
}
static double mu_by_state(const FrictionLaw *law, double theta, double speed)
{
    return rates_at(law, speed, theta).mu;
}
static double rate_by_speed(const FrictionLaw *law, double speed, double theta)
{
    return rates_at(law, speed, theta).rate[0];
}
static double rate_by_state(const FrictionLaw *law, double theta, double speed)
{
    return rates_at(law, speed, theta).rate[0];
}

// y' = A y, y = (u, v, theta): the largest |lambda| with Re lambda >= 0; 0: all decays.
static double fastest_growth(Fixture *fixture, const double *stiffness, const double *damping)
{
    const BlockRig *rig = &fixture->built.rig;
    const State *seen = &fixture->built.seen;
    int32_t n = fixture->free_count, all = rig->bulk.dof_count, size = 2 * n + CONTACTS;
    double *a = hand_matrix(size, size), *vectors = hand_matrix(size, size);
    double *re = hand_matrix(size, 1), *im = hand_matrix(size, 1);
    double *work = hand_matrix((int32_t)dense_eigen_work(size), 1), fastest = 0;
    for (int32_t i = 0; i < n; i++) {
        int32_t k = fixture->free[i];
        a[(int64_t)(n + i) * size + i] = 1;
        for (int32_t j = 0; j < n; j++) {
            int64_t from = (int64_t)fixture->free[j] * all + k;
            a[(int64_t)j * size + n + i] = -stiffness[from] / rig->bulk.mass[k];
            a[(int64_t)(n + j) * size + n + i] = -damping[from] / rig->bulk.mass[k];
        }
    }
    for (int32_t i = 0; i < CONTACTS; i++) {
        int64_t theta = 2 * n + i;
        a[theta * size + theta] = -1;
        if (!status_slips(seen->status[i])) continue;
        const FrictionLaw *law = &fixture->laws[i];
        int32_t t = interface_tangent(&rig->interface, i), k = rig->interface.dofs[t];
        double speed = fabs(seen->slip_rate[t]), d = status_direction(seen->status[i]);
        double force = seen->reaction[t + 1] / rig->bulk.mass[k], h = 1e-4 * speed;
        double by_state = 1e-4 * fmax(fabs(seen->theta[i * STATES_MAX]), 1e-2);
        int64_t v = n + fixture->place[k];
        a[v * size + v] -= force * slope_of(mu_by_speed, law, speed, seen->theta[i * STATES_MAX], h);
        a[theta * size + v] = -d * force *
                              slope_of(mu_by_state, law, seen->theta[i * STATES_MAX], speed, by_state);
        a[v * size + theta] = d * slope_of(rate_by_speed, law, speed, seen->theta[i * STATES_MAX], h);
        a[theta * size + theta] = slope_of(rate_by_state, law, seen->theta[i * STATES_MAX], speed, by_state);
    }
    assert_true(dense_eigen_general(a, size, re, im, vectors, work));
    for (int32_t k = 0; k < size; k++)
        if (re[k] >= 0) fastest = fmax(fastest, hypot(re[k], im[k]));
    free(a), free(vectors), free(re), free(im), free(work);
    return fastest;
}

TEST(test_what_grows_is_resolved)
{
    static Fixture fixture;
    RigDef def = rig_def();
    fixture.random = (Random){1};
    certificate_rig_build(&def, 1, 0.1, &fixture.built);
    const BlockRig *rig = &fixture.built.rig;
    assert_int_equal(rig->interface.contact_count, CONTACTS);
    double *stiffness = rig_dense(rig, rig->bulk.stiffness);
    double *damping = rig_dense(rig, rig->bulk.damping);
    fixture.free = calloc((size_t)rig->bulk.dof_count, sizeof(int32_t));
    fixture.place = calloc((size_t)rig->bulk.dof_count, sizeof(int32_t));
    int32_t held = 0, growing = 0, refused = 0, rightly = 0;
    for (int32_t trial = 0; trial < TRIALS; trial++) {
        randomise(&fixture);
        list_free(&fixture);
        double fastest = fastest_growth(&fixture, stiffness, damping);
        double reach = log_between(&fixture.random, 1e-3, 1e3);
        bool holds = certificate_holds(&fixture.built.certificate, &fixture.built.seen, reach);
        held += holds;
        growing += holds && fastest > 0;
        refused += !holds;
        rightly += !holds && fastest * reach >= 1;
        if (holds && !(fastest * reach < 1 + 1e-5))
            fail_msg("trial %d: %g grows, h = %g", trial, fastest, reach);
    }
    print_message("%d held, %d of them with something that grows; %d refused, %d rightly\n", held,
                  growing, refused, rightly);
    assert_true(held > TRIALS / 5 && growing > 10 && rightly > TRIALS / 10);
    free(stiffness), free(damping), free(fixture.free), free(fixture.place);
    certificate_rig_destroy(&fixture.built);
}
