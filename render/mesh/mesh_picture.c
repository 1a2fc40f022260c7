// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh as it is before anything is computed, drawn to scale from the arrays handed in: its
// elements, the named curves in colours with their names, the strip the rod pushes; in space in
// perspective, its outside in the colours of its groups, and below it its contact once more.
#include "render/render.h"

#include "base/memory.h"
#include "base/order.h"
#include "render/canvas/key.h"
#include "render/figures/rod_mark.h"
#include "render/view/camera.h"
#include "render/view/outer_faces.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REGIONS = 6, CONTACTS = 6 };

static const double MARGIN = 0.09;   // of the mesh's larger extent, kept around it for names
static const double EDGE_WIDTH = 0.22;   // points: edges of elements
static const double CURVE_WIDTH_NAMED = 1.6;   // points: named curves
static const double NAME_GAP = 3.0;   // points: curve to its name
static const double HEAD_HEIGHT = 11;   // points: the lines above the frame, each
static const double LEFT = 32, RIGHT = 10;   // points: beside the frame, half a number
static const double SIDE_MAX = 1.4;   // the picture's height over its width, at most

static const Color EDGE = {0.55f, 0.58f, 0.63f, 1};
// Surfaces that are named differ in lightness too, for print in grey.
static const Color REGION[REGIONS] = {{0.93f, 0.94f, 0.96f, 1}, {0.95f, 0.80f, 0.55f, 1},
                                      {0.60f, 0.80f, 0.86f, 1}, {0.80f, 0.66f, 0.80f, 1},
                                      {0.98f, 0.93f, 0.68f, 1}, {0.62f, 0.62f, 0.60f, 1}};
static const Color TOP = {0.10f, 0.32f, 0.66f, 1};
static const Color CONTACT[CONTACTS] = {{0.05f, 0.45f, 0.30f, 1}, {0.45f, 0.62f, 0.10f, 1},
                                        {0.00f, 0.55f, 0.62f, 1}, {0.48f, 0.36f, 0.10f, 1},
                                        {0.20f, 0.75f, 0.50f, 1}, {0.72f, 0.60f, 0.15f, 1}};
static const Color OTHER = {0.45f, 0.25f, 0.55f, 1};

// A block stands on z = 0 but for rounding, length.
static const double BASE_BELOW = -1e-9;

typedef struct MeshPage {
    const RenderMesh *mesh;
    Page *page;
    Axes axes;
    bool base_below;   // the names of contact and floor stand in the block and in the base
} MeshPage;

static Point node_place(const MeshPage *map, int32_t node)
{
    const double *at = map->mesh->position + 2 * (int64_t)node;
    return axes_place(&map->axes, at[0], at[1]);
}

// --- layout -------------------------------------------------------------------------------------

static void name_axis(Axis *axis, const char *name, const char *unit)
{
    if (unit && strcmp(unit, "m") == 0)
        axis_set_unit(axis, name, unit);
    else
        snprintf(axis->label, sizeof axis->label, "%s%s%.40s", name, unit ? " / " : "",
                 unit ? unit : " (the mesh's unit)");
}

// Ranges of both axes, margins included, and the picture's size that draws them to scale.
static void choose_ranges(const RenderMesh *mesh, Axes *axes)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int64_t k = 0; k < 2 * (int64_t)mesh->node_count; ++k) {
        low[k % 2] = fmin(low[k % 2], mesh->position[k]);
        high[k % 2] = fmax(high[k % 2], mesh->position[k]);
    }
    double margin = MARGIN * fmax(high[0] - low[0], high[1] - low[1]);
    axes->x = (Axis){.low = low[0] - margin, .high = high[0] + margin, .factor = 1};
    axes->y = (Axis){.low = low[1] - margin, .high = high[1] + margin, .factor = 1};
    name_axis(&axes->x, "~{x}", mesh->unit);
    name_axis(&axes->y, "~{z}", mesh->unit);
    if (axes->y.factor != axes->x.factor) {   // one unit for both
        Axis *finer = axes->y.factor > axes->x.factor ? &axes->y : &axes->x;
        const Axis *coarser = finer == &axes->y ? &axes->x : &axes->y;
        finer->factor = coarser->factor;
        snprintf(finer->label, sizeof finer->label, "%s%s", finer == &axes->y ? "~{z}" : "~{x}",
                 coarser->label + 4);
    }
}

