// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes through gmsh: the same block by every format, what each kind of element brings, and every
// way in which a file can be wrong. Small .msh files are written out by hand here, so that what is
// expected does not come from the code under test.
#include "io/mesh/mesh_file.h"

#include "base/memory.h"
#include "cases.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// cmocka 1.1.5 compares floats only, in single precision.
static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, wanted, tolerance);
}

enum { PATH_SIZE = 600 };

static char folder[PATH_SIZE];   // for the files of this program; set up once

static const char *source_path(const char *name, char path[PATH_SIZE])
{
    snprintf(path, PATH_SIZE, "%s/%s", getenv("AMONTONS_SOURCE"), name);
    return path;
}

static const char *write_file(const char *name, const char *text, char path[PATH_SIZE])
{
    snprintf(path, PATH_SIZE, "%.500s/%.90s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
    return path;
}

FIXTURE(make_folder)
{
    snprintf(folder, sizeof folder, "/tmp/amontons_mesh_XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

FIXTURE(remove_folder)
{
    char command[PATH_SIZE + 20];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command);
}

static void read_well(const char *path, const MeshParameter *parameters, int32_t count,
                      MeshFile *mesh)
{
    Error err = {0};
    bool done = mesh_file_read(path, parameters, count, false, NULL, mesh, &err);
    if (!done) fail_msg("%s", err.message);
}

// Reading fails as wrong input, with the file's name first and each of the words (NULL: none).
static void read_badly(const char *path, const MeshParameter *parameter, const char *one,
                       const char *two, const char *three)
{
    Error err = {0};
    MeshFile mesh;
    int64_t live = memory_counters().live;
    bool done = mesh_file_read(path, parameter, parameter ? 1 : 0, false, NULL, &mesh, &err);
    mesh_file_destroy(&mesh);
    assert_false(done);
    assert_int_equal(err.code, ERROR_INPUT);
    const char *wanted[] = {path, one, two, three};
    for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++)
        if (wanted[k] && !strstr(err.message, wanted[k]))
            fail_msg("'%s' is not in: %s", wanted[k], err.message);
    assert_ptr_equal(strstr(err.message, path), err.message);
    assert_int_equal(memory_counters().live, live);
}

// --- good meshes --------------------------------------------------------------------------------

static const MeshParameter T3[] = {{"nx", 3, ""}, {"nz", 2, ""}, {"shape", 0, "triangle"}};
static const MeshParameter T6[] = {
    {"nx", 3, ""}, {"nz", 2, ""}, {"shape", 0, "triangle"}, {"order", 2, ""}};
static const MeshParameter Q4[] = {{"nx", 3, ""}, {"nz", 2, ""}};
static const MeshParameter Q8[] = {
    {"nx", 3, ""}, {"nz", 2, ""}, {"order", 2, ""}, {"incomplete", 1, ""}};
static const MeshParameter Q9[] = {{"nx", 3, ""}, {"nz", 2, ""}, {"order", 2, ""}};

// A block of 3 x 2 cells by each kind: counts by hand.
TEST(test_element_kinds)
{
    static const struct {
        const MeshParameter *parameters;
        int32_t parameter_count;
        ElementKind kind;
        int32_t nodes, elements, width, contact_nodes;
    } rows[] = {{T3, 3, ELEMENT_T3, 4 * 3, 12, 2, 4},
                {T6, 4, ELEMENT_T6, 7 * 5, 12, 3, 7},
                {Q4, 2, ELEMENT_Q4, 4 * 3, 6, 2, 4},
                {Q8, 4, ELEMENT_Q8, 7 * 5 - 6, 6, 3, 7},
                {Q9, 3, ELEMENT_Q9, 7 * 5, 6, 3, 7}};
    char path[PATH_SIZE];
    source_path("meshes/block.geo", path);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        MeshFile mesh;
        Error err = {0};
        read_well(path, rows[k].parameters, rows[k].parameter_count, &mesh);
        assert_int_equal(mesh.node_count, rows[k].nodes);
        assert_int_equal(mesh.element_count, rows[k].elements);
        for (int32_t e = 0; e < mesh.element_count; e++)
            assert_int_equal(mesh.kind[e], rows[k].kind);
        assert_int_equal(mesh.first_node[mesh.element_count],
                         rows[k].elements * element_node_count(rows[k].kind));
        const MeshGroup *contact = mesh_file_group(&mesh, path, "contact", 1, &err);
        assert_non_null(contact);
        assert_int_equal(contact->face_count, 3);
        assert_int_equal(contact->nodes_per_face, rows[k].width);
        assert_int_equal(contact->node_count, rows[k].contact_nodes);
        for (int32_t i = 0; i < contact->node_count; i++)
            assert_true(mesh.position[2 * contact->nodes[i] + 1] == 0);
        mesh_file_destroy(&mesh);
    }
}

