// SPDX-License-Identifier: GPL-2.0-or-later
// Growth rates against a dense eigensolver of the whole companion form, a rigid block's rate, with
// memory Ruina's, and the exact dispersion relation of a shear column.
#include "stepping/growth.h"

#include "algebra/dense.h"
#include "block_mesh.h"
#include "reduction/reduction.h"
#include "dense_by_hand.h"
#include "own_laws.h"

#include <complex.h>

typedef double complex Complex;

// --- a block, its interface and a state ---------------------------------------------------------

typedef struct Case {
    Mesh mesh;
    Bulk bulk;
    Interface interface;
    ReducedBulk reduced;
    BulkOperator system;
    FrictionLaw law;
    Friction friction;   // everywhere by that law
    Rod rod;
    double stiffness;   // of the machine; 0: rigid
    State state;
    Growth *growth;
} Case;

static void case_build_block(Case *test, const BlockDef *def, const Material *material)
{
    Error err = {0};
    dense_use_one_thread();
    block_build(def, &test->mesh);
    Materials materials = materials_of(material);
    assert_true(bulk_create(&test->mesh, &test->bulk, &err) &&
                spectrum_find(&materials, 2, &test->bulk.spectrum, &err) &&
                bulk_assemble(&test->mesh, material, &test->bulk, &err));
    InterfaceDef where = {.has_rod = true,
                          .rod_name = "rod",
                          .rod_height = def->height / 2,
                          .rod_width = def->height / def->nz * 1.1};
    if (!interface_build(&test->mesh, &where, &test->interface, &err)) fail_msg("%s", err.message);
}

static void case_open(Case *test, GrowthDef def)
{
    Error err = {0};
    const Interface *interface = &test->interface;
    if (!test->system.dof_count)
        assert_true(bulk_operator_create(&test->bulk, test->mesh.position, interface->dofs,
                                         interface->count, &test->system, &err));
    test->friction = FRICTION_OF(&test->law);
    Block block = {.system = &test->system,
                   .interface = interface,
                   .friction = &test->friction,
                   .rod = &test->rod};
    test->system.machine =
        (Machine){.stiffness = test->stiffness, .first = 2 * interface->contact_count};
    assert_true(rod_build(interface, ROD_PUSHES, 0, &test->rod, &err));
    test->rod.stiffness = test->stiffness;
    assert_true(state_create(&test->system, interface, &test->state, &err));
    memset(test->state.rod_touches, 1, (size_t)interface->rod_count);
    test->growth = growth_create(&block, &def, &err);
    assert_non_null(test->growth);
}

static void case_close(Case *test)
{
    growth_destroy(test->growth);
    rod_destroy(&test->rod);
    state_destroy(&test->state);
    bulk_operator_destroy(&test->system);
    reduced_bulk_destroy(&test->reduced);
    interface_destroy(&test->interface);
    bulk_destroy(&test->bulk);
    mesh_destroy(&test->mesh);
}

static void slip(State *state, int32_t i, uint8_t status, double rate, double pressing)
{
    state->status[i] = status;
    state->slip_rate[2 * i] = rate * (status == CONTACT_SLIP_FORWARD ? 1 : -1);
    state->reaction[2 * i + 1] = pressing;
}

// --- the reference: all eigenvalues of the companion form ---------------------------------------

static int by_real_part(const void *a, const void *b)
{
    double x = creal(*(const Complex *)a), y = creal(*(const Complex *)b);
    return (x < y) - (x > y);
}

// Nodes that move behind a rod on a spring: all rigid ones that touch it, together. The first
// of them stands for the rod; -1: it does not move.
static int32_t rod_unknown(const Case *test)
{
    for (int32_t j = 0; j < test->interface.rod_count; j++)
        if (test->rod.stiffness > 0 && test->state.rod_touches[j] && test->rod.softness[j] == 0)
            return interface_rod(&test->interface, j);
    return -1;
}

// Ties the rod's rigid nodes together in `unit`, or adds what acts on them up in `image`.
static void tie_rod(const Case *test, double *field, bool sums)
{
    int32_t rod = rod_unknown(test), first = rod < 0 ? 0 : test->system.interface_dofs[rod];
    for (int32_t j = 0; j < test->interface.rod_count; j++) {
        int32_t x = interface_rod(&test->interface, j), dof = test->system.interface_dofs[x];
        if (rod < 0 || x == rod || !test->state.rod_touches[j] || test->rod.softness[j] > 0)
            continue;
        *(sums ? &field[first] : &field[dof]) += field[sums ? dof : first];
    }
}

