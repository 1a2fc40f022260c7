// SPDX-License-Identifier: GPL-2.0-or-later
// Points, edges, elements of no group and copies in a raw mesh are left out; elements of a kind
// that we do not have are refused by name. The order is by element tag, whatever gmsh's is.
#include "io/mesh/raw_elements.h"

#include "base/memory.h"
#include "base/order.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// gmsh's numbers of what is not in ELEMENT_KINDS.
enum { GMSH_POINT = 15, GMSH_HEX_20 = 17, GMSH_WEDGE_15 = 18, KIND_LIST_SIZE = 64 };

// The ElementKind of a block's gmsh type, -1: none of ours.
static int32_t kind_of(const RawBlock *block)
{
    for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++) {
        const ElementInfo *info = &ELEMENTS[(ElementKind)kind];
        if (info->gmsh_type == block->gmsh_type && info->dim == block->dimension) return kind;
    }
    return -1;
}

// Why some are not among ours.
static const char *why_not(int32_t gmsh_type)
{
    bool serendipity = gmsh_type == GMSH_HEX_20 || gmsh_type == GMSH_WEDGE_15;
    return serendipity ? ": its faces have corners of negative weight, which can carry no contact "
                         "(Mesh.SecondOrderIncomplete = 0 makes HEX27)"
                       : "";
}

int32_t raw_dimension(const MeshRaw *raw)
{
    for (int32_t k = 0; k < raw->block_count; k++)
        if (raw->blocks[k].dimension == 3 && raw->blocks[k].count > 0) return 3;
    return 2;
}

// Tags of entities are signed in some files: the sign is the orientation.
bool raw_group_holds(const RawGroup *group, const RawBlock *block)
{
    if (group->dimension != block->dimension) return false;
    for (int32_t k = 0; k < group->entity_count; k++)
        if (abs(group->entities[k]) == block->entity) return true;
    return false;
}

int32_t raw_block_groups(const MeshRaw *raw, const RawBlock *block)
{
    int32_t count = 0;
    for (int32_t k = 0; k < raw->group_count; k++) count += raw_group_holds(&raw->groups[k], block);
    return count;
}

// Whether the file says which surfaces count.
static bool has_region(const MeshRaw *raw, int32_t dim)
{
    if (raw->all_elements) return false;
    for (int32_t k = 0; k < raw->group_count; k++)
        if (raw->groups[k].dimension == dim) return true;
    return false;
}

// By node tags, so that copies of one element come together; among copies the lowest tag first.
static int compare_nodes(const void *a, const void *b)
{
    const RawElement *first = a, *second = b;
    if (first->count != second->count) return first->count < second->count ? -1 : 1;
    for (int32_t k = 0; k < first->count; k++)
        if (first->nodes[k] != second->nodes[k]) return first->nodes[k] < second->nodes[k] ? -1 : 1;
    return order_int64(a, b);
}

// Format 2.2 writes an element once for each of its physical groups: keeps the first copy.
static void drop_copies(RawElements *elements)
{
    int32_t kept = 0;
    if (elements->count == 0) return;   // no array to sort
    qsort(elements->items, (size_t)elements->count, sizeof *elements->items, compare_nodes);
    for (int32_t k = 0; k < elements->count; k++) {
        const RawElement *item = &elements->items[k];
        const RawElement *last = kept > 0 ? &elements->items[kept - 1] : NULL;
        if (last && item->count == last->count &&
            memcmp(item->nodes, last->nodes, (size_t)item->count * sizeof *item->nodes) == 0)
            continue;
        elements->items[kept++] = *item;
    }
    elements->count = kept;
}

// Appends the elements of one block; they go on pointing into it. INT32_MAX / ELEMENT_NODES_MAX
// elements keep every index into element_nodes within int32_t.
static bool append_block(RawElements *elements, const RawBlock *block, Error *err)
{
    int64_t total = elements->count + block->count;
    if (total > INT32_MAX / ELEMENT_NODES_MAX)
        return REFUSE(err, "%lld elements are too many", (long long)total);
    if (!memory_resize(&elements->items, elements->count, total, sizeof *elements->items, err))
        return false;
    for (int64_t k = 0; k < block->count; k++)
        elements->items[elements->count++] =
            (RawElement){.number = block->number[k],
                         .nodes = block->nodes + k * block->nodes_per_element,
                         .count = block->nodes_per_element,
                         .kind = kind_of(block)};
    return error_is_clean(err);
}

// By tag, as gmsh mostly delivers them.
static void sort_elements(RawElements *elements, bool may_repeat)
{
    if (may_repeat) drop_copies(elements);
    for (int32_t k = 1; k < elements->count; k++)
        if (elements->items[k - 1].number > elements->items[k].number) {
            qsort(elements->items, (size_t)elements->count, sizeof *elements->items, order_int64);
            break;
        }
}

// "T3, T6, Q4, Q8, Q9", for messages.
static void list_kinds(int32_t dim, char list[KIND_LIST_SIZE])
{
    int length = 0;
    for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++)
        if (element_dim((ElementKind)kind) == dim)
            length += snprintf(list + length, KIND_LIST_SIZE - (size_t)length, "%s%s",
                               length ? ", " : "", ELEMENTS[(ElementKind)kind].name);
}

// picked: empty before; its elements point into `raw`, which must outlive them. Where the file has
// physical groups of this dimension only their elements count, else all of it.
bool raw_pick_body(const MeshRaw *raw, int32_t dim, const char *path, RawElements *picked,
                   Error *err)
{
    bool by_group = has_region(raw, dim), may_repeat = false;
    const char *what = dim == 2 ? "surface" : "volume";
    int64_t others = 0;
    char allowed[KIND_LIST_SIZE];
    list_kinds(dim, allowed);
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        int32_t groups = block->dimension == dim ? raw_block_groups(raw, block) : 0;
        if (block->dimension != dim || (by_group && groups == 0)) {
            others += block->count;
            continue;
        }
        if (kind_of(block) < 0)
            return REFUSE(
                err, "%s: element %lld is of a kind that is not supported, %s%s; allowed are %s",
                path, (long long)(block->count ? block->number[0] : 0), block->type_name,
                why_not(block->gmsh_type), allowed);
        may_repeat = may_repeat || groups > 1;
        if (!append_block(picked, block, err)) return false;
    }
    if (picked->count == 0)
        return REFUSE(err,
                      "%s: has no %s elements%s%s%s (%lld nodes, %lld other elements); was it "
                      "meshed in %dD, and is the %s in a physical group?",
                      path, what, by_group ? " in its physical " : "", by_group ? what : "",
                      by_group ? "s" : "", (long long)raw->node_count, (long long)others, dim,
                      what);
    sort_elements(picked, may_repeat);
    return true;
}

// Faces of order 3 on are refused here, before the elements, as a message about the group says
// more.
bool raw_pick_group(const MeshRaw *raw, const char *path, const RawGroup *from, const char *name,
                    RawElements *picked, Error *err)
{
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        if (!raw_group_holds(from, block)) continue;
        if (block->gmsh_type != GMSH_POINT && kind_of(block) < 0)
            return REFUSE(err, "%s: group '%s' has elements of a kind that is not supported, %s",
                          path, name, block->type_name);
        if (!append_block(picked, block, err)) return false;
    }
    sort_elements(picked, true);
    return true;
}
