// SPDX-License-Identifier: GPL-2.0-or-later
// A history that is a whole HDF5 file but not one of ours: arrays of other types, shapes and
// lengths, or missing, from letters as in fuzz_mesh. (What damaged bytes do inside HDF5 is another
// question, to which a process of its own is the answer: base/child_process.)
#include "io/hdf5/result_file.h"
#include "render/view/result_view.h"
#include "tests/fuzz/fuzz.h"

#include <hdf5.h>

typedef struct Letters {
    const uint8_t *at, *end;
} Letters;

static int32_t take(Letters *letters, int32_t high)
{
    int32_t value = letters->at < letters->end ? *letters->at++ - '0' : 0;
    return value < 0 ? 0 : value > high ? high : value;
}

static hid_t take_type(Letters *letters)
{
    switch (take(letters, 7)) {
    case 0:
    case 1:
    case 2:
        return H5Tcopy(H5T_IEEE_F64LE);
    case 3:
        return H5Tcopy(H5T_IEEE_F32LE);
    case 4:
        return H5Tcopy(H5T_STD_U8LE);
    case 5:
        return H5Tcopy(H5T_STD_I32LE);
    case 6:
        return H5Tcreate(H5T_COMPOUND, 8);
    default:
        return H5Tcopy(H5T_C_S1);
    }
}

static hid_t take_space(Letters *letters)
{
    static const hsize_t lengths[] = {0, 1, 2, 3, 4, 7, 1, 2, 3, 4, 5, 1000000000000, ~0ULL >> 1};
    hsize_t shape[3];
    int rank = take(letters, 3);
    for (int k = 0; k < rank; k++) shape[k] = lengths[take(letters, 12)];
    return rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, shape, NULL);
}

// Early allocation would fill the disk: nothing is written where the array is large.
static void add_array(hid_t file, const char *name, Letters *letters)
{
    static const double values[64] = {0, 0.25, 0.5, 1, -1, 2, 3, 1e300};
    hid_t type = take_type(letters), space = take_space(letters);
    hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    hid_t made = H5Dcreate2(file, name, type, space, links, H5P_DEFAULT, H5P_DEFAULT);
    if (made >= 0 && H5Sget_simple_extent_npoints(space) <= 64 && H5Tget_class(type) == H5T_FLOAT)
        H5Dwrite(made, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    if (made >= 0) H5Dclose(made);
    H5Pclose(links);
    H5Sclose(space);
    H5Tclose(type);
}

static void add_text(hid_t file, const char *name, Letters *letters)
{
    static const char *const values[] = {"si", "normalised", "", "a\nb\nc"};
    int32_t kind = take(letters, 6);
    if (kind == 6) return;
    hid_t type = H5Tcopy(kind == 5 ? H5T_NATIVE_DOUBLE : H5T_C_S1);
    hid_t space = H5Screate(H5S_SCALAR);
    if (kind < 4) H5Tset_size(type, H5T_VARIABLE);
    hid_t made = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    if (made >= 0 && kind < 4) H5Awrite(made, type, &values[kind]);
    if (made >= 0) H5Aclose(made);
    H5Sclose(space);
    H5Tclose(type);
}

static char place[] = "/dev/shm/amontons_fuzz_XXXXXX", path[80];

static void remove_folder(void)
{
    unlink(path);
    rmdir(place);
}

static const char *write_history(Letters *letters)
{
    static const char *const arrays[] = {"series/rod_displacement",
                                         "series/mu",
                                         "nodes/x",
                                         "nodes/pad",
                                         "events/kind",
                                         "events/U_start",
                                         "events/U_stop",
                                         "events/reach",
                                         "events/peak_slip_rate",
                                         "peaks/U",
                                         "peaks/mu",
                                         "peaks/counts",
                                         "interface/slip_rate",
                                         "interface/status"};
    if (!*path && (!mkdtemp(place) || atexit(remove_folder) != 0)) abort();
    snprintf(path, sizeof path, "%s/history.h5", place);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, 1 << 12, true);   // written when it is closed
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    add_text(file, "title", letters);
    add_text(file, "units", letters);
    add_text(file, "pads", letters);
    add_text(file, "warnings", letters);
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        if (take(letters, 9) < 9) add_array(file, arrays[k], letters);
    H5Fclose(file);
    H5Pclose(access);
    return place;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int64_t before = memory_counters().live;
    Letters letters = {data, data + size};
    Error other = {0};
    ResultView view;
    const char *folder = write_history(&letters);
    if (result_view_open(folder, &view, &other)) {
        result_view_read_slip_rate(&view, &other);
        result_view_read_status(&view, &other);
        result_view_close(&view);
    }
    fuzz_check_freed(before);
    return 0;
}