// Mid-side nodes follow the corners, in the order of the sides; an edge's middle comes last.
TEST(test_node_order)
{
    char path[PATH_SIZE];
    MeshFile mesh;
    Error err = {0};
    read_well(source_path("meshes/block.geo", path), Q9, 3, &mesh);
    for (int32_t e = 0; e < mesh.element_count; e++) {
        const int32_t *nodes = mesh.element_nodes + mesh.first_node[e];
        for (int32_t d = 0; d < 2; d++) {
            double centre = 0;
            for (int32_t a = 0; a < 4; a++) {
                double from = mesh.position[2 * nodes[a] + d];
                double to = mesh.position[2 * nodes[(a + 1) % 4] + d];
                double middle = mesh.position[2 * nodes[4 + a] + d];
                assert_near(middle, (from + to) / 2, 1e-12);
                centre += from / 4;
            }
            assert_near(mesh.position[2 * nodes[8] + d], centre, 1e-12);
        }
    }
    const MeshGroup *top = mesh_file_group(&mesh, path, "top", 1, &err);
    for (int32_t k = 0; k < top->face_count; k++) {
        const int32_t *nodes = top->face_nodes + 3 * k;
        assert_near(mesh.position[2 * nodes[2]],
                    (mesh.position[2 * nodes[0]] + mesh.position[2 * nodes[1]]) / 2, 1e-12);
    }
    mesh_file_destroy(&mesh);
}

static void assert_same(const MeshFile *a, const MeshFile *b, double tolerance)
{
    assert_int_equal(a->node_count, b->node_count);
    for (int32_t k = 0; k < 2 * a->node_count; k++)
        assert_true(fabs(a->position[k] - b->position[k]) <= tolerance);
    assert_int_equal(a->element_count, b->element_count);
    assert_memory_equal(a->kind, b->kind, (size_t)a->element_count);
    int32_t total = a->first_node[a->element_count];
    assert_memory_equal(a->element_nodes, b->element_nodes, (size_t)total * sizeof(int32_t));
    assert_int_equal(a->group_count, b->group_count);
    for (int32_t g = 0; g < a->group_count; g++) {
        const MeshGroup *p = &a->groups[g], *q = &b->groups[g];
        assert_string_equal(p->name, q->name);
        assert_int_equal(p->dimension, q->dimension);
        assert_int_equal(p->number, q->number);
        assert_int_equal(p->face_count, q->face_count);
        assert_int_equal(p->node_count, q->node_count);
        assert_memory_equal(p->face_nodes, q->face_nodes,
                            (size_t)(p->face_count * p->nodes_per_face) * sizeof(int32_t));
        assert_memory_equal(p->nodes, q->nodes, (size_t)p->node_count * sizeof(int32_t));
    }
}

