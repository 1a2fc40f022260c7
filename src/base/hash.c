// SPDX-License-Identifier: GPL-2.0-or-later
// Speed matters: a cached basis of some megabytes is summed at every start.
//
// Not cryptographic: it tells files of the cache apart and finds damage, it does not stop somebody
// who wants two files to agree. Two 64-bit streams give 128 bits (the first is FNV-1a's
// multiplication, by words in place of bytes), so that chance collisions need not be thought of.
// The bytes are taken as they lie in memory: hashes do not travel between byte orders, as cached
// files do not.
#include "base/hash.h"

#include <stdio.h>
#include <string.h>

static const uint64_t PRIME = 0x100000001b3u, OTHER_PRIME = 0x9e3779b97f4a7c15u;

// FNV-1a's offset basis, and the same turned by half for the other stream.
Hash hash_start(void)
{
    return (Hash){.low = 0xcbf29ce484222325u, .high = 0x84222325cbf29ce4u};
}

enum { LANES = 4, BLOCK_SIZE = LANES * sizeof(uint64_t), LONG_SIZE = 256 };

// One word into both streams; the rotation lets high bits reach low ones.
static void hash_word(Hash *hash, uint64_t word)
{
    hash->low = (hash->low ^ word) * PRIME;
    hash->low ^= hash->low >> 29;
    hash->high = (hash->high + word) * OTHER_PRIME;
    hash->high = (hash->high << 31) | (hash->high >> 33);
}

// Words that come far apart in time on one stream are four streams of their own here, so that a
// processor multiplies for all of them at once: each word changes its lane one to one, and each
// lane goes into the hash.
static const unsigned char *hash_blocks(Hash *hash, const unsigned char *at, size_t blocks)
{
    uint64_t lane[LANES] = {hash->low, hash->high, ~hash->low, ~hash->high};
    for (size_t k = 0; k < blocks; k++, at += BLOCK_SIZE) {
        uint64_t word[LANES];
        memcpy(word, at, BLOCK_SIZE);
        for (int l = 0; l < LANES; l++) {
            lane[l] = (lane[l] ^ word[l]) * OTHER_PRIME;
            lane[l] ^= lane[l] >> 29;
        }
    }
    for (int l = 0; l < LANES; l++) hash_word(hash, lane[l]);
    return at;
}

// The size goes in last, so that "ab" + "c" differs from "a" + "bc". Long pieces go through the
// lanes first, which gives other sums than short ones: a piece must be hashed as a whole to agree.
void hash_bytes(Hash *hash, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    size_t left = size, blocks = size >= LONG_SIZE ? size / BLOCK_SIZE : 0;
    if (blocks > 0) at = hash_blocks(hash, at, blocks);
    left -= blocks * BLOCK_SIZE;
    for (; left >= 8; left -= 8, at += 8) {
        uint64_t word;
        memcpy(&word, at, 8);
        hash_word(hash, word);
    }
    uint64_t tail = 0;
    if (left > 0) memcpy(&tail, at, left);   // nothing may be a null pointer
    hash_word(hash, tail);
    hash_word(hash, (uint64_t)size);
}

void hash_text(Hash *hash, const char *text)
{
    hash_bytes(hash, text, strlen(text));
}

// -0 compares equal to 0, and so it must hash.
void hash_number(Hash *hash, double value)
{
    double stored = value == 0 ? 0.0 : value;
    hash_bytes(hash, &stored, sizeof stored);
}

// Spreads each bit over all 64: what the streams leave in their high bits alone reaches the text.
static uint64_t mix(uint64_t word)
{
    word = (word ^ (word >> 33)) * 0xff51afd7ed558ccdu;
    word = (word ^ (word >> 33)) * 0xc4ceb9fe1a85ec53u;
    return word ^ (word >> 33);
}

// 32 hexadecimal digits; the hash itself is left as it was and may go on.
void hash_write(const Hash *hash, char text[HASH_TEXT_SIZE])
{
    unsigned long long first = mix(hash->low + hash->high), second = mix(hash->high ^ first);
    snprintf(text, HASH_TEXT_SIZE, "%016llx%016llx", first, second);
}
