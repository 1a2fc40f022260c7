// SPDX-License-Identifier: GPL-2.0-or-later
// LAPACK and BLAS write into arrays that their callers made, and no sanitizer looks into them: a
// build with the address sanitizer asks it before each call whether the arrays are as large as the
// call needs. Other builds check nothing.
#ifndef AMONTONS_ALGEBRA_ROOM_H
#define AMONTONS_ALGEBRA_ROOM_H

#include <stddef.h>
#include <stdint.h>

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define ROOM_IS_CHECKED
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#define ROOM_IS_CHECKED
#endif

#ifdef ROOM_IS_CHECKED
#include <sanitizer/asan_interface.h>

// Reads the first byte that does not belong to the array, which the sanitizer reports.
static inline void room_check(const void *array, int64_t bytes)
{
    const volatile char *beyond =
        bytes > 0 ? __asan_region_is_poisoned((void *)(uintptr_t)array, (size_t)bytes) : NULL;
    if (beyond) (void)*beyond;
}
#else
static inline void room_check(const void *array, int64_t bytes)
{
    (void)array, (void)bytes;
}
#endif

// The array has `count` entries at least.
#define CHECK_ROOM(array, count) room_check(array, (int64_t)(count) * (int64_t)sizeof *(array))

#endif
