// SPDX-License-Identifier: GPL-2.0-or-later
// Explains the numbers of a path in sentences: which pad decides and at which mu, whether it does
// so alone, what would hold it, and why a run of the same scene may differ.
#include "study/stability/stability.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static const double TAKES_PART = 0.1;   // in the mode, over the pad that does most
static const double EARLIER = 1e-3;   // mu, relative: less is the same moment

// There is room for each of the sentences below once.
__attribute__((format(printf, 2, 3))) static void say(StabilitySummary *summary, const char *format,
                                                      ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(summary->why[summary->why_count++], STABILITY_WHY_SIZE, format, arguments);
    va_end(arguments);
}

// "contact_2", or "the contact" where there is one.
static const char *name_of(const StabilitySummary *summary, int32_t pad)
{
    return summary->pad_count > 1 ? summary->pads[pad].name : "the contact";
}

void stability_explain(const StabilityPath *path, StabilitySummary *summary)
{
    const Interface *interface = &path->model->interface;
    const StabilityPad *pad = &summary->pads[summary->pad];
    const char *name = name_of(summary, summary->pad);
    double slips = pad->slipping / pad->length, steady = summary->steady_contact;
    char length[120] = "", others[160] = "";
    size_t used = 0;
    if (path->options->at_end) return;

    // Say which pad runs away, and at which mu.
    if (path->grows && summary->pad_count == 1 && interface->dim > 2)
        say(summary,
            "Slip runs away when %.2f of the contact slips, its front at %.3f L along the middle, "
            "at mu %.4f.",
            summary->area_c_rod, summary->l_c_rod, summary->mu_rod);
    else if (path->grows && summary->pad_count == 1)
        say(summary, "Slip runs away when its front has come to %.3f L, at mu %.4f.",
            summary->l_c_rod, summary->mu_rod);
    else if (path->grows && slips > 1 - 1e-9)
        say(summary, "Slip runs away once all of %s slips, at mu %.4f.", name, summary->mu_rod);
    else if (path->grows)
        say(summary, "Slip runs away on %s when %.2f of it slips, at mu %.4f.", name, slips,
            summary->mu_rod);
    else if (path->at_end)
        say(summary,
            "Nothing runs away before all of the contact slips: it then slides, at mu %.4f.",
            summary->mu_rod);
    else
        say(summary, "The path ended before anything ran away.");

    // Say if it runs away alone, unless friction remembers.
    if (path->grows && !path->nodes) {
        // Names of all that take part in the mode but the one that decides: "contact_1, contact_3".
        for (int32_t p = 0; p < summary->pad_count && used < sizeof others; p++) {
            if (p == summary->pad || summary->pads[p].mode < TAKES_PART) continue;
            used += (size_t)snprintf(others + used, sizeof others - used, "%s%s",
                                     used > 0 ? ", " : "", summary->pads[p].name);
        }
        if (!(pad->load >= 1) && *others)
            say(summary,
                "It cannot run away alone (weakening is %.2f of what it resists): slip of %s takes "
                "part.",
                pad->load, others);
        else if (!(pad->load >= 1))
            say(summary,
                "With pressures held weakening would be only %.2f of what it resists: it runs away "
                "as slip takes pressure off it.",
                pad->load);
        else if (steady >= pad->length)   // it runs away alone: on which contact it would not
            say(summary,
                "With its load spread evenly, slip on this pad would be steady: a part of it "
                "carries more than its mean pressure of %.3g.",
                pad->pressure);
        else if (steady > 0)
            say(summary,
                "A contact shorter than %.2g (%.2f of this pad) at the same mean pressure, %.3g, "
                "would not run away: nothing grows on it.",
                steady, steady / pad->length, pad->pressure);
    }

    // Friction that remembers: how stiff a body must be, and on which length slip begins.
    if (!isnan(summary->nucleation_length))
        snprintf(length, sizeof length,
                 " Slip that all else holds grows on a part longer than %.3g (nucleation length).",
                 summary->nucleation_length);
    if (path->nodes && !isnan(pad->critical_stiffness))
        say(summary,
            "Slip of a massless body at V is steady on a stiffness above %.3g (critical); that of "
            "%s, all else held, is %.3g.%s",
            pad->critical_stiffness, name, pad->stiffness, length);

    // A run may show oscillations and jumps before.
    if (summary->mu_sc < summary->mu_rod * (1 - EARLIER))
        say(summary,
            "From mu %.4f on (l_sc) oscillations grow, at first too slowly for this V: precursors "
            "may come in bursts, and a run may slide somewhat earlier.",
            summary->mu_sc);
    if (summary->mu_snap < summary->mu_rod * (1 + EARLIER))
        say(summary,
            "At mu %.4f a node of %s, at x = %.4g, reaches mu_S and has no slow state to go on to: "
            "it slips fast at once, whatever grows, and a run may slide there.",
            summary->mu_snap, name_of(summary, interface->pad[path->snap_node]),
            interface->x[path->snap_node]);
    if (summary->l_c_scan < summary->l_sc - summary->element)
        say(summary, "l_c (scan) is shorter than l_sc as it leaves out that slip shifts pressure, "
                     "which here steadies it.");
}
