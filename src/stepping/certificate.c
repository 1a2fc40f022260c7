// SPDX-License-Identifier: GPL-2.0-or-later
// DESIGN 4.5: a large implicit step damps what grows in place of showing it, so that truncation
// error alone would step over the instability; these are the tests that say where that cannot
// happen. Each comes down to one Cholesky or LU factorisation of a matrix of |F| rows, F the
// unknowns that move. The header has the derivations.
#include "stepping/certificate.h"

#include "base/clock.h"
#include "base/dense.h"
#include "base/memory.h"

#include <math.h>

// s m + k/s at the best of the s of rungs that double is at most this times 2 sqrt(m k):
// (sqrt 2 + 1/sqrt 2)/2.
// Rungs double, and the worst s lies half way between two in log s:
static const double BETWEEN_RUNGS = 1.0606601717798212;

// Where powers begin at least this part is along the vector that they tend to: it weakens most, and
// they begin with all that weakens.
static const double START_PART = 1e-6;

// A load that changes by less than this part in a power of the iteration has settled.
static const double SETTLED = 1e-6;

// block is borrowed. S_C is condensed from C alone, lifted as C may be singular in the interface's
// own motion (bulk/interface_operator), once for all states.
bool certificate_create(const Block *block, Certificate *certificate, Error *err)
{
    *certificate =
        (Certificate){.interface = block->interface, .law = block->law, .rod = block->rod};
    int64_t count = block->interface->count;
    certificate->matrix = NEW_ARRAY(double, count *count, err);
    certificate->weakening = NEW_ARRAY(double, count, err);
    certificate->damper = NEW_ARRAY(double, count, err);
    certificate->vector = NEW_ARRAY(double, count, err);
    certificate->moving = NEW_ARRAY(int32_t, count, err);
    certificate->pivots = NEW_ARRAY(int32_t, count, err);
    if (!error_is_clean(err)) return false;
    OperatorTerms terms = {.damping = 1, .lift = true, .schur_only = true};
    certificate->damping = interface_operator_create(block->system, terms, err);
    // Without viscosity (or with eta1 = 0) there is nothing that could certify a weakening slip.
    if (err->code == ERROR_COMPUTE) error_clear(err);
    return error_is_clean(err) &&
           (!certificate->damping ||
            contact_matrix_create(interface_operator_schur(certificate->damping), (int32_t)count,
                                  &certificate->damping_contact, err));
}

void certificate_destroy(Certificate *certificate)
{
    contact_matrix_destroy(&certificate->damping_contact);
    interface_operator_destroy(certificate->damping);
    memory_free(certificate->matrix);
    memory_free(certificate->weakening);
    memory_free(certificate->damper);
    memory_free(certificate->vector);
    memory_free(certificate->moving);
    memory_free(certificate->pivots);
    *certificate = (Certificate){0};
}

// Fills F, W and the dampers; says whether anything weakens at all.
// moving [*moving_count] in the interface's order; W and dampers beside it. weakening of the rod is
// 0.
static bool list_moving(Certificate *certificate, const State *state, int32_t *moving_count)
{
    const Interface *interface = certificate->interface;
    int32_t count = 0;
    bool weakens = false;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(i), n = interface_normal(i);
        if (!status_slips(state->status[i])) continue;
        double weakening = -friction_slope(certificate->law, fabs(state->slip_rate[t])) *
                           state->reaction[n];
        certificate->damper[count] = 0;
        certificate->moving[count] = t;
        certificate->weakening[count++] = weakening;
        if (weakening > 0) weakens = true;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        double softness = certificate->rod->softness[j];
        if (state->rod_touches[j] && softness == 0) continue;
        certificate->damper[count] = state->rod_touches[j] ? certificate->rod->lag / softness : 0;
        certificate->moving[count] = interface_rod(interface, j);
        certificate->weakening[count++] = 0;
    }
    *moving_count = count;
    return weakens;
}

// S with open nodes condensed out; NULL where they alone are singular in it.
static const double *close_operator(const State *state, ContactMatrix *matrix)
{
    return contact_matrix_close(matrix, state->status, state->contact_count);
}

// part S + (1 - part) S_C - W on F, part < 1; rung: of S, NULL where part is 0.
// true: positive definite. Only lower triangles are filled, as Cholesky reads no more. Where
// nothing weakens no factorisation is done, nor counted. Parts of condensed operators are less than
// their parts condensed: with open nodes the test is a little stricter between its ends.
static bool is_definite(Certificate *certificate, const State *state, ContactMatrix *rung,
                        double part)
{
    int32_t count = 0;
    if (!list_moving(certificate, state, &count)) return true;   // S itself is never indefinite
    const double *damping = NULL, *own = NULL;
    if (certificate->damping) damping = close_operator(state, &certificate->damping_contact);
    if (part > 0) own = close_operator(state, rung);
    if (!damping || (part > 0 && !own)) return false;
    int64_t size = certificate->interface->count;
    for (int32_t b = 0; b < count; b++) {
        int64_t column = size * certificate->moving[b];
        double *out = certificate->matrix + (int64_t)count * b;
        for (int32_t a = b; a < count; a++) {
            int64_t entry = column + certificate->moving[a];
            out[a] = (1 - part) * damping[entry] + (part > 0 ? part * own[entry] : 0);
        }
        out[b] += certificate->damper[b] - certificate->weakening[b];
    }
    certificate->checks++;
    return dense_cholesky(certificate->matrix, count);
}