// The frame's height over its width.
static double frame_shape(const Axes *axes)
{
    return (axes->y.high - axes->y.low) / (axes->x.high - axes->x.low);
}

// Room above the frame for title and note, points.
static double head_points(const RenderMesh *mesh)
{
    return 4 + HEAD_HEIGHT * ((mesh->title && mesh->title[0]) + (mesh->note && mesh->note[0]));
}

// --- elements -----------------------------------------------------------------------------------

// The outline [n] of an element, through the middles of its sides where it has them.
static int32_t element_outline(const MeshPage *map, int32_t e, Point *outline)
{
    const RenderMesh *mesh = map->mesh;
    const int32_t *nodes = mesh->element_nodes + mesh->first_node[e];
    int32_t corners = element_corner_count((ElementKind)mesh->kind[e]), count = 0;
    bool curved = mesh->first_node[e + 1] - mesh->first_node[e] >= 2 * corners;
    for (int32_t k = 0; k < corners; ++k) {
        outline[count++] = node_place(map, nodes[k]);
        if (curved) outline[count++] = node_place(map, nodes[corners + k]);
    }
    return count;
}

static void draw_elements(const MeshPage *map)
{
    Point outline[9];
    Canvas *canvas = map->page->canvas;
    const Box *box = &map->axes.box;

    // Fine meshes get thinner edges: a tenth of the typical element at most.
    double area = (box->right - box->left) * (box->bottom - box->top);
    double width = 0.1 * sqrt(area / map->mesh->element_count);
    Stroke stroke = {.color = EDGE, .width = fmin(EDGE_WIDTH * map->page->point, width)};
    for (int32_t e = 0; e < map->mesh->element_count; ++e)
        draw_polygon(canvas, REGION[0], outline, element_outline(map, e, outline));
    for (int32_t g = 0, region = 0; g < map->mesh->group_count; ++g) {
        const MeshGroup *group = &map->mesh->groups[g];
        if (group->dimension != 2 || group->element_count == 0) continue;
        for (int32_t k = 0; k < group->element_count; ++k)
            draw_polygon(canvas, REGION[region % REGIONS], outline,
                         element_outline(map, group->elements[k], outline));
        ++region;
    }
    for (int32_t e = 0; e < map->mesh->element_count; ++e) {
        int32_t count = element_outline(map, e, outline);
        for (int32_t k = 0; k < count; ++k)
            draw_segment(canvas, &stroke, outline[k], outline[(k + 1) % count]);
    }
}

// --- named curves -------------------------------------------------------------------------------

static bool is_contact(const MeshGroup *group)
{
    return strncmp(group->name, "contact", 7) == 0;
}

// Neighbouring pads differ, so that their ends are seen; each is named where it is.
static Color group_color(const MeshGroup *group, int32_t contact)
{
    if (is_contact(group)) return CONTACT[contact % CONTACTS];
    if (strcmp(group->name, "top") == 0) return TOP;
    if (strcmp(group->name, "rod") == 0) return ROD_COLOR;
    return OTHER;
}

static Box curve_extent(const MeshPage *map, const MeshGroup *group)
{
    Box extent = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (int32_t k = 0; k < group->nodes_per_face * group->face_count; ++k) {
        Point place = node_place(map, group->face_nodes[k]);
        extent.left = fmin(extent.left, place.x);
        extent.right = fmax(extent.right, place.x);
        extent.top = fmin(extent.top, place.y);
        extent.bottom = fmax(extent.bottom, place.y);
    }
    return extent;
}

// Name of a curve: "contact_3" as it is, "pad 3" or "3", by `form` 0, 1, 2.
static const char *group_name(const MeshGroup *group, int32_t form, char name[GROUP_NAME_SIZE + 4])
{
    bool numbered = is_contact(group) && strncmp(group->name, "contact_", 8) == 0;
    if (form == 0 || !numbered || !group->name[8]) return group->name;
    snprintf(name, GROUP_NAME_SIZE + 4, "%s%s", form == 1 ? "pad " : "", group->name + 8);
    return name;
}

