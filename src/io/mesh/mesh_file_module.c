// SPDX-License-Identifier: GPL-2.0-or-later
// The module amontons_gmsh, the only file that knows gmsh: loading libgmsh takes longer than
// reading a mesh. Each gmsh array is copied into counted memory and freed at once.
#include "base/memory.h"
#include "io/mesh/mesh_raw.h"

#include <errno.h>
#include <fcntl.h>
#include <gmshc.h>
#include <limits.h>
#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

// SCRIPT_NAME_SIZE: "/proc/self/fd/" and an int. MESH_ADAPT_QUADS: a value of Mesh.Algorithm.
enum { SCRIPT_NAME_SIZE = 40, MESH_ADAPT_QUADS = 8, LOCALE_SIZE = 200 };
static const char ERROR_MARK[] = "Error: ";
// gmsh's element types.
enum { MSH_TRI_3 = 2, MSH_QUA_4, MSH_TET_4, MSH_HEX_8, MSH_PRI_6, MSH_QUA_8 = 16 };

// gmsh's first error of this session, NULL: none. `log`: what gmshLoggerGet gave.
static const char *first_error(char **log, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (strncmp(log[k], ERROR_MARK, sizeof ERROR_MARK - 1) == 0)
            return log[k] + sizeof ERROR_MARK - 1;
    return NULL;
}

// Sets an error from the log's first message: the later ones mostly follow from it.
static void fail_with_log(const MeshRawRequest *request, const char *doing, Error *err)
{
    static const char *const words[] = {"point", "curve", "surface", "volume"};
    char **log = NULL, word[16], *name = NULL;
    size_t count = 0;
    int status = 0, number = 0;
    gmshLoggerGet(&log, &count, &status);
    const char *error = first_error(log, count);

    // Two `Physical Curve("top")` in a .geo: gmsh says "Physical curve 4 already exists", without
    // the name.
    bool repeats = error && sscanf(error, "Physical %15s %d already exists", word, &number) == 2;
    for (int dimension = 0; repeats && dimension <= 3; dimension++)
        if (strcmp(word, words[dimension]) == 0)
            gmshModelGetPhysicalName(dimension, number, &name, &status);
    if (name && name[0])
        error_set(err, ERROR_INPUT, __FILE__, __LINE__,
                  "%s: the physical name '%.*s' is used twice (give all its curves in one group)",
                  request->path, GROUP_NAME_SIZE - 1, name);
    else
        error_set(err, ERROR_INPUT, __FILE__, __LINE__, "%s: gmsh failed while %s: %s",
                  request->path, doing, error ? error : "it does not say why");
    for (size_t k = 0; k < count; k++) gmshFree(log[k]);
    gmshFree(log);
    gmshFree(name);
}

// True when gmsh logged an error, even where the call itself claimed success.
static bool gmsh_complained(void)
{
    char *message = NULL;
    int status = 0;
    gmshLoggerGetLastError(&message, &status);
    bool complained = status == 0 && message && message[0];
    gmshFree(message);
    return complained;
}

// Since 4.9 gmshInitialize also asks whether to mesh and show at once, as the program gmsh does.
#if GMSH_API_VERSION_MAJOR > 4 || GMSH_API_VERSION_MINOR >= 9
#define INITIALIZE(argc, argv, configuration, status)                                              \
    gmshInitialize(argc, argv, configuration, 0, status)
#else
#define INITIALIZE gmshInitialize
#endif

// Opens the file, or a script in its place. A file that is not trusted is opened here and named to
// gmsh by its descriptor: beside such a name there are no options (FILE.opt) that gmsh would run.
static bool gmsh_open(const MeshRawRequest *request, int *status, Error *err)
{
    char name[SCRIPT_NAME_SIZE], real[PATH_MAX];
    int file = -1;
    const char *path = request->opened_as ? request->opened_as : request->path;
    bool by_path = request->opened_as || (request->trusted && request->parameter_count == 0);
    bool by_script = request->script || request->parameter_count > 0;
    if (by_script)
        file = memfd_create("geo", MFD_CLOEXEC);
    else if (!by_path)
        file = open(request->path, O_RDONLY | O_CLOEXEC);
    if (!by_path && file < 0)
        FAIL(err, ERROR_FILE, "%s: cannot be opened: %s", request->path, strerror(errno));

    // The script sets the parameters, all in its first line, and is or includes the .geo:
    // DefineConstant does not change what has a value. (gmsh would keep -setnumber for every later
    // session of the process.)
    for (int32_t k = 0; k < request->parameter_count; k++) {
        const MeshParameter *parameter = &request->parameters[k];
        if (parameter->text[0])
            dprintf(file, "%s = \"%s\"; ", parameter->name, parameter->text);
        else
            dprintf(file, "%s = %.17g; ", parameter->name, parameter->value);
    }
    if (by_script && !request->script) {
        if (!realpath(request->path, real))
            FAIL(err, ERROR_FILE, "%s: %s", request->path, strerror(errno));
        if (strchr(real, '"'))
            FAIL(err, ERROR_INPUT, "%s: gmsh cannot include a file with a quote in its path", real);
        if (dprintf(file, "Include \"%s\";\n", real) <= 0)
            FAIL(err, ERROR_FILE, "%s: its parameters cannot be set", request->path);
    }
    for (int32_t done = 0; request->script && done < request->script_size;) {
        ssize_t count = write(file, request->script + done, (size_t)(request->script_size - done));
        if (count <= 0)
            FAIL(err, ERROR_FILE, "%s: no memory for its text: %s", request->path, strerror(errno));
        done += (int32_t)count;
    }
    snprintf(name, sizeof name, "/proc/self/fd/%d", file);
    gmshOpen(by_path ? path : name, status);
cleanup:
    if (file >= 0) close(file);
    return error_is_clean(err);
}

