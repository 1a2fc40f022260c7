// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons static`: one equilibrium, with the sums by which a user can judge it.
#include "cli/commands.h"
#include "cli/say.h"
#include "cli/options.h"

#include <math.h>

// Units of a force, an energy and a moment, in the plane each per width, and of a length; empty:
// normalised.
typedef struct Units {
    const char *force, *energy, *moment, *length;
} Units;

// Without -o nothing is written: the lines printed are all.
int command_static(const Command *command, int argc, char **argv)
{
    SceneWords words = {0};
    Error err = {0};
    Scene *scene = NULL;
    StaticSummary summary;
    static const Option no_options[] = {{0}};
    static const Units plane = {" N/m", " J/m", " N", " m"}, space = {" N", " J", " N m", " m"},
                       none = {"", "", "", ""};
    int status = scene_words_read(command, no_options, argc, argv, &words);
    if (status == 0) status = scene_words_open(&words, &scene);
    if (status != 0) return status;
    stop_on_signals();
    bool done = amontons_static(scene, words.folder, words.overwrite, &summary, &err);
    if (!done || words.quiet) goto cleanup;

    // Sums, and last the balances by which to judge them.
    const char *title = amontons_scene_title(scene);
    bool is_si = amontons_scene_is_si(scene);
    Units unit = !is_si ? none : summary.dim == 2 ? plane : space;
    double tangential = summary.rod_nodes > 0 ? summary.rod_force : -summary.shear_force;

    say("%s\n\n", *title ? title : "equilibrium");
    say("  contact        %d nodes: %d stick, %d slip, %d open\n", summary.contact_nodes,
        summary.sticking, summary.slipping, summary.open);
    say("  on the block   F_z %.6g%s, F_x %.6g%s from the floor, moment of the pressure %.6g%s\n",
        summary.normal_force, unit.force, summary.shear_force, unit.force, summary.pressure_moment,
        unit.moment);
    if (summary.rod_nodes > 0) {
        say("  rod            %.6g%s on %d nodes", summary.rod_force, unit.force,
            summary.rod_nodes);
        if (!isnan(summary.rod_height))   // it pushes
            say(", resultant at z = %.6g%s", summary.rod_height, unit.length);
        say("\n");
    }
    if (summary.normal_force > 0)
        say("  load ratio     F_T/F_N %.6g, F_T that of the %s\n",
            tangential / summary.normal_force, summary.rod_nodes > 0 ? "rod" : "floor against +x");
    say("  energy         elastic %.6g%s, work of the loads %.6g%s\n", summary.elastic_energy,
        unit.energy, summary.load_work, unit.energy);
    say("  errors         equations %.1e, forces %.1e, moments %.1e, contact %.1e\n",
        summary.residual, summary.force_balance, summary.moment_balance, summary.complementarity);
    say("  units          %s%s\n", is_si ? "SI" : "those of the scene (normalised)",
        summary.dim == 2 ? ", per width" : "");
    if (words.folder) say("  results        %s\n", words.folder);
cleanup:
    amontons_scene_destroy(scene);
    return done ? 0 : report_error(&err);
}
