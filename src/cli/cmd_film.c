// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons film`: a film of a stored result.
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "cli/say.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RATE_MAX = 240, NAME_SIZE = 256 };
static const double STILL_MOST = 0.5;   // s: what stands for longer looks as if it were at rest

// A number above 0, with nothing behind it.
static int read_number(const char *name, const char *word, double *number)
{
    char *end = NULL;
    if (!word) return 0;
    *number = strtod(word, &end);
    if (end == word || *end || !(*number > 0) || !isfinite(*number))
        return report_misuse("%s %s: a number above 0 is allowed", name, word);
    return 0;
}

static void show_frame(int32_t frame, int32_t frames, void *context)
{
    progress_part(context, (double)frame / frames, "of the film");
}

int command_film(const Command *command, int argc, char **argv)
{
    const char *result = NULL, *seconds = NULL, *rate = NULL, *size = NULL, *magnification = NULL;
    char name[NAME_SIZE];
    bool quiet = false, fields = false;
    FilmRequest film = {0};
    const Option options[] = {
        {"output", 'o', "FILE", "The film; its ending says of which kind", .word = &film.path},
        {"seconds", 0, "S", "How long it lasts; 20 by default", .word = &seconds},
        {"fps", 0, "N", "Frames a second; 30 by default, of a GIF 20", .word = &rate},
        {"size", 0, "WxH", "Pixels, even numbers; 1920x1080 by default, of a GIF 800x450",
         .word = &size},
        option_pictures(&film.style, TAKEN_BY_FILMS),
        {"of", 0, "FIELD",
         "What is shown of the block: von_mises (default), stress_xx, stress_zz, stress_xz, "
         "pressure, velocity, displacement, strain_energy or dissipation; or of the contact: a "
         "state of friction that remembers, as in theta",
         .word = &film.of},
        {"magnification", 0, "N", "Of the block's deformation; chosen by default",
         .word = &magnification},
        {"fields", 0, NULL, NULL, .flag = &fields},
        {"dark", 0, NULL, "Light lines on dark paper", .flag = &film.style.dark},
        option_overwrite(&film.style.overwrite),
        {"quiet", 'q', NULL, "Print nothing but errors", .flag = &quiet},
        {0}};
    int status = options_read(command, options, argc, argv, &result);
    if (status == 0 && fields)
        status = report_misuse("--fields is gone: run the scene with --set output.fields=film, and "
                               "film that result");
    if (status == 0) status = read_number("--seconds", seconds, &film.seconds);
    if (status == 0) status = read_number("--magnification", magnification, &film.magnification);
    if (status == 0 && rate) status = option_count("--fps", rate, 1, RATE_MAX, &film.rate);
    int end = 0;
    if (status == 0 && size &&
        (sscanf(size, "%dx%d%n", &film.width, &film.height, &end) != 2 || size[end] ||
         film.width <= 0 || film.height <= 0))
        status = report_misuse("--size %s: width and height in pixels are given as 1280x720", size);
    if (status == 0) status = option_may_write(film.path, film.style.overwrite);
    if (status != 0) return status;

    // results/fig1/ becomes fig1.mp4.
    size_t length = strlen(result);
    while (length > 1 && result[length - 1] == '/') --length;
    size_t first = length;
    while (first > 0 && result[first - 1] != '/') --first;
    bool named = strspn(result + first, "./") < length - first;
    snprintf(name, sizeof name, "%.*s.mp4", named ? (int)(length - first) : 4,
             named ? result + first : "film");

    if (!film.path) film.path = name;
    Error err = {0};
    double still = 0;
    Progress progress = progress_begin(quiet);
    film.on_frame = show_frame;
    film.context = &progress;
    film.still = &still;
    film.stop = stop_on_signals();
    stop_in_order();
    bool done = amontons_film(result, &film, &err);
    progress_end(&progress);
    if (!done) return report_error(&err);
    if (!quiet) say("film: %s\n", film.path);
    if (!quiet && still == 0)
        say("It shows no block, as the run stored no fields of it then: run the scene with --set "
            "output.fields=film for that.\n");
    if (!quiet && still > STILL_MOST)
        say("Its block stands still for up to %.1f s while time goes on: fields are stored too "
            "seldom for slow motion. Run the scene with --set output.fields=film for more.\n",
            still);
    return 0;
}
