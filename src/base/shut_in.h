// SPDX-License-Identifier: GPL-2.0-or-later
// Takes from this process what a reader of files does not need, so that a file that misleads its
// reader (gmsh) does no harm: Linux's seccomp, which an ordinary user may use, and which knows no
// way back. The one file that knows it; elsewhere nothing is taken. Called by base/child_process.
#ifndef AMONTONS_BASE_SHUT_IN_H
#define AMONTONS_BASE_SHUT_IN_H

#include <stdbool.h>

// Restricts this process and its threads: they start no other process or program, open no file for
// writing, make, move and delete none, have no network, and send no signals to others: such a call
// fails with EPERM. They still read files, and write to what is open already. false: the system
// cannot do that, and nothing is changed but that no process can be started by an ordinary user.
bool shut_in(void);

// Closes the descriptors from `first` to `last` that are open.
void shut_in_close(int first, int last);

#endif
