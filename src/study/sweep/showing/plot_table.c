// SPDX-License-Identifier: GPL-2.0-or-later
// Columns are read when they are asked for. A formula is worked out point by point.
#include "study/sweep/showing/plot_table.h"

#include "base/formula.h"
#include "base/memory.h"
#include "base/text.h"
#include "io/files/folder.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { WORDS_SIZE = 1 << 16 };

// --- reading ------------------------------------------------------------------------------------

// The attribute `name`, words with | between them; none where there is none.
static bool read_words(PlotTable *table, const char *name, WordList *words, Error *err)
{
    Error missing = {0};
    double ignored = 0;
    char *text = NEW_ARRAY(char, WORDS_SIZE, err), *rest = text;
    TRY(text);
    if (!array_file_get_text(table->file, name, text, WORDS_SIZE, &missing)) goto cleanup;
    for (const char *word = strsep(&rest, "|"); word; word = strsep(&rest, "|"))
        TRY(words_index(words, word, &ignored, err));
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

// *values: [table->count]; NULL where there is no such array. The first array says how many points
// there are.
static bool read_values(PlotTable *table, const char *name, double **values, Error *err)
{
    int64_t rows = 0;
    int32_t width = 0;
    if (!array_file_has(table->file, name)) return true;
    if (!array_file_read(table->file, name, values, &rows, &width, err)) return false;
    if (width != 1 || rows > INT32_MAX || (table->warned != *values && rows != table->count))
        return FAULT(err, ERROR_FILE, "%s: `%s` has not one number a point", table->path, name);
    table->count = (int32_t)rows;
    return true;
}

bool plot_table_open(const char *folder, PlotTable *table, Error *err)
{
    char units[20] = "";
    Error missing = {0};
    *table = (PlotTable){0};
    if (snprintf(table->path, sizeof table->path, "%s/sweep.h5", folder) >= (int)sizeof table->path)
        return REFUSE(err, "the path of the sweep is too long");
    if (!folder_check_inside(folder, "sweep.h5", err)) return false;
    if (access(table->path, R_OK) != 0)
        return REFUSE(err, "%s: there is no sweep.h5 in it: no sweep has ended there", folder);
    if (!(table->file = array_file_open(table->path, err))) return false;
    array_file_get_text(table->file, "title", table->title, sizeof table->title, &missing);
    const char *slash = strrchr(folder, '/');
    if (!table->title[0])
        snprintf(table->title, sizeof table->title, "%.90s",
                 slash && slash[1] ? slash + 1 : folder);
    if (!read_values(table, "result/warned", &table->warned, err)) return false;
    if (!table->warned || !array_file_get_text(table->file, "units", units, sizeof units, &missing))
        return REFUSE(err,
                      "%s was written by an earlier version: `amontons sweep` on its study writes "
                      "it anew, and computes nothing again",
                      table->path);
    table->is_si = strcmp(units, "si") == 0;
    return true;
}

void quantity_destroy(Quantity *quantity)
{
    memory_free_all(quantity->values, quantity->errors);
    words_destroy(&quantity->words);
    *quantity = (Quantity){0};
}

void plot_table_close(PlotTable *table)
{
    Error ignored = {0};
    array_file_close(table->file, &ignored);
    memory_free(table->warned);
    for (int32_t k = 0; k < table->column_count; k++) quantity_destroy(&table->columns[k]);
    *table = (PlotTable){0};
}

// --- columns ------------------------------------------------------------------------------------

// Returns the column `name`, which is read from the file when it is first asked for. NULL: there is
// none, or it cannot be read, and the error says so.
static const Quantity *find_column(PlotTable *table, const char *name, Error *err)
{
    char place[STUDY_NAME_SIZE + 32];
    WordList known = {0};
    char *all = NULL;
    for (int32_t k = 0; k < table->column_count; k++)
        if (strcmp(table->names[k], name) == 0) return &table->columns[k];
    if (table->column_count == PLOT_COLUMNS_MAX || strlen(name) >= STUDY_NAME_SIZE)
        FAIL(err, ERROR_INPUT, "%s has no column `%.60s`", table->path, name);
    Quantity *column = &table->columns[table->column_count];
    snprintf(table->names[table->column_count++], STUDY_NAME_SIZE, "%s", name);

    // A key of the scene.
    snprintf(place, sizeof place, "scene/%.95s", name);
    TRY(read_values(table, place, &column->values, err));
    column->is_key = column->values != NULL;
    if (column->is_key) {
        column->label = quantity_label(name, table->is_si);
        snprintf(place, sizeof place, "%.95s words", name);
        TRY(read_words(table, place, &column->words, err));
        // A value is the index of a word. The file may be anybody's.
        int32_t words = column->words.count;
        for (int32_t k = 0; words > 0 && k < table->count; k++) {
            double value = column->values[k];
            if (isnan(value) || (value >= 0 && value < words && value == floor(value))) continue;
            FAIL(err, ERROR_FILE,
                 "%s: `%s` holds %g in row %d, and not the number of one of its %d words: the file "
                 "is damaged; `amontons sweep` on its study writes it anew",
                 table->path, name, value, k + 1, words);
        }
        return column;
    }

    // Else a result, with how far it is known or, in older tables, its error.
    snprintf(place, sizeof place, "result/%.95s", name);
    TRY(read_values(table, place, &column->values, err));
    if (!column->values) {
        char hint[TEXT_HINT_SIZE];
        TRY(read_words(table, "columns", &known, err));
        TRY(all = words_join(&known, err));
        for (char *at = all; *at; at++)
            if (*at == '|') *at = ' ';
        const char *near =
            text_hint(name, (const char *const *)known.words, known.count, NULL, hint);
        FAIL(err, ERROR_INPUT, "%s has no column `%.60s`%s%s", table->path, name,
             near ? near : "; it has: ", near ? "" : all);
    }
    column->label = quantity_label(name, false);
    snprintf(place, sizeof place, "result/%.80s_known_to", name);
    TRY(read_values(table, place, &column->errors, err));
    if (column->errors) return column;
    snprintf(place, sizeof place, "result/%.80s_error", name);
    TRY(read_values(table, place, &column->errors, err));
    return column;
cleanup:
    memory_free(all);
    words_destroy(&known);
    return NULL;
}

// --- formulas -----------------------------------------------------------------------------------

typedef struct FormulaPoint {
    PlotTable *table;
    int32_t point;
    int32_t moved;   // the column whose value is taken `by` off; -1: none
    double by;
    bool *used;   // [PLOT_COLUMNS_MAX] out: columns that the formula has
    Error *err;
} FormulaPoint;

static bool value_of(const void *context, const char *name, double *value)
{
    const FormulaPoint *at = context;
    const Quantity *column = find_column(at->table, name, at->err);
    if (!column) return false;
    int32_t k = (int32_t)(column - at->table->columns);
    *value = column->values[at->point] + (k == at->moved ? at->by : 0);
    at->used[k] = true;
    return true;
}

static bool value_at(const char *text, FormulaPoint *at, double *value, Error *err)
{
    FormulaNames names = {.look_up = value_of, .context = at, .unknown = "is no column"};
    Formula formula;
    Error wrong = {0};
    double ignored = 0;
    if (!formula_read(text, &names, &formula, &wrong)) {
        if (error_is_clean(err)) *err = wrong;
        error_context(err, "= %.100s", text);
        return false;
    }
    *value = formula_at(&formula, 0, &ignored);
    return true;
}

// Writes the label of a formula, "~{P}_{ext} · ~{L} (SI)": columns stand by their symbols.
static void formula_label(const char *formula, bool is_si, QuantityLabel *label)
{
    size_t written = 0, size = sizeof label->words;
    while (*formula == ' ') formula++;
    while (*formula && written + QUANTITY_LABEL_SIZE / 2 < size) {
        char name[STUDY_NAME_SIZE];
        size_t length = 0;
        bool begins = isalpha((unsigned char)*formula);
        while (begins && length + 1 < sizeof name &&
               (isalnum((unsigned char)formula[length]) || formula[length] == '.' ||
                formula[length] == '_'))
            length++;
        if (length > 0) {
            snprintf(name, sizeof name, "%.*s", (int)length, formula);
            QuantityLabel column = quantity_label(name, true);
            const char *symbol = strstr(column.words, "~{");
            bool is_key = strchr(name, '.') && strncmp(name, "results.", 8) != 0;
            written += (size_t)snprintf(label->words + written, size - written, "%.40s",
                                        is_key && symbol ? symbol : column.words);
            formula += length;
        } else {
            const char one[2] = {*formula, 0};
            written += (size_t)snprintf(label->words + written, size - written, "%s",
                                        *formula == '*' ? "\u00b7" : one);
            formula++;
        }
    }
    snprintf(label->words + written, size - written, " (%s)", is_si ? "SI" : "normalised");
}

const Quantity *plot_table_find(PlotTable *table, const char *text, Quantity *made, Error *err)
{
    const char *equals = strchr(text, '=');
    if (!equals) return find_column(table, text, err);
    const char *formula = equals + 1;

    // Values, and their errors: half of what each column's own does to the value, independent of
    // each other; NaN where one of them is not known.
    bool used[PLOT_COLUMNS_MAX] = {false}, any = false;
    if (!(made->values = NEW_ARRAY(double, table->count, err))) return NULL;
    for (int32_t k = 0; k < table->count; k++) {
        FormulaPoint point = {table, k, -1, 0, used, err};
        if (!value_at(formula, &point, &made->values[k], err)) return NULL;
    }
    for (int32_t c = 0; c < table->column_count; c++)
        any = any || (used[c] && table->columns[c].errors);
    if (any && !(made->errors = NEW_ARRAY(double, table->count, err))) return NULL;
    for (int32_t k = 0; any && k < table->count; k++) {
        double square = 0;
        for (int32_t c = 0; c < table->column_count; c++) {
            const double *errors = table->columns[c].errors;
            double high = 0, low = 0;
            if (!used[c] || !errors) continue;
            FormulaPoint above = {table, k, c, errors[k], used, err};
            FormulaPoint below = {table, k, c, -errors[k], used, err};
            if (!value_at(formula, &above, &high, err) || !value_at(formula, &below, &low, err))
                return NULL;
            square += 0.25 * (high - low) * (high - low);
        }
        made->errors[k] = sqrt(square);
    }

    // "NAME = FORMULA" has a label of its own.
    formula_label(formula, table->is_si, &made->label);
    int length = (int)(equals - text);
    while (length > 0 && text[length - 1] == ' ') --length;
    if (length > 0) snprintf(made->label.words, sizeof made->label.words, "%.*s", length, text);
    return made;
}
