// SPDX-License-Identifier: GPL-2.0-or-later
// Products of responses, at points alike in viscosity, in inertia, in both and in neither, and
// of columns that are no responses, against
// x'K z, x'C z, x'M z formed by hand; combinations likewise.
#include "reduction/responses.h"

#include "base/memory.h"
#include "reduced_block.h"

static const Material MATERIAL = {
    .young = 2.5, .poisson = 0.34, .density = 1.3, .eta1 = 0.8, .eta2 = 0.3};
static const BlockDef SHAPE = {
    .kind = ELEMENT_Q4, .nx = 6, .nz = 5, .length = 1.4, .height = 0.5, .distortion = 0.2};

static const ParameterPoint POINTS[] = {{0, 0},     {0, 0},  {0, 0.4},   {1, 0.4}, {0.5, 0.4},
                                        {0.4, 0.5}, {1, 30}, {0.4, 3e3}, {0, 3e3}, {0.9, 200}};
enum { POINT_COUNT = sizeof POINTS / sizeof *POINTS, COLUMNS = 5, MAX = POINT_COUNT * COLUMNS };

typedef struct Rig {
    ReducedBlock block;   // not reduced
    BulkOperator mesh;
    Responses responses;
    Random random;
} Rig;

static void start(Rig *rig)
{
    Error err = {0};
    *rig = (Rig){.random = {.state = 5}};
    reduced_block_build(&SHAPE, &MATERIAL, 0.7, 0, &rig->block);
    assert_true(bulk_operator_create(&rig->block.bulk, NULL, rig->block.dofs,
                                     rig->block.interface_count, &rig->mesh, &err));
    assert_true(responses_create(&rig->mesh, &rig->block.def.scales, &rig->responses, &err));
    rig->responses.inertia_least = 0.1;
}

static void end(Rig *rig)
{
    responses_destroy(&rig->responses);
    bulk_operator_destroy(&rig->mesh);
    reduced_block_destroy(&rig->block);
}

// The next block: responses to boundary motions at random, the last column to the load.
static void response(Rig *rig, ParameterPoint point)
{
    Error err = {0};
    const BulkScales *scales = &rig->block.def.scales;
    int64_t dofs = rig->mesh.dof_count, m = rig->mesh.interface_count;
    OperatorTerms terms = {.mass = point.inertia / scales->mass,
                           .damping = point.viscosity / scales->damping,
                           .stiffness = (1 - point.viscosity) / scales->stiffness,
                           .lift = true};
    InterfaceOperator *full = interface_operator_create(&rig->mesh, terms, &err);
    ResponseBlock *next = responses_next(&rig->responses, point, COLUMNS, &err);
    assert_true(full && next);
    double *boundary = hand_matrix((int32_t)m, COLUMNS);
    for (int64_t k = 0; k < m * (COLUMNS - 1); k++)
        boundary[k] = random_between(&rig->random, -1, 1);
    assert_true(interface_operator_respond(full, boundary, COLUMNS - 1, next->field, &err));
    for (int64_t j = 0; j < COLUMNS - 1; j++) {
        memcpy(next->boundary + j * (m + 1), boundary + j * m, (size_t)m * sizeof *boundary);
        hand_apply(interface_operator_schur(full), (int32_t)m, (int32_t)m, boundary + j * m,
                   next->reaction + j * (m + 1));
    }
    double *pull = next->reaction + (COLUMNS - 1) * (m + 1);
    assert_true(interface_operator_respond_held(full, rig->responses.unit_load,
                                                next->field + (COLUMNS - 1) * dofs, pull, &err));
    for (int64_t i = 0; i < m; i++) pull[i] = -pull[i];
    pull[m] = 1;
    free(boundary);
    interface_operator_destroy(full);
}

// The next block becomes columns at random, 0 on the interface.
static void replace_by_others(Rig *rig)
{
    int32_t dofs = rig->mesh.dof_count;
    double *columns = hand_matrix(dofs, COLUMNS);
    for (int32_t k = 0; k < dofs * COLUMNS; k++) columns[k] = random_between(&rig->random, -1, 1);
    for (int32_t j = 0; j < COLUMNS; j++)
        for (int32_t i = 0; i < rig->mesh.interface_count; i++)
            columns[j * dofs + rig->mesh.interface_dofs[i]] = 0;
    responses_replace(&rig->responses, COLUMNS, columns);
    free(columns);
}

