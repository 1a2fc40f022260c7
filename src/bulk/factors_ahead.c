// SPDX-License-Identifier: GPL-2.0-or-later
// Two slots: what the caller works with, and what the thread factors. Each has a copy of the
// system, made in the thread, as factors of one analysis share their work space.
#include "bulk/factors_ahead.h"

#include "base/memory.h"
#include "base/worker.h"

enum { SLOTS = 2 };

typedef struct Slot {
    bool copied;
    BulkOperator system;
    FactoredPoint point;   // owned
    OperatorTerms terms;
} Slot;

struct FactorsAhead {
    FactorsAheadDef def;
    int32_t given, taken;   // jobs handed to the thread, points to the caller
    Slot slots[SLOTS];
    Worker *worker;
};

// In the thread.
static bool factor_slot(void *context, int32_t number, int32_t waiting, Error *err)
{
    FactorsAhead *ahead = context;
    Slot *slot = &ahead->slots[number];
    (void)waiting;
    const FactorsAheadDef *def = &ahead->def;
    FactoredPoint *point = &slot->point;
    interface_operator_destroy(point->full);
    point->full = NULL;
    if (!slot->copied) {
        TRY(bulk_operator_copy(def->system, &slot->system, err));
        slot->copied = true;
        point->held = NEW_ARRAY(double, def->system->dof_count, err);
        point->pull = NEW_ARRAY(double, def->system->interface_count, err);
        if (!error_is_clean(err)) goto cleanup;
    }
    point->full = interface_operator_create(&slot->system, slot->terms, err);
    if (!point->full) goto cleanup;
    TRY(interface_operator_answer_held(point->full, def->load, point->held, point->pull, err));
cleanup:
    return error_is_clean(err);
}

// In the thread, too: memory is counted where it is asked for.
static void free_slots(void *context)
{
    FactorsAhead *ahead = context;
    for (int32_t k = 0; k < SLOTS; k++) {
        Slot *slot = &ahead->slots[k];
        interface_operator_destroy(slot->point.full);
        memory_free(slot->point.held);
        memory_free(slot->point.pull);
        bulk_operator_destroy(&slot->system);
    }
}

static void submit(FactorsAhead *ahead, int32_t slot)
{
    if (ahead->given == ahead->def.count) return;
    ahead->slots[slot].terms = ahead->def.terms[ahead->given++];
    worker_submit(ahead->worker);
}

bool factors_ahead_create(const FactorsAheadDef *def, FactorsAhead **out, Error *err)
{
    FactorsAhead *ahead = *out = NEW_ARRAY(FactorsAhead, 1, err);
    if (!ahead) goto cleanup;
    ahead->def = *def;
    WorkerDef work = {.slots = SLOTS, .work = factor_slot, .end = free_slots, .context = ahead};
    TRY(worker_create(&work, &ahead->worker, err));
    for (int32_t slot = 0; slot < SLOTS; slot++) submit(ahead, slot);
cleanup:
    return error_is_clean(err);
}

void factors_ahead_extend(FactorsAhead *ahead, int32_t count)
{
    ahead->def.count = count;
}

// The slot that the caller is done with is factored anew while it works with the other.
bool factors_ahead_next(FactorsAhead *ahead, FactoredPoint *point, Error *err)
{
    int32_t done = (ahead->taken + SLOTS - 1) % SLOTS;   // of the one before
    if (ahead->taken > 0) submit(ahead, done);
    TRY(worker_wait_for(ahead->worker, ahead->taken + 1, err));
    *point = ahead->slots[ahead->taken++ % SLOTS].point;
cleanup:
    return error_is_clean(err);
}

void factors_ahead_destroy(FactorsAhead *ahead)
{
    if (!ahead) return;
    worker_destroy(ahead->worker);
    memory_free(ahead);
}
