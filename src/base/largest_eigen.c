// SPDX-License-Identifier: GPL-2.0-or-later
// Lanczos on L^-1 a L^-T with every vector made orthogonal to all before (Parlett, The Symmetric
// Eigenvalue Problem, 13): a few steps where few eigenvalues stand out. With V T V' what it has
// found so far, beta the length of the next vector and s an eigenvector of T, V s has a residual of
// beta |s_last|.
//
// It can miss an eigenvalue, a multiple one above all. So two Cholesky factors prove where the
// others lie: next b - (a - sum of the mu b x x'b found) and a - least b are positive definite.
#include "base/largest_eigen.h"

#include "base/dense.h"
#include "base/memory.h"
#include "base/parallel.h"

#include <math.h>
#include <string.h>

// More steps than a STEPS_PART of the size take as long as all eigenvalues by a tridiagonal form.
// So they are given up, and half way where most of what was found is wanted: there is more to
// come. Ritz values are looked at after every LOOK_EVERY steps.
enum { STEPS_PART = 8, LOOK_EVERY = 10 };

// Residuals: of wanted vectors, in units of `above`; of the next one in units of its value, or of
// `above` where it is far below. The bound for the others is farther away by MARGIN than rounding.
static const double WANTED_RESIDUAL = 1e-9, NEXT_RESIDUAL = 1e-2, NEXT_FAR = 1e-3, MARGIN = 1e-6;

typedef struct Lanczos {
    const LargestEigenDef *def;
    int32_t steps, steps_max;
    double *basis;   // [size * (steps_max + 1)] orthonormal; owned, like all below
    double *diagonal, *beside;   // of T; [steps_max] each
    double *ritz, *rotation;   // eigenvalues [steps_max] and vectors [steps_max^2] of T
    double *work;   // [dense_eigen_work(steps_max) + size]
} Lanczos;

static void lanczos_destroy(Lanczos *lanczos)
{
    double *const owned[] = {lanczos->basis, lanczos->diagonal, lanczos->beside,
                             lanczos->ritz,  lanczos->rotation, lanczos->work};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++) memory_free(owned[k]);
}

static bool lanczos_create(const LargestEigenDef *def, Lanczos *lanczos, Error *err)
{
    int64_t n = def->size, steps = n / STEPS_PART / LOOK_EVERY * LOOK_EVERY;
    *lanczos = (Lanczos){.def = def, .steps_max = (int32_t)steps};
    lanczos->basis = NEW_ARRAY(double, n *(steps + 1), err);
    lanczos->diagonal = NEW_ARRAY(double, steps, err);
    lanczos->beside = NEW_ARRAY(double, steps, err);
    lanczos->ritz = NEW_ARRAY(double, steps, err);
    lanczos->rotation = NEW_ARRAY(double, steps *steps, err);
    lanczos->work = NEW_ARRAY(double, dense_eigen_work((int32_t)steps) + n, err);
    return error_is_clean(err);
}

// x := x / |x|; returns |x|.
static double normalise(double *x, int32_t n)
{
    double norm = sqrt(dense_dot(x, x, n));
    for (int32_t k = 0; norm > 0 && k < n; k++) x[k] /= norm;
    return norm;
}

// x := x - V V'x with the first `count` columns of V; along: [count] becomes V'x. Twice is enough.
static void take_out(const Lanczos *lanczos, int32_t count, double *x, double *along)
{
    DenseView known = {lanczos->basis, lanczos->def->size, count};
    dense_apply_transposed(known, x, 1, 0, along);
    dense_apply(known, along, -1, 1, x);
}

static void step(Lanczos *lanczos)
{
    const LargestEigenDef *def = lanczos->def;
    int32_t n = def->size, k = lanczos->steps++;
    double *now = lanczos->basis + (int64_t)k * n, *next = now + n, *x = lanczos->work;
    double *along = lanczos->work + n;
    memcpy(x, now, (size_t)n * sizeof *x);
    dense_lower_solve_transposed(def->lower, n, x);
    dense_symmetric_apply(def->a, n, x, next);
    dense_lower_solve(def->lower, n, next);
    take_out(lanczos, k + 1, next, along);
    lanczos->diagonal[k] = along[k];
    take_out(lanczos, k + 1, next, along);
    lanczos->beside[k] = normalise(next, n);
}

static bool find_ritz(Lanczos *lanczos)
{
    int32_t steps = lanczos->steps;
    memset(lanczos->rotation, 0, (size_t)steps * (size_t)steps * sizeof(double));
    for (int64_t k = 0; k < steps; k++) {
        lanczos->rotation[k * steps + k] = lanczos->diagonal[k];
        if (k + 1 < steps) lanczos->rotation[k * steps + k + 1] = lanczos->beside[k];
    }
    return dense_eigen(lanczos->rotation, steps, lanczos->ritz, lanczos->work);
}

// Of the k-th Ritz vector.
static double residual(const Lanczos *lanczos, int64_t k)
{
    int64_t steps = lanczos->steps;
    return lanczos->beside[steps - 1] * fabs(lanczos->rotation[k * steps + steps - 1]);
}

