// SPDX-License-Identifier: GPL-2.0-or-later
// Small disturbances of slip in space: the matrix of what moves against finite differences of
// friction, the certificate against eigenvalues of matrices condensed by hand, growth rates against
// LAPACK's of the whole block.
#include "base/memory.h"
#include "space_rig.h"
#include "stepping/certificate.h"
#include "stepping/growth.h"

typedef struct Fixture {
    BlockRig rig;
    State seen;
    double *schur;   // [count^2] of C alone, by hand
} Fixture;

static void fixture_build(Fixture *fixture)
{
    Error err = {0};
    SpaceDef shape = {.kind = ELEMENT_HEX8, .cells = {2, 2, 1}, .size = {1, 0.8, 0.5}};
    RigDef def = rig_def();
    def.rod_width = 0;
    space_rig_build(&shape, &def, (double[]){0, 0, -0.003}, &fixture->rig);
    const Interface *interface = &fixture->rig.interface;
    assert_true(state_create(&fixture->rig.system, interface, &fixture->seen, &err));
    double *c = rig_dense(&fixture->rig, fixture->rig.bulk.damping);
    fixture->schur = hand_matrix(interface->count, interface->count);
    hand_schur(c, fixture->rig.bulk.dof_count, interface->dofs, interface->count, fixture->schur);
    free(c);
}

static void fixture_destroy(Fixture *fixture)
{
    free(fixture->schur);
    state_destroy(&fixture->seen);
    rig_destroy(&fixture->rig);
}

// Friction against slip in any direction, most of it slower than v_c.
static void random_state(Random *random, double pressure, bool open, Fixture *fixture)
{
    double v_c = fixture->rig.law.critical_velocity;
    for (int32_t i = 0; i < fixture->rig.interface.contact_count; i++) {
        double angle = random_between(random, 0, 2 * M_PI),
               p = pressure * random_between(random, 0.2, 1);
        double speed = v_c * random_between(random, 0.1, 1.2), *r = fixture->seen.reaction + 3 * i;
        uint8_t status = (uint8_t)random_index(random, 4);
        if (!open && status == CONTACT_OPEN) status = CONTACT_STICK;
        double mu =
            status == CONTACT_OPEN ? 0 : friction_coefficient(NODE_OF(&fixture->rig.law), speed);
        for (int32_t c = 0; c < 2; c++) {
            double along = c == 0 ? cos(angle) : sin(angle);
            fixture->seen.slip_rate[3 * i + c] = status == CONTACT_STICK ? 0 : speed * along;
            r[c] = -mu * p * along;
        }
        r[2] = status == CONTACT_OPEN ? 0 : p;
        fixture->seen.status[i] =
            status_slips(status) ? status_of_slip(fixture->seen.slip_rate[3 * i]) : status;
    }
}

// Moving unknowns, by hand: tangents of slipping nodes, all of open nodes.
static int32_t list_moving(const Fixture *fixture, int32_t *moving)
{
    int32_t count = 0;
    for (int32_t k = 0; k < 3 * fixture->rig.interface.contact_count; k++) {
        uint8_t status = fixture->seen.status[k / 3];
        if (status == CONTACT_OPEN || (status_slips(status) && k % 3 < 2)) moving[count++] = k;
    }
    return count;
}

// mu(s) r_n v/s of node i, its component c, at other velocities and pressure.
static double friction_force(const Fixture *fixture, const double *v, double pressing, int32_t c)
{
    double speed = hypot(v[0], v[1]);
    return friction_coefficient(NODE_OF(&fixture->rig.law), speed) * pressing * v[c] / speed;
}

