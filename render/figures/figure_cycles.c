// SPDX-License-Identifier: GPL-2.0-or-later
// Two figures of the events of a cycle, or of all cycles: precursors, and front-speed.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "io/text/csv_writer.h"
#include "render/canvas/key.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>

enum { CYCLES_NAMED = 8, CYCLE_WORDS_SIZE = 48, ENTRIES = 11 + CYCLES_NAMED };

static const Color FIRST_CYCLE = {0.05f, 0.27f, 0.55f, 1}, LAST_CYCLE = {0.96f, 0.62f, 0.14f, 1};

// --- all cycles ----------------------------------------------------------------------------------

// Colour of cycle number k, from 1, of `count`: up to eight colours of their own, beyond that from
// blue in the first to orange in the last.
static Color cycle_color(int32_t k, int32_t count)
{
    if (count <= CYCLES_NAMED) return stack_color(k - 1);
    float part = (float)(k - 1) / (float)(count - 1);
    return (Color){FIRST_CYCLE.red + part * (LAST_CYCLE.red - FIRST_CYCLE.red),
                   FIRST_CYCLE.green + part * (LAST_CYCLE.green - FIRST_CYCLE.green),
                   FIRST_CYCLE.blue + part * (LAST_CYCLE.blue - FIRST_CYCLE.blue), 1};
}

// Adds the meaning of the colours to the entries of a key; returns how many these are then. words:
// must outlive the entries.
static int32_t cycle_key(int32_t count, char words[CYCLES_NAMED][CYCLE_WORDS_SIZE],
                         KeyEntry *entries, int32_t used)
{
    bool each = count <= CYCLES_NAMED;
    for (int32_t i = 0; i < (each ? count : 2); ++i) {
        int32_t cycle = each ? i + 1 : i == 0 ? 1 : count;
        const char *before = each || i == 0 ? "" : "and so on to ";
        if (cycle == 1)
            snprintf(words[i], CYCLE_WORDS_SIZE, "first loading");
        else
            snprintf(words[i], CYCLE_WORDS_SIZE, "%scycle %d", before, cycle);
        entries[used++] = (KeyEntry){KEY_LINE, cycle_color(cycle, count), words[i]};
    }
    return used;
}

// --- precursors ----------------------------------------------------------------------------------

static const double PRECURSORS_MARGIN = 10;   // points: half a number, and the name l_c
static const double PRECURSORS_HEADROOM = 1.02;   // of the load ratio

// Extent of the cycles that are shown.
typedef struct Extent {
    double top;   // the largest load ratio
    int32_t precursors, slidings;
} Extent;

// Draws the farthest slip so far and the events of each cycle that is shown: discs are precursors,
// rings slidings. page NULL: they are counted.
static bool lengths_draw(const Page *page, const Axes *axes, ResultView *view, Extent *extent,
                         Error *err)
{
    int32_t asked = view->cycle, first = 0, last = 0;
    ViewCurve curve;
    zoom_cycles(view, &first, &last);
    for (int32_t cycle = first; cycle <= last; ++cycle) {
        bool several = last > first;
        Color color = several ? cycle_color(cycle, last) : FIGURE_CURVE;
        computed_choose_cycle(view, cycle);
        if (!computed_curve(view, MEASURED_LENGTH, &curve, err)) break;
        if (curve.count > 0) extent->top = fmax(extent->top, curve.at[curve.count - 1]);
        if (page) {
            Stroke stroke = {.color = color, .width = CURVE_WIDTH * page->point};
            axes_curve(page, axes, &stroke, curve.at, curve.value, curve.count);
        }
        for (int32_t k = 0; k < view->event_count; ++k) {
            double mu = NAN, length = NAN;
            bool sliding = view->events[k].kind == VIEW_LEADING;
            if (!computed_event(view, &view->events[k], &mu, &length)) continue;
            extent->top = fmax(extent->top, mu);
            *(sliding ? &extent->slidings : &extent->precursors) += 1;
            if (!page) continue;
            Point at = axes_place(axes, mu, length);
            draw_disc(page->canvas, several ? color : INK, at, KEY_RADIUS * page->point);
            if (sliding) draw_disc(page->canvas, PAPER, at, 0.6 * KEY_RADIUS * page->point);
        }
    }
    computed_choose_cycle(view, asked);
    return error_is_clean(err);
}

