// SPDX-License-Identifier: GPL-2.0-or-later
// The longer parts of amontons_info; called by run/info/info only.
#ifndef AMONTONS_RUN_INFO_INFO_H
#define AMONTONS_RUN_INFO_INFO_H

#include "amontons.h"
#include "fem/mesh.h"

bool info_mesh(const char *path, const InfoOptions *options, FILE *out, Error *err);   // .msh, .geo
void info_write_mesh(const Mesh *mesh, FILE *out);
bool info_result(const char *folder, FILE *out, Error *err);   // a result folder

// The mesh as a picture; strip: the rod's, z from and to, NULL: none. unit: of lengths, as
// RenderMesh has it.
bool info_draw_mesh(const Mesh *mesh, const double strip[2], const char *unit,
                    const InfoOptions *options, Error *err);

#endif
