// SPDX-License-Identifier: GPL-2.0-or-later
// Order of a step: rows at v and r -> r = S v - g for what is held -> residuals of these rows -> LU
// of the derivative, kept while steps with it gain a digit -> the step -> statuses and rows anew.
// A row is linear in r, so that rows of an earlier r (a warm start) meet the r of this g.
#include "contact/contact_discs.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "contact/contact_sweeps.h"
#include "friction/friction.h"

#include <string.h>

// A derivative is factored anew when a step leaves more than this part of the residual.
static const double CHORD_GAIN = 0.1;
// All 435 problems of five blocks that Newton did not settle at once are solved with these, 433
// with 3 rounds, 420 with rounds of 15 sweeps each.
enum {
    STEPS = 20,   // of Newton before any sweeps, and after each round of them
    HALVINGS = 4,   // of a step that leaves more than there was: to and fro over a kink of mu
};

bool contact_discs_create(const Interface *interface, ContactNewton *newton, ContactDiscs *discs,
                          Error *err)
{
    *discs = (ContactDiscs){.newton = newton};
    discs->row = NEW_ARRAY(DiscRow, interface->contact_count, err);
    discs->kept = NEW_ARRAY(DiscRow, interface->contact_count, err);
    discs->taken = NEW_ARRAY(double, interface->count, err);
    int64_t count = interface->count;
    discs->factors.lu = memory_bytes((int64_t)sizeof(float) * count * count, err);
    discs->factors.pivots = NEW_ARRAY(int32_t, count, err);
    discs->factors.single = NEW_ARRAY(float, count, err);
    discs->factors.column = NEW_ARRAY(double, count, err);
    return error_is_clean(err);
}

void contact_discs_destroy(ContactDiscs *discs)
{
    DiscFactors *factors = &discs->factors;
    memory_free_all(discs->row, discs->kept, discs->taken, factors->lu, factors->pivots,
                    factors->single, factors->column);
    *discs = (ContactDiscs){0};
}

// One solve so far. Nothing is owned.
typedef struct Settling {
    ContactDiscs *discs;
    ContactNewton *newton;
    const ContactProblem *problem;
    ContactSolution *at;
    ContactScales scales;
    double tolerance;
    double residual;   // of the last step with these statuses, over the scale of force
    bool in_double;   // factors are made in double precision, for each step: after sweeps
} Settling;

// --- statuses and rows --------------------------------------------------------------------------

// Status and row of node i. false: its status stays. In space this decides when a node begins to
// slip (contact_judge_node in the plane).
static bool judge_node(const Settling *settling, int32_t i)
{
    const ContactProblem *problem = settling->problem;
    const Interface *interface = problem->interface;
    const FrictionNode *node = friction_at(problem->friction, i);
    ContactSolution *at = settling->at;
    DiscRow *row = &settling->discs->row[i];
    int32_t t = interface_tangent(interface, i), n = interface_normal(interface, i);
    uint8_t was = at->status[i];
    double slack = settling->tolerance * settling->scales.force;

    // rho of the tangents and of the normal, from the node's own entries of S.
    int64_t next = interface->count + 1;   // from an entry of the diagonal to the next
    const double *entry = problem->matrix->schur + t * next;
    double rho = 0.5 * (entry[0] + entry[next]), rho_n = entry[2 * next];

    // Open, where nothing presses.
    double pressing = at->reaction[n] - rho_n * (at->velocity[n] - problem->bound[n]);
    if (pressing <= (was == CONTACT_OPEN ? slack : -slack)) {
        at->status[i] = CONTACT_OPEN;
        return was != CONTACT_OPEN;
    }

    // Sticks, where z lies in the disc.
    double speed = slip_size(interface, i, at->velocity);
    double mu = friction_coefficient(node, speed), limit = mu * fmax(pressing, 0);
    double z[] = {at->reaction[t] - rho * at->velocity[t],
                  at->reaction[t + 1] - rho * at->velocity[t + 1]};
    double size = hypot(z[0], z[1]);
    bool creeps = node->law->creeps && size > 0;
    if (!creeps && size <= limit + (was == CONTACT_STICK ? slack : 0)) {
        at->status[i] = CONTACT_STICK;
        return was != CONTACT_STICK;
    }

    // Slips along d.
    *row = (DiscRow){.d = {-z[0] / size, -z[1] / size},
                     .mu = mu,
                     .theta = limit > 0 ? limit / (limit + rho * speed) : 0,
                     .rho = rho};
    double slope = friction_slope(node, speed) * fmax(at->reaction[n], 0);
    for (int32_t c = 0; c < 2; c++)
        row->along[c] = slope * (speed > 0 ? at->velocity[t + c] / speed : row->d[c]);
    at->status[i] = CONTACT_SLIP_FORWARD;
    return was != CONTACT_SLIP_FORWARD;
}

