// SPDX-License-Identifier: GPL-2.0-or-later
// A block on n equal pads. gmsh's y is the z of amontons: the pads stand on y = 0, the rod pushes
// the face x = 0 of the block towards +x. Here for n = 3:
//
//                    top
//         +------------------------+   length x height, on top of the pads
//    rod  |          body          |  leading
//         +----+---+----+---+----+-+
//         |pad |   |pad |   |pad |     n pads of pad_height, together fill * length long;
//         +----+   +----+   +----+     the first begins at x = 0, the last ends at x = length
//       contact_1 contact_2 contact_3
//
// Physical groups: body (the surface of block and pads), contact_1 ... contact_n by ascending x,
// top, rod (the trailing face of the block, without its pad) and leading (curves).

DefineConstant[
    n = 3,                  // pads
    length = 1,             // of the block, along x
    height = 0.5,           // of the block above the pads
    pad_height = 0.05,      // of the pads
    fill = 0.6,             // contact length over length, above 0 and below 1; n = 1: it is 1
    cells_pad = 8,          // cells along each pad
    cells_gap = 6,          // cells along each gap
    cells_pad_height = 3,   // cells up each pad
    nz = 20,                // cells up the block
    grade_z = 1,            // height of the top cell of the block over that of its lowest
    shape = "quad",         // "quad" or "triangle"
    order = 1,              // 1: Q4, T3; 2: Q9, T6
    incomplete = 0          // 1: order 2 gives Q8 in place of Q9
];

// --- what is allowed ----------------------------------------------------------------------------
If (n < 1 || n != Floor(n))
    Error("n must be a whole number from 1 on, found %g", n);
    Abort;
EndIf
If (length <= 0 || height <= 0 || pad_height <= 0)
    Error("length, height and pad_height must be above 0, found %g, %g and %g", length, height,
          pad_height);
    Abort;
EndIf
If (n > 1 && (fill <= 0 || fill >= 1))
    Error("fill must be above 0 and below 1, found %g", fill);
    Abort;
EndIf
If (cells_pad < 1 || cells_gap < 1 || cells_pad_height < 1 || nz < 1 ||
    cells_pad != Floor(cells_pad) || cells_gap != Floor(cells_gap) ||
    cells_pad_height != Floor(cells_pad_height) || nz != Floor(nz))
    Error(StrCat("cells_pad, cells_gap, cells_pad_height and nz must be whole numbers from 1 on, ",
                 "found %g, %g, %g and %g"),
          cells_pad, cells_gap, cells_pad_height, nz);
    Abort;
EndIf
If (grade_z <= 0)
    Error("grade_z must be above 0 (1: even), found %g", grade_z);
    Abort;
EndIf
If (order != 1 && order != 2)
    Error("order must be 1 or 2, found %g", order);
    Abort;
EndIf
If (incomplete != 0 && incomplete != 1)
    Error("incomplete must be 0 or 1, found %g", incomplete);
    Abort;
EndIf
If (StrCmp(shape, "quad") != 0 && StrCmp(shape, "triangle") != 0)
    Error(StrCat("shape must be quad or triangle, found ", shape));
    Abort;
EndIf

// --- geometry -----------------------------------------------------------------------------------
// Columns k = 0 ... 2 n - 2 are pad, gap, pad, ...; vertical k is left of column k. Points and
// curves are numbered (the number below) * bank + k:
//
//      3 ---- 13 ---- 3    z = top           points 1, 2, 3
//      |              |                      curves 11, 12, 13 along x, 21 and 22 upwards
//     22       2     22    body              surfaces 1 (pads) and 2 (columns of the block)
//      |              |
//      2 ---- 12 ---- 2    z = pad_height
//     21       1     21    pads, k even
//      1 ---- 11 ---- 1    z = 0
bank = 2 * n;
columns = 2 * n - 1;
pad_length = length;
gap_length = 0;
If (n > 1)
    pad_length = fill * length / n;
    gap_length = (1 - fill) * length / (n - 1);
EndIf
ratio_z = 1;
If (nz > 1)
    ratio_z = grade_z ^ (1 / (nz - 1));
EndIf

For k In {0 : columns}
    x = Floor(k / 2) * (pad_length + gap_length) + (k % 2) * pad_length;
    If (k == columns)
        x = length;
    EndIf
    Point(1 * bank + k) = {x, 0, 0};
    Point(2 * bank + k) = {x, pad_height, 0};
    Point(3 * bank + k) = {x, pad_height + height, 0};
    Line(21 * bank + k) = {1 * bank + k, 2 * bank + k};
    Line(22 * bank + k) = {2 * bank + k, 3 * bank + k};
    Transfinite Curve{21 * bank + k} = cells_pad_height + 1;
    Transfinite Curve{22 * bank + k} = nz + 1 Using Progression ratio_z;
EndFor

tops[] = {};
surfaces[] = {};
For k In {0 : columns - 1}
    cells = k % 2 ? cells_gap : cells_pad;
    Line(12 * bank + k) = {2 * bank + k, 2 * bank + k + 1};
    Line(13 * bank + k) = {3 * bank + k, 3 * bank + k + 1};
    Transfinite Curve{12 * bank + k, 13 * bank + k} = cells + 1;
    Curve Loop(2 * bank + k) = {12 * bank + k, 22 * bank + k + 1, -(13 * bank + k),
                                -(22 * bank + k)};
    Plane Surface(2 * bank + k) = {2 * bank + k};
    tops[] += 13 * bank + k;
    surfaces[] += 2 * bank + k;
    If (k % 2 == 0)
        Line(11 * bank + k) = {1 * bank + k, 1 * bank + k + 1};
        Transfinite Curve{11 * bank + k} = cells + 1;
        Curve Loop(bank + k) = {11 * bank + k, 21 * bank + k + 1, -(12 * bank + k),
                                -(21 * bank + k)};
        Plane Surface(bank + k) = {bank + k};
        surfaces[] += bank + k;
        Physical Curve(Sprintf("contact_%g", k / 2 + 1)) = {11 * bank + k};
    EndIf
EndFor

Physical Surface("body") = surfaces[];
Physical Curve("top") = tops[];
Physical Curve("rod") = {22 * bank};
Physical Curve("leading") = {22 * bank + columns};

// --- mesh ---------------------------------------------------------------------------------------
Transfinite Surface{surfaces[]};
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{surfaces[]};
EndIf
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
