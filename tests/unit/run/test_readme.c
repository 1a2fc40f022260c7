// SPDX-License-Identifier: GPL-2.0-or-later
// The generated tables of docs/ are what the tables of the code say. When one differs, this writes
// the page with the right table into the build folder, so that mending is one copy.
#include "io/hdf5/result_tables.h"
#include "cases.h"
#include "scene/keys.h"

#include <stdint.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*TableWriter)(FILE *out);

// A page of docs/, zero-terminated; freed by the caller.
static char *read_page(const char *page)
{
    const char *source = getenv("AMONTONS_SOURCE");
    char path[4096];
    snprintf(path, sizeof path, "%s/docs/%s.md", source ? source : ".", page);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    char *text = NULL;
    size_t size = 0;
    ssize_t length = getdelim(&text, &size, '\0', file);
    fclose(file);
    assert_true(length > 0);
    return text;
}

// The text of a writer, without line ends at its end; freed by the caller.
static char *written_by(TableWriter writer)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    writer(out);
    fclose(out);
    while (size > 0 && text[size - 1] == '\n') text[--size] = '\0';
    return text;
}

// `text` with what stands between <!-- name --> and <!-- /name --> replaced by `table`.
static char *with_table(const char *text, const char *name, const char *table)
{
    char open_mark[64], close_mark[64];
    snprintf(open_mark, sizeof open_mark, "<!-- %s -->\n", name);
    snprintf(close_mark, sizeof close_mark, "\n<!-- /%s -->", name);
    const char *start = strstr(text, open_mark);
    assert_non_null(start);
    start += strlen(open_mark);
    const char *end = strstr(start, close_mark);
    assert_non_null(end);
    char *whole = NULL;
    assert_true(asprintf(&whole, "%.*s%s%s", (int)(start - text), text, table, end) > 0);
    return whole;
}

static void check_table(const char *page, const char *name, TableWriter writer)
{
    char *text = read_page(page);
    char *table = written_by(writer);
    assert_true(strlen(table) > 500);
    char *right = with_table(text, name, table);
    bool same = strcmp(text, right) == 0;
    char path[80];
    snprintf(path, sizeof path, "docs-%s.md", page);
    FILE *file = same ? NULL : fopen(path, "w");
    if (file) {
        fputs(right, file);
        fclose(file);
        printf("the table \"%s\" of docs/%s.md is out of date; a right page is %s here\n", name,
               page, path);
    }
    free(right);
    free(table);
    free(text);
    assert_true(same);
}

// "| first | second | ... |"; a bar inside a cell would end the cell, and is escaped.
static void put_row(FILE *out, int32_t count, const char *const *cells)
{
    for (int32_t k = 0; k < count; k++) {
        fputs("| ", out);
        for (const char *c = cells[k]; *c; c++) fprintf(out, *c == '|' ? "\\%c" : "%c", *c);
        fputc(' ', out);
    }
    fputs("|\n", out);
}

// type: "ARRAY_FLOAT64", shown as numpy calls it, for those who read with h5py.
static void put_array(FILE *out, const char *name, const char *shape, const char *type,
                      const char *const unit_and_words[2])
{
    char quoted[80], lower[20] = "";
    snprintf(quoted, sizeof quoted, "`%s`", name);
    for (int32_t k = 0; type[k + 6]; k++) lower[k] = (char)tolower(type[k + 6]);
    put_row(out, 5, (const char *[]){quoted, shape, lower, unit_and_words[0], unit_and_words[1]});
}

static void write_history_table(FILE *out)
{
    static const char *const shapes[] = {[COLUMNS_ONE] = "steps",
                                         [COLUMNS_NODES] = "steps, nodes",
                                         [COLUMNS_PADS] = "steps, pads",
                                         [COLUMNS_PROBES] = "steps, probes, components"};
    fputs("| array | shape | type | unit | what it holds |\n|---|---|---|---|---|\n", out);
#define X(symbol, name, type, columns, unit, words)                                                \
    put_array(out, name, shapes[COLUMNS_##columns], #type, (const char *[]){unit, words});
    RESULT_SERIES(X)
#undef X
#define X(symbol, name, type, unit, words)                                                         \
    put_array(out, name, "nodes", #type, (const char *[]){unit, words});
    RESULT_NODES(X)
#undef X
#define X(symbol, name, type, unit, words)                                                         \
    put_array(out, name, strcmp(name, "faces/nodes") == 0 ? "faces, points" : "corners, 2", #type, \
              (const char *[]){unit, words});
    RESULT_FACES(X)
#undef X
#define X(symbol, name, type, unit, words)                                                         \
    put_array(out, name, "probes, axes", #type, (const char *[]){unit, words});
    RESULT_PROBES(X)
#undef X
#define X(symbol, name, unit, words)                                                               \
    put_array(out, name, strncmp(name, "peaks/", 6) == 0 ? "peaks" : "events", "ARRAY_FLOAT64",    \
              (const char *[]){unit, words});
    RESULT_TABLES(X)
#undef X
    fputs("\n| attribute of the file | unit | what it holds |\n|---|---|---|\n", out);
    fputs(
        "| `title` | text | of the scene |\n| `units` | text | normalised or si |\n"
        "| `version` | text | of amontons |\n"
        "| `pads` | text | names of the pads by their numbers in `nodes/pad`, a line "
        "each |\n"
        "| `states` | text | names of what friction remembers, a line each: theta, phi, one's own; "
        "absent: nothing |\n"
        "| `state_unit` | text | time (theta), 1 (phi) or its own (a formula's, a plug-in's) |\n"
        "| `probes` | text | names of the probes, a line each; absent: there are none |\n"
        "| `warnings` | text | what the run was warned of, a line each; absent: of nothing |\n",
        out);
#define X(symbol, name, unit, words) put_row(out, 3, (const char *[]){"`" name "`", unit, words});
    RESULT_NUMBERS(X)
#undef X
}

TEST(test_history_table)
{
    check_table("results", "history", write_history_table);
}

TEST(test_key_table)
{
    check_table("scenes", "keys", scene_write_reference);
}
