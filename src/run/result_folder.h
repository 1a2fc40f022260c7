// SPDX-License-Identifier: GPL-2.0-or-later
// The folder a run writes into: made when missing, never written over unasked. Called by
// run/simulation.
#ifndef AMONTONS_RUN_RESULT_FOLDER_H
#define AMONTONS_RUN_RESULT_FOLDER_H

#include "base/error.h"

// Makes `folder` (and its parents). When it holds an earlier result: ERROR_INPUT without
// `overwrite`, else what amontons wrote there is removed, run.json first; other files stay.
bool result_folder_prepare(const char *folder, bool overwrite, Error *err);

#endif
