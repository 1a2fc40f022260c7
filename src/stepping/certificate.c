// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/certificate.h"

#include "base/clock.h"
#include "base/dense.h"
#include "base/memory.h"

#include <math.h>

bool certificate_create(const Block *block, Certificate *certificate, Error *err)
{
    *certificate = (Certificate){.interface = block->interface, .law = block->law};
    int64_t count = block->interface->count;
    certificate->matrix = NEW_ARRAY(double, count *count, err);
    certificate->weakening = NEW_ARRAY(double, count, err);
    certificate->moving = NEW_ARRAY(int32_t, count, err);
    certificate->pivots = NEW_ARRAY(int32_t, count, err);
    if (!error_is_clean(err)) return false;
    OperatorTerms terms = {.damping = 1, .lift = true};
    certificate->damping = interface_operator_create(block->system, terms, err);
    // Without viscosity (or with eta1 = 0) there is nothing that could certify a weakening slip.
    if (err->code == ERROR_COMPUTE) error_clear(err);
    return error_is_clean(err);
}

void certificate_destroy(Certificate *certificate)
{
    interface_operator_destroy(certificate->damping);
    memory_free(certificate->matrix);
    memory_free(certificate->weakening);
    memory_free(certificate->moving);
    memory_free(certificate->pivots);
    *certificate = (Certificate){0};
}

// Fills F and W; says whether anything weakens at all.
static bool list_moving(Certificate *certificate, const State *state, int32_t *moving_count)
{
    const Interface *interface = certificate->interface;
    int32_t count = 0;
    bool weakens = false;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(i), n = interface_normal(i);
        if (state->status[i] == CONTACT_STICK) continue;
        double weakening = 0;
        if (status_slips(state->status[i]))
            weakening = -friction_slope(certificate->law, fabs(state->slip_rate[t])) *
                        state->reaction[n];
        certificate->moving[count] = t;
        certificate->weakening[count++] = weakening;
        if (weakening > 0) weakens = true;
        if (state->status[i] != CONTACT_OPEN) continue;
        certificate->moving[count] = n;
        certificate->weakening[count++] = 0;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        if (state->rod_touches[j]) continue;
        certificate->moving[count] = interface_rod(interface, j);
        certificate->weakening[count++] = 0;
    }
    *moving_count = count;
    return weakens;
}

// schur: NULL where the matrix itself is singular.
static bool is_definite(Certificate *certificate, const State *state, const double *schur)
{
    int32_t count = 0;
    if (!list_moving(certificate, state, &count)) return true;   // S itself is never indefinite
    if (!schur) return false;
    int64_t size = certificate->interface->count;
    for (int32_t b = 0; b < count; b++) {
        const double *column = schur + size * certificate->moving[b];
        double *out = certificate->matrix + (int64_t)count * b;
        for (int32_t a = b; a < count; a++) out[a] = column[certificate->moving[a]];
        out[b] -= certificate->weakening[b];
    }
    certificate->checks++;
    return dense_cholesky(certificate->matrix, count);
}

bool certificate_holds(Certificate *certificate, const State *state)
{
    const double *schur = certificate->damping ? interface_operator_schur(certificate->damping)
                                               : NULL;
    double started = clock_seconds();
    bool holds = is_definite(certificate, state, schur);
    certificate->seconds += clock_seconds() - started;
    return holds;
}

// det J > 0, J with the pressure that follows slip.
static bool coupled_is_positive(Certificate *certificate, const State *state, const double *schur)
{
    int32_t count = 0;
    list_moving(certificate, state, &count);
    int64_t size = certificate->interface->count;
    for (int32_t a = 0; a < count; a++) {
        int32_t row = certificate->moving[a];
        const double *own = schur + size * row, *normal = own;   // symmetric
        double mu = 0;
        bool contact = row < 2 * certificate->interface->contact_count;
        if (contact && row % 2 == 0 && status_slips(state->status[row / 2])) {
            mu = status_direction(state->status[row / 2]) *
                 friction_coefficient(certificate->law, fabs(state->slip_rate[row]));
            normal = schur + size * interface_normal(row / 2);
        }
        for (int32_t b = 0; b < count; b++) {
            int32_t column = certificate->moving[b];
            certificate->matrix[(int64_t)b * count + a] = own[column] + mu * normal[column];
        }
        certificate->matrix[(int64_t)a * count + a] -= certificate->weakening[a];
    }
    certificate->checks++;
    return dense_lu(certificate->matrix, count, certificate->pivots) &&
           dense_lu_sign(certificate->matrix, count, certificate->pivots) > 0;
}

bool certificate_step_resolves(Certificate *certificate, const State *state,
                               const InterfaceOperator *rung)
{
    const double *schur = interface_operator_schur(rung);
    double started = clock_seconds();
    bool resolves = is_definite(certificate, state, schur) ||
                    coupled_is_positive(certificate, state, schur);
    certificate->seconds += clock_seconds() - started;
    return resolves;
}
