// SPDX-License-Identifier: GPL-2.0-or-later
// One half of a block whose upper side is loaded on a strip about its middle, x = 0.
//
//        strip  top
//         +--+-------+
//  middle |          | leading
//         +----------+
//           contact
DefineConstant[ length = 1.5, height = 1, strip = 0.1, cells = 50 ];   // cells: of a unit length
Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, height, 0};
Point(4) = {strip, height, 0};
Point(5) = {0, height, 0};
Point(6) = {strip, 0, 0};
Line(1) = {1, 6};
Line(2) = {6, 2};
Line(3) = {2, 3};
Line(4) = {3, 4};
Line(5) = {4, 5};
Line(6) = {5, 1};
Line(7) = {6, 4};
Transfinite Curve{1, 5} = Round(strip * cells) + 1;
Transfinite Curve{2, 4} = Round((length - strip) * cells) + 1;
Transfinite Curve{3, 6, 7} = Round(height * cells) + 1;
Curve Loop(1) = {1, 7, 5, 6};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Surface{1, 2};
Recombine Surface{1, 2};
Physical Surface("body") = {1, 2};
Physical Curve("contact") = {1, 2};
Physical Curve("leading") = {3};
Physical Curve("top") = {4, 5};
Physical Curve("strip") = {5};
Physical Curve("middle") = {6};
