// SPDX-License-Identifier: GPL-2.0-or-later
// The boundary of a box of every element is as large as the box's, its outline twelve edges; a cut
// leaves what geometry says, and a linear field is itself on the section of distorted elements.
#include "render/view/surface.h"

#include "cases.h"
#include "space_mesh.h"

enum { KINDS = 5 };

static const ElementKind kinds[KINDS] = {ELEMENT_TET4, ELEMENT_TET10, ELEMENT_WEDGE6, ELEMENT_HEX8,
                                         ELEMENT_HEX27};
static const double box[3] = {1, 0.8, 0.6};

static double field_at(const double *place)
{
    return 0.3 + place[0] - 2 * place[1] + 0.5 * place[2];
}

// A box of 3 x 2 x 2 cells, drawn as it was but moved by (0.1, 0, 0).
static Block make_block(ElementKind kind, double distortion)
{
    SpaceDef def = {.kind = kind, .cells = {3, 2, 2}, .distortion = distortion, .seed = 5};
    memcpy(def.size, box, sizeof box);
    MeshFile file = space_file(&def);
    Error err = {0};
    Block block = {.frame = {.dim = 3,
                             .stresses = 6,
                             .node_count = file.node_count,
                             .position = file.position,
                             .element_count = file.element_count,
                             .kind = file.kind,
                             .first_node = file.first_node,
                             .element_nodes = file.element_nodes}};
    block.value = NEW_ARRAY(double, file.node_count, &err);
    block.moved = memory_array(file.node_count, sizeof *block.moved, &err);
    assert_true(error_is_clean(&err));
    for (int32_t i = 0; i < file.node_count; ++i) {
        block.value[i] = field_at(file.position + 3 * i);
        memcpy(block.moved[i], file.position + 3 * i, sizeof block.moved[i]);
        block.moved[i][0] += 0.1;
    }
    file.position = NULL;
    file.kind = NULL;
    file.first_node = file.element_nodes = NULL;
    mesh_file_destroy(&file);
    return block;
}

static double area_of(const SurfaceParts *triangles)
{
    double sum = 0;
    for (int32_t t = 0; t < triangles->count; ++t) {
        const SurfacePoint *p = triangles->points + 3 * t;
        double a[3], b[3], square = 0;
        for (int d = 0; d < 3; ++d) {
            a[d] = p[1].at[d] - p[0].at[d];
            b[d] = p[2].at[d] - p[0].at[d];
        }
        for (int d = 0; d < 3; ++d)
            square += pow(a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3], 2);
        sum += sqrt(square) / 2;
    }
    return sum;
}

static double length_of(const SurfaceParts *lines)
{
    double sum = 0;
    for (int32_t k = 0; k < lines->count; ++k) {
        double square = 0;
        for (int d = 0; d < 3; ++d)
            square += pow(lines->points[2 * k + 1].at[d] - lines->points[2 * k].at[d], 2);
        sum += sqrt(square);
    }
    return sum;
}

// The cut `words`: area and outline, and the field at every corner. Sides of wedges that are no
// longer flat are cut into triangles from either side by another diagonal: a crack of 4e-4
// of area and outline here, none where they are flat.
static void check_with(double distortion, ElementKind kind, const char *words, double area,
                       double outline)
{
    Error err = {0};
    Surface surface;
    SpaceCut cut;
    Block block = make_block(kind, distortion);
    bool cracks = kind == ELEMENT_WEDGE6 && distortion > 0;
    assert_true(space_cut_read(words, &cut, &err));
    assert_true(surface_build(&block, &cut, false, 0, &surface, &err));
    assert_near(ELEMENTS[kind].name, area_of(&surface.triangles), area, cracks ? 2e-3 : 1e-12);
    assert_near(ELEMENTS[kind].name, length_of(&surface.outline), outline, cracks ? 1e-2 : 1e-12);
    for (int64_t k = 0; k < 3 * (int64_t)surface.triangles.count; ++k) {
        const SurfacePoint *point = &surface.triangles.points[k];
        assert_near("field", point->value, field_at(point->was), 1e-12);
        assert_near("place", point->at[0] - 0.1, point->was[0], 1e-12);
    }
    surface_destroy(&surface);
    block_destroy(&block);
}

static void check(ElementKind kind, const char *words, double area, double outline)
{
    check_with(0, kind, words, area, outline);
    check_with(0.15, kind, words, area, outline);
}

TEST(a_box_has_its_boundary)
{
    for (int k = 0; k < KINDS; ++k)
        check(kinds[k], NULL, 2 * (1 * 0.8 + 1 * 0.6 + 0.8 * 0.6), 4 * (1 + 0.8 + 0.6));
}

// y = 0.3: what is left is a box of 1 x 0.5 x 0.6.
TEST(one_plane_leaves_a_box)
{
    for (int k = 0; k < KINDS; ++k)
        check(kinds[k], "y=0.3", 2 * (1 * 0.5 + 1 * 0.6 + 0.5 * 0.6), 4 * (1 + 0.5 + 0.6));
}

// A corner of 0.35 x 0.3 x 0.2 is taken out: the area stays; the outline loses three edges of that
// size, and has nine new ones.
TEST(three_planes_take_a_corner)
{
    for (int k = 0; k < KINDS; ++k)
        check(kinds[k], "x=0.35,y=0.3,z=0.4", 2 * (1 * 0.8 + 1 * 0.6 + 0.8 * 0.6),
              4 * (1 + 0.8 + 0.6) + 2 * (0.35 + 0.3 + 0.2));
}

TEST(cuts_are_checked)
{
    static const char *const bad[] = {"w=1", "y", "y=", "y=1;", "x=1,y=2,z=3,x=4", "y=0.2 m"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        Error err = {0};
        SpaceCut cut;
        assert_false(space_cut_read(bad[k], &cut, &err));
        assert_int_equal(err.code, ERROR_INPUT);
    }
}

// Right is along x, up is up, and what is nearer to low y is nearer; lengths at the middle stay.
TEST(the_camera_stands_before_the_block)
{
    static const double low[3] = {0, 0, 0};
    Camera camera = camera_before(low, box);
    double middle[3] = {0.5, 0.4, 0.3}, seen[3], other[3];
    camera_see(&camera, middle, seen);
    assert_near("middle", seen[0] + seen[1], 0, 1e-12);
    for (int d = 0; d < 3; ++d) {
        double place[3] = {0.5, 0.4, 0.3};
        place[d] += 1e-5;
        camera_see(&camera, place, other);
        double moved = hypot(other[0] - seen[0], other[1] - seen[1]) / 1e-5;
        double away = (other[2] - seen[2]) / 1e-5;
        assert_near("lengths", moved * moved + away * away, 1, 1e-4);
        if (d == 0) assert_true(other[0] > seen[0] + 0.8e-5);
        if (d == 1) assert_true(other[2] > seen[2] && other[0] < seen[0]);
        if (d == 2) assert_true(other[1] > seen[1] + 0.8e-5 && fabs(other[0] - seen[0]) < 1e-12);
    }
    // No point of the floor is hidden: its far corner is seen below the box's near lower one.
    double drop = camera_drop(low, box), far[3] = {1, 0.8, -drop};
    camera_see(&camera, low, seen);
    camera_see(&camera, far, other);
    assert_true(other[1] < seen[1] + 0.05);
}