// Lengths of precursors over the load ratio, as experiments show them: each at the load at which it
// began, with how far slip came from the trailing end in it. The curve is the farthest that slip
// had come by then, slow slip included.
bool figure_precursors(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    Measured measured = {0};
    Extent extent = {0};
    int32_t first = 0, last = 0, count = 0;
    double length = view->number[NUMBER_LENGTH];
    Zoom zoom = zoom_choose(view);
    if (!(length > 0)) return REFUSE(err, "the result does not say how long the block is");
    if (!lengths_draw(NULL, NULL, view, &extent, err)) return false;
    if (!measured_read(page.style.compare, MEASURED_LENGTH, view, &measured, err)) return false;

    // The key.
    KeyEntry entries[ENTRIES];
    char words[CYCLES_NAMED][CYCLE_WORDS_SIZE];
    zoom_cycles(view, &first, &last);
    bool several = last > first;
    entries[count++] = (KeyEntry){KEY_LINE, several ? INK : FIGURE_CURVE, "farthest slip so far"};
    if (extent.precursors > 0)
        entries[count++] = (KeyEntry){KEY_DISC, INK, "length of a rapid precursor"};
    if (extent.slidings > 0)
        entries[count++] = (KeyEntry){KEY_RING, INK, several ? "slidings" : "sliding"};
    if (several)
        count = cycle_key(last, words, entries, count);
    else if (zoom.words[0])
        entries[count++] = (KeyEntry){.words = zoom.words};
    count = measured_key(&measured, KEY_DISC, entries, count);
    if (measured.matched)
        entries[count++] = (KeyEntry){KEY_LINE, FIGURE_LEVEL, "to the precursor nearest in load"};
    key_draw(&page, entries, count);

    // The axes; l_c is that of the cycles after the first loading.
    double high = extent.top > 0 ? extent.top : 1;
    for (int32_t k = 0; k < measured.count; ++k) high = fmax(high, measured.at[k]);
    high *= PRECURSORS_HEADROOM;
    Axes axes = {
        .x = {.high = high > 0 ? high : 1, .factor = 1, .label = FIGURE_MU},
        .y = {.high = length, .factor = 1 / length, .label = "length of slip ~{l} / ~{L}"}};
    axes_fit(&page, &page.room, PRECURSORS_MARGIN, &axes);
    double critical = zoom.cycle == 1 ? (double)NAN : view->number[NUMBER_L_C];
    Stroke dashed = dashed_stroke(&page, INK, 0.5);
    if (isfinite(critical)) axes_level(&page, &axes, &dashed, critical, 1.6, "~{l}_{c}");

    if (lengths_draw(&page, &axes, view, &(Extent){0}, err)) {
        // A line from each measured length to the event that it stands beside.
        Stroke stroke = {.color = FIGURE_LEVEL, .width = 0.5 * page.point};
        canvas_clip(page.canvas, &axes.box);
        for (int32_t k = 0; k < measured.count && measured.matched; ++k)
            if (isfinite(measured.computed[k]))
                draw_segment(page.canvas, &stroke,
                             axes_place(&axes, measured.at[k], measured.value[k]),
                             axes_place(&axes, measured.x[k], measured.computed[k]));
        canvas_clip(page.canvas, NULL);

        measured_draw(&page, &measured, -1, &axes);
        axes_draw(&page, &axes);
    }
    measured_destroy(&measured);
    return error_is_clean(err);
}

static void write_length(TextWriter *csv, double mu, double part, int32_t cycle, const char *event)
{
    csv_rounded(csv, mu);
    csv_rounded(csv, part);
    csv_number(csv, cycle);
    csv_text(csv, event);
    csv_end_row(csv);
}

