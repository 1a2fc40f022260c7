// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/disc_factors.h"

#include "algebra/dense.h"
#include "base/memory.h"

bool disc_factors_create(const Interface *interface, DiscFactors *factors, Error *err)
{
    int64_t count = interface->count;
    *factors = (DiscFactors){.lu = memory_bytes((int64_t)sizeof(float) * count * count, err)};
    factors->pivots = NEW_ARRAY(int32_t, count, err);
    factors->single = NEW_ARRAY(float, count, err);
    factors->column = NEW_ARRAY(double, count, err);
    return error_is_clean(err);
}

void disc_factors_destroy(DiscFactors *factors)
{
    memory_free_all(factors->lu, factors->pivots, factors->single, factors->column);
    *factors = (DiscFactors){0};
}

void disc_column(const ContactNewton *newton, const DiscRow *rows, int32_t b, double *out)
{
    const ContactEquations *equations = &newton->equations;
    const ContactProblem *problem = equations->problem;
    int32_t own = equations->free[b], rod = interface_rod(problem->interface, 0);
    const double *column = newton->closed + (int64_t)problem->interface->count * own;
    for (int32_t a = 0; a < equations->free_count; a++) {
        int32_t k = equations->free[a];
        if (k >= rod) {
            out[a] = column[k];
            continue;
        }
        const DiscRow *row = &rows[dof_node(3, k)];
        const double *d = row->d;
        out[a++] = d[0] * column[k] + d[1] * column[k + 1] + row->mu * column[k + 2];
        out[a] = (1 - row->theta) * (d[0] * column[k + 1] - d[1] * column[k]);
    }
    if (own >= rod) {
        if (equations->at->rod_touches[own - rod]) out[b] += rod_stiffness(problem, own - rod);
        return;
    }
    const DiscRow *row = &rows[dof_node(3, own)];
    int32_t axis = dof_axis(3, own), first = b - axis;
    out[first] += row->along[axis];
    out[first + 1] += row->theta * row->rho * (axis == 0 ? -row->d[1] : row->d[0]);
}

static double scale_of(const ContactNewton *newton)
{
    return 1 / newton->equations.problem->matrix->diagonal;
}

bool disc_factors_make(DiscFactors *factors, const ContactNewton *newton, const DiscRow *row)
{
    int64_t size = newton->equations.free_count;
    double scale = scale_of(newton);
    float *out = factors->lu;
    for (int32_t b = 0; b < size; b++, out += size) {
        disc_column(newton, row, b, factors->column);
        for (int32_t a = 0; a < size; a++) out[a] = (float)(scale * factors->column[a]);
    }
    bool regular = dense_lu_single(factors->lu, (int32_t)size, factors->pivots);
    factors->rows = regular ? (int32_t)size : 0;
    return regular;
}

void disc_factors_solve(const DiscFactors *factors, const ContactNewton *newton, double *x)
{
    double scale = scale_of(newton);
    dense_lu_single_solve(factors->lu, factors->rows, factors->pivots, x, factors->single);
    for (int32_t a = 0; a < factors->rows; a++) x[a] *= scale;
}

void disc_factors_archive(DiscFactors *factors, int32_t count, Archive *archive)
{
    archive_index(archive, &factors->rows, 0, count + 1);
    if (archive->failed) return;
    int64_t entries = (int64_t)factors->rows * factors->rows;
    archive_octets(archive, (uint8_t *)factors->lu, entries * (int64_t)sizeof(float));
    archive_indices(archive, factors->pivots, factors->rows, 1, factors->rows + 1);
}
