// SPDX-License-Identifier: GPL-2.0-or-later
// The text is looked at twice: once for what separates its cells, once to cut them out, in place (a
// quoted cell only gets shorter).
#include "io/text/csv_reader.h"

#include "base/memory.h"
#include "base/text.h"
#include "base/units.h"
#include "io/files/text_file.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { SIZE_MAX_CSV = 1 << 30, NUMBER_SIZE = 64, REASON_SIZE = 400, UNIT_BEHIND_MAX = 1000 };

static const char BLANKS[] = " \t", ENDS[] = "\r\n", COMMENTS[] = "#%";
static const char SEPARATORS[] = "\t;,", ALL_SEPARATORS[] = "\t;, ";   // in this order

// --- what separates the cells -------------------------------------------------------------------

static const char *next_line(const char *line)
{
    line += strcspn(line, ENDS);
    if (*line == '\r' && line[1] == '\n') line++;
    return *line ? line + 1 : line;
}

// Empty lines, comments, and the line "sep=;" that spreadsheets write for each other.
static bool is_left_out(const char *line)
{
    line += strspn(line, BLANKS);
    bool separator = strncasecmp(line, "sep=", 4) == 0 && line[4] && strchr(ENDS, line[5]);
    return !*line || strchr(ENDS, *line) || strchr(COMMENTS, *line) || separator;
}

static bool ends_line(char c)
{
    return !c || strchr(ENDS, c);
}

static bool is_number(const char *cell, size_t length, double *value)
{
    char copy[NUMBER_SIZE];
    while (length > 0 && strchr(BLANKS, *cell)) cell++, length--;
    while (length > 0 && strchr(BLANKS, cell[length - 1])) length--;
    if (length == 0 || length >= sizeof copy) return false;
    memcpy(copy, cell, length);
    copy[length] = 0;
    char *comma = strchr(copy, ',');
    if (comma && (strchr(copy, '.') || strchr("0123456789", comma[1]) == NULL || !comma[1] ||
                  strchr(comma + 1, ',')))
        return false;
    if (comma) *comma = '.';
    return text_number(copy, value) == (int32_t)length;
}

// Number of cells in a line; *numbers: each of them is a number.
static int32_t count_cells(const char *line, char separator, bool *numbers)
{
    int32_t count = 0;
    *numbers = true;
    if (separator == ' ') line += strspn(line, BLANKS);
    for (;;) {
        // Find the end of the cell. Blanks before a bracket separate nothing: x [mm].
        const char *end = line;
        // A separator that is a tab is none of the blanks before a quote. Else E" is a name.
        bool quoted = false,
             has_quotes = line[strspn(line, separator == '\t' ? " " : BLANKS)] == '"';
        for (; *end && (quoted || !ends_line(*end)); end++) {
            if (*end == '"' && has_quotes) quoted = !quoted;
            if (quoted || (separator == ' ' ? !strchr(BLANKS, *end) : *end != separator)) continue;
            if (separator != ' ') break;
            const char *next = end + strspn(end, BLANKS);
            if (*next != '(' && *next != '[') break;
            end = next - 1;   // all of them at once: there may be millions
        }

        double value;
        *numbers = *numbers && is_number(line, (size_t)(end - line), &value);
        count++;
        if (separator == ' ') end += strspn(end, BLANKS);
        if (ends_line(*end)) return count;
        line = separator == ' ' ? end : end + 1;
    }
}

// Finds what separates the cells: the first that divides the first two lines into equally many,
// more than one. Where their widths differ it is the first that divides the first line: the error
// then counts its cells. If the first line holds numbers, 0,5 1,2 are two with decimal commas.
static char find_separator(const char *text)
{
    const char *first = text;
    char found = 0;
    bool ignored, numbers;
    while (*first && is_left_out(first)) first = next_line(first);
    const char *second = next_line(first);
    while (*second && is_left_out(second)) second = next_line(second);
    int32_t by_blanks = count_cells(first, ' ', &numbers);
    numbers = numbers && by_blanks > 1;
    for (const char *one = SEPARATORS; *one; one++) {
        int32_t count = count_cells(first, *one, &ignored);
        if (count < 2 || (*one == ',' && numbers)) continue;
        if (count_cells(second, *one, &ignored) == count) return *one;
        if (!found) found = *one;
    }
    if (found) return found;
    bool alike = by_blanks > 1 && count_cells(second, ' ', &ignored) == by_blanks;
    return numbers || alike ? ' ' : ',';
}

