// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons static`: equilibrium under given load, K u = f + G' r with the plane, friction and rod
// of a run,
//
//     S u_b = g + r,   S, g: K and f condensed on the interface,
//
// which is the contact problem of one stage (contact/contact_problem) with displacements in the
// place of velocities: gap u_z >= 0, the rod at its displacement, friction Coulomb's with
// mu_static, stick meaning u_x = 0: slip is measured from the undeformed block. The problem is
// positively homogeneous: loading in proportional steps gives the same states, hence one solve.
// Reactions are then found anew from element stresses, r = int B' sigma - f, so that the balances
// printed owe nothing to the solver.
#include "amontons.h"
#include "algebra/dense.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "friction/friction.h"
#include "fem/element_group.h"
#include "fem/floor.h"
#include "contact/contact_check.h"
#include "contact/contact_solver.h"
#include "io/hdf5/array_file.h"
#include "io/text/json_writer.h"
#include "model/assemble.h"
#include "model/contact_nodes.h"
#include "record/field_files.h"
#include "run/result/result_folder.h"
#include "scene/keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PATH_SIZE = 1200 };

typedef struct StaticSolution {
    double *displacement;   // u [dof_count]; owned, like all that follows
    double *load;   // f as prescribed, also where supports hold [dof_count]
    double *reaction;   // int B' sigma - f [dof_count]: plane, rod, supports; elsewhere rounding
    double *contact_displacement;   // [interface_count]
    double *contact_reaction;   // [interface_count] r
    uint8_t *status;   // [contact_count] ContactStatus
    uint8_t *rod_touches;   // [rod_count]
    double *work;   // [dof_count]
    Rod rod;
    double rod_way;   // where it stands: rod.displacement, or less on a spring; length
    FrictionNode *friction_nodes;   // [contact_count] Coulomb's law with mu_static; owned
    Friction friction;   // of them all
    int64_t iterations;
} StaticSolution;

// Bounds say where the nodes may go: as far as the rod, and down to the substrate. They lie in
// [interface_count] `bound`, borrowed, like rod and law of the solution; S and g are the caller's
// to add. rod_reach 1: at a soft node r_x = (bound - u)/softness, as nothing moves.
static ContactProblem contact_problem(const Model *model, const StaticSolution *solution,
                                      double *bound)
{
    const Interface *interface = &model->interface;
    memset(bound, 0, (size_t)interface->count * sizeof(double));
    for (int32_t i = 0; i < interface->contact_count; i++)
        bound[interface_normal(interface, i)] = -interface_gap(interface, i);
    for (int32_t j = 0; j < interface->rod_count; j++)
        bound[interface_rod(interface, j)] = solution->rod_way;
    return (ContactProblem){.interface = &model->interface,
                            .friction = &solution->friction,
                            .rod_kind = solution->rod.kind,
                            .rod_softness = solution->rod.softness,
                            .rod_reach = 1,
                            .bound = bound};
}

// All nodes start sticking and the rod touching; bound: [interface_count] work.
static bool solve_contact(const Model *model, InterfaceOperator *stiffness, const double *g,
                          double *bound, StaticSolution *solution, Error *err)
{
    const Interface *interface = &model->interface;
    ContactSolver solver = {0};
    ContactMatrix matrix = {0};
    for (int32_t j = 0; j < interface->rod_count; j++) solution->rod_touches[j] = 1;
    for (int32_t i = 0; i < interface->contact_count; i++) solution->status[i] = CONTACT_STICK;
    ContactProblem problem = contact_problem(model, solution, bound);
    problem.matrix = &matrix;
    problem.g = g;
    ContactSolution contact = {.velocity = solution->contact_displacement,
                               .reaction = solution->contact_reaction,
                               .status = solution->status,
                               .rod_touches = solution->rod_touches};
    TRY(contact_matrix_create(interface_operator_schur(stiffness), interface->count, &matrix, err));
    TRY(contact_solver_create(interface, &solver, err));
    if (!contact_solve(&solver, &problem, &contact))
        FAIL(err, ERROR_COMPUTE,
             "%s: no equilibrium was found in %d iterations: is the block held against sliding "
             "and tipping (rod, friction, load.supports)?",
             model->scene->path, (int)solver.iterations);
    solution->iterations = solver.iterations;
cleanup:
    contact_solver_destroy(&solver);
    contact_matrix_destroy(&matrix);
    return error_is_clean(err);
}

