// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons render`: pictures of a stored result, or of a plot that a file describes. Which of the
// two the name's ending tells.
// Which of both it is, a result or a plot, is told by the name alone, before anything is read.
#include "cli/commands.h"

#include <stdio.h>
#include <string.h>

enum { FIGURES_MAX = 32, PATH_SIZE = 1200 };

typedef struct RenderOptions {
    const char *folder;
    const char *figures[FIGURES_MAX];
    int32_t figure_count;
    bool too_many;
} RenderOptions;

static error_t take_option(int key, char *word, struct argp_state *state)
{
    RenderOptions *options = state->input;
    switch (key) {
    case 'f':
        if (options->figure_count == FIGURES_MAX)
            options->too_many = true;
        else
            options->figures[options->figure_count++] = word;
        return 0;
    case ARGP_KEY_ARG:
        if (options->folder)   // --figure force slip-map: the further words are names too
            return options->figure_count ? take_option('f', word, state)
                                         : (options->too_many = true, 0);
        options->folder = word;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

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

// Figures are checked by the module that draws them: it knows which there are.
int command_render(int argc, char **argv)
{
    static const struct argp_option known[] = {
        {"figure", 'f', "NAME", 0,
         "Draw only this picture: force, slip-map or contact-density. "
         "May be given several times",
         0},
        {0}};
    static const struct argp argp = {
        .options = known,
        .parser = take_option,
        .args_doc = "RESULT\nPLOT.yaml",
        .doc = "Draws the pictures of the result folder RESULT again, from its stored history "
               "alone: nothing is solved. They go to RESULT/figures/NAME.png. Or draws the curves "
               "that "
               "the file PLOT.yaml describes, into PLOT.png; what such a file holds stands in "
               "render/plot_file.h."
               "\vWithout --figure all pictures are drawn. Example:\n\n"
               "  amontons render fig1-result --figure force"};
    RenderOptions options = {0};
    Error err = {0};
    options_parse(&argp, argc, argv, "amontons render", &options);
    if (!options.folder)
        return report_misuse("render needs a result folder, as in `amontons render fig1-result`");
    if (options.too_many)
        return report_misuse("render takes one result folder, and at most 32 pictures");
    if (is_plot(options.folder)) {
        if (options.figure_count) return report_misuse("--figure has no meaning for a plot");
        return draw_plot(options.folder);
    }
    if (!amontons_render_result(options.folder, options.figures, options.figure_count, &err))
        return report_error(&err);
    printf("pictures drawn: %s/figures\n", options.folder);
    return 0;
}
