// SPDX-License-Identifier: GPL-2.0-or-later
// A basis comes back from the cache as it went in, or not at all, with a reason; one that comes out
// otherwise than the recorded one is noticed.
#include "model/basis_cache.h"

#include "base/memory.h"
#include "random_numbers.h"
#include "cache_fixture.h"
#include "unit/reduction/reduced_block.h"

enum { PATH_SIZE = 2 * PLACE_SIZE, M = 7, ALL = 11, DOFS = 40, LEVELS = 3 };
static const char NAME[] = "00112233445566778899aabbccddeeff";
static const char OTHER[] = "00112233445566778899aabbccddeef0";

static double *random_array(Random *random, int64_t count)
{
    Error err = {0};
    double *array = NEW_ARRAY(double, count, &err);
    for (int64_t k = 0; k < count; k++) array[k] = random_between(random, -1, 1);
    return array;
}

// All but the maps of a part with `m` unknowns on the border.
static ReducedPart make_part(Random *random, int32_t m, int32_t interior, int32_t dofs)
{
    int32_t all = m + interior;
    return (ReducedPart){.full_dofs = dofs,
                         .border_count = m,
                         .interior_count = interior,
                         .count = all,
                         .mass = random_array(random, m * m),
                         .coupling = random_array(random, interior * m),
                         .masses = random_array(random, interior),
                         .damping = random_array(random, all * all),
                         .stiffness = random_array(random, m * m),
                         .load = random_array(random, all),
                         .modes = random_array(random, dofs * all),
                         .errors = {LEVELS, {1, 10, 1e4}, {1e-4 * m, 2e-4, 0.3}}};
}

static void make_basis(uint64_t seed, ReducedBulk *reduced)
{
    Random random = {.state = seed};
    *reduced = (ReducedBulk){.dim = 2,
                             .full_dofs = DOFS,
                             .interface_count = M,
                             .count = ALL,
                             .part_count = 1,
                             .part = {make_part(&random, M, ALL - M, DOFS)},
                             .load = random_array(&random, ALL),
                             .rigid = random_array(&random, 3 * M)};
    reduced->part[0].border = (Transform){.size = M, .count = M};
    reduced->part[0].mesh = (Transform){.size = DOFS, .count = DOFS};
}

static void store(const char *name, char note[CACHE_NOTE_SIZE])
{
    ReducedBulk reduced;
    note[0] = 0;
    make_basis(5, &reduced);
    basis_cache_store(name, &reduced, note);
    reduced_bulk_destroy(&reduced);
}

static bool load(const char *name, bool with_modes, ReducedBulk *reduced,
                 char note[CACHE_NOTE_SIZE])
{
    Error err = {0};
    bool found = true;
    note[0] = 0;
    if (!basis_cache_load(name, with_modes, reduced, &found, note, &err))
        fail_msg("%s", err.message);
    return found;
}

static void assert_same(const double *a, const double *b, size_t count)
{
    assert_non_null(a);
    assert_memory_equal(a, b, count * sizeof *a);
}

static void assert_same_map(const Transform *a, const Transform *b)
{
    assert_true(a->count == b->count && a->size == b->size);
    if (!b->blocks) return;
    assert_memory_equal(a->block_of, b->block_of, (size_t)a->size * sizeof *a->block_of);
    assert_memory_equal(a->rows, b->rows, (size_t)a->size * sizeof *a->rows);
    assert_memory_equal(a->values, b->values, (size_t)a->size * sizeof *a->values);
}

static void assert_same_bulk(const ReducedBulk *a, const ReducedBulk *b, bool with_modes)
{
    assert_true(a->full_dofs == b->full_dofs && a->count == b->count && a->mirrored == b->mirrored);
    assert_true(a->interface_count == M && a->part_count == b->part_count);
    assert_same(a->load, b->load, (size_t)b->count);
    assert_same(a->rigid, b->rigid, 3 * (size_t)(M + b->mirrored));
    for (int p = 0; p < b->part_count; p++) {
        const ReducedPart *part = &a->part[p], *wanted = &b->part[p];
        size_t all = (size_t)wanted->count, m = (size_t)wanted->border_count;
        assert_true(part->interior_count == wanted->interior_count && part->count == wanted->count);
        assert_same_map(&part->border, &wanted->border);
        assert_same(part->mass, wanted->mass, m * m);
        assert_same(part->coupling, wanted->coupling, (all - m) * m);
        assert_same(part->masses, wanted->masses, all - m);
        assert_same(part->damping, wanted->damping, all * all);
        assert_same(part->stiffness, wanted->stiffness, m * m);
        assert_same(part->load, wanted->load, all);
        assert_int_equal(part->errors.count, LEVELS);
        assert_memory_equal(part->errors.inertia, wanted->errors.inertia, LEVELS * 8);
        assert_memory_equal(part->errors.error, wanted->errors.error, LEVELS * 8);
        if (!with_modes) assert_null(part->modes);
        if (!with_modes) continue;
        assert_same_map(&part->mesh, &wanted->mesh);
        assert_same(part->modes, wanted->modes, (size_t)wanted->full_dofs * all);
    }
}

