// SPDX-License-Identifier: GPL-2.0-or-later
// A block in space on n x m pads. x along the drive, y across it, z up: the pads stand on z = 0, the
// rod pushes the face x = 0 of the block towards +x. From the side (n = 3), and likewise from behind:
//
//                    top
//         +------------------------+   height above the pads
//    rod  |          body          |  leading
//         +----+---+----+---+----+-+
//         |pad |   |pad |   |pad |     pads of pad_height, together fill_x * length long, a gap
//         +----+   +----+   +----+     between neighbours
//
// Physical groups: body and pads (volumes); contact_1 ... contact_(n m), row by row along x, the row
// of least y first; top, rod (the trailing face of the block, without its pads), leading, left and
// right (surfaces).
//
//   In a scene:   mesh: {file: pads3d.geo, set: {n: 3, m: 2, fill_x: 0.5}}
//   By hand:      gmsh -3 pads3d.geo -setnumber n 3

DefineConstant[
    n = 3,                  // pads along x
    m = 2,                  // pads along y
    length = 1,             // of the block, along x
    breadth = 0.6,          // of the block, along y
    height = 0.3,           // of the block above the pads
    pad_height = 0.05,      // of the pads
    fill_x = 0.6,           // part of the length on pads, above 0, up to 1; below 1 where n > 1
    fill_y = 0.6,           // the same along y
    cells_x = 4,            // cells along each pad, and along each gap
    cells_y = 4,            // the same along y
    cells_pad_height = 2,   // cells up each pad
    nz = 6,                 // cells up the block
    grade_z = 1,            // height of the top cell of the block over that of its lowest
    shape = "hex",          // "hex", "wedge" or "tet"
    order = 1,              // 1: HEX8, WEDGE6, TET4; 2: HEX27, TET10
    refine = 1              // so many times as many cells along each side, for a study of the mesh
];

// --- what is allowed ----------------------------------------------------------------------------
If (n < 1 || m < 1 || n > 1000 || m > 1000 || n != Floor(n) || m != Floor(m))
    Error("n and m must be whole numbers from 1 to 1000, found %g and %g", n, m);
    Abort;
EndIf
If (length <= 0 || breadth <= 0 || height <= 0 || pad_height <= 0)
    Error("length, breadth, height and pad_height must be above 0, found %g, %g, %g and %g", length,
          breadth, height, pad_height);
    Abort;
EndIf
If (fill_x <= 0 || fill_y <= 0 || fill_x > 1 || fill_y > 1 || (n > 1 && fill_x == 1) ||
    (m > 1 && fill_y == 1))
    Error("fill_x and fill_y must be above 0 and below 1, found %g and %g", fill_x, fill_y);
    Abort;
EndIf
If (cells_x < 1 || cells_y < 1 || cells_pad_height < 1 || nz < 1 || cells_x != Floor(cells_x) ||
    cells_y != Floor(cells_y) || cells_pad_height != Floor(cells_pad_height) || nz != Floor(nz))
    Error(StrCat("cells_x, cells_y, cells_pad_height and nz must be whole numbers from 1 on, found ",
                 "%g, %g, %g and %g"),
          cells_x, cells_y, cells_pad_height, nz);
    Abort;
EndIf
If (grade_z <= 0 || grade_z > 1e6)
    Error("grade_z must be above 0 (1: even) and at most 1e6, found %g", grade_z);
    Abort;
EndIf
If (order != 1 && order != 2)
    Error("order must be 1 or 2, found %g", order);
    Abort;
EndIf
If (refine <= 0)
    Error("refine must be above 0 (1: as told), found %g", refine);
    Abort;
EndIf
If (StrCmp(shape, "hex") != 0 && StrCmp(shape, "wedge") != 0 && StrCmp(shape, "tet") != 0)
    Error(StrCat("shape must be hex, wedge or tet, found ", shape));
    Abort;
EndIf
If (StrCmp(shape, "wedge") == 0 && order == 2)
    Error("wedges are of order 1; order 2 goes with hex and tet");
    Abort;
EndIf
cells_x = refine * cells_x < 1 ? 1 : Floor(refine * cells_x + 0.5);
cells_y = refine * cells_y < 1 ? 1 : Floor(refine * cells_y + 0.5);
cells_pad_height = refine * cells_pad_height < 1 ? 1 : Floor(refine * cells_pad_height + 0.5);
nz = refine * nz < 1 ? 1 : Floor(refine * nz + 0.5);
If (n * m * cells_x * cells_y * (nz + cells_pad_height) > 1e7)
    Error("%g x %g pads of %g x %g cells are more than 1e7 cells", n, m, cells_x, cells_y);
    Abort;
EndIf

// --- where pads begin and end -------------------------------------------------------------------
// Along an axis pads and gaps take turns from 0 on; one pad stands in the middle. Stretch k reaches
// from xs[k] to xs[k + 1]; solid_x[k]: 1 for a pad.
xs[] = {0};
solid_x[] = {};
If (n == 1 && fill_x < 1)
    xs[] += {length * (1 - fill_x) / 2, length * (1 + fill_x) / 2, length};
    solid_x[] = {0, 1, 0};
