// SPDX-License-Identifier: GPL-2.0-or-later
// A block in space on a plate that deforms: two bodies that share no point, so that the block may
// slide. The block is that of block3d.geo, with the same groups; the plate lies below z = 0 and
// reaches as far beyond the block on each side.
//
// Physical groups: body and base (volumes), contact, top, rod (x = 0), leading, left (y = 0), right,
// floor (the plate's upper side), bottom and base_rear (the plate's side towards -x; surfaces).
//
//   In a scene:   mesh: {file: base3d.geo, set: {nx: 12, ny: 12, nz: 12}}
//                 load: {supports: [{group: bottom, direction: all}]}

DefineConstant[
    length = 1,             // extent of the block along x
    breadth = 1,            // extent of the block along y
    height = 0.5,           // extent of the block along z
    base_height = 0.5,      // extent of the plate along z
    margin = 0.5,           // how far the plate reaches beyond the block
    nx = 8,                 // cells of the block along x
    ny = 8,                 // cells of the block along y
    nz = 6,                 // cells of the block along z
    ratio = 1,              // cells of the floor to a cell of the contact; 1: their nodes match
    shape = "hex",          // "hex" or "tet"
    order = 1,              // 1: HEX8, TET4; 2: HEX27, TET10
    grade_x = 1,            // length of the middle cell of the contact over that of its end cells, about
    grade_y = 1,            // the same along y
    grade_z = 1,            // height of a cell far from the contact over that of one at it
    refine = 1              // so many times as many cells along each side, for a study of the mesh
];

// --- what is allowed ----------------------------------------------------------------------------
If (length <= 0 || breadth <= 0 || height <= 0 || base_height <= 0)
    Error("length, breadth, height and base_height must be above 0, found %g, %g, %g and %g",
          length, breadth, height, base_height);
    Abort;
EndIf
If (margin < 0)
    Error("margin must be from 0 on, found %g", margin);
    Abort;
EndIf
If (nx < 1 || ny < 1 || nz < 1 || nx != Floor(nx) || ny != Floor(ny) || nz != Floor(nz))
    Error("nx, ny and nz must be whole numbers from 1 on, found %g, %g and %g", nx, ny, nz);
    Abort;
EndIf
If (ratio <= 0 || refine <= 0)
    Error("ratio and refine must be above 0, found %g and %g", ratio, refine);
    Abort;
EndIf
If (order != 1 && order != 2)
    Error("order must be 1 or 2, found %g", order);
    Abort;
EndIf
If (grade_x <= 0 || grade_y <= 0 || grade_z <= 0 || grade_x > 1e6 || grade_y > 1e6 || grade_z > 1e6)
    Error("grade_x, grade_y and grade_z must be above 0 (1: even) and at most 1e6, found %g, %g, %g",
          grade_x, grade_y, grade_z);
    Abort;
EndIf
If (StrCmp(shape, "hex") != 0 && StrCmp(shape, "tet") != 0)
    Error(StrCat("shape must be hex or tet, found ", shape));
    Abort;
EndIf
nx = refine * nx < 1 ? 1 : Floor(refine * nx + 0.5);
ny = refine * ny < 1 ? 1 : Floor(refine * ny + 0.5);
nz = refine * nz < 1 ? 1 : Floor(refine * nz + 0.5);
mx = ratio * nx < 1 ? 1 : Floor(ratio * nx + 0.5);
my = ratio * ny < 1 ? 1 : Floor(ratio * ny + 0.5);
deep = base_height / height * ratio * nz;
deep = deep < 1 ? 1 : Floor(deep + 0.5);
beside_x = margin / length * mx < 1 ? 1 : Floor(margin / length * mx + 0.5);
beside_y = margin / breadth * my < 1 ? 1 : Floor(margin / breadth * my + 0.5);
cells = nx * ny * nz + (mx + 2 * beside_x) * (my + 2 * beside_y) * deep;
If (cells > 1e7)
    Error("%g cells are more than 1e7, which no computer here could step", cells);
    Abort;
EndIf

faces[] = {};
base[] = {};
floor[] = {};
bottom[] = {};
rear[] = {};

// --- both bodies, as boxes between places along x, y and z ------------------------------------------
// Body 1 is the block, body 2 the plate: what lies below the block, and a margin around it. Nothing
// is extruded: gmsh would make one point of two that stand at one place.
x~{1}[] = {0, length};
y~{1}[] = {0, breadth};
z~{1}[] = {0, height};
cells_x~{1}[] = {nx};
cells_y~{1}[] = {ny};
cells_z~{1} = nz;
If (margin > 0)
    x~{2}[] = {-margin, 0, length, length + margin};
    y~{2}[] = {-margin, 0, breadth, breadth + margin};
    cells_x~{2}[] = {beside_x, mx, beside_x};
    cells_y~{2}[] = {beside_y, my, beside_y};
