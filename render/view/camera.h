// SPDX-License-Identifier: GPL-2.0-or-later
// How a block in space is seen: from its trailing and right side and from above, in perspective,
// with x to the right. Called by block, mesh_picture and block_page.
#ifndef AMONTONS_RENDER_VIEW_CAMERA_H
#define AMONTONS_RENDER_VIEW_CAMERA_H

typedef struct Camera {
    double centre[3];   // what it looks at: lengths there are as on the page
    double right[3], up[3], forward[3];   // unit vectors
    double distance;   // from there, length
} Camera;

// Camera before a box from `low` to `high`.
Camera camera_before(const double low[3], const double high[3]);

// seen: across, up, and how far away; lengths.
void camera_see(const Camera *camera, const double place[3], double seen[3]);

// Distance below the box at which its floor must be drawn, so that the box hides nothing of it,
// length.
double camera_drop(const double low[3], const double high[3]);

#endif
