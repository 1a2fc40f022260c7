// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of friction that remembers against all growth rates of a block, its states
// included, from dense matrices and differences of the laws: where it holds, all that does not
// decay has |lambda| < 1/h; where oscillations are narrow Re lambda < a |lambda|; where runaway is
// excluded no rate is real; growth_rates finds what there is. Pressure follows slip in the last
// two.
#include "base/memory.h"
#include "friction/friction_make.h"
#include "friction/friction_state.h"

#include "certificate_rig.h"
#include "dense_by_hand.h"
#include "random_numbers.h"
#include "stepping/growth.h"

enum { CONTACTS = 5, TRIALS = 400 };

typedef struct Fixture {
    CertificateRig built;
    FrictionLaw laws[CONTACTS];
    Random random;
    double *stiffness, *damping;   // dense, of the mesh
    int32_t *free, free_count;   // unknowns of the bulk that move
    int32_t *place;   // of an unknown among them; -1: it is held
    double *re, *im;   // [2 free_count + CONTACTS] the rates that find_rates found
} Fixture;

static void fixture_build(double longest, double shortest, Fixture *fixture)
{
    RigDef def = rig_def();
    *fixture = (Fixture){.random = {1}};
    certificate_rig_build(&def, longest, shortest, &fixture->built);
    const BlockRig *rig = &fixture->built.rig;
    int32_t count = rig->bulk.dof_count;
    assert_int_equal(rig->interface.contact_count, CONTACTS);
    fixture->stiffness = rig_dense(rig, rig->bulk.stiffness);
    fixture->damping = rig_dense(rig, rig->bulk.damping);
    fixture->free = calloc((size_t)count, sizeof(int32_t));
    fixture->place = calloc((size_t)count, sizeof(int32_t));
    fixture->re = hand_matrix(2 * count + CONTACTS, 1);
    fixture->im = hand_matrix(2 * count + CONTACTS, 1);
}

static void fixture_destroy(Fixture *fixture)
{
    free(fixture->stiffness), free(fixture->damping), free(fixture->free), free(fixture->place);
    free(fixture->re), free(fixture->im);
    certificate_rig_destroy(&fixture->built);
}

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

// y' = A y, y = (u, v, theta), into re and im; coupled: what slip adds to the pressure changes
// friction. Returns how many.
static int32_t find_rates(Fixture *fixture, bool coupled)
{
    const double *stiffness = fixture->stiffness, *damping = fixture->damping;
    const BlockRig *rig = &fixture->built.rig;
    const State *seen = &fixture->built.seen;
    int32_t n = fixture->free_count, all = rig->bulk.dof_count, size = 2 * n + CONTACTS;
    double *a = hand_matrix(size, size), *vectors = hand_matrix(size, size);
    double *work = hand_matrix((int32_t)dense_eigen_work(size), 1);
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
        a[v * size + v] -= force *
                           slope_of(mu_by_speed, law, speed, seen->theta[i * STATES_MAX], h);
        a[theta * size + v] =
            -d * force * slope_of(mu_by_state, law, seen->theta[i * STATES_MAX], speed, by_state);
        a[v * size + theta] = d *
                              slope_of(rate_by_speed, law, speed, seen->theta[i * STATES_MAX], h);
        a[theta * size + theta] =
            slope_of(rate_by_state, law, seen->theta[i * STATES_MAX], speed, by_state);
        double mu = d * rates_at(law, speed, seen->theta[i * STATES_MAX]).mu / rig->bulk.mass[k];
        for (int32_t j = 0; coupled && j < n; j++) {
            int64_t from = (int64_t)fixture->free[j] * all + rig->interface.dofs[t + 1];
            a[(int64_t)j * size + v] -= mu * stiffness[from];
            a[(int64_t)(n + j) * size + v] -= mu * damping[from];
        }
    }
    assert_true(dense_eigen_general(a, size, fixture->re, fixture->im, vectors, work));
    free(a), free(vectors), free(work);
    return size;
}

// The largest |lambda| with Re lambda >= 0; 0: all decays.
static double fastest_growth(Fixture *fixture)
{
    double fastest = 0;
    int32_t count = find_rates(fixture, false);
    for (int32_t k = 0; k < count; k++)
        if (fixture->re[k] >= 0) fastest = fmax(fastest, hypot(fixture->re[k], fixture->im[k]));
    return fastest;
}

// Of all with |lambda| from `low` to `high` the largest Re lambda/|lambda|; real: of these alone.
static double widest(const Fixture *fixture, int32_t count, double low, double high, bool real)
{
    double most = -1;
    for (int32_t k = 0; k < count; k++) {
        double size = hypot(fixture->re[k], fixture->im[k]);
        if (size < low || size > high || (real && fixture->im[k] != 0)) continue;
        most = fmax(most, fixture->re[k] / size);
    }
    return most;
}

