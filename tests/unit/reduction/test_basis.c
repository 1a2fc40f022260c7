// SPDX-License-Identifier: GPL-2.0-or-later
// The matrices of a basis that grows, against products of its modes with the mesh's own matrices,
// whether what is new of a response is made of products or by the mesh; that it responds as the
// mesh to boundary motions it was given; and what it condenses to, against elimination by hand.
#include "reduction/basis.h"

#include "reduced_block.h"

static const Material MATERIAL = {
    .young = 2.5, .poisson = 0.34, .density = 1.3, .eta1 = 0.8, .eta2 = 0.3};
static const BlockDef SHAPE = {
    .kind = ELEMENT_Q4, .nx = 6, .nz = 5, .length = 1.4, .height = 0.5, .distortion = 0.2};

typedef struct Rig {
    ReducedBlock block;   // not reduced
    BulkOperator mesh;
    InterfaceOperator *statics;
    Basis basis;
    ReducedPart reduced;   // what the basis becomes at the end
} Rig;

// The static modes, and the static response to the load.
static void start(Rig *rig, double loss_max)
{
    Error err = {0};
    memset(rig, 0, sizeof *rig);
    reduced_block_build(&SHAPE, &MATERIAL, 0.7, 0, &rig->block);
    assert_true(bulk_operator_create(&rig->block.bulk, NULL, rig->block.dofs,
                                     rig->block.interface_count, &rig->mesh, &err));
    assert_true(basis_create(&rig->mesh, &rig->block.def.scales, &rig->basis, &err));
    rig->basis.loss_max = loss_max;
    rig->basis.responses.inertia_least = 0.1;
    OperatorTerms terms = {.stiffness = 1 / rig->block.def.scales.stiffness, .lift = true};
    rig->statics = interface_operator_create(&rig->mesh, terms, &err);
    assert_non_null(rig->statics);
    if (!basis_start(&rig->basis, rig->statics, &err)) fail_msg("%s", err.message);
}

static void end(Rig *rig)
{
    basis_destroy(&rig->basis);
    interface_operator_destroy(rig->statics);
    bulk_operator_destroy(&rig->mesh);
    reduced_part_destroy(&rig->reduced);
    reduced_block_destroy(&rig->block);
}

// Responses to the first `columns` motions of one node, at a point.
static void extend(Rig *rig, ParameterPoint point, int32_t columns)
{
    Error err = {0};
    Responses *responses = &rig->basis.responses;
    const BulkScales *scales = &rig->block.def.scales;
    int64_t m = rig->block.interface_count;
    OperatorTerms terms = {.mass = point.inertia / scales->mass,
                           .damping = point.viscosity / scales->damping,
                           .stiffness = (1 - point.viscosity) / scales->stiffness,
                           .lift = true};
    InterfaceOperator *full = interface_operator_create(&rig->mesh, terms, &err);
    ResponseBlock *next = responses_next(responses, point, columns, &err);
    assert_true(full && next);
    double *boundary = hand_matrix((int32_t)m, columns);
    for (int64_t j = 0; j < columns; j++) {
        boundary[j * m + j] = next->boundary[j * (m + 1) + j] = 1;
        memcpy(next->reaction + j * (m + 1), interface_operator_schur(full) + j * m,
               (size_t)m * sizeof *boundary);
    }
    assert_true(interface_operator_respond(full, boundary, columns, next->field, &err));
    if (!basis_extend(&rig->basis, &err)) fail_msg("%s", err.message);
    free(boundary);
    interface_operator_destroy(full);
}

// x' T z of the mesh, normalised.
static double product(const Rig *rig, BulkTerm term, const double *x, const double *z)
{
    const BulkScales *scales = &rig->block.def.scales;
    const double unit[] = {scales->stiffness, scales->damping, scales->mass};
    double *image = hand_matrix(rig->basis.full_dofs, 1), sum = 0;
    bulk_operator_apply(&rig->mesh, term, z, image);
    for (int32_t k = 0; k < rig->basis.full_dofs; k++) sum += x[k] * image[k];
    free(image);
    return sum / unit[term];
}

// K of the reduced bulk as its header draws it.
static double stiffness_of(const ReducedPart *reduced, int32_t i, int32_t j)
{
    int32_t m = reduced->border_count;
    if (i < m && j < m) return reduced->stiffness[j * m + i];
    return i == j;
}

// The basis is finished by it. M of the interior is diagonal.
static void assert_matrices(Rig *rig, double tolerance)
{
    Error err = {0};
    const ReducedPart *reduced = &rig->reduced;
    if (!basis_finish(&rig->basis, true, &rig->reduced, &err)) fail_msg("%s", err.message);
    int32_t count = reduced->count, dofs = reduced->full_dofs;
    double *mass = whole_mass(reduced);
    for (int32_t j = 0; j < count; j++) {
        const double *z = reduced->modes + j * dofs;
        double load = 0;
        for (int32_t i = 0; i <= j; i++) {
            const double *x = reduced->modes + i * dofs;
            assert_near("K", stiffness_of(reduced, i, j), product(rig, BULK_STIFFNESS, x, z),
                        tolerance);
            assert_near("C", reduced->damping[j * count + i], product(rig, BULK_DAMPING, x, z),
                        tolerance);
            assert_near("M", mass[j * count + i], product(rig, BULK_MASS, x, z), tolerance);
            assert_true(reduced->damping[i * count + j] == reduced->damping[j * count + i]);
        }
        for (int32_t k = 0; k < dofs; k++) load += z[k] * rig->basis.responses.unit_load[k];
        assert_near("f", reduced->load[j], load, tolerance);
    }
    free(mass);
}

