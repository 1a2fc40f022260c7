// SPDX-License-Identifier: GPL-2.0-or-later
// meshes/block3d.geo, pads3d.geo and grooves3d.geo: volumes, areas of the contact and groups
// against what geometry says, in each of their shapes.
#include "contact/interface.h"

#include "near.h"

typedef struct Drawn {
    Mesh mesh;
    Interface interface;
    double volume, area;   // of the block; of its contact
} Drawn;

static void draw(const char *name, const MeshParameter *parameters, int32_t count, Drawn *drawn)
{
    char path[600];
    Error err = {0};
    MeshFile file;
    const InterfaceDef def = {.has_rod = true, .rod_name = "rod", .rod_whole = true};
    snprintf(path, sizeof path, "%s/meshes/%s", getenv("AMONTONS_SOURCE"), name);
    if (!mesh_file_read(path, parameters, count, false, NULL, &file, &err) ||
        !mesh_build(&file, path, &drawn->mesh, &err) ||
        !interface_build(&drawn->mesh, &def, &drawn->interface, &err))
        fail_msg("%s", err.message);
    drawn->volume = drawn->area = 0;
    for (int32_t e = 0; e < drawn->mesh.element_count; e++)
        drawn->volume += mesh_element_area(&drawn->mesh, e);
    for (int32_t i = 0; i < drawn->interface.contact_count; i++)
        drawn->area += drawn->interface.weight[i];
}

static void destroy(Drawn *drawn)
{
    interface_destroy(&drawn->interface);
    mesh_destroy(&drawn->mesh);
}

static const struct {
    const char *shape;
    int32_t order;
    ElementKind kind;
} SHAPES[] = {{"hex", 1, ELEMENT_HEX8},
              {"hex", 2, ELEMENT_HEX27},
              {"wedge", 1, ELEMENT_WEDGE6},
              {"tet", 1, ELEMENT_TET4},
              {"tet", 2, ELEMENT_TET10}};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

static void set_shape(int32_t k, MeshParameter *shape, MeshParameter *order)
{
    *shape = (MeshParameter){"shape", 0, ""};
    *order = (MeshParameter){"order", SHAPES[k].order, ""};
    snprintf(shape->text, sizeof shape->text, "%s", SHAPES[k].shape);
}

TEST(test_block)
{
    for (int32_t k = 0; k < 2 * SHAPE_COUNT; k++) {
        MeshParameter with[] = {{"nx", 4, ""},      {"ny", 6, ""},      {"nz", 3, ""},
                                {"breadth", 2, ""}, {"grade_x", 2, ""}, {"grade_z", 3, ""},
                                {"layout", 0, ""},  {"", 0, ""},        {"", 0, ""}};
        snprintf(with[6].text, sizeof with[6].text, "%s", k < SHAPE_COUNT ? "regular" : "free");
        set_shape(k % SHAPE_COUNT, &with[7], &with[8]);
        Drawn drawn;
        draw("block3d.geo", with, 9, &drawn);
        for (int32_t e = 0; e < drawn.mesh.element_count; e++)
            assert_int_equal(drawn.mesh.kind[e], SHAPES[k % SHAPE_COUNT].kind);
        assert_near("volume", drawn.volume, 1, 1e-12);
        assert_near("contact", drawn.area, 2, 1e-12);
        assert_int_equal(drawn.interface.pad_count, 1);
        if (k == 0) {
            assert_int_equal(drawn.mesh.node_count, 5 * 7 * 4);
            assert_int_equal(drawn.interface.contact_count, 5 * 7);
            assert_int_equal(drawn.interface.rod_count, 7 * 3);   // the lowest row is contact
            double last = drawn.interface.rod_z[20] - drawn.interface.rod_z[13];
            assert_near("grade_z", last / drawn.interface.rod_z[0], 3, 1e-9);
        }
        destroy(&drawn);
    }
}

