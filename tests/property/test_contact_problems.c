// SPDX-License-Identifier: GPL-2.0-or-later
// Random contact problems. Large ones with moderate friction are solved, rightly, from any guess.
// Small ones are also solved by trying every combination of statuses: what the active set gives up
// is held against what there is to be found.
#include "base/memory.h"
#include "contact_by_hand.h"
#include "dense_by_hand.h"
#include "own_laws.h"
#include "plane.h"

static void random_loads(Random *random, HandContact *hand)
{
    for (int32_t i = 0; i < hand->interface.contact_count; i++) {
        hand->g[plane_tangent(i)] = random_between(random, -3, 3);
        hand->g[plane_normal(i)] = random_between(random, -4, 1.5);
        hand->bound[plane_normal(i)] = random_between(random, -0.4, 0.1);
    }
    for (int32_t j = 0; j < hand->interface.rod_count; j++) {
        hand->g[interface_rod(&hand->interface, j)] = random_between(random, -1, 1);
        hand->bound[interface_rod(&hand->interface, j)] = random_between(random, -0.5, 0.5);
    }
}

static void random_statuses(Random *random, HandContact *hand)
{
    for (int32_t i = 0; i < hand->interface.contact_count; i++)
        hand->status[i] = (uint8_t)random_index(random, 4);
    for (int32_t j = 0; j < hand->interface.rod_count; j++)
        hand->rod_touches[j] = (uint8_t)random_index(random, 2);
}

static HandContact hand, other;   // large; a test runs alone

// Up to 40 nodes and 4 rod nodes, the three laws in turn, friction and weakening small against S.
TEST(test_large_problems)
{
    Random random = {.state = 31};
    int32_t seen[4] = {0}, touching = 0;
    for (int32_t trial = 0; trial < 150; trial++) {
        hand_contact_size(&hand, 1 + random_index(&random, HAND_NODES),
                          random_index(&random, HAND_RODS + 1));
        hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 3),
                                 .mu_static = random_between(&random, 0.1, 0.5),
                                 .mu_kinetic = 0.1,
                                 .critical_velocity = random_between(&random, 0.8, 3)};
        if (trial % 5 == 0) hand.rod_kind = ROD_IS_BONDED;
        hand_random_schur(&random, 3, 0.5, &hand);
        random_loads(&random, &hand);
        random_statuses(&random, &hand);
        if (!hand_contact_solve(&hand))
            fail_msg("trial %d with %d nodes is not solved", trial, hand.interface.contact_count);
        assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
        other = hand;
        random_statuses(&random, &other);
        if (trial % 2) memset(other.status, CONTACT_STICK, sizeof other.status);
        assert_true(hand_contact_solve(&other));
        assert_all_near("from another guess", other.velocity, hand.velocity, hand.interface.count,
                        1e-8);
        for (int32_t i = 0; i < hand.interface.contact_count; i++) seen[hand.status[i]]++;
        for (int32_t j = 0; j < hand.interface.rod_count; j++) touching += hand.rod_touches[j];
    }
    for (int k = 0; k < 4; k++) assert_true(seen[k] > 200);   // the cases are not one-sided
    assert_true(touching > 50);
}

// A random table: it falls, and may rise again at each point, up to `highest`.
static FrictionLaw random_table(Random *random, double spacing, bool straight, double highest)
{
    enum { POINTS = 6 };
    double velocity[POINTS] = {0}, mu[POINTS] = {random_between(random, 0.3, 0.5)};
    for (int32_t k = 1; k < POINTS; k++) {
        velocity[k] = velocity[k - 1] + spacing * random_between(random, 0.3, 1);
        mu[k] = random_between(random, 0.2, highest);
    }
    return own_table(POINTS, velocity, mu, straight);
}

static int32_t piece_of(const FrictionTable *table, double speed)
{
    int32_t piece = 0;
    while (piece + 1 < table->count && speed >= table->speed[piece + 1]) piece++;
    return piece;
}

// The same with tables that weaken and strengthen, half of them to more than at rest, of cubics and
// of lines with a kink at each point. Every other problem is small and has changes so steep that
// sweeps are needed.
TEST(test_own_laws)
{
    Random random = {.state = 32};
    int32_t pieces[8] = {0};
    int64_t rescued = 0;
    for (int32_t trial = 0; trial < 400; trial++) {
        bool small = trial % 4 < 2;
        hand_contact_size(&hand, 1 + random_index(&random, small ? 6 : HAND_NODES), 2);
        hand.law = random_table(&random, small ? 0.015 : 0.4, trial % 2, trial < 200 ? 0.3 : 0.8);
        hand_random_schur(&random, 3, 0.5, &hand);
        random_loads(&random, &hand);
        random_statuses(&random, &hand);
        HandCounts counts;
        if (!hand_contact_solve_by(&hand, true, &counts)) fail_msg("trial %d is not solved", trial);
        rescued += counts.rescued;
        assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
        for (int32_t i = 0; i < hand.interface.contact_count; i++)
            if (status_slips(hand.status[i]))
                pieces[piece_of(&hand.law.table, fabs(hand.velocity[2 * i]))]++;
    }
    print_message("nodes on pieces 0 to 3: %d %d %d %d, %d by sweeps\n", pieces[0], pieces[1],
                  pieces[2], pieces[3], (int)rescued);
    for (int32_t k = 0; k < 3; k++) assert_true(pieces[k] > 20);
    assert_true(rescued > 5);
}

