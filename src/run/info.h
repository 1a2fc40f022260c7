// SPDX-License-Identifier: GPL-2.0-or-later
// The two longer parts of amontons_info; called by run/info only.
#ifndef AMONTONS_RUN_INFO_H
#define AMONTONS_RUN_INFO_H

#include "base/error.h"

#include <stdio.h>

bool info_mesh(const char *path, FILE *out, Error *err);       // a .msh or .geo file
bool info_result(const char *folder, FILE *out, Error *err);   // a result folder

#endif
