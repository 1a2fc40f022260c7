// SPDX-License-Identifier: GPL-2.0-or-later
// Files that `amontons static` writes: the sums as JSON, every node's values as HDF5 (for
// comparison node by node), the fields for ParaView. The JSON comes last: if it exists, the others
// are whole.
#include "run/static/static_solve.h"

#include "base/memory.h"
#include "io/hdf5/array_file.h"
#include "io/text/json_writer.h"
#include "record/field_files.h"
#include "scene/keys.h"

#include <stdio.h>

enum { PATH_SIZE = 1200 };

static bool write_json(const char *folder, const Model *model, const StaticSolution *solution,
                       const StaticSummary *summary, Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/static.json", folder);
    JsonWriter *json = json_create(path, err);
    if (!json) return false;
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
    return json_finish(json, err);
}

// One array of the file: values [rows * width].
typedef struct Column {
    ArraySeries series;
    const double *values;
    int64_t rows;
} Column;

// number: [nodes], stress: of the solution; contact: [4][contacts] node, status, x, weight.
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
          plane ? "0 open, 1 stick, 2 slip towards +x, 3 slip towards -x"
                : "0 open, 1 stick, 2 slip"},
         contact + contacts,
         contacts},
        {{"contact/weight", ARRAY_FLOAT64, 1, plane ? "length" : "length^2",
          "integral of the shape function"},
         interface->weight,
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

// solution->work is overwritten.
bool static_report_write(const char *folder, const Model *model, StaticSolution *solution,
                         const StaticSummary *summary, Error *err)
{
    FieldFiles files = {0};
    char path[PATH_SIZE];
    FieldState state = {.displacement = solution->displacement, .velocity = solution->work};
    snprintf(path, sizeof path, "%s/static.vtu", folder);
    for (int32_t k = 0; k < model->bulk.dof_count; k++) solution->work[k] = 0;
    TRY(field_files_create(&model->mesh, &model->interface, &files, err));
    files.materials = model->materials.list;
    files.spectrum = &model->bulk.spectrum;
    TRY(field_files_write_bulk(&files, &state, path, err));
    TRY(write_arrays(folder, model, solution, &files.stress, err));
    TRY(write_json(folder, model, solution, summary, err));
cleanup:
    field_files_destroy(&files);
    return error_is_clean(err);
}
