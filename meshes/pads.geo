// SPDX-License-Identifier: GPL-2.0-or-later
// A block on n pads. gmsh's y is the z of amontons: the pads stand on y = 0, the rod pushes the
// face x = 0 of the block towards +x. Here for n = 3, ends = "flush":
//
//                    top
//         +------------------------+   total_height, or height above the pads
//    rod  |          body          |  leading
//         +----+---+----+---+----+-+
//         |pad |   |pad |   |pad |     pads of pad_height, together contact_length (or
//         +----+   +----+   +----+     fill * length) long, a gap between neighbours
//       contact_1 contact_2 contact_3
//
// Physical groups: body (the surface of block and pads), contact_1 ... contact_n by ascending x,
// top, rod (the trailing face of the block, without its pad) and leading (curves). With base_height
// the pads stand on a base that deforms, as in base.geo: base (surface), floor (its upper side),
// bottom, base_rear and base_front (curves).
//
//   In a scene:   mesh: {file: pads.geo, set: {n: 4, fill: 0.5, pad_height: 0.1}}
//   By hand:      gmsh -2 pads.geo -setnumber n 4

DefineConstant[
    n = 3,                  // pads
    length = 1,             // of the block, along x
    height = 0.5,           // of the block above the pads
    total_height = 0,       // of block and pads together, in place of height; 0: height counts
    pad_height = 0.05,      // of the pads
    fill = 0.6,             // contact length over length, above 0 and below 1; at n = 1 also 1
    contact_length = 0,     // of all pads together, in place of fill; 0: fill counts
    pad_ratio = 1,          // length of the last pad over that of the first, in geometric steps
    gap = 0,                // between neighbours, the row of pads in the middle of the block;
                            // 0: as wide as `ends` makes it
    first_gap = 1,          // width of the first gap, by the trailing pad, over that of the others; all
                            // gaps together are as wide as before
    ends = "flush",         // "flush": first and last pad end with the block (n = 1: in the middle)
                            // "open": half a gap at either end of the block
    fillet = 0,             // radius at the roots of the pads; 0: sharp
    layout = "auto",        // "regular": rows and columns of cells
                            // "free": unstructured, of the sizes below
                            // "auto": free with a fillet, else regular
    size_contact = 0,       // of the cells in pads and gaps; 0: by cells_...
    size_bulk = 0,          // of the cells at the top; 0: by nz and grade_z
    cells_pad = 8,          // cells along each pad
    cells_gap = 6,          // cells along each gap
    cells_pad_height = 3,   // cells up each pad
    nz = 20,                // cells up the block
    grade_z = 1,            // height of the top cell of the block over that of its lowest
    grade_contact = 1,      // length of a pad's middle cell over that of its end cells, where stress
                            // is singular; height of its top cell over that of its lowest
    refine = 1,             // sizes are divided, numbers of cells and grade_contact multiplied by
                            // this, for a study of the mesh
    shape = "quad",         // "quad" or "triangle"
    order = 1,              // 1: Q4, T3; 2: Q9, T6
    incomplete = 0,         // 1: order 2 gives Q8 in place of Q9
    base_height = 0,        // of a base below the pads; 0: none, the floor is rigid
    behind = 0.5,           // how far the base reaches behind the block
    before = 0.5,           // and before it
    ratio = 1               // cells of the floor to a cell of a pad; 2: half as long
];

// --- what is allowed ----------------------------------------------------------------------------
If (n < 1 || n > 10000 || n != Floor(n))
    Error("n must be a whole number from 1 to 10000, found %g", n);
    Abort;
EndIf
If (length <= 0 || height <= 0 || pad_height <= 0)
    Error("length, height and pad_height must be above 0, found %g, %g and %g", length, height,
          pad_height);
    Abort;
EndIf
If (total_height != 0 && total_height <= pad_height)
    Error("total_height must be above pad_height (or 0: height counts), found %g with pads of %g",
          total_height, pad_height);
    Abort;
EndIf
If (contact_length == 0 && (fill <= 0 || fill > 1 || (n > 1 && fill == 1)))
    Error("fill must be above 0 and below 1, found %g", fill);
    Abort;
EndIf
If (contact_length < 0 || contact_length > length || (n > 1 && contact_length == length))
    Error("contact_length must be above 0 (0: fill counts) and below length = %g, found %g",
          length, contact_length);
    Abort;
EndIf
If (pad_ratio <= 0)
    Error("pad_ratio must be above 0 (1: equal pads), found %g", pad_ratio);
    Abort;
