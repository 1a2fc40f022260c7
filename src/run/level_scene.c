// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/level_scene.h"

#include <string.h>

bool scene_refine(Scene *scene, double refine, Error *err)
{
    int32_t k = 0, count = scene->mesh.parameter_count;
    while (k < count && strcmp(scene->mesh.parameters[k].name, "refine") != 0) k++;
    if (refine == 1) return true;
    if (k < count) {
        scene->mesh.parameters[k].value *= refine;
        return true;
    }
    if (k == SCENE_LIST_MAX)
        return REFUSE(err, "%s: mesh.set: no room for `refine` beside %d parameters", scene->path,
                      k);
    scene->mesh.parameters[k] = (MeshParameter){.name = "refine", .value = refine};
    scene->mesh.parameter_count++;
    return true;
}

void scene_scale_loads(Scene *scene, double factor)
{
    scene->load.pressure *= factor;
    scene->load.force *= factor;
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        scene->load.tractions[k].x *= factor;
        scene->load.tractions[k].y *= factor;
        scene->load.tractions[k].z *= factor;
    }
}
