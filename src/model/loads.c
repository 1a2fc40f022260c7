// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/loads.h"

#include "base/memory.h"
#include "fem/assembly.h"

#include <math.h>

static bool blame(const Scene *scene, const char *key, const char *words, Error *err)
{
    error_set(err, ERROR_INPUT, __FILE__, __LINE__, "%s", words);
    return scene_blame(scene, key, false, err);
}

bool scene_check_thickness(const Scene *scene, const Mesh *mesh, Error *err)
{
    if (mesh->dim > 2 && scene->thickness > 0)
        return blame(scene, "thickness",
                     "the mesh is in space, where it has its breadth: leave it out", err);
    if (mesh->dim > 2 || scene->thickness > 0) return true;
    if (scene->load.force > 0)
        return blame(scene, "load.force",
                     "in the plane a force needs the block's `thickness`; without it, give "
                     "load.pressure",
                     err);
    if (scene->rod.stiffness_is_whole)
        return blame(scene, "rod.stiffness",
                     "in the plane N/m of the whole machine need the block's `thickness`; without "
                     "it, divide by the thickness by hand (N/m over m: Pa)",
                     err);
    return true;
}

// Length of the top in the plane, its area in space.
static bool measure_top(const Scene *scene, const Mesh *mesh, double *size, Error *err)
{
    MeshBoundary top;
    double *weight = NEW_ARRAY(double, mesh->node_count, err);
    *size = 0;
    TRY(weight);
    TRY(scene_blame(scene, "groups.top", mesh_boundary(mesh, scene->groups.top, &top, err), err));
    boundary_add_weights(mesh, &top, false, weight);
    for (int32_t i = 0; i < top.node_count; i++) *size += weight[top.nodes[i]];
cleanup:
    memory_free(weight);
    return error_is_clean(err);
}

bool scene_pressure(const Scene *scene, const Mesh *mesh, double *pressure, Error *err)
{
    double size = 0;
    *pressure = scene->load.pressure;
    if (!(scene->load.force > 0)) return true;
    if (!measure_top(scene, mesh, &size, err)) return false;
    *pressure = scene->load.force / scene_whole_force(scene, mesh->dim) / size;
    return true;
}

double scene_machine_stiffness(const Scene *scene, const Mesh *mesh, double breadth)
{
    double stiffness = scene->rod.stiffness;
    return scene->rod.stiffness_is_whole ? stiffness / scene_whole_force(scene, mesh->dim)
                                         : stiffness * breadth;
}

double scene_whole_force(const Scene *scene, int32_t dim)
{
    if (dim > 2) return 1;
    return scene->thickness > 0 ? scene->thickness : (double)NAN;
}
