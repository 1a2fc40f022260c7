// SPDX-License-Identifier: GPL-2.0-or-later
// Which nodes are contact and rod, their order, weights and unknowns; and the rod's own few lines.
#include "contact/interface.h"

#include "block_mesh.h"
#include "plane.h"
#include "contact/rod.h"

#include <math.h>

static BlockDef block_of(ElementKind kind)
{
    return (BlockDef){.kind = kind, .nx = 4, .nz = 5, .length = 1, .height = 0.5};
}

static InterfaceDef def_with_rod(double height, double width)
{
    return (InterfaceDef){
        .has_rod = true, .rod_name = "rod", .rod_height = height, .rod_width = width};
}

TEST(test_nodes_and_weights)
{
    Error err = {0};
    int64_t live = memory_counters().live;
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        BlockDef block = block_of((ElementKind)kind);
        InterfaceDef def = def_with_rod(0.25, 0.3);   // 0.1 .. 0.4: rows 1 to 4 of order 1
        Mesh mesh;
        Interface interface;
        block_build(&block, &mesh);
        assert_true(interface_build(&mesh, &def, &interface, &err));
        bool second = kind != ELEMENT_T3 && kind != ELEMENT_Q4;
        assert_int_equal(interface.contact_count, second ? 9 : 5);
        assert_int_equal(interface.rod_count, second ? 7 : 4);
        assert_int_equal(interface.count, 2 * interface.contact_count + interface.rod_count);
        assert_int_equal(interface.pad_count, 1);
        double sum = 0;
        for (int32_t i = 0; i < interface.contact_count; i++) {
            int32_t node = interface.node[i];
            assert_near("x", interface.x[i], (double)i / (interface.contact_count - 1), 1e-15);
            assert_near("x of the node", mesh.position[2 * node], interface.x[i], 0);
            assert_near("z of the node", mesh.position[2 * node + 1], 0, 0);
            assert_int_equal(interface.pad[i], 0);
            assert_int_equal(interface.dofs[plane_tangent(i)], 2 * node);
            assert_int_equal(interface.dofs[plane_normal(i)], 2 * node + 1);
            sum += interface.weight[i];
        }
        assert_near("weights", sum, 1, 1e-14);
        assert_near("end", interface.weight[0], second ? 0.25 / 6 : 0.125, 1e-15);
        for (int32_t j = 0; j < interface.rod_count; j++) {
            int32_t node = interface.rod_node[j];
            assert_near("z", interface.rod_z[j], 0.1 + 0.3 * j / (interface.rod_count - 1), 1e-14);
            assert_near("z of the node", mesh.position[2 * node + 1], interface.rod_z[j], 0);
            assert_near("x of the node", mesh.position[2 * node], 0, 0);
            assert_int_equal(interface.dofs[interface_rod(&interface, j)], 2 * node);
        }
        interface_destroy(&interface);
        interface_destroy(&interface);   // a second time is harmless
        mesh_destroy(&mesh);
    }
    assert_int_equal(memory_counters().live, live);
}

// A strip that reaches the ground leaves the corner to the contact; one between nodes is refused.
TEST(test_strip)
{
    Error err = {0};
    BlockDef block = block_of(ELEMENT_Q4);
    Mesh mesh;
    Interface interface;
    block_build(&block, &mesh);
    InterfaceDef low = def_with_rod(0.05, 0.1);
    assert_true(interface_build(&mesh, &low, &interface, &err));
    assert_int_equal(interface.rod_count, 1);
    assert_near("z", interface.rod_z[0], 0.1, 1e-15);
    interface_destroy(&interface);

    InterfaceDef between = def_with_rod(0.26, 0.04);
    assert_false(interface_build(&mesh, &between, &interface, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "0.24 <= z <= 0.28"));
    assert_non_null(strstr(err.message, "the nearest is at z = 0.3"));
    interface_destroy(&interface);

    error_clear(&err);
    InterfaceDef none = {.has_rod = false};
    assert_true(interface_build(&mesh, &none, &interface, &err));
    assert_int_equal(interface.rod_count, 0);
    assert_int_equal(interface.count, 10);
    interface_destroy(&interface);

    InterfaceDef wrong = def_with_rod(0.25, 0.3);
    wrong.rod_name = "rodd";
    assert_false(interface_build(&mesh, &wrong, &interface, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "did you mean 'rod'?"));
    interface_destroy(&interface);
    mesh_destroy(&mesh);
}

