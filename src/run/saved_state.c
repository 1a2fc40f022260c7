// SPDX-License-Identifier: GPL-2.0-or-later
// The list is gone through three times: to measure, to write, and later to read (base/archive). In
// front of it stands what it is and of what, behind it a checksum:
//
//     "amontons-state, reduced"  computation  identity  time, end of the history
//     { parts of the state }  checksum
//
// Data that can be made again from the scene is not saved: mesh, matrices, the factors of the
// step-size levels. Data that depends on earlier rounding is saved: factors that the next step may
// use again, the order of sweeps (contact/contact_matrix), products that are carried on
// (stepping/state).
#include "run/simulation_state.h"

#include "base/clock.h"
#include "base/computation.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "base/system.h"
#include "base/transfer.h"
#include "io/files/open_file.h"
#include "io/files/part_file.h"
#include "scene/keys.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const FORMATS[] = {"amontons-state, full mesh", "amontons-state, reduced"};
enum { WORD_SIZE = 32, CHECKSUM_SIZE = HASH_TEXT_SIZE - 1 };

// --- of what ------------------------------------------------------------------------------------

// Returns false for keys that may differ: how far the run goes, what is only shown, and names of
// files whose contents are compared instead.
static bool key_counts(const char *key)
{
    static const char *const free[] = {"title",           "mesh.file",       "friction.file",
                                       "contact.profile", "reduction.cache", "output.figures",
                                       "output.compare"};
    for (size_t k = 0; k < sizeof free / sizeof free[0]; k++)
        if (strcmp(key, free[k]) == 0) return false;
    return strncmp(key, "time.until", strlen("time.until")) != 0;
}

// *found: what the state has in this place, where it is read.
static void pass_word(Archive *archive, const char *word, char found[WORD_SIZE + 1])
{
    memset(found, 0, WORD_SIZE + 1);
    snprintf(found, WORD_SIZE + 1, "%s", word);
    archive_text(archive, found, WORD_SIZE + 1);
}

// A state is known by the sources that compute, too: they say what it means.
static bool archive_head(Simulation *simulation, Archive *archive, SavedHead *head, Error *err)
{
    char format[WORD_SIZE + 1], sources[WORD_SIZE + 1], identity[WORD_SIZE + 1];
    char ours[HASH_TEXT_SIZE];
    Hash computation = computation_hash();
    hash_write(&computation, ours);

    // The identity is of the matrices themselves, not of the mesh file: a reduced state is in
    // coordinates of its basis.
    if (!simulation->identity[0]) {
        const Interface *interface = &simulation->model.interface;
        size_t contacts = (size_t)interface->contact_count, rods = (size_t)interface->rod_count;
        Hash hash = hash_start();
        if (!scene_hash(&simulation->scene, key_counts, &hash, err)) return false;
        bulk_operator_hash(&simulation->model.system, &hash);
        hash_bytes(&hash, interface->x, contacts * sizeof *interface->x);
        hash_bytes(&hash, interface->weight, contacts * sizeof *interface->weight);
        hash_bytes(&hash, interface->pad, contacts * sizeof *interface->pad);
        hash_bytes(&hash, simulation->rod.softness, rods * sizeof *simulation->rod.softness);
        hash_write(&hash, simulation->identity);
    }
    pass_word(archive, FORMATS[simulation->model.reduced.count > 0], format);
    pass_word(archive, ours, sources);
    pass_word(archive, simulation->identity, identity);
    if (archive->failed || (strcmp(format, FORMATS[0]) != 0 && strcmp(format, FORMATS[1]) != 0))
        return REFUSE(err, "it is not a saved state as this version writes it");
    if (strcmp(sources, ours) != 0)
        return REFUSE(err,
                      "it was saved by a build of other sources, which may compute otherwise "
                      "(%.8s, this is %.8s): begin anew with --overwrite, or go on with that build",
                      sources, ours);
    if (strcmp(identity, simulation->identity) != 0)
        return REFUSE(
            err,
            "it is the state of another scene or mesh; only time.until, title and output.figures "
            "may differ (and the reduction must be the one that was made then)");
    *head = (SavedHead){simulation->control.now.time, simulation->history.end};
    archive_number(archive, &head->time);
    history_end_archive(&head->history, archive);
    return true;
}