// gmsh's own program writes the block in four formats; each gives what the .geo gives.
TEST(test_formats_agree)
{
    static const char *const formats[] = {"-format msh41", "-format msh41 -bin", "-format msh22",
                                          "-format msh22 -bin"};
    static const char *const shapes[] = {"", "-setstring shape triangle -setnumber order 2"};
    char geo[PATH_SIZE], msh[PATH_SIZE], command[3 * PATH_SIZE];
    source_path("meshes/block.geo", geo);
    for (int32_t s = 0; s < 2; s++) {
        MeshFile direct;
        read_well(geo, s ? T6 : Q4, s ? 4 : 2, &direct);
        for (int32_t f = 0; f < 4; f++) {
            snprintf(msh, sizeof msh, "%.500s/block%d.msh", folder, f);
            snprintf(command, sizeof command,
                     "gmsh -v 1 -nt 1 -2 '%s' -setnumber nx 3 -setnumber nz 2 %s %s -o '%s' "
                     ">/dev/null 2>&1",
                     geo, shapes[s], formats[f], msh);
            assert_int_equal(system(command), 0);
            MeshFile mesh;
            read_well(msh, NULL, 0, &mesh);
            assert_same(&direct, &mesh, f % 2 ? 0 : 1e-15);   // ASCII has 16 digits
            mesh_file_destroy(&mesh);
        }
        mesh_file_destroy(&direct);
    }
}

// gmsh keeps options and groups until it is finalised: one read must not colour the next.
TEST(test_second_read_is_clean)
{
    char path[PATH_SIZE];
    MeshFile first, between, second;
    source_path("meshes/block.geo", path);
    read_well(path, Q4, 2, &first);
    read_well(path, Q8, 4, &between);
    read_well(path, Q4, 2, &second);
    assert_same(&first, &second, 0);
    mesh_file_destroy(&first);
    mesh_file_destroy(&between);
    mesh_file_destroy(&second);
}

// Centres of arcs, loose points and lines of the drawing, surfaces outside the groups: left out.
TEST(test_drawing_aids)
{
    char path[PATH_SIZE];
    MeshFile mesh;
    Error err = {0};
    write_file("aids.geo",
               "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0};\n"
               "Point(4) = {0, 1, 0}; Point(5) = {0.5, -3, 0}; Point(6) = {7, 7, 0};\n"
               "Point(7) = {9, 7, 0}; Point(8) = {9, 9, 0}; Point(9) = {0.5, 1, 0};\n"
               "Line(1) = {1, 2}; Line(2) = {2, 3}; Circle(3) = {3, 5, 4}; Line(4) = {4, 1};\n"
               "Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 6};\n"
               "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
               "Curve Loop(2) = {5, 6, 7}; Plane Surface(2) = {2};\n"
               "Transfinite Curve{1:4} = 3; Transfinite Surface{1}; Recombine Surface{1};\n"
               "Physical Surface(\"body\") = {1}; Physical Curve(\"contact\") = {1};\n"
               "Physical Point(\"corner\") = {1}; Physical Point(\"mark\") = {9};\n",
               path);
    read_well(path, NULL, 0, &mesh);
    assert_int_equal(mesh.node_count, 9);
    assert_int_equal(mesh.element_count, 4);
    assert_int_equal(mesh_file_group(&mesh, path, "corner", 0, &err)->node_count, 1);
    assert_int_equal(mesh_file_group(&mesh, path, "mark", 0, &err)->node_count, 0);
    mesh_file_destroy(&mesh);
}

// --- meshes written by hand ---------------------------------------------------------------------

// Two squares side by side, 0 <= x <= 2, 0 <= z <= 1, in format 2.2.
#define NAMES_22 "$PhysicalNames\n2\n1 1 \"contact\"\n2 7 \"body\"\n$EndPhysicalNames\n"
#define NODES_22 "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n"
#define HEAD_22 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define ELEMENTS_22                                                                                \
    "$Elements\n4\n1 1 2 1 1 1 2\n2 1 2 1 1 2 3\n3 3 2 7 1 1 2 5 4\n4 3 2 7 1 2 3 6 5\n"           \
    "$EndElements\n"

