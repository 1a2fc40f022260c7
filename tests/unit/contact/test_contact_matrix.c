// SPDX-License-Identifier: GPL-2.0-or-later
// S with open nodes condensed out, however it was reached, against an elimination from S itself.
#include "contact/contact_matrix.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "contact_by_hand.h"

enum { NODES = 9, RODS = 2, COUNT = 2 * NODES + RODS, OPERATORS = 60 };

static double schur[OPERATORS][COUNT * COUNT];

static void make_operators(HandContact *hand)
{
    Random random = {.state = 5};
    hand_contact_size(hand, NODES, RODS);
    for (int k = 0; k < OPERATORS; k++) {
        hand_random_schur(&random, 0.2, 1, hand);
        memcpy(schur[k], hand->schur, sizeof schur[k]);
    }
}

// Gaussian elimination of the open unknowns, one after the other, in a copy.
static void expect_closed(const double *found, const double *s, const uint8_t *status)
{
    double a[COUNT * COUNT];
    memcpy(a, s, sizeof a);
    for (int k = 0; k < 2 * NODES; k++) {
        if (status[k / 2] != CONTACT_OPEN) continue;
        for (int i = 0; i < COUNT; i++) {
            double factor = a[k * COUNT + i] / a[k * COUNT + k];
            for (int j = 0; j < COUNT && i != k; j++) a[j * COUNT + i] -= factor * a[j * COUNT + k];
        }
    }
    for (int i = 0; i < COUNT; i++) {
        bool open = i < 2 * NODES && status[i / 2] == CONTACT_OPEN;
        for (int j = 0; j < COUNT && !open; j++) {
            if (j < 2 * NODES && status[j / 2] == CONTACT_OPEN) continue;
            assert_near("S'", found[j * COUNT + i], a[j * COUNT + i], 1e-10);
            assert_near("symmetric", found[i * COUNT + j], a[j * COUNT + i], 1e-10);
        }
    }
}

// Nodes that open and close at random, for long, each matrix with statuses of its own.
TEST(test_any_order)
{
    Error err = {0};
    HandContact hand;
    static ContactMatrix operators[OPERATORS];
    static uint8_t status[OPERATORS][NODES];
    Random random = {.state = 8};
    make_operators(&hand);
    for (int k = 0; k < OPERATORS; k++)
        assert_true(contact_matrix_create(schur[k], COUNT, &operators[k], &err));
    int64_t allocations = memory_counters().allocations, sweeps = 0;
    for (int trial = 0; trial < 4000; trial++) {
        int k = random_index(&random, trial % 2 ? 3 : OPERATORS);
        status[k][random_index(&random, NODES)] = (uint8_t)random_index(&random, 4);
        expect_closed(contact_matrix_close(&operators[k], status[k], NODES, 2), schur[k],
                      status[k]);
    }
    memset(hand.status, CONTACT_STICK, sizeof hand.status);
    for (int k = 0; k < OPERATORS; k++) {
        assert_true(operators[k].swept <= 9 * COUNT);   // renewed from time to time
        sweeps += operators[k].sweeps;
        assert_ptr_equal(contact_matrix_close(&operators[k], hand.status, NODES, 2), schur[k]);
    }
    assert_true(sweeps > 4 * 16 * NODES);
    assert_int_equal(memory_counters().allocations, allocations);
    for (int k = 0; k < OPERATORS; k++) contact_matrix_destroy(&operators[k]);
}

// One node more costs two sweeps.
TEST(test_sweeps_little)
{
    Error err = {0};
    HandContact hand;
    ContactMatrix matrix;
    make_operators(&hand);
    assert_true(contact_matrix_create(schur[0], COUNT, &matrix, &err));
    memset(hand.status, CONTACT_SLIP_FORWARD, sizeof hand.status);
    for (int i = 0; i < 4; i++) {
        hand.status[2 * i] = CONTACT_OPEN;
        expect_closed(contact_matrix_close(&matrix, hand.status, NODES, 2), schur[0], hand.status);
        assert_int_equal(matrix.sweeps, 2 * (i + 1));
    }
    contact_matrix_destroy(&matrix);
}

