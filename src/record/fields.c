// SPDX-License-Identifier: GPL-2.0-or-later
// A recorder: at the times that the scene asks for it keeps a copy of the unknowns and of what the
// interface shows; a thread of its own recovers the block from it and writes (record/field_files),
// while the solver goes on. So disks that are slow to confirm a file cost the run nothing until as
// many times wait as there are slots.
//
// The solver's thread owns what says when to write, the writer's the files and the list of them; it
// is idle whenever fields_flush has returned, and before the first time is handed over.
#include "record/fields.h"

#include "base/memory.h"
#include "contact/slip.h"
#include "fem/floor.h"
#include "io/files/folder.h"
#include "record/contact_arrays.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    PATH_SIZE = 1200,
    FIRST_ROOM = 64,
    LIST_EVERY = 16   // times, where the writer never catches up
};

// --- the writer's thread -------------------------------------------------------------------------

// Vectors of a time: displacement, velocity, and one for each shape of the materials' branches.
static int32_t vectors_of(const Fields *fields)
{
    return 2 + fields->files.spectrum->shape_count;
}

// The list is written anew whenever no other time waits: a run that is cut off leaves one that
// opens. A Worker calls this.
static bool write_time(void *self, int32_t slot, int32_t waiting, Error *err)
{
    Fields *fields = self;
    const FieldTimeCopy *copy = &fields->slots[slot];
    char path[PATH_SIZE];
    FieldState state = {.displacement = copy->whole[0],
                        .velocity = copy->whole[1],
                        .relaxing = (const double *const *)copy->whole + 2,
                        .time = copy->time};

    // The mesh in all times that wait: its modes, tens of megabytes, come from memory once for
    // them.
    if (fields->recovered == 0) {
        const double *unknowns[(2 + SPECTRUM_SHAPES_MAX) * FIELD_SLOTS] = {NULL};
        double *whole[(2 + SPECTRUM_SHAPES_MAX) * FIELD_SLOTS] = {NULL};
        int32_t each = vectors_of(fields), all = each * waiting;
        for (int32_t k = 0; k < all; k++) {
            const FieldTimeCopy *one = &fields->slots[(slot + k / each) % FIELD_SLOTS];
            unknowns[k] = one->unknowns[k % each];
            whole[k] = one->whole[k % each];
        }
        fields->recovered = waiting;
        TRY(bulk_operator_recover(fields->system, all, unknowns, whole, err));
        for (int32_t k = 0; k < all; k++) floor_displace(fields->files.mesh, whole[k]);
    }
    fields->recovered--;

    // Its two files, and the list.
    int32_t number = fields->listed;
    snprintf(path, sizeof path, "%s/fields/" FIELD_BULK_NAME, fields->folder, number);
    TRY(field_files_write_bulk(&fields->files, &state, path, err));
    snprintf(path, sizeof path, "%s/fields/" FIELD_LINE_NAME, fields->folder, number);
    TRY(field_files_write_line(&fields->files, copy->line, copy->time, path, err));
    fields->times[fields->listed++] = copy->time;
    snprintf(path, sizeof path, "%s/fields.pvd", fields->folder);
    if (waiting == 1 || fields->listed % LIST_EVERY == 0)
        TRY(field_file_write_pvd(path, fields->times, fields->listed, err));
cleanup:
    return error_is_clean(err);
}

// --- the solver's thread -------------------------------------------------------------------------

// folder, mesh and what is in `def` are borrowed. The first record is always due: next_U and next_t
// lie before everything.
bool fields_create(const FieldsDef *def, const char *folder, const Mesh *mesh,
                   const Interface *interface, Fields *fields, Error *err)
{
    *fields = (Fields){.def = *def, .folder = folder, .room = FIRST_ROOM};
    fields->next_U = fields->next_t = -INFINITY;   // the start is written in any case
    if (!field_files_create(mesh, interface, &fields->files, err)) return false;
    if (!(fields->times = NEW_ARRAY(double, FIRST_ROOM, err))) return false;
    return folder_make_inside(folder, "fields", err);
}

void fields_destroy(Fields *fields)
{
    worker_destroy(fields->writer);
    for (int32_t k = 0; k < FIELD_SLOTS; k++) memory_free(fields->slots[k].storage);
    field_files_destroy(&fields->files);
    memory_free(fields->times);
    *fields = (Fields){0};
}

bool fields_flush(Fields *fields, Error *err)
{
    return worker_wait(fields->writer, err);
}

// Makes room for one more time. The writer must be idle where there is none.
static bool make_room(Fields *fields, Error *err)
{
    if (fields->written < fields->room) return true;
    if (!fields_flush(fields, err)) return false;
    return memory_grow(&fields->times, fields->written, &fields->room, sizeof(double), err);
}

// A multiple of `every` was reached or passed: *next is the one beyond. 0: not by this.
static bool passes(double every, double at, double *next)
{
    if (!(every > 0 && at >= *next)) return false;
    *next = (floor(at / every) + 1) * every;
    return true;
}