// --- the list -----------------------------------------------------------------------------------

// in_loop: allocations of the loop of steps. They and wall times are summed over the parts of a
// run; how its basis was come by is told of the first.
static void archive_report(Simulation *simulation, int64_t in_loop, Archive *archive)
{
    double elapsed = clock_seconds() - simulation->started;
    archive_section(archive, "report");
    archive_count(archive, &simulation->relaxation_steps);
    archive_integer(archive, &simulation->resumed);
    archive_numbers_of(archive, &elapsed, &simulation->timing.relax, &simulation->timing.solve,
                       &simulation->timing.output);
    archive_count(archive, &in_loop);
    archive_flag(archive, &simulation->model.from_cache);
    archive_text(archive, simulation->model.cache_note, sizeof simulation->model.cache_note);
    if (!archive_reads(archive)) return;
    simulation->started = clock_seconds() - elapsed;
    simulation->allocations_before = simulation_allocations(simulation) - in_loop;
}

// Lists where the computation stands.
static bool archive_parts(Simulation *simulation, Archive *archive, Error *err)
{
    const Interface *interface = &simulation->model.interface;
    archive_section(archive, "load");
    archive_numbers_of(archive, &simulation->pressure, &simulation->model.scales.load,
                       &simulation->last_unquiet);
    archive_flag(archive, &simulation->mu_above);
    bulk_operator_archive(&simulation->model.system, archive);
    int64_t factorisations = simulation->model.system.factorisations;
    rod_archive(&simulation->rod, archive);
    if (!step_control_archive(&simulation->control, archive, err)) return false;
    simulation->model.system.factorisations = factorisations;   // levels made again do not count

    // A scene that ends elsewhere than the saved one ends where it says itself.
    double end = simulation->t_end;
    double until[] = {simulation->scene.time.until_U, simulation->scene.time.until_t};
    archive_section(archive, "end");
    archive_number(archive, &end);
    archive_numbers(archive, until, 2);
    if (archive_reads(archive)) {
        const Rod *rod = &simulation->rod;
        bool steered = rod->since != 0 || rod->velocity != simulation->scene.rod.velocity;
        bool moved = until[0] != simulation->scene.time.until_U ||
                     until[1] != simulation->scene.time.until_t;
        if (!moved)
            simulation->t_end = end;
        else if (steered)
            simulation->t_end = steering_end(simulation);
    }

    explicit_reference_archive(&simulation->explicit_reference, archive);
    if (!events_archive(&simulation->events, interface, archive, err)) return false;
    if (!drops_archive(&simulation->drops, archive, err)) return false;
    steady_archive(&simulation->steady, archive);
    pads_archive(&simulation->pads, archive);
    contact_arrays_archive(&simulation->contact, archive);
    rotation_archive(&simulation->rotation, archive);
    program_readings_archive(&simulation->readings, archive);

    RunErrors *errors = &simulation->errors;
    archive_section(archive, "errors");
    archive_numbers_of(archive, &errors->energy, &errors->complementarity, &errors->moment,
                       &errors->equation, &errors->penetration, &errors->moment_quasi_static);

    RunWarnings *warnings = &simulation->warnings;
    archive_section(archive, "warnings");
    archive_index(archive, &warnings->count, 0, RUN_WARNINGS_MAX + 1);
    for (int32_t k = 0; k < warnings->count && !archive->failed; k++)
        archive_text(archive, warnings->text[k], RUN_WARNING_SIZE);

    if (simulation->window.def.given) window_archive(&simulation->window, archive);
    return fields_archive(&simulation->fields, archive, err);
}

// --- save and restore ---------------------------------------------------------------------------

