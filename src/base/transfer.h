// SPDX-License-Identifier: GPL-2.0-or-later
// Bytes to and from an open file or pipe, all of them: a signal or a nearly full disk cuts a call
// of the system short. Called by whoever reads or writes a descriptor.
#ifndef AMONTONS_BASE_TRANSFER_H
#define AMONTONS_BASE_TRANSFER_H

#include <stdint.h>

// `at`: where in the file; -1: where it stands.

// Returns the number of bytes read: fewer than `size` at the file's end, or after a failure, which
// errno says (else it is 0).
int64_t transfer_read(int descriptor, void *bytes, int64_t size, int64_t at);
// 0, or the errno of the failure.
int transfer_write(int descriptor, const void *bytes, int64_t size, int64_t at);
// All that was written onto the disk; likewise. A file system that cannot do that is no failure.
int transfer_sync(int descriptor);

#endif
