// SPDX-License-Identifier: GPL-2.0-or-later
// A region's numbers are set by the keys of `material`, pointed at their place in the region:
// units, ranges and messages are those of these keys.
#include "scene/materials.h"

#include <stdio.h>
#include <string.h>

static const char *const words[SCENE_MATERIAL_NUMBERS] = {"young", "poisson", "density", "eta1",
                                                          "eta2"};
static const char MAP[] = "materials";

enum { PATH_SIZE = GROUP_NAME_SIZE + 32 };

const char *scene_material_word(int32_t k)
{
    return words[k];
}

static int32_t word_index(const char *word)
{
    for (int32_t k = 0; k < SCENE_MATERIAL_NUMBERS; k++)
        if (strcmp(words[k], word) == 0) return k;
    return -1;
}

const char *scene_region_name(const Scene *scene, int32_t k)
{
    return k == 0 ? "material" : scene->materials.region[k - 1].group;
}

static const SceneKey *material_key(int32_t k)
{
    char name[40];
    int32_t count = 0;
    snprintf(name, sizeof name, "material.%s", words[k]);
    return &scene_keys(&count)[scene_key_index(name)];
}

double scene_material_number(const Scene *scene, const SceneMaterial *region, int32_t k)
{
    if (region->given[k]) return region->number[k];
    return *(const double *)((const char *)scene + material_key(k)->offset);
}

// NULL: there is none of the name, which has `length` bytes.
static const SceneMaterial *find_region(const SceneMaterials *materials, const char *name,
                                        size_t length)
{
    for (int32_t i = 0; i < materials->count; i++) {
        const SceneMaterial *region = &materials->region[i];
        if (strlen(region->group) == length && memcmp(region->group, name, length) == 0)
            return region;
    }
    return NULL;
}

bool scene_materials_find(const Scene *scene, const char *path, double *number)
{
    size_t map = strlen(MAP);
    const char *dot = strrchr(path, '.');
    if (strncmp(path, MAP, map) != 0 || path[map] != '.' || dot <= path + map) return false;
    const char *name = path + map + 1;
    const SceneMaterial *region = find_region(&scene->materials, name, (size_t)(dot - name));
    int32_t k = word_index(dot + 1);
    if (!region || k < 0 || !region->given[k]) return false;
    *number = region->number[k];
    return true;
}

// One number of a region, by its word.
static bool set_number(const char *word, const SceneValue *value, SceneMaterial *region,
                       Scene *scene, Error *err)
{
    char path[PATH_SIZE];
    int32_t k = word_index(word);
    snprintf(path, sizeof path, "%s.%s.%.20s", MAP, region->group, word);
    if (k < 0) {
        bool plane = strcmp(word, "plane") == 0;
        return yaml_key_error(
            value->document, value->node, err, "%s: %s; allowed: %s", path,
            plane ? "the whole block is in plane stress or strain (material.plane)" : "unknown key",
            "young, poisson, density, eta1, eta2");
    }
    SceneKey key = *material_key(k);
    key.name = path;
    key.offset = (size_t)((char *)&region->number[k] - (char *)scene);
    region->given[k] = true;
    return scene_value_set(&key, value, scene, err);
}

// The region of the name, as it is or a new one.
static SceneMaterial *take_region(const SceneValue *value, const char *name, size_t length,
                                  Scene *scene, Error *err)
{
    SceneMaterials *materials = &scene->materials;
    SceneMaterial *region = NULL;
    bool fits = length > 0 && length < GROUP_NAME_SIZE;
    const SceneMaterial *found = fits ? find_region(materials, name, length) : NULL;
    if (found) return &materials->region[found - materials->region];
    if (!fits || materials->count == SCENE_MATERIALS_MAX) {
        yaml_key_error(value->document, value->node, err,
                       "%s: at most %d regions, with names of 1 to 63 bytes", MAP,
                       SCENE_MATERIALS_MAX);
        return NULL;
    }
    region = &materials->region[materials->count++];
    *region = (SceneMaterial){0};
    memcpy(region->group, name, length);
    return region;
}

// {young: 0.01, eta1: 1}; an empty map is a region of `material`.
static bool set_region(const char *name, const SceneValue *value, Scene *scene, Error *err)
{
    const YamlDocument *document = value->document;
    YamlKind kind = yaml_kind(document, value->node);
    SceneMaterial *region = take_region(value, name, strlen(name), scene, err);
    if (!region) return false;
    memset(region->given, 0, sizeof region->given);
    if (kind != YAML_MAP && kind != YAML_NOTHING) {
        char path[PATH_SIZE], allowed[160];
        int32_t word = word_index(name);
        snprintf(path, sizeof path, "%s.%s", MAP, region->group);
        snprintf(allowed, sizeof allowed,
                 "a map for a region of that name, {young: 0.01, eta1: 0.1}%s%s%s",
                 word < 0 ? "" : " (that of the whole block is `material.", word < 0 ? "" : name,
                 word < 0 ? "" : "`)");
        return yaml_refuse(document, value->node, path, allowed, err);
    }
    YAML_EACH (part, document, value->node) {
        SceneValue one = {.document = document, .node = part};
        if (!set_number(yaml_key(document, part), &one, region, scene, err)) return false;
    }
    return true;
}

bool scene_materials_set(const SceneValue *value, Scene *scene, Error *err)
{
    const YamlDocument *document = value->document;
    SceneValue one = {.document = document, .node = value->node};
    YamlKind kind = yaml_kind(document, value->node);
    if (value->part && kind == YAML_MAP) return set_region(value->part, &one, scene, err);
    if (value->part) {
        const char *dot = strrchr(value->part, '.');
        size_t length = dot ? (size_t)(dot - value->part) : 0;
        SceneMaterial *region = take_region(&one, value->part, length, scene, err);
        return region && set_number(dot + 1, &one, region, scene, err);
    }
    scene->materials.count = 0;
    if (kind != YAML_MAP && kind != YAML_NOTHING)
        return yaml_refuse(document, value->node, MAP,
                           "a map, as in {pads: {young: 0.01, eta1: 0.1}}", err);
    YAML_EACH (item, document, value->node) {
        one.node = item;
        if (!set_region(yaml_key(document, item), &one, scene, err)) return false;
    }
    return true;
}
