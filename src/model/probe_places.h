// SPDX-License-Identifier: GPL-2.0-or-later
// Where the probes of a scene (output.probes) are in its mesh. Called by model/obtain.
#ifndef AMONTONS_MODEL_PROBE_PLACES_H
#define AMONTONS_MODEL_PROBE_PLACES_H

#include "fem/mesh.h"
#include "record/probes.h"
#include "scene/scene.h"

// places: [SCENE_PROBES_MAX], filled as far as the scene has probes. ERROR_INPUT: a probe has
// another number of coordinates than the mesh, or lies outside of all bodies; it says which body is
// nearest, and where.
bool probe_places_find(const Scene *scene, const Mesh *mesh, ProbePlace *places, Error *err);

#endif