// Saves in two passes: the first measures. What it allocates itself is not the loop's.
bool amontons_simulation_save(Simulation *simulation, SavedState *state, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    Archive archive = archive_measure();
    Hash hash = hash_start();
    char checksum[HASH_TEXT_SIZE];
    SavedHead head;
    int64_t before = simulation_allocations(simulation);
    int64_t in_loop = before - simulation->allocations_before;
    *state = (SavedState){0};
    if (!steering_is_open(simulation, err)) return false;
    for (int pass = 0; pass < 2; pass++) {
        TRY(archive_head(simulation, &archive, &head, err));
        TRY(archive_parts(simulation, &archive, err));
        archive_report(simulation, in_loop, &archive);
        if (pass == 1) break;
        state->size = archive.at + CHECKSUM_SIZE;
        TRY((state->bytes = memory_bytes(state->size, err)));
        archive = archive_write(state->bytes, archive.at);
    }
    TRY(archive_check(&archive, true, err));
    hash_bytes(&hash, state->bytes, (size_t)archive.at);
    hash_write(&hash, checksum);
    memcpy((char *)state->bytes + archive.at, checksum, CHECKSUM_SIZE);
cleanup:
    if (!error_is_clean(err)) amontons_state_free(state);
    simulation->allocations_before += simulation_allocations(simulation) - before;
    return error_is_clean(err);
}

// Opens the archive in the state and checks it as a whole.
static bool open_archive(const SavedState *state, Archive *archive, Error *err)
{
    Hash hash = hash_start();
    char checksum[HASH_TEXT_SIZE];
    int64_t size = state->size - CHECKSUM_SIZE;
    if (!state->bytes || size < 0) return REFUSE(err, "it is too short for a saved state");
    hash_bytes(&hash, state->bytes, (size_t)size);
    hash_write(&hash, checksum);
    if (memcmp((const char *)state->bytes + size, checksum, CHECKSUM_SIZE) != 0)
        return REFUSE(err, "it is no saved state, or damaged: its checksum does not hold");
    *archive = archive_read(state->bytes, size);
    return true;
}

bool saved_state_fits(Simulation *simulation, const SavedState *state, SavedHead *head, Error *err)
{
    Archive archive;
    return open_archive(state, &archive, err) && archive_head(simulation, &archive, head, err);
}

// The arrays that a caller sees are those of the step that was saved.
bool amontons_simulation_restore(Simulation *simulation, const SavedState *state, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    Archive archive;
    SavedHead head;
    if (!steering_is_open(simulation, err)) return false;
    TRY(open_archive(state, &archive, err));
    TRY(archive_head(simulation, &archive, &head, err));
    TRY(archive_parts(simulation, &archive, err));
    TRY(history_take_back(&simulation->history, &head.history, err));
    simulation->seen = observe(&simulation->control, &simulation->model.scales);
    TRY(contact_arrays_record(&simulation->contact, &simulation->seen, err));
    archive_report(simulation, 0, &archive);
    TRY(archive_check(&archive, true, err));
cleanup:
    if (!error_is_clean(err)) error_context(err, "the state cannot be put back");
    return error_is_clean(err);
}

bool amontons_state_write(const SavedState *state, const char *path, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    return part_file_put(path, true, state->bytes, state->size, err);
}

// Checked when it is restored.
bool amontons_state_read(const char *path, SavedState *state, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    struct stat status;
    *state = (SavedState){0};
    int descriptor = open_to_read(path, err);
    TRY(descriptor >= 0);
    if (fstat(descriptor, &status) != 0)
        FAIL(err, ERROR_FILE, "cannot read %s: %s", path, strerror(errno));
    // The run that wrote it had all of it in memory, beside the run itself.
    state->size = status.st_size;
    if ((double)state->size > system_memory() / 2)
        FAIL(err, ERROR_INPUT,
             "%s has %.3g GB, more than the state of a run can have on a computer with %.3g GB: it "
             "is damaged, or the run was one of a larger computer",
             path, (double)state->size / 1e9, system_memory() / 1e9);
    TRY((state->bytes = memory_bytes(state->size, err)));
    if (transfer_read(descriptor, state->bytes, state->size, -1) < state->size)
        FAIL(err, ERROR_FILE, "cannot read %s: %s", path, strerror(errno));
cleanup:
    if (descriptor >= 0) close(descriptor);
    if (!error_is_clean(err)) amontons_state_free(state);
    return error_is_clean(err);
}

void amontons_state_free(SavedState *state)
{
    memory_free(state->bytes);
    *state = (SavedState){0};
}
