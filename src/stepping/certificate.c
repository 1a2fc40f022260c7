// SPDX-License-Identifier: GPL-2.0-or-later
// A large implicit step damps what grows instead of showing it, so that control of the truncation
// error alone would step over the instability. Each test here comes down to one Cholesky or LU
// factorisation of a matrix of |F| rows. The header has the derivations.
#include "stepping/certificate.h"

#include "base/clock.h"
#include "algebra/dense.h"
#include "base/memory.h"
#include "stepping/moving_set.h"

#include <math.h>

// Levels double: where s lies half way between two of them in log s, s m + k/s at the nearest is
// this times its least, (sqrt 2 + 1/sqrt 2)/2. With matrices of both: s M + K/s there is a sum of
// theirs with weights that make at least 1/this together.
static const double BETWEEN_LEVELS = 1.0606601717798212;
// N is at most this times such a sum: N is log-convex in s^2, so that it is at most
// N_1^(1 - x) N_2^x, x = (s^2 - 1)/3 for s from 1 to 2; beside the sum that is at most 1.1242.
static const double BETWEEN_MEMORIES = 1.125;

// A ratio that changes by less than this part in a power of the iteration has settled: enough to
// tell it from 1.
static const double SETTLED = 1e-6;

// A matrix of so many rows is first asked about in single precision, which is enough where it stays
// definite without this part of its diagonal, or does not become so with it: rounding there is some
// 1e-6 of it.
enum { SINGLE_ROWS = 128 };
static const double SINGLE_MARGIN = 1e-4;

// Open nodes are few where they are at most this part of all.
enum { OPEN_PARTS = 8 };

static bool create_work(const Block *block, Certificate *certificate, Error *err)
{
    *certificate = (Certificate){0};
    int64_t count = block->interface->count;
    if (!moving_set_create(block, &certificate->moving, err)) return false;
    certificate->matrix = memory_bytes(8 * count * count, err);   // taken up as it is used
    if (count >= SINGLE_ROWS) certificate->single = memory_bytes(4 * count * (count + 2), err);
    certificate->vector = NEW_ARRAY(double, count, err);
    certificate->pivots = NEW_ARRAY(int32_t, count, err);
    return error_is_clean(err);
}

// By viscosity alone, or with branches at real rates that double, up from the fastest branch while
// inertia does not yet make up for what branches lose, and down to the slowest or until every node
// resists RISEN times its least.
static bool find_alone(const Block *block, Certificate *certificate, Error *err)
{
    static const double RISEN = 4;
    const Spectrum *spectrum = bulk_operator_spectrum(block->system);
    const Interface *interface = block->interface;
    double fastest = INFINITY, slowest = 0;
    for (int32_t k = 0; k < spectrum->count; k++) {
        fastest = fmin(fastest, spectrum->time[k]);
        slowest = fmax(slowest, spectrum->time[k]);
    }
    double *alone = certificate->alone = NEW_ARRAY(double, interface->contact_count, err);
    for (int32_t i = 0; alone && i < interface->contact_count; i++) {
        int64_t t = interface_tangent(interface, i);
        alone[i] = spectrum->count > 0 ? INFINITY : certificate->damping[t * interface->count + t];
    }
    if (spectrum->count == 0) return alone;
    bool up = true, done = !alone;
    for (double rate = 1 / fastest; !done; rate = up ? 2 * rate : 0.5 * rate) {
        OperatorTerms terms = {.mass = rate, .damping = 1, .stiffness = 1 / rate};
        InterfaceOperator *condensed = interface_operator_create(block->system, terms, err);
        if (!condensed) return false;
        const double *schur = interface_operator_schur(condensed);
        bool less = false, risen = true;
        for (int32_t i = 0; i < interface->contact_count; i++) {
            int64_t t = interface_tangent(interface, i);
            double own = schur[t * interface->count + t];
            less = less || own < alone[i];
            risen = risen && own > RISEN * alone[i];
            alone[i] = fmin(alone[i], own);
        }
        interface_operator_destroy(condensed);
        done = !up && (risen || rate * slowest <= 1);
        if (up && !less) {
            up = false;
            rate = 1 / fastest;
        }
    }
    return error_is_clean(err);
}

