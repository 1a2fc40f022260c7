// SPDX-License-Identifier: GPL-2.0-or-later
// A slider on a base that share two nodes and an edge, and one region of them.
#include "io/mesh/mesh_pick.h"

#include "base/memory.h"
#include "../../fem/mesh_by_hand.h"
#include "near.h"

//     6---7
//     |   |      slider: element 2; base: elements 0, 1
//     3---4---5
//     |   |   |
//     0---1---2
static MeshFile two_bodies(void)
{
    static const double places[][2] = {{0, 0}, {1, 0}, {2, 0}, {0, 1},
                                       {1, 1}, {2, 1}, {0, 2}, {1, 2}};
    static const int32_t squares[] = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6};
    static const int32_t middle[][2] = {{3, 4}, {4, 5}}, low[][2] = {{0, 1}, {1, 2}},
                         side[][2] = {{0, 3}, {3, 6}}, right[][2] = {{2, 5}};
    static const int32_t base[] = {0, 1}, slider[] = {2};
    MeshFile file = hand_mesh(8, places, ELEMENT_Q4, 3, squares);
    hand_curve(&file, "middle", 2, middle);
    hand_curve(&file, "low", 2, low);
    hand_curve(&file, "side", 2, side);
    hand_curve(&file, "right", 1, right);
    file.groups[4] = (MeshGroup){.name = "base",
                                 .dimension = 2,
                                 .element_count = 2,
                                 .elements = hand_copy(base, 2, sizeof *base)};
    file.groups[5] = (MeshGroup){.name = "slider",
                                 .dimension = 2,
                                 .element_count = 1,
                                 .elements = hand_copy(slider, 1, sizeof *slider)};
    file.group_count = 6;
    return file;
}

TEST(test_one_of_two)
{
    static const char names[][GROUP_NAME_SIZE] = {"slider", "base"};
    static const int32_t nodes[] = {0, 1, 3, 2}, edge[] = {0, 1}, side[] = {0, 2};
    int64_t live = memory_counters().live;
    Error err = {0};
    MeshFile file = two_bodies();
    assert_true(mesh_file_pick("a.msh", names, 1, &file, &err));
    assert_int_equal(file.node_count, 4);
    assert_int_equal(file.node_number[0], 4);
    assert_true(file.position[0] == 0 && file.position[1] == 1 && file.position[7] == 2);
    assert_int_equal(file.element_count, 1);
    assert_int_equal(file.element_number[0], 3);
    assert_memory_equal(file.element_nodes, nodes, sizeof nodes);
    assert_int_equal(file.group_count, 3);   // low, right, base are gone
    assert_string_equal(file.groups[0].name, "middle");
    assert_int_equal(file.groups[0].face_count, 1);
    assert_memory_equal(file.groups[0].face_nodes, edge, sizeof edge);
    assert_int_equal(file.groups[0].node_count, 2);
    assert_string_equal(file.groups[1].name, "side");
    assert_memory_equal(file.groups[1].face_nodes, side, sizeof side);
    assert_string_equal(file.groups[2].name, "slider");
    assert_int_equal(file.groups[2].elements[0], 0);
    mesh_file_destroy(&file);
    file = two_bodies();
    assert_true(mesh_file_pick("a.msh", names, 2, &file, &err));
    assert_int_equal(file.node_count, 8);
    assert_int_equal(file.group_count, 6);
    mesh_file_destroy(&file);
    assert_int_equal(memory_counters().live, live);
}

TEST(test_no_such_region)
{
    static const char names[][GROUP_NAME_SIZE] = {"sliders", "middle"};
    for (int32_t k = 0; k < 2; k++) {
        Error err = {0};
        MeshFile file = two_bodies();
        assert_false(mesh_file_pick("a.msh", &names[k], 1, &file, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        assert_non_null(
            strstr(err.message, k ? "is a curve, wanted is a surface" : "did you mean 'slider'?"));
        mesh_file_destroy(&file);
    }
}
