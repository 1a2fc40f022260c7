// SPDX-License-Identifier: GPL-2.0-or-later
// Values looked up in a text; every text that is cut off or garbled is survived.
#include "io/text/json_reader.h"

#include "cases.h"

#include <math.h>
#include <string.h>

static const char TEXT[] =
    "{\n  \"status\": \"done\", \"odd \\\"key\\\"\": {\"}\": 1},\n"
    "  \"results\": {\"mu_M\": 0.25, \"none\": null, \"periodic\": true, \"off\": false,\n"
    "    \"peaks\": [{\"mu\": 0.5, \"U\": 1e-3}, {\"mu\": -2.5e-1}], \"list\": [1, 2.5, 3]},\n"
    "  \"message\": \"say \\\"no\\\", [not] {this}\\n\\u0041\\u20ac end\", \"last\": 7\n}\n";

TEST(test_numbers)
{
    static const struct {
        const char *path;
        double value;
    } known[] = {{"results.mu_M", 0.25},      {"results.periodic", 1},
                 {"results.off", 0},          {"results.peaks.0.mu", 0.5},
                 {"results.peaks.0.U", 1e-3}, {"results.peaks.1.mu", -0.25},
                 {"results.list.2", 3},       {"last", 7}};
    double value = 0;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        assert_true(json_find_number(TEXT, known[k].path, &value));
        assert_true(value == known[k].value);
    }
    assert_true(json_find_number(TEXT, "results.none", &value));
    assert_true(isnan(value));
}

TEST(test_absent)
{
    static const char *const paths[] = {"mu_M",
                                        "results.mu",
                                        "results.peaks.2.mu",
                                        "status",
                                        "results.list.three",
                                        "results.list.-1",
                                        "results.",
                                        "results.mu_M.x",
                                        "results.peaks.mu",
                                        "resultsx",
                                        "result",
                                        "results.list.1x"};
    double value = 0;
    char text[20];
    for (size_t k = 0; k < sizeof paths / sizeof paths[0]; k++)
        assert_false(json_find_number(TEXT, paths[k], &value));
    assert_false(json_find_text(TEXT, "last", text, sizeof text));
    assert_false(json_find_text(TEXT, "nothing", text, sizeof text));
    assert_false(json_find_number("", "last", &value));
}

TEST(test_texts)
{
    char text[80], few[4];
    assert_true(json_find_text(TEXT, "status", text, sizeof text));
    assert_string_equal(text, "done");
    assert_true(json_find_text(TEXT, "message", text, sizeof text));
    assert_string_equal(text, "say \"no\", [not] {this}\nA? end");
    assert_true(json_find_text(TEXT, "status", few, sizeof few));
    assert_string_equal(few, "don");
}

// The quote that ends the text is no digit of the escape.
TEST(test_short_escape)
{
    char text[80];
    const char *short_of_digits = "{\"a\": \"x\\u4\", \"b\": \"no part of a\"}";
    assert_true(json_find_text(short_of_digits, "a", text, sizeof text));
    assert_string_equal(text, "x\x04");
    assert_true(json_find_text("{\"a\": \"\\u&0\"}", "a", text, sizeof text));
    assert_string_equal(text, "?&0");
}

// An index stands for every item: a list may be shorter at another time.
// Values that are nested deeper than any of our files, or end within a text, are not read.
TEST(test_depth)
{
    char text[200] = "", value[10];
    double number = 0;
    for (int k = 0; k < 70; k++) strcat(text, "[");
    strcat(text, "1");
    for (int k = 0; k < 70; k++) strcat(text, "]");
    assert_false(json_is_whole(text));
    assert_false(json_find_number("{\"a\": [[[", "b", &number));
    assert_false(json_find_text("{\"a\": \"b", "a", value, sizeof value));
    assert_false(json_find_text(TEXT, "status", value, 0));
    assert_true(json_is_whole(" {\r\n\t\"a\" :\t1 }\r\n"));
    assert_false(json_is_whole("{\"a\": 1} 2"));
}

