// SPDX-License-Identifier: GPL-2.0-or-later
// Which pad runs away first, and why. In the state where slip runs away each pad is seen alone:
// the first nodes of it slip from its trailing edge on (J), with the pressure they have, and all
// other contact and rod nodes are held. With T the tangents of J, S_C and S_K the Schur
// complements of C and K on the interface and w the nodes' weights,
//
//     drag       smallest v' S_C[T,T] v / v' w v over slips v of the whole pad
//     stiffness  smallest v' S_K[T,T] v / v' w v
//     ratio(J)    largest weakening over the resistance S(s) = s M + C + K/s of J, over s
//                (stepping/growth, growth_scan); it rises with J, and l_c is where it reaches 1
//
// Shorter contacts resist more. Of the pad that takes part most, a part in the middle alone is put
// in contact, the rest of its face free; the longest part at which no disturbance grows
// (stepping/growth, growth_rates, at its mean pressure) is the steady contact.
//
// Drag is what a geometry has of viscosity against slip: eta1/2 over H for a layer of height H that
// shears, about eta over the length for a short pad on a large block. Weakening over drag,
// (mu_S - mu_K) p / (v_c drag), decides where slip begins to oscillate; elasticity and inertia
// together resist more, so a pad runs away by itself only where that ratio > 1.
#include "study/stability/stability.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "contact/slip.h"
#include "record/observation.h"

#include <math.h>
#include <stdio.h>

typedef struct PadWork {
    StabilityPath *path;   // not owned
    const Interface *interface;   // not owned
    InterfaceOperator *stiffness;   // S_K; owned, like all that follows
    State trial;   // slips on J only
    int32_t *nodes;   // [contact_count] of the pad, ascending x
    int32_t count;
    double pressure;   // mean of the pad's, stress
    double *matrix, *values, *work;   // [contact_count^2], [contact_count], DENSE_EIGEN_WORK
} PadWork;

// The smallest eigenvalue of w^-1/2 S[T,T] w^-1/2 over the whole pad. schur: NULL where the
// matrix is singular; then it is 0.
static bool softest_slip(PadWork *work, const double *schur, double *smallest, Error *err)
{
    const Interface *interface = work->interface;
    int64_t size = interface->count;
    *smallest = 0;
    if (!schur) return true;
    for (int32_t b = 0; b < work->count; b++) {
        int32_t j = work->nodes[b];
        for (int32_t a = 0; a < work->count; a++) {
            int32_t i = work->nodes[a];
            work->matrix[(int64_t)work->count * b + a] =
                schur[size * interface_tangent(interface, j) + interface_tangent(interface, i)] /
                sqrt(interface->weight[i] * interface->weight[j]);
        }
    }
    if (!dense_eigen(work->matrix, work->count, work->values, work->work))
        FAIL(err, ERROR_COMPUTE, "the softest slip of a pad was not found");
    *smallest = work->values[0];
cleanup:
    return error_is_clean(err);
}

// The trial state: the one in which slip runs away, but nothing moves.
static void hold_all(PadWork *work)
{
    State *trial = &work->trial;
    state_copy(&work->path->runaway, trial);
    for (int32_t i = 0; i < trial->contact_count; i++) trial->status[i] = CONTACT_STICK;
    for (int32_t j = 0; j < trial->rod_count; j++) trial->rod_touches[j] = 1;
}

// The ratio when the first `slipping` nodes of the pad slip forward, slowly, and all else is held.
static double ratio_of(PadWork *work, int32_t slipping)
{
    State *trial = &work->trial;
    hold_all(work);
    for (int32_t a = 0; a < slipping; a++) {
        stability_let_slip(work->path, trial, work->nodes[a]);
    }
    return growth_scan(work->path->growth, trial).ratio;
}

// Linear between the last number of nodes that is stable and the next.
static double critical_length(PadWork *work)
{
    int32_t holds = 0, fails = work->count;
    double below = 0, above = ratio_of(work, fails);
    if (!(above >= 1)) return NAN;
    while (fails - holds > 1) {
        int32_t middle = (holds + fails) / 2;
        double ratio = ratio_of(work, middle);
        if (ratio >= 1) {
            fails = middle;
            above = ratio;
        } else {
            holds = middle;
            below = ratio;
        }
    }
    double length = 0;
    for (int32_t a = 0; a < holds; a++) length += work->interface->weight[work->nodes[a]];
    double part = isfinite(above) ? (1 - below) / (above - below) : 1;
    return length + part * work->interface->weight[work->nodes[holds]];
}

// The fastest growth, Re lambda, when `slipping` nodes in the middle of the pad slip at the pad's
// mean pressure, its others free or held and the other pads held. Beside free ones a contact ends
// at its outer nodes: half a weight.
static bool growth_of_part(PadWork *work, int32_t slipping, bool free, double *rate, Error *err)
{
    State *trial = &work->trial;
    int32_t first = (work->count - slipping) / 2, last = first + slipping - 1;
    GrowthRates rates;
    hold_all(work);
    for (int32_t a = 0; a < work->count; a++) {
        int32_t i = work->nodes[a];
        bool inside = a >= first && a <= last, end = free && (a == first || a == last);
        trial->reaction[interface_normal(work->interface, i)] =
            work->pressure * work->interface->weight[i] * (end ? 0.5 : 1);
        if (inside)
            stability_let_slip(work->path, trial, i);
        else if (free)
            trial->status[i] = CONTACT_OPEN;
    }
    TRY(growth_rates(work->path->growth, trial, &rates, err));
    *rate = rates.count > 0 ? rates.rate[0].re : -INFINITY;
cleanup:
    return error_is_clean(err);
}

