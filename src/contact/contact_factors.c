// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/contact_factors.h"

#include "algebra/dense.h"
#include "base/memory.h"

bool contact_factors_create(const Interface *interface, ContactFactors *factors, Error *err)
{
    int64_t count = interface->count;
    *factors = (ContactFactors){.lu = memory_bytes(8 * count * count, err)};
    factors->pivots = NEW_ARRAY(int32_t, count, err);
    factors->status = NEW_ARRAY(uint8_t, count, err);
    return error_is_clean(err);
}

void contact_factors_destroy(ContactFactors *factors)
{
    memory_free_all(factors->lu, factors->pivots, factors->status);
    *factors = (ContactFactors){0};
}

bool contact_factors_make(ContactFactors *factors, const ContactEquations *equations,
                          const double *matrix)
{
    int32_t rows = equations->free_count;
    contact_jacobian(equations, matrix, rows, factors->lu);
    contact_copy_statuses(equations, factors->status);
    factors->rows = dense_lu(factors->lu, rows, factors->pivots) ? rows : 0;
    return factors->rows == rows;
}

void contact_factors_solve(const ContactFactors *factors, double *x)
{
    dense_lu_solve(factors->lu, factors->rows, factors->pivots, x);
}

// count: interface unknowns.
void contact_factors_archive(ContactFactors *factors, int32_t count, Archive *archive)
{
    archive_section(archive, "contact factors");
    archive_octets(archive, factors->status, count);
    archive_index(archive, &factors->rows, 0, count + 1);
    if (archive->failed) return;
    archive_numbers(archive, factors->lu, (int64_t)factors->rows * factors->rows);
    archive_indices(archive, factors->pivots, factors->rows, 1, factors->rows + 1);
}
