// SPDX-License-Identifier: GPL-2.0-or-later
// Lists of elements picked from a raw mesh: those of the body, or those of one group. Called by
// io/mesh/mesh_convert only.
#ifndef AMONTONS_IO_MESH_RAW_ELEMENTS_H
#define AMONTONS_IO_MESH_RAW_ELEMENTS_H

#include "base/error.h"
#include "io/mesh/mesh_raw.h"

#include <stdint.h>

// One element: where it stands in the raw blocks.
typedef struct RawElement {
    int64_t number;
    const int64_t *nodes;   // its node tags, in the block
    int32_t count;   // of nodes
    int32_t kind;   // ElementKind; -1 for points
} RawElement;

typedef struct RawElements {
    int32_t count;
    RawElement *items;   // [count]; owned
} RawElements;

// The block's entity is in the group.
bool raw_group_holds(const RawGroup *group, const RawBlock *block);
// In how many groups of its dimension a block's entity is.
int32_t raw_block_groups(const MeshRaw *raw, const RawBlock *block);

// 3 where there are volume elements, else 2.
int32_t raw_dimension(const MeshRaw *raw);

// The elements of the body by ascending number: of the physical groups of its dimension, or all of
// it where there are none. ERROR_INPUT: none, or a kind that is not in ELEMENT_KINDS.
bool raw_pick_body(const MeshRaw *raw, int32_t dim, const char *path, RawElements *picked,
                   Error *err);

// The points, edges or faces of a group, by ascending number; `name` for messages.
bool raw_pick_group(const MeshRaw *raw, const char *path, const RawGroup *from, const char *name,
                    RawElements *picked, Error *err);

#endif