// Multiples of every_U and every_t, at the first step at or beyond each; a step that passes several
// is written once. With every_slip also each time the fastest point has slipped so far: where slip
// is rapid, steps of a time or of U would leave all of it out. With at_events also steps in which a
// rapid event begins, crosses the interface or ends.
static bool is_due(Fields *fields, const Observation *seen)
{
    // U has come back over the multiple of every_U at or beyond which a file was written last; not
    // by rounding, as a rod that is held on it would.
    double reached = fields->next_U - fields->def.every_U;
    if (seen->U < reached - 1e-6 * fields->def.every_U) fields->next_U = -INFINITY;

    bool by_U = passes(fields->def.every_U, seen->U, &fields->next_U);
    bool by_t = passes(fields->def.every_t, seen->t, &fields->next_t);
    bool due = fields->written == 0 || fields->def.every_step || by_U || by_t;
    fields->slipped += seen->max_slip_rate * seen->step_size;
    if (fields->def.every_slip > 0 && fields->slipped >= fields->def.every_slip) due = true;
    const Events *events = fields->events;
    bool happens = events->began || events->crossed || events->ended;
    due = due || (fields->def.at_events && happens);
    if (due) fields->slipped = 0;
    return due;
}

// A run that is killed keeps every file that was written, each whole (io/files/part_file).
bool fields_record(void *self, const Observation *seen, Error *err)
{
    Fields *fields = self;
    const State *state = seen->state;
    size_t bytes = (size_t)state->dof_count * sizeof(double);
    int32_t slot;
    if (!is_due(fields, seen)) return true;

    // The writer starts at the first time that is written: until then nobody knows the system.
    if (!fields->writer) {
        const Mesh *mesh = fields->files.mesh;
        int64_t dofs = seen->system->dof_count, whole = (int64_t)mesh->dim * mesh->node_count;
        int64_t line = (int64_t)field_line_columns(mesh->dim - 1) * seen->interface->contact_count;
        WorkerDef def = {.slots = FIELD_SLOTS, .work = write_time, .context = fields};
        int32_t each = vectors_of(fields);
        fields->system = seen->system;
        for (int32_t k = 0; k < FIELD_SLOTS; k++) {
            FieldTimeCopy *copy = &fields->slots[k];
            if (!copy->storage)
                copy->storage = memory_bytes(8 * (each * (dofs + whole) + line), err);
            if (!copy->storage) return false;
            double *next = copy->storage;
            for (int which = 0; which < each; which++, next += dofs) copy->unknowns[which] = next;
            for (int which = 0; which < each; which++, next += whole) copy->whole[which] = next;
            copy->line = next;
        }
        if (!worker_create(&def, &fields->writer, err)) return false;
    }
    if (!make_room(fields, err)) return false;
    if (!worker_slot(fields->writer, &slot, err)) return false;

    // A copy for the writer: displacement, velocity, and what the branches of each shape have
    // stretched.
    FieldTimeCopy *copy = &fields->slots[slot];
    copy->time = seen->t;
    memcpy(copy->unknowns[0], state->displacement, bytes);
    memcpy(copy->unknowns[1], state->velocity, bytes);
    const Spectrum *spectrum = fields->files.spectrum;
    for (int32_t j = 0; j < spectrum->shape_count; j++) {
        double *sum = copy->unknowns[2 + j];
        memset(sum, 0, bytes);
        for (int32_t k = 0; k < state->branch_count; k++)
            for (int32_t d = 0; d < state->dof_count; d++)
                sum[d] += spectrum->share[k][j] * state->stretch[(int64_t)k * state->dof_count + d];
    }

    // The line of the contact, [field_line_columns][contact_count]. The law is asked here: a
    // plug-in need not be safe elsewhere.
    const Interface *interface = seen->interface;
    const int32_t *dofs = seen->system->interface_dofs;
    int64_t count = interface->contact_count, tangents = interface->dim - 1;
    double *rate = copy->line, *moved = rate + tangents * count, *gap = moved + tangents * count;
    double *pressure = gap + count, *shear = pressure + count, *density = shear + tangents * count;
    double *area = density + count;
    for (int32_t i = 0; i < count; i++) {
        int32_t n = interface_normal(interface, i);
        for (int32_t d = 0; d < tangents; d++) {
            int32_t t = interface_tangent(interface, i) + d;
            rate[d * count + i] = state->slip_rate[t];
            moved[d * count + i] = state->displacement[dofs[t]];
            shear[d * count + i] = -state->reaction[t] / interface->weight[i];
        }
        gap[i] = state->displacement[dofs[n]] + interface_gap(interface, i);
        pressure[i] = state->reaction[n] / interface->weight[i];
        density[i] = state->status[i] == CONTACT_OPEN
                         ? 0
                         : friction_contact_density(friction_at(fields->friction, i),
                                                    slip_size(interface, i, state->slip_rate));
        area[i] = seen_contact_area(seen, fields->friction, i);
    }
    worker_submit(fields->writer);
    fields->written++;
    return true;
}

// Without a folder there is no list: what a state with fields has of it is passed over. Times are
// in a state once they are on the disk.
bool fields_archive(Fields *fields, Archive *archive, Error *err)
{
    int32_t written = fields->written;
    if (!fields_flush(fields, err)) return false;
    archive_section(archive, "fields");
    archive_integer(archive, &written);
    archive_numbers_of(archive, &fields->next_U, &fields->next_t, &fields->slipped);
    if (archive_reads(archive)) fields->written = fields->listed = 0;
    for (int32_t k = 0; k < written && !archive->failed; k++) {
        double time = archive_reads(archive) ? NAN : fields->times[k];
        archive_number(archive, &time);
        if (!archive_reads(archive) || !fields->folder) continue;
        if (!make_room(fields, err)) return false;
        fields->times[fields->listed++] = time;
        fields->written++;
    }
    return true;
}
