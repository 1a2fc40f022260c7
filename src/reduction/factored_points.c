// SPDX-License-Identifier: GPL-2.0-or-later
// Factors of one analysis share their work space: each that is there at once has a copy.
#include "reduction/factored_points.h"

#include "base/memory.h"
#include "base/parallel.h"

enum { SLOTS_MAX = 4 };   // factors at once, for memory

typedef struct Slot {
    bool copied;
    BulkOperator system;
    FactoredPoint point;
    Error error;
} Slot;

typedef struct Batch {
    const FactoredPointsDef *def;
    int32_t first;   // term
    Slot slots[SLOTS_MAX];
} Batch;

static void factor(void *context, int32_t k, int32_t worker)
{
    Batch *batch = context;
    const FactoredPointsDef *def = batch->def;
    Slot *slot = &batch->slots[k];
    FactoredPoint *point = &slot->point;
    Error *err = &slot->error;
    (void)worker;
    if (!slot->copied) {
        slot->copied = true;
        TRY(bulk_operator_copy(def->system, &slot->system, err));
        point->held = NEW_ARRAY(double, def->system->dof_count, err);
        point->pull = NEW_ARRAY(double, def->system->interface_count, err);
        if (!error_is_clean(err)) return;
    }
    interface_operator_destroy(point->full);
    point->full = interface_operator_create(&slot->system, def->terms[batch->first + k], err);
    if (point->full)
        interface_operator_respond_held(point->full, def->load, point->held, point->pull, err);
cleanup:;
}

bool factored_points_visit(const FactoredPointsDef *def, Error *err)
{
    Batch batch = {.def = def};
    int32_t workers = parallel_workers(), slots = workers < SLOTS_MAX ? workers : SLOTS_MAX;
    for (int32_t at = 0; at < def->count; at += slots) {
        int32_t left = def->count - at, count = left < slots ? left : slots;
        batch.first = at;
        parallel_for(count, factor, &batch);
        for (int32_t k = 0; k < count; k++) {
            *err = batch.slots[k].error;
            if (error_is_clean(err)) def->visit(def->context, at + k, &batch.slots[k].point, err);
            if (!error_is_clean(err)) goto cleanup;
        }
    }
cleanup:
    for (int32_t k = 0; k < SLOTS_MAX; k++) {
        Slot *slot = &batch.slots[k];
        interface_operator_destroy(slot->point.full);
        memory_free_all(slot->point.held, slot->point.pull);
        bulk_operator_destroy(&slot->system);
    }
    return error_is_clean(err);
}
