// SPDX-License-Identifier: GPL-2.0-or-later
// The key of a shape changes when and only when its interface or basis does, and what the cache
// gives back is what was put in, or nothing with a reason.
#include "model/shape_cache.h"

#include "base/memory.h"
#include "near.h"
#include "scene_of_text.h"
#include "random_numbers.h"

#include <unistd.h>

enum { FOLDER_SIZE = 64, PATH_SIZE = 256, TEXT_SIZE = 4000 };
static const double TOLERANCE = 1e-2;

static char folder[FOLDER_SIZE], cache[FOLDER_SIZE + 16];

static void write_text(const char *name, const char *text)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
}

FIXTURE(make_folder)
{
    snprintf(folder, sizeof folder, "/tmp/amontons-shapes-XXXXXX");
    if (!mkdtemp(folder)) return -1;
    snprintf(cache, sizeof cache, "%s/a/cache", folder);
    write_text("block.geo", "Point(1) = {0, 0, 0};\n");   // keys read it, they do not mesh it
    return setenv("AMONTONS_CACHE", cache, 1);
}

FIXTURE(remove_folder)
{
    char command[FOLDER_SIZE + 16];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

static const char *const BASE[] = {
    "title: Shape",
    "mesh: {file: block.geo, set: {nx: 4, nz: 6, shape: quad}}",
    "groups: {top: top, rod: rod, contact: [contact_1, contact_2]}",
    "material: {young: 2, poisson: 0.3, density: 1.5, eta1: 1.2, eta2: 0.8}",
    "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3}",
    "load: {pressure: 0.01, tractions: [{group: leading, x: 0.002, z: 0}]}",
    "rod: {velocity: 1e-4, height: 0.2, width: 0.04}",
    "time: {until: {t: 0.1}}",
};
enum { LINES = sizeof BASE / sizeof *BASE };

// The key of the base scene with line `line` (from 0) replaced; tolerance of the basis.
static void key_with(int32_t line, const char *replaced, double tolerance, char key[HASH_TEXT_SIZE])
{
    Error err = {0};
    char text[TEXT_SIZE] = "", path[PATH_SIZE];
    static Scene scene;
    for (int32_t k = 0; k < LINES; k++) {
        strcat(text, k == line ? replaced : BASE[k]);
        strcat(text, "\n");
    }
    if (line >= LINES) strcat(text, replaced);
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    if (!scene_of_text(path, text, &scene, &err)) fail_msg("%s", err.message);
    if (!shape_key(&scene, tolerance, key, &err)) fail_msg("%s", err.message);
}

typedef struct Change {
    int32_t line;
    const char *text;
} Change;

TEST(test_what_changes_the_key)
{
    static const Change changes[] = {
        {1, "mesh: {file: block.geo, set: {nx: 5, nz: 6, shape: quad}}"},
        {1, "mesh: {file: block.geo, set: {nx: 6, nz: 4, shape: quad}}"},
        {1, "mesh: {file: block.geo, set: {nx: 4, nz: 6, shape: triangle}}"},
        {1, "mesh: {file: block.geo, set: {nx: 4, nz: 6}}"},
        {1, "mesh: {file: block.geo, set: {nx: 4, ny: 6, shape: quad}}"},
        {1, "mesh: {file: block.geo}"},
        {1, "mesh: {file: other.geo, set: {nx: 4, nz: 6, shape: quad}}"},
        {2, "groups: {top: above, rod: rod, contact: [contact_1, contact_2]}"},
        {2, "groups: {top: top, rod: pusher, contact: [contact_1, contact_2]}"},
        {2, "groups: {top: top, rod: rod, contact: [contact_1]}"},
        {2, "groups: {top: top, rod: rod, contact: [contact_2, contact_1]}"},
        {2, "groups: {top: top, rod: rod}"},
        {3, "material: {young: 2, poisson: 0.31, density: 1.5, eta1: 1.2, eta2: 0.8}"},
        {3, "material: {young: 2, poisson: 0.3, density: 1.5, eta1: 1.2, eta2: 0.81}"},
        {3, "material: {young: 2, poisson: 0.3, density: 1.5, eta1: 0.8, eta2: 1.2}"},
        {3,
         "material: {young: 2, poisson: 0.3, density: 1.5, eta1: 1.2, eta2: 0.8, plane: strain}"},
        {5, "load: {pressure: 0.01, tractions: [{group: leading, x: 0.003, z: 0}]}"},
        {5, "load: {pressure: 0.01, tractions: [{group: leading, x: 0, z: 0.002}]}"},
        {5, "load: {pressure: 0.01, tractions: [{group: top, x: 0.002, z: 0}]}"},
        {5, "load: {pressure: 0.01}"},
        {5, "load: {pressure: 0.02, tractions: [{group: leading, x: 0.002, z: 0}]}"},
        {6, "rod: {velocity: 1e-4, height: 0.21, width: 0.04}"},
        {6, "rod: {velocity: 1e-4, height: 0.2, width: 0.05}"},
        {6, "rod: {velocity: 1e-4, height: 0.2}"},
        {6, "rod: {kind: none}"},
        {LINES, "reduction: {use: always}"},
        {LINES, "materials: {body: {young: 3}}"},
        {LINES, "materials: {pads: {young: 3}}"},
        {LINES, "materials: {body: {density: 3}}"},
        {LINES, "materials: {body: {eta2: 3}}"},
    };
    enum { COUNT = sizeof changes / sizeof *changes };
    write_text("other.geo", "Point(1) = {0, 0, 1};\n");
    char keys[COUNT + 3][HASH_TEXT_SIZE];
    key_with(-1, "", TOLERANCE, keys[0]);
    assert_int_equal(strlen(keys[0]), HASH_TEXT_SIZE - 1);
    key_with(-1, "", TOLERANCE / 2, keys[1]);
    write_text("block.geo", "Point(1) = {0, 0, 0};\r");   // one byte
    key_with(-1, "", TOLERANCE, keys[2]);
    write_text("block.geo", "Point(1) = {0, 0, 0};\n");
    for (int32_t k = 0; k < COUNT; k++)
        key_with(changes[k].line, changes[k].text, TOLERANCE, keys[3 + k]);
    for (int32_t k = 0; k < COUNT + 3; k++)
        for (int32_t j = 0; j < k; j++)
            if (strcmp(keys[j], keys[k]) == 0) fail_msg("%d and %d share a key", j - 3, k - 3);
}

TEST(test_what_does_not)
{
    static const Change changes[] = {
        {0, "title: Another name"},
        {0, "units: si"},
        {1, "mesh: {file: copy.geo, set: {nx: 4, nz: 6, shape: quad}}"},   // content, not name
        {1, "mesh: {file: ./block.geo, set: {nx: 4.0, nz: 6, shape: quad}}"},
        {3, "material: {young: 2.2, poisson: 0.3, density: 1.6, eta1: 1.2, eta2: 0.8}"},
        {3, "material: {young: 2, poisson: 0.3, density: 150, eta1: 1.2, eta2: 0.8}"},
        {3, "material: {young: 8, poisson: 0.3, density: 1.5, eta1: 2.4, eta2: 1.6}"},
        {4, "friction: {mu_static: 0.6, mu_kinetic: 0.1, critical_velocity: 1e-5}"},
        {4, "friction: {law: coulomb, mu_static: 0.6}"},
        {5, "load: {pressure: 0.02, tractions: [{group: leading, x: 0.004, z: 0}]}"},
        {6, "rod: {velocity: 3e-6, height: 0.2, width: 0.04}"},
        {6, "rod: {velocity: 1e-4, height: 0.2, width: 0.04, kind: bonded}"},
        {7, "time: {until: {t: 1}, tolerance: 1e-6, wave_step: 0.05, certificate: false}"},
        {LINES, "start: {friction: off, rod: held, tolerance: 1e-3}"},
        {LINES, "output: {history: true, fields: {every_U: 0.1}, figures: [force]}"},
    };
    char base[HASH_TEXT_SIZE], key[HASH_TEXT_SIZE];
    write_text("copy.geo", "Point(1) = {0, 0, 0};\n");
    key_with(-1, "", TOLERANCE, base);
    for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
        key_with(changes[k].line, changes[k].text, TOLERANCE, key);
        if (strcmp(base, key) != 0) fail_msg("%s changes the key", changes[k].text);
    }
}

