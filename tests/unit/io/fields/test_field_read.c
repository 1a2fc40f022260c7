// SPDX-License-Identifier: GPL-2.0-or-later
// Field files and their list, written by hand in VTK's text form: what is read, and what is said
// where something is missing or points outside.
#include "io/fields/field_read.h"

#include "base/memory.h"
#include "near.h"
#include "result_place.h"

enum { TEXT_SIZE = 6000 };

static char place[PLACE_SIZE], path[2 * PLACE_SIZE];

// A square of four nodes, cut into two triangles.
typedef struct Parts {
    const char *points, *connectivity, *offsets, *types, *displacement, *von_mises;
    const char *width;   // components of the displacement
} Parts;

static const Parts GOOD = {.points = "0 0 0  1 0 0  1 1 0  0 1 0",
                           .connectivity = "0 1 2  0 2 3",
                           .offsets = "3 6",
                           .types = "5 5",
                           .displacement = "1 2 0  3 4 0  5 6 0  7 8 0",
                           .von_mises = "1 2 3 4",
                           .width = "3"};

static void add_array(char *text, const char *type, const char *name, const char *width,
                      const char *values)
{
    if (!values) return;
    size_t used = strlen(text);
    snprintf(text + used, TEXT_SIZE - used,
             "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%s\" format=\"ascii\">\n"
             "%s\n</DataArray>\n",
             type, name, width, values);
}

static bool read_parts(const Parts *parts, FieldFrame *frame, Error *err)
{
    static const char *const vectors[] = {"velocity", "stress_elastic", "stress"};
    char text[TEXT_SIZE] = "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\">\n"
                           "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n"
                           "<PointData>\n";
    add_array(text, "Float64", "displacement", parts->width, parts->displacement);
    for (int k = 0; k < 3; k++) add_array(text, "Float64", vectors[k], "3", GOOD.points);
    add_array(text, "Float64", "von_mises", "1", parts->von_mises);
    add_array(text, "Float64", "of_others", "1", "9 9 9 9");
    strcat(text, "</PointData>\n<Points>\n");
    add_array(text, "Float64", "Points", "3", parts->points);
    strcat(text, "</Points>\n<Cells>\n");
    add_array(text, "Int64", "connectivity", "1", parts->connectivity);
    add_array(text, "Int64", "offsets", "1", parts->offsets);
    add_array(text, "UInt8", "types", "1", parts->types);
    strcat(text, "</Cells>\n</Piece></UnstructuredGrid></VTKFile>\n");
    place_write(place, "one.vtu", text);
    *err = (Error){0};
    return field_frame_read(path, frame, err);
}

TEST(test_frame)
{
    Error err;
    FieldFrame frame;
    if (!read_parts(&GOOD, &frame, &err)) fail_msg("%s", err.message);
    assert_int_equal(frame.node_count, 4);
    assert_int_equal(frame.element_count, 2);
    assert_int_equal(frame.kind[1], ELEMENT_T3);
    assert_int_equal(frame.element_nodes[5], 3);
    assert_true(frame.displacement[10] == 8 && frame.von_mises[2] == 3 && frame.position[7] == 1);
    field_frame_destroy(&frame);
}

// Deeper elements are left out, with the nodes that only they have.
TEST(test_crop)
{
    Error err;
    FieldFrame frame;
    Parts parts = GOOD;
    parts.points = "0 -1 0  1 -3 0  1 -2 0  0 0 0";
    if (!read_parts(&parts, &frame, &err)) fail_msg("%s", err.message);
    assert_true(field_frame_crop(&frame, 0.5, &err));
    assert_int_equal(frame.element_count, 1);
    assert_int_equal(frame.node_count, 3);
    for (int32_t k = 0; k < 3; k++) assert_int_equal(frame.element_nodes[k], k);
    assert_int_equal(frame.first_node[1], 3);
    assert_true(frame.position[4] == -2 && frame.displacement[7] == 8 && frame.von_mises[1] == 3);
    assert_true(field_frame_crop(&frame, 5, &err));
    assert_int_equal(frame.node_count, 3);
    field_frame_destroy(&frame);
}

