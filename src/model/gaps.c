// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/gaps.h"

#include "base/memory.h"
#include "model/place_formula.h"
#include "scene/profile.h"

#include <math.h>

// Measured no farther than the contact nodes reach: what lies beyond is not guessed.
static bool reaches_over(const char *path, const char *axis, const double measured[2],
                         const double contact[2], Error *err)
{
    // Rounding of positions, over the contact's length: a file may hold five digits, and this is
    // far less than a cell.
    static const double ROUNDING = 1e-4;
    double slack = ROUNDING * (contact[1] - contact[0]);
    if (measured[0] > contact[0] + slack || measured[1] < contact[1] - slack)
        return REFUSE(
            err,
            "%s goes from %s = %g to %g, the contact from %g to %g: it must reach over all of it",
            path, axis, measured[0], measured[1], contact[0], contact[1]);
    return true;
}

static bool add_profile(const Scene *scene, Interface *interface, Error *err)
{
    SceneProfile profile = {0};
    const char *path = scene->contact.profile;
    const double *y = interface->y;
    int32_t count = interface->contact_count;
    TRY(scene_profile_read(scene, &profile, err));
    if (profile.y && !y)
        FAIL(err, ERROR_INPUT, "%s has x, y and gap, but the mesh is in the plane: there is no y",
             path);
    TRY(reaches_over(path, "x", (double[]){profile.x[0], profile.x[profile.count - 1]},
                     (double[]){interface->x[0], interface->x[count - 1]}, err));
    if (profile.y) {
        double reach[2] = {y[0], y[0]};
        for (int32_t i = 0; i < count; i++) {
            reach[0] = fmin(reach[0], y[i]);
            reach[1] = fmax(reach[1], y[i]);
        }
        TRY(reaches_over(path, "y", (double[]){profile.y[0], profile.y[profile.rows - 1]}, reach,
                         err));
    }
    for (int32_t i = 0; i < count; i++)
        interface->gap[i] += scene_profile_at(&profile, interface->x[i], y ? y[i] : 0);
cleanup:
    scene_profile_destroy(&profile);
    return error_is_clean(err);
}

bool model_lay_gaps(Model *model, Error *err)
{
    const Scene *scene = model->scene;
    Interface *interface = &model->interface;
    Formula formula;
    bool profile = *scene->contact.profile;
    if (!*scene->contact.gap && !profile) return true;
    if (!interface->gap && !(interface->gap = NEW_ARRAY(double, interface->contact_count, err)))
        return false;

    // The formula: in the plane it is read once, in space anew for the y of each node.
    for (int32_t i = 0; *scene->contact.gap && i < interface->contact_count; i++) {
        const double *y = interface->y ? &interface->y[i] : NULL;
        double ignored, gap = 0;
        bool done = true;
        if (i == 0 || y) done = place_formula_read(scene->contact.gap, y, &formula, err);
        if (done) gap = formula_at(&formula, interface->x[i], &ignored);
        if (done && !(gap >= 0 && isfinite(gap)))
            done = REFUSE(err, "at x = %g the gap is %g; a number >= 0 is needed", interface->x[i],
                          gap);
        if (!scene_blame(scene, "contact.gap", done, err)) return false;
        interface->gap[i] += gap;
    }
    return !profile ||
           scene_blame(scene, "contact.profile", add_profile(scene, interface, err), err);
}
