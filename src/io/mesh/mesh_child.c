// SPDX-License-Identifier: GPL-2.0-or-later
// The reply is the mesh as the cache keeps it.
#include "io/mesh/mesh_child.h"

#include "base/module.h"
#include "io/mesh/mesh_cache.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

// READING_SECONDS, SECONDS_MAX: of processor time, to read the file, which takes a second for 1e6
// cells, and in all. gmsh makes 900 000 triangles in it. SECONDS_WAITED: by the clock, on a machine
// that others use, too.
enum { READING_SECONDS = 20, SECONDS_MAX = 60, SECONDS_WAITED = 600 };

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

bool mesh_child_read(const MeshRawRequest *request, const ChildWatch *watch, MeshFile *mesh,
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
