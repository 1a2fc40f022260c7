// SPDX-License-Identifier: GPL-2.0-or-later
// The way there: speed-up of each step; the power; the film's time as a sum over steps; then the
// ease, on places evenly spaced in that time. The speed-up belongs to times of the run, so easing
// moves nothing: the film's time is summed anew.
#include "render/film/film_clock.h"

#include "base/memory.h"
#include "render/view/result_view.h"

#include <math.h>

static const double RAPID = 2;   // V: what record/events calls rapid
static const double POWER_MAX = 2;
static const double EXTRA = 1;   // film time that rapid slip adds, over that of the rest

enum { HALVINGS = 60, PLACES_A_FRAME = 64, PLACES_MAX = 1 << 20 };

// Times of the run, rising, and at each the logarithm of the speed-up to the power 1.
typedef struct Course {
    int64_t count;
    double *t, *log_fast;   // [count] owned
} Course;

static bool course_make(Course *course, int64_t count, Error *err)
{
    course->count = count;
    return (course->t = NEW_ARRAY(double, count, err)) &&
           (course->log_fast = NEW_ARRAY(double, count, err));
}

static void course_destroy(Course *course)
{
    memory_free_all(course->t, course->log_fast);
    *course = (Course){0};
}

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
    if (!course_make(course, def->rows + 2, err)) return false;
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

// A place in the film's time: in step `k` of a course, `part` of the way to its end.
typedef struct Place {
    int64_t k;
    double before, part;   // before: the film's time at the step's beginning
} Place;

// Led along, from step 1.
static void place_move(const Course *course, double power, double at, Place *place)
{
    double own = stretched(course, place->k, power);
    while (place->before + own < at && place->k + 1 < course->count) {
        place->before += own;
        own = stretched(course, ++place->k, power);
    }
    place->part = own > 0 ? fmin((at - place->before) / own, 1) : 0;
}

static double time_at(const Course *course, const Place *place)
{
    const double *t = course->t + place->k;
    return t[-1] + place->part * (t[0] - t[-1]);
}

// Frames evenly spaced in the film's time, the first at low, the last at high.
static bool frames_place(const FilmClockDef *def, const Course *even, double power,
                         FilmClock *clock, Error *err)
{
    if (!(clock->t = NEW_ARRAY(double, def->frames, err))) return false;
    if (!(clock->speed = NEW_ARRAY(double, def->frames, err))) return false;
    double seconds = (double)(def->frames - 1) / def->rate, whole = length_of(even, power);
    Place place = {.k = 1};
    for (int32_t i = 0; i < def->frames; ++i) {
        place_move(even, power, whole * i / (def->frames - 1), &place);
        const double *log_fast = even->log_fast + place.k;
        double here = log_fast[-1] + place.part * (log_fast[0] - log_fast[-1]);
        clock->t[i] = time_at(even, &place);
        clock->speed[i] = whole / seconds * exp(-power * here);
    }
    clock->t[def->frames - 1] = def->high;
    clock->frames = def->frames;
    clock->rate = def->rate;
    return true;
}

bool film_clock_create(const FilmClockDef *def, FilmClock *clock, Error *err)
{
    Course course = {0}, even = {0};
    int64_t places = (int64_t)PLACES_A_FRAME * def->frames;
    *clock = (FilmClock){0};
    if (places > PLACES_MAX) places = PLACES_MAX;
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

    // The same course at places that are evenly spaced in the film's time.
    double step = length_of(&course, power) / (double)(places - 1);
    Place place = {.k = 1};
    TRY(course_make(&even, places, err));
    for (int64_t i = 0; i < places; ++i) {
        place_move(&course, power, (double)i * step, &place);
        even.t[i] = time_at(&course, &place);
        even.log_fast[i] = log_fast_of(&course, place.k);
    }
    even.t[places - 1] = course.t[course.count - 1];

    // Speed, 1 without slow motion, grows by no more than `slope` a unit of the run's time, before
    // and behind rapid slip: its logarithm then changes evenly in the film's time. It can only
    // fall, so that nothing rapid is shown faster than without. With this slope the way from the
    // slowest to the fastest takes `ease` seconds.
    if (def->ease > 0) {
        double largest = 0, seconds = (double)(def->frames - 1) / def->rate;
        for (int64_t i = 0; i < places; ++i) largest = fmax(largest, even.log_fast[i]);
        double slope = seconds / length_of(&even, power) * power * largest / def->ease;
        for (int32_t back = 0; back < 2; ++back)
            for (int64_t i = 1; i < places; ++i) {
                int64_t k = back ? places - 1 - i : i, from = back ? k + 1 : k - 1;
                double fastest = exp(-power * even.log_fast[from]) +
                                 slope * fabs(even.t[k] - even.t[from]);
                if (exp(-power * even.log_fast[k]) > fastest)
                    even.log_fast[k] = -log(fastest) / power;
            }
    }
    TRY(frames_place(def, &even, power, clock, err));
cleanup:
    course_destroy(&course);
    course_destroy(&even);
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
