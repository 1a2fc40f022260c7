// SPDX-License-Identifier: GPL-2.0-or-later
// The points that an element of a Slurm array computes, `amontons sweep --element`. One; many where
// `keep: table` says that they take less time than the start of an element.
//
//     DIR/slurm/designs           of a search: the cases that it has added to the study, round by
//                                 round, each text with a zero byte at its end
//     DIR/slurm/share-7.points    a line a point: its number and hash
//     DIR/slurm/share-7.reports   what it has computed, as DIR/reports, with `keep: table`
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_SHARE_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_SHARE_H

#include "study/sweep/computing/point.h"

// points[first], points[first + step], ... ([count] in all): a share of each part of the study, for
// points near to each other take as long.
bool share_write(const Sweep *sweep, int32_t share, const int32_t *points, int32_t count,
                 int32_t step, Error *err);
bool share_write_designs(const Sweep *sweep, Error *err);
// Runs a share in the element. The sweep has a study, a folder and options, and nothing else.
bool share_run(Sweep *sweep, int32_t share, Error *err);
// Adds the results of the share to the sweep's reports and removes the share's files.
bool share_take(Sweep *sweep, int32_t share, Error *err);
bool share_take_all(Sweep *sweep, Error *err);   // also of an earlier sweep that was killed

#endif
