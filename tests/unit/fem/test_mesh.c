// SPDX-License-Identifier: GPL-2.0-or-later
// Faults that mesh_build refuses and mends; counts and areas of the shipped blocks against
// formulas.
#include "fem/mesh.h"

#include "base/memory.h"
#include "cases.h"
#include "mesh_by_hand.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// cmocka 1.1.5 compares floats only, in single precision.
static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, wanted, tolerance);
}

// 2 x 1 squares of side 1; node 6 is spare.
//     3---4---5
//     |   |   |
//     0---1---2
static const double PLACES[][2] = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}, {3, 0}};
static const int32_t SQUARES[] = {0, 1, 4, 3, 1, 2, 5, 4};
static const int32_t BOTTOM[][2] = {{1, 2}, {0, 1}};

static void build_badly(MeshFile *file, const char *one, const char *two, const char *three)
{
    Error err = {0};
    Mesh mesh;
    bool done = mesh_build(file, "some/block.msh", &mesh, &err);
    mesh_destroy(&mesh);
    assert_false(done);
    assert_int_equal(err.code, ERROR_INPUT);
    assert_ptr_equal(strstr(err.message, "some/block.msh: "), err.message);
    const char *wanted[] = {one, two, three};
    for (int32_t k = 0; k < 3; k++)
        if (wanted[k] && !strstr(err.message, wanted[k]))
            fail_msg("'%s' is not in: %s", wanted[k], err.message);
    assert_null(file->position);   // taken over, and freed with the mesh
}

TEST(test_build)
{
    Error err = {0};
    Mesh mesh;
    MeshBoundary curve;
    int64_t live = memory_counters().live;
    MeshFile file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, SQUARES);
    hand_curve(&file, "contact", 2, BOTTOM);
    assert_true(mesh_build(&file, "block.msh", &mesh, &err));
    assert_string_equal(mesh.path, "block.msh");
    assert_int_equal(mesh.node_count, 6);
    assert_true(mesh.x_min == 0 && mesh.x_max == 2 && mesh.z_min == 0 && mesh.z_max == 1);
    assert_memory_equal(mesh.element_nodes, SQUARES, sizeof SQUARES);
    assert_true(mesh_boundary(&mesh, "contact", &curve, &err));
    assert_string_equal(curve.name, "contact");
    assert_int_equal(curve.face_count, 2);
    assert_int_equal(curve.node_count, 3);
    for (int32_t k = 0; k < 3; k++) assert_int_equal(curve.nodes[k], k);
    assert_false(mesh_boundary(&mesh, "contacts", &curve, &err));
    assert_non_null(strstr(err.message, "did you mean 'contact'?"));
    mesh_destroy(&mesh);
    mesh_destroy(&mesh);   // a second time is harmless
    assert_int_equal(memory_counters().live, live);
}

// Curve nodes come by ascending x whatever the order of the file; a vertical one by z.
TEST(test_curve_order)
{
    static const double places[][2] = {{2, 0}, {0, 1}, {1, 0}, {2, 1}, {0, 0}, {1, 1}};
    static const int32_t squares[] = {4, 2, 5, 1, 2, 0, 3, 5};
    static const int32_t bottom[][2] = {{2, 0}, {4, 2}}, left[][2] = {{1, 4}};
    Error err = {0};
    Mesh mesh;
    MeshFile file = hand_mesh(6, places, ELEMENT_Q4, 2, squares);
    hand_curve(&file, "contact", 2, bottom);
    hand_curve(&file, "rod", 1, left);
    assert_true(mesh_build(&file, "block.msh", &mesh, &err));
    static const int32_t wanted_bottom[] = {4, 2, 0}, wanted_left[] = {4, 1};
    assert_memory_equal(mesh.groups[0].nodes, wanted_bottom, sizeof wanted_bottom);
    assert_memory_equal(mesh.groups[1].nodes, wanted_left, sizeof wanted_left);
    mesh_destroy(&mesh);
}

TEST(test_orphan)
{
    static const int32_t off[][2] = {{2, 6}};
    MeshFile file = hand_mesh(7, PLACES, ELEMENT_Q4, 2, SQUARES);
    build_badly(&file, "node 7 at (3, 0) is on no surface element", NULL, NULL);
    file = hand_mesh(7, PLACES, ELEMENT_Q4, 2, SQUARES);
    hand_curve(&file, "contact", 1, off);
    build_badly(&file, "node 7", "no surface element", "group 'contact'");
}

TEST(test_repeated_node)
{
    static const int32_t folded[] = {0, 1, 4, 3, 1, 2, 5, 5};
    MeshFile file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, folded);
    build_badly(&file, "element 2 (Q4) has node 6 twice", NULL, NULL);
}

