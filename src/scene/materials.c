// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/materials.h"

#include <stdlib.h>
#include <string.h>

const char *scene_region_name(const Scene *scene, int32_t k)
{
    return k == 0 ? "material" : scene->materials.region[k - 1].group;
}

double scene_material_number(const Scene *scene, const SceneMaterial *region, int32_t k)
{
    const double whole[SCENE_MATERIAL_NUMBERS] = {scene->material.young, scene->material.poisson,
                                                  scene->material.density, scene->material.eta1,
                                                  scene->material.eta2};
    return region->given[k] ? region->number[k] : whole[k];
}

const SceneRelaxation *scene_material_relaxation(const Scene *scene, const SceneMaterial *region)
{
    return region && region->has_relaxation ? &region->relaxation : &scene->material.relaxation;
}

bool scene_branches_find(const Scene *scene, const char *path, double *number)
{
    static const char whole[] = "material.relaxation.", below[] = ".relaxation.";
    const SceneRelaxation *relaxation = &scene->material.relaxation;
    const char *rest = path + sizeof whole - 1;
    char *word;
    if (strncmp(path, whole, sizeof whole - 1) != 0) {
        const char *found = strstr(path, below), *name = path + sizeof "materials." - 1;
        if (!found || strncmp(path, "materials.", sizeof "materials." - 1) != 0) return false;
        relaxation = NULL;
        for (int32_t i = 0; i < scene->materials.count; i++) {
            const SceneMaterial *region = &scene->materials.region[i];
            size_t length = strlen(region->group);
            if (region->has_relaxation && name + length == found &&
                memcmp(region->group, name, length) == 0)
                relaxation = &region->relaxation;
        }
        rest = found + sizeof below - 1;
    }
    long k = relaxation ? strtol(rest, &word, 10) : -1;
    if (k < 0 || word == rest || k >= relaxation->count) return false;
    const SceneBranch *branch = &relaxation->branch[k];
    const double *named = strcmp(word, ".time") == 0    ? &branch->time
                          : strcmp(word, ".shear") == 0 ? &branch->shear
                          : strcmp(word, ".bulk") == 0  ? &branch->bulk
                                                        : NULL;
    if (named) *number = *named;
    return named != NULL;
}

bool scene_materials_find(const Scene *scene, const char *path, double *number)
{
    static const char map[] = "materials.";
    const char *name = path + sizeof map - 1;
    if (strncmp(path, map, sizeof map - 1) != 0) return false;
    for (int32_t i = 0; i < scene->materials.count; i++) {
        const SceneMaterial *region = &scene->materials.region[i];
        size_t length = strlen(region->group);
        if (strncmp(name, region->group, length) != 0 || name[length] != '.') continue;
        for (int32_t k = 0; k < SCENE_MATERIAL_NUMBERS; k++) {
            if (strcmp(scene_material_items.parts[k].word, name + length + 1) != 0) continue;
            if (region->given[k]) *number = region->number[k];
            return region->given[k];
        }
    }
    return false;
}
