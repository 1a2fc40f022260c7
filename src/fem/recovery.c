// SPDX-License-Identifier: GPL-2.0-or-later
// Strains are taken at the nodes of each element. On a regular mesh the mean over the elements at
// an inner node is a central difference, one order better than each of them. The means are one
// sparse operator, made once; the stress of a point is that of its mean strain. Of elements that
// share an areal strain (fem/element_group) this is the areal part.
//
// The mean is not weighted by the elements' sizes. Arrays are [strains * nodes]: xx, zz, xz of node
// 0, of node 1, ...; shears of a strain are the engineering ones, 2 xz, as in fem/element.
#include "fem/recovery.h"

#include "base/memory.h"
#include "fem/element_group.h"

#include <math.h>

// The point of a node in a material; at most one for each node of each element. next: [points] the
// following point of a node, -1: none.
static bool split_nodes(const Mesh *mesh, NodalStress *stress, Error *err)
{
    int32_t nodes = mesh->node_count, places = mesh->first_node[mesh->element_count];
    int32_t *next = NEW_ARRAY(int32_t, (int64_t)nodes + places, err);
    int32_t *region = stress->region = NEW_ARRAY(int32_t, (int64_t)nodes + places, err);
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
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++) {
            int32_t point = mesh->element_nodes[a], own = mesh_region(mesh, e);
            while (region[point] != own && next[point] >= 0) point = next[point];
            if (region[point] != own) {   // a new one
                int32_t made = stress->point_count++;
                stress->extra_node[made - nodes] = mesh->element_nodes[a];
                region[made] = own;
                next[made] = -1;
                next[point] = made;
                point = made;
            }
            stress->points[a] = point;
        }
cleanup:
    memory_free(next);
    return error_is_clean(err);
}

const int32_t *nodal_stress_points(const NodalStress *stress, const Mesh *mesh, int32_t e)
{
    return (stress->points ? stress->points : mesh->element_nodes) + mesh->first_node[e];
}

// The place of `node` in the row of `point`, a new one at its end where there is none yet; rows are
// short.
static int32_t place_in_row(NodalStress *stress, int32_t point, int32_t node)
{
    int32_t k = stress->row[point], end = k + stress->row_length[point];
    while (k < end && stress->column[k] != node) k++;
    stress->row_length[point] += k == end;
    stress->column[k] = node;
    return k;
}

