// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_make.h"

#include "friction/friction_start.h"

#include <math.h>
#include <string.h>

// `word` stands in `words`, which have blanks between them. words NULL: there are none.
static bool has_word(const char *words, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = words; at; at = strchr(at, ' ')) {
        at += *at == ' ';
        if (strncmp(at, word, length) == 0 && (at[length] == ' ' || !at[length])) return true;
    }
    return false;
}

FrictionUse friction_use(const FrictionLaw *law, const char *key)
{
    const FrictionOperations *operations = friction_operations(law);
    if (has_word(operations->must, key)) return FRICTION_MUST;
    bool may = has_word(operations->may, key) || has_word("law along contacts", key);
    return may ? FRICTION_MAY : FRICTION_UNUSED;
}

// --- a look at one's own law of speed alone -----------------------------------------------------

static const double SAME = 1e-9;   // relative: a number typed twice, rounding of a formula
static const double JUMP = 1e-6;   // of mu: what is left of a jump that halving does not reduce
static const double STEP = 1e-6;   // of a speed, for differences
static const double SLOPE_ERROR = 1e-3;   // relative, that differences leave to a slope
static const double CHANGED = 0.63212055882855768;   // 1 - 1/e
static const double SPENT_PART = 0.01;   // of the drop may be left where the law is spent

static double mu_of(const FrictionLaw *law, double speed)
{
    FrictionNode node = {.law = law, .factor = 1};
    return friction_coefficient(&node, speed);
}

static double slope_of(const FrictionLaw *law, double speed)
{
    FrictionNode node = {.law = law, .factor = 1};
    return friction_slope(&node, speed);
}

// The k-th of the speeds, ascending from 0 to the end, at which the law is looked at; INFINITY:
// there are no more. A formula may change anywhere: a hundred to a decade, over twelve of them.
static double speed_of(const FrictionLaw *law, int32_t k)
{
    enum { DECADE = 100, DECADES = 12, LAST = DECADES * DECADE + 1 };
    const FrictionOperations *operations = friction_operations(law);
    if (operations->look_speed) return operations->look_speed(law, k);
    if (k >= LAST) return k == LAST ? law->end : INFINITY;
    return k == 0 ? 0 : law->end * pow(10, (double)(k - LAST) / DECADE);
}

// Looks at mu and its slope at this speed, and refuses values that no law may have.
static bool look_at(const FrictionLaw *law, double speed, Error *err)
{
    double mu = mu_of(law, speed), slope = slope_of(law, speed);
    if (!isfinite(mu))
        return REFUSE(err, "at velocity %g the coefficient is %g: not a finite number", speed, mu);
    if (!isfinite(slope))
        return REFUSE(err, "at velocity %g the slope of the coefficient is %g: not finite", speed,
                      slope);
    if (mu < 0)
        return REFUSE(err, "at velocity %g the coefficient is %g: it must not be negative", speed,
                      mu);
    return true;
}

// Between two speeds that are looked at: where mu changes by more than its slopes say, the interval
// is halved towards the larger change. A jump stays, whatever is steep shrinks.
static bool is_continuous(const FrictionLaw *law, double low, double high, Error *err)
{
    double from = mu_of(law, low), to = mu_of(law, high);
    double slopes = slope_of(law, low) + slope_of(law, high);
    double jump = JUMP * fmax(from, to);
    if (fabs(to - from - 0.5 * (high - low) * slopes) <= jump) return true;
    double least = low + 1e-12 * high;
    while (high - low > 1e-13 * high && high > least && fabs(to - from) > jump) {
        double middle = 0.5 * (low + high), mu = mu_of(law, middle);
        bool left = fabs(mu - from) > fabs(to - mu);
        *(left ? &high : &low) = middle;
        *(left ? &to : &from) = mu;
    }
    if (fabs(to - from) > jump)
        return REFUSE(err,
                      "at velocity %g the coefficient jumps from %g to %g: it must be continuous",
                      high, from, to);
    return true;
}

// The slope against differences on both sides; at a kink it lies between them.
static bool slope_fits(const FrictionLaw *law, double speed, Error *err)
{
    double h = STEP * speed, mu = mu_of(law, speed);
    double before = (mu - mu_of(law, speed - h)) / h;
    double after = (mu_of(law, speed + h) - mu) / h;
    double slope = slope_of(law, speed);
    double allowed = SLOPE_ERROR * (fabs(before) + fabs(after)) +
                     STEP * fmax(law->mu_static, mu) / speed;
    if (slope < fmin(before, after) - allowed || slope > fmax(before, after) + allowed)
        return REFUSE(
            err,
            "at velocity %g the slope is said to be %g, but differences of the coefficient give %g",
            speed, slope, 0.5 * (before + after));
    return true;
}

// Weakening, or where there is none what strengthens.
static double course(const FrictionLaw *law, double speed)
{
    double slope = slope_of(law, speed);
    return fmax(law->steepest > 0 ? -slope : slope, 0);
}

// 0 where the law is level.
static double find_critical(const FrictionLaw *law)
{
    double largest = law->steepest > 0 ? law->steepest : law->bend;
    double at_rest = course(law, 0), allowed = CHANGED * largest, low = 0, high;
    for (int32_t k = 1; isfinite(high = speed_of(law, k)); k++) {
        if (fabs(course(law, high) - at_rest) > allowed) break;
        low = high;
    }
    if (!(largest > 0) || !isfinite(high)) return largest > 0 ? law->end : 0;
    while (high - low > 1e-15 * high) {
        double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        *(fabs(course(law, middle) - at_rest) > allowed ? &high : &low) = middle;
    }
    return high;
}

