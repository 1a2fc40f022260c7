// SPDX-License-Identifier: GPL-2.0-or-later
// Pressure, friction, their ratio, slip, contact area and gap along the contact at chosen moments:
// a frame for each, a curve for each moment; in space along a line. Where the block has lifted off,
// rings.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "io/hdf5/result_tables.h"
#include "io/text/csv_writer.h"
#include "render/canvas/key.h"
#include "render/view/block.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- numbers -------------------------------------------------------------------------------------

enum { MOMENT_SIZE = 40 };
enum { PROFILES_MAX = 8, PROFILE_WORDS_SIZE = 100 };

typedef enum ProfileQuantity {
    PROFILE_PRESSURE,   // p, stress
    PROFILE_SHEAR,   // tau; in space its size, stress
    PROFILE_RATIO,   // tau/p, 1; NaN where open
    PROFILE_SLIP,   // along the drive since the first moment; since the rod's start if it is alone
    PROFILE_AREA,   // of the real contacts over that when the rod started, 1; 0 where open
    PROFILE_GAP,   // between block and floor, length; 0 where they touch
    PROFILE_QUANTITIES
} ProfileQuantity;

typedef struct Profiles {
    int32_t count;   // moments
    int32_t nodes;
    int64_t row[PROFILES_MAX];   // [count] of the history
    char words[PROFILES_MAX][PROFILE_WORDS_SIZE];   // when that was
    // [count * nodes] each; gap and area NULL where the history has none; owned
    double *values[PROFILE_QUANTITIES];
    double *status;   // [count * nodes] 0: open; owned
    bool opens;   // some node is open at one of the moments
} Profiles;

// words: what is said of it before U and F_T/F_N; may be empty.
static void add_row(const ResultView *view, int64_t row, const char *words, Profiles *profiles)
{
    int32_t k = profiles->count++;
    profiles->row[k] = row;
    snprintf(profiles->words[k], PROFILE_WORDS_SIZE,
             "%s%s~{F}_{T} / ~{F}_{N} = %.3g, ~{U} = %.6g%s", words, words[0] ? ": " : "",
             view->mu[row], view->U[row] * (view->si ? 1e3 : 1), view->si ? " mm" : "");
}

// The moments that are asked for.
static bool add_asked(const ResultView *view, const char *at, Profiles *profiles, Error *err)
{
    char word[MOMENT_SIZE], *end = NULL;
    for (; *at; at += strcspn(at, ","), at += *at == ',') {
        bool by_U = false;
        double value = 0;
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
        if (strncmp(word, "mu=", 3) == 0) {
            value = strtod(word + 3, &end);
            if (!word[3] || *end || at[strcspn(at, ",")])
                return REFUSE(err, "a load is given alone, as in mu=0.2, not as \"%.40s\"", word);

            // The rows at which F_T/F_N rises through mu, the last PROFILES_MAX of them.
            int64_t found[PROFILES_MAX];
            int32_t count = 0;
            for (int64_t row = view->rows - 1; row > 0 && count < PROFILES_MAX; --row) {
                if (!(view->mu[row - 1] < value && view->mu[row] >= value)) continue;
                bool nearer = fabs(view->mu[row - 1] - value) < fabs(view->mu[row] - value);
                found[count++] = nearer ? row - 1 : row;
            }
            if (count == 0) return REFUSE(err, "F_T/F_N never rises through %g", value);
            while (count > 0) add_row(view, found[--count], "", profiles);
            return true;
        }
        if (profiles->count == PROFILES_MAX)
            return REFUSE(err, "profile shows %d moments at most", PROFILES_MAX);
        if (!block_moment_seen(view, word, &by_U, &value, err)) return false;
        add_row(view, result_view_nearest_row(view, by_U ? view->U : view->t, value), "", profiles);
    }
    return profiles->count > 0 || REFUSE(err, "no moment is named");
}

// Around the last sliding, or else the last rapid event.
static void add_event(const ResultView *view, Profiles *profiles)
{
    const ViewEvent *chosen = NULL;
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        if (event->kind <= VIEW_QUASI_STATIC || !isfinite(event->U_start + event->U_stop)) continue;
        if (!chosen || event->kind == VIEW_LEADING || chosen->kind != VIEW_LEADING) chosen = event;
    }
    if (!chosen) {
        int64_t largest = 0;
        for (int64_t row = 1; row < view->rows; ++row)
            if (view->mu[row] > view->mu[largest]) largest = row;
        if (largest + 1 < view->rows) add_row(view, largest, "largest load", profiles);
        add_row(view, view->rows - 1, "end", profiles);
        return;
    }
    int64_t before = 0, after = result_view_nearest_row(view, view->U, chosen->U_stop);
    for (int64_t row = 0; row < view->rows && view->U[row] < chosen->U_start; ++row) before = row;
    while (after + 1 < view->rows && view->U[after + 1] <= chosen->U_stop) ++after;
    int64_t equal = before;
    while (equal > 0 && view->mu[equal] > view->mu[after]) --equal;
    bool found = view->mu[equal] <= view->mu[after] && equal < before;
    if (found &&
        fabs(view->mu[equal + 1] - view->mu[after]) < fabs(view->mu[equal] - view->mu[after]))
        ++equal;
    if (found && equal < before) add_row(view, equal, "before, at the load after", profiles);
    add_row(view, before, chosen->kind == VIEW_LEADING ? "before sliding" : "before the event",
            profiles);
    add_row(view, after, chosen->kind == VIEW_LEADING ? "after sliding" : "after the event",
            profiles);
}

