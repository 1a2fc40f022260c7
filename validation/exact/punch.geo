// SPDX-License-Identifier: GPL-2.0-or-later
// A block whose lower face stands on a round piece of it: that is the contact, the rest of the face is free, as under a
// flat round punch. The disc is in the middle of the face; small cells at its rim, layers that grow upwards.
DefineConstant[
    radius = 0.25,          // of the contact
    side = 4,               // of the block, along x and y
    height = 2,
    rim = 0.03,             // size of cells at the rim
    middle = 0.06,          // in the middle of the contact
    far = 1,                // at the corners of the block
    layers = 12,            // of cells upwards
    grade = 30,             // height of the last over that of the first
    refine = 1              // divides sizes, multiplies layers
];
Point(1) = {side / 2, side / 2, 0, middle / refine};
Point(2) = {side / 2 + radius, side / 2, 0, rim / refine};
Point(3) = {side / 2, side / 2 + radius, 0, rim / refine};
Point(4) = {side / 2 - radius, side / 2, 0, rim / refine};
Point(5) = {side / 2, side / 2 - radius, 0, rim / refine};
Point(6) = {0, 0, 0, far / refine};
Point(7) = {side, 0, 0, far / refine};
Point(8) = {side, side, 0, far / refine};
Point(9) = {0, side, 0, far / refine};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 2};
Line(5) = {6, 7};
Line(6) = {7, 8};
Line(7) = {8, 9};
Line(8) = {9, 6};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1};
Plane Surface(2) = {2, 1};
Point{1} In Surface{1};
count = layers * refine;
ratio = grade ^ (1 / (count - 1));
each[] = {};
heights[] = {};
total = 0;
For k In {1 : count}
    total = total + ratio ^ (k - 1);
EndFor
sum = 0;
For k In {1 : count}
    sum = sum + ratio ^ (k - 1) / total;
    each[] += {1};
    heights[] += {k == count ? 1 : sum};
EndFor
inner[] = Extrude{0, 0, height}{ Surface{1}; Layers{each[], heights[]}; Recombine; };
outer[] = Extrude{0, 0, height}{ Surface{2}; Layers{each[], heights[]}; Recombine; };
Physical Volume("body") = {inner[1], outer[1]};
Physical Surface("contact") = {1};
Physical Surface("top") = {inner[0], outer[0]};
Physical Surface("left") = {outer[2]};
Physical Surface("leading") = {outer[3]};
Physical Surface("right") = {outer[4]};
Physical Surface("rod") = {outer[5]};
