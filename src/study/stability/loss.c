// SPDX-License-Identifier: GPL-2.0-or-later
// Where on the path stability is lost first: l, U and mu of each way to lose it, into the summary.
#include "study/stability/stability.h"

#include "friction/friction.h"

#include <math.h>

static bool creeps(const StabilityPath *path)
{
    const Model *model = path->model;
    return friction_creeps(&model->friction, model->interface.contact_count);
}

// Half a period's growth against v_c/V: pi Re/Im - ln(v_c/V). From 0 on a disturbance of the rod's
// size comes to v_c, where friction no longer weakens, before its oscillation turns it back: slip
// then runs away although the pair is still complex. Friction that is 0 at rest has no such end: an
// oscillation that grows becomes a sliding.
double stability_half_period(const StabilityPath *path, int32_t k)
{
    const StabilityPoint *point = &path->points[k];
    double ratio = path->model->friction.critical_velocity / path->model->scene->rod.velocity;
    if (!(point->rate_re > 0)) return -INFINITY;
    if (!(point->rate_im > 0)) return INFINITY;
    if (creeps(path) || ratio < 1) ratio = 1;
    return M_PI * point->rate_re / point->rate_im - log(ratio);
}

// A measure of a point that is below 0 where it is stable and reaches 0 where that is lost. Between
// two points of which the second has one more slipping node, it is taken as linear in l.
typedef double (*Margin)(const StabilityPath *path, int32_t k);

// In space: by no more of the contact than this.
static const double NEXT_PART = 0.1;

// Point k slips at one node more than the one before, and that is the next one along the front
// (where two slipping parts meet, the front jumps).
static bool is_next(const StabilityPath *path, int32_t k)
{
    const StabilityPoint *point = &path->points[k];
    const Interface *interface = &path->model->interface;
    int32_t passed = 0, more = point->slipping - point[-1].slipping;
    if (interface->dim > 2) return more <= NEXT_PART * interface->contact_count;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double l = interface->x[i] - path->model->scales.trailing;
        passed += l > point[-1].front && l <= point->front;
    }
    return more == 1 && passed == 1;
}

// The certificate is yes or no: lost at the point itself.
static double certificate_margin(const StabilityPath *path, int32_t k)
{
    return path->points[k].certified ? -INFINITY : 0;
}

// Real part of a rate that oscillates or grows; -INFINITY: the rate is overdamped. Such rates stay
// near -E/eta and say nothing about the oscillating pair.
static double real_part(const StabilityPath *path, int32_t k)
{
    const StabilityPoint *point = &path->points[k];
    return point->rate_im > 0 || point->rate_re > 0 ? point->rate_re : -INFINITY;
}

// Weakening over the resistance of M, C and K at the worst s, less 1 (growth_scan; pressure kept).
static double overload(const StabilityPath *path, int32_t k)
{
    return path->points[k].load - 1;
}

// Near the birth of the real pair (Im lambda)^2 is linear through 0; the first point of the
// real pair has none, and is replaced by the extrapolation of the two before it.
static double frequency_square(const StabilityPath *path, int32_t k)
{
    const StabilityPoint *point = &path->points[k];
    if (!(point->rate_re > 0)) return -INFINITY;
    if (point->rate_im > 0) return -point->rate_im * point->rate_im;
    if (k < 2 || !(point[-1].rate_im > 0) || !(point[-2].rate_re > 0) || !is_next(path, k) ||
        !is_next(path, k - 1))
        return 0;
    double square = point[-1].rate_im * point[-1].rate_im;
    double fall = (point[-2].rate_im * point[-2].rate_im - square) /
                  (point[-1].front - point[-2].front);
    return fmax(fall * (point->front - point[-1].front) - square, 0);
}

// Place where the margin is lost first: l, U and mu there. Where the margin jumps, the set of
// slipping nodes that has lost it slips ever since its last node began to: since the point before,
// whose U and mu are taken: its own are those at which one more node is about to slip.
static StabilityPoint first_loss(const StabilityPath *path, Margin margin)
{
    StabilityPoint lost = {
        .front = NAN, .U = NAN, .mu = NAN, .mu_at_V = NAN, .rate_im = NAN, .area = NAN};
    int32_t count = path->options->at_end ? 0 : path->count;   // one state has no path
    for (int32_t k = 0; k < count; k++) {
        double after = margin(path, k), before = k > 0 ? margin(path, k - 1) : 0;
        if (!(after >= 0)) continue;
        lost = path->points[k];
        if (k == 0) break;
        const StabilityPoint *last = &path->points[k - 1];
        if (!isfinite(before) || before >= 0 || !is_next(path, k)) {
            lost.U = last->U;
            lost.mu = last->mu;
            lost.mu_at_V = last->mu_at_V;
            break;
        }
        double part = isfinite(after) ? before / (before - after) : 1;
        lost.front = last->front + part * (lost.front - last->front);
        lost.area = last->area + part * (lost.area - last->area);
        lost.U = last->U + part * (lost.U - last->U);
        lost.mu = last->mu + part * (lost.mu - last->mu);
        lost.mu_at_V = last->mu_at_V + part * (lost.mu_at_V - last->mu_at_V);
        break;
    }
    return lost;
}

// The same, or the end of the block: there it slides, whether or not anything grows, at the largest
// mu of the path (that of the end itself is what is left while it slides). What creeps gives way
// before it runs away: of it that is the largest mu so far.
static StabilityPoint first_sliding(const StabilityPath *path, Margin margin)
{
    StabilityPoint lost = first_loss(path, margin);
    bool ends = isnan(lost.front);
    if (!creeps(path) && (!ends || !path->at_end)) return lost;
    if (ends && !path->at_end) return lost;
    if (ends) lost = path->points[path->count - 1];
    for (int32_t k = 0; k < path->count - 1 && path->points[k].front <= lost.front; k++) {
        if (path->points[k].mu < lost.mu) continue;
        lost.mu = path->points[k].mu;
        lost.mu_at_V = path->points[k].mu_at_V;
        lost.U = path->points[k].U;
    }
    return lost;
}

// l_sc, l_c and mu there. At the scene's V slip cannot run away later than for V -> 0.
void stability_summarise(const StabilityPath *path, StabilitySummary *summary)
{
    const Interface *interface = &path->model->interface;
    double length = path->model->length;
    StabilityPoint oscillates = first_loss(path, real_part);
    StabilityPoint slides = first_sliding(path, frequency_square);
    StabilityPoint rod = first_sliding(path, stability_half_period);
    bool earlier = slides.front < rod.front;
    if (interface->dim > 2) earlier = slides.area < rod.area;
    if (earlier) rod = slides;
    *summary =
        (StabilitySummary){.l_sc_certificate = first_loss(path, certificate_margin).front / length,
                           .l_sc = oscillates.front / length,
                           .l_c_scan = first_loss(path, overload).front / length,
                           .l_c = slides.front / length,
                           .l_c_rod = rod.front / length,
                           .mu_sc = oscillates.mu_at_V,
                           .mu_snap = path->mu_snap,
                           .mu_c = slides.mu,
                           .mu_rod = rod.mu_at_V,
                           .U_c = slides.U,
                           .U_rod = rod.U,
                           .area_sc = oscillates.area,
                           .area_c = slides.area,
                           .area_c_rod = rod.area,
                           .frequency = oscillates.rate_im,
                           .element = 1.0 / fmax(interface_nodes_along(interface) - 1, 1),
                           .points = path->count,
                           .path_steps = path->control.counters.accepted,
                           .seconds_growth = path->seconds_growth};
}
