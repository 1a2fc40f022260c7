// SPDX-License-Identifier: GPL-2.0-or-later
// The driver (virtual file layer) under an HDF5 file. HDF5 1.10 does not survive a write or a close
// that fails: closing afterwards, or the program's end, can crash inside it. So it never sees one:
// this driver keeps the first cause and drops what cannot be written; whoever wrote asks it
// afterwards. A read that fails HDF5 is told where the file is only read. Called by
// io/hdf5/array_file_module and io/hdf5/array_series.
#ifndef AMONTONS_IO_HDF5_ARRAY_DISK_H
#define AMONTONS_IO_HDF5_ARRAY_DISK_H

#include "io/files/part_file.h"
#include "io/hdf5/array_journal.h"

#include <hdf5.h>
#include <stdint.h>

enum { HDF5_CAUSE_SIZE = 512 };

typedef struct ArrayDisk {
    H5FD_t base;   // HDF5's part; stands first, so that HDF5's pointer is ours
    const PartFile *file;   // the file; not owned
    bool reading;   // only
    int failure;   // errno of the first access that failed; 0: none
    haddr_t end_of_space;   // bytes handed out to HDF5
    haddr_t end_of_file;   // bytes the file has, or would have if nothing had failed
    haddr_t kept;   // bytes that a reader needs of the last whole flush
    ArrayJournal journal;   // what is to be written over those
} ArrayDisk;

// Begins with a file that is open. anew: it is empty; else what a killed writer left half done is
// done first. ERROR_FILE.
bool array_disk_open(ArrayDisk *disk, const PartFile *file, bool anew, Error *err);
// The same for a file that is only read: of an unfinished one what is half done is seen as done.
bool array_disk_look(ArrayDisk *disk, const PartFile *file, bool finished, Error *err);

// Makes `access` (a file access property list) use `disk`, which must stay where it is until the
// HDF5 file is closed; `driver` is released by the caller with H5FDunregister.
// false: HDF5 refused, and its error stack says why.
bool array_disk_use(ArrayDisk *disk, hid_t access, hid_t *driver);

// Ends a call that wrote `what`; `status` is HDF5's, negative for a failure. ERROR_FILE with the
// system's reason when the disk has failed, now or before.
bool array_disk_check(const ArrayDisk *disk, herr_t status, const char *what, Error *err);

// HDF5's flush has come to its end: what it writes over comes into the file, all or nothing.
bool array_disk_settle(ArrayDisk *disk, Error *err);
bool array_disk_sync(ArrayDisk *disk, Error *err);   // onto the disk
// HDF5 has closed the file: settled, on the disk, without a journal.
bool array_disk_end(ArrayDisk *disk, Error *err);
void array_disk_close(ArrayDisk *disk);   // a journal that is there stays; zeroed is fine

// HDF5's message for the fault of its last call, the one nearest to the origin.
const char *hdf5_cause(char cause[HDF5_CAUSE_SIZE]);

#endif