static void draw_groups(const MeshPage *map)
{
    const Page *page = map->page;
    int32_t contact = 0, form = 0;

    // All contacts are called alike, by the longest form that fits below each.
    for (int32_t g = 0; g < map->mesh->group_count; ++g) {
        const MeshGroup *group = &map->mesh->groups[g];
        char name[GROUP_NAME_SIZE + 4];
        if (group->dimension != 1 || group->face_count == 0 || !is_contact(group)) continue;
        Box extent = curve_extent(map, group);
        while (form < 2 && text_width(page->text, NUMBER_SIZE * page->point,
                                      group_name(group, form, name)) > extent.right - extent.left)
            ++form;
    }

    for (int32_t g = 0; g < map->mesh->group_count; ++g) {
        const MeshGroup *group = &map->mesh->groups[g];
        if (group->dimension != 1 || group->face_count == 0) continue;
        Color color = group_color(group, contact);
        contact += is_contact(group);
        Stroke stroke = {.color = color, .width = CURVE_WIDTH_NAMED * page->point};
        for (int32_t k = 0; k < group->face_count; ++k) {
            const int32_t *nodes = group->face_nodes + (int64_t)k * group->nodes_per_face;
            Point from = node_place(map, nodes[0]), to = node_place(map, nodes[1]);
            Point through = group->nodes_per_face == 3 ? node_place(map, nodes[2]) : to;
            const Point line[3] = {from, through, to};
            draw_line(page->canvas, &stroke, line, 3);
        }

        // Its name, outside the mesh, beside the middle of the curve: below or above a level one,
        // left or right of an upright one.
        const Box *box = &map->axes.box;
        Box extent = curve_extent(map, group);
        double gap = NAME_GAP * page->point, middle = (box->left + box->right) / 2;
        double x = (extent.left + extent.right) / 2, y = (extent.top + extent.bottom) / 2;
        TextStyle style = {.size = NUMBER_SIZE * page->point, .color = color, .across = 0.5};
        char buffer[GROUP_NAME_SIZE + 4];
        const char *name = group_name(group, form, buffer);
        if (extent.right - extent.left >= extent.bottom - extent.top) {
            bool below = y > (box->top + box->bottom) / 2;
            if (map->base_below && is_contact(group)) below = false;   // the base is there
            if (map->base_below && strcmp(group->name, "floor") == 0) below = true;
            style.up = below ? 1 : 0;
            text_draw(page->text, &style, (Point){x, y + (below ? gap : -gap)}, name);
            continue;
        }
        style.rising = true;
        if (isfinite(map->mesh->rod_low)) y = (extent.top + y) / 2;   // the middle is the arrow's
        double right = text_digit_height() * style.size + gap;   // the baseline is on the right
        text_draw(page->text, &style, (Point){x < middle ? x - gap : x + right, y}, name);
    }
}

static void draw_head(const MeshPage *map)
{
    const char *lines[2] = {map->mesh->title, map->mesh->note};
    double point = map->page->point, y = map->axes.box.top - 4 * point;
    double room = canvas_width(map->page->canvas) - map->axes.box.left - RIGHT * point;
    TextStyle style = {.color = INK};
    for (int32_t k = 1; k >= 0; --k) {
        if (!lines[k] || !lines[k][0]) continue;
        style.size = (k == 0 ? LABEL_SIZE : SMALL_SIZE) * point;
        text_draw_within(map->page->text, &style, (Point){map->axes.box.left, y}, room, lines[k]);
        y -= HEAD_HEIGHT * point;
    }
}

// --- in space -----------------------------------------------------------------------------------

enum { GROUPS_MAX = 64 };   // more are drawn as if they had no name

static const double ROUNDING = 1e-6;   // of heights, over the block's
static const double NAME_MARGIN = 1.5;   // points of paper around a contact's name
static const Color SPACE_EDGE = {0.40f, 0.43f, 0.48f, 1};
static const Color PLAIN = {0.93f, 0.94f, 0.96f, 1};
static const Color SHADE = {0.86f, 0.88f, 0.92f, 1};   // faces without a name that stand upright

typedef struct SeenFace {
    double nearness;   // the smaller the farther; first, for the order
    Point corner[FACE_CORNERS_MAX];
    int32_t corners;
    Color color;
} SeenFace;