// Column of the derivative of r_t + mu(s) r_n v/s at unknown k by one of unknown l, with r = S v,
// by central differences of friction. coupled: r_n follows, too.
static double by_differences(const Fixture *fixture, const double *schur, int32_t k, int32_t l,
                             bool coupled)
{
    int32_t size = fixture->rig.interface.count, n = 3 * (k / 3) + 2, c = k % 3;
    double value = schur[(int64_t)l * size + k], difference[2] = {0}, h = 1e-9;
    if (!status_slips(fixture->seen.status[k / 3])) return value;
    for (int side = 0; side < 2; side++) {
        const double *at = fixture->seen.slip_rate + 3 * (k / 3);
        double v[] = {at[0], at[1]}, step = side ? h : -h;
        if (l / 3 == k / 3 && l % 3 < 2) v[l % 3] += step;
        double pressing = fixture->seen.reaction[n];
        if (coupled) pressing += schur[(int64_t)l * size + n] * step;
        difference[side] = friction_force(fixture, v, pressing, c);
    }
    return value + (difference[1] - difference[0]) / (2 * h);
}

// x, y of each slipping node's two rows become along and across: columns likewise.
static void turn_by_hand(const Fixture *fixture, const int32_t *moving, int32_t count, double *a)
{
    for (int32_t p = 0; p < count; p++) {
        int32_t i = moving[p] / 3;
        if (!status_slips(fixture->seen.status[i]) || moving[p] % 3 != 0) continue;
        const double *v = fixture->seen.slip_rate + 3 * i;
        double angle = atan2(v[1], v[0]), x = cos(angle), y = sin(angle);
        for (int32_t q = 0; q < count; q++) {
            double *one = &a[q * count + p], *two = one + 1, was = *one;
            *one = x * was + y * *two;
            *two = x * *two - y * was;
        }
        for (int32_t q = 0; q < count; q++) {
            double *one = &a[p * count + q], *two = one + count, was = *one;
            *one = x * was + y * *two;
            *two = x * *two - y * was;
        }
    }
}

TEST(test_differences)
{
    Random random = {.state = 3};
    Error err = {0};
    Fixture fixture;
    MovingSet set;
    fixture_build(&fixture);
    assert_true(moving_set_create(&fixture.rig.block, &set, &err));
    double expected[27 * 27], matrix[27 * 27], lower[27 * 27];
    for (int32_t trial = 0; trial < 60; trial++) {
        int32_t moving[27], count;
        random_state(&random, 1e-3, true, &fixture);
        moving_set_find(&set, &fixture.seen, true);
        count = list_moving(&fixture, moving);
        assert_int_equal(set.count, count);
        for (int32_t p = 0; p < count; p++)
            for (int32_t q = 0; q < count; q++)
                expected[q * count + p] =
                    by_differences(&fixture, fixture.schur, moving[p], moving[q], true);
        turn_by_hand(&fixture, moving, count, expected);
        moving_set_gather(&set, fixture.schur, 1, 0, matrix);
        moving_set_couple(&set, fixture.schur, matrix);
        moving_set_turn(&set, false, matrix);
        moving_set_add_dampers(&set, 0, matrix);
        moving_set_subtract_weakening(&set, 0, matrix);
        double scale = dense_max_abs(expected, count * count);
        assert_all_near("derivative", matrix, expected, count * count, 1e-6 * scale);
        moving_set_gather_symmetric(&set, fixture.schur, lower);
        moving_set_turn(&set, true, lower);
        moving_set_add_dampers(&set, 0, lower);
        moving_set_subtract_weakening(&set, 0, lower);
        for (int32_t q = 0; q < count; q++)
            for (int32_t p = q; p < count; p++)
                assert_near("symmetric part", lower[q * count + p],
                            0.5 * (matrix[q * count + p] + matrix[p * count + q]), 1e-12 * scale);
    }
    moving_set_destroy(&set);
    fixture_destroy(&fixture);
}

