// SPDX-License-Identifier: GPL-2.0-or-later
// A thread is made for each call: it takes some 20 us, the halves some ms.
#include "base/share.h"

#include "base/thread.h"

typedef struct Second {
    void (*half)(void *context, int32_t which);
    void *context;
} Second;

static void *run_second(void *self)
{
    const Second *second = self;
    second->half(second->context, 1);
    return NULL;
}

void share_in_two(void (*half)(void *context, int32_t which), void *context)
{
    Second second = {half, context};
    pthread_t thread;
    int refused = thread_start(run_second, &second, &thread);
    half(context, 0);
    if (refused)
        half(context, 1);
    else
        pthread_join(thread, NULL);
}