EndIf
If (first_gap <= 0)
    Error("first_gap must be above 0 (1: equal gaps), found %g", first_gap);
    Abort;
EndIf
If (gap < 0)
    Error("gap must be above 0 (0: as wide as ends makes it), found %g", gap);
    Abort;
EndIf
If (fillet < 0)
    Error("fillet must be above 0 (0: sharp roots), found %g", fillet);
    Abort;
EndIf
If (size_contact < 0 || size_bulk < 0)
    Error("size_contact and size_bulk must be above 0 (0: by cells), found %g and %g",
          size_contact, size_bulk);
    Abort;
EndIf
If (cells_pad < 1 || cells_gap < 1 || cells_pad_height < 1 || nz < 1 ||
    cells_pad != Floor(cells_pad) || cells_gap != Floor(cells_gap) ||
    cells_pad_height != Floor(cells_pad_height) || nz != Floor(nz))
    Error(StrCat("cells_pad, cells_gap, cells_pad_height and nz must be whole numbers from 1 on, ",
                 "found %g, %g, %g and %g"),
          cells_pad, cells_gap, cells_pad_height, nz);
    Abort;
EndIf
If (grade_z <= 0)
    Error("grade_z must be above 0 (1: even), found %g", grade_z);
    Abort;
EndIf
If (grade_contact < 1 || refine <= 0)
    Error("grade_contact must be from 1 on and refine above 0, found %g and %g", grade_contact,
          refine);
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
If (StrCmp(shape, "quad") != 0 && StrCmp(shape, "triangle") != 0)
    Error(StrCat("shape must be quad or triangle, found ", shape));
    Abort;
EndIf
If (StrCmp(ends, "flush") != 0 && StrCmp(ends, "open") != 0)
    Error(StrCat("ends must be flush or open, found ", ends));
    Abort;
EndIf
If (StrCmp(layout, "auto") != 0 && StrCmp(layout, "regular") != 0 && StrCmp(layout, "free") != 0)
    Error(StrCat("layout must be auto, regular or free, found ", layout));
    Abort;
EndIf
If (fillet > 0 && StrCmp(layout, "regular") == 0)
    Error("a fillet needs the layout free or auto, found regular with fillet = %g", fillet);
    Abort;
EndIf
If (base_height < 0 || behind < 0 || before < 0 || ratio <= 0)
    Error(StrCat("base_height (0: a rigid floor), behind and before must be from 0 on and ratio ",
                 "above 0, found %g, %g, %g and %g"),
          base_height, behind, before, ratio);
    Abort;
EndIf

size_contact = size_contact / refine;
size_bulk = size_bulk / refine;

// --- lengths ------------------------------------------------------------------------------------
touching = contact_length > 0 ? contact_length : fill * length;
top_z = total_height > 0 ? total_height : pad_height + height;
margin = 0;                                        // free underside at either end
gap_length = gap;
If (n == 1)
    gap_length = 0;
    margin = (length - touching) / 2;
ElseIf (gap > 0)
    margin = (length - touching - (n - 1) * gap) / 2;
ElseIf (StrCmp(ends, "open") == 0)
    gap_length = (length - touching) / n;
    margin = gap_length / 2;
Else
    gap_length = (length - touching) / (n - 1);
EndIf
If (Fabs(margin) < 1e-9 * length)
    margin = 0;
EndIf
If (margin < 0)
    Error(StrCat("pads and gaps do not fit: %g of pads and %g gaps of %g are longer than the ",
                 "block, length = %g; gap may be up to %g, or 0: as wide as ends makes it"),
          touching, n - 1, gap, length, (length - touching) / (n - 1));
    Abort;
EndIf

gap_lengths[] = {};
narrowest = gap_length;
For k In {0 : n - 2}
    gap_lengths[] += gap_length;
    If (first_gap != 1 && n > 2)
        gap_lengths[k] = (n - 1) * gap_length / (n - 2 + first_gap) * (k == 0 ? first_gap : 1);
        narrowest = gap_lengths[k] < narrowest ? gap_lengths[k] : narrowest;
    EndIf
EndFor

// Pads in geometric progression: the last pad_ratio times the first.
step = 1;
If (n > 1)
    step = pad_ratio ^ (1 / (n - 1));
EndIf
sum = 0;
For k In {0 : n - 1}
    sum += step ^ k;
EndFor
shortest = touching / sum * (step < 1 ? step ^ (n - 1) : 1);
If (size_contact > shortest / 2)
    Error("size_contact / refine must be at most half of the shortest pad, which is %g long, found %g",
          shortest, size_contact);
    Abort;