// The longest part at which nothing grows, in nodes and linear in Re lambda between the last number
// that is steady and the next; `count`: all of it. The first node is taken as steady.
static bool steady_nodes(PadWork *work, bool free, double *nodes, Error *err)
{
    int32_t holds = 1, fails = work->count;
    double below = -INFINITY, above = 0;
    *nodes = work->count;
    TRY(growth_of_part(work, fails, free, &above, err));
    if (!(above > 0)) goto cleanup;
    while (fails - holds > 1) {
        int32_t middle = (holds + fails) / 2;
        double rate = 0;
        TRY(growth_of_part(work, middle, free, &rate, err));
        *(rate > 0 ? &fails : &holds) = middle;
        *(rate > 0 ? &above : &below) = rate;
    }
    *nodes = holds + (isfinite(below) ? below / (below - above) : 0);
cleanup:
    return error_is_clean(err);
}

// The work is on pad p from here on.
static void take_pad(PadWork *work, int32_t p)
{
    const Interface *interface = work->interface;
    work->count = 0;
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (interface->pad[i] == p) work->nodes[work->count++] = i;
}

bool stability_measure_pads(StabilityPath *path, StabilitySummary *summary, Error *err)
{
    const Interface *interface = &path->model->interface;
    int64_t count = interface->contact_count;
    PadWork work = {.path = path, .interface = interface};
    double most = 0, nodes = 0;
    path->grows = path->at_rod >= 0;
    if (!path->grows) {   // it slides because all of it slips, nothing grows before
        path->at_rod = path->count - 1;
        state_copy(&path->last, &path->runaway);
    }
    summary->steady_contact = summary->nucleation_length = NAN;

    // S_K (lifted, where the free block leaves it singular), a trial state and room for one pad.
    BulkOperator *system = &path->model->system;
    OperatorTerms terms = {.stiffness = 1, .lift = true};
    TRY((work.stiffness = interface_operator_create(system, terms, err)));
    TRY(state_create(system, interface, &work.trial, err));
    TRY((work.nodes = NEW_ARRAY(int32_t, count, err)));
    TRY((work.matrix = NEW_ARRAY(double, count *count, err)));
    TRY((work.values = NEW_ARRAY(double, count, err)));
    TRY((work.work = NEW_ARRAY(double, DENSE_EIGEN_WORK(count), err)));

    // Measures each pad alone where slip runs away: nodes of the other pads are held.
    const State *state = &path->runaway;
    const double *re = path->modes + 2 * (int64_t)path->at_rod * interface->contact_count;
    const double *im = re + interface->contact_count;
    for (int32_t p = 0; p < interface->pad_count && p < STABILITY_PADS_MAX; p++) {
        StabilityPad *pad = &summary->pads[p];
        double spring = 0;
        take_pad(&work, p);
        *pad = (StabilityPad){0};
        snprintf(pad->name, sizeof pad->name, "%s", interface->pad_name[p]);

        // Loads, lengths and the mode's share: means over the nodes by their weights, which lengths
        // keep until they are divided by the pad's breadth.
        for (int32_t a = 0; a < work.count; a++) {
            int32_t i = work.nodes[a];
            double weight = interface->weight[i];
            pad->length += weight;
            pad->pressure += state->reaction[interface_normal(interface, i)];
            if (state->status[i] != CONTACT_STICK) pad->slipping += weight;
            pad->mode += weight * hypot(re[i], im[i]);
        }
        pad->pressure /= pad->length;
        pad->mode /= pad->length;
        for (int32_t a = 0; a < work.count; a++) {
            int32_t i = work.nodes[a];
            spring += interface->weight[i] * stability_critical_spring(path, i, pad->pressure);
        }
        TRY(softest_slip(&work, path->control.certificate.damping, &pad->drag, err));
        TRY(softest_slip(&work, interface_operator_schur(work.stiffness), &pad->stiffness, err));
        pad->load = ratio_of(&work, work.count);
        pad->critical_stiffness = spring / pad->length;
        pad->l_c = critical_length(&work);
        double breadth = pad_size(interface, p).breadth;
        pad->length /= breadth;
        pad->slipping /= breadth;
        pad->l_c /= breadth;
        if (pad->mode > most) summary->pad = p;
        most = fmax(most, pad->mode);
        summary->pad_count = p + 1;
    }
    for (int32_t p = 0; p < summary->pad_count && most > 0; p++) summary->pads[p].mode /= most;
    if (interface->dim > 2) goto cleanup;

    // The longest contact at which nothing grows, length; 0: none, as where the block then rocks.
    take_pad(&work, summary->pad);
    work.pressure = summary->pads[summary->pad].pressure;
    double length = summary->pads[summary->pad].length, elements = fmax(work.count - 1, 1);
    if (path->grows && !path->options->at_end) {
        TRY(steady_nodes(&work, true, &nodes, err));
        summary->steady_contact = length * (nodes - 1) / elements;
    }
    // The longest part of a contact that is held elsewhere, which slips between its held
    // neighbours; NaN: all of it, or friction has no memory.
    if (path->nodes) {
        TRY(steady_nodes(&work, false, &nodes, err));
        if (nodes < work.count) summary->nucleation_length = length * nodes / elements;
    }
cleanup:
    interface_operator_destroy(work.stiffness);
    state_destroy(&work.trial);
    memory_free_all(work.nodes, work.matrix, work.values, work.work);
    return error_is_clean(err);
}