// x' T z, normalised.
static double product(const Rig *rig, BulkTerm term, const double *x, const double *z)
{
    const BulkScales *scales = &rig->block.def.scales;
    const double unit[] = {scales->stiffness, scales->damping, scales->mass};
    double *image = hand_matrix(rig->mesh.dof_count, 1), sum = 0;
    bulk_operator_apply(&rig->mesh, term, z, image);
    for (int32_t k = 0; k < rig->mesh.dof_count; k++) sum += x[k] * image[k];
    free(image);
    return sum / unit[term];
}

static const double *column(const Rig *rig, int64_t k)
{
    return rig->responses.blocks[k / COLUMNS].field + k % COLUMNS * rig->mesh.dof_count;
}

// An equation loses what the other terms of it weigh more than the one it gives: 1e-10 of the
// energies of x and z.
TEST(test_products)
{
    Error err = {0};
    Rig rig;
    start(&rig);
    for (int32_t p = 0; p < POINT_COUNT; p++) {
        response(&rig, POINTS[p]);
        if (p == 3 || p == 6) replace_by_others(&rig);
        int64_t all = (p + 1) * COLUMNS;
        double *gram[BULK_TERMS];
        for (int t = 0; t < BULK_TERMS; t++) gram[t] = hand_matrix((int32_t)all, COLUMNS);
        assert_true(responses_multiply(&rig.responses, gram, &err));
        for (int t = 0; t < BULK_TERMS; t++) {
            for (int64_t j = 0; j < COLUMNS; j++) {
                const double *z = column(&rig, all - COLUMNS + j);
                for (int64_t i = 0; i < all; i++) {
                    const double *x = column(&rig, i);
                    double scale = sqrt(product(&rig, t, x, x) * product(&rig, t, z, z));
                    assert_near("x'T z", gram[t][j * all + i], product(&rig, t, x, z),
                                1e-10 * scale);
                }
            }
            free(gram[t]);
        }
        responses_keep(&rig.responses);
    }
    end(&rig);
}

TEST(test_combination)
{
    Error err = {0};
    Rig rig;
    start(&rig);
    for (int32_t p = 0; p < 3; p++) {
        response(&rig, POINTS[p]);
        responses_keep(&rig.responses);
    }
    int32_t dofs = rig.mesh.dof_count, all = 3 * COLUMNS;
    double *c = hand_matrix(all, 2), *y = hand_matrix(dofs, 2), *wanted = hand_matrix(dofs, 2);
    for (int32_t k = 0; k < 2 * all; k++) c[k] = random_between(&rig.random, -1, 1);
    for (int32_t k = 0; k < 2 * dofs; k++) y[k] = wanted[k] = random_between(&rig.random, -1, 1);
    for (int32_t j = 0; j < 2; j++)
        for (int32_t i = 0; i < all; i++)
            for (int32_t k = 0; k < dofs; k++)
                wanted[j * dofs + k] += c[j * all + i] * column(&rig, i)[k];
    for (int32_t k = 0; k < 2; k++)
        for (int32_t i = 0; i < rig.mesh.interface_count; i++)
            wanted[k * dofs + rig.mesh.interface_dofs[i]] = 0;
    assert_true(responses_combine(&rig.responses, c, 2, y, &err));
    assert_all_near("y + X c", y, wanted, 2 * dofs, 1e-12);
    free(c), free(y), free(wanted);
    end(&rig);
}

// A block that is not kept leaves nothing but the room for its fields, which the next one takes;
// there is room for so many points only.
TEST(test_blocks)
{
    Error err = {0};
    Rig rig;
    start(&rig);
    int64_t live = memory_counters().live;
    assert_non_null(responses_next(&rig.responses, POINTS[0], 3, &err));
    assert_non_null(responses_next(&rig.responses, POINTS[1], 2, &err));   // in its place
    assert_non_null(
        responses_next(&rig.responses, POINTS[1], 200, &err));   // more than there was room
    responses_drop(&rig.responses);
    assert_int_equal(memory_counters().live, live + 1);
    assert_int_equal(rig.responses.count, 0);
    for (int32_t k = 0; k < RESPONSE_BLOCKS_MAX; k++) {
        assert_non_null(responses_next(&rig.responses, POINTS[0], 1, &err));
        responses_keep(&rig.responses);
    }
    assert_null(responses_next(&rig.responses, POINTS[0], 1, &err));
    assert_non_null(strstr(err.message, "more than"));
    end(&rig);
}