// model: mesh, loads and interface are there; supports are held and the rod is built here. K
// alone may be singular (a block that only stands): its interface is lifted for the factor, and S
// lowered again (reduction/interface_operator). ERROR_COMPUTE: no equilibrium, or K is singular in
// the interior.
static bool static_solve(Model *model, StaticSolution *solution, Error *err)
{
    *solution = (StaticSolution){0};
    Bulk *bulk = &model->bulk;
    const Interface *interface = &model->interface;
    InterfaceOperator *stiffness = NULL;
    BulkOperator system = {0};
    double *g = NEW_ARRAY(double, interface->count, err);
    double *bound = NEW_ARRAY(double, interface->count, err);
    solution->displacement = NEW_ARRAY(double, bulk->dof_count, err);
    solution->load = NEW_ARRAY(double, bulk->dof_count, err);
    solution->reaction = NEW_ARRAY(double, bulk->dof_count, err);
    solution->work = NEW_ARRAY(double, bulk->dof_count, err);
    solution->contact_displacement = NEW_ARRAY(double, interface->count, err);
    solution->contact_reaction = NEW_ARRAY(double, interface->count, err);
    solution->status = NEW_ARRAY(uint8_t, interface->contact_count, err);
    solution->rod_touches = NEW_ARRAY(uint8_t, interface->rod_count, err);
    if (!error_is_clean(err)) goto cleanup;
    const Scene *scene = model->scene;
    RodKind kind = scene->rod.kind == ROD_BONDED ? ROD_IS_BONDED : ROD_PUSHES;
    TRY(model_build_rod(model, kind, &solution->rod, err));
    TRY(model_lay_laws(model, err));
    TRY(model_lay_gaps(model, err));
    TRY((solution->friction_nodes = NEW_ARRAY(FrictionNode, interface->contact_count, err)));
    for (int32_t i = 0; i < interface->contact_count; i++) {
        const FrictionNode *node = friction_at(&model->friction, i);
        solution->friction_nodes[i] = friction_constant(node->factor * node->law->mu_static);
    }
    solution->friction = friction_of_nodes(solution->friction_nodes, interface->contact_count);
    memcpy(solution->load, bulk->load, (size_t)bulk->dof_count * sizeof(double));
    floor_scatter(&model->mesh, solution->load);
    TRY(model_hold_supports(model, err));
    TRY(bulk_assemble(&model->mesh, model->materials.list, bulk, err));
    TRY(bulk_operator_create(bulk, model->mesh.position, interface->dofs, interface->count, &system,
                             err));
    system.machine = model_machine(model);
    OperatorTerms terms = {.stiffness = 1, .lift = true};
    TRY((stiffness = interface_operator_create(&system, terms, err)));
    // A rod on a spring is found from the forces: displacements are against it until then.
    bool rigid = scene->rod.stiffness == 0;
    if (rigid) solution->rod_way = scene->rod.displacement;
    interface_operator_pull(stiffness, model->machine_stiffness * scene->rod.displacement);
    TRY(interface_operator_condense(stiffness, bulk->load, g, err));
    TRY(solve_contact(model, stiffness, g, bound, solution, err));
    double way = interface_operator_release(stiffness, solution->contact_displacement);
    if (!rigid) solution->rod_way = way;
    TRY(interface_operator_expand(stiffness, solution->contact_displacement, solution->displacement,
                                  err));
    for (int32_t k = 0; k < interface->count; k++)
        solution->displacement[interface->dofs[k]] = solution->contact_displacement[k];
    floor_displace(&model->mesh, solution->displacement);

    // reaction = int B' sigma - f, element by element: owes nothing to the assembled matrices.
    const Mesh *mesh = &model->mesh;
    int32_t dofs[ELEMENT_DOFS_MAX];
    ElementGroup group;
    ElementMatrices matrices;
    for (int32_t dof = 0; dof < bulk->dof_count; dof++)
        solution->reaction[dof] = -solution->load[dof];
    for (int32_t e = 0; e < mesh->element_count; e++) {
        if (!element_group_at(mesh, e, &group)) continue;
        element_group_matrices(mesh, model->materials.list, &group, &matrices);
        for (int32_t i = 0; i < matrices.dof_count; i++)
            dofs[i] =
                node_dof(mesh->dim, group.node[dof_node(mesh->dim, i)], dof_axis(mesh->dim, i));
        for (int32_t row = 0; row < matrices.dof_count; row++) {
            double force = 0;
            for (int32_t column = 0; column < matrices.dof_count; column++)
                force += matrices.stiffness[row][column] * solution->displacement[dofs[column]];
            solution->reaction[dofs[row]] += force;
        }
    }
cleanup:
    interface_operator_destroy(stiffness);
    bulk_operator_destroy(&system);
    memory_free_all(bound, g);
    return error_is_clean(err);
}

