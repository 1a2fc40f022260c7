// SPDX-License-Identifier: GPL-2.0-or-later
// The progress on a terminal and in a log, byte by byte.
#include "cli/progress.h"

#include "near.h"

#include <fcntl.h>
#include <math.h>
#include <sys/ioctl.h>
#include <unistd.h>

// Standard error, while it is something else.
typedef struct Stage {
    int kept, ours;
    char text[4000];
} Stage;

// A terminal of so many columns (-1: of a size that it does not know); 0: a pipe.
static void begin(Stage *stage, int columns)
{
    int ends[2];
    *stage = (Stage){.kept = dup(STDERR_FILENO)};
    if (columns == 0) {
        assert_int_equal(pipe(ends), 0);
    } else {
        ends[0] = posix_openpt(O_RDWR | O_NOCTTY);
        assert_true(ends[0] >= 0 && grantpt(ends[0]) == 0 && unlockpt(ends[0]) == 0);
        ends[1] = open(ptsname(ends[0]), O_RDWR | O_NOCTTY);
        struct winsize size = {.ws_row = 24, .ws_col = (unsigned short)(columns > 0 ? columns : 0)};
        assert_int_equal(ioctl(ends[1], TIOCSWINSZ, &size), 0);
    }
    dup2(ends[1], STDERR_FILENO);
    close(ends[1]);
    stage->ours = ends[0];
    fcntl(stage->ours, F_SETFL, O_NONBLOCK);
}

// All that was written since.
static const char *said(Stage *stage)
{
    size_t used = 0;
    fflush(stderr);
    for (ssize_t got;
         (got = read(stage->ours, stage->text + used, sizeof stage->text - 1 - used)) > 0;)
        used += (size_t)got;
    stage->text[used] = 0;
    return stage->text;
}

static void end(Stage *stage)
{
    fflush(stderr);
    dup2(stage->kept, STDERR_FILENO);
    close(stage->kept);
    close(stage->ours);
}

static void assert_said(Stage *stage, const char *wanted)
{
    char text[4000];
    snprintf(text, sizeof text, "%s", said(stage));
    if (strcmp(text, wanted) == 0) return;
    end(stage);
    fail_msg("said `%s`, not `%s`", text, wanted);
}

TEST(test_parts_in_a_log)
{
    Stage stage;
    begin(&stage, 0);
    Progress progress = progress_begin(false);
    progress_stage("meshing", &progress);   // over before anybody reads it
    progress_part(&progress, 0.05, "of the film");
    assert_said(&stage, "");
    progress_part(&progress, 0.31, "of the film");
    assert_said(&stage, " 30 %  of the film\n");
    progress_part(&progress, 0.35, "of the film");
    progress_end(&progress);
    assert_said(&stage, "");
    end(&stage);
}

TEST(test_parts_on_a_terminal)
{
    Stage stage;
    begin(&stage, 60);
    Progress progress = progress_begin(false);
    assert_said(&stage, "preparing ...");
    progress_stage("meshing", &progress);
    assert_said(&stage, "\rmeshing ...\033[K");
    progress_part(&progress, 0.5, "of the film");
    const char *drawn = said(&stage);
    bool right = *drawn == '\r' && strstr(drawn, " 50 %  of the film");
    progress_part(&progress, 0.51, "of the film");   // sooner than the eye sees
    assert_said(&stage, "");
    progress_stage("relaxing", &progress);   // the bar has its place
    assert_said(&stage, "");
    progress_end(&progress);
    assert_said(&stage, "\r\033[K");
    progress_end(&progress);
    assert_said(&stage, "");
    end(&stage);
    assert_true(right);
}

TEST(test_quiet)
{
    Stage stage;
    begin(&stage, 60);
    Progress progress = progress_begin(true);
    StepView view = {.fraction = 0.5, .step_size = 1};
    progress_stage("meshing", &progress);
    progress_part(&progress, 0.5, "of the film");
    progress_step(&view, &progress);
    progress_end(&progress);
    assert_said(&stage, "");
    end(&stage);
}

// A run behind an error bar: by the size that the terminal has, or 80 columns; in a log nothing.
TEST(test_runs_of_a_mesh)
{
    Stage stage;
    StepView view = {.mesh = 2, .run = 1, .U = 0.00123, .fraction = 0.25, .events = 1};
    view.mu_M = 0.3291;
    view.seconds_left = 12;
    begin(&stage, -1);
    Progress progress = {.style = PROGRESS_BAR};
    progress_step(&view, &progress);
    assert_said(&stage, "\rmesh 2, run 1, 25 %  U 0.00123  1 event  mu_M so far 0.329  0:12 left"
                        "\033[K");
    end(&stage);
    begin(&stage, 30);
    view.events = 2;
    progress = (Progress){.style = PROGRESS_BAR};
    progress_step(&view, &progress);
    assert_said(&stage, "\rmesh 2, run 1, 25 %  U 0.0012\033[K");
    end(&stage);
    begin(&stage, 0);
    progress = progress_begin(false);
    progress_step(&view, &progress);
    assert_said(&stage, "");
    progress.drawn.tv_sec -= 11;   // in a log every ten seconds
    progress_step(&view, &progress);
    assert_said(&stage, "mesh 2, run 1, 25 %  U 0.00123  2 events  mu_M so far 0.329  0:12 left\n");
    end(&stage);
}

TEST(test_time_left)
{
    static const struct {
        double seconds;
        const char *text;
    } cases[] = {{0, "0:00"},
                 {59.6, "1:00"},
                 {65, "1:05"},
                 {3599.4, "59:59"},
                 {3723, "1:02:03"},
                 {1e9, "1000:00:00"},
                 {INFINITY, "1000:00:00"},
                 {NAN, "-:--"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[32];
        progress_format_left(cases[k].seconds, text, sizeof text);
        assert_string_equal(text, cases[k].text);
    }
}

// At `fraction` of the way, `elapsed` thousands of s after the first step: beside them it makes no
// difference what the test itself takes.
static void step_at(Progress *progress, double elapsed, double fraction)
{
    StepView view = {.fraction = fraction, .step_size = fraction, .events = 1};
    clock_gettime(CLOCK_MONOTONIC, &progress->started);
    progress->started.tv_sec -= (time_t)(1000 * elapsed);
    progress->running = true;
    progress_step(&view, progress);
}

// The first rapid event comes at a tenth of the way, after 3000 s; from there on a tenth takes
// 1000 s: at 0.7 there are 3000 s to go (50:00), where all the time so far would say 3857.
TEST(test_since_the_first_event)
{
    Stage stage;
    begin(&stage, 0);
    Progress progress = progress_begin(false);
    for (int k = 10; k <= 70; k++) step_at(&progress, 3 + 0.1 * (k - 10), 0.01 * k + 1e-9);
    progress_end(&progress);
    const char *line = strstr(said(&stage), " 70 %");
    const char *left = line ? strstr(line, "  50:0") : NULL;
    if (!left) left = line ? strstr(line, "  49:5") : NULL;
    end(&stage);
    assert_non_null(left);
}
