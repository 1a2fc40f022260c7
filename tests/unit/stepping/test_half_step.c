// SPDX-License-Identifier: GPL-2.0-or-later
// A block in space stepped on one side and as a whole: the same steps; what is certified of the
// whole is what is certified of both halves; and who pushes it aside gets the whole.
#include "reduction/mirror.h"
#include "reduction/reduction.h"
#include "space_rig.h"
#include "stepping/step_control.h"

typedef struct Pushed {
    BlockRig rig;
    ReducedBulk reduced;   // empty: the mesh itself is stepped
    BulkOperator small;   // of it
    StepControl control;
    FrictionNode *nodes;   // [contact_count]; owned
} Pushed;

// mu is rise[0] x + rise[1] y higher than at the corner.
static void pushed_vary(const double rise[2], Pushed *pushed)
{
    Error err = {0};
    const Interface *interface = &pushed->rig.interface;
    pushed->nodes = NEW_ARRAY(FrictionNode, interface->contact_count, &err);
    for (int32_t i = 0; i < interface->contact_count; i++)
        pushed->nodes[i] = friction_node(&pushed->rig.law,
                                         1 + rise[0] * interface->x[i] + rise[1] * interface->y[i]);
    pushed->rig.friction = friction_of_nodes(pushed->nodes, interface->contact_count);
}

typedef struct PushedDef {
    SpaceDef shape;
    RigDef rig;
    double pressure, velocity;   // of the load and of the rod
    bool reduced;
} PushedDef;

// The rig's block is stepped by the four parts of its mesh.
static void pushed_reduce(const PushedDef *def, Pushed *pushed)
{
    Error err = {0};
    BlockRig *rig = &pushed->rig;
    Material material = def->rig.material;
    double length = def->shape.size[0];
    int32_t *image[2], dofs = rig->bulk.dof_count;
    material.plane_strain = true;
    for (int32_t axis = 0; axis < 2; axis++) {
        double *position = hand_matrix(dofs, 1);
        memcpy(position, rig->mesh.position, (size_t)dofs * sizeof *position);
        assert_true(mirror_nodes_find(3, axis, position, dofs / 3, &image[axis], &err));
        free(position);
    }
    ReductionDef reduction = {.tolerance = 1e-2,
                              .materials = materials_of(&material),
                              .no_patches = true,
                              .node_image = image,
                              .position = rig->mesh.position,
                              .scales = {material.young * length,
                                         (material.eta1 + material.eta2) * length,
                                         material.density * length * length * length,
                                         dense_max_abs(rig->bulk.load, dofs)}};
    assert_true(reduction_build(&rig->bulk, rig->interface.dofs, rig->interface.count, &reduction,
                                &pushed->reduced, &err));
    assert_int_equal(pushed->reduced.part_count, 4);
    assert_true(bulk_operator_reduce(&pushed->reduced, length, rig->system.mass_total,
                                     &pushed->small, &err));
    rig->block.system = &pushed->small;
    for (int32_t axis = 0; axis < 2; axis++) memory_free(image[axis]);
}

// The rod along the breadth. rise: of friction; NULL: it is the same everywhere.
static void pushed_build_of(const PushedDef *def, const double *rise, Pushed *pushed)
{
    Error err = {0};
    int64_t count = 0;
    StepControlDef steps = {.tolerance = 2e-6,
                            .step_max = 2,
                            .step_min = 1e-7,
                            .wave_step = 0.1,
                            .use_certificate = true};
    space_rig_build(&def->shape, &def->rig, (double[]){0, 0, -def->pressure}, &pushed->rig);
    BlockRig *rig = &pushed->rig;
    pushed->nodes = NULL;
    pushed->reduced = (ReducedBulk){0};
    if (def->reduced) pushed_reduce(def, pushed);
    if (rise) pushed_vary(rise, pushed);
    assert_true(step_control_create(&rig->block, &steps, &pushed->control, &err));
    RelaxationDef relaxation = {.speed_max = 1e-9, .duration_max = 1e5};
    assert_true(relax(&pushed->control, &relaxation, &count, &err));
    for (int32_t j = 0; j < rig->interface.rod_count; j++)
        rig->rod.origin[j] =
            pushed->control.now
                .displacement[rig->block.system->interface_dofs[interface_rod(&rig->interface, j)]];
    assert_true(rig->interface.rod_count > 1);
    rig->rod.kind = ROD_PUSHES;
    rig->rod.velocity = def->velocity;
    step_control_restart(&pushed->control);
}

