// SPDX-License-Identifier: GPL-2.0-or-later
// meshes/pads.geo without fillets, in rows of quadrilaterals. What that file computes is computed
// here in the same order, since each rounding counts. Points are numbered row by row, curves as in
// the file: below the pads, between pads and block, on top, up the pads, up the block:
//
//     top     o------o------o------o         point rows: feet (at pads only), roots, top
//             |      |      |      |         patches: pads, then the columns of the block
//     roots   o------o------o------o
//             |  pad | gap  |  pad |         column k from x[k] to x[k + 1]
//     feet    o------o      o------o
#include "io/plain_mesh.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PADS_MAX = 10000;

enum {
    N,
    LENGTH,
    HEIGHT,
    TOTAL_HEIGHT,
    PAD_HEIGHT,
    FILL,
    CONTACT_LENGTH,
    PAD_RATIO,
    GAP,
    SIZE_CONTACT,
    SIZE_BULK,
    CELLS_PAD,
    CELLS_GAP,
    CELLS_PAD_HEIGHT,
    NZ,
    GRADE_Z,
    GRADE_CONTACT,
    REFINE,
    ENDS,
    LAYOUT,
    SHAPE,
    FILLET,
    ORDER,
    INCOMPLETE,
    PARAMETER_COUNT
};

// The defaults of meshes/pads.geo. Those from SHAPE on may be given, but not otherwise.
static const MeshParameter DEFAULTS[PARAMETER_COUNT] = {
    [N] = {.name = "n", .value = 3},
    [LENGTH] = {.name = "length", .value = 1},
    [HEIGHT] = {.name = "height", .value = 0.5},
    [TOTAL_HEIGHT] = {.name = "total_height", .value = 0},
    [PAD_HEIGHT] = {.name = "pad_height", .value = 0.05},
    [FILL] = {.name = "fill", .value = 0.6},
    [CONTACT_LENGTH] = {.name = "contact_length", .value = 0},
    [PAD_RATIO] = {.name = "pad_ratio", .value = 1},
    [GAP] = {.name = "gap", .value = 0},
    [SIZE_CONTACT] = {.name = "size_contact", .value = 0},
    [SIZE_BULK] = {.name = "size_bulk", .value = 0},
    [CELLS_PAD] = {.name = "cells_pad", .value = 8},
    [CELLS_GAP] = {.name = "cells_gap", .value = 6},
    [CELLS_PAD_HEIGHT] = {.name = "cells_pad_height", .value = 3},
    [NZ] = {.name = "nz", .value = 20},
    [GRADE_Z] = {.name = "grade_z", .value = 1},
    [GRADE_CONTACT] = {.name = "grade_contact", .value = 1},
    [REFINE] = {.name = "refine", .value = 1},
    [ENDS] = {.name = "ends", .text = "flush"},
    [LAYOUT] = {.name = "layout", .text = "auto"},
    [SHAPE] = {.name = "shape", .text = "quad"},
    [FILLET] = {.name = "fillet", .value = 0},
    [ORDER] = {.name = "order", .value = 1},
    [INCOMPLETE] = {.name = "incomplete", .value = 0}};

typedef struct Pads {
    double of[PARAMETER_COUNT];   // as given, or the default
    bool open;   // half a gap at either end
    double touching, top, margin, gap;   // lengths; margin: free underside at either end
    double step, sum;   // of the pads' lengths: the next over the one before; in units of the first
    double fine, grade;   // size of the cells in pads and gaps; how fine the ends of pads are
    CurveSpacing up_pad, up_block;
    int32_t columns;
    double *x;   // [columns + 1] where they begin and end; owned
    bool *solid;   // [columns + 2] at k + 1: column k is a pad; owned
    CurveSpacing *across;   // [columns]; owned
} Pads;

// --- what is allowed ----------------------------------------------------------------------------

static bool is_whole(double cells)
{
    return cells >= 1 && floor(cells) == cells;
}

