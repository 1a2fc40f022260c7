// SPDX-License-Identifier: GPL-2.0-or-later
// What a flush would overwrite in a file is gathered in memory, and goes to `path`.journal first.
// When all of it is there, on the disk and sealed by a checksum, it is copied into the file. Who
// is killed before leaves the file as the last flush left it, who is killed after leaves a journal
// from which the rest is copied: never half a flush. One journal holds one flush. Called by
// io/hdf5/array_disk.
#ifndef AMONTONS_IO_HDF5_ARRAY_JOURNAL_H
#define AMONTONS_IO_HDF5_ARRAY_JOURNAL_H

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stddef.h>

typedef struct ArrayJournal {
    char path[PATH_MAX + 16];
    int64_t size;   // bytes of head and pieces that are not in the file yet; 0: none
    int64_t room;
    char *bytes;   // [room]; owned
    bool made;   // the file, by this writer
} ArrayJournal;

// Of the file `path`; what another writer left there is removed. The functions below return 0 or
// the errno of what failed.
int array_journal_create(ArrayJournal *journal, const char *path);
int array_journal_add(ArrayJournal *journal, int64_t address, const void *bytes, size_t size);
int array_journal_seal(ArrayJournal *journal);   // onto the disk
int array_journal_apply(ArrayJournal *journal, int descriptor);   // into the file

// The journal that a writer left, or one that still writes has now, where it is whole.
int array_journal_find(ArrayJournal *journal, const char *path);
// bytes[size] as read from the file at `address`, with what the journal holds of them put over it.
void array_journal_overlay(const ArrayJournal *journal, int64_t address, char *bytes, size_t size);

void array_journal_close(ArrayJournal *journal);   // the file stays; zeroed is fine
void array_journal_remove(ArrayJournal *journal);   // and goes

#endif