TEST(test_by_hand)
{
    static const double positions[] = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1};
    static const int32_t nodes[] = {0, 1, 4, 3, 1, 2, 5, 4}, edges[] = {0, 1, 1, 2};
    char path[PATH_SIZE];
    MeshFile mesh;
    write_file("hand.msh", HEAD_22 NAMES_22 NODES_22 ELEMENTS_22, path);
    read_well(path, NULL, 0, &mesh);
    assert_int_equal(mesh.node_count, 6);
    assert_memory_equal(mesh.position, positions, sizeof positions);
    assert_int_equal(mesh.node_number[5], 6);
    assert_int_equal(mesh.element_number[1], 4);
    assert_memory_equal(mesh.element_nodes, nodes, sizeof nodes);
    assert_int_equal(mesh.group_count, 2);
    assert_string_equal(mesh.groups[0].name, "contact");
    assert_memory_equal(mesh.groups[0].face_nodes, edges, sizeof edges);
    assert_string_equal(mesh.groups[1].name, "body");
    assert_int_equal(mesh.groups[1].number, 7);
    mesh_file_destroy(&mesh);
}

TEST(test_groups_by_number)
{
    char path[PATH_SIZE];
    MeshFile mesh;
    Error err = {0};
    write_file("unnamed.msh", HEAD_22 NODES_22 ELEMENTS_22, path);
    read_well(path, NULL, 0, &mesh);
    assert_int_equal(mesh_file_group(&mesh, path, "1", 1, &err)->face_count, 2);
    assert_non_null(mesh_file_group(&mesh, path, "7", 2, &err));
    mesh_file_destroy(&mesh);
}

TEST(test_group_lookup)
{
    char path[PATH_SIZE];
    MeshFile mesh;
    Error missing = {0}, surface = {0}, far = {0};
    write_file("hand.msh", HEAD_22 NAMES_22 NODES_22 ELEMENTS_22, path);
    read_well(path, NULL, 0, &mesh);
    assert_null(mesh_file_group(&mesh, path, "contcat", 1, &missing));
    assert_int_equal(missing.code, ERROR_INPUT);
    assert_non_null(strstr(missing.message, path));
    assert_non_null(strstr(missing.message, "has no group 'contcat'"));
    assert_non_null(strstr(missing.message, "'contact' (curve), 'body' (surface)"));
    assert_non_null(strstr(missing.message, "did you mean 'contact'?"));
    assert_null(mesh_file_group(&mesh, path, "xyz", 1, &far));
    assert_null(strstr(far.message, "did you mean"));
    assert_null(mesh_file_group(&mesh, path, "body", 1, &surface));
    assert_int_equal(surface.code, ERROR_INPUT);
    assert_non_null(strstr(surface.message, "'body' is a surface, wanted is a curve"));
    assert_non_null(strstr(surface.message, "'contact' (curve)"));
    mesh_file_destroy(&mesh);
}

// A node on no element stays in the arrays, for fem/mesh to complain about (format 4.1 says which
// surface it is on; with 2.2, gmsh drops it by itself).
TEST(test_lone_node)
{
    char path[PATH_SIZE];
    MeshFile mesh;
    write_file("lone.msh",
               "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
               "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 0 0\n$EndEntities\n"
               "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n5 7 0\n$EndNodes\n"
               "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n",
               path);
    read_well(path, NULL, 0, &mesh);
    assert_int_equal(mesh.node_count, 4);
    assert_int_equal(mesh.node_number[3], 4);
    assert_true(mesh.position[6] == 5 && mesh.position[7] == 7);
    mesh_file_destroy(&mesh);
}

