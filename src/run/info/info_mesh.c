// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons info` on a mesh: read and checked as a run would do it, so that what is wrong with a
// mesh is found before anything is computed.
#include "run/info/info.h"

#include "base/memory.h"
#include "base/module.h"
#include "base/text.h"
#include "fem/mesh_parts.h"
#include "render/render.h"

#include <math.h>
#include <string.h>

static const char *size_name(const Mesh *mesh)
{
    return mesh->dim == 2 ? "area" : "volume";
}

// The aspect ratio is fem/mesh_summary's: longest over shortest edge of an element.
void info_write_mesh(const Mesh *mesh, FILE *out)
{
    static const char *const dimensions[] = {"point", "curve", "surface", "volume"};
    MeshSummary summary = mesh_summarise(mesh);
    char moved[MOVE_TEXT_SIZE];
    fprintf(out, "mesh %s\n  %d nodes, %d elements:", mesh->path, mesh->node_count,
            mesh->element_count);
    for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++)
        if (summary.element_counts[kind])
            fprintf(out, " %d %s", summary.element_counts[kind], ELEMENTS[(ElementKind)kind].name);
    fprintf(out, "\n  x from %.6g to %.6g", mesh->x_min, mesh->x_max);
    if (mesh->dim > 2) fprintf(out, ", y from %.6g to %.6g", mesh->y_min, mesh->y_max);
    fprintf(out, ", z from %.6g to %.6g, %s %.6g\n", mesh->z_min, mesh->z_max, size_name(mesh),
            summary.area);
    fprintf(out, "  element edges %.4g to %.4g, largest aspect ratio %.3g\n", summary.edge_min,
            summary.edge_max, summary.aspect_max);
    if (*mesh_move_text(mesh, moved)) fprintf(out, "  %s\n", moved);

    // Cells and area or volume of a region, which `materials` of a scene may name; how long a curve
    // of the boundary is, and its edges; faces and nodes of a surface.
    fprintf(out, "  groups\n");
    for (int32_t g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        int32_t dimension = group->dimension;
        double size = 0, shortest = INFINITY, longest = 0;
        fprintf(out, "    %-16s %-7s", group->name,
                dimensions[dimension >= 0 && dimension <= 2 ? dimension : 3]);
        if (dimension == mesh->dim) {
            for (int32_t k = 0; k < group->element_count; k++)
                size += mesh_element_area(mesh, group->elements[k]);
            fprintf(out, "%6d cells                %s %.6g", group->element_count, size_name(mesh),
                    size);
        } else if (dimension == mesh->dim - 1 && mesh->dim > 2) {
            fprintf(out, "%6d faces %6d nodes", group->face_count, group->node_count);
        } else if (dimension == mesh->dim - 1) {
            // Lengths are taken between end nodes: the arc of a curved edge is not followed.
            for (int32_t k = 0; k < group->face_count; k++) {
                const int32_t *nodes = group->face_nodes + (int64_t)k * group->nodes_per_face;
                double edge = mesh_distance(mesh, nodes[0], nodes[1]);
                size += edge;
                shortest = fmin(shortest, edge);
                longest = fmax(longest, edge);
            }
            fprintf(out, "%6d edges %6d nodes   length %.6g, edges %.4g to %.4g", group->face_count,
                    group->node_count, size, group->face_count ? shortest : 0, longest);
        } else {
            fprintf(out, "%6d nodes", group->node_count);
        }
        fprintf(out, "\n");
    }
    if (mesh->warning[0]) fprintf(out, "  gmsh made it, but says: %s\n", mesh->warning);
}