TEST(test_no_key)
{
    char key[HASH_TEXT_SIZE];
    const char *const draws[] = {"Include \"parts.geo\";\n",
                                 "Merge 'mesh.msh';\n",
                                 "h = StringToNumber(GetEnv(\"H\"));\n",
                                 "v() = ShapeFromFile(\"x.brep\");\n",
                                 "Field[1].FileName = \"sizes.dat\";\n",
                                 "Point(1) = {0, 0, 0}; // Include\n"};   // better once too often
    for (size_t k = 0; k < sizeof draws / sizeof *draws; k++) {
        write_text("drawing.geo", draws[k]);
        key_with(1, "mesh: {file: drawing.geo}", TOLERANCE, key);
        assert_string_equal(key, "");
    }
    write_text("drawing.geo", "Point(1) = {0, 0, 0};\n");
    key_with(1, "mesh: {file: drawing.geo}", TOLERANCE, key);
    assert_int_equal(strlen(key), HASH_TEXT_SIZE - 1);
    write_text("drawing.geo.opt", "Mesh.MeshSizeFactor = 2;\n");   // gmsh reads it as well
    key_with(1, "mesh: {file: drawing.geo}", TOLERANCE, key);
    assert_string_equal(key, "");
    write_text("mesh.msh", "Include\n");   // a mesh holds no commands
    key_with(1, "mesh: {file: mesh.msh}", TOLERANCE, key);
    assert_int_equal(strlen(key), HASH_TEXT_SIZE - 1);
    key_with(LINES, "reduction: {cache: false}", TOLERANCE, key);
    assert_string_equal(key, "");
    Error err = {0};
    Scene scene = {.reduction.cache = true, .material = {.eta1 = 1}};
    snprintf(scene.mesh.file, sizeof scene.mesh.file, "%s/missing.geo", folder);
    assert_false(shape_key(&scene, TOLERANCE, key, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "missing.geo"));
}

