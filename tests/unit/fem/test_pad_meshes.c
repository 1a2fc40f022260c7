// SPDX-License-Identifier: GPL-2.0-or-later
// meshes/pads.geo and meshes/grooves.geo: areas, lengths and groups against what geometry says, and
// what they refuse.
#include "base/memory.h"
#include "fem/mesh.h"

#include "near.h"

#include <string.h>

enum { PARAMETERS_MAX = 12, PADS_MAX = 12 };

typedef struct Drawn {
    Mesh mesh;
    MeshContact contact;
    MeshSummary summary;
} Drawn;

static void path_of(const char *name, char path[600])
{
    snprintf(path, 600, "%s/meshes/%s", getenv("AMONTONS_SOURCE"), name);
}

// Parameters end with an empty name.
static int32_t count_of(const MeshParameter *parameters)
{
    int32_t count = 0;
    while (parameters[count].name[0]) count++;
    return count;
}

static void draw(const char *name, const MeshParameter *parameters, Drawn *drawn)
{
    char path[600];
    Error err = {0};
    MeshFile file;
    path_of(name, path);
    if (!mesh_file_read(path, parameters, count_of(parameters), false, NULL, &file, &err) ||
        !mesh_build(&file, path, &drawn->mesh, &err) ||
        !mesh_contact(&drawn->mesh, NULL, 0, &drawn->contact, &err))
        fail_msg("%s", err.message);
    drawn->summary = mesh_summarise(&drawn->mesh);
}

static void drawn_destroy(Drawn *drawn)
{
    mesh_contact_destroy(&drawn->contact);
    mesh_destroy(&drawn->mesh);
}

// Curve c is contact_<c + 1> and reaches from `from` to `to`.
static void assert_pad(const Drawn *drawn, int32_t c, double from, double to)
{
    const MeshBoundary *pad = &drawn->contact.pads[c];
    const double *position = drawn->mesh.position;
    char name[GROUP_NAME_SIZE];
    snprintf(name, sizeof name, "contact_%d", c + 1);
    assert_string_equal(pad->name, name);
    assert_near("begins", position[2 * pad->nodes[0]], from, 1e-12);
    assert_near("ends", position[2 * pad->nodes[pad->node_count - 1]], to, 1e-12);
}

// Extent of a curve along z.
static double rise_of(const Drawn *drawn, const char *name)
{
    Error err = {0};
    MeshBoundary curve;
    double low = INFINITY, high = -INFINITY;
    assert_true(mesh_boundary(&drawn->mesh, name, &curve, &err));
    for (int32_t i = 0; i < curve.node_count; i++) {
        double z = drawn->mesh.position[2 * curve.nodes[i] + 1];
        low = fmin(low, z);
        high = fmax(high, z);
    }
    return high - low;
}

// Rows of cells: n pads, together fill * length, the first at x = 0, the last ending at length.
TEST(test_flush)
{
    for (int32_t n = 1; n <= PADS_MAX; n = 2 * n + 1) {
        MeshParameter parameters[PARAMETERS_MAX] = {{"n", n, ""},
                                                    {"length", 2, ""},
                                                    {"height", 1, ""},
                                                    {"fill", 0.7, ""},
                                                    {"pad_height", 0.1, ""},
                                                    {"cells_pad", 4, ""},
                                                    {"shape", 0, "quad"},
                                                    {"order", n == 3 ? 2 : 1, ""}};
        if (n == 7) snprintf(parameters[6].text, GROUP_NAME_SIZE, "triangle");
        Drawn drawn;
        draw("pads.geo", parameters, &drawn);
        assert_int_equal(drawn.contact.pad_count, n);
        assert_int_equal(drawn.contact.node_count, n * (n == 3 ? 9 : 5));
        double pad = 1.4 / n, pitch = n > 1 ? (2 - pad) / (n - 1) : 0, first = n > 1 ? 0 : 0.3;
        for (int32_t c = 0; c < n; c++)
            assert_pad(&drawn, c, first + c * pitch, first + c * pitch + pad);
        assert_near("area", drawn.summary.area, 2 * 1 + 0.7 * 2 * 0.1, 1e-10);
        assert_near("top", drawn.mesh.z_max, 1.1, 1e-15);
        assert_near("rod", rise_of(&drawn, "rod"), 1, 1e-15);
        assert_near("leading", rise_of(&drawn, "leading"), 1, 1e-15);
        drawn_destroy(&drawn);
    }
}

