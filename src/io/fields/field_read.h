// SPDX-License-Identifier: GPL-2.0-or-later
// Reads what record/fields wrote: which times there are, and the block at one of them. Called by
// render/view/block.
#ifndef AMONTONS_IO_FIELDS_FIELD_READ_H
#define AMONTONS_IO_FIELDS_FIELD_READ_H

#include "io/mesh/mesh_file.h"

enum { FIELD_NAME_SIZE = 64 };

typedef struct FieldTime {
    double t;   // time
    char file[FIELD_NAME_SIZE];   // of the block, below the result folder
} FieldTime;

// The list fields.pvd of the result in `folder`: *times [*count], owned by the caller
// (memory_free). ERROR_INPUT where there is none.
bool field_times_read(const char *folder, FieldTime **times, int32_t *count, Error *err);

// The block at one time. Vectors have three components: (x, z, 0), in space (x, y, z). Stresses are
// xx, zz, xz; in space xx, yy, zz, xy, yz, xz.
typedef struct FieldFrame {
    int32_t dim;   // of the block: 2, in space 3
    int32_t stresses;   // of a node: 3, in space 6
    int32_t node_count;
    double *position, *displacement, *velocity;   // [node_count * 3] owned, like all
    double *stress_elastic, *stress;   // [node_count * stresses] without and with the viscous part
    double *von_mises;   // [node_count]
    int32_t element_count;
    uint8_t *kind;   // [element_count] ElementKind
    int32_t *first_node;   // [element_count + 1] offsets into element_nodes
    int32_t *element_nodes;   // in gmsh's order
} FieldFrame;

// Checked: nothing points outside. ERROR_FILE names `path`.
bool field_frame_read(const char *path, FieldFrame *frame, Error *err);
// Takes away the elements that lie wholly deeper than this below the floor (z = 0), and the nodes
// that only they have.
bool field_frame_crop(FieldFrame *frame, double depth, Error *err);
void field_frame_destroy(FieldFrame *frame);   // zeroed is fine

#endif