// Springs and dampers of the strip's soft ends, against the rod, and the machine's.
static void add_springs(const Case *test, BulkTerm term, const double *unit, double *image)
{
    int32_t rod = rod_unknown(test), first = rod < 0 ? 0 : test->system.interface_dofs[rod];
    for (int32_t j = 0; j < test->interface.rod_count; j++) {
        int32_t dof = test->system.interface_dofs[interface_rod(&test->interface, j)];
        double softness = test->rod.softness[j], factor = 0;
        if (softness == 0 || !test->state.rod_touches[j]) continue;
        if (term == BULK_STIFFNESS) factor = 1 / softness;
        if (term == BULK_DAMPING) factor = test->rod.lag[j] / softness;
        double force = factor * (unit[dof] - (rod < 0 ? 0 : unit[first]));
        image[dof] += force;
        if (rod >= 0) image[first] -= force;
    }
    if (rod >= 0 && term == BULK_STIFFNESS) image[first] += test->rod.stiffness * unit[first];
}

// One of M, C, K, dense, with friction rows combined and W taken off C, on the moving unknowns.
static double *moving_matrix(const Case *test, BulkTerm term, const int32_t *moving, int32_t count)
{
    int32_t n = test->system.dof_count;
    const State *state = &test->state;
    double *unit = hand_matrix(n, 1), *image = hand_matrix(n, 1), *out = hand_matrix(count, count);
    for (int32_t b = 0; b < count; b++) {
        memset(unit, 0, (size_t)n * sizeof *unit);
        unit[moving[b]] = 1;
        tie_rod(test, unit, false);
        bulk_operator_apply(&test->system, term, unit, image);
        tie_rod(test, image, true);
        for (int32_t i = 0; i < test->interface.contact_count; i++) {
            if (!status_slips(state->status[i])) continue;
            const int32_t *dofs = test->system.interface_dofs + 2 * i;
            double rate = state->slip_rate[2 * i], mu = test->law.mu_static;
            double slope = (test->law.mu_static - test->law.mu_kinetic) /
                           test->law.critical_velocity;
            mu -= slope * fabs(rate);
            image[dofs[0]] += (rate > 0 ? mu : -mu) * image[dofs[1]];
            if (term == BULK_DAMPING && moving[b] == dofs[0])
                image[dofs[0]] -= slope * state->reaction[2 * i + 1];
        }
        add_springs(test, term, unit, image);
        for (int32_t a = 0; a < count; a++) out[b * count + a] = image[moving[a]];
    }
    free(unit);
    free(image);
    return out;
}

// The rates with im >= 0, rightmost first, into `rates`; returns how many.
static int32_t dense_rates(const Case *test, Complex *rates)
{
    int32_t n = test->system.dof_count, count = 0, *moving = calloc((size_t)n, sizeof *moving);
    const State *state = &test->state;
    for (int32_t dof = 0; dof < n; dof++) {
        bool held = false;
        for (int32_t k = 0; k < test->interface.count; k++) {
            if (test->system.interface_dofs[k] != dof) continue;
            int32_t i = k / 2;
            int32_t j = k - 2 * test->interface.contact_count;
            if (j >= 0)
                held = state->rod_touches[j] && test->rod.softness[j] == 0 &&
                       k != rod_unknown(test);
            else
                held = state->status[i] == CONTACT_STICK ||
                       (status_slips(state->status[i]) && k % 2);
        }
        if (!held) moving[count++] = dof;
    }
    double *m = moving_matrix(test, BULK_MASS, moving, count);
    double *c = moving_matrix(test, BULK_DAMPING, moving, count);
    double *k = moving_matrix(test, BULK_STIFFNESS, moving, count);
    const Spectrum *spectrum = bulk_operator_spectrum(&test->system);
    int32_t branches = spectrum->count, size = (2 + branches) * count, found = 0;
    double *both = hand_matrix(count, size), *companion = hand_matrix(size, size);
    memcpy(both, k, (size_t)(count * count) * sizeof *k);
    memcpy(both + count * count, c, (size_t)(count * count) * sizeof *k);
    for (int32_t j = 0; j < spectrum->shape_count;
         j++) {   // u, u', then the stretch of each branch
        double *shape = moving_matrix(test, BULK_SHAPE + j, moving, count);
        for (int32_t b = 0; b < branches; b++)
            for (int32_t a = 0; a < count * count; a++)
                both[(2 + b) * count * count + a] += spectrum->share[b][j] * shape[a];
        free(shape);
    }
    assert_true(hand_solve(m, count, both, size));
    for (int32_t b = 0; b < size; b++) {
        int32_t branch = b / count - 2;
        if (branch == -1) companion[b * size + b - count] = 1;
        for (int32_t j = 0; branch == -1 && j < branches; j++)
            companion[b * size + b + (1 + j) * count] = 1;
        if (branch >= 0) companion[b * size + b] = -1 / spectrum->time[branch];
        for (int32_t a = 0; a < count; a++) companion[b * size + count + a] = -both[b * count + a];
    }
    double *re = hand_matrix(size, 1), *im = hand_matrix(size, 1), *v = hand_matrix(size, size);
    double *work = hand_matrix((int32_t)DENSE_EIGEN_WORK(size), 1);
    assert_true(dense_eigen_general(companion, size, re, im, v, work));
    for (int32_t j = 0; j < size; j++)
        if (im[j] >= 0) rates[found++] = re[j] + im[j] * I;
    qsort(rates, (size_t)found, sizeof *rates, by_real_part);
    double *all[] = {m, c, k, both, companion, re, im, v, work};
    for (size_t a = 0; a < sizeof all / sizeof *all; a++) free(all[a]);
    free(moving);
    return found;
}

