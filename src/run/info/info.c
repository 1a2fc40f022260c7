// SPDX-License-Identifier: GPL-2.0-or-later
// Contents of a file in text: the name's end tells the kind; a folder is a result.
#include "amontons.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "base/module.h"
#include "base/text.h"
#include "fem/mesh_parts.h"
#include "io/files/folder.h"
#include "io/files/text_file.h"
#include "io/text/json_reader.h"
#include "model/model.h"
#include "model/scene_mesh.h"
#include "render/render.h"
#include "run/info/info_curves.h"
#include "run/result/result_folder.h"
#include "scene/friction_law.h"
#include "scene/keys.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// --- a mesh -------------------------------------------------------------------------------------

static const char *size_name(const Mesh *mesh)
{
    return mesh->dim == 2 ? "area" : "volume";
}

// The aspect ratio is fem/mesh_summary's: longest over shortest edge of an element.
static void write_mesh(const Mesh *mesh, FILE *out)
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

// Has the module `render` draw the mesh. strip: the rod's lowest and highest z, length; NULL:
// none. unit: of lengths, as RenderMesh has it.
static bool draw_mesh(const Mesh *mesh, const double strip[2], const char *unit,
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

// Reads and checks the mesh as a run would do it, so that what is wrong with it is found before
// anything is computed.
static bool info_mesh(const char *path, const InfoOptions *options, FILE *out, Error *err)
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
    write_mesh(&mesh, out);

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
    if (options->picture) TRY(draw_mesh(&mesh, NULL, NULL, options, err));
cleanup:
    mesh_file_destroy(&file);
    mesh_parts_destroy(&parts);
    mesh_destroy(&mesh);
    memory_free(parameters);
    return error_is_clean(err);
}

// --- a result, from run.json --------------------------------------------------------------------

enum { PATH_SIZE = 1100, REPORT_BYTES_MAX = 1 << 28 };

// "  label   value" for each of these entries of run.json that is there.
static const struct {
    const char *path, *label;
} entries[] = {
    {"status", "status"},
    {"failure", "failure"},
    {"message", "message"},
    {"results.mu_M", "mu_M"},
    {"results.mu_M_spread", "mu_M spread"},
    {"results.mu_hold", "mu_hold"},
    {"results.mu_max", "mu_max"},
    {"results.l_c_over_L", "l_c / L"},
    {"results.l_sc_over_L", "l_sc / L"},
    {"results.slip_cells", "slip cells"},
    {"base.slip_over_contact", "slip over base / L"},
    {"base.dundurs_alpha", "Dundurs' alpha"},
    {"base.dundurs_beta", "Dundurs' beta"},
    {"base.shear_impedance_over_block", "rho c_S over block"},
    {"steps.accepted", "accepted steps"},
    {"steps.rejected", "rejected steps"},
    {"timing_s.total", "time taken, s"},
    {"errors.energy", "energy error"},
    {"errors.complementarity", "complementarity"},
    {"errors.moment", "moment error"},
};