// Loads and lengths of the events of each cycle that is shown, then the farthest slip so far.
bool figure_precursors_table(const char *path, ResultView *view, const FieldChoice *field,
                             Error *err)
{
    (void)field;
    static const char *const names[] = {"F_T/F_N", "l/L", "cycle", "event"};
    int32_t asked = view->cycle, first = 0, last = 0;
    double L = view->number[NUMBER_LENGTH];
    TextWriter *csv = text_writer_create(path, false, err);
    if (!csv) return false;
    for (int32_t c = 0; c < 4; ++c) csv_text(csv, names[c]);
    csv_end_row(csv);
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last; ++k) {
        ViewCurve curve;
        computed_choose_cycle(view, k);
        TRY(computed_curve(view, MEASURED_LENGTH, &curve, err));
        int32_t cycle = zoom_choose(view).cycle;
        for (int32_t i = 0; i < view->event_count; ++i) {
            double mu = NAN, length = NAN;
            if (computed_event(view, &view->events[i], &mu, &length))
                write_length(csv, mu, length / L, cycle, view_event_word(&view->events[i]));
        }
        for (int64_t i = 0; i < curve.count; ++i)
            write_length(csv, curve.at[i], curve.value[i] / L, cycle, MEASURED_FARTHEST);
    }
cleanup:
    computed_choose_cycle(view, asked);
    return text_writer_finish(csv, err);
}

// --- front-speed ---------------------------------------------------------------------------------

static const double SPEED_MARGIN = 22;   // points: names of the waves' speeds
static const double SPEED_HEADROOM = 1.08;   // frame's top over the largest speed
static const double OF_PRECURSOR = 0.6, OF_SLIDING = 0.8;   // radius of marks, over KEY_RADIUS

static const Color PRECURSOR = {0.85f, 0.47f, 0.10f, 1};

// Numbers of the fronts that are shown.
typedef struct Fronts {
    int32_t precursors, slidings;   // with a front that the steps resolve
    double fastest;   // velocity
    bool backwards;   // one ran towards the trailing end
} Fronts;

// Speeds by size, with a line between neighbours that ran the same way; a triangle that points left
// where the front ran towards the trailing end, a ring above the fastest wave.
static void front_draw(const Page *page, const Axes *axes, const ResultView *view,
                       const ViewCurve *curve, Color color, double radius)
{
    Stroke stroke = {.color = color, .width = CURVE_WIDTH * page->point};
    double fastest_wave = view->number[NUMBER_C_LONGITUDINAL];
    canvas_clip(page->canvas, &axes->box);
    for (int64_t k = 0; k < curve->count; ++k) {
        double speed = fabs(curve->value[k]), size = radius * KEY_RADIUS * page->point;
        Point at = axes_place(axes, curve->at[k], speed);
        if (k + 1 < curve->count && computed_speeds_join(view, curve, k))
            draw_segment(page->canvas, &stroke, at,
                         axes_place(axes, curve->at[k + 1], fabs(curve->value[k + 1])));
        if (curve->value[k] < 0)
            key_draw_back(page->canvas, color, at, size);
        else
            draw_disc(page->canvas, color, at, (speed > fastest_wave ? 1.5 : 1) * size);
        if (speed > fastest_wave) draw_disc(page->canvas, PAPER, at, 0.8 * size);
    }
    canvas_clip(page->canvas, NULL);
}