// A crossed quad, a flat triangle, a T6 whose mid-side node lies past the quarter point.
TEST(test_area)
{
    static const int32_t crossed[] = {0, 1, 4, 3, 1, 2, 4, 5}, flat[] = {0, 1, 3, 0, 1, 2};
    static const double bent[][2] = {{0, 0}, {1, 0}, {0, 1}, {0.2, 0}, {0.5, 0.5}, {0, 0.5}};
    static const double fair[][2] = {{0, 0}, {1, 0}, {0, 1}, {0.3, 0}, {0.5, 0.5}, {0, 0.5}};
    static const int32_t six[] = {0, 1, 2, 3, 4, 5};
    Error err = {0};
    Mesh mesh;
    MeshFile file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, crossed);
    build_badly(&file, "element 2 (Q4) at (1.5, 0.5)", "non-positive area", NULL);
    file = hand_mesh(4, PLACES, ELEMENT_T3, 2, flat);
    build_badly(&file, "element 2 (T3) at (1, 0)", "non-positive area", "from 0 to 0");
    file = hand_mesh(3, PLACES, ELEMENT_T3, 1, flat + 3);
    file.position[3] = 1e-13;   // less than what round-off can tell from nothing
    build_badly(&file, "element 1 (T3)", "non-positive area", NULL);
    file = hand_mesh(6, bent, ELEMENT_T6, 1, six);
    build_badly(&file, "element 1 (T6)", "non-positive area", NULL);
    file = hand_mesh(6, fair, ELEMENT_T6, 1, six);
    assert_true(mesh_build(&file, "t6.msh", &mesh, &err));
    mesh_destroy(&mesh);
}

// Clockwise: turned round, from the same first corner, all of them or one among others.
TEST(test_orientation)
{
    static const int32_t clockwise[] = {0, 3, 4, 1, 1, 4, 5, 2};
    static const int32_t second[] = {0, 1, 4, 3, 1, 4, 5, 2}, first[] = {0, 3, 4, 1, 1, 2, 5, 4};
    Error err = {0};
    Mesh mesh;
    MeshFile file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, clockwise);
    assert_true(mesh_build(&file, "block.msh", &mesh, &err));
    assert_memory_equal(mesh.element_nodes, SQUARES, sizeof SQUARES);
    mesh_destroy(&mesh);
    const int32_t *const one_of_them[] = {second, first};
    for (int32_t k = 0; k < 2; k++) {
        file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, one_of_them[k]);
        assert_true(mesh_build(&file, "block.msh", &mesh, &err));
        assert_memory_equal(mesh.element_nodes, SQUARES, sizeof SQUARES);
        mesh_destroy(&mesh);
    }
}

// Reversed elements of each kind have the area they should have.
TEST(test_reversed_kinds)
{
    static const double t6[][2] = {{0, 0}, {0, 1}, {1, 0}, {0, .5}, {.5, .5}, {.5, 0}};
    static const double q9[][2] = {{0, 0},  {0, 1},  {1, 1},  {1, 0},  {0, .5},
                                   {.5, 1}, {1, .5}, {.5, 0}, {.5, .5}};
    static const int32_t all[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    const struct {
        ElementKind kind;
        const double (*places)[2];
        double area;
    } rows[] = {{ELEMENT_T3, t6, .5},
                {ELEMENT_T6, t6, .5},
                {ELEMENT_Q4, q9, 1},
                {ELEMENT_Q8, q9, 1},
                {ELEMENT_Q9, q9, 1}};
    for (int32_t k = 0; k < 5; k++) {
        Error err = {0};
        Mesh mesh;
        MeshFile file =
            hand_mesh(element_node_count(rows[k].kind), rows[k].places, rows[k].kind, 1, all);
        assert_true(mesh_build(&file, "one.msh", &mesh, &err));
        assert_near(mesh_summarise(&mesh).area, rows[k].area, 1e-14);
        mesh_destroy(&mesh);
    }
}

TEST(test_edges)
{
    static const double places[][2] = {{0, .5}, {1, 0}, {2, 0}, {2, 1}, {1, 1}};
    static const int32_t thrice[] = {0, 1, 4, 1, 2, 4, 1, 3, 4}, diagonal[][2] = {{0, 4}};
    MeshFile file = hand_mesh(5, places, ELEMENT_T3, 3, thrice);
    build_badly(&file, "the edge at (1, 0.5) is on more than two elements", "3 among them", NULL);
    file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, SQUARES);
    hand_curve(&file, "contact", 1, diagonal);
    build_badly(&file, "group 'contact'", "node 1 to 5", "is on no element");
}

