// SPDX-License-Identifier: GPL-2.0-or-later
// With x = [u; w/s], w = lambda u, the shifted inverse maps x = [a; b] to [y - a/s; y] where
//
//     (A - W) y = K a/s^2 - M b,   A = s M + C + K/s,  friction rows combined as in P,
//
// and its eigenvalues are theta = 1/(lambda - s). Held unknowns are 0 throughout. K has the springs
// of soft rod nodes and the machine's.
//
// A state's unknowns are [u; w/s], 2 dof_count of them: w is scaled by s so that both halves have
// one unit. Behind them stands the way R of a rod on a spring, which has no mass and hence no w:
// the soft ends of its strip are led by it. Last, where friction remembers, z of each slipping
// tangent: what friction remembers of its slip, a way that fades, dz/dt = v - fading z, so that
// friction falls by memory z. Its part c of x comes back as (s y - c)/(s + fading), and to the
// right side is added -memory c/(s (s + fading)); W is W(s). Of several states each has its z, its
// theta' over a scale of its own; (s - g_theta)^-1 stands for 1/(s + fading). The stretches of the
// materials' branches are the last, e = (s y - c)/(s + 1/tau), and add K_k c/(s (s + 1/tau_k)). Of
// each shift's space only pairs whose residual is below RESIDUAL_LIMIT are believed; neighbouring
// shifts see some of them twice, and keep_rate drops the second.
#include "stepping/growth.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "friction/friction_response.h"
#include "stepping/moving_set.h"

#include <math.h>
#include <string.h>

// Shifts of the scan from one of Arnoldi's to the next, whose spaces overlap; vectors of a space.
enum { STRIDE = 3, VECTORS_LIMIT = 40 };
static const double RESIDUAL_LIMIT =
    1e-8;   // of an eigenpair that is believed: |P u| against its terms
static const double SAME_RATE = 1e-6;   // two shifts saw one rate, relative: such agree to 1e-7,
    // others differ by 1e-4
static const double NO_RATE = 1e-7;   // |theta| s below it is 0: of a rod, which has no mass, or of
    // motions so stiff that y and a/s differ by rounding

struct Growth {
    BulkOperator *system;   // not owned, like the next
    const Interface *interface;
    bool on_spring;   // the rod has a way of its own
    int32_t states;   // of a node, at most
    const Spectrum *spectrum;   // of the materials' branches; not owned
    int32_t shift_count;
    double shift[GROWTH_SHIFTS_MAX];   // s, 1/time
    InterfaceOperator *at[GROWTH_SHIFTS_MAX];   // A; owned, like all that follows
    MovingSet moving;   // of the state asked about
    double *matrix;   // [interface_count^2] of the moving unknowns
    int32_t *pivots;   // [interface_count]
    double *step;   // [interface_count]
    double *g, *border;   // [interface_count]
    double *rhs, *image, *sum;   // [dof_count]
    double *basis;   // [state_size * (VECTORS_LIMIT + 1)] orthonormal
    double *eigen_work;   // [DENSE_EIGEN_WORK(VECTORS_LIMIT)]
    double *mode_re, *mode_im, *real_mode;   // [interface_count]
    double projected[(VECTORS_LIMIT + 1) * VECTORS_LIMIT];   // Hessenberg
    double square[VECTORS_LIMIT * VECTORS_LIMIT], ritz[VECTORS_LIMIT * VECTORS_LIMIT];
    double theta_re[VECTORS_LIMIT], theta_im[VECTORS_LIMIT], dots[VECTORS_LIMIT];
};

static int64_t state_size(const Growth *growth)
{
    return 2 * (int64_t)growth->system->dof_count + growth->on_spring +
           (int64_t)growth->states * growth->interface->count +
           (int64_t)growth->spectrum->count * growth->system->dof_count;
}

// The range begins at the slowest oscillation of the block, a quarter wave over its length, and
// ends at about c over the distance of two nodes: length/contact_count.
GrowthDef growth_def(double length, double speed, int32_t contact_count)
{
    return (GrowthDef){.slowest = speed / (4 * length), .fastest = speed * contact_count / length};
}

