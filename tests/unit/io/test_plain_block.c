// SPDX-License-Identifier: GPL-2.0-or-later
// A plain block is what gmsh makes of the same script, to the bit and to the number; what is not
// plain is left to gmsh. gmsh's own is made of a copy of meshes/block.geo with a comment more.
#include "io/plain_block.h"

#include "base/memory.h"
#include "io/mesh_source.h"
#include "result_place.h"

enum { PATH_SIZE = 2 * PLACE_SIZE, PARAMETERS_MAX = 6 };

static char folder[PLACE_SIZE], ours[PATH_SIZE], gmshs[PATH_SIZE];

// Writes the copy, `ending` behind it.
static void copy_block(const char *to, const char *ending)
{
    FILE *from = fopen(ours, "rb"), *copy = fopen(to, "wb");
    assert_true(from && copy);
    for (int letter; (letter = fgetc(from)) != EOF;) fputc(letter, copy);
    fputs(ending, copy);
    assert_int_equal(fclose(copy), 0);
    fclose(from);
}

static int make_copy(void **state)
{
    (void)state;
    place_make(folder);
    snprintf(ours, sizeof ours, "%s/meshes/block.geo", getenv("AMONTONS_SOURCE"));
    snprintf(gmshs, sizeof gmshs, "%s/block.geo", folder);
    copy_block(gmshs, "// by gmsh\n");
    return setenv("AMONTONS_CACHE", "", 1);
}

static int remove_copy(void **state)
{
    (void)state;
    place_remove(folder);
    return 0;
}

static bool make(const char *path, const MeshParameter *parameters, int32_t count, MeshFile *mesh)
{
    Error err = {0};
    bool made = true;
    *mesh = (MeshFile){0};
    if (!plain_block_make(path, parameters, count, mesh, &made, &err)) fail_msg("%s", err.message);
    return made;
}

#define SAME(one, other, count) assert_memory_equal(one, other, (size_t)(count) * sizeof *(one))

static void compare_groups(const MeshGroup *group, const MeshGroup *by_gmsh)
{
    assert_string_equal(group->name, by_gmsh->name);
    assert_int_equal(group->dimension, by_gmsh->dimension);
    assert_int_equal(group->number, by_gmsh->number);
    assert_int_equal(group->edge_count, by_gmsh->edge_count);
    assert_int_equal(group->nodes_per_edge, by_gmsh->nodes_per_edge);
    assert_int_equal(group->node_count, by_gmsh->node_count);
    assert_int_equal(group->element_count, by_gmsh->element_count);
    assert_int_equal(group->blurred, by_gmsh->blurred);
    int32_t ends = group->edge_count * group->nodes_per_edge;
    if (ends) SAME(group->edge_nodes, by_gmsh->edge_nodes, ends);
    if (group->node_count) SAME(group->nodes, by_gmsh->nodes, group->node_count);
    if (group->element_count) SAME(group->elements, by_gmsh->elements, group->element_count);
}

static void compare_with_gmsh(const MeshParameter *parameters, int32_t count)
{
    Error err = {0};
    MeshFile mesh, by_gmsh;
    assert_true(make(ours, parameters, count, &mesh));
    if (!mesh_file_read(gmshs, parameters, count, &by_gmsh, &err)) fail_msg("%s", err.message);
    assert_int_equal(mesh.node_count, by_gmsh.node_count);
    assert_int_equal(mesh.element_count, by_gmsh.element_count);
    assert_int_equal(mesh.group_count, by_gmsh.group_count);
    SAME(mesh.node_number, by_gmsh.node_number, mesh.node_count);
    SAME(mesh.element_number, by_gmsh.element_number, mesh.element_count);
    SAME(mesh.kind, by_gmsh.kind, mesh.element_count);
    SAME(mesh.first_node, by_gmsh.first_node, mesh.element_count + 1);
    SAME(mesh.element_nodes, by_gmsh.element_nodes, mesh.first_node[mesh.element_count]);
    SAME(mesh.position, by_gmsh.position, 2 * mesh.node_count);
    for (int32_t k = 0; k < mesh.group_count; k++)
        compare_groups(&mesh.groups[k], &by_gmsh.groups[k]);
    mesh_file_destroy(&mesh);
    mesh_file_destroy(&by_gmsh);
}

#define NUMBER(of, is)                                                                             \
    {                                                                                              \
        .name = of, .value = is                                                                    \
    }
