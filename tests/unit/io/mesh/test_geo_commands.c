// SPDX-License-Identifier: GPL-2.0-or-later
// Scripts that would keep the reader busy for ever are refused, by name.
#include "io/mesh/geo_commands.h"

#include "result_place.h"

#include <string.h>

static void expect_refused(const char *place, const char *wanted)
{
    Error err = {0};
    assert_false(geo_commands_refuse(place_path(place, "a.geo"), true, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, wanted)) fail_msg("%s", err.message);
}

// Opening a pipe that nobody writes to would wait.
TEST(test_pipe)
{
    char place[PLACE_SIZE];
    place_make(place);
    assert_int_equal(mkfifo(place_path(place, "pipe"), 0600), 0);
    place_write(place, "a.geo", "Include \"pipe\";\n");
    expect_refused(place, "no file");
    place_write(place, "a.geo", "// nothing\n");
    assert_int_equal(mkfifo(place_path(place, "a.geo.opt"), 0600), 0);
    expect_refused(place, "a.geo.opt, which is no file");
    place_remove(place);
}

// Seven files, each of which includes the next one ten times: 10^7 readings.
TEST(test_tenfold)
{
    char place[PLACE_SIZE], text[400];
    place_make(place);
    for (char name[] = "a.geo"; *name < 'h'; ++*name) {
        size_t length = 0;
        for (int k = 0; k < 10; k++)
            length += (size_t)snprintf(text + length, sizeof text - length, "Include \"%c.geo\";\n",
                                       *name + 1);
        place_write(place, name, text);
    }
    place_write(place, "h.geo", "");
    expect_refused(place, "more than 1000 files");
    place_remove(place);
}

// Itself: as deep as files may include each other.
TEST(test_itself)
{
    char place[PLACE_SIZE];
    place_make(place);
    place_write(place, "a.geo", "Include \"a.geo\";\n");
    expect_refused(place, "deep");
    place_remove(place);
}

// Words that only look like commands are let through, commands in any of the files are not.
TEST(test_words)
{
    static const struct {
        const char *text, *wanted;   // NULL: it is let through
    } cases[] = {
        {"Printf(\"all is well\");\nPrinted = 1;\n", NULL},
        {"Include \"absent.geo\";\n", NULL},   // gmsh cannot open it either
        {"Include 'calm.geo';\n", NULL},
        {"\n\nPrint \"x.png\";\n", "a.geo:3: `Print`: gmsh would run a command"},
        {"Printf(\"x\") >> \"f\";\n", "a.geo:1: `Printf`"},
        {"Include 'wild.geo';\n", "wild.geo:2: `SystemCall`"},
        {"Include name;\n", "a.geo:1: includes a file whose name is not written out"},
    };
    char place[PLACE_SIZE];
    place_make(place);
    place_write(place, "calm.geo", "nx = 1;\n");
    place_write(place, "wild.geo", "\nSystemCall \"touch here\";\n");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Error err = {0};
        place_write(place, "a.geo", cases[k].text);
        if (cases[k].wanted)
            expect_refused(place, cases[k].wanted);
        else if (!geo_commands_refuse(place_path(place, "a.geo"), true, &err))
            fail_msg("%s", err.message);
    }
    FILE *file = fopen(place_path(place, "a.geo"), "w");
    fwrite("nx = 1;\0SystemCall", 1, 18, file);
    fclose(file);
    expect_refused(place, "is no text");
    place_remove(place);
}
