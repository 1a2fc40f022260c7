// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/probe_places.h"

#include "fem/mesh_locate.h"

#include <stdio.h>

bool probe_places_find(const Scene *scene, const Mesh *mesh, ProbePlace *places, Error *err)
{
    const SceneProbes *probes = &scene->output.probes;
    for (int32_t k = 0; k < probes->count; k++) {
        const SceneProbe *probe = &probes->probe[k];
        char asked[PLACE_TEXT_SIZE], nearest[PLACE_TEXT_SIZE];
        char low[PLACE_TEXT_SIZE], high[PLACE_TEXT_SIZE];
        double distance = 0;
        if (probe->at.count != mesh->dim) {
            error_set(err, ERROR_INPUT, __FILE__, __LINE__,
                      "`%s` has `at` with %d number%s; allowed: %s, as the mesh is in %s",
                      probe->name, probe->at.count, probe->at.count == 1 ? "" : "s",
                      mesh->dim == 2 ? "[x, z]" : "[x, y, z]",
                      mesh->dim == 2 ? "the plane" : "space");
            return scene_blame(scene, "output.probes", false, err);
        }
        places[k].element = mesh_locate(mesh, probe->at.value, places[k].at);
        if (places[k].element >= 0) continue;

        // Outside: where it would be inside.
        int32_t node = mesh_nearest_node(mesh, probe->at.value, &distance);
        MeshPlace from = {mesh->x_min, mesh->dim == 2 ? mesh->z_min : mesh->y_min, mesh->z_min};
        MeshPlace to = {mesh->x_max, mesh->dim == 2 ? mesh->z_max : mesh->y_max, mesh->z_max};
        error_set(
            err, ERROR_INPUT, __FILE__, __LINE__,
            "`%s` is at %s, outside of the block%s: %s at %s, %g away; the block reaches from "
            "%s to %s",
            probe->name, place_text(mesh->dim, probe->at.value, asked),
            mesh->is_base ? " and its base" : "",
            !mesh->is_base             ? "its nearest node is"
            : mesh_in_base(mesh, node) ? "the nearest node is one of the base,"
                                       : "the nearest node is one of the block,",
            mesh_place_text(mesh, node, nearest), distance, place_text(mesh->dim, from, low),
            place_text(mesh->dim, to, high));
        return scene_blame(scene, "output.probes", false, err);
    }
    return true;
}