// --- every combination of statuses --------------------------------------------------------------
typedef enum Branch { OPEN, STICK, FORWARD, BACKWARD } Branch;

// A law given by a table of lines: mu of piece k at rest and its slope, level beyond the
// last point.
static void table_piece(const FrictionTable *table, int32_t k, double *at_rest, double *slope)
{
    bool last = k == table->count - 1;
    *slope = last ? 0 : (table->mu[k + 1] - table->mu[k]) / (table->speed[k + 1] - table->speed[k]);
    *at_rest = table->mu[k] - *slope * table->speed[k];
}

// State of node i in this combination: a branch, and there the law's piece.
typedef struct Choice {
    Branch branch;
    double mu, slope;   // mu + slope |v_t|
} Choice;

static int32_t choices_of(const FrictionLaw *law)
{
    if (law->kind == FRICTION_TABLE) return 2 + 2 * law->table.count;
    return law->kind == FRICTION_LINEAR_WEAKENING ? 6 : 4;
}

static Choice choice_of(const FrictionLaw *law, int32_t k)
{
    Choice choice = {.branch = k < 2   ? (Branch)k
                               : k % 2 ? BACKWARD
                                       : FORWARD,
                     .mu = law->mu_static};
    int32_t piece = (k - 2) / 2;
    if (k < 2) return choice;
    if (law->kind == FRICTION_TABLE) table_piece(&law->table, piece, &choice.mu, &choice.slope);
    if (law->kind != FRICTION_LINEAR_WEAKENING) return choice;
    if (piece == 1)
        choice.mu = law->mu_kinetic;
    else
        choice.slope = -(law->mu_static - law->mu_kinetic) / law->critical_velocity;
    return choice;
}

// One linear system. pressing: [nodes] r_n where it is known beforehand; NULL: slopes are left out.
static bool solve_choices(const HandContact *problem, const Choice *choice, const double *pressing,
                          double *velocity)
{
    int32_t count = problem->interface.count;
    double a[8 * 8];
    for (int32_t row = 0; row < count; row++) {
        const Choice *at = &choice[row / 2];
        int32_t n = row | 1;
        bool tangent = row % 2 == 0;
        bool held = tangent ? at->branch == STICK : at->branch != OPEN;
        double sign = at->branch == FORWARD ? 1 : -1;
        double mu = tangent && at->branch != OPEN ? sign * at->mu : 0;
        for (int32_t column = 0; column < count; column++)
            a[column * count + row] = held ? column == row
                                           : problem->schur[column * count + row] +
                                                 mu * problem->schur[column * count + n];
        velocity[row] = problem->g[row] + mu * problem->g[n];
        if (held) velocity[row] = tangent ? 0 : problem->bound[row];
        if (pressing && tangent && !held) a[row * count + row] += at->slope * pressing[row / 2];
    }
    return hand_solve(a, count, velocity, 1);
}

static void find_reaction(HandContact *found)
{
    int32_t count = found->interface.count;
    hand_apply(found->schur, count, count, found->velocity, found->reaction);
    for (int32_t k = 0; k < count; k++) found->reaction[k] -= found->g[k];
}

// How many combinations keep all conditions.
static int32_t count_solutions(const HandContact *problem)
{
    int32_t nodes = problem->interface.contact_count, choices = choices_of(&problem->law);
    int32_t combinations = 1, solutions = 0;
    for (int32_t i = 0; i < nodes; i++) combinations *= choices;
    other = *problem;
    for (int32_t c = 0; c < combinations; c++) {
        Choice choice[4];
        double pressing[4] = {0};
        bool sloped = false;
        for (int32_t i = 0, rest = c; i < nodes; i++, rest /= choices) {
            choice[i] = choice_of(&problem->law, rest % choices);
            sloped = sloped || choice[i].slope != 0;
        }
        if (!solve_choices(problem, choice, NULL, other.velocity)) continue;
        find_reaction(&other);
        if (sloped) {   // tangents and normals are apart: these r_n hold whatever slips
            for (int32_t i = 0; i < nodes; i++) pressing[i] = other.reaction[plane_normal(i)];
            if (!solve_choices(problem, choice, pressing, other.velocity)) continue;
            find_reaction(&other);
        }
        if (hand_contact_error(&other) < 1e-9) solutions++;
    }
    return solutions;
}

typedef struct Tally {
    int32_t solved, given_up, several;
} Tally;

