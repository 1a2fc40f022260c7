// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/info.h"

#include "base/memory.h"
#include "bulk/mesh.h"

#include <math.h>

static const char *dimension_name(int32_t dimension)
{
    static const char *const names[] = {"point", "curve", "surface"};
    return dimension >= 0 && dimension <= 2 ? names[dimension] : "volume";
}

static double edge_length(const Mesh *mesh, const MeshGroup *group, int32_t edge)
{
    const int32_t *nodes = group->edge_nodes + (int64_t)edge * group->nodes_per_edge;
    const double *a = mesh->position + 2 * (int64_t)nodes[0];
    const double *b = mesh->position + 2 * (int64_t)nodes[1];
    return hypot(b[0] - a[0], b[1] - a[1]);
}

static void write_curve(const Mesh *mesh, const MeshGroup *group, FILE *out)
{
    double length = 0, shortest = INFINITY, longest = 0;
    for (int32_t i = 0; i < group->edge_count; i++) {
        double edge = edge_length(mesh, group, i);
        length += edge;
        shortest = fmin(shortest, edge);
        longest = fmax(longest, edge);
    }
    fprintf(out, "%6d edges %6d nodes   length %.6g, edges %.4g to %.4g", group->edge_count,
            group->node_count, length, group->edge_count ? shortest : 0, longest);
}

static void write_groups(const Mesh *mesh, FILE *out)
{
    fprintf(out, "  groups\n");
    for (int32_t g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        fprintf(out, "    %-16s %-7s", group->name, dimension_name(group->dimension));
        if (group->dimension == 1) write_curve(mesh, group, out);
        if (group->dimension == 0) fprintf(out, "%6d nodes", group->node_count);
        fprintf(out, "\n");
    }
}

bool info_mesh(const char *path, FILE *out, Error *err)
{
    MeshFile file = {0};
    Mesh mesh = {0};
    TRY(mesh_file_read(path, NULL, 0, &file, err));
    TRY(mesh_build(&file, path, &mesh, err));
    MeshSummary summary = mesh_summarise(&mesh);
    fprintf(out, "mesh %s\n  %d nodes, %d elements:", path, mesh.node_count, mesh.element_count);
    for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++)
        if (summary.element_counts[kind])
            fprintf(out, " %d %s", summary.element_counts[kind], element_name((ElementKind)kind));
    fprintf(out, "\n  x from %.6g to %.6g, z from %.6g to %.6g, area %.6g\n", mesh.x_min,
            mesh.x_max, mesh.z_min, mesh.z_max, summary.area);
    fprintf(out, "  element edges %.4g to %.4g, largest aspect ratio %.3g\n", summary.edge_min,
            summary.edge_max, summary.aspect_max);
    write_groups(&mesh, out);
cleanup:
    mesh_file_destroy(&file);
    mesh_destroy(&mesh);
    return error_is_clean(err);
}