// One pad without free ends is a plain block.
TEST(test_one_pad_whole)
{
    MeshParameter parameters[PARAMETERS_MAX] = {{"n", 1, ""}, {"fill", 1, ""}};
    Drawn drawn;
    draw("pads.geo", parameters, &drawn);
    assert_pad(&drawn, 0, 0, 1);
    assert_near("area", drawn.summary.area, 0.55, 1e-12);
    assert_near("rod", rise_of(&drawn, "rod"), 0.5, 1e-15);
    drawn_destroy(&drawn);
}

// All contacts become one group.
static void join_contacts(Mesh *mesh)
{
    MeshGroup *first = NULL;
    for (int32_t g = 0; g < mesh->group_count; g++) {
        MeshGroup *group = &mesh->groups[g];
        if (strncmp(group->name, "contact_", 8) != 0) continue;
        snprintf(group->name, sizeof group->name, first ? "joined" : "contact");
        if (!first) {
            first = group;
            continue;
        }
        int32_t width = first->nodes_per_face, faces = first->face_count, nodes = first->node_count;
        Error err = {0};
        int32_t *face_nodes = NEW_ARRAY(int32_t, (faces + group->face_count) * width, &err);
        int32_t *all = NEW_ARRAY(int32_t, nodes + group->node_count, &err);
        memcpy(face_nodes, group->face_nodes,
               (size_t)(group->face_count * width) * sizeof(int32_t));
        memcpy(face_nodes + group->face_count * width, first->face_nodes,
               (size_t)(faces * width) * sizeof(int32_t));   // in whatever order
        memcpy(all, first->nodes, (size_t)nodes * sizeof(int32_t));
        memcpy(all + nodes, group->nodes, (size_t)group->node_count * sizeof(int32_t));
        memory_free_all(first->face_nodes, first->nodes);
        first->face_nodes = face_nodes;
        first->nodes = all;
        first->face_count += group->face_count;
        first->node_count += group->node_count;
        mesh_sort_nodes(mesh, all, first->node_count);
    }
}

// Pieces of one group are the pads that they are under names of their own, in plane and space.
TEST(test_one_group_for_all)
{
    MeshParameter plane[PARAMETERS_MAX] = {{"n", 12, ""}, {"fill", 0.7, ""}, {"order", 2, ""}};
    MeshParameter space[PARAMETERS_MAX] = {{"n", 2, ""}, {"refine", 1, ""}};
    for (int which = 0; which < 2; which++) {
        Drawn drawn;
        Error err = {0};
        MeshContact joined;
        draw(which ? "pads3d.geo" : "pads.geo", which ? space : plane, &drawn);
        const MeshContact *named = &drawn.contact;
        join_contacts(&drawn.mesh);
        assert_true(mesh_contact(&drawn.mesh, NULL, 0, &joined, &err));
        assert_true(named->pad_count > 1);
        assert_int_equal(joined.pad_count, named->pad_count);
        assert_int_equal(joined.node_count, named->node_count);
        for (int32_t i = 0; i < named->node_count; i++) {
            assert_int_equal(joined.nodes[i], named->nodes[i]);
            assert_int_equal(joined.pad_of[i], named->pad_of[i]);
        }
        for (int32_t p = 0; p < joined.pad_count; p++) {
            char name[GROUP_NAME_SIZE];
            snprintf(name, sizeof name, "contact/%d", p + 1);
            assert_string_equal(joined.pads[p].name, name);
            assert_int_equal(joined.pads[p].face_count, named->pads[p].face_count);
            assert_int_equal(joined.pads[p].node_count, named->pads[p].node_count);
        }
        mesh_contact_destroy(&joined);
        drawn_destroy(&drawn);
    }
}