// S v = g + r with |r_t| <= mu r_n always has a solution when S is positive definite and mu bounded
// and continuous (by Brouwer's theorem on the friction bounds): enumeration must find one.
static Tally tally_small_problems(FrictionLaw law, double coupling, double diagonal)
{
    Random random = {.state = 32};
    Tally tally = {0};
    for (int32_t trial = 0; trial < 150; trial++) {
        hand_contact_size(&hand, 1 + random_index(&random, 4), 0);
        hand.law = law;
        hand_random_schur(&random, diagonal, coupling, &hand);
        random_loads(&random, &hand);
        random_statuses(&random, &hand);
        bool solved = hand_contact_solve(&hand);
        if (solved) assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
        int32_t solutions = count_solutions(&hand);
        if (solutions == 0) fail_msg("trial %d: enumeration finds no solution", trial);
        tally.solved += solved;
        tally.given_up += !solved;
        tally.several += solutions > 1;
    }
    return tally;
}

// Constant friction with everything coupled: nothing is given up, though problems may have several
// solutions or none that statuses change towards.
TEST(test_small_coulomb_problems)
{
    const struct {
        double mu, diagonal;
    } cases[] = {{0.3, 0.5}, {0.8, 0.5}, {1.2, 3}, {3, 3}, {3, 0.5}, {5, 0.5}, {5, 0.1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        FrictionLaw law = {.kind = FRICTION_COULOMB, .mu_static = cases[k].mu};
        Tally tally = tally_small_problems(law, 1, cases[k].diagonal);
        assert_int_equal(tally.given_up, 0);
    }
}

// Weakening, tangents and normals apart: nothing is given up, also where it is too strong for S and
// there are several solutions.
TEST(test_small_weakening_problems)
{
    const double velocities[] = {8, 2, 0.5, 0.125};
    int32_t several = 0;
    for (int32_t k = 0; k < 8; k++) {
        FrictionLaw law = {
            .mu_static = 0.6, .mu_kinetic = 0.1, .critical_velocity = velocities[k / 2]};
        Tally tally = tally_small_problems(law, 0, k % 2 ? 3 : 0.5);
        assert_int_equal(tally.given_up, 0);
        several += tally.several;
    }
    assert_true(several > 50);   // the hard cases were among them
}

// Friction that rises above what holds at rest: at once; after a fall; before it falls to less. Of
// the last the fall is too strong for S now and then.
TEST(test_small_rising_problems)
{
    static const double velocity[] = {0, 0.3, 1},
                        mu[][3] = {{0.3, 0.5, 0.9}, {0.5, 0.3, 0.8}, {0.3, 0.9, 0.2}};
    for (int32_t k = 0; k < 6; k++) {
        FrictionLaw law = own_table(3, velocity, mu[k / 2], true);
        Tally tally = tally_small_problems(law, 0, k % 2 ? 3 : 0.5);
        assert_int_equal(tally.given_up, 0);
        if (k / 2 == 0) assert_int_equal(tally.several, 0);
        if (k == 4) assert_true(tally.several > 10);
    }
}

// One of the hard problems: friction up to 5 that weakens faster than S resists, everything
// coupled, the rod too.
static void hard_problem(Random *random, int32_t trial)
{
    static const double softness[HAND_RODS] = {0.3, 0, 2, 0};
    hand_contact_size(&hand, 1 + random_index(random, 12), random_index(random, 3));
    hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 3),
                             .mu_static = random_between(random, 0.5, 5),
                             .mu_kinetic = random_between(random, 0.02, 0.5),
                             .critical_velocity = pow(10, random_between(random, -3, 0.5))};
    if (trial % 7 == 0) hand.rod_kind = ROD_IS_BONDED;
    if (trial % 11 == 0) hand.rod_kind = ROD_AWAY;
    if (trial % 2 == 0) hand.rod_softness = softness;
    hand.rod_reach = 0.7;
    hand_random_schur(random, 0.1, 1, &hand);
    random_loads(random, &hand);
    random_statuses(random, &hand);
}

// Solved, rightly, after sweeps where Newton's statuses do not settle.
TEST(test_hard_problems)
{
    Random random = {.state = 33};
    int64_t rescued = 0, sweeps = 0;
    for (int32_t trial = 0; trial < 1500; trial++) {
        hard_problem(&random, trial);
        HandCounts counts;
        if (!hand_contact_solve_by(&hand, true, &counts))
            fail_msg("trial %d with %d nodes is not solved", trial, hand.interface.contact_count);
        assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
        rescued += counts.rescued;
        sweeps += counts.sweeps;
    }
    print_message("%d problems solved after %d sweeps\n", (int)rescued, (int)sweeps);
    assert_true(rescued > 40);
}

// A caller with shorter steps at hand is told soon: statuses that go round in a cycle, and
// equations that come no nearer, are seen long before the limits. What is solved is solved rightly.
TEST(test_gives_up_soon)
{
    Random random = {.state = 33};
    int64_t unsolved = 0, iterations = 0;
    for (int32_t trial = 0; trial < 1500; trial++) {
        hard_problem(&random, trial);
        HandCounts counts;
        if (hand_contact_solve_by(&hand, false, &counts)) {
            assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
            continue;
        }
        iterations += counts.iterations;
        unsolved++;
    }
    print_message("%d problems given up after %.1f iterations\n", (int)unsolved,
                  (double)iterations / (double)unsolved);
    assert_true(unsolved > 40);
    assert_true(iterations < 15 * unsolved);   // 20 without looking
}