// All of them, the rod's too. false: none has changed.
static bool judge_all(Settling *settling)
{
    const Interface *interface = settling->problem->interface;
    bool changed = false;
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (judge_node(settling, i)) changed = true;
    for (int32_t j = 0; j < interface->rod_count; j++) {
        double violation;
        uint8_t better =
            contact_judge_rod(&settling->newton->equations, settling->scales, j, &violation);
        if (!(violation > settling->tolerance)) continue;
        settling->at->rod_touches[j] = better;
        changed = true;
    }
    return changed;
}

// --- equations and their derivative -------------------------------------------------------------

// Residuals of the equations of what is free, into newton->step: of a slipping node along d, and
// across it by (1 - theta). Where `kept`, they are turned into the directions that were factored.
// Returns the largest force that any is off.
static double find_residual(const Settling *settling, bool kept)
{
    const ContactProblem *problem = settling->problem;
    const Interface *interface = problem->interface;
    const ContactEquations *equations = &settling->newton->equations;
    const ContactSolution *at = settling->at;
    double largest = 0, *step = settling->newton->step;
    int32_t rods = interface_rod(interface, 0);
    for (int32_t a = 0; a < equations->free_count; a++) {
        int32_t k = equations->free[a];
        if (k >= rods) {
            step[a] = at->reaction[k];
            if (at->rod_touches[k - rods])
                step[a] += rod_stiffness(problem, k - rods) * (at->velocity[k] - problem->bound[k]);
            largest = fmax(largest, fabs(step[a]));
            continue;
        }
        // Both equations of a node, whose tangents follow one another.
        int32_t i = dof_node(interface->dim, k), t = interface_tangent(interface, i);
        const DiscRow *row = &settling->discs->row[i], *old = &settling->discs->kept[i];
        const double *r = at->reaction + t, *v = at->velocity + t, *d = row->d;
        double along = d[0] * r[0] + d[1] * r[1] +
                       row->mu * at->reaction[interface_normal(interface, i)];
        double turning = (1 - row->theta) * (d[0] * r[1] - d[1] * r[0]) +
                         row->theta * row->rho * (d[0] * v[1] - d[1] * v[0]);
        double across = row->theta < 1 ? turning / (1 - row->theta) : 0;
        double force = along;
        if (kept) {
            double cosine = d[0] * old->d[0] + d[1] * old->d[1];
            double sine = old->d[0] * d[1] - old->d[1] * d[0];
            force = cosine * along - sine * across;
            turning = (1 - old->theta) * (sine * along + cosine * across);
        }
        step[a++] = force;
        step[a] = turning;
        largest = fmax(largest, hypot(force, across));
    }
    return largest;
}

// Column b of the derivative, out [free_count], of what `newton` lists as free.
static void derivative_column(const ContactNewton *newton, const DiscRow *rows, int32_t b,
                              double *out)
{
    const ContactEquations *equations = &newton->equations;
    const ContactProblem *problem = equations->problem;
    int32_t own = equations->free[b], rod = interface_rod(problem->interface, 0);
    const double *column = newton->closed + (int64_t)problem->interface->count * own;
    for (int32_t a = 0; a < equations->free_count; a++) {
        int32_t k = equations->free[a];
        if (k >= rod) {
            out[a] = column[k];
            continue;
        }
        const DiscRow *row = &rows[dof_node(3, k)];
        const double *d = row->d;
        out[a++] = d[0] * column[k] + d[1] * column[k + 1] + row->mu * column[k + 2];
        out[a] = (1 - row->theta) * (d[0] * column[k + 1] - d[1] * column[k]);
    }
    if (own >= rod) {
        if (equations->at->rod_touches[own - rod]) out[b] += rod_stiffness(problem, own - rod);
        return;
    }
    const DiscRow *row = &rows[dof_node(3, own)];
    int32_t axis = dof_axis(3, own), first = b - axis;
    out[first] += row->along[axis];
    out[first + 1] += row->theta * row->rho * (axis == 0 ? -row->d[1] : row->d[0]);
}

// LU in double precision, into the factors of the plane. false: the derivative is singular.
static bool factor_double(const Settling *settling)
{
    ContactNewton *newton = settling->newton;
    int64_t size = newton->equations.free_count;
    for (int32_t b = 0; b < size; b++)
        derivative_column(newton, settling->discs->row, b, newton->factors.lu + b * size);
    return dense_lu(newton->factors.lu, (int32_t)size, newton->factors.pivots);
}

