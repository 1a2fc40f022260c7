// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/scene_mesh.h"

#include "base/system.h"
#include "io/mesh/mesh_pick.h"

#include <string.h>

// Bytes that a node takes at least, with one factorised matrix; a run needs several times as much.
static const double NODE_BYTES = 4e3;

static double metres(SceneLength unit)
{
    static const double each[] = {
#define X(symbol, name, metres) metres,
        SCENE_LENGTHS(X)
#undef X
    };
    return each[unit];
}

bool scene_mesh_read(const Scene *scene, const ChildWatch *watch, Mesh *mesh, MeshOrigin *origin,
                     Error *err)
{
    MeshFile file = {0};
    const SceneNames *body = &scene->groups.body, *contact = &scene->groups.contact;
    const SceneNumbers *shift = &scene->mesh.shift;
    const char *path = scene->mesh.file;
    *mesh = (Mesh){0};
    bool done = mesh_file_read(path, scene->mesh.parameters, scene->mesh.parameter_count,
                               scene->trusted, watch, &file, err);
    if (origin) *origin = file.origin;

    // Said before the memory is full: then the system would end this or another program.
    double needed = file.node_count * NODE_BYTES, have = system_memory();
    if (done && needed > have)
        done = REFUSE(
            err,
            "%s: %d nodes are too many for this computer: to factorise one matrix takes %.1f GB, "
            "and there are %.1f; coarser cells, or cells graded towards the contact, are needed",
            path, file.node_count, needed / 1e9, have / 1e9);
    TRY(scene_blame(scene, "mesh.file", done, err));
    if (body->count > 0) {
        done = mesh_file_pick(path, body->name, body->count, &file, err);
        TRY(scene_blame(scene, "groups.body", done, err));
    }

    // Where the floor has the name of one of the block's own boundaries no part is a base.
    const char *floor = scene->groups.floor;
    bool taken = strcmp(floor, scene->groups.top) == 0 || strcmp(floor, scene->groups.rod) == 0;
    for (int32_t k = 0; k < contact->count; k++)
        taken = taken || strcmp(floor, contact->name[k]) == 0;
    TRY(mesh_build_on_base(&file, path, taken ? NULL : floor, mesh, err));

    // The order is that in which places are made of those of the file.
    MeshPlace by = {0};
    if (shift->count > 0 && shift->count != mesh->dim) {
        error_set(err, ERROR_INPUT, __FILE__, __LINE__,
                  "%d numbers; the mesh is in %s: it takes %s", shift->count,
                  mesh->dim == 2 ? "the plane" : "space", mesh->dim == 2 ? "[x, z]" : "[x, y, z]");
        TRY(scene_blame(scene, "mesh.shift", false, err));
    }
    for (int32_t d = 0; d < shift->count; d++) by[d] = shift->value[d];
    mesh_move(metres(scene->mesh.unit) * scene->mesh.scale, by, mesh);
    if (shift->count == 0) {
        done = mesh_stand_on_floor(contact->name, contact->count, mesh, err);
        TRY(scene_blame(scene, "groups.contact", done, err));
    }
cleanup:
    mesh_file_destroy(&file);
    return error_is_clean(err);
}
