// SPDX-License-Identifier: GPL-2.0-or-later
// Trees, places and errors of YAML texts; lines and columns were counted by hand.
#include "base/memory.h"
#include "cases.h"
#include "io/text/yaml_document.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char good[] = "title: A \"small\" one   # with a comment\n"
                           "block: {young: 1e3, names: [top, 'rod 2', \"\"]}\n"
                           "empty:\n"
                           "tilde: ~\n"
                           "unité: 10 um/s\n"
                           "deep:\n"
                           "  deeper:\n"
                           "    - one\n"
                           "    - {two: 2}\n";

static YamlDocument *parse(const char *text)
{
    Error err = {0};
    YamlDocument *document = NULL;
    if (!yaml_parse("scene.yaml", text, 0, &document, &err)) fail_msg("%s", err.message);
    return document;
}

TEST(test_tree)
{
    YamlDocument *document = parse(good);
    static const struct {
        const char *path;
        YamlKind kind;
        const char *text;
        int32_t line, column;
    } cases[] = {
        {"", YAML_MAP, "", 1, 1},
        {"title", YAML_SCALAR, "A \"small\" one", 1, 8},
        {"block", YAML_MAP, "", 2, 8},
        {"block.young", YAML_SCALAR, "1e3", 2, 16},
        {"block.names", YAML_LIST, "", 2, 28},
        {"empty", YAML_NOTHING, "", 3, 1},
        {"tilde", YAML_NOTHING, "", 4, 8},
        {"unité", YAML_SCALAR, "10 um/s", 5, 8},
        {"deep.deeper", YAML_LIST, "", 8, 5},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        YamlNode node = yaml_look_up(document, cases[k].path);
        assert_int_not_equal(node, YAML_NO_NODE);
        assert_int_equal(yaml_kind(document, node), cases[k].kind);
        assert_string_equal(yaml_text(document, node), cases[k].text);
        assert_int_equal(yaml_line(document, node), cases[k].line);
        assert_int_equal(yaml_column(document, node), cases[k].column);
    }
    assert_int_equal(yaml_look_up(document, "block.yo"), YAML_NO_NODE);
    assert_int_equal(yaml_look_up(document, "title.x"), YAML_NO_NODE);
    yaml_destroy(document);
}

TEST(test_lists_keep_their_order)
{
    YamlDocument *document = parse(good);
    YamlNode list = yaml_look_up(document, "block.names");
    assert_int_equal(yaml_count(document, list), 3);
    static const char *const texts[] = {"top", "rod 2", ""};
    static const bool quoted[] = {false, true, true};
    static const int32_t columns[] = {29, 34, 43};
    int32_t k = 0;
    for (YamlNode item = yaml_first(document, list); item != YAML_NO_NODE;
         item = yaml_next(document, item), k++) {
        assert_string_equal(yaml_text(document, item), texts[k]);
        assert_int_equal(yaml_is_quoted(document, item), quoted[k]);
        assert_int_equal(yaml_kind(document, item), YAML_SCALAR);
        assert_string_equal(yaml_key(document, item), "");
        assert_int_equal(yaml_column(document, item), columns[k]);
    }
    assert_int_equal(k, 3);
    YamlNode item =
        yaml_next(document, yaml_first(document, yaml_look_up(document, "deep.deeper")));
    assert_string_equal(yaml_key(document, yaml_first(document, item)), "two");
    yaml_destroy(document);
}

