// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/hash.h"

#include <stdio.h>
#include <string.h>
#include <xxhash.h>

Hash hash_start(void)
{
    return (Hash){0};
}

// A chain: the hash so far, the size of the piece and its hash are hashed together, so that it
// matters where one piece ends and the next begins.
void hash_bytes(Hash *hash, const void *bytes, size_t size)
{
    XXH128_hash_t piece = XXH3_128bits(bytes, size);
    uint64_t link[] = {hash->low, hash->high, size, piece.low64, piece.high64};
    XXH128_hash_t chained = XXH3_128bits(link, sizeof link);
    *hash = (Hash){.low = chained.low64, .high = chained.high64};
}

void hash_text(Hash *hash, const char *text)
{
    hash_bytes(hash, text, strlen(text));
}

// -0 equals 0, so both must have one hash.
void hash_number(Hash *hash, double value)
{
    double stored = value == 0 ? 0.0 : value;
    hash_bytes(hash, &stored, sizeof stored);
}

// More may be hashed afterwards.
void hash_write(const Hash *hash, char text[HASH_TEXT_SIZE])
{
    snprintf(text, HASH_TEXT_SIZE, "%016llx%016llx", (unsigned long long)hash->high,
             (unsigned long long)hash->low);
}
