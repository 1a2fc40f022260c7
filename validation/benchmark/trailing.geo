// SPDX-License-Identifier: GPL-2.0-or-later
// A block as ../../meshes/block.geo meshes it, of n x n quads of order 1, but with columns that get shorter
// towards the trailing face, where slip sets out: lengths in geometric progression, the last `grade` times
// the first. For estimators.py.

DefineConstant[
    length = 1,             // extent along x
    height = 0.5,           // extent along z
    n = 20,                 // cells along x, and up the block
    grade = 4               // length of the leading cell over that of the trailing one
];

Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
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

Transfinite Curve{1, -3} = n + 1 Using Progression grade ^ (1 / (n - 1));
Transfinite Curve{2, 4} = n + 1;
Transfinite Surface{1};
Recombine Surface{1};