// The inside of a contact of T6 is bent in its plane, its rim stays: corners have a share of the
// area then, and must not become contact nodes by it. Area and its middle stay.
TEST(test_bent_faces)
{
    Error err = {0};
    Drawn drawn;
    const InterfaceDef def = {.has_rod = false};
    const MeshParameter with[] = {
        {"nx", 4, ""}, {"ny", 4, ""}, {"nz", 2, ""}, {"shape", 0, "tet"}, {"order", 2, ""}};
    const double pi = 3.14159265358979;
    draw("block3d.geo", with, 5, &drawn);
    int32_t count = drawn.interface.contact_count;
    for (int32_t i = 0; i < drawn.mesh.node_count; i++) {
        double *at = &drawn.mesh.position[3 * i];
        at[0] += 0.06 * sin(pi * at[0]) * sin(2 * pi * at[1]);
    }
    interface_destroy(&drawn.interface);
    assert_true(interface_build(&drawn.mesh, &def, &drawn.interface, &err));
    assert_int_equal(drawn.interface.contact_count, count);
    double area = 0, middle = 0, least = 1;
    for (int32_t i = 0; i < count; i++) {
        area += drawn.interface.weight[i];
        middle += drawn.interface.weight[i] * drawn.interface.x[i];
        least = fmin(least, drawn.interface.weight[i]);
    }
    assert_near("area", area, 1, 1e-12);
    assert_near("middle", middle, 0.5, 2e-4);   // what three points leave of a bent face
    assert_true(least > 0.2 / 6 / 32);   // of 32 faces; of a corner it would be 1e-4
    destroy(&drawn);
}

// 3 x 2 pads over 0.6 of 1 and 0.5 of 0.8.
TEST(test_pads)
{
    for (int32_t k = 0; k < SHAPE_COUNT; k++) {
        MeshParameter with[] = {{"cells_x", 2, ""},  {"cells_y", 2, ""},  {"nz", 2, ""},
                                {"breadth", .8, ""}, {"fill_y", 0.5, ""}, {"", 0, ""},
                                {"", 0, ""}};
        set_shape(k, &with[5], &with[6]);
        Drawn drawn;
        draw("pads3d.geo", with, 7, &drawn);
        assert_near("volume", drawn.volume, 0.8 * 0.3 + 0.6 * 0.5 * 0.8 * 0.05, 1e-12);
        assert_near("contact", drawn.area, 0.6 * 0.5 * 0.8, 1e-12);
        assert_int_equal(drawn.interface.pad_count, 6);
        for (int32_t i = 0; i < drawn.interface.contact_count;
             i++)   // columns of two, rows of three
            assert_true(drawn.interface.y[i] < 0.21 || drawn.interface.y[i] > 0.59);
        destroy(&drawn);
    }
}

// Two grooves of 0.05 to 0.03 by 0.03, over a breadth of 0.6 or a length of 1.
TEST(test_grooves)
{
    for (int32_t k = 0; k < 2 * SHAPE_COUNT; k++) {
        bool along = k >= SHAPE_COUNT;
        double way = along ? 1 : 0.6, across = along ? 0.6 : 1;
        MeshParameter with[] = {
            {"floor", 0.03, ""}, {"size_contact", 0.03, ""}, {"size_bulk", 0.1, ""},
            {"cells", 4, ""},    {"direction", 0, ""},       {"", 0, ""},
            {"", 0, ""}};
        snprintf(with[4].text, sizeof with[4].text, "%s", along ? "along" : "across");
        set_shape(k % SHAPE_COUNT, &with[5], &with[6]);
        Drawn drawn;
        draw("grooves3d.geo", with, 7, &drawn);
        assert_near("volume", drawn.volume, 0.18 - 2 * 0.04 * 0.03 * way, 1e-12);
        assert_near("contact", drawn.area, (across - 2 * 0.05) * way, 1e-12);
        assert_int_equal(drawn.interface.pad_count, 3);
        destroy(&drawn);
    }
}
