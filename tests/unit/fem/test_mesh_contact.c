// SPDX-License-Identifier: GPL-2.0-or-later
// The contact line of one curve, of pads, of neighbours that share a node; and what it refuses.
#include "fem/mesh.h"

#include "base/memory.h"
#include "cases.h"
#include "mesh_by_hand.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Three squares of side 1 in a row.
//     4---5---6---7
//     |   |   |   |
//     0---1---2---3
static const double PLACES[][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 1}, {1, 1}, {2, 1}, {3, 1}};
static const int32_t SQUARES[] = {0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6};
static const int32_t LEFT[][2] = {{0, 1}}, MIDDLE[][2] = {{2, 1}}, RIGHT[][2] = {{2, 3}};

static void build(const double (*places)[2], const char *const *names,
                  const int32_t (*const *pairs)[2], int32_t curves, Mesh *mesh)
{
    Error err = {0};
    MeshFile file = hand_mesh(8, places, ELEMENT_Q4, 3, SQUARES);
    for (int32_t k = 0; k < curves; k++) hand_curve(&file, names[k], 1, pairs[k]);
    if (!mesh_build(&file, "block.msh", mesh, &err)) fail_msg("%s", err.message);
}

static void refuse(const Mesh *mesh, const char (*names)[GROUP_NAME_SIZE], int32_t count,
                   const char *one, const char *two)
{
    Error err = {0};
    MeshContact contact;
    bool done = mesh_contact(mesh, names, count, &contact, &err);
    mesh_contact_destroy(&contact);
    assert_false(done);
    assert_int_equal(err.code, ERROR_INPUT);
    assert_ptr_equal(strstr(err.message, "block.msh: "), err.message);
    if (!strstr(err.message, one)) fail_msg("'%s' is not in: %s", one, err.message);
    if (two && !strstr(err.message, two)) fail_msg("'%s' is not in: %s", two, err.message);
}

// Pads at both ends, the right one first in the file: ordered by x all the same. The gap's nodes
// belong to the pads' ends.
TEST(test_pads_by_default_names)
{
    static const char *const names[] = {"contact_1", "contact_2", "contactless"};
    static const int32_t(*const pairs[])[2] = {RIGHT, LEFT, MIDDLE};
    static const int32_t nodes[] = {0, 1, 2, 3}, owners[] = {0, 0, 1, 1};
    Error err = {0};
    Mesh mesh;
    MeshContact contact;
    build(PLACES, names, pairs, 3, &mesh);
    assert_true(mesh_contact(&mesh, NULL, 0, &contact, &err));
    assert_int_equal(contact.pad_count, 2);
    assert_string_equal(contact.pads[0].name, "contact_2");
    assert_int_equal(contact.node_count, 4);
    assert_memory_equal(contact.nodes, nodes, sizeof nodes);
    assert_memory_equal(contact.pad_of, owners, sizeof owners);
    mesh_contact_destroy(&contact);
    mesh_contact_destroy(&contact);
    mesh_destroy(&mesh);
}

// Named curves keep the order given; a node they share is listed once, with the first.
TEST(test_neighbours)
{
    static const char *const names[] = {"west", "mid", "east"};
    static const int32_t(*const pairs[])[2] = {LEFT, MIDDLE, RIGHT};
    static const char asked[][GROUP_NAME_SIZE] = {"east", "mid", "west"};
    static const int32_t nodes[] = {0, 1, 2, 3}, owners[] = {2, 1, 0, 0};
    Error err = {0};
    Mesh mesh;
    MeshContact contact;
    build(PLACES, names, pairs, 3, &mesh);
    assert_true(mesh_contact(&mesh, asked, 3, &contact, &err));
    assert_int_equal(contact.pad_count, 3);
    assert_string_equal(contact.pads[0].name, "east");
    assert_int_equal(contact.node_count, 4);
    assert_memory_equal(contact.nodes, nodes, sizeof nodes);
    assert_memory_equal(contact.pad_of, owners, sizeof owners);
    mesh_contact_destroy(&contact);
    mesh_destroy(&mesh);
}

TEST(test_missing)
{
    static const char *const names[] = {"contacts"};
    static const int32_t(*const pairs[])[2] = {LEFT};
    static const char asked[][GROUP_NAME_SIZE] = {"contacs"};
    Mesh mesh;
    build(PLACES, names, pairs, 1, &mesh);
    refuse(&mesh, NULL, 0, "has no group 'contact'", "'contacts' (curve)");
    refuse(&mesh, asked, 1, "has no group 'contacs'", "did you mean 'contacts'?");
    mesh_destroy(&mesh);
}

// Nodes over z = 0 have a gap, rounding is none; one must lie on it.
TEST(test_gaps)
{
    static const char *const names[] = {"contact_1", "contact_2"};
    static const int32_t(*const pairs[])[2] = {LEFT, RIGHT};
    double places[8][2];
    Error err = {0};
    Mesh mesh;
    MeshContact contact;
    memcpy(places, PLACES, sizeof places);
    places[2][1] = 1e-12, places[3][1] = 2e-5;
    build(places, names, pairs, 2, &mesh);
    assert_true(mesh_contact(&mesh, NULL, 0, &contact, &err));
    assert_true(mesh_gap(&mesh, contact.nodes[0]) == 0);
    assert_true(mesh_gap(&mesh, 2) == 0 && mesh_gap(&mesh, 3) == 2e-5);
    mesh_contact_destroy(&contact);
    mesh_destroy(&mesh);
    for (int32_t i = 0; i < 8; i++) places[i][1] = PLACES[i][1] + 1;   // in the air
    build(places, names, pairs, 2, &mesh);
    refuse(&mesh, NULL, 0, "no contact node lies on z = 0", "has z = 1");
    mesh_destroy(&mesh);
}

