// SPDX-License-Identifier: GPL-2.0-or-later
// The faces of the contact of a block in space, over its contact nodes: what is needed to draw it.
// Corners of T6 faces touch nothing and are no contact nodes; they are points here, too. Part of
// contact/interface; used by run/output and record/field_files.
#ifndef AMONTONS_CONTACT_CONTACT_FACES_H
#define AMONTONS_CONTACT_CONTACT_FACES_H

#include "fem/mesh.h"

typedef struct ContactFaces {
    int32_t corner_count;
    double *corner;   // [corner_count * 2] x and y of the points that are no contact nodes; owned
    int32_t count, width;   // faces; room for the points of one
    int32_t
        *point;   // [count * width] contact node, or behind them the corners; -1: no more; owned
} ContactFaces;

// contact: its nodes are the contact nodes. Of a mesh in the plane: none.
bool contact_faces_build(const Mesh *mesh, const MeshContact *contact, ContactFaces *faces,
                         Error *err);
void contact_faces_destroy(ContactFaces *faces);

// Number of points of face f; they are the first of its row.
int32_t contact_face_points(const ContactFaces *faces, int32_t f);

#endif
