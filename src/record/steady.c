// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/steady.h"

#include <math.h>

// Range of mu, relative to mu: twice the error that the steps of a standard run leave.
static const double STEADY_RANGE = 2e-3;

static const Estimate NONE = {NAN, NAN};

Steady steady_of(const Events *events, double way, double fading)
{
    way = fmax(way, -log(STEADY_RANGE) * fading);
    return (Steady){.events = events, .way = way, .from = NAN, .to = NAN, .before = NONE};
}

static bool all_slips(const Steady *steady, const Observation *seen)
{
    int32_t slipping = 0;
    for (int32_t i = 0; i < seen->interface->contact_count; i++) {
        if (seen_status(seen, i) == CONTACT_STICK) return false;
        slipping += status_slips(seen->state->status[i]);
    }
    return slipping > 0 && steady->events->rapid < 0;
}

// Mean of mu over the way since `from`, if it is long enough.
static Estimate since(const Steady *steady)
{
    double way = steady->to - steady->from;
    if (!steady->slides || !(way > 0 && way >= steady->way)) return NONE;
    return (Estimate){steady->sum / way, 0.5 * (steady->high - steady->low)};
}

// Where slip begins, or mu leaves the range, it is counted anew from here; in the latter case what
// it was before stands until the way is long enough again.
bool steady_record(void *self, const Observation *seen, Error *err)
{
    (void)err;
    Steady *steady = self;
    double low = fmin(steady->low, seen->mu), high = fmax(steady->high, seen->mu);
    bool keeps = high - low <= STEADY_RANGE * fabs(high);
    bool goes_on = steady->slides && seen->U >= steady->to && all_slips(steady, seen);
    steady->before = goes_on && !keeps ? since(steady) : goes_on ? steady->before : NONE;
    steady->slides = all_slips(steady, seen);
    if (!goes_on || !keeps) {
        steady->from = steady->to = seen->U;
        steady->low = steady->high = seen->mu;
        steady->sum = 0;
        return true;
    }
    steady->sum += seen->mu * (seen->U - steady->to);
    steady->to = seen->U;
    steady->low = low;
    steady->high = high;
    return true;
}

Estimate steady_mu(const Steady *steady)
{
    Estimate now = since(steady);
    return isnan(now.value) ? steady->before : now;
}

void steady_archive(Steady *steady, Archive *archive)
{
    archive_section(archive, "steady");
    archive_flag(archive, &steady->slides);
    archive_numbers_of(archive, &steady->from, &steady->to, &steady->low, &steady->high,
                       &steady->sum, &steady->before.value, &steady->before.error);
}