// Every rate found is one of the dense ones, and the rightmost ones are all found, but for those of
// the overdamped bulk that crowd at -E/eta.
static void assert_same_rates(const Case *test, double tolerance)
{
    Error err = {0};
    GrowthRates found;
    Complex *wanted = malloc((size_t)(10 * test->system.dof_count) * sizeof *wanted);
    int32_t count = dense_rates(test, wanted);
    assert_true(growth_rates(test->growth, &test->state, &found, &err));
    for (int32_t k = 0; k < found.count; k++) {
        Complex here = found.rate[k].re + found.rate[k].im * I;
        double nearest = INFINITY;
        for (int32_t j = 0; j < count; j++) nearest = fmin(nearest, cabs(wanted[j] - here));
        if (!(nearest <= tolerance * cabs(here)))
            fail_msg("%g + %g i is no eigenvalue: the nearest is %g off", creal(here), cimag(here),
                     nearest);
    }
    double real = 0;
    for (int32_t k = 0; k < count; k++) {
        if (k < GROWTH_KEPT && creal(wanted[k]) > -0.1) {
            assert_true(k < found.count);
            assert_near("Re lambda", found.rate[k].re, creal(wanted[k]),
                        tolerance * cabs(wanted[k]));
        }
        if (cimag(wanted[k]) == 0 && creal(wanted[k]) > real) real = creal(wanted[k]);
    }
    assert_near("largest real rate", found.real.re, real, tolerance * real);
    free(wanted);
}

static const Material SOFT = {.young = 1, .poisson = 0.34, .density = 1, .eta1 = 1, .eta2 = 1};
static const FrictionLaw LAW = {.kind = FRICTION_LINEAR_WEAKENING,
                                .mu_static = 0.38,
                                .mu_kinetic = 0.1,
                                .critical_velocity = 3.4e-4};

static void set_state(Case *test, double pressure, int32_t slipping)
{
    const Interface *interface = &test->interface;
    State *state = &test->state;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double pressing = pressure * interface->weight[i] * (0.3 + 1.4 * interface->x[i]);
        state->status[i] = CONTACT_STICK;
        state->reaction[2 * i + 1] = pressing;
        double rate = 0.03 * test->law.critical_velocity * (1 + i % 3);
        if (i < slipping) slip(state, i, CONTACT_SLIP_FORWARD, rate, pressing);
    }
}

