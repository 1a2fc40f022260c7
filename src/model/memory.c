// SPDX-License-Identifier: GPL-2.0-or-later
// With n unknowns on the mesh and m of them on the interface: a reduction keeps factors of the mesh
// and responses to all m of the unknowns that are left, where modes replace what is far
// (reduction/far_patches). In space a sparse factor has n^(4/3) entries, and contact and its
// certificate keep matrices of m x m.
#include "model/memory.h"

#include "reduction/far_patches.h"

#include <math.h>

// Bytes in the plane, for each unknown of the mesh and for each entry of a response: 4.5e9 at 480 x
// 480 cells, 1.9e9 at 320 x 320 and at 800 contact nodes on 60 rows.
static const double BYTES_FACTORS = 9000, BYTES_PRODUCTS = 36;

// Bytes of a run in space on a few cells: the program and its libraries.
static const double SPACE_LEAST = 6e7;
// Bytes for each unknown of the mesh: mesh, matrices and those of its parts.
static const double SPACE_MESH = 4500;
// Numbers in space that are kept at once: matrices of m x m (one for each step size, their copies,
// factors, certificate), entries of a factor, and in a reduction those of three factors of a part
// (at rest, and of two points at once) and columns of responses over those of its border. Contact
// that is its own mirror image is solved on one side, and takes 58 squares where its symmetry
// breaks, which nobody knows before.
static const double SPACE_SQUARES = 30, SPACE_SQUARES_ONE_SIDE = 13, SPACE_ENTRIES = 25;
static const double SPACE_PART_ENTRIES = 90, SPACE_COLUMNS = 1.5;
static const double SPACE_TOGETHER = 1.4;   // two parts side by side over one
static const double SPACE_FACTORS = 11;   // step sizes of a run with a sliding, each with a factor
// Unknowns of a reduced block over those of its interface. Each is a mode of the mesh, which is
// kept where fields or probes are asked for.
static const double SPACE_MODES = 1.55, PLANE_MODES = 3.1;

double memory_expected(const MemorySizes *sizes, bool reduced)
{
    double n = sizes->unknowns, m = sizes->interface, parts = sizes->parts;
    double of_part = n / parts, border = m / parts;
    double modes = sizes->modes ? (sizes->space ? SPACE_MODES : PLANE_MODES) * n * border : 0;
    if (!sizes->space)
        return reduced ? BYTES_FACTORS * of_part +
                             BYTES_PRODUCTS * border * far_patches_left(of_part, border) +
                             sizeof(double) * modes
                       : 0;
    double squares = (sizes->one_side ? SPACE_SQUARES_ONE_SIDE : SPACE_SQUARES) * m * m;
    double factor = SPACE_ENTRIES * pow(n, 4.0 / 3);
    double responses = SPACE_PART_ENTRIES * pow(of_part, 4.0 / 3) +
                       SPACE_COLUMNS * of_part * border;
    if (parts > 1 && !sizes->one_by_one) responses *= SPACE_TOGETHER;
    double numbers = reduced ? fmax(squares, responses) + modes : squares + SPACE_FACTORS * factor;
    return SPACE_LEAST + SPACE_MESH * n + sizeof(double) * numbers;
}
