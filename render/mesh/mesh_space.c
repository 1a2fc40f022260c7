// SPDX-License-Identifier: GPL-2.0-or-later
// Faces that look away are left out, the others drawn from the farthest to the nearest.
#include "render/mesh/mesh_space.h"

#include "base/memory.h"
#include "base/order.h"
#include "render/view/camera.h"
#include "render/view/outer_faces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GROUPS_MAX = 64 };   // more are drawn as if they had no name

static const double ROUNDING = 1e-6;   // of heights, over the block's
static const double EDGE_WIDTH = 0.22;   // points
static const double NAME_MARGIN = 1.5;   // points of paper around a contact's name
static const Color EDGE = {0.40f, 0.43f, 0.48f, 1};
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

static bool is_contact(const MeshGroup *group)
{
    return group->dimension == 2 && strncmp(group->name, "contact", 7) == 0;
}

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

double mesh_space_shape(const RenderMesh *mesh)
{
    MeshView view = view_of(mesh);
    return (view.high[1] - view.low[1]) / (view.high[0] - view.low[0]);
}

// Marks each node with the groups that it belongs to.
static bool mark_groups(MeshView *view, Error *err)
{
    const RenderMesh *mesh = view->mesh;
    view->groups = NEW_ARRAY(uint64_t, mesh->node_count, err);
    if (!view->groups) return false;
    for (int32_t g = 0; g < mesh->group_count && g < GROUPS_MAX; ++g) {
        const MeshGroup *group = &mesh->groups[g];
        if (group->dimension != 2) continue;
        for (int32_t k = 0; k < group->nodes_per_face * group->face_count; ++k)
            if (group->face_nodes[k] >= 0) view->groups[group->face_nodes[k]] |= (uint64_t)1 << g;
    }
    return true;
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

// In its middle on the floor: colours repeat.
static void draw_contact_name(const Page *page, const MeshView *view, const Axes *axes,
                              const MeshGroup *group)
{
    int32_t nodes = group->nodes_per_face * group->face_count;
    Point middle = {0, 0};
    for (int32_t k = 0; k < nodes; ++k) {
        double seen[3];
        see(view, group->face_nodes[k], true, seen);
        Point at = axes_place(axes, seen[0], seen[1]);
        middle = (Point){middle.x + at.x / nodes, middle.y + at.y / nodes};
    }
    TextStyle style = {.size = SMALL_SIZE * page->point, .color = INK, .across = 0.5, .up = 0.5};
    const char *number = strncmp(group->name, "contact_", 8) == 0 ? group->name + 8 : "";
    const char *name = number[0] ? number : group->name;
    double half = text_width(page->text, style.size, name) / 2 + NAME_MARGIN * page->point;
    double up = style.size / 2 + NAME_MARGIN * page->point / 2;
    draw_fill(page->canvas, PAPER,
              &(Box){middle.x - half, middle.y - up, middle.x + half, middle.y + up});
    text_draw(page->text, &style, middle, name);
}

bool mesh_space_draw(const RenderMesh *mesh, const Page *page, const Box *box, const Color *color,
                     Error *err)
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
    TRY(mark_groups(&view, err));
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
    Stroke edge = {.color = EDGE, .width = EDGE_WIDTH * page->point};
    qsort(faces, (size_t)seen, sizeof *faces, order_doubles);
    for (int32_t f = 0; f < seen; ++f) {
        draw_polygon(page->canvas, faces[f].color, faces[f].corner, faces[f].corners);
        for (int32_t k = 0; k < faces[f].corners; ++k)
            draw_segment(page->canvas, &edge, faces[f].corner[k],
                         faces[f].corner[(k + 1) % faces[f].corners]);
    }
    for (int32_t g = 0; g < mesh->group_count; ++g)
        if (is_contact(&mesh->groups[g]) && mesh->groups[g].face_count > 0)
            draw_contact_name(page, &view, &axes, &mesh->groups[g]);
cleanup:
    memory_free_all(outer, faces, view.groups);
    return error_is_clean(err);
}
