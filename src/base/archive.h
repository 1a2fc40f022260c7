// SPDX-License-Identifier: GPL-2.0-or-later
// A state, or what a cache keeps, as bytes. Whoever has a part of it lists that in one function,
// which writes it, reads it back, or only measures it, as the archive is set: so what is written
// and what is read cannot differ.
//
//     void energy_archive(EnergyLedger *ledger, Archive *archive)
//     {
//         archive_section(archive, "energy");
//         archive_number(archive, &ledger->rod_work);
//         ...
//     }
//
// Arrays are as long as their owner has them: one of another length is a fault, as are a section of
// another name and an end that comes too early. After a fault nothing more is read, and
// archive_check tells it. Numbers lie in the machine's own byte order, without gaps.
#ifndef AMONTONS_BASE_ARCHIVE_H
#define AMONTONS_BASE_ARCHIVE_H

#include "base/error.h"

#include <stddef.h>

typedef enum ArchiveMode {
    ARCHIVE_MEASURES,
    ARCHIVE_WRITES,
    ARCHIVE_SENDS,
    ARCHIVE_READS
} ArchiveMode;

enum { ARCHIVE_NAME_SIZE = 24 };

// Takes the next bytes of an archive that is not in memory; false: it cannot.
typedef bool (*ArchiveSend)(void *context, const void *bytes, int64_t size);

typedef struct Archive {
    ArchiveMode mode;
    char *bytes;   // [size]; not owned; NULL while measuring
    int64_t size;   // bytes that there are
    int64_t at;   // bytes gone through
    bool failed;   // what is read is not what was asked for
    char section[ARCHIVE_NAME_SIZE];   // where
    ArchiveSend send;
    void *context;   // of send; not owned
    Error *err;   // where reading says that there is no memory for an array; not owned
} Archive;

Archive archive_measure(void);
Archive archive_write(void *bytes, int64_t size);
Archive archive_send(ArchiveSend send, void *context);
Archive archive_read(const void *bytes, int64_t size);

void archive_section(Archive *archive, const char *name);   // shorter than ARCHIVE_NAME_SIZE

void archive_number(Archive *archive, double *number);
void archive_integer(Archive *archive, int32_t *integer);
void archive_count(Archive *archive, int64_t *count);   // from 0 to 2^53: others are a fault
void archive_flag(Archive *archive, bool *flag);
// Several, by their addresses.
#define archive_numbers_of(archive, ...)                                                           \
    archive_number_list((archive), (double *const[]){__VA_ARGS__},                                 \
                        (int32_t)(sizeof((double *[]){__VA_ARGS__}) / sizeof(double *)))
#define archive_counts_of(archive, ...)                                                            \
    archive_count_list((archive), (int64_t *const[]){__VA_ARGS__},                                 \
                       (int32_t)(sizeof((int64_t *[]){__VA_ARGS__}) / sizeof(int64_t *)))
void archive_number_list(Archive *archive, double *const *numbers, int32_t count);
void archive_count_list(Archive *archive, int64_t *const *counts, int32_t count);
void archive_numbers(Archive *archive, double *numbers, int64_t count);
// Integers from `low` to below `high`: others are a fault, as what they count might not be there.
void archive_indices(Archive *archive, int32_t *indices, int64_t count, int32_t low, int32_t high);
void archive_index(Archive *archive, int32_t *index, int32_t low, int32_t high);   // a fault: low
void archive_octets(Archive *archive, uint8_t *octets, int64_t count);
void archive_text(Archive *archive, char *text, int64_t size);   // all of its array
void archive_length(Archive *archive, int32_t *length);   // from 0 to below 2^28: a few add up;
    // 0 after a fault
void archive_require(Archive *archive, bool condition);   // of what is read: else it is a fault

// The same of arrays that reading makes, `count` long, the caller's to free; NULL after a fault.
void *archive_new(Archive *archive, void *known, int64_t count,
                  size_t size);   // items to go through
void archive_new_numbers(Archive *archive, double **numbers, int64_t count);
void archive_new_counts(Archive *archive, int64_t **counts, int64_t count);
void archive_new_indices(Archive *archive, int32_t **indices, int64_t count, int32_t low,
                         int32_t high);
void archive_new_octets(Archive *archive, uint8_t **octets, int64_t count, uint8_t high);

// A list that grows: its length and room, as memory_grow has them. Reading makes *list anew with
// that room (owned by the caller, zeroed), for the caller to go through its `*count` items.
bool archive_list(Archive *archive, void **list, int32_t *count, int32_t *room, size_t size,
                  Error *err);

bool archive_reads(const Archive *archive);
bool archive_fills(const Archive *archive);   // reads, and without a fault so far
// ERROR_FILE: a fault, or (with `whole`) bytes left over.
bool archive_check(const Archive *archive, bool whole, Error *err);

#endif
