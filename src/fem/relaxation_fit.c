// SPDX-License-Identifier: GPL-2.0-or-later
#include "fem/relaxation_fit.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double ROUNDING = 1e-12;   // of a gradient, over the largest that there was
static const double DEPENDENT = 1e-10;   // of a column, what others leave of it
enum { TIMES_MAX = 100 };
static const double BEYOND = 3;   // times beyond those of the data, which still shape their ends
static const double MISFIT_ALLOWED = 0.005;   // above the least: less than what such data know

// --- least squares that are not negative ---------------------------------------------------------

// Least squares over the columns `passive` by Householder reflections: z [columns], 0 elsewhere.
// Work [rows * (columns + 1)]. A column that depends on those before it gets 0.
static void solve_passive(const double *A, const double *b, int32_t rows, int32_t columns,
                          const bool *passive, double *work, double *z)
{
    int32_t used = 0;
    int32_t *of = (int32_t *)(void *)(work + (int64_t)rows * (columns + 1));
    double *right = work + (int64_t)rows * columns;
    memcpy(right, b, (size_t)rows * sizeof *right);
    memset(z, 0, (size_t)columns * sizeof *z);
    for (int32_t c = 0; c < columns; c++) {
        if (!passive[c]) continue;
        for (int32_t r = 0; r < rows; r++)
            work[(int64_t)used * rows + r] = A[(int64_t)r * columns + c];
        of[used++] = c;
    }
    int32_t rank = 0;
    for (int32_t k = 0; k < used; k++) {
        double *column = work + (int64_t)k * rows, size = 0, whole = 0;
        for (int32_t r = 0; r < rows; r++) whole += column[r] * column[r];
        for (int32_t r = rank; r < rows; r++) size += column[r] * column[r];
        if (rank == rows || !(size > DEPENDENT * DEPENDENT * whole)) {
            of[k] = -1;
            continue;
        }
        double norm = column[rank] > 0 ? -sqrt(size) : sqrt(size);
        double first = column[rank] - norm;
        column[rank] = first;
        double scale = size - norm * (first + norm);   // half of the reflected vector's square
        for (int32_t j = k + 1; j <= used; j++) {
            double *other = j < used ? work + (int64_t)j * rows : right, sum = 0;
            for (int32_t r = rank; r < rows; r++) sum += column[r] * other[r];
            for (int32_t r = rank; r < rows; r++) other[r] -= sum / scale * column[r];
        }
        column[rank++] = norm;
    }
    for (int32_t k = used - 1; k >= 0; k--) {
        if (of[k] < 0) continue;
        double sum = right[--rank];
        for (int32_t j = k + 1; j < used; j++)
            if (of[j] >= 0) sum -= work[(int64_t)j * rows + rank] * z[of[j]];
        z[of[k]] = sum / work[(int64_t)k * rows + rank];
    }
}

