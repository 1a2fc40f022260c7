// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh comes back from the cache as it was put in, or not at all: the key knows what the mesh
// depends on, and arrays that do not fit each other are no mesh, whatever their checksum says.
#include "io/mesh/mesh_cache.h"

#include "base/memory.h"
#include "cache_fixture.h"

enum { PATH_SIZE = 2 * PLACE_SIZE };
static const char KEY[] = "0123456789abcdef0123456789abcdef";

static const char *write_text(const char *name, const char *text, char path[PATH_SIZE])
{
    snprintf(path, PATH_SIZE, "%s/%s", cache, name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
    return path;
}

// --- two triangles and a quadrilateral of order 2, three groups --------------------------------

static double position[] = {0, 0, 1, 0, 1, 1, 0, 1, 2, 0, 2, 1, 1.5, 0, 2, 0.5, 1.5, 1, 1, 0.5};
static int64_t node_number[] = {1, 2, 3, 4, 7, 8, 9, 10, 11, 9007199254740991};
static int64_t element_number[] = {5, 6, 123456789012};
static uint8_t kind[] = {ELEMENT_T3, ELEMENT_T3, ELEMENT_Q8};
static int32_t first_node[] = {0, 3, 6, 14};
static int32_t element_nodes[] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 2, 6, 7, 8, 9, 0};   // one more
static int32_t bottom[] = {0, 1, 1, 4}, bottom_nodes[] = {0, 1, 4}, corner[] = {3};
static int32_t part[] = {0, 2};

static MeshFile known_mesh(MeshGroup groups[3])
{
    groups[0] = (MeshGroup){.name = "corner", .number = 3, .node_count = 1, .nodes = corner};
    groups[1] = (MeshGroup){.name = "contact",
                            .dimension = 1,
                            .number = 1,
                            .face_count = 2,
                            .nodes_per_face = 2,
                            .face_nodes = bottom,
                            .node_count = 3,
                            .nodes = bottom_nodes};
    groups[2] = (MeshGroup){
        .name = "body", .dimension = 2, .number = INT32_MAX, .element_count = 2, .elements = part};
    return (MeshFile){.dim = 2,
                      .node_count = 10,
                      .position = position,
                      .node_number = node_number,
                      .element_count = 3,
                      .element_number = element_number,
                      .kind = kind,
                      .first_node = first_node,
                      .element_nodes = element_nodes,
                      .group_count = 3,
                      .groups = groups};
}

static bool load(MeshFile *mesh)
{
    Error err = {0};
    bool found = true;
    if (!mesh_cache_load(KEY, mesh, &found, &err)) fail_msg("%s", err.message);
    return found;
}

TEST(test_back_to_the_bit)
{
    MeshGroup groups[3];
    MeshFile known = known_mesh(groups), mesh;
    assert_false(load(&mesh));   // nothing there yet
    mesh_cache_store(KEY, &known);
    assert_true(load(&mesh));
    assert_int_equal(mesh.node_count, 10);
    assert_int_equal(mesh.element_count, 3);
    assert_int_equal(mesh.group_count, 3);
    assert_memory_equal(mesh.position, position, sizeof position);
    assert_memory_equal(mesh.node_number, node_number, sizeof node_number);
    assert_memory_equal(mesh.element_number, element_number, sizeof element_number);
    assert_memory_equal(mesh.kind, kind, sizeof kind);
    assert_memory_equal(mesh.first_node, first_node, sizeof first_node);
    assert_memory_equal(mesh.element_nodes, element_nodes, 14 * sizeof *element_nodes);
    for (int32_t k = 0; k < 3; k++) {
        const MeshGroup *seen = &mesh.groups[k];
        assert_string_equal(seen->name, groups[k].name);
        assert_int_equal(seen->dimension, groups[k].dimension);
        assert_int_equal(seen->number, groups[k].number);
        assert_int_equal(seen->face_count, groups[k].face_count);
        assert_int_equal(seen->nodes_per_face, groups[k].nodes_per_face);
        assert_int_equal(seen->node_count, groups[k].node_count);
        assert_int_equal(seen->element_count, groups[k].element_count);
    }
    assert_memory_equal(mesh.groups[0].nodes, corner, sizeof corner);
    assert_memory_equal(mesh.groups[1].face_nodes, bottom, sizeof bottom);
    assert_memory_equal(mesh.groups[1].nodes, bottom_nodes, sizeof bottom_nodes);
    assert_memory_equal(mesh.groups[2].elements, part, sizeof part);
    mesh_file_destroy(&mesh);
}

// Whether a mesh with `*place` changed to `value` is taken for one.
static bool believed_with(MeshFile *known, int32_t *place, int32_t value)
{
    MeshFile mesh;
    int32_t kept = *place;
    *place = value;
    mesh_cache_store(KEY, known);
    *place = kept;
    bool taken = load(&mesh);
    mesh_file_destroy(&mesh);
    return taken;
}

