// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/steady.h"

#include <math.h>

// Range of mu, relative to mu: twice the error that the steps of a standard run leave.
static const double STEADY_RANGE = 2e-3;

static const Estimate NONE = {NAN, NAN};

Steady steady_of(const Events *events, double way)
{
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

void steady_answer(const Steady *steady, Answers *answers)
{
    answers->steady = answers->peaks_counted == 0 && !isnan(steady_mu(steady).value);
    if (!answers->steady) return;
    answers->mu_M = steady_mu(steady);
    answers->mu_M_parts = (ErrorParts){NAN, NAN, answers->mu_M.error};
}

const char *steady_words(const Steady *steady, const Answers *answers)
{
    if (!steady->events) return "none: the run failed before its first step";
    if (answers->steady) return "steady sliding";
    if (!isnan(answers->mu_M.value)) return "peaks";
    if (steady->slides) return "none: the block slides slowly, and F_T/F_N is not steady yet";
    if (answers->peaks > 0)
        return "none: what slidings of the whole block there were belong to the start or run-in";
    if (steady->events->kinds[EVENT_LEADING] > 0)
        return "none: the block slid from the start on, and not once from rest";
    if (answers->regime.count > 0) return "none: only parts of the block slid in this run";
    return "none: the block as a whole did not slide in this run";
}

void steady_write_json(const Steady *steady, const Answers *answers, JsonWriter *json)
{
    Estimate mu = steady_mu(steady);
    json_text(json, "mu_M_is", steady_words(steady, answers));
    json_numbers_of(json, {"mu_steady", mu.value}, {"mu_steady_error", mu.error},
                    {"mu_steady_from_U", isnan(mu.value) ? NAN : steady->from});
}

void steady_archive(Steady *steady, Archive *archive)
{
    archive_section(archive, "steady");
    archive_flag(archive, &steady->slides);
    archive_numbers_of(archive, &steady->from, &steady->to, &steady->low, &steady->high,
                       &steady->sum, &steady->before.value, &steady->before.error);
}
