// SPDX-License-Identifier: GPL-2.0-or-later
// A block with shallow grooves across its contact face. gmsh's y is the z of amontons: the block
// lies on y = 0, the rod pushes the face x = 0 towards +x. Here for grooves = 2:
//
//                       top
//          +---------------------------+
//    rod   |           body            |  leading
//          |                           |
//          |       ___         ___     |    depth;  floor: width of a groove at its upper end
//          +------/   \-------/   \----+    width of a groove at the contact
//          contact_1  contact_2  contact_3
//
// Contacts are equally long, grooves too; the block begins and ends with a contact. Walls are
// straight where floor = width (then the block stands on pads: pads.geo meshes that in rows);
// floor = 0 makes grooves pointed. Unstructured.
//
// Physical groups: body (the surface), contact_1 ... contact_(grooves + 1) by ascending x, top, rod
// (the trailing face) and leading (curves).
//
//   In a scene:   mesh: {file: grooves.geo, set: {grooves: 3, width: 0.05, depth: 0.03}}

DefineConstant[
    grooves = 2,            // 0: a plain block
    length = 1,             // of the block, along x
    height = 0.5,           // of the block, along z
    width = 0.05,           // of each groove at the contact
    floor = 0.03,           // of each groove at its upper end; 0: pointed
    depth = 0.03,           // of the grooves
    size_contact = 0.02,    // of the cells at the contact and in the grooves
    size_bulk = 0.05,       // of the cells at the top
    grade_contact = 1,      // length of a contact's middle cell over that of its end cells, where
                            // stress is singular; their mean is size_contact
    refine = 1,             // sizes are divided and grade_contact is multiplied by this, for a
                            // study of the mesh
    shape = "quad",         // "quad" or "triangle"
    order = 1,              // 1: Q4, T3; 2: Q9, T6
    incomplete = 0          // 1: order 2 gives Q8 in place of Q9
];

// --- what is allowed ----------------------------------------------------------------------------
If (grooves < 0 || grooves != Floor(grooves))
    Error("grooves must be a whole number from 0 on, found %g", grooves);
    Abort;
EndIf
If (length <= 0 || height <= 0)
    Error("length and height must be above 0, found %g and %g", length, height);
    Abort;
EndIf
If (width <= 0 || grooves * width >= length)
    Error("width must be above 0 and leave contacts between %g grooves in a length of %g, found %g",
          grooves, length, width);
    Abort;
EndIf
If (floor < 0 || floor > width)
    Error("floor must be from 0 (pointed) to width = %g (straight walls), found %g", width, floor);
    Abort;
EndIf
If (depth <= 0 || depth >= height)
    Error("depth must be above 0 and below height = %g, found %g", height, depth);
    Abort;
EndIf
If (grade_contact < 1 || refine <= 0)
    Error("grade_contact must be from 1 on and refine above 0, found %g and %g", grade_contact,
          refine);
    Abort;
EndIf
If (size_contact <= 0 || size_bulk <= 0)
    Error("size_contact and size_bulk must be above 0, found %g and %g", size_contact, size_bulk);
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

size_contact = size_contact / refine;
size_bulk = size_bulk / refine;
grade = refine * grade_contact > 1 ? refine * grade_contact : 1;
If (floor > 0 && size_contact > floor)
    Error("size_contact / refine must be at most floor = %g (or floor = 0: pointed grooves), found %g",
          floor, size_contact);
    Abort;
EndIf

// --- the outline, its underside from x = 0 to x = length ----------------------------------------
contact_length = (length - grooves * width) / (grooves + 1);
If (size_contact > contact_length / 2)
    Error("size_contact / refine must be at most half of a contact, which is %g long, found %g",
          contact_length, size_contact);
    Abort;
EndIf
// The end cells of a contact of cells that follow a parabola (Bump) with a mean of size_contact.
size_end = size_contact;
If (grade > 1)
    bend = Sqrt(1 - 1 / grade);
    size_end = size_contact / grade * Log((1 + bend) / (1 - bend)) / (2 * bend);
EndIf
cells = 2 * Floor(contact_length / size_contact / 2 + 0.5);     // even, as quads want it
walk[] = {};
first = newp;
Point(first) = {0, 0, 0, size_end};
here = first;
For k In {0 : grooves}
    left = k * (contact_length + width);
    right = k < grooves ? left + contact_length : length;
    edge = newp;
    Point(edge) = {right, 0, 0, size_end};
    base = newl;
    Line(base) = {here, edge};
    If (grade > 1)
        Transfinite Curve{base} = cells + 1 Using Bump 1 / grade;
    EndIf
    walk[] += base;
    Physical Curve(Sprintf("contact_%g", k + 1)) = {base};
    here = edge;
    If (k < grooves)
        middle = right + width / 2;
        up = newp;
        Point(up) = {middle - floor / 2, depth, 0, size_contact};
        wall = newl;
        Line(wall) = {here, up};
        walk[] += wall;
        here = up;
        If (floor > 0)
            over = newp;
            Point(over) = {middle + floor / 2, depth, 0, size_contact};
            ridge = newl;
            Line(ridge) = {here, over};
            walk[] += ridge;
            here = over;
        EndIf
        down = newp;
        Point(down) = {right + width, 0, 0, size_end};
        wall = newl;
        Line(wall) = {here, down};
        walk[] += wall;
        here = down;
    EndIf
EndFor
upper_right = newp;
Point(upper_right) = {length, height, 0, size_bulk};
upper_left = newp;
Point(upper_left) = {0, height, 0, size_bulk};
face = newl;
Line(face) = {here, upper_right};
ceiling = newl;
Line(ceiling) = {upper_right, upper_left};
trailing = newl;
Line(trailing) = {upper_left, first};
outline = newll;
Curve Loop(outline) = {walk[], face, ceiling, trailing};
whole = news;
Plane Surface(whole) = {outline};

Physical Surface("body") = {whole};
Physical Curve("leading") = {face};
Physical Curve("top") = {ceiling};
Physical Curve("rod") = {trailing};

// --- mesh ---------------------------------------------------------------------------------------
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{whole};
EndIf
Mesh.Algorithm = 6;                  // frontal; 8 crashes gmsh 4.8
Mesh.RecombinationAlgorithm = 3;     // no triangle is left over
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
