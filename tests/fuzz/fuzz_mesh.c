// SPDX-License-Identifier: GPL-2.0-or-later
// The border to gmsh: tags, positions, elements and groups as its interface may deliver them, from
// letters: '0' is 0, 'A' is 17, and so on. What is accepted is looked through.
#include "fem/mesh.h"
#include "io/mesh/mesh_raw.h"
#include "tests/fuzz/fuzz.h"

#include <math.h>

enum { NODES_MAX = 40, BLOCKS_MAX = 8, ELEMENTS_MAX = 20, GROUPS_MAX = 8 };

typedef struct Letters {
    const uint8_t *at, *end;
} Letters;

static int32_t take(Letters *letters, int32_t low, int32_t high)
{
    int32_t value = letters->at < letters->end ? *letters->at++ - '0' : 0;
    return value < low ? low : value > high ? high : value;
}

// Mostly a multiple of 1/4, sometimes no number at all.
static double take_position(Letters *letters)
{
    int32_t value = take(letters, -48, 207);
    return value == 206 ? NAN : value == 207 ? 1e300 : 0.25 * value;
}

static void take_nodes(Letters *letters, MeshRaw *raw, Error *err)
{
    raw->node_count = take(letters, 0, NODES_MAX);
    raw->node_number = NEW_ARRAY(int64_t, raw->node_count, err);
    raw->node_dimension = NEW_ARRAY(uint8_t, raw->node_count, err);
    raw->node_position = NEW_ARRAY(double, 3 * raw->node_count, err);
    int32_t shift = take(letters, -1, 2);
    for (int64_t k = 0; k < raw->node_count; k++) {
        raw->node_number[k] = k + 1 + (take(letters, 0, 60) == 60 ? shift : 0);
        raw->node_dimension[k] = (uint8_t)take(letters, 0, 3);
        raw->node_position[3 * k] = take_position(letters);
        raw->node_position[3 * k + 1] = take_position(letters);
    }
}

static void take_blocks(Letters *letters, MeshRaw *raw, Error *err)
{
    static const int32_t types[] = {1, 2, 3, 8, 9, 10, 16, 15, 4, 99};
    static const int32_t widths[] = {2, 3, 4, 3, 6, 9, 8, 1, 4, 2};
    raw->block_count = take(letters, 0, BLOCKS_MAX);
    raw->blocks = NEW_ARRAY(RawBlock, raw->block_count, err);
    for (int32_t k = 0; k < raw->block_count; k++) {
        RawBlock *block = &raw->blocks[k];
        int32_t kind = take(letters, 0, 9);
        block->gmsh_type = types[kind];
        block->nodes_per_element = widths[kind];
        block->dimension = take(letters, 0, 3);
        block->entity = take(letters, 0, 9);
        block->count = take(letters, 0, ELEMENTS_MAX);
        snprintf(block->type_name, sizeof block->type_name, "kind %d", kind);
        block->number = NEW_ARRAY(int64_t, block->count, err);
        block->nodes = NEW_ARRAY(int64_t, block->count * widths[kind], err);
        for (int64_t e = 0; e < block->count; e++) block->number[e] = 20 * k + e + 1;
        for (int64_t a = 0; a < block->count * widths[kind]; a++)
            block->nodes[a] = take(letters, -1, NODES_MAX);
    }
}

static void take_groups(Letters *letters, MeshRaw *raw, Error *err)
{
    static const char *const names[] = {"contact", "top", "rod", "body", "", "contact_2"};
    raw->group_count = take(letters, 0, GROUPS_MAX);
    raw->groups = NEW_ARRAY(RawGroup, raw->group_count, err);
    for (int32_t k = 0; k < raw->group_count; k++) {
        RawGroup *group = &raw->groups[k];
        snprintf(group->name, sizeof group->name, "%s", names[take(letters, 0, 5)]);
        group->dimension = take(letters, 0, 3);
        group->number = take(letters, 0, 9);
        group->entity_count = take(letters, 0, 3);
        group->entities = NEW_ARRAY(int32_t, group->entity_count, err);
        for (int32_t j = 0; j < group->entity_count; j++) group->entities[j] = take(letters, 0, 9);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int64_t before = memory_counters().live;
    Error err = {0};
    Letters letters = {data, data + size};
    MeshRaw raw = {0};
    MeshFile file = {0};
    Mesh mesh = {0};
    MeshContact contact = {0};
    take(&letters, 0, 1);   // the files of the corpus begin with a letter that is not used
    take_nodes(&letters, &raw, &err);
    take_blocks(&letters, &raw, &err);
    take_groups(&letters, &raw, &err);
    if (mesh_raw_convert(&raw, "fuzz.msh", &file, &err) &&
        mesh_build(&file, "fuzz.msh", &mesh, &err)) {
        mesh_summarise(&mesh);
        mesh_contact(&mesh, NULL, 0, &contact, &err);
    }
    mesh_contact_destroy(&contact);
    mesh_destroy(&mesh);
    mesh_file_destroy(&file);
    mesh_raw_destroy(&raw);
    fuzz_check_freed(before);
    return 0;
}
