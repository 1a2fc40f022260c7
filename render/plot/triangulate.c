// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/triangulate.h"

#include "base/memory.h"

#include <libqhull_r/libqhull_r.h>

#include <math.h>
#include <stdio.h>

enum { POINTS_MIN = 3, DIMENSIONS = 2 };

// Facets of the paraboloid's lower side, cut into triangles (Qt) where points lie on one circle.
static bool take_triangles(qhT *qh, const int32_t *index, int32_t **corners, int32_t *triangles,
                           Error *err)
{
    int64_t count = 0;
    facetT *facet;
    FORALLfacets
    {
        if (facet->upperdelaunay) continue;
        count++;
    }
    if (!(*corners = NEW_ARRAY(int32_t, 3 * count + 1, err))) return false;
    FORALLfacets
    {
        vertexT *vertex, **vertexp;
        int32_t k = 0;
        if (facet->upperdelaunay) continue;
        FOREACHvertex_(facet->vertices)
        {
            int32_t point = qh_pointid(qh, vertex->point);
            if (k < 3) (*corners)[3 * *triangles + k++] = index[point];
        }
        *triangles += k == 3;
    }
    return true;
}

// Qhull changes none of `places`. What it says of a flat set of points is not passed on.
static bool hull_make(double *places, const int32_t *index, int32_t count, int32_t **corners,
                      int32_t *triangles, Error *err)
{
    // Qbb scales the last coordinate, Qc Qz: points on one circle; Q12: allows wide facets.
    char options[] = "qhull d Qt Qbb Qc Qz Q12";
    int left = 0, bytes = 0;
    qhT hull;
    FILE *ignored = fopen("/dev/null", "w");
    if (!ignored) FAIL(err, ERROR_FILE, "cannot open /dev/null");
    qh_zero(&hull, ignored);
    int status = qh_new_qhull(&hull, DIMENSIONS, count, places, False, options, NULL, ignored);
    bool flat = status == qh_ERRsingular || status == qh_ERRinput;
    if (status == 0)
        take_triangles(&hull, index, corners, triangles, err);
    else if (!flat)
        error_set(err, ERROR_LIBRARY, __FILE__, __LINE__,
                  "Qhull cannot join the points of a map (its error %d)", status);
    qh_freeqhull(&hull, qh_ALL);
    qh_memfreeshort(&hull, &left, &bytes);
cleanup:
    if (ignored) fclose(ignored);
    return error_is_clean(err);
}

bool triangulate(const Point *points, int32_t count, int32_t **corners, int32_t *triangles,
                 Error *err)
{
    int32_t kept = 0;
    double *places = NULL;
    int32_t *index = NULL;
    *corners = NULL;
    *triangles = 0;
    TRY(places = NEW_ARRAY(double, DIMENSIONS *(int64_t)count, err));
    TRY(index = NEW_ARRAY(int32_t, (int64_t)count + 1, err));
    for (int32_t k = 0; k < count; k++) {
        if (!isfinite(points[k].x) || !isfinite(points[k].y)) continue;
        places[DIMENSIONS * kept] = points[k].x;
        places[DIMENSIONS * kept + 1] = points[k].y;
        index[kept++] = k;
    }
    if (kept >= POINTS_MIN) TRY(hull_make(places, index, kept, corners, triangles, err));
    if (!*corners) TRY(*corners = NEW_ARRAY(int32_t, 1, err));
cleanup:
    memory_free_all(places, index);
    return error_is_clean(err);
}