TEST(test_faces_and_folds)
{
    static const char *const names[] = {"contact"};
    static const int32_t round[][2] = {{0, 1}, {2, 1}, {2, 3}, {3, 7}};
    static const int32_t(*const pairs[])[2] = {round};
    double places[8][2];
    Error err = {0};
    Mesh mesh;
    MeshFile file;
    memcpy(places, PLACES, sizeof places);
    for (int32_t fold = 0; fold < 3; fold++) {
        places[7][0] = fold == 0 ? 3 : fold == 1 ? 2.5 : 3.5;
        file = hand_mesh(8, (const double(*)[2])places, ELEMENT_Q4, 3, SQUARES);
        hand_curve(&file, names[0], 4, pairs[0]);
        if (!mesh_build(&file, "block.msh", &mesh, &err)) fail_msg("%s", err.message);
        if (fold < 2)
            refuse(&mesh, NULL, 0, "contact group 'contact'",
                   fold ? "turns back" : "goes straight up at x = 3, from z = 0 to 1");
        MeshContact contact;
        if (fold == 2) assert_true(mesh_contact(&mesh, NULL, 0, &contact, &err));   // leans out
        if (fold == 2) mesh_contact_destroy(&contact);
        mesh_destroy(&mesh);
    }
}

TEST(test_below_the_substrate)
{
    static const char *const names[] = {"contact"};
    static const int32_t top[][2] = {{6, 7}};
    static const int32_t(*const pairs[])[2] = {top};
    double places[8][2];
    Mesh mesh;
    for (int32_t i = 0; i < 8; i++) {
        places[i][0] = PLACES[i][0];
        places[i][1] = PLACES[i][1] - 1;
    }
    build(places, names, pairs, 1, &mesh);
    refuse(&mesh, NULL, 0, "reaches down to z = -1", "'contact'");
    mesh_destroy(&mesh);
}

TEST(test_overlap)
{
    static const char *const names[] = {"contact", "contact_left"};
    static const int32_t both[][2] = {{0, 1}, {1, 2}};
    Error err = {0};
    Mesh mesh;
    MeshFile file = hand_mesh(8, PLACES, ELEMENT_Q4, 3, SQUARES);
    hand_curve(&file, names[0], 2, both);
    hand_curve(&file, names[1], 1, LEFT);
    assert_true(mesh_build(&file, "block.msh", &mesh, &err));
    refuse(&mesh, NULL, 0, "both have the edge", "'contact' and 'contact_left'");
    mesh_destroy(&mesh);
}

// An edge with an element on either side, and a block of whose notch both sides end in one place.
TEST(test_inside_and_unglued)
{
    static const double stacked[][2] = {{0, -1}, {1, -1}, {0, 0}, {1, 0}, {0, 1}, {1, 1}};
    static const double split[][2] = {{0, 0}, {1, 0},   {1, 1}, {0, 1}, {1, 0},   {2, 0},
                                      {2, 1}, {1.2, 1}, {0, 2}, {1, 2}, {1.2, 2}, {2, 2}};
    static const int32_t tower[] = {0, 1, 3, 2, 2, 3, 5, 4},
                         halves[] = {0, 1, 2, 3, 4, 5, 6, 7, 3, 2, 9, 8, 2, 7, 10, 9, 7, 6, 11, 10};
    static const int32_t inner[][2] = {{2, 3}}, bottom[][2] = {{0, 1}, {4, 5}};
    Error err = {0};
    Mesh mesh;
    MeshFile file = hand_mesh(6, stacked, ELEMENT_Q4, 2, tower);
    hand_curve(&file, "contact", 1, inner);
    assert_true(mesh_build(&file, "block.msh", &mesh, &err));
    refuse(&mesh, NULL, 0, "'contact' runs inside the block", NULL);
    mesh_destroy(&mesh);
    file = hand_mesh(12, split, ELEMENT_Q4, 5, halves);   // a notch that ends at the floor
    hand_curve(&file, "contact", 2, bottom);
    assert_true(mesh_build(&file, "block.msh", &mesh, &err));
    refuse(&mesh, NULL, 0, "both at x = 1", "not glued");
    mesh_destroy(&mesh);
}

TEST(test_memory_faults)
{
    static const char *const names[] = {"contact_1", "contact_2"};
    static const int32_t(*const pairs[])[2] = {RIGHT, LEFT};
    Mesh mesh;
    bool done = false;
    build(PLACES, names, pairs, 2, &mesh);
    int64_t live = memory_counters().live;
    for (int64_t k = 0; !done; k++) {
        Error err = {0};
        MeshContact contact;
        memory_fail_after(k);
        done = mesh_contact(&mesh, NULL, 0, &contact, &err);
        memory_fail_after(-1);
        mesh_contact_destroy(&contact);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 100);
    }
    mesh_destroy(&mesh);
}