// A Q4 beside a Q8: the common side has a middle node on one side only.
TEST(test_mixed_order)
{
    static const double places[][2] = {{0, 0},  {1, 0},  {1, 1},  {0, 1}, {.5, 0},
                                       {1, .5}, {.5, 1}, {0, .5}, {2, 0}, {2, 1}};
    static const int32_t nodes[] = {0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 9, 2};
    MeshFile file = hand_mesh(10, places, ELEMENT_Q4, 3, nodes);
    file.element_count = 2;
    file.kind[0] = ELEMENT_Q8;
    file.first_node[1] = 8;
    file.first_node[2] = 12;
    build_badly(&file, "share the edge at (1, 0.5)", "different order", "elements 1 and 2");
}

TEST(test_summary)
{
    static const double places[][2] = {{0, 0}, {4, 0}, {4, 1}, {0, 1}, {0, 4}};
    static const int32_t nodes[] = {1, 2, 3, 0, 3, 2, 4, 0};   // the last is no node
    Error err = {0};
    Mesh mesh;
    MeshFile file = hand_mesh(5, places, ELEMENT_Q4, 2, nodes);
    file.kind[1] = ELEMENT_T3;
    file.first_node[2] = 7;
    assert_true(mesh_build(&file, "mixed.msh", &mesh, &err));
    MeshSummary summary = mesh_summarise(&mesh);
    assert_int_equal(summary.element_counts[ELEMENT_Q4], 1);
    assert_int_equal(summary.element_counts[ELEMENT_T3], 1);
    assert_near(summary.area, 4 + 6, 1e-14);
    assert_near(summary.edge_min, 1, 0);
    assert_near(summary.edge_max, 5, 1e-15);
    assert_near(summary.aspect_max, 4, 0);
    assert_int_equal(summary.aspect_worst, 0);
    mesh_destroy(&mesh);
}

TEST(test_memory_faults)
{
    int64_t live = memory_counters().live;
    bool done = false;
    for (int64_t k = 0; !done; k++) {
        Error err = {0};
        Mesh mesh;
        MeshFile file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, SQUARES);
        hand_curve(&file, "contact", 2, BOTTOM);
        memory_fail_after(k);
        done = mesh_build(&file, "block.msh", &mesh, &err);
        memory_fail_after(-1);
        mesh_destroy(&mesh);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 100);
    }
}

// --- the shipped meshes -------------------------------------------------------------------------

static void mesh_geo(const char *name, const MeshParameter *parameters, int32_t count, Mesh *mesh)
{
    char path[600];
    MeshFile file;
    Error err = {0};
    snprintf(path, sizeof path, "%s/meshes/%s", getenv("AMONTONS_SOURCE"), name);
    if (!mesh_file_read(path, parameters, count, false, NULL, &file, &err) ||
        !mesh_build(&file, path, mesh, &err))
        fail_msg("%s", err.message);
}

// nx x nz cells of each kind and layout: counts by formula, area length x height.
TEST(test_block_counts)
{
    enum { NX = 6, NZ = 4 };
    static const struct {
        const char *shape, *layout;
        int32_t order, incomplete, nodes, elements;
        ElementKind kind;
    } rows[] = {{"quad", "regular", 1, 0, 7 * 5, 24, ELEMENT_Q4},
                {"quad", "regular", 2, 0, 13 * 9, 24, ELEMENT_Q9},
                {"quad", "regular", 2, 1, 13 * 9 - 24, 24, ELEMENT_Q8},
                {"triangle", "regular", 1, 0, 7 * 5, 48, ELEMENT_T3},
                {"triangle", "alternate", 1, 0, 7 * 5, 48, ELEMENT_T3},
                {"triangle", "regular", 2, 0, 13 * 9, 48, ELEMENT_T6},
                {"triangle", "regular", 2, 1, 13 * 9, 48, ELEMENT_T6},
                {"quad", "free", 1, 0, 0, 0, ELEMENT_Q4},
                {"triangle", "free", 2, 0, 0, 0, ELEMENT_T6}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        MeshParameter parameters[] = {{"nx", NX, ""},
                                      {"nz", NZ, ""},
                                      {"length", 3, ""},
                                      {"height", 1.5, ""},
                                      {"order", rows[k].order, ""},
                                      {"incomplete", rows[k].incomplete, ""},
                                      {"shape", 0, ""},
                                      {"layout", 0, ""}};
        snprintf(parameters[6].text, GROUP_NAME_SIZE, "%s", rows[k].shape);
        snprintf(parameters[7].text, GROUP_NAME_SIZE, "%s", rows[k].layout);
        Mesh mesh;
        mesh_geo("block.geo", parameters, 8, &mesh);
        MeshSummary summary = mesh_summarise(&mesh);
        if (rows[k].nodes) assert_int_equal(mesh.node_count, rows[k].nodes);
        if (rows[k].elements) assert_int_equal(mesh.element_count, rows[k].elements);
        assert_int_equal(summary.element_counts[rows[k].kind], mesh.element_count);
        assert_near(summary.area, 4.5, 1e-10);
        assert_true(mesh.x_min == 0 && mesh.x_max == 3 && mesh.z_min == 0 && mesh.z_max == 1.5);
        static const char *const curves[] = {"contact", "top", "rod", "leading"};
        for (int32_t c = 0; c < 4; c++) {
            MeshBoundary curve;
            Error err = {0};
            assert_true(mesh_boundary(&mesh, curves[c], &curve, &err));
            assert_int_equal(curve.face_count, c < 2 ? NX : NZ);
            assert_int_equal(curve.node_count, (c < 2 ? NX : NZ) * rows[k].order + 1);
            for (int32_t i = 0; i < curve.node_count; i++) {
                const double *place = mesh.position + 2 * curve.nodes[i];
                double off = c == 0 ? place[1] : c == 1 ? place[1] - 1.5 : place[0];
                assert_true(fabs(c == 3 ? place[0] - 3 : off) < 1e-12);
            }
        }
        mesh_destroy(&mesh);
    }
}

