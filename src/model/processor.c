// SPDX-License-Identifier: GPL-2.0-or-later
// What is timed is what base/sparse does with a lattice whose first row is the border: the same
// work as for a mesh of 110 x 110 nodes, by the same libraries. Processor time, the least of some.
#include "model/processor.h"

#include "base/clock.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/sparse.h"

#include <math.h>
#include <stdio.h>

enum { SIDE = 110, NODES = SIDE * SIDE, NEIGHBOURS = 9, TURNS = 5, PASSES = 8 };

// s on the machine on which the constants of model/choice were fitted.
static const double FACTOR_SECONDS = 0.0125, PASS_SECONDS = 0.00074;

// Beyond that the measurement, or the file, is wrong.
static const double FARTHEST = 32;

static const char NAME[] = "processor", FORMAT[] = "speed 1";

const Processor PROCESSOR_USUAL = {1, 1};

typedef struct Lattice {
    SparsePattern pattern;
    double *values;   // 9 on the diagonal, -1 beside it
    int32_t border[SIDE];
    double *right;   // [NODES] side, and what comes out
    double schur[SIDE];
    SparseAnalysis *analysis;
} Lattice;

static void fill_row(Lattice *lattice, int32_t node)
{
    int32_t x = node % SIDE, z = node / SIDE;
    int32_t at = lattice->pattern.start[node];
    for (int32_t k = 0; k < NEIGHBOURS; k++) {
        int32_t to_x = x + k % 3 - 1, to_z = z + k / 3 - 1;
        if (to_x < 0 || to_x >= SIDE || to_z < 0 || to_z >= SIDE) continue;
        lattice->pattern.index[at] = to_z * SIDE + to_x;
        lattice->values[at++] = k == NEIGHBOURS / 2 ? NEIGHBOURS : -1;
    }
    lattice->pattern.start[node + 1] = at;
}

static bool make_lattice(Lattice *lattice, Error *err)
{
    SparsePattern *pattern = &lattice->pattern;
    pattern->size = NODES;
    TRY((pattern->start = NEW_ARRAY(int32_t, NODES + 1, err)));
    TRY((pattern->index = NEW_ARRAY(int32_t, NODES * NEIGHBOURS, err)));
    TRY((lattice->values = NEW_ARRAY(double, NODES *NEIGHBOURS, err)));
    TRY((lattice->right = NEW_ARRAY(double, NODES, err)));
    for (int32_t node = 0; node < NODES; node++) fill_row(lattice, node);
    for (int32_t k = 0; k < SIDE; k++) lattice->border[k] = k;
    TRY((lattice->analysis = sparse_analyse(pattern, lattice->border, SIDE, err)));
cleanup:
    return error_is_clean(err);
}

static void destroy_lattice(Lattice *lattice)
{
    sparse_analysis_destroy(lattice->analysis);
    sparse_pattern_destroy(&lattice->pattern);
    memory_free(lattice->values);
    memory_free(lattice->right);
}

// s of one factor, and of one pass through it; each the least so far.
static bool take_turn(Lattice *lattice, Processor *least, Error *err)
{
    double begun = clock_processor_seconds();
    SparseFactor *factor = sparse_factorise(lattice->analysis, lattice->values, err);
    TRY(factor);
    double factored = clock_processor_seconds();
    for (int32_t k = 0; k < PASSES; k++) {
        for (int32_t node = 0; node < NODES; node++) lattice->right[node] = 1;
        TRY(sparse_condense(factor, lattice->right, lattice->schur, err));
        TRY(sparse_expand(factor, lattice->schur, lattice->right, err));
    }
    least->factor = fmin(least->factor, factored - begun);
    least->pass = fmin(least->pass, (clock_processor_seconds() - factored) / PASSES);
cleanup:
    sparse_factor_destroy(factor);
    return error_is_clean(err);
}

bool processor_measure(Processor *processor, Error *err)
{
    Lattice lattice = {0};
    Processor least = {INFINITY, INFINITY};
    TRY(make_lattice(&lattice, err));
    for (int32_t k = 0; k < TURNS; k++) TRY(take_turn(&lattice, &least, err));
    *processor = (Processor){least.factor / FACTOR_SECONDS, least.pass / PASS_SECONDS};
cleanup:
    destroy_lattice(&lattice);
    return error_is_clean(err);
}

// --- what is kept -------------------------------------------------------------------------------

static double rounded(double speed)
{
    double bounded = fmin(fmax(speed, 1 / FARTHEST), FARTHEST);
    return exp2(0.5 * round(2 * log2(bounded)));
}

// The version's constants belong to it.
static void find_key(char key[HASH_TEXT_SIZE])
{
    Hash hash = hash_start();
    hash_text(&hash, FORMAT);
    hash_number(&hash, FACTOR_SECONDS);
    hash_number(&hash, PASS_SECONDS);
    hash_write(&hash, key);
}

bool processor_keep(const Processor *processor, Error *err)
{
    char path[CACHE_PATH_SIZE], key[HASH_TEXT_SIZE];
    double speeds[] = {rounded(processor->factor), rounded(processor->pass)};
    CacheArray array = {.name = "speed", .count = 2, .values = speeds};
    find_key(key);
    if (!cache_file_path(NAME, "speed", path))
        FAIL(err, ERROR_INPUT, "there is no cache to keep it in: AMONTONS_CACHE is empty");
    TRY(cache_file_write(path, key, &array, 1, err));
cleanup:
    return error_is_clean(err);
}

static bool is_speed(double speed)
{
    return speed >= 1 / FARTHEST && speed <= FARTHEST;   // not NaN
}

bool processor_kept(Processor *processor, char note[CACHE_NOTE_SIZE], Error *err)
{
    char path[CACHE_PATH_SIZE], key[HASH_TEXT_SIZE], reason[CACHE_REASON_SIZE] = "";
    CacheFile file = {0};
    bool found = false;
    *processor = PROCESSOR_USUAL;
    find_key(key);
    if (!cache_file_path(NAME, "speed", path)) goto cleanup;
    TRY(cache_file_read(path, key, &file, &found, reason, err));
    const double *speeds = found ? cache_file_array(&file, "speed", 2) : NULL;
    if (speeds && is_speed(speeds[0]) && is_speed(speeds[1]))
        *processor = (Processor){speeds[0], speeds[1]};
    else if (found)
        snprintf(reason, sizeof reason, "it holds no speeds");
    if (reason[0])
        snprintf(note, CACHE_NOTE_SIZE,
                 "what `amontons cache --measure` kept is not used, measure again: %s", reason);
cleanup:
    cache_file_destroy(&file);
    return error_is_clean(err);
}