// The first and the last quarter of the bottom as two pads, the middle free.
TEST(test_pads)
{
    Error err = {0};
    BlockDef block = block_of(ELEMENT_Q4);
    MeshFile file = block_file(&block);
    MeshGroup *first = &file.groups[0], *last = &file.groups[1];
    memcpy(last->face_nodes, first->face_nodes + 2 * 3, 2 * sizeof(int32_t));
    memcpy(last->nodes, first->nodes + 3, 2 * sizeof(int32_t));
    snprintf(first->name, sizeof first->name, "contact_front");
    snprintf(last->name, sizeof last->name, "contact_1");
    first->face_count = last->face_count = 1;
    first->node_count = last->node_count = 2;
    Mesh mesh;
    Interface interface;
    assert_true(mesh_build(&file, "pads", &mesh, &err));
    InterfaceDef def = {.has_rod = false};
    assert_true(interface_build(&mesh, &def, &interface, &err));
    const double x[] = {0, 0.25, 0.75, 1};
    assert_int_equal(interface.contact_count, 4);
    assert_int_equal(interface.pad_count, 2);
    for (int32_t i = 0; i < 4; i++) {
        assert_near("x", interface.x[i], x[i], 1e-15);
        assert_near("weight", interface.weight[i], 0.125, 1e-15);
        assert_int_equal(interface.pad[i], i / 2);
    }
    assert_string_equal(interface.pad_name[0], "contact_front");
    assert_string_equal(interface.pad_name[1], "contact_1");
    interface_destroy(&interface);
    const char names[][GROUP_NAME_SIZE] = {"contact_1"};   // asked by name: one of them
    def.contact_names = names;
    def.contact_name_count = 1;
    assert_true(interface_build(&mesh, &def, &interface, &err));
    assert_int_equal(interface.contact_count, 2);
    assert_near("x", interface.x[0], 0.75, 1e-15);
    interface_destroy(&interface);
    mesh_destroy(&mesh);
}

TEST(test_rod)
{
    Error err = {0};
    BlockDef block = block_of(ELEMENT_Q4);
    InterfaceDef def = def_with_rod(0.25, 0.1);   // rows 2 and 3
    Mesh mesh;
    Interface interface;
    Rod rod;
    block_build(&block, &mesh);
    assert_true(interface_build(&mesh, &def, &interface, &err));
    assert_true(rod_build(&interface, ROD_PUSHES, 1e-5, &rod, &err));
    assert_int_equal(rod.count, 2);
    assert_true(rod.velocity == 1e-5 && rod.kind == ROD_PUSHES && rod.origin[0] == 0);
    double reaction[12];
    for (int32_t k = 0; k < 12; k++) reaction[k] = k;
    assert_near("F_T", rod_force(&interface, reaction), 10 + 11, 0);
    rod_destroy(&rod);
    rod_destroy(&rod);
    interface_destroy(&interface);
    mesh_destroy(&mesh);
}

