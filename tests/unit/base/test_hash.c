// SPDX-License-Identifier: GPL-2.0-or-later
// A hash for cache keys: every bit counts, so do lengths and the borders between pieces,
// nothing that is structured collides, and the digest is the same tomorrow.
#include "base/hash.h"

#include "near.h"
#include "random_numbers.h"

static void digest(const Hash *hash, uint64_t half[2])
{
    char text[HASH_TEXT_SIZE];
    hash_write(hash, text);
    assert_int_equal(sscanf(text, "%16lx%16lx", &half[0], &half[1]), 2);
}

static void digest_bytes(const void *bytes, size_t size, uint64_t half[2])
{
    Hash hash = hash_start();
    hash_bytes(&hash, bytes, size);
    digest(&hash, half);
}

// One flipped bit changes about half of each half's bits: the count over all flips is binomial.
TEST(test_every_bit_counts)
{
    Random random = {.state = 1};
    double changed[2] = {0};
    int32_t flips = 0;
    for (size_t size = 1; size <= 40; size++) {
        unsigned char bytes[40];
        for (size_t k = 0; k < size; k++) bytes[k] = (unsigned char)random_bits(&random);
        uint64_t before[2], after[2];
        digest_bytes(bytes, size, before);
        for (size_t bit = 0; bit < 8 * size; bit++, flips++) {
            bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
            digest_bytes(bytes, size, after);
            bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
            for (int h = 0; h < 2; h++) {
                int count = __builtin_popcountll(before[h] ^ after[h]);
                assert_in_range(count, 8, 56);   // a mean of 32 and a deviation of 4
                changed[h] += count;
            }
        }
    }
    for (int h = 0; h < 2; h++) assert_near("bits changed", changed[h] / flips, 32, 0.5);
}

// The same of long inputs, which other code hashes than short ones; and two words that change
// places are noticed.
TEST(test_long_inputs)
{
    enum { SIZE = 1000, WORDS = SIZE / 8 };
    Random random = {.state = 3};
    uint64_t words[WORDS], before[2], after[2];
    double changed[2] = {0};
    int32_t flips = 0;
    for (int32_t k = 0; k < WORDS; k++) words[k] = random_bits(&random);
    for (size_t size = SIZE - 33; size <= SIZE; size += 11) {
        unsigned char *bytes = (unsigned char *)words;
        digest_bytes(bytes, size, before);
        for (size_t bit = 0; bit < 8 * size; bit++, flips++) {
            bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
            digest_bytes(bytes, size, after);
            bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
            for (int h = 0; h < 2; h++) {
                int count = __builtin_popcountll(before[h] ^ after[h]);
                assert_in_range(count, 8, 56);
                changed[h] += count;
            }
        }
    }
    for (int h = 0; h < 2; h++) assert_near("bits changed", changed[h] / flips, 32, 0.5);
    digest_bytes(words, SIZE, before);
    for (int32_t k = 0; k < WORDS; k++) {
        for (int32_t j = 0; j < k; j++) {
            uint64_t kept = words[k];
            words[k] = words[j];
            words[j] = kept;
            digest_bytes(words, SIZE, after);
            words[j] = words[k];
            words[k] = kept;
            for (int h = 0; h < 2; h++) assert_true(before[h] != after[h]);
        }
    }
}

// Zeros appended or moved over a border between two pieces are not the same input.
TEST(test_lengths_count)
{
    static const unsigned char zeros[64];
    uint64_t seen[65][2];
    for (size_t size = 0; size <= 64; size++) {
        digest_bytes(zeros, size, seen[size]);
        for (size_t k = 0; k < size; k++)
            for (int h = 0; h < 2; h++) assert_true(seen[k][h] != seen[size][h]);
    }
    uint64_t pieces[2][2];
    for (int which = 0; which < 2; which++) {
        Hash hash = hash_start();
        hash_text(&hash, which ? "ab" : "a");
        hash_text(&hash, which ? "c" : "bc");
        digest(&hash, pieces[which]);
    }
    assert_true(pieces[0][0] != pieces[1][0] && pieces[0][1] != pieces[1][1]);
}

static int compare_words(const void *a, const void *b)
{
    uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return left < right ? -1 : left > right;
}

// 2^20 inputs that differ as little as numbers in a scene do: by 2^-64, no two of 2^20 random words
// of 64 bits meet with a probability of 3e-8.
TEST(test_structured_inputs_do_not_collide)
{
    enum { COUNT = 1 << 20 };
    uint64_t *half[2] = {malloc(COUNT * sizeof(uint64_t)), malloc(COUNT * sizeof(uint64_t))};
    for (int32_t k = 0; k < COUNT; k++) {
        Hash hash = hash_start();
        hash_number(&hash, k % 1024);
        hash_number(&hash, ldexp(1, -(k / 1024)));   // 2^-1023: below the normal numbers too
        uint64_t both[2];
        digest(&hash, both);
        for (int h = 0; h < 2; h++) half[h][k] = both[h];
    }
    for (int h = 0; h < 2; h++) {
        qsort(half[h], COUNT, sizeof(uint64_t), compare_words);
        for (int32_t k = 1; k < COUNT; k++) assert_true(half[h][k - 1] != half[h][k]);
        free(half[h]);
    }
}

TEST(test_numbers)
{
    const double values[] = {0.0, -0.0, 1.0, -1.0, 5e-324, 1 + 0x1p-52, INFINITY};
    uint64_t seen[7][2];
    for (int k = 0; k < 7; k++) {
        Hash hash = hash_start();
        hash_number(&hash, values[k]);
        digest(&hash, seen[k]);
    }
    for (int k = 0; k < 7; k++)
        for (int j = 0; j < k; j++)
            assert_int_equal(seen[j][0] == seen[k][0] && seen[j][1] == seen[k][1],
                             j == 0 && k == 1);
}

// The text is 32 lower-case hexadecimal digits, leading zeros too; and what it was when this test
// was written, so that a cache outlives a compiler. The stored text is this program's own.
TEST(test_text)
{
    for (int32_t k = 0; k < 4096; k++) {
        Hash hash = hash_start();
        hash_number(&hash, k);
        char text[HASH_TEXT_SIZE + 1];
        memset(text, 'x', sizeof text);
        hash_write(&hash, text);
        assert_int_equal(strspn(text, "0123456789abcdef"), HASH_TEXT_SIZE - 1);
        assert_int_equal(text[HASH_TEXT_SIZE - 1], 0);
        assert_int_equal(text[HASH_TEXT_SIZE], 'x');
    }
    Hash hash = hash_start();
    char text[HASH_TEXT_SIZE];
    hash_text(&hash, "a block pushed by a rod");
    hash_number(&hash, 0.34);
    hash_bytes(&hash, "", 0);
    hash_write(&hash, text);
    assert_string_equal(text, "53e6655de5cd8a25b66720895effe1b4");
}
