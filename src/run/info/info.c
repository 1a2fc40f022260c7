// SPDX-License-Identifier: GPL-2.0-or-later
// Contents of a file in text: the name's end tells the kind; a folder is a result.
#include "run/info/info.h"

#include "amontons.h"
#include "base/decimal_point.h"
#include "base/text.h"
#include "model/model.h"
#include "model/scene_mesh.h"
#include "run/info/info_curves.h"
#include "scene/friction_law.h"
#include "scene/keys.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

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
        info_write_mesh(&mesh, out);
        double middle = 0, width = 0;
        model_rod_strip(scene, mesh.z_max - mesh.z_min, &middle, &width);
        double strip[2] = {middle - 0.5 * width, middle + 0.5 * width};
        const char *unit = scene->units == UNITS_SI ? "m" : "~{L}_{0}";
        TRY(info_draw_mesh(&mesh, scene->rod.kind == ROD_NONE ? NULL : strip, unit, options, err));
    }
cleanup:
    mesh_destroy(&mesh);
    amontons_scene_destroy(scene);
    return error_is_clean(err);
}

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
