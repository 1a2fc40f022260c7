// SPDX-License-Identifier: GPL-2.0-or-later
// A block with a round hole, or with a slot from above or from the leading face.
//
//    +----------+      +---+ +----+     +----------+
//    |    O     |      |   | |    |     |     +----+
//    |          |      |   +-+    |     |     +----+
//    +----------+      +----------+     +----------+
DefineConstant[
    length = 1,
    height = 0.5,
    cut = "hole",       // "hole", "top" or "leading"
    x = 0.5,            // centre of the hole, or middle of a slot from above
    z = 0.25,           // centre of the hole, or middle of a slot from the leading face
    radius = 0.1,       // of the hole
    width = 0.05,       // of a slot
    depth = 0.2,        // of a slot
    size = 0.02,        // of the cells at the contact
    refine = 1,         // sizes are divided by this
    shape = "triangle", // "triangle" or "quad"
    order = 1,
    incomplete = 0
];
If (length <= 0 || height <= 0 || radius <= 0 || width <= 0 || depth <= 0 || size <= 0 || refine <= 0)
    Error("lengths must be above 0");
    Abort;
EndIf
fine = size / refine;
coarse = 3 * fine;
Point(1) = {0, 0, 0, fine};
Point(2) = {length, 0, 0, fine};
Point(3) = {length, height, 0, coarse};
Point(4) = {0, height, 0, coarse};
Line(1) = {1, 2};
Line(4) = {4, 1};
holes[] = {};
leading[] = {2};
top[] = {3};
outline[] = {1, 2, 3, 4};
If (StrCmp(cut, "hole") == 0)
    If (x - radius <= 0 || x + radius >= length || z - radius <= 0 || z + radius >= height)
        Error("a hole of radius %g at %g, %g does not lie within the block", radius, x, z);
        Abort;
    EndIf
    Point(5) = {x, z, 0, 2 * fine};
    Point(6) = {x + radius, z, 0, 2 * fine};
    Point(7) = {x, z + radius, 0, 2 * fine};
    Point(8) = {x - radius, z, 0, 2 * fine};
    Point(9) = {x, z - radius, 0, 2 * fine};
    Circle(5) = {6, 5, 7};
    Circle(6) = {7, 5, 8};
    Circle(7) = {8, 5, 9};
    Circle(8) = {9, 5, 6};
    Line(2) = {2, 3};
    Line(3) = {3, 4};
    Curve Loop(2) = {5 : 8};
    holes[] = {2};
EndIf
If (StrCmp(cut, "top") == 0)
    Point(5) = {x + width / 2, height, 0, coarse};
    Point(6) = {x + width / 2, height - depth, 0, 2 * fine};
    Point(7) = {x - width / 2, height - depth, 0, 2 * fine};
    Point(8) = {x - width / 2, height, 0, coarse};
    Line(2) = {2, 3};
    Line(3) = {3, 5};
    Line(5) = {5, 6};
    Line(6) = {6, 7};
    Line(7) = {7, 8};
    Line(8) = {8, 4};
    top[] = {3, 8};
    outline[] = {1, 2, 3, 5, 6, 7, 8, 4};
EndIf
If (StrCmp(cut, "leading") == 0)
    Point(5) = {length, z - width / 2, 0, 2 * fine};
    Point(6) = {length - depth, z - width / 2, 0, 2 * fine};
    Point(7) = {length - depth, z + width / 2, 0, 2 * fine};
    Point(8) = {length, z + width / 2, 0, 2 * fine};
    Line(2) = {2, 5};
    Line(5) = {5, 6};
    Line(6) = {6, 7};
    Line(7) = {7, 8};
    Line(8) = {8, 3};
    Line(3) = {3, 4};
    leading[] = {2, 8};
    outline[] = {1, 2, 5, 6, 7, 8, 3, 4};
EndIf
Curve Loop(1) = {outline[]};
Plane Surface(1) = {1, holes[]};
Physical Surface("body") = {1};
Physical Curve("contact") = {1};
Physical Curve("leading") = {leading[]};
Physical Curve("top") = {top[]};
Physical Curve("rod") = {4};
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{1};
EndIf
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 1;     // some triangles are left over
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
