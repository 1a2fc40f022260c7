// SPDX-License-Identifier: GPL-2.0-or-later
// A bridge: a block on two feet, with an arch between them. gmsh's y is the z of amontons.
DefineConstant[
    foot = 0.3,       // length of each foot on the floor
    rise = 0.2,       // of the arch over the floor
    size = 0.02,      // of the cells at the contact
    refine = 1        // sizes are divided by this
];

fine = size / refine;
coarse = 3 * size / refine;

// Corners, the floor first; the number behind a point's place is the size of the cells there.
Point(1) = {0, 0, 0, fine};
Point(2) = {foot, 0, 0, fine};
Point(3) = {0.5, rise, 0, fine};              // top of the arch
Point(4) = {1 - foot, 0, 0, fine};
Point(5) = {1, 0, 0, fine};
Point(6) = {1, 0.5, 0, coarse};
Point(7) = {0, 0.5, 0, coarse};
Point(8) = {0, 0.25, 0, fine};                // finer cells where the rod pushes

Line(1) = {1, 2};                             // first foot
Spline(2) = {2, 3, 4};
Line(3) = {4, 5};                             // second foot
Line(4) = {5, 6};
Line(5) = {6, 7};
Line(6) = {7, 8};
Line(7) = {8, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7};
Plane Surface(1) = {1};

Physical Surface("body") = {1};
Physical Curve("contact_1") = {1};            // or one group, "contact" = {1, 3}: two pads all the same
Physical Curve("contact_2") = {3};
Physical Curve("top") = {5};
Physical Curve("rod") = {6, 7};