// Half as high as long.
static void pushed_build_by(const int32_t cells[3], const double *rise, bool reduced,
                            Pushed *pushed)
{
    PushedDef def = {.shape = {.kind = ELEMENT_HEX8,
                               .cells = {cells[0], cells[1], cells[2]},
                               .size = {0.5, 0.5, 0.25}},
                     .rig = rig_def(),
                     .pressure = 0.003,
                     .velocity = 1e-4,
                     .reduced = reduced};
    def.rig.rod_kind = ROD_AWAY;
    def.rig.rod_width = 0.13;
    pushed_build_of(&def, rise, pushed);
}

static void pushed_build(const int32_t cells[3], const double *rise, Pushed *pushed)
{
    pushed_build_by(cells, rise, false, pushed);
}

static void pushed_destroy(Pushed *pushed)
{
    step_control_destroy(&pushed->control);
    if (pushed->reduced.part_count > 0) bulk_operator_destroy(&pushed->small);
    reduced_bulk_destroy(&pushed->reduced);
    rig_destroy(&pushed->rig);
    memory_free(pushed->nodes);
}

static void compare_certificates(StepControl *control)
{
    const State *now = &control->now, *one = half_step_fold(&control->half, now);
    bool even = certificate_holds(&control->half.symmetric, one, 0);
    bool odd = certificate_holds(&control->half.antisymmetric, one, 0);
    assert_int_equal(certificate_holds(&control->certificate, now, 0), even && odd);
}

// [dof_count] a motion or force that is opposite on both sides, largest entry 1.
static double *antisymmetric_vector(const Pushed *pushed)
{
    const SymmetricPart *part = &pushed->control.half.bulk;
    int32_t dofs = part->system->dof_count;
    double *x = hand_matrix(dofs, 1), *even = hand_matrix(dofs, 1);
    Random random = {.state = 5};
    for (int32_t k = 0; k < dofs; k++) x[k] = random_between(&random, -1, 1);
    symmetric_part_take(part, x, even);
    for (int32_t k = 0; k < dofs; k++) x[k] -= even[k];
    double largest = dense_max_abs(x, dofs);
    for (int32_t k = 0; k < dofs; k++) x[k] /= largest;
    free(even);
    return x;
}

// Whoever asks between steps finds the whole bulk acting.
static void check_all_acts(const Pushed *pushed, const double *odd)
{
    const BulkOperator *system = pushed->rig.block.system;
    double *force = hand_matrix(system->dof_count, 1);
    bulk_operator_apply(system, BULK_STIFFNESS, odd, force);
    assert_true(dense_max_abs(force, system->dof_count) > 1e-3);
    free(force);
}