#define TEXT(of, is)                                                                               \
    {                                                                                              \
        .name = of, .text = is                                                                     \
    }

static void test_known_file(void **state)
{
    (void)state;
    char text[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    Error err = {0};
    MeshFile mesh;
    bool whole = false;
    assert_true(mesh_source_hash(ours, NULL, 0, &hash, &whole, &err));
    hash_write(&hash, text);
    if (!make(ours, NULL, 0, &mesh))
        fail_msg("meshes/block.geo was edited: BLOCK_GEO becomes %s once the others agree", text);
    mesh_file_destroy(&mesh);
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
    compare_with_gmsh(NULL, 0);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        int32_t count = 0;
        while (count < PARAMETERS_MAX && cases[k][count].name[0]) count++;
        compare_with_gmsh(cases[k], count);
    }
}

// What gmsh has to make, or to refuse.
static void test_left_to_gmsh(void **state)
{
    (void)state;
    static const MeshParameter other[] = {TEXT("shape", "triangle"), TEXT("layout", "alternate"),
                                          TEXT("layout", "free"),    NUMBER("order", 2),
                                          NUMBER("crown", 0.01),     NUMBER("edge_radius", 1),
                                          NUMBER("grade_x", 2),      NUMBER("grade_z", 3),
                                          NUMBER("nx", 2.5),         NUMBER("nx", 0),
                                          NUMBER("nz", -3),          NUMBER("length", 0),
                                          NUMBER("height", -1),      NUMBER("refine", 0),
                                          NUMBER("refine", 1000),    NUMBER("length", 1e9),
                                          NUMBER("height", 1e-9),    NUMBER("unknown", 1)};
    MeshFile mesh;
    for (size_t k = 0; k < sizeof other / sizeof other[0]; k++)
        if (make(ours, &other[k], 1, &mesh)) fail_msg("%s is made", other[k].name);
}

static void test_left_to_gmsh_by_its_file(void **state)
{
    (void)state;
    char copy[PATH_SIZE], options[PATH_SIZE + 8];
    MeshFile mesh;
    snprintf(copy, sizeof copy, "%s/copy.geo", folder);
    snprintf(options, sizeof options, "%s.opt", copy);
    assert_false(make(gmshs, NULL, 0, &mesh));
    copy_block(copy, "");
    assert_true(make(copy, NULL, 0, &mesh));
    mesh_file_destroy(&mesh);
    place_write(folder, "copy.geo.opt", "Mesh.ElementOrder = 2;\n");
    assert_false(make(copy, NULL, 0, &mesh));
}

// Every allocation that may fail does so once, and frees what there is.
static void test_without_memory(void **state)
{
    (void)state;
    static const MeshParameter cells[] = {NUMBER("nx", 3), NUMBER("nz", 2)};
    int64_t live = memory_counters().live;
    bool made = false, done = false;
    for (int32_t k = 0; !done; k++) {
        MeshFile mesh = {0};
        Error err = {0};
        memory_fail_after(k);
        done = plain_block_make(ours, cells, 2, &mesh, &made, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        mesh_file_destroy(&mesh);
        assert_int_equal(memory_counters().live, live);
    }
    assert_true(made);
}

// A whole read needs no gmsh, and keeps nothing that can be made anew as fast.
static void test_read_without_gmsh(void **state)
{
    (void)state;
    static const MeshParameter cells[] = {NUMBER("nx", 3), NUMBER("nz", 2)};
    char place[PATH_SIZE];
    Error err = {0};
    MeshFile mesh;
    const char *modules = getenv("AMONTONS_MODULES");
    snprintf(place, sizeof place, "%s", modules ? modules : "");
    setenv("AMONTONS_MODULES", folder, 1);
    bool done = mesh_file_read(ours, cells, 2, &mesh, &err);
    modules ? setenv("AMONTONS_MODULES", place, 1) : unsetenv("AMONTONS_MODULES");
    if (!done) fail_msg("%s", err.message);
    assert_int_equal(mesh.element_count, 6);
    mesh_file_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_known_file),
                                       cmocka_unit_test(test_read_without_gmsh),
                                       cmocka_unit_test(test_gmshs_own),
                                       cmocka_unit_test(test_left_to_gmsh),
                                       cmocka_unit_test(test_left_to_gmsh_by_its_file),
                                       cmocka_unit_test(test_without_memory)};
    return cmocka_run_group_tests(tests, make_copy, remove_copy);
}
