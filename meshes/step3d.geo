// SPDX-License-Identifier: GPL-2.0-or-later
// A block of any shape from a STEP file, read by gmsh's OpenCASCADE, of tetrahedra. It is moved so
// that its lowest, rearmost corner (of the box around it) lies at the origin: x along the drive,
// y across it, z up. What is flat and lies on the box has a name by where it lies.
//
// Physical groups: body (all volumes), contact (z = 0; where it is in several pieces contact_1,
// contact_2, ...), top, rod (x = 0), leading, left (y = 0) and right (surfaces).
//
//   In a scene:   mesh: {file: step3d.geo, set: {file: ../part.step, unit: 1e-3}}
//   By hand:      gmsh -3 step3d.geo -setstring file part.step

DefineConstant[
    file = "part.step",     // the STEP file: an absolute path, or one from the folder of this file
    unit = 1,               // what a unit of the file is in the scene: 1e-3 for a part in mm in SI
    size_contact = 0.1,     // of the cells at the contact, over the height of the block
    size_bulk = 0.2,        // of the cells at the top, over the height
    order = 1,              // 1: TET4, 2: TET10
    refine = 1              // sizes are divided by this, for a study of the mesh
];

// --- what is allowed ----------------------------------------------------------------------------
If (unit <= 0 || size_contact <= 0 || size_bulk <= 0 || refine <= 0)
    Error("unit, size_contact, size_bulk and refine must be above 0, found %g, %g, %g and %g", unit,
          size_contact, size_bulk, refine);
    Abort;
EndIf
If (order != 1 && order != 2)
    Error("order must be 1 or 2, found %g", order);
    Abort;
EndIf

// --- the block ----------------------------------------------------------------------------------
SetFactory("OpenCASCADE");
shape[] = ShapeFromFile(file);
body[] = Volume{:};
If (#body[] == 0)
    Error(StrCat("there is no volume in ", file));
    Abort;
EndIf
If (#body[] > 1)
    body[] = BooleanFragments{ Volume{body[0]}; Delete; }{ Volume{body[{1 : #body[] - 1}]}; Delete; };
EndIf
box[] = BoundingBox Volume{body[]};
length = unit * (box[3] - box[0]);
breadth = unit * (box[4] - box[1]);
height = unit * (box[5] - box[2]);
Translate{-box[0], -box[1], -box[2]}{ Volume{body[]}; }
Dilate{{0, 0, 0}, unit}{ Volume{body[]}; }

// --- names --------------------------------------------------------------------------------------
e = 1e-4 * height;          // boxes are larger than what is in them, by some 1e-7
contact[] = Surface In BoundingBox{-e, -e, -e, length + e, breadth + e, e};
top[] = Surface In BoundingBox{-e, -e, height - e, length + e, breadth + e, height + e};
rod[] = Surface In BoundingBox{-e, -e, -e, e, breadth + e, height + e};
leading[] = Surface In BoundingBox{length - e, -e, -e, length + e, breadth + e, height + e};
left[] = Surface In BoundingBox{-e, -e, -e, length + e, e, height + e};
right[] = Surface In BoundingBox{-e, breadth - e, -e, length + e, breadth + e, height + e};
If (#contact[] == 0)
    Error(StrCat("no flat face lies at the bottom of ", file));
    Abort;
EndIf
corners[] = PointsOf{ Surface{contact[]}; };
place[] = Point{corners[0]};
Translate{0, 0, -place[2]}{ Volume{body[]}; }   // to 0 itself
If (#contact[] == 1)
    Physical Surface("contact") = {contact[]};
Else
    For k In {1 : #contact[]}
        Physical Surface(Sprintf("contact_%g", k)) = {contact[k - 1]};
    EndFor
EndIf
Physical Volume("body") = {body[]};
If (#top[] > 0)
    Physical Surface("top") = {top[]};
EndIf
If (#rod[] > 0)
    Physical Surface("rod") = {rod[]};
EndIf
If (#leading[] > 0)
    Physical Surface("leading") = {leading[]};
EndIf
If (#left[] > 0)
    Physical Surface("left") = {left[]};
EndIf
If (#right[] > 0)
    Physical Surface("right") = {right[]};
EndIf

// --- mesh ---------------------------------------------------------------------------------------
Field[1] = MathEval;
Field[1].F = Sprintf("%.17g + z * %.17g", size_contact * height / refine,
                     (size_bulk - size_contact) / refine);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = order;
Mesh.HighOrderOptimize = 2;          // else cells at a bore may be turned inside out
