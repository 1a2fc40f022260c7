// SPDX-License-Identifier: GPL-2.0-or-later
// Documents are compared with what they should be, byte by byte; numbers with strtod's reading of
// them. tests/end_to_end reads run.json with Python's parser.
#include "io/text/json_writer.h"

#include "base/memory.h"
#include "cases.h"
#include "io/files/own_list.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[64];
static char path[128], part[136];

FIXTURE(make_folder)
{
    snprintf(folder, sizeof folder, "/tmp/amontons_json_XXXXXX");
    if (!mkdtemp(folder) || !own_list_make(folder, &(Error){0})) return -1;
    snprintf(path, sizeof path, "%s/document", folder);
    snprintf(part, sizeof part, "%s.part", path);
    return 0;
}

FIXTURE(remove_folder)
{
    unlink(path);
    snprintf(path, sizeof path, "%s/" OWN_LIST_NAME, folder);
    unlink(path);
    return rmdir(folder);   // fails when anything else was left
}

static bool exists(const char *name)
{
    struct stat entry;
    return stat(name, &entry) == 0;
}

static void assert_document(const char *expected)
{
    char text[4096] = {0};
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    assert_true(length > 0);
    assert_string_equal(text, expected);
    assert_false(exists(part));
}

static JsonWriter *create(void)
{
    Error err = {0};
    JsonWriter *json = json_create(path, &err);
    assert_non_null(json);
    return json;
}

static void finish(JsonWriter *json)
{
    Error err = {0};
    if (!json_finish(json, &err)) fail_msg("%s", err.message);
}

TEST(a_document_is_laid_out_as_stated)
{
    JsonWriter *json = create();
    json_begin_object(json, NULL);
    json_text(json, "status", "done");
    json_begin_object(json, "steps");
    json_integer(json, "accepted", 1234567890123456789);
    json_boolean(json, "certified", true);
    json_boolean(json, "capped", false);
    json_end(json);
    json_begin_list(json, "peaks");
    for (int32_t k = 0; k < 2; k++) {
        json_begin_object(json, NULL);
        json_number(json, "U", 0.002 + k);
        json_end(json);
    }
    json_end(json);
    json_begin_list(json, "x");
    json_number(json, NULL, 0);
    json_number(json, NULL, -0.5);
    json_number(json, NULL, 1e-300);
    json_end(json);
    json_begin_list(json, "none");
    json_end(json);
    json_begin_object(json, "empty");
    json_end(json);
    json_text(json, "reason", NULL);
    json_end(json);
    assert_true(exists(part));
    assert_false(exists(path));
    finish(json);
    assert_document("{\n"
                    "  \"status\": \"done\",\n"
                    "  \"steps\": {\n"
                    "    \"accepted\": 1234567890123456789,\n"
                    "    \"certified\": true,\n"
                    "    \"capped\": false\n"
                    "  },\n"
                    "  \"peaks\": [\n"
                    "    {\n"
                    "      \"U\": 0.002\n"
                    "    },\n"
                    "    {\n"
                    "      \"U\": 1.002\n"
                    "    }\n"
                    "  ],\n"
                    "  \"x\": [0, -0.5, 1e-300],\n"
                    "  \"none\": [],\n"
                    "  \"empty\": {},\n"
                    "  \"reason\": null\n"
                    "}\n");
}

