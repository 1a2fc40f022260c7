// SPDX-License-Identifier: GPL-2.0-or-later
// With n unknowns on the mesh, m of them on the interface: a sparse factor of a mesh of two
// dimensions takes n^1.5 operations. Of the n log n entries that a pass goes through more come from
// far memory where the mesh is larger: n^1.5 fits them, too. A basis takes some factors and
// products of q x m responses, q what is left where modes replace what is far; of two parts
// (reduction/mirror) those of each. A stage on it, and the contact problem of either way, passes
// through matrices of some m x m. The seconds before them were fitted to processor times of thirty
// shapes by validation/benchmark/choice.py.
#include "model/choice.h"

#include "reduction/far_patches.h"

#include <math.h>

// s, each for one of what its comment says.
static const double FULL_FACTOR = 7.6e-9;   // rung and n^1.5
static const double FULL_STAGE = 1.2e-9;   // stage and n^1.5
static const double FULL_BORDER = 4.9e-9;   // stage and m^2
static const double REDUCTION_FACTORS = 5.0e-5;   // n
static const double REDUCTION_PRODUCTS = 6.8e-10;   // q m^2 of each part
static const double REDUCED_STAGE = 3.8e-9;   // stage and m^2
static const double ANY_STAGE = 5e-6;   // stage: contact and certificate of small interfaces

// Several materials have no one viscous time: more modes are left, and go through each stage.
static const double OF_SEVERAL = 2.5;

static const double RUNGS = 11;   // used by a run with a sliding

// Below that a basis is built in any case: what it might cost now the next run of the shape saves;
// s.
static const double NOT_WORTH_ASKING = 0.05;

// Bytes of memory for each entry of n and of q x m, and in all (4.5e9 at 480 x 480 cells, 1.9e9 at
// 320 x 320 and at 800 contact nodes on 60 rows).
static const double BYTES_FACTORS = 9000, BYTES_PRODUCTS = 36, BYTES_MAX = 6e9;

// In space a sparse factor takes n^2 operations and has n^(4/3) entries; the contact problem and
// its certificate pass through matrices of m x m and factor those of what slips. What is far is not
// replaced, so that q = n. Contact that is its own mirror image is solved on one side: a half of
// what passes through m x m, as both sides are certified, a sixth of the factors. Fitted to
// processor times of cubes of 6, 10, 14 and 20 cells a side and of 40 x 40 x 20, reduced and not.
static const double SPACE_FACTOR = 1.6e-9;   // rung and n^2
static const double SPACE_STAGE = 3.7e-8;   // stage and n^(4/3)
static const double SPACE_CONTACT = 3.4e-9, SPACE_CONTACT_FACTORS = 4e-12;   // stage and m^2, m^3
static const double SPACE_ONE_SIDE = 0.5, SPACE_ONE_SIDE_FACTORS = 1.0 / 6;   // of those
static const double SPACE_REDUCED_STAGE = 0.7e-9;   // stage and m^2
static const double SPACE_REDUCTION = 1.8e-8;   // n^2 of each part
static const double SPACE_PRODUCTS = 0.55e-9;   // n m^2 of each part

// Numbers that are kept at once: matrices of m x m (rungs, their copies, factors, certificate),
// entries of a factor, and in a reduction columns of responses over those of a part's border.
static const double SPACE_SQUARES = 30, SPACE_SQUARES_ONE_SIDE = 23, SPACE_ENTRIES = 39,
                    SPACE_COLUMNS = 12;
static const double SPACE_TOGETHER = 1.2;   // two parts side by side over one: 0.9 to 1.16

static ExpectedCost expect_in_space(const ChoiceSizes *sizes)
{
    double n = sizes->unknowns, m = sizes->interface, parts = sizes->parts;
    double stages = sizes->stages, of_part = n / parts, border = m / parts;
    double passes = SPACE_CONTACT * m * m, factors = SPACE_CONTACT_FACTORS * m * m * m;
    if (parts > 1) {
        passes *= SPACE_ONE_SIDE;
        factors *= SPACE_ONE_SIDE_FACTORS;
    }
    double contact = ANY_STAGE + passes + factors;
    double reduction = SPACE_REDUCTION * of_part * of_part +
                       SPACE_PRODUCTS * of_part * border * border;
    double squares = (parts > 1 ? SPACE_SQUARES_ONE_SIDE : SPACE_SQUARES) * m * m,
           entries = SPACE_ENTRIES * pow(n, 4.0 / 3);
    double responses = SPACE_ENTRIES * pow(of_part, 4.0 / 3) + SPACE_COLUMNS * of_part * border;
    if (parts > 1) responses *= SPACE_TOGETHER;
    double full = RUNGS * SPACE_FACTOR * n * n + stages * SPACE_STAGE * pow(n, 4.0 / 3);
    return (ExpectedCost){.reduction = parts * reduction * (sizes->several ? OF_SEVERAL : 1),
                          .reduced = stages * (contact + SPACE_REDUCED_STAGE * m * m),
                          .full = full + stages * contact,
                          .bytes_reduced = sizeof(double) * fmax(squares, responses),
                          .bytes_full = sizeof(double) * (squares + RUNGS * entries)};
}

ExpectedCost choice_expect(const ChoiceSizes *sizes)
{
    if (sizes->space) return expect_in_space(sizes);
    double n = sizes->unknowns, square = sizes->interface * sizes->interface;
    double factor = FULL_FACTOR * pow(n, 1.5);
    double pass = FULL_STAGE * pow(n, 1.5) + FULL_BORDER * square;
    double parts = sizes->parts, m = sizes->interface / parts;
    double products = REDUCTION_PRODUCTS * parts * m * m * far_patches_left(n / parts, m);
    double stage = REDUCED_STAGE * square * (sizes->several ? OF_SEVERAL : 1);
    double reduction = REDUCTION_FACTORS * n + products, any = sizes->stages * ANY_STAGE;
    return (ExpectedCost){.reduction = reduction,
                          .reduced = any + sizes->stages * stage,
                          .full = any + RUNGS * factor + sizes->stages * pass};
}

bool choice_reduces(const ChoiceSizes *sizes, const ExpectedCost *cost)
{
    double n = sizes->unknowns / sizes->parts, m = sizes->interface / sizes->parts;
    double bytes = BYTES_FACTORS * n + BYTES_PRODUCTS * m * far_patches_left(n, m);
    if (sizes->held) return true;
    if (sizes->space ? cost->bytes_reduced > cost->bytes_full : bytes > BYTES_MAX) return false;
    return cost->reduction < NOT_WORTH_ASKING ||
           cost->reduction / sizes->runs + cost->reduced < cost->full;
}
