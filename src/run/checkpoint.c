// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/simulation_state.h"

#include "base/child_process.h"
#include "base/clock.h"
#include "run/warnings.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

static const double EVERY = 10;   // s of wall time
static const double SHARE = 0.01;   // of the time that checkpoints may take, where they are large

// CHECK_SECONDS: of processor time to read a history's single numbers, far above what it takes.
enum { PATH_SIZE = AMONTONS_PATH_SIZE + 32, CHECK_SECONDS = 600 };

static void find_path(const char *folder, char path[PATH_SIZE])
{
    snprintf(path, PATH_SIZE, "%s/%s", folder, CHECKPOINT_FILE);
}

// Runs on several meshes do not go on from one state.
bool checkpoint_is_kept(const Simulation *simulation)
{
    return result_folder_is_settled(&simulation->folder) && !(simulation->scene.accuracy.mu > 0) &&
           simulation->options.checkpoint_every >= 0;
}

bool checkpoint_now(Simulation *simulation, Error *err)
{
    char path[PATH_SIZE];
    SavedState state = {0};
    double started = clock_seconds();
    find_path(simulation->folder.path, path);
    TRY(history_sync(&simulation->history, err));
    TRY(fields_flush(&simulation->fields, err));
    TRY(amontons_simulation_save(simulation, &state, err));
    TRY(amontons_state_write(&state, path, err));
cleanup:
    amontons_state_free(&state);
    simulation->checkpoint_at = clock_seconds();
    simulation->checkpoint_cost = simulation->checkpoint_at - started;
    simulation->timing.output += simulation->checkpoint_cost;
    return error_is_clean(err);
}

void checkpoint_when_due(Simulation *simulation)
{
    double asked = simulation->options.checkpoint_every;
    double since = clock_seconds() - simulation->checkpoint_at;
    double every = asked > 0 ? asked : fmax(EVERY, simulation->checkpoint_cost / SHARE);
    if (since < every) return;
    if (!checkpoint_is_kept(simulation)) return;
    Error failed = {0};
    if (checkpoint_now(simulation, &failed) || simulation->checkpoint_failed) return;
    warnings_add(&simulation->warnings, "a checkpoint could not be written: %s", failed.message);
    simulation->checkpoint_failed = true;
}

bool checkpoint_at_end(Simulation *simulation, Error *err)
{
    char path[PATH_SIZE];
    if (!result_folder_is_settled(&simulation->folder)) return true;
    if (checkpoint_is_kept(simulation) && simulation->history.file)
        return checkpoint_now(simulation, err);
    find_path(simulation->folder.path, path);
    unlink(path);
    return true;
}

bool checkpoint_read(const char *folder, SavedState *state, Error *err)
{
    char path[PATH_SIZE];
    find_path(folder, path);
    if (access(path, F_OK) != 0)
        return REFUSE(err,
                      "%s has no %s to go on from: the run ended before its first one, or wrote "
                      "none; say --overwrite to begin anew",
                      folder, CHECKPOINT_FILE);
    return amontons_state_read(path, state, err);
}

typedef struct HistoryCheck {
    const char *folder;
    const HistoryEnd *end;
} HistoryCheck;

static bool check_history(void *context, FILE *reply, Error *err)
{
    const HistoryCheck *check = context;
    (void)reply;   // it says no more than its error
    ArrayFile *file = result_file_open(check->folder, err);
    bool fits = file && history_has_end(file, check->end, err);
    array_file_abandon(file);
    return fits;
}

// In a child process, as the history may be a stranger's, and one that HDF5 crashes on. What the
// child has read is then opened here, to be gone on with.
bool checkpoint_check_history(const char *folder, const HistoryEnd *end, Error *err)
{
    HistoryCheck check = {folder, end};
    ChildWork work = {.path = folder,
                      .reader = "HDF5",
                      .seconds = CHECK_SECONDS,
                      .advice = "its history is damaged",
                      .read = check_history,
                      .context = &check};
    if (child_do(&work, err)) return true;
    err->code = ERROR_INPUT;
    error_context(err, "the history cannot be gone on with (--overwrite begins anew)");
    return false;
}