// Dimension of the block's mesh: 3 where there is a volume, 2 where there is a surface.
static int model_dimension(void)
{
    int status = 0;
    int dimension = gmshModelGetDimension(&status);
    return dimension == 3 ? 3 : 2;
}

static bool has_elements(int dimension, int entity)
{
    int *types = NULL, status = 0;
    size_t count = 0;
    gmshModelMeshGetElementTypes(&types, &count, dimension, entity, &status);
    gmshFree(types);
    return status == 0 && count > 0;
}

// gmsh has said "Error" and made its mesh nevertheless, as it does where an optimiser is not
// compiled in: its words become a warning. An error in the script itself, which has a line, is
// none: what stood there was not done.
static bool only_warns(MeshRaw *raw)
{
    char **log = NULL;
    size_t count = 0, entities = 0;
    int *pairs = NULL, status = 0, dimension = model_dimension();
    gmshLoggerGet(&log, &count, &status);
    const char *first = first_error(log, count);
    bool in_script = false;
    for (size_t k = 0; k < count; k++)
        in_script = in_script || (strncmp(log[k], ERROR_MARK, sizeof ERROR_MARK - 1) == 0 &&
                                  strstr(log[k], "', line "));

    // Every surface, in space every volume, has elements.
    gmshModelGetEntities(&pairs, &entities, dimension, &status);
    bool only = first && !in_script && status == 0 && entities > 0;
    for (size_t k = 0; only && k + 1 < entities; k += 2)
        only = has_elements(dimension, pairs[k + 1]);
    gmshFree(pairs);
    if (only) snprintf(raw->warning, sizeof raw->warning, "%s", first);
    for (size_t k = 0; k < count; k++) gmshFree(log[k]);
    gmshFree(log);
    return only;
}

// Opens the file, meshes what has no mesh, and splits its cells. Afterwards gmsh holds a mesh. A
// script that has made one of the block's dimension keeps it, with all that it did to it (SetOrder,
// RefineMesh, ...), as `gmsh - FILE` does.
static bool gmsh_load(const MeshRawRequest *request, MeshRaw *raw, Error *err)
{
    int *types = NULL, status = 0, order = 1;
    size_t count = 0;
    double algorithm = 0;
    TRY(gmsh_open(request, &status, err));
    bool is_meshed = has_elements(model_dimension(), -1);
    // gmsh reports some errors by status, some in its log only.
    if ((status || gmsh_complained()) && !(request->generate && is_meshed && only_warns(raw))) {
        fail_with_log(request, "reading it", err);
        goto cleanup;
    }

    // gmsh meshes what has no mesh yet.
    if (request->generate && !is_meshed) {
        if (request->opened) request->opened();
        gmshOptionGetNumber("Mesh.Algorithm", &algorithm, &status);
        if (status == 0 && algorithm == MESH_ADAPT_QUADS)
            FAIL(err, ERROR_INPUT,
                 "%s: sets Mesh.Algorithm = 8, which crashes gmsh 4.8; use 6, and for "
                 "quadrilaterals Mesh.RecombinationAlgorithm = 3 with it",
                 request->path);
        // Meshing threads that throw would end the program: let them log, and look at the log.
        gmshOptionSetNumber("General.AbortOnError", 0, &status);
        gmshModelMeshGenerate(model_dimension(), &status);
        if ((status || gmsh_complained()) && !only_warns(raw)) {
            fail_with_log(request, "meshing it", err);
            goto cleanup;
        }
    }
    if (request->splits == 0) goto cleanup;

    // Every edge is halved `splits` times. gmsh makes linear elements of it, which get their order
    // back; new nodes are put onto the geometry where there is one (a .geo).
    status = 0;
    gmshModelMeshGetElementTypes(&types, &count, model_dimension(), -1, &status);
    for (size_t k = 0; k < count; k++) {
        if (types[k] < MSH_TRI_3 || types[k] > MSH_PRI_6) order = 2;   // not linear
        if (types[k] == MSH_QUA_8) gmshOptionSetNumber("Mesh.SecondOrderIncomplete", 1, &status);
    }
    for (int32_t k = 0; k < request->splits && status == 0; k++) gmshModelMeshRefine(&status);
    if (status == 0 && order > 1) gmshModelMeshSetOrder(order, &status);
    if (status || (gmsh_complained() && !raw->warning[0]))
        fail_with_log(request, "splitting its cells", err);
cleanup:
    gmshFree(types);
    return error_is_clean(err);
}

