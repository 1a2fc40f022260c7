// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/friction_file.h"

#include "base/memory.h"
#include "io/text/csv_reader.h"

#include <math.h>
#include <stdlib.h>

// Names of the columns as people write them.
static const char *const SPEEDS[] = {"v",
                                     "V",
                                     "velocity",
                                     "speed",
                                     "slip rate",
                                     "sliding velocity",
                                     "slip velocity",
                                     "sliding speed",
                                     NULL};
static const char *const COEFFICIENTS[] = {"mu",      "cof",     "friction", "mu_mean",
                                           "mean mu", "F_T/F_N", "F_t/F_n",  NULL};

bool friction_data_read(const Scene *scene, FrictionData *data, Error *err)
{
    static const char WANTED[] = "wanted: v with its unit and mu, as in `v (mm/s), mu, mu_error`";
    CsvTable csv = {0};
    *data = (FrictionData){0};
    TRY(csv_read_bare(scene->friction_keys.file, &csv, err));

    // Columns of v, mu and its error, and what a 1 in each stands for in the scene's units.
    CsvUnit unit[3] = {{"", 0}, {"", 0}, {"", 0}};
    int32_t column[3] = {0, 1, -1};
    double factor[3] = {1, 1, 1};
    if (!csv.named && csv.columns != 2)
        FAIL(err, ERROR_INPUT, "%s:%d: %d columns without names; %s", csv.path, csv.line[1],
             csv.columns, WANTED);
    if (csv.named) {
        TRY(csv_find_any(&csv, SPEEDS, &column[0], &unit[0], err));
        TRY(csv_find_any(&csv, COEFFICIENTS, &column[1], &unit[1], err));
        if (column[0] < 0 || column[1] < 0)
            FAIL(err, ERROR_INPUT, "%s:%d: there is no column of the %s; %s", csv.path, csv.line[0],
                 column[0] < 0 ? "slip rate v" : "coefficient mu", WANTED);
        csv_find_error(&csv, column[1], &column[2], &unit[2]);
        for (int32_t k = 0; k < 3; k++)
            TRY(column[k] < 0 || csv_to_scene(&csv, column[k], unit[k], k == 0 ? "velocity" : "1",
                                              scene->units == UNITS_SI, &factor[k], err));
    }

    // Rows.
    TRY(csv_check(&csv, column[2], true, err));
    TRY(data->velocity = NEW_ARRAY(double, csv.rows + 1, err));
    TRY(data->mu = NEW_ARRAY(double, csv.rows + 1, err));
    if (column[2] >= 0) TRY(data->error = NEW_ARRAY(double, csv.rows + 1, err));
    for (int32_t row = 0; row < csv.rows; row++) {
        double *velocity = &data->velocity[data->count], *mu = &data->mu[data->count];
        if (!*csv_cell(&csv, row, column[1])) continue;
        TRY(csv_read_number(&csv, row, column[0], velocity, err));
        TRY(csv_read_number(&csv, row, column[1], mu, err));
        *velocity *= factor[0];
        *mu *= factor[1];
        if (!(*velocity >= 0))
            TRY(csv_refuse(&csv, row, column[0], err, "%g: a slip rate is 0 or more", *velocity));
        if (!(*mu >= 0))
            TRY(csv_refuse(&csv, row, column[1], err, "%g: a coefficient is 0 or more", *mu));
        if (data->error) data->error[data->count] = factor[2] * csv_value(&csv, row, column[2]);
        data->count++;
    }
    if (data->count < 2)
        FAIL(err, ERROR_INPUT, "%s has %d point%s; two or more are needed", csv.path, data->count,
             data->count == 1 ? "" : "s");
cleanup:
    csv_destroy(&csv);
    if (!error_is_clean(err)) friction_data_destroy(data);
    return error_is_clean(err);
}

void friction_data_destroy(FrictionData *data)
{
    memory_free_all(data->velocity, data->mu, data->error);
    *data = (FrictionData){0};
}

typedef struct Pair {
    double velocity, mu;
} Pair;

static int by_velocity(const void *a, const void *b)
{
    double x = ((const Pair *)a)->velocity, y = ((const Pair *)b)->velocity;
    return (x > y) - (x < y);
}

bool friction_data_points(const Scene *scene, const FrictionData *data, double *velocity,
                          double *mu, int32_t *count, Error *err)
{
    Pair *pair = NEW_ARRAY(Pair, data->count, err);
    int32_t alike = 0;   // values in the mean of the last point
    *count = 0;
    TRY(pair);
    for (int32_t k = 0; k < data->count; k++) pair[k] = (Pair){data->velocity[k], data->mu[k]};
    qsort(pair, (size_t)data->count, sizeof *pair, by_velocity);
    for (int32_t k = 0; k < data->count; k++) {
        if (*count > 0 && pair[k].velocity == velocity[*count - 1]) {
            mu[*count - 1] += (pair[k].mu - mu[*count - 1]) / ++alike;
            continue;
        }
        if (*count == FRICTION_POINTS_MAX - 1)
            FAIL(err, ERROR_INPUT,
                 "%s: more than %d velocities: give means over parts of the range",
                 scene->friction_keys.file, FRICTION_POINTS_MAX - 1);
        velocity[*count] = pair[k].velocity;
        mu[(*count)++] = pair[k].mu;
        alike = 1;
    }
cleanup:
    memory_free(pair);
    return error_is_clean(err);
}