// at: "U=0.01,U=0.02", "t=12", or "mu=0.2", all moments at which F_T/F_N rises through it, the last
// ones; NULL: around the last sliding of the whole block (else the last rapid event): before it at
// the load that is left after it, just before it, and after it. Without an event the largest
// F_T/F_N and the end.
static bool profiles_read(ResultView *view, const char *at, Profiles *profiles, Error *err)
{
    *profiles = (Profiles){.nodes = view->nodes};
    double **values = profiles->values;
    if (at)
        TRY(add_asked(view, at, profiles, err));
    else
        add_event(view, profiles);
    const int64_t *rows = profiles->row;
    int32_t count = profiles->count;
    TRY(result_view_read_at(view, SERIES_PRESSURE, false, rows, count, &values[PROFILE_PRESSURE],
                            err));
    TRY(result_view_read_at(view, SERIES_SHEAR, false, rows, count, &values[PROFILE_SHEAR], err));
    TRY(result_view_read_at(view, SERIES_SLIP, false, rows, count, &values[PROFILE_SLIP], err));
    TRY(result_view_read_at(view, SERIES_STATUS, false, rows, count, &profiles->status, err));
    if (result_file_has_series(view->file, SERIES_GAP))
        TRY(result_view_read_at(view, SERIES_GAP, false, rows, count, &values[PROFILE_GAP], err));
    if (result_file_has_series(view->file, SERIES_AREA))
        TRY(result_view_read_at(view, SERIES_AREA, false, rows, count, &values[PROFILE_AREA], err));
    int32_t nodes = profiles->nodes;
    TRY(values[PROFILE_RATIO] = NEW_ARRAY(double, (int64_t)profiles->count *nodes, err));
    for (int32_t k = profiles->count - 1; k >= 0; --k)
        for (int32_t i = 0; i < nodes; ++i) {
            int64_t at_node = (int64_t)k * nodes + i;
            bool open = profiles->status[at_node] == STATUS_OPEN;
            profiles->opens = profiles->opens || open;
            values[PROFILE_RATIO][at_node] = open || !(values[PROFILE_PRESSURE][at_node] > 0)
                                                 ? NAN
                                                 : values[PROFILE_SHEAR][at_node] /
                                                       values[PROFILE_PRESSURE][at_node];
            if (profiles->count > 1) values[PROFILE_SLIP][at_node] -= values[PROFILE_SLIP][i];
        }
cleanup:
    return error_is_clean(err);
}

static void profiles_destroy(Profiles *profiles)
{
    memory_free_list((void *const *)profiles->values, PROFILE_QUANTITIES);
    memory_free(profiles->status);
    *profiles = (Profiles){0};
}

// --- the figure ----------------------------------------------------------------------------------

static const double RING = 0.62;   // inside over outside of the mark of an open node

