// SPDX-License-Identifier: GPL-2.0-or-later
// The section, as the manual of gmsh has it (chapter "MSH file format version 2"):
//
//     $Elements
//     count
//     number type tag-count <tags> <nodes>          one line an element; tags: group, entity, ...
//
// in binary files blocks of `type elements tag-count` and for each element `number <tags> <nodes>`,
// ints of four bytes. An element that is in several groups is written once for each of them.
#include "io/mesh/msh2_entities.h"

#include "base/hash.h"
#include "base/memory.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Dimension and nodes of gmsh's element types; beyond these the section is left to gmsh.
static const struct {
    int8_t dim, nodes;
} TYPES[] = {{-1, 0}, {1, 2}, {2, 3}, {2, 4},  {3, 4},  {3, 8},  {3, 6},
             {3, 5},  {1, 3}, {2, 6}, {2, 9},  {3, 10}, {3, 27}, {3, 18},
             {3, 14}, {0, 1}, {2, 8}, {3, 20}, {3, 15}, {3, 13}};

enum {
    TYPE_COUNT = sizeof TYPES / sizeof TYPES[0],
    NODES_MAX = 27,
    TAGS_MAX = 64,
    DIMENSIONS = 4,
    ELEMENT_BYTES_MIN = 8,   // "1 15 0 1"
    LINE_SIZE = 80   // of what is written anew of a line: four numbers
};

typedef struct Msh2Element {
    int32_t type, group, entity;
    int32_t tags;   // how many the file gives; without the second the entity is 0
    int64_t begin, after_entity;   // places in the file: its first byte; behind group and entity
    int64_t first_node;   // into Msh2File.nodes
    uint64_t groups;   // hash of all the groups that it is in
    int32_t made_entity;   // the number that it gets
} Msh2Element;

typedef struct Msh2File {
    const char *bytes;
    int64_t size, at;   // at: the next to be read
    bool binary;
    int64_t count;
    Msh2Element *elements;   // [count]; owned
    int64_t *nodes;   // [nodes_used] tags of all elements, one after the other; owned
    int64_t nodes_used, nodes_room;
} Msh2File;

static int32_t dim_of(const Msh2Element *element)
{
    return TYPES[element->type].dim;
}

// --- reading ------------------------------------------------------------------------------------

// A decimal number on the line that is being read; false: there is none.
static bool read_decimal(Msh2File *file, int64_t *value)
{
    while (file->bytes[file->at] == ' ' || file->bytes[file->at] == '\t') file->at++;
    char *end = NULL;
    const char *begin = file->bytes + file->at;
    if (*begin == '\n' || *begin == '\r' || *begin == 0) return false;
    *value = strtoll(begin, &end, 10);
    file->at = end - file->bytes;
    return end > begin;
}

static bool read_int(Msh2File *file, int64_t *value)
{
    int32_t found;
    if (!file->binary) return read_decimal(file, value);
    if (file->size - file->at < (int64_t)sizeof found) return false;
    memcpy(&found, file->bytes + file->at, sizeof found);
    file->at += (int64_t)sizeof found;
    *value = found;
    return true;
}

static void skip_line(Msh2File *file)
{
    while (file->at < file->size && file->bytes[file->at] != '\n') file->at++;
    if (file->at < file->size) file->at++;
}

// False: the file is not understood, or an error.
static bool read_elements(Msh2File *file, Error *err)
{
    static const char mark[] = "\n$Elements";
    int is_binary = 0;
    int64_t count = 0;
    double version = 0;
    const char *format = strstr(file->bytes, "$MeshFormat");
    const char *begin = memmem(file->bytes, (size_t)file->size, mark, sizeof mark - 1);
    if (!format || !begin || sscanf(format, "$MeshFormat %lf %d", &version, &is_binary) != 2)
        return false;
    file->at = begin + 1 - file->bytes;
    skip_line(file);
    if (!read_decimal(file, &count) || count < 1 || count > file->size / ELEMENT_BYTES_MIN)
        return false;
    skip_line(file);
    file->count = count;
    file->binary = is_binary == 1;
    if (!(file->elements = NEW_ARRAY(Msh2Element, count, err))) return false;

    // Lines: number, type, tag-count, and the rest of one element. Blocks: type, elements,
    // tag-count, then of each element its number and the rest.
    for (int64_t k = 0; k < count;) {
        int64_t number = 0, type = 0, in_block = 1, tags = 0, line = file->at;
        if (!file->binary && !read_int(file, &number)) return false;
        if (!read_int(file, &type)) return false;
        if (file->binary && !read_int(file, &in_block)) return false;
        if (!read_int(file, &tags)) return false;
        if (type <= 0 || type >= TYPE_COUNT || tags < (file->binary ? 2 : 0) || tags > TAGS_MAX ||
            in_block < 1 || in_block > count - k)
            return false;
        for (int64_t i = 0; i < in_block; i++, k++) {
            Msh2Element *element = &file->elements[k];
            *element =
                (Msh2Element){.type = (int32_t)type, .begin = file->binary ? file->at : line};
            if (file->binary && !read_int(file, &number)) return false;

            // The first two tags are the numbers of the group and of the entity.
            element->tags = (int32_t)tags;
            element->after_entity = file->at;
            for (int64_t tag = 0, value = 0; tag < tags; tag++) {
                if (!read_int(file, &value) || value < INT_MIN || value > INT_MAX) return false;
                if (tag == 0) element->group = (int32_t)value;
                if (tag == 1) element->entity = (int32_t)value;
                if (tag <= 1) element->after_entity = file->at;
            }

            // The nodes of all elements follow each other in one array.
            if (file->nodes_used + NODES_MAX > file->nodes_room) {
                int64_t room = 2 * file->nodes_room + 1000 * NODES_MAX;
                if (!memory_resize(&file->nodes, file->nodes_room, room, sizeof *file->nodes, err))
                    return false;
                file->nodes_room = room;
            }
            element->first_node = file->nodes_used;
            for (int32_t a = 0; a < TYPES[element->type].nodes; a++)
                if (!read_int(file, &file->nodes[file->nodes_used++])) return false;
        }
        if (!file->binary) skip_line(file);
    }
    return true;
}

