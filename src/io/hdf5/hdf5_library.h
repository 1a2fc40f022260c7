// SPDX-License-Identifier: GPL-2.0-or-later
// HDF5 as it is used here. A file that is written is one in memory (HDF5's driver "core", with
// nothing behind it), whose bytes we put on the disk ourselves: HDF5 1.10 crashes at the program's
// end if a write of its own failed. A file that is read is read from the disk, and is refused where
// it leads to another file. Called by the other files of this module.
#ifndef AMONTONS_IO_HDF5_HDF5_LIBRARY_H
#define AMONTONS_IO_HDF5_HDF5_LIBRARY_H

#include "base/error.h"

#include <hdf5.h>
#include <stdint.h>

enum { HDF5_CAUSE_SIZE = 512 };

// HDF5's message for the fault of its last call, the one nearest to the origin.
const char *hdf5_cause(char cause[HDF5_CAUSE_SIZE]);

// Ends a call that wrote `what` into `path`: ERROR_LIBRARY with HDF5's reason if `status`, HDF5's,
// is negative.
bool hdf5_wrote(herr_t status, const char *path, const char *what, Error *err);

// A file in memory, empty, or that of `bytes` (memory_free), which are freed. `path` names it in
// messages. The id, to be closed by the caller; negative: ERROR_LIBRARY, ERROR_FILE where the bytes
// are none of HDF5's.
hid_t hdf5_memory_create(const char *path, Error *err);
hid_t hdf5_memory_open(const char *path, void *bytes, int64_t size, Error *err);
// The bytes of a file in memory, as they stand on the disk: [*size], HDF5's, valid until its next
// call for the file. NULL: an error.
const void *hdf5_memory_bytes(hid_t file, const char *path, int64_t *size, Error *err);

// `path` for reading, without a lock; negative: ERROR_FILE. The file of a running simulation can be
// read as of its last flush.
hid_t hdf5_disk_open(const char *path, Error *err);

// Attributes of an object: single numbers and texts. Negative: HDF5 failed, and its error stack
// says why. One cannot be changed in place: an old one of this name is removed first.
herr_t attribute_write_number(hid_t object, const char *name, double value);
herr_t attribute_write_text(hid_t object, const char *name, const char *value);   // h5py: str
// A scalar or an array of one, whatever its stored type.
herr_t attribute_read_number(hid_t object, const char *name, double *value);
// The same of a text, cut to `size`. One of fixed length is none of ours.
herr_t attribute_read_text(hid_t object, const char *name, char *value, int32_t size);
#endif