// The least eigenvalue of S_C with friction's derivative on what moves says what the certificate
// says. Damping across slip decides some: without it a third more would be refused.
TEST(test_certificate)
{
    Random random = {.state = 4};
    Error err = {0};
    Fixture fixture;
    Certificate certificate;
    fixture_build(&fixture);
    assert_true(certificate_create(&fixture.rig.block, &certificate, &err));
    int32_t held = 0, cases = 0;
    for (int32_t trial = 0; trial < 400; trial++) {
        double a[27 * 27], values[27];
        int32_t moving[27], count;
        random_state(&random, random_between(&random, 0.1, 1) * 4e-4, true, &fixture);
        count = list_moving(&fixture, moving);
        for (int32_t p = 0; p < count; p++)
            for (int32_t q = 0; q < count; q++)
                a[q * count + p] =
                    by_differences(&fixture, fixture.schur, moving[p], moving[q], false);
        if (count == 0) continue;
        hand_eigenvalues(a, count, values);
        if (fabs(values[0]) < 1e-6 * values[count - 1]) continue;   // of differences
        // From one random state to the next sweeps of S_C may pass one that nothing holds, which
        // counts as a no; the second time they begin anew.
        bool holds = certificate_holds(&certificate, &fixture.seen, 0) ||
                     certificate_holds(&certificate, &fixture.seen, 0);
        if (certificate.moving.weakens) assert_int_equal(holds, values[0] > 0);
        held += holds && certificate.moving.weakens;
        cases += certificate.moving.weakens;
    }
    print_message("%d of %d certified\n", held, cases);
    assert_true(cases > 200 && held > 40 && held < cases - 40);
    certificate_destroy(&certificate);
    fixture_destroy(&fixture);
}

// The rates of M u'' + (C + friction) u' + K u = 0 of all that is free, its rows with the pressure
// that follows slip: the largest real part, and the largest real rate.
static void rates_by_hand(const Fixture *fixture, double *largest, double *real)
{
    const Bulk *bulk = &fixture->rig.bulk;
    const Interface *interface = &fixture->rig.interface;
    int32_t n = bulk->dof_count, free_count = 0;
    int32_t *free_dof = calloc((size_t)n, sizeof *free_dof), *at = calloc((size_t)n, sizeof *at);
    for (int32_t dof = 0; dof < n; dof++) at[dof] = -1;
    for (int32_t k = 0; k < interface->count; k++) at[interface->dofs[k]] = k;
    for (int32_t dof = 0; dof < n; dof++) {
        int32_t k = at[dof];
        uint8_t status = k < 0 ? CONTACT_OPEN : fixture->seen.status[k / 3];
        if (status == CONTACT_OPEN || (status_slips(status) && k % 3 < 2))
            free_dof[free_count++] = dof;
    }
    double *parts[] = {rig_dense(&fixture->rig, bulk->stiffness),
                       rig_dense(&fixture->rig, bulk->damping)};
    int32_t size = 2 * free_count;
    double *a = hand_matrix(size, size);
    for (int32_t p = 0; p < free_count; p++) {
        int32_t dof = free_dof[p], k = at[dof];
        bool slips = k >= 0 && status_slips(fixture->seen.status[k / 3]);
        const double *v = slips ? fixture->seen.slip_rate + 3 * (k / 3) : NULL;
        double pressing = slips ? fixture->seen.reaction[3 * (k / 3) + 2] : 0;
        double mu = slips ? friction_force(fixture, v, 1, k % 3) : 0;
        int32_t normal = slips ? interface->dofs[3 * (k / 3) + 2] : dof;
        for (int32_t q = 0; q < free_count; q++)
            for (int32_t part = 0; part < 2; part++) {
                double value = parts[part][(int64_t)free_dof[q] * n + dof] +
                               mu * parts[part][(int64_t)free_dof[q] * n + normal];
                int32_t l = at[free_dof[q]];
                if (slips && part == 1 && l >= 0 && l / 3 == k / 3) {
                    double more[] = {v[0], v[1]}, less[] = {v[0], v[1]};
                    more[l % 3] += 1e-9;
                    less[l % 3] -= 1e-9;
                    value += (friction_force(fixture, more, pressing, k % 3) -
                              friction_force(fixture, less, pressing, k % 3)) /
                             2e-9;
                }
                a[(int64_t)(q + part * free_count) * size + free_count + p] = -value /
                                                                              bulk->mass[dof];
            }
        a[(int64_t)(free_count + p) * size + p] = 1;
    }
    double *re = hand_matrix(size, 1), *im = hand_matrix(size, 1),
           *vectors = hand_matrix(size, size);
    double *work = calloc((size_t)DENSE_EIGEN_WORK(size), sizeof *work);
    assert_true(dense_eigen_general(a, size, re, im, vectors, work));
    *largest = -INFINITY;
    *real = 0;
    for (int32_t j = 0; j < size; j++) {
        *largest = fmax(*largest, re[j]);
        if (im[j] == 0) *real = fmax(*real, re[j]);
    }
    void *all[] = {free_dof, at, parts[0], parts[1], a, re, im, vectors, work};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
}

