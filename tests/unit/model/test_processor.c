// SPDX-License-Identifier: GPL-2.0-or-later
// What was measured comes back rounded; a file that is damaged, or holds what no machine is, is not
// believed.
#include "model/processor.h"

#include "base/hash.h"
#include "near.h"
#include "cache_fixture.h"

static void keep(double factor, double pass)
{
    Error err = {0};
    if (!processor_keep(&(Processor){factor, pass}, &err)) fail_msg("%s", err.message);
}

static Processor kept(char note[CACHE_NOTE_SIZE])
{
    Error err = {0};
    Processor processor = {0};
    note[0] = 0;
    if (!processor_kept(&processor, note, &err)) fail_msg("%s", err.message);
    return processor;
}

static void assert_kept(double factor, double pass, const char *said)
{
    char note[CACHE_NOTE_SIZE];
    Processor processor = kept(note);
    assert_near("factor", processor.factor, factor, 1e-12);
    assert_near("pass", processor.pass, pass, 1e-12);
    if (said[0] ? !strstr(note, said) : note[0] != 0) fail_msg("`%s` is not `%s`", note, said);
}

static void test_round_trip(void **state)
{
    (void)state;
    assert_kept(1, 1, "");   // nothing there: nothing to say
    keep(1.1, 2.9);   // of 1, 1.41, 2, 2.83, 4
    assert_kept(1, 2 * sqrt(2), "");
    keep(0.52, 1e9);
    assert_kept(0.5, 32, "");
    setenv("AMONTONS_CACHE", "", 1);
    Error err = {0};
    assert_false(processor_keep(&(Processor){1, 1}, &err));
    assert_non_null(strstr(err.message, "AMONTONS_CACHE"));
    assert_kept(1, 1, "");
    setenv("AMONTONS_CACHE", cache, 1);
}

static void test_damaged(void **state)
{
    (void)state;
    char bytes[1000], path[PLACE_SIZE + 40];
    keep(4, 0.25);
    assert_kept(4, 0.25, "");
    snprintf(path, sizeof path, "%s/processor.speed", cache);
    FILE *file = fopen(path, "rb");
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    for (size_t at = 0; at <= size; at += 7) {   // a byte changed, and all but the first so many
        for (int cut = 0; cut < 2; cut++) {
            file = fopen(path, "wb");
            if (!cut && at < size) bytes[at] ^= 4;
            fwrite(bytes, 1, cut ? at : size, file);
            fclose(file);
            if (!cut && at < size) bytes[at] ^= 4;
            if (at < size) assert_kept(1, 1, "measure again");
        }
    }
}

// Under a right checksum; the key is that of a file of ours.
static void test_impossible(void **state)
{
    (void)state;
    const double wrong[][2] = {{NAN, 1}, {1, -1}, {0, 1}, {1, 1e300}, {INFINITY, 1}};
    char path[PLACE_SIZE + 40], key[HASH_TEXT_SIZE] = "";
    keep(4, 0.25);
    snprintf(path, sizeof path, "%s/processor.speed", cache);
    FILE *file = fopen(path, "rb");
    fseek(file, (long)strlen("amontons-cache 1\n"), SEEK_SET);
    assert_int_equal(fread(key, 1, HASH_TEXT_SIZE - 1, file), HASH_TEXT_SIZE - 1);
    fclose(file);
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        Error err = {0};
        CacheArray array = {.name = "speed", .count = 2, .values = wrong[k]};
        assert_true(cache_file_write(path, key, &array, 1, &err));
        assert_kept(1, 1, "it holds no speeds");
    }
}

// On whatever machine the test runs, in whatever company.
static void test_measured(void **state)
{
    (void)state;
    Error err = {0};
    Processor processor;
    assert_true(processor_measure(&processor, &err));
    assert_true(processor.factor > 0 && isfinite(processor.factor));
    assert_true(processor.pass > 0 && isfinite(processor.pass));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_round_trip, cache_begin, cache_end),
        cmocka_unit_test_setup_teardown(test_damaged, cache_begin, cache_end),
        cmocka_unit_test_setup_teardown(test_impossible, cache_begin, cache_end),
        cmocka_unit_test(test_measured)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