TEST(test_may_hold)
{
    static const char *const holds[] = {"last",
                                        "status",
                                        "results.none",
                                        "results.list.9",
                                        "results.peaks.7.U",
                                        "results.peaks.0.mu",
                                        "empty.3.thing"};
    static const char *const lacks[] = {"results",
                                        "results.peaks",
                                        "results.peaks.0",
                                        "results.mu",
                                        "results.peaks.0.V",
                                        "results.peaks.U",
                                        "results.list.9.mu",
                                        "last.0",
                                        "",
                                        "empty.thing"};
    static const char text[] =
        "{\"empty\": [], \"last\": 7, \"status\": \"\", \"results\": {\"none\": "
        "null, \"list\": [1, 2], \"mu_M\": 1, \"peaks\": [{\"mu\": 1}, {\"mu\": "
        "2, \"U\": 3}]}}";
    for (size_t k = 0; k < sizeof holds / sizeof holds[0]; k++)
        if (!json_may_hold(text, holds[k])) fail_msg("%s", holds[k]);
    for (size_t k = 0; k < sizeof lacks / sizeof lacks[0]; k++)
        if (json_may_hold(text, lacks[k])) fail_msg("%s", lacks[k]);
}

TEST(test_keys)
{
    char key[20];
    static const char *const keys[] = {"mu_M", "none", "periodic", "off", "peaks", "list"};
    for (int32_t k = 0; k < 6; k++) {
        assert_true(json_find_key(TEXT, "results", k, key, sizeof key));
        assert_string_equal(key, keys[k]);
    }
    assert_false(json_find_key(TEXT, "results", 6, key, sizeof key));
    assert_true(json_find_key(TEXT, "results.peaks.1", 0, key, sizeof key));
    assert_string_equal(key, "mu");
    assert_true(json_find_key(TEXT, "", 0, key, 4));
    assert_string_equal(key, "sta");
    assert_false(json_find_key(TEXT, "last", 0, key, sizeof key));
    assert_false(json_find_key(TEXT, "results.list", 0, key, sizeof key));
}

// Cut anywhere, or with any byte replaced: an answer or none, and no byte beyond the end is read
// (the sanitizers say so: the text is copied to where it just fits).
TEST(test_damage)
{
    enum { SIZE = sizeof TEXT };
    for (size_t k = 0; k < SIZE; k++) {
        char cut[SIZE], text[40];
        double value = 0;
        memcpy(cut, TEXT, SIZE);
        cut[k] = 0;
        json_find_number(cut, "last", &value);
        for (const char *other = "{}[]\",\\:0"; *other && k + 1 < SIZE; other++) {
            memcpy(cut, TEXT, SIZE);
            cut[k] = *other;
            json_find_number(cut, "results.peaks.1.mu", &value);
            json_find_text(cut, "message", text, sizeof text);
            json_may_hold(cut, "results.peaks.9.mu");
            json_find_key(cut, "results.peaks.1", 3, text, sizeof text);
        }
    }
}

TEST(test_shorter)
{
    char text[sizeof TEXT], whole[sizeof TEXT];
    double value = 0;
    memcpy(text, TEXT, sizeof TEXT);
    json_drop(text, "results.nowhere");
    assert_string_equal(text, TEXT);
    json_drop(text, "results.peaks");
    assert_false(json_find_number(text, "results.peaks.0.mu", &value));
    assert_true(json_find_number(text, "results.list.1", &value) && value == 2.5);
    assert_true(json_find_number(text, "last", &value) && value == 7);
    json_compact(text);
    assert_string_equal(text,
                        "{\"status\":\"done\",\"odd \\\"key\\\"\":{\"}\":1},"
                        "\"results\":{\"mu_M\":0.25,\"none\":null,\"periodic\":true,\"off\":false,"
                        "\"peaks\":null,\"list\":[1,2.5,3]},"
                        "\"message\":\"say \\\"no\\\", [not] {this}\\n\\u0041\\u20ac end\","
                        "\"last\":7}");
    memcpy(whole, text, sizeof whole);
    json_compact(text);
    assert_string_equal(text, whole);
    for (size_t length = 0; length < sizeof TEXT - 1; length++) {   // cut off: survived
        memcpy(text, TEXT, sizeof TEXT);
        text[length] = 0;
        json_drop(text, "results.list");
        json_compact(text);
    }
}