// Kept over a run and filled anew at each time that is written.
bool nodal_stress_create(const Mesh *mesh, NodalStress *stress, Error *err)
{
    int32_t *shares = NULL, room = 0;   // shares: [points] elements around each
    *stress = (NodalStress){.dim = mesh->dim, .point_count = mesh->node_count};
    if (mesh->region) TRY(split_nodes(mesh, stress, err));
    int32_t points = stress->point_count;
    const int32_t *point = nodal_stress_points(stress, mesh, 0);
    TRY(shares = NEW_ARRAY(int32_t, points, err));
    TRY(stress->row = NEW_ARRAY(int32_t, points, err));
    TRY(stress->row_length = NEW_ARRAY(int32_t, points, err));

    // A row has room for all nodes of its point's elements, or of their groups.
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++) {
            ElementGroup group;
            element_group_of(mesh, e, &group);
            stress->row[point[a]] += group.node_count;
            shares[point[a]]++;
        }
    for (int32_t k = 0; k < points; k++) {
        room += stress->row[k];
        stress->row[k] = room - stress->row[k];
    }
    TRY(stress->column = NEW_ARRAY(int32_t, room, err));
    TRY(stress->slope = memory_array(room, sizeof *stress->slope, err));
    if (mesh->mean_next) TRY(stress->areal = memory_array(room, sizeof *stress->areal, err));

    // Adds to the row of the point at each node of an element the slopes (d/dx to d/dz) of the
    // element's shape functions there, over the number of elements around the point: the row
    // becomes their mean.
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++) {
            const int32_t *element = mesh->element_nodes + mesh->first_node[e];
            int32_t at = a - mesh->first_node[e];
            int32_t nodes = mesh->first_node[e + 1] - mesh->first_node[e];
            double share = 1.0 / shares[point[a]], b[STRAINS_MAX][ELEMENT_DOFS_MAX];
            MeshPlace position[ELEMENT_NODES_MAX];
            mesh_places(mesh, element, nodes, position);
            element_strain_matrix(mesh->kind[e], (const MeshPlace *)position,
                                  shape_node(mesh->kind[e], at), b);
            for (int32_t n = 0; n < nodes; n++) {
                int32_t k = place_in_row(stress, point[a], element[n]);
                for (int32_t d = 0; d < mesh->dim; d++)
                    stress->slope[k][d] += share * b[d][node_dof(mesh->dim, n, d)];
            }
            if (!mesh->mean_next || mesh->mean_next[e] < 0) continue;

            // Adds to `areal` in the same way the mean areal strain of the element's group, less
            // the areal strain of the element itself.
            double mean[ELEMENT_DOFS_MAX];
            ElementGroup group;
            element_group_of(mesh, e, &group);
            element_group_areal(mesh, &group, mean);
            for (int32_t n = 0; n < group.node_count; n++)
                for (int32_t d = 0; d < mesh->dim; d++)
                    stress->areal[place_in_row(stress, point[a], group.node[n])][d] +=
                        share * mean[node_dof(mesh->dim, n, d)];
            for (int32_t n = 0; n < nodes; n++)
                for (int32_t d = 0; d < mesh->dim; d++)
                    stress->areal[place_in_row(stress, point[a], element[n])][d] -=
                        share * b[d][node_dof(mesh->dim, n, d)];
        }

    // The stresses are filled at each time that is written.
    stress->elastic = NEW_ARRAY(double, strain_count(mesh->dim) * (int64_t)points, err);
    stress->total = NEW_ARRAY(double, strain_count(mesh->dim) * (int64_t)points, err);
    stress->von_mises = NEW_ARRAY(double, points, err);
cleanup:
    memory_free(shares);
    return error_is_clean(err);
}

void nodal_stress_destroy(NodalStress *stress)
{
    memory_free_all(stress->elastic, stress->total, stress->von_mises, stress->row,
                    stress->row_length, stress->column, stress->slope, stress->areal,
                    stress->region, stress->points, stress->extra_node);
    *stress = (NodalStress){0};
}

typedef struct Strains {
    double strain[STRAINS_MAX], rate[STRAINS_MAX];   // axes, then pairs of axes
} Strains;

// strain += that of a node's displacement u by the slopes of its shape function.
static void add_strain(int32_t dim, const double *slope, const double *u, double *strain)
{
    for (int32_t d = 0; d < dim; d++) strain[d] += slope[d] * u[d];
    for (int32_t row = dim; row < strain_count(dim); row++) {
        int32_t d = SHEAR_AXES[row - dim][0], f = SHEAR_AXES[row - dim][1];
        strain[row] += slope[f] * u[d] + slope[d] * u[f];
    }
}

// A row of the operator times displacement and velocity.
static Strains strains_at(const NodalStress *stress, int32_t point, const double *displacement,
                          const double *velocity)
{
    Strains found = {0};
    double more = 0, more_rate = 0;
    int32_t end = stress->row[point] + stress->row_length[point];
    for (int32_t k = stress->row[point]; k < end; k++) {
        const double *u = displacement + node_dof(stress->dim, stress->column[k], 0);
        const double *v = velocity + node_dof(stress->dim, stress->column[k], 0);
        add_strain(stress->dim, stress->slope[k], u, found.strain);
        add_strain(stress->dim, stress->slope[k], v, found.rate);
        if (!stress->areal) continue;
        for (int32_t d = 0; d < stress->dim; d++) {
            more += stress->areal[k][d] * u[d] / stress->dim;
            more_rate += stress->areal[k][d] * v[d] / stress->dim;
        }
    }
    for (int32_t d = 0; d < stress->dim; d++) {
        found.strain[d] += more;
        found.rate[d] += more_rate;
    }
    return found;
}