// From too little weakening to grow to so much that several real rates exist. Returns how many
// states had one.
static int32_t check_block(FrictionLaw law, double length, double pressure, bool reduced,
                           double machine, const Material *material)
{
    Error err = {0};
    Case test = {.law = law};
    BlockDef def = {ELEMENT_Q4,           .nx = 8,          .nz = 5, .length = length,
                    .height = length / 2, .distortion = 0.1};
    case_build_block(&test, &def, material);
    if (reduced) {
        ReductionDef how = {.tolerance = 1e-3,
                            .scales = {1, 2, length * length, 1},
                            .materials = materials_of(material)};
        assert_true(reduction_build(&test.bulk, test.interface.dofs, test.interface.count, &how,
                                    &test.reduced, &err));
        assert_true(bulk_operator_reduce(&test.reduced, 1, 1, &test.system, &err));
    }
    test.stiffness = machine;
    case_open(&test, growth_def(length, 1.06, test.interface.contact_count));
    test.rod.softness[0] = reduced ? 0 : 0.4;   // rigid, or its end within a cell
    for (int32_t j = 0; j < test.interface.rod_count; j++) test.rod.lag[j] = 1.5;
    double factors[] = {0.03, 0.3, 0.7, 1, 2, 2.6};
    int32_t growing = 0;
    for (size_t p = 0; p < sizeof factors / sizeof *factors; p++) {
        for (int32_t slipping = 0; slipping < 9; slipping += 2) {
            GrowthRates found;
            set_state(&test, factors[p] * pressure, slipping);
            assert_same_rates(&test, 1e-6);
            assert_true(growth_rates(test.growth, &test.state, &found, &err));
            growing += found.real.re > 0;
        }
        // A mixed state: backward slip, an open node, a rod node let go.
        double rate = 0.06 * law.critical_velocity;
        slip(&test.state, 3, CONTACT_SLIP_BACKWARD, rate, factors[p] * pressure * length / 8);
        test.state.status[0] = CONTACT_OPEN;
        test.state.rod_touches[0] = 0;
        assert_same_rates(&test, 1e-6);
        test.state.rod_touches[0] = 1;
    }
    case_close(&test);
    return growing;
}

TEST(test_against_dense)
{
    const FrictionLaw glass = {.kind = FRICTION_LINEAR_WEAKENING,
                               .mu_static = 1.2,
                               .mu_kinetic = 0.2,
                               .critical_velocity = 3.9e-7};   // the paper's set B
    for (int32_t reduced = 0; reduced < 2; reduced++) {
        assert_in_range(check_block(LAW, 1, 3e-3, reduced, 0, &SOFT), 3, 27);
        assert_in_range(check_block(glass, 0.04, 2.5e-5, reduced, 0, &SOFT), 2, 27);
    }
    assert_in_range(check_block(LAW, 1, 3e-3, false, 0.1, &SOFT), 3, 27);
}

// Branches are unknowns of their own there.
TEST(test_branches_against_dense)
{
    Material relaxing = SOFT;
    relaxing.branch_count = 2;
    relaxing.branch[0] = (Branch){.time = 0.7, .shear = 0.3, .bulk = 0.1};
    relaxing.branch[1] = (Branch){.time = 2, .shear = 0.5};
    for (int32_t reduced = 0; reduced < 2; reduced++)
        assert_in_range(check_block(LAW, 1, 3e-3, reduced, 0, &relaxing), 1, 27);
}

// A block so stiff that it only shoves: (mu_S - mu_K) P / (rho H v_c), whatever its shape and
// however pressure changes along it. On a spring k, w that rate, they are those of
//
//     s^2 - w s + K(s)/m = 0,    1/K = 1/k + a/(1 + s lag),
//
// a the softness of the strip's ends where all of it is soft.
static double rigid_rate(double w, double mass, double machine, double soft, double lag)
{
    double s = w;
    for (int32_t k = 0; k < 100 && machine > 0; k++)
        s = w - 1 / (1 / machine + soft / (1 + s * lag)) / mass / s;
    return s;
}

