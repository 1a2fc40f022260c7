// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons render`: pictures of a stored result, or of a plot that a file describes. The ending of
// the name tells which.
#include "cli/commands.h"
#include "cli/options.h"

#include <stdio.h>
#include <string.h>

enum { PATH_SIZE = 1200 };

static const CommandText text = {
    .name = "render",
    .argument = "RESULT\nPLOT.yaml",
    .what = "result folder",
    .example = "amontons render fig1-result",
    .help = "Draws the pictures of the result folder RESULT again, from its stored history; "
            "nothing is computed. They are written to RESULT/figures/NAME.png. With a file "
            "PLOT.yaml or PLOT.json that describes curves: draws them into PLOT.png. A sweep "
            "leaves such files; render/plot_file.h explains their keys."
            "\vWithout --figure all pictures are drawn. Example:\n\n"
            "  amontons render fig1-result --figure force"};

// JSON is YAML: the descriptions that a sweep leaves are .json.
static bool is_plot(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".json") == 0);
}

// fig2a.yaml becomes fig2a.png.
static int draw_plot(const char *plot)
{
    Error err = {0};
    char png[PATH_SIZE];
    int stem = (int)(strrchr(plot, '.') - plot);
    if (stem + 5 > (int)sizeof png) return report_misuse("the path of the plot is too long");
    snprintf(png, sizeof png, "%.*s.png", stem, plot);
    if (!amontons_render_plot_file(plot, png, &err)) return report_error(&err);
    printf("picture drawn: %s\n", png);
    return 0;
}

// The module that draws them checks the figures: it knows which there are.
int command_render(int argc, char **argv)
{
    const char *from = NULL;
    OptionWords figures = {0};
    Error err = {0};
    const Option options[] = {{"figure", 'f', "NAME",
                               "Draw only this picture: force, slip-map or contact-density. May "
                               "be given several times",
                               .words = &figures},
                              {0}};
    int status = options_read(&text, options, argc, argv, &from);
    if (status != 0) return status;
    if (is_plot(from)) {
        if (figures.count) return report_misuse("--figure has no meaning for a plot");
        return draw_plot(from);
    }
    if (!amontons_render_result(from, figures.list, figures.count, &err)) return report_error(&err);
    printf("pictures drawn: %s/figures\n", from);
    return 0;
}
