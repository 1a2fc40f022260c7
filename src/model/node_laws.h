// SPDX-License-Identifier: GPL-2.0-or-later
// The friction law of each contact node, where they differ. Called by model/obtain and
// run/static/static_solve when the interface is known.
#ifndef AMONTONS_MODEL_NODE_LAWS_H
#define AMONTONS_MODEL_NODE_LAWS_H

#include "model/model.h"

// Sets laws, friction_nodes and friction of the model by friction.contacts and friction.along, and
// for a law that remembers. Else friction stays the scene's law, alike at all nodes.
// ERROR_INPUT: a group that is no contact curve, a factor that is not finite or negative, with x.
bool model_lay_laws(Model *model, Error *err);

#endif
