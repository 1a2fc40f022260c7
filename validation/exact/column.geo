// SPDX-License-Identifier: GPL-2.0-or-later
// A layer of rows of cells. Every row but the lowest nodes is held along z (group "rows"), so that
// it can only shear, as an endless layer; the contact nodes are left free to press. At the two ends
// the shear of the lowest row has no neighbour to lean on: an error of one cell in nx.
//
//      +---+---+---+---+  top: row nz
//      +---+---+---+---+  rows: 1 ... nz
//      +---+---+---+---+  contact: row 0
DefineConstant[ width = 0.5, height = 1, nx = 16, nz = 32, shape = "quad" ];
For j In {0 : nz}
    Point(2 * j + 1) = {0, height * j / nz, 0};
    Point(2 * j + 2) = {width, height * j / nz, 0};
    Line(3 * j + 1) = {2 * j + 1, 2 * j + 2};
    Transfinite Curve{3 * j + 1} = nx + 1;
EndFor
rows[] = {};
surfaces[] = {};
For j In {1 : nz}
    Line(3 * j + 2) = {2 * j - 1, 2 * j + 1};
    Line(3 * j + 3) = {2 * j, 2 * j + 2};
    Transfinite Curve{3 * j + 2, 3 * j + 3} = 2;
    Curve Loop(j) = {3 * j - 2, 3 * j + 3, -(3 * j + 1), -(3 * j + 2)};
    Plane Surface(j) = {j};
    rows[] += 3 * j + 1;
    surfaces[] += j;
EndFor
Physical Surface("body") = surfaces[];
Physical Curve("contact") = {1};
Physical Curve("rows") = rows[];
Physical Curve("top") = {3 * nz + 1};
Transfinite Surface{surfaces[]};
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{surfaces[]};
EndIf
