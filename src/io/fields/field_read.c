// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/fields/field_read.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/fields/field_file.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LINE_SIZE = 400, COUNT_MAX = 100000000 };

// --- the list of times ---------------------------------------------------------------------------

bool field_times_read(const char *folder, FieldTime **times, int32_t *count, Error *err)
{
    char path[PATH_MAX], line[LINE_SIZE];
    FILE *list = NULL;
    int32_t room = 0;
    *times = NULL;
    *count = 0;
    snprintf(path, sizeof path, "%s/fields.pvd", folder);
    if (!open_is_there(path))
        FAIL(err, ERROR_INPUT,
             "%s has no fields of the block (%s): a scene stores them with output.fields", folder,
             strerror(errno));
    TRY(folder_check_inside(folder, "fields.pvd", err));
    TRY(list = open_stream(path, err));
    while (fgets(line, sizeof line, list)) {
        // A line as io/fields/field_file writes it; others name no block.
        FieldTime time;
        const char *step = strstr(line, "timestep=\""), *file = strstr(line, "file=\"");
        if (!step || !strstr(line, "name=\"bulk\"") || !file ||
            sscanf(step, "timestep=\"%lf\"", &time.t) != 1 ||
            sscanf(file, "file=\"%63[^\"]\"", time.file) != 1 || strstr(time.file, "..") ||
            time.file[0] == '/')
            continue;
        TRY(memory_grow(times, *count, &room, sizeof time, err));
        (*times)[(*count)++] = time;
    }
    if (*count == 0) FAIL(err, ERROR_INPUT, "%s names no time", path);
cleanup:
    if (list) fclose(list);
    if (!error_is_clean(err)) {
        memory_free(*times);
        *times = NULL;
    }
    return error_is_clean(err);
}

// --- one time ------------------------------------------------------------------------------------

// Indices from 0 to below `end`, into a new array.
static bool take_indices(const FieldPart *part, int64_t end, int32_t **indices, Error *err)
{
    memory_free(*indices);   // of an array that is there twice
    if (!(*indices = NEW_ARRAY(int32_t, part->count, err))) return false;
    for (int64_t k = 0; k < part->count; k++) {
        if (!(part->values[k] >= 0 && part->values[k] < (double)end))
            return FAULT(err, ERROR_FILE, "its %s are damaged", part->name);
        (*indices)[k] = (int32_t)part->values[k];
    }
    return true;
}

// VTK's numbers of the cells that record/fields writes, all of one dimension; nodes go from VTK's
// order to gmsh's.
static bool take_kinds(const FieldPart *part, FieldFrame *frame, Error *err)
{
    memory_free(frame->kind);
    if (!(frame->kind = NEW_ARRAY(uint8_t, part->count, err))) return false;
    for (int64_t k = 0; k < part->count; k++) {
        bool found = false;
        for (int kind = 0; kind < ELEMENT_KIND_COUNT && !found; kind++) {
            const ElementInfo *info = &ELEMENTS[(ElementKind)kind];
            frame->kind[k] = (uint8_t)kind;
            found = info->dim > 1 && info->vtk_type == part->values[k];
        }
        if (!found) return FAULT(err, ERROR_FILE, "it has cells that are no elements of a block");
    }
    for (int32_t e = 0; e < frame->element_count; e++)
        if (part->count != frame->element_count ||
            frame->first_node[e + 1] - frame->first_node[e] !=
                element_node_count((ElementKind)frame->kind[e]))
            return FAULT(err, ERROR_FILE, "its cells have the wrong number of nodes");
    frame->dim = frame->element_count > 0 ? element_dim((ElementKind)frame->kind[0]) : 2;
    for (int32_t e = 0; e < frame->element_count; e++) {
        ElementKind kind = (ElementKind)frame->kind[e];
        int32_t *nodes = frame->element_nodes + frame->first_node[e], vtk[ELEMENT_NODES_MAX];
        if (element_dim(kind) != frame->dim)
            return FAULT(err, ERROR_FILE, "it has cells of two and of three dimensions");
        memcpy(vtk, nodes, (size_t)element_node_count(kind) * sizeof *vtk);
        for (int32_t k = 0; k < element_node_count(kind); k++)
            nodes[element_vtk_node(kind, k)] = vtk[k];
    }
    return true;
}

enum { PLANE_STRESSES = 3 };   // of a node; in space twice as many