// S_C is condensed from C alone, lifted as C may be singular in the interface's own motion
// (reduction/interface_operator), once for all states.
static bool make_damping(Certificate *certificate, Error *err)
{
    OperatorTerms terms = {.damping = 1, .lift = true};
    InterfaceOperator *condensed = interface_operator_create(certificate->system, terms, err);
    certificate->aside = false;
    if (condensed) certificate->damping = interface_operator_take_schur(condensed);
    interface_operator_destroy(condensed);
    // Without viscosity (or with eta1 = 0) there is nothing that could certify a weakening slip.
    if (err->code == ERROR_COMPUTE) error_clear(err);
    return error_is_clean(err) &&
           (!certificate->damping ||
            contact_matrix_create(certificate->damping, certificate->moving.interface->count,
                                  &certificate->damping_contact, err));
}

bool certificate_create(const Block *block, Certificate *certificate, Error *err)
{
    TRY(create_work(block, certificate, err));
    certificate->system = block->system;
    TRY(make_damping(certificate, err));
    if (certificate->damping) TRY(find_alone(block, certificate, err));
cleanup:
    return error_is_clean(err);
}

static void free_damping(Certificate *certificate)
{
    contact_matrix_destroy(&certificate->damping_contact);
    memory_free(certificate->damping);
    certificate->damping = NULL;
}

void certificate_lay_aside(Certificate *certificate)
{
    certificate->aside = certificate->damping != NULL;
    free_damping(certificate);
}

bool certificate_halve(const Certificate *whole, const ContactHalf *half, const Block *block,
                       ContactPart part, Certificate *certificate, Error *err)
{
    int64_t count = half->interface.count;
    bool antisymmetric = part == PART_ANTISYMMETRIC;
    TRY(create_work(block, certificate, err));
    certificate->part = part;
    if (!whole->damping) goto cleanup;
    double *damping = certificate->damping = NEW_ARRAY(double, count *count, err);
    TRY(damping);
    if (contact_half_matrix(half, whole->damping, antisymmetric, damping)) {
        TRY(contact_matrix_create(damping, (int32_t)count, &certificate->damping_contact, err));
    } else {
        free_damping(certificate);
    }
cleanup:
    return error_is_clean(err);
}

void certificate_destroy(Certificate *certificate)
{
    free_damping(certificate);
    memory_free(certificate->alone);
    moving_set_destroy(&certificate->moving);
    memory_free_all(certificate->matrix, certificate->single, certificate->vector,
                    certificate->pivots);
    *certificate = (Certificate){0};
}

// Finds what moves: open nodes are condensed out of every S, or where they are few counted among
// what moves, which is the same question and needs no second matrix of a level. On pads most nodes
// are open; in the plane a matrix is small.
static void find_moving(Certificate *certificate, const State *state)
{
    int32_t open = 0;
    for (int32_t i = 0; i < state->contact_count; i++) open += state->status[i] == CONTACT_OPEN;
    certificate->with_open = certificate->moving.interface->dim > 2 &&
                             OPEN_PARTS * open <= state->contact_count;
    moving_set_find(&certificate->moving, state, certificate->with_open);
}

// S for what was found to move; NULL where open nodes alone are singular in it.
static const double *close_matrix(const Certificate *certificate, const State *state,
                                  ContactMatrix *matrix)
{
    if (certificate->with_open) return matrix->schur;
    return contact_matrix_close(matrix, state->status, state->contact_count,
                                certificate->moving.interface->dim);
}

// certificate->matrix, which may be overwritten, is positive definite. expected: what the answer is
// presumably, which saves time where it is right.
static bool matrix_is_definite(Certificate *certificate, bool expected)
{
    int32_t count = certificate->moving.count;
    double *matrix = certificate->matrix;
    DenseAnswer answer = DENSE_UNSURE;
    if (count >= SINGLE_ROWS)
        answer = dense_definite_single(matrix, count, expected ? -SINGLE_MARGIN : SINGLE_MARGIN,
                                       certificate->single);
    return answer == DENSE_UNSURE ? dense_cholesky(matrix, count) : answer == DENSE_YES;
}

