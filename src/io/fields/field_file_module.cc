// SPDX-License-Identifier: GPL-2.0-or-later
// The one C++ file: VTK's XML writers and a reader behind two C functions, which catch every
// exception. Double arrays are handed to VTK as they are, without a copy.
extern "C" {
#include "io/fields/field_file.h"
}

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtkZLibDataCompressor.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <string>
#include <vector>

namespace
{

constexpr int mesh_level = 1;   // zlib's; level 9 takes 60 times as long and saves a tenth
constexpr int stored_level = 0;
constexpr int block_bytes = 1 << 20;   // of 32 kB, as VTK has them, zlib is set up 25 times a file
constexpr int caller_keeps = 1;   // VTK must not free the array ("save")

// VTK's array over the caller's values, which it reads and never changes.
template <typename Array, typename Value>
vtkSmartPointer<Array> borrow(const Value *values, int64_t count, int components)
{
    using Stored = typename Array::ValueType;   // long long where int64_t is long
    static_assert(sizeof(Stored) == sizeof(Value), "the same bytes under another name");
    auto array = vtkSmartPointer<Array>::New();
    array->SetNumberOfComponents(components);
    array->SetArray(reinterpret_cast<Stored *>(const_cast<Value *>(values)), count, caller_keeps);
    return array;
}

// Points, fields and time: what both kinds of grid have.
void fill(vtkPointSet *set, const FieldGrid &grid)
{
    vtkNew<vtkPoints> points;
    points->SetData(borrow<vtkDoubleArray>(grid.points, 3 * grid.point_count, 3));
    set->SetPoints(points);
    for (int32_t k = 0; k < grid.point_array_count; k++) {
        const FieldArray &field = grid.point_arrays[k];
        auto array = borrow<vtkDoubleArray>(field.values, grid.point_count * field.components,
                                            field.components);
        array->SetName(field.name);
        set->GetPointData()->AddArray(array);
    }
    vtkNew<vtkDoubleArray> time;
    time->SetName("TimeValue");
    time->InsertNextValue(grid.time);
    set->GetFieldData()->AddArray(time);
}

// Offsets and connectivity as VTK 9 keeps them itself: 64-bit, borrowed.
vtkSmartPointer<vtkCellArray> make_cells(const FieldGrid &grid)
{
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    cells->SetData(borrow<vtkTypeInt64Array>(grid.offsets, grid.cell_count + 1, 1),
                   borrow<vtkTypeInt64Array>(grid.connectivity, grid.offsets[grid.cell_count], 1));
    return cells;
}

// Blocks of the last file of each format of this thread, in their order, before and after
// compression: a run writes both kinds in turn.
struct Block {
    std::vector<unsigned char> plain, packed;
};
thread_local std::vector<Block> last_blocks[2];

// zlib's format, as every reader of VTK's files knows it. What a run writes again and again, the
// mesh, is compressed once. Values at nodes are stored: level 1 takes 15 times as long as all else
// of a file, and saves a fifth of them. The bytes of a file depend on its grid alone.
class MeshCompressor : public vtkZLibDataCompressor
{
  public:
    static MeshCompressor *New();   // no vtkTypeMacro: files name the class that reads them

    void begin(const FieldGrid *of, FieldFormat format)
    {
        grid = of;
        last = &last_blocks[format == FIELD_VTP];
    }

  protected:
    size_t CompressBuffer(const unsigned char *plain, size_t size, unsigned char *packed,
                          size_t room) override
    {
        if (is_value(plain)) return pack(plain, size, packed, room, stored_level);
        if (next == last->size()) last->emplace_back();
        Block &block = (*last)[next++];
        if (!std::equal(plain, plain + size, block.plain.begin(), block.plain.end())) {
            size_t length = pack(plain, size, packed, room, mesh_level);
            block.plain.assign(plain, plain + size);
            block.packed.assign(packed, packed + length);
            return length;
        }
        std::copy(block.packed.begin(), block.packed.end(), packed);
        return block.packed.size();
    }

  private:
    const FieldGrid *grid = nullptr;
    std::vector<Block> *last = nullptr;
    size_t next = 0;

    size_t pack(const unsigned char *plain, size_t size, unsigned char *packed, size_t room,
                int level)
    {
        CompressionLevel = level;
        return vtkZLibDataCompressor::CompressBuffer(plain, size, packed, room);
    }

