// SPDX-License-Identifier: GPL-2.0-or-later
// An elastic slab of infinite length that slides as a whole, under rate and state: its growth rates
// and the wavelength from which on disturbances grow, against the exact dispersion relation. The
// slab is periodic: unknowns of its right side are those of its left side, in the assembled
// matrices. Its top is free, so that long waves find it as soft as one likes.
#include "block_rig.h"
#include "own_laws.h"
#include "stepping/growth.h"

#include <complex.h>

typedef double complex Complex;

static const double SPEED = 4e-5, HEIGHT = 0.5, PRESSURE = 0.04;

static FrictionLaw law_of_slab(void)
{
    return law_with_state((FrictionLaw){.kind = FRICTION_RATE_STATE,
                                        .direct_effect = 0.01,
                                        .evolution_effect = 0.025,
                                        .slip_distance = 4e-4,
                                        .mu_reference = 0.4,
                                        .reference_velocity = SPEED});
}

// --- the exact relation -------------------------------------------------------------------------

// 4 x 4 by elimination with pivots.
static Complex determinant(Complex a[4][4])
{
    Complex product = 1;
    for (int32_t c = 0; c < 4; c++) {
        int32_t best = c;
        for (int32_t r = c + 1; r < 4; r++)
            if (cabs(a[r][c]) > cabs(a[best][c])) best = r;
        for (int32_t k = 0; k < 4 && best != c; k++) {
            Complex kept = a[c][k];
            a[c][k] = a[best][k];
            a[best][k] = -kept;
        }
        product *= a[c][c];
        for (int32_t r = c + 1; r < 4; r++) {
            Complex part = a[r][c] / a[c][c];
            for (int32_t k = c; k < 4; k++) a[r][k] -= part * a[c][k];
        }
    }
    return product;
}

// At exp(i q x + s t): 0 at a growth rate s. In the slab P waves, grad exp(i q x +- alpha z), and S
// waves, curl exp(i q x +- beta z); on its top no traction; below u_z = 0 and
// sigma_xz + W(s) s u_x + mu sigma_zz = 0.
static Complex relation(Complex s, double q)
{
    Material material = paper_material();
    Moduli elastic = material_elastic(&material), viscous = material_viscous(&material);
    Complex shear = moduli_shear(elastic) + s * moduli_shear(viscous);
    Complex trace = elastic.trace + s * viscous.trace, axial = 2 * shear + trace;
    Complex inertia = material.density * s * s;
    Complex alpha = csqrt(q * q + inertia / axial), beta = csqrt(q * q + inertia / shear);
    const FrictionLaw law = law_of_slab();
    double fades = SPEED / law.slip_distance;
    Complex weakens = PRESSURE * (law.evolution_effect / law.slip_distance / (s + fades) -
                                  law.direct_effect / SPEED);
    Complex a[4][4];
    for (int32_t k = 0; k < 4; k++) {
        bool pressure = k < 2;
        Complex d = (pressure ? alpha : beta) * (k % 2 ? -1 : 1);   // d/dz
        Complex ux = pressure ? I * q : d, uz = pressure ? d : -I * q;
        Complex sheared = shear * (d * ux + I * q * uz),
                pressed = axial * d * uz + trace * I * q * ux;
        Complex top = cexp(d * HEIGHT - fmax(creal(alpha), creal(beta)) * HEIGHT);
        a[0][k] = sheared * top;
        a[1][k] = pressed * top;
        a[2][k] = uz;
        a[3][k] = sheared + weakens * s * ux + law.mu_reference * pressed;
    }
    return determinant(a);
}

static Complex newton(Complex s, double q, int32_t steps)
{
    for (int32_t k = 0; k < steps; k++) {
        Complex h = 1e-6 * s, here = relation(s, q);
        s -= here / ((relation(s + h, q) - relation(s - h, q)) / (2 * h));
    }
    return s;
}

// --- the mesh -----------------------------------------------------------------------------------