// S_C + narrow (S - S_C)/BETWEEN_LEVELS - W - N on F is positive definite; S that of `level` (NULL:
// narrow is 0), N of what is remembered at 1/reach and faster. Parts of condensed operators are
// less than their parts condensed: with open nodes condensed out the test is a little stricter
// between its ends.
static bool is_definite(Certificate *certificate, const State *state, ContactMatrix *level,
                        double narrow, double reach, bool expected)
{
    MovingSet *moving = &certificate->moving;
    find_moving(certificate, state);
    if (!moving->weakens && !moving->remembers) return true;   // S itself is never indefinite
    if (certificate->aside && !make_damping(certificate, &(Error){0})) return false;
    const double *damping = NULL, *own = NULL;
    double part = narrow / BETWEEN_LEVELS, factor = level ? BETWEEN_MEMORIES : 1;
    if (certificate->damping_contact.schur)
        damping = close_matrix(certificate, state, &certificate->damping_contact);
    if (level) own = close_matrix(certificate, state, level);
    if (!damping || (level && !own)) return false;
    moving_set_gather(moving, damping, 1 - part, 0, certificate->matrix);
    if (level) moving_set_gather(moving, own, part, 1, certificate->matrix);
    moving_set_turn(moving, true, certificate->matrix);
    moving_set_add_dampers(moving, 0, certificate->matrix);
    moving_set_subtract_weakening(moving, 0, certificate->matrix);
    moving_set_subtract_memory(moving, reach, narrow, factor, certificate->matrix);
    certificate->checks++;
    return matrix_is_definite(certificate, expected);
}

bool certificate_holds(Certificate *certificate, const State *state, double reach)
{
    double started = clock_seconds();
    bool holds = is_definite(certificate, state, NULL, 0, reach, certificate->held_last);
    certificate->held_last = holds;
    certificate->seconds += clock_seconds() - started;
    return holds;
}

// a = cos(arctan(pi/log g)) of the header is ratio/sqrt(1 + ratio^2), ratio = log g/pi.
bool certificate_oscillates_less(Certificate *certificate, const State *state, DtLevels *dt_levels,
                                 LevelRange range, double growth)
{
    double started = clock_seconds(), ratio = log(growth) / M_PI;
    double narrow = ratio / sqrt(1 + ratio * ratio);
    bool less =
        dt_levels_fill(dt_levels, certificate->part);   // BETWEEN_LEVELS is that of neighbours
    for (int32_t k = range.first; less && k < range.end; k++) {
        ContactMatrix *level = dt_level_contact(dt_levels, k, certificate->part);
        if (level)
            less =
                is_definite(certificate, state, level, narrow, dt_level_reach(dt_levels, k), true);
    }
    certificate->seconds += clock_seconds() - started;
    return less;
}

// certificate->matrix = J + W of what moves, S that of a level, open nodes condensed out.
static void fill_coupled(Certificate *certificate, const double *closed)
{
    moving_set_gather(&certificate->moving, closed, 1, 0, certificate->matrix);
    moving_set_couple(&certificate->moving, closed, certificate->matrix);
    moving_set_turn(&certificate->moving, false, certificate->matrix);
    moving_set_add_dampers(&certificate->moving, 0, certificate->matrix);
}

// x'J x > 0 for all x: no eigenvalue of J has a real part below 0, so that det J > 0. At half the
// cost of LU.
static bool is_positive(Certificate *certificate, const double *closed, double reach)
{
    MovingSet *moving = &certificate->moving;
    moving_set_gather_symmetric(moving, closed, certificate->matrix);
    moving_set_turn(moving, true, certificate->matrix);
    moving_set_add_dampers(moving, 0, certificate->matrix);
    moving_set_subtract_weakening(moving, reach, certificate->matrix);
    return matrix_is_definite(certificate, true);
}

