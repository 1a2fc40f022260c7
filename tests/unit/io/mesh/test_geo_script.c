// SPDX-License-Identifier: GPL-2.0-or-later
// Commands of a .geo, what becomes of them in the text that gmsh is given, and scripts that would
// keep the reader busy for ever.
#include "io/mesh/geo_script.h"

#include "base/memory.h"
#include "result_place.h"

#include <string.h>

static void expect_refused(const char *place, const char *wanted)
{
    Error err = {0};
    GeoScript script = {0};
    assert_false(geo_script_read(place_path(place, "a.geo"), &script, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, wanted)) fail_msg("%s\nlacks %s", err.message, wanted);
    geo_script_destroy(&script);
}

static GeoScript read_script(const char *place)
{
    Error err = {0};
    GeoScript script = {0};
    if (!geo_script_read(place_path(place, "a.geo"), &script, &err)) fail_msg("%s", err.message);
    return script;
}

// Opening a pipe that nobody writes to would wait.
TEST(test_pipe)
{
    char place[PLACE_SIZE];
    place_make(place);
    assert_int_equal(mkfifo(place_path(place, "pipe"), 0600), 0);
    place_write(place, "a.geo", "Include \"pipe\";\n");
    expect_refused(place, "no file");
    assert_int_equal(mkfifo(place_path(place, "pipe.step"), 0600), 0);
    place_write(place, "a.geo", "Merge \"pipe.step\";\n");
    expect_refused(place, "no file");
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

// Texts that keep the reader busy for ever if a search begins at each of their words, as the clock
// of ctest tells: 2 MB each.
TEST(test_endless)
{
    static const char *const cases[] = {"x(",          "x[0](",  "x.",   "x~{", "DefineConstant[a,",
                                        "Field[1",     "x~",     "(",    "{",   "x = ((",
                                        "x = {1}; x(", "Max(1,", "View["};
    enum { SIZE = 1 << 21 };
    char place[PLACE_SIZE], *text = malloc(SIZE + 100);
    place_make(place);
    assert_non_null(text);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Error err = {0};
        GeoScript script = {0};
        char *at = text;
        while (at < text + SIZE) at = stpcpy(at, cases[k]);
        strcpy(at, ";\nx = 1;\n");
        place_write(place, "a.geo", text);
        geo_script_read(place_path(place, "a.geo"), &script, &err);   // refused or not
        geo_script_destroy(&script);
    }
    char *at = text;
    while (at < text + SIZE / 4) at = stpcpy(at, "Merge \"absent.step\";\n");
    place_write(place, "a.geo", text);
    GeoScript script = read_script(place);
    geo_script_destroy(&script);
    free(text);
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

// Every way out of the script that gmsh has, plain and hidden.
TEST(test_refused)
{
    static const struct {
        const char *text, *wanted;
    } cases[] = {
        {"\n\nSystemCall \"id\";\n", "a.geo:3: `SystemCall` runs a command"},
        {"/* \" */ NonBlockingSystemCall \"id\"; // \"\n", "`NonBlockingSystemCall`"},
        {"s = '\"'; System \"id\"; t = '\"';\n", "`System` runs"},
        {"Field[1]=ExternalProcess; Background Field=1;\n",
         "`ExternalProcess` is no kind of field"},
        {"Field [ 1+1 ] = /**/ ExternalProcess;\n", "`ExternalProcess` is no kind"},
        {"Field[1]=Structured;\n", "`Structured` is no kind"},
        {"Field[1]=Box; Field[1].CommandLine=\"id\";\n", "`CommandLine` opens"},
        {"Field[1]=PostView; Field[1].FileName=\"/etc/passwd\";\n", "`FileName` opens"},
        {"OnelabRun(\"x\", \"id\");\n", "`OnelabRun` has to do"},
        {"CreateDir \"x\";\n", "`CreateDir` makes a folder"},
        {"x = GetEnv(\"HOME\");\n", "`GetEnv` asks"},
        {"S2N[\"SystemCall\"] \"id\";\n", "`S2N` makes a name"},
        {"a() = ListFromFile(\"/etc/passwd\");\n", "`ListFromFile`"},
        {"x = GetValue(\"how many?\", 3);\n", "`GetValue` asks"},
        {"NewCommand \"id\";\n", "`NewCommand` is neither"},
        {"NewCommand = 1; NewCommand \"id\";\n", "`NewCommand` is no command"},
        {"SystemCall = 1;\n", "`SystemCall`"},
        {"DefineConstant[SystemCall = 1];\n", "`SystemCall`"},
        {"x = 1 . SystemCall \"id\";\n", "`SystemCall`"},
        {"3SystemCall \"id\";\n", "`SystemCall`"},
        {"x = 3 4 General.LogFileName = \"f\";\n", "`General` shows or writes"},
        {"x = Printf(\"a\") > \"f\";\n", "`Printf` shows or writes"},
        {"x = 1 Save \"f.msh\";\n", "`Save`"},
        {"Printf(\"x\"", "`Printf` begins a statement that has no end"},
        {"Include name;\n", "`Include` includes a file whose name is not written out"},
        {"Merge name;\n", "`Merge` opens a file whose name"},
        {"Merge \"x.py\";\n", "x.py"},
        {"Merge \"script.msh\";\n", "is no mesh"},
        {"Merge \"opted.step\";\n", "options beside it"},
        {"v() = ShapeFromFile(1 Merge \"a.step\"; );\n", "`Merge` stands inside"},
        {"v() = ShapeFromFile(ShapeFromFile(\"a.step\"));\n", "`ShapeFromFile` stands inside"},
        {"v() = ShapeFromFile(1 Exit);\n", "`Exit` stands inside"},
        {"v() = ShapeFromFile(Str(\"a\") Printf);\n", "`Printf` stands inside"},
        {"Include 'wild.geo';\n", "wild.geo:2: `SystemCall`"},
        {"Merge 'wild.geo';\n", "wild.geo:2: `SystemCall`"},
        {"If(0) s = \"EndIf SystemCall\"; EndIf\n", "holds a word that ends what gmsh skips"},
        {"x1EndIf = 1;\n", "has a word in it that ends"},
        {"s = \"no end;\n", "has no end"},
        {"/* no end\n", "has no end"}};
    char place[PLACE_SIZE], longer[2000];
    place_make(place);
    place_write(place, "wild.geo", "\nSystemCall \"touch here\";\n");
    place_write(place, "x.py", "import os\n");
    place_write(place, "script.msh", "SystemCall \"id\";\n");
    place_write(place, "opted.step", "ISO\n");
    place_write(place, "opted.step.opt", "SystemCall \"id\";\n");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        place_write(place, "a.geo", cases[k].text);
        expect_refused(place, cases[k].wanted);
    }
    memset(longer, 'x', sizeof longer);
    memcpy(longer, "s = \"", 5);
    strcpy(longer + sizeof longer - 4, "\";\n");
    place_write(place, "a.geo", longer);
    expect_refused(place, "longer than gmsh reads");
    FILE *file = fopen(place_path(place, "a.geo"), "w");
    fwrite("nx = 1;\0SystemCall", 1, 18, file);
    fclose(file);
    expect_refused(place, "is no text");
    place_remove(place);
}

