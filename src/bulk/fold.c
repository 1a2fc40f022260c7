// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/fold.h"

#include "base/memory.h"

static const double ROOT_HALF = 0.70710678118654752440;

bool fold_create(int32_t count, Fold *fold, Error *err)
{
    *fold = (Fold){.one = NEW_ARRAY(int32_t, count, err),
                   .other = NEW_ARRAY(int32_t, count, err),
                   .sign = NEW_ARRAY(double, count, err)};
    return error_is_clean(err);
}

void fold_destroy(Fold *fold)
{
    memory_free(fold->one);
    memory_free(fold->other);
    memory_free(fold->sign);
    *fold = (Fold){0};
}

void fold_append(Fold *fold, int32_t one, int32_t other, double sign)
{
    fold->one[fold->count] = one;
    fold->other[fold->count] = other;
    fold->sign[fold->count++] = sign;
}

void fold_take(const Fold *fold, const double *whole, double *half)
{
    for (int32_t k = 0; k < fold->count; k++) {
        double here = whole[fold->one[k]];
        half[k] = fold->other[k] == NO_IMAGE
                      ? here
                      : ROOT_HALF * (here + fold->sign[k] * whole[fold->other[k]]);
    }
}

void fold_add(const Fold *fold, const double *half, double *whole)
{
    for (int32_t k = 0; k < fold->count; k++) {
        if (fold->other[k] == NO_IMAGE) {
            whole[fold->one[k]] += half[k];
            continue;
        }
        double share = ROOT_HALF * half[k];
        whole[fold->one[k]] += share;
        whole[fold->other[k]] += fold->sign[k] * share;
    }
}

void fold_add_square(const Fold *fold, const double *half, int32_t size, double *whole)
{
    for (int32_t j = 0; j < fold->count; j++) {
        const double *from = half + (int64_t)j * fold->count;
        double *one = whole + (int64_t)fold->one[j] * size;
        bool paired = fold->other[j] != NO_IMAGE;
        double *other = paired ? whole + (int64_t)fold->other[j] * size : one;
        double weight = paired ? ROOT_HALF : 1, turned = paired ? fold->sign[j] : 0;
        for (int32_t i = 0; i < fold->count; i++) {
            bool two = fold->other[i] != NO_IMAGE;
            double value = (two ? ROOT_HALF : 1) * weight * from[i];
            one[fold->one[i]] += value;
            other[fold->one[i]] += turned * value;
            if (!two) continue;
            one[fold->other[i]] += fold->sign[i] * value;
            other[fold->other[i]] += fold->sign[i] * turned * value;
        }
    }
}