// One operator for each s, factored here and never again: they know nothing of the state, whose W
// is subtracted on the interface. The basis is the largest array: 41 vectors of twice the reduced
// bulk's size.
Growth *growth_create(const Block *block, const GrowthDef *def, Error *err)
{
    Growth *growth = NEW_ARRAY(Growth, 1, err);
    if (!growth) goto cleanup;
    growth->system = block->system;
    growth->interface = block->interface;
    growth->spectrum = bulk_operator_spectrum(block->system);
    growth->on_spring = block->system->machine.stiffness > 0;
    growth->states = friction_states(block->friction, block->interface->contact_count);
    TRY(moving_set_create(block, &growth->moving, err));
    int64_t m = growth->interface->count, n = growth->system->dof_count;
    growth->matrix = NEW_ARRAY(double, m *m, err);
    growth->pivots = NEW_ARRAY(int32_t, m, err);
    growth->step = NEW_ARRAY(double, m, err);
    growth->g = NEW_ARRAY(double, m, err);
    growth->border = NEW_ARRAY(double, m, err);
    growth->rhs = NEW_ARRAY(double, n, err);
    growth->image = NEW_ARRAY(double, n, err);
    growth->sum = NEW_ARRAY(double, n, err);
    growth->basis = NEW_ARRAY(double, state_size(growth) * (VECTORS_LIMIT + 1), err);
    growth->eigen_work = NEW_ARRAY(double, DENSE_EIGEN_WORK(VECTORS_LIMIT), err);
    growth->mode_re = NEW_ARRAY(double, m, err);
    growth->mode_im = NEW_ARRAY(double, m, err);
    growth->real_mode = NEW_ARRAY(double, m, err);
    if (!error_is_clean(err)) goto cleanup;
    for (double s = def->slowest; growth->shift_count < GROWTH_SHIFTS_MAX; s *= 2) {
        int32_t k = growth->shift_count++;
        growth->shift[k] = s;
        OperatorTerms terms = {.mass = s, .damping = 1, .stiffness = 1 / s};
        TRY((growth->at[k] = interface_operator_create(block->system, terms, err)));
        if (s >= def->fastest) break;
    }
cleanup:
    if (error_is_clean(err)) return growth;
    growth_destroy(growth);
    return NULL;
}

void growth_destroy(Growth *growth)
{
    if (!growth) return;
    for (int32_t k = 0; k < GROWTH_SHIFTS_MAX; k++) interface_operator_destroy(growth->at[k]);
    double *arrays[] = {growth->matrix,  growth->step,    growth->g,         growth->border,
                        growth->rhs,     growth->image,   growth->basis,     growth->eigen_work,
                        growth->mode_re, growth->mode_im, growth->real_mode, growth->sum};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) memory_free(arrays[k]);
    moving_set_destroy(&growth->moving);
    memory_free_all(growth->pivots, growth);
}

// --- the scan -----------------------------------------------------------------------------------

// ratio >= 1: some s > 0 is a real growth rate with the pressure held. At an end of the range no
// parabola is fitted.
GrowthScan growth_scan(Growth *growth, const State *state)
{
    MovingSet *moving = &growth->moving;
    double ratio[GROWTH_SHIFTS_MAX] = {0}, octaves, *matrix = growth->matrix;
    int32_t best = 0, count = growth->shift_count;
    for (int32_t k = 0; k < count; k++) {
        double reach = 1 / growth->shift[k];
        moving_set_find(moving, state, true);
        moving_set_settle(moving, reach);
        moving_set_gather(moving, interface_operator_schur(growth->at[k]), 1, 0, matrix);
        moving_set_turn(moving, false, matrix);
        moving_set_add_dampers(moving, reach, matrix);
        ratio[k] = INFINITY;   // where S cannot be factored
        if (dense_lu(matrix, moving->count, growth->pivots))
            ratio[k] = weakening_ratio(moving, matrix, growth->pivots, 1e-12, growth->step);
        if (ratio[k] > ratio[best]) best = k;
    }
    GrowthScan scan = {.ratio = ratio[best], .rate = growth->shift[best]};
    if (best == 0 || best == count - 1) return scan;
    scan.ratio = weakening_ratio_top(ratio + best - 1, &octaves);
    scan.rate *= exp2(octaves);
    return scan;
}

// --- the eigenproblem ---------------------------------------------------------------------------

// The z of x: [states] of each row.
static double *memories_of(const Growth *growth, const double *x)
{
    return (double *)x + 2 * (int64_t)growth->system->dof_count + growth->on_spring;
}

// The stretches of branch k in x: [dof_count], behind all else.
static double *stretch_of(const Growth *growth, const double *x, int32_t k)
{
    return memories_of(growth, x) + (int64_t)growth->states * growth->interface->count +
           (int64_t)k * growth->system->dof_count;
}

