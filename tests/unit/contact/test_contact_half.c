// SPDX-License-Identifier: GPL-2.0-or-later
// One side of a contact against both: random problems that are their own mirror images, solved
// whole, and the quadratic form of S on motions that are even or odd.
#define HAND_DIM 3
#define HAND_NODES 24
#include "algebra/dense.h"
#include "contact/contact_half.h"
#include "contact_by_hand.h"

// Columns of nodes across y, some with one on the middle line; two rod nodes face each other.
enum { ROWS = 4, ACROSS_MAX = 4, RODS = 3 };

typedef struct Sides {
    int32_t image[HAND_UNKNOWNS];
    double sign[HAND_UNKNOWNS];
    double x[HAND_NODES], y[HAND_NODES], rod_z[RODS], rod_y[RODS];
} Sides;

static HandContact hand;
static Sides sides;
static Random seed = {.state = 2611};

// across: nodes of a row; an odd number has one in the middle.
static void lay_out(int32_t across)
{
    hand_contact_size(&hand, ROWS * across, RODS);
    for (int32_t i = 0; i < ROWS * across; i++) {
        int32_t row = i / across, k = i % across, opposite = row * across + across - 1 - k;
        sides.x[i] = row;
        sides.y[i] = 0.7 + (2.0 * k - (across - 1)) * (1 + 0.1 * row);
        for (int32_t c = 0; c < 3; c++) {
            sides.image[3 * i + c] = 3 * opposite + c;
            sides.sign[3 * i + c] = c == 1 ? -1 : 1;
        }
    }
    for (int32_t j = 0; j < RODS; j++) {
        int32_t own = interface_rod(&hand.interface, j), last = interface_rod(&hand.interface, 0);
        sides.rod_z[j] = 1;
        sides.rod_y[j] = 0.7 + (j - 1) * 0.4;
        sides.image[own] = last + RODS - 1 - j;
        sides.sign[own] = 1;
    }
    hand.interface.x = sides.x;
    hand.interface.y = sides.y;
    hand.interface.rod_z = sides.rod_z;
    hand.interface.rod_y = sides.rod_y;
}

// S, g and bounds at random, each the mean of its own and its image's.
static void fill_alike(int32_t trial)
{
    static double own[HAND_UNKNOWNS * HAND_UNKNOWNS];
    int32_t count = hand.interface.count;
    double g[HAND_UNKNOWNS], bound[HAND_UNKNOWNS];
    hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 3),
                             .mu_static = 0.4,
                             .mu_kinetic = 0.1,
                             .critical_velocity = 1.5};
    hand.rod_kind = trial % 5 == 0 ? ROD_IS_BONDED : ROD_PUSHES;
    hand_random_schur(&seed, 3, 0.5, &hand);
    memcpy(own, hand.schur, sizeof own);
    for (int32_t k = 0; k < count; k++) {
        bool normal = k % 3 == 2 && k < interface_rod(&hand.interface, 0);
        g[k] = random_between(&seed, normal ? -4 : -3, normal ? 1.5 : 3);
        bound[k] = random_between(&seed, -0.4, 0.1);
    }
    for (int32_t k = 0; k < count; k++) {
        int32_t image = sides.image[k];
        hand.g[k] = 0.5 * (g[k] + sides.sign[k] * g[image]);
        hand.bound[k] = 0.5 * (bound[k] + bound[image]);
        for (int32_t j = 0; j < count; j++)
            hand.schur[j * count + k] =
                0.5 * (own[j * count + k] +
                       sides.sign[k] * sides.sign[j] * own[sides.image[j] * count + image]);
    }
}

// The same problem by one side.
static bool solve_half(const ContactHalf *half, HandContact *out)
{
    static HandContact one;
    hand_contact_size(&one, half->interface.contact_count, half->interface.rod_count);
    one.law = hand.law;
    one.rod_kind = hand.rod_kind;
    assert_true(contact_half_matrix(half, hand.schur, false, one.schur));
    contact_half_fold_forces(half, true, hand.g, one.g);
    assert_near("what is odd in g", dense_max_abs(one.g, one.interface.count), 0, 1e-14);
    contact_half_fold_forces(half, false, hand.g, one.g);
    contact_half_fold(half, false, hand.bound, one.bound);
    if (!hand_contact_solve(&one)) return false;
    ContactSolution from = {one.velocity, one.reaction, one.status, one.rod_touches};
    memset(out->velocity, 0, sizeof out->velocity);
    memset(out->reaction, 0, sizeof out->reaction);
    contact_half_add(half, false, one.velocity, out->velocity);
    contact_half_add_forces(half, false, one.reaction, out->reaction);
    contact_half_unfold_statuses(half, &from, out->status, out->rod_touches);
    return true;
}