// --- which belong together ----------------------------------------------------------------------

// Compares dimension, type and nodes, so that the copies of an element come together, then groups.
static int compare_copies(const void *a, const void *b, void *context)
{
    const Msh2File *file = context;
    const Msh2Element *first = &file->elements[*(const int64_t *)a],
                      *second = &file->elements[*(const int64_t *)b];
    if (first->type != second->type) return first->type < second->type ? -1 : 1;
    const int64_t *one = file->nodes + first->first_node, *two = file->nodes + second->first_node;
    for (int32_t k = 0; k < TYPES[first->type].nodes; k++)
        if (one[k] != two[k]) return one[k] < two[k] ? -1 : 1;
    return (first->group > second->group) - (first->group < second->group);
}

// Compares dimension, entity and groups.
static int compare_entities(const void *a, const void *b, void *context)
{
    const Msh2File *file = context;
    const Msh2Element *first = &file->elements[*(const int64_t *)a],
                      *second = &file->elements[*(const int64_t *)b];
    if (dim_of(first) != dim_of(second)) return dim_of(first) < dim_of(second) ? -1 : 1;
    if (first->entity != second->entity) return first->entity < second->entity ? -1 : 1;
    return (first->groups > second->groups) - (first->groups < second->groups);
}

bool msh2_tell_entities_apart(const char *bytes, int64_t size, char **mended, int64_t *mended_size,
                              Error *err)
{
    Msh2File file = {.bytes = bytes, .size = size};
    int64_t *order = NULL, from = 0, to = 0;
    int32_t most[DIMENSIONS] = {0};   // the largest entity of each dimension
    bool changed = false;
    *mended = NULL;
    if (!read_elements(&file, err)) goto cleanup;
    TRY(order = NEW_ARRAY(int64_t, file.count, err));
    for (int64_t k = 0; k < file.count; k++) order[k] = k;

    // The groups of every element, from all of its copies.
    qsort_r(order, (size_t)file.count, sizeof *order, compare_copies, &file);
    for (int64_t k = 0, end; k < file.count; k = end) {
        Hash hash = hash_start();
        const Msh2Element *first = &file.elements[order[k]], *last = NULL;
        const size_t length = (size_t)TYPES[first->type].nodes * sizeof *file.nodes;
        for (end = k; end < file.count; end++) {
            const Msh2Element *copy = &file.elements[order[end]];
            if (copy->type != first->type ||
                memcmp(file.nodes + first->first_node, file.nodes + copy->first_node, length) != 0)
                break;
            if (!last || last->group != copy->group)
                hash_bytes(&hash, &copy->group, sizeof copy->group);
            last = copy;
        }
        for (int64_t i = k; i < end; i++) file.elements[order[i]].groups = hash.low;
    }

    // The entities: the first set of groups on one keeps its number, each other set gets a new
    // number. 0 is no entity's.
    for (int64_t k = 0; k < file.count; k++) {
        const Msh2Element *element = &file.elements[k];
        int32_t dim = dim_of(element);
        if (element->entity > most[dim]) most[dim] = element->entity;
    }
    qsort_r(order, (size_t)file.count, sizeof *order, compare_entities, &file);
    for (int64_t k = 0; k < file.count; k++) {
        Msh2Element *element = &file.elements[order[k]];
        const Msh2Element *last = k > 0 ? &file.elements[order[k - 1]] : NULL;
        bool same = last && dim_of(last) == dim_of(element) && last->entity == element->entity;
        if (same && last->groups == element->groups)
            element->made_entity = last->made_entity;
        else if (same || element->entity == 0) {
            if (most[dim_of(element)] == INT_MAX) goto cleanup;
            element->made_entity = ++most[dim_of(element)];
        } else
            element->made_entity = element->entity;
        changed = changed || element->made_entity != element->entity;
    }
    if (!changed) goto cleanup;

    // The file. In a binary one numbers keep their places; a line is written anew up to its entity.
    char *made = memory_bytes(size + (file.binary ? 0 : LINE_SIZE * file.count), err);
    TRY(made);
    for (int64_t k = 0; k < file.count; k++) {
        const Msh2Element *element = &file.elements[k];
        int64_t until = file.binary ? element->after_entity : element->begin;
        memcpy(made + to, bytes + from, (size_t)(until - from));
        to += until - from;
        from = until;
        if (file.binary) {
            memcpy(made + to - sizeof(int32_t), &element->made_entity, sizeof(int32_t));
            continue;
        }
        to += snprintf(made + to, LINE_SIZE, "%lld %d %d %d %d",
                       strtoll(bytes + element->begin, NULL, 10), element->type,
                       element->tags < 2 ? 2 : element->tags, element->group, element->made_entity);
        from = element->after_entity;
    }
    memcpy(made + to, bytes + from, (size_t)(size - from));
    *mended = made;
    *mended_size = to + size - from;
cleanup:
    memory_free_all(order, file.elements, file.nodes);
    return error_is_clean(err);
}
