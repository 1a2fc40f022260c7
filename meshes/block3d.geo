// SPDX-License-Identifier: GPL-2.0-or-later
// A block in space on a flat substrate, a lower corner at the origin: x along the drive, y across
// it, z up. The contact is the face z = 0, and the rod pushes the face x = 0 towards +x.
//
//            +--------------+
//           /     top      /|
//          +--------------+ |      z  y
//     rod  |     body     | |      | /
//          |              | +      |/
//          +--------------+/       +--- x
//              contact
//
// Physical groups: body (the volume), contact, top, rod (x = 0), leading, left (y = 0) and right
// (surfaces).
//
//   In a scene:   mesh: {file: block3d.geo, set: {nx: 20, ny: 20, nz: 20}}
//   By hand:      gmsh -3 block3d.geo -setnumber nx 20 -setstring shape tet

DefineConstant[
    length = 1,             // extent along x
    breadth = 1,            // extent along y
    height = 0.5,           // extent along z
    nx = 10,                // cells along x
    ny = 10,                // cells along y
    nz = 10,                // cells along z
    shape = "hex",          // "hex", "wedge" (triangles seen from above) or "tet"
    order = 1,              // 1: HEX8, WEDGE6, TET4; 2: HEX27, TET10
    layout = "regular",     // seen from above: "regular": nx x ny cells; "free": unstructured, nx
                            // and ny cells on the sides only, which must be even for hex
    grade_x = 1,            // length of the middle cell over that of the end cells, about
    grade_y = 1,            // the same along y
    grade_z = 1,            // height of the top cell over that of the cell at the contact
    refine = 1              // so many times as many cells along each side, for a study of the mesh
];

// --- what is allowed ----------------------------------------------------------------------------
If (length <= 0 || breadth <= 0 || height <= 0)
    Error("length, breadth and height must be above 0, found %g, %g and %g", length, breadth,
          height);
    Abort;
EndIf
If (nx < 1 || ny < 1 || nz < 1 || nx != Floor(nx) || ny != Floor(ny) || nz != Floor(nz))
    Error("nx, ny and nz must be whole numbers from 1 on, found %g, %g and %g", nx, ny, nz);
    Abort;
EndIf
If (refine <= 0)
    Error("refine must be above 0 (1: as told), found %g", refine);
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
If (StrCmp(shape, "hex") != 0 && StrCmp(shape, "wedge") != 0 && StrCmp(shape, "tet") != 0)
    Error(StrCat("shape must be hex, wedge or tet, found ", shape));
    Abort;
EndIf
If (StrCmp(layout, "regular") != 0 && StrCmp(layout, "free") != 0)
    Error(StrCat("layout must be regular or free, found ", layout));
    Abort;
EndIf
If (StrCmp(shape, "wedge") == 0 && order == 2)
    Error("wedges are of order 1; order 2 goes with hex and tet");
    Abort;
EndIf
nx = refine * nx < 1 ? 1 : Floor(refine * nx + 0.5);
ny = refine * ny < 1 ? 1 : Floor(refine * ny + 0.5);
nz = refine * nz < 1 ? 1 : Floor(refine * nz + 0.5);
If (nx * ny * nz > 1e7)
    Error("%g x %g x %g cells are more than 1e7, which no computer here could step", nx, ny, nz);
    Abort;
EndIf
If (StrCmp(layout, "free") == 0 && StrCmp(shape, "hex") == 0 &&
    (nx != 2 * Floor(nx / 2) || ny != 2 * Floor(ny / 2)))
    Error("nx and ny must be even for a free layout of hexahedra, found %g and %g", nx, ny);
    Abort;
EndIf

// --- the contact, from which the block is drawn upwards -----------------------------------------
Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, breadth, 0};
Point(4) = {0, breadth, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = nx + 1 Using Bump 1 / grade_x;
Transfinite Curve{2, 4} = ny + 1 Using Bump 1 / grade_y;
If (StrCmp(layout, "regular") == 0)
    Transfinite Surface{1} = {1, 2, 3, 4};
EndIf
If (StrCmp(shape, "hex") == 0)
    Recombine Surface{1};
EndIf

// nz heights in geometric progression, the last grade_z times the first.
ratio_z = 1;
If (nz > 1)
    ratio_z = grade_z ^ (1 / (nz - 1));
EndIf
layers[] = {};
heights[] = {};
total = 0;
For k In {1 : nz}
    total = total + ratio_z ^ (k - 1);
EndFor
sum = 0;
For k In {1 : nz}
    sum = sum + ratio_z ^ (k - 1) / total;
    layers[] += {1};
    heights[] += {k == nz ? 1 : sum};
EndFor
If (StrCmp(shape, "tet") == 0)
    made[] = Extrude{0, 0, height}{ Surface{1}; Layers{layers[], heights[]}; };
Else
    made[] = Extrude{0, 0, height}{ Surface{1}; Layers{layers[], heights[]}; Recombine; };
EndIf

Physical Volume("body") = {made[1]};
Physical Surface("contact") = {1};
Physical Surface("top") = {made[0]};
Physical Surface("left") = {made[2]};
Physical Surface("leading") = {made[3]};
Physical Surface("right") = {made[4]};
Physical Surface("rod") = {made[5]};

// --- mesh ---------------------------------------------------------------------------------------
Mesh.Algorithm = 6;                  // frontal; 8 crashes gmsh 4.8
Mesh.RecombinationAlgorithm = 3;     // no triangle is left over where the layout is free
Mesh.ElementOrder = order;
