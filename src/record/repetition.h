// SPDX-License-Identifier: GPL-2.0-or-later
// Whether the end of a series repeats with a period: record/peaks asks it of the peaks of
// mu, record/falls of its falls.
#ifndef AMONTONS_RECORD_REPETITION_H
#define AMONTONS_RECORD_REPETITION_H

#include <stdbool.h>
#include <stdint.h>

// Item k of `series` is as good as item `later`, which has the same phase and is judged by.
typedef bool ItemsAgree(const void *series, int32_t k, int32_t later);

// Of `count` items those from the end on that agree with the last one of their phase, the first
// item of the run left out: how many, at least `period`. A slow drift does not agree.
int32_t repetition_count(int32_t count, int32_t period, ItemsAgree *agree, const void *series);

#endif
