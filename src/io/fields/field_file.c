// SPDX-License-Identifier: GPL-2.0-or-later
// VTK encodes, we write: on a full disk VTK's own writers only say that they failed, and leave a
// part of the file.
#include "io/fields/field_file.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/fields/field_file_module.h"
#include "io/files/part_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- .vtu and .vtp ------------------------------------------------------------------------------

// Two arrays of one name would be one array in ParaView.
static bool check_arrays(const FieldArray *arrays, int32_t count, Error *err)
{
    for (int32_t k = 0; k < count; k++) {
        if (!arrays[k].name || !arrays[k].values || arrays[k].components < 1)
            return FAULT(err, ERROR_LIBRARY, "array %d has no name, no values or no components", k);
        for (int32_t other = 0; other < k; other++)
            if (strcmp(arrays[k].name, arrays[other].name) == 0)
                return FAULT(err, ERROR_LIBRARY, "two arrays are called %s", arrays[k].name);
    }
    return true;
}

// VTK checks nothing, and would read past the end.
static bool check_grid(const FieldGrid *grid, FieldFormat format, Error *err)
{
    if (grid->offsets[0] != 0) return FAULT(err, ERROR_LIBRARY, "the first offset is not 0");
    for (int64_t e = 0; e < grid->cell_count; e++)
        if (grid->offsets[e + 1] < grid->offsets[e])
            return FAULT(err, ERROR_LIBRARY, "cell %lld has a negative number of nodes",
                         (long long)e);
    for (int64_t k = 0; k < grid->offsets[grid->cell_count]; k++)
        if (grid->connectivity[k] < 0 || grid->connectivity[k] >= grid->point_count)
            return FAULT(err, ERROR_LIBRARY, "the connectivity names node %lld of %lld",
                         (long long)grid->connectivity[k], (long long)grid->point_count);
    if (format == FIELD_VTU && !grid->cell_types)
        return FAULT(err, ERROR_LIBRARY, "the cells have no types");
    return check_arrays(grid->point_arrays, grid->point_array_count, err) &&
           check_arrays(grid->cell_arrays, grid->cell_array_count, err);
}

// The sink of the module: the bytes of the whole file, once.
static bool write_bytes(void *file, const char *bytes, int64_t size, Error *err)
{
    return part_file_write(file, bytes, size, err);
}

// The grid's arrays are VTK's only while encoding; it copies none of them.
static bool write_grid(const char *path, const FieldGrid *grid, FieldFormat format, Error *err)
{
    PartFile file = {0};
    FieldOutput output = {.format = format, .sink = write_bytes, .context = &file};
    TRY(check_grid(grid, format, err));   // before VTK is loaded, and before a file is made
    FieldEncodeFunction encode =
        (FieldEncodeFunction)module_function("vtk", "amontons_vtk_encode", err);
    if (!encode) goto cleanup;
    TRY(part_file_create(&file, path, err));
    TRY(encode(grid, &output, err));
    TRY(part_file_commit(&file, err));
cleanup:
    part_file_discard(&file);
    if (!error_is_clean(err)) error_context(err, "while writing fields into %s", path);
    return error_is_clean(err);
}

bool field_file_write_vtu(const char *path, const FieldGrid *grid, Error *err)
{
    return write_grid(path, grid, FIELD_VTU, err);
}

bool field_file_write_vtp(const char *path, const FieldGrid *grid, Error *err)
{
    return write_grid(path, grid, FIELD_VTP, err);
}

// --- .pvd ---------------------------------------------------------------------------------------

// The value of an XML attribute in double quotes.
static void put_escaped(FILE *out, const char *text)
{
    for (const char *c = text; *c; c++) {
        switch (*c) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            fputc(*c, out);
        }
    }
}

// Parts are numbered in the order in which their names come up; `first` holds an entry of each.
// first: [entries] room for as many parts.
static int32_t part_number(const FieldSeriesEntry *entries, int32_t entry, int32_t *first,
                           int32_t *part_count)
{
    int32_t number = 0;
    while (number < *part_count && strcmp(entries[first[number]].part, entries[entry].part) != 0)
        number++;
    if (number == *part_count) first[(*part_count)++] = entry;
    return number;
}

// ParaView's format: one DataSet a file and time; 17 digits give the time back exactly.
static void put_collection(FILE *out, const FieldSeriesEntry *entries, int32_t count,
                           int32_t *first)
{
    int32_t part_count = 0;
    fputs("<?xml version=\"1.0\"?>\n"
          "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
          "  <Collection>\n",
          out);
    for (int32_t k = 0; k < count; k++) {
        fprintf(out, "    <DataSet timestep=\"%.17g\" part=\"%d\" name=\"", entries[k].time,
                part_number(entries, k, first, &part_count));
        put_escaped(out, entries[k].part);
        fputs("\" file=\"", out);
        put_escaped(out, entries[k].file);
        fputs("\"/>\n", out);
    }
    fputs("  </Collection>\n</VTKFile>\n", out);
}

// Put together in memory first.
bool field_file_write_pvd(const char *path, const FieldSeriesEntry *entries, int32_t count,
                          Error *err)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = NULL;
    int32_t *first = NEW_ARRAY(int32_t, count, err);
    if (!first) goto cleanup;
    out = open_memstream(&text, &size);
    if (!out) FAIL(err, ERROR_MEMORY, "no memory for %s", path);
    put_collection(out, entries, count, first);
    bool is_whole = ferror(out) == 0;
    is_whole = fclose(out) == 0 && is_whole;
    if (!is_whole) FAIL(err, ERROR_MEMORY, "no memory for %s", path);
    TRY(part_file_put(path, text, (int64_t)size, err));
cleanup:
    free(text);
    memory_free(first);
    return error_is_clean(err);
}