// The speed from which on next to nothing weakens.
static double find_spent(const FrictionLaw *law)
{
    double drop = law->mu_static - law->mu_kinetic;
    if (law->fall > 0) {
        // The lowest one from which on no more than SPENT_PART of the largest fall is to come.
        int32_t k = 0;
        double lowest = INFINITY, speed = law->end;
        while (isfinite(speed_of(law, k))) k++;
        while (k-- > 0) {
            double mu = mu_of(law, speed_of(law, k));
            lowest = fmin(lowest, mu);
            if (mu - lowest > SPENT_PART * law->fall) return speed;
            speed = speed_of(law, k);
        }
        return 0;
    }
    // The search goes by multiples of v_c, so that it does not depend on the last digits of the
    // law.
    for (double times = 1; times * law->critical_velocity < law->end;
         times += times < 64 ? 1 : times)
        if (mu_of(law, times * law->critical_velocity) - law->mu_kinetic <= SPENT_PART * drop)
            return times * law->critical_velocity;
    return law->end;
}

// Looks at one's own law of speed alone before it is used. law: kind, end and functions are set;
// mu_static, mu_kinetic and critical_velocity as the scene gives them, 0 where it does not. Sets
// these three, and what else of its shape is kept:
//
//   mu_S   mu(0)
//   mu_K   the lowest coefficient
//   v_c    the speed at which the weakening -mu' (of a law that only rises: mu') has changed by
//          1 - 1/e of its largest value from what it is at rest: so it is v_c of the linear and of
//          the exponential law
//
// A v_c that is given stays, a mu_K too, which must be a lower bound. ERROR_INPUT, with the
// velocity: not finite, negative, not continuous, or a slope that is not that of mu; or a mu_static
// or mu_kinetic that is not that of the law. mu' of a linear table is not continuous and its
// largest need not be at a point looked at: pieces are looked at from both ends, and inside.
static bool look_at_own(const FrictionSource *source, FrictionLaw *law, Error *err)
{
    double given = law->mu_static, before = 0, speed, lowest = INFINITY, lowest_at = 0, rise = 0;
    double highest = 0, fall = 0;
    law->mu_static = mu_of(law, 0);
    law->steepest = law->fall = 0;
    for (int32_t k = 0; isfinite(speed = speed_of(law, k)); k++) {
        if (!look_at(law, speed, err)) return false;
        if (k > 0 && !is_continuous(law, before, speed, err)) return false;
        if (k > 0 && speed < law->end && !slope_fits(law, speed, err)) return false;
        double slope = slope_of(law, speed);
        law->steepest = fmax(law->steepest, fmax(-slope, 0));
        rise = fmax(rise, slope);
        double mu = mu_of(law, speed);
        if (mu < lowest) lowest_at = speed;
        lowest = fmin(lowest, mu);
        highest = fmax(highest, mu);
        fall = fmax(fall, highest - mu);
        before = speed;
    }
    law->bend = fmax(law->steepest, rise);
    if (highest > law->mu_static * (1 + SAME)) law->fall = fall;
    if (given > 0 && fabs(given - law->mu_static) > SAME * given)
        return REFUSE(err, "at velocity 0 the coefficient is %g, but mu_static is given as %g",
                      law->mu_static, given);
    if (given > 0) law->mu_static = given;
    if (law->mu_kinetic > lowest * (1 + SAME))
        return REFUSE(
            err, "at velocity %g the coefficient is %g, but mu_kinetic, the lowest, is given as %g",
            lowest_at, lowest, law->mu_kinetic);
    if (!(law->mu_kinetic > 0)) law->mu_kinetic = lowest;
    law->mu_kinetic = fmin(law->mu_kinetic, law->mu_static);
    if (!(law->critical_velocity > 0)) law->critical_velocity = find_critical(law);
    law->strengthens = rise > SAME * law->steepest;
    law->mu_reference = mu_of(law, source->rod_velocity > 0 ? source->rod_velocity : law->end);
    law->creeps = friction_never_holds(law->mu_static, slope_of(law, 0), law->mu_reference);
    law->spent = law->steepest > 0 ? find_spent(law) : 0;
    return true;
}

// --- making -------------------------------------------------------------------------------------

bool friction_make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    const FrictionOperations *operations = friction_operations(law);
    if (operations->own) law->end = source->end;
    if (operations->rested) {
        if (!(source->rest > 0) && !(source->rod_velocity > 0))
            return REFUSE_AT(err, key, "rest",
                             "missing: without a rod that moves nothing says what the contacts "
                             "remember; allowed: a number > 0");
        law->remembers = true;
        law->states = 1;
        law->start[0] = source->rest > 0 ? friction_rested(law, source->rest)
                                         : operations->steady(law, source->rod_velocity);
    }
    if (operations->make && !operations->make(source, law, key, err)) return false;
    if (!operations->own) return true;
    if (!law->remembers) return ERROR_AT(key, operations->mu_key, look_at_own(source, law, err));
    if (law->feels_pressure && isnan(source->pressure))
        return true;   // made again when it is known
    return friction_start(source, law, key, err);
}