// gmsh's tags are size_t, ours int64_t.
static bool copy_tags(const size_t *from, size_t count, int64_t **to, Error *err)
{
    int64_t *copy = NEW_ARRAY(int64_t, (int64_t)count, err);
    if (copy)
        for (size_t k = 0; k < count; k++) copy[k] = (int64_t)from[k];
    *to = copy;
    return copy != NULL;
}

// Appends the nodes on entities of one dimension.
static bool fetch_nodes(int dimension, MeshRaw *raw, Error *err)
{
    size_t *tags = NULL, tag_count = 0, value_count = 0, parameter_count = 0;
    double *values = NULL, *parameters = NULL;
    int status = 0;
    gmshModelMeshGetNodes(&tags, &tag_count, &values, &value_count, &parameters, &parameter_count,
                          dimension, -1, 0, 0, &status);
    if (status) FAIL(err, ERROR_LIBRARY, "gmsh gives no nodes (status %d)", status);
    int64_t old = raw->node_count, total = old + (int64_t)tag_count;
    if (!memory_resize(&raw->node_number, old, total, sizeof(int64_t), err)) goto cleanup;
    if (!memory_resize(&raw->node_dimension, old, total, sizeof(uint8_t), err)) goto cleanup;
    if (!memory_resize(&raw->node_position, 3 * old, 3 * total, sizeof(double), err)) goto cleanup;
    for (size_t k = 0; k < tag_count; k++) {
        raw->node_number[old + (int64_t)k] = (int64_t)tags[k];
        raw->node_dimension[old + (int64_t)k] = (uint8_t)dimension;
    }
    if (tag_count) memcpy(raw->node_position + 3 * old, values, 3 * tag_count * sizeof(double));
    raw->node_count = total;
cleanup:
    gmshFree(tags);
    gmshFree(values);
    gmshFree(parameters);
    return error_is_clean(err);
}

// Appends the blocks of one entity.
static bool fetch_elements(int dimension, int entity, MeshRaw *raw, Error *err)
{
    int *types = NULL, status = 0;
    size_t type_count = 0, tag_lists = 0, node_lists = 0, local_count = 0;
    char *name = NULL;   // gmsh's of a type
    double *local = NULL;
    size_t **tags = NULL, *tag_counts = NULL, **nodes = NULL, *node_counts = NULL;
    gmshModelMeshGetElements(&types, &type_count, &tags, &tag_counts, &tag_lists, &nodes,
                             &node_counts, &node_lists, dimension, entity, &status);
    if (status) FAIL(err, ERROR_LIBRARY, "gmsh gives no elements (status %d)", status);
    for (size_t k = 0; k < type_count; k++) {
        if (!memory_resize(&raw->blocks, raw->block_count, raw->block_count + 1,
                           sizeof *raw->blocks, err))
            goto cleanup;
        RawBlock *block = &raw->blocks[raw->block_count++];
        *block = (RawBlock){.dimension = dimension, .entity = entity, .gmsh_type = types[k]};
        int type_dimension = 0, order = 0, primary = 0;
        gmshModelMeshGetElementProperties(types[k], &name, &type_dimension, &order,
                                          &block->nodes_per_element, &local, &local_count, &primary,
                                          &status);
        if (status) FAIL(err, ERROR_LIBRARY, "gmsh does not know its type %d", types[k]);
        snprintf(block->type_name, sizeof block->type_name, "%s", name);
        gmshFree(name);
        gmshFree(local);
        name = NULL;
        local = NULL;
        block->count = (int64_t)tag_counts[k];
        TRY(copy_tags(tags[k], tag_counts[k], &block->number, err));
        TRY(copy_tags(nodes[k], node_counts[k], &block->nodes, err));
    }
cleanup:
    gmshFree(name);
    gmshFree(local);
    for (size_t k = 0; k < tag_lists; k++) gmshFree(tags[k]);
    for (size_t k = 0; k < node_lists; k++) gmshFree(nodes[k]);
    gmshFree(types);
    gmshFree(tags);
    gmshFree(tag_counts);
    gmshFree(nodes);
    gmshFree(node_counts);
    return error_is_clean(err);
}