TEST(test_names_of_pieces)
{
    assert_true(mesh_piece_is_of("feet", "feet"));
    assert_true(mesh_piece_is_of("feet/12", "feet"));
    assert_false(mesh_piece_is_of("feet", "feet/1"));
    assert_false(mesh_piece_is_of("feet/", "feet"));
    assert_false(mesh_piece_is_of("feet/1a", "feet"));
    assert_false(mesh_piece_is_of("feet_1", "feet"));
}

// Half a gap at either end; a given gap puts the row in the middle; lengths in geometric steps.
TEST(test_placing)
{
    MeshParameter open[PARAMETERS_MAX] = {{"n", 2, ""}, {"fill", 0.5, ""}, {"ends", 0, "open"}};
    MeshParameter middle[PARAMETERS_MAX] = {
        {"n", 3, ""}, {"contact_length", 0.6, ""}, {"gap", 0.05, ""}, {"total_height", 0.4, ""}};
    MeshParameter graded[PARAMETERS_MAX] = {
        {"n", 3, ""}, {"fill", 0.7, ""}, {"pad_ratio", 4, ""}, {"size_contact", 0.02, ""}};
    Drawn drawn;
    draw("pads.geo", open, &drawn);
    assert_pad(&drawn, 0, 0.125, 0.375);
    assert_pad(&drawn, 1, 0.625, 0.875);
    drawn_destroy(&drawn);
    draw("pads.geo", middle, &drawn);
    assert_pad(&drawn, 0, 0.15, 0.35);
    assert_pad(&drawn, 2, 0.65, 0.85);
    assert_near("top", drawn.mesh.z_max, 0.4, 1e-15);
    assert_near("area", drawn.summary.area, 0.35 + 0.6 * 0.05, 1e-12);
    drawn_destroy(&drawn);
    draw("pads.geo", graded, &drawn);   // 0.1, 0.2, 0.4 with gaps of 0.15
    assert_pad(&drawn, 0, 0, 0.1);
    assert_pad(&drawn, 1, 0.25, 0.45);
    assert_pad(&drawn, 2, 0.6, 1);
    drawn_destroy(&drawn);
}

// Rows of cells by sizes: fine below, near size_bulk at the top.
TEST(test_sizes)
{
    MeshParameter parameters[PARAMETERS_MAX] = {
        {"n", 2, ""}, {"fill", 0.5, ""}, {"size_contact", 0.01, ""}, {"size_bulk", 0.05, ""}};
    Drawn drawn;
    draw("pads.geo", parameters, &drawn);
    assert_int_equal(drawn.contact.node_count, 2 * 26);
    assert_near("finest", drawn.summary.edge_min, 0.01, 1e-3);
    assert_true(drawn.summary.edge_max > 0.035 && drawn.summary.edge_max < 0.055);
    drawn_destroy(&drawn);
}

static double edge_of(const Drawn *drawn, int32_t pad, int32_t edge)
{
    const MeshBoundary *curve = &drawn->contact.pads[pad];
    return drawn->mesh.position[2 * curve->nodes[edge + 1]] -
           drawn->mesh.position[2 * curve->nodes[edge]];
}

// Cells of a graded contact: as many as without, the middle ones about `grade` times the end ones,
// the same from both ends (cells of a parabola: within 1 part in 8 at 20 of them). `refine` halves
// sizes and doubles the grade.
TEST(test_graded)
{
    for (int32_t k = 0; k < 3; k++) {
        MeshParameter of_pads[PARAMETERS_MAX] = {{"n", 2, ""},
                                                 {"fill", 0.8, ""},
                                                 {"pad_height", 0.05, ""},
                                                 {"refine", 2, ""},
                                                 {"size_contact", 0.04, ""},
                                                 {"size_bulk", 0.1, ""},
                                                 {"grade_contact", 2, ""},
                                                 {"layout", 0, "regular"}};
        MeshParameter of_grooves[PARAMETERS_MAX] = {
            {"grooves", 1, ""},      {"width", 0.2, ""},         {"floor", 0.1, ""},
            {"refine", 2, ""},       {"size_contact", 0.04, ""}, {"size_bulk", 0.1, ""},
            {"grade_contact", 2, ""}};
        if (k == 1) snprintf(of_pads[7].text, GROUP_NAME_SIZE, "free");
        Drawn drawn;
        draw(k < 2 ? "pads.geo" : "grooves.geo", k < 2 ? of_pads : of_grooves, &drawn);
        for (int32_t pad = 0; pad < 2; pad++) {
            assert_int_equal(drawn.contact.pads[pad].node_count, 21);
            assert_near("alike", edge_of(&drawn, pad, 0), edge_of(&drawn, pad, 19), 1e-9);
            assert_near("grade", edge_of(&drawn, pad, 10) / edge_of(&drawn, pad, 0), 4, 0.5);
        }
        drawn_destroy(&drawn);
    }
}