TEST(numbers_are_short_and_exact)
{
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0.1, "0.1"},
                 {0.30000000000000004, "0.30000000000000004"},
                 {1.0 / 3.0, "0.3333333333333333"},
                 {3.4e-4, "0.00034"},
                 {1e22, "1e+22"},
                 {-0.0, "-0"},
                 {5e-324, "4.94065645841247e-324"},
                 {NAN, "null"},
                 {INFINITY, "null"},
                 {-INFINITY, "null"}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char expected[64];
        JsonWriter *json = create();
        json_number(json, NULL, cases[k].value);
        finish(json);
        snprintf(expected, sizeof expected, "%s\n", cases[k].text);
        assert_document(expected);
    }
    JsonWriter *json = create();
    uint64_t bits = 42;
    enum { COUNT = 2000 };
    static double given[COUNT];
    json_begin_list(json, NULL);
    for (int32_t k = 0; k < COUNT; k++) {
        do {
            bits = bits * 6364136223846793005u + 1442695040888963407u;
            memcpy(&given[k], &bits, sizeof bits);
        } while (!isfinite(given[k]));
        json_number(json, NULL, given[k]);
    }
    json_end(json);
    finish(json);
    FILE *file = fopen(path, "r");
    assert_int_equal(fgetc(file), '[');
    for (int32_t k = 0; k < COUNT; k++) {
        double read = 0;
        assert_int_equal(fscanf(file, "%lf%*[,]", &read), 1);
        assert_memory_equal(&read, &given[k], sizeof read);
    }
    assert_int_equal(fgetc(file), ']');
    fclose(file);
}

TEST(several_numbers_are_members_lists_and_objects)
{
    const double speeds[] = {1.5, NAN};
    JsonWriter *json = create();
    json_begin_object(json, NULL);
    json_numbers_of(json, {"whole", 123456789012345}, {"half", 0.5});
    json_object_of(json, "inner", {"one", 1}, {"none", NAN});
    json_number_list(json, "speeds", speeds, 2);
    json_end(json);
    finish(json);
    assert_document("{\n  \"whole\": 123456789012345,\n  \"half\": 0.5,\n  \"inner\": {\n"
                    "    \"one\": 1,\n    \"none\": null\n  },\n  \"speeds\": [1.5, null]\n}\n");
}

