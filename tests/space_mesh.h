// SPDX-License-Identifier: GPL-2.0-or-later
// Blocks in space of any element, written down without gmsh: cells of a lattice, inner nodes moved
// at random if asked, each cell one hexahedron, two wedges or six tetrahedra. Groups: contact
// (z = 0), top, rod (x = 0), leading, left (y = 0), right.
#ifndef AMONTONS_TESTS_SPACE_MESH_H
#define AMONTONS_TESTS_SPACE_MESH_H

#include "base/memory.h"
#include "fem/mesh.h"
#include "io/mesh/element_faces.h"
#include "io/mesh/shape_functions.h"
#include "space_lattice.h"

// The lattice point of node a of an element with these corners: its reference place weighs them.
static inline int32_t space_point(const SpaceLattice *lattice, ElementKind kind,
                                  const int32_t (*corner)[3], int32_t a)
{
    static const ElementKind linear[ELEMENT_KIND_COUNT] = {[ELEMENT_TET4] = ELEMENT_TET4,
                                                           [ELEMENT_TET10] = ELEMENT_TET4,
                                                           [ELEMENT_WEDGE6] = ELEMENT_WEDGE6,
                                                           [ELEMENT_HEX8] = ELEMENT_HEX8,
                                                           [ELEMENT_HEX27] = ELEMENT_HEX8};
    ShapeValues shape = shape_at(linear[kind], shape_node(kind, a));
    int32_t at[3];
    for (int d = 0; d < 3; d++) {
        double sum = 0;
        for (int32_t c = 0; c < element_corner_count(kind); c++)
            sum += shape.value[c] * corner[c][d];
        at[d] = (int32_t)lround(sum);
    }
    return lattice_at(lattice, at);
}

static inline void space_elements(const SpaceDef *def, SpaceLattice *lattice, MeshFile *file)
{
    Error err = {0};
    SpaceParts parts = space_parts(def->kind);
    int32_t width = element_node_count(def->kind), at[3], filled = 0, e = 0;
    file->element_count = parts.count * def->cells[0] * def->cells[1] * def->cells[2];
    file->kind = NEW_ARRAY(uint8_t, file->element_count, &err);
    file->element_number = NEW_ARRAY(int64_t, file->element_count, &err);
    file->first_node = NEW_ARRAY(int32_t, file->element_count + 1, &err);
    file->element_nodes = NEW_ARRAY(int32_t, width * file->element_count, &err);
    for (at[2] = 0; at[2] < def->cells[2]; at[2]++)
        for (at[1] = 0; at[1] < def->cells[1]; at[1]++)
            for (at[0] = 0; at[0] < def->cells[0]; at[0]++)
                for (int32_t part = 0; part < parts.count; part++, e++) {
                    int32_t corner[8][3];
                    for (int32_t c = 0; c < element_corner_count(def->kind); c++)
                        for (int d = 0; d < 3; d++)
                            corner[c][d] = 2 * (at[d] + ((parts.corner[part][c] >> d) & 1));
                    for (int32_t a = 0; a < width; a++) {
                        int32_t point =
                            space_point(lattice, def->kind, (const int32_t(*)[3])corner, a);
                        if (lattice->node[point] < 0) lattice->node[point] = file->node_count++;
                        file->element_nodes[filled++] = lattice->node[point];
                    }
                    file->kind[e] = (uint8_t)def->kind;
                    file->element_number[e] = e + 1;
                    file->first_node[e + 1] = filled;
                }
}

// The faces of elements all of whose nodes lie at `value` along `axis`.
static inline void space_group(const char *name, int32_t axis, double value, MeshFile *file)
{
    Error err = {0};
    MeshGroup *group = &file->groups[file->group_count++];
    int32_t most = 6 * file->element_count;
    snprintf(group->name, sizeof group->name, "%s", name);
    group->dimension = 2;
    group->number = file->group_count;
    group->nodes_per_face = FACE_NODES_MAX;
    group->face_nodes = NEW_ARRAY(int32_t, FACE_NODES_MAX * most, &err);
    group->nodes = NEW_ARRAY(int32_t, file->node_count, &err);
    memset(group->face_nodes, -1, (size_t)(FACE_NODES_MAX * most) * sizeof(int32_t));
    for (int32_t e = 0; e < file->element_count; e++)
        for (int32_t side = 0; side < element_face_count((ElementKind)file->kind[e]); side++) {
            ElementFace face = element_face((ElementKind)file->kind[e], side);
            bool on = true;
            for (int32_t a = 0; a < element_node_count(face.kind); a++) {
                int32_t node = file->element_nodes[file->first_node[e] + face.node[a]];
                on = on && fabs(file->position[3 * node + axis] - value) < 1e-12;
                group->face_nodes[FACE_NODES_MAX * group->face_count + a] = node;
            }
            if (on)
                group->face_count++;
            else
                memset(group->face_nodes + FACE_NODES_MAX * group->face_count, -1,
                       FACE_NODES_MAX * sizeof(int32_t));
        }
    for (int32_t i = 0; i < file->node_count; i++)
        if (fabs(file->position[3 * i + axis] - value) < 1e-12)
            group->nodes[group->node_count++] = i;
}

static inline MeshFile space_file(const SpaceDef *def)
{
    Error err = {0};
    MeshFile file = {.dim = 3};
    SpaceLattice lattice;
    int32_t count = 1;
    for (int d = 0; d < 3; d++) {
        lattice.points[d] = 2 * def->cells[d] + 1;
        count *= lattice.points[d];
    }
    lattice.place = calloc((size_t)count, sizeof *lattice.place);
    lattice.node = malloc((size_t)count * sizeof *lattice.node);
    memset(lattice.node, -1, (size_t)count * sizeof *lattice.node);
    space_place(def, &lattice);
    space_elements(def, &lattice, &file);
    file.position = NEW_ARRAY(double, 3 * file.node_count, &err);
    file.node_number = NEW_ARRAY(int64_t, file.node_count, &err);
    for (int32_t k = 0; k < count; k++)
        if (lattice.node[k] >= 0)
            memcpy(file.position + 3 * lattice.node[k], lattice.place[k], sizeof lattice.place[k]);
    for (int32_t k = 0; k < file.node_count; k++) file.node_number[k] = k + 1;
    file.groups = NEW_ARRAY(MeshGroup, 6, &err);
    space_group("contact", 2, 0, &file);
    space_group("top", 2, def->size[2], &file);
    space_group("rod", 0, 0, &file);
    space_group("leading", 0, def->size[0], &file);
    space_group("left", 1, 0, &file);
    space_group("right", 1, def->size[1], &file);
    free(lattice.place);
    free(lattice.node);
    return file;
}

static inline void space_build(const SpaceDef *def, Mesh *mesh)
{
    Error err = {0};
    MeshFile file = space_file(def);
    if (!mesh_build(&file, "block in space by hand", mesh, &err)) fail_msg("%s", err.message);
}

#endif
