// SPDX-License-Identifier: GPL-2.0-or-later
// What figures of one curve share. The curve is computed only where there is something to compare.
#include "base/memory.h"
#include "render/figures/figures.h"

void figure_curve_destroy(FigureCurve *curve)
{
    memory_free(curve->at);
    memory_free(curve->value);
}

bool figure_curve_measured(ResultView *view, const char *path, MeasuredKind kind,
                           CurveFunction compute, Measured *measured, Error *err)
{
    FigureCurve curve = {0};
    TRY(measured_read(path, kind, view, measured, err));
    if (measured->count == 0) return true;
    TRY(compute(view, &curve, err));
    const ComputedCurve computed = {curve.count, curve.at, curve.value};
    measured_compare(measured, view, computed_on_curve, &computed);
cleanup:
    figure_curve_destroy(&curve);
    return error_is_clean(err);
}
