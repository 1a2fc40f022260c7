// SPDX-License-Identifier: GPL-2.0-or-later
// Newtons of a scene in the model's own terms: by thickness in the plane, as they are in space.
#include "model/loads.h"

#include "block_mesh.h"
#include "cases.h"
#include "near.h"

#include <stdlib.h>
#include <string.h>

static Scene *new_scene(void)
{
    Scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    strcpy(scene->groups.top, "top");
    return scene;
}

TEST(force_over_the_top)
{
    Error err = {0};
    Scene *scene = new_scene();
    Mesh mesh = {0};
    double pressure = 0;
    block_build(&(BlockDef){.kind = ELEMENT_Q4, .length = 2, .height = 0.5, .nx = 4, .nz = 2},
                &mesh);
    scene->load.force = 60;
    scene->rod.stiffness = 4e6;
    assert_false(scene_check_thickness(scene, &mesh, &err));
    assert_non_null(strstr(err.message, "load.force: in the plane a force needs"));
    error_clear(&err);
    scene->thickness = 0.006;
    assert_true(scene_check_thickness(scene, &mesh, &err));
    assert_true(scene_pressure(scene, &mesh, &pressure, &err));
    assert_near("pressure", pressure, 60 / (0.006 * 2), 1e-9);
    assert_near("per width", scene_machine_stiffness(scene, &mesh, 1), 4e6, 0);
    scene->rod.stiffness_is_total = true;
    assert_near("whole", scene_machine_stiffness(scene, &mesh, 1), 4e6 / 0.006, 1e-6);
    assert_near("forces", scene_whole_force(scene, 2), 0.006, 0);
    scene->thickness = scene->load.force = 0;
    assert_false(scene_check_thickness(scene, &mesh, &err));
    assert_non_null(strstr(err.message, "rod.stiffness: in the plane N/m"));
    error_clear(&err);
    scene->load.force = 60;
    scene->thickness = 1;
    strcpy(scene->groups.top, "roof");
    assert_false(scene_pressure(scene, &mesh, &pressure, &err));
    assert_non_null(strstr(err.message, "groups.top"));
    mesh_destroy(&mesh);
    free(scene);
}
