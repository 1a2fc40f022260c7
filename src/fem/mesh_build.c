// SPDX-License-Identifier: GPL-2.0-or-later
// All checks of a mesh; fem/mesh.h says what holds afterwards.
#include "fem/mesh.h"

#include "base/memory.h"
#include "fem/floor.h"
#include "fem/mesh_faces.h"
#include "fem/mesh_locate.h"
#include "fem/mesh_parts.h"
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Most points at which determinants of one kind are looked at: HEX27's nodes and quadrature points.
enum { PROBES_MAX = ELEMENT_NODES_MAX + QUADRATURE_POINTS_MAX };

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
    floor_destroy(&mesh->floor);
    memory_free_all(mesh->region, mesh->mean_next, mesh->is_base);
    *mesh = (Mesh){0};
}

// --- checks -------------------------------------------------------------------------------------

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
        const char *group = NULL;   // that holds node i, the first
        for (int32_t g = 0; g < mesh->group_count && !group; g++)
            for (int32_t k = 0; k < mesh->groups[g].node_count && !group; k++)
                if (mesh->groups[g].nodes[k] == i) group = mesh->groups[g].name;
        FAIL(err, ERROR_INPUT, "%s: node %lld at %s is on no %s element%s%s%s", mesh->path,
             (long long)mesh->node_number[i], mesh_place_text(mesh, i, at),
             mesh->dim == 2 ? "surface" : "volume", group ? "; it belongs to group '" : "",
             group ? group : "",
             group
                 ? "' (`groups: {body: REGION}` in the scene leaves out what is not of that region)"
                 : "");
    }
cleanup:
    memory_free(used);
    return error_is_clean(err);
}

// Shape functions at the nodes and quadrature points of each kind, where Jacobians are looked at.
typedef struct ProbePoints {
    int32_t count[ELEMENT_KIND_COUNT];
    ShapeValues shape[ELEMENT_KIND_COUNT][PROBES_MAX];
} ProbePoints;

static void add_probe(ElementKind kind, const double *point, ProbePoints *probes)
{
    probes->shape[kind][probes->count[kind]++] = shape_at(kind, point);
}

// Smallest and largest determinant of element e over its probes, over the scale; its centre.
static void determinant_range(const Mesh *mesh, const ProbePoints *probes, int32_t e,
                              double range[2], MeshPlace centre)
{
    MeshPlace position[ELEMENT_NODES_MAX];
    int32_t count = mesh->first_node[e + 1] - mesh->first_node[e];
    ElementKind kind = mesh->kind[e];
    double scale = 0;   // of its Jacobian: the longest distance from node 0 to the power of dim
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
    scale = pow(scale, mesh->dim / 2.0);
    range[0] = INFINITY, range[1] = -INFINITY;
    for (int32_t q = 0; q < probes->count[kind]; q++) {
        double determinant =
            shape_jacobian(kind, &probes->shape[kind][q], (const MeshPlace *)position);
        range[0] = fmin(range[0], determinant);
        range[1] = fmax(range[1], determinant);
    }
    for (int32_t k = 0; k < 2; k++) range[k] = scale > 0 ? range[k] / scale : 0;
}