TEST(test_what_grows_is_resolved)
{
    static Fixture fixture;
    fixture_build(1, 0.1, &fixture);
    int32_t held = 0, growing = 0, refused = 0, rightly = 0;
    for (int32_t trial = 0; trial < TRIALS; trial++) {
        randomise(&fixture);
        list_free(&fixture);
        double fastest = fastest_growth(&fixture);
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
    fixture_destroy(&fixture);
}

// On ranges of rungs. What grows more slowly than these is not asked about.
TEST(test_what_oscillates_is_narrow)
{
    static Fixture fixture;
    Error err = {0};
    fixture_build(1e3, 1e-3, &fixture);
    Certificate *certificate = &fixture.built.certificate;
    State *seen = &fixture.built.seen;
    Ladder *ladder = &fixture.built.ladder;
    int32_t last = ladder->rung_count - 1, cleared = 0, growing = 0, refused = 0, rightly = 0;
    int32_t excluded = 0, slower = 0, real = 0;
    assert_non_null(ladder_rung(ladder, 0, &err));
    assert_non_null(ladder_rung(ladder, last, &err));
    for (int32_t trial = 0; trial < TRIALS; trial++) {
        randomise(&fixture);
        list_free(&fixture);
        RungRange range = {random_index(&fixture.random, last - 1), last + 1};
        double low = 1 / ladder_reach(ladder, range.first), high = 1 / ladder_reach(ladder, last);
        double growth = log_between(&fixture.random, 1.1, 1e3), ratio = log(growth) / M_PI;
        int32_t count = find_rates(&fixture, false);
        double wide = widest(&fixture, count, low, high, false);
        double allowed = ratio / sqrt(1 + ratio * ratio);
        bool less = certificate_oscillates_less(certificate, seen, ladder, range, growth);
        if (less && !(wide < allowed + 1e-5)) fail_msg("trial %d: %g, %g", trial, wide, allowed);
        cleared += less;
        growing += less && wide > 0;
        refused += !less;
        rightly += !less && wide >= allowed;
        count = find_rates(&fixture, true);
        bool none = certificate_excludes_runaway(certificate, seen, ladder, range);
        if (none && widest(&fixture, count, low, high, true) > 0) fail_msg("trial %d", trial);
        excluded += none;
        slower += none && widest(&fixture, count, 1e-12, low, true) > 0;
        real += !none && widest(&fixture, count, low, high, true) > 0;
    }
    print_message("%d cleared, of them %d grow; %d refused, %d rightly\n", cleared, growing,
                  refused, rightly);
    print_message("%d without a real rate, %d of them with a slower one; %d rightly refused\n",
                  excluded, slower, real);
    assert_true(cleared > TRIALS / 5 && growing > 5 && rightly > TRIALS / 20);
    assert_true(excluded > TRIALS / 5 && slower > 10 && real > TRIALS / 20);
    fixture_destroy(&fixture);
}

// How far the nearest rate is, relative.
static double distance_to(const Fixture *fixture, int32_t count, GrowthRate rate)
{
    double nearest = INFINITY, size = hypot(rate.re, rate.im);
    for (int32_t k = 0; k < count; k++)
        nearest = fmin(nearest, hypot(fixture->re[k] - rate.re, fixture->im[k] - rate.im));
    return nearest / size;
}

// Slow ones of the states and fast ones of waves. 3e-4: derivatives of laws are differences here
// (one of 800 is 1.3e-4 off).
TEST(test_rates_with_memory)
{
    static Fixture fixture;
    Error err = {0};
    fixture_build(1, 0.1, &fixture);
    GrowthDef def = {.slowest = 1e-5, .fastest = 20};
    randomise(&fixture);   // so that the laws are ones with memory
    Growth *growth = growth_create(&fixture.built.rig.block, &def, &err);
    assert_non_null(growth);
    int32_t compared = 0, grows = 0, real = 0;
    for (int32_t trial = 0; trial < TRIALS / 4; trial++) {
        randomise(&fixture);
        list_free(&fixture);
        GrowthRates found;
        int32_t count = find_rates(&fixture, true), rightmost = 0;
        assert_true(growth_rates(growth, &fixture.built.seen, &found, &err));
        for (int32_t k = 0; k < found.count; k++)
            if (!(distance_to(&fixture, count, found.rate[k]) < 3e-4))
                fail_msg("trial %d: %g + %g i", trial, found.rate[k].re, found.rate[k].im);
        for (int32_t k = 0; k < count; k++)
            if (fixture.re[k] > fixture.re[rightmost] || k == 0) rightmost = k;
        double re = fixture.re[rightmost], size = hypot(re, fixture.im[rightmost]);
        compared += found.count;
        if (!(re > 0) || size > def.fastest || size < def.slowest) continue;
        assert_true(found.count > 0);
        assert_near("the fastest", found.rate[0].re, re, 1e-4 * size);
        grows++;
        real += fixture.im[rightmost] == 0;
    }
    print_message("%d rates compared; %d states grow, %d of them real\n", compared, grows, real);
    assert_true(compared > TRIALS / 4 && grows > 20 && real > 5);
    growth_destroy(growth);
    fixture_destroy(&fixture);
}
