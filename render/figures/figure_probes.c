// SPDX-License-Identifier: GPL-2.0-or-later
// Readings of points inside the bodies against U: a frame for each component, a curve for each
// probe.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "io/text/csv_writer.h"
#include "render/figures/probe_data.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>

enum { KEY_MAX = 34 };   // probes, which slidings are shown, measurements

static const double SMALL_STRAIN = 1e-2;   // below it strains are shown in millionths

bool figure_probes_are_there(const ResultView *view)
{
    return view->probes > 0;
}

bool figure_probes_show(const char *quantity)
{
    Error unknown = {0};
    ProbeQuantity found;
    return probe_quantity_find(quantity, &found, &unknown);
}

bool figure_probes(Page *page, const FigureInput *input, Error *err)
{
    ResultView *view = input->view;
    PageDef def = input->def;
    ProbeQuantity quantity;
    ViewRange shown;
    Axes axes[PROBE_COMPONENTS_MAX] = {0};
    Measured measured = {0};
    double *values = NULL;
    TRY(probe_quantity_find(input->field->of, &quantity, err));
    TRY(measured_read(def.style->compare, MEASURED_PROBE, view, &measured, err));
    if (measured.count > 0 && !input->field->of) quantity = measured.quantity;
    if (measured.quantity != quantity) measured.count = 0;
    TRY(probe_read(view, quantity, &values, err));
    TRY(view_range_find(view, def.style, &shown, err));
    int32_t components = probe_components(view, quantity);
    int64_t stride = (int64_t)components * view->probes;
    def.height = page_shape(def.style, stack_shape(components));
    TRY(page_begin(page, &def, err));

    // The key.
    Page whole = *page;
    char names[KEY_MAX][PROBE_NAME_SIZE];
    KeyEntry entries[KEY_MAX];
    int32_t count = 0;
    for (int32_t k = 0; k < view->probes && count < KEY_MAX - 2; ++k) {
        probe_name(view, k, names[k]);
        entries[count++] =
            (KeyEntry){k < STACK_COLORS ? KEY_LINE : KEY_DASHED, stack_color(k), names[k]};
    }
    if (shown.words[0]) entries[count++] = (KeyEntry){.words = shown.words};
    key_draw(&whole, entries, measured_key(&measured, KEY_DISC, entries, count));

    // A frame for each component: its range, name and unit.
    ProbeWords words = probe_words(quantity);
    for (int32_t c = 0; c < components; ++c) {
        double low = INFINITY, high = -INFINITY;
        for (int64_t row = 0; row < view->rows; ++row)
            for (int32_t k = 0; k < view->probes; ++k)
                if (view->U[row] >= shown.low && view->U[row] <= shown.high)
                    stack_widen(values[row * stride + k * components + c], &low, &high);
        for (int32_t k = 0; k < measured.count; ++k)
            if ((int32_t)measured.x[k] % PROBE_COMPONENTS_MAX == c)
                stack_widen(measured.value[k], &low, &high);
        axes[c] = (Axes){.x = figure_length_axis(view, "U", shown.low, shown.high),
                         .y = stack_axis(low, high)};
        Axis *axis = &axes[c].y;
        char name[AXIS_LABEL_SIZE];
        double largest = fmax(fabs(axis->low), fabs(axis->high));
        snprintf(name, sizeof name, "%s_{%s}", words.symbol, probe_component(view, quantity, c));
        if (quantity == PROBE_STRAIN && largest < SMALL_STRAIN) {
            axis->factor = 1e6;
            snprintf(axis->label, sizeof axis->label, "%.70s (10^{\u22126})", name);
        } else if (view->si && words.si[0]) {
            axis_set_unit(axis, name, words.si);
        } else {
            snprintf(axis->label, sizeof axis->label, "%.50s%s%.30s", name,
                     words.normalised[0] ? " / " : "", words.normalised);
        }
    }

    // A curve for each probe, dashed where colours begin anew.
    stack_fit(&whole, axes, components);
    for (int32_t c = 0; c < components; ++c) {
        canvas_clip(whole.canvas, &axes[c].box);
        for (int32_t k = 0; k < view->probes; ++k) {
            Stroke stroke = {.color = stack_color(k), .width = CURVE_WIDTH * whole.point};
            if (k >= STACK_COLORS) stroke.dash = 3 * whole.point, stroke.space = 2 * whole.point;
            const double *reading = values + k * components + c;
            LinePen pen = line_begin(whole.canvas, &stroke);
            for (int64_t row = 0; row < view->rows; ++row)
                line_add(&pen, axes_place(&axes[c], view->U[row], reading[row * stride]));
            line_end(&pen);
        }
        canvas_clip(whole.canvas, NULL);
        measured_draw(&whole, &measured, c, &axes[c]);
        axes_draw(&whole, &axes[c]);
    }
cleanup:
    memory_free(values);
    measured_destroy(&measured);
    return error_is_clean(err);
}

// U, t, then each component of each quantity of each probe: "gauge1 strain_xx".
bool figure_probes_table(const char *path, ResultView *view, const FieldChoice *field, Error *err)
{
    (void)field;
    TextWriter *csv = NULL;
    double *values[PROBE_QUANTITY_COUNT] = {0};
    for (int32_t q = 0; q < PROBE_QUANTITY_COUNT; ++q)
        TRY(probe_read(view, (ProbeQuantity)q, &values[q], err));
    TRY(csv = text_writer_create(path, false, err));
    csv_text(csv, view->si ? "U (m)" : "U");
    csv_text(csv, view->si ? "t (s)" : "t");
    for (int32_t k = 0; k < view->probes; ++k)
        for (int32_t q = 0; q < PROBE_QUANTITY_COUNT; ++q)
            for (int32_t c = 0; c < probe_components(view, (ProbeQuantity)q); ++c)
                probe_column_csv(csv, view, k, (ProbeQuantity)q, c);
    csv_end_row(csv);
    for (int64_t row = 0; row < view->rows; ++row) {
        csv_rounded(csv, view->U[row]);
        csv_rounded(csv, view->t[row]);
        for (int32_t k = 0; k < view->probes; ++k)
            for (int32_t q = 0; q < PROBE_QUANTITY_COUNT; ++q) {
                int32_t components = probe_components(view, (ProbeQuantity)q);
                const double *at = values[q] + (row * view->probes + k) * components;
                for (int32_t c = 0; c < components; ++c) csv_rounded(csv, at[c]);
            }
        csv_end_row(csv);
    }
cleanup:
    memory_free_list((void *const *)values, PROBE_QUANTITY_COUNT);
    return text_writer_finish(csv, err);
}
