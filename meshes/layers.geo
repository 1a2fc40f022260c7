// SPDX-License-Identifier: GPL-2.0-or-later
// A block that stands on a layer of another material: a coating, a rubber sole.
//
//               top
//           5---------6
//           |  body   |
//      rod  3---------4  leading
//           |  layer  |
//           1---------2
//             contact
//
// Physical groups: body and layer (surfaces), contact, top, rod (the trailing face of both) and
// leading (curves). Materials of their own: `materials: {layer: {young: 0.1}}` in a scene.
//
//   In a scene:   mesh: {file: layers.geo, set: {layer: 0.1, nz_layer: 4}}

DefineConstant[
    length = 1,             // extent along x
    height = 0.5,           // extent along z, the layer's included
    layer = 0.1,            // height of the layer
    nx = 40,                // cells along x
    nz = 16,                // cells up the body
    nz_layer = 8,           // cells up the layer
    shape = "quad",         // "quad" or "triangle"
    order = 1,              // 1: Q4, T3; 2: Q9, T6
    refine = 1              // so many times as many cells along each side, for a study of the mesh
];

// --- what is allowed ----------------------------------------------------------------------------
If (length <= 0 || layer <= 0 || height <= layer)
    Error("length and layer must be above 0 and height above layer, found %g, %g and %g", length,
          layer, height);
    Abort;
EndIf
If (nx < 1 || nz < 1 || nz_layer < 1 || nx != Floor(nx) || nz != Floor(nz) ||
    nz_layer != Floor(nz_layer))
    Error("nx, nz and nz_layer must be whole numbers from 1 on, found %g, %g and %g", nx, nz,
          nz_layer);
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
If (StrCmp(shape, "quad") != 0 && StrCmp(shape, "triangle") != 0)
    Error(StrCat("shape must be quad or triangle, found ", shape));
    Abort;
EndIf
nx = refine * nx < 1 ? 1 : Floor(refine * nx + 0.5);
nz = refine * nz < 1 ? 1 : Floor(refine * nz + 0.5);
nz_layer = refine * nz_layer < 1 ? 1 : Floor(refine * nz_layer + 0.5);
If (nx * (nz + nz_layer) > 1e7)
    Error("%g x %g cells are more than 1e7, which no computer here could step", nx, nz + nz_layer);
    Abort;
EndIf

// --- geometry -----------------------------------------------------------------------------------
Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {0, layer, 0};
Point(4) = {length, layer, 0};
Point(5) = {0, height, 0};
Point(6) = {length, height, 0};
Line(1) = {1, 2};
Line(2) = {3, 4};
Line(3) = {5, 6};
Line(4) = {1, 3};
Line(5) = {2, 4};
Line(6) = {3, 5};
Line(7) = {4, 6};
Curve Loop(1) = {1, 5, -2, -4};
Curve Loop(2) = {2, 7, -3, -6};
Plane Surface(1) = {1};
Plane Surface(2) = {2};

Physical Surface("layer") = {1};
Physical Surface("body") = {2};
Physical Curve("contact") = {1};
Physical Curve("leading") = {5, 7};
Physical Curve("top") = {3};
Physical Curve("rod") = {4, 6};

// --- mesh ---------------------------------------------------------------------------------------
Transfinite Curve{1, 2, 3} = nx + 1;
Transfinite Curve{4, 5} = nz_layer + 1;
Transfinite Curve{6, 7} = nz + 1;
Transfinite Surface{1, 2};
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{1, 2};
EndIf

Mesh.ElementOrder = order;
