// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/recorder.h"

#include <assert.h>

void recorders_add(Recorders *recorders, void *self,
                   bool (*record)(void *self, const Observation *seen, Error *err))
{
    assert(recorders->count < RECORDERS_MAX);
    recorders->list[recorders->count++] = (Recorder){.self = self, .record = record};
}

bool recorders_record(const Recorders *recorders, const Observation *seen, Error *err)
{
    for (int32_t k = 0; k < recorders->count; k++)
        TRY(recorders->list[k].record(recorders->list[k].self, seen, err));
cleanup:
    return error_is_clean(err);
}
