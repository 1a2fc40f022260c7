// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/probes.h"

#include "base/memory.h"
#include "fem/floor.h"
#include "fem/recovery.h"
#include "io/mesh/shape_functions.h"

#include <string.h>

enum { READINGS_MAX = DIM_MAX + STRAINS_MAX };

// The displacement of a contact node over a base is its jump and that of the floor: coefficients
// are gathered on both as forces are (fem/floor).
bool probes_create(const ProbePlace *places, int32_t count, const Mesh *mesh,
                   const BulkOperator *system, const Material *materials, const Spectrum *spectrum,
                   Probes *probes, Error *err)
{
    NodalStress stress = {0};
    double *full = NULL, *rows = NULL;
    int32_t dim = mesh->dim, strains = strain_count(dim), readings = dim + strains;
    int32_t dofs = system->dof_count;
    *probes = (Probes){.dim = dim, .strains = strains, .materials = materials};
    probes->spectrum = spectrum;
    if (count == 0) return true;
    TRY((probes->list = NEW_ARRAY(Probe, count, err)));
    probes->count = count;
    TRY((probes->displacement = NEW_ARRAY(double, count *dim, err)));
    TRY((probes->velocity = NEW_ARRAY(double, count *dim, err)));
    TRY((probes->strain = NEW_ARRAY(double, count *strains, err)));
    TRY((probes->stress = NEW_ARRAY(double, count *strains, err)));
    TRY((full = NEW_ARRAY(double, (int64_t)dim * mesh->node_count, err)));
    TRY((rows = NEW_ARRAY(double, (int64_t)readings *dofs, err)));
    TRY(nodal_stress_create(mesh, &stress, err));
    for (int32_t k = 0; k < count; k++) {
        Probe *probe = &probes->list[k];
        int32_t element = places[k].element;
        ElementKind kind = (ElementKind)mesh->kind[element];
        const int32_t *nodes = mesh->element_nodes + mesh->first_node[element];
        const int32_t *points = nodal_stress_points(&stress, mesh, element);
        ShapeValues shape = shape_at(kind, places[k].at);
        probe->region = mesh_region(mesh, element);

        // Coefficients of each reading in the displacements of the mesh's nodes: of the
        // displacement along axis r, or of strain number r - dim; then in the system's unknowns.
        for (int32_t r = 0; r < readings; r++) {
            memset(full, 0, (size_t)dim * (size_t)mesh->node_count * sizeof *full);
            for (int32_t a = 0; a < element_node_count(kind); a++) {
                if (r < dim)
                    full[node_dof(dim, nodes[a], r)] += shape.value[a];
                else
                    nodal_strain_row(&stress, points[a], r - dim, shape.value[a], full);
            }
            floor_gather(mesh, full);
            TRY(bulk_operator_project(system, full, rows + (int64_t)r * dofs, err));
        }

        // Only columns in which some reading has a coefficient are kept.
        TRY((probe->column = NEW_ARRAY(int32_t, dofs, err)));
        for (int32_t j = 0; j < dofs; j++) {
            bool counts = false;
            for (int32_t r = 0; r < readings; r++)
                counts = counts || rows[(int64_t)r * dofs + j] != 0;
            if (counts) probe->column[probe->column_count++] = j;
        }
        int32_t used = probe->column_count;
        TRY((probe->row = NEW_ARRAY(double, (int64_t)used *readings, err)));
        for (int32_t c = 0; c < used; c++)
            for (int32_t r = 0; r < readings; r++)
                probe->row[(int64_t)c * readings + r] = rows[(int64_t)r * dofs + probe->column[c]];
    }
cleanup:
    nodal_stress_destroy(&stress);
    memory_free_all(full, rows);
    return error_is_clean(err);
}

void probes_destroy(Probes *probes)
{
    for (int32_t k = 0; k < probes->count; k++)
        memory_free_all(probes->list[k].column, probes->list[k].row);
    memory_free_all(probes->list, probes->displacement, probes->velocity, probes->strain,
                    probes->stress);
    *probes = (Probes){0};
}

// read: [dim + strains] of unknowns x, engineering shears.
static void read_unknowns(const Probe *probe, int32_t readings, const double *x, double *read)
{
    for (int32_t r = 0; r < readings; r++) read[r] = 0;
    for (int32_t c = 0; c < probe->column_count; c++) {
        double value = x[probe->column[c]];
        const double *row = probe->row + (int64_t)c * readings;
        for (int32_t r = 0; r < readings; r++) read[r] += row[r] * value;
    }
}

static void add_stress(Moduli moduli, double share, int32_t dim, const double *strain,
                       double *stress)
{
    double matrix[STRAINS_MAX][STRAINS_MAX];
    moduli_matrix(moduli, dim, matrix);
    for (int32_t r = 0; r < strain_count(dim); r++)
        for (int32_t c = 0; c < strain_count(dim); c++)
            stress[r] += share * matrix[r][c] * strain[c];
}

void probes_read(Probes *probes, const State *state)
{
    int32_t dim = probes->dim, strains = probes->strains, readings = dim + strains;
    const Spectrum *spectrum = probes->spectrum;
    for (int32_t k = 0; k < probes->count; k++) {
        const Probe *probe = &probes->list[k];
        const Material *material = &probes->materials[probe->region];
        double at[READINGS_MAX], rate[READINGS_MAX], stretch[READINGS_MAX];
        double *strain = probes->strain + k * strains, *stress = probes->stress + k * strains;
        read_unknowns(probe, readings, state->displacement, at);
        read_unknowns(probe, readings, state->velocity, rate);
        memcpy(probes->displacement + k * dim, at, (size_t)dim * sizeof *at);
        memcpy(probes->velocity + k * dim, rate, (size_t)dim * sizeof *rate);
        for (int32_t r = 0; r < strains; r++) {
            strain[r] = r < dim ? at[dim + r] : 0.5 * at[dim + r];
            stress[r] = 0;
        }
        add_stress(material_elastic(material), 1, dim, at + dim, stress);
        add_stress(material_viscous(material), 1, dim, rate + dim, stress);
        for (int32_t b = 0; b < state->branch_count; b++) {
            const double *of_branch = state->stretch + (int64_t)b * state->dof_count;
            read_unknowns(probe, readings, of_branch, stretch);
            for (int32_t j = 0; j < spectrum->shape_count; j++)
                if (spectrum->shape[j].region == probe->region)
                    add_stress(spectrum->shape[j].moduli, spectrum->share[b][j], dim, stretch + dim,
                               stress);
        }
    }
}