bool figure_profile(Page *page, const FigureInput *input, Error *err)
{
    static const struct {
        const char *name, *si, *normalised;
    } words[PROFILE_QUANTITIES] = {{"~{p}", "Pa", "~{E}"},       {"~{\u03c4}", "Pa", "~{E}"},
                                   {"~{\u03c4} / ~{p}", "", ""}, {"slip", "m", "~{L}_{0}"},
                                   {"~{A} / ~{A}_{0}", "", ""},  {"gap", "m", "~{L}_{0}"}};
    ResultView *view = input->view;
    PageDef def = input->def;
    Profiles profiles = {0};
    Axes axes[PROFILE_QUANTITIES] = {0};
    ProfileQuantity shown[PROFILE_QUANTITIES];
    double from = 0, to = 0;
    int32_t frames = 0;
    TRY(profiles_read(view, input->field->at, &profiles, err));

    // A frame for each quantity that there is, the gap where some node is open.
    result_view_x_extent(view, &from, &to);
    for (int32_t q = 0; q < PROFILE_QUANTITIES; ++q) {
        bool area = q == PROFILE_AREA;   // which changes by a few per cent
        double low = area ? INFINITY : 0, high = area ? -INFINITY : 0;
        if (!profiles.values[q] || (q == PROFILE_GAP && !profiles.opens)) continue;
        for (int64_t i = 0; i < (int64_t)profiles.count * profiles.nodes; ++i)
            stack_widen(profiles.values[q][i], &low, &high);
        Axes *own = &axes[frames];
        *own = (Axes){.x = figure_length_axis(view, "x", from, to), .y = stack_axis(low, high)};
        const char *name = words[q].name, *normalised = words[q].normalised;
        if (view->si && words[q].si[0])
            axis_set_unit(&own->y, name, words[q].si);
        else
            snprintf(own->y.label, sizeof own->y.label, "%s%s%s", name, *normalised ? " / " : "",
                     normalised);
        shown[frames++] = (ProfileQuantity)q;
    }
    def.height = page_shape(def.style, stack_shape(frames));
    TRY(page_begin(page, &def, err));
    Page whole = *page;

    // The key.
    KeyEntry entries[PROFILES_MAX + 2];
    int32_t count = 0;
    for (int32_t k = 0; k < profiles.count; ++k)
        entries[count++] = (KeyEntry){KEY_LINE, stack_color(k), profiles.words[k]};
    if (profiles.count > 1)
        entries[count++] = (KeyEntry){.words = "slip is that since the first of these moments"};
    if (profiles.opens) entries[count++] = (KeyEntry){KEY_RING, INK, "open: no contact"};
    key_draw(&whole, entries, count);

    // A curve for each moment.
    stack_fit(&whole, axes, frames);
    for (int32_t f = 0; f < frames; ++f) {
        for (int32_t k = 0; k < profiles.count; ++k) {
            // Gaps between pads break the curve.
            Stroke stroke = {.color = stack_color(k), .width = CURVE_WIDTH * whole.point};
            canvas_clip(whole.canvas, &axes[f].box);
            LinePen pen = line_begin(whole.canvas, &stroke);
            for (int32_t i = 0; i < view->nodes; ++i) {
                if (i > 0 && view->pad[i] != view->pad[i - 1]) line_add(&pen, (Point){NAN, NAN});
                line_add(&pen,
                         axes_place(&axes[f], view->x[i],
                                    (profiles.values[shown[f]] + (int64_t)k * profiles.nodes)[i]));
            }
            line_end(&pen);
            canvas_clip(whole.canvas, NULL);
        }

        for (int32_t k = 0; shown[f] == PROFILE_PRESSURE && k < profiles.count; ++k) {
            double radius = KEY_RADIUS * whole.point;
            for (int32_t i = 0; i < view->nodes; ++i) {
                int64_t at_node = (int64_t)k * view->nodes + i;
                if (profiles.status[at_node] != STATUS_OPEN) continue;
                Point at =
                    axes_place(&axes[f], view->x[i], profiles.values[PROFILE_PRESSURE][at_node]);
                draw_disc(whole.canvas, stack_color(k), at, radius);
                draw_disc(whole.canvas, PAPER, at, RING * radius);
            }
        }
        axes_draw(&whole, &axes[f]);
    }
cleanup:
    profiles_destroy(&profiles);
    return error_is_clean(err);
}

// A row for each node at each moment.
bool figure_profile_table(const char *path, ResultView *view, const FieldChoice *field, Error *err)
{
    enum { COLUMNS = 4 + PROFILE_QUANTITIES + 1 };
    static const char *const names[2][COLUMNS] = {
        {"U", "t", "F_T/F_N", "x", "p", "tau", "tau/p", "slip", "A/A_0", "gap", "status"},
        {"U (m)", "t (s)", "F_T/F_N", "x (m)", "p (Pa)", "tau (Pa)", "tau/p", "slip (m)", "A/A_0",
         "gap (m)", "status"}};
    Profiles profiles;
    TextWriter *csv = NULL;
    TRY(profiles_read(view, field->at, &profiles, err));
    TRY(csv = text_writer_create(path, false, err));
    for (int32_t c = 0; c < COLUMNS; ++c) csv_text(csv, names[view->si][c]);
    csv_end_row(csv);
    for (int32_t k = 0; k < profiles.count; ++k)
        for (int32_t i = 0; i < profiles.nodes; ++i) {
            int64_t row = profiles.row[k], at_node = (int64_t)k * profiles.nodes + i;
            csv_rounded(csv, view->U[row]);
            csv_rounded(csv, view->t[row]);
            csv_rounded(csv, view->mu[row]);
            csv_rounded(csv, view->x[i]);
            for (int32_t q = 0; q < PROFILE_QUANTITIES; ++q)
                csv_rounded(csv, profiles.values[q] ? profiles.values[q][at_node] : NAN);
            csv_rounded(csv, profiles.status[at_node]);
            csv_end_row(csv);
        }
cleanup:
    profiles_destroy(&profiles);
    return text_writer_finish(csv, err);
}
