// SPDX-License-Identifier: GPL-2.0-or-later
// What can be checked of a mesh file before gmsh reads it: gmsh opens a missing file as an empty
// model, takes junk for a script, and reads a file that was cut off inside its last number.
#include "io/mesh/mesh_file.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/text_file.h"
#include "io/mesh/geo_script.h"
#include "io/mesh/geo_parameters.h"
#include "io/mesh/mesh_child.h"
#include "io/mesh/mesh_cache.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { SPLITS_MAX = 6 };

// --- before gmsh --------------------------------------------------------------------------------

// What the system says of the path, before anybody opens it.
static bool check_file(const char *path, Error *err)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return REFUSE(err, "%s: cannot be read: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode)) return REFUSE(err, "%s: is not a file", path);
    if (status.st_size == 0) return REFUSE(err, "%s: is empty", path);
    return true;
}

// A .msh begins as one, else gmsh would run it as a script, whatever its name ends with (so it
// would behind a byte order mark, which text_file_read leaves out); it says its version, and has
// the mark that ends the elements, without which it was cut off.
static bool check_msh(const char *path, double *version, Error *err)
{
    static const char begin[] = "$MeshFormat", comments[] = "$Comments", end[] = "$EndElements";
    struct stat status;
    char *bytes = NULL;
    int32_t size = 0;
    TRY(text_file_read(path, GEO_BYTES_MAX, &bytes, &size, err));
    if (stat(path, &status) != 0 || status.st_size != size ||
        (strncmp(bytes, begin, strlen(begin)) != 0 &&
         strncmp(bytes, comments, strlen(comments)) != 0))
        FAIL(err, ERROR_INPUT,
             "%s: is not a gmsh mesh: it does not begin with $MeshFormat (format 4.1 or 2.2)",
             path);
    const char *line = strstr(bytes, begin);   // comments may stand before it
    if (!line)
        FAIL(err, ERROR_INPUT, "%s: is not a gmsh mesh: it has no $MeshFormat (format 4.1 or 2.2)",
             path);
    line = strchr(line, '\n');
    if (!line || (*version = strtod(line, NULL)) <= 0)
        FAIL(err, ERROR_INPUT, "%s: is truncated: no version after $MeshFormat", path);
    if (!memmem(bytes, (size_t)size, end, strlen(end)))
        FAIL(err, ERROR_INPUT, "%s: is truncated, or was never meshed: it has no $EndElements",
             path);
cleanup:
    memory_free(bytes);
    return error_is_clean(err);
}

// A request with parameters of our own choice: an array, since `refine` may leave the list.
typedef struct Parameters {
    MeshParameter *list;   // [count]; owned
    int32_t count;
} Parameters;

static bool is_refine(const MeshParameter *parameter)
{
    return strcmp(parameter->name, "refine") == 0 && !parameter->text[0];
}

// Takes `refine` out of the list: nothing that reads the file knows it, so its cells are split.
// ERROR_INPUT: not a power of two.
static bool take_refine(const char *path, Parameters *given, int32_t *splits, Error *err)
{
    int32_t kept = 0;
    *splits = 0;
    for (int32_t k = 0; k < given->count; k++) {
        if (!is_refine(&given->list[k])) {
            given->list[kept++] = given->list[k];
            continue;
        }
        int exponent = 0;
        double part = frexp(given->list[k].value, &exponent);
        *splits = exponent - 1;
        if (part != 0.5 || *splits < 0 || *splits > SPLITS_MAX)
            return REFUSE(
                err,
                "%s: refine = %g; its cells are split in halves along each edge, so it can be 1, "
                "2, 4, ... %d%s",
                path, given->list[k].value, 1 << SPLITS_MAX,
                text_ends_with(path, ".geo") ? " (unless the .geo has a parameter `refine`)" : "");
    }
    given->count = kept;
    return true;
}

// gmsh would ignore a parameter that the script does not take.
static bool check_geo(const char *path, Parameters *given, int32_t *splits, Error *err)
{
    GeoParameters known = {0};
    bool refines = false;
    TRY(geo_parameters_read(path, &known, err));
    for (int32_t k = 0; k < known.count; k++)
        refines = refines || strcmp(known.items[k].name, "refine") == 0;
    if (!refines) TRY(take_refine(path, given, splits, err));
    TRY(geo_parameters_check(&known, path, given->list, given->count, err));
cleanup:
    geo_parameters_destroy(&known);
    return error_is_clean(err);
}

// gmsh names a script that it was given as text by a descriptor, and the line of that text.
static void name_the_file(const char *path, const GeoScript *script, Error *err)
{
    static const char given[] = "/proc/self/fd/", behind[] = "', line ";
    char message[sizeof err->message];
    const char *file = path;
    int32_t line = 0, rest = 0, number = 0;
    char *found = strstr(err->message, given);
    if (!found || sscanf(found + strlen(given), "%d%n", &number, &rest) != 1) return;
    char *at = found + strlen(given) + rest;
    if (script->text && strncmp(at, behind, strlen(behind)) == 0 && found > err->message &&
        sscanf(at + strlen(behind), "%d%n", &line, &rest) == 1) {
        geo_script_place(script, line, &file, &line);
        at += strlen(behind) + (size_t)rest;
        at += strspn(at, ": ");
        snprintf(message, sizeof message, "%.*s%s:%d: %s", (int)(found - 1 - err->message),
                 err->message, file, line, at);
    } else {
        snprintf(message, sizeof message, "%.*s%s%s", (int)(found - err->message), err->message,
                 file, at);
    }
    memcpy(err->message, message, sizeof message);
}

bool mesh_file_read(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                    bool trusted, MeshFile *mesh, Error *err)
{
    char key[HASH_TEXT_SIZE];
    bool found = false;
    GeoScript script = {0};
    MeshRawRequest request = {
        .path = path, .generate = text_ends_with(path, ".geo"), .trusted = trusted};
    Parameters given = {.count = parameter_count};
    *mesh = (MeshFile){0};
    if (!request.generate && !text_ends_with(path, ".msh"))
        FAIL(err, ERROR_INPUT, "%s: a mesh is a .msh or a .geo file", path);
    TRY((given.list = NEW_ARRAY(MeshParameter, parameter_count, err)));
    if (parameter_count > 0)
        memcpy(given.list, parameters, (size_t)parameter_count * sizeof *parameters);
    TRY(check_file(path, err));
    if (request.generate && !trusted) {
        TRY(geo_script_read(path, &script, err));
        request.script = script.text;
        request.script_size = script.size;
    }
    if (request.generate)
        TRY(check_geo(path, &given, &request.splits, err));
    else
        TRY(check_msh(path, &request.version, err) &&
            take_refine(path, &given, &request.splits, err));
    if (!request.generate && given.count > 0)
        FAIL(
            err, ERROR_INPUT,
            "%s: parameters ('%s') need a .geo; a .msh is meshed already, and knows `refine` alone",
            path, given.list[0].name);
    request.parameters = given.list;
    request.parameter_count = given.count;
    TRY(mesh_cache_key(path, parameters, parameter_count, key, err));
    TRY(mesh_cache_load(key, mesh, &found, err));
    if (!found) {
        if (!mesh_child_read(&request, mesh, err)) {
            name_the_file(path, &script, err);
            goto cleanup;
        }
        mesh_cache_store(key, mesh);
    }
    mesh->origin = found ? MESH_OF_CACHE : key[0] ? MESH_OF_GMSH : MESH_OF_OTHER_FILES;
cleanup:
    memory_free(given.list);
    geo_script_destroy(&script);
    return error_is_clean(err);
}
