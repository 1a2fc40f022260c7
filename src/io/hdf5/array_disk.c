// SPDX-License-Identifier: GPL-2.0-or-later
// Only those calls of a driver that HDF5 needs to create a file and write it. To HDF5 all of them
// succeed (0); `failure` holds what really happened.
//
// New bytes go into the file at once. What lies below `kept` is needed to read the file as of the
// last flush: what HDF5 writes there goes to the journal first (array_disk_settle).
#include "io/hdf5/array_disk.h"

#include "base/transfer.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// The property list carries the address of the disk; HDF5 copies it byte by byte.
typedef struct DiskAddress {
    ArrayDisk *disk;
} DiskAddress;

// The first cause is the one to report: later ones follow from it.
static void note_failure(ArrayDisk *disk, int cause)
{
    if (disk->failure == 0) disk->failure = cause ? cause : EIO;
}

// HDF5 opens a file that it creates twice, the first time only to see whether it is there.
static H5FD_t *disk_open(const char *name, unsigned flags, hid_t access, haddr_t address_max)
{
    (void)name, (void)flags, (void)address_max;
    const DiskAddress *address = H5Pget_driver_info(access);
    return address ? &address->disk->base : NULL;
}

static herr_t disk_close(H5FD_t *base)
{
    (void)base;   // the descriptor is not ours
    return 0;
}

// What HDF5 may do on top: collect small pieces of metadata and data into larger writes. The file
// itself is in the default format, readable without this driver.
static herr_t disk_query(const H5FD_t *base, unsigned long *flags)
{
    (void)base;
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
}

// Space is handed out once and never again, not even the last piece: so nothing that the last flush
// wrote is overwritten before the next one.
static haddr_t disk_allocate(H5FD_t *base, H5FD_mem_t type, hid_t transfer, hsize_t size)
{
    (void)type, (void)transfer;
    ArrayDisk *disk = (ArrayDisk *)base;
    haddr_t address = disk->end_of_space;
    disk->end_of_space += size;
    return address;
}

// Nothing is reused (disk_allocate), at the cost of a little length.
static herr_t disk_free(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address,
                        hsize_t size)
{
    (void)base, (void)type, (void)transfer, (void)address, (void)size;
    return 0;
}

static haddr_t disk_end_of_space(const H5FD_t *base, H5FD_mem_t type)
{
    (void)type;
    return ((const ArrayDisk *)base)->end_of_space;
}

// Asked by HDF5; else only disk_allocate moves the end.
static herr_t disk_set_end_of_space(H5FD_t *base, H5FD_mem_t type, haddr_t end)
{
    (void)type;
    ((ArrayDisk *)base)->end_of_space = end;
    return 0;
}

static haddr_t disk_end_of_file(const H5FD_t *base, H5FD_mem_t type)
{
    (void)type;
    return ((const ArrayDisk *)base)->end_of_file;
}

static bool sync_file(ArrayDisk *disk)
{
    int cause = transfer_sync(disk->file->descriptor);
    if (cause) note_failure(disk, cause);
    return disk->failure == 0;
}

// HDF5 may ask for what it has not written yet: zeros.
static herr_t disk_read(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address, size_t size,
                        void *buffer)
{
    (void)type, (void)transfer;
    ArrayDisk *disk = (ArrayDisk *)base;
    int64_t got = transfer_read(disk->file->descriptor, buffer, (int64_t)size, (int64_t)address);
    if (got < (int64_t)size && errno != 0) note_failure(disk, errno);
    memset((char *)buffer + got, 0, size - (size_t)got);   // past the end, or unreadable
    array_journal_overlay(&disk->journal, (int64_t)address, buffer, size);
    return disk->reading && disk->failure != 0 ? -1 : 0;
}

// After a failure nothing more is written: the state of the last flush stays readable.
static herr_t disk_write(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address,
                         size_t size, const void *buffer)
{
    (void)type, (void)transfer;
    ArrayDisk *disk = (ArrayDisk *)base;
    // HDF5 checks the length when it closes: keep it as if all had been written.
    if (address + size > disk->end_of_file) disk->end_of_file = address + size;
    if (disk->failure != 0) return 0;
    int cause =
        address < disk->kept
            ? array_journal_add(&disk->journal, (int64_t)address, buffer, size)
            : transfer_write(disk->file->descriptor, buffer, (int64_t)size, (int64_t)address);
    if (cause != 0) note_failure(disk, cause);
    return 0;
}

