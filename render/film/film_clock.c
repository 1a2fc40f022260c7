// SPDX-License-Identifier: GPL-2.0-or-later
// The way there: speed-up of each step; the power; the film's time as a sum over steps, on which
// frames are evenly spaced.
#include "render/film/film_clock.h"

#include "base/memory.h"
#include "render/view/result_view.h"

#include <math.h>

static const double RAPID = 2;   // V: what record/events calls rapid
static const double POWER_MAX = 2;
static const double EXTRA = 1;   // film time that rapid slip adds, over that of the rest

enum { HALVINGS = 60 };

// Times of the run, rising, and at each the logarithm of the speed-up to the power 1.
typedef struct Course {
    int64_t count;
    double *t, *log_fast;   // [count] owned
} Course;

static double log_fast_at(const FilmClockDef *def, int64_t row)
{
    double part = def->fastest[row] / (RAPID * def->V);
    return def->V > 0 && part > 1 && isfinite(part) ? log(part) : 0;
}

// Between two steps the logarithm is linear.
static double log_fast_between(const FilmClockDef *def, int64_t row, double t)
{
    double length = def->t[row] - def->t[row - 1];
    double part = length > 0 ? fmin(fmax((t - def->t[row - 1]) / length, 0), 1) : 1;
    double before = log_fast_at(def, row - 1);
    return before + part * (log_fast_at(def, row) - before);
}

// The steps from low to high; both ends lie on steps or between two.
static bool course_create(const FilmClockDef *def, Course *course, Error *err)
{
    int64_t n = 1, last = 1;
    if (!(course->t = NEW_ARRAY(double, def->rows + 2, err))) return false;
    if (!(course->log_fast = NEW_ARRAY(double, def->rows + 2, err))) return false;
    course->t[0] = def->low;
    for (int64_t row = 1; row < def->rows; ++row) {
        double t = def->t[row];
        if (def->t[row - 1] <= def->low) course->log_fast[0] = log_fast_between(def, row, def->low);
        if (def->t[row - 1] < def->high) last = row;
        if (!(t > course->t[n - 1] && t < def->high)) continue;
        course->t[n] = t;
        course->log_fast[n++] = log_fast_at(def, row);
    }
    course->t[n] = def->high;
    course->log_fast[n] = log_fast_between(def, last, def->high);
    course->count = n + 1;
    return true;
}

// Speed of the step that ends at k: that of its slower end. Steps of rapid slip are short; a long
// one that only begins or ends fast shows nothing that slow motion would be for.
static double log_fast_of(const Course *course, int64_t k)
{
    return fmin(course->log_fast[k - 1], course->log_fast[k]);
}

static double stretched(const Course *course, int64_t k, double power)
{
    return (course->t[k] - course->t[k - 1]) * exp(power * log_fast_of(course, k));
}

static double length_of(const Course *course, double power)
{
    double sum = 0;
    for (int64_t k = 1; k < course->count; ++k) sum += stretched(course, k, power);
    return sum;
}

// Frames evenly spaced in the film's time, the first at low, the last at high.
static bool frames_place(const FilmClockDef *def, const Course *course, double power,
                         FilmClock *clock, Error *err)
{
    if (!(clock->t = NEW_ARRAY(double, def->frames, err))) return false;
    if (!(clock->speed = NEW_ARRAY(double, def->frames, err))) return false;
    double seconds = (double)(def->frames - 1) / def->rate, whole = length_of(course, power);
    double before = 0, own = stretched(course, 1, power);   // film time to step k; of step k
    int64_t k = 1;
    for (int32_t i = 0; i < def->frames; ++i) {
        double at = whole * i / (def->frames - 1);
        for (; before + own < at && k + 1 < course->count; own = stretched(course, ++k, power))
            before += own;
        double part = own > 0 ? fmin((at - before) / own, 1) : 0;
        clock->t[i] = course->t[k - 1] + part * (course->t[k] - course->t[k - 1]);
        clock->speed[i] = whole / seconds * exp(-power * log_fast_of(course, k));
    }
    clock->t[def->frames - 1] = def->high;
    clock->frames = def->frames;
    clock->rate = def->rate;
    return true;
}

bool film_clock_create(const FilmClockDef *def, FilmClock *clock, Error *err)
{
    Course course = {0};
    *clock = (FilmClock){0};
    if (!(def->high > def->low)) FAIL(err, ERROR_INPUT, "the film would show no time");
    TRY(course_create(def, &course, err));

    // The power with which fast steps are stretched, by halving.
    double least = 0, power = POWER_MAX, wanted = (1 + EXTRA) * (def->high - def->low);
    if (length_of(&course, power) > wanted) {
        double most = power;
        for (int32_t k = 0; k < HALVINGS; ++k) {
            double middle = (least + most) / 2;
            if (length_of(&course, middle) < wanted)
                least = middle;
            else
                most = middle;
        }
        power = (least + most) / 2;
    }
    TRY(frames_place(def, &course, power, clock, err));
cleanup:
    memory_free_all(course.t, course.log_fast);
    if (!error_is_clean(err)) film_clock_destroy(clock);
    return error_is_clean(err);
}

void film_clock_destroy(FilmClock *clock)
{
    memory_free_all(clock->t, clock->speed);
    *clock = (FilmClock){0};
}

double film_clock_seconds(const FilmClock *clock, double t)
{
    int32_t last = clock->frames - 1;
    if (!(t > clock->t[0])) return 0;
    if (t >= clock->t[last]) return (double)last / clock->rate;
    int64_t k = curve_place(clock->t, clock->frames, t);
    return ((double)k + (t - clock->t[k]) / (clock->t[k + 1] - clock->t[k])) / clock->rate;
}
