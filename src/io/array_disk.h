// SPDX-License-Identifier: GPL-2.0-or-later
// The file under an HDF5 file being written, as a driver of HDF5's virtual file layer. HDF5 1.10
// does not survive a write that fails: closing afterwards can crash inside the library. So HDF5
// never sees one. This driver keeps the first cause, drops what cannot be written, and
// array_file asks it after every call. Called by io/array_file alone.
#ifndef AMONTONS_IO_ARRAY_DISK_H
#define AMONTONS_IO_ARRAY_DISK_H

#include "base/error.h"

#include <hdf5.h>
#include <stdint.h>

typedef struct ArrayDisk {
    H5FD_t base;          // HDF5's part; stands first, so that HDF5's pointer is ours
    int descriptor;       // of the file, for reading and writing; not owned
    int failure;          // errno of the first access that failed; 0: none
    haddr_t end_of_space; // bytes HDF5 has handed out
    haddr_t end_of_file;  // bytes the file has, or would have if nothing had failed
} ArrayDisk;

// Makes `access` (a file access property list) use `disk`, which must stay where it is until the
// HDF5 file is closed; `driver` is released by the caller with H5FDunregister.
// false: HDF5 refused, and its error stack says why.
bool array_disk_use(ArrayDisk *disk, int descriptor, hid_t access, hid_t *driver);

#endif