typedef struct MeshView {
    const RenderMesh *mesh;
    const Color *color;
    Camera camera;
    double drop;   // from the block to its contact as drawn, length
    double low[2], high[2];   // what the camera sees, length
    uint64_t *groups;   // [node_count] bits of those of surfaces that a node belongs to; owned
} MeshView;

static void see(const MeshView *view, int32_t node, bool below, double seen[3])
{
    double place[3];
    memcpy(place, view->mesh->position + 3 * (int64_t)node, sizeof place);
    if (below) place[2] -= view->drop;
    camera_see(&view->camera, place, seen);
}

static MeshView view_of(const RenderMesh *mesh)
{
    MeshView view = {.mesh = mesh, .low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int64_t k = 0; k < 3 * (int64_t)mesh->node_count; ++k) {
        low[k % 3] = fmin(low[k % 3], mesh->position[k]);
        high[k % 3] = fmax(high[k % 3], mesh->position[k]);
    }
    double floor = low[2] + ROUNDING * (high[2] - low[2]);
    view.camera = camera_before(low, high);
    view.drop = camera_drop(low, high);
    for (int32_t node = 0; node < mesh->node_count; ++node)
        for (int32_t below = 0; below < 2; ++below) {
            double seen[3];
            see(&view, node, below && mesh->position[3 * (int64_t)node + 2] <= floor, seen);
            for (int32_t d = 0; d < 2; ++d) {
                view.low[d] = fmin(view.low[d], seen[d]);
                view.high[d] = fmax(view.high[d], seen[d]);
            }
        }
    return view;
}

// The height over the width of what the camera sees.
static double view_shape(const RenderMesh *mesh)
{
    MeshView view = view_of(mesh);
    return (view.high[1] - view.low[1]) / (view.high[0] - view.low[0]);
}

// The group of surfaces that all corners belong to; -1: none does.
static int32_t group_of(const MeshView *view, const int32_t *nodes, int32_t corners)
{
    uint64_t common = ~(uint64_t)0;
    for (int32_t k = 0; k < corners; ++k) common &= view->groups[nodes[k]];
    for (int32_t g = 0; g < GROUPS_MAX; ++g)
        if (common >> g & 1) return g;
    return -1;
}

// false: it looks away; `below` it is seen from above, whichever way it looks.
static bool see_face(const MeshView *view, const Axes *axes, const int32_t *nodes, int32_t corners,
                     bool below, SeenFace *face)
{
    double turned = 0;
    *face = (SeenFace){.corners = corners};
    for (int32_t k = 0; k < corners; ++k) {
        double seen[3];
        see(view, nodes[k], below, seen);
        face->corner[k] = axes_place(axes, seen[0], seen[1]);
        face->nearness -= seen[2] / corners;
    }
    for (int32_t k = 0; k < corners; ++k) {
        const Point *a = &face->corner[k], *b = &face->corner[(k + 1) % corners];
        turned += a->x * b->y - b->x * a->y;
    }
    int32_t group = group_of(view, nodes, corners);
    const double *first = view->mesh->position + 3 * (int64_t)nodes[0];
    const double *third = view->mesh->position + 3 * (int64_t)nodes[2];
    face->color = group >= 0 ? view->color[group] : first[2] == third[2] ? PLAIN : SHADE;
    if (below) face->nearness -= 1e6 * view->camera.distance;   // behind all else
    return below || turned < 0;   // counter-clockwise from outside; y goes down on the page
}

