// SPDX-License-Identifier: GPL-2.0-or-later
// A table: a block on two unequal feet with slanted walls, their soles flat or rounded, of a material of their own or not.
//
//        top          surfaces: body, soles (the lower half of each foot)
//    +----------+
//    |   body   |     rod: the trailing face of the block, leading: the other one
//    +-+  __  +-+
//      \_/  \_/       contact_1, contact_2
DefineConstant[
    length = 1,
    height = 0.4,       // of the block above the feet
    leg = 0.1,          // height of the feet
    first = 0.25,       // length of the trailing foot on the floor
    second = 0.35,      // of the leading one
    inset = 0.05,       // free underside at either end
    slant = 0.02,       // how much wider a foot is, on either side, at its upper end
    crown = 0,          // how much higher the ends of each sole lie than its middle, which touches: a parabola
    size = 0.02,        // of the cells at the contact
    refine = 1,         // sizes are divided by this
    shape = "triangle", // "triangle" or "quad"
    order = 1,
    incomplete = 0
];
If (length <= 0 || height <= 0 || leg <= 0 || first <= 0 || second <= 0 || size <= 0 || refine <= 0 || crown < 0 || crown >= leg / 2)
    Error("lengths must be above 0 and crown below half of leg = %g, found crown %g", leg, crown);
    Abort;
EndIf
If (inset < slant || 2 * inset + first + second + 2 * slant >= length)
    Error("two feet of %g and %g with slants of %g do not fit below a block of %g", first, second, slant, length);
    Abort;
EndIf
fine = size / refine;
coarse = 3 * fine;
half = leg / 2;
left[] = {inset, length - inset - second};
long[] = {first, second};
under[] = {};       // of the block, from x = 0 on
soles[] = {};
Point(1) = {0, leg, 0, coarse};
here = 1;
For k In {0 : 1}
    a = 10 + 20 * k;
    Point(a) = {left[k], crown, 0, fine};
    Point(a + 1) = {left[k] + long[k], crown, 0, fine};
    Point(a + 2) = {left[k] - slant / 2, half, 0, fine};
    Point(a + 3) = {left[k] + long[k] + slant / 2, half, 0, fine};
    Point(a + 4) = {left[k] - slant, leg, 0, 2 * fine};
    Point(a + 5) = {left[k] + long[k] + slant, leg, 0, 2 * fine};
    If (crown > 0)
        Point(a + 6) = {left[k] + long[k] / 4, 0, 0};
        Point(a + 7) = {left[k] + long[k] / 2, 0, 0, fine};
        Point(a + 8) = {left[k] + 3 * long[k] / 4, 0, 0};
        Bezier(a) = {a, a + 6, a + 7};
        Bezier(a + 7) = {a + 7, a + 8, a + 1};
        floor[] = {a, a + 7};
    Else
        Line(a) = {a, a + 1};
        floor[] = {a};
    EndIf
    Line(a + 1) = {a + 1, a + 3};
    Line(a + 2) = {a + 3, a + 2};       // joint of sole and foot
    Line(a + 3) = {a + 2, a};
    Curve Loop(a) = {floor[], a + 1, a + 2, a + 3};
    Plane Surface(a) = {a};
    soles[] += a;
    Line(a + 4) = {here, a + 4};
    Line(a + 5) = {a + 4, a + 2};
    Line(a + 6) = {a + 3, a + 5};
    under[] += {a + 4, a + 5, -(a + 2), a + 6};
    here = a + 5;
    Physical Curve(Sprintf("contact_%g", k + 1)) = {floor[]};
EndFor
Point(2) = {length, leg, 0, coarse};
Point(3) = {length, leg + height, 0, coarse};
Point(4) = {0, leg + height, 0, coarse};
Line(1) = {here, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {under[], 1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Surface("soles") = {soles[]};
Physical Curve("rod") = {4};
Physical Curve("leading") = {2};
Physical Curve("top") = {3};
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{1, soles[]};
EndIf
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 1;     // some triangles are left over
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
