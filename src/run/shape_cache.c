// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/shape_cache.h"

#include "base/memory.h"
#include "io/cache_file.h"
#include "io/text_file.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MESH_BYTES_MAX = 1 << 28, PATH_SIZE = PATH_MAX + 64, COUNTS = 8 };

// Stands in every key: a new meaning of the arrays below needs a new number.
static const char FORMAT[] = "shape 4 " AMONTONS_VERSION;

void shape_destroy(Shape *shape)
{
    interface_destroy(&shape->interface);
    reduction_destroy(&shape->reduced);
    memory_free(shape->rotation);
    *shape = (Shape){0};
}

double load_reference(const Scene *scene)
{
    double largest = fabs(scene->load.pressure);
    if (largest > 0) return largest;
    for (int32_t k = 0; k < scene->load.traction_count; k++)
        largest =
            fmax(largest, fmax(fabs(scene->load.tractions[k].x), fabs(scene->load.tractions[k].z)));
    return largest > 0 ? largest : 1;
}

// The mesh file's bytes; *whole is false when it draws on others.
static bool hash_mesh(const Scene *scene, Hash *hash, bool *whole, Error *err)
{
    char *bytes = NULL;
    int32_t size = 0;
    TRY(text_file_read(scene->mesh.file, MESH_BYTES_MAX, &bytes, &size, err));
    size_t length = strlen(scene->mesh.file);
    bool is_geo = length > 4 && strcmp(scene->mesh.file + length - 4, ".geo") == 0;
    *whole = !is_geo || (!strstr(bytes, "Include") && !strstr(bytes, "Merge"));
    hash_text(hash, is_geo ? "geo" : "msh");
    hash_bytes(hash, bytes, (size_t)size);
    for (int32_t k = 0; k < scene->mesh.parameter_count; k++) {
        hash_text(hash, scene->mesh.parameters[k].name);
        hash_text(hash, scene->mesh.parameters[k].text);
        hash_number(hash, scene->mesh.parameters[k].value);
    }
cleanup:
    memory_free(bytes);
    return error_is_clean(err);
}

static void hash_boundary(const Scene *scene, Hash *hash)
{
    double reference = load_reference(scene);
    hash_text(hash, scene->groups.top);
    for (int32_t k = 0; k < scene->groups.contact.count; k++)
        hash_text(hash, scene->groups.contact.name[k]);
    hash_text(hash, scene->rod.kind == ROD_NONE ? "no rod" : scene->groups.rod);
    hash_number(hash, scene->rod.height);
    hash_number(hash, scene->rod.width);
    hash_number(hash, scene->rod.ends);
    hash_number(hash, scene->load.pressure / reference);
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        hash_text(hash, scene->load.tractions[k].group);
        hash_number(hash, scene->load.tractions[k].x / reference);
        hash_number(hash, scene->load.tractions[k].z / reference);
    }
}

bool shape_key(const Scene *scene, double tolerance, char key[HASH_TEXT_SIZE], Error *err)
{
    key[0] = 0;
    if (!scene->reduction.cache) return true;
    Hash hash = hash_start();
    bool whole = false;
    double eta = scene->material.eta1 + scene->material.eta2;
    hash_text(&hash, FORMAT);
    TRY(hash_mesh(scene, &hash, &whole, err));
    hash_boundary(scene, &hash);
    hash_number(&hash, scene->material.poisson);
    hash_number(&hash, scene->material.plane);
    hash_number(&hash, scene->material.eta2 / eta);
    // Without the length, which is the mesh's: rho E / eta^2 tells the rest.
    hash_number(&hash,
                round(2 * log10(scene->material.density * scene->material.young / (eta * eta))));
    hash_number(&hash, tolerance);
    if (whole) hash_write(&hash, key);
cleanup:
    return error_is_clean(err);
}

// CACHE/<key>.<ending>; false: there is no cache. The folder is made.
static bool cache_path(const char *key, const char *ending, char path[PATH_SIZE])
{
    char folder[PATH_MAX];
    const char *given = getenv("AMONTONS_CACHE"), *base = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    int length = -1;
    if (given)
        length = snprintf(folder, sizeof folder, "%s", given);
    else if (base && base[0])
        length = snprintf(folder, sizeof folder, "%s/amontons", base);
    else if (home && home[0])
        length = snprintf(folder, sizeof folder, "%s/.cache/amontons", home);
    if (length <= 0 || length >= (int)sizeof folder) return false;
    for (char *slash = folder + 1; *slash; slash++) {
        if (*slash != '/') continue;
        *slash = 0;
        mkdir(folder, 0777);   // a failure shows when the file is opened
        *slash = '/';
    }
    mkdir(folder, 0777);
    snprintf(path, PATH_SIZE, "%s/%s.%s", folder, key, ending);
    return true;
}