// --- what is stored ------------------------------------------------------------------------------
static double *random_array(Random *random, int64_t count)
{
    Error err = {0};
    double *array = NEW_ARRAY(double, count, &err);
    for (int64_t k = 0; k < count; k++) array[k] = random_between(random, -1, 1);
    return array;
}

static int32_t *index_array(Random *random, int32_t count, uint64_t below)
{
    Error err = {0};
    int32_t *array = NEW_ARRAY(int32_t, count, &err);
    for (int32_t k = 0; k < count; k++) array[k] = (int32_t)(random_bits(random) % below);
    return array;
}

static const char BASIS[] = "ffeeddccbbaa99887766554433221100";

// Three contact nodes on two pads, a rod node, of 49 nodes; numbers at random.
static void make_shape(uint64_t seed, Shape *shape)
{
    enum { M = 7 };
    Random random = {.state = seed};
    *shape = (Shape){
        .sizes = {
            1.5, 0.5, 1, 0.75, 36, 98, 0.01, 1.4, 0.1, 0.75, {{{1, 0}, 0.25}}, 2, {0.5, 0.25}}};
    shape->interface = (Interface){.dim = 2,
                                   .contact_count = 3,
                                   .node = index_array(&random, 3, 49),
                                   .x = random_array(&random, 3),
                                   .weight = random_array(&random, 3),
                                   .gap = random_array(&random, 3),
                                   .pad = index_array(&random, 3, 2),
                                   .pad_count = 2,
                                   .rod_count = 1,
                                   .rod_node = index_array(&random, 1, 49),
                                   .rod_z = random_array(&random, 1),
                                   .rod_share = random_array(&random, 1),
                                   .rod_face = {0.25, 0.75},
                                   .count = M,
                                   .dofs = index_array(&random, M, 98)};
    Error err = {0};
    shape->interface.pad_name = memory_array(2, GROUP_NAME_SIZE, &err);
    snprintf(shape->interface.pad_name[0], GROUP_NAME_SIZE, "left");
    snprintf(shape->interface.pad_name[1], GROUP_NAME_SIZE, "%063d", 7);   // as long as allowed
    snprintf(shape->basis, sizeof shape->basis, "%s", BASIS);
}

