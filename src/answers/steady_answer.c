// SPDX-License-Identifier: GPL-2.0-or-later
#include "answers/steady_answer.h"

#include <math.h>

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
