// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/program_readings.h"

#include <math.h>

// Range of mu, relative to mu: a level with a larger error is not accepted. As in record/steady.
static const double STEADY_RANGE = 2e-3;
static const double ARRIVED = 0.02;   // |ln| of a node's velocity over the rod's, at most
// Relative; steps end at points up to rounding.
static const double REACHED = 3e-12;

static const Estimate NONE = {NAN, NAN};

bool program_jumps(const RodCourse *course)
{
    const Schedule *over = &course->schedule;
    for (int32_t k = 0; k + 1 < over->count; k++)
        if (over->at[k] == over->at[k + 1] && over->factor[k] != over->factor[k + 1]) return true;
    return over->repeats && over->factor[over->count - 1] != over->factor[0];
}

// --- what a piece shows -------------------------------------------------------------------------

// Range of mu in the bins where slip is from `from` to `to`, and in the bin before, as steps may be
// long.
static void range_of(const ProgramPiece *piece, double from, double to, double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int32_t k = 0; k < piece->count && piece->at[k] <= to; k++) {
        if (k + 1 < piece->count && piece->at[k + 1] < from) continue;
        range[0] = fmin(range[0], piece->low[k]);
        range[1] = fmax(range[1], piece->high[k]);
    }
}

static Estimate level_of(const ProgramPiece *piece)
{
    enum { LEAST = 3 };   // bins
    double last[2], earlier[2];
    if (!piece->level || piece->count < LEAST) return NONE;
    double end = piece->at[piece->count - 1];
    range_of(piece, 0.75 * end, end, last);
    range_of(piece, 0.5 * end, 0.75 * end, earlier);
    double middle = 0.5 * (last[0] + last[1]);
    double moved = fabs(middle - 0.5 * (earlier[0] + earlier[1]));
    double error = last[1] - last[0] + moved;
    return error <= STEADY_RANGE * fabs(middle) ? (Estimate){middle, error} : NONE;
}

// The first bin in which no more than 1/e of the way to `after` is left.
static Estimate distance_of(const ProgramPiece *piece, const Estimate *after, double error)
{
    const ProgramTop *top = &piece->top;
    double left = top->mu - after->value, from = top->slip, mu = left;
    if (!(fabs(left) > 2 * (after->error + error))) return NONE;
    for (int32_t k = 0; k < piece->count; k++) {
        double here = piece->first[k] - after->value, at = piece->at[k];
        if (at <= top->slip) continue;
        if (here / left > exp(-1)) {
            from = at;
            mu = here;
            continue;
        }
        double part = (mu - left * exp(-1)) / (mu - here);
        double distance = from + part * (at - from) - top->slip;
        double threshold = after->error * (1 - exp(-1)) + error * exp(-1);
        double open = distance * exp(1) * threshold / fabs(left);
        return (Estimate){distance, open + 0.5 * (at - from) + top->slip};
    }
    return NONE;
}

// Reads the piece as far as it was seen.
static ProgramReading read_piece(const ProgramPiece *piece)
{
    ProgramReading reading = piece->reading;
    const ProgramTop *top = &piece->top;

    // Error of the reference point. After a velocity step it comes from nodes that are not quite at
    // the rod's velocity (mu may be steeper there than on the way); after a hold, from the length
    // of the step behind the peak.
    double error = top->off;
    if (reading.kind != READING_HOLD) {
        double slope = (top->mu - reading.before.value) /
                       log(reading.velocity / reading.velocity_before);
        error = 2 * fabs(slope) * top->off;
    }
    reading.after = level_of(piece);
    reading.distance = distance_of(piece, &reading.after, error);
    double evolved = fabs(top->mu - reading.after.value) *
                     expm1(top->slip / reading.distance.value);
    if (!isnan(evolved)) error += evolved;
    reading.peak = (Estimate){top->mu - reading.before.value, reading.before.error + error};
    bool compares = reading.kind == READING_STEP || reading.velocity == reading.velocity_before;
    if (!compares || isnan(reading.peak.value)) reading.peak = NONE;
    return reading;
}

// --- steps --------------------------------------------------------------------------------------

// The piece under way is over; the next one begins at `time`, where the step seen last is.
static void begin_piece(ProgramReadings *readings, double time)
{
    const RodCourse *course = readings->course;
    ProgramPiece *now = &readings->now;
    if (now->reading.kind != READING_NONE && readings->count < PROGRAM_READINGS_MAX)
        readings->list[readings->count++] = read_piece(now);
    double tiny = 1e-9 * fabs(course->velocity);
    double before = rod_course_velocity(course, time);
    double after = rod_course_velocity(course, time * (1 + REACHED));
    if (fabs(after - before) <= tiny) after = before;

    // The reading that a jump from velocity `before` to `after` begins.
    ProgramReading reading = {.kind = READING_NONE, .before = NONE, .velocity = after};
    if (before > 0 && after > 0 && before != after) {
        reading.kind = READING_STEP;
        reading.velocity_before = before;
        reading.before = level_of(now);
    } else if (before == 0 && after > 0 && now->level && now->reading.velocity_before > 0) {
        reading.kind = READING_HOLD;
        reading.velocity_before = now->reading.velocity_before;
        reading.before = now->reading.before;
        reading.duration = now->ends - now->begins;
    } else if (before > 0 && after == 0) {
        reading.velocity_before = before;
        reading.before = level_of(now);
    }
    double ends = schedule_next(&course->schedule, time);
    double last = isfinite(ends) ? rod_course_velocity(course, ends) : after;
    reading.t = time;
    reading.U = readings->U;
    *now = (ProgramPiece){
        .reading = reading,
        .level = fabs(last - after) <= tiny,
        .begins = time,
        .ends = ends,
        .mu = readings->mu,
        .slip = readings->slip,
        .top.mu = NAN,
    };
}

