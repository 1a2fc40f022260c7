// SPDX-License-Identifier: GPL-2.0-or-later
// Preloaded into the program (LD_PRELOAD): what malloc, calloc and realloc give begins MEMORY_SHIFT
// bytes (16, 32 or 48; malloc promises multiples of 16) behind a multiple of 64. Memory that is
// asked for with an alignment (aligned_alloc, posix_memalign, memalign) has that, as base/memory
// relies on.
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 64 };

void *__libc_malloc(size_t size);
void __libc_free(void *block);
void *memalign(size_t alignment, size_t size);

// Before each block: where its memory begins, and its size.
typedef struct Head {
    void *memory;
    size_t size;
} Head;

static Head *head_of(void *block)
{
    return (Head *)block - 1;
}

// NULL: none is left. alignment: a power of 2.
static void *give(size_t alignment, size_t shift, size_t size)
{
    size_t extra = alignment + LINE + sizeof(Head);
    char *memory = size < SIZE_MAX - extra ? __libc_malloc(size + extra) : NULL;
    if (!memory) {
        errno = ENOMEM;
        return NULL;
    }
    uintptr_t first = (uintptr_t)memory + sizeof(Head) + alignment - 1;
    char *block = memory + ((first & ~(alignment - 1)) - (uintptr_t)memory) + shift;
    *head_of(block) = (Head){memory, size};
    return block;
}

static size_t shift_wanted(void)
{
    const char *wanted = getenv("MEMORY_SHIFT");
    return wanted ? (size_t)atoi(wanted) % LINE / 16 * 16 : 0;
}

void *malloc(size_t size)
{
    return give(LINE, shift_wanted(), size);
}

void free(void *block)
{
    if (block) __libc_free(head_of(block)->memory);
}

void *calloc(size_t count, size_t size)
{
    size_t bytes = 0;
    if (__builtin_mul_overflow(count, size, &bytes)) return NULL;
    void *block = malloc(bytes);
    return block ? memset(block, 0, bytes) : NULL;
}

void *realloc(void *block, size_t size)
{
    void *longer = malloc(size);
    if (!longer || !block) return longer;
    size_t had = head_of(block)->size;
    memcpy(longer, block, had < size ? had : size);
    free(block);
    return longer;
}

void *memalign(size_t alignment, size_t size)
{
    return give(alignment < 16 ? 16 : alignment, 0, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
    *block = memalign(alignment, size);
    return *block ? 0 : ENOMEM;
}

size_t malloc_usable_size(void *block)
{
    return block ? head_of(block)->size : 0;
}
