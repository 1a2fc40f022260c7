// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk and the interface as ParaView sees them: fields/bulk_*.vtu, fields/interface_*.vtp and
// the fields.pvd that lists them against time, at times the scene chose and where rapid events
// begin, cross and end. Nothing is recovered in between. A Recorder of run/simulation, after
// record/events.
#ifndef AMONTONS_RECORD_FIELDS_H
#define AMONTONS_RECORD_FIELDS_H

#include "bulk/recovery.h"
#include "contact/friction_law.h"
#include "io/field_file.h"
#include "record/events.h"

typedef struct FieldsDef {
    double every_U, every_t;   // 0: not by this; length, time
    bool every_step, at_events;
} FieldsDef;

typedef struct Fields {
    FieldsDef def;
    const char *folder;   // of the result; not owned, like the next four
    const Mesh *mesh;
    const Material *materials;
    const FrictionLaw *law;
    const Events *events;
    NodalStress stress;   // owned, like all that follows
    double *points;   // [stress.point_count * 3]
    double *vectors;   // [stress.point_count * 6] displacement, velocity
    double *displacement, *velocity;   // [nodes * 2] of the whole mesh
    int64_t *offsets, *connectivity;
    uint8_t *cell_types;
    double *line_points;   // [contact_count * 3]
    double *line_values;   // [contact_count * 6]
    int64_t *line_offsets, *line_connectivity;
    uint8_t *line_types;
    int32_t line_count;
    FieldSeriesEntry *entries;   // [entry_count]
    char (*names)[32];   // [entry_count] file names the entries point to
    int32_t entry_count, room;
    int32_t written;   // times written
    double seconds;   // wall time spent
    double next_U, next_t;   // when the next is due
} Fields;

// What is written of the bulk. Nothing is owned.
typedef struct FieldState {
    const double *displacement, *velocity;   // [2 * nodes]
    double time;
} FieldState;

// For single files: no folder, no series. `materials` are set by the caller, also after create.
bool fields_prepare(const Mesh *mesh, const Interface *interface, Fields *fields, Error *err);
// Writes one .vtu; the stresses stay in fields->stress.
bool fields_write_bulk(Fields *fields, const FieldState *state, const char *path, Error *err);

bool fields_create(const FieldsDef *def, const char *folder, const Mesh *mesh,
                   const Interface *interface, Fields *fields, Error *err);
void fields_destroy(Fields *fields);
bool fields_record(void *self, const Observation *seen, Error *err);   // a Recorder
// Which times were written and which are due; files of later times are written over as they come.
bool fields_archive(Fields *fields, Archive *archive, Error *err);

#endif