static void check_rigid_block(double machine, double softness, double lag)
{
    Error err = {0};
    Material stiff = {.young = 1e9, .poisson = 0.3, .density = 1.7, .eta1 = 1e6, .eta2 = 1e6};
    Case test = {.law = {.kind = FRICTION_LINEAR_WEAKENING,
                         .mu_static = 0.6,
                         .mu_kinetic = 0.2,
                         .critical_velocity = 0.05}};
    BlockDef def = {ELEMENT_Q4, .nx = 2, .nz = 2, .length = 0.8, .height = 0.3};
    case_build_block(&test, &def, &stiff);
    double pressure = 4, rate = (0.6 - 0.2) * pressure / (1.7 * 0.3 * 0.05);
    test.stiffness = machine;
    rate = rigid_rate(rate, 1.7 * 0.3 * 0.8, machine, softness / test.interface.rod_count, lag);
    GrowthDef how = growth_def(0.8, 0.8 * rate, test.interface.contact_count);
    case_open(&test, how);
    memset(test.state.rod_touches, machine > 0, (size_t)test.interface.rod_count);
    for (int32_t j = 0; j < test.interface.rod_count; j++) {
        test.rod.softness[j] = softness;
        test.rod.lag[j] = lag;
    }
    for (int32_t i = 0; i < 3; i++)
        slip(&test.state, i, CONTACT_SLIP_FORWARD, 1e-3, pressure * test.interface.weight[i]);
    GrowthRates rates;
    assert_true(growth_rates(test.growth, &test.state, &rates, &err));
    assert_near("growth rate", rates.rate[0].re, rate, 1e-6 * rate);
    assert_near("it does not oscillate", rates.rate[0].im, 0, 0);
    assert_near("the real one", rates.real.re, rate, 1e-6 * rate);
    for (int32_t i = 0; i < 3; i++) {
        assert_near("all slip alike", rates.mode_re[2 * i], 1, 1e-6);
        assert_near("in one direction", rates.real_mode[2 * i], 1, 1e-6);
        assert_near("none lifts off", rates.mode_re[2 * i + 1], 0, 0);
    }
    // Beyond v_c, and with Coulomb friction, nothing weakens: it only drifts.
    for (int32_t i = 0; i < 3; i++) test.state.slip_rate[2 * i] = 0.06;
    assert_true(growth_rates(test.growth, &test.state, &rates, &err));
    assert_true(rates.real.re < 1e-3 * rate);   // a double root at 0
    assert_near("nothing to bear", growth_scan(test.growth, &test.state).ratio, 0, 0);
    case_close(&test);
}

TEST(test_rigid_block)
{
    check_rigid_block(0, 0, 0);
    check_rigid_block(70, 0, 0);
    check_rigid_block(70, 0.01, 0);
    check_rigid_block(70, 0.01, 0.02);
}

// Ruina's analysis (J. Geophys. Res. 88, 1983) with inertia: a rigid block on a spring k, pressed
// by N, slips steadily at V with rate and state. Its rates are the roots of
//
//     (m s^2 + s a N/V + k) (s + V/D_c) - s b N/D_c = 0,
//
// a pair that decays above k = (b - a) N/D_c + m V^2 b/(a D_c^2) about, and grows below.
static double complex ruina(double complex s, double mass, double spring, double load,
                            const FrictionLaw *law)
{
    double speed = law->reference_velocity, fades = speed / law->slip_distance;
    return (mass * s * s + s * law->direct_effect * load / speed + spring) * (s + fades) -
           s * law->evolution_effect * load / law->slip_distance;
}

static GrowthRate ruina_rate(double spring_part, bool slip_law, double *off)
{
    Error err = {0};
    const double speed = 1e-3, pressure = 4, load = pressure * 0.8, mass = 1.7 * 0.3 * 0.8;
    Material stiff = {.young = 1e7, .poisson = 0.3, .density = 1.7, .eta1 = 1e4, .eta2 = 1e4};
    Case test = {.law = law_with_state((FrictionLaw){.kind = FRICTION_RATE_STATE,
                                                     .slip_distance = 5e-3,
                                                     .evolution_effect = 0.018,
                                                     .direct_effect = 0.012,
                                                     .mu_reference = 0.6,
                                                     .reference_velocity = speed,
                                                     .slip_law = slip_law})};
    const FrictionLaw *law = &test.law;
    BlockDef def = {ELEMENT_Q4, .nx = 2, .nz = 2, .length = 0.8, .height = 0.3};
    case_build_block(&test, &def, &stiff);
    double critical = (law->evolution_effect - law->direct_effect) * load / law->slip_distance;
    test.stiffness = spring_part * critical;
    case_open(&test, (GrowthDef){.slowest = 0.01, .fastest = 10});
    for (int32_t i = 0; i < 3; i++)
        slip(&test.state, i, CONTACT_SLIP_FORWARD, speed, pressure * test.interface.weight[i]);
    GrowthRates rates;
    assert_true(growth_rates(test.growth, &test.state, &rates, &err));
    double complex s = rates.rate[0].re + rates.rate[0].im * I, step = 1e-7 * s;
    double complex here = ruina(s, mass, test.stiffness, load, law);
    *off = cabs(here / (ruina(s + step, mass, test.stiffness, load, law) - here) * step / s);
    case_close(&test);
    return rates.rate[0];
}