// Even cells without grading; with it the top cell is grade_z times the lowest, steps of one
// ratio, and the ends of the contact line are finest, alike, about 1 / grade_x of the middle.
TEST(test_block_grading)
{
    MeshParameter parameters[] = {
        {"nx", 41, ""}, {"nz", 9, ""}, {"grade_x", 1, ""}, {"grade_z", 1, ""}};
    for (int32_t graded = 0; graded < 2; graded++) {
        Mesh mesh;
        MeshBoundary rod, contact;
        Error err = {0};
        double step[41];
        if (graded) parameters[2].value = 4, parameters[3].value = 8;
        mesh_geo("block.geo", parameters, 4, &mesh);
        assert_true(mesh_boundary(&mesh, "rod", &rod, &err));
        for (int32_t k = 0; k < 9; k++)
            step[k] = mesh.position[2 * rod.nodes[k + 1] + 1] - mesh.position[2 * rod.nodes[k] + 1];
        for (int32_t k = 1; k < 9; k++)
            assert_near(step[k] / step[k - 1], graded ? pow(8, 1. / 8) : 1, 1e-6);
        assert_true(mesh_boundary(&mesh, "contact", &contact, &err));
        for (int32_t k = 0; k < 41; k++)
            step[k] = mesh.position[2 * contact.nodes[k + 1]] - mesh.position[2 * contact.nodes[k]];
        for (int32_t k = 0; k < 20; k++) {
            assert_near(step[k] / step[40 - k], 1, 1e-8);
            assert_true(graded ? step[k] < step[k + 1] : fabs(step[k] - 1. / 41) < 1e-10);
        }
        assert_near(step[20] / step[0], graded ? 4 : 1, graded ? 0.4 : 1e-9);
        mesh_destroy(&mesh);
    }
}

// The same edge again, the other way round: a load on it would act twice.
TEST(test_edge_listed_twice)
{
    static const int32_t twice[][2] = {{1, 2}, {0, 1}, {2, 1}};
    MeshFile file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, SQUARES);
    hand_curve(&file, "top", 3, twice);
    build_badly(&file, "group 'top'", "twice", "(2, 0)");
    file = hand_mesh(6, PLACES, ELEMENT_Q4, 2, SQUARES);   // in two groups it is no mistake
    hand_curve(&file, "bottom", 2, BOTTOM);
    hand_curve(&file, "contact", 2, BOTTOM);
    Error err = {0};
    Mesh mesh;
    assert_true(mesh_build(&file, "some/block.msh", &mesh, &err));
    mesh_destroy(&mesh);
}

// Two squares side by side with nodes of their own where they touch.
TEST(test_two_parts)
{
    static const double places[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1},
                                       {1, 0}, {3, 0}, {3, 1}, {1, 1}};
    static const int32_t squares[] = {0, 1, 2, 3, 4, 5, 6, 7};
    MeshFile file = hand_mesh(8, places, ELEMENT_Q4, 2, squares);
    build_badly(&file, "share no node", "4 nodes in x = 0 ... 1", "4 nodes in x = 1 ... 3");
}