// Entries that are missing in run.json (a failed run has no mu_M) are left out. The file may be
// long: each event is in it, and no tree is made of it.
static bool write_run(const char *folder, FILE *out, Error *err)
{
    char path[PATH_SIZE], *text = NULL;
    int32_t size = 0, lines = 1;
    snprintf(path, sizeof path, "%s/run.json", folder);
    if (access(path, F_OK) != 0) {
        fprintf(out, "  no run.json: the run was killed, or is still under way\n");
        snprintf(path, sizeof path, "%s/%s", folder, CHECKPOINT_FILE);
        if (access(path, F_OK) == 0)
            fprintf(out, "  %s: `run --resume` goes on\n", CHECKPOINT_FILE);
        return true;
    }
    TRY(text_file_read(path, REPORT_BYTES_MAX, &text, &size, err));
    if (!json_is_whole(text)) {
        for (const char *at = text; *at; at++) lines += *at == '\n';
        FAIL(err, ERROR_INPUT, "%s:%d: ends before its last bracket: no run.json of ours", path,
             lines);
    }
    for (size_t k = 0; k < sizeof entries / sizeof entries[0]; k++) {
        if (!json_may_hold(text, entries[k].path)) continue;
        const char *entry = entries[k].path;
        char beside[PATH_SIZE], words[ERROR_MESSAGE_SIZE];
        double value = NAN, known_to = NAN, error = NAN;
        fprintf(out, "  %-18s ", entries[k].label);
        snprintf(beside, sizeof beside, "%s_known_to", entry);
        if (json_find_number(text, beside, &known_to)) {
            // A result of which run.json tells how far it is known.
            snprintf(beside, sizeof beside, "%s_error", entry);
            json_find_number(text, beside, &error);
            json_find_number(text, entry, &value);
            bool has_bar = error == known_to;
            text_estimate(value, has_bar ? error : (double)NAN, known_to, words);
            fputs(words, out);
            if (!has_bar && !isnan(value)) {
                text_known_to(value, known_to, words);
                fprintf(out, ", %s (on this mesh %.6g)", words, value);
            }
        } else if (json_find_text(text, entry, words, sizeof words)) {
            fputs(words, out);
        } else if (!json_find_number(text, entry, &value) || isnan(value)) {
            fputs("none", out);
        } else {   // to six digits where it is not whole
            fprintf(out, fabs(value) < 1e15 && value == floor(value) ? "%.0f" : "%.6g", value);
        }
        fputc('\n', out);
    }
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

static bool info_result(const char *folder, FILE *out, Error *err)
{
    static const char *const files[] = {"history.h5", "history.h5.part", "run.json"};
    bool there = false;
    for (int32_t k = 0; k < 3; k++) {
        char path[PATH_SIZE];
        if (!folder_check_inside(folder, files[k], err)) return false;
        snprintf(path, sizeof path, "%s/%s", folder, files[k]);
        there = there || access(path, F_OK) == 0;
    }
    if (!there)
        return REFUSE(err, "%s: not a result folder: no run.json and no history.h5 in it", folder);
    fprintf(out, "result %s\n", folder);
    return write_run(folder, out, err);
}

// --- a scene ------------------------------------------------------------------------------------

// Every key with its value after defaults; `-` where a key without a default was left out, which
// the scene does not need then.
static bool info_scene(const char *path, const InfoOptions *options, FILE *out, Error *err)
{
    Scene *scene = NULL;
    Mesh mesh = {0};
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    bool (*read)(const char *, const char *const *, int32_t, Scene **, Error *) =
        options->trust ? amontons_scene_read_trusted : amontons_scene_read;
    TRY(read(path, options->overrides, options->override_count, &scene, err));
    fprintf(out, "scene %s\n  %s\n\n", path, *scene->title ? scene->title : "(no title)");
    for (int32_t k = 0; k < count; k++) {
        char value[2000];
        scene_key_value(&keys[k], scene, value, sizeof value);
        bool absent = !keys[k].standard && !scene->given[k];
        if (scene_key_may_lack(&keys[k]) && absent) continue;
        fprintf(out, "  %-28s %s%s\n", keys[k].name, absent ? "-" : value,
                scene->given[k] ? "" : "   (default)");
    }
    if (scene_law_waits(scene))
        fprintf(out, "\nThe law depends on the pressure that load.force makes on the mesh; a run "
                     "looks at it\n");
    else if (friction_is_own(&scene->friction))
        fprintf(out, "\nThe law's own mu at rest %.6g, lowest mu %.6g, v_c %.4g\n",
                scene->friction.mu_static, scene->friction.mu_kinetic,
                scene->friction.critical_velocity);

    // mu at rest under a table that begins above v = 0.
    const FrictionTable *table = &scene->friction.table;
    bool given = scene->given[scene_key_index("friction.mu_static")];
    if (scene->friction.kind == FRICTION_TABLE && table->first > 0)
        fprintf(out, "The table begins at v = %.4g; at rest mu is %.6g, %s\n", table->first,
                table->rest, given ? "friction.mu_static" : "its first value");
    TRY(info_write_material(scene, out, err));
    fprintf(out, "\nThe mesh file is %s\n", scene->mesh.file);
    if (options->picture && info_picture_is_of(options->picture, "friction"))
        TRY(info_draw_friction(scene, options, err));
    else if (options->picture && info_picture_is_of(options->picture, "material"))
        TRY(info_draw_material(scene, options, err));
    else if (options->picture) {
        // The mesh that the scene names, with its parameters, and where the rod stands.
        TRY(scene_mesh_read(scene, NULL, &mesh, NULL, err));
        write_mesh(&mesh, out);
        double middle = 0, width = 0;
        model_rod_strip(scene, mesh.z_max - mesh.z_min, &middle, &width);
        double strip[2] = {middle - 0.5 * width, middle + 0.5 * width};
        const char *unit = scene->units == UNITS_SI ? "m" : "~{L}_{0}";
        TRY(draw_mesh(&mesh, scene->rod.kind == ROD_NONE ? NULL : strip, unit, options, err));
    }
cleanup:
    mesh_destroy(&mesh);
    amontons_scene_destroy(scene);
    return error_is_clean(err);
}

// --- any of them --------------------------------------------------------------------------------

// Problems with the output (a full disk, a closed pipe) are errors too.
bool amontons_info(const char *path, const InfoOptions *options, FILE *out, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    static const char *const names[] = {"run.json", "history.h5", "history.h5.part"};
    struct stat status;
    InfoOptions none = {0};
    char folder[AMONTONS_PATH_SIZE];
    if (!options) options = &none;
    if (stat(path, &status) != 0) return REFUSE(err, "%s: %s", path, strerror(errno));

    // A file of a result stands for the folder that it lies in.
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    int length = slash ? (int)(slash - path) : 0;
    bool fits = !S_ISDIR(status.st_mode) && length < AMONTONS_PATH_SIZE;
    for (size_t k = 0; fits && k < sizeof names / sizeof names[0]; k++) {
        if (strcmp(name, names[k]) != 0) continue;
        snprintf(folder, sizeof folder, "%.*s", length, path);
        if (length == 0) snprintf(folder, sizeof folder, slash ? "/" : ".");
        return amontons_info(folder, options, out, err);
    }

    bool told;
    if (S_ISDIR(status.st_mode)) {
        if (options->picture || options->override_count > 0)
            return REFUSE(err,
                          "%s is a result folder: values are set and meshes drawn of meshes and "
                          "scenes (`amontons render` draws a result)",
                          path);
        told = info_result(path, out, err);
    } else if (mesh_file_format(path) != MESH_NO_FORMAT)
        told = info_mesh(path, options, out, err);
    else if (text_ends_with(path, ".yaml") || text_ends_with(path, ".yml"))
        told = info_scene(path, options, out, err);
    else
        return REFUSE(err,
                      "%s: not known what this is; allowed: a mesh (.msh, .geo), a scene (.yaml, "
                      ".yml), a result folder, or its run.json or history.h5",
                      path);
    if (told && (fflush(out) != 0 || ferror(out)))
        return FAULT(err, ERROR_FILE, "cannot write: %s", strerror(errno));
    return told;
}
