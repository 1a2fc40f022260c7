// SPDX-License-Identifier: GPL-2.0-or-later
// Symbols are collected, and each block of them gets Huffman codes of its own. The only distance is
// a pixel back, so that its code is one bit, which stands in every match.
#include "render/canvas/run_deflate.h"

#include "base/memory.h"

#include <string.h>

enum {
    BLOCK = 1 << 15,   // symbols that share their codes
    SYMBOLS = 286,   // literals, the end of a block, lengths
    END_OF_BLOCK = 256,
    LENGTH_FIRST = 257,
    LENGTH_LEAST = 3,
    LENGTH_MOST = 258,   // 86 pixels
    PIXEL = 3,   // bytes
    CODE_BITS = 15,   // of the longest code
    SYMBOL_BITS = 9,   // of an entry; what follows a length stands above
    ENTRY_BYTES = 4,   // of a block for one entry at most, header included
    WORD = 32,   // bits that are written at once
    FILTER_UP = 2,
    ADLER = 65521
};

struct RunDeflate {
    RunSink sink;
    void *context;
    uint64_t sum, sums;   // of Adler-32
    int32_t count;
    uint32_t entry[BLOCK];   // [count]
    uint64_t bits;   // not in `bytes` yet, the first one lowest
    int32_t bit_count;
    size_t size;
    uint8_t bytes[ENTRY_BYTES * (BLOCK + SYMBOLS)];   // [size]
};

static void put_bits(RunDeflate *stream, uint32_t bits, int32_t count)
{
    stream->bits |= (uint64_t)bits << stream->bit_count;
    stream->bit_count += count;
    if (stream->bit_count < WORD) return;
    for (int32_t byte = 0; byte < WORD / 8; ++byte)
        stream->bytes[stream->size++] = (uint8_t)(stream->bits >> 8 * byte);
    stream->bits >>= WORD;
    stream->bit_count -= WORD;
}

// Up to a whole byte.
static void put_rest(RunDeflate *stream)
{
    for (; stream->bit_count > 0; stream->bit_count -= 8, stream->bits >>= 8)
        stream->bytes[stream->size++] = (uint8_t)stream->bits;
    stream->bit_count = 0;
    stream->bits = 0;
}

// --- codes of a block ----------------------------------------------------------------------------

typedef struct Codes {
    int32_t length[SYMBOLS];   // bits; 0: the symbol does not occur
    uint32_t code[SYMBOLS];   // the first bit lowest
} Codes;

// The two least frequent trees become one, until one is left. false: some code is too long.
static bool find_lengths(const int64_t *often, Codes *codes)
{
    int64_t weight[2 * SYMBOLS];
    int32_t above[2 * SYMBOLS] = {0}, depth[2 * SYMBOLS] = {0}, trees = SYMBOLS;
    memcpy(weight, often, SYMBOLS * sizeof *often);
    for (;; ++trees) {
        int32_t least[2] = {-1, -1};
        for (int32_t k = 0; k < trees; ++k) {
            if (weight[k] == 0) continue;
            if (least[0] < 0 || weight[k] < weight[least[0]]) {
                least[1] = least[0];
                least[0] = k;
            } else if (least[1] < 0 || weight[k] < weight[least[1]]) {
                least[1] = k;
            }
        }
        if (least[1] < 0) break;
        weight[trees] = weight[least[0]] + weight[least[1]];
        for (int32_t k = 0; k < 2; ++k) {
            weight[least[k]] = 0;
            above[least[k]] = trees;
        }
    }
    for (int32_t k = trees - 2; k >= 0; --k) depth[k] = above[k] ? depth[above[k]] + 1 : 0;
    for (int32_t k = 0; k < SYMBOLS; ++k) {
        codes->length[k] = depth[k];
        if (depth[k] > CODE_BITS) return false;
    }
    return true;
}

