// SPDX-License-Identifier: GPL-2.0-or-later
// A block in space with shallow grooves in its contact face, across the drive or along it: x along
// the drive, y across, z up. The block lies on z = 0, the rod pushes the face x = 0 towards +x. A
// section of it, for grooves = 2, is that of grooves.geo:
//
//          +---------------------------+
//          |           body            |
//          |       ___         ___     |    depth;  floor: width of a groove at its upper end
//          +------/   \-------/   \----+    width of a groove at the contact
//          contact_1  contact_2  contact_3
//
// Contacts are equally wide, grooves too; the block begins and ends with a contact. floor = 0 makes
// grooves pointed. The section is unstructured, and the same all the way.
//
// Physical groups: body (the volume), contact_1 ... contact_(grooves + 1) by ascending x or y, top,
// rod (x = 0), leading, left (y = 0) and right (surfaces).
//
//   In a scene:   mesh: {file: grooves3d.geo, set: {grooves: 3, direction: along}}

DefineConstant[
    grooves = 2,            // 0: a plain block
    direction = "across",   // "across" the drive: grooves along y; "along" it: along x
    length = 1,             // of the block, along x
    breadth = 0.6,          // along y
    height = 0.3,           // along z
    width = 0.05,           // of each groove at the contact
    floor = 0.05,           // of each groove at its upper end; 0: pointed
    depth = 0.03,           // of the grooves
    size_contact = 0.04,    // of the cells at the contact and in the grooves
    size_bulk = 0.08,       // of the cells at the top
    cells = 10,             // along the grooves
    refine = 1,             // sizes are divided and cells multiplied by this, for a study of the mesh
    shape = "hex",          // "hex", "wedge" (lying on a side) or "tet"
    order = 1               // 1: HEX8, WEDGE6, TET4; 2: HEX27, TET10
];

// --- what is allowed ----------------------------------------------------------------------------
If (StrCmp(direction, "across") != 0 && StrCmp(direction, "along") != 0)
    Error(StrCat("direction must be across or along, found ", direction));
    Abort;
EndIf
across = StrCmp(direction, "across") == 0;
span = across ? length : breadth;       // over which grooves are spread
way = across ? breadth : length;        // along which they run
If (grooves < 0 || grooves != Floor(grooves))
    Error("grooves must be a whole number from 0 on, found %g", grooves);
    Abort;
EndIf
If (length <= 0 || breadth <= 0 || height <= 0)
    Error("length, breadth and height must be above 0, found %g, %g and %g", length, breadth, height);
    Abort;
EndIf
If (width <= 0 || grooves * width >= span)
    Error("width must be above 0 and leave contacts between %g grooves in %g, found %g", grooves, span,
          width);
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
If (size_contact <= 0 || size_bulk <= 0 || refine <= 0)
    Error("size_contact, size_bulk and refine must be above 0, found %g, %g and %g", size_contact,
          size_bulk, refine);
    Abort;
EndIf
If (cells < 1 || cells != Floor(cells))
    Error("cells must be a whole number from 1 on, found %g", cells);
    Abort;
EndIf
If (order != 1 && order != 2)
    Error("order must be 1 or 2, found %g", order);
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
size_contact = size_contact / refine;
size_bulk = size_bulk / refine;
cells = refine * cells < 1 ? 1 : Floor(refine * cells + 0.5);
contact_width = (span - grooves * width) / (grooves + 1);
If (size_contact > contact_width / 2 || (floor > 0 && size_contact > floor))
    Error("size_contact / refine must be at most half of a contact (%g wide) and floor = %g, found %g",
          contact_width, floor, size_contact);
    Abort;
EndIf

// --- the section, its underside from one side to the other --------------------------------------
// s along the span. touching[]: places of the contacts in the walk.
walk[] = {};
touching[] = {};
first = newp;
Point(first) = {0, 0, 0, size_contact};
here = first;
For k In {0 : grooves}
    left = k * (contact_width + width);
    s = k < grooves ? left + contact_width : span;
    edge = newp;
    Point(edge) = {across ? s : 0, across ? 0 : s, 0, size_contact};
    base = newl;
    Line(base) = {here, edge};
    touching[] += #walk[];
    walk[] += base;
    here = edge;
    If (k < grooves)
        s = left + contact_width + (width - floor) / 2;
        up = newp;
        Point(up) = {across ? s : 0, across ? 0 : s, depth, size_contact};
        wall = newl;
        Line(wall) = {here, up};
        walk[] += wall;
        here = up;
        If (floor > 0)
            s = s + floor;
            over = newp;
            Point(over) = {across ? s : 0, across ? 0 : s, depth, size_contact};
            ridge = newl;
            Line(ridge) = {here, over};
            walk[] += ridge;
            here = over;
        EndIf
        s = left + contact_width + width;
        down = newp;
        Point(down) = {across ? s : 0, across ? 0 : s, 0, size_contact};
        wall = newl;
        Line(wall) = {here, down};
        walk[] += wall;
        here = down;
    EndIf
EndFor
upper_right = newp;
Point(upper_right) = {across ? span : 0, across ? 0 : span, height, size_bulk};
upper_left = newp;
Point(upper_left) = {0, 0, height, size_bulk};
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
If (StrCmp(shape, "hex") == 0)
    Recombine Surface{whole};
EndIf
If (StrCmp(shape, "tet") == 0)
    made[] = Extrude{across ? 0 : way, across ? way : 0, 0}{ Surface{whole}; Layers{cells}; };
Else
    made[] = Extrude{across ? 0 : way, across ? way : 0, 0}{ Surface{whole}; Layers{cells}; Recombine; };
EndIf

// Even numbers of cells along the underside, as quadrilaterals want them.
Transfinite Curve{walk[]} = 3;
For k In {0 : grooves}
    Transfinite Curve{walk[touching[k]]} = 2 * Ceil(contact_width / size_contact / 2 - 1e-6) + 1;
    If (k < grooves && floor > 0)
        Transfinite Curve{walk[touching[k] + 2]} = 2 * Ceil(floor / size_contact / 2 - 1e-6) + 1;
    EndIf
EndFor

sides = #walk[];        // made[2 + k]: the side of curve k of the walk
For k In {0 : grooves}
    Physical Surface(Sprintf("contact_%g", k + 1)) = {made[2 + touching[k]]};
EndFor
Physical Volume("body") = {made[1]};
Physical Surface("top") = {made[3 + sides]};
If (across)
    Physical Surface("leading") = {made[2 + sides]};
    Physical Surface("rod") = {made[4 + sides]};
    Physical Surface("left") = {whole};
    Physical Surface("right") = {made[0]};
Else
    Physical Surface("right") = {made[2 + sides]};
    Physical Surface("left") = {made[4 + sides]};
    Physical Surface("rod") = {whole};
    Physical Surface("leading") = {made[0]};
EndIf

// --- mesh ---------------------------------------------------------------------------------------
Mesh.Algorithm = 6;                  // frontal; 8 crashes gmsh 4.8
Mesh.RecombinationAlgorithm = 3;     // no triangle is left over
Mesh.ElementOrder = order;