// In rows, and of numbers that the file accepts for themselves.
static bool read_parameters(const MeshParameter *given, int32_t count, Pads *pads)
{
    MeshParameter all[PARAMETER_COUNT];
    memcpy(all, DEFAULTS, sizeof all);
    if (!plain_take(given, count, all, PARAMETER_COUNT)) return false;
    if (!plain_unchanged(all, DEFAULTS, SHAPE, PARAMETER_COUNT)) return false;
    for (int32_t k = 0; k < PARAMETER_COUNT; k++) pads->of[k] = all[k].value;
    const double *of = pads->of;
    const char *ends = all[ENDS].text, *layout = all[LAYOUT].text;
    pads->open = strcmp(ends, "open") == 0;
    return (pads->open || strcmp(ends, "flush") == 0) &&
           (strcmp(layout, "auto") == 0 || strcmp(layout, "regular") == 0) && is_whole(of[N]) &&
           of[N] <= PADS_MAX && is_whole(of[CELLS_PAD]) && is_whole(of[CELLS_GAP]) &&
           is_whole(of[CELLS_PAD_HEIGHT]) && is_whole(of[NZ]) && of[HEIGHT] > 0 &&
           of[PAD_RATIO] > 0 && of[GAP] >= 0 && of[CONTACT_LENGTH] >= 0 && of[SIZE_CONTACT] >= 0 &&
           of[SIZE_BULK] >= 0 && of[GRADE_Z] > 0 && of[GRADE_CONTACT] >= 1 && of[REFINE] > 0;
}

// --- lengths ------------------------------------------------------------------------------------

static void find_margin(Pads *pads)
{
    double n = pads->of[N], length = pads->of[LENGTH], gap = pads->of[GAP];
    pads->gap = gap;
    if (n == 1) {
        pads->gap = 0;
        pads->margin = (length - pads->touching) / 2;
    } else if (gap > 0) {
        pads->margin = (length - pads->touching - (n - 1) * gap) / 2;
    } else if (pads->open) {
        pads->gap = (length - pads->touching) / n;
        pads->margin = pads->gap / 2;
    } else {
        pads->gap = (length - pads->touching) / (n - 1);
    }
    if (fabs(pads->margin) < 1e-9 * length) pads->margin = 0;
}

// false: they do not fit, or are so short that rounding might make two points one.
static bool find_lengths(Pads *pads)
{
    const double *of = pads->of;
    double n = of[N], length = of[LENGTH], height = of[PAD_HEIGHT];
    pads->touching = of[CONTACT_LENGTH] > 0 ? of[CONTACT_LENGTH] : of[FILL] * length;
    pads->top = of[TOTAL_HEIGHT] > 0 ? of[TOTAL_HEIGHT] : height + of[HEIGHT];
    if (!(of[TOTAL_HEIGHT] == 0 || of[TOTAL_HEIGHT] > height)) return false;
    if (!(pads->touching > 0 && (pads->touching < length || (n == 1 && of[FILL] <= 1))))
        return false;
    find_margin(pads);
    pads->step = n > 1 ? pow(of[PAD_RATIO], 1 / (n - 1)) : 1;
    for (double k = 0; k < n; k++) pads->sum += pow(pads->step, k);
    double least = PLAIN_EXTENT_MIN * length;
    double shortest = pads->touching / pads->sum * (pads->step < 1 ? pow(pads->step, n - 1) : 1);
    return plain_is_extent(length) && plain_is_extent(height) && plain_is_extent(pads->top) &&
           plain_is_extent(pads->top - height) && shortest >= least &&
           (n == 1 || pads->gap >= least) && (pads->margin == 0 || pads->margin >= least) &&
           of[SIZE_CONTACT] / of[REFINE] <= shortest / 2;
}

static void add_column(Pads *pads, double to, bool solid)
{
    pads->x[++pads->columns] = to;
    pads->solid[pads->columns] = solid;
}

static bool list_columns(Pads *pads, Error *err)
{
    double n = pads->of[N], length = pads->of[LENGTH], x = pads->margin;
    int64_t most = 2 * (int64_t)n + 1;
    TRY((pads->x = NEW_ARRAY(double, most + 1, err)));
    TRY((pads->solid = NEW_ARRAY(bool, most + 2, err)));
    TRY((pads->across = NEW_ARRAY(CurveSpacing, most, err)));
    if (pads->margin > 0) add_column(pads, pads->margin, false);
    for (double k = 0; k < n; k++) {
        x = x + pads->touching / pads->sum * pow(pads->step, k);
        if (k == n - 1) x = length - pads->margin;
        add_column(pads, x, true);
        if (k == n - 1) break;
        x = x + pads->gap;
        add_column(pads, x, false);
    }
    if (pads->margin > 0) add_column(pads, length, false);
cleanup:
    return error_is_clean(err);
}