// Format 2.2 writes what is in two groups twice; the mesh has it once.
TEST(test_two_groups_in_22)
{
    char path[PATH_SIZE];
    MeshFile mesh;
    write_file("twice.msh",
               HEAD_22 NODES_22 "$Elements\n8\n1 1 2 1 1 1 2\n2 1 2 2 1 1 2\n3 1 2 1 1 2 3\n"
                                "4 1 2 2 1 2 3\n5 3 2 7 1 1 2 5 4\n6 3 2 8 1 1 2 5 4\n"
                                "7 3 2 7 1 2 3 6 5\n8 3 2 8 1 2 3 6 5\n$EndElements\n",
               path);
    read_well(path, NULL, 0, &mesh);
    assert_int_equal(mesh.element_count, 2);
    assert_int_equal(mesh.groups[0].face_count, 2);
    assert_int_equal(mesh.groups[1].face_count, 2);
    mesh_file_destroy(&mesh);
}

// The right one of two cells is in group 8 as well, the left edge in group 1, the right one in 2.
static void check_told_apart(const char *path, int32_t times)
{
    MeshFile mesh;
    MeshParameter refine = {"refine", times, ""};
    Error err = {0};
    read_well(path, &refine, 1, &mesh);
    assert_int_equal(mesh.element_count, 2 * times * times);
    const MeshGroup *left = mesh_file_group(&mesh, path, "1", 1, &err);
    const MeshGroup *right = mesh_file_group(&mesh, path, "2", 1, &err);
    const MeshGroup *all = mesh_file_group(&mesh, path, "7", 2, &err);
    const MeshGroup *one = mesh_file_group(&mesh, path, "8", 2, &err);
    assert_true(left && right && all && one);
    assert_int_equal(left->face_count, times);
    assert_int_equal(right->face_count, times);
    assert_int_equal(all->element_count, 2 * times * times);
    assert_int_equal(one->element_count, times * times);
    for (int32_t k = 0; k < right->node_count; k++)
        assert_true(mesh.position[2 * right->nodes[k]] >= 1);
    mesh_file_destroy(&mesh);
}

// Numbers of entities are the file's own matter: all 1, all 0 as meshio has them, or none.
TEST(test_entities_in_22)
{
    static const char *const forms[] = {"%d 2 %d 1 ", "%d 2 %d 0 ", "%d 1 %d ",
                                        "%d 5 %d 1 2 1 -2 "};
    static const char *const ends[] = {"1 2", "2 3", "1 2 5 4", "2 3 6 5", "2 3 6 5"};
    static const int types[] = {1, 1, 3, 3, 3}, groups[] = {1, 2, 7, 7, 8};
    char path[PATH_SIZE], text[1000];
    for (size_t f = 0; f < sizeof forms / sizeof *forms; f++) {
        int length = snprintf(text, sizeof text, HEAD_22 NODES_22 "$Elements\n5\n");
        for (int k = 0; k < 5; k++) {
            length += snprintf(text + length, sizeof text - (size_t)length, "%d ", k + 1);
            length += snprintf(text + length, sizeof text - (size_t)length, forms[f], types[k],
                               groups[k]);
            length += snprintf(text + length, sizeof text - (size_t)length, "%s\n", ends[k]);
        }
        snprintf(text + length, sizeof text - (size_t)length, "$EndElements\n");
        write_file("shared.msh", text, path);
        check_told_apart(path, 1);
    }
}