TEST(test_same_solution)
{
    Error err = {0};
    static HandContact other;
    int32_t slipping = 0, open = 0;
    for (int32_t trial = 0; trial < 40; trial++) {
        ContactHalf half;
        lay_out(2 + trial % (ACROSS_MAX - 1));
        fill_alike(trial);
        assert_true(contact_half_find(&hand.interface, &half, &err));
        assert_true(half.interface.contact_count > 0);
        memset(hand.status, CONTACT_STICK, sizeof hand.status);
        other = hand;
        assert_true(hand_contact_solve(&hand));
        assert_true(solve_half(&half, &other));
        assert_near("judged", hand_contact_error(&other), 0, 1e-9);
        assert_all_near("v", other.velocity, hand.velocity, hand.interface.count, 1e-9);
        assert_all_near("r", other.reaction, hand.reaction, hand.interface.count, 1e-9);
        for (int32_t i = 0; i < hand.interface.contact_count; i++) {
            assert_int_equal(other.status[i], hand.status[i]);
            slipping += status_slips(hand.status[i]);
            open += hand.status[i] == CONTACT_OPEN;
        }
        contact_half_destroy(&half);
    }
    assert_true(slipping > 50 && open > 50);
}

static double form(const double *matrix, const double *v, int32_t count)
{
    double sum = 0;
    for (int32_t j = 0; j < count; j++)
        for (int32_t i = 0; i < count; i++) sum += v[i] * matrix[j * count + i] * v[j];
    return sum;
}

// v'S v of a motion of both sides is that of one side's matrix; even and odd do not meet.
TEST(test_even_and_odd)
{
    Error err = {0};
    static double matrix[2][HAND_UNKNOWNS * HAND_UNKNOWNS];
    for (int32_t across = 2; across <= ACROSS_MAX; across++) {
        ContactHalf half;
        lay_out(across);
        fill_alike(1);
        int32_t count = hand.interface.count;
        assert_true(contact_half_find(&hand.interface, &half, &err));
        int32_t size = half.interface.count;
        assert_int_equal(half.interface.contact_count, ROWS * ((across + 1) / 2));
        for (int odd = 0; odd < 2; odd++)
            assert_true(contact_half_matrix(&half, hand.schur, odd, matrix[odd]));
        for (int32_t trial = 0; trial < 6; trial++) {
            bool odd = trial % 2;
            double whole[HAND_UNKNOWNS], one[HAND_UNKNOWNS];
            for (int32_t k = 0; k < count; k++) whole[k] = random_between(&seed, -1, 1);
            for (int32_t k = 0; k < count; k++) {
                double sign = odd ? -sides.sign[k] : sides.sign[k];
                if (sides.image[k] == k && sign < 0) whole[k] = 0;
                if (sides.image[k] > k) whole[sides.image[k]] = sign * whole[k];
            }
            for (int32_t k = 0; k < size; k++) one[k] = whole[half.unknown[k]];
            assert_near("v'S v", form(matrix[odd], one, size), form(hand.schur, whole, count),
                        1e-10);
        }
        hand.schur[1] *= 1 + 1e-6;   // of one side only
        assert_false(contact_half_matrix(&half, hand.schur, false, matrix[0]));
        contact_half_destroy(&half);
    }
}

// A node beside its place, or without an image: there are no two sides; nor in the plane.
TEST(test_no_image)
{
    Error err = {0};
    ContactHalf half;
    for (int32_t which = 0; which < 4; which++) {
        lay_out(3);
        if (which == 0) sides.y[4] += 1e-3;
        if (which == 1) sides.x[3] += 1e-3;
        if (which == 2) sides.rod_y[0] -= 1e-3;
        if (which == 3) hand.interface.dim = 2;
        assert_true(contact_half_find(&hand.interface, &half, &err));
        assert_int_equal(half.interface.contact_count, 0);
        contact_half_destroy(&half);
    }
}
