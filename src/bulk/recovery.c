// SPDX-License-Identifier: GPL-2.0-or-later
// Strains are taken at the nodes of each element. On a regular mesh the mean over the elements at
// an inner node is a central difference, one order better than each of them.
//
// The mean is not weighted by the elements' sizes. Arrays are [3 * nodes]: xx, zz, xz of node 0, of
// node 1, ...; the strain's third entry is the engineering shear 2 xz, as in bulk/element.
#include "bulk/recovery.h"

#include "base/memory.h"
#include "bulk/element.h"

#include <math.h>
#include <string.h>

// The point of a node in a material, a new one where there is none yet; next: [points] the
// following point of a node, -1: none; region: [points].
static int32_t find_point(NodalStress *stress, int32_t node, int32_t own, int32_t *next,
                          int32_t *region, int32_t nodes)
{
    int32_t point = node;
    while (region[point] != own && next[point] >= 0) point = next[point];
    if (region[point] == own) return point;
    int32_t made = stress->point_count++;
    stress->extra_node[made - nodes] = node;
    region[made] = own;
    next[made] = -1;
    next[point] = made;
    return made;
}

// At most one point for each node of each element.
static bool split_nodes(const Mesh *mesh, NodalStress *stress, Error *err)
{
    int32_t nodes = mesh->node_count, places = mesh->first_node[mesh->element_count];
    int32_t *next = NEW_ARRAY(int32_t, (int64_t)nodes + places, err);
    int32_t *region = NEW_ARRAY(int32_t, (int64_t)nodes + places, err);
    stress->points = NEW_ARRAY(int32_t, places, err);
    stress->extra_node = NEW_ARRAY(int32_t, places, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t i = 0; i < nodes; i++) {
        region[i] = INT32_MAX;
        next[i] = -1;
    }
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++) {
            int32_t *lowest = &region[mesh->element_nodes[a]], own = mesh_region(mesh, e);
            if (own < *lowest) *lowest = own;
        }
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++)
            stress->points[a] = find_point(stress, mesh->element_nodes[a], mesh_region(mesh, e),
                                           next, region, nodes);
cleanup:
    memory_free(next);
    memory_free(region);
    return error_is_clean(err);
}

const int32_t *nodal_stress_points(const NodalStress *stress, const Mesh *mesh, int32_t e)
{
    return (stress->points ? stress->points : mesh->element_nodes) + mesh->first_node[e];
}

// Of element `e` at its node `at`: the slopes d/dx, d/dz of its shape functions.
static void slopes_at(const Mesh *mesh, int32_t e, int32_t at, double (*slope)[2])
{
    const int32_t *element = mesh->element_nodes + mesh->first_node[e];
    int32_t nodes = mesh->first_node[e + 1] - mesh->first_node[e];
    double position[ELEMENT_NODES_MAX][2], point[2], b[3][ELEMENT_DOFS_MAX];
    for (int32_t a = 0; a < nodes; a++)
        memcpy(position[a], mesh->position + 2 * element[a], sizeof position[a]);
    shape_node(mesh->kind[e], at, &point[0], &point[1]);
    element_strain_matrix(mesh->kind[e], (const double(*)[2])position, point, b);
    for (int32_t a = 0; a < nodes; a++) {
        slope[a][0] = b[0][2 * a];
        slope[a][1] = b[1][2 * a + 1];
    }
}

static bool prepare_slopes(const Mesh *mesh, NodalStress *stress, Error *err)
{
    int64_t count = 0;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        int64_t nodes = mesh->first_node[e + 1] - mesh->first_node[e];
        count += nodes * nodes;
    }
    stress->slope = memory_array(count, sizeof *stress->slope, err);
    if (!stress->slope) return false;
    double(*slope)[2] = stress->slope;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        int32_t nodes = mesh->first_node[e + 1] - mesh->first_node[e];
        for (int32_t a = 0; a < nodes; a++, slope += nodes) slopes_at(mesh, e, a, slope);
    }
    return true;
}