static void assert_same_shape(const Shape *a, const Shape *b)
{
    const Interface *i = &a->interface, *j = &b->interface;
    assert_memory_equal(&a->sizes, &b->sizes, sizeof a->sizes);
    assert_string_equal(a->basis, BASIS);
    assert_true(i->contact_count == 3 && i->rod_count == 1 && i->pad_count == 2 && i->count == 7);
    assert_memory_equal(i->node, j->node, 3 * sizeof(int32_t));
    assert_memory_equal(i->pad, j->pad, 3 * sizeof(int32_t));
    assert_memory_equal(i->pad_name, j->pad_name, 2 * GROUP_NAME_SIZE);
    assert_memory_equal(i->rod_node, j->rod_node, sizeof(int32_t));
    assert_memory_equal(i->dofs, j->dofs, 7 * sizeof(int32_t));
    assert_memory_equal(i->x, j->x, 3 * sizeof(double));
    assert_memory_equal(i->weight, j->weight, 3 * sizeof(double));
    assert_memory_equal(i->gap, j->gap, 3 * sizeof(double));
    assert_memory_equal(i->rod_z, j->rod_z, sizeof(double));
    assert_memory_equal(i->rod_share, j->rod_share, sizeof(double));
    assert_memory_equal(i->rod_face, j->rod_face, sizeof i->rod_face);
}

static const char KEY[] = "00112233445566778899aabbccddeeff";

static bool load(const char *key, Shape *shape, char note[CACHE_NOTE_SIZE])
{
    Error err = {0};
    bool found = true;
    note[0] = 0;
    if (!shape_cache_load(key, shape, &found, note, &err)) fail_msg("%s", err.message);
    return found;
}

static void store(const char *key, uint64_t seed, char note[CACHE_NOTE_SIZE])
{
    Shape shape;
    note[0] = 0;
    make_shape(seed, &shape);
    shape_cache_store(key, &shape, note);
    shape_destroy(&shape);
}

// One in space has more of each node, and the line along its middle.
TEST(test_space)
{
    Shape made, read;
    char note[CACHE_NOTE_SIZE];
    static const char SPACE_KEY[] = "10112233445566778899aabbccddeeff";
    Random random = {.state = 77};
    make_shape(7, &made);
    Interface *a = &made.interface;
    memory_free(a->node), memory_free(a->rod_node), memory_free(a->dofs);
    a->dim = 3;
    a->count = 10;
    a->node = index_array(&random, 3, 30), a->rod_node = index_array(&random, 1, 30);
    a->dofs = index_array(&random, 10, 90);
    a->y = random_array(&random, 3);
    a->rod_y = random_array(&random, 1);
    a->rod_length = random_array(&random, 1);
    a->line_count = 2;
    a->line = index_array(&random, 2, 3);
    made.sizes.full_dofs = 90;
    shape_cache_store(SPACE_KEY, &made, note);
    assert_true(load(SPACE_KEY, &read, note));
    const Interface *b = &read.interface;
    assert_memory_equal(&made.sizes, &read.sizes, sizeof made.sizes);
    assert_true(b->dim == 3 && b->count == 10 && b->line_count == 2);
    assert_memory_equal(a->y, b->y, 3 * sizeof(double));
    assert_memory_equal(a->rod_y, b->rod_y, sizeof(double));
    assert_memory_equal(a->rod_length, b->rod_length, sizeof(double));
    assert_memory_equal(a->line, b->line, 2 * sizeof(int32_t));
    assert_memory_equal(a->dofs, b->dofs, 10 * sizeof(int32_t));
    shape_destroy(&made);
    shape_destroy(&read);
}

TEST(test_round_trip)
{
    Shape made, read;
    char note[CACHE_NOTE_SIZE];
    int64_t live = memory_counters().live;
    assert_false(load(KEY, &read, note));   // nothing there: no reason to say anything
    assert_string_equal(note, "");
    store(KEY, 5, note);   // makes the folder, and the one above it
    assert_string_equal(note, "");
    make_shape(5, &made);
    assert_true(load(KEY, &read, note));
    assert_string_equal(note, "");
    assert_same_shape(&read, &made);
    shape_destroy(&read);
    shape_destroy(&made);
    assert_int_equal(memory_counters().live, live);
}

