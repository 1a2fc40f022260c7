// SPDX-License-Identifier: GPL-2.0-or-later
// A 128-bit content hash: names a cached file by what it depends on, and shows when its bytes have
// changed. Not for secrets: it does not stop somebody who wants two files to agree. XXH3 of xxHash.
// Numbers are hashed as they lie in memory: like cached files, names hold for one byte order.
#ifndef AMONTONS_BASE_HASH_H
#define AMONTONS_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

enum { HASH_TEXT_SIZE = 33 };

typedef struct Hash {
    uint64_t low, high;
} Hash;

Hash hash_start(void);
void hash_bytes(Hash *hash, const void *bytes, size_t size);   // its length counts too
void hash_text(Hash *hash, const char *text);
void hash_number(Hash *hash, double value);   // -0 and 0 are the same
void hash_write(const Hash *hash, char text[HASH_TEXT_SIZE]);   // 32 hexadecimal digits

#endif