// Kept over a run and filled anew at each time that is written.
bool nodal_stress_create(const Mesh *mesh, NodalStress *stress, Error *err)
{
    *stress = (NodalStress){.point_count = mesh->node_count};
    if (mesh->region) TRY(split_nodes(mesh, stress, err));
    TRY(prepare_slopes(mesh, stress, err));
    int64_t count = stress->point_count;
    stress->elastic = NEW_ARRAY(double, 3 * count, err);
    stress->total = NEW_ARRAY(double, 3 * count, err);
    stress->von_mises = NEW_ARRAY(double, count, err);
    stress->shares = NEW_ARRAY(int32_t, count, err);
cleanup:
    return error_is_clean(err);
}

void nodal_stress_destroy(NodalStress *stress)
{
    memory_free(stress->elastic);
    memory_free(stress->total);
    memory_free(stress->von_mises);
    memory_free(stress->shares);
    memory_free(stress->slope);
    memory_free(stress->points);
    memory_free(stress->extra_node);
    *stress = (NodalStress){0};
}

typedef struct Strains {
    double strain[3], rate[3];   // xx, zz, 2 xz
} Strains;

// element: [nodes] of the mesh; slope: [nodes] at the place asked for; B u_e and B v_e.
static Strains strains_of(const int32_t *element, int32_t nodes, const double (*slope)[2],
                          const double *displacement, const double *velocity)
{
    Strains found = {0};
    for (int32_t a = 0; a < nodes; a++) {
        const double *u = displacement + 2 * element[a], *v = velocity + 2 * element[a];
        double x = slope[a][0], z = slope[a][1];
        found.strain[0] += x * u[0];
        found.strain[1] += z * u[1];
        found.strain[2] += z * u[0];   // two sums, as B's columns stand
        found.strain[2] += x * u[1];
        found.rate[0] += x * v[0];
        found.rate[1] += z * v[1];
        found.rate[2] += z * v[0];
        found.rate[2] += x * v[1];
    }
    return found;
}

// sqrt(3 J_2) with all three normal stresses: sigma_yy counts in plane strain.
static double von_mises(const double stress[3], double out_of_plane)
{
    double xx = stress[0], zz = stress[1], xz = stress[2], yy = out_of_plane;
    return sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) +
                3 * xz * xz);
}

// Von Mises is that of the mean stress, not the mean of the elements' von Mises.
// displacement, velocity: [2 * nodes] of the full mesh. stress->total has the viscous part, C's
// stress at this velocity, stress->elastic has not.
void nodal_stress_recover(const Mesh *mesh, const Material *materials, const double *displacement,
                          const double *velocity, NodalStress *stress)
{
    double elastic[3][3], viscous[3][3];
    const double(*slope)[2] = (const double(*)[2])stress->slope;
    size_t points = (size_t)stress->point_count;
    memset(stress->elastic, 0, 3 * points * sizeof(double));
    memset(stress->total, 0, 3 * points * sizeof(double));
    memset(stress->von_mises, 0, points * sizeof(double));
    memset(stress->shares, 0, points * sizeof(int32_t));
    for (int32_t e = 0; e < mesh->element_count; e++) {
        const int32_t *point = nodal_stress_points(stress, mesh, e);
        const int32_t *element = mesh->element_nodes + mesh->first_node[e];
        int32_t count = mesh->first_node[e + 1] - mesh->first_node[e];
        const Material *material = &materials[mesh_region(mesh, e)];
        material_elastic(material, elastic);
        material_viscous(material, viscous);
        for (int32_t a = 0; a < count; a++, slope += count) {
            Strains at = strains_of(element, count, slope, displacement, velocity);
            int32_t node = point[a];
            for (int r = 0; r < 3; r++) {
                double held = 0, damped = 0;
                for (int c = 0; c < 3; c++) {
                    held += elastic[r][c] * at.strain[c];
                    damped += viscous[r][c] * at.rate[c];
                }
                stress->elastic[3 * node + r] += held;
                stress->total[3 * node + r] += held + damped;
            }
            // Until the mean is taken the array holds the out-of-plane stress.
            stress->von_mises[node] += material_out_of_plane(material, at.strain, at.rate);
            stress->shares[node]++;
        }
    }
    for (int32_t node = 0; node < stress->point_count; node++) {
        double share = 1.0 / stress->shares[node];
        for (int r = 0; r < 3; r++) {
            stress->elastic[3 * node + r] *= share;
            stress->total[3 * node + r] *= share;
        }
        stress->von_mises[node] =
            von_mises(stress->total + 3 * node, share * stress->von_mises[node]);
    }
}
