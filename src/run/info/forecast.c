// SPDX-License-Identifier: GPL-2.0-or-later
// What a run would cost, by what reduction.use: auto goes by (model/choice).
#include "amontons_simulation.h"
#include "base/clock.h"
#include "algebra/dense.h"
#include "base/decimal_point.h"
#include "model/obtain.h"

bool amontons_forecast(const Scene *scene, RunForecast *forecast, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    Model model = {0};
    double begun = clock_processor_seconds();
    *forecast = (RunForecast){0};
    dense_use_one_thread();
    TRY(model_forecast(scene, &model, err));
    const ExpectedCost *cost = &model.expected;
    bool reduced = model.is_reduced;
    double reduction = model.choice.held ? 0 : cost->reduction;
    *forecast = (RunForecast){.elements = model.mesh.element_count,
                              .contact_nodes = model.interface.contact_count,
                              .unknowns = model.bulk.dof_count,
                              .reduced = reduced,
                              .held = model.choice.held,
                              .stages = model.choice.stages,
                              .mesh = clock_processor_seconds() - begun,
                              .reduction = reduced ? reduction : 0,
                              .steps = reduced ? cost->reduced : cost->full,
                              .otherwise = reduced ? cost->full : reduction + cost->reduced,
                              .memory = reduced ? cost->bytes_reduced : cost->bytes_full};
cleanup:
    model_destroy(&model);
    return error_is_clean(err);
}
