// SPDX-License-Identifier: GPL-2.0-or-later
// From gmsh's tags to indices, with meshes written by hand as gmsh's interface delivers them: tags
// with holes and out of order, nodes that are missing, no numbers at all.
//
//      50 --- 35
//      |    /  |     two triangles on entity 1, the contact 10-20 on curve 1,
//      |  /    |     10-20 again on curve 2 with a middle node (40)
//      10 --- 20
#include "io/mesh/mesh_raw.h"

#include "base/memory.h"
#include "near.h"

enum { NODES = 5 };

typedef struct Raw {
    int64_t number[NODES];
    uint8_t dimension[NODES];
    double position[3 * NODES];
    int64_t triangle[2], triangle_nodes[6], edge[1], face_nodes[2], arc[1], arc_nodes[3];
    int32_t body[1], contact[2];
    RawBlock blocks[3];
    RawGroup groups[2];
    MeshRaw raw;
} Raw;

static void make(Raw *made)
{
    *made = (Raw){.number = {35, 10, 50, 20, 40},
                  .dimension = {2, 2, 2, 2, 1},
                  .position = {1, 1, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0.5, 0, 0},
                  .triangle = {7, 3},
                  .triangle_nodes = {10, 35, 50, 10, 20, 35},
                  .edge = {1},
                  .face_nodes = {10, 20},
                  .arc = {2},
                  .arc_nodes = {10, 20, 40},
                  .body = {1},
                  .contact = {1, 2}};
    made->blocks[0] = (RawBlock){.dimension = 2,
                                 .entity = 1,
                                 .gmsh_type = 2,
                                 .nodes_per_element = 3,
                                 .count = 2,
                                 .number = made->triangle,
                                 .nodes = made->triangle_nodes};
    made->blocks[1] = (RawBlock){.dimension = 1,
                                 .entity = 1,
                                 .gmsh_type = 1,
                                 .nodes_per_element = 2,
                                 .count = 1,
                                 .number = made->edge,
                                 .nodes = made->face_nodes};
    made->blocks[2] = (RawBlock){.dimension = 1,
                                 .entity = 2,
                                 .gmsh_type = 8,
                                 .nodes_per_element = 3,
                                 .count = 1,
                                 .number = made->arc,
                                 .nodes = made->arc_nodes};
    made->groups[0] = (RawGroup){
        .dimension = 2, .number = 9, .name = "body", .entity_count = 1, .entities = made->body};
    made->groups[1] =
        (RawGroup){.dimension = 1, .number = 4, .entity_count = 1, .entities = made->contact};
    made->raw = (MeshRaw){.node_count = NODES,
                          .node_number = made->number,
                          .node_dimension = made->dimension,
                          .node_position = made->position,
                          .block_count = 2,
                          .blocks = made->blocks,
                          .group_count = 2,
                          .groups = made->groups};
}

static void assert_refused(const Raw *made, const char *says)
{
    Error err = {0};
    MeshFile mesh;
    int64_t live = memory_counters().live;
    assert_false(mesh_raw_convert(&made->raw, "a.msh", &mesh, &err));
    mesh_file_destroy(&mesh);
    assert_int_equal(memory_counters().live, live);
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, says)) fail_msg("'%s' does not say '%s'", err.message, says);
}

TEST(test_tags_with_holes)
{
    Error err = {0};
    MeshFile mesh;
    Raw made;
    make(&made);
    if (!mesh_raw_convert(&made.raw, "a.msh", &mesh, &err)) fail_msg("%s", err.message);
    static const int64_t numbers[] = {10, 20, 35, 40, 50}, elements[] = {3, 7};
    static const int32_t nodes[] = {0, 1, 2, 0, 2, 4};   // of element 3, then of 7
    assert_int_equal(mesh.node_count, 5);   // 40 is on a curve: fem/mesh_build refuses it
    assert_memory_equal(mesh.node_number, numbers, sizeof numbers);
    assert_memory_equal(mesh.element_number, elements, sizeof elements);
    assert_memory_equal(mesh.element_nodes, nodes, sizeof nodes);
    assert_true(mesh.position[2 * 4] == 0 && mesh.position[2 * 4 + 1] == 1);
    assert_string_equal(mesh.groups[0].name, "4");   // of a group without a name, its number
    assert_int_equal(mesh.groups[0].face_nodes[1], 1);
    assert_int_equal(mesh.groups[1].element_count, 2);
    mesh_file_destroy(&mesh);
}