bool certificate_holds(Certificate *certificate, const State *state)
{
    double started = clock_seconds();
    bool holds = is_definite(certificate, state, NULL, 0);
    certificate->seconds += clock_seconds() - started;
    return holds;
}

// matrix = (S_t + sign(v) mu S_n)[F,F], the pressure that follows slip included; returns |F|, or -1
// where there is no such matrix.
// Unsymmetric: row of a slipping tangent plus s mu times the row of its normal; W is left for the
// caller to subtract, who may need the matrix without it.
static int32_t fill_coupled(Certificate *certificate, const State *state, ContactMatrix *rung)
{
    int32_t count = 0;
    const double *closed = close_operator(state, rung);
    if (!closed) return -1;
    list_moving(certificate, state, &count);
    int64_t size = certificate->interface->count;
    for (int32_t a = 0; a < count; a++) {
        int32_t row = certificate->moving[a];
        const double *own = closed + size * row, *normal = own;   // symmetric
        double mu = 0;
        if (row < 2 * certificate->interface->contact_count) {
            mu = status_direction(state->status[row / 2]) *
                 friction_coefficient(certificate->law, fabs(state->slip_rate[row]));
            normal = closed + size * interface_normal(row / 2);
        }
        for (int32_t b = 0; b < count; b++) {
            int32_t column = certificate->moving[b];
            certificate->matrix[(int64_t)b * count + a] = own[column] + mu * normal[column];
        }
        certificate->matrix[(int64_t)a * count + a] += certificate->damper[a];
    }
    certificate->checks++;
    return count;
}

// det J > 0
// The sign of det J is that of the product of U's diagonal and of the row swaps: the determinant
// itself would overflow.
static bool coupled_is_positive(Certificate *certificate, const State *state, ContactMatrix *rung)
{
    int32_t count = fill_coupled(certificate, state, rung);
    if (count < 0) return false;
    for (int64_t a = 0; a < count; a++)
        certificate->matrix[a * count + a] -= certificate->weakening[a];
    return dense_lu(certificate->matrix, count, certificate->pivots) &&
           dense_lu_sign(certificate->matrix, count, certificate->pivots) > 0;
}

// growth > 1. part: a = cos(arctan(pi/log g)) of the header, written as ratio/sqrt(1 + ratio^2),
// ratio = log g/pi, and less by what s between the rungs may hide.
bool certificate_swings_less(Certificate *certificate, const State *state, ContactMatrix *rung,
                             double growth)
{
    double started = clock_seconds(), ratio = log(growth) / M_PI;
    double part = ratio / sqrt(1 + ratio * ratio) / BETWEEN_RUNGS;
    bool less = is_definite(certificate, state, rung, part);
    certificate->seconds += clock_seconds() - started;
    return less;
}

// Powers of ((S_t + sign(v) mu S_n)[F,F])^-1 W.
// W takes all but J out of the vector before each solve. SETTLED is enough to tell the load from 1.
// On short steps mass decides, nodes bear nearly the same and powers settle slowly, far below 1:
// there, and where the vector turns, its growth over all n powers bounds the load, as load^n times
// START_PART is at most |x_n|/|x_0|. The bound is up to START_PART^(-1/n), 7 %, too large.
static double largest_load(Certificate *certificate, const State *state, ContactMatrix *rung)
{
    enum { POWERS_MAX = 200 };
    int32_t count = fill_coupled(certificate, state, rung);
    double *x = certificate->vector, load = INFINITY;
    if (count < 0 || !dense_lu(certificate->matrix, count, certificate->pivots)) return INFINITY;
    for (int32_t a = 0; a < count; a++) x[a] = certificate->weakening[a] > 0 ? 1 : 0;
    double norm = sqrt(dense_dot(x, x, count)), logarithm = 0;   // of |x_n|/|x_0|
    if (norm == 0) return 0;
    for (int32_t power = 0; power < POWERS_MAX; power++) {
        double before = load;
        for (int32_t a = 0; a < count; a++) x[a] *= certificate->weakening[a] / norm;
        dense_lu_solve(certificate->matrix, count, certificate->pivots, x);
        load = norm = sqrt(dense_dot(x, x, count));
        if (fabs(load - before) <= SETTLED * load) return load;
        logarithm += log(load);
    }
    return fmax(load, exp((logarithm - log(START_PART)) / POWERS_MAX));
}

double certificate_load(Certificate *certificate, const State *state, ContactMatrix *rung)
{
    double started = clock_seconds();
    double load = largest_load(certificate, state, rung);
    certificate->seconds += clock_seconds() - started;
    return load;
}

bool certificate_step_resolves(Certificate *certificate, const State *state, ContactMatrix *rung)
{
    double started = clock_seconds();
    bool resolves = coupled_is_positive(certificate, state, rung);
    certificate->seconds += clock_seconds() - started;
    return resolves;
}
