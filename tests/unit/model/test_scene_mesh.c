// SPDX-License-Identifier: GPL-2.0-or-later
// One block drawn at other places, in other units, beside others: the scene has it where it stands
// on the floor, and there with the same bits where it stood there before.
#include "model/scene_mesh.h"

#include "near.h"
#include "place_fixture.h"
#include "small_scene.h"

static const char BLOCK[] =
    "Point(1) = {%g, %g, 0}; Point(2) = {%g, %g, 0}; Point(3) = {%g, %g, 0}; Point(4) = {%g, %g, "
    "0};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
    "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
    "Transfinite Curve{1:4} = 5; Transfinite Surface{1}; Recombine Surface{1};\n"
    "Physical Curve(\"contact\") = {1}; Physical Curve(\"top\") = {3};\n"
    "Physical Curve(\"rod\") = {4}; Physical Surface(\"body\") = {1};\n";

// A block from (x, z), so wide and high.
static void draw(const char *name, double x, double z, double width, double height)
{
    char text[1500];
    snprintf(text, sizeof text, BLOCK, x, z, x + width, z, x + width, z + height, x, z + height);
    place_write(place, name, text);
}

static bool read_mesh(const char *name, const char *const *more, Mesh *mesh, Error *err)
{
    char file[PLACE_SIZE + 60];
    const char *settings[12] = {file};
    int32_t count = 1;
    snprintf(file, sizeof file, "mesh={file: %s/%s}", place, name);
    while (*more) settings[count++] = *more++;
    settings[count] = NULL;
    Scene *scene = small_scene(settings);
    bool done = scene_mesh_read(scene, NULL, mesh, NULL, err);
    amontons_scene_destroy(scene);
    return done;
}

#define SETTINGS(...) ((const char *const[]){__VA_ARGS__ __VA_OPT__(, ) NULL})

static void read_well(const char *name, const char *const *more, Mesh *mesh)
{
    Error err = {0};
    if (!read_mesh(name, more, mesh, &err)) fail_msg("%s", err.message);
}

TEST(test_floor)
{
    char text[MOVE_TEXT_SIZE];
    Mesh plain, mesh;
    draw("plain.geo", 0, 0, 1, 0.5);
    draw("deep.geo", -0.5, -0.25, 1, 0.5);
    read_well("plain.geo", SETTINGS(), &plain);
    assert_string_equal(mesh_move_text(&plain, text), "");
    read_well("deep.geo", SETTINGS(), &mesh);
    assert_true(mesh.z_min == 0 && mesh.z_max == 0.5 && mesh.x_min == -0.5);
    assert_true(mesh.move.onto_floor && mesh.move.shift[1] == 0.25);
    assert_non_null(strstr(mesh_move_text(&mesh, text), "moved by 0.25 along z"));
    mesh_destroy(&mesh);
    read_well("deep.geo", SETTINGS("mesh.shift=[0.5, 0.25]"), &mesh);
    assert_true(!mesh.move.onto_floor);
    assert_int_equal(mesh.node_count, plain.node_count);
    for (int32_t k = 0; k < 2 * mesh.node_count; k++)
        assert_near("place", mesh.position[k], plain.position[k], 1e-11);   // gmsh's own rounding
    mesh_destroy(&mesh);
    read_well("deep.geo", SETTINGS("mesh.shift=[0, 0]"),
              &mesh);   // left where it is, for a run to refuse
    assert_true(mesh.z_min == -0.25);
    mesh_destroy(&mesh);
    mesh_destroy(&plain);
}

TEST(test_scale)
{
    Mesh mesh;
    draw("plain.geo", 0, 0, 100, 50);
    read_well("plain.geo", SETTINGS("mesh.scale=0.01"), &mesh);
    assert_near("x_max", mesh.x_max, 1, 1e-15);
    assert_true(mesh.move.scale == 0.01);
    mesh_destroy(&mesh);
    read_well("plain.geo", SETTINGS("units=si", "mesh.unit=mm", "mesh.scale=2"), &mesh);
    assert_near("x_max", mesh.x_max, 0.2, 1e-15);
    assert_near("z_max", mesh.z_max, 0.1, 1e-15);
    mesh_destroy(&mesh);
}

static void refused(const char *name, const char *const *more, const char *key, const char *says)
{
    Error err = {0};
    Mesh mesh;
    assert_false(read_mesh(name, more, &mesh, &err));
    mesh_destroy(&mesh);
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, key) || !strstr(err.message, says)) fail_msg("%s", err.message);
}

TEST(test_body)
{
    Mesh mesh;
    char text[3000];
    int length = snprintf(text, sizeof text, BLOCK, 0., 0., 1., 0., 1., 0.5, 0., 0.5);
    snprintf(text + length, sizeof text - (size_t)length,
             "Point(11) = {-1, -1, 0}; Point(12) = {2, -1, 0}; Point(13) = {2, 0, 0};\n"
             "Point(14) = {-1, 0, 0}; Line(11) = {11, 12}; Line(12) = {12, 13};\n"
             "Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11, 12, 13, 14};\n"
             "Plane Surface(2) = {2}; Physical Surface(\"base\") = {2};\n");
    place_write(place, "two.geo", text);
    read_well("two.geo", SETTINGS("groups.body=body"), &mesh);
    assert_true(mesh.x_min == 0 && mesh.z_min == 0 && mesh.x_max == 1);
    mesh_destroy(&mesh);
    refused("two.geo", SETTINGS(), "two.geo", "groups: {body: body}");
    refused("two.geo", SETTINGS("groups.body=boy"), "groups.body", "did you mean 'body'?");
    refused("two.geo", SETTINGS("groups.body=base"), "groups.contact", "has no group 'contact'");
    refused("two.geo", SETTINGS("groups.body=body", "mesh.shift=[1, 2, 3]"), "mesh.shift",
            "it takes [x, z]");
}

GROUP_BETWEEN(begin, end);
