// SPDX-License-Identifier: GPL-2.0-or-later
// A ball of radius 1 whose lower half is kept, on a plane that it touches at the origin: Hertz's
// contact on a mesh that is curved itself. Contact is what lies below z = cap; cells grow with the
// distance from the point of contact. Of OpenCASCADE, its poles and its seam away from the contact.

DefineConstant[
    size = 0.02,            // of the cells at the contact
    cap = 0.03,             // height up to which the surface may touch
    grow = 0.35,            // size of a cell over its distance
    order = 1               // 1: TET4, 2: TET10
];
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 1, 1};
Rotate{{1, 0, 0}, {0, 0, 1}, Pi / 2}{ Volume{1}; }
Box(2) = {-2, -2, -1, 4, 4, 1 + cap};
Box(3) = {-2, -2, cap, 4, 4, 1 - cap};
low = BooleanIntersection{ Volume{1}; }{ Volume{2}; Delete; };
high = BooleanIntersection{ Volume{1}; Delete; }{ Volume{3}; Delete; };
touching = newp;
Point(touching) = {0, 0, 0};   // a node of every mesh
body[] = BooleanFragments{ Volume{low[]}; Delete; }{ Volume{high[]}; Point{touching}; Delete; };
e = 1e-6;
contact[] = Abs(Boundary{ Volume{body[0]}; });
contact[] -= Surface In BoundingBox{-1, -1, cap - e, 1, 1, cap + e};
top[] = Surface In BoundingBox{-1 - e, -1 - e, 1 - e, 1 + e, 1 + e, 1 + e};
Physical Volume("body") = {body[]};
Physical Surface("contact") = {contact[]};
Physical Surface("top") = {top[]};
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g * Max(0, Sqrt(x*x + y*y + z*z) - 0.15)", size, grow);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = order;
Mesh.HighOrderOptimize = 2;