// Lawson and Hanson's algorithm NNLS: the column with the steepest descent becomes free; while a
// free one would be negative, the way to it ends where the first meets 0, which is held again.
bool least_squares_not_negative(const double *A, const double *b, int32_t rows, int32_t columns,
                                double *x, Error *err)
{
    int64_t size = (int64_t)rows * (columns + 1) + columns;
    double *work = NEW_ARRAY(double, size, err), *z = NEW_ARRAY(double, 2 * (int64_t)columns, err);
    bool *passive = NEW_ARRAY(bool, columns, err);
    double largest = 0;
    if (!error_is_clean(err)) goto cleanup;
    double *gradient = z + columns;
    memset(x, 0, (size_t)columns * sizeof *x);
    for (int32_t round = 0;; round++) {
        int32_t steepest = -1;
        memset(gradient, 0, (size_t)columns * sizeof *gradient);
        for (int32_t r = 0; r < rows; r++) {
            double left = b[r];
            for (int32_t c = 0; c < columns; c++) left -= A[(int64_t)r * columns + c] * x[c];
            for (int32_t c = 0; c < columns; c++) gradient[c] += A[(int64_t)r * columns + c] * left;
        }
        for (int32_t c = 0; c < columns; c++) {
            largest = fmax(largest, fabs(gradient[c]));
            bool steeper = steepest < 0 || gradient[c] > gradient[steepest];
            if (!passive[c] && gradient[c] > ROUNDING * largest && steeper) steepest = c;
        }
        if (steepest < 0) break;
        if (round > 10 * columns) FAIL(err, ERROR_INPUT, "the fit does not settle");
        passive[steepest] = true;
        solve_passive(A, b, rows, columns, passive, work, z);
        if (!(z[steepest] > 0)) {   // by rounding alone
            passive[steepest] = false;
            break;
        }
        for (;;) {
            double part = 1;
            for (int32_t c = 0; c < columns; c++)
                if (passive[c] && z[c] <= 0) part = fmin(part, x[c] / (x[c] - z[c]));
            for (int32_t c = 0; c < columns; c++) {
                bool meets = passive[c] && z[c] <= 0 && x[c] <= part * (x[c] - z[c]);
                x[c] = meets ? 0 : x[c] + part * (z[c] - x[c]);
                if (meets) passive[c] = false;
            }
            if (part == 1) break;
            solve_passive(A, b, rows, columns, passive, work, z);
        }
    }
cleanup:
    memory_free_all(work, z, passive);
    return error_is_clean(err);
}

// --- the solid ----------------------------------------------------------------------------------

void relaxation_moduli(const RelaxationFit *fit, double frequency, double *storage, double *loss)
{
    *storage = fit->rest;
    *loss = fit->viscosity * frequency;
    for (int32_t k = 0; k < fit->count; k++) {
        double s = frequency * fit->time[k], part = fit->modulus[k] * s / (1 + s * s);
        *storage += s * part;
        *loss += part;
    }
}

double relaxation_at(const RelaxationFit *fit, double time)
{
    double sum = fit->rest;
    for (int32_t k = 0; k < fit->count; k++) sum += fit->modulus[k] * exp(-time / fit->time[k]);
    return sum;
}

double wlf_shift(double c1, double c2, double reference, double temperature)
{
    double above = temperature - reference;
    return c2 + above > 0 ? pow(10, -c1 * above / (c2 + above)) : (double)NAN;
}