// Asks for entities only: asking gmsh for a group's nodes costs 60-100 ms on a large body.
static bool fetch_group(const char *path, int dimension, int number, RawGroup *group, Error *err)
{
    char *name = NULL;
    int *entities = NULL, status = 0;
    size_t count = 0;
    *group = (RawGroup){.dimension = dimension, .number = number};
    gmshModelGetPhysicalName(dimension, number, &name, &status);
    if (name && strlen(name) >= sizeof group->name)
        FAIL(err, ERROR_INPUT, "%s: the physical name '%s' is longer than %d bytes", path, name,
             (int)sizeof group->name - 1);
    if (name) snprintf(group->name, sizeof group->name, "%s", name);
    gmshModelGetEntitiesForPhysicalGroup(dimension, number, &entities, &count, &status);
    if (status) FAIL(err, ERROR_LIBRARY, "%s: gmsh does not give group %d", path, number);
    TRY((group->entities = NEW_ARRAY(int32_t, (int64_t)count, err)));
    group->entity_count = (int32_t)count;
    for (size_t k = 0; k < count; k++) group->entities[k] = entities[k];
cleanup:
    gmshFree(name);
    gmshFree(entities);
    return error_is_clean(err);
}

// gmsh has one session a process.
static pthread_mutex_t session = PTHREAD_MUTEX_INITIALIZER;

__attribute__((visibility("default"))) bool amontons_gmsh_read(const MeshRawRequest *request,
                                                               MeshRaw *raw, Error *err)
{
    char name[] = "gmsh", *argv[] = {name, NULL}, locale[LOCALE_SIZE];
    int status = 0;
    bool begun = false;
    int *entities = NULL, *groups = NULL;   // [2 * ...] dimension and tag of each
    size_t entity_numbers = 0, group_numbers = 0;
    double factor = 1, all = 0;
    *raw = (MeshRaw){0};
    pthread_mutex_lock(&session);
    snprintf(locale, sizeof locale, "%s", setlocale(LC_NUMERIC, NULL));

    // gmsh starts without its configuration files (a user's must not change our mesh), silent, with
    // one thread (so that the same .geo gives the same mesh), and with a log.
    INITIALIZE(1, argv, 0, &status);
    if (status) FAIL(err, ERROR_LIBRARY, "gmsh does not start (status %d)", status);
    begun = true;
    gmshOptionSetNumber("General.Terminal", 0, &status);
    gmshOptionSetNumber("General.NumThreads", 1, &status);
    gmshLoggerStart(&status);

    TRY(gmsh_load(request, raw, err));
    for (int dimension = 0; dimension <= 3; dimension++) TRY(fetch_nodes(dimension, raw, err));

    // One entity after the other, as the groups of an element are those of its entity.
    gmshModelGetEntities(&entities, &entity_numbers, -1, &status);
    if (status) FAIL(err, ERROR_LIBRARY, "gmsh gives no entities (status %d)", status);
    for (size_t k = 0; k + 1 < entity_numbers; k += 2)
        TRY(fetch_elements(entities[k], entities[k + 1], raw, err));
    gmshModelGetPhysicalGroups(&groups, &group_numbers, -1, &status);
    if (status) FAIL(err, ERROR_LIBRARY, "gmsh gives no physical groups (status %d)", status);
    TRY((raw->groups = NEW_ARRAY(RawGroup, (int64_t)group_numbers / 2, err)));
    for (size_t k = 0; k + 1 < group_numbers; k += 2)
        TRY(fetch_group(request->path, groups[k], groups[k + 1], &raw->groups[raw->group_count++],
                        err));
    if (request->generate) {
        // The options that gmsh applies when it writes a mesh, as these numbers are taken from its
        // memory.
        gmshOptionGetNumber("Mesh.ScalingFactor", &factor, &status);
        for (int64_t k = 0; status == 0 && factor != 1 && k < 3 * raw->node_count; k++)
            raw->node_position[k] *= factor;
        gmshOptionGetNumber("Mesh.SaveAll", &all, &status);
        raw->all_elements = status == 0 && all != 0;
    }
cleanup:
    gmshFree(entities);
    gmshFree(groups);

    // The next session finds no model, no options and no log of this one.
    if (begun) gmshLoggerStop(&status);
    if (begun) gmshFinalize(&status);

    // gmsh sets LC_NUMERIC to "C" and leaves it so.
    if (strcmp(setlocale(LC_NUMERIC, NULL), locale) != 0) setlocale(LC_NUMERIC, locale);
    pthread_mutex_unlock(&session);
    return error_is_clean(err);
}