// The fronts of the precursors and of the sliding of each cycle that is shown, of all rapid events
// where none has ended, each cycle in its colour where these are several. axes NULL: they are
// counted.
static bool fronts_draw(const Page *page, const Axes *axes, ResultView *view, Fronts *fronts,
                        Error *err)
{
    int32_t asked = view->cycle, first = 0, last = 0;
    zoom_cycles(view, &first, &last);
    for (int32_t cycle = first; cycle <= last; ++cycle) {
        bool several = last > first;
        computed_choose_cycle(view, cycle);
        Zoom zoom = zoom_choose(view);
        for (int32_t k = 0; k < view->event_count; ++k) {
            const ViewEvent *event = &view->events[k];
            ViewCurve curve;
            bool sliding = event->kind == VIEW_LEADING;
            Color color = several ? cycle_color(cycle, last) : sliding ? FIGURE_CURVE : PRECURSOR;
            if (!view_event_counts(event) || !zoom_covers(&zoom, event->U_start)) continue;
            bool found = computed_front_speed(view, event, &curve, err);
            if (found && axes)
                front_draw(page, axes, view, &curve, color, sliding ? OF_SLIDING : OF_PRECURSOR);
            for (int64_t i = 0; found && i < curve.count; ++i) {
                fronts->fastest = fmax(fronts->fastest, fabs(curve.value[i]));
                fronts->backwards = fronts->backwards || curve.value[i] < 0;
            }
            *(sliding ? &fronts->slidings : &fronts->precursors) += found && curve.count > 0;
            memory_free_all(curve.at, curve.value);
            if (!found) break;
        }
        if (!error_is_clean(err)) break;
    }
    computed_choose_cycle(view, asked);
    return error_is_clean(err);
}

// Draws how fast fronts of the precursors and the sliding of a cycle run, over x, beside the speeds
// of waves. A front of speeding up may be faster than any wave, and where viscosity damps every
// wave their speeds bound nothing: the key says both.
bool figure_front_speed(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    ViewCurve curve, front;
    Measured measured = {0};
    Fronts fronts = {0};
    const double *number = view->number;
    double length = number[NUMBER_LENGTH], fastest_wave = number[NUMBER_C_LONGITUDINAL];
    int32_t first = 0, last = 0, count = 0;
    Zoom zoom = zoom_choose(view);
    if (!(length > 0 && number[NUMBER_C_RAYLEIGH] > 0 && fastest_wave > 0))
        return REFUSE(err, "the result does not say how fast waves are");
    if (!fronts_draw(&page, NULL, view, &fronts, err)) return false;
    if (!measured_read(page.style.compare, MEASURED_SPEED, view, &measured, err)) return false;

    // The key.
    KeyEntry entries[ENTRIES];
    char words[CYCLES_NAMED][CYCLE_WORDS_SIZE], damped[80];
    zoom_cycles(view, &first, &last);
    bool several = last > first;
    if (fronts.slidings + fronts.precursors == 0) {
        entries[count++] = (KeyEntry){.words = "no front that the steps resolve:"};
        entries[count++] = (KeyEntry){.words = "time.accuracy: fine or a smaller time.wave_step"};
    }
    if (several) {
        entries[count++] = (KeyEntry){.words = "fronts of precursors (small) and slidings:"};
        count = cycle_key(last, words, entries, count);
    } else if (fronts.slidings > 0) {
        entries[count++] = (KeyEntry){KEY_LINE, FIGURE_CURVE, "front of the sliding"};
        if (zoom.found) entries[count++] = (KeyEntry){KEY_DASHED, INK, "slow slip ended here"};
    }
    if (!several && fronts.precursors > 0)
        entries[count++] = (KeyEntry){KEY_LINE, PRECURSOR, "fronts of precursors"};
    if (fronts.backwards)
        entries[count++] = (KeyEntry){KEY_BACK, INK, "runs towards the trailing end"};
    entries[count++] = (KeyEntry){KEY_DASHED, FIGURE_LEVEL,
                                  "waves of Rayleigh ~{c}_{R}, shear ~{c}_{S}, pressure ~{c}_{L}"};
    if (!several && zoom.words[0]) entries[count++] = (KeyEntry){.words = zoom.words};
    if (fronts.fastest > fastest_wave)
        entries[count++] =
            (KeyEntry){KEY_RING, FIGURE_CURVE, "faster than ~{c}_{L}: no wave carries it"};
    if (number[NUMBER_WAVE_DAMPING] > 1) {
        snprintf(damped, sizeof damped, "with %.2g times its eta1 and eta2 or less they would run",
                 1 / number[NUMBER_WAVE_DAMPING]);
        entries[count++] = (KeyEntry){.words = "viscosity damps every wave of this block;"};
        entries[count++] = (KeyEntry){.words = damped};
    }
    key_draw(&page, entries, measured_key(&measured, KEY_DISC, entries, count));

    // The axes, and the speeds of waves.
    double low = result_view_trailing_end(view), high = fmax(fastest_wave, fronts.fastest);
    for (int32_t k = 0; k < measured.count; ++k) high = fmax(high, measured.value[k]);
    Axes axes = {.x = {low, low + length, 1 / length, .label = "~{x} / ~{L}"},
                 .y = {.high = high * SPEED_HEADROOM,
                       .factor = 1 / number[NUMBER_C_RAYLEIGH],
                       .label = "front speed ~{v} / ~{c}_{R}"}};
    axes_fit(&page, &page.room, SPEED_MARGIN, &axes);
    Stroke stroke = dashed_stroke(&page, FIGURE_LEVEL, 0.5);
    axes_level(&page, &axes, &stroke, number[NUMBER_C_RAYLEIGH], 2, "~{c}_{R}");
    axes_level(&page, &axes, &stroke, number[NUMBER_C_SHEAR], 2, NULL);   // too near for a name
    axes_level(&page, &axes, &stroke, fastest_wave, 2, "~{c}_{L}");

    TRY(fronts_draw(&page, &axes, view, &(Fronts){0}, err));
    TRY(computed_curve(view, MEASURED_SPEED, &curve, err));
    TRY(computed_curve(view, MEASURED_FRONT, &front, err));
    if (curve.count > 0) {
        // An upright line shows how far slow slip had come before.
        Stroke upright = dashed_stroke(&page, INK, CURVE_WIDTH);
        double x = curve_value(&front, zoom.U_slide);
        draw_segment(page.canvas, &upright, axes_place(&axes, x, axes.y.low),
                     axes_place(&axes, x, axes.y.high));
    }
    measured_draw(&page, &measured, -1, &axes);
    axes_draw(&page, &axes);
cleanup:
    measured_destroy(&measured);
    return error_is_clean(err);
}

