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

// The file with its `index`-th number of an array replaced, and a checksum that holds.
static void replace_number(const char *path, const char *array, int64_t index, double number)
{
    Error err = {0};
    char name[HASH_TEXT_SIZE], reason[CACHE_REASON_SIZE];
    CacheFile file;
    bool found = false, replaced = false;
    snprintf(name, sizeof name, "%.32s", strrchr(path, '/') + 1);
    assert_true(cache_file_read(path, name, &file, &found, reason, &err));
    assert_true(found);
    for (int32_t k = 0; k < file.array_count; k++) {
        if (strcmp(file.arrays[k].name, array) != 0) continue;
        assert_true(file.arrays[k].count > index);
        ((double *)(uintptr_t)file.arrays[k].values)[index] = number;
        replaced = true;
    }
    assert_true(replaced);
    assert_true(cache_file_write(path, name, file.arrays, file.array_count, &err));
    cache_file_destroy(&file);
}

// Numbers that cannot be: an unknown of the line that is replaced; a near row twice; a patch before
// itself; rows that are not the coordinates of the patch before; couplings out of order.
static void check_impossible(const FarCacheDef *def, const char *path, const FarBlock *first)
{
    int32_t line = def->upper->interface_dofs[0], last = first->coupling_count - 1;
    int32_t pair = last;   // a coupling of two patches
    while (first->couplings[pair].before < 0) pair--;
    const FarCoupling *coupling = &first->couplings[pair];
    const struct {
        const char *array;
        int64_t index;
        double number;
    } wrong[] = {{"indices", 0, line},
                 {"indices", first->index_count - 1, first->indices[first->index_count - 2]},
                 {"before", pair, coupling->patch + 1},
                 {"rows", pair, coupling->count - 1},
                 {"patch", last, 0},
                 {"patch", 0, first->patch_count},
                 {"sizes", 0, first->dof_count + 1}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char note[CACHE_NOTE_SIZE];
        FarBlock second;
        replace_number(path, wrong[k].array, wrong[k].index, wrong[k].number);
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

    check_impossible(&def, path, &first);
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
