// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes that do not hang together where they look as if they did: in the plane and in space, each
// fault put into a mesh that is accepted without it.
#include "fem/mesh_parts.h"

#include "base/memory.h"
#include "mesh_by_hand.h"
#include "near.h"

// 3 x 2 squares of side 1, nodes by rows; nodes 12 and 13 are copies of 5 and 6.
static const double PLACES[][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 1}, {1, 1}, {2, 1},
                                   {3, 1}, {0, 2}, {1, 2}, {2, 2}, {3, 2}, {1, 1}, {2, 1}};
static const int32_t SQUARES[] = {0, 1, 5, 4, 1, 2, 6,  5, 2, 3, 7,  6,
                                  4, 5, 9, 8, 5, 6, 10, 9, 6, 7, 11, 10};

static void refused(MeshFile *file, const char *one, const char *two)
{
    Error err = {0};
    Mesh mesh;
    bool done = mesh_build(file, "a.msh", &mesh, &err);
    mesh_destroy(&mesh);
    assert_false(done);
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, one)) fail_msg("'%s' is not in: %s", one, err.message);
    if (!strstr(err.message, two)) fail_msg("'%s' is not in: %s", two, err.message);
}

static void accepted(MeshFile *file)
{
    Error err = {0};
    Mesh mesh;
    if (!mesh_build(file, "a.msh", &mesh, &err)) fail_msg("%s", err.message);
    mesh_destroy(&mesh);
}

// The middle square of the upper row has nodes of its own below.
TEST(test_crack)
{
    double open[14][2];
    int32_t squares[24];
    memcpy(squares, SQUARES, sizeof squares);
    MeshFile file = hand_mesh(12, PLACES, ELEMENT_Q4, 6, SQUARES);
    accepted(&file);
    squares[12 + 1] = squares[16] = 12;
    file = hand_mesh(13, PLACES, ELEMENT_Q4, 6, squares);
    refused(&file, "is on element", "lies inside the block");
    memcpy(open, PLACES, sizeof open);
    open[12][1] += 1e-3;   // a slit that stands open is a shape like any other
    file = hand_mesh(13, open, ELEMENT_Q4, 6, squares);
    accepted(&file);
    squares[17] = squares[20] = 13;
    file = hand_mesh(14, PLACES, ELEMENT_Q4, 6, squares);
    refused(&file, "is on element", "lies inside the block");
}

// Two cells beside one: the node between them lies on its side.
TEST(test_hanging_node)
{
    static const double places[][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2},
                                       {3, 0}, {3, 1}, {3, 2}, {2, 1}};
    static const int32_t squares[] = {0, 1, 2, 3, 1, 4, 5, 7, 7, 5, 6, 2};
    MeshFile file = hand_mesh(8, places, ELEMENT_Q4, 3, squares);
    refused(&file, "the edge at (2, ", "right behind it");
}

// A square laid over the others, joined to them by a corner: no face of it is another's.
TEST(test_overlap)
{
    static const double places[][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0.5}, {3, 0.5}, {3, 2}};
    static const int32_t squares[] = {0, 1, 2, 3, 4, 5, 6, 2};
    MeshFile file = hand_mesh(7, places, ELEMENT_Q4, 2, squares);
    refused(&file, "lies inside the block", "overlap");
}

// Bent sides of second order, the middle nodes off the chord.
TEST(test_bent)
{
    static const double places[][2] = {{0, 0},  {1, 0}, {0, 1},    {.5, -.1}, {.55, .55},
                                       {0, .5}, {1, 1}, {1.1, .5}, {.5, 1.05}};
    static const int32_t triangles[] = {0, 1, 2, 3, 4, 5, 1, 6, 2, 7, 8, 4};
    MeshFile file = hand_mesh(9, places, ELEMENT_T6, 2, triangles);
    accepted(&file);
}

// A triangle turned over onto its neighbour: each runs counter-clockwise.
TEST(test_fold)
{
    static const double places[][2] = {{0, 0}, {1, 0}, {0, 1}, {0.2, 0.5}};
    static const int32_t triangles[] = {0, 1, 2, 0, 1, 3};
    MeshFile file = hand_mesh(4, places, ELEMENT_T3, 2, triangles);
    refused(&file, "lie on one side of the edge at (0.5, 0)", "folded");
}

