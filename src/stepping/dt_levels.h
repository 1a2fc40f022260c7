// SPDX-License-Identifier: GPL-2.0-or-later
// The step sizes dt_k = dt_max 2^-k. The matrix of a level, A_k = M/(gamma dt_k) + C + gamma dt_k K
// condensed on the interface (Hairer and Wanner, Solving ODEs II, IV.8: one matrix for all stages),
// does not depend on the state: it is factored when the level is first used and kept, so that
// changing the step costs nothing after that. Used by stepping/sdirk.
#ifndef AMONTONS_STEPPING_DT_LEVELS_H
#define AMONTONS_STEPPING_DT_LEVELS_H

#include "reduction/interface_operator.h"
#include "contact/contact_half.h"

enum { DT_LEVELS_MAX = 128 };

typedef struct DtLevels {
    BulkOperator *system;   // not owned
    double step_max;   // of level 0, time
    int32_t run_from;   // levels before it are relaxing's alone
    int32_t level_count;   // usable levels: 0 .. level_count - 1
    InterfaceOperator *level[DT_LEVELS_MAX];   // NULL: not built; owned
    // S of the levels that are built, or its symmetric or antisymmetric part on one side, when
    // first asked for. S itself is kept only where it was. Owned.
    ContactMatrix contact[CONTACT_PARTS][DT_LEVELS_MAX];
    double *half_schur[CONTACT_PARTS][DT_LEVELS_MAX];   // of `contact`, but for the whole
    const ContactHalf *half;   // by which it is halved; NULL: never, or not any more, as a S turned
        // out not to be its own mirror image; not owned
    int64_t accepted[DT_LEVELS_MAX];   // steps, counted by step_control
    double seconds;   // wall time spent on building levels
    int64_t allocations;   // counted, arrays that this took
} DtLevels;

// Levels from step_max down to the last that is not below step_min.
void dt_levels_init(BulkOperator *system, double step_max, double step_min, DtLevels *dt_levels);
void dt_levels_destroy(DtLevels *dt_levels);
// Frees all matrices of levels from `first` to before `end`.
void dt_levels_drop(DtLevels *dt_levels, int32_t first, int32_t end);
// Frees the matrices of one side, where contact is solved as a whole from now on.
void dt_levels_drop_halves(DtLevels *dt_levels);

double dt_level_step(const DtLevels *dt_levels, int32_t k);
// gamma dt: displacement over velocity.
double dt_level_reach(const DtLevels *dt_levels, int32_t k);
// The coarsest level whose step is at most `step`; level_count when there is none.
int32_t dt_level_find(const DtLevels *dt_levels, double step);
// The operator of level k, with the matrix that the contact sees of that part; with the whole one
// where S turns out not to be its own mirror image: `half` then becomes NULL. NULL with the error
// set when the matrix cannot be factored.
InterfaceOperator *dt_level_operator(DtLevels *dt_levels, int32_t k, ContactPart part, Error *err);
// Builds what lies between levels that are built; false: one cannot be factored.
bool dt_levels_fill(DtLevels *dt_levels, ContactPart part);
// The matrix that the contact sees of that part of level k, made when first asked for. NULL: the
// level is not built, or S is not its own mirror image.
ContactMatrix *dt_level_contact(DtLevels *dt_levels, int32_t k, ContactPart part);

// The largest error that the reduction of the bulk left in a level that steps were accepted on.
double dt_levels_reduction_error(const DtLevels *dt_levels);

// Lists which levels are built, how often each was used, and what their contact matrices keep.
// Reading builds those and no others: which are built decides how a run ends. last, last_halved:
// the contact solver's last factorisation, and that of one side. Levels of other steps are a fault.
bool dt_levels_archive(DtLevels *dt_levels, int64_t last, int64_t last_halved, Archive *archive,
                       Error *err);

#endif
