// SPDX-License-Identifier: GPL-2.0-or-later
// Checks a mesh file before gmsh reads it: gmsh opens a missing file as an empty model, takes junk
// for a script, and reads a file that was cut off inside its last number. Then has gmsh read it in
// a child process (base/child_process), so that a mesh that crashes it is an error like any other.
#include "io/mesh/mesh_file.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/files/text_file.h"
#include "io/mesh/geo_parameters.h"
#include "io/mesh/geo_script.h"
#include "io/mesh/mesh_cache.h"
#include "io/mesh/mesh_raw.h"
#include "io/mesh/msh2_entities.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SPLITS_MAX = 6, MENDED_NAME_SIZE = 40 };   // the latter: "/proc/self/fd/" and an int

// READING_SECONDS, SECONDS_MAX: of processor time, to read the file, which takes a second for 1e6
// cells, and in all. gmsh makes 900 000 triangles in it. SECONDS_WAITED: by the clock, on a machine
// that others use, too.
enum { READING_SECONDS = 20, SECONDS_MAX = 60, SECONDS_WAITED = 600 };

// --- before gmsh --------------------------------------------------------------------------------

// File in memory that gmsh opens in place of a file that had to be mended.
typedef struct MendedFile {
    int descriptor;   // -1: none, gmsh opens the file itself
    char name[MENDED_NAME_SIZE];   // to open it by, in this process and its children
} MendedFile;

static bool mended_write(const char *path, const char *bytes, int64_t size, MendedFile *mended,
                         Error *err)
{
    mended->descriptor = memfd_create("mended.msh", MFD_CLOEXEC);
    for (int64_t at = 0; mended->descriptor >= 0 && at < size;) {
        ssize_t written = write(mended->descriptor, bytes + at, (size_t)(size - at));
        if (written < 0 && errno != EINTR) {
            close(mended->descriptor);
            mended->descriptor = -1;
        }
        at += written > 0 ? written : 0;
    }
    if (mended->descriptor < 0)
        return FAULT(err, ERROR_FILE, "%s: no copy of it can be made: %s", path, strerror(errno));
    snprintf(mended->name, sizeof mended->name, "/proc/self/fd/%d", mended->descriptor);
    return true;
}

// A .msh begins as one, else gmsh would run it as a script, whatever its name ends with; it says
// its version, and has the mark that ends the elements, without which it was cut off. A byte order
// mark before it, and numbers of entities that do not tell groups apart, are mended.
static bool check_msh(const char *path, MendedFile *mended, Error *err)
{
    enum { NAMES_MAX = 1000 };
    static const char begin[] = "$MeshFormat", comments[] = "$Comments", end[] = "$EndElements";
    const char *names[NAMES_MAX];   // from its quote
    int dims[NAMES_MAX], numbers[NAMES_MAX], count = 0;
    struct stat status;
    char *bytes = NULL, *told_apart = NULL;
    int32_t size = 0;
    int64_t made = 0;
    double version = 0;
    TRY(text_file_bytes(path, GEO_BYTES_MAX, &bytes, &size, err));
    if (strncmp(bytes, begin, strlen(begin)) != 0 &&
        strncmp(bytes, comments, strlen(comments)) != 0)
        FAIL(err, ERROR_INPUT,
             "%s: is not a gmsh mesh: it does not begin with $MeshFormat (format 4.1 or 2.2)",
             path);
    const char *line = strstr(bytes, begin);   // comments may stand before it
    if (!line)
        FAIL(err, ERROR_INPUT, "%s: is not a gmsh mesh: it has no $MeshFormat (format 4.1 or 2.2)",
             path);
    line = strchr(line, '\n');
    if (!line || (version = strtod(line, NULL)) <= 0)
        FAIL(err, ERROR_INPUT, "%s: is truncated: no version after $MeshFormat", path);
    if (!memmem(bytes, (size_t)size, end, strlen(end)))
        FAIL(err, ERROR_INPUT, "%s: is truncated, or was never meshed: it has no $EndElements",
             path);

    // Between these marks `dim number "name"` on each line: of two groups of one dimension with one
    // name gmsh would give the second no name.
    const char *first = strstr(bytes, "$PhysicalNames"), *last = strstr(bytes, "$EndPhysicalNames");
    while (first && last && count < NAMES_MAX && (first = strchr(first, '\n')) && ++first < last) {
        const char *quote = strchr(first, '"');
        if (sscanf(first, "%d%*[ \t]%d", &dims[count], &numbers[count]) != 2 || !quote ||
            quote > last)
            continue;
        size_t length = strcspn(quote + 1, "\"\n") + 2;
        for (int k = 0; k < count; k++)
            if (dims[k] == dims[count] && numbers[k] != numbers[count] &&
                strncmp(names[k], quote, length) == 0)
                FAIL(err, ERROR_INPUT,
                     "%s: the physical name '%.*s' is used twice: by groups %d and %d of "
                     "dimension %d",
                     path, (int)length - 2, quote + 1, numbers[k], numbers[count], dims[k]);
        names[count++] = quote;
    }

    bool marked = stat(path, &status) != 0 ||
                  status.st_size != size;   // text_file_read left it out
    if (version < 3) TRY(msh2_tell_entities_apart(bytes, size, &told_apart, &made, err));
    if (told_apart)
        TRY(mended_write(path, told_apart, made, mended, err));
    else if (marked)
        TRY(mended_write(path, bytes, size, mended, err));
cleanup:
    memory_free_all(bytes, told_apart);
    return error_is_clean(err);
}