// --- sums and balances --------------------------------------------------------------------------

// Sums over the contact, balances of the whole block, and how far the solution is off. Forces are
// those on the block: upwards is positive. The rod's resultant height is NaN without a force.
static StaticSummary static_summarise(const Model *model, StaticSolution *solution)
{
    const Mesh *mesh = &model->mesh;
    const Interface *interface = &model->interface;
    int32_t dofs = model->bulk.dof_count, up = mesh->dim - 1;
    StaticSummary summary = {.dim = mesh->dim,
                             .nodes = mesh->node_count,
                             .contact_nodes = interface->contact_count,
                             .rod_nodes = interface->rod_count,
                             .iterations = solution->iterations};

    // Forces of plane and rod on the block.
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double normal = solution->reaction[interface->dofs[interface_normal(interface, i)]];
        summary.shear_force += solution->reaction[interface->dofs[interface_tangent(interface, i)]];
        summary.normal_force += normal;
        summary.pressure_moment += interface->x[i] * normal;
        summary.open += solution->status[i] == CONTACT_OPEN;
        summary.sticking += solution->status[i] == CONTACT_STICK;
        summary.slipping += status_slips(solution->status[i]);
    }
    double rod_moment = 0;
    for (int32_t j = 0; j < interface->rod_count; j++) {
        double force = solution->contact_reaction[interface_rod(interface, j)];
        summary.rod_force += force;
        rod_moment += interface->rod_z[j] * force;
    }
    summary.rod_height = summary.rod_force != 0 ? rod_moment / summary.rod_force : NAN;

    // Balances of forces, moments and energy.
    MeshPlace force = {0};
    double moment = 0, moved = 0, internal_work = 0, reaction_work = 0, size = 0;
    for (int32_t node = 0; node < mesh->node_count; node++) {
        int32_t first = node_dof(mesh->dim, node, 0);
        const double *load = solution->load + first, *r = solution->reaction + first;
        const double *u = solution->displacement + first, *at = mesh_place(mesh, node);
        for (int32_t d = 0; d < mesh->dim; d++) {
            force[d] += load[d] + r[d];
            moved += fabs(r[d]);
            size = fmax(size, fabs(at[d]));
            reaction_work += r[d] * u[d];
            internal_work += (load[d] + r[d]) * u[d];
            summary.load_work += load[d] * u[d];
        }
        moment += at[0] * (load[up] + r[up]) - at[up] * (load[0] + r[0]);
    }
    double scale = moved > 0 ? moved : 1, applied = summary.load_work;
    for (int32_t k = 0; k < interface->count; k++)
        applied += solution->contact_reaction[k] * solution->contact_displacement[k];
    summary.elastic_energy = 0.5 * internal_work;
    summary.force_balance = dense_max_abs(force, mesh->dim) / scale;
    summary.moment_balance = fabs(moment) / (scale * (size > 0 ? size : 1));
    summary.energy_balance = fabs(internal_work - applied) /
                             fmax(fabs(internal_work), fabs(reaction_work) + 1e-300);

    // The largest nodal force that nothing gives, and that the interface gives otherwise than it
    // says.
    double *given = solution->work, worst = 0;
    memset(given, 0, (size_t)dofs * sizeof(double));
    for (int32_t k = 0; k < interface->count; k++)
        given[interface->dofs[k]] = solution->contact_reaction[k];
    floor_scatter(mesh, given);
    for (int32_t dof = 0; dof < dofs; dof++)
        if (!model->bulk.held[dof]) worst = fmax(worst, fabs(solution->reaction[dof] - given[dof]));
    double largest =
        fmax(dense_max_abs(solution->reaction, dofs), dense_max_abs(solution->load, dofs));
    summary.residual = worst / (largest > 0 ? largest : 1);

    // Conditions of the contact.
    ContactProblem problem = contact_problem(model, solution, solution->work);
    double contact_force = dense_max_abs(solution->contact_reaction, interface->count);
    double length = dense_max_abs(solution->displacement, dofs);
    ContactResidual residual =
        contact_residual(&problem, solution->contact_displacement, solution->contact_reaction,
                         contact_force > 0 ? contact_force : 1, length > 0 ? length : 1);
    summary.complementarity = contact_residual_max(&residual);
    return summary;
}