// --- cells --------------------------------------------------------------------------------------

// The cell that begins at *at, with a zero byte behind it; *at becomes the beginning of the next
// one. *ends: the row does. A quote that is never closed takes the rest of the text.
static char *take_cell(char separator, char **at, bool *ends)
{
    if (separator != '\t') *at += strspn(*at, BLANKS);
    char *cell = *at, *from = *at, *to = *at, *last = *at;   // last: behind what is no blank
    bool quoted = *from == '"';
    if (quoted) ++from;
    while (*from) {
        if (!quoted) {
            if (strchr(ENDS, *from)) break;
            if (separator != ' ' && *from == separator) break;
            if (separator == ' ' && strchr(BLANKS, *from)) {
                const char *next = from + strspn(from, BLANKS);
                if (*next != '(' && *next != '[') break;
                while (from < next) *to++ = *from++;
            }
        }
        if (quoted && *from == '"' && from[1] != '"') {
            quoted = false;
            last = to;
            ++from;
            continue;
        }
        if (quoted && *from == '"') ++from;   // doubled
        bool blank = !quoted && strchr(BLANKS, *from);
        *to++ = *from++;
        if (!blank) last = to;
    }
    if (separator == ' ') from += strspn(from, BLANKS);
    if (*from == '\r' && from[1] == '\n') ++from;
    *ends = separator == ' ' ? ends_line(*from) : *from != separator;
    *at = *from && (separator != ' ' || *ends) ? from + 1 : from;
    *last = 0;
    return cell;
}

// Cells and where they stand, as they are read.
typedef struct Reading {
    CsvTable *table;
    char *at, *line_start;
    int32_t line;   // of the file
    int32_t count, room, byte_room;   // cells
    int32_t lines, line_room;   // rows
} Reading;

static bool add_cell(Reading *reading, const char *cell, int32_t byte, Error *err)
{
    CsvTable *table = reading->table;
    if (!memory_grow(&table->cells, reading->count, &reading->room, sizeof *table->cells, err) ||
        !memory_grow(&table->byte, reading->count, &reading->byte_room, sizeof *table->byte, err))
        return false;
    table->byte[reading->count] = byte;
    table->cells[reading->count++] = cell;
    return true;
}

// One row. What a program leaves at its end, a separator with nothing behind it, is no cell.
static bool read_row(Reading *reading, Error *err)
{
    CsvTable *table = reading->table;
    int32_t width = 0;
    if (!memory_grow(&table->line, reading->lines, &reading->line_room, sizeof *table->line, err))
        return false;
    table->line[reading->lines++] = reading->line;
    char *line_start = reading->line_start;
    char separator = table->separator;
    for (bool ends = false; !ends; width++) {
        char *from = reading->at;
        if (separator != '\t') from += strspn(from, BLANKS);
        const char *cell = take_cell(separator, &reading->at, &ends);
        for (const char *c = from; c < reading->at - 1; c++)   // within a quoted cell
            if (*c == '\n') {
                reading->line++;
                reading->line_start = (char *)c + 1;
            }
        bool first = table->columns == 0;
        if (ends && !*cell && (first ? width > 1 : width == table->columns)) break;
        if (!add_cell(reading, cell, (int32_t)(from - line_start) + 1, err)) return false;
    }
    reading->line++;
    reading->line_start = reading->at;
    if (table->columns == 0) table->columns = width;
    if (width != table->columns)
        return REFUSE(err, "%s:%d: %d cell%s, the first row has %d%s", table->path,
                      table->line[reading->lines - 1], width, width == 1 ? "" : "s", table->columns,
                      table->separator == ',' && width == 2 * table->columns
                          ? "; are these decimal commas? then semicolons, tabs or blanks have to "
                            "separate the numbers"
                          : "");
    return true;
}