// Both evolution laws are one at steady slip.
TEST(test_rate_and_state_on_a_spring)
{
    for (double part = 0.3; part < 2; part += 0.23) {
        double off, aged = 0;
        for (int32_t slip_law = 0; slip_law < 2; slip_law++) {
            GrowthRate rate = ruina_rate(part, slip_law == 1, &off);
            assert_near("off Ruina's rate", off, 0, 1e-6);
            assert_true((rate.re > 0) == (part < 1));
            assert_true(rate.im > 0);
            if (slip_law) assert_near("the same", rate.re, aged, 1e-6 * rate.im);
            aged = rate.re;
        }
    }
}

// --- a shear column -----------------------------------------------------------------------------

enum { LAYERS = 200 };

// One column, sides periodic: u_x alone is sheared, linear elements, lumped mass; u_z of the foot
// hangs on a spring of its own. Contact node: the foot. Rod node: u_x of the top, held.
static void column_build(Case *test, double shear, double eta, double density, double height)
{
    Error err = {0};
    int32_t nodes = LAYERS + 1, n = 2 * nodes;
    double h = height / LAYERS;
    Bulk *bulk = &test->bulk;
    *bulk = (Bulk){.dim = 2, .dof_count = n};
    bulk->pattern.size = n;
    bulk->pattern.start = NEW_ARRAY(int32_t, n + 1, &err);
    bulk->pattern.index = NEW_ARRAY(int32_t, 3 * n, &err);
    bulk->stiffness = NEW_ARRAY(double, 3 * n, &err);
    bulk->damping = NEW_ARRAY(double, 3 * n, &err);
    bulk->mass = NEW_ARRAY(double, n, &err);
    bulk->load = NEW_ARRAY(double, n, &err);
    int32_t entry = 0;
    for (int32_t dof = 0; dof < n; dof++) {
        int32_t node = dof / 2;
        bool along = dof % 2 == 0, end = node == 0 || node == LAYERS;
        bulk->mass[dof] = density * h * (end ? 0.5 : 1);
        for (int32_t other = node - 1; other <= node + 1; other++) {
            if (other < 0 || other > LAYERS || (!along && other != node)) continue;
            double factor = other == node ? (end ? 1 : 2) : -1;
            bulk->pattern.index[entry] = 2 * other + dof % 2;
            bulk->stiffness[entry] = along ? factor * shear / h : 1;
            bulk->damping[entry++] = along ? factor * eta / h : 1;
        }
        bulk->pattern.start[dof + 1] = entry;
    }
    Interface *interface = &test->interface;
    *interface =
        (Interface){.dim = 2, .contact_count = 1, .rod_count = 1, .count = 3, .pad_count = 1};
    interface->dofs = NEW_ARRAY(int32_t, 3, &err);
    interface->x = NEW_ARRAY(double, 1, &err);
    interface->weight = NEW_ARRAY(double, 1, &err);
    interface->dofs[1] = 1;
    interface->dofs[2] = 2 * LAYERS;
    double *position = hand_matrix(n, 1);
    assert_true(bulk_operator_create(bulk, position, interface->dofs, 3, &test->system, &err));
    free(position);
    case_open(test, growth_def(4 * height, sqrt(shear / density), 200));
}

// (G + eta s) q coth(q H) - s w, q = sqrt(rho s^2 / (G + eta s)): zero at a growth rate s.
static Complex column_equation(Complex s, double shear, double eta, double density, double height,
                               double weakening)
{
    Complex modulus = shear + eta * s, q = csqrt(density * s * s / modulus);
    return modulus * q / ctanh(q * height) - s * weakening;
}

