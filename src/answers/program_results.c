// SPDX-License-Identifier: GPL-2.0-or-later
#include "answers/program_results.h"

#include <math.h>

static const Estimate NONE = {NAN, NAN};

static double logarithm(const ProgramReading *reading)
{
    return log(reading->velocity / reading->velocity_before);
}

static Estimate direct_of(const ProgramReading *reading)
{
    double ln = logarithm(reading);
    return (Estimate){reading->peak.value / ln, reading->peak.error / fabs(ln)};
}

static Estimate change_of(const ProgramReading *reading)
{
    double ln = logarithm(reading);
    return (Estimate){(reading->after.value - reading->before.value) / ln,
                      (reading->after.error + reading->before.error) / fabs(ln)};
}

static bool heals(const ProgramReadings *readings, int32_t k, ProgramReading *reading)
{
    return program_readings_at(readings, k, reading) && reading->kind == READING_HOLD &&
           !isnan(reading->peak.value);
}

// A straight line of healing over the logarithm of the time held: its slope.
static Estimate healing_of(const ProgramReadings *readings)
{
    ProgramReading reading;
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, parts = 0;
    for (int32_t k = 0; k <= readings->count; k++) {
        if (!heals(readings, k, &reading)) continue;
        double dx = log10(reading.duration) - x, dy = reading.peak.value - y;   // from means so far
        n++;
        x += dx / n;
        y += dy / n;
        xx += dx * dx * (n - 1) / n;
        xy += dx * dy * (n - 1) / n;
        yy += dy * dy * (n - 1) / n;
    }
    if (!(xx > 1e-12 * (1 + x * x))) return NONE;
    double slope = xy / xx, rest = fmax(yy - slope * xy, 0);
    for (int32_t k = 0; k <= readings->count; k++)
        if (heals(readings, k, &reading))
            parts += fabs(log10(reading.duration) - x) / xx * reading.peak.error;
    return (Estimate){slope, parts + (n > 2 ? sqrt(rest / (n - 2) / xx) : 0)};
}

// Widens *all to hold the bar of `one` where it is known.
static void span(Estimate *all, Estimate one)
{
    if (isnan(one.value)) return;
    double low = fmin(all->value - all->error, one.value - one.error);   // NaN counts for nothing
    double high = fmax(all->value + all->error, one.value + one.error);
    *all = (Estimate){0.5 * (low + high), 0.5 * (high - low)};
}

ProgramSums program_results_sum(const ProgramReadings *readings)
{
    ProgramSums sums = {0, 0, NONE, NONE, NONE, healing_of(readings)};
    ProgramReading reading;
    for (int32_t k = 0; program_readings_at(readings, k, &reading); k++) {
        if (reading.kind == READING_HOLD) sums.holds++;
        if (reading.kind != READING_STEP) continue;
        sums.steps++;
        span(&sums.direct, direct_of(&reading));
        span(&sums.change, change_of(&reading));
        span(&sums.distance, reading.distance);
    }
    return sums;
}

static const char *why_not(const ProgramReading *reading)
{
    if (isnan(reading->before.value)) return "mu was not steady before";
    if (reading->kind == READING_HOLD && reading->velocity != reading->velocity_before)
        return "the rod goes on with another velocity";
    if (isnan(reading->peak.value)) return "the contact never had the rod's velocity as a whole";
    if (reading->kind == READING_HOLD) return NULL;
    if (isnan(reading->after.value)) return "mu was not steady after";
    return isnan(reading->distance.value) ? "no change of mu with slip stands out" : NULL;
}

static void write_estimate(JsonWriter *json, const char *name, const char *error, Estimate value)
{
    json_number(json, name, value.value);
    json_number(json, error, value.error);
}

void program_results_json(const ProgramReadings *readings, JsonWriter *json)
{
    static const char *const lists[] = {[READING_STEP] = "steps", [READING_HOLD] = "holds"};
    ProgramReading reading;
    json_begin_object(json, "program");
    for (int32_t kind = READING_STEP; kind < READING_KINDS; kind++) {
        json_begin_list(json, lists[kind]);
        for (int32_t k = 0; program_readings_at(readings, k, &reading); k++) {
            if (reading.kind != kind) continue;
            json_begin_object(json, NULL);
            json_numbers_of(json, {"t", reading.t}, {"U", reading.U});
            if (kind == READING_STEP)
                json_numbers_of(json, {"velocity_before", reading.velocity_before},
                                {"velocity", reading.velocity});
            else
                json_number(json, "duration", reading.duration);
            write_estimate(json, "mu_before", "mu_before_error", reading.before);
            if (kind == READING_STEP) {
                write_estimate(json, "direct", "direct_error", reading.peak);
                write_estimate(json, "direct_per_ln", "direct_per_ln_error", direct_of(&reading));
                write_estimate(json, "mu_after", "mu_after_error", reading.after);
                write_estimate(json, "change_per_ln", "change_per_ln_error", change_of(&reading));
                write_estimate(json, "slip_distance", "slip_distance_error", reading.distance);
            } else {
                write_estimate(json, "healing", "healing_error", reading.peak);
            }
            json_text(json, "why_not", why_not(&reading));
            json_end(json);
        }
        json_end(json);
    }
    ProgramSums sums = program_results_sum(readings);
    write_estimate(json, "direct_per_ln", "direct_per_ln_error", sums.direct);
    write_estimate(json, "change_per_ln", "change_per_ln_error", sums.change);
    write_estimate(json, "slip_distance", "slip_distance_error", sums.distance);
    write_estimate(json, "healing_per_decade", "healing_per_decade_error", sums.healing);
    json_end(json);
}