// --- files --------------------------------------------------------------------------------------

// One array of the file: values [rows * width].
typedef struct Column {
    ArraySeries series;
    const double *values;
    int64_t rows;
} Column;

// number: [nodes], stress: of the solution; contact: [2][contacts] node, status.
static bool write_arrays(const char *folder, const Model *model, const StaticSolution *solution,
                         const NodalStress *stress, Error *err)
{
    const Mesh *mesh = &model->mesh;
    const Interface *interface = &model->interface;
    int64_t nodes = mesh->node_count, contacts = interface->contact_count;
    int32_t dim = mesh->dim, plane = dim == 2;
    const char *force = plane ? "force/width" : "force";
    ArrayFile *file = NULL;
    char path[PATH_SIZE];
    double *number = NEW_ARRAY(double, nodes, err), *contact = NEW_ARRAY(double, 2 * contacts, err);
    if (!number || !contact) goto cleanup;
    for (int64_t i = 0; i < nodes; i++) number[i] = (double)mesh->node_number[i];
    for (int64_t i = 0; i < contacts; i++) {
        contact[i] = interface->node[i];
        contact[contacts + i] = solution->status[i];
    }
    const Column columns[] = {
        {{"nodes/number", ARRAY_INT32, 1, "1", "the mesh's node tags"}, number, nodes},
        {{"nodes/position", ARRAY_FLOAT64, dim, "length", plane ? "x, z" : "x, y, z"},
         mesh->position,
         nodes},
        {{"nodes/displacement", ARRAY_FLOAT64, dim, "length", plane ? "u_x, u_z" : "u_x, u_y, u_z"},
         solution->displacement,
         nodes},
        {{"nodes/load", ARRAY_FLOAT64, dim, force, "of pressure and tractions"},
         solution->load,
         nodes},
        {{"nodes/reaction", ARRAY_FLOAT64, dim, force,
          "of plane, rod and supports on the block; rounding at free nodes"},
         solution->reaction,
         nodes},
        {{"nodes/stress", ARRAY_FLOAT64, strain_count(dim), "stress",
          plane ? "xx, zz, xz, mean of the elements around"
                : "xx, yy, zz, xy, yz, xz, mean of the elements around"},
         stress->elastic,
         nodes},
        {{"contact/node", ARRAY_INT32, 1, "1", "row of nodes/*, by ascending x"},
         contact,
         contacts},
        {{"contact/status", ARRAY_UINT8, 1, "1",
          "0 open, 1 stick, 2 slip towards +x, 3 slip towards -x"},
         contact + contacts,
         contacts},
        {{"contact/weight", ARRAY_FLOAT64, 1, plane ? "length" : "length^2",
          "integral of the shape function"},
         interface->weight,
         contacts},
        {{"contact/jump", ARRAY_FLOAT64, dim, "length", "displacement against the floor"},
         solution->contact_displacement,
         contacts}};
    snprintf(path, sizeof path, "%s/static.h5", folder);
    TRY((file = array_file_create(path, err)));
    for (size_t k = 0; k < sizeof columns / sizeof columns[0]; k++)
        TRY(array_file_write(file, &columns[k].series, columns[k].values, 0, columns[k].rows, err));
cleanup:
    memory_free_all(number, contact);
    if (error_is_clean(err)) return array_file_close(file, err);
    array_file_abandon(file);
    return false;
}