ElseIf (n == 1)
    xs[] += {length};
    solid_x[] = {1};
Else
    For k In {1 : n}
        at = (k - 1) * length * (1 - fill_x) / (n - 1) + k * length * fill_x / n;
        xs[] += {k == n ? length : at};
        solid_x[] += {1};
        If (k < n)
            xs[] += {at + length * (1 - fill_x) / (n - 1)};
            solid_x[] += {0};
        EndIf
    EndFor
EndIf
ys[] = {0};
solid_y[] = {};
If (m == 1 && fill_y < 1)
    ys[] += {breadth * (1 - fill_y) / 2, breadth * (1 + fill_y) / 2, breadth};
    solid_y[] = {0, 1, 0};
ElseIf (m == 1)
    ys[] += {breadth};
    solid_y[] = {1};
Else
    For k In {1 : m}
        at = (k - 1) * breadth * (1 - fill_y) / (m - 1) + k * breadth * fill_y / m;
        ys[] += {k == m ? breadth : at};
        solid_y[] += {1};
        If (k < m)
            ys[] += {at + breadth * (1 - fill_y) / (m - 1)};
            solid_y[] += {0};
        EndIf
    EndFor
EndIf
columns = #solid_x[];
rows = #solid_y[];

// --- the underside of the block, from which pads go down and the block up -----------------------
bank = (columns + 1) * (rows + 1);      // points k + (columns + 1) j; curves along x and y; surfaces
For j In {0 : rows}
    For k In {0 : columns}
        Point(1 + k + (columns + 1) * j) = {xs[k], ys[j], pad_height};
    EndFor
EndFor
For j In {0 : rows}
    For k In {0 : columns - 1}
        at = 1 + k + (columns + 1) * j;
        Line(at) = {at, at + 1};
        Transfinite Curve{at} = cells_x + 1;
    EndFor
EndFor
For j In {0 : rows - 1}
    For k In {0 : columns}
        at = 1 + k + (columns + 1) * j;
        Line(bank + at) = {at, at + columns + 1};
        Transfinite Curve{bank + at} = cells_y + 1;
    EndFor
EndFor
For j In {0 : rows - 1}
    For k In {0 : columns - 1}
        at = 1 + k + (columns + 1) * j;
        Curve Loop(at) = {at, bank + at + 1, -(at + columns + 1), -(bank + at)};
        Plane Surface(at) = {at};
        Transfinite Surface{at};
        If (StrCmp(shape, "hex") == 0)
            Recombine Surface{at};
        EndIf
    EndFor
EndFor

// nz heights in geometric progression, the last grade_z times the first.
ratio_z = 1;
If (nz > 1)
    ratio_z = grade_z ^ (1 / (nz - 1));
EndIf
total = 0;
For k In {1 : nz}
    total = total + ratio_z ^ (k - 1);
EndFor
layers[] = {};
heights[] = {};
sum = 0;
For k In {1 : nz}
    sum = sum + ratio_z ^ (k - 1) / total;
    layers[] += {1};
    heights[] += {k == nz ? 1 : sum};
EndFor

body[] = {};
pads[] = {};
tops[] = {};
trailing[] = {};
ahead[] = {};
lefts[] = {};
rights[] = {};
number = 0;
For j In {0 : rows - 1}
    For k In {0 : columns - 1}
        at = 1 + k + (columns + 1) * j;
        If (StrCmp(shape, "tet") == 0)
            up[] = Extrude{0, 0, height}{ Surface{at}; Layers{layers[], heights[]}; };
        Else
            up[] = Extrude{0, 0, height}{ Surface{at}; Layers{layers[], heights[]}; Recombine; };
        EndIf
        tops[] += {up[0]};
        body[] += {up[1]};
        If (j == 0)
            lefts[] += {up[2]};
        EndIf
        If (k == columns - 1)
            ahead[] += {up[3]};
        EndIf
        If (j == rows - 1)
            rights[] += {up[4]};
        EndIf
        If (k == 0)
            trailing[] += {up[5]};
        EndIf
        If (solid_x[k] && solid_y[j])
            number = number + 1;
            If (StrCmp(shape, "tet") == 0)
                down[] = Extrude{0, 0, -pad_height}{ Surface{at}; Layers{cells_pad_height}; };
            Else
                down[] = Extrude{0, 0, -pad_height}{ Surface{at}; Layers{cells_pad_height}; Recombine; };
            EndIf
            pads[] += {down[1]};
            Physical Surface(Sprintf("contact_%g", number)) = {down[0]};
        EndIf
    EndFor
EndFor

Physical Volume("body") = body[];
Physical Volume("pads") = pads[];
Physical Surface("top") = tops[];
Physical Surface("rod") = trailing[];
Physical Surface("leading") = ahead[];
Physical Surface("left") = lefts[];
Physical Surface("right") = rights[];

// --- mesh ---------------------------------------------------------------------------------------
Mesh.ElementOrder = order;
