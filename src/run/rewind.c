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
    if (!saved_state_keep(simulation, &kept->states[kept->count], err)) return false;
    kept->times[kept->count++] = simulation->control.now.time;
    return true;
}

// Always false.
static bool refuse_other_end(Error *err)
{
    return REFUSE(err, "output.window.last is counted back from the end of the run, and so far it "
                       "had another one (--overwrite begins anew)");
}

// The last steps of a run are cut to its end. With a later one, states from before it would lead to
// other steps there: the run can be taken back to that end at the most.
bool rewind_start(Simulation *simulation, Error *err)
{
    const Window *window = &simulation->window;
    if (!window_is_sought(window)) return true;
    bool moved = simulation->goes_on && simulation->end_moved;
    if (moved && window->def.last > 0) return refuse_other_end(err);
    if (moved) kept_states_destroy(&simulation->kept);
    return window->again || simulation->kept.count > 0 || keep(simulation, err);
}

bool rewind_follow(Simulation *simulation, bool *finished, Error *err)
{
    Window *window = &simulation->window;
    if (!window_is_sought(window)) return true;
    bool goes_further = window->again && simulation->control.now.time > window->furthest;
    if (goes_further && window->def.last > 0) return refuse_other_end(err);
    if (window->again) return true;
    if (window->ended && !window->found && !keep(simulation, err)) return false;
    if (*finished) window_close(window, simulation->kept.times[0]);
    if (!window->found) return true;
    if (!saved_state_take_back(simulation, &simulation->kept.states[0], err)) return false;
    if (!window_take_back(window, &simulation->seen, err)) return false;
    kept_states_destroy(&simulation->kept);
    *finished = false;
    return true;
}