// Takes `refine` out of the list, which may get shorter: nothing that reads the file knows it, so
// its cells are split. ERROR_INPUT: not a power of two.
static bool take_refine(const char *path, MeshParameter *list, int32_t *count, int32_t *splits,
                        Error *err)
{
    int32_t kept = 0;
    *splits = 0;
    for (int32_t k = 0; k < *count; k++) {
        if (strcmp(list[k].name, "refine") != 0 || list[k].text[0]) {
            list[kept++] = list[k];
            continue;
        }
        int exponent = 0;
        double part = frexp(list[k].value, &exponent);
        *splits = exponent - 1;
        if (part != 0.5 || *splits < 0 || *splits > SPLITS_MAX)
            return REFUSE(
                err,
                "%s: refine = %g; its cells are split in halves along each edge, so it can be 1, "
                "2, 4, ... %d%s",
                path, list[k].value, 1 << SPLITS_MAX,
                mesh_file_format(path) == MESH_SCRIPT
                    ? " (unless the .geo has a parameter `refine`)"
                    : "");
    }
    *count = kept;
    return true;
}

// --- gmsh in a child process --------------------------------------------------------------------

// The reply is the mesh as the cache keeps it.
typedef struct MeshReading {
    const MeshRawRequest *request;
    MeshFile *mesh;
} MeshReading;

static void begin_meshing(void)
{
    child_allow(SECONDS_MAX);
}

// An empty array may be NULL, which fwrite must not be given.
static bool append(void *context, const void *bytes, int64_t size)
{
    return size == 0 || fwrite(bytes, 1, (size_t)size, context) == (size_t)size;
}

// reply: NULL in the process that asks.
static bool read_by_gmsh(void *context, FILE *reply, Error *err)
{
    const MeshReading *reading = context;
    MeshRaw raw = {0};
    MeshRawRequest request = *reading->request;
    if (reply) request.opened = begin_meshing;
    // Text that a trusted file prints must not come before our answer.
    if (reply && request.trusted) dup2(STDERR_FILENO, STDOUT_FILENO);
    MeshRawReader read = (MeshRawReader)module_function("gmsh", "amontons_gmsh_read", err);
    bool done = read && read(&request, &raw, err);
    done = done && mesh_raw_convert(&raw, request.path, reading->mesh, err);
    if (done) memcpy(reading->mesh->warning, raw.warning, sizeof raw.warning);
    mesh_raw_destroy(&raw);
    Archive archive = archive_send(append, reply);
    if (done && reply) mesh_archive(reading->mesh, &archive);   // a failure shows at its end
    return done;
}

