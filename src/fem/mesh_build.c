// SPDX-License-Identifier: GPL-2.0-or-later
// All checks of a mesh; fem/mesh.h says what holds afterwards.
#include "fem/mesh.h"

#include "base/memory.h"
#include "fem/mesh_faces.h"
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A determinant counts as zero below this times the square of the element's longest edge. Round-off
// is 1e-16 of it; an element of aspect ratio 1e4 still has 2e-5 of it.
static const double AREA_TOLERANCE = 1e-12;

// The arrays came from io/mesh/mesh_file, which frees them.
void mesh_destroy(Mesh *mesh)
{
    MeshFile file = {.position = mesh->position,
                     .node_number = mesh->node_number,
                     .element_number = mesh->element_number,
                     .kind = mesh->kind,
                     .first_node = mesh->first_node,
                     .element_nodes = mesh->element_nodes,
                     .group_count = mesh->group_count,
                     .groups = mesh->groups};
    mesh_file_destroy(&file);
    memory_free_all(mesh->region, mesh->mean_next);
    *mesh = (Mesh){0};
}

// Moves the arrays; `file` is empty afterwards, so destroying both is always right.
static void take_over(MeshFile *file, const char *path, Mesh *mesh)
{
    *mesh = (Mesh){.dim = file->dim,
                   .node_count = file->node_count,
                   .position = file->position,
                   .node_number = file->node_number,
                   .element_count = file->element_count,
                   .element_number = file->element_number,
                   .kind = file->kind,
                   .first_node = file->first_node,
                   .element_nodes = file->element_nodes,
                   .group_count = file->group_count,
                   .groups = file->groups};
    snprintf(mesh->path, sizeof mesh->path, "%s", path);
    *file = (MeshFile){0};
}

// The block's extent. A node on no element would change it, but is an error.
static void find_extent(Mesh *mesh)
{
    double *low[DIM_MAX] = {&mesh->x_min, &mesh->y_min},
           *high[DIM_MAX] = {&mesh->x_max, &mesh->y_max};
    low[mesh->dim - 1] = &mesh->z_min;
    high[mesh->dim - 1] = &mesh->z_max;
    for (int32_t d = 0; d < mesh->dim; d++) {
        *low[d] = INFINITY;
        *high[d] = -INFINITY;
        for (int32_t i = 0; i < mesh->node_count; i++) {
            *low[d] = fmin(*low[d], mesh_place(mesh, i)[d]);
            *high[d] = fmax(*high[d], mesh_place(mesh, i)[d]);
        }
    }
}

// --- checks -------------------------------------------------------------------------------------

// The name of a group that holds node i, NULL: none. For errors: it searches all.
static const char *group_of_node(const Mesh *mesh, int32_t i)
{
    for (int32_t g = 0; g < mesh->group_count; g++)
        for (int32_t k = 0; k < mesh->groups[g].node_count; k++)
            if (mesh->groups[g].nodes[k] == i) return mesh->groups[g].name;
    return NULL;
}

// A node of no element has no stiffness: the matrix would be singular.
static bool check_nodes(const Mesh *mesh, Error *err)
{
    char at[PLACE_TEXT_SIZE];
    bool *used = NEW_ARRAY(bool, mesh->node_count, err);
    if (!used) goto cleanup;
    for (int32_t k = 0; k < mesh->first_node[mesh->element_count]; k++)
        used[mesh->element_nodes[k]] = true;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        if (used[i]) continue;
        const char *group = group_of_node(mesh, i);
        FAIL(err, ERROR_INPUT, "%s: node %lld at %s is on no %s element%s%s%s", mesh->path,
             (long long)mesh->node_number[i], mesh_place_text(mesh, i, at),
             mesh->dim == 2 ? "surface" : "volume", group ? "; it belongs to group '" : "",
             group ? group : "", group ? "'" : "");
    }
cleanup:
    memory_free(used);
    return error_is_clean(err);
}

// A quadrilateral with two corners in one node has a Jacobian of zero there.
static bool check_repeats(const Mesh *mesh, Error *err)
{
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++)
            for (int32_t b = mesh->first_node[e]; b < a; b++)
                if (mesh->element_nodes[a] == mesh->element_nodes[b])
                    return REFUSE(err, "%s: element %lld (%s) has node %lld twice", mesh->path,
                                  (long long)mesh->element_number[e], ELEMENTS[mesh->kind[e]].name,
                                  (long long)mesh->node_number[mesh->element_nodes[a]]);
    return true;
}

// Positions of the nodes of element e, and their mean; returns the longest distance from node 0 to
// the power of the dimension, the scale of its Jacobian.
static double gather(const Mesh *mesh, int32_t e, MeshPlace *position, MeshPlace centre)
{
    int32_t count = mesh->first_node[e + 1] - mesh->first_node[e];
    double scale = 0;
    mesh_places(mesh, mesh->element_nodes + mesh->first_node[e], count, position);
    memset(centre, 0, sizeof(MeshPlace));
    for (int32_t a = 0; a < count; a++) {
        double square = 0;
        for (int32_t d = 0; d < mesh->dim; d++) {
            double way = position[a][d] - position[0][d];
            centre[d] += position[a][d] / count;
            square += way * way;
        }
        scale = fmax(scale, square);
    }
    return pow(scale, mesh->dim / 2.0);
}

