// SPDX-License-Identifier: GPL-2.0-or-later
// J^-1 x by factors against the derivative itself (the tests of contact/contact_equations have it
// against differences); problems solved with them.
#define HAND_NODES 80

#include "contact/contact_newton.h"

#include "contact_by_hand.h"

enum { OPEN = 20, RODS = 2, COUNT = 2 * HAND_NODES + RODS };

typedef struct Rig {
    HandContact hand;
    ContactMatrix matrix;
    ContactProblem problem;
    ContactSolution at;
    ContactEquations equations;
    int32_t free[COUNT];
    ContactRow row[COUNT];
    ContactFactors factors;
} Rig;

static const double softness[RODS] = {0.5, 0};

// Slow slip and fast, pressed nodes, v_c = 1.
static void make_rig(Random *random, double coupling, Rig *rig)
{
    Error err = {0};
    HandContact *hand = &rig->hand;
    hand_contact_size(hand, HAND_NODES, RODS);
    hand->law = (FrictionLaw){.kind = FRICTION_LINEAR_WEAKENING,
                              .mu_static = 0.6,
                              .mu_kinetic = 0.2,
                              .critical_velocity = 1};
    hand->rod_softness = softness;
    hand->rod_reach = 0.5;
    hand_random_schur(random, 1, coupling, hand);
    assert_true(contact_matrix_create(hand->schur, COUNT, &rig->matrix, &err));
    rig->problem = hand_problem(hand, &rig->matrix);
    rig->at = (ContactSolution){hand->velocity, hand->reaction, hand->status, hand->rod_touches};
    rig->equations = (ContactEquations){&rig->problem, &rig->at, rig->free, 0, rig->row};
    for (int32_t k = 0; k < COUNT; k++) {
        hand->velocity[k] = random_between(random, 0.1, 4);
        hand->reaction[k] = random_between(random, 0, 0.2);
    }
    for (int32_t i = 0; i < HAND_NODES; i++)
        hand->status[i] = i < OPEN ? CONTACT_OPEN : CONTACT_SLIP_FORWARD;
    assert_true(contact_factors_create(&hand->interface, &rig->factors, &err));
}

static void end_rig(Rig *rig)
{
    contact_factors_destroy(&rig->factors);
    contact_matrix_destroy(&rig->matrix);
}

// Open nodes are free here, as S is that of all.
static void list_free(Rig *rig)
{
    ContactEquations *equations = &rig->equations;
    contact_list_free(equations);
    for (int32_t k = 0; k < 2 * HAND_NODES; k++)
        if (rig->hand.status[k / 2] == CONTACT_OPEN) equations->free[equations->free_count++] = k;
    contact_find_rows(&rig->equations);
}

// Another status, speed or pressing force at a node that is closed, or a rod node that comes or
// goes.
static void change_something(Random *random, Rig *rig)
{
    int32_t i = OPEN + random_index(random, HAND_NODES - OPEN), what = random_index(random, 8);
    if (what == 0) rig->at.rod_touches[i % RODS] = !rig->at.rod_touches[i % RODS];
    if (what == 1) rig->at.reaction[2 * i + 1] = random_between(random, 0, 0.2);
    if (what == 2 || what == 3) rig->at.velocity[2 * i] = random_between(random, 0.1, 4);
    if (what > 3) rig->at.status[i] = (uint8_t)(CONTACT_STICK + random_index(random, 3));
    if (what > 5) rig->at.status[i] = CONTACT_SLIP_FORWARD;
    rig->at.velocity[2 * i] =
        copysign(rig->at.velocity[2 * i], rig->at.status[i] == CONTACT_SLIP_BACKWARD ? -1 : 1);
}

static void expect_solves(Random *random, Rig *rig)
{
    static double jacobian[COUNT * COUNT];
    double right[COUNT], x[COUNT];
    int32_t rows = rig->equations.free_count;
    contact_jacobian(&rig->equations, rig->hand.schur, rows, jacobian);
    for (int32_t a = 0; a < rows; a++) x[a] = right[a] = random_between(random, -1, 1);
    contact_factors_solve(&rig->factors, x);
    for (int32_t a = 0; a < rows; a++) {
        double sum = 0;
        for (int32_t b = 0; b < rows; b++) sum += jacobian[b * rows + a] * x[b];
        assert_near("J x", sum, right[a], 1e-10);
    }
}

TEST(test_solves)
{
    static Rig rig;
    Random random = {.state = 3};
    make_rig(&random, 0.5, &rig);
    for (int32_t trial = 0; trial < 40; trial++) {
        change_something(&random, &rig);
        list_free(&rig);
        assert_true(contact_factors_make(&rig.factors, &rig.equations, rig.hand.schur));
        expect_solves(&random, &rig);
    }
    end_rig(&rig);
}

// Writes one and reads it into the other. Returns false if it is refused.
static bool read_back(ContactFactors *from, ContactFactors *into, Error *err)
{
    static char bytes[4 * 8 * COUNT * COUNT];
    Archive archive = archive_write(bytes, sizeof bytes);
    contact_factors_archive(from, COUNT, &archive);
    archive = archive_read(bytes, archive.at);
    contact_factors_archive(into, COUNT, &archive);
    return archive_check(&archive, true, err);
}

// Read back they give the same bits.
TEST(test_archive)
{
    static Rig rig;
    Error err = {0};
    Random random = {.state = 4};
    ContactFactors copy;
    double x[COUNT], y[COUNT];
    make_rig(&random, 0.5, &rig);
    assert_true(contact_factors_create(&rig.hand.interface, &copy, &err));
    list_free(&rig);
    assert_true(contact_factors_make(&rig.factors, &rig.equations, rig.hand.schur));
    assert_true(read_back(&rig.factors, &copy, &err));
    for (int32_t a = 0; a < COUNT; a++) x[a] = y[a] = random_between(&random, -1, 1);
    contact_factors_solve(&rig.factors, x);
    contact_factors_solve(&copy, y);
    assert_memory_equal(x, y, sizeof x);
    contact_factors_destroy(&copy);
    end_rig(&rig);
}

// Loads that change a little from one problem to the next: solved from where the last one ended.
TEST(test_solver)
{
    static Rig rig;
    Error err = {0};
    Random random = {.state = 6};
    ContactSolver solver;
    make_rig(&random, 0.05, &rig);
    HandContact *hand = &rig.hand;
    hand->law.kind = FRICTION_COULOMB;   // statuses alone change
    assert_true(contact_solver_create(&hand->interface, &solver, &err));
    for (int32_t k = 0; k < COUNT; k++)
        hand->g[k] = k >= 2 * HAND_NODES ? 0 : k % 2 ? -1 : random_between(&random, 0.2, 3);
    int64_t allocations = memory_counters().allocations;
    for (int32_t round = 0; round < 200; round++) {
        hand->g[2 * random_index(&random, HAND_NODES)] = random_between(&random, 0.2, 3);
        assert_true(contact_solve(&solver, &rig.problem, &rig.at));
        assert_near("judged", hand_contact_error(hand), 0, 1e-10);
    }
    assert_int_equal(memory_counters().allocations, allocations);
    contact_solver_destroy(&solver);
    end_rig(&rig);
}
