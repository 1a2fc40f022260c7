// SPDX-License-Identifier: GPL-2.0-or-later
// The step sizes dt_k = dt_max 2^-k. The matrix of a rung, A_k = M/(gamma dt_k) + C + gamma dt_k K
// condensed on the interface (Hairer and Wanner, Solving ODEs II, IV.8: one matrix for all stages),
// does not depend on the state: it is factored when the rung is first used and kept, so that
// changing the step costs nothing after that. Used by stepping/sdirk.
#ifndef AMONTONS_STEPPING_LADDER_H
#define AMONTONS_STEPPING_LADDER_H

#include "reduction/interface_operator.h"
#include "contact/contact_half.h"

enum { LADDER_RUNGS_MAX = 128 };

typedef struct Ladder {
    BulkOperator *system;   // not owned
    double step_max;   // of rung 0, time
    double gamma;   // of the scheme that steps on it; at first that of SDIRK2
    int32_t rung_count;   // usable rungs: 0 .. rung_count - 1
    InterfaceOperator *rung[LADDER_RUNGS_MAX];   // NULL: not built; owned
    // S of the rungs that are built, or its symmetric or antisymmetric part on one side, when first
    // asked for. S itself is kept only where it was. Owned.
    ContactMatrix contact[CONTACT_PARTS][LADDER_RUNGS_MAX];
    double *half_schur[CONTACT_PARTS][LADDER_RUNGS_MAX];   // of `contact`, but for the whole
    const ContactHalf *half;   // by which it is halved; NULL: never, or not any more, as a S turned
        // out not to be its own mirror image; not owned
    int64_t accepted[LADDER_RUNGS_MAX];   // steps, counted by step_control
    double seconds;   // wall time spent on building rungs
    int64_t allocations;   // counted, arrays that this took
} Ladder;

// Rungs from step_max down to the last that is not below step_min.
void ladder_init(BulkOperator *system, double step_max, double step_min, Ladder *ladder);
void ladder_destroy(Ladder *ladder);

double ladder_step(const Ladder *ladder, int32_t k);
double ladder_reach(const Ladder *ladder, int32_t k);   // gamma dt: displacement over velocity
// The coarsest rung whose step is at most `step`; rung_count when there is none.
int32_t ladder_find(const Ladder *ladder, double step);
// The operator of rung k, with the matrix that the contact sees of that part; with the whole one
// where S turns out not to be its own mirror image: `half` then becomes NULL. NULL with the error
// set when the matrix cannot be factored.
InterfaceOperator *ladder_rung(Ladder *ladder, int32_t k, ContactPart part, Error *err);
// Builds what lies between rungs that are built; false: one cannot be factored.
bool ladder_fill(Ladder *ladder, ContactPart part);
// The matrix that the contact sees of that part of rung k, made when first asked for. NULL: the
// rung is not built, or S is not its own mirror image.
ContactMatrix *ladder_contact(Ladder *ladder, int32_t k, ContactPart part);

// The largest error that the reduction of the bulk left in a rung that steps were accepted on.
double ladder_reduction_error(const Ladder *ladder);

// Which rungs are built, how often each was used, and what their contact matrices keep. Reading
// builds those and no others: which are built decides how a run ends. last, last_halved: the
// contact solver's last factorisation, and that of one side. A ladder of other steps is a fault.
bool ladder_archive(Ladder *ladder, int64_t last, int64_t last_halved, Archive *archive,
                    Error *err);

#endif