// Names out of the comment [its line, from 1] above the first row, or empty ones, before the rest.
static bool put_names_before(Reading *reading, char *comment, int32_t line, Error *err)
{
    CsvTable *table = reading->table;
    int32_t columns = table->columns;
    for (int32_t k = 0; k < columns; k++)
        if (!add_cell(reading, "", 1, err)) return false;
    if (!memory_grow(&table->line, reading->lines, &reading->line_room, sizeof *table->line, err))
        return false;
    memmove(table->cells + columns, table->cells,
            (size_t)(reading->count - columns) * sizeof *table->cells);
    memmove(table->byte + columns, table->byte,
            (size_t)(reading->count - columns) * sizeof *table->byte);
    memmove(table->line + 1, table->line, (size_t)reading->lines++ * sizeof *table->line);
    table->line[0] = comment ? line : table->line[1];
    table->named = false;
    for (int32_t k = 0; k < columns; k++) {
        table->cells[k] = "";
        table->byte[k] = 1;
    }
    if (!comment) return true;
    char *at = comment + strspn(comment, " \t#%");
    bool numbers = true, ends = false;
    char separator = 0;
    for (const char *one = ALL_SEPARATORS; *one && !separator; one++)
        if (count_cells(at, *one, &numbers) == columns) separator = *one;
    if (!separator) return true;
    if (count_cells(at, separator, &numbers) != columns || numbers) return true;
    for (int32_t k = 0; k < columns; k++) {
        table->byte[k] = (int32_t)(at - comment) + 1;
        table->cells[k] = take_cell(separator, &at, &ends);
    }
    table->named = table->named_by_comment = true;
    return true;
}

static bool is_unit(const char *text, int32_t length)
{
    char copy[CSV_UNIT_SIZE];
    double one = 1;
    if (length <= 0 || length >= CSV_UNIT_SIZE) return false;
    snprintf(copy, sizeof copy, "%.*s", length, text);
    return unit_to_si(copy, NULL, &one);
}

// The unit that brackets hold which are all of the text; length 0: there are none.
static CsvUnit in_brackets(const char *bracket)
{
    int32_t length = (int32_t)strlen(bracket), depth = 0;
    if ((*bracket != '(' && *bracket != '[') || !strchr(")]", bracket[length - 1]))
        return (CsvUnit){bracket, 0};
    for (int32_t k = 0; k < length - 1; k++) {   // "(t) (MPa)" is no unit
        depth += strchr("([", bracket[k]) ? 1 : strchr(")]", bracket[k]) ? -1 : 0;
        if (depth == 0) return (CsvUnit){bracket, 0};
    }
    CsvUnit unit = {bracket + 1, length - 2};
    while (unit.length > 0 && strchr(BLANKS, *unit.text)) unit.text++, unit.length--;
    while (unit.length > 0 && strchr(BLANKS, unit.text[unit.length - 1])) unit.length--;
    return unit;
}

// Numbers without a dimension have "-", "1" or "%" in the place of a unit.
static bool is_dimensionless(const char *text, int32_t length)
{
    return length == 1 && strchr("-1%", *text);
}

// A row of units below the names is none of values. Its cells are units, or empty or dashes where
// there is none; a row of ones or dashes alone is one of values.
static bool take_units(CsvTable *table, Error *err)
{
    int32_t columns = table->columns, units = 0;
    if (table->rows < 1 || !table->named || table->named_by_comment) return true;
    for (int32_t k = 0; k < columns; k++) {
        const char *cell = csv_cell(table, 0, k);
        CsvUnit unit = in_brackets(cell);
        if (unit.length == 0) unit = (CsvUnit){cell, (int32_t)strlen(cell)};
        if (*cell && !is_unit(unit.text, unit.length)) return true;
        units += *cell && !is_dimensionless(unit.text, unit.length);
    }
    if (units == 0) return true;
    if (!(table->units = memory_array(columns, sizeof *table->units, err))) return false;
    memcpy(table->units, table->cells + columns, (size_t)columns * sizeof *table->units);
    size_t rest = (size_t)(table->rows - 1) * (size_t)columns;
    memmove(table->cells + columns, table->cells + 2 * columns, rest * sizeof *table->cells);
    memmove(table->byte + columns, table->byte + 2 * columns, rest * sizeof *table->byte);
    memmove(table->line + 1, table->line + 2, (size_t)(table->rows - 1) * sizeof *table->line);
    table->rows--;
    return true;
}

