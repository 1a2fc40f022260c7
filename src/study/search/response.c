// SPDX-License-Identifier: GPL-2.0-or-later
// Response surfaces: Box and Wilson, J. R. Stat. Soc. B 13, 1 (1951). The least misfit by damped
// Gauss-Newton steps (Marquardt, SIAM J. Appl. Math. 11, 431 (1963)), kept within the ranges.
#include "study/search/response.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS_MAX = 200 };
static const double MORE = 1.5;   // designs that count, for each term
static const double RIDGE = 1e-10;   // of a term's own weight: designs on a line leave terms open
static const double DAMPED = 1e-3, DAMPED_MAX = 1e12,
                    SETTLED = 1e-12;   // damping; change of misfit

// --- terms --------------------------------------------------------------------------------------

static int32_t full_terms(int32_t keys)
{
    return 1 + keys + keys * (keys + 1) / 2;
}

// 1, d_k, d_k^2, d_k d_l, as many as there are. slopes: [terms][keys] or NULL.
static void terms_at(const Response *r, const double *place, double *terms, double *slopes)
{
    double d[RESPONSE_KEYS_MAX];
    int32_t n = r->keys, at = 1;
    if (slopes) memset(slopes, 0, (size_t)r->terms * (size_t)n * sizeof *slopes);
    for (int32_t k = 0; k < n; k++) d[k] = (place[k] - r->origin[k]) / r->scale[k];
    terms[0] = 1;
    for (int32_t k = 0; k < n; k++, at++) {
        terms[at] = d[k];
        if (slopes) slopes[at * n + k] = 1 / r->scale[k];
    }
    for (int32_t apart = 0; apart < n; apart++) {   // squares first
        for (int32_t k = 0; k + apart < n && at < r->terms; k++, at++) {
            int32_t l = k + apart;
            terms[at] = d[k] * d[l];
            if (!slopes) continue;
            slopes[at * n + k] += d[l] / r->scale[k];
            slopes[at * n + l] += d[k] / r->scale[l];
        }
    }
}

double response_at(const Response *r, int32_t datum, const double *place)
{
    double terms[RESPONSE_TERMS_MAX];
    terms_at(r, place, terms, NULL);
    return dense_dot(terms, &r->coefficients[(int64_t)datum * r->terms], r->terms);
}

// --- through designs ----------------------------------------------------------------------------

// Coefficients and errors of all results; the factor of the normal equations is the same for all.
static bool solve(const ResponseDef *def, const double *weights, Response *r, Error *err)
{
    int32_t n = r->terms;
    double *rows = NEW_ARRAY(double, (int64_t)def->designs *n, err);
    double *matrix = NEW_ARRAY(double, (int64_t)n *n, err);
    TRY(rows && matrix);
    for (int32_t d = 0; d < def->designs; d++) {
        double *row = &rows[(int64_t)d * n];
        terms_at(r, def->list[d].place, row, NULL);
        for (int32_t k = 0; k < n; k++)
            dense_add_scaled(weights[d] * row[k], row, n, &matrix[k * n]);
    }
    for (int32_t k = 0; k < n; k++) matrix[k * n + k] *= 1 + RIDGE;
    if (!dense_cholesky(matrix, n))
        FAIL(err, ERROR_COMPUTE, "designs do not differ in all keys: there is nothing to fit");
    for (int32_t k = 0; k < r->data; k++) {
        double *b = &r->coefficients[(int64_t)k * n];
        double sum = 0, square = 0, scatter = 0, own = 0;
        for (int32_t d = 0; d < def->designs; d++)
            dense_add_scaled(weights[d] * def->list[d].found[k], &rows[(int64_t)d * n], n, b);
        dense_lower_solve(matrix, n, b);
        dense_lower_solve_transposed(matrix, n, b);
        for (int32_t d = 0; d < def->designs; d++) {
            double off = def->list[d].found[k] - dense_dot(b, &rows[(int64_t)d * n], n);
            sum += weights[d];
            square += weights[d] * weights[d];
            scatter += weights[d] * off * off;
            own += weights[d] * def->list[d].own[k];
        }
        double count = sum * sum / square;   // designs that count
        scatter = count > n ? scatter / sum * count / (count - n) : 0;
        r->own[k] = fmax(own / sum, sqrt(scatter));
    }
cleanup:
    memory_free_all(rows, matrix);
    return error_is_clean(err);
}