// Shorter codes first, then by symbol, as the format asks.
static void number_codes(Codes *codes)
{
    uint32_t next = 0;
    for (int32_t length = 1; length <= CODE_BITS; ++length, next <<= 1) {
        for (int32_t k = 0; k < SYMBOLS; ++k) {
            if (codes->length[k] != length) continue;
            codes->code[k] = 0;
            for (int32_t bit = 0; bit < length; ++bit)
                codes->code[k] |= (next >> bit & 1) << (length - 1 - bit);
            ++next;
        }
    }
}

static void make_codes(const RunDeflate *stream, Codes *codes)
{
    int64_t often[SYMBOLS] = {[END_OF_BLOCK] = 1, [LENGTH_FIRST] = 1};
    for (int32_t k = 0; k < stream->count; ++k)
        ++often[stream->entry[k] & ((1 << SYMBOL_BITS) - 1)];
    while (!find_lengths(often, codes))
        for (int32_t k = 0; k < SYMBOLS; ++k) often[k] = (often[k] + 1) / 2;
    number_codes(codes);
}

// Lengths of codes are written in a code of four bits for each of 0 to 15.
static void put_header(RunDeflate *stream, const Codes *codes, bool last)
{
    enum { DYNAMIC = 2, LENGTH_CODES = 19, REPEATS = 3, FOUR_BITS = 4 };
    put_bits(stream, last, 1);
    put_bits(stream, DYNAMIC, 2);
    put_bits(stream, SYMBOLS - LENGTH_FIRST, 5);
    put_bits(stream, PIXEL - 1, 5);   // distances up to 3
    put_bits(stream, LENGTH_CODES - FOUR_BITS, 4);
    for (int32_t k = 0; k < LENGTH_CODES; ++k) put_bits(stream, k < REPEATS ? 0 : FOUR_BITS, 3);
    for (int32_t k = 0; k < SYMBOLS + PIXEL; ++k) {
        uint32_t length = k < SYMBOLS ? (uint32_t)codes->length[k] : k == SYMBOLS + PIXEL - 1;
        uint32_t turned = 0;
        for (int32_t bit = 0; bit < FOUR_BITS; ++bit)
            turned |= (length >> bit & 1) << (FOUR_BITS - 1 - bit);
        put_bits(stream, turned, FOUR_BITS);
    }
}

// The bits that follow a code of lengths: none up to 10 and at the longest, then one more each time
// that lengths double.
static int32_t length_bits(int32_t symbol)
{
    enum { PLAIN = LENGTH_FIRST + 8, FOURS = 4 };
    return symbol < PLAIN || symbol == SYMBOLS - 1 ? 0 : (symbol - PLAIN) / FOURS + 1;
}

static void put_block(RunDeflate *stream, bool last)
{
    Codes codes;
    make_codes(stream, &codes);
    put_header(stream, &codes, last);
    for (int32_t k = 0; k < stream->count; ++k) {
        int32_t symbol = stream->entry[k] & ((1 << SYMBOL_BITS) - 1);
        uint32_t extra = stream->entry[k] >> SYMBOL_BITS;
        int32_t bits = codes.length[symbol];   // of a match: and those of its length and distance
        int32_t more = symbol < LENGTH_FIRST ? 0 : length_bits(symbol) + 1;
        put_bits(stream, codes.code[symbol] | extra << bits, bits + more);
    }
    put_bits(stream, codes.code[END_OF_BLOCK], codes.length[END_OF_BLOCK]);
    stream->count = 0;
}

static void hand_over(RunDeflate *stream)
{
    stream->sink(stream->context, stream->bytes, stream->size);
    stream->size = 0;
}

// --- bytes ---------------------------------------------------------------------------------------

static void add_entry(RunDeflate *stream, int32_t symbol, int32_t extra)
{
    stream->entry[stream->count++] = (uint32_t)(extra << SYMBOL_BITS | symbol);
    if (stream->count < BLOCK) return;
    put_block(stream, false);
    hand_over(stream);
}