static void link_to(const char *place, const char *name, const char *target)
{
    unlink(place_path(place, name));
    assert_int_equal(symlink(target, place_path(place, name)), 0);
}

// gmsh goes by the ending of the path that it is given and by what stands beside it. It is given
// the path that was checked, and never the one that a link leads to.
TEST(test_links)
{
    static const char *const targets[] = {"evil.geo", "r/x.step", "EndIf System\"x\".step"};
    char place[PLACE_SIZE], wanted[2 * PLACE_SIZE];
    place_make(place);
    assert_int_equal(mkdir(place_path(place, "r"), 0777), 0);
    place_write(place, "evil.geo", "SystemCall \"id\";\n");
    place_write(place, "r/x.step", "ISO\n");
    place_write(place, "r/x.step.opt", "SystemCall \"id\";\n");
    place_write(place, targets[2], "ISO\n");
    place_write(place, "a.geo", "Merge \"part.step\";\n");
    for (size_t k = 0; k < sizeof targets / sizeof *targets; k++) {
        link_to(place, "part.step", targets[k]);
        GeoScript script = read_script(place);
        snprintf(wanted, sizeof wanted, "\"%s/part.step\";", place);
        if (!strstr(script.text, wanted)) fail_msg("%s\nlacks %s", script.text, wanted);
        geo_script_destroy(&script);
    }
    link_to(place, "part.step.opt", "nowhere.opt");
    expect_refused(place, "options beside it");

    // A folder through a link: its real name, which would end an If, does not come into the text.
    assert_int_equal(mkdir(place_path(place, "EndIf x"), 0777), 0);
    link_to(place, "calm", "EndIf x");
    place_write(place, "calm/b.geo", "v() = ShapeFromFile(\"a.step\");\n");
    place_write(place, "a.geo", "If (0)\nInclude \"calm/b.geo\";\nEndIf\n");
    GeoScript script = read_script(place);
    assert_null(strstr(script.text, "EndIf x"));
    assert_non_null(strstr(script.text, "calm/\""));
    geo_script_destroy(&script);
    place_remove(place);
}