// A name and where it stands.
typedef struct NamePlace {
    const char *name;
    int32_t column;
} NamePlace;

static int order_names(const void *left, const void *right)
{
    const NamePlace *a = left, *b = right;
    int order = strcmp(a->name, b->name);
    return order ? order : (a->column > b->column) - (a->column < b->column);
}

// A name stands once, whatever a stranger's file has of them: equal ones are neighbours in a sorted
// list. The error is about the first that stands again.
static bool check_names(const CsvTable *table, Error *err)
{
    int32_t count = 0, first = -1, again = -1;
    NamePlace *list = NEW_ARRAY(NamePlace, table->columns, err);
    if (!list) return false;
    for (int32_t k = 0; k < table->columns; k++)
        if (*table->cells[k]) list[count++] = (NamePlace){table->cells[k], k};
    if (count > 0) qsort(list, (size_t)count, sizeof *list, order_names);
    for (int32_t i = 1; i < count; i++) {
        if (strcmp(list[i - 1].name, list[i].name) != 0) continue;
        if (again >= 0 && again < list[i].column) continue;
        first = list[i - 1].column;
        again = list[i].column;
    }
    memory_free(list);
    return again < 0 ||
           csv_refuse(table, -1, again, err, "stands twice, in column %d and in column %d",
                      first + 1, again + 1);
}

static bool read_table(const char *path, bool may_be_bare, CsvTable *table, Error *err)
{
    int32_t size = 0, comment_line = 0, first[2] = {-1, -1};
    char *comment = NULL;   // the last one before the first row
    bool is_bare = true;
    double value;
    Reading reading = {.table = table, .line = 1};
    *table = (CsvTable){.named = true};
    TRY(table->path = memory_text(path, err));
    TRY(text_file_read(path, SIZE_MAX_CSV, &table->text, &size, err));
    if (memchr(table->text, 0, (size_t)size))
        FAIL(err, ERROR_INPUT, "%s is no text in UTF-8: it holds zero bytes", path);

    // The rows, and the comment above them.
    table->separator = find_separator(table->text);
    reading.at = reading.line_start = table->text;
    while (*reading.at) {
        char *line = reading.at;
        if (is_left_out(line)) {
            if (reading.lines == 0 && strchr(COMMENTS, line[strspn(line, BLANKS)])) {
                comment = line;
                comment_line = reading.line;
            }
            reading.at = (char *)next_line(line);
            reading.line_start = reading.at;
            reading.line++;
            continue;
        }
        TRY(read_row(&reading, err));
    }
    if (reading.count == 0) FAIL(err, ERROR_INPUT, "%s: no table, or one that is cut off", path);

    // A first row of numbers alone is none of names.
    for (int32_t k = 0; k < table->columns; k++)
        is_bare = is_bare && is_number(table->cells[k], strlen(table->cells[k]), &value);
    if (is_bare) TRY(put_names_before(&reading, comment, comment_line, err));
    if (!table->named && !may_be_bare)
        FAIL(err, ERROR_INPUT, "%s:%d: found numbers; the first row names the columns", path,
             table->line[1]);
    table->rows = reading.count / table->columns - 1;
    TRY(take_units(table, err));
    TRY(check_names(table, err));

    // The decimal sign. first: the first cells with a point and with a comma.
    for (int32_t k = table->columns; k < (table->rows + 1) * table->columns; k++) {
        const char *cell = table->cells[k];
        bool comma = strchr(cell, ',') != NULL;
        if ((!comma && !strchr(cell, '.')) || !is_number(cell, strlen(cell), &value)) continue;
        if (first[comma] < 0) first[comma] = k;
        int32_t other = first[!comma];
        if (other >= 0)
            TRY(csv_refuse(table, k / table->columns - 1, k % table->columns, err,
                           "is `%.30s`, but line %d has `%.30s`: the decimal sign is a point or a "
                           "comma, in all of the file",
                           cell, table->line[other / table->columns], table->cells[other]));
    }
    table->decimal_comma = first[1] >= 0;
cleanup:
    if (!error_is_clean(err)) csv_destroy(table);
    return error_is_clean(err);
}

