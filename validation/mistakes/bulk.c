// SPDX-License-Identifier: GPL-2.0-or-later
// Mistakes in the bulk and in the matrix of a stage.
#include "mistake.h"

#include "reduction/interface_operator.h"
#include "fem/assembly.h"
#include "fem/floor.h"
#include "fem/material.h"
#include "fem/mesh_faces.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

REPLACED(material_elastic);
REPLACED(material_viscous);
REPLACED(interface_operator_create);
REPLACED(boundary_add_weights);
REPLACED(bulk_assemble);
REPLACED(floor_find);
REPLACED(floor_displace);

Mistake mistake_made(void)
{
    static const char *const names[] = {
#define X(symbol, name) name,
        MISTAKES(X)
#undef X
    };
    static volatile int known = -1;   // hot functions ask
    const char *wanted = known < 0 ? getenv("AMONTONS_MISTAKE") : NULL;
    for (int k = 0; wanted && k < (int)(sizeof names / sizeof names[0]); k++)
        if (strcmp(wanted, names[k]) == 0) known = k;
    if (known >= 0) return (Mistake)known;
    fprintf(stderr, "AMONTONS_MISTAKE=%s: there is no such mistake\n", wanted ? wanted : "");
    _exit(3);   // an exit that is not the program's own is told as a fault (cli/options.c)
}

// sigma = D eps with Young's modulus and Poisson's ratio of the other plane state.
Moduli __wrap_material_elastic(const Material *material)
{
    Material other = *material;
    if (mistake_made() == MISTAKE_WRONG_PLANE) other.plane_strain = !material->plane_strain;
    return __real_material_elastic(&other);
}

// A shear viscosity that is twice too large leaves that along an axis as it is.
Moduli __wrap_material_viscous(const Material *material)
{
    Moduli moduli = __real_material_viscous(material);
    Mistake mistake = mistake_made();
    if (mistake == MISTAKE_VISCOUS_SIGN) moduli.trace = -material->eta2;
    if (mistake == MISTAKE_SHEAR_VISCOSITY)
        moduli = (Moduli){2 * material->eta1, material->eta2 - material->eta1};
    return moduli;
}

// One node in the middle of the list has half of what it should; corners have what a bend of their
// face leaves them.
void __wrap_boundary_add_weights(const Mesh *mesh, const MeshBoundary *boundary, bool shadow,
                                 double *weight)
{
    __real_boundary_add_weights(mesh, boundary, shadow, weight);
    if (shadow && mistake_made() == MISTAKE_HALF_WEIGHT)
        weight[boundary->nodes[boundary->node_count / 2]] /= 2;
    for (int32_t k = 0; mistake_made() == MISTAKE_BENT_CORNERS && k < boundary->face_count; k++) {
        FaceNodes face = mesh_boundary_face(boundary, k);
        for (int32_t a = 0; face.kind == ELEMENT_T6 && a < 3; a++)
            weight[face.node[a]] += 1e-4 * weight[face.node[3 + a]];
    }
}

// Only matrices of steps: those without mass are of equilibria and certificates.
InterfaceOperator *__wrap_interface_operator_create(BulkOperator *system, OperatorTerms terms,
                                                    Error *err)
{
    if (mistake_made() == MISTAKE_STAGE_MATRIX && terms.mass > 0) terms.stiffness *= 2;
    return __real_interface_operator_create(system, terms, err);
}

bool __wrap_bulk_assemble(const Mesh *mesh, const Material *materials, Bulk *bulk, Error *err)
{
    static const double LIGHT = 1e-3;
    if (!__real_bulk_assemble(mesh, materials, bulk, err)) return false;
    for (int32_t dof = 0; mistake_made() == MISTAKE_LIGHT_BASE && dof < bulk->dof_count; dof++)
        if (bulk->in_base && bulk->in_base[dof]) bulk->mass[dof] *= LIGHT;
    if (mistake_made() == MISTAKE_MASS_APART && bulk->mass_beside)
        memset(bulk->mass_beside, 0,
               (size_t)bulk->pattern.start[bulk->dof_count] * sizeof *bulk->mass_beside);
    return true;
}

// Weights of the floor's side: what is shared out of each of its nodes adds up to 1, instead of what
// each contact node takes.
static void weigh_by_floor(Floor *floor, int32_t nodes)
{
    int32_t count = floor->start[nodes];
    double *sum = calloc((size_t)nodes, sizeof *sum);
    for (int32_t k = 0; sum && k < count; k++) sum[floor->node[k]] += floor->share[k];
    for (int32_t k = 0; sum && k < count; k++)
        if (sum[floor->node[k]] != 0) floor->share[k] /= sum[floor->node[k]];
    free(sum);
}

// Each row has the node of the row that follows it in the list.
bool __wrap_floor_find(const char (*names)[GROUP_NAME_SIZE], int32_t count, const char *floor,
                       Mesh *mesh, Error *err)
{
    if (!__real_floor_find(names, count, floor, mesh, err)) return false;
    int32_t *node = mesh->floor.node, *start = mesh->floor.start;
    if (mistake_made() == MISTAKE_FLOOR_BESIDE && start && mesh->floor.matches)
        memmove(node, node + 1, (size_t)(start[mesh->node_count] - 1) * sizeof *node);
    if (mistake_made() == MISTAKE_FLOOR_WEIGHT && start && !mesh->floor.matches)
        weigh_by_floor(&mesh->floor, mesh->node_count);
    return true;
}

void __wrap_floor_displace(const Mesh *mesh, double *field)
{
    if (mistake_made() != MISTAKE_ONE_SIDED) __real_floor_displace(mesh, field);
}
