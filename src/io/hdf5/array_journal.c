// SPDX-License-Identifier: GPL-2.0-or-later
// The file: a head, then pieces, each an address, a length and so many bytes. The head is written
// last; while it is zeros, or does not fit the pieces, there is no journal.
#include "io/hdf5/array_journal.h"

#include "base/memory.h"
#include "base/transfer.h"
#include "io/files/open_file.h"

#include <errno.h>
#include <fcntl.h>
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
enum { BUFFER = 1 << 16 };

// --- bytes --------------------------------------------------------------------------------------

static int read_at(const ArrayJournal *journal, void *bytes, size_t size, int64_t at)
{
    if (journal->copy) {
        if (at + (int64_t)size > journal->size) return EIO;
        memcpy(bytes, journal->copy + at, size);
        return 0;
    }
    if (transfer_read(journal->descriptor, bytes, (int64_t)size, at) == (int64_t)size) return 0;
    return errno ? errno : EIO;
}

// EINVAL: a file system that cannot sync, which is no error.
static int sync_data(int descriptor)
{
    return fdatasync(descriptor) != 0 && errno != EINVAL ? errno : 0;
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
    if (!open_is_there(journal->path)) return 0;
    int left = open_to_write(journal->path, OPEN_PART, why);
    if (left < 0) return errno;
    close(left);
    return unlink(journal->path) != 0 && errno != ENOENT ? errno : 0;
}

// The first piece of a flush: what the journal held is in the file, which is on the disk.
static int begin(ArrayJournal *journal)
{
    const Head none = {0};
    if (!journal->open) {
        char why[OPEN_WHY_SIZE];
        journal->descriptor = open_to_write(journal->path, OPEN_PART, why);
        if (journal->descriptor < 0) return errno;
        journal->open = true;
    }
    journal->holds = true;
    journal->size = sizeof none;
    journal->hash = hash_start();
    return transfer_write(journal->descriptor, &none, sizeof none, 0);
}

static int append(ArrayJournal *journal, const void *bytes, size_t size)
{
    int cause = transfer_write(journal->descriptor, bytes, (int64_t)size, journal->size);
    hash_bytes(&journal->hash, bytes, size);
    journal->size += (int64_t)size;
    return cause;
}

int array_journal_add(ArrayJournal *journal, int64_t address, const void *bytes, size_t size)
{
    Piece piece = {.address = address, .size = (int64_t)size};
    int cause = journal->holds ? 0 : begin(journal);
    if (cause == 0) cause = append(journal, &piece, sizeof piece);
    return cause ? cause : append(journal, bytes, size);
}

int array_journal_seal(ArrayJournal *journal)
{
    Head head = {.size = journal->size};
    memcpy(head.name, NAME, sizeof NAME);
    hash_write(&journal->hash, head.checksum);
    int cause = transfer_write(journal->descriptor, &head, sizeof head, 0);
    return cause ? cause : sync_data(journal->descriptor);
}

// --- reading ------------------------------------------------------------------------------------

// The part that [from, from + size) and the piece have in common: begins at *first, *count bytes.
static bool overlap(const Piece *piece, int64_t from, int64_t size, int64_t *first, int64_t *count)
{
    int64_t end = from + size, piece_end = piece->address + piece->size;
    *first = from > piece->address ? from : piece->address;
    *count = (end < piece_end ? end : piece_end) - *first;
    return *count > 0;
}

int array_journal_overlay(const ArrayJournal *journal, int64_t address, char *bytes, size_t size)
{
    Piece piece;
    int cause = 0;
    if (!journal->holds) return 0;
    for (int64_t at = sizeof(Head); cause == 0 && at < journal->size; at += piece.size) {
        int64_t first, count;
        cause = read_at(journal, &piece, sizeof piece, at);
        at += (int64_t)sizeof piece;
        if (cause == 0 && overlap(&piece, address, (int64_t)size, &first, &count))
            cause = read_at(journal, bytes + (first - address), (size_t)count,
                            at + first - piece.address);
    }
    return cause;
}

int array_journal_apply(ArrayJournal *journal, int descriptor)
{
    char buffer[BUFFER];
    Piece piece;
    int cause = 0;
    for (int64_t at = sizeof(Head); cause == 0 && at < journal->size; at += piece.size) {
        cause = read_at(journal, &piece, sizeof piece, at);
        at += (int64_t)sizeof piece;
        for (int64_t done = 0; cause == 0 && done < piece.size; done += BUFFER) {
            size_t count = (size_t)(piece.size - done < BUFFER ? piece.size - done : BUFFER);
            cause = read_at(journal, buffer, count, at + done);
            if (cause == 0)
                cause = transfer_write(descriptor, buffer, (int64_t)count, piece.address + done);
        }
    }
    if (cause == 0) journal->holds = false;
    return cause;
}

// Every piece lies within the journal, and the checksum is that of all of them, each hashed as it
// was added.
static bool is_sealed(const ArrayJournal *journal, const Head *head)
{
    Hash hash = hash_start();
    Piece piece;
    char checksum[HASH_TEXT_SIZE];
    for (int64_t at = sizeof *head; at < journal->size; at += piece.size) {
        if (read_at(journal, &piece, sizeof piece, at) != 0) return false;
        at += (int64_t)sizeof piece;
        if (piece.address < 0 || piece.size < 0 || piece.size > journal->size - at) return false;
        hash_bytes(&hash, &piece, sizeof piece);
        hash_bytes(&hash, journal->copy + at, (size_t)piece.size);
    }
    hash_write(&hash, checksum);
    return memcmp(checksum, head->checksum, HASH_TEXT_SIZE) == 0;
}

// A journal of a sound head into the memory; `size` is 0 where it has none.
static int read_copy(ArrayJournal *journal, Head *head)
{
    Error err = {0};
    struct stat status;
    if (fstat(journal->descriptor, &status) != 0) return errno;
    if (status.st_size < (off_t)sizeof *head || read_at(journal, head, sizeof *head, 0) != 0)
        return 0;
    if (memcmp(head->name, NAME, sizeof NAME) != 0 || head->size > status.st_size) return 0;
    char *copy = memory_bytes(head->size, &err);
    if (!copy) return ENOMEM;
    int cause = read_at(journal, copy, (size_t)head->size, 0);
    journal->copy = copy;
    journal->size = head->size;
    return cause;
}

int array_journal_find(ArrayJournal *journal, const char *path)
{
    Head head = {0};
    if (!find_name(journal, path)) return ENAMETOOLONG;
    Error unseen = {0};
    journal->descriptor = open_to_read(journal->path, &unseen);
    if (journal->descriptor < 0) return open_is_there(journal->path) ? EINVAL : 0;
    journal->open = true;
    int cause = read_copy(journal, &head);
    journal->holds = cause == 0 && journal->copy && is_sealed(journal, &head);
    if (!journal->holds) array_journal_close(journal);
    return cause;
}

// --- end ----------------------------------------------------------------------------------------

void array_journal_close(ArrayJournal *journal)
{
    if (journal->open) close(journal->descriptor);
    memory_free(journal->copy);
    journal->copy = NULL;
    journal->open = journal->holds = false;
}

void array_journal_remove(ArrayJournal *journal)
{
    if (journal->path[0]) unlink(journal->path);
    array_journal_close(journal);
}
