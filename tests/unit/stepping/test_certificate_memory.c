// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of friction that remembers against all growth rates of a block, its states
// included, from dense matrices and differences of the laws: where it holds, all that does not
// decay has |lambda| < 1/h; where oscillations are narrow Re lambda < a |lambda|; where runaway is
// excluded no rate is real; growth_rates finds what there is. Pressure follows slip in the last
// two.
#include "base/memory.h"
#include "certificate_rig.h"
#include "dense_by_hand.h"
#include "own_laws.h"
#include "random_numbers.h"
#include "stepping/growth.h"

#include <float.h>

enum { CONTACTS = 5, TRIALS = 400, STATES = 3 };

typedef struct Fixture {
    CertificateRig built;
    bool several;   // laws of one's own with one to three states, in place of those built in
    FrictionLaw laws[CONTACTS];
    FrictionNode nodes[CONTACTS];
    Random random;
    double *stiffness, *damping;   // dense, of the mesh
    int32_t *free, free_count;   // unknowns of the bulk that move
    int32_t *place;   // of an unknown among them; -1: it is held
    double rounding;   // what those may be off by, as eigenvalues of so large a matrix
    double *re, *im;   // [2 free_count + CONTACTS STATES] the rates that find_rates found
} Fixture;

static void fixture_build(double longest, double shortest, bool several, Fixture *fixture)
{
    RigDef def = rig_def();
    *fixture = (Fixture){.random = {1}, .several = several};
    certificate_rig_build(&def, longest, shortest, &fixture->built);
    const BlockRig *rig = &fixture->built.rig;
    int32_t count = rig->bulk.dof_count;
    assert_int_equal(rig->interface.contact_count, CONTACTS);
    fixture->stiffness = rig_dense(rig, rig->bulk.stiffness);
    fixture->damping = rig_dense(rig, rig->bulk.damping);
    fixture->free = calloc((size_t)count, sizeof(int32_t));
    fixture->place = calloc((size_t)count, sizeof(int32_t));
    fixture->re = hand_matrix(2 * count + CONTACTS * STATES, 1);
    fixture->im = hand_matrix(2 * count + CONTACTS * STATES, 1);
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
    FrictionLaw law = {.kind = kinds[k],
                       .mu_static = 0.38,
                       .mu_kinetic = 0.1,
                       .critical_velocity = log_between(random, 1e-4, 1e-2),
                       .slip_distance = log_between(random, 1e-5, 1e-2),
                       .healing_time = log_between(random, 1, 1e3),
                       .healing = log_between(random, 3e-3, 0.1),
                       .direct_effect = log_between(random, 3e-3, 0.03),
                       .mu_reference = 0.3,
                       .reference_velocity = 1e-5,
                       .slip_law = k == 3};
    law.evolution_effect = law.healing;
    return law_with_state(law);
}

// mu = f_0 + a ln(1 + v/V_0) + sum b_k ln(V_0 theta_k/D_k), V_0 = 1e-5. The first state is theta by
// the slip law, which grows by itself below v theta/D = 1/e, all others psi = ln(V_0 theta/D) by
// the ageing law; the others pull at each. Parameters: a, then b, D and the pull of each.
static void several_rates(const AmontonsFriction *given, double speed, double pressure,
                          const double *state, AmontonsFrictionRates *rates)
{
    static const double SLOW = 1e-5;
    const double *own = given->parameters + 1;
    (void)pressure;
    rates->mu = 0.5 + given->parameters[0] * log1p(speed / SLOW);
    rates->mu_speed = given->parameters[0] / (SLOW + speed);
    rates->mu_pressure = 0;
    for (int k = 0; k < rates->states; k++, own += 3) {
        double x = state[k], D = own[1], part = speed * x / D, pull = own[2] * speed / D;
        rates->mu += own[0] * (k == 0 ? log(SLOW * x / D) : x);
        rates->mu_state[k] = own[0] * (k == 0 ? 1 / x : 1);
        rates->rate[k] = k == 0 ? -part * log(part) : (SLOW * exp(-x) - speed) / D;
        rates->rate_speed[k] = k == 0 ? -x / D * (log(part) + 1) : -1 / D;
        for (int j = 0; j < rates->states; j++) {
            rates->rate_state[k][j] = j == k ? 0 : pull;
            if (j == k) continue;
            rates->rate[k] += pull * state[j];
            rates->rate_speed[k] += own[2] / D * state[j];
        }
        rates->rate_state[k][k] = k == 0 ? -speed / D * (log(part) + 1) : -SLOW * exp(-x) / D;
    }
}

