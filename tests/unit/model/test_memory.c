// SPDX-License-Identifier: GPL-2.0-or-later
// The modes of the mesh that a run keeps for fields and probes, against what is told of them
// before a basis is there. How many unknowns a basis needs is not known then, hence the half.
#include "model/memory.h"

#include "amontons.h"
#include "model/obtain.h"
#include "scene/scene.h"

#include "near.h"

static void check(const char *file, const char *const *overrides, int32_t count)
{
    Error err = {0};
    Scene *scene = NULL;
    Model model = {0};
    double bytes = 0;
    char path[600];
    snprintf(path, sizeof path, "%s/validation/%s", getenv("AMONTONS_SOURCE"), file);
    if (!amontons_scene_read(path, overrides, count, &scene, &err)) fail_msg("%s", err.message);
    if (!model_obtain(scene, NULL, &model, &err)) fail_msg("%s", err.message);
    assert_true(model.is_reduced);
    for (int32_t p = 0; p < model.reduced.part_count; p++) {
        const ReducedPart *part = &model.reduced.part[p];
        bytes += (double)sizeof *part->modes * part->full_dofs * part->count;
    }
    MemorySizes sizes = {.space = model.mesh.dim > 2,
                         .unknowns = model.bulk.dof_count,
                         .interface = model.interface.count,
                         .parts = model.reduced.part_count};
    double without = memory_expected(&sizes, true);
    sizes.modes = true;
    double told = memory_expected(&sizes, true) - without;
    assert_true(bytes > told / 1.5 && bytes < 1.5 * told);
    model_destroy(&model);
    amontons_scene_destroy(scene);
}

TEST(test_modes_in_the_plane)
{
    const char *overrides[] = {"mesh.set.nx=40", "mesh.set.nz=40", "output.fields={every_U: 0.01}",
                               "reduction.cache=false"};
    check("paper/fig1.yaml", overrides, 4);
}

TEST(test_modes_in_space)
{
    const char *overrides[] = {"mesh.set={length: 1, breadth: 1, height: 1, nx: 10, ny: 10, nz: 8}",
                               "output.fields={every_U: 0.01}", "reduction.cache=false"};
    check("space/papers.yaml", overrides, 3);
}