TEST(test_what_cannot_be_is_not_believed)
{
    MeshGroup groups[3];
    MeshFile known = known_mesh(groups), mesh;
    assert_true(believed_with(&known, &element_nodes[0], 2));   // a change that a mesh may have
    assert_false(believed_with(&known, &element_nodes[13], 10));
    assert_false(believed_with(&known, &element_nodes[0], -1));
    assert_false(believed_with(&known, &bottom[3], 10));
    assert_false(believed_with(&known, &corner[0], 10));
    assert_false(believed_with(&known, &part[0], 3));
    assert_false(believed_with(&known, &first_node[0], 1));
    for (int32_t k = 0; k < 4; k++) first_node[k]++;
    mesh_cache_store(KEY, &known);
    assert_false(load(&mesh));
    for (int32_t k = 0; k < 4; k++) first_node[k]--;
    assert_false(believed_with(&known, &first_node[1], 4));
    assert_false(believed_with(&known, &known.node_count, 9));   // which elements have
    assert_false(believed_with(&known, &known.node_count, -1));
    assert_false(believed_with(&known, &known.element_count, 2));
    assert_false(believed_with(&known, &known.group_count, -1));
    assert_false(believed_with(&known, &groups[0].dimension, 3));
    assert_true(believed_with(&known, &groups[0].number, -1));
    assert_false(believed_with(&known, &groups[1].nodes_per_face, -1));
    assert_false(believed_with(&known, &groups[2].element_count, -1));
    node_number[9]++;
    mesh_cache_store(KEY, &known);
    assert_true(load(&mesh));   // 2^53
    mesh_file_destroy(&mesh);
    node_number[9]++;
    mesh_cache_store(KEY, &known);
    assert_false(load(&mesh));
    node_number[9] -= 2;
    static const uint8_t kinds[] = {ELEMENT_KIND_COUNT, ELEMENT_T6};
    for (size_t k = 0; k < sizeof kinds; k++) {
        kind[0] = kinds[k];
        mesh_cache_store(KEY, &known);
        assert_false(load(&mesh));
    }
    kind[0] = ELEMENT_T3;
}

static void assert_within(const int32_t *indices, int64_t count, int32_t limit)
{
    for (int64_t k = 0; k < count; k++) assert_true(indices[k] >= 0 && indices[k] < limit);
}

// Each byte changed under a checksum that holds: no mesh, or one whose indices are its own.
TEST(test_every_byte)
{
    static const unsigned char values[] = {0x00, 0x7f, 0xff};
    MeshGroup groups[3];
    MeshFile known = known_mesh(groups), mesh;
    char name[64];
    size_t size, taken = 0;
    snprintf(name, sizeof name, "%s.mesh", KEY);
    mesh_cache_store(KEY, &known);
    char *bytes = cache_bytes(name, &size);
    int64_t live = memory_counters().live;
    for (size_t at = 64; at < size - 32; at++)
        for (size_t v = 0; v < sizeof values; v++) {
            char kept = bytes[at];
            bytes[at] = (char)values[v];
            cache_put(name, bytes, size);
            bytes[at] = kept;
            if (load(&mesh)) {
                taken++;
                assert_within(mesh.first_node, mesh.element_count, INT32_MAX);
                assert_within(mesh.element_nodes, mesh.first_node[mesh.element_count],
                              mesh.node_count);
                for (int32_t k = 0; k < mesh.group_count; k++) {
                    const MeshGroup *group = &mesh.groups[k];
                    assert_within(group->face_nodes, group->face_count * group->nodes_per_face,
                                  mesh.node_count);
                    assert_within(group->nodes, group->node_count, mesh.node_count);
                    assert_within(group->elements, group->element_count, mesh.element_count);
                }
            }
            mesh_file_destroy(&mesh);
            assert_int_equal(memory_counters().live, live);
        }
    assert_true(taken > 100);   // places, names
    free(bytes);
}

static void key_of(const char *name, const char *text, double value, char key[HASH_TEXT_SIZE])
{
    char path[PATH_SIZE];
    Error err = {0};
    MeshParameter parameter = {.name = "nx", .value = value};
    if (!mesh_cache_key(write_text(name, text, path), &parameter, 1, key, &err))
        fail_msg("%s", err.message);
}

TEST(test_key)
{
    char first[HASH_TEXT_SIZE], other[HASH_TEXT_SIZE], path[PATH_SIZE];
    key_of("a.geo", "Point(1) = {0, 0, 0};\n", 4, first);
    assert_int_equal(strlen(first), HASH_TEXT_SIZE - 1);
    key_of("b.geo", "Point(1) = {0, 0, 0};\n", 4, other);
    assert_string_equal(first, other);   // another name is the same mesh
    key_of("b.geo", "Point(1) = {0, 0, 0};\n", 5, other);
    assert_string_not_equal(first, other);
    key_of("b.geo", "Point(1) = {0, 0, 1};\n", 4, other);
    assert_string_not_equal(first, other);
    const char *const draws[] = {"Include \"parts.geo\";\n",
                                 "Merge 'mesh.msh';\n",
                                 "h = StringToNumber(GetEnv(\"H\"));\n",
                                 "v() = ShapeFromFile(\"x.brep\");\n",
                                 "Field[1].FileName = \"sizes.dat\";\n",
                                 "Point(1) = {0, 0, 0}; // Include\n"};   // better once too often
    for (size_t k = 0; k < sizeof draws / sizeof *draws; k++) {
        key_of("b.geo", draws[k], 4, other);
        assert_string_equal(other, "");
    }
    key_of("b.msh", "Include\n", 4, other);   // a mesh holds no commands
    assert_int_equal(strlen(other), HASH_TEXT_SIZE - 1);
    write_text("b.geo.opt", "Mesh.Algorithm = 1;\n", path);
    key_of("b.geo", "Point(1) = {0, 0, 0};\n", 4, other);
    assert_string_equal(other, "");
}

TEST(test_switched_off)
{
    MeshGroup groups[3];
    MeshFile known = known_mesh(groups), mesh;
    setenv("AMONTONS_CACHE", "", 1);
    mesh_cache_store(KEY, &known);
    assert_false(load(&mesh));
    setenv("AMONTONS_CACHE", cache, 1);
}

GROUP_BETWEEN(cache_begin, cache_end);
