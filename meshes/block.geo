// SPDX-License-Identifier: GPL-2.0-or-later
// A rectangular block on a flat substrate, its lower left corner at the origin. gmsh's y is the z
// of amontons: the contact line is y = 0, and the rod pushes the face x = 0 towards +x.
//
//               top
//           4---------3
//      rod  |  body   |  leading
//           1---------2
//             contact
//
// Physical groups: body (the surface), contact, top, rod (the trailing face) and leading (curves).
//
//   In a scene:   mesh: {file: block.geo, set: {nx: 80, nz: 80, shape: quad}}
//   By hand:      gmsh -2 block.geo -setnumber nx 80 -setstring shape triangle

DefineConstant[
    length = 1,             // extent along x
    height = 0.5,           // extent along z
    nx = 40,                // cells along x
    nz = 40,                // cells along z
    shape = "quad",         // "quad" or "triangle"
    order = 1,              // 1: Q4, T3; 2: Q9, T6
    incomplete = 0,         // 1: order 2 gives Q8 in place of Q9
    layout = "regular",     // "regular": nx x nz cells, a triangle being half a cell
                            // "alternate": as regular, but the diagonals of triangles alternate
                            // "free": unstructured; nx and nz cells on the sides only, which
                            // must be even for quads
    crown = 0,              // how much higher the ends of the contact lie than its middle, which
                            // touches the substrate: a parabola of radius length^2 / (8 crown)
    edge_radius = 0,        // of a rounded trailing edge, a parabola; 0: sharp
    edge_length = 0.2,      // how far along x it goes, where it is round
    grade_x = 1,            // length of the middle cell over that of the end cells, about
    grade_z = 1,            // height of the top cell over that of the cell at the contact
    refine = 1              // so many times as many cells along each side, for a study of the mesh
];

// --- what is allowed ----------------------------------------------------------------------------
If (length <= 0 || height <= 0)
    Error("length and height must be above 0, found %g and %g", length, height);
    Abort;
EndIf
If (nx < 1 || nz < 1 || nx != Floor(nx) || nz != Floor(nz))
    Error("nx and nz must be whole numbers from 1 on, found %g and %g", nx, nz);
    Abort;
EndIf
If (refine <= 0)
    Error("refine must be above 0 (1: as told), found %g", refine);
    Abort;
EndIf
If (crown < 0 || crown >= height)
    Error("crown must be from 0 on and below height = %g, found %g", height, crown);
    Abort;
EndIf
If (edge_radius < 0)
    Error("edge_radius must be above 0 (0: a sharp edge), found %g", edge_radius);
    Abort;
EndIf
edge_height = 0;
If (edge_length <= 0 || (edge_radius > 0 && edge_length >= length))
    Error("edge_length must be above 0 and below length = %g, found %g", length, edge_length);
    Abort;
EndIf
If (edge_radius > 0)
    edge_height = edge_length ^ 2 / (2 * edge_radius);
    If (edge_height >= height)
        Error("the rounded edge is %g high (edge_length^2 / (2 edge_radius)), the block %g",
              edge_height, height);
        Abort;
    EndIf
    If (crown > 0 || grade_x != 1)
        Error("edge_radius goes without crown and grade_x, found %g and %g", crown, grade_x);
        Abort;
    EndIf
EndIf
If (order != 1 && order != 2)
    Error("order must be 1 or 2, found %g", order);
    Abort;
EndIf
If (incomplete != 0 && incomplete != 1)
    Error("incomplete must be 0 or 1, found %g", incomplete);
    Abort;
EndIf
If (grade_x <= 0 || grade_z <= 0 || grade_x > 1e6 || grade_z > 1e6)
    Error("grade_x and grade_z must be above 0 (1: even) and at most 1e6, found %g and %g", grade_x,
          grade_z);
    Abort;
EndIf
If (StrCmp(shape, "quad") != 0 && StrCmp(shape, "triangle") != 0)
    Error(StrCat("shape must be quad or triangle, found ", shape));
    Abort;
EndIf
If (StrCmp(layout, "regular") != 0 && StrCmp(layout, "alternate") != 0 &&
    StrCmp(layout, "free") != 0)
    Error(StrCat("layout must be regular, alternate or free, found ", layout));
    Abort;
EndIf
nx = refine * nx < 1 ? 1 : Floor(refine * nx + 0.5);
nz = refine * nz < 1 ? 1 : Floor(refine * nz + 0.5);
If (edge_radius > 0 && nx < 2)
    Error("a rounded edge needs two cells along x, found %g", nx);
    Abort;
EndIf
If (nx * nz > 1e7)
    Error("%g x %g cells are more than 1e7, which no computer here could step", nx, nz);
    Abort;
EndIf
If (StrCmp(layout, "free") == 0 && StrCmp(shape, "quad") == 0 &&
    (nx != 2 * Floor(nx / 2) || nz != 2 * Floor(nz / 2)))
    Error("nx and nz must be even for a free layout of quads, found %g and %g", nx, nz);
    Abort;
EndIf

// --- geometry -----------------------------------------------------------------------------------
Point(1) = {0, crown + edge_height, 0};
Point(2) = {length, crown, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
If (crown > 0)
    Point(5) = {length / 2, -crown, 0};
    Bezier(1) = {1, 5, 2};
ElseIf (edge_radius > 0)
    Point(5) = {edge_length / 2, 0, 0};
    Point(6) = {edge_length, 0, 0};
    Bezier(1) = {1, 5, 6};
    Line(5) = {6, 2};
Else
    Line(1) = {1, 2};
EndIf
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
below[] = {1};   // the contact
If (edge_radius > 0)
    below[] += {5};
EndIf
Curve Loop(1) = {below[], 2, 3, 4};
Plane Surface(1) = {1};

Physical Surface("body") = {1};
Physical Curve("contact") = {below[]};
Physical Curve("leading") = {2};
Physical Curve("top") = {3};
Physical Curve("rod") = {4};

// --- mesh ---------------------------------------------------------------------------------------
// nz heights in geometric progression, the last grade_z times the first.
ratio_z = 1;
If (nz > 1)
    ratio_z = grade_z ^ (1 / (nz - 1));
EndIf
Transfinite Curve{1, 3} = nx + 1 Using Bump 1 / grade_x;
If (edge_radius > 0)
    nx_edge = Floor(nx * edge_length / length + 0.5);
    nx_edge = nx_edge < 1 ? 1 : (nx_edge < nx ? nx_edge : nx - 1);
    Transfinite Curve{1} = nx_edge + 1;
    Transfinite Curve{5} = nx - nx_edge + 1;
EndIf
Transfinite Curve{2, -4} = nz + 1 Using Progression ratio_z;

If (StrCmp(layout, "regular") == 0)
    Transfinite Surface{1} = {1, 2, 3, 4};
EndIf
If (StrCmp(layout, "alternate") == 0)
    Transfinite Surface{1} = {1, 2, 3, 4} Alternate;
EndIf
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{1};
EndIf

Mesh.Algorithm = 6;                  // frontal; 8 crashes gmsh 4.8
Mesh.RecombinationAlgorithm = 3;     // no triangle is left over where the layout is free
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
