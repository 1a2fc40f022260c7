// SPDX-License-Identifier: GPL-2.0-or-later
// The boundary motions that a basis was given have the responses of the mesh, and a renewal brings
// that back after the basis was spoiled within its span.
#include "reduction/basis_condense.h"
#include "reduction/basis_extension.h"
#include "reduction/basis_renew.h"
#include "reduction/growing_basis.h"

#include "reduced_block.h"

static const Material MATERIAL = {
    .young = 2.5, .poisson = 0.34, .density = 1.3, .eta1 = 0.8, .eta2 = 0.3};
static const BlockDef SHAPE = {
    .kind = ELEMENT_Q4, .nx = 6, .nz = 5, .length = 1.4, .height = 0.5, .distortion = 0.2};
static const ParameterPoint POINTS[] = {{0.2, 3}, {0.9, 500}};

enum { POINT_COUNT = 2, COLUMNS = 5 };

typedef struct Rig {
    ReducedBlock block;   // reduced here
    BulkOperator mesh;
    GrowingBasis basis;
    InterfaceOperator *full[POINT_COUNT];
} Rig;

static InterfaceOperator *factor(Rig *rig, ParameterPoint point)
{
    Error err = {0};
    const BulkScales *scales = &rig->block.def.scales;
    OperatorTerms terms = {.mass = point.inertia / scales->mass,
                           .damping = point.viscosity / scales->damping,
                           .stiffness = (1 - point.viscosity) / scales->stiffness,
                           .lift = true};
    InterfaceOperator *full = interface_operator_create(&rig->mesh, terms, &err);
    assert_non_null(full);
    return full;
}

// Responses to boundary motions of the first COLUMNS unknowns of the interface, one each.
static void add_responses(Rig *rig, int32_t which)
{
    Error err = {0};
    int64_t m = rig->block.interface_count;
    double *boundary = hand_matrix((int32_t)m, COLUMNS);
    const double *schur = interface_operator_schur(rig->full[which]);
    ResponseBlock *next = responses_next(&rig->basis.responses, POINTS[which], COLUMNS, &err);
    assert_non_null(next);
    for (int64_t j = 0; j < COLUMNS; j++) {
        boundary[j * m + j] = next->boundary[j * (m + 1) + j] = 1;
        memcpy(next->reaction + j * (m + 1), schur + j * m, (size_t)m * sizeof *schur);
    }
    assert_true(interface_operator_respond(rig->full[which], boundary, COLUMNS, next->field, &err));
    assert_true(basis_extend(&rig->basis, &err));
    free(boundary);
}

static void start(Rig *rig)
{
    Error err = {0};
    *rig = (Rig){0};
    reduced_block_build(&SHAPE, &MATERIAL, 0.7, 0, &rig->block);
    assert_true(bulk_operator_create(&rig->block.bulk, NULL, rig->block.dofs,
                                     rig->block.interface_count, &rig->mesh, &err));
    assert_true(basis_create(&rig->mesh, &rig->block.def.scales, &rig->basis, &err));
    rig->basis.loss_max = 1e300;
    rig->basis.responses.inertia_least = 0.1;
    InterfaceOperator *statics = factor(rig, (ParameterPoint){0, 0});
    assert_true(basis_start(&rig->basis, statics, &err));
    interface_operator_destroy(statics);
    for (int32_t k = 0; k < POINT_COUNT; k++) {
        rig->full[k] = factor(rig, POINTS[k]);
        add_responses(rig, k);
    }
}

static void end(Rig *rig)
{
    for (int32_t k = 0; k < POINT_COUNT; k++) interface_operator_destroy(rig->full[k]);
    basis_destroy(&rig->basis);
    bulk_operator_destroy(&rig->mesh);
    reduced_block_destroy(&rig->block);
}