// A large one, many of whose nodes open and close at once: what was swept together against the
// equations S' stands for, S (v_O, 1_k) = (0, S'_k), and read back to the last bit.
TEST(test_together)
{
    enum { MANY = 140, SIZE = 2 * MANY, TURNS = 12 };
    static double s[SIZE * SIZE], b[SIZE * SIZE];
    static char bytes[8 * SIZE * 40];
    static uint8_t status[MANY];
    Error err = {0};
    Random random = {.state = 21};
    ContactMatrix matrix, copy;
    for (int k = 0; k < SIZE * SIZE; k++) b[k] = random_between(&random, -1, 1);
    dense_multiply_by_transposed(dense_view(b, SIZE, SIZE), dense_view(b, SIZE, SIZE), s);
    for (int j = 0; j < SIZE; j++) {
        s[j * SIZE + j] += 20;
        for (int i = j; i < SIZE; i++) s[i * SIZE + j] = s[j * SIZE + i];
    }
    assert_true(contact_matrix_create(s, SIZE, &matrix, &err));
    assert_true(contact_matrix_create(s, SIZE, &copy, &err));
    for (int turn = 0; turn < TURNS; turn++) {
        for (int i = 0; i < MANY; i++)
            if (random_index(&random, 1 + turn) == 0) status[i] = (uint8_t)random_index(&random, 3);
        const double *closed = contact_matrix_close(&matrix, status, MANY, 2);
        assert_non_null(closed);
        for (int k = 0; k < SIZE; k++) {
            bool swept = status[k / 2] == CONTACT_OPEN;   // there -S_OO^-1: S_OO times it is -1
            for (int i = 0; i < SIZE; i++) {
                if (swept && status[i / 2] != CONTACT_OPEN) continue;
                double force = swept ? -(i == k) : s[k * SIZE + i];
                for (int j = 0; j < SIZE; j++)
                    if (status[j / 2] == CONTACT_OPEN)
                        force -= s[j * SIZE + i] * closed[k * SIZE + j];
                double wanted = status[i / 2] == CONTACT_OPEN ? 0 : closed[k * SIZE + i];
                assert_near("S'", force, wanted, 1e-10 * s[0]);
            }
        }
    }
    Archive archive = archive_write(bytes, sizeof bytes);
    contact_matrix_archive(&matrix, 0, &archive);
    archive = archive_read(bytes, archive.at);
    contact_matrix_archive(&copy, 0, &archive);
    assert_true(archive_check(&archive, true, &err));
    assert_memory_equal(copy.closed, matrix.closed, sizeof s);
    contact_matrix_destroy(&matrix);
    contact_matrix_destroy(&copy);
}

// All normals move as one but for springs of `hold`: with all nodes open there is nothing else that
// holds them. Where nothing holds them nothing is left behind in what is asked for next.
TEST(test_floating)
{
    Error err = {0};
    HandContact hand;
    ContactMatrix matrix;
    const double holds[] = {0, 1e-14, 1e-11};
    make_operators(&hand);
    for (int h = 0; h < 3; h++) {
        double *s = schur[h];
        memset(s, 0, sizeof schur[h]);
        for (int k = 0; k < COUNT; k++) s[k * COUNT + k] = 1;
        for (int i = 0; i < NODES; i++) {
            for (int j = 0; j < NODES; j++)
                s[(2 * j + 1) * COUNT + 2 * i + 1] = (i == j) * (1 + holds[h]) - 1.0 / NODES;
        }
        assert_true(contact_matrix_create(s, COUNT, &matrix, &err));
        memset(hand.status, CONTACT_OPEN, sizeof hand.status);
        assert_null(contact_matrix_close(&matrix, hand.status, NODES, 2));
        for (int i = 0; i < NODES; i += 2) hand.status[i] = CONTACT_STICK;
        expect_closed(contact_matrix_close(&matrix, hand.status, NODES, 2), s, hand.status);
        contact_matrix_destroy(&matrix);
    }
}

TEST(test_memory)
{
    Error err = {0};
    HandContact hand;
    ContactMatrix matrix;
    hand_contact_size(&hand, NODES, RODS);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        memory_fail_after(k);
        error_clear(&err);
        done = contact_matrix_create(schur[0], COUNT, &matrix, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        contact_matrix_destroy(&matrix);
        assert_int_equal(memory_counters().live, live);
    }
}
