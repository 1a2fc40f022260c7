// SPDX-License-Identifier: GPL-2.0-or-later
// meshes/block.geo with a straight contact, in rows of quadrilaterals. Points and curves as there:
//
//         3 -- 3 -- 4      (here from 0 on: points 0 ... 3, curves 0 ... 3 around the block)
//         |         |
//         4         2
//         |         |
//         1 -- 1 -- 2
#include "io/plain_mesh.h"

#include <math.h>
#include <string.h>

enum {
    LENGTH,
    HEIGHT,
    NX,
    NZ,
    GRADE_X,
    GRADE_Z,
    REFINE,
    ORDER,
    INCOMPLETE,
    CROWN,
    EDGE_RADIUS,
    SHAPE,
    LAYOUT,
    PARAMETER_COUNT
};

// The defaults of meshes/block.geo. Those from ORDER on may be given, but not otherwise.
static const MeshParameter DEFAULTS[PARAMETER_COUNT] = {
    [LENGTH] = {.name = "length", .value = 1},
    [HEIGHT] = {.name = "height", .value = 0.5},
    [NX] = {.name = "nx", .value = 40},
    [NZ] = {.name = "nz", .value = 40},
    [GRADE_X] = {.name = "grade_x", .value = 1},
    [GRADE_Z] = {.name = "grade_z", .value = 1},
    [REFINE] = {.name = "refine", .value = 1},
    [ORDER] = {.name = "order", .value = 1},
    [INCOMPLETE] = {.name = "incomplete", .value = 0},
    [CROWN] = {.name = "crown", .value = 0},
    [EDGE_RADIUS] = {.name = "edge_radius", .value = 0},
    [SHAPE] = {.name = "shape", .text = "quad"},
    [LAYOUT] = {.name = "layout", .text = "regular"}};

// Cells of the four curves. false: not in rows, or not allowed.
static bool read_spacing(const MeshParameter *of, CurveSpacing spacing[PATCH_SIDES])
{
    if (!plain_unchanged(of, DEFAULTS, ORDER, PARAMETER_COUNT)) return false;
    double nx = of[NX].value, nz = of[NZ].value, refine = of[REFINE].value;
    double grade_x = of[GRADE_X].value, grade_z = of[GRADE_Z].value;
    if (floor(nx) != nx || floor(nz) != nz || !(nx >= 1 && nz >= 1)) return false;
    if (!(refine > 0 && grade_x > 0 && grade_z > 0)) return false;
    nx = plain_refined(nx, refine);
    nz = plain_refined(nz, refine);
    double ratio = nz > 1 ? pow(grade_z, 1 / (nz - 1)) : 1;
    return plain_is_extent(of[LENGTH].value) && plain_is_extent(of[HEIGHT].value) &&
           nx * nz <= PLAIN_CELLS_MAX && curve_spacing(LAW_BUMP, 1 / grade_x, nx, &spacing[0]) &&
           curve_spacing(LAW_PROGRESSION, ratio, nz, &spacing[1]) &&
           curve_spacing(LAW_BUMP, 1 / grade_x, nx, &spacing[2]) &&
           curve_spacing(LAW_PROGRESSION, 1 / ratio, nz, &spacing[3]);
}

bool plain_block_build(const MeshParameter *given, int32_t count, PlainModel *model, bool *fits,
                       Error *err)
{
    // gmsh gives the first number to the body.
    static const PlainGroup groups[] = {{"contact", 1, 2, 0, 1},
                                        {"leading", 1, 3, 1, 1},
                                        {"top", 1, 4, 2, 1},
                                        {"rod", 1, 5, 3, 1},
                                        {"body", 2, 1, 0, 1}};
    enum { GROUP_COUNT = sizeof groups / sizeof groups[0] };
    MeshParameter of[PARAMETER_COUNT];
    CurveSpacing spacing[PATCH_SIDES];
    memcpy(of, DEFAULTS, sizeof of);
    *fits = plain_take(given, count, of, PARAMETER_COUNT) && read_spacing(of, spacing);
    if (!*fits) return true;
    double length = of[LENGTH].value, height = of[HEIGHT].value;
    const double corners[PATCH_SIDES][2] = {{0, 0}, {length, 0}, {length, height}, {0, height}};
    TRY(plain_model_create(PATCH_SIDES, PATCH_SIDES, 1, GROUP_COUNT, model, err));
    memcpy(model->point, corners, sizeof corners);
    memcpy(model->group, groups, sizeof groups);
    for (int32_t k = 0; k < PATCH_SIDES; k++) {
        model->curve[k] = (PlainCurve){.point = {k, (k + 1) % PATCH_SIDES}, .spacing = spacing[k]};
        model->patch[0].side[k] = k;
    }
cleanup:
    return error_is_clean(err);
}
