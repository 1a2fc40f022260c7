// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/rewind.h"

#include "run/saved_state.h"

#include <string.h>

// `last` needs one state more than slidings, `around` the one before its sliding.
static bool keep(Simulation *simulation, Error *err)
{
    KeptStates *kept = &simulation->kept;
    int32_t room = simulation->window.def.last + 1;
    if (kept->count == room) {
        amontons_state_free(&kept->states[0]);
        kept->count--;
        memmove(kept->states, kept->states + 1, (size_t)kept->count * sizeof(SavedState));
        memmove(kept->times, kept->times + 1, (size_t)kept->count * sizeof(double));
    }
    TRY(saved_state_keep(simulation, &kept->states[kept->count], err));
    kept->times[kept->count++] = simulation->control.now.time;
cleanup:
    return error_is_clean(err);
}

bool rewind_start(Simulation *simulation, Error *err)
{
    const Window *window = &simulation->window;
    bool begins = window_is_sought(window) && !window->again && simulation->kept.count == 0;
    return !begins || keep(simulation, err);
}

// A result that was gone on with to a later end has its last slidings behind it.
static bool stays_inside(const Simulation *simulation, Error *err)
{
    const Window *window = &simulation->window;
    if (window->def.last > 0 && simulation->control.now.time > window->furthest)
        FAIL(err, ERROR_INPUT,
             "output.window.last: the slidings before t = %g were written as the last; a run that "
             "goes further has others (--overwrite begins anew)",
             window->furthest);
cleanup:
    return error_is_clean(err);
}

bool rewind_follow(Simulation *simulation, bool *finished, Error *err)
{
    Window *window = &simulation->window;
    if (!window_is_sought(window)) return true;
    if (window->again) return stays_inside(simulation, err);
    if (window->ended && !window->found) TRY(keep(simulation, err));
    if (*finished) window_close(window, simulation->kept.times[0]);
    if (!window->found) goto cleanup;
    TRY(saved_state_take_back(simulation, &simulation->kept.states[0], err));
    TRY(window_take_back(window, &simulation->seen, err));
    kept_states_destroy(&simulation->kept);
    *finished = false;
cleanup:
    return error_is_clean(err);
}