bool csv_read(const char *path, CsvTable *table, Error *err)
{
    return read_table(path, false, table, err);
}

bool csv_read_bare(const char *path, CsvTable *table, Error *err)
{
    return read_table(path, true, table, err);
}

void csv_destroy(CsvTable *table)
{
    memory_free_all(table->cells, table->line, table->byte, table->text, table->path, table->units);
    *table = (CsvTable){0};
}

// --- reading ------------------------------------------------------------------------------------

const char *csv_name(const CsvTable *table, int32_t column)
{
    return table->cells[column];
}

const char *csv_cell(const CsvTable *table, int32_t row, int32_t column)
{
    return column < 0 ? "" : table->cells[(int64_t)(row + 1) * table->columns + column];
}

double csv_value(const CsvTable *table, int32_t row, int32_t column)
{
    const char *cell = csv_cell(table, row, column);
    double value = NAN;
    if (!table->decimal_comma && strchr(cell, ',')) return NAN;
    return is_number(cell, strlen(cell), &value) ? value : (double)NAN;
}

bool csv_refuse(const CsvTable *table, int32_t row, int32_t column, Error *err, const char *format,
                ...)
{
    char reason[REASON_SIZE];
    va_list words;
    va_start(words, format);
    vsnprintf(reason, sizeof reason, format, words);
    va_end(words);
    const char *name = csv_name(table, column);
    return REFUSE(err, "%s:%d:%d: %.60s%s%s", table->path, table->line[row + 1],
                  table->byte[(int64_t)(row + 1) * table->columns + column],
                  *name ? name : "this column", row < 0 ? " " : ": ", reason);
}

bool csv_read_number(const CsvTable *table, int32_t row, int32_t column, double *value, Error *err)
{
    *value = csv_value(table, row, column);
    return isfinite(*value) || csv_refuse(table, row, column, err, "`%.40s` is no number",
                                          csv_cell(table, row, column));
}

bool csv_check(const CsvTable *table, int32_t column, bool positive, Error *err)
{
    for (int32_t row = 0; column >= 0 && row < table->rows; ++row) {
        const char *cell = csv_cell(table, row, column);
        double value = csv_value(table, row, column);
        if (!*cell || (isfinite(value) && (!positive || value > 0))) continue;
        return csv_refuse(table, row, column, err,
                          "`%.40s` is no number%s; what is not known is left empty", cell,
                          positive ? " above 0" : "");
    }
    return true;
}

int32_t csv_column(const CsvTable *table, const char *name)
{
    for (int32_t k = 0; k < table->columns; ++k)
        if (strcmp(table->cells[k], name) == 0) return k;
    return -1;
}

// --- units --------------------------------------------------------------------------------------

// Length 0: there is none.
static CsvUnit unit_of_row(const CsvTable *table, int32_t column)
{
    const char *cell = table->units ? table->units[column] : "";
    CsvUnit unit = in_brackets(cell);
    return unit.length > 0 ? unit : (CsvUnit){cell, (int32_t)strlen(cell)};
}

// Takes the text behind a name as a unit. Text in brackets always is one, so that a wrong unit is
// reported. Text behind a slash, a blank, an underscore or `in` is one if it is known: F_T/F_N,
// x_error and U/L are names.
static bool take_unit(const char *rest, CsvUnit *unit)
{
    const char *at = rest + strspn(rest, BLANKS);
    *unit = in_brackets(at);
    if (unit->length > 0) return true;
    if (at > rest && strncmp(at, "in", 2) == 0 && strchr(BLANKS, at[2])) at += 2;
    if (at == rest && !strchr("/_", *at)) return false;
    bool over = *at == '/';
    at += over || *at == '_';
    at += strspn(at, BLANKS);
    *unit = in_brackets(at);   // v/(m/s)
    if (unit->length == 0) *unit = (CsvUnit){at, (int32_t)strlen(at)};
    if (!over && is_dimensionless(unit->text, unit->length)) return false;   // x_1, run 1
    return is_unit(unit->text, unit->length);
}