// Grid before fields, points first: as the module hands them on. What is not known is passed over.
static bool take_part(void *context, const FieldPart *part, Error *err)
{
    FieldFrame *frame = context;
    int32_t stresses = frame->dim > 2 ? 2 * PLANE_STRESSES : PLANE_STRESSES;
    const struct {
        const char *name;
        int32_t components;
        double **values;
    } arrays[] = {
        {"points", 3, &frame->position},      {"displacement", 3, &frame->displacement},
        {"velocity", 3, &frame->velocity},    {"stress_elastic", stresses, &frame->stress_elastic},
        {"stress", stresses, &frame->stress}, {"von_mises", 1, &frame->von_mises}};
    if (part->count > COUNT_MAX)
        return FAULT(err, ERROR_FILE, "it has more than %d nodes", COUNT_MAX);
    if (strcmp(part->name, "points") == 0) frame->node_count = (int32_t)part->count;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        int32_t components = arrays[k].components;
        double **values = arrays[k].values;
        if (strcmp(arrays[k].name, part->name) != 0) continue;
        memory_free(*values);
        *values = NULL;
        if (part->components != components || part->count != frame->node_count)
            return FAULT(err, ERROR_FILE, "its array %s is not one of %d numbers a node",
                         part->name, components);
        if (!(*values = NEW_ARRAY(double, components * part->count, err))) return false;
        memcpy(*values, part->values, (size_t)(components * part->count) * sizeof **values);
        return true;
    }
    if (strcmp(part->name, "offsets") == 0) {
        frame->element_count = (int32_t)part->count - 1;
        return take_indices(part, INT32_MAX, &frame->first_node, err);
    }
    if (strcmp(part->name, "connectivity") == 0) {
        bool whole = part->count == frame->first_node[frame->element_count];
        if (!whole) return FAULT(err, ERROR_FILE, "its cells are damaged");
        return take_indices(part, frame->node_count, &frame->element_nodes, err);
    }
    if (strcmp(part->name, "types") == 0) {
        if (!take_kinds(part, frame, err)) return false;
        frame->stresses = frame->dim > 2 ? 2 * PLANE_STRESSES : PLANE_STRESSES;
    }
    return error_is_clean(err);
}

bool field_frame_read(const char *path, FieldFrame *frame, Error *err)
{
    *frame = (FieldFrame){0};
    if (!open_check(path, err)) goto cleanup;   // VTK opens it by its name
    FieldDecodeFunction decode =
        (FieldDecodeFunction)module_function("vtk", "amontons_vtk_decode", err);
    TRY(decode);
    TRY(decode(path, take_part, frame, err));
    const void *needed[] = {frame->displacement,   frame->velocity,  frame->stress,
                            frame->stress_elastic, frame->von_mises, frame->kind};
    for (size_t k = 0; k < sizeof needed / sizeof *needed; k++)
        if (!needed[k]) FAIL(err, ERROR_FILE, "it lacks an array that a run writes");
cleanup:
    error_context(err, "while reading %s", path);
    return error_is_clean(err);
}

// In place: the numbers of these nodes are moved to the front of an array of so many a node.
static void keep_values(double *values, int32_t components, const int32_t *place, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (place[i] >= 0)
            memmove(values + (int64_t)components * place[i], values + (int64_t)components * i,
                    (size_t)components * sizeof *values);
}

bool field_frame_crop(FieldFrame *frame, double depth, Error *err)
{
    int32_t *place = NULL, elements = 0, entries = 0, nodes = 0;   // place of a node; -1: it goes
    TRY(place = NEW_ARRAY(int32_t, frame->node_count, err));
    for (int32_t i = 0; i < frame->node_count; i++) place[i] = -1;
    for (int32_t e = 0; e < frame->element_count; e++) {
        int32_t begin = frame->first_node[e], count = frame->first_node[e + 1] - begin;
        const int32_t *own = frame->element_nodes + begin;
        double highest = -INFINITY;
        for (int32_t k = 0; k < count; k++)
            highest = fmax(highest, frame->position[3 * (int64_t)own[k] + frame->dim - 1]);
        if (highest <= -depth) continue;
        for (int32_t k = 0; k < count; k++) place[own[k]] = 0;
        memmove(frame->element_nodes + entries, own, (size_t)count * sizeof *own);
        frame->kind[elements] = frame->kind[e];
        frame->first_node[elements++] = entries;
        entries += count;
    }
    frame->first_node[elements] = entries;
    frame->element_count = elements;
    for (int32_t i = 0; i < frame->node_count; i++)
        if (place[i] == 0) place[i] = nodes++;
    for (int32_t k = 0; k < entries; k++) frame->element_nodes[k] = place[frame->element_nodes[k]];
    double *const vectors[] = {frame->position, frame->displacement, frame->velocity};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
        keep_values(vectors[k], 3, place, frame->node_count);
    keep_values(frame->stress_elastic, frame->stresses, place, frame->node_count);
    keep_values(frame->stress, frame->stresses, place, frame->node_count);
    keep_values(frame->von_mises, 1, place, frame->node_count);
    frame->node_count = nodes;
cleanup:
    memory_free(place);
    return error_is_clean(err);
}

void field_frame_destroy(FieldFrame *frame)
{
    memory_free_all(frame->position, frame->displacement, frame->velocity, frame->stress_elastic,
                    frame->stress, frame->von_mises, frame->kind, frame->first_node,
                    frame->element_nodes);
    *frame = (FieldFrame){0};
}