static int32_t count_wanted(const Lanczos *lanczos)
{
    int32_t wanted = 0, steps = lanczos->steps;
    while (wanted < steps && lanczos->ritz[steps - 1 - wanted] > lanczos->def->above) wanted++;
    return wanted;
}

// By how much the bound for all others is above the k-th Ritz value.
static double distance(const Lanczos *lanczos, int64_t k)
{
    return fmax(residual(lanczos, k), MARGIN * lanczos->def->above);
}

static bool has_converged(const Lanczos *lanczos, int32_t wanted)
{
    int32_t steps = lanczos->steps, next = steps - 1 - wanted;
    double above = lanczos->def->above;
    if (next < 0) return false;
    for (int32_t k = next + 1; k < steps; k++)
        if (!(residual(lanczos, k) <= WANTED_RESIDUAL * above)) return false;
    double largest = lanczos->ritz[next], far = distance(lanczos, next);
    return far <= fmax(NEXT_RESIDUAL * largest, NEXT_FAR * above) && largest + far <= above;
}

// false: the steps did not suffice.
static bool run(Lanczos *lanczos, int32_t *wanted)
{
    int32_t n = lanczos->def->size;
    double *start = lanczos->basis;
    // Orthogonal to no eigenvector but by chance: a sequence without pattern.
    for (int32_t k = 0; k < n; k++) start[k] = fmod(0.6180339887498949 * (k + 1.0), 1) - 0.5;
    normalise(start, n);
    while (lanczos->steps < lanczos->steps_max) {
        step(lanczos);
        if (lanczos->steps % LOOK_EVERY != 0) continue;
        if (!find_ritz(lanczos)) return false;
        *wanted = count_wanted(lanczos);
        if (has_converged(lanczos, *wanted)) return true;
        bool half_way = 2 * lanczos->steps > lanczos->steps_max;
        if (half_way && 4 * *wanted > 3 * lanczos->steps) return false;
    }
    return false;
}

// The wanted ones, out of the basis.
static bool take_wanted(const Lanczos *lanczos, int32_t wanted, LargestEigen *largest, Error *err)
{
    int64_t n = lanczos->def->size, steps = lanczos->steps, first = steps - wanted;
    largest->count = wanted;
    largest->values = NEW_ARRAY(double, wanted, err);
    largest->vectors = NEW_ARRAY(double, n *wanted, err);
    if (!error_is_clean(err)) return false;
    for (int32_t k = 0; k < wanted; k++) largest->values[k] = lanczos->ritz[first + k];
    dense_multiply((DenseView){lanczos->basis, (int32_t)n, (int32_t)steps},
                   (DenseView){lanczos->rotation + first * steps, (int32_t)steps, wanted}, 1, 0,
                   largest->vectors);
    largest->next = fmax(lanczos->ritz[first - 1], 0) + distance(lanczos, first - 1);
    return true;
}

typedef struct Proof {
    Lanczos *lanczos;
    const LargestEigen *largest;
    bool holds[2];
} Proof;

// next b - a + sum of mu (b x)(b x)', where b x = L (L'x).
static void fill_above(const Proof *proof, double *matrix)
{
    const LargestEigenDef *def = proof->lanczos->def;
    const LargestEigen *largest = proof->largest;
    int64_t n = def->size;
    double *images = proof->lanczos->basis;   // which is done with
    for (int64_t k = 0; k < n * n; k++) matrix[k] = largest->next * def->b[k] - def->a[k];
    for (int64_t k = 0; k < largest->count; k++)
        for (int64_t i = 0; i < n; i++)
            images[k * n + i] = sqrt(largest->values[k]) * largest->vectors[k * n + i];
    dense_lower_multiply(def->lower, def->size, largest->count, images);
    dense_add_square((DenseView){images, def->size, largest->count}, matrix);
}

static void prove(void *context, int32_t which, int32_t worker)
{
    (void)worker;
    Proof *proof = context;
    const LargestEigenDef *def = proof->lanczos->def;
    int64_t square = (int64_t)def->size * def->size;
    double *matrix = def->work + which * square;
    if (which == 0)
        fill_above(proof, matrix);
    else
        for (int64_t k = 0; k < square; k++) matrix[k] = def->a[k] - def->least * def->b[k];
    proof->holds[which] = dense_cholesky(matrix, def->size);
}

bool largest_eigen_find(const LargestEigenDef *def, LargestEigen *largest, bool *found, Error *err)
{
    Lanczos lanczos;
    int32_t wanted = 0;
    *largest = (LargestEigen){0};
    *found = false;
    TRY(lanczos_create(def, &lanczos, err));
    if (!run(&lanczos, &wanted)) goto cleanup;
    TRY(take_wanted(&lanczos, wanted, largest, err));
    Proof proof = {.lanczos = &lanczos, .largest = largest};
    parallel_for(2, prove, &proof);
    *found = proof.holds[0] && proof.holds[1];
cleanup:
    lanczos_destroy(&lanczos);
    if (!*found) largest_eigen_destroy(largest);
    return error_is_clean(err);
}

void largest_eigen_destroy(LargestEigen *largest)
{
    memory_free(largest->values);
    memory_free(largest->vectors);
    *largest = (LargestEigen){0};
}