// Shares of rows 0.1 apart: strip 0.12 .. 0.28 holds row 2 and 30 % of row 1, 80 % of row 3 when it
// is moved up by 0.05; whatever its place, the shares make up its width.
TEST(test_shares)
{
    Error err = {0};
    BlockDef block = block_of(ELEMENT_Q4);
    Mesh mesh;
    Interface interface;
    block_build(&block, &mesh);
    InterfaceDef def = def_with_rod(0.2, 0.16);
    def.rod_in_part = true;
    assert_true(interface_build(&mesh, &def, &interface, &err));
    assert_int_equal(interface.rod_count, 3);
    assert_near("below", interface.rod_share[0], 0.3, 1e-9);
    assert_near("inside", interface.rod_share[1], 1, 0);
    assert_near("above", interface.rod_share[2], 0.3, 1e-9);
    assert_near("face from", interface.rod_face[0], mesh.z_min, 0);
    assert_near("face to", interface.rod_face[1], mesh.z_max, 0);
    interface_destroy(&interface);
    for (int32_t step = 0; step < 40; step++) {
        def.rod_height = 0.15 + 0.005 * step;
        assert_true(interface_build(&mesh, &def, &interface, &err));
        double width = 0;
        for (int32_t j = 0; j < interface.rod_count; j++) width += 0.1 * interface.rod_share[j];
        double lost = fmax(0.05 - (def.rod_height - 0.08), 0);   // to the corner, which is contact
        assert_near("width", width, 0.16 - lost, 1e-9);
        interface_destroy(&interface);
    }
    mesh_destroy(&mesh);
}

// As many as there are in the plane; in space by cells as long along the drive as across it: 40
// rows of 10 on a contact four times as long as it is wide.
TEST(test_nodes_along)
{
    enum { ALONG = 40, ACROSS = 10, ALL = ALONG * ACROSS };
    double x[ALL], y[ALL];
    for (int32_t count = 1; count < 2000; count++)
        assert_true(interface_nodes_along(&(Interface){.dim = 2, .contact_count = count}) == count);
    for (int32_t i = 0; i < ALL; i++) {
        x[i] = 4.0 * (i / ACROSS) / (ALONG - 1);
        y[i] = 1.0 * (i % ACROSS) / (ACROSS - 1);
    }
    Interface space = {.dim = 3, .contact_count = ALL, .x = x, .y = y};
    assert_near("in space", interface_nodes_along(&space), ALONG, 1e-13);
}

// The bound at which a soft node feels no force, and the softness of half a share.
TEST(test_soft_rod)
{
    Error err = {0};
    double share[] = {0.5, 1}, height[] = {0.1, 0.2};
    Interface interface = {.rod_count = 2, .rod_share = share, .rod_z = height};
    Rod rod;
    assert_true(rod_build(&interface, ROD_PUSHES, 1e-2, &rod, &err));
    assert_near("rigid at first", rod_bound(&rod, 0, 0.1, 30, 2), (0.3 - 0.1) / 2, 1e-15);
    rod_soften(&interface, (RodGround[]){{4, 6}, {4, 6}}, &rod);
    assert_near("softness", rod.softness[0], log(2) / 3.14159265358979, 1e-12);
    assert_near("a whole node", rod.softness[1], 0, 0);
    assert_near("its bound", rod_bound(&rod, 1, 0.1, 30, 2), (0.3 - 0.1) / 2, 1e-15);
    // way 0.2 - 2 v + lag (V - v) = 0 with lag 1.5
    double v = rod_bound(&rod, 0, 0.1, 30, 2);
    assert_near("no force", 0.2 - 2 * v + 1.5 * (1e-2 - v), 0, 1e-15);
    rod_destroy(&rod);
}

TEST(test_memory_faults)
{
    BlockDef block = block_of(ELEMENT_Q4);
    InterfaceDef def = def_with_rod(0.25, 0.3);
    Mesh mesh;
    block_build(&block, &mesh);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        Interface interface;
        Rod rod = {0};
        memory_fail_after(k);
        done = interface_build(&mesh, &def, &interface, &err) &&
               rod_build(&interface, ROD_PUSHES, 1, &rod, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        rod_destroy(&rod);
        interface_destroy(&interface);
        assert_int_equal(memory_counters().live, live);
    }
    mesh_destroy(&mesh);
}