// Makes the file as long as the space handed out, as HDF5 records the length in its header.
static herr_t disk_truncate(H5FD_t *base, hid_t transfer, hbool_t closing)
{
    (void)transfer, (void)closing;
    ArrayDisk *disk = (ArrayDisk *)base;
    if (disk->end_of_file == disk->end_of_space || disk->failure != 0) return 0;
    if (ftruncate(disk->file->descriptor, (off_t)disk->end_of_space) != 0)
        note_failure(disk, errno);
    disk->end_of_file = disk->end_of_space;
    return 0;
}

// --- a file from its beginning to its end -------------------------------------------------------

bool array_disk_open(ArrayDisk *disk, const PartFile *file, bool anew, Error *err)
{
    struct stat status;
    *disk = (ArrayDisk){.file = file};   // of a reopened file HDF5 itself says where its space ends
    int cause = anew ? 0 : array_journal_find(&disk->journal, file->path);
    if (cause == 0) cause = array_journal_apply(&disk->journal, file->descriptor);
    array_journal_close(&disk->journal);
    if (cause == 0) sync_file(disk);
    if (cause == 0) cause = disk->failure;
    if (cause == 0) cause = array_journal_create(&disk->journal, file->path);
    if (cause != 0) note_failure(disk, cause);
    if (!array_disk_check(disk, 0, "", err)) return false;
    if (fstat(file->descriptor, &status) == 0)
        disk->kept = disk->end_of_file = (haddr_t)status.st_size;
    return true;
}

bool array_disk_look(ArrayDisk *disk, const PartFile *file, bool finished, Error *err)
{
    struct stat status;
    *disk = (ArrayDisk){.file = file, .reading = true};
    int cause = finished ? 0 : array_journal_find(&disk->journal, file->path);
    if (cause != 0)
        return FAULT(err, ERROR_FILE, "cannot read %s.journal: %s", file->path, strerror(cause));
    if (fstat(file->descriptor, &status) == 0) disk->end_of_file = (haddr_t)status.st_size;
    return true;
}

// First the new bytes and what the last journal had, then this one, each on the disk before the
// next.
bool array_disk_settle(ArrayDisk *disk, Error *err)
{
    if (disk->failure == 0 && disk->journal.size > 0 && sync_file(disk)) {
        int cause = array_journal_seal(&disk->journal);
        if (cause == 0) cause = array_journal_apply(&disk->journal, disk->file->descriptor);
        if (cause != 0) note_failure(disk, cause);
    }
    disk->kept = disk->end_of_space;
    return array_disk_check(disk, 0, "", err);
}

bool array_disk_sync(ArrayDisk *disk, Error *err)
{
    sync_file(disk);
    return array_disk_check(disk, 0, "", err);
}

bool array_disk_end(ArrayDisk *disk, Error *err)
{
    if (!array_disk_settle(disk, err)) return false;
    if (!array_disk_sync(disk, err)) return false;
    array_journal_remove(&disk->journal);
    return true;
}

void array_disk_close(ArrayDisk *disk)
{
    array_journal_close(&disk->journal);
}

// FLMAP_DICHOTOMY: metadata and raw data are gathered apart, though both go to one file.
bool array_disk_use(ArrayDisk *disk, hid_t access, hid_t *driver)
{
    static const H5FD_class_t description = {
#ifdef H5FD_CLASS_VERSION   // since HDF5 1.14
        .version = H5FD_CLASS_VERSION,
#endif
        .name = "amontons_disk",
        .maxaddr = INT64_MAX,
        .fc_degree = H5F_CLOSE_STRONG,   // closing the file closes the datasets left open
        .fapl_size = sizeof(DiskAddress),
        .open = disk_open,
        .close = disk_close,
        .query = disk_query,
        .alloc = disk_allocate,
        .free = disk_free,
        .get_eoa = disk_end_of_space,
        .set_eoa = disk_set_end_of_space,
        .get_eof = disk_end_of_file,
        .read = disk_read,
        .write = disk_write,
        .truncate = disk_truncate,
        .fl_map = H5FD_FLMAP_DICHOTOMY,
    };
    DiskAddress address = {disk};
    *driver = H5FDregister(&description);
    return *driver >= 0 && H5Pset_driver(access, *driver, &address) >= 0;
}

bool array_disk_check(const ArrayDisk *disk, herr_t status, const char *what, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    // First the disk: what HDF5 says after a lost write follows from that.
    if (disk->failure != 0)
        return FAULT(err, disk->failure == ENOMEM ? ERROR_MEMORY : ERROR_FILE,
                     "cannot write %s: %s", disk->file->part, strerror(disk->failure));
    if (status < 0)
        return FAULT(err, ERROR_LIBRARY, "HDF5 cannot write %s into %s: %s", what, disk->file->part,
                     hdf5_cause(cause));
    return true;
}

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