// to = shifted inverse of from; both [state_size], distinct. Held unknowns come out as 0, as they
// come in: the border is set so.
static bool apply_inverse(Growth *growth, int32_t k, const double *from, double *to, Error *err)
{
    BulkOperator *system = growth->system;
    const Interface *interface = growth->interface;
    const Spectrum *spectrum = growth->spectrum;
    const MovingSet *moving = &growth->moving;
    double *step = growth->step, *rhs = growth->rhs, *sum = growth->sum, *image = growth->image;
    int32_t n = system->dof_count;
    double s = growth->shift[k];
    const double *a = from, *b = from + n, *c;
    double rod = growth->on_spring ? from[2 * (int64_t)n] : 0, square = s * s;

    // The right side in the bulk: K a/s^2 - M b, and what the branches are stretched by,
    // sum_k K_k c_k/(s (s + 1/tau_k)).
    bulk_operator_apply(system, BULK_MASS, b, rhs);
    bulk_operator_apply(system, BULK_STIFFNESS, a, image);
    for (int32_t j = 0; j < n; j++) rhs[j] = image[j] / square - rhs[j];
    for (int32_t j = 0; j < spectrum->shape_count; j++) {
        memset(sum, 0, (size_t)n * sizeof *sum);
        for (int32_t l = 0; l < spectrum->count; l++) {
            double factor = spectrum->share[l][j] / (s * (s + 1 / spectrum->time[l]));
            c = stretch_of(growth, from, l);
            for (int32_t i = 0; i < n; i++) sum[i] += factor * c[i];
        }
        bulk_operator_apply(system, bulk_shape(j), sum, image);
        for (int32_t i = 0; i < n; i++) rhs[i] += image[i];
    }
    interface_operator_pull(growth->at[k], system->machine.stiffness * rod / square);
    TRY(interface_operator_condense(growth->at[k], rhs, growth->g, err));

    // The moving unknowns' rows of it, with springs of soft rod nodes and what friction remembers.
    for (int32_t r = 0; r < moving->count; r++) {
        const MovingUnknown *row = &moving->list[r];
        double way = a[system->interface_dofs[row->unknown]] - rod;   // of soft nodes
        step[r] = growth->g[row->unknown] + row->spring * way / square;
        if (row->normal >= 0) step[r] += row->friction * growth->g[row->normal];
    }
    moving_set_turn_vector(moving, false, step);
    c = memories_of(growth, from);
    for (int32_t r = 0; moving->remembers && r < moving->count; r++, c += growth->states) {
        const MovingUnknown *row = &moving->list[r];
        if (row->node >= 0)
            step[r] += friction_respond(&moving->rates[row->node], s, 0, c, NULL) / s;
        else
            step[r] -= row->memory * *c / (s * (s + row->fading));
    }

    // Their velocities, and by these what friction remembers then.
    dense_lu_solve(growth->matrix, moving->count, growth->pivots, step);
    double *z = memories_of(growth, to);
    c = memories_of(growth, from);
    memset(z, 0, (size_t)growth->states * (size_t)interface->count * sizeof *z);
    for (int32_t r = 0; growth->states > 0 && r < moving->count;
         r++, c += growth->states, z += growth->states) {
        const MovingUnknown *row = &moving->list[r];
        if (row->node >= 0)
            friction_respond(&moving->rates[row->node], s, step[r], c, z);
        else if (row->memory != 0)
            *z = (s * step[r] - *c) / (s + row->fading);
    }
    moving_set_turn_vector(moving, true, step);

    // Velocities and displacements of all unknowns.
    memset(growth->border, 0, (size_t)interface->count * sizeof(double));
    for (int32_t r = 0; r < moving->count; r++) growth->border[moving->list[r].unknown] = step[r];
    double own = interface_operator_release(growth->at[k], growth->border);
    TRY(interface_operator_expand(growth->at[k], growth->border, to + n, err));
    for (int32_t j = 0; j < interface->count; j++)
        to[n + system->interface_dofs[j]] = growth->border[j];
    for (int32_t j = 0; j < n; j++) to[j] = to[n + j] - a[j] / s;

    // Rod nodes that are held go the rod's way to the last bit: what they would fall behind by
    // rounding is an eigenvector of its own, with theta = -1/s.
    if (growth->on_spring) to[2 * (int64_t)n] = own - rod / s;
    for (int32_t j = 0; growth->on_spring && j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j), r = 0;
        while (r < moving->count && moving->list[r].unknown != x) r++;
        if (r == moving->count) to[system->interface_dofs[x]] = own - rod / s;
    }

    // Stretches of the branches, by these velocities.
    for (int32_t l = 0; l < spectrum->count; l++) {
        double *e = stretch_of(growth, to, l), rate = 1 / spectrum->time[l];
        c = stretch_of(growth, from, l);
        for (int32_t i = 0; i < n; i++) e[i] = (s * to[n + i] - c[i]) / (s + rate);
    }