bool info_mesh(const char *path, const InfoOptions *options, FILE *out, Error *err)
{
    MeshFile file = {0};
    Mesh mesh = {0};
    MeshParts parts = {0};
    MeshParameter *parameters = NEW_ARRAY(MeshParameter, options->override_count, err);
    if (!parameters) goto cleanup;

    // "n=4" is a parameter of a .geo: what reads as a number is one.
    for (int32_t k = 0; k < options->override_count; k++) {
        const char *word = options->overrides[k], *equals = strchr(word, '=');
        MeshParameter *parameter = &parameters[k];
        if (!equals || equals == word || !equals[1])
            FAIL(err, ERROR_INPUT, "--set %s: a mesh takes name=value, as in --set n=4", word);
        if (equals - word >= GROUP_NAME_SIZE || strlen(equals + 1) >= GROUP_NAME_SIZE)
            FAIL(err, ERROR_INPUT, "--set %s: name and value have at most %d bytes each", word,
                 GROUP_NAME_SIZE - 1);
        memcpy(parameter->name, word, (size_t)(equals - word));
        int32_t length = text_number(equals + 1, &parameter->value);
        if (equals[1 + length]) snprintf(parameter->text, GROUP_NAME_SIZE, "%s", equals + 1);
    }
    TRY(mesh_file_read(path, parameters, options->override_count, options->trust, NULL, &file,
                       err));
    TRY(mesh_build_parts(&file, path, "floor", &mesh, &parts, err));

    // The mesh stands as in a scene that says nothing else; one without a contact as it is drawn.
    bool has_contact = false;
    for (int32_t g = 0; g < mesh.group_count; g++)
        has_contact = has_contact ||
                      (mesh.groups[g].dimension == mesh.dim - 1 && mesh.groups[g].face_count > 0 &&
                       mesh_is_contact_name(mesh.groups[g].name));
    if (has_contact && (parts.count == 1 || mesh.is_base))
        TRY(mesh_stand_on_floor(NULL, 0, &mesh, err));
    info_write_mesh(&mesh, out);

    // Find the regions of each part, and those of them to name.
    if (mesh.is_base) {
        fprintf(out, "  block on a base that deforms: `floor` is the base's upper side\n");
    } else if (parts.count > 1) {
        char text[PART_TEXT_SIZE];
        fprintf(out, "  %d parts that share no node, none of them a base with a group `floor`\n",
                parts.count);
        for (int32_t k = 0; k < parts.count; k++)
            fprintf(out, "    %s\n", mesh_part_text(&mesh, &parts, k, text));
        fprintf(out, "    %s\n", mesh_parts_advice(&mesh, &parts, text));
    }
    if (options->picture) TRY(info_draw_mesh(&mesh, NULL, NULL, options, err));
cleanup:
    mesh_file_destroy(&file);
    mesh_parts_destroy(&parts);
    mesh_destroy(&mesh);
    memory_free(parameters);
    return error_is_clean(err);
}

// strip: the rod's lowest and highest z, length, or NULL. Drawn by the module `render`.
bool info_draw_mesh(const Mesh *mesh, const double strip[2], const char *unit,
                    const InfoOptions *options, Error *err)
{
    char note[200];
    const char *name = strrchr(mesh->path, '/');
    MeshSummary summary = mesh_summarise(mesh);
    bool in_metres = unit && strcmp(unit, "m") == 0;
    double factor = in_metres ? 1000 : 1;
    snprintf(note, sizeof note,
             "%d nodes, %d elements, edges %.3g to %.3g%s%s, aspect ratio to %.3g",
             mesh->node_count, mesh->element_count, factor * summary.edge_min,
             factor * summary.edge_max, unit ? " " : "",
             in_metres ? "mm"
             : unit    ? unit
                       : "",
             summary.aspect_max);
    RenderMesh request = {.title = name ? name + 1 : mesh->path,
                          .note = note,
                          .unit = unit,
                          .node_count = mesh->node_count,
                          .dim = mesh->dim,
                          .position = mesh->position,
                          .element_count = mesh->element_count,
                          .kind = mesh->kind,
                          .first_node = mesh->first_node,
                          .element_nodes = mesh->element_nodes,
                          .group_count = mesh->group_count,
                          .groups = mesh->groups,
                          .rod_low = strip ? strip[0] : NAN,
                          .rod_high = strip ? strip[1] : NAN,
                          .style = {.overwrite = options->overwrite}};
    RenderMeshFunction render =
        (RenderMeshFunction)module_function("render", "amontons_render_mesh", err);
    return render && render(&request, options->picture, err);
}
