// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/kept_states.h"

#include "base/memory.h"

void kept_states_destroy(KeptStates *kept)
{
    for (int32_t k = 0; k < kept->count; k++) memory_free(kept->states[k].bytes);
    kept->count = 0;
}

bool kept_states_archive(KeptStates *kept, Archive *archive, Error *err)
{
    int32_t count = kept->count;
    archive_section(archive, "kept states");
    archive_index(archive, &count, 0, KEPT_STATES_MAX + 1);
    if (archive_reads(archive)) kept_states_destroy(kept);
    for (int32_t k = 0; k < count && !archive->failed; k++) {
        SavedState *state = &kept->states[k];
        int64_t size = state->size;
        archive_number(archive, &kept->times[k]);
        archive_count(archive, &size);
        if (archive_reads(archive)) {
            if (size < 0 || size > archive->size)
                return FAULT(err, ERROR_FILE, "a saved state is damaged");
            *state = (SavedState){.size = size};
            if (!(state->bytes = memory_bytes(size, err))) return false;
            kept->count++;
        }
        archive_octets(archive, state->bytes, size);
    }
    return true;
}
