// SPDX-License-Identifier: GPL-2.0-or-later
// A rectangular block on a base that deforms: two bodies that share no point, so that the block may
// slide. The block is that of block.geo, with the same groups; the base lies below y = 0, which is
// the z = 0 of amontons.
//
//                    top
//                4---------3
//           rod  |  body   |  leading
//    14----------1---------2----------17
//     |           contact / floor      |
//     | base_rear   base    base_front |
//    24--------------------------------27
//                  bottom
//
// Physical groups: body and base (surfaces), contact, top, rod, leading, floor (the base's upper
// side), bottom, base_rear and base_front (curves).
//
//   In a scene:   mesh: {file: base.geo, set: {nx: 40, base_height: 0.5}}
//                 load: {supports: [{group: bottom, x: true, z: true}]}

DefineConstant[
    length = 1,             // extent of the block along x
    height = 0.5,           // extent of the block along z
    base_height = 0.5,      // extent of the base along z
    behind = 0.5,           // how far the base reaches behind the block
    before = 0.5,           // and before it
    nx = 40,                // cells of the block along x
    nz = 40,                // cells of the block along z
    ratio = 1,              // cells of the floor to a cell of the contact; 1: their nodes match
    shape = "quad",         // "quad" or "triangle"
    glued = 0,              // 1: one body, without contact and floor, for comparison
    order = 1,              // 1: Q4, T3; 2: Q9, T6
    incomplete = 0,         // 1: order 2 gives Q8 in place of Q9
    crown = 0,              // how much higher the ends of the contact lie than its middle
    grade_x = 1,            // length of a cell in the middle of the block over one at its ends, about
    grade_z = 1,            // height of a cell far from the contact over that of one at it
    refine = 1              // so many times as many cells along each side, for a study of the mesh
];

// --- what is allowed ----------------------------------------------------------------------------
If (length <= 0 || height <= 0 || base_height <= 0)
    Error("length, height and base_height must be above 0, found %g, %g and %g", length, height,
          base_height);
    Abort;
EndIf
If (behind < 0 || before < 0)
    Error("behind and before must be from 0 on, found %g and %g", behind, before);
    Abort;
EndIf
If (nx < 1 || nz < 1 || nx != Floor(nx) || nz != Floor(nz))
    Error("nx and nz must be whole numbers from 1 on, found %g and %g", nx, nz);
    Abort;
EndIf
If (ratio <= 0 || refine <= 0)
    Error("ratio and refine must be above 0, found %g and %g", ratio, refine);
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
If (crown < 0 || crown >= height)
    Error("crown must be from 0 on and below height = %g, found %g", height, crown);
    Abort;
EndIf
If (grade_x <= 0 || grade_z <= 0 || grade_x > 1e6 || grade_z > 1e6)
    Error("grade_x and grade_z must be above 0 (1: even) and at most 1e6, found %g and %g", grade_x,
          grade_z);
    Abort;
EndIf
If (StrCmp(shape, "quad") != 0 && StrCmp(shape, "triangle") != 0)
    Error(StrCat("shape must be quad or triangle, found ", shape));
    Abort;
EndIf
nx = refine * nx < 1 ? 1 : Floor(refine * nx + 0.5);
nz = refine * nz < 1 ? 1 : Floor(refine * nz + 0.5);
under = ratio * nx < 1 ? 1 : Floor(ratio * nx + 0.5);       // cells of the floor below the block
deep = base_height / height * ratio * nz;
deep = deep < 1 ? 1 : Floor(deep + 0.5);
rear = behind / length * under;
rear = rear < 1 ? 1 : Floor(rear + 0.5);
ahead = before / length * under;
ahead = ahead < 1 ? 1 : Floor(ahead + 0.5);
If (nx * nz + (under + rear + ahead) * deep > 1e7)
    Error("%g x %g cells and a base of %g are more than 1e7, which no computer here could step",
          nx, nz, (under + rear + ahead) * deep);
    Abort;
EndIf

// --- the block ----------------------------------------------------------------------------------
Point(1) = {0, crown, 0};
Point(2) = {length, crown, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
If (crown > 0)
    Point(5) = {length / 2, -crown, 0};
    Bezier(1) = {1, 5, 2};
Else
    Line(1) = {1, 2};
EndIf
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {1, 4};
Curve Loop(1) = {1, 2, 3, -4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = nx + 1 Using Bump 1 / grade_x;
Transfinite Curve {2, 4} = nz + 1 Using Progression (nz > 1 ? grade_z ^ (1 / (nz - 1)) : 1);
Transfinite Surface {1} = {1, 2, 3, 4};

If (glued != 0 && (glued != 1 || ratio != 1 || crown != 0))
    Error("glued must be 0 or 1, and then ratio is 1 and crown 0; found %g", glued);
    Abort;
EndIf

// --- the base: behind the block, below it, before it ----------------------------------------------
x[] = {-behind, 0, length, length + before};
cells[] = {rear, under, ahead};
top[] = {};
first = behind > 0 ? 0 : 1;
last = before > 0 ? 2 : 1;
For k In {first : last + 1}
    If (glued == 0 || k == 0 || k == 3)
        top[] += {14 + k};
        Point(14 + k) = {x[k], 0, 0};
    Else
        top[] += {k};   // a corner of the block
    EndIf
    Point(24 + k) = {x[k], -base_height, 0};
    Line(14 + k) = {top[k - first], 24 + k};
    Transfinite Curve {14 + k} = deep + 1 Using Progression
                                 (deep > 1 ? grade_z ^ (1 / (deep - 1)) : 1);
EndFor
base[] = {};
floor[] = {};
bottom[] = {};
For k In {first : last}
    If (glued == 0 || k != 1)
        Line(34 + k) = {top[k - first], top[k + 1 - first]};
        upper = 34 + k;
        floor[] += {upper};
    Else
        upper = 1;   // the block's lower side
    EndIf
    Line(44 + k) = {24 + k, 25 + k};
    If (k == 1)
        Transfinite Curve {upper, 44 + k} = cells[k] + 1 Using Bump 1 / grade_x;
    Else
        Transfinite Curve {upper, 44 + k} = cells[k] + 1;
    EndIf
    Curve Loop(14 + k) = {-upper, 14 + k, 44 + k, -(15 + k)};
    Plane Surface(14 + k) = {14 + k};
    Transfinite Surface {14 + k} = {top[k - first], 24 + k, 25 + k, top[k + 1 - first]};
    base[] += {14 + k};
    bottom[] += {44 + k};
EndFor

Physical Surface("body") = {1};
Physical Surface("base") = {base[]};
If (glued == 0)
    Physical Curve("contact") = {1};
EndIf
Physical Curve("leading") = {2};
Physical Curve("top") = {3};
Physical Curve("rod") = {4};
If (#floor[] > 0)
    Physical Curve("floor") = {floor[]};
EndIf
Physical Curve("bottom") = {bottom[]};
Physical Curve("base_rear") = {14 + first};
Physical Curve("base_front") = {15 + last};

If (StrCmp(shape, "quad") == 0)
    Recombine Surface {1, base[]};
EndIf
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