TEST(test_round_trip)
{
    ReducedBulk made, read;
    char note[CACHE_NOTE_SIZE];
    int64_t live = memory_counters().live;
    assert_false(load(NAME, false, &read, note));   // nothing there: no reason to say anything
    assert_string_equal(note, "");
    store(NAME, note);
    assert_string_equal(note, "");
    make_basis(5, &made);
    for (int with_modes = 0; with_modes < 2; with_modes++) {
        assert_true(load(NAME, with_modes, &read, note));
        assert_string_equal(note, "");
        assert_same_bulk(&read, &made, with_modes);
        assert_true(!read.part[0].border.blocks && read.part[0].border.size == M);   // T = 1
        reduced_bulk_destroy(&read);
    }
    reduced_bulk_destroy(&made);
    assert_int_equal(memory_counters().live, live);
}

// (x + sign x*) / sqrt(2) of an unknown and its image; of its own image: x.
static void append_pair(Transform *by, int32_t one, int32_t image, double sign)
{
    transform_append_images(by, (int32_t[]){one, image}, one == image ? 1 : 2, (double[]){1, sign});
}

static void make_map(int32_t count, int32_t whole, int32_t first, Transform *by)
{
    Error err = {0};
    assert_true(transform_create(whole, count, whole, by, &err));
    for (int32_t k = 0; k < count; k++) {
        int32_t other = k + 1 < count ? whole - 1 - k : first + k;
        append_pair(by, first + k, other, k % 2 ? -1 : 1);
    }
}

// M = 7 and 2 mirrored unknowns: parts of 5 and 4 on the border, 3 and 2 inside.
static void make_parts(ReducedBulk *reduced)
{
    enum { MIRRORED = 2, DOFS_OF_EACH = DOFS / 2 };
    Random random = {.state = 9};
    *reduced = (ReducedBulk){
        .dim = 2,
        .full_dofs = DOFS,
        .interface_count = M,
        .mirrored = MIRRORED,
        .count = M + MIRRORED + 5,
        .part_count = 2,
        .part = {make_part(&random, 5, 3, DOFS_OF_EACH), make_part(&random, 4, 2, DOFS_OF_EACH)},
        .load = random_array(&random, M + MIRRORED + 5),
        .rigid = random_array(&random, 3 * (M + MIRRORED))};
    for (int p = 0; p < 2; p++) {
        make_map(reduced->part[p].border_count, M + MIRRORED, p, &reduced->part[p].border);
        make_map(DOFS_OF_EACH, DOFS, p, &reduced->part[p].mesh);
    }
}

TEST(test_symmetry_parts)
{
    ReducedBulk made, read;
    char note[CACHE_NOTE_SIZE] = "";
    int64_t live = memory_counters().live;
    make_parts(&made);
    assert_true(basis_cache_store(NAME, &made, note));
    for (int with_modes = 0; with_modes < 2; with_modes++) {
        assert_true(load(NAME, with_modes, &read, note));
        assert_same_bulk(&read, &made, with_modes);
        reduced_bulk_destroy(&read);
    }
    // Another length than its parts have together: not whole.
    made.count--;
    assert_true(basis_cache_store(NAME, &made, note));
    assert_false(load(NAME, false, &read, note));
    assert_string_equal(note, "a cached basis is not used: an array is missing or wrong");
    made.count++;
    made.part[0].border.blocks[1].rows[0] = 8;   // an unknown in two columns
    assert_true(basis_cache_store(NAME, &made, note));
    assert_false(load(NAME, false, &read, note));
    assert_string_equal(note, "a cached basis is not used: an array is missing or wrong");
    reduced_bulk_destroy(&made);
    assert_int_equal(memory_counters().live, live);
}