EndIf

If (fillet >= pad_height || (margin > 0 && fillet >= margin) || (n > 1 && 2 * fillet >= narrowest))
    If (fillet > 0)
        Error(StrCat("fillet must be below pad_height = %g, half a gap = %g and the free end of ",
                     "the underside = %g (0: none), found %g"),
              pad_height, narrowest / 2, margin, fillet);
        Abort;
    EndIf
EndIf

// Columns k = 0, 1, ...: pads, gaps between them, and the free ends where there are any. Column k
// reaches from xs[k] to xs[k + 1]; solid[k + 1]: 1 for a pad. Beyond either end is no pad.
xs[] = {0};
solid[] = {0};
If (margin > 0)
    xs[] += margin;
    solid[] += 0;
EndIf
x = margin;
For k In {0 : n - 1}
    x = x + touching / sum * step ^ k;
    If (k == n - 1)
        x = length - margin;
    EndIf
    xs[] += x;
    solid[] += 1;
    If (k < n - 1)
        x = x + gap_lengths[k];
        xs[] += x;
        solid[] += 0;
    EndIf
EndFor
If (margin > 0)
    xs[] += length;
    solid[] += 0;
EndIf
columns = #solid[] - 1;
solid[] += 0;

// --- sizes of cells -----------------------------------------------------------------------------
cells_pad = refine * cells_pad < 1 ? 1 : Floor(refine * cells_pad + 0.5);
cells_gap = refine * cells_gap < 1 ? 1 : Floor(refine * cells_gap + 0.5);
cells_pad_height = refine * cells_pad_height < 1 ? 1 : Floor(refine * cells_pad_height + 0.5);
nz = refine * nz < 1 ? 1 : Floor(refine * nz + 0.5);
If (n * (cells_pad + cells_gap) * (nz + cells_pad_height) > 1e7)
    Error("%g pads of %g cells, %g cells up, are more than 1e7 cells", n, cells_pad, nz);
    Abort;
EndIf
grade = refine * grade_contact > 1 ? refine * grade_contact : 1;
fine = size_contact > 0 ? size_contact : touching / n / cells_pad;
// The end cells of a pad of cells that follow a parabola (Bump) with a mean of `fine`.
finest = fine;
If (grade > 1)
    bend = Sqrt(1 - 1 / grade);
    finest = fine / grade * Log((1 + bend) / (1 - bend)) / (2 * bend);
EndIf
up_pad = size_contact > 0 ? Ceil(pad_height / fine - 1e-6) : cells_pad_height;
coarse = size_bulk;
up_block = nz;
ratio_z = 1;
body_z = top_z - pad_height;
If (nz > 1)
    ratio_z = grade_z ^ (1 / (nz - 1));
EndIf
If (size_bulk > 0)      // heights in geometric progression from `fine` to `coarse`
    coarse = size_bulk < body_z / 2 ? size_bulk : body_z / 2;
    ratio_z = fine < body_z / 2 ? (body_z - fine) / (body_z - coarse) : 1;
    If (Fabs(ratio_z - 1) < 1e-9)
        up_block = Ceil(body_z / coarse - 1e-6);
        ratio_z = 1;
    Else
        up_block = 1 + Ceil(Log(coarse / fine) / Log(ratio_z) - 1e-6);
        ratio_z = up_block > 1 ? (coarse / fine) ^ (1 / (up_block - 1)) : 1;
    EndIf
Else
    coarse = body_z / nz;
EndIf

is_free = StrCmp(layout, "free") == 0 || (StrCmp(layout, "auto") == 0 && fillet > 0);
surfaces[] = {};
feet[] = {};
tops[] = {};