TEST(test_bad_texts)
{
    static const struct {
        const char *text, *place, *words;
    } cases[] = {
        {"a: 1\nb: 2\na: 3\n", "s.yaml:3:1: ", "`a` stands twice (first in line 1)"},
        {"m: {x: 1, y: 2,\n    x: 3}\n", "s.yaml:2:5: ", "`x` stands twice (first in line 1)"},
        {"a: [1, 2\nb: 3\n", "s.yaml:3:1: ", "without a closing bracket"},
        {"a: 1\n\tb: 2\n", "s.yaml:1:4: ", "not YAML"},
        {"a: b: c\n", "s.yaml:1:5: ", "not YAML"},
        {"a: \"x\\q\"\n", "s.yaml:1:6: ", "invalid escape"},
        {"a: @b\n", "s.yaml:1:4: ", "not YAML"},
        {"a: &x 1\nb: *x\n", "s.yaml:1:", "aliases"},
        {"a: *x\n", "s.yaml:1:", "aliases"},
        {"a: \"x\\0y\"\n", "s.yaml:1:4: ", "the character U+0000"},
        {"a: \"\\0\"\n", "s.yaml:1:4: ", "the character U+0000"},
        {"\"a\\x00b\": 1\n", "s.yaml:1:1: ", "the character U+0000"},
        {"a: 1\n---\nb: 2\n", "s.yaml:2:1: ", "second document"},
        {"a: 1\n[x]: 2\n", "s.yaml:2:1: ", "a key must be a plain word"},
        {"a: 1\n: 2\n", "s.yaml:", "a key must be"},
        {"a: \x01\n", "s.yaml:1:4: ", "0x01: not a text file"},
        {"a: 1\nb: \xff\n", "s.yaml:2:4: ", "0xFF: not UTF-8"},
        {"a: \xc0\x80\n", "s.yaml:1:4: ", "0xC0: not UTF-8"},
        {"a: \xed\xa0\x80\n", "s.yaml:1:4: ", "0xED: not UTF-8"},
        {"a: \xe2\x82", "s.yaml:1:4: ", "0xE2: not UTF-8"},
        {"a: [[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]", "s.yaml:1:", "more than 16 levels"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        Error err = {0};
        YamlDocument *document = NULL;
        assert_false(yaml_parse("s.yaml", cases[k].text, 0, &document, &err));
        assert_null(document);
        assert_int_equal(err.code, ERROR_INPUT);
        if (strncmp(err.message, cases[k].place, strlen(cases[k].place)) != 0 ||
            !strstr(err.message, cases[k].words))
            fail_msg("case %zu: %s", k, err.message);
    }
}

TEST(test_errors_show_the_line)
{
    YamlDocument *document = parse(good);
    Error err = {0};
    yaml_error(document, yaml_look_up(document, "block.young"), &err, "too %s", "large");
    assert_string_equal(err.message, "scene.yaml:2:16: too large\n"
                                     "    2 | block: {young: 1e3, names: [top, 'rod 2', \"\"]}\n"
                                     "      |                ^");
    error_clear(&err);
    yaml_key_error(document, yaml_look_up(document, "unité"), &err, "not known");
    assert_string_equal(err.message, "scene.yaml:5:1: not known\n"
                                     "    5 | unité: 10 um/s\n"
                                     "      | ^");
    const struct {
        const char *path, *found;
    } refused[] = {{"block.names", "n: found a list of 3; allowed: a number"},
                   {"block", "n: found a map of 2 keys; allowed: a number"},
                   {"block.young", "n: found `1e3`; allowed: a number"},
                   {"empty", "n: found nothing; allowed: a number"}};
    for (int k = 0; k < 4; k++) {
        error_clear(&err);
        assert_false(
            yaml_refuse(document, yaml_look_up(document, refused[k].path), "n", "a number", &err));
        if (!strstr(err.message, refused[k].found)) fail_msg("%s", err.message);
    }
    yaml_destroy(document);
}

TEST(test_long_lines_are_cut_around_the_caret)
{
    char text[3000] = "a: [", last[40] = "";
    for (int i = 0; i < 400; i++) snprintf(text + strlen(text), 20, "%d, ", 1000 + i);
    strcat(text, "here]");
    YamlDocument *document = parse(text);
    Error err = {0};
    YamlNode item = yaml_first(document, yaml_look_up(document, "a"));
    while (yaml_next(document, item) != YAML_NO_NODE) item = yaml_next(document, item);
    yaml_error(document, item, &err, "x");
    char *line = strchr(err.message, '\n') + 1;
    char *caret = strchr(line, '\n') + 1;
    assert_true(caret - line < 110);
    snprintf(last, sizeof last, "%.5s", line + strcspn(caret, "^"));
    assert_string_equal(last, "here]");
    yaml_destroy(document);
}

TEST(test_skipped_text_is_shown)
{
    Error err = {0};
    YamlDocument *document = NULL;
    assert_true(yaml_parse("--set a.b=7", "a.b=7", 4, &document, &err));
    assert_string_equal(yaml_text(document, YAML_ROOT), "7");
    yaml_error(document, YAML_ROOT, &err, "no");
    assert_string_equal(err.message, "--set a.b=7:1:5: no\n    1 | a.b=7\n      |     ^");
    yaml_destroy(document);
    error_clear(&err);
    assert_false(yaml_parse("--set", "a=[1", 2, &document, &err));
    assert_non_null(strstr(err.message, "a=[1"));
}

TEST(test_empty_texts_are_nothing)
{
    static const char *const texts[] = {"", "  \n\n", "# only a comment\n", "---\n", "~", "\r\n"};
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) {
        YamlDocument *document = parse(texts[k]);
        assert_int_equal(yaml_kind(document, YAML_ROOT), YAML_NOTHING);
        yaml_destroy(document);
    }
}

