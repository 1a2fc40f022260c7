// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons render`: pictures of a stored result, or of a plot that a file describes; the ending of
// the name tells which. `amontons compare`: measurements beside a stored result, each figure that
// shows what was measured, and the misfit.
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/say.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 1200, WORDS_SIZE = 2000 };

// The module that draws them checks the figures: it knows which there are.
int command_render(const Command *command, int argc, char **argv)
{
    const char *from = NULL, *plot = NULL;
    bool no_title = false;
    OptionWords figures = {0};
    PictureRequest request = {.style = {.format = "png"}};
    Error err = {0};
    const Option options[] = {
        {"figure", 'f', "NAME",
         "Draw only this picture: force, slip-map, contact-density, contact-area (over that at "
         "rest), state-map (of friction that remembers), contact-plane (of a block in space), "
         "precursors (slip over F_T/F_N), front-speed, probes, pads (which lets go first), profile "
         "(p, tau, slip and gap along x), field or field-strip (up to six frames of one sliding). "
         "May be given often; without it those that the result has fields, events, states or "
         "--compare has data for",
         .words = &figures},
        {"panels", 0, "NAME,NAME",
         "Draw these of force, slip-map, contact-density, contact-area and state-map below each "
         "other, as panels.png",
         .word = &request.panels},
        {"format", 0, "png|pdf|svg", "Of the files; png by default", .word = &request.style.format},
        option_pictures(&request.style, TAKEN_BY_FIGURES),
        {"no-title", 0, NULL, "As --title none", .flag = &no_title},
        {"plot", 0, "PLOT", "Of a sweep: draw this, as in '{x: load.pressure, y: mu_M}'",
         .word = &plot},
        {"of", 0, "FIELD",
         "What `field` shows: von_mises (default), stress_xx, stress_zz, stress_xz, pressure, "
         "velocity, displacement, strain_energy or dissipation; "
         "`contact-plane`: slip_rate (default), contact_density, pressure, shear, "
         "shear_over_pressure, slip, gap, arrival or a state by its name, as in theta; `probes`: "
         "strain (default), stress, displacement, velocity",
         .word = &request.field.of},
        {"at", 0, "U=U",
         "When: the stored time nearest to it; or t=TIME. Of contact-plane and profile several, as "
         "in U=0.01,U=0.02; of profile also mu=0.2, where F_T/F_N rises through it",
         .word = &request.field.at},
        {"cut", 0, "y=Y",
         "Cut a block in space open: what lies before this plane, or before up to three as in "
         "x=0.2,y=0.25, is taken away",
         .word = &request.field.cut},
        {"edges", 0, NULL, "Draw the elements' edges in `field`", .flag = &request.field.edges},
        {"dark", 0, NULL, "Light lines on dark paper", .flag = &request.style.dark},
        option_overwrite(&request.style.overwrite),
        {0}};
    int status = options_read(command, options, argc, argv, &from);
    if (status != 0) return status;
    if (no_title) request.style.title = "none";

    // A plot is a description, also one that a sweep leaves: JSON is YAML.
    char path[PATH_SIZE];
    const char *dot = strrchr(from, '.');
    bool of_plot = dot && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".json") == 0);
    bool of_sweep = snprintf(path, sizeof path, "%s/sweep.h5", from) < (int)sizeof path &&
                    access(path, R_OK) == 0;
    if ((figures.count || request.panels) && (of_plot || of_sweep))
        return report_misuse("%s has no meaning for a plot or a sweep",
                             figures.count ? "--figure" : "--panels");
    const FieldChoice *field = &request.field;
    if ((field->of || field->at || field->cut || field->edges) && (of_plot || of_sweep))
        return report_misuse("--%s has no meaning for a plot or a sweep", field->of    ? "of"
                                                                          : field->at  ? "at"
                                                                          : field->cut ? "cut"
                                                                                       : "edges");
    if (figures.count && request.panels) return report_misuse("--figure and --panels: one of them");
    if (plot && !of_sweep)
        return report_misuse("--plot has a meaning for the folder of a sweep alone");
    if (of_plot && !of_sweep) {   // fig2a.yaml becomes fig2a.png
        int stem = (int)(dot - from);
        if (stem + 5 > (int)sizeof path) return report_misuse("the path of the plot is too long");
        snprintf(path, sizeof path, "%.*s.%.3s", stem, from, request.style.format);
        if (!amontons_render_plot_file(from, path, &request.style, &err)) return report_error(&err);
        say("picture drawn: %s\n", path);
        return 0;
    }
    request.figures = figures.list;
    request.figure_count = figures.count;
    bool drawn = of_sweep ? amontons_render_sweep(from, plot, &request.style, &err)
                          : amontons_render_result(from, &request, &err);
    if (!drawn) return report_error(&err);
    say("pictures drawn: %s/figures\n", from);
    return 0;
}

int command_compare(const Command *command, int argc, char **argv)
{
    const char *first = NULL, *style_name = NULL;
    char words[WORDS_SIZE];
    OptionWords given = {0};
    Command taken = *command;
    PictureStyle style = {.format = "png"};
    Error err = {0};
    const Option options[] = {
        {"format", 0, "png|pdf|svg", "Of the files; png by default", .word = &style.format},
        {"style", 0, "NAME", "What they are for: column (default), columns, slide or poster",
         .word = &style_name},
        {"dark", 0, NULL, "Light lines on dark paper", .flag = &style.dark},
        option_overwrite(&style.overwrite),
        {0}};
    taken.all = &given;
    int status = options_read(&taken, options, argc, argv, &first);
    if (status != 0) return status;
    if (given.count != 2)
        return report_misuse("compare takes a result folder and a table: amontons compare RESULT "
                             "FILE.csv");
    if (style_name && !amontons_picture_option(&style, "style", style_name, &err))
        return report_misuse("--%s", err.message);
    if (!amontons_compare(given.list[0], given.list[1], &style, words, sizeof words, &err))
        return report_error(&err);
    say("%s beside %s:\n%s", given.list[1], given.list[0], words);
    say("pictures drawn: %s/figures\n", given.list[0]);
    return 0;
}
