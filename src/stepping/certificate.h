// SPDX-License-Identifier: GPL-2.0-or-later
// When may inertia's time scale be skipped? With F the interface unknowns that can move and W the
// weakening on them (stepping/moving_set; open nodes are condensed out of every S below, which
// changes neither what is definite nor a sign of det J):
//
//   * S_C[F,F] - W positive definite, S_C the Schur complement of the damping C alone: viscosity
//     takes more out of any slip than weakening puts in. No perturbation can gain energy, and any
//     step that accuracy allows may be taken. First lost at about l_sc.
//   * det J(s) > 0, s = 1/(gamma dt) of a level. J, the rows of slipping nodes with the pressure
//     that follows slip,
//
//         J(s) = (S(s)_t + sign(v) mu S(s)_n)[F,F] - W,    S(s) = (M s + C + K/s) condensed,
//
//     is singular exactly at real growth rates, and det J > 0 for s to infinity, where M decides:
//     det J < 0 tells of a rate above s, which the step would hide. (Two of them it does not show.
//     S(s) - W definite would exclude every rate but those that only pressure gives: a corner that
//     carries a pad may run away at a rate far above s where S - W is definite; and with mu_S =
//     1.2 slip is steady for long while it is not.)
//
// Where the first test fails a disturbance may oscillate and grow: an exp(lambda t) of the shape u
// has lambda^2 m + lambda c + k = 0 with m = u* M u, c = u* (C - W) u, k = u* K u; hence
// -Re lambda/|lambda| = c/(2 sqrt(m k)), and 2 sqrt(m k) is the least of s m + k/s over s > 0. So
//
//   * S_C + a (S(s) - S_C) - W positive definite for all s: Re lambda < a |lambda| for all that
//     grows. (The Schur complement of C + a (s M + K/s) is larger, as Schur complements are
//     concave.) With a = cos(arctan(pi/log g)) what oscillates grows by less than g in half a
//     period.
//
// Friction that remembers has W(s) = W + memory/(s + fading) (stepping/moving_set), memory and
// fading diagonal. The second test takes W(s) of its own s. In place of the first, for a step dt
// with h = gamma dt:
//
//   * S_C[F,F] - W - N positive definite, N the most that memory Re 1/(lambda + fading) is where
//     Re lambda >= 0 and |lambda| >= 1/h: |lambda| < 1/h for all that grows, so that the step
//     resolves it. (Else the real part of u*(lambda m + c + k/lambda - memory/(lambda + fading))u
//     is at least u*(C - W - N)u: it cannot be 0.)
//   * The third test takes N with Re lambda >= a |lambda|, |lambda| >= s, for all s from 1/h on.
//
// A state that grows by itself makes poles of W(s) on the right: the tests of det J ask that none
// is real and as fast as 1/h.
//
// All leave out that pressure follows slip. Dampers of soft rod nodes
// belong to C; their springs are left out, which only makes the tests stricter. Called by
// stepping/step_control.
#ifndef AMONTONS_STEPPING_CERTIFICATE_H
#define AMONTONS_STEPPING_CERTIFICATE_H

#include "stepping/dt_levels.h"
#include "stepping/moving_set.h"

typedef struct Certificate {
    ContactPart part;   // of what is asked about
    BulkOperator *system;   // that S_C is of; NULL: of one side; not owned
    bool aside;   // S_C was laid aside, and is made again when it is asked for
    double *damping;   // [count^2] S_C, or its symmetric or antisymmetric part; owned; NULL: C is
        // singular
    double *alone;   // [contact_count] what resists a node that slips alone; NULL: C is singular;
        // S_C[t,t], with branches S[t,t] at the real rate where it is least; owned
    ContactMatrix damping_contact;   // S_C, open nodes condensed out; empty without; owned
    bool held_last;   // the last time that it was asked: a state is mostly like the one before
    bool with_open;   // open nodes are counted among what moves
    MovingSet moving;   // F and W of the state asked about; owned, like all that follows
    double *matrix;   // [count^2] work
    float *single;   // [count * (count + 2)] work; NULL: count is small
    double *vector;   // [count] work
    int32_t *pivots;   // [count] work
    int64_t checks;   // counted, factorisations
    double seconds;   // wall time spent
} Certificate;

bool certificate_create(const Block *block, Certificate *certificate, Error *err);
// The certificate of the symmetric or antisymmetric part on one side; its unknowns are those of
// `block`, whose bulk is not asked for. Where S_C is not its own image nothing is certified.
bool certificate_halve(const Certificate *whole, const ContactHalf *half, const Block *block,
                       ContactPart part, Certificate *certificate, Error *err);
void certificate_destroy(Certificate *certificate);
// Frees S_C until it is asked for again: while the parts of a state are asked about it is not.
void certificate_lay_aside(Certificate *certificate);

// The slip set of `state` cannot gain energy. Where friction remembers: |lambda| < 1/reach of all
// that grows, reach: gamma dt of a step, time.
bool certificate_holds(Certificate *certificate, const State *state, double reach);

// det J > 0: no single real rate of growth lies above 1/reach, reach: gamma dt of `level`.
bool certificate_step_resolves(Certificate *certificate, const State *state, ContactMatrix *level,
                               double reach);

// det J > 0 fails on some level that is built; on level `resolved` it is known to hold (-1: on
// none).
bool certificate_finds_runaway(Certificate *certificate, const State *state, DtLevels *dt_levels,
                               int32_t resolved);

// The next two ask levels from `first` to before `end`; of these all between the first and the last
// of the levels of dt that are built, where those that lack are built.
typedef struct LevelRange {
    int32_t first, end;
} LevelRange;

// A disturbance that oscillates, at the s of these levels, grows by less than `growth` > 1 in half
// a period.
bool certificate_oscillates_less(Certificate *certificate, const State *state, DtLevels *dt_levels,
                                 LevelRange range, double growth);

// No real rate of growth lies within the range of the levels, those between included.
bool certificate_excludes_runaway(Certificate *certificate, const State *state, DtLevels *dt_levels,
                                  LevelRange range);

// Weakening over what the block withstands at s = 1/reach of `level`, the pressure that follows
// slip included (stepping/moving_set); INFINITY where S is singular.
double certificate_ratio(Certificate *certificate, const State *state, ContactMatrix *level,
                         double reach);

// Moves the counts of another certificate into this one.
void certificate_take_counts(Certificate *certificate, Certificate *from);

// Writes or reads the state of its one matrix, and its counter.
void certificate_archive(Certificate *certificate, Archive *archive);

#endif