// The largest part by which S of the basis differs from that of the mesh, in columns that it was
// given. (Products of responses lose some 1e-12 here.)
static double largest_error(const Rig *rig)
{
    Error err = {0};
    int32_t m = rig->block.interface_count;
    double *schur = hand_matrix(m, m), energy, largest = 0;
    for (int32_t k = 0; k < POINT_COUNT; k++) {
        bool definite = false;
        const double factors[] = {[BULK_STIFFNESS] = 1 - POINTS[k].viscosity,
                                  [BULK_DAMPING] = POINTS[k].viscosity,
                                  [BULK_MASS] = POINTS[k].inertia};
        const double *exact = interface_operator_schur(rig->full[k]);
        assert_true(basis_condense(&rig->basis, factors, schur, &energy, &definite, &err));
        if (!definite) largest = INFINITY;
        for (int32_t at = 0; at < m * COLUMNS; at++)
            largest = fmax(largest, fabs(schur[at] - exact[at]) / fabs(exact[at % m * (m + 1)]));
    }
    free(schur);
    return largest;
}

// Modes from `first` on mixed with those before them, and all that was known of them made wrong.
static void spoil(Rig *rig, int32_t first)
{
    Error err = {0};
    GrowingBasis *basis = &rig->basis;
    int64_t m = basis->interface_count, r = basis->interior_count,
            rows = basis->responses.count - m;
    assert_true(extension_spell_out_mix(basis, &err));
    for (int64_t j = first; j < r; j++) {
        for (int64_t i = 0; i < rows && j > 0; i++)
            basis->mix[j * rows + i] = 1.5 * basis->mix[j * rows + i] +
                                       0.25 * basis->mix[(j - 1) * rows + i];
        for (int64_t i = 0; i < m && j > 0; i++)
            basis->parts[j * m + i] = 1.5 * basis->parts[j * m + i] +
                                      0.25 * basis->parts[(j - 1) * m + i];
        for (int64_t i = 0; i < m; i++) {
            basis->beside[BULK_MASS][j * m + i] = 0.1;
            basis->beside[BULK_DAMPING][j * m + i] = 0.2;
        }
        for (int64_t i = 0; i < r; i++) {
            basis->interior[BULK_MASS][j * r + i] = basis->interior[BULK_MASS][i * r + j] = 0.1;
            basis->interior[BULK_DAMPING][j * r + i] = basis->interior[BULK_DAMPING][i * r + j] =
                0.2;
        }
        basis->load[m + j] = 7;
    }
}

// Of the static response to the unit load, from what is known of the modes: f' K^-1 f.
static double load_energy(const Rig *rig)
{
    const GrowingBasis *basis = &rig->basis;
    int32_t m = basis->interface_count, r = basis->interior_count;
    double *square = hand_matrix(r, r), *response = hand_matrix(r, 1), energy = 0;
    memcpy(square, basis->interior[BULK_STIFFNESS], (size_t)r * (size_t)r * sizeof *square);
    memcpy(response, basis->load + m, (size_t)r * sizeof *response);
    assert_true(hand_solve(square, r, response, 1));
    for (int32_t k = 0; k < r; k++) energy += response[k] * basis->load[m + k];
    free(square), free(response);
    return energy;
}

static void test_renewal(void **state)
{
    (void)state;
    Error err = {0};
    Rig rig;
    start(&rig);
    int32_t count = rig.basis.interior_count;
    assert_int_equal(count, 1 + POINT_COUNT * COLUMNS);   // that of the load, too
    const int32_t firsts[] = {0, 1, count - COLUMNS, count - 1};
    assert_near("S", largest_error(&rig), 0, 1e-10);
    double load = load_energy(&rig);
    for (int32_t k = 0; k < 4; k++) {
        spoil(&rig, firsts[k]);
        assert_true(largest_error(&rig) > 1e-3);
        assert_true(basis_renew(&rig.basis, firsts[k], &err));
        assert_int_equal(rig.basis.interior_count, count);
        assert_near("S", largest_error(&rig), 0, 1e-10);
        assert_near("energy of the load", load_energy(&rig), load, 1e-10 * load);
    }
    end(&rig);
}

// With every loss renewed at once the same comes out.
static void test_renewed_at_once(void **state)
{
    (void)state;
    Error err = {0};
    Rig rig;
    start(&rig);
    rig.basis.loss_max = 0;
    add_responses(&rig, 0);   // these again: nothing but rounding is left
    assert_near("S", largest_error(&rig), 0, 1e-10);
    assert_int_equal(rig.basis.interior_count, 1 + POINT_COUNT * COLUMNS);
    assert_true(error_is_clean(&err));
    end(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_renewal),
        cmocka_unit_test(test_renewed_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
