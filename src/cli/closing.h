// SPDX-License-Identifier: GPL-2.0-or-later
// The last lines of `amontons run`: answers and files.
#ifndef AMONTONS_CLI_CLOSING_H
#define AMONTONS_CLI_CLOSING_H

#include "amontons.h"

void closing_print(const char *title, const RunSummary *summary);

#endif
