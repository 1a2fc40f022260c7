// SPDX-License-Identifier: GPL-2.0-or-later
// Threads as base/worker and base/parallel make them: signals are for the threads of whoever calls.
#ifndef AMONTONS_BASE_THREAD_H
#define AMONTONS_BASE_THREAD_H

#include <pthread.h>

// 0, or what pthread_create says.
int thread_start(void *(*run)(void *self), void *self, pthread_t *thread);

#endif
