// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/symmetry_map.h"

#include "base/memory.h"

static const double ROOT_HALF = 0.70710678118654752440;

bool symmetry_map_create(int32_t count, SymmetryMap *map, Error *err)
{
    *map = (SymmetryMap){.one = NEW_ARRAY(int32_t, count, err),
                         .other = NEW_ARRAY(int32_t, count, err),
                         .sign = NEW_ARRAY(double, count, err),
                         .weight = NEW_ARRAY(double, count, err)};
    return error_is_clean(err);
}

void symmetry_map_destroy(SymmetryMap *map)
{
    memory_free(map->one);
    memory_free(map->other);
    memory_free(map->sign);
    memory_free(map->weight);
    *map = (SymmetryMap){0};
}

void symmetry_map_append(SymmetryMap *map, int32_t one, int32_t other, double sign)
{
    map->one[map->count] = one;
    map->other[map->count] = other;
    map->sign[map->count] = one == other ? 0 : sign;
    map->weight[map->count++] = one == other ? 1 : ROOT_HALF;
}

void symmetry_map_take(const SymmetryMap *map, const double *whole, double *part)
{
    for (int32_t k = 0; k < map->count; k++)
        part[k] = map->weight[k] * (whole[map->one[k]] + map->sign[k] * whole[map->other[k]]);
}

void symmetry_map_add(const SymmetryMap *map, const double *part, double *whole)
{
    for (int32_t k = 0; k < map->count; k++) {
        double share = map->weight[k] * part[k];
        whole[map->one[k]] += share;
        whole[map->other[k]] += map->sign[k] * share;
    }
}

void symmetry_map_add_square(const SymmetryMap *map, const double *part, int32_t size,
                             double *whole)
{
    for (int32_t j = 0; j < map->count; j++) {
        const double *from = part + (int64_t)j * map->count;
        double *one = whole + (int64_t)map->one[j] * size;
        double *other = whole + (int64_t)map->other[j] * size;
        double weight = map->weight[j], sign = map->sign[j];
        for (int32_t i = 0; i < map->count; i++) {
            double value = map->weight[i] * weight * from[i], turned = map->sign[i] * value;
            one[map->one[i]] += value;
            one[map->other[i]] += turned;
            other[map->one[i]] += sign * value;
            other[map->other[i]] += sign * turned;
        }
    }
}