void csv_split(const CsvTable *table, int32_t column, int32_t *name_length, CsvUnit *unit)
{
    const char *name = csv_name(table, column), *end = name + strlen(name);
    // A unit is short, a name may be anybody's: what is behind each of its blanks is not looked at.
    bool is_long = end - name > UNIT_BEHIND_MAX;
    for (const char *at = is_long ? end - UNIT_BEHIND_MAX : name + 1; at < end; at++) {
        if (!strchr("/ \t([", *at) || !take_unit(at, unit)) continue;
        *name_length = (int32_t)(at - name);
        return;
    }
    *name_length = (int32_t)(end - name);
    *unit = unit_of_row(table, column);
}

// Primes of E' and E'' as people write them, and as the keyboard has them.
static const struct {
    const char *written, *plain;
} PRIMES[] = {{"\xE2\x80\xB2", "'"},
              {"\xE2\x80\x99", "'"},   // U+2032, U+2019
              {"\xE2\x80\xB3", "''"},
              {"\xE2\x80\x9D", "''"},   // U+2033, U+201D
              {"\"", "''"}};
enum { WORD_LENGTH = 4 };   // from which on a name is a word, in capitals or not

// Column `column` is called `name`, which may have a unit behind it. Symbols are as they are
// (V, v), words in capitals or not, with blanks or underscores between them.
static bool is_called(const CsvTable *table, int32_t column, const char *name, CsvUnit *unit)
{
    const char *own = csv_name(table, column);
    bool word = strlen(name) >= WORD_LENGTH;
    *unit = unit_of_row(table, column);
    while (*name) {
        bool between = strchr(" _", *name) && *own && strchr(" _", *own);
        bool letter = word && tolower((unsigned char)*own) == tolower((unsigned char)*name);
        size_t k = 0, primes = sizeof PRIMES / sizeof *PRIMES;
        if (*own == *name || between || letter) {
            own++, name++;
            continue;
        }
        while (k < primes && (strncmp(own, PRIMES[k].written, strlen(PRIMES[k].written)) != 0 ||
                              strncmp(name, PRIMES[k].plain, strlen(PRIMES[k].plain)) != 0))
            k++;
        if (k == primes) return false;
        own += strlen(PRIMES[k].written);
        name += strlen(PRIMES[k].plain);
    }
    return !*own || take_unit(own, unit);
}

static bool find_named(const CsvTable *table, const char *name, int32_t *column, CsvUnit *unit,
                       Error *err)
{
    for (int32_t k = 0; k < table->columns; k++) {
        CsvUnit found;
        if (!is_called(table, k, name, &found)) continue;
        if (*column >= 0)
            return csv_refuse(table, -1, k, err, "is %s a second time, beside column %d, %.40s",
                              name, *column + 1, csv_name(table, *column));
        *column = k;
        *unit = found;
    }
    return true;
}

// Quantities by symbol, and what people call them. Such a word counts where the symbol is not in
// the table.
static const char *const QUANTITIES[][7] = {
    {"t", "time", NULL},
    {"U", "displacement", NULL},
    {"mu", "\xCE\xBC", "\xC2\xB5", "COF", "friction coefficient", "coefficient of friction", NULL},
    {"F_T", "F_t", "Ft", "friction force", "tangential force", "shear force", NULL},
    {"F_N", "F_n", "Fn", "normal force", "normal load", NULL},
    {"hold", "hold time", "holding time", "time held", "waiting time", NULL}};

bool csv_find(const CsvTable *table, const char *name, int32_t *column, CsvUnit *unit, Error *err)
{
    size_t q = 0, quantities = sizeof QUANTITIES / sizeof *QUANTITIES;
    *column = -1;
    *unit = (CsvUnit){"", 0};
    if (!find_named(table, name, column, unit, err)) return false;
    while (q < quantities && strcmp(QUANTITIES[q][0], name) != 0) q++;
    if (*column >= 0 || q == quantities) return true;
    for (const char *const *word = QUANTITIES[q] + 1; *word; word++)
        if (!find_named(table, *word, column, unit, err)) return false;
    return true;
}

