// SPDX-License-Identifier: GPL-2.0-or-later
// Friction along the contact: wherever nodes lie, together they hold what the formula says.
#include "model/contact_nodes.h"
#include "run/simulation_state.h"

#include "near.h"
#include "small_scene.h"

#include "base/memory.h"

enum { NODES_MAX = 64 };

static const char jumps[] = "points(x, 0.15, 0.6, 0.15, 1, 0.85, 1, 0.85, 0.6)";
static const double jumps_integral = 1 - 2 * 0.15 * 0.4;

// Reads the factor of each node's threshold. Returns the sum of weights times factors.
static double read_factors(const Model *model, double factors[NODES_MAX])
{
    const Interface *interface = &model->interface;
    double sum = 0;
    assert_in_range(interface->contact_count, 1, NODES_MAX);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        factors[i] = model->friction_nodes[i].factor;
        sum += factors[i] * interface->weight[i];
    }
    return sum;
}

// Factors of the block with so many cells; mesh: further settings.
static double block_factors(const char *along, int32_t cells, const char *mesh,
                            double factors[NODES_MAX])
{
    char friction[200], count[40];
    Simulation *simulation = NULL;
    Error err = {0};
    snprintf(friction, sizeof friction, "friction.along=%s", along);
    snprintf(count, sizeof count, "mesh.set.nx=%d", cells);
    Scene *scene =
        small_scene((const char *const[]){friction, count, "friction.mu_static=0.38", mesh, NULL});
    if (!amontons_simulation_create(scene, &(RunOptions){0}, &simulation, &err))
        fail_msg("%s", err.message);
    double sum = read_factors(&simulation->model, factors);
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(scene);
    return sum;
}

// Ends of 0.15 at 0.6, which begin at a node, within a cell, or half way between nodes; nodes
// within edges, whose weights are Simpson's, and cells that differ.
TEST(test_jumps)
{
    static const int32_t cells[] = {10, 14, 20};
    static const char *const meshes[] = {"mesh.set.order=1", "mesh.set.order=2",
                                         "mesh.set.grade_x=3"};
    double factors[NODES_MAX];
    for (int32_t k = 0; k < 9; k++) {
        int32_t count = cells[k % 3];
        double integral = block_factors(jumps, count, meshes[k / 3], factors);
        assert_near(meshes[k / 3], integral, jumps_integral, 2 * 0.4 * 2.0 / (32 * count));
        assert_near("end", factors[0], 0.6, 1e-12);
        assert_near("middle", factors[count / 2], 1, 1e-12);
    }
}

// A straight line has its value at the middle of each part: that of the node, but for the ends of
// the contact and nodes between cells that differ.
TEST(test_line)
{
    double factors[NODES_MAX];
    assert_near("all", block_factors("1 + x", 10, "mesh.set.order=1", factors), 1.5, 1e-12);
    assert_near("inside", factors[3], 1.3, 1e-12);
    assert_near("first", factors[0], 1.025, 1e-12);
    assert_near("all, order 2", block_factors("1 + x", 10, "mesh.set.order=2", factors), 1.5,
                1e-12);
    assert_near("between edges", factors[6], 1.3, 1e-12);
    assert_near("within one", factors[7], 1.35, 1e-12);
    assert_near("first, order 2", factors[0], 1 + 0.1 / 12, 1e-12);
    assert_near("all, graded", block_factors("1 + x", 10, "mesh.set.grade_x=3", factors), 1.5,
                1e-12);
}

// Where pads share a node and where a gap lies within one: parts neither shift nor reach over it.
TEST(test_pads)
{
    double x[] = {0, 0.2, 0.4, 0.6, 0.7, 1, 1.2}, weight[] = {0.1, 0.2, 0.2, 0.15, 0.05, 0.1, 0.1};
    int32_t pad[] = {0, 0, 0, 0, 1, 1, 1};
    char names[2][GROUP_NAME_SIZE] = {"contact_1", "contact_2"};
    double factors[NODES_MAX];
    Error err = {0};
    Scene *scene = small_scene((const char *const[]){
        "friction.along=points(x, 0.6, 1, 0.6, 0.5, 0.68, 0.5, 0.68, 2, 1, 2, 1.2, 4)",
        "friction.mu_static=0.38", NULL});
    Model model = {.scene = scene,
                   .interface = {.dim = 2,
                                 .contact_count = 7,
                                 .x = x,
                                 .weight = weight,
                                 .pad = pad,
                                 .pad_count = 2,
                                 .pad_name = names}};
    if (!model_lay_laws(&model, &err)) fail_msg("%s", err.message);
    read_factors(&model, factors);
    static const double wanted[] = {1, 1, 1, (2 + 0.5) / 3, (3 * 0.5 + 2 * 2) / 5, 2.5, 3.5};
    for (int32_t i = 0; i < 7; i++) assert_near("pads", factors[i], wanted[i], 1.5 / 32);
    memory_free_all(model.friction_nodes, model.laws);
    amontons_scene_destroy(scene);
}