TEST(test_windows_lines)
{
    YamlDocument *document = parse("a: 1\r\nb: two\r\n");
    Error err = {0};
    yaml_error(document, yaml_look_up(document, "b"), &err, "x");
    assert_string_equal(err.message, "scene.yaml:2:4: x\n    2 | b: two\n      |    ^");
    yaml_destroy(document);
}

// --- files --------------------------------------------------------------------------------------

static void write_file(const char *path, const char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void assert_read_fails(const char *path, ErrorCode code, const char *words)
{
    Error err = {0};
    YamlDocument *document = NULL;
    assert_false(yaml_read(path, &document, &err));
    assert_null(document);
    if (err.code != code || !strstr(err.message, words) || !strstr(err.message, path))
        fail_msg("%s: %s", amontons_error_name(err.code), err.message);
}

TEST(test_files)
{
    char folder[] = "/tmp/yaml-test-XXXXXX", path[100];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    assert_read_fails(path, ERROR_INPUT, "No such file");
    assert_read_fails(folder, ERROR_INPUT, "is a folder");
    write_file(path,
               "\xEF\xBB\xBF"
               "a: 1\n",
               8);
    Error err = {0};
    YamlDocument *document = NULL;
    assert_true(yaml_read(path, &document, &err));
    assert_int_equal(yaml_column(document, yaml_look_up(document, "a")), 4);
    yaml_destroy(document);
    write_file(path, "a: 1\0b: 2\n", 10);
    assert_read_fails(path, ERROR_INPUT, "0x00: not a text file");
    assert_int_equal(truncate(path, 1 << 30), 0);   // sparse: no byte of it is stored
    assert_read_fails(path, ERROR_INPUT, "more than the 1048576 bytes");
    assert_read_fails("/proc/self/mem", ERROR_FILE, "cannot read");
    unlink(path);
    rmdir(folder);
}

TEST(test_too_many_nodes)
{
    size_t size = 100000;
    char *text = malloc(size + 1);
    for (size_t i = 0; i < size; i += 2) memcpy(text + i, i ? "1," : " [", 2);
    text[size] = 0;
    Error err = {0};
    YamlDocument *document = NULL;
    assert_false(yaml_parse("big", text, 0, &document, &err));
    assert_non_null(strstr(err.message, "more than 20000 values"));
    free(text);
}

TEST(test_memory_faults)
{
    int64_t live = memory_counters().live;
    bool done = false;
    for (int64_t k = 0; !done; k++) {
        assert_true(k < 100);
        Error err = {0};
        YamlDocument *document = NULL;
        memory_fail_after(k);
        done = yaml_parse("scene.yaml", good, 0, &document, &err);
        memory_fail_after(-1);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        yaml_destroy(document);
        assert_int_equal(memory_counters().live, live);
    }
}

// Any bytes end in a tree or in an error; the tree's nodes are all reachable exactly once.
static int32_t count_nodes(const YamlDocument *document, YamlNode node)
{
    int32_t count = 1;
    for (YamlNode child = yaml_first(document, node); child != YAML_NO_NODE;
         child = yaml_next(document, child))
        count += count_nodes(document, child);
    return count;
}

TEST(test_mutated_texts)
{
    static const char letters[] = "{}[],:#&*!|>'\"%@`-? \n\t\r0a~\\\xc3\xa9\x80";
    uint32_t random = 12345;
    int64_t live = memory_counters().live;
    for (int32_t k = 0; k < 4000; k++) {
        char text[sizeof good];
        memcpy(text, good, sizeof good);
        for (int32_t i = 0; i <= k % 5; i++) {
            random = random * 1664525u + 1013904223u;
            text[(random >> 8) % (sizeof good - 1)] = letters[(random >> 24) % (sizeof letters)];
        }
        Error err = {0};
        YamlDocument *document = NULL;
        bool done = yaml_parse("fuzz", text, 0, &document, &err);
        assert_int_equal(done, error_is_clean(&err));
        if (done) assert_in_range(count_nodes(document, YAML_ROOT), 1, 100);
        yaml_destroy(document);
    }
    assert_int_equal(memory_counters().live, live);
}