typedef struct Slab {
    Mesh mesh;
    Bulk assembled, bulk;
    Interface interface;
    BulkOperator system;
    FrictionLaw law;
    Friction friction;   // everywhere by that law
    Rod rod;
    State state;
    Growth *growth;
} Slab;

// As a full pattern: A + its image under `place`, which says where each unknown goes.
static void wrap(const Bulk *from, const int32_t *place, int32_t count, const double *values,
                 double *to)
{
    for (int32_t j = 0; j < from->dof_count; j++)
        for (int32_t k = from->pattern.start[j]; k < from->pattern.start[j + 1]; k++)
            to[(int64_t)place[j] * count + place[from->pattern.index[k]]] += values[k];
}

static void slab_wrap(Slab *slab, int32_t nx, int32_t nz)
{
    Error err = {0};
    const Bulk *from = &slab->assembled;
    int32_t count = 2 * nx * (nz + 1), *place = calloc((size_t)from->dof_count, sizeof *place);
    Bulk *bulk = &slab->bulk;
    *bulk = (Bulk){.dim = 2, .dof_count = count, .pattern.size = count};
    bulk->pattern.start = NEW_ARRAY(int32_t, count + 1, &err);
    bulk->pattern.index = NEW_ARRAY(int32_t, count * count, &err);
    bulk->stiffness = NEW_ARRAY(double, count *count, &err);
    bulk->damping = NEW_ARRAY(double, count *count, &err);
    bulk->mass = NEW_ARRAY(double, count, &err);
    bulk->load = NEW_ARRAY(double, count, &err);
    for (int32_t j = 0; j < count; j++) {
        bulk->pattern.start[j + 1] = count * (j + 1);
        for (int32_t k = 0; k < count; k++) bulk->pattern.index[j * count + k] = k;
    }
    double width = slab->mesh.position[2 * nx];
    for (int32_t node = 0; node < from->dof_count / 2; node++) {
        const double *at = slab->mesh.position + 2 * (int64_t)node;
        int32_t i = (int32_t)lround(at[0] / width * nx) % nx;
        int32_t k = (int32_t)lround(at[1] / HEIGHT * nz);
        for (int32_t c = 0; c < 2; c++) {
            place[2 * node + c] = 2 * (nx * k + i) + c;
            bulk->mass[place[2 * node + c]] += from->mass[2 * node + c];
        }
    }
    wrap(from, place, count, from->stiffness, bulk->stiffness);
    wrap(from, place, count, from->damping, bulk->damping);
    free(place);
}

static void slab_build(double length, int32_t nx, int32_t nz, Slab *slab)
{
    Error err = {0};
    BlockDef def = {ELEMENT_Q4, .nx = nx, .nz = nz, .length = length, .height = HEIGHT};
    Material material = paper_material();
    *slab = (Slab){.law = law_of_slab()};
    slab->friction = FRICTION_OF(&slab->law);
    dense_use_one_thread();
    block_build(&def, &slab->mesh);
    assert_true(bulk_create(&slab->mesh, &slab->assembled, &err) &&
                bulk_assemble(&slab->mesh, &material, &slab->assembled, &err));
    slab_wrap(slab, nx, nz);
    Interface *interface = &slab->interface;
    *interface = (Interface){.dim = 2, .contact_count = nx, .count = 2 * nx, .pad_count = 1};
    interface->dofs = NEW_ARRAY(int32_t, 2 * nx, &err);
    interface->x = NEW_ARRAY(double, nx, &err);
    interface->weight = NEW_ARRAY(double, nx, &err);
    for (int32_t k = 0; k < 2 * nx; k++) interface->dofs[k] = k;
    double *position = hand_matrix(slab->bulk.dof_count, 1);
    assert_true(
        bulk_operator_create(&slab->bulk, position, interface->dofs, 2 * nx, &slab->system, &err));
    free(position);
    Block block = {&slab->system, interface, &slab->friction, &slab->rod, NULL};
    assert_true(rod_build(interface, ROD_AWAY, 0, &slab->rod, &err));
    assert_true(state_create(&slab->system, interface, &slab->state, &err));
    for (int32_t i = 0; i < nx; i++) {
        slab->state.status[i] = CONTACT_SLIP_FORWARD;
        slab->state.slip_rate[2 * i] = SPEED;
        slab->state.reaction[2 * i + 1] = PRESSURE * length / nx;
    }
    GrowthDef how = {.slowest = 5e-3, .fastest = 10};
    slab->growth = growth_create(&block, &how, &err);
    assert_non_null(slab->growth);
}