static void add_to_bin(ProgramPiece *piece, double mu, double slip)
{
    int32_t last = piece->count - 1;
    if (last >= 0 && slip < piece->at[last] + piece->width) {
        piece->low[last] = fmin(piece->low[last], mu);
        piece->high[last] = fmax(piece->high[last], mu);
        return;
    }
    if (piece->count == PROGRAM_BINS) {   // two bins each become one
        for (int32_t bin = 0, one = 0; one < PROGRAM_BINS; bin++, one += 2) {
            int32_t next = one + 1;
            piece->at[bin] = piece->at[one];
            piece->first[bin] = piece->first[one];
            piece->low[bin] = fmin(piece->low[one], piece->low[next]);
            piece->high[bin] = fmax(piece->high[one], piece->high[next]);
        }
        piece->count = PROGRAM_BINS / 2;
        piece->width = piece->at[piece->count - 1] / piece->count;
    }
    int32_t k = piece->count++;
    piece->at[k] = slip;
    piece->first[k] = piece->low[k] = piece->high[k] = mu;
}

// A point that a step ends at belongs to what came before; one that was stepped over, not.
bool program_readings_record(void *self, const Observation *seen, Error *err)
{
    (void)err;
    ProgramReadings *readings = self;
    ProgramPiece *now = &readings->now;
    if (!readings->course) return true;
    while (readings->started && now->ends < seen->t * (1 - REACHED))
        begin_piece(readings, now->ends);

    // mu and the mean slip of the contact, and how far a node's velocity is off the rod's.
    const Interface *interface = seen->interface;
    double shear = 0, normal = 0, moved = 0, weight = 0, velocity = now->reading.velocity;
    readings->off = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_unknown(interface, i, 0), n = interface_normal(interface, i);
        shear -= seen->state->reaction[t];
        normal += seen->state->reaction[n];
        moved += interface->weight[i] * seen->state->displacement[seen->system->interface_dofs[t]];
        weight += interface->weight[i];
        double ratio = seen->state->slip_rate[t] / velocity;
        readings->off = fmax(readings->off, ratio > 0 ? fabs(log(ratio)) : INFINITY);
    }
    readings->mu = normal > 0 ? shear / normal : 0;
    readings->slip = moved / weight;
    readings->U = seen->U;

    // The step belongs to the piece under way.
    if (!readings->started) begin_piece(readings, 0);
    readings->started = true;
    double mu = readings->mu, slip = readings->slip - now->slip;
    ProgramTop *top = &now->top;
    add_to_bin(now, mu, slip);
    if (now->reading.kind != READING_HOLD) {
        // The first step in which every node slides with the rod's new velocity.
        if (isnan(top->mu) && readings->off <= ARRIVED)
            *top = (ProgramTop){.mu = mu, .slip = slip, .off = readings->off};
    } else if (!now->fell && !(mu <= top->mu)) {
        *top = (ProgramTop){.mu = mu, .slip = slip};
    } else if (!now->fell) {
        // A peak is past where mu has gone back by half of it, and by more than a level may.
        if (top->off == 0) top->off = top->mu - mu;
        double limit = fmax(0.5 * (top->mu - now->mu), STEADY_RANGE * fabs(top->mu));
        now->fell = top->mu - mu > limit;
    }
    while (now->ends <= seen->t * (1 + REACHED)) begin_piece(readings, now->ends);
    return true;
}

bool program_readings_at(const ProgramReadings *readings, int32_t k, ProgramReading *reading)
{
    bool open = k == readings->count && readings->now.reading.kind != READING_NONE;
    if (k < readings->count) *reading = readings->list[k];
    if (open) *reading = read_piece(&readings->now);
    return k < readings->count || open;
}

// --- checkpoints --------------------------------------------------------------------------------

static void archive_estimate(Estimate *estimate, Archive *archive)
{
    archive_numbers_of(archive, &estimate->value, &estimate->error);
}

static void archive_reading(ProgramReading *reading, Archive *archive)
{
    archive_index(archive, &reading->kind, 0, READING_KINDS);
    archive_numbers_of(archive, &reading->t, &reading->U, &reading->velocity_before,
                       &reading->velocity, &reading->duration);
    archive_estimate(&reading->before, archive);
    archive_estimate(&reading->after, archive);
    archive_estimate(&reading->peak, archive);
    archive_estimate(&reading->distance, archive);
}

void program_readings_archive(ProgramReadings *readings, Archive *archive)
{
    if (!readings->course) return;
    archive_section(archive, "program readings");
    archive_flag(archive, &readings->started);
    archive_numbers_of(archive, &readings->mu, &readings->slip, &readings->U);

    ProgramPiece *piece = &readings->now;
    ProgramTop *top = &piece->top;
    archive_reading(&piece->reading, archive);
    archive_flag(archive, &piece->level);
    archive_numbers_of(archive, &piece->begins, &piece->ends, &piece->mu, &piece->slip,
                       &piece->width);
    archive_index(archive, &piece->count, 0, PROGRAM_BINS + 1);
    archive_numbers(archive, piece->at, piece->count);
    archive_numbers(archive, piece->first, piece->count);
    archive_numbers(archive, piece->low, piece->count);
    archive_numbers(archive, piece->high, piece->count);
    archive_numbers_of(archive, &top->mu, &top->slip, &top->off);
    archive_flag(archive, &piece->fell);
    archive_index(archive, &readings->count, 0, PROGRAM_READINGS_MAX + 1);
    for (int32_t k = 0; k < readings->count; k++) archive_reading(&readings->list[k], archive);
}
