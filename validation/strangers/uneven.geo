// SPDX-License-Identifier: GPL-2.0-or-later
// A table on two feet of unequal height: the underside of the block has a step between them. One sole may stand a little
// above the floor, which it comes down to under load or not.
//
//    +----------+   height
//    |   body   |     rod: the trailing face of the block, leading: the other one
//    |     +--+ |
//    | +---+  | |     contact_1, contact_2: the soles
//    +-+      +-+
DefineConstant[
    length = 1,
    height = 0.5,       // of the upper face over the floor
    leg_first = 0.05,   // height of the trailing foot
    leg_second = 0.15,  // of the leading one
    first = 0.25,       // length of the trailing foot
    second = 0.35,      // of the leading one
    inset = 0.05,       // free underside at either end
    step = 0.5,         // x of the step
    lift_first = 0,     // how far the trailing sole stands above the floor
    lift_second = 0,    // and the leading one
    size = 0.02,        // of the cells at the contact
    refine = 1,         // sizes are divided by this
    shape = "triangle", // "triangle" or "quad"
    order = 1,
    incomplete = 0
];
If (length <= 0 || leg_first <= 0 || leg_second <= 0 || first <= 0 || second <= 0 || inset <= 0 || size <= 0 || refine <= 0)
    Error("lengths must be above 0");
    Abort;
EndIf
If (height <= leg_first || height <= leg_second || lift_first < 0 || lift_second < 0 || lift_first >= leg_first || lift_second >= leg_second)
    Error("legs must be below height = %g, lifts below the legs", height);
    Abort;
EndIf
If (step <= inset + first || step >= length - inset - second)
    Error("the step at %g is not between the feet", step);
    Abort;
EndIf
fine = size / refine;
coarse = 3 * fine;
x[] = {0, inset, inset, inset + first, inset + first, step, step,
       length - inset - second, length - inset - second, length - inset, length - inset, length, length, 0};
z[] = {leg_first, leg_first, lift_first, lift_first, leg_first, leg_first, leg_second,
       leg_second, lift_second, lift_second, leg_second, leg_second, height, height};
cell[] = {coarse, 2 * fine, fine, fine, 2 * fine, coarse, coarse, 2 * fine, fine, fine, 2 * fine, coarse, coarse, coarse};
For k In {0 : 13}
    Point(k + 1) = {x[k], z[k], 0, cell[k]};
EndFor
For k In {1 : 14}
    Line(k) = {k, k < 14 ? k + 1 : 1};
EndFor
Curve Loop(1) = {1 : 14};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("contact_1") = {3};
Physical Curve("contact_2") = {9};
Physical Curve("leading") = {12};
Physical Curve("top") = {13};
Physical Curve("rod") = {14};
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{1};
EndIf
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 1;     // some triangles are left over
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