static void assert_damaged(Parts parts, const char *says)
{
    Error err;
    FieldFrame frame;
    int64_t live = memory_counters().live;
    if (read_parts(&parts, &frame, &err)) fail_msg("not refused: %s", says);
    field_frame_destroy(&frame);
    assert_int_equal(memory_counters().live, live);
    if (!strstr(err.message, says) || !strstr(err.message, path))
        fail_msg("'%s' does not say '%s'", err.message, says);
}

TEST(test_damaged)
{
    Parts parts = GOOD;
    parts.types = "5 3";   // a line
    assert_damaged(parts, "it has cells that are no elements of a block");
    parts.types = "5 9";   // a quadrilateral of three nodes
    assert_damaged(parts, "its cells have the wrong number of nodes");
    parts = GOOD;
    parts.connectivity = "0 1 2  0 2 4";
    assert_damaged(parts, "its connectivity are damaged");
    parts.connectivity = "0 1 2  0 -2 3";
    assert_damaged(parts, "its connectivity are damaged");
    parts = GOOD;
    parts.offsets = "3 -6";
    assert_damaged(parts, "the file is damaged, VTK cannot read it: ");
    parts = GOOD;
    parts.offsets = "3 5";
    assert_damaged(parts, "its cells have the wrong number of nodes");
    parts = GOOD;
    parts.width = "1";
    parts.displacement = "1 2 3 4";
    assert_damaged(parts, "its array displacement is not one of 3 numbers a node");
    parts = GOOD;
    parts.von_mises = NULL;
    assert_damaged(parts, "it lacks an array that a run writes");
}

TEST(test_list)
{
    Error err = {0};
    FieldTime *times;
    int32_t count;
    assert_false(field_times_read(place, &times, &count, &err));
    assert_non_null(strstr(err.message, "has no fields of the block"));
    place_write(place, "fields.pvd",
                "<VTKFile>\n"
                "<DataSet timestep=\"0\" name=\"contact\" file=\"fields/contact_0.vtp\"/>\n"
                "<DataSet timestep=\"0.5\" name=\"bulk\" file=\"fields/bulk_0.vtu\"/>\n"
                "<DataSet timestep=\"soon\" name=\"bulk\" file=\"fields/bulk_1.vtu\"/>\n"
                "<DataSet timestep=\"1\" name=\"bulk\" file=\"../bulk_2.vtu\"/>\n"
                "<DataSet timestep=\"1\" name=\"bulk\" file=\"/etc/passwd\"/>\n"
                "<DataSet timestep=\"1\" name=\"bulk\" file=\"\"/>\n"
                "<DataSet timestep=\"1\" name=\"bulk\"/>\n"
                "<DataSet timestep=\"1.5\" name=\"bulk\" file=\"fields/bulk_3.vtu\"/>\n");
    err = (Error){0};
    if (!field_times_read(place, &times, &count, &err)) fail_msg("%s", err.message);
    assert_int_equal(count, 2);   // nothing outside the folder
    assert_true(times[0].t == 0.5 && times[1].t == 1.5);
    assert_string_equal(times[1].file, "fields/bulk_3.vtu");
    memory_free(times);
    place_write(place, "fields.pvd", "<VTKFile>\n</VTKFile>\n");
    assert_false(field_times_read(place, &times, &count, &err));
    assert_non_null(strstr(err.message, "names no time"));
    assert_null(times);
}

FIXTURE(make)
{
    place_make(place);
    snprintf(path, sizeof path, "%s/one.vtu", place);
    return 0;
}

FIXTURE(drop)
{
    place_remove(place);
    return 0;
}

GROUP_BETWEEN(make, drop);