// The outside of the mesh in `box`, in the colours of its groups of surfaces, [group_count]: faces
// that look away are left out, the others drawn from the farthest to the nearest.
static bool draw_outside(const RenderMesh *mesh, const Page *page, const Box *box,
                         const Color *color, Error *err)
{
    ElementList elements = {mesh->element_count, mesh->kind, mesh->first_node, mesh->element_nodes};
    MeshView view = view_of(mesh);
    OuterFace *outer = NULL;
    SeenFace *faces = NULL;
    int32_t count = 0, seen = 0;
    Axes axes = {.box = *box,
                 .x = {.low = view.low[0], .high = view.high[0], .factor = 1},
                 .y = {.low = view.low[1], .high = view.high[1], .factor = 1}};
    view.color = color;

    // Marks each node with the groups of surfaces that it belongs to.
    TRY(view.groups = NEW_ARRAY(uint64_t, mesh->node_count, err));
    for (int32_t g = 0; g < mesh->group_count && g < GROUPS_MAX; ++g) {
        const MeshGroup *group = &mesh->groups[g];
        if (group->dimension != 2) continue;
        for (int32_t k = 0; k < group->nodes_per_face * group->face_count; ++k)
            if (group->face_nodes[k] >= 0) view.groups[group->face_nodes[k]] |= (uint64_t)1 << g;
    }

    TRY(outer_faces(&elements, &outer, &count, err));
    TRY(faces = NEW_ARRAY(SeenFace, 2 * (int64_t)count, err));
    for (int32_t f = 0; f < count; ++f) {
        int32_t nodes[FACE_NODES_MAX];
        ElementKind kind;
        outer_face_nodes(&elements, &outer[f], &kind, nodes);
        int32_t corners = element_corner_count(kind), group = group_of(&view, nodes, corners);
        seen += see_face(&view, &axes, nodes, corners, false, &faces[seen]);
        if (group >= 0 && is_contact(&mesh->groups[group]))
            seen += see_face(&view, &axes, nodes, corners, true, &faces[seen]);
    }
    Stroke edge = {.color = SPACE_EDGE, .width = EDGE_WIDTH * page->point};
    qsort(faces, (size_t)seen, sizeof *faces, order_doubles);
    for (int32_t f = 0; f < seen; ++f) {
        draw_polygon(page->canvas, faces[f].color, faces[f].corner, faces[f].corners);
        for (int32_t k = 0; k < faces[f].corners; ++k)
            draw_segment(page->canvas, &edge, faces[f].corner[k],
                         faces[f].corner[(k + 1) % faces[f].corners]);
    }

    // The name of each contact in its middle on the floor, as colours repeat.
    TextStyle style = {.size = SMALL_SIZE * page->point, .color = INK, .across = 0.5, .up = 0.5};
    for (int32_t g = 0; g < mesh->group_count; ++g) {
        const MeshGroup *group = &mesh->groups[g];
        int32_t nodes = group->nodes_per_face * group->face_count;
        Point middle = {0, 0};
        if (group->dimension != 2 || !is_contact(group) || group->face_count == 0) continue;
        for (int32_t k = 0; k < nodes; ++k) {
            double place[3];
            see(&view, group->face_nodes[k], true, place);
            Point at = axes_place(&axes, place[0], place[1]);
            middle = (Point){middle.x + at.x / nodes, middle.y + at.y / nodes};
        }
        const char *number = strncmp(group->name, "contact_", 8) == 0 ? group->name + 8 : "";
        const char *name = number[0] ? number : group->name;
        double half = text_width(page->text, style.size, name) / 2 + NAME_MARGIN * page->point;
        double up = style.size / 2 + NAME_MARGIN * page->point / 2;
        draw_fill(page->canvas, PAPER,
                  &(Box){middle.x - half, middle.y - up, middle.x + half, middle.y + up});
        text_draw(page->text, &style, middle, name);
    }
cleanup:
    memory_free_all(outer, faces, view.groups);
    return error_is_clean(err);
}

// --- the module's third entry -------------------------------------------------------------------

static void draw_page(const RenderMesh *mesh, Page *page)
{
    MeshPage map = {.mesh = mesh, .page = page};
    for (int32_t node = 0; node < mesh->node_count; ++node)
        map.base_below = map.base_below || mesh->position[2 * (int64_t)node + 1] < BASE_BELOW;

    // A single surface needs no name.
    KeyEntry entries[REGIONS];
    int32_t count = 0;
    for (int32_t g = 0; g < map.mesh->group_count && count < REGIONS; ++g) {
        const MeshGroup *group = &map.mesh->groups[g];
        if (group->dimension != 2 || group->element_count == 0) continue;
        entries[count] = (KeyEntry){KEY_PATCH, REGION[count], group->name};
        ++count;
    }
    if (count > 1) key_draw(map.page, entries, count);

    // The largest frame of the block's shape that fits, in the middle.
    double point = page->point;
    Axes *axes = &map.axes;
    choose_ranges(mesh, axes);
    double width = canvas_width(page->canvas) - (LEFT + RIGHT) * point;
    double height = page->room.bottom - (head_points(mesh) + axes_bottom_margin(axes)) * point;
    double shape = frame_shape(axes), narrow = fmin(width, height / shape);
    axes->box.left = round(LEFT * point + (width - narrow) / 2);
    axes->box.right = axes->box.left + round(narrow);
    axes->box.top = round(head_points(mesh) * point);
    axes->box.bottom = axes->box.top + round(narrow * shape);

    canvas_clip(page->canvas, &map.axes.box);
    draw_elements(&map);
    draw_groups(&map);
    RodMark rod = {INFINITY, mesh->rod_low, mesh->rod_high, 1};
    for (int32_t node = 0; node < mesh->node_count; ++node) {
        const double *place = mesh->position + 2 * (int64_t)node;
        if (rod_mark_pushes(rod.low, rod.high, place[1])) rod.face = fmin(rod.face, place[0]);
    }
    rod_mark_draw(page, axes, &rod);
    canvas_clip(page->canvas, NULL);
    draw_head(&map);
    axes_draw(page, axes);
}

