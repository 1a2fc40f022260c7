// SPDX-License-Identifier: GPL-2.0-or-later
// Counts and sizes of meshes whose answers are plain to see, and of random ones against the outline
// of the block.
#include "block_mesh.h"
#include "fem/mesh.h"
#include "mesh_by_hand.h"
#include "near.h"

#include "plane.h"

// One rectangle, 3 by 4.
TEST(test_by_hand)
{
    static const double places[][2] = {{0, 0}, {3, 0}, {3, 4}, {0, 4}};
    static const int32_t corners[] = {0, 1, 2, 3};
    Error err = {0};
    Mesh mesh;
    MeshFile file = hand_mesh(4, places, ELEMENT_Q4, 1, corners);
    if (!mesh_build(&file, "one.msh", &mesh, &err)) fail_msg("%s", err.message);
    MeshSummary summary = mesh_summarise(&mesh);
    assert_int_equal(summary.element_counts[ELEMENT_Q4], 1);
    assert_int_equal(summary.element_counts[ELEMENT_T3], 0);
    assert_near("area", summary.area, 12, 1e-13);
    assert_near("shortest", summary.edge_min, 3, 0);
    assert_near("longest", summary.edge_max, 4, 0);
    assert_near("aspect", summary.aspect_max, 4.0 / 3, 1e-15);
    assert_int_equal(summary.aspect_worst, 0);
    mesh_destroy(&mesh);
}

// The second of two triangles is the needle: sides 3, 4, 5 and 4, 0.5 and their hypotenuse.
TEST(test_the_worst_is_named)
{
    static const double places[][2] = {{0, 0}, {3, 0}, {0, 4}, {-0.5, 0}};
    static const int32_t corners[] = {0, 1, 2, 0, 2, 3};
    Error err = {0};
    Mesh mesh;
    MeshFile file = hand_mesh(4, places, ELEMENT_T3, 2, corners);
    if (!mesh_build(&file, "two.msh", &mesh, &err)) fail_msg("%s", err.message);
    MeshSummary summary = mesh_summarise(&mesh);
    assert_int_equal(summary.element_counts[ELEMENT_T3], 2);
    assert_near("area", summary.area, 6 + 1, 1e-14);
    assert_near("shortest", summary.edge_min, 0.5, 0);
    assert_near("longest", summary.edge_max, 5, 1e-15);
    assert_near("aspect", summary.aspect_max, sqrt(16.25) / 0.5, 1e-13);
    assert_int_equal(summary.aspect_worst, 1);
    mesh_destroy(&mesh);
}

// Inner nodes moved at random change every element and not the whole: length times height.
TEST(test_blocks)
{
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        bool triangles = kind == ELEMENT_T3 || kind == ELEMENT_T6;
        BlockDef def = {.kind = (ElementKind)kind,
                        .nx = 4,
                        .nz = 3,
                        .length = 2,
                        .height = 0.75,
                        .distortion = 0.2,
                        .seed = 7};
        Mesh mesh;
        block_build(&def, &mesh);
        MeshSummary summary = mesh_summarise(&mesh);
        assert_int_equal(summary.element_counts[kind], triangles ? 24 : 12);
        assert_near("area", summary.area, 1.5, 1e-13);
        assert_true(summary.edge_min > 0 && summary.edge_min < 0.25);
        assert_true(summary.edge_max > (triangles ? sqrt(0.3125) : 0.5) * 0.9);
        assert_in_range(summary.aspect_worst, 0, mesh.element_count - 1);
        mesh_destroy(&mesh);
    }
}