    bool is_value(const unsigned char *plain) const
    {
        const auto *at = reinterpret_cast<const double *>(plain);
        for (int32_t k = 0; k < grid->point_array_count; k++) {
            const FieldArray &array = grid->point_arrays[k];
            if (at >= array.values && at < array.values + array.components * grid->point_count)
                return true;
        }
        return false;
    }
};

vtkStandardNewMacro(MeshCompressor);

// Called by VTK with an error's text; the first one is the cause.
void keep_first(vtkObject *, unsigned long, void *message, void *text)
{
    auto *kept = static_cast<std::string *>(message);
    if (kept->empty() && text) *kept = static_cast<const char *>(text);
}

// Runs a writer into memory and hands the bytes on.
bool write(vtkXMLWriter *writer, const FieldGrid &grid, FieldFormat format, FieldSink sink,
           void *context, Error *err)
{
    std::string message;
    vtkNew<vtkCallbackCommand> observer;   // with one, VTK does not print its errors
    observer->SetCallback(keep_first);
    observer->SetClientData(&message);
    vtkNew<MeshCompressor> compressor;
    compressor->begin(&grid, format);
    compressor->AddObserver("ErrorEvent", observer);
    writer->AddObserver("ErrorEvent", observer);
    writer->SetCompressor(compressor);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetHeaderTypeToUInt64();
    writer->SetBlockSize(block_bytes);
    writer->WriteToOutputStringOn();
    if (writer->Write() != 1 || !message.empty()) {
        error_set(err, ERROR_LIBRARY, __FILE__, __LINE__, "VTK cannot write the grid: %s",
                  message.empty() ? "it gives no reason" : message.c_str());
        return false;
    }
    const std::string bytes = writer->GetOutputString();
    return sink(context, bytes.data(), static_cast<int64_t>(bytes.size()), err);
}

bool encode(const FieldGrid &grid, FieldFormat format, FieldSink sink, void *context, Error *err)
{
    if (format == FIELD_VTP) {
        vtkNew<vtkPolyData> contact;
        fill(contact, grid);
        const bool lines = !grid.cell_types || grid.cell_types[0] == VTK_LINE;
        if (lines)
            contact->SetLines(make_cells(grid));
        else
            contact->SetPolys(make_cells(grid));
        vtkNew<vtkXMLPolyDataWriter> writer;
        writer->SetInputDataObject(contact);
        return write(writer, grid, format, sink, context, err);
    }
    vtkNew<vtkUnstructuredGrid> cells;
    fill(cells, grid);
    cells->SetCells(borrow<vtkUnsignedCharArray>(grid.cell_types, grid.cell_count, 1),
                    make_cells(grid));
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputDataObject(cells);
    return write(writer, grid, format, sink, context, err);
}

// As doubles, whatever the file has: indices are exact in them.
bool hand_on(vtkDataArray *array, const char *name, FieldTake take, void *context, Error *err)
{
    vtkNew<vtkDoubleArray> numbers;
    numbers->DeepCopy(array);
    const FieldPart part = {name, numbers->GetNumberOfComponents(), numbers->GetNumberOfTuples(),
                            numbers->GetPointer(0)};
    return take(context, &part, err);
}

// Asked cell by cell, which all versions of VTK answer, however they keep the types.
bool hand_on_types(vtkUnstructuredGrid *grid, FieldTake take, void *context, Error *err)
{
    vtkNew<vtkDoubleArray> types;
    types->SetNumberOfValues(grid->GetNumberOfCells());
    for (vtkIdType k = 0; k < grid->GetNumberOfCells(); k++)
        types->SetValue(k, grid->GetCellType(k));
    return hand_on(types, "types", take, context, err);
}

// "ERROR: In FILE, line 407\nvtkXMLReader (0x55...): Cannot read it.\n\n": what stands behind the
// address, up to the end of its line.
std::string sentence_of(const std::string &message)
{
    const auto from = message.find("): ");
    const std::string text = from == std::string::npos ? message : message.substr(from + 3);
    return text.substr(0, text.find('\n'));
}

// Switches off what VTK itself would write to standard error: objects that it makes on the way have
// no observer. The verbosity belongs to the process and is hence restored.
class Silence
{
  public:
    Silence() : before(vtkLogger::GetCurrentVerbosityCutoff())
    {
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    }
    ~Silence()
    {
        vtkLogger::SetStderrVerbosity(before);
    }

  private:
    const vtkLogger::Verbosity before;
};

bool decode(const char *path, FieldTake take, void *context, Error *err)
{
    const Silence silence;
    std::string message;
    vtkNew<vtkCallbackCommand> observer;
    observer->SetCallback(keep_first);
    observer->SetClientData(&message);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->AddObserver("ErrorEvent", observer);
    reader->SetReaderErrorObserver(observer);
    reader->SetParserErrorObserver(observer);
    reader->SetFileName(path);
    reader->Update();
    vtkUnstructuredGrid *grid = reader->GetOutput();
    if (!message.empty() || !grid || grid->GetNumberOfCells() < 1 || !grid->GetPoints()) {
        error_set(err, ERROR_FILE, __FILE__, __LINE__,
                  "the file is damaged, VTK cannot read it: %s",
                  message.empty() ? "it has no cells" : sentence_of(message).c_str());
        return false;
    }
    bool done =
        hand_on(grid->GetPoints()->GetData(), "points", take, context, err) &&
        hand_on(grid->GetCells()->GetOffsetsArray(), "offsets", take, context, err) &&
        hand_on(grid->GetCells()->GetConnectivityArray(), "connectivity", take, context, err) &&
        hand_on_types(grid, take, context, err);
    vtkPointData *fields = grid->GetPointData();
    for (int k = 0; done && k < fields->GetNumberOfArrays(); k++)
        if (vtkDataArray *array = fields->GetArray(k))
            done = hand_on(array, array->GetName() ? array->GetName() : "", take, context, err);
    return done;
}

std::mutex encoding;   // VTK's factories and tools are shared by the whole process

}   // namespace

// Runs `work` alone; what it throws becomes an error.
template <typename Work>
static bool guarded(const Work &work, Error *err)
{
    const std::lock_guard<std::mutex> alone(encoding);
    try {
        vtkSMPTools::SetBackend("Sequential");   // its threads would wait by spinning
        return work();
    } catch (const std::exception &thrown) {
        error_set(err, ERROR_LIBRARY, __FILE__, __LINE__, "VTK failed: %s", thrown.what());
    } catch (...) {
        error_set(err, ERROR_LIBRARY, __FILE__, __LINE__, "VTK failed for an unknown reason");
    }
    return false;
}

extern "C" __attribute__((visibility("default"))) bool
amontons_vtk_encode(const FieldGrid *grid, FieldFormat format, FieldSink sink, void *context,
                    Error *err)
{
    return guarded([&] { return encode(*grid, format, sink, context, err); }, err);
}

extern "C" __attribute__((visibility("default"))) bool
amontons_vtk_decode(const char *path, FieldTake take, void *context, Error *err)
{
    return guarded([&] { return decode(path, take, context, err); }, err);
}