// Indices travel as doubles: exact up to 2^53.
static bool read_indices(const CacheFile *file, const char *name, int32_t count, int32_t **out,
                         Error *err)
{
    const double *values = cache_file_array(file, name, count);
    if (!values) return false;
    *out = NEW_ARRAY(int32_t, count, err);
    for (int32_t k = 0; *out && k < count; k++) (*out)[k] = (int32_t)values[k];
    return *out != NULL;
}

static bool read_numbers(const CacheFile *file, const char *name, int64_t count, double **out,
                         Error *err)
{
    const double *values = cache_file_array(file, name, count);
    if (!values) return false;
    *out = NEW_ARRAY(double, count, err);
    if (*out) memcpy(*out, values, (size_t)count * sizeof(double));
    return *out != NULL;
}

// Names travel as the bytes of doubles, filled up with zeros.
enum { NAME_NUMBERS = GROUP_NAME_SIZE / sizeof(double) };

static bool read_names(const CacheFile *file, Interface *interface, Error *err)
{
    int64_t count = interface->pad_count;
    const double *values = cache_file_array(file, "pad_name", count * NAME_NUMBERS);
    if (!values) return false;
    interface->pad_name = memory_array(count, GROUP_NAME_SIZE, err);
    if (!interface->pad_name) return false;
    memcpy(interface->pad_name, values, (size_t)count * GROUP_NAME_SIZE);
    for (int64_t k = 0; k < count; k++) interface->pad_name[k][GROUP_NAME_SIZE - 1] = 0;
    return true;
}

// false without an error: an array is missing or of another length.
static bool read_shape(const CacheFile *file, Shape *shape, Error *err)
{
    const double *counts = cache_file_array(file, "counts", COUNTS);
    const double *sizes = cache_file_array(file, "sizes", sizeof(ShapeSizes) / sizeof(double));
    if (!counts || !sizes) return false;
    memcpy(&shape->sizes, sizes, sizeof shape->sizes);
    Interface *interface = &shape->interface;
    ReducedBulk *reduced = &shape->reduced;
    interface->contact_count = (int32_t)counts[0];
    interface->rod_count = (int32_t)counts[1];
    interface->pad_count = (int32_t)counts[2];
    interface->count = 2 * interface->contact_count + interface->rod_count;
    reduced->full_dofs = (int32_t)counts[3];
    reduced->interface_count = interface->count;
    reduced->interior_count = (int32_t)counts[4];
    reduced->count = interface->count + reduced->interior_count;
    reduced->dropped = counts[5];
    reduced->error = counts[6];
    int64_t all = reduced->count, m = interface->count;
    return read_indices(file, "node", interface->contact_count, &interface->node, err) &&
           read_numbers(file, "x", interface->contact_count, &interface->x, err) &&
           read_numbers(file, "weight", interface->contact_count, &interface->weight, err) &&
           read_indices(file, "pad", interface->contact_count, &interface->pad, err) &&
           read_names(file, interface, err) &&
           read_indices(file, "rod_node", interface->rod_count, &interface->rod_node, err) &&
           read_numbers(file, "rod_z", interface->rod_count, &interface->rod_z, err) &&
           read_numbers(file, "rod_share", interface->rod_count, &interface->rod_share, err) &&
           read_indices(file, "dofs", interface->count, &interface->dofs, err) &&
           read_numbers(file, "rotation", m, &shape->rotation, err) &&
           read_numbers(file, "mass", all * all, &reduced->mass, err) &&
           read_numbers(file, "damping", all * all, &reduced->damping, err) &&
           read_numbers(file, "stiffness", m * m, &reduced->stiffness, err) &&
           read_numbers(file, "load", all, &reduced->load, err);
}

bool shape_cache_load(const char *key, bool with_modes, Shape *shape, bool *found,
                      char note[SHAPE_NOTE_SIZE], Error *err)
{
    char path[PATH_SIZE], reason[CACHE_REASON_SIZE] = "";
    CacheFile file = {0}, modes = {0};
    *shape = (Shape){0};
    *found = false;
    note[0] = 0;
    if (!key[0] || !cache_path(key, "shape", path)) goto cleanup;
    TRY(cache_file_read(path, key, &file, found, reason, err));
    if (*found && !read_shape(&file, shape, err)) {
        *found = false;
        snprintf(reason, sizeof reason, "an array is missing");
    }
    if (*found && with_modes) {
        ReducedBulk *reduced = &shape->reduced;
        cache_path(key, "modes", path);
        TRY(cache_file_read(path, key, &modes, found, reason, err));
        *found = *found &&
                 read_numbers(&modes, "modes", (int64_t)reduced->full_dofs * reduced->count,
                              &reduced->modes, err);
    }
    if (reason[0]) snprintf(note, SHAPE_NOTE_SIZE, "a cached basis is not used: %s", reason);
cleanup:
    cache_file_destroy(&file);
    cache_file_destroy(&modes);
    if (!*found) shape_destroy(shape);
    return error_is_clean(err);
}