// Speeds of the fronts of the events of each cycle that is shown, below 0 towards the trailing end.
// U, where the rod was when it began, says which row of events.csv an event is.
bool figure_front_speed_table(const char *path, ResultView *view, const FieldChoice *field,
                              Error *err)
{
    (void)field;
    int32_t asked = view->cycle, first = 0, last = 0;
    ViewCurve curve = {0};
    TextWriter *csv = text_writer_create(path, false, err);
    if (!csv) return false;
    const char *const names[] = {"x/L", "v/c_R", "cycle", "event", view->si ? "U (m)" : "U"};
    for (int32_t c = 0; c < 5; ++c) csv_text(csv, names[c]);
    csv_end_row(csv);
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last; ++k) {
        computed_choose_cycle(view, k);
        Zoom zoom = zoom_choose(view);
        for (int32_t e = 0; e < view->event_count; ++e) {
            const ViewEvent *event = &view->events[e];
            if (!view_event_counts(event) || !zoom_covers(&zoom, event->U_start)) continue;
            TRY(computed_front_speed(view, event, &curve, err));
            for (int64_t i = 0; i < curve.count; ++i) {
                csv_rounded(csv, curve.at[i] / view->number[NUMBER_LENGTH]);
                csv_rounded(csv, curve.value[i] / view->number[NUMBER_C_RAYLEIGH]);
                csv_number(csv, zoom.cycle);
                csv_text(csv, view_event_word(event));
                csv_rounded(csv, event->U_start);
                csv_end_row(csv);
            }
            memory_free_all(curve.at, curve.value);
            curve = (ViewCurve){0};
        }
    }
cleanup:
    memory_free_all(curve.at, curve.value);
    computed_choose_cycle(view, asked);
    return text_writer_finish(csv, err);
}