// Factors of the derivative at the rows as they are, which are kept: in single precision of the
// derivative over the largest entry of S, or in double. false: it is singular.
static bool factor(Settling *settling)
{
    ContactNewton *newton = settling->newton;
    DiscFactors *single = &settling->discs->factors;
    int32_t size = newton->equations.free_count;
    bool regular;
    newton->factorisations++;
    if (settling->in_double) {
        regular = factor_double(settling);
        newton->factors.rows = regular ? size : 0;
        single->rows = 0;
    } else {
        double scale = 1 / settling->problem->matrix->diagonal;
        float *out = single->lu;
        for (int32_t b = 0; b < size; b++, out += size) {
            derivative_column(newton, settling->discs->row, b, single->column);
            for (int32_t a = 0; a < size; a++) out[a] = (float)(scale * single->column[a]);
        }
        regular = dense_lu_single(single->lu, size, single->pivots);
        newton->factors.rows = 0;
        single->rows = regular ? size : 0;
    }

    // Statuses and rows that the factors are of.
    contact_copy_statuses(&newton->equations, newton->factors.status);
    memcpy(settling->discs->kept, settling->discs->row,
           (size_t)settling->problem->interface->contact_count * sizeof(DiscRow));
    settling->problem->matrix->factored = regular ? newton->factorisations : 0;
    newton->factors_gain = true;
    return regular;
}

// --- steps --------------------------------------------------------------------------------------

// The residual in newton->step becomes the step that takes it away.
static void find_step(const Settling *settling)
{
    ContactNewton *newton = settling->newton;
    const ContactEquations *equations = &newton->equations;
    int32_t size = equations->free_count, rods = interface_rod(settling->problem->interface, 0);
    for (int32_t a = 0; a < size; a++) newton->step[a] = -newton->step[a];

    // The forces at open nodes are removed: their part in these equations.
    const DiscRow *rows = newton->reused ? settling->discs->kept : settling->discs->row;
    if (newton->open_count > 0) contact_newton_find_pull(newton);
    for (int32_t a = 0; newton->open_count > 0 && a < size; a++) {
        int32_t k = equations->free[a];
        const double *pull = newton->pull + k;
        if (k >= rods) {
            newton->step[a] += pull[0];
            continue;
        }
        const DiscRow *row = &rows[dof_node(3, k)];
        newton->step[a++] += row->d[0] * pull[0] + row->d[1] * pull[1] + row->mu * pull[2];
        newton->step[a] += (1 - row->theta) * (row->d[0] * pull[1] - row->d[1] * pull[0]);
    }

    const DiscFactors *factors = &settling->discs->factors;
    if (settling->in_double || factors->rows == 0) {
        dense_lu_solve(newton->factors.lu, size, newton->factors.pivots, newton->step);
        return;
    }
    double scale = 1 / settling->problem->matrix->diagonal;
    dense_lu_single_solve(factors->lu, factors->rows, factors->pivots, newton->step,
                          factors->single);
    for (int32_t a = 0; a < factors->rows; a++) newton->step[a] *= scale;
}

// The residual after a step, at rows made anew, over the scale of force; at open nodes, too.
static double residual_now(Settling *settling)
{
    const ContactNewton *newton = settling->newton;
    double largest = find_residual(settling, false);
    for (int32_t a = 0; a < newton->open_count; a++)
        largest = fmax(largest, fabs(settling->at->reaction[newton->open[a]]));
    return isfinite(largest) ? largest / settling->scales.force : INFINITY;
}

// Newton's steps from rows, lists and reactions as they are. true: equations and statuses hold.
// false: they do not within STEPS, a derivative is singular, or a number is not finite.
static bool settle(Settling *settling)
{
    ContactNewton *newton = settling->newton;
    double *taken = settling->discs->taken;
    size_t unknowns = (size_t)settling->problem->interface->count;
    for (int32_t k = 0; k < STEPS; k++) {
        if (!newton->listed && !contact_newton_close(newton)) return false;

        newton->reused = !settling->in_double && contact_newton_keeps_factors(newton);
        if (!newton->reused && !factor(settling)) return false;

        // The step.
        if (!isfinite(find_residual(settling, newton->reused))) return false;
        find_step(settling);
        contact_newton_creep(newton);
        memcpy(taken, newton->step, (size_t)newton->equations.free_count * sizeof(double));
        contact_newton_take(newton);
        settling->discs->iterations++;

        // Statuses at its end; where they stay, a step that leaves more than there was is halved.
        double before = settling->residual;
        bool changed;
        for (int32_t halved = 0;; halved++) {
            settling->scales = contact_scales(settling->problem, settling->at->reaction);
            changed = judge_all(settling);
            settling->residual = changed ? INFINITY : residual_now(settling);
            if (changed || newton->reused || settling->residual <= before || halved == HALVINGS)
                break;

            // Half of what is left of the last step is taken back.
            for (int32_t a = 0; a < newton->equations.free_count; a++) {
                taken[a] *= 0.5;
                newton->step[a] = -taken[a];
            }
            memset(newton->pull, 0, unknowns * sizeof(double));
            contact_newton_take(newton);
        }
        if (changed) {
            contact_newton_settle(newton);
            continue;
        }

        // The last digits are those of S v - g with all of its columns.
        if (settling->residual <= settling->tolerance && !newton->exact) {
            contact_newton_react(newton);
            if (judge_all(settling)) continue;
            settling->residual = residual_now(settling);
        }
        if (settling->residual <= settling->tolerance) return true;
        if (newton->reused && settling->residual > CHORD_GAIN * before)
            newton->factors_gain = false;
    }
    return false;
}