static void same_steps(const int32_t cells[3], const double *rise, bool reduced)
{
    Error err = {0};
    Pushed half, whole;
    int32_t halved = 0, certified = 0, count = 0, slipping = 0, alone = 0;
    pushed_build_by(cells, rise, reduced, &half);
    pushed_build_by(cells, rise, reduced, &whole);
    whole.control.asymmetric = true;
    assert_true(half.control.half.exists);
    double *odd = antisymmetric_vector(&half);
    for (; half.control.now.time < 45; count++) {
        assert_true(step_control_advance(&half.control, INFINITY, &err));
        assert_true(step_control_advance(&whole.control, INFINITY, &err));
        const State *one = &half.control.now, *other = &whole.control.now;
        assert_near("time", one->time, other->time, 1e-12);
        // Each solve is settled to 1e-12, and slip that weakens amplifies what is left.
        assert_all_near("u", one->displacement, other->displacement, one->dof_count, 1e-9);
        assert_all_near("r", one->reaction, other->reaction, one->interface_count, 1e-9);
        assert_memory_equal(one->status, other->status, (size_t)one->contact_count);
        assert_int_equal(half.control.certified, whole.control.certified);
        halved += half.control.scheme.part == PART_SYMMETRIC;
        alone += half.control.scheme.symmetric_alone;
        assert_false(whole.control.scheme.symmetric_alone);
        check_all_acts(&half, odd);
        certified += half.control.certified;
        slipping += one->status[one->contact_count / 2] != CONTACT_STICK;
        compare_certificates(&half.control);
    }
    assert_false(half.control.asymmetric);
    print_message("%d steps, %d on one side, %d without the other part of the bulk, %d certified\n",
                  count, halved, alone, certified);
    assert_true(halved > 0.8 * count && certified < count && slipping > 10);
    assert_true(reduced ? alone > 0.5 * count && alone < count : alone == 0);
    free(odd);
    pushed_destroy(&half);
    pushed_destroy(&whole);
}

// With nodes on the middle line, and without.
TEST(test_same_steps)
{
    same_steps((int32_t[]){4, 4, 2}, NULL, false);
    same_steps((int32_t[]){4, 3, 2}, NULL, false);
    same_steps((int32_t[]){4, 4, 2}, NULL, true);
}

TEST(test_friction_that_differs)
{
    Error err = {0};
    Pushed across;
    same_steps((int32_t[]){4, 4, 2}, (double[]){0.4, 0}, false);
    pushed_build((int32_t[]){4, 4, 2}, (double[]){0.4, 1e-12}, &across);
    assert_true(step_control_advance(&across.control, INFINITY, &err));
    assert_true(across.control.half.exists);
    assert_int_equal(across.control.scheme.part, PART_WHOLE);   // not its own mirror image
    pushed_destroy(&across);
}

// All of one side move by way * (1, 1, 0), those of the other by way * (-1, 1, 0).
static void push_aside(double way, Pushed *pushed)
{
    State *now = &pushed->control.now;
    const Mesh *mesh = &pushed->rig.mesh;
    double breadth = 0;
    for (int32_t i = 0; i < mesh->node_count; i++)
        breadth = fmax(breadth, mesh->position[3 * i + 1]);
    for (int32_t i = 0; i < mesh->node_count; i++) {
        now->velocity[3 * i] += mesh->position[3 * i + 1] < 0.5 * breadth ? way : -way;
        now->velocity[3 * i + 1] += way;
    }
    for (int32_t k = 0; k < now->interface_count; k++)
        now->slip_rate[k] = now->velocity[pushed->rig.interface.dofs[k]];
    bulk_operator_apply(pushed->control.scheme.system, BULK_MASS, now->velocity, now->momentum);
}

// The bulk gets velocities that are opposite on both sides.
static void push_bulk_aside(double way, Pushed *pushed)
{
    State *now = &pushed->control.now;
    const BulkOperator *system = pushed->rig.block.system;
    double *odd = antisymmetric_vector(pushed);
    for (int32_t k = 0; k < now->dof_count; k++) now->velocity[k] += way * odd[k];
    for (int32_t k = 0; k < now->interface_count; k++)
        now->slip_rate[k] = now->velocity[system->interface_dofs[k]];
    bulk_operator_apply(system, BULK_MASS, now->velocity, now->momentum);
    free(odd);
}

