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
    return error_is_clean(err) && disc_factors_create(interface, &discs->factors, err);
}

void contact_discs_destroy(ContactDiscs *discs)
{
    memory_free_all(discs->row, discs->kept, discs->taken);
    disc_factors_destroy(&discs->factors);
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
    bool factors_anew;   // a step with kept factors did not gain: none is taken any more
    bool in_double;   // factors are made in double precision
} Settling;

// --- statuses and rows --------------------------------------------------------------------------

// rho of tangents and normal of node i.
static void node_scales(const ContactProblem *problem, int32_t i, double *tangent, double *normal)
{
    int64_t count = problem->interface->count, t = interface_tangent(problem->interface, i);
    const double *entry = problem->matrix->schur + t * (count + 1);
    *tangent = 0.5 * (entry[0] + entry[count + 1]);
    *normal = entry[2 * (count + 1)];
}

// Status and row of node i. false: its status stays.
static bool judge_node(const Settling *settling, int32_t i)
{
    const ContactProblem *problem = settling->problem;
    const Interface *interface = problem->interface;
    const FrictionNode *node = friction_at(problem->friction, i);
    ContactSolution *at = settling->at;
    DiscRow *row = &settling->discs->row[i];
    int32_t t = interface_tangent(interface, i), n = interface_normal(interface, i);
    uint8_t was = at->status[i];
    double rho, rho_n, slack = settling->tolerance * settling->scales.force;
    node_scales(problem, i, &rho, &rho_n);
    double pressing = at->reaction[n] - rho_n * (at->velocity[n] - problem->bound[n]);
    if (pressing <= (was == CONTACT_OPEN ? slack : -slack)) {
        at->status[i] = CONTACT_OPEN;
        return was != CONTACT_OPEN;
    }
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

// --- equations ----------------------------------------------------------------------------------

// Residual of the equations of node i: along d, and across it by (1 - theta).
static void node_residual(const Settling *settling, int32_t i, double off[2])
{
    const Interface *interface = settling->problem->interface;
    const DiscRow *row = &settling->discs->row[i];
    int32_t t = interface_tangent(interface, i), n = interface_normal(interface, i);
    const double *r = settling->at->reaction + t, *v = settling->at->velocity + t, *d = row->d;
    off[0] = d[0] * r[0] + d[1] * r[1] + row->mu * settling->at->reaction[n];
    off[1] = (1 - row->theta) * (d[0] * r[1] - d[1] * r[0]) +
             row->theta * row->rho * (d[0] * v[1] - d[1] * v[0]);
}

// Into newton->step: what the rows of what is free are off, those of a slipping node turned into
// the directions that were factored, where `kept`. Returns the largest force that any is off.
static double find_residual(const Settling *settling, bool kept)
{
    const ContactProblem *problem = settling->problem;
    const ContactEquations *equations = &settling->newton->equations;
    const ContactSolution *at = settling->at;
    double largest = 0, *step = settling->newton->step;
    int32_t rods = interface_rod(problem->interface, 0);
    for (int32_t a = 0; a < equations->free_count; a++) {
        int32_t k = equations->free[a];
        if (k >= rods) {
            step[a] = at->reaction[k];
            if (at->rod_touches[k - rods])
                step[a] += rod_stiffness(problem, k - rods) * (at->velocity[k] - problem->bound[k]);
            largest = fmax(largest, fabs(step[a]));
            continue;
        }
        int32_t i = dof_node(problem->interface->dim, k);
        const DiscRow *row = &settling->discs->row[i], *old = &settling->discs->kept[i];
        double off[2], across;
        node_residual(settling, i, off);
        across = row->theta < 1 ? off[1] / (1 - row->theta) : 0;
        if (kept) {
            double cosine = row->d[0] * old->d[0] + row->d[1] * old->d[1];
            double sine = old->d[0] * row->d[1] - old->d[1] * row->d[0];
            double along = off[0];
            off[0] = cosine * along - sine * across;
            off[1] = (1 - old->theta) * (sine * along + cosine * across);
        }
        step[a++] = off[0];
        step[a] = off[1];
        largest = fmax(largest, hypot(off[0], across));
    }
    return largest;
}

// In double precision, into the factors of the plane.
static bool factor_double(const Settling *settling)
{
    ContactNewton *newton = settling->newton;
    int64_t size = newton->equations.free_count;
    for (int32_t b = 0; b < size; b++)
        disc_column(newton, settling->discs->row, b, newton->factors.lu + b * size);
    return dense_lu(newton->factors.lu, (int32_t)size, newton->factors.pivots);
}

// --- steps --------------------------------------------------------------------------------------

// Factors are of this S and of these statuses, and steps with them gain.
static bool may_reuse(const Settling *settling)
{
    const ContactNewton *newton = settling->newton;
    int64_t factored = settling->problem->matrix->factored;
    return newton->factors_gain && !newton->creeps && !settling->factors_anew && factored > 0 &&
           factored == newton->factorisations &&
           contact_has_statuses(&newton->equations, newton->factors.status);
}

static bool factor(Settling *settling)
{
    ContactNewton *newton = settling->newton;
    ContactFactors *factors = &newton->factors;
    int32_t size = newton->equations.free_count;
    newton->factorisations++;
    bool regular = settling->in_double
                       ? factor_double(settling)
                       : disc_factors_make(&settling->discs->factors, newton, settling->discs->row);
    contact_copy_statuses(&newton->equations, factors->status);
    memcpy(settling->discs->kept, settling->discs->row,
           (size_t)settling->problem->interface->contact_count * sizeof(DiscRow));
    factors->rows = regular && settling->in_double ? size : 0;
    if (settling->in_double) settling->discs->factors.rows = 0;
    settling->problem->matrix->factored = regular ? newton->factorisations : 0;
    newton->factors_gain = true;
    return regular;
}

// Subtracts from newton->step the velocity change of these rows when the forces at open nodes are
// removed.
static void add_pull(const Settling *settling)
{
    ContactNewton *newton = settling->newton;
    const ContactEquations *equations = &newton->equations;
    int32_t rods = interface_rod(settling->problem->interface, 0);
    const DiscRow *rows = newton->reused ? settling->discs->kept : settling->discs->row;
    contact_newton_find_pull(newton);
    for (int32_t a = 0; a < equations->free_count; a++) {
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
}

// The residual in newton->step becomes the step that takes it away.
static void find_step(const Settling *settling)
{
    ContactNewton *newton = settling->newton;
    int32_t size = newton->equations.free_count;
    for (int32_t a = 0; a < size; a++) newton->step[a] = -newton->step[a];
    if (newton->open_count > 0) add_pull(settling);
    if (!settling->in_double && settling->discs->factors.rows > 0)
        disc_factors_solve(&settling->discs->factors, newton, newton->step);
    else
        dense_lu_solve(newton->factors.lu, size, newton->factors.pivots, newton->step);
}

// One step from rows, lists and reactions as they are. false: the derivative is singular, or a
// number is not finite.
static bool take_step(Settling *settling)
{
    ContactNewton *newton = settling->newton;
    newton->reused = may_reuse(settling);
    if (!newton->reused && !factor(settling)) return false;
    double before = find_residual(settling, newton->reused);
    if (!isfinite(before)) return false;
    find_step(settling);
    contact_newton_creep(newton);
    size_t bytes = (size_t)newton->equations.free_count * sizeof(double);
    memcpy(settling->discs->taken, newton->step, bytes);
    contact_newton_take(newton);
    settling->discs->iterations++;
    return true;
}

// Half of what is left of the last step is taken back.
static void halve_step(Settling *settling)
{
    ContactNewton *newton = settling->newton;
    double *taken = settling->discs->taken;
    for (int32_t a = 0; a < newton->equations.free_count; a++) {
        taken[a] *= 0.5;
        newton->step[a] = -taken[a];
    }
    memset(newton->pull, 0, (size_t)settling->problem->interface->count * sizeof(double));
    contact_newton_take(newton);
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

typedef enum Progress { GOES_ON, SOLVED } Progress;

static Progress judge_step(Settling *settling)
{
    ContactNewton *newton = settling->newton;
    double before = settling->residual;
    for (int32_t halved = 0;; halved++) {
        settling->scales = contact_scales(settling->problem, settling->at->reaction);
        if (judge_all(settling)) {
            contact_newton_settle(newton);
            settling->residual = INFINITY;
            return GOES_ON;
        }
        settling->residual = residual_now(settling);
        if (newton->reused || settling->residual <= before || halved == HALVINGS) break;
        halve_step(settling);
    }
    if (settling->residual <= settling->tolerance && !newton->exact) {
        contact_newton_react(newton);
        if (judge_all(settling)) return GOES_ON;
        settling->residual = residual_now(settling);
    }
    if (settling->residual <= settling->tolerance) return SOLVED;
    if (newton->reused && settling->residual > CHORD_GAIN * before) settling->factors_anew = true;
    return GOES_ON;
}

static bool settle(Settling *settling)
{
    for (int32_t k = 0; k < STEPS; k++) {
        if (!settling->newton->listed && !contact_newton_close(settling->newton)) return false;
        if (!take_step(settling)) return false;
        if (judge_step(settling) == SOLVED) return true;
    }
    return false;
}

// --- one solve ----------------------------------------------------------------------------------

// Rows at what was handed in, which may be of another g; statuses stay. Where nothing says which
// way a node slips, it rests.
static void start_rows(Settling *settling)
{
    const Interface *interface = settling->problem->interface;
    ContactSolution *at = settling->at;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (!status_slips(at->status[i])) continue;
        judge_node(settling, i);
        if (!status_slips(at->status[i])) at->status[i] = CONTACT_STICK;
    }
}

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

// Which way nodes slip along the drive.
static void clean_solution(const Settling *settling)
{
    const Interface *interface = settling->problem->interface;
    ContactSolution *at = settling->at;
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (status_slips(at->status[i]))
            at->status[i] = status_of_slip(at->velocity[interface_tangent(interface, i)]);
    release_open(settling);
}

bool contact_discs_solve(ContactDiscs *discs, double tolerance, const ContactProblem *problem,
                         ContactSolution *solution)
{
    Settling settling = {.discs = discs,
                         .newton = discs->newton,
                         .problem = problem,
                         .at = solution,
                         .scales = contact_scales(problem, solution->reaction),
                         .tolerance = tolerance,
                         .residual = INFINITY};
    start_rows(&settling);
    contact_newton_begin(discs->newton, problem, solution, 1e-3 * tolerance);
    bool solved = settle(&settling);
    discs->swept += !solved;
    for (int32_t k = 0; k < SWEEP_ROUNDS && !solved; k++) {
        discs->sweeps += contact_sweep(problem, solution, k);
        contact_newton_begin(discs->newton, problem, solution, 1e-3 * tolerance);
        settling.residual = INFINITY;
        settling.factors_anew = settling.in_double = true;
        settling.scales = contact_scales(problem, solution->reaction);
        judge_all(&settling);
        contact_newton_settle(discs->newton);
        solved = settle(&settling);
    }
    if (solved) clean_solution(&settling);
    return solved;
}

// At a solution e.r_t = 0, and the across row does not turn either: rows are its derivative with
// their directions held.
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
    disc_factors_archive(&discs->factors, interface->count, archive);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        DiscRow *row = &discs->kept[i];
        archive_numbers(archive, row->d, TANGENTS_MAX);
        archive_numbers_of(archive, &row->mu, &row->theta, &row->rho);
        archive_numbers(archive, row->along, TANGENTS_MAX);
    }
}