// The folder of the script comes into the text, too. gmsh ends a string after 1023 bytes.
TEST(test_folders)
{
    static const char *const texts[] = {"Merge \"a.step\";\n", "v() = ShapeFromFile(\"a.step\");\n",
                                        "If (0) Include \"absent.geo\"; EndIf\n"};
    char place[PLACE_SIZE], below[1500], part[200];
    place_make(place);
    for (int turn = 0; turn < 2; turn++) {
        size_t length = (size_t)snprintf(below, sizeof below, "%s", place);
        memset(part, 'x', sizeof part);
        part[sizeof part - 1] = 0;
        for (int k = 0; k < (turn == 0 ? 1 : 6); k++) {
            length += (size_t)snprintf(below + length, sizeof below - length, "/%s",
                                       turn == 0 ? "If Else System 'id'" : part);
            assert_int_equal(mkdir(below, 0777), 0);
        }
        for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
            Error err = {0};
            GeoScript script = {0};
            char path[1600];
            snprintf(path, sizeof path, "%s/a.geo", below);
            FILE *file = fopen(path, "w");
            assert_non_null(file);
            fputs(texts[k], file);
            fclose(file);
            assert_false(geo_script_read(path, &script, &err));
            assert_int_equal(err.code, ERROR_INPUT);
            geo_script_destroy(&script);
        }
    }
    place_remove(place);
}

