// SPDX-License-Identifier: GPL-2.0-or-later
// What a scene gives each contact node: its friction law, where they differ, and its gap by the
// shape of the substrate (contact.gap and contact.profile). Called by model/obtain and
// run/static/static_solve when the interface is known.
#ifndef AMONTONS_MODEL_CONTACT_NODES_H
#define AMONTONS_MODEL_CONTACT_NODES_H

#include "model/model.h"

// Sets laws, friction_nodes and friction of the model by friction.contacts and friction.along, and
// for a law that remembers. Else friction stays the scene's law, alike at all nodes.
// ERROR_INPUT: a group that is no contact curve, a factor that is not finite or negative, with x.
bool model_lay_laws(Model *model, Error *err);

// Adds the gaps of the scene to those that the mesh's own curves leave; without them the interface
// stays as it is. ERROR_INPUT: a gap that is not finite or negative, with x.
bool model_lay_gaps(Model *model, Error *err);

#endif