void nodal_strain_row(const NodalStress *stress, int32_t point, int32_t component, double share,
                      double *row)
{
    int32_t dim = stress->dim, end = stress->row[point] + stress->row_length[point];
    bool axial = component < dim;
    for (int32_t k = stress->row[point]; k < end; k++) {
        double *of_node = row + node_dof(dim, stress->column[k], 0);
        const double *slope = stress->slope[k];
        if (axial) {
            of_node[component] += share * slope[component];
            for (int32_t d = 0; stress->areal && d < dim; d++)
                of_node[d] += share * stress->areal[k][d] / dim;
        } else {
            int32_t d = SHEAR_AXES[component - dim][0], f = SHEAR_AXES[component - dim][1];
            of_node[d] += share * slope[f];
            of_node[f] += share * slope[d];
        }
    }
}

// sqrt(3 J_2) with all three normal stresses; in the plane across is sigma_yy, which counts in
// plane strain.
static double von_mises(int32_t dim, const double *stress, double across)
{
    double xx = stress[0], yy = dim == 2 ? across : stress[1], zz = stress[dim - 1], shear = 0;
    for (int32_t k = dim; k < strain_count(dim); k++) shear += 3 * stress[k] * stress[k];
    return sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) +
                shear);
}

// Von Mises is that of the mean stress, not the mean of the elements' von Mises.
// displacement, velocity: [dim * nodes] of the full mesh. stress->total has the viscous part, C's
// stress at this velocity, stress->elastic has not.
void nodal_stress_recover(const Material *materials, const double *displacement,
                          const double *velocity, const Spectrum *spectrum,
                          const double *const *relaxing, NodalStress *stress)
{
    double elastic[STRAINS_MAX][STRAINS_MAX], viscous[STRAINS_MAX][STRAINS_MAX];
    int32_t strains = strain_count(stress->dim);
    for (int32_t point = 0; point < stress->point_count; point++) {
        const Material *material = &materials[stress->region ? stress->region[point] : 0];
        moduli_matrix(material_elastic(material), stress->dim, elastic);
        moduli_matrix(material_viscous(material), stress->dim, viscous);
        Strains at = strains_at(stress, point, displacement, velocity);
        double *held = stress->elastic + strains * point, *total = stress->total + strains * point;
        for (int32_t r = 0; r < strains; r++) {
            double damped = 0;
            held[r] = 0;
            for (int32_t c = 0; c < strains; c++) {
                held[r] += elastic[r][c] * at.strain[c];
                damped += viscous[r][c] * at.rate[c];
            }
            total[r] = held[r] + damped;
        }
        double across = material_out_of_plane(material, at.strain, at.rate);
        for (int32_t j = 0; relaxing && j < spectrum->shape_count; j++) {
            const SpectrumShape *shape = &spectrum->shape[j];
            if (shape->region != (stress->region ? stress->region[point] : 0)) continue;

            // The stress of the branches of one shape, and their sigma_yy in plane strain.
            Strains stretched = strains_at(stress, point, relaxing[j], relaxing[j]);
            moduli_matrix(shape->moduli, stress->dim, elastic);
            for (int32_t r = 0; r < strains; r++) {
                double pulled = 0;
                for (int32_t c = 0; c < strains; c++) pulled += elastic[r][c] * stretched.strain[c];
                held[r] += pulled;
                total[r] += pulled;
            }
            if (material->plane_strain)
                across += shape->moduli.trace * (stretched.strain[0] + stretched.strain[1]);
        }
        stress->von_mises[point] = von_mises(stress->dim, total, across);
    }
}
