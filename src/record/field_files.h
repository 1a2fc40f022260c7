// SPDX-License-Identifier: GPL-2.0-or-later
// One time of the fields as ParaView sees it: the bulk as .vtu, the interface as .vtp. Called by
// record/fields, in its writer's thread, and by run/static/static_solve.
#ifndef AMONTONS_RECORD_FIELD_FILES_H
#define AMONTONS_RECORD_FIELD_FILES_H

#include "fem/recovery.h"
#include "contact/interface.h"
#include "io/fields/field_file.h"

enum { FIELD_LINE_ARRAYS = 7 };

// Numbers of a contact node that they hold.
static inline int32_t field_line_columns(int32_t tangents)
{
    return 3 * tangents + 4;
}

// Data that all times of a mesh share, and work arrays for one time.
typedef struct FieldFiles {
    const Mesh *mesh;   // not owned
    const Material *materials;   // not owned; the caller's to set, before the first file
    const Spectrum *spectrum;   // of their branches; likewise
    NodalStress stress;   // of the last .vtu; owned, like all that follows
    // Grids without arrays of points, which each file has its own of.
    FieldGrid bulk;   // of stress.point_count points
    FieldGrid line;   // contact nodes, and behind them corners of faces that touch nothing
    double *vectors;   // [bulk points * 6] displacement, velocity
    const ContactFaces *faces;   // none in the plane; not owned
    int32_t contact_count, tangents;   // tangents: 1 in the plane, 2 in space
    double *line_values;   // [FIELD_LINE_ARRAYS * line points * 3] work
} FieldFiles;

// State of the whole mesh. Nothing is owned.
typedef struct FieldState {
    const double *displacement, *velocity;   // [dim * nodes]
    const double *const *relaxing;   // [shapes of the spectrum] as in fem/recovery; NULL: none
    double time;
} FieldState;

bool field_files_create(const Mesh *mesh, const Interface *interface, FieldFiles *files,
                        Error *err);
void field_files_destroy(FieldFiles *files);

bool field_files_write_bulk(FieldFiles *files, const FieldState *state, const char *path,
                            Error *err);
// line: [field_line_columns][contact_count]: slip rate, displacement along the floor, gap,
// pressure, shear stress, contact density, contact area.
bool field_files_write_line(FieldFiles *files, const double *line, double time, const char *path,
                            Error *err);

#endif