// Text in comments and strings is no command, nor is an option of meshes or a name of one's
// own; what shows or writes is left out, and the lines stay.
TEST(test_let_through)
{
    static const struct {
        const char *text, *becomes;   // NULL: itself; compared without blanks
    } cases[] = {
        {"// System: SystemCall \"id\";\nPoint(1) = {0, 0, 0};\n", "Point(1) = {0, 0, 0};"},
        {"/* Save\n \"x\" */ Mesh.SaveAll = 1;\n", "Mesh.SaveAll = 1;"},
        {"Physical Curve(\"System: Save\") = {1};\n", NULL},
        {"Printed = 1; Savings = 2; x = Printed + Savings;\n", NULL},
        {"Printf(\"x\") >> \"f\"; nx = 1;\n", "nx = 1;"},
        {"Save \"x.msh\"; Print \"x.png\"; Print.Width = 3; nx = 1;\n", "nx = 1;"},
        {"General.Terminal = 1;General.LogFileName = \"f\"; nx = 1;\n", "nx = 1;"},
        {"Geometry.Color.Points = Orange; Color Red {Surface{1};} nx = 1;\n", "nx = 1;"},
        {"If (1) Printf(\"a;b\", 3); Else Exit; EndIf\n", "If (1) Else Abort; EndIf"},
        {"x = General.MinX;\n", NULL},
        {"Plugin(Warp).Run; Plugin(Crack).Run;\n", "Plugin(Crack).Run;"},
        {"Field[1] = MathEval; Field[1].F = \"x\"; Background Field = 1;\n", NULL},
        {"DefineConstant[ a = {1, Choices{1, 2}, Name \"b\"} ]; Point(a) = {0};\n", NULL},
        {"For i In {0:3} Point(i) = {i, 0, 0}; EndFor\n", NULL},
        {"Macro go Point(x) = {0}; Return\nx = 1; Call go;\n", NULL},
        {"Include 'calm.geo'; x = nx;\n", "nx = 1; x = nx;"},
        {"If (0) Include 'absent.geo'; EndIf\n",
         "If (0) Error(\"cannot open '@/absent.geo'\"); EndIf"},
        {"Merge 'absent.step';\n", "Merge \"@/absent.step\";"},
        {"v() = ShapeFromFile(\"a.step\");\n",
         "v() = ShapeFromFile(StrChoice(StrCmp(StrSub(\"a.step\", 0, 1), \"/\"), StrCat(\"@/\", "
         "\"a.step\"), "
         "\"a.step\"));"}};
    char place[PLACE_SIZE];
    place_make(place);
    place_write(place, "calm.geo", "nx = 1;\n");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char wanted[2000] = "", found[2000] = "";
        int32_t lines = 0, lines_found = 0;
        size_t length = 0;
        const char *text = cases[k].becomes ? cases[k].becomes : cases[k].text;
        place_write(place, "a.geo", cases[k].text);
        GeoScript script = read_script(place);
        for (; *text; text++)
            if (*text == '@')
                length += (size_t)snprintf(wanted + length, sizeof wanted - length, "%s", place);
            else if (!strchr(" \n", *text))
                wanted[length++] = *text;
        length = 0;
        for (int32_t i = 0; i < script.size; i++)
            if (!strchr(" \n", script.text[i])) found[length++] = script.text[i];
        assert_string_equal(found, wanted);
        for (text = cases[k].text; *text; text++) lines += *text == '\n';
        for (text = script.text; *text; text++) lines_found += *text == '\n';
        if (script.file_count == 1) assert_int_equal(lines_found, lines + 1);
        geo_script_destroy(&script);
    }
    place_remove(place);
}

// Lines of the text, of the file and of what it includes.
TEST(test_places)
{
    char place[PLACE_SIZE];
    place_make(place);
    place_write(place, "b.geo", "b1 = 1;\nb2 = 2;\n");
    place_write(place, "a.geo", "a1 = 1;\na2 = 1; Include \"b.geo\"; rest = 1;\na3 = 1;\n");
    GeoScript script = read_script(place);
    static const struct {
        const char *word, *file;
        int32_t line;
    } cases[] = {{"a1", "a.geo", 1}, {"a2", "a.geo", 2},   {"b1", "b.geo", 1},
                 {"b2", "b.geo", 2}, {"rest", "a.geo", 2}, {"a3", "a.geo", 3}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        int32_t line = 1;
        const char *path = NULL, *at = strstr(script.text, cases[k].word);
        assert_non_null(at);
        for (const char *before = script.text; before < at; before++) line += *before == '\n';
        geo_script_place(&script, line, &path, &line);
        assert_non_null(strstr(path, cases[k].file));
        assert_int_equal(line, cases[k].line);
    }
    geo_script_destroy(&script);
    place_remove(place);
}

TEST(test_memory)
{
    char place[PLACE_SIZE];
    int64_t live = memory_counters().live;
    place_make(place);
    place_write(place, "b.geo", "b1 = 1;\n");
    place_write(place, "a.geo", "x = 1; Include \"b.geo\"; Merge \"c.step\";\n");
    for (int64_t k = 0; k < 60; k++) {
        Error err = {0};
        GeoScript script = {0};
        memory_fail_after(k);
        bool done = geo_script_read(place_path(place, "a.geo"), &script, &err);
        memory_fail_after(-1);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        geo_script_destroy(&script);
        assert_int_equal(memory_counters().live, live);
    }
    place_remove(place);
}
