// SPDX-License-Identifier: GPL-2.0-or-later
// Friction along the contact: wherever nodes lie, together they hold what the formula says.
#include "run/simulation_state.h"

#include "near.h"
#include "small_scene.h"

// The threshold of a node is 0.38 times its factor. *integral: of the factors over the contact.
static double *factors_of(const char *along, int32_t cells, double *integral)
{
    char setting[200], mesh[40];
    Simulation *simulation = NULL;
    Error err = {0};
    snprintf(setting, sizeof setting, "friction.along=%s", along);
    snprintf(mesh, sizeof mesh, "mesh.set.nx=%d", cells);
    Scene *scene =
        small_scene((const char *const[]){setting, mesh, "friction.mu_static=0.38", NULL});
    if (!amontons_simulation_create(scene, &(RunOptions){0}, &simulation, &err))
        fail_msg("%s", err.message);
    const Interface *interface = &simulation->model.interface;
    double *factors = malloc(sizeof *factors * (size_t)interface->contact_count);
    *integral = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        factors[i] = simulation->model.node_laws[i].mu_static / 0.38;
        *integral += factors[i] * interface->weight[i];
    }
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(scene);
    return factors;
}

// Ends of 0.15 at 0.6, which begin at a node, within a cell, or half way between nodes.
static void test_jumps(void **state)
{
    (void)state;
    static const int32_t cells[] = {10, 14, 20};
    for (size_t k = 0; k < sizeof cells / sizeof *cells; k++) {
        double integral = 0,
               *factors = factors_of("points(x, 0.15, 0.6, 0.15, 1, 0.85, 1, 0.85, 0.6)", cells[k],
                                     &integral);
        double sample = 1.0 / (32 * cells[k]);
        assert_near("all", integral, 1 - 2 * 0.15 * 0.4, 2 * 0.4 * sample);
        assert_near("end", factors[0], 0.6, 1e-12);
        assert_near("middle", factors[cells[k] / 2], 1, 1e-12);
        free(factors);
    }
}

// A straight line has its value at the middle of each part: that of the node, but for the ends.
static void test_line(void **state)
{
    (void)state;
    double integral = 0, *factors = factors_of("1 + x", 10, &integral);
    assert_near("all", integral, 1.5, 1e-12);
    assert_near("inside", factors[3], 1.3, 1e-12);
    assert_near("first", factors[0], 1.025, 1e-12);
    free(factors);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_jumps), cmocka_unit_test(test_line)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
