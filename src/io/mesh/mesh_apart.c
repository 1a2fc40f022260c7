// SPDX-License-Identifier: GPL-2.0-or-later
// The reply: the struct, then its arrays in the order of its fields, each block and group with its
// own behind it. Both sides are the same program, so nothing is converted.
#include "io/mesh/mesh_apart.h"

#include "base/apart.h"
#include "base/memory.h"
#include "base/module.h"

#include <stdio.h>

// Of processor time: to read the file, which takes a second for 1e6 cells, and in all. gmsh makes
// 900 000 triangles in it.
enum { READING_SECONDS = 20, SECONDS_MAX = 60 };

// --- in the child -------------------------------------------------------------------------------

static void send(const void *array, int64_t count, size_t size, FILE *reply)
{
    fwrite(array, size, (size_t)count, reply);   // a failure shows when the reply is flushed
}

static void send_raw(const MeshRaw *raw, FILE *reply)
{
    send(raw, 1, sizeof *raw, reply);
    send(raw->node_number, raw->node_count, sizeof *raw->node_number, reply);
    send(raw->node_dimension, raw->node_count, sizeof *raw->node_dimension, reply);
    send(raw->node_position, 3 * raw->node_count, sizeof *raw->node_position, reply);
    send(raw->blocks, raw->block_count, sizeof *raw->blocks, reply);
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        send(block->number, block->count, sizeof *block->number, reply);
        send(block->nodes, block->count * block->nodes_per_element, sizeof *block->nodes, reply);
    }
    send(raw->groups, raw->group_count, sizeof *raw->groups, reply);
    for (int32_t k = 0; k < raw->group_count; k++)
        send(raw->groups[k].entities, raw->groups[k].entity_count, sizeof(int32_t), reply);
}

static void begin_meshing(void)
{
    apart_allow(SECONDS_MAX);
}

static bool read_by_gmsh(void *context, FILE *reply, Error *err)
{
    MeshRaw raw = {0};
    MeshRawRequest request = *(const MeshRawRequest *)context;
    request.opened = begin_meshing;
    MeshRawReader read = (MeshRawReader)module_function("gmsh", "amontons_gmsh_read", err);
    if (read && read(&request, &raw, err)) send_raw(&raw, reply);
    mesh_raw_destroy(&raw);
    return error_is_clean(err);
}

// --- in the parent ------------------------------------------------------------------------------

static bool take_blocks(ApartReply *reply, MeshRaw *raw, int32_t count, Error *err)
{
    TRY((raw->blocks = apart_take(reply, count, sizeof *raw->blocks, err)));
    for (int32_t k = 0; k < count; k++) raw->blocks[k].number = raw->blocks[k].nodes = NULL;
    raw->block_count = count;
    for (int32_t k = 0; k < count; k++) {
        RawBlock *block = &raw->blocks[k];
        TRY((block->number = apart_take(reply, block->count, sizeof *block->number, err)));
        TRY((block->nodes = apart_take(reply, block->count * block->nodes_per_element,
                                       sizeof *block->nodes, err)));
    }
cleanup:
    return error_is_clean(err);
}

static bool take_groups(ApartReply *reply, MeshRaw *raw, int32_t count, Error *err)
{
    TRY((raw->groups = apart_take(reply, count, sizeof *raw->groups, err)));
    for (int32_t k = 0; k < count; k++) raw->groups[k].entities = NULL;
    raw->group_count = count;
    for (int32_t k = 0; k < count; k++) {
        RawGroup *group = &raw->groups[k];
        TRY((group->entities = apart_take(reply, group->entity_count, sizeof(int32_t), err)));
    }
cleanup:
    return error_is_clean(err);
}

// Pointers of the other process are set to NULL before anything may fail.
static bool take_raw(ApartReply *reply, MeshRaw *raw, Error *err)
{
    MeshRaw *sent = apart_take(reply, 1, sizeof *sent, err);
    if (!sent) goto cleanup;
    int64_t nodes = raw->node_count = sent->node_count;
    TRY((raw->node_number = apart_take(reply, nodes, sizeof *raw->node_number, err)));
    TRY((raw->node_dimension = apart_take(reply, nodes, sizeof *raw->node_dimension, err)));
    TRY((raw->node_position = apart_take(reply, 3 * nodes, sizeof *raw->node_position, err)));
    TRY(take_blocks(reply, raw, sent->block_count, err));
    TRY(take_groups(reply, raw, sent->group_count, err));
cleanup:
    memory_free(sent);
    return error_is_clean(err);
}

bool mesh_apart_read(const MeshRawRequest *request, MeshRaw *raw, Error *err)
{
    ApartReply reply = {0};
    ApartWork work = {.path = request->path,
                      .reader = "gmsh",
                      .seconds = READING_SECONDS,
                      .advice = "where it is not endless: coarser cells, or mesh it by gmsh itself "
                                "and name the .msh",
                      .read = read_by_gmsh,
                      .context = (void *)request};
    *raw = (MeshRaw){0};
    TRY(module_function("gmsh", "amontons_gmsh_read", err));
    TRY(apart_read(&work, &reply, err));
    TRY(take_raw(&reply, raw, err));
cleanup:
    apart_destroy(&reply);
    return error_is_clean(err);
}