// det J > 0 at the s of `level`; what moves has been found. false, too: nothing holds the open
// nodes.
static bool is_resolved(Certificate *certificate, const State *state, ContactMatrix *level,
                        double reach)
{
    const double *closed = close_matrix(certificate, state, level);
    int32_t *pivots = certificate->pivots, count = certificate->moving.count;
    if (!closed || !moving_set_decays(&certificate->moving, reach)) return false;
    certificate->checks++;
    if (is_positive(certificate, closed, reach)) return true;
    fill_coupled(certificate, closed);
    moving_set_subtract_weakening(&certificate->moving, reach, certificate->matrix);
    return dense_lu(certificate->matrix, count, pivots) &&
           dense_lu_sign(certificate->matrix, count, pivots) > 0;
}

bool certificate_step_resolves(Certificate *certificate, const State *state, ContactMatrix *level,
                               double reach)
{
    double started = clock_seconds();
    find_moving(certificate, state);
    bool resolves = is_resolved(certificate, state, level, reach);
    certificate->seconds += clock_seconds() - started;
    return resolves;
}

bool certificate_finds_runaway(Certificate *certificate, const State *state, DtLevels *dt_levels,
                               int32_t resolved)
{
    double started = clock_seconds();
    bool found = false;
    find_moving(certificate, state);
    for (int32_t k = 0; k < dt_levels->level_count && !found; k++) {
        ContactMatrix *level = k == resolved ? NULL
                                             : dt_level_contact(dt_levels, k, certificate->part);
        found = level && !is_resolved(certificate, state, level, dt_level_reach(dt_levels, k));
    }
    certificate->seconds += clock_seconds() - started;
    return found;
}

double certificate_ratio(Certificate *certificate, const State *state, ContactMatrix *level,
                         double reach)
{
    double started = clock_seconds(), ratio = INFINITY;
    int32_t *pivots = certificate->pivots;
    find_moving(certificate, state);
    const double *closed = close_matrix(certificate, state, level);
    if (closed) {
        bool decays = moving_set_decays(&certificate->moving, reach);
        moving_set_settle(&certificate->moving, reach);
        fill_coupled(certificate, closed);
        certificate->checks++;
        if (decays && dense_lu(certificate->matrix, certificate->moving.count, pivots))
            ratio = weakening_ratio(&certificate->moving, certificate->matrix, pivots, SETTLED,
                                    certificate->vector);
    }
    certificate->seconds += clock_seconds() - started;
    return ratio;
}

bool certificate_excludes_runaway(Certificate *certificate, const State *state, DtLevels *dt_levels,
                                  LevelRange range)
{
    double ratio[3] = {0}, octaves;
    if (!dt_levels_fill(dt_levels, certificate->part)) return false;   // so is the parabola
    for (int32_t k = range.first; k < range.end; k++) {
        ContactMatrix *level = dt_level_contact(dt_levels, k, certificate->part);
        ratio[0] = ratio[1];
        ratio[1] = ratio[2];
        ratio[2] =
            level ? certificate_ratio(certificate, state, level, dt_level_reach(dt_levels, k)) : 0;
        // Each by itself: fmax would lose a ratio that is not a number.
        if (!(ratio[2] < 1) || !(weakening_ratio_top(ratio, &octaves) < 1)) return false;
    }
    return true;
}

void certificate_take_counts(Certificate *certificate, Certificate *from)
{
    certificate->checks += from->checks;
    certificate->seconds += from->seconds;
    from->checks = 0;
    from->seconds = 0;
}

void certificate_archive(Certificate *certificate, Archive *archive)
{
    bool damped = certificate->damping_contact.schur != NULL;
    archive_section(archive, "certificate");
    archive_count(archive, &certificate->checks);
    archive_flag(archive, &certificate->held_last);
    archive_flag(archive, &damped);
    if (damped && certificate->aside) make_damping(certificate, &(Error){0});
    if (damped != (certificate->damping_contact.schur != NULL)) archive->failed = true;
    // It is never factored by the contact solver.
    if (damped) contact_matrix_archive(&certificate->damping_contact, -1, archive);
}