// `length` bytes, each as the one a pixel before it.
static void add_match(RunDeflate *stream, int32_t length)
{
    int32_t past = length - LENGTH_LEAST, bits = 0;
    while (past >> bits >= 8) ++bits;
    if (length == LENGTH_MOST)
        add_entry(stream, SYMBOLS - 1, 0);
    else
        add_entry(stream, LENGTH_FIRST + 4 * bits + (past >> bits), past & ((1 << bits) - 1));
}

static void sum_byte(RunDeflate *stream, uint8_t byte)
{
    stream->sum += byte;
    stream->sums += stream->sum;
}

// Of a pixel: each byte less that of the pixel above, without carries from one to the next.
static uint32_t change_of(const uint8_t *row, const uint8_t *above)
{
    static const uint32_t high = 0x00808080, low = 0x007f7f7f;
    uint32_t to, from;
    memcpy(&to, row, sizeof to);
    memcpy(&from, above, sizeof from);
    return (((to | high) & 0x00ffffff) - (from & low)) ^ (~(to ^ from) & high);
}

// How many pixels from the first of `most` on change as that one does.
static int32_t run_length(const uint8_t *row, const uint8_t *above, int32_t most, uint32_t change)
{
    static const uint64_t used = 0x00ffffff00ffffff;   // of two pixels
    int32_t k = 1;
    for (uint64_t to, from; change == 0 && k + 2 <= most; k += 2) {
        memcpy(&to, row + 4 * k, sizeof to);
        memcpy(&from, above + 4 * k, sizeof from);
        if ((to ^ from) & used) break;
    }
    while (k < most && change_of(row + 4 * k, above + 4 * k) == change) ++k;
    return k;
}

// Bytes of a pixel in memory are blue, green, red, so in a PNG the last one is the first.
static void add_run(RunDeflate *stream, uint32_t change, int32_t pixels)
{
    const uint8_t colors[PIXEL] = {(uint8_t)(change >> 16), (uint8_t)(change >> 8),
                                   (uint8_t)change};
    if (change == 0) stream->sums += stream->sum * (uint64_t)pixels * PIXEL;
    for (int32_t k = 0; change != 0 && k < pixels; ++k)
        for (int32_t c = 0; c < PIXEL; ++c) sum_byte(stream, colors[c]);
    for (int32_t c = 0; c < PIXEL; ++c) add_entry(stream, colors[c], 0);
    for (int32_t left = PIXEL * (pixels - 1); left > 0; left -= LENGTH_MOST)
        add_match(stream, left < LENGTH_MOST ? left : LENGTH_MOST);
}

void run_deflate_row(RunDeflate *stream, const uint8_t *row, const uint8_t *above, int32_t width)
{
    sum_byte(stream, FILTER_UP);
    add_entry(stream, FILTER_UP, 0);
    for (int32_t k = 0, pixels = 0; k < width; k += pixels) {
        uint32_t change = change_of(row + 4 * k, above + 4 * k);
        pixels = run_length(row + 4 * k, above + 4 * k, width - k, change);
        add_run(stream, change, pixels);
    }
    stream->sum %= ADLER;
    stream->sums %= ADLER;
}

RunDeflate *run_deflate_create(RunSink sink, void *context, Error *err)
{
    RunDeflate *stream = NEW_ARRAY(RunDeflate, 1, err);
    if (!stream) return NULL;
    stream->sink = sink;
    stream->context = context;
    stream->sum = 1;
    put_bits(stream, 0x78, 8);   // deflate with a window of 32 kB
    put_bits(stream, 0x01, 8);   // checksum of these two, lowest level
    return stream;
}

void run_deflate_end(RunDeflate *stream)
{
    uint32_t check = (uint32_t)(stream->sums << 16 | stream->sum);
    put_block(stream, true);
    put_rest(stream);
    for (int32_t byte = 3; byte >= 0; --byte)
        stream->bytes[stream->size++] = (uint8_t)(check >> 8 * byte);
    hand_over(stream);
}

void run_deflate_destroy(RunDeflate *stream)
{
    memory_free(stream);
}
