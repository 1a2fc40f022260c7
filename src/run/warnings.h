// SPDX-License-Identifier: GPL-2.0-or-later
// Warnings that a scene's answer is doubtful though it can be computed: those that the scene alone
// tells (amontons_scene_warning), weakening that is too fast for viscosity and mesh, a rod that
// misses its face, and at the end of a run slip that had too few cells to turn fast on. Written to
// run.json (warnings), handed to the caller in RunSummary. Each says in a few words what is wrong,
// then a colon and the rest: the legend of a sweep's picture has room for the former. Called by
// run/simulation once its model stands, and when it is done.
#ifndef AMONTONS_RUN_WARNINGS_H
#define AMONTONS_RUN_WARNINGS_H

#include "amontons.h"
#include "answers/error_bars.h"
#include "model/model.h"
#include "record/events.h"
#include "record/rotation.h"
#include "scene/scene.h"
#include "stepping/certificate.h"

// Contact nodes at which friction, each node taken alone, weakens faster than viscosity can damp:
// their cells are too long. *worst: the largest ratio of the two. load: F_N, force/width, taken as
// evenly spread. 0 without damping.
int32_t undamped_nodes(const Certificate *certificate, double load, double *worst);

// Materials without viscosity on which friction that weakens acts, where others have some. Returns
// whether there is one.
bool warnings_of_viscosity(const Scene *scene, const Model *model, RunWarnings *warnings);

// Branches that were made a viscosity, as they relax faster than anything in the mesh moves; those
// that do not relax in the run.
void warnings_of_branches(const Model *model, RunWarnings *warnings);

// Warns in an SI scene of a viscosity that damps every wave of the block, and what would know
// better.
void warnings_of_damping(const Model *model, RunWarnings *warnings);

// Undamped nodes. Returns whether there are some.
bool warnings_of_resolution(const Certificate *certificate, double load, RunWarnings *warnings);

// Where friction remembers, slip turns unstable over G/(p k), k what it loses in a unit of slip at
// the start (b/D_c of rate and state): contact nodes with cells longer than an eighth of that.
void warnings_of_memory(const Model *model, double load, RunWarnings *warnings);

// A block that is taller than long though only its length was given: one that a mesh file made so
// by a height of its own.
void warnings_of_shape(const Scene *scene, double length, double height, RunWarnings *warnings);
// Warns in an SI scene of a block, or a speed of sound, of a size that a unit left out would
// explain.
void warnings_of_units(const Model *model, RunWarnings *warnings);
// A gap under the contact as large as the block, or so steep where the block may touch that nodes
// which come down along z do not describe it.
void warnings_of_gaps(const Model *model, RunWarnings *warnings);
// The rod's strip against the extent of its face; height: H, length.
void warnings_of_rod(const Scene *scene, const Interface *interface, double height,
                     RunWarnings *warnings);

// A material that the mean stresses of the largest load and of mu times it deform by more than
// small strains allow for: the one that they deform most.
void warnings_of_strain(const Model *model, double mu, RunWarnings *warnings);

// Mean slip over a base since t = 0 over the length of the contact; NaN: the floor is rigid, or no
// step was begun.
double base_slip(const Model *model, const State *state);
// A block that went so far over its base that what lies under it is no longer what it was.
void warnings_of_base(double slip, RunWarnings *warnings);

// The block turned about z, or went across the drive, by a part of its way that can be seen.
void warnings_of_rotation(const Scene *scene, const Rotation *rotation, RunWarnings *warnings);

// least: the event with the fewest cells (record/drops); NULL: none, and nothing is said.
void warnings_of_slip(const Scene *scene, const Interface *interface, const Event *least,
                      RunWarnings *warnings);

// An error bar that was asked for and is not met: how far the answer is known, and why no farther.
void warnings_of_bar(const Levels *levels, RunWarnings *warnings);

// Warns of meshes left out for other load drops, of a bar that is not confirmed, and of answers of
// the last mesh that lie outside the bar of all.
void warnings_of_last_mesh(const Levels *levels, RunWarnings *warnings);

void warnings_add(RunWarnings *warnings, const char *format, ...)
    __attribute__((format(printf, 2, 3)));   // what does not fit is left out

#endif