cleanup:
    return error_is_clean(err);
}

// Makes `x` orthogonal to the first `count` vectors, twice (once loses digits); dots: what was
// taken off. Returns what is left of its length, and scales it to 1.
static double orthogonalise(Growth *growth, int32_t count, double *x, double *dots)
{
    int32_t size = (int32_t)state_size(growth);
    DenseView basis = {growth->basis, size, count};
    memset(dots, 0, (size_t)count * sizeof(double));
    for (int32_t pass = 0; pass < 2; pass++) {
        dense_apply_transposed(basis, x, 1, 0, growth->dots);
        dense_apply(basis, growth->dots, -1, 1, x);
        for (int32_t j = 0; j < count; j++) dots[j] += growth->dots[j];
    }
    double norm = sqrt(dense_dot(x, x, size));
    for (int32_t j = 0; j < size && norm > 0; j++) x[j] /= norm;
    return norm;
}

// Fills `projected` [VECTORS_LIMIT + 1 rows]; *count: the dimension reached, *rest: its last
// residual. Arnoldi: column j of `projected` has the products of step j, below its diagonal the
// length of what was new.
static bool build_basis(Growth *growth, int32_t k, int32_t *count, double *rest, Error *err)
{
    const int32_t *dofs = growth->system->interface_dofs;
    const MovingSet *moving = &growth->moving;
    int64_t size = state_size(growth), rows = VECTORS_LIMIT + 1;
    double *seed = growth->basis + size;

    // The first vector: what an uneven slip brings about.
    memset(seed, 0, (size_t)size * sizeof(double));
    for (int32_t j = 0; j < growth->system->dof_count; j++)
        seed[j] = 1e-3 * (1 + 0.5 * cos(1.7 * j));
    for (int32_t j = 0; j < growth->interface->count; j++) seed[dofs[j]] = 0;
    for (int32_t r = 0; r < moving->count; r++) growth->step[r] = 1 + 0.5 * cos(1.3 * r);
    moving_set_turn_vector(moving, false, growth->step);   // nothing of what is held
    moving_set_turn_vector(moving, true, growth->step);
    for (int32_t r = 0; r < moving->count; r++)
        seed[dofs[moving->list[r].unknown]] = growth->step[r];
    TRY(apply_inverse(growth, k, seed, growth->basis, err));
    orthogonalise(growth, 0, growth->basis, growth->projected);

    memset(growth->projected, 0, sizeof growth->projected);
    for (*count = 0; *count < VECTORS_LIMIT;) {
        int32_t j = (*count)++;
        double *next = growth->basis + size * (j + 1), *column = growth->projected + rows * j;
        TRY(apply_inverse(growth, k, growth->basis + size * j, next, err));
        double length = sqrt(dense_dot(next, next, (int32_t)size));
        *rest = orthogonalise(growth, j + 1, next, column);
        if (!(*rest > 1e-13 * length)) {   // the space is invariant: all of it is exact
            *rest = 0;
            break;
        }
        column[j + 1] = *rest;
    }
cleanup:
    return error_is_clean(err);
}

// u on the interface of a Ritz vector, from one column of `ritz`.
static void lift_mode(const Growth *growth, int32_t count, const double *column, double *mode)
{
    int64_t size = state_size(growth);
    for (int32_t m = 0; m < growth->interface->count; m++) {
        const double *entry = growth->basis + growth->system->interface_dofs[m];
        double sum = 0;
        for (int32_t j = 0; j < count; j++) sum += entry[size * j] * column[j];
        mode[m] = sum;
    }
}

// Largest slip 1, real and positive; im may be NULL.
// A mode is known up to a complex factor: this one makes modes of neighbouring states comparable.
static void scale_mode(const Growth *growth, double *re, double *im)
{
    int32_t largest = 0;
    double square = 0;
    int32_t dim = growth->interface->dim;
    for (int32_t t = 0; t < dim * growth->interface->contact_count; t++) {
        if (dof_axis(dim, t) == dim - 1) continue;
        double here = re[t] * re[t] + (im ? im[t] * im[t] : 0);
        if (here > square) {
            square = here;
            largest = t;
        }
    }
    if (square == 0) return;
    double c = re[largest] / square, d = im ? im[largest] / square : 0;   // times conj/|.|^2
    for (int32_t m = 0; m < growth->interface->count; m++) {
        double x = re[m], y = im ? im[m] : 0;
        re[m] = x * c + y * d;
        if (im) im[m] = y * c - x * d;
    }
}

