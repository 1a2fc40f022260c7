// SPDX-License-Identifier: GPL-2.0-or-later
// The map onto the symmetric or the antisymmetric part of a vector: what is alike on both sides of
// a mirror line, or what is opposite. A pair of unknowns x, x* of the whole is (x + s x*)/sqrt(2)
// in a part, with s = 1 or -1; an unknown that is its own image is as it is, in one of them: it
// stands as a pair with itself and s = 0. Both parts together are an orthogonal turn T of the
// whole. Made by reduction/mirror.
#ifndef AMONTONS_REDUCTION_SYMMETRY_MAP_H
#define AMONTONS_REDUCTION_SYMMETRY_MAP_H

#include "base/error.h"

#include <stdint.h>

typedef struct SymmetryMap {
    int32_t count;   // of the part
    int32_t *one, *other;   // [count] unknowns of the whole; owned
    double *sign;   // [count] s; owned
    double *weight;   // [count] 1/sqrt(2) of a pair, else 1; owned
} SymmetryMap;

// Room for at most `count`; SymmetryMap.count starts at 0.
bool symmetry_map_create(int32_t count, SymmetryMap *map, Error *err);
void symmetry_map_destroy(SymmetryMap *map);
void symmetry_map_append(SymmetryMap *map, int32_t one, int32_t other, double sign);

void symmetry_map_take(const SymmetryMap *map, const double *whole,
                       double *part);   // part = T whole
void symmetry_map_add(const SymmetryMap *map, const double *part,
                      double *whole);   // whole += T' part
// whole [size^2] += T' part T, part [count^2] symmetric.
void symmetry_map_add_square(const SymmetryMap *map, const double *part, int32_t size,
                             double *whole);

#endif