// The mesh that `refine` says is the one that its sizes and counts say.
TEST(test_refined)
{
    MeshParameter twice[PARAMETERS_MAX] = {{"cells_pad", 4, ""}, {"refine", 2, ""}};
    MeshParameter told[PARAMETERS_MAX] = {{"cells_pad", 8, ""},
                                          {"cells_gap", 12, ""},
                                          {"cells_pad_height", 6, ""},
                                          {"nz", 40, ""},
                                          {"grade_contact", 2, ""}};
    MeshParameter half[PARAMETERS_MAX] = {{"nx", 20, ""}, {"nz", 10, ""}, {"refine", 0.5, ""}};
    Drawn one, other;
    draw("pads.geo", twice, &one);
    draw("pads.geo", told, &other);
    assert_int_equal(one.mesh.node_count, other.mesh.node_count);
    for (int32_t k = 0; k < 2 * one.mesh.node_count; k++)
        assert_near("position", one.mesh.position[k], other.mesh.position[k], 1e-12);
    drawn_destroy(&one);
    drawn_destroy(&other);
    draw("block.geo", half, &one);
    assert_int_equal(one.mesh.node_count, 11 * 6);
    drawn_destroy(&one);
}

// Each root gains r^2 (1 - pi/4), and up to a tenth more: chords stand for arcs.
TEST(test_fillet)
{
    for (int32_t k = 0; k < 2; k++) {
        bool open = k == 1;
        MeshParameter parameters[PARAMETERS_MAX] = {{"n", 3, ""},
                                                    {"fill", 0.6, ""},
                                                    {"pad_height", 0.05, ""},
                                                    {"fillet", 0.03, ""},
                                                    {"ends", 0, "flush"},
                                                    {"shape", 0, "quad"},
                                                    {"size_contact", 0.01, ""},
                                                    {"size_bulk", 0.05, ""}};
        if (open) {
            snprintf(parameters[4].text, GROUP_NAME_SIZE, "open");
            snprintf(parameters[5].text, GROUP_NAME_SIZE, "triangle");
        }
        double roots = open ? 6 : 4, corner = 0.03 * 0.03 * (1 - acos(-1) / 4);
        Drawn drawn;
        draw("pads.geo", parameters, &drawn);
        assert_int_equal(drawn.contact.pad_count, 3);
        double gained = (drawn.summary.area - 0.5 - 0.6 * 0.05) / roots;
        assert_true(gained >= corner && gained < 1.12 * corner);
        assert_int_equal(drawn.summary.element_counts[open ? ELEMENT_T3 : ELEMENT_Q4],
                         drawn.mesh.element_count);
        assert_near("contact", rise_of(&drawn, "contact_2"), 0, 0);
        drawn_destroy(&drawn);
    }
}

// A groove takes (width + floor) / 2 * depth away.
TEST(test_grooves)
{
    for (int32_t k = 0; k < 3; k++) {
        double floors[] = {0, 0.03, 0.05};
        MeshParameter parameters[PARAMETERS_MAX] = {{"grooves", 3, ""},
                                                    {"width", 0.05, ""},
                                                    {"floor", floors[k], ""},
                                                    {"depth", 0.03, ""},
                                                    {"shape", 0, "quad"}};
        if (k == 0) snprintf(parameters[4].text, GROUP_NAME_SIZE, "triangle");
        Drawn drawn;
        draw("grooves.geo", parameters, &drawn);
        assert_int_equal(drawn.contact.pad_count, 4);
        double pad = 0.85 / 4;
        for (int32_t c = 0; c < 4; c++)
            assert_pad(&drawn, c, c * (pad + 0.05), c * (pad + 0.05) + pad);
        assert_near("area", drawn.summary.area, 0.5 - 3 * (0.05 + floors[k]) / 2 * 0.03, 1e-12);
        assert_near("rod", rise_of(&drawn, "rod"), 0.5, 1e-15);
        drawn_destroy(&drawn);
    }
}