// 2 x 2 x 2 hexahedra of side 1; the last node is the middle one once more.
static MeshFile cubes(void)
{
    Error err = {0};
    static const int32_t corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                         {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    MeshFile file = {.dim = 3, .node_count = 27, .element_count = 8};
    file.position = NEW_ARRAY(double, 3 * 28, &err);
    file.node_number = hand_numbers(28);
    file.element_number = hand_numbers(8);
    file.kind = NEW_ARRAY(uint8_t, 8, &err);
    file.first_node = NEW_ARRAY(int32_t, 9, &err);
    file.element_nodes = NEW_ARRAY(int32_t, 64, &err);
    file.groups = NEW_ARRAY(MeshGroup, 1, &err);
    for (int32_t i = 0; i < 27; i++) {
        file.position[3 * i] = i % 3;
        file.position[3 * i + 1] = (i / 3) % 3;
        file.position[3 * i + 2] = i / 9;
    }
    for (int32_t d = 0; d < 3; d++) file.position[3 * 27 + d] = 1;
    for (int32_t e = 0; e < 8; e++) {
        file.kind[e] = ELEMENT_HEX8;
        file.first_node[e + 1] = 8 * (e + 1);
        for (int32_t a = 0; a < 8; a++) {
            int32_t at[3];
            for (int32_t d = 0; d < 3; d++) at[d] = ((e >> d) & 1) + corner[a][d];
            file.element_nodes[8 * e + a] = at[0] + 3 * at[1] + 9 * at[2];
        }
    }
    return file;
}

TEST(test_space)
{
    MeshFile file = cubes();
    accepted(&file);
    file = cubes();   // the upper four have a middle node of their own
    file.node_count = 28;
    for (int32_t k = 32; k < 64; k++)
        if (file.element_nodes[k] == 13) file.element_nodes[k] = 27;
    refused(&file, "the face at (", "lies inside the block");
    for (int32_t turns = 1; turns <= 3; turns++) {   // the upper side of the last is turned
        int32_t old[4];
        file = cubes();
        int32_t *top = file.element_nodes + 60;
        memcpy(old, top, sizeof old);
        for (int32_t k = 0; k < 4; k++) top[k] = old[(k + turns) % 4];
        refused(&file, "a.msh", turns == 2 ? "non-positive volume" : "");
    }
}

// Slider and base, which touch: two parts, of which the advice names the one with the contact.
TEST(test_parts)
{
    static const double places[][2] = {{0, 0},   {1, 0},  {1, 1}, {0, 1},
                                       {-1, -1}, {2, -1}, {2, 0}, {-1, 0}};
    static const int32_t squares[] = {4, 5, 6, 7, 0, 1, 2, 3}, bottom[][2] = {{0, 1}};
    Error err = {0};
    Mesh mesh;
    MeshParts parts;
    char text[PART_TEXT_SIZE];
    MeshFile file = hand_mesh(8, places, ELEMENT_Q4, 2, squares);
    hand_curve(&file, "contact", 1, bottom);
    for (int32_t k = 0; k < 2; k++) {
        MeshGroup *region = &file.groups[file.group_count++];
        *region = (MeshGroup){.dimension = 2, .number = k + 1, .element_count = 1};
        snprintf(region->name, sizeof region->name, k ? "slider" : "base");
        region->elements = hand_copy(&k, 1, sizeof k);
    }
    if (!mesh_build_parts(&file, "a.msh", NULL, &mesh, &parts, &err)) fail_msg("%s", err.message);
    assert_int_equal(parts.count, 2);
    mesh_part_text(&mesh, &parts, 0, text);
    assert_string_equal(text, "4 nodes in x = 0 ... 1, z = 0 ... 1, groups 'contact', 'slider'");
    mesh_part_text(&mesh, &parts, 1, text);
    assert_string_equal(text, "4 nodes in x = -1 ... 2, z = -1 ... 0, groups 'base'");
    mesh_parts_advice(&mesh, &parts, text);
    assert_string_equal(text, "`groups: {body: slider}` in the scene picks one");
    assert_false(mesh_parts_refuse(&mesh, &parts, &err));
    assert_non_null(strstr(err.message, "groups: {body: slider}"));
    mesh_parts_destroy(&parts);
    mesh_destroy(&mesh);
}