// An element whose determinant is negative throughout runs the other way round, as those of a
// reversed surface do: it is turned. One whose determinant is 0 or changes its sign is an error.
static bool orient_elements(Mesh *mesh, Error *err)
{
    ProbePoints *probes = NEW_ARRAY(ProbePoints, 1, err);
    if (!probes) goto cleanup;

    // Probes, evaluated once a mesh. At nodes, because a corner's angle may exceed 180 degrees
    // while determinants at the quadrature points are positive; at quadrature points, because
    // integrals are taken there; in hexahedra and wedges of first order, whose determinant is of
    // second order, between the corners too: a twisted one turns inside out in the middle.
    for (ElementKind kind = 0; kind < ELEMENT_KIND_COUNT; kind++) {
        if (element_dim(kind) < 2) continue;   // a face
        Quadrature rule = shape_quadrature(kind);
        for (int32_t a = 0; a < element_node_count(kind); a++)
            add_probe(kind, shape_node(kind, a), probes);
        for (int32_t q = 0; q < rule.count; q++) add_probe(kind, rule.point[q], probes);
    }
    for (int32_t a = element_node_count(ELEMENT_HEX8); a < element_node_count(ELEMENT_HEX27); a++)
        add_probe(ELEMENT_HEX8, shape_node(ELEMENT_HEX27, a), probes);
    for (int32_t a = 0; a < element_node_count(ELEMENT_T6); a++)
        for (int32_t level = -1; level <= 1; level++) {
            const double *seen_from_above = shape_node(ELEMENT_T6, a);
            MeshPlace point = {seen_from_above[0], seen_from_above[1], level};
            add_probe(ELEMENT_WEDGE6, point, probes);
        }

    // Turns or refuses each element whose determinant is not positive throughout.
    for (int32_t e = 0; e < mesh->element_count; e++) {
        double range[2];
        MeshPlace centre;
        determinant_range(mesh, probes, e, range, centre);
        if (range[1] < -AREA_TOLERANCE) {
            // Exchanges nodes so that the element runs the other way round, from the same first
            // corner: the first two axes of its reference element are exchanged.
            ElementKind kind = mesh->kind[e];
            int32_t *nodes = mesh->element_nodes + mesh->first_node[e];
            int32_t old[ELEMENT_NODES_MAX], count = element_node_count(kind);
            memcpy(old, nodes, (size_t)count * sizeof *nodes);
            for (int32_t a = 0; a < count; a++) {
                const double *at = shape_node(kind, a);
                for (int32_t b = 0; b < count; b++) {
                    const double *other = shape_node(kind, b);
                    if (other[0] == at[1] && other[1] == at[0] && other[2] == at[2])
                        nodes[a] = old[b];
                }
            }
            continue;
        }
        if (range[0] > AREA_TOLERANCE) continue;

        // The error names a region that the element is in.
        char at[PLACE_TEXT_SIZE];
        const char *region = NULL;
        for (int32_t g = 0; g < mesh->group_count && !region; g++)
            for (int32_t k = 0; k < mesh->groups[g].element_count && !region; k++)
                if (mesh->groups[g].elements[k] == e) region = mesh->groups[g].name;
        bool changes = range[0] < -AREA_TOLERANCE && range[1] > AREA_TOLERANCE;
        FAIL(
            err, ERROR_INPUT,
            "%s: element %lld (%s) at %s%s%s%s has a non-positive %s: its Jacobian determinant "
            "runs from %.3g to %.3g of its size %s; %s",
            mesh->path, (long long)mesh->element_number[e], ELEMENTS[mesh->kind[e]].name,
            place_text(mesh->dim, centre, at), region ? " of group '" : "", region ? region : "",
            region ? "'" : "", mesh->dim == 2 ? "area" : "volume", range[0], range[1],
            mesh->dim == 2 ? "squared" : "cubed",
            !changes
                ? "its corners lie on one line or plane: draw it otherwise, or mesh it with other "
                  "sizes"
            : element_node_count(mesh->kind[e]) > element_corner_count(mesh->kind[e])
                ? "it turns inside out: its sides are bent too far (`Mesh.HighOrderOptimize = 2;`, "
                  "or shorter cells where the boundary is curved), or its nodes are not in gmsh's "
                  "order"
                : "it turns inside out: its corners are not in gmsh's order, or it is twisted or "
                  "crossed");
    }
cleanup:
    memory_free(probes);
    return error_is_clean(err);
}

