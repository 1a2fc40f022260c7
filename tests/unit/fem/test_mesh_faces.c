// SPDX-License-Identifier: GPL-2.0-or-later
// The table of faces, in the plane edges, against Euler's formula and against what is known of a
// block's sides.
#include "fem/mesh_faces.h"

#include "base/memory.h"
#include "cases.h"
#include "mesh_by_hand.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

// A square, and on its right a triangle on the same side.
//     3---2
//     |   | .
//     0---1---4
static const double PLACES[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}};
static const int32_t NODES[] = {0, 1, 2, 3, 1, 4, 2, 0};

static void build(Mesh *mesh)
{
    Error err = {0};
    MeshFile file = hand_mesh(5, PLACES, ELEMENT_Q4, 2, NODES);
    file.kind[1] = ELEMENT_T3;
    file.first_node[2] = 7;
    assert_true(mesh_build(&file, "two.msh", mesh, &err));
}

static FaceNodes edge_of(const int32_t *ends)
{
    return (FaceNodes){ELEMENT_L2, ends};
}

TEST(test_find)
{
    Error err = {0};
    Mesh mesh;
    MeshFaces table;
    build(&mesh);
    assert_true(mesh_faces_build(&mesh, &table, &err));
    const MeshFace *shared = mesh_faces_find(&table, edge_of((int32_t[]){2, 1}));
    assert_non_null(shared);
    assert_ptr_equal(shared, mesh_faces_find(&table, edge_of((int32_t[]){1, 2})));
    assert_int_equal(shared->key.corner[0], 1);
    assert_int_equal(shared->key.corner[1], 2);
    assert_int_equal(shared->elements, 2);
    assert_int_equal(shared->key.inner[0], -1);
    assert_int_equal(mesh_faces_find(&table, edge_of((int32_t[]){1, 4}))->elements, 1);
    assert_int_equal(mesh_faces_find(&table, edge_of((int32_t[]){4, 2}))->element, 1);
    assert_null(mesh_faces_find(&table, edge_of((int32_t[]){0, 2})));   // a diagonal
    assert_null(mesh_faces_find(&table, edge_of((int32_t[]){3, 4})));
    mesh_faces_destroy(&table);
    mesh_faces_destroy(&table);
    mesh_destroy(&mesh);
}

// A disc: corners - edges + elements = 1. On the boundary as many edges as the four curves have.
TEST(test_euler)
{
    static const char *const shapes[] = {"quad", "triangle"};
    for (int32_t k = 0; k < 4; k++) {
        MeshParameter parameters[] = {{"nx", 10, ""},
                                      {"nz", 6, ""},
                                      {"shape", 0, ""},
                                      {"layout", 0, "free"},
                                      {"order", 1 + k / 2, ""}};
        char path[600];
        Error err = {0};
        MeshFile file;
        Mesh mesh;
        MeshFaces table;
        snprintf(parameters[2].text, GROUP_NAME_SIZE, "%s", shapes[k % 2]);
        snprintf(path, sizeof path, "%s/meshes/block.geo", getenv("AMONTONS_SOURCE"));
        if (!mesh_file_read(path, parameters, 5, false, NULL, &file, &err) ||
            !mesh_build(&file, path, &mesh, &err) || !mesh_faces_build(&mesh, &table, &err))
            fail_msg("%s", err.message);
        int32_t edges = 0, middles = 0, boundary = 0, centres = 0;
        for (int32_t i = 0; i < mesh.node_count; i++)
            for (int32_t j = table.first[i]; j < table.last[i]; j++) {
                edges++;
                middles += table.faces[j].key.inner[0] >= 0;
                boundary += table.faces[j].elements == 1;
            }
        for (int32_t e = 0; e < mesh.element_count; e++) centres += mesh.kind[e] == ELEMENT_Q9;
        assert_int_equal(mesh.node_count - middles - centres - edges + mesh.element_count, 1);
        assert_int_equal(middles, k / 2 ? edges : 0);
        assert_int_equal(boundary, 2 * (10 + 6));
        mesh_faces_destroy(&table);
        mesh_destroy(&mesh);
    }
}

TEST(test_memory_faults)
{
    Mesh mesh;
    bool done = false;
    build(&mesh);
    int64_t live = memory_counters().live;
    for (int64_t k = 0; !done; k++) {
        Error err = {0};
        MeshFaces table;
        memory_fail_after(k);
        done = mesh_faces_build(&mesh, &table, &err);
        memory_fail_after(-1);
        mesh_faces_destroy(&table);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
    }
    mesh_destroy(&mesh);
}
