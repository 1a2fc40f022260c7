// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/view/camera.h"

#include <math.h>

static const double TURNED = 0.46, RAISED = 0.38;   // rad: from along y, and from the horizontal
static const double AWAY = 5, GAP = 0.06;   // of the box's diagonal

static double diagonal(const double low[3], const double high[3])
{
    return sqrt(pow(high[0] - low[0], 2) + pow(high[1] - low[1], 2) + pow(high[2] - low[2], 2));
}

Camera camera_before(const double low[3], const double high[3])
{
    double along[2] = {sin(TURNED), cos(TURNED)};
    Camera camera = {.right = {along[1], -along[0], 0},
                     .forward = {cos(RAISED) * along[0], cos(RAISED) * along[1], -sin(RAISED)},
                     .up = {sin(RAISED) * along[0], sin(RAISED) * along[1], cos(RAISED)},
                     .distance = AWAY * diagonal(low, high)};
    for (int d = 0; d < 3; ++d) camera.centre[d] = (low[d] + high[d]) / 2;
    return camera;
}

void camera_see(const Camera *camera, const double place[3], double seen[3])
{
    const double *axis[3] = {camera->right, camera->up, camera->forward};
    for (int k = 0; k < 3; ++k) {
        seen[k] = 0;
        for (int d = 0; d < 3; ++d) seen[k] += (place[d] - camera->centre[d]) * axis[k][d];
    }
    seen[2] += camera->distance;
    seen[0] *= camera->distance / seen[2];
    seen[1] *= camera->distance / seen[2];
}

double camera_drop(const double low[3], const double high[3])
{
    double depth = (high[0] - low[0]) * sin(TURNED) + (high[1] - low[1]) * cos(TURNED);
    return tan(RAISED) * depth + GAP * diagonal(low, high);
}