Else
    x~{2}[] = {0, length};
    y~{2}[] = {0, breadth};
    cells_x~{2}[] = {mx};
    cells_y~{2}[] = {my};
EndIf
z~{2}[] = {0, -base_height};
cells_z~{2} = deep;
For body In {1 : 2}
    I = #x~{body}[] - 1;   // boxes along x, and along y
    J = #y~{body}[] - 1;
    all = 10000 * body;
    under = body == 2 && margin > 0 ? 1 : 0;   // the boxes that the block covers
    growth = cells_z~{body} > 1 ? grade_z ^ (1 / (cells_z~{body} - 1)) : 1;
    For k In {0 : 1}
        For j In {0 : J}
            For i In {0 : I}
                Point(all + 100 * k + 10 * j + i) = {x~{body}[i], y~{body}[j], z~{body}[k]};
            EndFor
        EndFor
    EndFor
    For k In {0 : 1}   // lines along x, then along y
        For j In {0 : J}
            For i In {0 : I - 1}
                n = all + 100 * k + 10 * j + i;
                Line(n) = {n, n + 1};
                Transfinite Curve {n} = cells_x~{body}[i] + 1 Using Bump (i == under ? 1 / grade_x : 1);
            EndFor
        EndFor
        For j In {0 : J - 1}
            For i In {0 : I}
                n = all + 100 * k + 10 * j + i;
                Line(3000 + n) = {n, n + 10};
                Transfinite Curve {3000 + n} = cells_y~{body}[j] + 1
                                               Using Bump (j == under ? 1 / grade_y : 1);
            EndFor
        EndFor
    EndFor
    For j In {0 : J}   // and away from the contact
        For i In {0 : I}
            n = all + 10 * j + i;
            Line(6000 + n) = {n, n + 100};
            Transfinite Curve {6000 + n} = cells_z~{body} + 1 Using Progression growth;
        EndFor
    EndFor
    For k In {0 : 1}   // level faces
        For j In {0 : J - 1}
            For i In {0 : I - 1}
                n = all + 100 * k + 10 * j + i;
                Curve Loop(n) = {n, 3001 + n, -(10 + n), -(3000 + n)};
                Plane Surface(n) = {n};
                Transfinite Surface {n};
                faces[] += {n};
            EndFor
        EndFor
    EndFor
    For j In {0 : J - 1}   // faces across x
        For i In {0 : I}
            n = all + 10 * j + i;
            Curve Loop(3000 + n) = {3000 + n, 6010 + n, -(3100 + n), -(6000 + n)};
            Plane Surface(3000 + n) = {3000 + n};
            Transfinite Surface {3000 + n};
            faces[] += {3000 + n};
        EndFor
    EndFor
    For j In {0 : J}   // faces across y
        For i In {0 : I - 1}
            n = all + 10 * j + i;
            Curve Loop(6000 + n) = {n, 6001 + n, -(100 + n), -(6000 + n)};
            Plane Surface(6000 + n) = {6000 + n};
            Transfinite Surface {6000 + n};
            faces[] += {6000 + n};
        EndFor
    EndFor
    For j In {0 : J - 1}
        For i In {0 : I - 1}
            n = all + 10 * j + i;
            Surface Loop(n) = {n, 100 + n, 3000 + n, 3001 + n, 6000 + n, 6010 + n};
            Volume(n) = {n};
            Transfinite Volume {n};
            If (body == 2)
                base[] += {n};
                floor[] += {n};
                bottom[] += {100 + n};
                If (i == 0)
                    rear[] += {3000 + n};
                EndIf
            EndIf
        EndFor
    EndFor
EndFor
If (StrCmp(shape, "hex") == 0)
    Recombine Surface {faces[]};
EndIf

Physical Volume("body") = {10000};
Physical Surface("contact") = {10000};
Physical Surface("top") = {10100};
Physical Surface("rod") = {13000};
Physical Surface("leading") = {13001};
Physical Surface("left") = {16000};
Physical Surface("right") = {16010};
Physical Volume("base") = {base[]};
Physical Surface("floor") = {floor[]};
Physical Surface("bottom") = {bottom[]};
Physical Surface("base_rear") = {rear[]};

Mesh.ElementOrder = order;