TEST(test_growth)
{
    Random random = {.state = 5};
    Error err = {0};
    Fixture fixture;
    fixture_build(&fixture);
    GrowthDef def = growth_def(1, 1.1, 9);
    Growth *growth = growth_create(&fixture.rig.block, &def, &err);
    assert_non_null(growth);
    int32_t grows = 0, runs_away = 0;
    for (int32_t trial = 0; trial < 25; trial++) {
        GrowthRates rates;
        double largest, real;
        random_state(&random, random_between(&random, 0.2, 1) * 2e-3, false, &fixture);
        rates_by_hand(&fixture, &largest, &real);
        assert_true(growth_rates(growth, &fixture.seen, &rates, &err));
        if (largest > 0.1 && largest < 30) {
            assert_near("largest", rates.rate[0].re, largest, 1e-5 * largest);
            grows++;
        }
        if (real > 0.1 && real < 30) {
            assert_near("real", rates.real.re, real, 1e-5 * real);
            runs_away++;
        }
    }
    print_message("%d grow, %d run away\n", grows, runs_away);
    assert_true(grows > 5 && runs_away > 5);
    growth_destroy(growth);
    fixture_destroy(&fixture);
}

// Slip of speed 0 is the limit of ever slower slip: friction holds its direction. Each number of
// the state at rest is that of the same state at 1e-7 v_c, where the damper across is large enough
// and rounding is not yet.
TEST(test_rest_is_slowest_slip)
{
    Random random = {.state = 6};
    Error err = {0};
    Fixture fixture;
    Certificate certificate;
    ContactMatrix level = {0};
    fixture_build(&fixture);
    int32_t size = fixture.rig.interface.count, compared = 0, turned = 0;
    GrowthDef def = growth_def(1, 1.1, 9);
    Growth *growth = growth_create(&fixture.rig.block, &def, &err);
    assert_non_null(growth);
    assert_true(certificate_create(&fixture.rig.block, &certificate, &err));
    assert_true(contact_matrix_create(fixture.schur, size, &level, &err));
    for (int32_t trial = 0; trial < 40; trial++) {
        double ratio[2], load[2];
        GrowthRates rates[2];
        bool holds[2];
        random_state(&random, random_between(&random, 0.2, 1) * 2e-3, false, &fixture);
        for (int32_t k = 0; k < size; k++) fixture.seen.slip_rate[k] *= 1e-7;
        for (int at = 0; at < 2; at++) {
            if (at == 1) memset(fixture.seen.slip_rate, 0, (size_t)size * sizeof(double));
            ratio[at] = certificate_ratio(&certificate, &fixture.seen, &level, 1);
            holds[at] = certificate_holds(&certificate, &fixture.seen, 0);
            load[at] = growth_scan(growth, &fixture.seen).ratio;
            assert_true(growth_rates(growth, &fixture.seen, &rates[at], &err));
        }
        turned += certificate.moving.turned_count;
        assert_near("ratio", ratio[1], ratio[0], 1e-5 * ratio[0]);
        assert_near("load", load[1], load[0], 1e-5 * load[0]);
        assert_int_equal(holds[1], holds[0]);
        if (rates[0].count == 0 || rates[0].rate[0].re < 0.1 || rates[0].rate[0].re > 30) continue;
        assert_near("rate", rates[1].rate[0].re, rates[0].rate[0].re, 1e-4 * rates[0].rate[0].re);
        compared++;
    }
    print_message("%d rates compared, %d nodes at rest\n", compared, turned);
    assert_true(compared > 10 && turned > 100);
    contact_matrix_destroy(&level);
    growth_destroy(growth);
    certificate_destroy(&certificate);
    fixture_destroy(&fixture);
}
