// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rod_course.h"

#include <math.h>

// Segment between point k and the next; t counts from point k.
typedef struct Segment {
    double duration;   // INFINITY: beyond the last point
    double velocity;   // v_0 at its beginning
    double slope;   // a, acceleration, or by way g, 1/time
} Segment;

static Segment segment_of(const RodCourse *course, int32_t k)
{
    const Schedule *over = &course->schedule;
    double first = course->velocity * over->factor[k];
    if (k + 1 == over->count) return (Segment){.duration = INFINITY, .velocity = first};
    double last = course->velocity * over->factor[k + 1], duration = over->at[k + 1] - over->at[k];
    if (!(duration > 0)) return (Segment){.velocity = first};
    double slope = course->by_way ? log(last / first) / duration : (last - first) / duration;
    return (Segment){.duration = duration, .velocity = first, .slope = slope};
}

static double way_in(const RodCourse *course, const Segment *segment, double t)
{
    double way = segment->velocity * t, slope = segment->slope;
    if (!course->by_way) return way + 0.5 * slope * t * t;
    return slope * t == 0 ? way : segment->velocity * expm1(slope * t) / slope;
}

// Times of the points of a table of U: v over a segment is (v_1 - v_0)/(U_1 - U_0) (U - U_0).
RodCourse rod_course(const Schedule *table, bool by_way, double velocity)
{
    RodCourse course = {.by_way = by_way, .velocity = velocity, .schedule = *table};
    double *at = course.schedule.at, *factor = course.schedule.factor;
    for (int32_t k = 0; by_way && k + 1 < table->count; k++) {
        double mean = velocity * factor[k], ratio = factor[k + 1] / factor[k];
        if (ratio != 1) mean *= (ratio - 1) / log(ratio);
        at[k + 1] = at[k] + (table->at[k + 1] - table->at[k]) / mean;
    }
    for (int32_t k = 0; k + 1 < table->count; k++) {
        Segment segment = segment_of(&course, k);
        course.way[k + 1] = course.way[k] + way_in(&course, &segment, segment.duration);
    }
    return course;
}

double rod_course_velocity(const RodCourse *course, double time)
{
    double from;
    if (course->schedule.count == 0) return course->velocity;
    int32_t k = schedule_segment(&course->schedule, time, &from);
    Segment segment = segment_of(course, k);
    double t = fmax(time - from - course->schedule.at[k], 0);
    return course->by_way ? segment.velocity * exp(segment.slope * t)
                          : segment.velocity + segment.slope * t;
}

double rod_course_way(const RodCourse *course, double time)
{
    const Schedule *over = &course->schedule;
    double from;
    if (over->count == 0) return course->velocity * time;
    int32_t k = schedule_segment(over, time, &from);
    double rounds = round(from / over->at[over->count - 1]);
    Segment segment = segment_of(course, k);
    return rounds * course->way[over->count - 1] + course->way[k] +
           way_in(course, &segment, time - from - over->at[k]);
}

// Time when the first round has covered `way` from its beginning; INFINITY: it does not.
static double arrival_in_round(const RodCourse *course, double way)
{
    for (int32_t k = 0; k < course->schedule.count; k++) {
        if (course->schedule.repeats && k + 1 == course->schedule.count) break;
        Segment segment = segment_of(course, k);
        double v = segment.velocity, slope = segment.slope, left = way - course->way[k], t;
        // The least t in the segment at which what is left is covered.
        if (left <= 0) {
            t = 0;
        } else if (slope == 0) {
            t = v > 0 ? left / v : INFINITY;
        } else if (course->by_way) {
            t = log1p(slope * left / v) / slope;
        } else {
            // The first root (-v +- sqrt)/slope that is not negative, without cancellation.
            double square = v * v + 2 * slope * left, sum = square < 0 ? -1 : v + sqrt(square);
            t = sum > 0 ? 2 * left / sum : INFINITY;
        }
        bool within = left <= 0 || t <= segment.duration * (1 + 1e-12);
        if (within && isfinite(t)) return course->schedule.at[k] + t;
    }
    return INFINITY;
}

double rod_course_arrival(const RodCourse *course, double way)
{
    const Schedule *over = &course->schedule;
    if (over->count == 0) return course->velocity > 0 ? way / course->velocity : INFINITY;
    double first = arrival_in_round(course, way), each = course->way[over->count - 1];
    if (isfinite(first) || !over->repeats || !(each > 0)) return first;

    // U is largest within a round at a point or where the velocity goes through 0.
    double farthest = 0;
    for (int32_t k = 0; k + 1 < over->count; k++) {
        Segment segment = segment_of(course, k);
        double turn = segment.slope < 0 ? -segment.velocity / segment.slope : -1;
        farthest = fmax(farthest, course->way[k + 1]);
        if (!course->by_way && turn > 0 && turn < segment.duration)
            farthest = fmax(farthest, course->way[k] + way_in(course, &segment, turn));
    }
    double rounds = ceil((way - farthest) / each * (1 - 1e-12));
    return rounds * over->at[over->count - 1] + arrival_in_round(course, way - rounds * each);
}