// --- cells --------------------------------------------------------------------------------------

// Up the block: nz heights, or in progression from `fine` to size_bulk.
static bool space_block(double size_bulk, double nz, Pads *pads)
{
    double height = pads->top - pads->of[PAD_HEIGHT], fine = pads->fine;
    double ratio = nz > 1 ? pow(pads->of[GRADE_Z], 1 / (nz - 1)) : 1;
    if (size_bulk > 0) {
        double coarse = size_bulk < height / 2 ? size_bulk : height / 2;
        ratio = fine < height / 2 ? (height - fine) / (height - coarse) : 1;
        if (fabs(ratio - 1) < 1e-9) {
            nz = ceil(height / coarse - 1e-6);
            ratio = 1;
        } else {
            nz = 1 + ceil(log(coarse / fine) / log(ratio) - 1e-6);
            ratio = nz > 1 ? pow(coarse / fine, 1 / (nz - 1)) : 1;
        }
    }
    return curve_spacing(LAW_PROGRESSION, ratio, nz, &pads->up_block);
}

static bool space_pads(double size_contact, double cells, Pads *pads)
{
    double up = size_contact > 0 ? ceil(pads->of[PAD_HEIGHT] / pads->fine - 1e-6) : cells;
    bool graded = pads->grade > 1 && up > 1;
    return curve_spacing(LAW_PROGRESSION, graded ? pow(pads->grade, 1 / (up - 1)) : 1, up,
                         &pads->up_pad);
}

// Of the columns; `cells` of a gap and of a pad, unless they go by size.
static bool space_columns(double size_contact, const double cells[2], Pads *pads)
{
    double all = 0, up[2] = {pads->up_block.cells, pads->up_block.cells + pads->up_pad.cells};
    for (int32_t k = 0; k < pads->columns; k++) {
        bool solid = pads->solid[k + 1];
        double wide = pads->x[k + 1] - pads->x[k];
        double across = size_contact > 0 ? ceil(wide / pads->fine - 1e-6) : cells[solid];
        double ratio = solid && pads->grade > 1 ? 1 / pads->grade : 1;
        if (!curve_spacing(LAW_BUMP, ratio, across, &pads->across[k])) return false;
        all += across * up[solid];
    }
    return all <= PLAIN_CELLS_MAX;
}

static bool find_cells(Pads *pads)
{
    const double *of = pads->of;
    double refine = of[REFINE], size_contact = of[SIZE_CONTACT] / refine;
    double cells[] = {plain_refined(of[CELLS_GAP], refine), plain_refined(of[CELLS_PAD], refine)};
    double up = plain_refined(of[CELLS_PAD_HEIGHT], refine), nz = plain_refined(of[NZ], refine);
    if (of[N] * (cells[1] + cells[0]) * (nz + up) > PLAIN_CELLS_MAX) return false;
    pads->grade = refine * of[GRADE_CONTACT] > 1 ? refine * of[GRADE_CONTACT] : 1;
    pads->fine = size_contact > 0 ? size_contact : pads->touching / of[N] / cells[1];
    return space_block(of[SIZE_BULK] / refine, nz, pads) && space_pads(size_contact, up, pads) &&
           space_columns(size_contact, cells, pads);
}

// --- the model ----------------------------------------------------------------------------------

// Where rows of points and curves begin. Row k of points or curves up: [k] is at x[k].
typedef struct Rows {
    int32_t feet, roots, top;   // points
    int32_t below, between, above, up_pad, up_block;   // curves
    int32_t pads;   // patches of the block begin behind the pads
} Rows;

static int32_t count_feet(const Pads *pads)
{
    int32_t feet = 0;
    for (int32_t k = 0; k <= pads->columns; k++) feet += pads->solid[k] || pads->solid[k + 1];
    return feet;
}

