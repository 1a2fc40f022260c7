// SPDX-License-Identifier: GPL-2.0-or-later
// The disk fills up in the middle of a run, at one size after the other: the run ends with an error
// that says so, and no file with a final name is half a file.
#include "base/memory.h"
#include "block_mesh.h"
#include "io/hdf5/result_file.h"
#include "result_place.h"
#include "small_scene.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>

// A Q4 block as .msh 2.2: a .geo would want a script written, which is not what is tested.
static void write_mesh(const char *place, const char *name)
{
    BlockDef def = {.kind = ELEMENT_Q4, .nx = 4, .nz = 4, .length = 1, .height = 0.5};
    MeshFile mesh = block_file(&def);
    FILE *file = fopen(place_path(place, name), "w");
    assert_non_null(file);
    fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n2 9 \"body\"\n");
    int32_t edges = 0, tag = 0;
    for (int32_t k = 0; k < mesh.group_count; k++) {
        fprintf(file, "1 %d \"%s\"\n", k + 1, mesh.groups[k].name);
        edges += mesh.groups[k].face_count;
    }
    fprintf(file, "$EndPhysicalNames\n$Nodes\n%d\n", mesh.node_count);
    for (int32_t i = 0; i < mesh.node_count; i++)
        fprintf(file, "%d %.17g %.17g 0\n", i + 1, mesh.position[2 * i], mesh.position[2 * i + 1]);
    fprintf(file, "$EndNodes\n$Elements\n%d\n", edges + mesh.element_count);
    for (int32_t k = 0; k < mesh.group_count; k++)
        for (int32_t e = 0; e < mesh.groups[k].face_count; e++)
            fprintf(file, "%d 1 2 %d %d %d %d\n", ++tag, k + 1, k + 1,
                    mesh.groups[k].face_nodes[2 * e] + 1, mesh.groups[k].face_nodes[2 * e + 1] + 1);
    for (int32_t e = 0; e < mesh.element_count; e++) {
        const int32_t *nodes = mesh.element_nodes + 4 * e;
        fprintf(file, "%d 3 2 9 1 %d %d %d %d\n", ++tag, nodes[0] + 1, nodes[1] + 1, nodes[2] + 1,
                nodes[3] + 1);
    }
    fprintf(file, "$EndElements\n");
    fclose(file);
    mesh_file_destroy(&mesh);
}

// No file may grow beyond `bytes`; 0: no limit.
static void limit_files(rlim_t bytes)
{
    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes > 0 ? bytes : limit.rlim_max;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static bool ends_with(const char *place, const char *name, const char *ending)
{
    static char text[1 << 21];
    size_t size = strlen(ending), length = 0;
    FILE *file = fopen(place_path(place, name), "r");
    assert_non_null(file);
    length = fread(text, 1, sizeof text, file);
    fclose(file);
    return length >= size && memcmp(text + length - size, ending, size) == 0;
}

// Every file of the folder `name` in `place` that bears no .part.
static void check_vtk_files(const char *place)
{
    DIR *directory = opendir(place_path(place, "fields"));
    if (!directory) return;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        char name[400];
        const char *dot = strrchr(entry->d_name, '.');
        if (!dot || (strcmp(dot, ".vtu") != 0 && strcmp(dot, ".vtp") != 0)) continue;
        snprintf(name, sizeof name, "fields/%s", entry->d_name);
        if (!ends_with(place, name, "</VTKFile>\n")) fail_msg("%s is half a file", name);
    }
    closedir(directory);
}

static void check_place(const char *place)
{
    Error err = {0};
    check_vtk_files(place);
    if (place_has(place, "run.json") && !ends_with(place, "run.json", "}\n"))
        fail_msg("run.json is half a file");
    if (place_has(place, "fields.pvd") && !ends_with(place, "fields.pvd", "</VTKFile>\n"))
        fail_msg("fields.pvd is half a file");
    if (!place_has(place, "history.h5")) return;
    ArrayFile *file = result_file_open(place, &err);   // whole: opens and holds its last table
    assert_non_null(file);
    for (ResultTable table = 0; table < RESULT_TABLES_COUNT; table++)
        assert_true(array_file_has(file, result_table_name(table)) !=
                    (table == EVENTS_SLIPPED));   // in space
    assert_true(array_file_close(file, &err));
}

// Runs once for each size; returns how often the disk was too small.
static int32_t run_at_all_sizes(const char *output)
{
    const rlim_t sizes[] = {1, 1000, 3000, 6000, 10000, 20000, 40000, 60000, 100000, 0};
    int32_t failed = 0;
    char meshes[PLACE_SIZE], mesh[PLACE_SIZE + 40];
    place_make(meshes);
    write_mesh(meshes, "block.msh");
    snprintf(mesh, sizeof mesh, "mesh={file: %s/block.msh}", meshes);
    Scene *scene = small_scene((const char *const[]){mesh, "rod.width=0.3", "time.until={t: 40}",
                                                     "time.step_max=1", output, NULL});
    int64_t live = memory_counters().live;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        Error err = {0};
        RunSummary summary;
        char place[PLACE_SIZE];
        place_make(place);
        RunOptions options = {.folder = place};
        limit_files(sizes[k]);
        bool done = amontons_run(scene, &options, &summary, &err);
        limit_files(0);
        if (!done && err.code != ERROR_FILE)
            fail_msg("%d bytes: %s: %s", (int)sizes[k], amontons_error_name(err.code), err.message);
        if (!done && !strstr(err.message, place)) fail_msg("where? %s", err.message);
        if (done) assert_true(place_has(place, "run.json"));
        check_place(place);
        assert_int_equal(memory_counters().live, live);
        failed += !done;
        place_remove(place);
        if (sizes[k] == 0) assert_true(done);
    }
    amontons_scene_destroy(scene);
    place_remove(meshes);
    return failed;
}

TEST(test_history)
{
    assert_true(run_at_all_sizes("output={history: true, fields: none}") >= 6);
}

TEST(test_fields)
{
    assert_true(run_at_all_sizes("output={history: false, fields: {every_t: 20}}") >= 3);
}

TEST(test_report_only)
{
    int32_t failed = run_at_all_sizes("output={history: false, fields: none}");
    assert_true(failed >= 2 && failed <= 5);
}

FIXTURE(group_begin)
{
    signal(SIGXFSZ, SIG_IGN);   // then write() fails with EFBIG
    return 0;
}

GROUP_BETWEEN(group_begin, NULL);
