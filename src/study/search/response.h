// SPDX-License-Identifier: GPL-2.0-or-later
// Each measured result as a polynomial of the keys, through the designs computed so far: smooth
// where runs scatter, and cheap where they are not: the misfit gets a least value and a profile.
// Keys are scaled: 0 and 1 are the ends of their ranges. Called by fit.
//
// Least squares with weights that fall with a design's misfit. The polynomial is of second order
// where there are designs enough for one, else without mixed terms, else of first order.
#ifndef AMONTONS_STUDY_SEARCH_RESPONSE_H
#define AMONTONS_STUDY_SEARCH_RESPONSE_H

#include "study/search/measurements.h"

enum { RESPONSE_KEYS_MAX = 12, RESPONSE_TERMS_MAX = 91 };   // 1 + 12 + 12 * 13 / 2

typedef struct ResponseDesign {
    double place[RESPONSE_KEYS_MAX];
    const double *found;   // [data]
    const double *own;   // [data] the program's own error of each, one standard deviation
    double misfit;
} ResponseDesign;

typedef struct ResponseDef {
    int32_t keys, designs, data;
    const ResponseDesign *list;   // [designs]
    const Datum *measured;   // [data]
    double far;   // misfit above the least from which on a design counts little
    int32_t failed;   // runs that failed
    const char *failure;   // what the first of them said; NULL: none
} ResponseDef;

typedef struct Response {
    int32_t keys, data, terms;
    double origin[RESPONSE_KEYS_MAX], scale[RESPONSE_KEYS_MAX];   // of the polynomials' variables
    const Datum *measured;   // [data] not owned
    double *coefficients;   // [data][terms] owned, as the next
    double *own;   // [data] the program's error: of the runs, or their scatter about the polynomial
} Response;

// ERROR_COMPUTE: too few designs.
bool response_make(const ResponseDef *def, Response *response, Error *err);
void response_destroy(Response *response);   // zeroed is fine

double response_at(const Response *response, int32_t datum, const double *place);
// Sum of squares of (found - measured), each over both errors.
double response_misfit(const Response *response, const double *place);
// The least misfit over the keys that are not fixed, each from 0 to 1, from `place` on, which goes
// there. fixed: NULL: none is.
double response_least(const Response *response, const bool *fixed, double *place);
// J' W J at `place`: half the second derivatives of the misfit, without those of the results.
void response_curvature(const Response *response, const double *place, double *curvature);

#endif
