// SPDX-License-Identifier: GPL-2.0-or-later
// A block whose trailing and leading faces lean. No parameter `refine`: gmsh halves its edges.
DefineConstant[
    length = 1,         // of the contact
    height = 0.5,
    back = 0.1,         // how far the top begins behind the lower end of the trailing face; below 0: it hangs over
    front = 0.1,        // how far it ends before that of the leading face; below 0: it hangs over
    size = 0.03,        // of the cells at the contact
    shape = "triangle", // "triangle" or "quad"
    order = 1
];
If (length <= 0 || height <= 0 || size <= 0 || back + front >= length)
    Error("a wedge needs a top, a height and cells, found back %g, front %g, height %g, size %g", back, front, height, size);
    Abort;
EndIf
Point(1) = {0, 0, 0, size};
Point(2) = {length, 0, 0, size};
Point(3) = {length - front, height, 0, 3 * size};
Point(4) = {back, height, 0, 3 * size};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("contact") = {1};
Physical Curve("leading") = {2};
Physical Curve("top") = {3};
Physical Curve("rod") = {4};
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{1};
EndIf
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 3;
Mesh.ElementOrder = order;