// Every face of a named boundary must be a face of an element, with the same mid-side nodes, and be
// listed once: a load acts as often as its face is listed.
static bool check_boundaries(const Mesh *mesh, const MeshFaces *table, Error *err)
{
    int32_t *listed = NULL;   // by face of the table: the last group that lists it, + 1
    const char *what = mesh->dim == 2 ? "edge" : "face",
               *piece = mesh->dim == 2 ? "curve" : "surface";
    char at[PLACE_TEXT_SIZE];
    TRY((listed = NEW_ARRAY(int32_t, table->first[mesh->node_count], err)));
    for (int32_t g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        for (int32_t k = 0; k < group->face_count; k++) {
            MeshBoundary boundary = {.dim = mesh->dim,
                                     .nodes_per_face = group->nodes_per_face,
                                     .face_nodes = group->face_nodes};
            FaceNodes face = mesh_boundary_face(&boundary, k);
            const int32_t *nodes = face.node;
            const MeshFace *known = mesh_faces_find(table, face);
            if (!known || !mesh_face_is(known, face))
                FAIL(err, ERROR_INPUT,
                     "%s: group '%s': its %s from node %lld to %lld at %s is on no element",
                     mesh->path, group->name, what, (long long)mesh->node_number[nodes[0]],
                     (long long)mesh->node_number[nodes[1]], mesh_place_text(mesh, nodes[0], at));
            int32_t *last = &listed[known - table->faces];
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
    return error_is_clean(err);
}

// --- building -----------------------------------------------------------------------------------

// Each check may rely on those before it.
bool mesh_build_parts(MeshFile *file, const char *path, const char *floor, Mesh *mesh,
                      MeshParts *parts, Error *err)
{
    MeshFaces faces = {0};
    uint8_t *in_base = NULL;   // [parts] 1 for those of the base; owned
    *parts = (MeshParts){0};

    // The arrays move; `file` is empty afterwards, so destroying both is always right.
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
                   .groups = file->groups,
                   .move = {.scale = 1}};
    snprintf(mesh->path, sizeof mesh->path, "%s", path);
    memcpy(mesh->warning, file->warning, sizeof file->warning);
    *file = (MeshFile){0};
    mesh_find_extent(mesh);
    TRY(check_nodes(mesh, err));

    // A quadrilateral with two corners in one node has a Jacobian of zero there.
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++)
            for (int32_t b = mesh->first_node[e]; b < a; b++)
                if (mesh->element_nodes[a] == mesh->element_nodes[b])
                    FAIL(err, ERROR_INPUT, "%s: element %lld (%s) has node %lld twice", mesh->path,
                         (long long)mesh->element_number[e], ELEMENTS[mesh->kind[e]].name,
                         (long long)mesh->node_number[mesh->element_nodes[a]]);

    TRY(orient_elements(mesh, err));
    TRY(mesh_faces_build(mesh, &faces, err));
    TRY(check_boundaries(mesh, &faces, err));
    TRY(mesh_parts_find(mesh, parts, err));

    // The base: every part that has nodes of the boundary called `floor`, where one part is left
    // that has none. Else nothing is marked.
    if (floor && parts->count > 1) {
        int32_t left = parts->count;
        TRY(in_base = NEW_ARRAY(uint8_t, parts->count, err));
        for (int32_t g = 0; g < mesh->group_count; g++) {
            const MeshGroup *group = &mesh->groups[g];
            if (group->dimension != mesh->dim - 1 || strcmp(group->name, floor) != 0) continue;
            for (int32_t k = 0; k < group->node_count; k++) {
                int32_t part = parts->part[group->nodes[k]];
                if (!in_base[part]) left--;
                in_base[part] = 1;
            }
        }
        if (left == 1) {
            TRY(mesh->is_base = NEW_ARRAY(uint8_t, mesh->node_count, err));
            for (int32_t i = 0; i < mesh->node_count; i++)
                mesh->is_base[i] = in_base[parts->part[i]];
            mesh_find_extent(mesh);
        }
    }
    if (parts->count == 1 || mesh->is_base) TRY(mesh_check_inside(mesh, &faces, err));
    for (int32_t g = 0; g < mesh->group_count; g++)
        mesh_sort_nodes(mesh, mesh->groups[g].nodes, mesh->groups[g].node_count);
cleanup:
    memory_free(in_base);
    mesh_faces_destroy(&faces);
    return error_is_clean(err);
}

// *mesh is the caller's to destroy also on failure. Errors name node or element by gmsh's number.
bool mesh_build_on_base(MeshFile *file, const char *path, const char *floor, Mesh *mesh, Error *err)
{
    MeshParts parts;
    bool done = mesh_build_parts(file, path, floor, mesh, &parts, err) &&
                (parts.count == 1 || mesh->is_base || mesh_parts_refuse(mesh, &parts, err));
    mesh_parts_destroy(&parts);
    return done;
}

bool mesh_build(MeshFile *file, const char *path, Mesh *mesh, Error *err)
{
    return mesh_build_on_base(file, path, NULL, mesh, err);
}