typedef struct Refused {
    const char *mesh;
    MeshParameter parameters[3];
    const char *message;
} Refused;

TEST(test_refused)
{
    static const Refused rows[] = {
        {"pads.geo", {{"fill", 1.2, ""}}, "fill must be above 0 and below 1, found 1.2"},
        {"pads.geo", {{"fill", 1, ""}}, "fill must be above 0 and below 1, found 1"},
        {"pads.geo", {{"n", 0, ""}}, "n must be a whole number from 1 to 10000, found 0"},
        {"pads.geo", {{"n", 9999, ""}, {"nz", 9999, ""}}, "are more than 1e7 cells"},
        {"block.geo", {{"nx", 1e8, ""}}, "1e+08 x 40 cells are more than 1e7"},
        {"block.geo", {{"refine", 1e300, ""}}, "parameter 'refine' is 1e+300; at most 1e+60"},
        {"block.geo", {{"refine", 1e30, ""}}, "cells are more than 1e7"},
        {"block.geo", {{"grade_z", 1e7, ""}}, "(1: even) and at most 1e6, found 1 and 1e+07"},
        {"pads.geo", {{"pad_height", -1, ""}}, "pad_height must be above 0"},
        {"pads.geo", {{"cells_gap", 1.5, ""}}, "whole numbers from 1 on"},
        {"pads.geo", {{"shape", 0, "hex"}}, "shape must be quad or triangle, found hex"},
        {"pads.geo", {{"ends", 0, "round"}}, "ends must be flush or open, found round"},
        {"pads.geo", {{"gap", -0.1, ""}}, "gap must be above 0 (0: as wide as ends makes it)"},
        {"pads.geo", {{"gap", 0.3, ""}}, "0.6 of pads and 2 gaps of 0.3 are longer than the block"},
        {"pads.geo", {{"contact_length", 1.5, ""}}, "below length = 1, found 1.5"},
        {"pads.geo", {{"pad_ratio", 0, ""}}, "pad_ratio must be above 0 (1: equal pads), found 0"},
        {"pads.geo", {{"fillet", -0.1, ""}}, "fillet must be above 0 (0: sharp roots)"},
        {"pads.geo", {{"fillet", 0.05, ""}}, "fillet must be below pad_height = 0.05, half a gap"},
        {"pads.geo", {{"fillet", 0.03, ""}, {"gap", 0.05, ""}}, "half a gap = 0.025"},
        {"pads.geo", {{"fillet", 0.01, ""}, {"layout", 0, "regular"}}, "a fillet needs the layout"},
        {"pads.geo", {{"total_height", 0.05, ""}}, "total_height must be above pad_height"},
        {"pads.geo", {{"size_bulk", -1, ""}}, "size_contact and size_bulk must be above 0"},
        {"grooves.geo", {{"width", 0.5, ""}}, "leave contacts between 2 grooves in a length of 1"},
        {"grooves.geo", {{"floor", 0.06, ""}}, "to width = 0.05 (straight walls), found 0.06"},
        {"grooves.geo", {{"depth", 0.5, ""}}, "depth must be above 0 and below height = 0.5"},
        {"grooves.geo", {{"grooves", 1.5, ""}}, "grooves must be a whole number from 0 on"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char path[600];
        Error err = {0};
        MeshFile file;
        path_of(rows[k].mesh, path);
        assert_false(mesh_file_read(path, rows[k].parameters, count_of(rows[k].parameters), false,
                                    NULL, &file, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, rows[k].message))
            fail_msg("%s\nlacks: %s", err.message, rows[k].message);
        mesh_file_destroy(&file);
    }
}