// An antisymmetric part above rounding is found at once; later steps are those of the whole.
static void pushed_aside(bool reduced)
{
    Error err = {0};
    Pushed half, whole;
    const int32_t cells[] = {4, 4, 2};
    pushed_build_by(cells, NULL, reduced, &half);
    pushed_build_by(cells, NULL, reduced, &whole);
    whole.control.asymmetric = true;
    Pushed *both[] = {&half, &whole};
    for (int32_t k = 0; k < 2; k++) {
        while (both[k]->control.now.time < 12)
            assert_true(step_control_advance(&both[k]->control, INFINITY, &err));
        if (reduced)
            push_bulk_aside(1e-6, both[k]);
        else
            push_aside(1e-6, both[k]);
    }
    assert_false(half.control.asymmetric);
    for (int32_t k = 0; k < 40; k++) {
        assert_true(step_control_advance(&half.control, INFINITY, &err));
        assert_true(step_control_advance(&whole.control, INFINITY, &err));
        assert_all_near("u", half.control.now.displacement, whole.control.now.displacement,
                        half.control.now.dof_count, 1e-11);
    }
    assert_true(half.control.asymmetric);
    // Those of one side are freed.
    for (int32_t k = 0; k < half.control.dt_levels.level_count; k++)
        assert_null(half.control.dt_levels.contact[PART_SYMMETRIC][k].schur);
    pushed_destroy(&half);
    pushed_destroy(&whole);
}

TEST(test_pushed_aside)
{
    pushed_aside(false);
    pushed_aside(true);
}

// A disturbance to one side below what counts as such (1e-9 of 1e-4) and above rounding (1e-12), in
// a state in which it might grow: to first order it does what it does to the whole, which is pushed
// further, as its solver settles slip rates to 1e-12 only.
TEST(test_odd_is_followed)
{
    enum { STEPS = 12 };
    Error err = {0};
    Pushed half, whole;
    double odd[2][STEPS], way[] = {3e-15, 1e-13};
    int32_t acting = 0;
    const int32_t cells[] = {4, 4, 2};
    pushed_build(cells, NULL, &half);
    pushed_build(cells, NULL, &whole);
    whole.control.asymmetric = true;
    while (half.control.antisymmetric_decays) {
        assert_true(half.control.now.time < 60);
        assert_true(step_control_advance(&half.control, INFINITY, &err));
        assert_true(step_control_advance(&whole.control, INFINITY, &err));
    }
    Pushed *both[] = {&half, &whole};
    for (int32_t k = 0; k < 2; k++) {
        push_aside(way[k], both[k]);
        for (int32_t n = 0; n < STEPS; n++) {
            const State *now = &both[k]->control.now;
            const Interface *interface = &both[k]->rig.interface;
            assert_true(step_control_advance(&both[k]->control, INFINITY, &err));
            acting += k == 0 && !half.control.antisymmetric_decays;
            odd[k][n] = 0;
            for (int32_t i = 0; i < interface->contact_count; i++)
                odd[k][n] += (interface->y[i] - 0.25) * now->slip_rate[3 * i];
        }
    }
    assert_false(half.control.asymmetric);
    assert_true(acting > 0);
    for (int32_t n = 0; n < acting; n++)
        assert_near("odd", odd[0][n] / way[0], odd[1][n] / way[1], 2e-2 * fabs(odd[1][0] / way[1]));
    pushed_destroy(&half);
    pushed_destroy(&whole);
}

// The block of Iwashita, Matsukawa & Otsuki (2023), twice as broad as long and as high
// (validation/space/papers.yaml).
static void build_of_2023(Pushed *pushed)
{
    PushedDef def = {.shape = {.kind = ELEMENT_HEX8, .cells = {8, 16, 8}, .size = {1, 2, 1}},
                     .rig = rig_def(),
                     .pressure = 0.006,
                     .velocity = 2.83e-5};
    def.rig.rod_kind = ROD_AWAY;
    def.rig.rod_width = 0.13;
    def.rig.material.eta1 = def.rig.material.eta2 = 1.41;
    def.rig.law.critical_velocity = 4.81e-4;
    pushed_build_of(&def, NULL, pushed);
}

