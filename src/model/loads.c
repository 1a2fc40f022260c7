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
    if (scene->rod.stiffness_is_total)
        return blame(scene, "rod.stiffness",
                     "in the plane N/m of the whole machine need the block's `thickness`; without "
                     "it, divide by the thickness by hand (N/m over m: Pa)",
                     err);
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        const bool *is_total = scene->load.tractions[k].is_total;
        if (is_total[0] || is_total[1] || is_total[2])
            return blame(scene, "load.tractions",
                         "in the plane a force needs the block's `thickness`; without it, divide "
                         "by the area of the group by hand (N over m2: Pa)",
                         err);
    }
    return true;
}

// Length of a group in the plane, its area in space. key: which of the scene names it.
static bool measure_group(const Scene *scene, const Mesh *mesh, const char *key, const char *group,
                          double *size, Error *err)
{
    MeshBoundary boundary;
    double *weight = NEW_ARRAY(double, mesh->node_count, err);
    *size = 0;
    TRY(weight);
    TRY(scene_blame(scene, key, mesh_boundary(mesh, group, &boundary, err), err));
    boundary_add_weights(mesh, &boundary, false, weight);
    for (int32_t i = 0; i < boundary.node_count; i++) *size += weight[boundary.nodes[i]];
cleanup:
    memory_free(weight);
    return error_is_clean(err);
}

bool scene_pressure(const Scene *scene, const Mesh *mesh, double *pressure, Error *err)
{
    double size = 0;
    *pressure = scene->load.pressure;
    if (!(scene->load.force > 0)) return true;
    if (!measure_group(scene, mesh, "groups.top", scene->groups.top, &size, err)) return false;
    *pressure = scene->load.force / scene_whole_force(scene, mesh->dim) / size;
    return true;
}

bool scene_traction(const Scene *scene, const Mesh *mesh, int32_t k, MeshPlace traction, Error *err)
{
    const SceneTraction *given = &scene->load.tractions[k];
    const double values[] = {given->x, given->y, given->z};
    for (int32_t axis = 0; axis < mesh->dim; axis++) {
        int32_t i = axis == mesh->dim - 1 ? 2 : axis;
        double size = 1;
        if (given->is_total[i] &&
            !measure_group(scene, mesh, "load.tractions", given->group, &size, err))
            return false;
        if (given->is_total[i]) size *= scene_whole_force(scene, mesh->dim);
        traction[axis] = values[i] / size;
    }
    return true;
}

double scene_machine_stiffness(const Scene *scene, const Mesh *mesh, double breadth)
{
    double stiffness = scene->rod.stiffness;
    return scene->rod.stiffness_is_total ? stiffness / scene_whole_force(scene, mesh->dim)
                                         : stiffness * breadth;
}

double scene_whole_force(const Scene *scene, int32_t dim)
{
    if (dim > 2) return 1;
    return scene->thickness > 0 ? scene->thickness : (double)NAN;
}