// The same in a binary file, elements one by one as meshio writes them.
TEST(test_entities_in_binary_22)
{
    static const int32_t blocks[][3] = {{1, 1, 2}, {1, 1, 2}, {3, 1, 2}, {3, 1, 2}, {3, 1, 2}};
    static const int32_t numbers[][7] = {{1, 1, 0, 1, 2},
                                         {2, 2, 0, 2, 3},
                                         {3, 7, 0, 1, 2, 5, 4},
                                         {4, 7, 0, 2, 3, 6, 5},
                                         {5, 8, 0, 2, 3, 6, 5}};
    static const double places[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0};
    char path[PATH_SIZE];
    int32_t one = 1;
    FILE *file = fopen(write_file("binary.msh", "", path), "wb");
    assert_non_null(file);
    fprintf(file, "$MeshFormat\n2.2 1 8\n");
    fwrite(&one, 4, 1, file);
    fprintf(file, "\n$EndMeshFormat\n$Nodes\n6\n");
    for (int32_t i = 0; i < 6; i++) {
        int32_t number = i + 1;
        fwrite(&number, 4, 1, file);
        fwrite(places + 3 * i, 8, 3, file);
    }
    fprintf(file, "\n$EndNodes\n$Elements\n5\n");
    for (int32_t k = 0; k < 5; k++) {
        fwrite(blocks[k], 4, 3, file);
        fwrite(numbers[k], 4, k < 2 ? 5 : 7, file);
    }
    fprintf(file, "\n$EndElements\n");
    assert_int_equal(fclose(file), 0);
    check_told_apart(path, 1);
}

// Endings of gmsh and of other systems, and what an editor puts before the first word.
TEST(test_names_and_marks)
{
    static const char *const names[] = {"HAND.MSH", "hand.msh2", "hand.Msh4"};
    char path[PATH_SIZE];
    MeshFile mesh;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        write_file(names[k], HEAD_22 NAMES_22 NODES_22 ELEMENTS_22, path);
        read_well(path, NULL, 0, &mesh);
        assert_int_equal(mesh.element_count, 2);
        mesh_file_destroy(&mesh);
    }
    write_file("mark.msh", "\xEF\xBB\xBF" HEAD_22 NAMES_22 NODES_22 ELEMENTS_22, path);
    read_well(path, NULL, 0, &mesh);
    assert_int_equal(mesh.element_count, 2);
    mesh_file_destroy(&mesh);
    write_file("BLOCK.GEO",
               "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {0, 1, 0};\n"
               "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};\n"
               "Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};\n",
               path);
    read_well(path, NULL, 0, &mesh);
    assert_true(mesh.element_count > 0);
    mesh_file_destroy(&mesh);
    read_badly(write_file("part.step", "x", path), NULL, "meshes/step3d.geo", NULL, NULL);
    read_badly(write_file("part.vtu", "x", path), NULL, "meshio", NULL, NULL);
}

// --- files that are wrong -----------------------------------------------------------------------

TEST(test_not_a_mesh)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%.500s/absent.msh", folder);
    read_badly(path, NULL, "No such file", NULL, NULL);
    snprintf(path, sizeof path, "%.500s/absent.geo", folder);
    read_badly(path, NULL, "No such file", NULL, NULL);
    read_badly(folder, NULL, "a mesh is a .msh or a .geo file", NULL, NULL);
    read_badly(write_file("empty.msh", "", path), NULL, "is empty", NULL, NULL);
    read_badly(write_file("mesh.vtk", "x", path), NULL, "a .msh or a .geo", NULL, NULL);
    read_badly(write_file("junk.msh", "hello\nworld\n", path), NULL, "is not a gmsh mesh",
               "$MeshFormat", NULL);
    read_badly(write_file("junk.geo", "hello world\n", path), NULL, "junk.geo:1: `hello`",
               "neither a word of gmsh", NULL);
    read_badly(write_file("head.msh", "$MeshFormat\n", path), NULL, "truncated", NULL, NULL);
    read_badly(write_file("none.msh", "$MeshFormat\nx 0 8\n", path), NULL, "no version", NULL,
               NULL);
    read_badly(write_file("talk.msh", "$Comments\nhello\n$EndComments\n", path), NULL,
               "it has no $MeshFormat", NULL, NULL);
    snprintf(path, sizeof path, "%.500s/folder.msh", folder);
    assert_int_equal(mkdir(path, 0700), 0);
    read_badly(path, NULL, "is not a file", NULL, NULL);
}

