// SPDX-License-Identifier: GPL-2.0-or-later
// A plain block is what gmsh makes of the same script, to the bit and to the number; what is not
// plain is left to gmsh. gmsh's own is made of a copy of meshes/block.geo with a comment more.
#include "plain_by_gmsh.h"
#include "random_numbers.h"

#include <math.h>

enum { PARAMETERS_MAX = 6, GRADED_SETS = 60 };

static int begin(void **state)
{
    (void)state;
    return plain_begin("block.geo");
}

static void test_known_file(void **state)
{
    (void)state;
    plain_test_known();
}

// Sizes with and without an end in binary; a cell, a row, a column; more cells than gmsh has parts
// of a curve; blocks so small that gmsh finds its plane by other points, or by singular values.
static void test_gmshs_own(void **state)
{
    (void)state;
    static const MeshParameter cases[][PARAMETERS_MAX] = {
        {NUMBER("nx", 8), NUMBER("nz", 6)},
        {NUMBER("nx", 1), NUMBER("nz", 1)},
        {NUMBER("nx", 1), NUMBER("nz", 5), NUMBER("length", 0.3)},
        {NUMBER("nx", 7), NUMBER("nz", 1), NUMBER("height", 0.7)},
        {NUMBER("nx", 150), NUMBER("nz", 3), NUMBER("height", 0.1)},
        {NUMBER("nx", 128), NUMBER("nz", 2)},
        {NUMBER("length", 0.17952920433977623), NUMBER("height", 0.59130622122504151),
         NUMBER("nx", 5), NUMBER("nz", 35)},
        {NUMBER("length", 0.33492435868963399), NUMBER("height", 0.80093192317123174),
         NUMBER("nx", 14), NUMBER("nz", 26)},
        {NUMBER("length", 0.013), NUMBER("height", 0.085), NUMBER("nx", 9), NUMBER("nz", 7)},
        {NUMBER("length", 0.085), NUMBER("height", 0.012), NUMBER("nx", 9), NUMBER("nz", 7)},
        {NUMBER("length", 2100), NUMBER("height", 33.3), NUMBER("nx", 6), NUMBER("nz", 6)},
        {NUMBER("nx", 5), NUMBER("nz", 3), NUMBER("refine", 1.5)},
        {NUMBER("nx", 8), NUMBER("nz", 8), NUMBER("refine", 0.05), NUMBER("crown", 0)},
        {NUMBER("nx", 3), NUMBER("nz", 4), TEXT("shape", "quad"), TEXT("layout", "regular"),
         NUMBER("order", 1), NUMBER("grade_z", 1)}};
    assert_true(plain_is_gmshs(NULL, 0));
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        int32_t count = 0;
        while (count < PARAMETERS_MAX && cases[k][count].name[0]) count++;
        assert_true(plain_is_gmshs(cases[k], count));
    }
}

// Finer towards the ends of the contact, or towards their middle; towards it or away from it.
static void test_graded(void **state)
{
    (void)state;
    Random random = {1};
    for (int32_t k = 0; k < GRADED_SETS; k++) {
        const MeshParameter set[] = {
            NUMBER("length", pow(10, random_between(&random, -2, 2))),
            NUMBER("height", random_between(&random, 0.1, 2)),
            NUMBER("nx", 1 + random_index(&random, 60)),
            NUMBER("nz", 1 + random_index(&random, 60)),
            NUMBER("grade_x", k % 3 ? pow(10, random_between(&random, -1, 2)) : 1),
            NUMBER("grade_z", k % 4 ? pow(10, random_between(&random, -2, 2)) : 1)};
        assert_true(plain_is_gmshs(set, sizeof set / sizeof set[0]));
    }
}

// What gmsh has to make, or to refuse.
static void test_left_to_gmsh(void **state)
{
    (void)state;
    static const MeshParameter other[] = {TEXT("shape", "triangle"), TEXT("layout", "alternate"),
                                          TEXT("layout", "free"),    NUMBER("order", 2),
                                          NUMBER("crown", 0.01),     NUMBER("edge_radius", 1),
                                          NUMBER("grade_x", 1e5),    NUMBER("grade_z", -1),
                                          NUMBER("nx", 2.5),         NUMBER("nx", 0),
                                          NUMBER("nz", -3),          NUMBER("length", 0),
                                          NUMBER("height", -1),      NUMBER("refine", 0),
                                          NUMBER("refine", 1000),    NUMBER("length", 1e9),
                                          NUMBER("height", 1e-9),    NUMBER("unknown", 1)};
    MeshFile mesh;
    for (size_t k = 0; k < sizeof other / sizeof other[0]; k++)
        if (plain_make(ours, &other[k], 1, &mesh)) fail_msg("%s is made", other[k].name);
}

static void test_left_to_gmsh_by_its_file(void **state)
{
    (void)state;
    char copy[PLAIN_PATH_SIZE];
    MeshFile mesh;
    snprintf(copy, sizeof copy, "%s/copy.geo", plain_folder);
    assert_false(plain_make(gmshs, NULL, 0, &mesh));
    plain_copy(copy, "");
    assert_true(plain_make(copy, NULL, 0, &mesh));
    mesh_file_destroy(&mesh);
    place_write(plain_folder, "copy.geo.opt", "Mesh.ElementOrder = 2;\n");
    assert_false(plain_make(copy, NULL, 0, &mesh));
}

static void test_without_memory(void **state)
{
    (void)state;
    static const MeshParameter cells[] = {NUMBER("nx", 3), NUMBER("nz", 2), NUMBER("grade_z", 9)};
    plain_test_without_memory(cells, 3);
}

// A whole read needs no gmsh, and keeps nothing that can be made anew as fast.
static void test_read_without_gmsh(void **state)
{
    (void)state;
    static const MeshParameter cells[] = {NUMBER("nx", 3), NUMBER("nz", 2)};
    assert_int_equal(plain_read_alone(cells, 2), 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_file),    cmocka_unit_test(test_read_without_gmsh),
        cmocka_unit_test(test_gmshs_own),     cmocka_unit_test(test_graded),
        cmocka_unit_test(test_left_to_gmsh),  cmocka_unit_test(test_left_to_gmsh_by_its_file),
        cmocka_unit_test(test_without_memory)};
    return cmocka_run_group_tests(tests, begin, plain_end);
}