// A cut file, modes that are cut or gone, another basis's file under this name, no name.
TEST(test_not_trusted)
{
    ReducedBulk read;
    char note[CACHE_NOTE_SIZE], path[PATH_SIZE], modes[PATH_SIZE], other[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s.basis", cache, NAME);
    snprintf(modes, sizeof modes, "%s/%s.modes", cache, NAME);
    snprintf(other, sizeof other, "%s/%s.basis", cache, OTHER);
    int64_t live = memory_counters().live;
    store(NAME, note);
    assert_int_equal(truncate(path, 1000), 0);
    assert_false(load(NAME, false, &read, note));
    assert_string_equal(note, "a cached basis is not used: it is cut off");
    store(NAME, note);
    assert_int_equal(truncate(modes, 1000), 0);
    assert_true(load(NAME, false, &read, note));   // modes are not asked for
    reduced_bulk_destroy(&read);
    assert_false(load(NAME, true, &read, note));
    assert_string_equal(note, "a cached basis is not used: it is cut off");
    assert_int_equal(unlink(modes), 0);
    assert_false(load(NAME, true, &read, note));
    assert_string_equal(note, "");
    store(NAME, note);
    assert_int_equal(rename(path, other), 0);
    assert_false(load(OTHER, false, &read, note));
    assert_string_equal(note, "a cached basis is not used: it belongs to another shape");
    assert_false(load("", false, &read, note));
    assert_string_equal(note, "");
    assert_int_equal(memory_counters().live, live);
}

// A file that is whole, but whose sizes are none: more levels than there is room for, a count of
// which fuzzing found the first.
TEST(test_impossible_sizes)
{
    ReducedBulk made, read;
    char note[CACHE_NOTE_SIZE] = "";
    int64_t live = memory_counters().live;
    make_basis(5, &made);
    ReducedPart *part = &made.part[0];
    int32_t *const places[] = {&made.interface_count, &part->interior_count, &part->errors.count,
                               &part->full_dofs};
    static const int32_t wrong[] = {-1, -1, REDUCTION_LEVELS_MAX + 1, 1 << 28};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char name[64];
        int32_t kept = *places[k];
        size_t size;
        basis_cache_store(NAME, &made, note);
        snprintf(name, sizeof name, "%s.basis", NAME);
        char *bytes = cache_bytes(name, &size);
        for (size_t at = 64; at < size - 32; at++)   // the first of these that holds the number
            if (memcmp(bytes + at, &kept, sizeof kept) == 0) {
                memcpy(bytes + at, &wrong[k], sizeof kept);
                break;
            }
        cache_put(name, bytes, size);
        free(bytes);
        assert_false(load(NAME, false, &read, note));
        assert_string_equal(note, "a cached basis is not used: an array is missing or wrong");
    }
    reduced_bulk_destroy(&made);
    assert_int_equal(memory_counters().live, live);
}

TEST(test_memory_faults)
{
    char note[CACHE_NOTE_SIZE];
    ReducedBulk read, made;
    store(NAME, note);
    make_basis(6, &made);
    int64_t live = memory_counters().live;
    bool done = false, found;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        memory_fail_after(k);
        done = basis_cache_load(NAME, true, &read, &found, note, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        if (done) assert_true(found);
        reduced_bulk_destroy(&read);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 20);
    }
    setenv("AMONTONS_CACHE", "/proc/self", 1);   // a folder in which not even root makes files
    note[0] = 0;
    basis_cache_store(NAME, &made, note);
    assert_non_null(strstr(note, "the basis is not kept for the next run: cannot write"));
    setenv("AMONTONS_CACHE", cache, 1);
    reduced_bulk_destroy(&made);
}

// The recorded basis: of this block. Trace of S at dt = 1, 0.1, 0.01, 1e-4, and how many modes.
// When this fails and the new basis is meant to be so: write here the numbers of the message.
static const int32_t RECORDED_MODES = 39;
static const double RECORDED_TRACES[4] = {29.6363560258, 19.9828148797, 28.2719551359,
                                          699.509537686};

TEST(test_recorded_basis)
{
    const Material material = {.young = 1, .poisson = 0.3, .density = 1, .eta1 = 1, .eta2 = 0.5};
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 10, .nz = 8, .length = 1, .height = 0.5};
    const double steps[4] = {1, 1e-1, 1e-2, 1e-4};
    double trace[4] = {0};
    ReducedBlock block;
    reduced_block_build(&shape, &material, 0.003, 1e-2, &block);
    for (int k = 0; k < 4; k++) {
        OperatorTerms terms = {.mass = 1 / steps[k], .damping = 1, .stiffness = steps[k]};
        double *schur = reduced_schur(&block.reduced, terms);
        for (int32_t j = 0; j < block.interface_count; j++)
            trace[k] += schur[j * (block.interface_count + 1)];
        free(schur);
    }
    bool same = block.reduced.part[0].interior_count == RECORDED_MODES;
    for (int k = 0; k < 4; k++)
        same = same && fabs(trace[k] - RECORDED_TRACES[k]) <= 1e-7 * fabs(trace[k]);
    if (!same)
        fail_msg("the basis came out otherwise: %d modes, traces {%.12g, %.12g, %.12g, %.12g}",
                 block.reduced.part[0].interior_count, trace[0], trace[1], trace[2], trace[3]);
    reduced_block_destroy(&block);
}

GROUP_BETWEEN(cache_begin, cache_end);
