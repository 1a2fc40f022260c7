// SPDX-License-Identifier: GPL-2.0-or-later
// What a run is expected to take, against what it takes, on a soft layer: counts, not seconds.
#include "amontons_simulation.h"

#include "small_scene.h"

#include <math.h>

enum { SETTINGS = 8 };

// Stages of the run over those expected.
static double taken_over_expected(const char *const *settings)
{
    Error err = {0};
    RunForecast forecast;
    RunSummary summary;
    RunOptions options = {0};
    Scene *scene = small_scene(settings);
    if (!amontons_forecast(scene, &forecast, &err)) fail_msg("%s", err.message);
    if (!amontons_run(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
    return (double)summary.counters.contact_solves / forecast.stages;
}

// Two of validation/strangers (10 and 30) on coarser meshes, and the block without a layer. The
// first sticks and slips with drops far below mu_S - mu_K, the second slides without drops.
TEST(test_soft_layers)
{
    static const char *const layers[][SETTINGS] = {
        {"mesh={file: ../../meshes/layers.geo, set: {length: 1, height: 0.31383, layer: 0.02, "
         "nx: 10, nz: 3, nz_layer: 1}}",
         "material={young: 1, poisson: 0.48897, density: 1, eta1: 1.3702, eta2: 0.56252, plane: "
         "strain}",
         "materials={layer: {young: 0.03465, poisson: 0.1385, eta1: 0.023434, eta2: 0.0023823}}",
         "friction={law: exponential-weakening, mu_static: 0.62791, mu_kinetic: 0.12952, "
         "critical_velocity: 0.00080989}",
         "load={pressure: 7.345e-05}",
         "rod={velocity: 2.8724e-07, height: 0.14367, width: 0.1, stiffness: 0.030232}",
         "time={until: {U: 0.0035}}", NULL},
        {"mesh={file: ../../meshes/layers.geo, set: {length: 1, height: 0.40761, layer: 0.0269, "
         "nx: 16, nz: 4, nz_layer: 1}}",
         "material={young: 1, poisson: 0.34289, density: 1, eta1: 1.5211, eta2: 0.2}",
         "materials={layer: {young: 0.06075, poisson: 0.36406, eta1: 0.06133, eta2: 0.0524}}",
         "friction={law: linear-weakening, mu_static: 0.64443, mu_kinetic: 0.17308, "
         "critical_velocity: 0.00031848}",
         "load={pressure: 6.6149e-05}", "rod={velocity: 2.384e-05, height: 0.12, width: 0.1}",
         "time={until: {U: 0.0013411}}", NULL},
        {NULL}};
    for (size_t k = 0; k < sizeof layers / sizeof *layers; k++) {
        double ratio = taken_over_expected(layers[k]);
        if (!(fabs(log2(ratio)) <= 2)) fail_msg("layer %zu: %g times the stages", k, ratio);
    }
}
