// SPDX-License-Identifier: GPL-2.0-or-later
// Modes of what is far above the line come back from the cache as they went in, with or without
// their fields, and what is spoilt or cannot be is made anew, with a reason.
#include "model/far_cache.h"

#include "base/memory.h"
#include "cache_fixture.h"
#include "unit/reduction/pad_design.h"

#include <dirent.h>
#include <unistd.h>

enum { PATH_SIZE = 2 * PLACE_SIZE };

static FarCacheDef cache_def(const PadBlock *made)
{
    BulkScales scales = {1, 1, 1, 1};
    FarFieldDef far = {2e-2, scales, made->block.materials};
    return (FarCacheDef){.upper = &made->upper, .far = far, .keep = true};
}

static bool obtain(const FarCacheDef *def, FarBlock *block, char note[CACHE_NOTE_SIZE])
{
    Error err = {0};
    bool found = false;
    note[0] = 0;
    if (!far_cache_obtain(def, block, &found, note, &err)) fail_msg("%s", err.message);
    return found;
}

static void assert_same(const FarBlock *one, const FarBlock *other, bool with_fields)
{
    assert_int_equal(one->patch_count, other->patch_count);
    assert_true(one->patch_count > 0);
    assert_int_equal(one->number_count, other->number_count);
    assert_memory_equal(one->indices, other->indices, (size_t)one->index_count * sizeof(int32_t));
    assert_memory_equal(one->matrices, other->matrices, (size_t)one->number_count * sizeof(double));
    assert_true(one->error == other->error);
    for (int32_t p = 0; p < one->patch_count; p++) {
        const FarPatch *a = &one->patches[p], *b = &other->patches[p];
        assert_int_equal(a->size, b->size);
        assert_int_equal(a->count, b->count);
        if (!with_fields) continue;
        assert_non_null(b->field);
        assert_memory_equal(a->field, b->field,
                            (size_t)a->size * (size_t)a->count * sizeof(double));
    }
    assert_int_equal(one->coupling_count, other->coupling_count);
    for (int32_t k = 0; k < one->coupling_count; k++) {
        const FarCoupling *a = &one->couplings[k], *b = &other->couplings[k];
        assert_int_equal(a->patch, b->patch);
        assert_int_equal(a->before, b->before);
        assert_int_equal(a->count, b->count);
    }
}

// The one file with this ending.
static void file_of(const char *ending, char path[PATH_SIZE])
{
    DIR *listing = opendir(cache);
    path[0] = 0;
    for (struct dirent *file; (file = readdir(listing));)
        if (strstr(file->d_name, ending)) snprintf(path, PATH_SIZE, "%s/%s", cache, file->d_name);
    closedir(listing);
}

static void test_comes_back(void **state)
{
    (void)state;
    char note[CACHE_NOTE_SIZE];
    PadBlock made, moved;
    PadDesign others = PAD_DESIGN;
    FarBlock first, second;
    others.fill = 0.7;
    pad_block_build(PAD_DESIGN, &made);
    pad_block_build(others, &moved);
    FarCacheDef def = cache_def(&made), of_moved = cache_def(&moved);
    assert_false(obtain(&def, &first, note));
    assert_true(obtain(&of_moved, &second, note));
    assert_string_equal(note, "");
    assert_same(&first, &second, false);
    assert_null(second.patches[0].field);
    far_block_destroy(&second);

    of_moved.with_fields = true;   // which were not kept
    assert_false(obtain(&of_moved, &second, note));
    far_block_destroy(&second);
    assert_true(obtain(&of_moved, &second, note));
    assert_same(&first, &second, true);
    far_block_destroy(&second);

    def.far.tolerance = 1e-2;
    assert_false(obtain(&def, &second, note));
    far_block_destroy(&second);
    def.keep = false;
    assert_false(obtain(&def, &second, note));
    far_block_destroy(&second);
    far_block_destroy(&first);
    pad_block_destroy(&made);
    pad_block_destroy(&moved);
}

// Where it stands in the file (model/far_cache.c): the error, how many patches and couplings; size
// and columns of each patch; patch, before and rows of each coupling; the indices, their number
// before them.
enum { SIZES = 64 + 8 + 2 * 4, PATCH_BYTES = 2 * 4, COUPLING_BYTES = 3 * 4 };