TEST(text_is_escaped)
{
    static const struct {
        const char *value, *text;
    } cases[] = {
        {"a \"b\" \\ /", "a \\\"b\\\" \\\\ /"},
        {"line\nnext\ttab\r\x01\x1f\x7f", "line\\nnext\\ttab\\u000d\\u0001\\u001f\\u007f"},
        {"\xC2\xB5 \xE2\x88\x9A \xF0\x9D\x9C\x87", "\xC2\xB5 \xE2\x88\x9A \xF0\x9D\x9C\x87"},
        {"lone \xFF here", "lone \xEF\xBF\xBD here"},
        {"cut \xE2\x88", "cut \xEF\xBF\xBD\xEF\xBF\xBD"},
        {"overlong \xC0\xAF", "overlong \xEF\xBF\xBD\xEF\xBF\xBD"},
        {"surrogate \xED\xA0\x80", "surrogate \xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD"},
        {"far \xF4\x90\x80\x80", "far \xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char expected[256];
        JsonWriter *json = create();
        json_begin_object(json, NULL);
        json_text(json, cases[k].value, cases[k].value);
        json_end(json);
        finish(json);
        snprintf(expected, sizeof expected, "{\n  \"%s\": \"%s\"\n}\n", cases[k].text,
                 cases[k].text);
        assert_document(expected);
    }
}

static void assert_refused(JsonWriter *json, ErrorCode code, const char *words)
{
    Error err = {0};
    assert_false(json_finish(json, &err));
    assert_int_equal(err.code, code);
    if (!strstr(err.message, words) || !strstr(err.message, "document"))
        fail_msg("not the error expected (%s): %s", words, err.message);
    assert_false(exists(part));
}

TEST(a_wrong_document_never_gets_its_name)
{
    unlink(path);
    assert_refused(create(), ERROR_LIBRARY, "not whole");

    JsonWriter *json = create();
    json_begin_object(json, NULL);
    assert_refused(json, ERROR_LIBRARY, "not whole");

    json = create();
    for (int32_t k = 0; k < 100; k++) json_begin_list(json, NULL);
    for (int32_t k = 0; k < 100; k++) json_end(json);
    assert_refused(json, ERROR_LIBRARY, "nesting");

    json = create();
    json_begin_object(json, NULL);
    json_abandon(json);
    json_abandon(NULL);
    assert_false(exists(part) || exists(path));
}

TEST(an_earlier_document_stays_until_the_new_one_is_whole)
{
    JsonWriter *json = create();
    json_integer(json, NULL, 1);
    finish(json);
    json = create();
    json_begin_list(json, NULL);
    Error err = {0};
    assert_false(json_finish(json, &err));
    assert_document("1\n");
    json = create();
    json_integer(json, NULL, 2);
    finish(json);
    assert_document("2\n");
}

TEST(missing_folders_are_named)
{
    Error err = {0};
    assert_null(json_create("/proc/none/run.json", &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, "/proc/none/run.json"));
    assert_non_null(strstr(err.message, "No such file or directory"));
}

// In a child, because a user's rights and limits cannot be taken back. Exits with 0 when writing
// 100 kB failed with a message that has `words`, and left nothing.
static void assert_child_is_refused(rlim_t limit, const char *words)
{
    pid_t child = fork();
    if (child == 0) {
        Error err = {0};
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){limit, RLIM_INFINITY});
        JsonWriter *json = json_create(path, &err);
        if (json) {
            json_begin_list(json, NULL);
            for (int32_t k = 0; k < 20000; k++) json_number(json, NULL, k);
            json_end(json);
            json_finish(json, &err);
        }
        bool as_expected = err.code == ERROR_FILE && strstr(err.message, words) &&
                           strstr(err.message, path) && !exists(part) && !exists(path);
        if (!as_expected) fprintf(stderr, "%s\n", err.message);
        // Coverage counts are files, too, and are written on exit.
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){RLIM_INFINITY, RLIM_INFINITY});
        exit(as_expected ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(a_full_disk_leaves_nothing)
{
    unlink(path);
    assert_child_is_refused(0, "File too large");
    assert_child_is_refused(50000, "File too large");
}

TEST(every_path_frees_when_memory_is_short)
{
    int64_t live = memory_counters().live;
    for (int64_t k = 0; k < 2; k++) {   // the text grows in memory of the C library
        Error err = {0};
        unlink(path);
        memory_fail_after(k);
        JsonWriter *json = json_create(path, &err);
        if (json) {
            json_begin_list(json, NULL);
            for (int32_t n = 0; n < 5000; n++) json_integer(json, NULL, n);
            json_end(json);
            json_finish(json, &err);
        }
        memory_fail_after(-1);
        assert_int_equal(memory_counters().live, live);
        assert_int_equal(err.code, k < 1 ? ERROR_MEMORY : ERROR_NONE);
        assert_false(exists(part));
        assert_int_equal(exists(path), k >= 1);
    }
}

TEST(a_document_stays_in_memory)
{
    Error err = {0};
    int64_t live = memory_counters().live;
    JsonWriter *json = json_create(NULL, &err);
    json_begin_object(json, NULL);
    json_text(json, "status", "done");
    json_end(json);
    char *text = json_take(json, &err);
    assert_string_equal(text, "{\n  \"status\": \"done\"\n}\n");
    memory_free(text);
    json = json_create(NULL, &err);
    json_begin_object(json, NULL);
    assert_null(json_take(json, &err));   // not whole
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_int_equal(memory_counters().live, live);
}

GROUP_BETWEEN(make_folder, remove_folder);

// One line, words without quotes where YAML needs none.
TEST(test_flow)
{
    Error err = {0};
    JsonWriter *json = json_create_flow(&err);
    json_begin_object(json, NULL);
    json_text(json, "group", "top");
    json_text(json, "along", "1 + x");
    json_text(json, "empty", "");
    json_begin_list(json, "list");
    json_number(json, NULL, 1e6);
    json_number(json, NULL, 0.1);
    json_begin_object(json, NULL);
    json_boolean(json, "yes", true);
    json_end(json);
    json_end(json);
    json_end(json);
    char *text = json_take(json, &err);
    assert_string_equal(text, "{group: top, along: \"1 + x\", empty: \"\", list: [1e+06, 0.1, "
                              "{yes: true}]}");
    memory_free(text);
}