TEST(test_matrices)
{
    // Always made by the mesh; never, which costs some digits of what little of a response is new.
    static const struct {
        double loss_max, tolerance;
    } cases[] = {{0, 1e-11}, {1e300, 1e-7}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Rig rig;
        start(&rig, cases[k].loss_max);
        assert_int_equal(rig.basis.interior_count, 1);   // the load's
        extend(&rig, (ParameterPoint){0, 0.4}, 3);
        extend(&rig, (ParameterPoint){1, 30}, 2);
        assert_int_equal(rig.basis.interior_count, 6);
        assert_matrices(&rig, cases[k].tolerance);
        end(&rig);
    }
}

// A response that is in the basis already adds nothing to it.
TEST(test_dependent_responses)
{
    Rig rig;
    start(&rig, 0);
    extend(&rig, (ParameterPoint){0, 0.4}, 3);
    extend(&rig, (ParameterPoint){0, 0.4}, 3);
    assert_int_equal(rig.basis.interior_count, 4);
    assert_matrices(&rig, 1e-11);
    assert_int_equal(rig.reduced.count, rig.block.interface_count + 4);
    end(&rig);
}

// Where S of the basis differs from that of the mesh, of its diagonal, in columns that were given.
static double largest_error(const Rig *rig, ParameterPoint point, int32_t columns)
{
    Error err = {0};
    BulkOperator mesh = rig->mesh;
    int32_t m = rig->block.interface_count;
    double *schur = hand_matrix(m, m), energy, largest = 0;
    const double factors[] = {[BULK_STIFFNESS] = 1 - point.viscosity,
                              [BULK_DAMPING] = point.viscosity,
                              [BULK_MASS] = point.inertia};
    OperatorTerms terms = parameter_terms(point, &rig->block.def.scales);
    terms.lift = true;
    InterfaceOperator *full = interface_operator_create(&mesh, terms, &err);
    assert_non_null(full);
    const double *exact = interface_operator_schur(full);
    bool definite = false;
    assert_true(basis_condense(&rig->basis, factors, schur, &energy, &definite, &err) && definite);
    for (int32_t at = 0; at < m * columns; at++)
        largest = fmax(largest, fabs(schur[at] - exact[at]) / fabs(exact[at % m * (m + 1)]));
    interface_operator_destroy(full);
    free(schur);
    return largest;
}

// (Products of responses lose some 1e-12 here.) The same ones again bring nothing but rounding.
TEST(test_responses_are_those_of_the_mesh)
{
    const ParameterPoint points[] = {{0.2, 3}, {0.9, 500}, {0.2, 3}};
    for (int formed = 0; formed < 2; formed++) {
        Rig rig;
        start(&rig, formed ? 0 : 1e300);
        for (int k = 0; k < 3; k++) extend(&rig, points[k], 5);
        assert_int_equal(rig.basis.interior_count, 11);   // that of the load, too
        for (int k = 0; k < 2; k++) assert_near("S", largest_error(&rig, points[k], 5), 0, 1e-10);
        end(&rig);
    }
}

// A of the basis as it is, Phi neither orthogonal nor of length 1.
TEST(test_condensed)
{
    Rig rig;
    Error err = {0};
    start(&rig, 1e300);
    extend(&rig, (ParameterPoint){0, 0.4}, 4);
    const Basis *basis = &rig.basis;
    int32_t m = basis->interface_count, r = basis->interior_count, count = m + r;
    double factor[BULK_TERMS] = {0.7, 0.3, 5}, energy = 0, wanted = 0;
    double *a = hand_matrix(count, count), *schur = hand_matrix(m, m), *made = hand_matrix(m, m);
    double *inner = hand_matrix(r, r), *response = hand_matrix(r, 1);
    int32_t border[200];
    for (int32_t k = 0; k < m; k++) border[k] = k;
    for (int term = 0; term < BULK_TERMS; term++) {
        for (int32_t k = 0; k < m * m; k++)
            a[k / m * count + k % m] += factor[term] * basis->statics[term][k];
        for (int32_t k = 0; k < r * r; k++)
            a[(m + k / r) * count + m + k % r] += factor[term] * basis->interior[term][k];
        for (int32_t k = 0; basis->beside[term] && k < m * r; k++) {
            a[(m + k / m) * count + k % m] += factor[term] * basis->beside[term][k];
            a[k % m * count + m + k / m] += factor[term] * basis->beside[term][k];
        }
    }
    hand_schur(a, count, border, m, schur);
    bool definite = false;
    if (!basis_condense(basis, factor, made, &energy, &definite, &err)) fail_msg("%s", err.message);
    assert_true(definite);
    assert_all_near("S", made, schur, m * m, 1e-11);
    for (int32_t j = 0; j < r; j++) {
        for (int32_t i = 0; i < r; i++) inner[j * r + i] = a[(m + j) * count + m + i];
        response[j] = basis->load[m + j];
    }
    assert_true(hand_solve(inner, r, response, 1));
    for (int32_t j = 0; j < r; j++) wanted += response[j] * basis->load[m + j];
    assert_near("energy", energy, wanted, 1e-12);
    factor[BULK_STIFFNESS] = -1e6;
    assert_true(basis_condense(basis, factor, made, &energy, &definite, &err));
    assert_false(definite);
    free(a), free(schur), free(made), free(inner), free(response);
    end(&rig);
}
