// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk and the interface as ParaView sees them: fields/bulk_*.vtu, fields/interface_*.vtp and
// the fields.pvd that lists them against time, at times the scene chose and where rapid events
// begin, cross and end. Nothing is recovered in between. A Recorder of run/simulation, after
// record/events.
#ifndef AMONTONS_RECORD_FIELDS_H
#define AMONTONS_RECORD_FIELDS_H

#include "base/worker.h"
#include "friction/friction.h"
#include "record/events.h"
#include "record/field_files.h"

typedef struct FieldsDef {
    double every_U, every_t;   // 0: not by this; length, time
    bool every_step, at_events;
    double every_slip;   // of the fastest point of the contact, length; 0: not by this
} FieldsDef;

enum { FIELD_SLOTS = 8 };

// Data of one time that the writer needs.
typedef struct FieldTimeCopy {
    double *storage;   // of all that follows; owned
    // [dof_count] displacement and velocity of the system that is stepped, and what the branches of
    // each shape are stretched by (fem/recovery).
    double *unknowns[2 + SPECTRUM_SHAPES_MAX];
    double *whole[2 + SPECTRUM_SHAPES_MAX];   // [dim * nodes] of the mesh: the writer's
    double *line;   // [field_line_columns * contact_count]
    double time;
} FieldTimeCopy;

typedef struct Fields {
    FieldsDef def;
    const char *folder;   // of the result; not owned, like the next two
    const Friction *friction;
    const Events *events;
    FieldFiles files;   // owned, like all that follows
    Worker *writer;   // NULL until the first time is written
    FieldTimeCopy slots[FIELD_SLOTS];
    const BulkOperator *system;   // not owned; set with the writer
    int32_t recovered;   // the writer's: slots from the next on whose mesh is recovered
    double *times;   // [listed] of the files that are written
    int32_t listed, room;   // room: times there is room for
    int32_t written;   // times written or handed to the writer
    double next_U, next_t;   // when the next is due
    double slipped;   // of the fastest point, since the last; length
} Fields;

bool fields_create(const FieldsDef *def, const char *folder, const Mesh *mesh,
                   const Interface *interface, Fields *fields, Error *err);
void fields_destroy(Fields *fields);   // writes what was handed over first
// A Recorder. What an earlier time failed of (a full disk) is said here, or by fields_flush.
bool fields_record(void *self, const Observation *seen, Error *err);
bool fields_flush(Fields *fields, Error *err);   // until every file and the list are on the disk
// Lists which times were written and which are due; files of later times are written over as they
// come.
bool fields_archive(Fields *fields, Archive *archive, Error *err);

#endif
