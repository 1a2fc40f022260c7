// SPDX-License-Identifier: GPL-2.0-or-later
// The picture of a mesh by hand: drawn, to scale, nothing lost and nothing left over on failure.
#include "render/render.h"

#include "base/memory.h"
#include "near.h"

#include <unistd.h>

// Two squares of side 1, the right one as two triangles; a pad under each.
//     3---4---5
//     | 0 | \ |
//     0---1---2
static const double PLACES[] = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1};
static const uint8_t KINDS[] = {ELEMENT_Q4, ELEMENT_T3, ELEMENT_T3};
static const int32_t FIRST[] = {0, 4, 7, 10}, NODES[] = {0, 1, 4, 3, 1, 2, 4, 2, 5, 4};
static int32_t LEFT[] = {0, 1}, RIGHT[] = {1, 2}, FACE[] = {3, 0};

static RenderMesh mesh_by_hand(MeshGroup groups[3])
{
    groups[0] = (MeshGroup){.name = "contact_1", .dimension = 1, .face_count = 1};
    groups[1] = (MeshGroup){.name = "contact_2", .dimension = 1, .face_count = 1};
    groups[2] = (MeshGroup){.name = "rod", .dimension = 1, .face_count = 1};
    int32_t *const edges[] = {LEFT, RIGHT, FACE};
    for (int32_t g = 0; g < 3; g++) {
        groups[g].nodes_per_face = 2;
        groups[g].face_nodes = edges[g];
    }
    return (RenderMesh){.title = "two squares",
                        .note = "a note that is far too long for the width of the picture it is "
                                "written above, and yet must not be cut off at its end",
                        .node_count = 6,
                        .position = PLACES,
                        .element_count = 3,
                        .kind = KINDS,
                        .first_node = FIRST,
                        .element_nodes = NODES,
                        .group_count = 3,
                        .groups = groups,
                        .rod_low = 0.4,
                        .rod_high = 0.6,
                        .style = {.dpi = 118.14, .overwrite = true}};   // 400 pixels
}

// Width and height from the file's own head.
static void read_size(const char *path, uint32_t size[2])
{
    unsigned char head[24];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
    fclose(file);
    for (int32_t k = 0; k < 2; k++) {
        const unsigned char *at = head + 16 + 4 * k;
        size[k] = (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
    }
}

TEST(test_drawn)
{
    char path[] = "/tmp/amontons_mesh_XXXXXX.png";
    Error err = {0};
    MeshGroup groups[3];
    RenderMesh mesh = mesh_by_hand(groups);
    uint32_t size[2];
    int64_t live = memory_counters().live;
    close(mkstemps(path, 4));
    assert_true(amontons_render_mesh(&mesh, path, &err));
    assert_int_equal(memory_counters().live, live);
    read_size(path, size);
    assert_int_equal(size[0], 400);
    assert_in_range(size[1], 250, 400);   // 2 x 1 with margins, lines above, numbers below
    mesh.title = mesh.note = NULL;
    mesh.rod_low = mesh.rod_high = NAN;
    mesh.style.dpi = 0;
    assert_true(amontons_render_mesh(&mesh, path, &err));
    read_size(path, size);
    assert_int_equal(size[0], 2031);   // 86 mm at 600 dots per inch
    unlink(path);
}

// A column of cells far taller than wide still fits on a page.
TEST(test_tall)
{
    char path[] = "/tmp/amontons_mesh_XXXXXX.png";
    Error err = {0};
    MeshGroup groups[3];
    RenderMesh mesh = mesh_by_hand(groups);
    double places[12];
    uint32_t size[2];
    for (int32_t k = 0; k < 12; k++) places[k] = k % 2 ? 50 * PLACES[k] : PLACES[k];
    mesh.position = places;
    close(mkstemps(path, 4));
    assert_true(amontons_render_mesh(&mesh, path, &err));
    read_size(path, size);
    assert_true(size[1] <= 1.4 * 400 + 1);
    unlink(path);
}

TEST(test_memory_runs_out)
{
    char folder[] = "/tmp/amontons_mesh_XXXXXX", path[64];
    MeshGroup groups[3];
    RenderMesh mesh = mesh_by_hand(groups);
    int64_t live = memory_counters().live;
    bool done = false;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/mesh.png", folder);
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        memory_fail_after(k);
        done = amontons_render_mesh(&mesh, path, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        assert_int_equal(access(path, F_OK) == 0, done);
        assert_true(k < 100);
    }
    unlink(path);
    rmdir(folder);
}

TEST(test_no_folder)
{
    Error err = {0};
    MeshGroup groups[3];
    RenderMesh mesh = mesh_by_hand(groups);
    assert_false(amontons_render_mesh(&mesh, "/proc/none/folder/mesh.png", &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, "/proc/none/folder/mesh.png"));
}
