// SPDX-License-Identifier: GPL-2.0-or-later
// The model that a scene is stepped with: read, assembled and reduced, or taken from the cache.
#ifndef AMONTONS_MODEL_OBTAIN_H
#define AMONTONS_MODEL_OBTAIN_H

#include "model/model.h"

// Somebody who wants to know which stage takes its time, and may end it before it begins or while
// it goes on.
typedef struct StageNotice {
    // "meshing", "reducing"; static storage
    bool (*tell)(void *self, const char *stage, Error *err);
    bool (*goes_on)(void *self, Error *err);   // asked while a child meshes, and
        // by any thread while the block is reduced
    void *self;   // not owned
} StageNotice;

// The shortest way to model->system: what the scene does not need of it is not done, and a shape in
// the cache is neither meshed nor assembled. On failure `model` holds what was made.
// notice: NULL: nobody.
bool model_obtain(const Scene *scene, const StageNotice *notice, Model *model, Error *err);

// Meshed and assembled where the cache does not have the shape, not reduced: sizes, memory, and
// whether it would be. On failure `model` holds what was made.
bool model_forecast(const Scene *scene, Model *model, Error *err);

#endif
