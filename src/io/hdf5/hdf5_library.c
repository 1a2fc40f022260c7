// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/hdf5/hdf5_library.h"

#include "base/clock.h"
#include "base/memory.h"
#include "io/files/open_file.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { GROWTH = 1 << 20 };   // bytes by which a file in memory grows

// The stack is walked from where the fault was found; outer entries only say that something failed.
static herr_t keep_innermost(unsigned position, const H5E_error2_t *entry, void *cause)
{
    if (position == 0) snprintf(cause, HDF5_CAUSE_SIZE, "%s", entry->desc);
    return 0;
}

const char *hdf5_cause(char cause[HDF5_CAUSE_SIZE])
{
    snprintf(cause, HDF5_CAUSE_SIZE, "it gives no reason");
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, cause);
    return cause;
}

bool hdf5_wrote(herr_t status, const char *path, const char *what, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    if (status >= 0) return true;
    return FAULT(err, ERROR_LIBRARY, "HDF5 cannot write %s into %s: %s", what, path,
                 hdf5_cause(cause));
}

// HDF5 prints its error stack otherwise. A file that could not be written is left open (see the
// header) and would be written once more at the program's end, which crashes.
static void start(void)
{
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

// --- attributes --------------------------------------------------------------------------------

// stored, given: types in the file and of `value`.
static herr_t write_one(hid_t object, const char *name, hid_t stored, hid_t given,
                        const void *value)
{
    if (H5Aexists(object, name) > 0) H5Adelete(object, name);
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
    herr_t status = attribute < 0 ? -1 : H5Awrite(attribute, given, value);
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return status;
}

herr_t attribute_write_number(hid_t object, const char *name, double value)
{
    return write_one(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

herr_t attribute_write_text(hid_t object, const char *name, const char *value)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    herr_t status = write_one(object, name, type, type, &value);
    H5Tclose(type);
    return status;
}

// An attribute of one value; negative: there is none, or it has several, for which a reader of one
// has no room. The file may be anybody's.
static hid_t open_one(hid_t object, const char *name)
{
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0) return -1;
    hid_t space = H5Aget_space(attribute);
    bool is_one = H5Sget_simple_extent_npoints(space) == 1;
    H5Sclose(space);
    if (is_one) return attribute;
    H5Aclose(attribute);
    return -1;
}

herr_t attribute_read_number(hid_t object, const char *name, double *value)
{
    hid_t attribute = open_one(object, name);
    if (attribute < 0) return -1;
    herr_t status = H5Aread(attribute, H5T_NATIVE_DOUBLE, value);
    H5Aclose(attribute);
    return status;
}

// HDF5 allocates the text.
herr_t attribute_read_text(hid_t object, const char *name, char *value, int32_t size)
{
    char *stored = NULL;
    hid_t attribute = open_one(object, name);
    if (attribute < 0) return -1;
    hid_t type = H5Aget_type(attribute);
    herr_t status = H5Tis_variable_str(type) > 0 ? H5Aread(attribute, type, &stored) : -1;
    if (status >= 0 && stored)
        snprintf(value, (size_t)size, "%s", stored);
    else
        status = -1;
    if (stored) H5free_memory(stored);
    H5Tclose(type);
    H5Aclose(attribute);
    return status;
}

// --- what a file may hold -----------------------------------------------------------------------

#if H5_VERSION_GE(1, 12, 0)
typedef H5L_info2_t LinkInfo;
#define visit_links H5Lvisit2
#else
typedef H5L_info_t LinkInfo;
#define visit_links H5Lvisit
#endif

typedef struct Visitor {
    const char *path;
    Error *err;
} Visitor;

// HDF5 calls it for each link that leads to an object for the first time. Links by name are not
// followed.
static herr_t visit_link(hid_t file, const char *name, const LinkInfo *link, void *self)
{
    Visitor *visitor = self;
    char cause[HDF5_CAUSE_SIZE];
    Error *err = visitor->err;
    if (link->type != H5L_TYPE_HARD) {
        error_set(err, ERROR_FILE, __FILE__, __LINE__,
                  "%s: %s is a link by name, which is not followed: the file is none that amontons "
                  "wrote",
                  visitor->path, name);
        return -1;
    }
    hid_t object = H5Oopen(file, name, H5P_DEFAULT);
    H5I_type_t type = H5Iget_type(object);
    if (type == H5I_DATASET) {
        // Its data lie in the file itself: no external files, and no parts of other datasets.
        hid_t creation = H5Dget_create_plist(object);
        H5D_layout_t layout = H5Pget_layout(creation);
        bool here = layout == H5D_COMPACT || layout == H5D_CONTIGUOUS || layout == H5D_CHUNKED;
        bool outside = H5Pget_external_count(creation) != 0;
        H5Pclose(creation);
        if (!here || outside)
            error_set(err, ERROR_FILE, __FILE__, __LINE__,
                      "%s: the data of %s lie in another file, which is not read: the file is none "
                      "that amontons wrote",
                      visitor->path, name);
    } else if (type != H5I_GROUP) {
        error_set(err, ERROR_FILE, __FILE__, __LINE__, "%s: %s is neither array nor group: %s",
                  visitor->path, name, hdf5_cause(cause));
    }
    if (object >= 0) H5Oclose(object);
    return error_is_clean(err) ? 0 : -1;
}

// Closes a file that is refused; its id.
static hid_t check_opened(hid_t file, const char *path, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    Visitor visitor = {path, err};
    herr_t status =
        file < 0 ? -1 : visit_links(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit_link, &visitor);
    if (status < 0 && error_is_clean(err))
        error_set(err, ERROR_FILE, __FILE__, __LINE__, "cannot read %s, not a whole HDF5 file: %s",
                  path, hdf5_cause(cause));
    if (status >= 0) return file;
    if (file >= 0) H5Fclose(file);
    return -1;
}

// Every call of HDF5 forgets why the one before it failed.
static void close_properties(hid_t access)
{
    hid_t cause = H5Eget_current_stack();
    H5Pclose(access);
    H5Eset_current_stack(cause);
}

// --- files in memory ----------------------------------------------------------------------------

// HDF5 tells files in memory by their names, and looks whether there is one on the disk. This one
// nothing has: no other of this moment and of this thread's stack, and no file. HDF5 copies `bytes`
// twice: they are freed between the two, as they may be large.
static hid_t open_memory(void *bytes, int64_t size)
{
    char name[100];
    hid_t file = -1, access = H5Pcreate(H5P_FILE_ACCESS);
    snprintf(name, sizeof name, "/dev/null/amontons %.17g %p", clock_seconds(), (void *)name);
    bool ready = H5Pset_fapl_core(access, GROWTH, false) >= 0 &&
                 H5Pset_fclose_degree(access, H5F_CLOSE_STRONG) >= 0;
    if (ready && !bytes) file = H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    if (ready && bytes) ready = H5Pset_file_image(access, bytes, (size_t)size) >= 0;
    memory_free(bytes);
    if (ready && bytes) file = H5Fopen(name, H5F_ACC_RDWR, access);
    close_properties(access);
    return file;
}

hid_t hdf5_memory_create(const char *path, Error *err)
{
    start();
    hid_t file = open_memory(NULL, 0);
    hdf5_wrote(file < 0 ? -1 : 0, path, "the header", err);
    return file;
}

hid_t hdf5_memory_open(const char *path, void *bytes, int64_t size, Error *err)
{
    start();
    return check_opened(size > 0 ? open_memory(bytes, size) : -1, path, err);
}

// The driver "core" gives where it has them, so that a large file needs no copy.
const void *hdf5_memory_bytes(hid_t file, const char *path, int64_t *size, Error *err)
{
    void *handle = NULL;
    herr_t status = H5Fflush(file, H5F_SCOPE_LOCAL);
    if (status >= 0) status = H5Fget_vfd_handle(file, H5P_DEFAULT, &handle);
    *size = status < 0 ? -1 : H5Fget_file_image(file, NULL, 0);
    if (!hdf5_wrote(*size < 0 ? -1 : 0, path, "what was appended", err)) return NULL;
    return *(void **)handle;
}

// --- files on the disk --------------------------------------------------------------------------

// No locks, which some file systems have not; all that is open in a file ends with it.
hid_t hdf5_disk_open(const char *path, Error *err)
{
    struct stat status;
    if (!open_check(path, err)) return -1;
    if (stat(path, &status) == 0 && status.st_size == 0) {
        error_set(
            err, ERROR_FILE, __FILE__, __LINE__,
            "%s is empty: the run is about to begin, or ended before anything was on the disk",
            path);
        return -1;
    }
    start();
    // A file that the host program has open, as h5py in the same process, is opened with the
    // properties that it has there, or not at all.
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(access, false, true);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, access);
    if (file < 0) file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    close_properties(access);
    return check_opened(file, path, err);
}