// --- rows and columns ---------------------------------------------------------------------------
// Points and curves are numbered (the number below) * bank + k:
//
//      3 ---- 13 ---- 3    z = top           points 1, 2, 3
//      |              |                      curves 11, 12, 13 along x, 21 and 22 upwards
//     22       2     22    body              surfaces 1 (pads) and 2 (columns of the block)
//      |              |
//      2 ---- 12 ---- 2    z = pad_height
//     21       1     21    pads
//      1 ---- 11 ---- 1    z = 0
If (!is_free)
    bank = columns + 1;
    For k In {0 : columns}
        Point(2 * bank + k) = {xs[k], pad_height, 0};
        Point(3 * bank + k) = {xs[k], top_z, 0};
        Line(22 * bank + k) = {2 * bank + k, 3 * bank + k};
        Transfinite Curve{22 * bank + k} = up_block + 1 Using Progression ratio_z;
        If (solid[k] || solid[k + 1])
            Point(1 * bank + k) = {xs[k], 0, 0};
            Line(21 * bank + k) = {1 * bank + k, 2 * bank + k};
            If (grade > 1 && up_pad > 1)
                Transfinite Curve{21 * bank + k} = up_pad + 1 Using Progression
                    grade ^ (1 / (up_pad - 1));
            Else
                Transfinite Curve{21 * bank + k} = up_pad + 1;
            EndIf
        EndIf
    EndFor
    number = 0;
    For k In {0 : columns - 1}
        wide = xs[k + 1] - xs[k];
        cells = solid[k + 1] ? cells_pad : cells_gap;
        If (size_contact > 0)
            cells = Ceil(wide / fine - 1e-6);
        EndIf
        Line(12 * bank + k) = {2 * bank + k, 2 * bank + k + 1};
        Line(13 * bank + k) = {3 * bank + k, 3 * bank + k + 1};
        If (solid[k + 1] && grade > 1)
            Transfinite Curve{12 * bank + k, 13 * bank + k} = cells + 1 Using Bump 1 / grade;
        Else
            Transfinite Curve{12 * bank + k, 13 * bank + k} = cells + 1;
        EndIf
        Curve Loop(2 * bank + k) = {12 * bank + k, 22 * bank + k + 1, -(13 * bank + k),
                                    -(22 * bank + k)};
        Plane Surface(2 * bank + k) = {2 * bank + k};
        tops[] += 13 * bank + k;
        surfaces[] += 2 * bank + k;
        If (solid[k + 1])
            number = number + 1;
            Line(11 * bank + k) = {1 * bank + k, 1 * bank + k + 1};
            If (grade > 1)
                Transfinite Curve{11 * bank + k} = cells + 1 Using Bump 1 / grade;
            Else
                Transfinite Curve{11 * bank + k} = cells + 1;
            EndIf
            Curve Loop(bank + k) = {11 * bank + k, 21 * bank + k + 1, -(12 * bank + k),
                                    -(21 * bank + k)};
            Plane Surface(bank + k) = {bank + k};
            surfaces[] += bank + k;
            feet[] += bank + k;
            Physical Curve(Sprintf("contact_%g", number)) = {11 * bank + k};
        EndIf
    EndFor
    Physical Curve("rod") = {22 * bank};
    Physical Curve("leading") = {22 * bank + columns};
    Transfinite Surface{surfaces[]};
EndIf

// --- one surface, its underside walked from x = 0 to x = length ---------------------------------
// At a root the walk goes round an arc of the fillet, whose centre lies in the gap.
If (is_free)
    at_root = fine;
    If (fillet > 0)
        at_root = fine < fillet / 2 ? fine : fillet / 2;
    EndIf
    walk[] = {};
    number = 0;
    foot = newp;                                   // lower end of the block's trailing face
    Point(foot) = {0, pad_height, 0, fine};
    here = foot;                                   // where the walk has come to
    For k In {0 : columns - 1}
        If (solid[k + 1])
            number = number + 1;
            bottom = newp;
            Point(bottom) = {xs[k], 0, 0, finest};
            If (k > 0 && fillet > 0)
                centre = newp;
                Point(centre) = {xs[k] - fillet, pad_height - fillet, 0, at_root};
                below = newp;
                Point(below) = {xs[k], pad_height - fillet, 0, at_root};
                arc = newl;
                Circle(arc) = {here, centre, below};
                walk[] += arc;
                here = below;
            EndIf
            side = newl;
            Line(side) = {here, bottom};
            walk[] += side;
            corner = newp;
            Point(corner) = {xs[k + 1], 0, 0, finest};
            base = newl;
            Line(base) = {bottom, corner};
            walk[] += base;
            If (grade > 1)
                Transfinite Curve{base} = 2 * Floor((xs[k + 1] - xs[k]) / fine / 2 + 0.5) + 1 Using
                    Bump 1 / grade;                // even, as quads want it
            EndIf
            Physical Curve(Sprintf("contact_%g", number)) = {base};
            root = newp;
            rounded = k < columns - 1 ? fillet : 0;
            Point(root) = {xs[k + 1], pad_height - rounded, 0, at_root};
            side = newl;
            Line(side) = {corner, root};
            walk[] += side;
            here = root;
            If (rounded > 0)
                centre = newp;
                Point(centre) = {xs[k + 1] + fillet, pad_height - fillet, 0, at_root};
                above = newp;
                Point(above) = {xs[k + 1] + fillet, pad_height, 0, at_root};
                arc = newl;
                Circle(arc) = {root, centre, above};
                walk[] += arc;
                here = above;
            EndIf
        Else
            next = newp;
            rounded = k < columns - 1 ? fillet : 0;
            Point(next) = {xs[k + 1] - rounded, pad_height, 0, at_root};
            under = newl;
            Line(under) = {here, next};
            walk[] += under;
            here = next;
        EndIf
    EndFor
    upper_right = newp;
    Point(upper_right) = {length, top_z, 0, coarse};
    upper_left = newp;
    Point(upper_left) = {0, top_z, 0, coarse};
    face = newl;
    Line(face) = {here, upper_right};
    ceiling = newl;
    Line(ceiling) = {upper_right, upper_left};
    trailing = newl;
    Line(trailing) = {upper_left, foot};
    outline = newll;
    Curve Loop(outline) = {walk[], face, ceiling, trailing};
    whole = news;
    Plane Surface(whole) = {outline};
    surfaces[] += whole;
    tops[] += ceiling;
    Physical Curve("rod") = {trailing};
    Physical Curve("leading") = {face};
    Mesh.Algorithm = 6;                  // frontal; 8 crashes gmsh 4.8
    Mesh.RecombinationAlgorithm = 3;     // no triangle is left over
