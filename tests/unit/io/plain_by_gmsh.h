// SPDX-License-Identifier: GPL-2.0-or-later
// One of meshes/*.geo, and a copy with a comment more, which io/plain_mesh leaves to gmsh: meshes
// of both with the same parameters, to be compared.
#ifndef AMONTONS_TESTS_PLAIN_BY_GMSH_H
#define AMONTONS_TESTS_PLAIN_BY_GMSH_H

#include "io/plain_mesh.h"

#include "base/memory.h"
#include "io/mesh_source.h"
#include "result_place.h"
#include "same_mesh.h"

enum { PLAIN_PATH_SIZE = 2 * PLACE_SIZE };

static char plain_folder[PLACE_SIZE], ours[PLAIN_PATH_SIZE], gmshs[PLAIN_PATH_SIZE];

#define NUMBER(of, is)                                                                             \
    {                                                                                              \
        .name = of, .value = is                                                                    \
    }
#define TEXT(of, is)                                                                               \
    {                                                                                              \
        .name = of, .text = is                                                                     \
    }

// Writes a copy of `ours`, `ending` behind it.
static inline void plain_copy(const char *to, const char *ending)
{
    FILE *from = fopen(ours, "rb"), *copy = fopen(to, "wb");
    assert_true(from && copy);
    for (int letter; (letter = fgetc(from)) != EOF;) fputc(letter, copy);
    fputs(ending, copy);
    assert_int_equal(fclose(copy), 0);
    fclose(from);
}

// name: "block.geo".
static inline int plain_begin(const char *name)
{
    place_make(plain_folder);
    snprintf(ours, sizeof ours, "%s/meshes/%s", getenv("AMONTONS_SOURCE"), name);
    snprintf(gmshs, sizeof gmshs, "%s/%s", plain_folder, name);
    plain_copy(gmshs, "// by gmsh\n");
    return setenv("AMONTONS_CACHE", "", 1);
}

static inline int plain_end(void **state)
{
    (void)state;
    place_remove(plain_folder);
    return 0;
}

static inline bool plain_make(const char *path, const MeshParameter *parameters, int32_t count,
                              MeshFile *mesh)
{
    Error err = {0};
    bool made = true;
    *mesh = (MeshFile){0};
    if (!plain_mesh_make(path, parameters, count, mesh, &made, &err)) fail_msg("%s", err.message);
    return made;
}

// true: made without gmsh, as gmsh makes it; false: gmsh refuses it, so it was left to gmsh. (gmsh
// 4.8 counts the Ifs that an Abort leaves: a process can be refused a hundred times.)
static inline bool plain_is_gmshs(const MeshParameter *parameters, int32_t count)
{
    Error err = {0};
    MeshFile mesh, by_gmsh;
    bool made = plain_make(ours, parameters, count, &mesh);
    bool possible = mesh_file_read(gmshs, parameters, count, &by_gmsh, &err);
    if (made != possible) {
        for (int32_t k = 0; k < count; k++)
            print_message("%s = %.17g %s\n", parameters[k].name, parameters[k].value,
                          parameters[k].text);
        fail_msg("%s, gmsh: %s", made ? "made" : "not made", err.message);
    }
    if (made) assert_same_mesh(&mesh, &by_gmsh);
    mesh_file_destroy(&mesh);
    mesh_file_destroy(&by_gmsh);
    return made;
}

// The file's bytes are those that are known.
static inline void plain_test_known(void)
{
    char text[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    Error err = {0};
    MeshFile mesh;
    bool whole = false;
    assert_true(mesh_source_hash(ours, NULL, 0, &hash, &whole, &err));
    hash_write(&hash, text);
    if (!plain_make(ours, NULL, 0, &mesh))
        fail_msg("%s was edited: its hash in io/plain_mesh.c becomes %s once the others agree",
                 ours, text);
    mesh_file_destroy(&mesh);
}

// Elements of a whole read, while there is no gmsh.
static inline int32_t plain_read_alone(const MeshParameter *parameters, int32_t count)
{
    char place[PLAIN_PATH_SIZE];
    Error err = {0};
    MeshFile mesh;
    const char *modules = getenv("AMONTONS_MODULES");
    snprintf(place, sizeof place, "%s", modules ? modules : "");
    setenv("AMONTONS_MODULES", plain_folder, 1);
    bool done = mesh_file_read(ours, parameters, count, &mesh, &err);
    modules ? setenv("AMONTONS_MODULES", place, 1) : unsetenv("AMONTONS_MODULES");
    if (!done) fail_msg("%s", err.message);
    int32_t elements = mesh.element_count;
    mesh_file_destroy(&mesh);
    return elements;
}

// Every allocation that may fail does so once, and frees what there is.
static inline void plain_test_without_memory(const MeshParameter *parameters, int32_t count)
{
    int64_t live = memory_counters().live;
    bool made = false, done = false;
    for (int32_t k = 0; !done; k++) {
        MeshFile mesh = {0};
        Error err = {0};
        memory_fail_after(k);
        done = plain_mesh_make(ours, parameters, count, &mesh, &made, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        mesh_file_destroy(&mesh);
        assert_int_equal(memory_counters().live, live);
    }
    assert_true(made);
}

#endif