bool csv_find_any(const CsvTable *table, const char *const *names, int32_t *column, CsvUnit *unit,
                  Error *err)
{
    *column = -1;
    *unit = (CsvUnit){"", 0};
    for (; *names; names++) {
        CsvUnit found;
        int32_t k = -1;
        if (!csv_find(table, *names, &k, &found, err)) return false;
        if (k < 0 || k == *column) continue;
        if (*column >= 0)
            return csv_refuse(table, -1, k, err, "is the same as column %d, %.40s", *column + 1,
                              csv_name(table, *column));
        *column = k;
        *unit = found;
    }
    return true;
}

// Endings of the name of a column of errors, and names of one that says not of what.
static const char *const ERROR_ENDINGS[] = {"_error", " error", "_err", " err",
                                            "_std",   " std",   "_sd",  " sd"};
static const char *const ERROR_NAMES[] = {"error", "err", "std", "sd", "+-", "+/-", "\xC2\xB1"};
static const char SIGMA[] = "sigma_";   // before the name

static bool is_named_error(const CsvTable *table, int32_t column, const char *of, CsvUnit *unit)
{
    char name[2 * CSV_UNIT_SIZE];
    snprintf(name, sizeof name, "%s%s", SIGMA, of);
    if (is_called(table, column, name, unit)) return true;
    for (size_t k = 0; k < sizeof ERROR_ENDINGS / sizeof *ERROR_ENDINGS; k++) {
        snprintf(name, sizeof name, "%s%s", of, ERROR_ENDINGS[k]);
        if (is_called(table, column, name, unit)) return true;
    }
    return false;
}

void csv_find_error(const CsvTable *table, int32_t of, int32_t *column, CsvUnit *unit)
{
    char name[CSV_UNIT_SIZE + 1];
    CsvUnit found;
    int32_t length = 0;
    csv_split(table, of, &length, &found);
    snprintf(name, sizeof name, "%.*s", length, csv_name(table, of));
    char *mean = length < CSV_UNIT_SIZE ? strstr(name, "mean") : NULL;   // mu_mean, mu_std
    if (mean && mean > name + 1 && !mean[4]) mean[-1] = 0;
    for (*column = 0; *column < table->columns; ++*column)
        if (*column != of && length < CSV_UNIT_SIZE && is_named_error(table, *column, name, unit))
            return;

    *column = of + 1;
    for (size_t k = 0; *column < table->columns && k < sizeof ERROR_NAMES / sizeof *ERROR_NAMES;
         k++)
        if (is_called(table, *column, ERROR_NAMES[k], unit)) return;
    *column = -1;
    *unit = (CsvUnit){"", 0};
}

bool csv_to_si(const CsvTable *table, int32_t column, CsvUnit unit, const char *dimension,
               double *factor, Error *err)
{
    char text[CSV_UNIT_SIZE];
    *factor = 1;
    snprintf(text, sizeof text, "%.*s", unit.length, unit.text);
    if (unit.length < CSV_UNIT_SIZE && unit_to_si(text, dimension, factor)) return true;
    return csv_refuse(table, -1, column, err, "has `%s`, which is no unit%s%s%s%s", text,
                      dimension ? " of " : "", dimension ? dimension : "",
                      dimension ? "; allowed: " : "", dimension ? unit_examples(dimension) : "");
}

bool csv_to_scene(const CsvTable *table, int32_t column, CsvUnit unit, const char *dimension,
                  bool in_units, double *factor, Error *err)
{
    *factor = 1;
    if (unit.length == 0) return true;
    if (!in_units && strcmp(dimension, "1") != 0)
        return csv_refuse(table, -1, column, err,
                          "has a unit; a normalised scene has plain numbers (units need `units: "
                          "si`)");
    return csv_to_si(table, column, unit, dimension, factor, err);
}