// Half of them with states that do not know each other.
static FrictionLaw several_states(Random *random)
{
    FrictionLaw law = {.kind = FRICTION_PLUGIN,
                       .remembers = true,
                       .states = 1 + random_index(random, STATES),
                       .mu_static = 0.5,
                       .mu_kinetic = 0.1,
                       .critical_velocity = 1e-4,
                       .plugin.rates = several_rates};
    double *own = law.plugin.given.parameters, pull = random_index(random, 2) * 0.3;
    *own++ = log_between(random, 3e-3, 0.03);
    for (int32_t k = 0; k < law.states; k++, own += 3) {
        own[0] = random_between(random, -0.01, 0.04);
        own[1] = log_between(random, 1e-5, 1e-2);
        own[2] = pull * random_between(random, -1, 1);
    }
    return law;
}

static void several_start(const FrictionLaw *law, Random *random, double speed, double *state)
{
    const double *own = law->plugin.given.parameters + 1;
    for (int32_t k = 0; k < law->states; k++, own += 3) {
        double off = random_between(random, -1.5, 1.5);
        state[k] = k == 0 ? own[1] / speed * exp(off) : log(1e-5 / speed) + off;
    }
}

// Statuses, slip rates, states and pressures at random; not far from steady slip.
static void randomise(Fixture *fixture)
{
    Random *random = &fixture->random;
    State *seen = &fixture->built.seen;
    const Interface *interface = &fixture->built.rig.interface;
    for (int32_t i = 0; i < CONTACTS; i++) {
        fixture->laws[i] = fixture->several ? several_states(random) : random_law(random);
        int32_t t = interface_tangent(interface, i);
        double speed = log_between(random, 1e-7, 1e-2);
        fixture->nodes[i] = friction_node(&fixture->laws[i], 1);
        double steady =
            fixture->several
                ? 0
                : friction_operations(&fixture->laws[i])->steady(&fixture->laws[i], speed);
        bool forward = random_index(random, 2) == 0;
        seen->status[i] = random_index(random, 4) == 0 ? CONTACT_STICK
                          : forward                    ? CONTACT_SLIP_FORWARD
                                                       : CONTACT_SLIP_BACKWARD;
        seen->slip_rate[t] = seen->status[i] == CONTACT_STICK ? 0 : forward ? speed : -speed;
        seen->theta[i * STATES_MAX] = fixture->laws[i].kind == FRICTION_RATE_STATE
                                          ? steady + random_between(random, -2, 2)
                                          : steady * random_between(random, 0.3, 1);
        if (fixture->several)
            several_start(&fixture->laws[i], random, speed, &seen->theta[i * STATES_MAX]);
        seen->reaction[t + 1] = log_between(random, 1e-4, 3e-3);
    }
    memset(seen->rod_touches, 1, (size_t)interface->rod_count);
    fixture->built.rig.friction = friction_of_nodes(fixture->nodes, CONTACTS);
}

