// SPDX-License-Identifier: GPL-2.0-or-later
// How large a run would be: sizes and memory, without a step.
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
    *forecast = (RunForecast){.elements = model.mesh.element_count,
                              .contact_nodes = model.interface.contact_count,
                              .unknowns = model.bulk.dof_count,
                              .reduced = model.is_reduced,
                              .held = model.from_cache,
                              .mesh = clock_processor_seconds() - begun,
                              .memory = model.memory};
    mesh_move_text(&model.mesh, forecast->mesh_moved);
cleanup:
    model_destroy(&model);
    return error_is_clean(err);
}