bool response_make(const ResponseDef *def, Response *r, Error *err)
{
    double *weights = NULL, *sorted = NULL;
    int32_t best = 0, n = def->keys, needed = (int32_t)(MORE * full_terms(n));
    *r =
        (Response){.keys = n, .data = def->data, .terms = full_terms(n), .measured = def->measured};
    if (def->designs < MORE * r->terms) r->terms = 1 + 2 * n;
    if (def->designs < MORE * r->terms) r->terms = 1 + n;
    if (def->designs <= r->terms && def->failed > 0)
        FAIL(err, ERROR_COMPUTE,
             "only %d designs have all that was measured: too few for %d keys; %d runs failed, the "
             "first with: %s",
             def->designs, n, def->failed, def->failure);
    if (def->designs <= r->terms)
        FAIL(err, ERROR_COMPUTE,
             "only %d designs have all that was measured: too few for %d keys; sweep.csv says "
             "which runs lack what (a longer time.until, or more `designs`, would help)",
             def->designs, n);
    TRY(weights = NEW_ARRAY(double, def->designs, err));
    TRY(r->coefficients = NEW_ARRAY(double, (int64_t)r->data * r->terms, err));
    TRY(r->own = NEW_ARRAY(double, r->data, err));

    // A design counts half where its misfit is `far` above the least; at least as many count as a
    // polynomial of second order needs. The best has the least.
    TRY(sorted = NEW_ARRAY(double, def->designs, err));
    for (int32_t d = 0; d < def->designs; d++) sorted[d] = def->list[d].misfit;
    qsort(sorted, (size_t)def->designs, sizeof *sorted, order_doubles);
    double reach = sorted[needed < def->designs ? needed : def->designs - 1] - sorted[0];
    double far = fmax(def->far, reach);
    for (int32_t d = 0; d < def->designs; d++) {
        double above = (def->list[d].misfit - sorted[0]) / far;
        weights[d] = 1 / (1 + above * above);
        if (def->list[d].misfit == sorted[0]) best = d;
    }

    // Variables begin at the best design, and are as long as designs that count lie about it.
    for (int32_t k = 0; k < r->keys; k++) {
        double sum = 0, square = 0;
        r->origin[k] = def->list[best].place[k];
        for (int32_t d = 0; d < def->designs; d++) {
            double apart = def->list[d].place[k] - r->origin[k];
            sum += weights[d];
            square += weights[d] * apart * apart;
        }
        r->scale[k] = square > 0 ? sqrt(square / sum) : 1;
    }

    TRY(solve(def, weights, r, err));
cleanup:
    memory_free_all(weights, sorted);
    return error_is_clean(err);
}

void response_destroy(Response *response)
{
    memory_free_all(response->coefficients, response->own);
    *response = (Response){0};
}

// --- misfit -------------------------------------------------------------------------------------

static double weight_of(const Response *r, int32_t datum)
{
    double error = r->measured[datum].error;
    return 1 / (error * error + r->own[datum] * r->own[datum]);
}

double response_misfit(const Response *r, const double *place)
{
    double terms[RESPONSE_TERMS_MAX], sum = 0;
    terms_at(r, place, terms, NULL);
    for (int32_t k = 0; k < r->data; k++) {
        double off = dense_dot(terms, &r->coefficients[(int64_t)k * r->terms], r->terms) -
                     r->measured[k].value;
        sum += weight_of(r, k) * off * off;
    }
    return sum;
}

// curvature: J' W J [keys * keys]; gradient: J' W (found - measured) [keys].
static void derive(const Response *r, const double *place, double *curvature, double *gradient)
{
    double terms[RESPONSE_TERMS_MAX], slopes[RESPONSE_TERMS_MAX * RESPONSE_KEYS_MAX];
    double row[RESPONSE_KEYS_MAX];
    int32_t n = r->keys;
    terms_at(r, place, terms, slopes);
    memset(curvature, 0, (size_t)n * (size_t)n * sizeof *curvature);
    memset(gradient, 0, (size_t)n * sizeof *gradient);
    for (int32_t k = 0; k < r->data; k++) {
        const double *of = &r->coefficients[(int64_t)k * r->terms];
        double weight = weight_of(r, k),
               off = dense_dot(terms, of, r->terms) - r->measured[k].value;
        dense_apply(dense_view(slopes, n, r->terms), of, 1, 0, row);
        dense_add_scaled(weight * off, row, n, gradient);
        for (int32_t i = 0; i < n; i++)
            dense_add_scaled(weight * row[i], row, n, &curvature[i * n]);
    }
}

void response_curvature(const Response *r, const double *place, double *curvature)
{
    double gradient[RESPONSE_KEYS_MAX];
    derive(r, place, curvature, gradient);
}

// Levenberg's method: damped steps of Gauss and Newton.
double response_least(const Response *r, const bool *fixed, double *place)
{
    double least = response_misfit(r, place), damped = DAMPED, next[RESPONSE_KEYS_MAX];
    double matrix[RESPONSE_KEYS_MAX * RESPONSE_KEYS_MAX], step[RESPONSE_KEYS_MAX];
    int32_t n = r->keys;
    for (int32_t round = 0; round < STEPS_MAX && damped < DAMPED_MAX; round++) {
        derive(r, place, matrix, step);
        for (int32_t k = 0; k < n; k++) step[k] = -step[k];

        // Rows and columns of keys that do not move become those of 1: fixed ones, and such at an
        // end of their range that would go beyond.
        for (int32_t k = 0; k < n; k++) {
            bool out = (place[k] <= 0 && step[k] < 0) || (place[k] >= 1 && step[k] > 0);
            if (!out && !(fixed && fixed[k]) && matrix[k * n + k] > 0) continue;
            for (int32_t i = 0; i < n; i++) matrix[i * n + k] = matrix[k * n + i] = 0;
            matrix[k * n + k] = 1;
            step[k] = 0;
        }
        for (int32_t k = 0; k < n; k++) matrix[k * n + k] *= 1 + damped;
        double misfit = INFINITY;
        if (dense_cholesky(matrix, n)) {
            dense_lower_solve(matrix, n, step);
            dense_lower_solve_transposed(matrix, n, step);
            for (int32_t k = 0; k < n; k++) next[k] = fmin(fmax(place[k] + step[k], 0), 1);
            misfit = response_misfit(r, next);
        }

        // Less damping after a step that helps, more after one that does not.
        if (!(misfit < least)) {
            damped *= 4;
            continue;
        }
        bool settled = least - misfit <= SETTLED * (1 + least);
        memcpy(place, next, (size_t)n * sizeof *place);
        least = misfit;
        damped = fmax(damped / 4, SETTLED);
        if (settled) break;
    }
    return least;
}
