// SPDX-License-Identifier: GPL-2.0-or-later
// The file: a head, then pieces, each an address, a length and so many bytes. While the head does
// not fit the pieces, as in a file half written, there is no journal.
#include "io/hdf5/array_journal.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/transfer.h"
#include "io/files/open_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct Head {
    char name[24];
    int64_t size;   // of head and pieces
    char checksum[HASH_TEXT_SIZE];   // of the pieces
} Head;

typedef struct Piece {
    int64_t address, size;
} Piece;

static const char NAME[] = "amontons-journal 1";
enum { FIRST_ROOM = 1 << 16 };

// The piece at *at, which goes on to the next, and its bytes; NULL: it does not end in the journal.
static const char *take_piece(const ArrayJournal *journal, int64_t *at, Piece *piece)
{
    int64_t left = journal->size - *at - (int64_t)sizeof *piece;
    if (left < 0) return NULL;
    memcpy(piece, journal->bytes + *at, sizeof *piece);
    if (piece->address < 0 || piece->size < 0 || piece->size > left) return NULL;
    const char *bytes = journal->bytes + *at + sizeof *piece;
    *at += (int64_t)sizeof *piece + piece->size;
    return bytes;
}

// What belongs before the pieces.
static Head head_of(const ArrayJournal *journal)
{
    Head head = {.size = journal->size};
    Hash hash = hash_start();
    Piece piece;
    int64_t at = sizeof head;
    memcpy(head.name, NAME, sizeof NAME);
    for (const char *bytes; (bytes = take_piece(journal, &at, &piece));) {
        hash_bytes(&hash, &piece, sizeof piece);
        hash_bytes(&hash, bytes, (size_t)piece.size);
    }
    hash_write(&hash, head.checksum);
    return head;
}

static bool find_name(ArrayJournal *journal, const char *path)
{
    *journal = (ArrayJournal){0};
    int length = snprintf(journal->path, sizeof journal->path, "%s.journal", path);
    return length < (int)sizeof journal->path;
}

// --- writing ------------------------------------------------------------------------------------

int array_journal_create(ArrayJournal *journal, const char *path)
{
    if (!find_name(journal, path)) return ENAMETOOLONG;
    char why[OPEN_WHY_SIZE];
    Error err = {0};
    journal->room = FIRST_ROOM;   // of most runs: steps then allocate nothing
    if (!(journal->bytes = memory_bytes(FIRST_ROOM, &err))) return ENOMEM;
    if (!open_is_there(journal->path)) return 0;
    int left = open_to_write(journal->path, OPEN_KEPT, why);
    if (left < 0) return errno;
    close(left);
    return unlink(journal->path) != 0 && errno != ENOENT ? errno : 0;
}

static void append(ArrayJournal *journal, const void *bytes, size_t size)
{
    memcpy(journal->bytes + journal->size, bytes, size);
    journal->size += (int64_t)size;
}

int array_journal_add(ArrayJournal *journal, int64_t address, const void *bytes, size_t size)
{
    Error err = {0};
    Piece piece = {.address = address, .size = (int64_t)size};
    if (journal->size == 0) journal->size = sizeof(Head);
    int64_t needed = journal->size + (int64_t)sizeof piece + piece.size;
    if (needed > journal->room) {
        if (!memory_resize(&journal->bytes, journal->room, 2 * needed, 1, &err)) return ENOMEM;
        journal->room = 2 * needed;
    }
    append(journal, &piece, sizeof piece);
    append(journal, bytes, size);
    return 0;
}

int array_journal_seal(ArrayJournal *journal)
{
    char why[OPEN_WHY_SIZE];
    Head head = head_of(journal);
    memcpy(journal->bytes, &head, sizeof head);
    // Ours from the first one on, also where no disk keeps the bit that says so.
    int file = open_to_write(journal->path, OPEN_KEPT, why);
    if (file < 0) return errno;
    journal->made = true;
    int cause = transfer_write(file, journal->bytes, journal->size, 0);
    if (cause == 0) cause = transfer_sync(file);
    close(file);
    return cause;
}

// --- reading ------------------------------------------------------------------------------------

void array_journal_overlay(const ArrayJournal *journal, int64_t address, char *bytes, size_t size)
{
    Piece piece;
    int64_t at = sizeof(Head), end = address + (int64_t)size;
    for (const char *from; (from = take_piece(journal, &at, &piece));) {
        int64_t first = address > piece.address ? address : piece.address;
        int64_t last = piece.address + piece.size < end ? piece.address + piece.size : end;
        if (last > first)
            memcpy(bytes + (first - address), from + (first - piece.address),
                   (size_t)(last - first));
    }
}

int array_journal_apply(ArrayJournal *journal, int descriptor)
{
    Piece piece;
    int64_t at = sizeof(Head);
    for (const char *from; (from = take_piece(journal, &at, &piece));) {
        int cause = transfer_write(descriptor, from, piece.size, piece.address);
        if (cause) return cause;
    }
    journal->size = 0;
    return 0;
}

// The whole file into the memory; `size` stays 0 where its head is not that of what follows.
static int read_sealed(ArrayJournal *journal, int file)
{
    Error err = {0};
    Head head;
    struct stat status;
    if (fstat(file, &status) != 0) return errno;
    if (status.st_size < (off_t)sizeof head) return 0;
    if (!(journal->bytes = memory_bytes(status.st_size, &err))) return ENOMEM;
    if (transfer_read(file, journal->bytes, status.st_size, 0) != status.st_size)
        return errno ? errno : EIO;
    memcpy(&head, journal->bytes, sizeof head);
    if (head.size < (int64_t)sizeof head || head.size > status.st_size) return 0;
    journal->size = head.size;
    Head right = head_of(journal);
    if (memcmp(&head, &right, sizeof head) != 0) journal->size = 0;
    return 0;
}

int array_journal_find(ArrayJournal *journal, const char *path)
{
    if (!find_name(journal, path)) return ENAMETOOLONG;
    Error unseen = {0};
    int file = open_to_read(journal->path, &unseen);
    if (file < 0) return open_is_there(journal->path) ? EINVAL : 0;
    int cause = read_sealed(journal, file);
    close(file);
    return cause;
}

// --- end ----------------------------------------------------------------------------------------

void array_journal_close(ArrayJournal *journal)
{
    memory_free(journal->bytes);
    journal->bytes = NULL;
    journal->size = journal->room = 0;
}

void array_journal_remove(ArrayJournal *journal)
{
    if (journal->path[0]) unlink(journal->path);
    array_journal_close(journal);
}