// Shape functions at the nodes and quadrature points of each kind, where Jacobians are looked at.
typedef struct ProbePoints {
    int32_t count[ELEMENT_KIND_COUNT];
    ShapeValues shape[ELEMENT_KIND_COUNT][ELEMENT_NODES_MAX + QUADRATURE_POINTS_MAX];
} ProbePoints;

// Evaluated once a mesh. At nodes, because a corner's angle may exceed 180 degrees while
// determinants at the quadrature points are positive; at quadrature points, because integrals are
// taken there.
static void set_probes(ProbePoints *probes)
{
    for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++) {
        if (element_dim((ElementKind)kind) < 2) continue;   // a face
        Quadrature rule = shape_quadrature((ElementKind)kind);
        int32_t count = 0;
        for (int32_t a = 0; a < element_node_count((ElementKind)kind); a++) {
            probes->shape[kind][count++] =
                shape_at((ElementKind)kind, shape_node((ElementKind)kind, a));
        }
        for (int32_t q = 0; q < rule.count; q++)
            probes->shape[kind][count++] = shape_at((ElementKind)kind, rule.point[q]);
        probes->count[kind] = count;
    }
}

// Smallest and largest determinant of element e over its probes, over the scale; its centre.
static void determinant_range(const Mesh *mesh, const ProbePoints *probes, int32_t e,
                              double range[2], MeshPlace centre)
{
    MeshPlace position[ELEMENT_NODES_MAX];
    double scale = gather(mesh, e, position, centre);
    ElementKind kind = mesh->kind[e];
    range[0] = INFINITY, range[1] = -INFINITY;
    for (int32_t q = 0; q < probes->count[kind]; q++) {
        double determinant =
            shape_jacobian(kind, &probes->shape[kind][q], (const MeshPlace *)position);
        range[0] = fmin(range[0], determinant);
        range[1] = fmax(range[1], determinant);
    }
    for (int32_t k = 0; k < 2; k++) range[k] = scale > 0 ? range[k] / scale : 0;
}

// Where node a of a kind goes when the first two axes of its reference element are exchanged.
static int32_t exchanged_node(ElementKind kind, int32_t a)
{
    const double *at = shape_node(kind, a);
    for (int32_t b = 0; b < element_node_count(kind); b++) {
        const double *other = shape_node(kind, b);
        if (other[0] == at[1] && other[1] == at[0] && other[2] == at[2]) return b;
    }
    return a;
}

// Exchanges nodes so that the element runs the other way round, from the same first corner.
static void reverse_element(ElementKind kind, int32_t *nodes)
{
    int32_t old[ELEMENT_NODES_MAX], count = element_node_count(kind);
    memcpy(old, nodes, (size_t)count * sizeof *nodes);
    for (int32_t a = 0; a < count; a++) nodes[a] = old[exchanged_node(kind, a)];
}

// Clockwise throughout is a reversed surface, which is turned round; a clockwise element among
// others is an error.
static bool check_orientation(Mesh *mesh, Error *err)
{
    bool clockwise = false;   // as the first element is, all must be
    int32_t first_bad = -1;
    double bad_range[2] = {0};
    MeshPlace bad_centre = {0};
    char at[PLACE_TEXT_SIZE];
    ProbePoints *probes = NEW_ARRAY(ProbePoints, 1, err);
    if (!probes) goto cleanup;
    set_probes(probes);
    for (int32_t e = 0; e < mesh->element_count; e++) {
        double range[2];
        MeshPlace centre;
        determinant_range(mesh, probes, e, range, centre);
        bool reversed = range[1] < -AREA_TOLERANCE;
        if (e == 0) clockwise = reversed;
        bool bad = !(range[0] > AREA_TOLERANCE) && !reversed;
        if (!bad && reversed == clockwise) continue;
        first_bad = e;
        memcpy(bad_range, range, sizeof range);
        memcpy(bad_centre, centre, sizeof centre);
        break;
    }
    if (first_bad >= 0)
        FAIL(err, ERROR_INPUT,
             "%s: element %lld (%s) at %s has a non-positive %s: its Jacobian determinant "
             "runs from %.3g to %.3g of its size squared%s",
             mesh->path, (long long)mesh->element_number[first_bad],
             ELEMENTS[mesh->kind[first_bad]].name, place_text(mesh->dim, bad_centre, at),
             mesh->dim == 2 ? "area" : "volume", bad_range[0], bad_range[1],
             bad_range[0] > AREA_TOLERANCE || bad_range[1] < -AREA_TOLERANCE
                 ? " while others run the other way round (a surface of the .geo is reversed)"
                 : "");
    if (clockwise)
        for (int32_t e = 0; e < mesh->element_count; e++)
            reverse_element(mesh->kind[e], mesh->element_nodes + mesh->first_node[e]);
cleanup:
    memory_free(probes);
    return error_is_clean(err);
}

