// SPDX-License-Identifier: GPL-2.0-or-later
// VTK encodes, we write: on a full disk VTK's own writers only say that they failed, and leave a
// part of the file.
#include "io/fields/field_file.h"

#include "base/module.h"
#include "base/text.h"
#include "io/text/text_writer.h"
#include "io/files/part_file.h"

#include <stdio.h>

// --- .vtu and .vtp ------------------------------------------------------------------------------

// The sink of the module: the bytes of the whole file, once.
static bool write_bytes(void *file, const char *bytes, int64_t size, Error *err)
{
    return part_file_write(file, bytes, size, err);
}

// The grid's arrays are VTK's only while encoding; it copies none of them.
bool field_file_write(const char *path, const FieldGrid *grid, Error *err)
{
    PartFile file = {0};
    FieldFormat format = text_ends_with(path, ".vtp") ? FIELD_VTP : FIELD_VTU;
    FieldEncodeFunction encode =
        (FieldEncodeFunction)module_function("vtk", "amontons_vtk_encode", err);
    if (!encode) goto cleanup;
    TRY(part_file_create(&file, path, err));
    TRY(encode(grid, format, write_bytes, &file, err));
    TRY(part_file_commit(&file, err));
cleanup:
    part_file_discard(&file);
    if (!error_is_clean(err)) error_context(err, "while writing fields into %s", path);
    return error_is_clean(err);
}

// --- .pvd ---------------------------------------------------------------------------------------

// ParaView's format: one DataSet a file and time; 17 digits give the time back exactly.
bool field_file_write_pvd(const char *path, const double *times, int32_t count, Error *err)
{
    TextWriter *writer = text_writer_create(path, false, err);
    if (!writer) return false;
    fputs("<?xml version=\"1.0\"?>\n"
          "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
          "  <Collection>\n",
          writer->out);
    for (int32_t k = 0; k < count; k++)
        fprintf(writer->out,
                "    <DataSet timestep=\"%.17g\" part=\"0\" name=\"bulk\" "
                "file=\"fields/" FIELD_BULK_NAME "\"/>\n"
                "    <DataSet timestep=\"%.17g\" part=\"1\" name=\"interface\" "
                "file=\"fields/" FIELD_LINE_NAME "\"/>\n",
                times[k], k, times[k], k);
    fputs("  </Collection>\n</VTKFile>\n", writer->out);
    return text_writer_finish(writer, err);
}
