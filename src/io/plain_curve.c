// SPDX-License-Identifier: GPL-2.0-or-later
// gmsh does not compute where the nodes of a curve are: it integrates a density of nodes along the
// curve, of a slope that it takes from differences, by trapezoids that it halves until they agree,
// and looks up where the integral has grown by another n-th. So even nodes lie some 1e-12 of the
// length beside k / n, those of a progression some 1e-9. The same steps are done here in the same
// order, since a mesh has to have the same bits whichever way it was made.
#include "io/plain_curve.h"

#include "base/memory.h"

#include <math.h>

// A curve is halved at least DEPTH_MIN times and at most DEPTH_MAX times, until a halving changes
// its part of the integral by less than PRECISION. SLOPE_STEP: half of what a slope is a difference
// over, in units of the curve.
enum { DEPTH_MIN = 6, DEPTH_MAX = 25 };
static const double PRECISION = 1e-9, SLOPE_STEP = 1e-5;

// Where gmsh itself takes long, or divides by what is nearly nothing.
static const double RATIO_MAX = 1e3, RATIO_NEXT_TO_1 = 1e-9, CELLS_MAX = 1e7,
                    GRADED_CELLS_MAX = 1e4;

bool curve_spacing(CurveLaw law, double ratio, double cells, CurveSpacing *spacing)
{
    if (!(cells >= 1 && cells <= CELLS_MAX)) return false;
    *spacing = (CurveSpacing){.cells = (int32_t)cells, .law = law, .ratio = ratio};
    if (ratio == 1) return true;
    double times = law == LAW_PROGRESSION ? pow(ratio, cells - 1) : ratio;
    return cells <= GRADED_CELLS_MAX && times <= RATIO_MAX && times >= 1 / RATIO_MAX &&
           fabs(ratio - 1) > RATIO_NEXT_TO_1;
}

// What is integrated from t = 0 to t = 1, and its integral.
typedef struct Course {
    double from, to;
    const CurveSpacing *spacing;
    double length;   // of the curve; 0: this is what is asked for
    double precision;   // for the length gmsh's is so coarse that DEPTH_MIN is enough
    int32_t count, room;
    struct CoursePoint {
        double t, integral;
    } * points;   // [count]; owned
} Course;

static double point_at(const Course *course, double t)
{
    return course->from + t * (course->to - course->from);
}

static double slope_at(const Course *course, double t)
{
    double before = t < SLOPE_STEP ? 0 : SLOPE_STEP, behind = t > 1 - SLOPE_STEP ? 0 : SLOPE_STEP;
    return fabs((point_at(course, t + behind) - point_at(course, t - before)) / (before + behind));
}

// Of the cell that t would lie in if they were in progression: gmsh's density jumps between cells.
static double density_progression(const Course *course, double t)
{
    double r = course->spacing->ratio, length = course->length;
    double first = length * (r - 1) / (pow(r, course->spacing->cells) - 1);
    double cell = trunc(log(t * length / first * (r - 1) + 1) / log(r));
    return slope_at(course, t) / (first * pow(r, cell));
}

static double density_bump(const Course *course, double t)
{
    double c = course->spacing->ratio, length = course->length;
    double nodes = (double)course->spacing->cells + 1, bend;
    if (c > 1) {
        bend = -4 * sqrt(c - 1) * atan2(1, sqrt(c - 1)) / (nodes * length);
    } else {
        double root = 1 / sqrt(1 - c);
        bend = 2 * sqrt(1 - c) * log(fabs((1 + root) / (1 - root))) / (nodes * length);
    }
    double middle = -bend * length * length / (4 * (c - 1)), off = t * length - length * 0.5;
    return slope_at(course, t) / (-bend * (off * off) + middle);
}

static double density_at(const Course *course, double t)
{
    if (course->length == 0) return slope_at(course, t);
    if (course->spacing->ratio == 1) return slope_at(course, t) / course->length;
    return course->spacing->law == LAW_BUMP ? density_bump(course, t)
                                            : density_progression(course, t);
}

static bool add_point(Course *course, double t, double rise, Error *err)
{
    struct CoursePoint *points =
        memory_grow(course->points, course->count, &course->room, sizeof *points, err);
    if (!points) return false;
    course->points = points;
    double before = course->count ? points[course->count - 1].integral : 0;
    points[course->count++] = (struct CoursePoint){.t = t, .integral = before + rise};
    return true;
}

// A part of the curve, with the density at its ends.
typedef struct Part {
    double t[2], density[2];
} Part;

static double trapezoid(const Part *part)
{
    return 0.5 * (part->density[0] + part->density[1]) * (part->t[1] - part->t[0]);
}

static bool add_part(Course *course, const Part *part, int32_t depth, Error *err)
{
    double t = 0.5 * (part->t[0] + part->t[1]), density = density_at(course, t);
    Part first = {{part->t[0], t}, {part->density[0], density}};
    Part second = {{t, part->t[1]}, {density, part->density[1]}};
    double off = fabs(trapezoid(part) - trapezoid(&first) - trapezoid(&second));
    if ((off < course->precision && depth > DEPTH_MIN) || depth > DEPTH_MAX)
        return add_point(course, t, trapezoid(&first), err) &&
               add_point(course, part->t[1], trapezoid(&second), err);
    return add_part(course, &first, depth + 1, err) && add_part(course, &second, depth + 1, err);
}

// *integral: that of the whole curve.
static bool integrate(Course *course, double *integral, Error *err)
{
    Part whole = {{0, 1}, {density_at(course, 0), density_at(course, 1)}};
    course->count = 0;
    TRY(add_point(course, 0, 0, err));
    TRY(add_part(course, &whole, 1, err));
    *integral = course->points[course->count - 1].integral;
cleanup:
    return error_is_clean(err);
}

bool curve_place_nodes(double from, double to, const CurveSpacing *spacing, double *at, Error *err)
{
    Course course = {.from = from, .to = to, .spacing = spacing, .precision = INFINITY};
    double length = 0, whole = 0;
    int32_t cells = spacing->cells;
    TRY(integrate(&course, &length, err));
    course.length = length;
    course.precision = PRECISION;
    TRY(integrate(&course, &whole, err));
    double share = whole / cells;
    at[0] = from;
    at[cells] = to;
    for (int32_t k = 1, part = 0; k < cells; k++) {
        double wanted = k * share;
        while (course.points[part + 1].integral < wanted) part++;
        const struct CoursePoint *p = &course.points[part];
        at[k] = point_at(&course, p[0].t + (p[1].t - p[0].t) / (p[1].integral - p[0].integral) *
                                               (wanted - p[0].integral));
    }
cleanup:
    memory_free(course.points);
    return error_is_clean(err);
}
