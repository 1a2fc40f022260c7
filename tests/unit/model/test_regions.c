// SPDX-License-Identifier: GPL-2.0-or-later
// Whose element is whose material: regions that differ from `material` in one number, or in none,
// and groups of which nobody can tell what belongs to them.
#include "run/simulation_state.h"

#include "small_scene.h"
#include "place_fixture.h"

// Materials of the model: 1 + regions, or 1 where all are alike.
static int32_t count_materials(const char *file, const char *materials, Error *err)
{
    char mesh[PLACE_SIZE + 60];
    Simulation *simulation = NULL;
    snprintf(mesh, sizeof mesh, "mesh={file: %s/%s}", place, file);
    Scene *scene =
        small_scene((const char *const[]){mesh, "groups={contact: low, top: high, rod: left}",
                                          "rod.height=0", "rod.width=0", materials, NULL});
    bool done = amontons_simulation_create(scene, &(RunOptions){0}, &simulation, err);
    int32_t count = done ? simulation->model.materials.count : 0;
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(scene);
    return count;
}

// Two squares side by side.
static const char SQUARES[] =
    "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0};\n"
    "Point(4) = {2, 1, 0}; Point(5) = {1, 1, 0}; Point(6) = {0, 1, 0};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5};\n"
    "Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {2, 5};\n"
    "Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1};\n"
    "Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};\n"
    "Transfinite Curve{1:7} = 3; Transfinite Surface{1, 2}; Recombine Surface{1, 2};\n"
    "Physical Curve(\"low\") = {1, 2}; Physical Curve(\"high\") = {4, 5};\n"
    "Physical Curve(\"left\") = {6}; Physical Surface(\"one\") = {1};\n";

TEST(test_one_number_differs)
{
    char text[1500];
    snprintf(text, sizeof text, "%sPhysical Surface(\"other\") = {2};\n", SQUARES);
    place_write(place, "squares.geo", text);
    static const struct {
        const char *materials;
        int32_t count;
    } cases[] = {
        {"materials={one: {young: 2}}", 2},   {"materials={one: {poisson: 0.2}}", 2},
        {"materials={one: {density: 2}}", 2}, {"materials={one: {eta1: 2}}", 2},
        {"materials={one: {eta2: 2}}", 2},    {"materials={one: , other: {eta2: 2}}", 3},
        {"materials={one: , other: }", 1},    {"materials={one: {young: 1, poisson: 0.34}}", 1},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Error err = {0};
        int32_t count = count_materials("squares.geo", cases[k].materials, &err);
        if (count != cases[k].count) fail_msg("%s: %d %s", cases[k].materials, count, err.message);
    }
}

TEST(test_in_two_regions)
{
    char text[1500];
    Error err = {0};
    snprintf(text, sizeof text, "%sPhysical Surface(\"other\") = {1, 2};\n", SQUARES);
    place_write(place, "both.geo", text);
    count_materials("both.geo", "materials={one: {young: 2}, other: {young: 3}}", &err);
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, "is in both 'one' and 'other': of which material?"))
        fail_msg("%s", err.message);
}

// Format 2.2 has an element once for each of its groups: all are in `one`, the left one in `other`
// as well, on one number of an entity.
TEST(test_groups_that_overlap)
{
    Error err = {0};
    place_write(place, "overlap.msh",
                "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n1 1 \"low\"\n"
                "1 2 \"high\"\n1 3 \"left\"\n2 7 \"one\"\n2 8 \"other\"\n$EndPhysicalNames\n"
                "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 2 1 0\n5 1 1 0\n6 0 1 0\n$EndNodes\n"
                "$Elements\n8\n1 1 2 1 1 1 2\n2 1 2 1 1 2 3\n3 1 2 2 2 4 5\n4 1 2 2 2 5 6\n"
                "5 1 2 3 3 6 1\n6 3 2 7 1 1 2 5 6\n7 3 2 8 1 1 2 5 6\n8 3 2 7 1 2 3 4 5\n"
                "$EndElements\n");
    assert_int_equal(count_materials("overlap.msh", "materials={one: {young: 2}}", &err), 2);
    assert_int_equal(count_materials("overlap.msh", "materials={other: {young: 2}}", &err), 2);
    if (!error_is_clean(&err)) fail_msg("%s", err.message);
}

GROUP_BETWEEN(begin, end);