EndIf

// --- the base -----------------------------------------------------------------------------------
// Below pads and gaps in columns as theirs, with cells as theirs; from the floor down heights grow
// as those of the block do upwards.
below[] = {};
If (base_height > 0)
    small = fine / ratio;
    large = coarse < base_height / 2 ? coarse : base_height / 2;
    down = Ceil(base_height / small - 1e-6);
    growth = 1;
    If (large > 1.001 * small)
        down = 1 + Ceil(Log(large / small) / Log((base_height - small) / (base_height - large)) - 1e-6);
        growth = down > 1 ? (large / small) ^ (1 / (down - 1)) : 1;
    EndIf
    places[] = {};
    If (behind > 0)
        places[] += {-behind};
    EndIf
    first = #places[];                             // the column below the block's own first
    places[] += xs[];
    If (before > 0)
        places[] += {length + before};
    EndIf
    floors[] = {};
    bottoms[] = {};
    sides[] = {};
    upper = newp;
    For k In {0 : #places[] - 1}
        Point(upper + 2 * k) = {places[k], 0, 0};
        Point(upper + 2 * k + 1) = {places[k], -base_height, 0};
        side = newl;
        Line(side) = {upper + 2 * k, upper + 2 * k + 1};
        Transfinite Curve{side} = down + 1 Using Progression growth;
        sides[] += side;
    EndFor
    For k In {0 : #places[] - 2}
        edge = newl;
        Line(edge) = {upper + 2 * k, upper + 2 * k + 2};
        foundation = newl;
        Line(foundation) = {upper + 2 * k + 1, upper + 2 * k + 3};
        column = k - first;                        // of the block
        is_below = column >= 0 && column < columns;
        is_pad = is_below && solid[is_below ? column + 1 : 0];
        wide = places[k + 1] - places[k];
        cells = size_contact > 0 || !is_below ? Ceil(wide / fine - 1e-6) : (is_pad ? cells_pad : cells_gap);
        cells = ratio * cells < 1 ? 1 : Floor(ratio * cells + 0.5);
        Transfinite Curve{edge, foundation} = cells + 1 Using Bump (is_pad ? 1 / grade : 1);
        outline = newll;
        Curve Loop(outline) = {-edge, sides[k], foundation, -sides[k + 1]};
        area = news;
        Plane Surface(area) = {outline};
        Transfinite Surface{area};
        below[] += area;
        floors[] += edge;
        bottoms[] += foundation;
    EndFor
    Physical Surface("base") = below[];
    Physical Curve("floor") = floors[];
    Physical Curve("bottom") = bottoms[];
    Physical Curve("base_rear") = {sides[0]};
    Physical Curve("base_front") = {sides[#sides[] - 1]};
EndIf

Physical Surface("body") = surfaces[];
If (#feet[] > 0)        // rows and columns: the pads are a surface of their own
    Physical Surface("body") -= feet[];
    Physical Surface("pads") = feet[];
EndIf
Physical Curve("top") = tops[];
If (StrCmp(shape, "quad") == 0)
    Recombine Surface{surfaces[], below[]};
EndIf
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