TEST(test_what_is_missing)
{
    Raw made;
    make(&made);
    made.triangle_nodes[2] = 51;   // above all tags
    assert_refused(&made, "element 7 uses node 51, which the file lacks");
    made.triangle_nodes[2] = 36;   // between them
    assert_refused(&made, "element 7 uses node 36, which the file lacks");
    made.triangle_nodes[2] = 5;   // below them
    assert_refused(&made, "element 7 uses node 5, which the file lacks");
    made.raw.node_count = 0;
    assert_refused(&made, "which the file lacks");
    make(&made);
    made.face_nodes[1] = 21;
    assert_refused(&made, "group '4' uses node 21, which the file lacks");
    make(&made);
    made.raw.block_count = 3;
    made.groups[1].entity_count = 2;
    assert_refused(&made, "group '4' mixes edges of 2 and 3 nodes");
    make(&made);
    made.groups[1].dimension = 2;
    made.groups[1].entities = made.body;
    snprintf(made.groups[1].name, sizeof made.groups[1].name, "body");
    assert_refused(&made, "'body' is used twice: by groups 9 and 4 of dimension 2");
}

// The number of a group without a name may be that of another dimension's, or another's name.
TEST(test_groups_by_dimension)
{
    Error err = {0};
    MeshFile mesh;
    Raw made;
    make(&made);
    snprintf(made.groups[0].name, sizeof made.groups[0].name, "4");
    made.groups[0].number = -2147483647;
    if (!mesh_raw_convert(&made.raw, "a.msh", &mesh, &err)) fail_msg("%s", err.message);
    assert_int_equal(mesh_file_group(&mesh, "a.msh", "4", 1, &err)->face_count, 1);
    assert_int_equal(mesh_file_group(&mesh, "a.msh", "4", 2, &err)->element_count, 2);
    mesh_file_destroy(&mesh);
}

// As gmsh reads numbers beyond its int, and negative ones.
TEST(test_numbers_out_of_range)
{
    Raw made;
    make(&made);
    made.number[4] = -2094967296;
    assert_refused(&made, "a node has the number -2094967296");
    make(&made);
    made.triangle[1] = -1;
    assert_refused(&made, "an element has the number -1");
}

TEST(test_positions)
{
    Raw made;
    for (int k = 0; k < 3; k++) {
        make(&made);
        made.position[3 + k] = k == 1 ? INFINITY : NAN;
        assert_refused(&made, "node 10 has a coordinate that is not a number");
    }
    make(&made);
    made.position[3 * 3 + 2] = 0.25;
    assert_refused(&made, "node 20 is at z = 0.25");
}

TEST(test_elements)
{
    Raw made;
    make(&made);
    made.blocks[0].gmsh_type = 4;
    snprintf(made.blocks[0].type_name, sizeof made.blocks[0].type_name, "Tetrahedron 4");
    assert_refused(&made, "element 7 is of a kind that is not supported, Tetrahedron 4");
    made.blocks[0].count = 0;
    assert_refused(&made, "element 0 is of a kind that is not supported");
    make(&made);
    made.blocks[0].count = 0;
    assert_refused(&made, "has no surface elements in its physical surfaces (5 nodes, 1 other");
    make(&made);
    made.blocks[1].gmsh_type = 26;   // a line of order 3
    snprintf(made.blocks[1].type_name, sizeof made.blocks[1].type_name, "Line 4");
    assert_refused(&made, "group '4' has elements of a kind that is not supported, Line 4");
}

// Format 2.2 writes an element once for each of its groups: the mesh has it once, in both.
TEST(test_copies)
{
    Error err = {0};
    MeshFile mesh;
    Raw made;
    int64_t numbers[] = {1, 5}, nodes[] = {10, 20, 10, 20};
    make(&made);
    made.groups[0] = made.groups[1];
    made.groups[0].number = 8;
    made.raw.block_count = 2;   // without a physical surface all flat elements count
    made.blocks[1].count = 2;
    made.blocks[1].number = numbers;
    made.blocks[1].nodes = nodes;
    if (!mesh_raw_convert(&made.raw, "a.msh", &mesh, &err)) fail_msg("%s", err.message);
    assert_int_equal(mesh.groups[0].face_count, 1);
    assert_int_equal(mesh.groups[1].face_count, 1);
    assert_int_equal(mesh.element_count, 2);
    mesh_file_destroy(&mesh);
}