// Files in `folder`: static.vtu, the fields for ParaView; static.h5, each node's values, for
// comparison node by node; static.json, the sums, last: if it exists, the others are whole.
// solution->work is overwritten.
static bool write_files(const char *folder, const Model *model, StaticSolution *solution,
                        const StaticSummary *summary, Error *err)
{
    FieldFiles files = {0};
    char path[PATH_SIZE];
    JsonWriter *json = NULL;
    FieldState state = {.displacement = solution->displacement, .velocity = solution->work};
    snprintf(path, sizeof path, "%s/static.vtu", folder);
    for (int32_t k = 0; k < model->bulk.dof_count; k++) solution->work[k] = 0;
    TRY(field_files_create(&model->mesh, &model->interface, &files, err));
    files.materials = model->materials.list;
    files.spectrum = &model->bulk.spectrum;
    TRY(field_files_write_bulk(&files, &state, path, err));
    TRY(write_arrays(folder, model, solution, &files.stress, err));

    // The sums.
    snprintf(path, sizeof path, "%s/static.json", folder);
    TRY(json = json_create(path, err));
    json_begin_object(json, NULL);
    json_text(json, "status", "done");
    json_text(json, "version", AMONTONS_VERSION);
    scene_write_json(model->scene, json, "scene", folder);
    json_object_of(json, "model", {"nodes", summary->nodes},
                   {"contact_nodes", summary->contact_nodes}, {"rod_nodes", summary->rod_nodes});
    json_begin_object(json, "results");
    json_numbers_of(json, {"open", summary->open}, {"sticking", summary->sticking},
                    {"slipping", summary->slipping}, {"normal_force", summary->normal_force},
                    {"shear_force", summary->shear_force},
                    {"pressure_moment", summary->pressure_moment},
                    {"rod_force", summary->rod_force}, {"rod_height", summary->rod_height});
    if (model->scene->rod.stiffness > 0) json_number(json, "rod_way", solution->rod_way);
    json_numbers_of(json, {"elastic_energy", summary->elastic_energy},
                    {"load_work", summary->load_work});
    json_integer(json, "iterations", summary->iterations);
    json_end(json);
    json_object_of(json, "errors", {"residual", summary->residual},
                   {"force", summary->force_balance}, {"moment", summary->moment_balance},
                   {"energy", summary->energy_balance},
                   {"complementarity", summary->complementarity});
    json_end(json);
    TRY(json_finish(json, err));
cleanup:
    field_files_destroy(&files);
    return error_is_clean(err);
}

// mesh -> bulk -> equilibrium -> sums -> files. folder NULL: nothing is written.
bool amontons_static(const Scene *scene, const char *folder, bool overwrite, StaticSummary *summary,
                     Error *err)
{
    NUMBERS_HAVE_A_POINT;
    Model model = model_of(scene);
    StaticSolution solution = {0};
    ResultFolder place = {0};
    *summary = (StaticSummary){0};
    TRY(dense_begin(err));
    if (scene->friction.remembers)
        FAIL(err, ERROR_INPUT,
             "%s: friction.law: what holds at rest goes by what the contacts remember; `%s` is for "
             "`amontons run`",
             scene->path, friction_law_name(&scene->friction));
    TRY(result_folder_claim(folder, overwrite, &place, err));
    TRY(model_read_mesh(NULL, &model, err));
    TRY(model_lay_bulk(&model, err));
    TRY(static_solve(&model, &solution, err));
    *summary = static_summarise(&model, &solution);
    TRY(result_folder_clear(&place, err));
    if (folder) TRY(write_files(folder, &model, &solution, summary, err));
    TRY(result_folder_settle(&place, err));
cleanup:
    memory_free_all(solution.displacement, solution.load, solution.reaction, solution.work);
    rod_destroy(&solution.rod);
    memory_free_all(solution.contact_displacement, solution.contact_reaction, solution.status,
                    solution.friction_nodes, solution.rod_touches);
    model_destroy(&model);
    result_folder_release(&place);
    return error_is_clean(err);
}
