// SPDX-License-Identifier: GPL-2.0-or-later
// A simulation from its first step to its report, and what ends it before the scene does.
#include "run/simulation_state.h"

#include "run/checkpoint.h"
#include "run/rewind.h"
#include "run/summary.h"

#include <math.h>

bool simulation_loop(Simulation *simulation, Error *err)
{
    Error unseen = {0}, lost = {0};
    bool finished = simulation->goes_on && simulation_is_finished(simulation);
    if (!rewind_start(simulation, err)) return false;
    while (!finished) {
        if (!amontons_simulation_step(simulation, NULL, &finished, err)) return false;
        if (!rewind_follow(simulation, &finished, err)) return false;
        checkpoint_when_due(simulation);
        if (simulation_may_go_on(simulation, &unseen)) continue;

        // Stopped. It says what is kept only where it is.
        bool asked = checkpoint_is_kept(simulation);
        bool kept = asked && checkpoint_now(simulation, &lost);
        const char *folder = simulation->folder.path;
        double U = simulation->seen.U, t = simulation->seen.t;
        if (asked && !kept)
            return FAULT(err, ERROR_INTERRUPT,
                         "stopped at U = %g (t = %g); this state is not kept: %s", U, t,
                         lost.message);
        return FAULT(err, ERROR_INTERRUPT, "stopped at U = %g (t = %g)%s%s%s", U, t,
                     *folder ? "; what was computed is kept in " : "", folder,
                     kept ? "; the same command with --resume goes on from there" : "");
    }
    return true;
}

// The loop itself allocates nothing but levels and output. A failure anywhere is written into
// run.json with what there was until then.
bool simulation_run(const Scene *scene, const RunOptions *options, RunSummary *summary, Error *err)
{
    Simulation *simulation = NULL;
    *summary = summary_none();
    TRY(amontons_simulation_create(scene, options, &simulation, err));
    TRY(simulation_loop(simulation, err));
    TRY(amontons_simulation_finish(simulation, summary, err));
cleanup:
    simulation_end(simulation, summary, err);
    return error_is_clean(err);
}

void simulation_end(Simulation *simulation, RunSummary *summary, const Error *err)
{
    if (simulation && !error_is_clean(err)) {
        Error second = {0};   // the first error is the one that counts
        simulation_finish(simulation, err, summary, &second);
    }
    amontons_simulation_destroy(simulation);
}
