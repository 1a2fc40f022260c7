// SPDX-License-Identifier: GPL-2.0-or-later
// Two slots: what the caller works with, and what a thread factors; both while the caller waits.
// Each has a thread and a copy of the system, made there, as factors of one analysis share their
// work space.
#include "reduction/factors_ahead.h"

#include "base/memory.h"
#include "base/worker.h"

enum { SLOTS = 2 };

typedef struct Slot {
    const FactorsAheadDef *def;
    bool copied;
    BulkOperator system;
    FactoredPoint point;   // owned
    OperatorTerms terms;
    Worker *worker;
} Slot;

struct FactorsAhead {
    FactorsAheadDef def;
    int32_t given, taken;   // jobs handed to the threads, points to the caller
    Slot slots[SLOTS];
};

// In the thread.
static bool factor_slot(void *context, int32_t number, int32_t waiting, Error *err)
{
    Slot *slot = context;
    (void)number, (void)waiting;
    const FactorsAheadDef *def = slot->def;
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
    TRY(interface_operator_respond_held(point->full, def->load, point->held, point->pull, err));
cleanup:
    return error_is_clean(err);
}

// In the thread, too: memory is counted where it is asked for.
static void free_slot(void *context)
{
    Slot *slot = context;
    interface_operator_destroy(slot->point.full);
    memory_free(slot->point.held);
    memory_free(slot->point.pull);
    bulk_operator_destroy(&slot->system);
}

static void submit(FactorsAhead *ahead, Slot *slot)
{
    if (ahead->given == ahead->def.count) return;
    slot->terms = ahead->def.terms[ahead->given++];
    worker_submit(slot->worker);
}

bool factors_ahead_create(const FactorsAheadDef *def, FactorsAhead **out, Error *err)
{
    FactorsAhead *ahead = *out = NEW_ARRAY(FactorsAhead, 1, err);
    if (!ahead) goto cleanup;
    ahead->def = *def;
    for (int32_t k = 0; k < SLOTS; k++) {
        Slot *slot = &ahead->slots[k];
        WorkerDef work = {.slots = 1, .work = factor_slot, .end = free_slot, .context = slot};
        slot->def = &ahead->def;
        TRY(worker_create(&work, &slot->worker, err));
        submit(ahead, slot);
    }
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
    Slot *slot = &ahead->slots[ahead->taken % SLOTS];
    if (ahead->taken > 0) submit(ahead, &ahead->slots[(ahead->taken - 1) % SLOTS]);
    TRY(worker_wait_for(slot->worker, ahead->taken / SLOTS + 1, err));
    *point = slot->point;
    ahead->taken++;
cleanup:
    return error_is_clean(err);
}

void factors_ahead_destroy(FactorsAhead *ahead)
{
    if (!ahead) return;
    for (int32_t k = 0; k < SLOTS; k++) worker_destroy(ahead->slots[k].worker);
    memory_free(ahead);
}