// The largest velocity that a node of the contact and its image have not alike, over the largest.
static double uneven(const Pushed *pushed)
{
    const Interface *interface = &pushed->rig.interface;
    const double *rate = pushed->control.now.slip_rate;
    double most = 0, off = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t across = 0;
        while (fabs(interface->x[across] - interface->x[i]) > 1e-9 ||
               fabs(interface->y[across] + interface->y[i] - 2) > 1e-9)
            across++;
        for (int32_t c = 0; c < 3; c++) {
            double there = (c == 1 ? -1 : 1) * rate[3 * across + c];
            off = fmax(off, fabs(rate[3 * i + c] - there));
            most = fmax(most, fabs(rate[3 * i + c]));
        }
    }
    return off / most;
}

// Rounding that weakening amplifies in each event, while friction holds what the one before has
// left of it: it comes to 1e-9 in the first slidings where nothing drops it.
TEST(test_stays_symmetric)
{
    Error err = {0};
    Pushed pushed;
    int32_t count = 0, acting = 0;
    double largest = 0;
    build_of_2023(&pushed);
    StepControl *control = &pushed.control;
    for (; control->now.time < 200; count++) {
        assert_true(step_control_advance(control, INFINITY, &err));
        acting += !control->antisymmetric_decays;
        largest = fmax(largest, uneven(&pushed));
        if (control->antisymmetric_decays) assert_false(uneven(&pushed) > 1e-15);
    }
    print_message("%d steps, %d of them might amplify, %g at most\n", count, acting, largest);
    assert_false(control->asymmetric);
    assert_true(acting > 10);
    pushed_destroy(&pushed);
}

// Runs to the last event before the first sliding, and pushes the block aside where its symmetric
// and antisymmetric part might amplify that; then takes steps until it leaves its half, or so many.
static int32_t disturb_event(double way, bool whole, int32_t steps, double *rates, Pushed *pushed)
{
    Error err = {0};
    StepControl *control = &pushed->control;
    build_of_2023(pushed);
    while (control->now.time < 160 || control->antisymmetric_decays)
        assert_true(step_control_advance(control, INFINITY, &err));
    push_aside(way, pushed);
    control->asymmetric = whole;
    for (int32_t n = 0; n < steps; n++) {
        assert_true(step_control_advance(control, INFINITY, &err));
        if (control->asymmetric && !whole) return n;
        rates[n] = uneven(pushed);
    }
    return steps;
}

// A disturbance that passes for rounding is amplified in an event, as a run that is solved whole
// shows: it is followed, and above 1e-9 the run leaves its half for good. A tenth of it, some 500
// times what rounding adds, is followed by the same factors and is dropped where it decays.
TEST(test_symmetry_breaks)
{
    enum { STEPS = 60, AFTER = 10 };
    double rates[3][STEPS];
    Pushed breaks, stays, whole;
    Error err = {0};
    int32_t count = disturb_event(2e-13, false, STEPS, rates[0], &breaks);
    assert_in_range(count, 3, STEPS - 1);
    assert_int_equal(disturb_event(2e-14, false, count, rates[1], &stays), count);
    disturb_event(2e-13, true, count, rates[2], &whole);
    for (int32_t n = 0; n < count; n++) {
        assert_near("whole", rates[0][n] / rates[2][n], 1, 0.02);
        assert_near("linear", rates[0][n] / rates[1][n], 10, 0.1);
    }
    assert_true(breaks.control.asymmetric && breaks.control.scheme.part == PART_WHOLE);
    assert_true(uneven(&breaks) > 1e-9);
    for (int32_t n = 0; n < AFTER && !stays.control.antisymmetric_decays; n++)
        assert_true(step_control_advance(&stays.control, INFINITY, &err));
    assert_true(step_control_advance(&stays.control, INFINITY, &err));
    assert_false(stays.control.asymmetric || uneven(&stays) > 1e-14);
    pushed_destroy(&breaks);
    pushed_destroy(&stays);
    pushed_destroy(&whole);
}