// --- one solve ----------------------------------------------------------------------------------

// An open node has no force, not even by rounding.
static void release_open(const Settling *settling)
{
    const Interface *interface = settling->problem->interface;
    ContactSolution *at = settling->at;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(interface, i);
        for (int32_t c = 0; at->status[i] == CONTACT_OPEN && c < interface->dim; c++)
            at->reaction[t + c] = 0;
    }
    for (int32_t j = 0; j < interface->rod_count; j++)
        if (!at->rod_touches[j]) at->reaction[interface_rod(interface, j)] = 0;
}

bool contact_discs_solve(ContactDiscs *discs, double tolerance, const ContactProblem *problem,
                         ContactSolution *solution)
{
    const Interface *interface = problem->interface;
    Settling settling = {.discs = discs,
                         .newton = discs->newton,
                         .problem = problem,
                         .at = solution,
                         .scales = contact_scales(problem, solution->reaction),
                         .tolerance = tolerance,
                         .residual = INFINITY};

    // Rows at what was handed in, which may be of another g; statuses stay. Where nothing says
    // which way a node slips, it rests.
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (!status_slips(solution->status[i])) continue;
        judge_node(&settling, i);
        if (!status_slips(solution->status[i])) solution->status[i] = CONTACT_STICK;
    }

    // Newton's steps; where these do not settle, sweeps and steps in turn.
    contact_newton_begin(discs->newton, problem, solution, 1e-3 * tolerance);
    bool solved = settle(&settling);
    discs->swept += !solved;
    for (int32_t k = 0; k < SWEEP_ROUNDS && !solved; k++) {
        discs->sweeps += contact_sweep(problem, solution, k);
        contact_newton_begin(discs->newton, problem, solution, 1e-3 * tolerance);
        settling.residual = INFINITY;
        settling.in_double = true;
        settling.scales = contact_scales(problem, solution->reaction);
        judge_all(&settling);
        contact_newton_settle(discs->newton);
        solved = settle(&settling);
    }
    if (!solved) return false;

    // Statuses say which way nodes slip along the drive.
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (status_slips(solution->status[i]))
            solution->status[i] =
                status_of_slip(solution->velocity[interface_tangent(interface, i)]);
    release_open(&settling);
    return true;
}

// At a solution friction lies along the slip (e.r_t = 0), so that the derivative of its direction
// has no part in these equations: they are linear, with the directions held.
bool contact_discs_follow(ContactDiscs *discs, ContactNewton *newton, const ContactProblem *problem,
                          ContactSolution *solution)
{
    Settling settling = {
        .discs = discs, .newton = newton, .problem = problem, .at = solution, .in_double = true};
    memset(solution->velocity, 0, (size_t)problem->interface->count * sizeof(double));
    contact_newton_begin(newton, problem, solution, 0);
    newton->reused = false;
    if (!contact_newton_close(newton)) return false;
    if (!factor_double(&settling)) return false;
    find_residual(&settling, false);
    find_step(&settling);
    contact_newton_take(newton);
    contact_newton_react(newton);
    release_open(&settling);
    return true;
}

// Factors are archived by contact/contact_newton; these are the directions they are in.
void contact_discs_archive(ContactDiscs *discs, const Interface *interface, Archive *archive)
{
    archive_section(archive, "contact discs");
    archive_counts_of(archive, &discs->iterations, &discs->sweeps, &discs->swept);
    DiscFactors *factors = &discs->factors;
    archive_index(archive, &factors->rows, 0, interface->count + 1);
    if (archive->failed) return;
    int64_t entries = (int64_t)factors->rows * factors->rows;
    archive_octets(archive, (uint8_t *)factors->lu, entries * (int64_t)sizeof(float));
    archive_indices(archive, factors->pivots, factors->rows, 1, factors->rows + 1);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        DiscRow *row = &discs->kept[i];
        archive_numbers(archive, row->d, TANGENTS_MAX);
        archive_numbers_of(archive, &row->mu, &row->theta, &row->rho);
        archive_numbers(archive, row->along, TANGENTS_MAX);
    }
}