static size_t place_of_coupling(const FarBlock *block, int32_t coupling)
{
    return (size_t)(SIZES + PATCH_BYTES * block->patch_count + COUPLING_BYTES * coupling);
}

static size_t place_of_index(const FarBlock *block, int64_t index)
{
    return place_of_coupling(block, block->coupling_count) + 8 + 4 * (size_t)index;
}

// Numbers that cannot be: an unknown of the line that is replaced; a near row twice; a patch before
// itself; rows that are not the coordinates of the patch before; couplings out of order.
static void check_impossible(const FarCacheDef *def, const char *name, const FarBlock *first)
{
    int32_t line = def->upper->interface_dofs[0], last = first->coupling_count - 1;
    int32_t pair = last;   // a coupling of two patches
    while (first->couplings[pair].before < 0) pair--;
    const FarCoupling *coupling = &first->couplings[pair];
    const struct {
        size_t at;
        int32_t old, number;
    } wrong[] = {{place_of_index(first, 0), first->indices[0], line},
                 {place_of_index(first, first->index_count - 1),
                  first->indices[first->index_count - 1], first->indices[first->index_count - 2]},
                 {place_of_coupling(first, pair) + 4, coupling->before, coupling->patch},
                 {place_of_coupling(first, pair) + 8, coupling->count, coupling->count - 1},
                 {place_of_coupling(first, last), first->couplings[last].patch, 0},
                 {place_of_coupling(first, 0), first->couplings[0].patch, first->patch_count},
                 {SIZES, first->patches[0].size, first->dof_count + 1},
                 {SIZES - 8, first->patch_count, 0}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char note[CACHE_NOTE_SIZE];
        FarBlock second;
        size_t size;
        char *bytes = cache_bytes(name, &size);
        assert_memory_equal(bytes + wrong[k].at, &wrong[k].old, sizeof wrong[k].old);
        memcpy(bytes + wrong[k].at, &wrong[k].number, sizeof wrong[k].number);
        cache_put(name, bytes, size);
        free(bytes);
        assert_false(obtain(def, &second, note));
        assert_non_null(strstr(note, "missing or wrong"));
        assert_same(first, &second, false);
        far_block_destroy(&second);
    }
}

// A byte in the middle; then numbers that cannot be.
static void test_spoilt(void **state)
{
    (void)state;
    char note[CACHE_NOTE_SIZE], path[PATH_SIZE];
    PadBlock made;
    FarBlock first, second;
    pad_block_build(PAD_DESIGN, &made);
    FarCacheDef def = cache_def(&made);
    assert_false(obtain(&def, &first, note));
    file_of(".upper", path);
    FILE *raw = fopen(path, "r+b");
    assert_non_null(raw);
    assert_int_equal(fseek(raw, 40000, SEEK_SET), 0);
    int byte = fgetc(raw);
    assert_int_equal(fseek(raw, 40000, SEEK_SET), 0);
    fputc(byte ^ 1, raw);
    fclose(raw);
    assert_false(obtain(&def, &second, note));
    assert_non_null(strstr(note, "upper block is not used"));
    assert_same(&first, &second, false);
    far_block_destroy(&second);
    assert_true(obtain(&def, &second, note));
    far_block_destroy(&second);

    check_impossible(&def, strrchr(path, '/') + 1, &first);
    far_block_destroy(&first);
    pad_block_destroy(&made);
}

static void test_memory_faults(void **state)
{
    (void)state;
    char note[CACHE_NOTE_SIZE];
    PadBlock made;
    FarBlock block;
    pad_block_build(PAD_DESIGN, &made);
    FarCacheDef def = cache_def(&made);
    def.with_fields = true;
    assert_false(obtain(&def, &block, note));
    far_block_destroy(&block);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        bool found = false;
        memory_fail_after(k);
        done = far_cache_obtain(&def, &block, &found, note, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        assert_int_equal(found, done);
        far_block_destroy(&block);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 100);
    }
    pad_block_destroy(&made);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_comes_back, cache_begin, cache_end),
        cmocka_unit_test_setup_teardown(test_spoilt, cache_begin, cache_end),
        cmocka_unit_test_setup_teardown(test_memory_faults, cache_begin, cache_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