static FaceNodes group_face(const Mesh *mesh, const MeshGroup *group, int32_t k)
{
    MeshBoundary boundary = {
        .dim = mesh->dim, .nodes_per_face = group->nodes_per_face, .face_nodes = group->face_nodes};
    return mesh_boundary_face(&boundary, k);
}

// Every face of a named boundary must be a face of an element, with the same mid-side nodes, and be
// listed once: a load acts as often as its face is listed.
static bool check_boundaries(const Mesh *mesh, Error *err)
{
    MeshFaces table = {0};
    int32_t *listed = NULL;   // by face of the table: the last group that lists it, + 1
    const char *what = mesh->dim == 2 ? "edge" : "face",
               *piece = mesh->dim == 2 ? "curve" : "surface";
    char at[PLACE_TEXT_SIZE];
    TRY(mesh_faces_build(mesh, &table, err));
    TRY((listed = NEW_ARRAY(int32_t, table.first[mesh->node_count], err)));
    for (int32_t g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        for (int32_t k = 0; k < group->face_count; k++) {
            FaceNodes face = group_face(mesh, group, k);
            const int32_t *nodes = face.node;
            const MeshFace *known = mesh_faces_find(&table, face);
            if (!known || !mesh_face_is(known, face))
                FAIL(err, ERROR_INPUT,
                     "%s: group '%s': its %s from node %lld to %lld at %s is not an %s of any "
                     "element",
                     mesh->path, group->name, what, (long long)mesh->node_number[nodes[0]],
                     (long long)mesh->node_number[nodes[1]], mesh_place_text(mesh, nodes[0], at),
                     what);
            int32_t *last = &listed[known - table.faces];
            if (*last == g + 1)
                FAIL(err, ERROR_INPUT,
                     "%s: group '%s' has its %s from node %lld to %lld at %s twice: a load on it "
                     "would act twice (a %s named twice, or once more reversed, in the physical "
                     "group?)",
                     mesh->path, group->name, what, (long long)mesh->node_number[nodes[0]],
                     (long long)mesh->node_number[nodes[1]], mesh_place_text(mesh, nodes[0], at),
                     piece);
            *last = g + 1;
        }
    }
cleanup:
    memory_free(listed);
    mesh_faces_destroy(&table);
    return error_is_clean(err);
}

// The first node of i's part (union-find with path halving).
static int32_t part_of(int32_t *parent, int32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

// The box of the part that `root` stands for, in `text`.
static void describe_part(const Mesh *mesh, int32_t *parent, int32_t root, char text[160])
{
    int32_t nodes = 0, up = mesh->dim - 1;
    MeshPlace low, high;
    for (int32_t d = 0; d < DIM_MAX; d++) low[d] = INFINITY, high[d] = -INFINITY;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        if (part_of(parent, i) != root) continue;
        nodes++;
        for (int32_t d = 0; d < mesh->dim; d++) {
            low[d] = fmin(low[d], mesh_place(mesh, i)[d]);
            high[d] = fmax(high[d], mesh_place(mesh, i)[d]);
        }
    }
    snprintf(text, 160, "%d nodes in x = %g ... %g, z = %g ... %g", nodes, low[0], high[0], low[up],
             high[up]);
}

// All elements hang together by their nodes; parts that only touch share none.
static bool check_one_part(const Mesh *mesh, Error *err)
{
    int32_t *parent = NEW_ARRAY(int32_t, mesh->node_count, err);
    if (!parent) goto cleanup;
    for (int32_t i = 0; i < mesh->node_count; i++) parent[i] = i;
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t k = mesh->first_node[e] + 1; k < mesh->first_node[e + 1]; k++) {
            int32_t one = part_of(parent, mesh->element_nodes[k - 1]);
            parent[part_of(parent, mesh->element_nodes[k])] = one;
        }
    for (int32_t i = 1; i < mesh->node_count; i++) {
        if (part_of(parent, i) == part_of(parent, 0)) continue;
        char first[160], second[160];
        describe_part(mesh, parent, part_of(parent, 0), first);
        describe_part(mesh, parent, part_of(parent, i), second);
        FAIL(err, ERROR_INPUT,
             "%s: the mesh has parts that share no node, and a scene is one block: %s, and %s (let "
             "them share points and lines in the .geo, or say `Coherence;`, `Coherence Mesh;`)",
             mesh->path, first, second);
    }
cleanup:
    memory_free(parent);
    return error_is_clean(err);
}

// --- building -----------------------------------------------------------------------------------

// Each check may rely on those before it. *mesh is the caller's to destroy also on failure. Errors
// name node or element by gmsh's number.
bool mesh_build(MeshFile *file, const char *path, Mesh *mesh, Error *err)
{
    take_over(file, path, mesh);
    find_extent(mesh);
    if (!check_nodes(mesh, err)) return false;
    if (!check_repeats(mesh, err)) return false;
    if (!check_orientation(mesh, err)) return false;
    if (!check_boundaries(mesh, err)) return false;
    if (!check_one_part(mesh, err)) return false;
    for (int32_t g = 0; g < mesh->group_count; g++)
        mesh_sort_nodes(mesh, mesh->groups[g].nodes, mesh->groups[g].node_count);
    return true;
}