// Cut anywhere, inside a number or between sections, a file is refused.
TEST(test_truncated)
{
    static const char text[] = HEAD_22 NAMES_22 NODES_22 ELEMENTS_22;
    char path[PATH_SIZE], part[sizeof text];
    for (size_t length = sizeof text - 3; length > 20; length -= 7) {
        memcpy(part, text, length);
        part[length] = '\0';
        read_badly(write_file("part.msh", part, path), NULL, NULL, NULL, NULL);
    }
    memcpy(part, text, sizeof text);
    strcpy(strstr(part, "$EndElements") - 2, "\n");   // within the last node number: "6 5" -> "6"
    read_badly(write_file("part.msh", part, path), NULL, "truncated", "$EndElements", NULL);
    // With the end mark put back, only gmsh can see it.
    strcpy(strstr(part, "2 3 6") + 5, "\n$EndElements\n");
    read_badly(write_file("part.msh", part, path), NULL, "gmsh failed", NULL, NULL);
}

TEST(test_elements_refused)
{
    char path[PATH_SIZE];
    write_file("lines.msh", HEAD_22 NODES_22 "$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n", path);
    read_badly(path, NULL, "has no surface elements", "1 other elements", NULL);
    write_file("points.geo", "Point(1) = {0, 0, 0};\n", path);
    read_badly(path, NULL, "has no surface elements", NULL, NULL);
    write_file("cubic.geo",
               "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {0, 1, 0};\n"
               "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};\n"
               "Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1}; Mesh.ElementOrder = 3;\n",
               path);
    read_badly(path, NULL, "Triangle 10", "T3, T6, Q4, Q8, Q9", NULL);
    write_file("pyramid.geo",
               "SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 1, 1, 1};\n"
               "Transfinite Curve \"*\" = 2; Transfinite Surface \"*\"; Recombine Surface \"*\";\n"
               "Transfinite Volume 1; Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1;\n",
               path);
    read_badly(path, NULL, "Hexahedron 20", "corners of negative weight", "HEX27");
    write_file("tilted.msh",
               HEAD_22 "$Nodes\n3\n1 0 0 0\n2 1 0 0.5\n3 0 1 0\n$EndNodes\n"
                       "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n",
               path);
    read_badly(path, NULL, "plane z = 0", "node 2", "0.5");
    write_file("nan.msh",
               HEAD_22 "$Nodes\n3\n1 0 0 0\n2 nan 0 0\n3 0 1 0\n$EndNodes\n"
                       "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n",
               path);
    read_badly(path, NULL, "node 2 has a coordinate that is not a number", NULL, NULL);
}

TEST(test_repeated_names)
{
    char path[PATH_SIZE];
    write_file("same.msh",
               HEAD_22
               "$PhysicalNames\n2\n1 1 \"contact\"\n2 7 \"contact\"\n$EndPhysicalNames\n" NODES_22
                   ELEMENTS_22,
               path);
    MeshFile mesh;   // a curve and a surface of one name
    read_well(path, NULL, 0, &mesh);
    assert_int_equal(mesh_file_group(&mesh, path, "contact", 1, &(Error){0})->face_count, 2);
    assert_int_equal(mesh_file_group(&mesh, path, "contact", 2, &(Error){0})->element_count, 2);
    mesh_file_destroy(&mesh);
    write_file("pair.msh",
               HEAD_22
               "$PhysicalNames\n2\n1 1 \"contact\"\n1 2 \"contact\"\n$EndPhysicalNames\n" NODES_22
               "$Elements\n3\n1 1 2 1 1 1 2\n2 1 2 2 2 2 3\n3 3 2 7 1 1 2 5 4\n$EndElements\n",
               path);
    read_badly(path, NULL, "'contact' is used twice", "groups 1 and 2 of dimension 1", NULL);
    write_file("same.geo",
               "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {0, 1, 0};\n"
               "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};\n"
               "Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1}; Physical Surface(\"b\") = {1};\n"
               "Physical Curve(\"side\") = {2}; Physical Curve(\"side\") = {3};\n",
               path);
    read_badly(path, NULL, "'side' is used twice", NULL, NULL);
}