// Keeps lambda where it is new and among the rightmost; returns its place or -1. A shift far from
// it, after those that are near, knows it less well.
static int32_t keep_rate(GrowthRates *rates, GrowthRate found, double shift)
{
    int32_t place = 0;
    double same = SAME_RATE * hypot(found.re, found.im) +
                  RESIDUAL_LIMIT * hypot(found.re - shift, found.im);
    for (int32_t k = 0; k < rates->count; k++) {
        if (hypot(rates->rate[k].re - found.re, rates->rate[k].im - found.im) <= same) return -1;
        if (rates->rate[k].re >= found.re) place = k + 1;
    }
    if (place >= GROWTH_KEPT) return -1;
    if (rates->count < GROWTH_KEPT) rates->count++;
    for (int32_t k = rates->count - 1; k > place; k--) rates->rate[k] = rates->rate[k - 1];
    rates->rate[place] = found;
    return place;
}

// theta of largest modulus belong to the lambda nearest to s, and converge first. rest * last
// component of the Ritz vector is the residual of the pair.
static bool rates_near_shift(Growth *growth, int32_t k, GrowthRates *rates, Error *err)
{
    MovingSet *moving = &growth->moving;
    const double *schur = interface_operator_schur(growth->at[k]);
    int32_t count = 0;
    double rest = 0, s = growth->shift[k];
    int64_t rows = VECTORS_LIMIT + 1;
    size_t bytes = (size_t)growth->interface->count * sizeof(double);

    // LU of the moving unknowns' rows of A - W, the friction rows combined.
    moving_set_gather(moving, schur, 1, 0, growth->matrix);
    moving_set_couple(moving, schur, growth->matrix);
    moving_set_turn(moving, false, growth->matrix);
    moving_set_add_dampers(moving, 1 / s, growth->matrix);
    moving_set_subtract_weakening(moving, 1 / s, growth->matrix);
    if (!dense_lu(growth->matrix, moving->count, growth->pivots))
        return true;   // s is itself a rate; other shifts see it

    // Its space, and the eigenvalues of what it makes of the inverse.
    TRY(build_basis(growth, k, &count, &rest, err));
    for (int32_t j = 0; j < count; j++)
        memcpy(growth->square + (int64_t)count * j, growth->projected + rows * j,
               (size_t)count * sizeof(double));
    if (!dense_eigen_general(growth->square, count, growth->theta_re, growth->theta_im,
                             growth->ritz, growth->eigen_work))
        FAIL(err, ERROR_COMPUTE, "the growth rates near %g were not found", s);

    // Pairs that have converged: the rightmost, and the largest that is real, with their modes.
    for (int32_t j = 0; j < count; j++) {
        bool pair = growth->theta_im[j] != 0;
        double x = growth->theta_re[j], y = growth->theta_im[j], square = x * x + y * y;
        const double *re = growth->ritz + (int64_t)count * j, *im = pair ? re + count : NULL;
        double last = hypot(re[count - 1], pair ? im[count - 1] : 0);
        if (pair) j++;
        if (!(rest * last <= RESIDUAL_LIMIT * sqrt(square))) continue;
        if (s * sqrt(square) < NO_RATE) continue;
        // lambda = s + 1/theta; of a pair the one with im > 0 is kept. It came by theta with
        // im > 0; lambda with im > 0 has the conjugate vector.
        GrowthRate found = {.re = s + x / square, .im = fabs(y) / square};
        if (keep_rate(rates, found, s) == 0) {
            lift_mode(growth, count, re, growth->mode_re);
            memset(growth->mode_im, 0, bytes);
            if (im) lift_mode(growth, count, im, growth->mode_im);
            for (int32_t m = 0; m < growth->interface->count; m++) growth->mode_im[m] *= -1;
            scale_mode(growth, growth->mode_re, growth->mode_im);
        }
        if (found.im == 0 && found.re > rates->real.re) {
            rates->real = found;
            lift_mode(growth, count, re, growth->real_mode);
            scale_mode(growth, growth->real_mode, NULL);
            rates->real_mode = growth->real_mode;
        }
    }
cleanup:
    return error_is_clean(err);
}

bool growth_rates(Growth *growth, const State *state, GrowthRates *rates, Error *err)
{
    *rates = (GrowthRates){.mode_re = growth->mode_re, .mode_im = growth->mode_im};
    moving_set_find(&growth->moving, state, true);
    for (int32_t k = 0; k < growth->shift_count; k += STRIDE)
        TRY(rates_near_shift(growth, k, rates, err));
cleanup:
    return error_is_clean(err);
}