typedef struct Listing {
    CacheArray arrays[CACHE_ARRAYS_MAX];
    double *owned[CACHE_ARRAYS_MAX];   // copies of indices
    int32_t count;
} Listing;

static void list_numbers(Listing *listing, const char *name, const double *values, int64_t count)
{
    CacheArray *array = &listing->arrays[listing->count++];
    *array = (CacheArray){.count = count, .values = values};
    snprintf(array->name, sizeof array->name, "%s", name);
}

static bool list_indices(Listing *listing, const char *name, const int32_t *values, int32_t count,
                         Error *err)
{
    double *copy = NEW_ARRAY(double, count, err);
    if (!copy) return false;
    for (int32_t k = 0; k < count; k++) copy[k] = values[k];
    listing->owned[listing->count] = copy;
    list_numbers(listing, name, copy, count);
    return true;
}

static bool list_names(Listing *listing, const Interface *interface, Error *err)
{
    int64_t count = (int64_t)interface->pad_count * NAME_NUMBERS;
    double *copy = NEW_ARRAY(double, count, err);
    if (!copy) return false;
    if (interface->pad_name) memcpy(copy, interface->pad_name, (size_t)count * sizeof(double));
    listing->owned[listing->count] = copy;
    list_numbers(listing, "pad_name", copy, count);
    return true;
}

static bool store_shape(const char *key, const Shape *shape, Error *err)
{
    char path[PATH_SIZE];
    Listing listing = {0};
    const Interface *interface = &shape->interface;
    const ReducedBulk *reduced = &shape->reduced;
    int64_t all = reduced->count, m = interface->count;
    double counts[COUNTS] = {
        interface->contact_count, interface->rod_count, interface->pad_count, reduced->full_dofs,
        reduced->interior_count,  reduced->dropped,     reduced->error};
    list_numbers(&listing, "counts", counts, COUNTS);
    list_numbers(&listing, "sizes", &shape->sizes.length, sizeof(ShapeSizes) / sizeof(double));
    TRY(list_indices(&listing, "node", interface->node, interface->contact_count, err));
    list_numbers(&listing, "x", interface->x, interface->contact_count);
    list_numbers(&listing, "weight", interface->weight, interface->contact_count);
    TRY(list_indices(&listing, "pad", interface->pad, interface->contact_count, err));
    TRY(list_names(&listing, interface, err));
    TRY(list_indices(&listing, "rod_node", interface->rod_node, interface->rod_count, err));
    list_numbers(&listing, "rod_z", interface->rod_z, interface->rod_count);
    list_numbers(&listing, "rod_share", interface->rod_share, interface->rod_count);
    TRY(list_indices(&listing, "dofs", interface->dofs, interface->count, err));
    list_numbers(&listing, "rotation", shape->rotation, m);
    list_numbers(&listing, "mass", reduced->mass, all * all);
    list_numbers(&listing, "damping", reduced->damping, all * all);
    list_numbers(&listing, "stiffness", reduced->stiffness, m * m);
    list_numbers(&listing, "load", reduced->load, all);
    // The modes first: a shape that is there has its modes.
    if (!cache_path(key, "modes", path)) goto cleanup;
    CacheArray modes = {
        .name = "modes", .count = reduced->full_dofs * all, .values = reduced->modes};
    TRY(cache_file_write(path, key, &modes, 1, err));
    if (!cache_path(key, "shape", path)) goto cleanup;
    TRY(cache_file_write(path, key, listing.arrays, listing.count, err));
cleanup:
    for (int32_t k = 0; k < CACHE_ARRAYS_MAX; k++) memory_free(listing.owned[k]);
    return error_is_clean(err);
}

void shape_cache_store(const char *key, const Shape *shape, char note[SHAPE_NOTE_SIZE])
{
    Error err = {0};
    if (key[0] && !store_shape(key, shape, &err))
        snprintf(note, SHAPE_NOTE_SIZE, "the basis is not kept for the next run: %.180s",
                 err.message);
}
