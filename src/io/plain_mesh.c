// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/plain_mesh.h"

#include "io/mesh_source.h"

#include <string.h>

// The files that are known, by mesh_source_hash. One that was edited is meshed by gmsh, and its
// test (io.plain_block, io.plain_pads) fails with the hash: written here, the test compares again.
static const struct PlainScript {
    const char *hash;
    bool (*build)(const MeshParameter *given, int32_t count, PlainModel *model, bool *fits,
                  Error *err);
} SCRIPTS[] = {{"662d0bfffc337430667dbc9046a0caa3", plain_block_build},
               {"4be2a1743a66dd839edee7a8a7425165", plain_pads_build}};

enum { SCRIPT_COUNT = sizeof SCRIPTS / sizeof SCRIPTS[0] };

// *script: NULL for another file.
static bool find_script(const char *path, const struct PlainScript **script, Error *err)
{
    char text[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    bool whole = false;
    *script = NULL;
    TRY(mesh_source_hash(path, NULL, 0, &hash, &whole, err));
    hash_write(&hash, text);
    for (int32_t k = 0; whole && k < SCRIPT_COUNT; k++)
        if (strcmp(text, SCRIPTS[k].hash) == 0) *script = &SCRIPTS[k];
cleanup:
    return error_is_clean(err);
}

bool plain_mesh_make(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                     MeshFile *mesh, bool *made, Error *err)
{
    const struct PlainScript *script = NULL;
    PlainModel model = {0};
    *made = false;
    TRY(find_script(path, &script, err));
    if (!script) goto cleanup;
    TRY(script->build(parameters, parameter_count, &model, made, err));
    if (*made) TRY(plain_model_mesh(&model, mesh, err));
cleanup:
    plain_model_destroy(&model);
    return error_is_clean(err);
}