static void slab_destroy(Slab *slab)
{
    growth_destroy(slab->growth);
    state_destroy(&slab->state);
    rod_destroy(&slab->rod);
    bulk_operator_destroy(&slab->system);
    interface_destroy(&slab->interface);
    bulk_destroy(&slab->bulk);
    bulk_destroy(&slab->assembled);
    mesh_destroy(&slab->mesh);
}

// The fastest of the found rates that is next to an exact one of wave number q, of which
// *off is how far it is from that, relative. Waves of -q have the conjugate rates: pressure that
// follows slip tells the two apart.
static GrowthRate rate_of_wave(Slab *slab, double q, double *off)
{
    static const double NEXT = 0.05;   // to the exact one
    Error err = {0};
    GrowthRates found;
    assert_true(growth_rates(slab->growth, &slab->state, &found, &err));
    for (int32_t k = 0; k < found.count; k++)
        for (int32_t sign = -1; sign < 2; sign += 2) {
            Complex s = found.rate[k].re + sign * found.rate[k].im * I;
            *off = cabs(newton(s, q, 8) / s - 1);
            if (found.rate[k].im > 0 && *off < NEXT) return found.rate[k];
        }
    fail_msg("no rate of the wave number %g", q);
    return (GrowthRate){0};
}

static GrowthRate rate_on(double length, int32_t nx, double *off)
{
    Slab slab;
    slab_build(length, nx, nx / 2, &slab);
    GrowthRate rate = rate_of_wave(&slab, 2 * M_PI / length, off);
    slab_destroy(&slab);
    return rate;
}

// Half as long elements are four times as near.
TEST(test_rates_of_a_slab)
{
    int32_t growing = 0;
    for (double length = 2; length < 7; length *= 1.5) {
        double coarse, fine;
        growing += rate_on(length, 12, &coarse).re > 0;
        rate_on(length, 24, &fine);
        assert_near("12 elements", coarse, 0, 0.04);
        assert_near("of second order", fine / coarse, 0.25, 0.01);
    }
    assert_in_range(growing, 2, 3);
}

// From which wavelength on Re s > 0; short waves are held by the slab, long ones are not.
static double critical_on(int32_t nx)
{
    double low = 2, high = 3, off, below = rate_on(low, nx, &off).re, above = INFINITY;
    for (int32_t k = 0; k < 5; k++) {   // by chords
        double middle = k == 0 ? high : low - below * (high - low) / (above - below);
        double rate = rate_on(middle, nx, &off).re;
        *(rate > 0 ? &high : &low) = middle;
        *(rate > 0 ? &above : &below) = rate;
    }
    return low - below * (high - low) / (above - below);
}

TEST(test_critical_wavelength)
{
    double low = 2, high = 3, off;
    GrowthRate start = rate_on(low, 12, &off);
    Complex plus = start.re + start.im * I, minus = conj(plus);
    Complex sign =
        cabs(newton(plus, M_PI, 8) - plus) < cabs(newton(minus, M_PI, 8) - minus) ? plus : minus;
    for (int32_t k = 0; k < 40; k++) {
        double middle = 0.5 * (low + high);
        sign = newton(sign, 2 * M_PI / middle, 12);
        *(creal(sign) > 0 ? &high : &low) = middle;
    }
    double coarse = critical_on(12), fine = critical_on(24), limit = fine + (fine - coarse) / 3;
    print_message("critical wavelength %.5f; %.5f and %.5f on meshes, %.5f in the limit\n", low,
                  coarse, fine, limit);
    assert_near("in the limit of small elements", limit, low, 3e-4 * low);
    assert_near("on 24 elements", fine, low, 6e-3 * low);
}