static PlainCurve curve_of(int32_t from, int32_t to, const CurveSpacing *spacing)
{
    return (PlainCurve){.point = {from, to}, .spacing = *spacing};
}

static void list_uprights(const Pads *pads, const Rows *at, PlainModel *model)
{
    for (int32_t k = 0, foot = 0; k <= pads->columns; k++) {
        double x = pads->x[k];
        memcpy(model->point[at->roots + k], (double[]){x, pads->of[PAD_HEIGHT]}, 2 * sizeof x);
        memcpy(model->point[at->top + k], (double[]){x, pads->top}, 2 * sizeof x);
        model->curve[at->up_block + k] = curve_of(at->roots + k, at->top + k, &pads->up_block);
        if (!pads->solid[k] && !pads->solid[k + 1]) continue;
        memcpy(model->point[at->feet + foot], (double[]){x, 0}, 2 * sizeof x);
        model->curve[at->up_pad + foot] = curve_of(at->feet + foot, at->roots + k, &pads->up_pad);
        foot++;
    }
}

static void list_patches(const Pads *pads, const Rows *at, PlainModel *model)
{
    for (int32_t k = 0, pad = 0, foot = 0; k < pads->columns; k++) {
        const CurveSpacing *across = &pads->across[k];
        int32_t left = at->up_block + k;
        model->curve[at->between + k] = curve_of(at->roots + k, at->roots + k + 1, across);
        model->curve[at->above + k] = curve_of(at->top + k, at->top + k + 1, across);
        model->patch[at->pads + k] = (PlainPatch){{at->between + k, left + 1, at->above + k, left}};
        if (pads->solid[k + 1]) {
            left = at->up_pad + foot;
            model->curve[at->below + pad] = curve_of(at->feet + foot, at->feet + foot + 1, across);
            model->patch[pad] = (PlainPatch){{at->below + pad, left + 1, at->between + k, left}};
            pad++;
        }
        foot += pads->solid[k] || pads->solid[k + 1];
    }
}

// gmsh numbers groups as the file names them, and once more where it takes the pads out of body.
static void list_groups(const Pads *pads, const Rows *at, PlainModel *model)
{
    int32_t n = at->pads, last = at->up_block + pads->columns;
    const PlainGroup others[] = {{"rod", 1, n + 1, at->up_block, 1},
                                 {"leading", 1, n + 2, last, 1},
                                 {"top", 1, n + 6, at->above, pads->columns},
                                 {"body", 2, n + 3, n, pads->columns},
                                 {"pads", 2, n + 5, 0, n}};
    for (int32_t k = 0; k < n; k++) {
        PlainGroup *group = &model->group[k];
        *group = (PlainGroup){.dimension = 1, .number = k + 1, .first = at->below + k, .count = 1};
        snprintf(group->name, sizeof group->name, "contact_%d", k + 1);
    }
    memcpy(model->group + n, others, sizeof others);
}

static bool build(const Pads *pads, PlainModel *model, Error *err)
{
    int32_t columns = pads->columns, feet = count_feet(pads), n = (int32_t)pads->of[N];
    Rows at = {.roots = feet,
               .top = feet + columns + 1,
               .between = n,
               .above = n + columns,
               .up_pad = n + 2 * columns,
               .up_block = n + 2 * columns + feet,
               .pads = n};
    TRY(plain_model_create(at.top + columns + 1, at.up_block + columns + 1, n + columns, n + 5,
                           model, err));
    list_uprights(pads, &at, model);
    list_patches(pads, &at, model);
    list_groups(pads, &at, model);
cleanup:
    return error_is_clean(err);
}

bool plain_pads_build(const MeshParameter *given, int32_t count, PlainModel *model, bool *fits,
                      Error *err)
{
    Pads pads = {0};
    *fits = read_parameters(given, count, &pads) && find_lengths(&pads);
    if (!*fits) return true;
    TRY(list_columns(&pads, err));
    *fits = find_cells(&pads);
    if (*fits) TRY(build(&pads, model, err));
cleanup:
    memory_free(pads.x);
    memory_free(pads.solid);
    memory_free(pads.across);
    return error_is_clean(err);
}