// Groups of surfaces in colours, which a key names unless they have their names on them; in the
// middle of what is left.
static bool draw_space(const RenderMesh *mesh, Page *page, Error *err)
{
    enum { NAMES = 12 };
    KeyEntry entries[NAMES + 1];
    int32_t count = 0, contact = 0;
    Color *color = NEW_ARRAY(Color, mesh->group_count, err);
    if (!color) return false;
    for (int32_t g = 0; g < mesh->group_count; ++g) {
        const MeshGroup *group = &mesh->groups[g];
        if (group->dimension != 2) continue;
        bool known = is_contact(group) || strcmp(group->name, "top") == 0 ||
                     strcmp(group->name, "rod") == 0;
        color[g] = known ? group_color(group, contact) : REGION[1 + count % (REGIONS - 1)];
        contact += is_contact(group);
        if (count < NAMES && !is_contact(group))
            entries[count++] = (KeyEntry){KEY_PATCH, color[g], group->name};
    }
    if (contact > 1) entries[count++] = (KeyEntry){.words = "n: contact_n"};
    key_draw(page, entries, count);
    MeshPage map = {.mesh = mesh, .page = page};
    double margin = RIGHT * page->point, width = canvas_width(page->canvas) - 2 * margin;
    double top = head_points(mesh) * page->point, height = page->room.bottom - margin - top;
    double shape = view_shape(mesh), narrow = fmin(width, height / shape);
    map.axes.box.left = margin + (width - narrow) / 2;
    map.axes.box.right = map.axes.box.left + narrow;
    map.axes.box.top = top;
    map.axes.box.bottom = top + narrow * shape;
    bool done = draw_outside(mesh, page, &map.axes.box, color, err);
    map.axes.box.left = margin;
    draw_head(&map);
    memory_free(color);
    return done;
}

__attribute__((visibility("default"))) bool amontons_render_mesh(const RenderMesh *mesh,
                                                                 const char *path, Error *err)
{
    Page page = {0};
    PictureStyle style = mesh->style;
    TRY(page_style_of_name(path, &style, err));

    // The picture's height over its width: to scale, but no more than SIDE_MAX. A single surface
    // needs no name.
    double width = page_width(&style), height = 0;
    if (mesh->dim > 2) {
        height = view_shape(mesh) * (width - 2 * RIGHT) + key_line_height();
        height += head_points(mesh);
        height += 2 * RIGHT;
    } else {
        int32_t regions = 0;
        Axes axes = {0};
        choose_ranges(mesh, &axes);
        for (int32_t g = 0; g < mesh->group_count; ++g)
            regions += mesh->groups[g].dimension == 2 && mesh->groups[g].element_count > 0;
        height = (width - LEFT - RIGHT) * frame_shape(&axes);
        if (regions > 1) height += key_line_height();
        height += head_points(mesh);
        height += axes_bottom_margin(&axes);
    }
    PageDef def = {.style = &style, .height = fmin(height / width, SIDE_MAX)};
    TRY(page_begin(&page, &def, err));
    if (mesh->dim > 2)
        TRY(draw_space(mesh, &page, err));
    else
        draw_page(mesh, &page);
    TRY(page_finish(&page, path, mesh->title ? mesh->title : "mesh", err));
cleanup:
    error_context(err, "picture %s", path);
    page_destroy(&page);
    return error_is_clean(err);
}