// A spoilt file, or another shape's: not used, and a reason given.
TEST(test_not_trusted)
{
    Shape read;
    char note[CACHE_NOTE_SIZE], path[PATH_SIZE], other[PATH_SIZE];
    static const char OTHER[] = "00112233445566778899aabbccddeef0";
    snprintf(path, sizeof path, "%s/%s.shape", cache, KEY);
    snprintf(other, sizeof other, "%s/%s.shape", cache, OTHER);
    int64_t live = memory_counters().live;
    store(KEY, 5, note);
    assert_int_equal(truncate(path, 500), 0);
    assert_false(load(KEY, &read, note));
    assert_string_equal(note, "a cached shape is not used: it is cut off");
    store(KEY, 5, note);
    assert_int_equal(rename(path, other), 0);
    assert_false(load(OTHER, &read, note));
    assert_string_equal(note, "a cached shape is not used: it belongs to another shape");
    assert_int_equal(memory_counters().live, live);
}

// A sum that holds says nothing about who wrote the file: what would be read beyond an array's end
// is not used.
TEST(test_impossible)
{
    Shape made, read;
    char note[CACHE_NOTE_SIZE];
    make_shape(5, &made);
    Interface *interface = &made.interface;
    int32_t *const places[] = {&interface->node[1], &interface->pad[2], &interface->rod_node[0],
                               &interface->dofs[6]};
    static const int32_t beyond[] = {49, 2, -1, 98};
    int64_t live = memory_counters().live;
    for (int32_t k = 0; k < 5; k++) {
        int32_t kept = k < 4 ? *places[k] : 0;
        if (k < 4) *places[k] = beyond[k];
        shape_cache_store(KEY, &made, note);
        assert_true(load(KEY, &read, note) == (k == 4));
        if (k < 4) *places[k] = kept;
        shape_destroy(&read);
    }
    assert_int_equal(memory_counters().live, live);
    shape_destroy(&made);
}

// No folder, an empty name, no key: no cache, and never an error.
TEST(test_nowhere)
{
    Shape read;
    char note[CACHE_NOTE_SIZE], path[PATH_SIZE];
    store("", 5, note);
    assert_string_equal(note, "");
    assert_false(load("", &read, note));
    setenv("AMONTONS_CACHE", "", 1);
    store(KEY, 5, note);
    assert_string_equal(note, "");
    assert_false(load(KEY, &read, note));
    snprintf(path, sizeof path, "%s/block.geo/cache", folder);   // under a file
    setenv("AMONTONS_CACHE", path, 1);
    store(KEY, 5, note);
    assert_non_null(strstr(note, "the shape is not kept for the next run: cannot write"));
    assert_non_null(strstr(note, "Not a directory"));
    assert_false(load(KEY, &read, note));
    assert_string_equal(note, "");
    // Where it stands without AMONTONS_CACHE.
    unsetenv("AMONTONS_CACHE");
    setenv("XDG_CACHE_HOME", folder, 1);
    store(KEY, 5, note);
    snprintf(path, sizeof path, "%s/amontons/%s.shape", folder, KEY);
    assert_int_equal(access(path, R_OK), 0);
    unsetenv("XDG_CACHE_HOME");
    setenv("HOME", folder, 1);
    store(KEY, 5, note);
    snprintf(path, sizeof path, "%s/.cache/amontons/%s.shape", folder, KEY);
    assert_int_equal(access(path, R_OK), 0);
    setenv("AMONTONS_CACHE", cache, 1);
}

TEST(test_memory_faults)
{
    char note[CACHE_NOTE_SIZE];
    Shape read;
    store(KEY, 5, note);
    int64_t live = memory_counters().live;
    bool done = false, found;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        memory_fail_after(k);
        done = shape_cache_load(KEY, &read, &found, note, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        if (done) assert_true(found);
        shape_destroy(&read);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 30);
    }
    Shape made;
    make_shape(6, &made);
    live = memory_counters().live;
    for (int32_t k = 0; k < 1; k++) {   // a shape that cannot be stored is no failure
        note[0] = 0;
        memory_fail_after(k);
        shape_cache_store(KEY, &made, note);
        memory_fail_after(-1);
        assert_non_null(strstr(note, "the shape is not kept for the next run"));
        assert_int_equal(memory_counters().live, live);
    }
    shape_destroy(&made);
}

GROUP_BETWEEN(make_folder, remove_folder);