// The fit with `count` relaxation times from `fastest` to `slowest`; those that get 0 are left out.
// A, b: room for all rows and columns. fit->count RELAXATION_TERMS_MAX + 1: more are left.
static bool fit_terms(const RelaxationData *data, bool has_viscosity, int32_t count, double fastest,
                      double slowest, double *A, double *b, RelaxationFit *fit, Error *err)
{
    enum { REST, VISCOSITY, FIRST };
    int32_t columns = FIRST + count, each = data->over_time ? 1 : 2;
    double x[FIRST + TIMES_MAX], time[TIMES_MAX];
    for (int32_t k = 0; k < count; k++)
        time[k] = count == 1 ? sqrt(fastest * slowest)
                             : fastest * pow(slowest / fastest, (double)k / (count - 1));
    for (int32_t i = 0; i < data->count; i++) {
        double at = data->at[i], *row = A + (int64_t)each * i * columns, *loss = row + columns;
        double scale[2] = {1 / data->storage[i], data->over_time ? 0 : 1 / data->loss[i]};
        for (int32_t d = 0; d < each; d++) b[each * i + d] = 1;
        row[REST] = scale[0];
        row[VISCOSITY] = 0;
        if (each == 2) {
            loss[REST] = 0;
            loss[VISCOSITY] = has_viscosity ? at * scale[1] : 0;
        }
        for (int32_t k = 0; k < count; k++) {
            double s = at * time[k], part = s / (1 + s * s);
            row[FIRST + k] = scale[0] * (each == 2 ? s * part : exp(-at / time[k]));
            if (each == 2) loss[FIRST + k] = scale[1] * part;
        }
    }
    // Columns of size 1: moduli and a viscosity are numbers of very different size.
    double size[FIRST + TIMES_MAX] = {0};
    for (int64_t i = 0; i < (int64_t)each * data->count * columns; i++)
        size[i % columns] += A[i] * A[i];
    for (int64_t i = 0; i < (int64_t)each * data->count * columns; i++)
        if (size[i % columns] > 0) A[i] /= sqrt(size[i % columns]);
    if (!least_squares_not_negative(A, b, each * data->count, columns, x, err)) return false;
    for (int32_t c = 0; c < columns; c++) x[c] = size[c] > 0 ? x[c] / sqrt(size[c]) : 0;

    *fit = (RelaxationFit){.rest = x[REST], .viscosity = x[VISCOSITY]};
    for (int32_t k = 0; k < count; k++) {
        if (!(x[FIRST + k] > 0)) continue;
        if (fit->count >= RELAXATION_TERMS_MAX) {
            fit->count = RELAXATION_TERMS_MAX + 1;
            return true;
        }
        fit->time[fit->count] = time[k];
        fit->modulus[fit->count++] = x[FIRST + k];
    }

    double sum = 0;
    int32_t rows = 0;
    fit->worst = 0;
    for (int32_t i = 0; i < data->count; i++) {
        double found[2] = {relaxation_at(fit, data->at[i]), 0};
        if (!data->over_time) relaxation_moduli(fit, data->at[i], &found[0], &found[1]);
        for (int32_t d = 0; d < (data->over_time ? 1 : 2); d++) {
            double off = fabs(found[d] / (d == 0 ? data->storage : data->loss)[i] - 1);
            sum += off * off;
            fit->worst = fmax(fit->worst, off);
            rows++;
        }
    }
    fit->misfit = sqrt(sum / rows);
    return true;
}

bool relaxation_fit(const RelaxationData *data, bool has_viscosity, RelaxationFit *fit, Error *err)
{
    // Numbers of times that are offered. Of many few are used, two around each that is in the data.
    static const int32_t offered[] = {1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12,
                                      13, 14, 15, 16, 17, 18, 19, 20, 30, 45, 70, TIMES_MAX};
    enum { COLUMNS_MAX = TIMES_MAX + 2, TRIALS = sizeof offered / sizeof *offered };
    RelaxationFit tried[TRIALS];
    double least = INFINITY, most = 0, misfit = INFINITY, *A = NULL, *b = NULL;
    if (data->count < 2 || data->count > RELAXATION_POINTS_MAX)
        return REFUSE(err, "%d points; allowed: 2 to %d", data->count, RELAXATION_POINTS_MAX);
    for (int32_t i = 0; i < data->count; i++) {
        bool fine = data->at[i] > 0 && data->storage[i] > 0 && isfinite(data->storage[i]) &&
                    (data->over_time || (data->loss[i] > 0 && isfinite(data->loss[i])));
        if (!fine) return REFUSE(err, "point %d: all numbers have to be above 0", i + 1);
        double time = data->over_time ? data->at[i] : 1 / data->at[i];
        least = fmin(least, time);
        most = fmax(most, time);
    }
    TRY(A = NEW_ARRAY(double, 2 * (int64_t)data->count * COLUMNS_MAX, err));
    TRY(b = NEW_ARRAY(double, 2 * (int64_t)data->count, err));
    for (int32_t n = 0; n < TRIALS; n++) {
        TRY(fit_terms(data, has_viscosity && !data->over_time, offered[n], least / BEYOND,
                      most * BEYOND, A, b, &tried[n], err));
        if (tried[n].count <= RELAXATION_TERMS_MAX) misfit = fmin(misfit, tried[n].misfit);
    }
    *fit = (RelaxationFit){.count = RELAXATION_TERMS_MAX + 1};
    for (int32_t n = 0; n < TRIALS; n++)
        if (tried[n].count < fit->count && tried[n].misfit <= misfit + MISFIT_ALLOWED)
            *fit = tried[n];
cleanup:
    memory_free_all(A, b);
    return error_is_clean(err);
}