TEST(test_parameters_refused)
{
    char path[PATH_SIZE];
    const MeshParameter unknown = {"hieght", 2, ""}, text = {"nx", 0, "many"},
                        number = {"shape", 4, ""}, bad = {"nx", 0, ""}, word = {"shape", 0, "hex"},
                        given = {"nx", 3, ""};
    source_path("meshes/block.geo", path);
    read_badly(path, &unknown, "'hieght'", "length, height, nx", "did you mean 'height'?");
    read_badly(path, &text, "'nx' is a number", "'many'", NULL);
    read_badly(path, &number, "'shape' is a text", "4", NULL);
    read_badly(path, &bad, "nx and nz must be whole numbers from 1 on", "found 0 and 40", NULL);
    read_badly(path, &word, "shape must be quad or triangle", "hex", NULL);
    write_file("hand.msh", HEAD_22 NAMES_22 NODES_22 ELEMENTS_22, path);
    read_badly(path, &given, "'nx'", "need a .geo", NULL);
    static const double refined[] = {3, 0.5, 1 << 20};   // not in halves, coarser, too often
    for (size_t k = 0; k < sizeof refined / sizeof *refined; k++) {
        const MeshParameter refine = {"refine", refined[k], ""};
        read_badly(path, &refine, "refine = ", "it can be 1, 2, 4", NULL);
    }
    const MeshParameter worded = {"refine", 0, "much"};
    read_badly(path, &worded, "'refine'", "need a .geo", NULL);
    write_file("own.geo", "Point(1) = {0, 0, 0};\n", path);
    const MeshParameter third = {"refine", 3, ""};
    read_badly(path, &third, "refine = 3", "unless the .geo has a parameter", NULL);
}

// Algorithm 8 ends the program; a quad mesher that throws in a thread would too.
TEST(test_gmsh_that_would_crash)
{
    static const char square[] =
        "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};\n"
        "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
        "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n";
    char path[PATH_SIZE], text[1000];
    snprintf(text, sizeof text, "%sMesh.Algorithm = 8;\n", square);
    read_badly(write_file("eight.geo", text, path), NULL, "Mesh.Algorithm = 8", "use 6", NULL);
    snprintf(
        text, sizeof text,
        "%sTransfinite Curve{1:4} = 6; Recombine Surface{1}; Mesh.RecombinationAlgorithm = 3;\n",
        square);
    read_badly(write_file("odd.geo", text, path), NULL, "gmsh failed while meshing it", "divided",
               NULL);
}

// --- memory -------------------------------------------------------------------------------------

static void exhaust(const char *path, const MeshParameter *parameters, int32_t count)
{
    int64_t live = memory_counters().live;
    bool done = false;
    for (int64_t k = 0; !done; k++) {
        Error err = {0};
        MeshFile mesh;
        memory_fail_after(k);
        done = mesh_file_read(path, parameters, count, false, NULL, &mesh, &err);
        memory_fail_after(-1);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        mesh_file_destroy(&mesh);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 1000);
    }
}

TEST(test_memory_faults)
{
    char path[PATH_SIZE];
    exhaust(source_path("meshes/block.geo", path), T6, 4);
    write_file("hand.msh", HEAD_22 NAMES_22 NODES_22 ELEMENTS_22, path);
    exhaust(path, NULL, 0);
    MeshFile mesh;
    Error err = {0};
    read_well(path, NULL, 0, &mesh);
    memory_fail_after(0);
    assert_null(mesh_file_group(&mesh, path, "absent", 1, &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    mesh_file_destroy(&mesh);
}

GROUP_BETWEEN(make_folder, remove_folder);
