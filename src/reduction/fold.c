// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/fold.h"

#include "base/memory.h"

static const double ROOT_HALF = 0.70710678118654752440;

bool fold_create(int32_t count, Fold *fold, Error *err)
{
    *fold = (Fold){.one = NEW_ARRAY(int32_t, count, err),
                   .other = NEW_ARRAY(int32_t, count, err),
                   .sign = NEW_ARRAY(double, count, err),
                   .weight = NEW_ARRAY(double, count, err)};
    return error_is_clean(err);
}

void fold_destroy(Fold *fold)
{
    memory_free(fold->one);
    memory_free(fold->other);
    memory_free(fold->sign);
    memory_free(fold->weight);
    *fold = (Fold){0};
}

void fold_append(Fold *fold, int32_t one, int32_t other, double sign)
{
    fold->one[fold->count] = one;
    fold->other[fold->count] = other;
    fold->sign[fold->count] = one == other ? 0 : sign;
    fold->weight[fold->count++] = one == other ? 1 : ROOT_HALF;
}

void fold_take(const Fold *fold, const double *whole, double *half)
{
    for (int32_t k = 0; k < fold->count; k++)
        half[k] = fold->weight[k] * (whole[fold->one[k]] + fold->sign[k] * whole[fold->other[k]]);
}

void fold_add(const Fold *fold, const double *half, double *whole)
{
    for (int32_t k = 0; k < fold->count; k++) {
        double share = fold->weight[k] * half[k];
        whole[fold->one[k]] += share;
        whole[fold->other[k]] += fold->sign[k] * share;
    }
}

void fold_add_square(const Fold *fold, const double *half, int32_t size, double *whole)
{
    for (int32_t j = 0; j < fold->count; j++) {
        const double *from = half + (int64_t)j * fold->count;
        double *one = whole + (int64_t)fold->one[j] * size;
        double *other = whole + (int64_t)fold->other[j] * size;
        double weight = fold->weight[j], sign = fold->sign[j];
        for (int32_t i = 0; i < fold->count; i++) {
            double value = fold->weight[i] * weight * from[i], turned = fold->sign[i] * value;
            one[fold->one[i]] += value;
            one[fold->other[i]] += turned;
            other[fold->one[i]] += sign * value;
            other[fold->other[i]] += sign * turned;
        }
    }
}