// The foot slips under ever more weakening: it rests, oscillates, and runs away, at the exact
// rates.
TEST(test_shear_column)
{
    Error err = {0};
    double poisson = 0.34, shear = 1 / (2 * (1 + poisson)), eta = 0.5, density = 1, height = 0.5;
    Case test = {.law = {.kind = FRICTION_LINEAR_WEAKENING,
                         .mu_static = 0.38,
                         .mu_kinetic = 0.1,
                         .critical_velocity = 3.4e-4}};
    dense_use_one_thread();
    column_build(&test, shear, eta, density, height);
    double slope = 0.28 / 3.4e-4, oscillates = NAN, runs = NAN, overload = NAN;
    for (double weakening = 0.8; weakening < 2.4; weakening += 0.03) {
        GrowthRates rates;
        slip(&test.state, 0, CONTACT_SLIP_FORWARD, 1e-6, weakening / slope);
        assert_true(growth_rates(test.growth, &test.state, &rates, &err));
        GrowthScan scan = growth_scan(test.growth, &test.state);
        Complex s = rates.rate[0].re + rates.rate[0].im * I;
        if (creal(s) > 0 && isnan(oscillates)) oscillates = weakening;
        if (rates.real.re > 0 && isnan(runs)) runs = weakening;
        if (scan.ratio >= 1 && isnan(overload)) overload = weakening;
        if (creal(s) <= 0) continue;
        // The residual over the derivative: how far the exact rate lies.
        Complex step = 1e-6 * s, f = column_equation(s, shear, eta, density, height, weakening);
        Complex slope_f = (column_equation(s + step, shear, eta, density, height, weakening) - f) /
                          step;
        if (fabs(weakening - runs) > 0.05)   // next to a double root nothing is sharp
            assert_near("off the exact rate", cabs(f / slope_f), 0, 2e-4 * cabs(s));
    }
    // The thresholds of REFERENCES 4, leading order: eta/H and eta/H + 2 sqrt(rho G/3).
    assert_near("oscillates from eta/H", oscillates, eta / height, 0.06);
    assert_near("runs away from", runs, eta / height + 2 * sqrt(density * shear / 3), 0.06);
    assert_near("without pressure to couple the scan finds the same", overload, runs, 0.031);
    case_close(&test);
}

// --- the certificate, memory --------------------------------------------------------------------

// The scan's ratio is the factor by which all weakening can be raised until a real rate exists when
// mu P_n is left out; here mu is small, so the exact problem agrees.
TEST(test_scan)
{
    Error err = {0};
    Case test = {.law = {.kind = FRICTION_LINEAR_WEAKENING,
                         .mu_static = 1e-7,
                         .mu_kinetic = 0,
                         .critical_velocity = 1e-4}};
    BlockDef def = {ELEMENT_Q4, .nx = 8, .nz = 4, .length = 1, .height = 0.5};
    case_build_block(&test, &def, &SOFT);
    case_open(&test, growth_def(1, 1.06, test.interface.contact_count));
    GrowthRates rates;
    set_state(&test, 1000, 5);
    GrowthScan scan = growth_scan(test.growth, &test.state);
    assert_true(scan.ratio > 0.1 && scan.rate > 0.1);
    for (int32_t beyond = 0; beyond < 2; beyond++) {
        double pressure = 1000 / scan.ratio * (beyond ? 1.004 : 0.996);
        set_state(&test, pressure, 5);
        assert_near("the ratio is proportional", growth_scan(test.growth, &test.state).ratio,
                    beyond ? 1.004 : 0.996, 1e-9);
        assert_true(growth_rates(test.growth, &test.state, &rates, &err));
        assert_int_equal(rates.real.re > 0, beyond);
    }
    assert_near("born there", rates.real.re, scan.rate, 0.25 * scan.rate);
    case_close(&test);
}

TEST(test_memory)
{
    Error err = {0};
    Case test = {.law = LAW};
    BlockDef def = {ELEMENT_Q4, .nx = 3, .nz = 2, .length = 1, .height = 0.5};
    case_build_block(&test, &def, &SOFT);
    case_open(&test, growth_def(1, 1.06, 4));
    Block block = {.system = &test.system,
                   .interface = &test.interface,
                   .friction = &test.friction,
                   .rod = &test.rod};
    GrowthDef how = growth_def(1, 1.06, 4);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int64_t k = 0; !done; k++) {
        error_clear(&err);
        memory_fail_after(k);
        Growth *growth = growth_create(&block, &how, &err);
        memory_fail_after(-1);
        done = growth != NULL;
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        growth_destroy(growth);
        assert_int_equal(memory_counters().live, live);
    }
    set_state(&test, 3e-3, 3);
    GrowthRates rates;
    assert_true(growth_rates(test.growth, &test.state, &rates, &err));
    int64_t allocations = memory_counters().allocations;
    assert_true(growth_rates(test.growth, &test.state, &rates, &err));
    growth_scan(test.growth, &test.state);
    assert_int_equal(memory_counters().allocations, allocations);
    growth_destroy(NULL);
    case_close(&test);
}