// The mesh, in this process where no child is wanted. The module is opened in this process, once
// for all meshes: to load it takes a tenth of a second, to hand it on to a child some milliseconds.
// watch: may end it; NULL: nobody. In this process nothing ends gmsh.
static bool read_in_child(const MeshRawRequest *request, const ChildWatch *watch, MeshFile *mesh,
                          Error *err)
{
    MeshReading reading = {request, mesh};
    ChildReply reply = {0};
    ChildWork work = {.path = request->path,
                      .reader = "gmsh",
                      .seconds = READING_SECONDS,
                      .seconds_waited = SECONDS_WAITED,
                      .shut_in = !request->trusted,
                      .kept = request->descriptor,
                      .advice = "where it is not endless: coarser cells, or mesh it by gmsh itself "
                                "and name the .msh",
                      .watch = watch,
                      .read = read_by_gmsh,
                      .context = &reading};
    if (!child_is_wanted()) return read_by_gmsh(&reading, NULL, err);
    bool done = module_function("gmsh", "amontons_gmsh_read", err) &&
                child_read(&work, &reply, err);
    Archive archive = archive_read(reply.bytes, reply.size);
    archive.err = err;
    if (done) mesh_archive(mesh, &archive);
    done = done && archive_check(&archive, true, err);
    child_destroy(&reply);
    return done;
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
                    bool trusted, const ChildWatch *watch, MeshFile *mesh, Error *err)
{
    char key[HASH_TEXT_SIZE];
    bool found = false, refines = false;
    GeoScript script = {0};
    GeoParameters known = {0};
    MeshFormat format = mesh_file_format(path);
    MeshRawRequest request = {.path = path, .generate = format == MESH_SCRIPT, .trusted = trusted};
    MendedFile mended = {.descriptor = -1};
    MeshParameter *given = NULL;   // [count] without `refine` where the file does not know it
    int32_t count = parameter_count;
    struct stat status;
    *mesh = (MeshFile){0};
    if (format == MESH_NO_FORMAT)
        FAIL(err, ERROR_INPUT, "%s: a mesh is a .msh or a .geo file%s", path,
             mesh_format_advice(path));
    TRY((given = NEW_ARRAY(MeshParameter, count, err)));
    if (count > 0) memcpy(given, parameters, (size_t)count * sizeof *parameters);

    // The path leads to a file that is not empty, before anybody opens it.
    if (stat(path, &status) != 0)
        FAIL(err, ERROR_INPUT, "%s: cannot be read: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode)) FAIL(err, ERROR_INPUT, "%s: is not a file", path);
    if (status.st_size == 0) FAIL(err, ERROR_INPUT, "%s: is empty", path);

    if (request.generate) {
        if (!trusted) {
            TRY(geo_script_read(path, &script, err));
            request.script = script.text;
            request.script_size = script.size;
        }
        // gmsh would ignore a parameter that the script does not take.
        TRY(geo_parameters_read(path, &known, err));
        for (int32_t k = 0; k < known.count; k++)
            refines = refines || strcmp(known.items[k].name, "refine") == 0;
        if (!refines) TRY(take_refine(path, given, &count, &request.splits, err));
        TRY(geo_parameters_check(&known, path, given, count, err));
    } else {
        TRY(check_msh(path, &mended, err));
        TRY(take_refine(path, given, &count, &request.splits, err));
        if (count > 0)
            FAIL(err, ERROR_INPUT,
                 "%s: parameters ('%s') need a .geo; a .msh is meshed already, and knows `refine` "
                 "alone",
                 path, given[0].name);
    }
    if (mended.descriptor >= 0) request.opened_as = mended.name;
    request.descriptor = mended.descriptor;
    request.parameters = given;
    request.parameter_count = count;

    // The cache has the mesh, or gmsh makes it.
    TRY(mesh_cache_key(path, parameters, parameter_count, key, err));
    TRY(mesh_cache_load(key, mesh, &found, err));
    if (!found) {
        if (!read_in_child(&request, watch, mesh, err)) {
            name_the_file(path, &script, err);
            goto cleanup;
        }
        mesh_cache_store(key, mesh);
    }
    mesh->origin = found ? MESH_OF_CACHE : key[0] ? MESH_OF_GMSH : MESH_OF_OTHER_FILES;
cleanup:
    if (mended.descriptor >= 0) close(mended.descriptor);
    memory_free(given);
    geo_parameters_destroy(&known);
    geo_script_destroy(&script);
    return error_is_clean(err);
}