// With laws that remember, as a run has them from the start.
static void fixture_open(double longest, double shortest, bool several, Fixture *fixture)
{
    Error err = {0};
    CertificateRig *built = &fixture->built;
    fixture_build(longest, shortest, several, fixture);
    randomise(fixture);
    fixture->random = (Random){1};
    certificate_destroy(&built->certificate);
    assert_true(certificate_create(&built->rig.block, &built->certificate, &err));
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

// mu (row 0) and the rate of each state by what slip rate (x = 0) or state x - 1 changes: by
// differences.
static void find_slopes(const FrictionNode *node, double speed, const double *theta, int32_t x,
                        double slope[1 + STATES])
{
    double here[1 + STATES_MAX] = {speed}, *at = &here[x], middle;
    FrictionRates rates[2];
    memcpy(here + 1, theta, STATES_MAX * sizeof(double));
    middle = *at;
    bool small = x == 0 || node->law->kind == FRICTION_PLUGIN;   // theta, times of any size
    double h = 1e-4 * fmax(fabs(middle), small && x < 2 ? 0 : 1e-2);
    for (int32_t side = 0; side < 2; side++) {
        *at = middle + (side ? h : -h);
        friction_rates(node, here[0], here + 1, &rates[side]);
    }
    slope[0] = (rates[1].mu - rates[0].mu) / (2 * h);
    for (int32_t k = 0; k < rates[0].states; k++)
        slope[1 + k] = (rates[1].rate[k] - rates[0].rate[k]) / (2 * h);
}

// Adds the friction of node i to y' = A y; its states begin at `theta`.
static void add_friction(const Fixture *fixture, int32_t i, int32_t theta, int32_t size, double *a)
{
    const BlockRig *rig = &fixture->built.rig;
    const State *seen = &fixture->built.seen;
    const FrictionNode *node = &fixture->nodes[i];
    int32_t t = interface_tangent(&rig->interface, i), k = rig->interface.dofs[t];
    int32_t states = node->law->states, v = fixture->free_count + fixture->place[k];
    double d = status_direction(seen->status[i]), slope[1 + STATES];
    double force = seen->reaction[t + 1] / rig->bulk.mass[k], unit[] = {1, 1, 1, 1};
    if (fixture->several) unit[1] = seen->theta[i * STATES_MAX];   // else digits are lost
    for (int32_t x = 0; x <= states; x++) {
        int64_t column = (int64_t)(x == 0 ? v : theta + x - 1) * size;
        find_slopes(node, fabs(seen->slip_rate[t]), &seen->theta[i * STATES_MAX], x, slope);
        a[column + v] -= (x == 0 ? 1 : d) * force * unit[x] * slope[0];
        for (int32_t m = 0; m < states; m++)
            a[column + theta + m] = (x == 0 ? d : 1) * unit[x] / unit[1 + m] * slope[1 + m];
    }
}

// y' = A y, y = (u, v, theta), into re and im; coupled: what slip adds to the pressure changes
// friction. Returns how many.
static int32_t find_rates(Fixture *fixture, bool coupled)
{
    const double *stiffness = fixture->stiffness, *damping = fixture->damping;
    const BlockRig *rig = &fixture->built.rig;
    const State *seen = &fixture->built.seen;
    int32_t n = fixture->free_count, all = rig->bulk.dof_count, size = 2 * n + CONTACTS * STATES;
    double *a = hand_matrix(size, size), *vectors = hand_matrix(size, size);
    double *work = hand_matrix((int32_t)DENSE_EIGEN_WORK(size), 1);
    for (int32_t i = 0; i < n; i++) {
        int32_t k = fixture->free[i];
        a[(int64_t)(n + i) * size + i] = 1;
        for (int32_t j = 0; j < n; j++) {
            int64_t from = (int64_t)fixture->free[j] * all + k;
            a[(int64_t)j * size + n + i] = -stiffness[from] / rig->bulk.mass[k];
            a[(int64_t)(n + j) * size + n + i] = -damping[from] / rig->bulk.mass[k];
        }
    }
    for (int64_t k = 2 * n; k < size; k++) a[k * size + k] = -1;   // of states that nothing moves
    for (int32_t i = 0; i < CONTACTS; i++) {
        if (!status_slips(seen->status[i])) continue;
        add_friction(fixture, i, 2 * n + STATES * i, size, a);
        int32_t t = interface_tangent(&rig->interface, i), k = rig->interface.dofs[t];
        FrictionRates rates;
        friction_rates(&fixture->nodes[i], fabs(seen->slip_rate[t]), &seen->theta[i * STATES_MAX],
                       &rates);
        double mu = status_direction(seen->status[i]) * rates.mu / rig->bulk.mass[k];
        int64_t v = n + fixture->place[k];
        for (int32_t j = 0; coupled && j < n; j++) {
            int64_t from = (int64_t)fixture->free[j] * all + rig->interface.dofs[t + 1];
            a[(int64_t)j * size + v] -= mu * stiffness[from];
            a[(int64_t)(n + j) * size + v] -= mu * damping[from];
        }
    }
    fixture->rounding = 4 * DBL_EPSILON * dense_max_abs(a, size * size);
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

// Largest Re lambda/|lambda| of all with |lambda| from `low` to `high`; real: of these alone.
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

static void check_resolved(bool several)
{
    static Fixture fixture;
    fixture_open(1, 0.1, several, &fixture);
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

TEST(test_what_grows_is_resolved)
{
    check_resolved(false);
    check_resolved(true);
}

// On ranges of levels. What grows more slowly than these is not asked about.
static void check_narrow(bool several)
{
    static Fixture fixture;
    Error err = {0};
    fixture_open(1e3, 1e-3, several, &fixture);
    Certificate *certificate = &fixture.built.certificate;
    State *seen = &fixture.built.seen;
    DtLevels *dt_levels = &fixture.built.dt_levels;
    int32_t last = dt_levels->level_count - 1, cleared = 0, growing = 0, refused = 0, rightly = 0;
    int32_t excluded = 0, slower = 0, real = 0;
    assert_non_null(dt_level_operator(dt_levels, 0, PART_WHOLE, &err));
    assert_non_null(dt_level_operator(dt_levels, last, PART_WHOLE, &err));
    for (int32_t trial = 0; trial < TRIALS; trial++) {
        randomise(&fixture);
        list_free(&fixture);
        LevelRange range = {random_index(&fixture.random, last - 1), last + 1};
        double low = 1 / dt_level_reach(dt_levels, range.first),
               high = 1 / dt_level_reach(dt_levels, last);
        double growth = log_between(&fixture.random, 1.1, 1e3), ratio = log(growth) / M_PI;
        int32_t count = find_rates(&fixture, false);
        double wide = widest(&fixture, count, low, high, false);
        double allowed = ratio / sqrt(1 + ratio * ratio);
        bool less = certificate_oscillates_less(certificate, seen, dt_levels, range, growth);
        if (less && !(wide < allowed + 1e-5)) fail_msg("trial %d: %g, %g", trial, wide, allowed);
        cleared += less;
        growing += less && wide > 0;
        refused += !less;
        rightly += !less && wide >= allowed;
        count = find_rates(&fixture, true);
        bool none = certificate_excludes_runaway(certificate, seen, dt_levels, range);
        if (none && widest(&fixture, count, low, high, true) > 0) fail_msg("trial %d", trial);
        excluded += none;
        slower += none && widest(&fixture, count, 1e-12, low, true) > 0;
        real += !none && widest(&fixture, count, low, high, true) > 0;
    }
    print_message("%d cleared, of them %d grow; %d refused, %d rightly\n", cleared, growing,
                  refused, rightly);
    print_message("%d without a real rate, %d of them with a slower one; %d rightly refused\n",
                  excluded, slower, real);
    assert_true(cleared > TRIALS / 5 && growing > (several ? 0 : 5) && rightly > TRIALS / 20);
    assert_true(excluded > TRIALS / 5 && slower > 10 && real > TRIALS / 20);
    fixture_destroy(&fixture);
}

TEST(test_what_oscillates_is_narrow)
{
    check_narrow(false);
    check_narrow(true);
}

// How far the nearest rate is beyond rounding, relative.
static double distance_to(const Fixture *fixture, int32_t count, GrowthRate rate)
{
    double nearest = INFINITY, size = hypot(rate.re, rate.im);
    for (int32_t k = 0; k < count; k++)
        nearest = fmin(nearest, hypot(fixture->re[k] - rate.re, fixture->im[k] - rate.im));
    return (nearest - fixture->rounding) / size;
}

// Slow ones of the states and fast ones of waves. 3e-4: derivatives of laws are differences here
// (one of 800 is 1.3e-4 off).
static void check_rates(bool several)
{
    static Fixture fixture;
    Error err = {0};
    fixture_open(1, 0.1, several, &fixture);
    GrowthDef def = {.slowest = 1e-5, .fastest = 20};
    Growth *growth = growth_create(&fixture.built.rig.block, &def, &err);
    assert_non_null(growth);
    int32_t compared = 0, grows = 0, real = 0;
    for (int32_t trial = 0; trial < TRIALS / 3; trial++) {
        randomise(&fixture);
        list_free(&fixture);
        GrowthRates found;
        int32_t count = find_rates(&fixture, true), rightmost = 0;
        assert_true(growth_rates(growth, &fixture.built.seen, &found, &err));
        for (int32_t k = 0; k < found.count; k++)
            if (!(distance_to(&fixture, count, found.rate[k]) < 3e-4))
                fail_msg("trial %d: %g + %g i, %g off", trial, found.rate[k].re, found.rate[k].im,
                         distance_to(&fixture, count, found.rate[k]));
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

TEST(test_rates_with_memory)
{
    check_rates(false);
    check_rates(true);
}
