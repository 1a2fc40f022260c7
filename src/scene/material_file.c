// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/material_file.h"

#include "base/memory.h"
#include "io/text/csv_reader.h"
#include "scene/keys.h"
#include "scene/materials.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

_Static_assert((int)RELAXATION_TERMS_MAX <= (int)SCENE_BRANCHES_MAX, "a branch for each term");

static const double TWO_PI = 6.283185307179586;

// Names of the columns as people and instruments write them.
typedef enum MaterialColumn {
    FREQUENCY,
    ANGULAR,
    TIME,
    YOUNG,
    YOUNG_LOSS,
    SHEAR,
    SHEAR_LOSS,
    TANGENT,
    TEMPERATURE,
    COLUMNS
} MaterialColumn;
static const char *const NAMES[COLUMNS][9] = {
    [FREQUENCY] = {"f", "freq", "freq.", "frequency", NULL},
    [ANGULAR] = {"omega", "w", "\xCF\x89", "angular frequency", "ang. frequency", NULL},
    [TIME] = {"t", NULL},
    [YOUNG] = {"E'", "E", "E(t)", "E_storage", "storage", "storage modulus", "relaxation modulus",
               "E1", NULL},
    [YOUNG_LOSS] = {"E''", "E_loss", "loss", "loss modulus", "E2", NULL},
    [SHEAR] = {"G'", "G", "G(t)", "G_storage", "shear storage modulus", "G1", NULL},
    [SHEAR_LOSS] = {"G''", "G_loss", "shear loss modulus", "G2", NULL},
    [TANGENT] = {"tan delta", "tan(delta)", "tan d", "tand", "tan \xCE\xB4", "tan(\xCE\xB4)",
                 "loss factor", NULL},
    [TEMPERATURE] = {"T", "temperature", "temp", "temp.", NULL}};
static const char *const DIMENSIONS[COLUMNS] = {
    "frequency", "frequency", "time", "stress", "stress", "stress", "stress", "1", NULL};
static const char WANTED[] = "wanted: f, E' and E'' (or tan_delta; G' and G''; omega), or t and E, "
                             "as in `f (Hz), E' (MPa), E'' (MPa)`";

typedef struct MaterialTable {
    CsvTable csv;
    int32_t column[COLUMNS];   // -1: there is none
    double factor[COLUMNS];   // to the scene's units
    MaterialColumn at, storage, loss;   // that are used; COLUMNS: none
} MaterialTable;

static bool read_value(const MaterialTable *table, int32_t row, MaterialColumn k, double *value,
                       Error *err)
{
    if (!csv_read_number(&table->csv, row, table->column[k], value, err)) return false;
    *value *= table->factor[k];
    return (*value > 0 && isfinite(*value)) ||
           csv_refuse(&table->csv, row, table->column[k], err,
                      "`%.40s`: a number above 0 is needed",
                      csv_cell(&table->csv, row, table->column[k]));
}

bool material_data_read(const char *path, SceneUnits units, const double *wlf, double shift,
                        MaterialData *data, Error *err)
{
    MaterialTable table = {0};
    double *at = NULL, *storage = NULL, *loss = NULL;
    *data = (MaterialData){0};
    TRY(csv_read(path, &table.csv, err));

    // Find the columns, and those of them that are used.
    const CsvTable *csv = &table.csv;
    const int32_t *has = table.column;
    CsvUnit unit[COLUMNS];
    for (int32_t k = 0; k < COLUMNS; k++)
        TRY(csv_find_any(csv, NAMES[k], &table.column[k], &unit[k], err));
    bool over_time = has[TIME] >= 0 && has[FREQUENCY] < 0 && has[ANGULAR] < 0;   // else a clock
    table.at = over_time ? TIME : has[ANGULAR] >= 0 ? ANGULAR : FREQUENCY;
    table.storage = has[SHEAR] >= 0 ? SHEAR : YOUNG;
    table.loss = over_time ? COLUMNS
                 : has[TANGENT] >= 0 && has[table.storage + 1] < 0
                     ? TANGENT
                     : (MaterialColumn)(table.storage + 1);
    if (has[YOUNG] >= 0 && has[SHEAR] >= 0)
        TRY(csv_refuse(csv, -1, has[SHEAR], err, "stands beside %s: one of them is enough",
                       csv_name(csv, has[YOUNG])));
    if (has[table.at] < 0 || has[table.storage] < 0 ||
        (table.loss < COLUMNS && has[table.loss] < 0))
        FAIL(err, ERROR_INPUT, "%s:%d: columns are missing; %s", csv->path, csv->line[0], WANTED);

    // Finds the factors to the scene's units.
    for (int32_t k = 0; k < COLUMNS; k++) {
        table.factor[k] = 1;
        if (has[k] >= 0 && DIMENSIONS[k])
            TRY(csv_to_scene(csv, has[k], unit[k], DIMENSIONS[k], units == UNITS_SI,
                             &table.factor[k], err));
    }

    // The data are over angular frequency. Hz counts cycles, and rad/s radians; with any other
    // unit, as 1/s, the name of the column decides.
    if (!over_time) {
        char text[CSV_UNIT_SIZE];
        snprintf(text, sizeof text, "%.*s", unit[table.at].length, unit[table.at].text);
        bool cycles = table.at == FREQUENCY ? !strstr(text, "rad") : strstr(text, "Hz") != NULL;
        if (cycles) table.factor[table.at] *= TWO_PI;
    }

    // Reads the rows, and shifts their times or frequencies.
    int32_t rows = csv->rows;
    if (rows < 2 || rows > RELAXATION_POINTS_MAX)
        FAIL(err, ERROR_INPUT, "%s has %d rows; allowed: 2 to %d", path, rows,
             RELAXATION_POINTS_MAX);
    TRY(at = NEW_ARRAY(double, rows, err));
    TRY(storage = NEW_ARRAY(double, rows, err));
    TRY(loss = NEW_ARRAY(double, rows, err));
    for (int32_t row = 0; row < rows; row++) {
        double longer = shift;
        TRY(read_value(&table, row, table.at, &at[row], err));
        TRY(read_value(&table, row, table.storage, &storage[row], err));
        if (table.loss < COLUMNS) TRY(read_value(&table, row, table.loss, &loss[row], err));
        if (table.loss == TANGENT) loss[row] *= storage[row];
        if (wlf) {
            double own = wlf[2];
            if (table.column[TEMPERATURE] >= 0)
                TRY(csv_read_number(&table.csv, row, table.column[TEMPERATURE], &own, err));
            longer *= wlf_shift(wlf[0], wlf[1], wlf[2], wlf[3]) /
                      wlf_shift(wlf[0], wlf[1], wlf[2], own);
            if (!(longer > 0 && isfinite(longer)))
                FAIL(err, ERROR_INPUT, "%s:%d: no shift from %g to %g degrees: c2 is %g", path,
                     table.csv.line[row + 1], own, wlf[3], wlf[1]);
        }
        at[row] *= table.loss < COLUMNS ? 1 / longer : longer;
    }
    data->shear = table.storage == SHEAR;
    data->data = (RelaxationData){.count = rows,
                                  .over_time = table.loss == COLUMNS,
                                  .at = at,
                                  .storage = storage,
                                  .loss = table.loss < COLUMNS ? loss : NULL};
    if (data->data.over_time) memory_free(loss);
    at = storage = loss = NULL;
cleanup:
    memory_free_all(at, storage, loss);
    csv_destroy(&table.csv);
    return error_is_clean(err);
}

void material_data_destroy(MaterialData *data)
{
    memory_free_all((void *)data->data.at, (void *)data->data.storage, (void *)data->data.loss);
    *data = (MaterialData){0};
}

void material_fit_at(const MaterialFit *fit, const MaterialData *data, double at, double value[2])
{
    double storage, loss = 0;
    if (data->data.over_time)
        storage = relaxation_at(&fit->shear, at);
    else
        relaxation_moduli(&fit->shear, at, &storage, &loss);
    double complex modulus = storage + I * loss;
    if (!data->shear) {   // Young's modulus of a shear modulus
        double complex G = modulus;
        double complex K = fit->bulk_relaxes ? fit->bulk * G / fit->shear.rest : fit->bulk;
        modulus = isinf(fit->bulk) ? 3 * G : 9 * K * G / (3 * K + G);
    }
    value[0] = creal(modulus);
    value[1] = cimag(modulus);
}

double material_fit_viscosity(const MaterialFit *fit, const MaterialData *data)
{
    double fastest = 0, storage, loss;
    if (data->data.over_time) return 0;
    for (int32_t i = 0; i < data->data.count; i++) fastest = fmax(fastest, data->data.at[i]);
    relaxation_moduli(&fit->shear, fastest, &storage, &loss);
    return 2 * 0.1 * loss / fastest;
}

bool material_fit(const MaterialData *data, double poisson, bool bulk_relaxes, double eta1,
                  MaterialFit *fit, Error *err)
{
    bool has_viscosity = isnan(eta1);
    RelaxationData own = data->data;
    double *moduli = NULL;
    *fit = (MaterialFit){.bulk_relaxes = bulk_relaxes};
    TRY(relaxation_fit(&own, has_viscosity, &fit->shear, err));
    if (!(fit->shear.rest > 0))
        FAIL(err, ERROR_INPUT,
             "the fit leaves no long-time modulus, as of a liquid: data at lower frequencies or "
             "longer times are needed");
    TRY(moduli = NEW_ARRAY(double, 2 * (int64_t)own.count, err));
    double *loss = moduli + own.count;
    for (int32_t i = 0; i < own.count; i++) {
        moduli[i] = own.storage[i];
        loss[i] = own.loss ? own.loss[i] : 0;
    }

    // Shear moduli of data in Young's modulus: with K constant G = 3 K E / (9 K - E), complex; with
    // Poisson's ratio constant G = E / (2 (1 + nu)).
    double young = fit->shear.rest, over_K = 3 * (1 - 2 * poisson) / young;
    for (int32_t i = 0; !data->shear && i < own.count; i++) {
        double complex E = moduli[i] + I * loss[i];
        double complex G = bulk_relaxes ? E / (2 * (1 + poisson)) : 3 * E / (9 - E * over_K);
        if (!(9 - creal(E) * over_K > 0))
            FAIL(err, ERROR_INPUT,
                 "a modulus of %g is more than an elastic volume allows for, with poisson "
                 "= %g of a long-time modulus of %g: poisson nearer to 0.5, or bulk: "
                 "relaxes",
                 creal(E), poisson, young);
        moduli[i] = creal(G);
        loss[i] = cimag(G);
    }

    // The part of a given viscosity is taken off the losses in shear.
    for (int32_t i = 0; own.loss && !has_viscosity && i < own.count; i++) {
        loss[i] -= own.at[i] * (eta1 / 2);
        if (!(loss[i] > 0))
            FAIL(err, ERROR_INPUT, "eta1 alone, %g, damps more than was measured at %g Hz",
                 2 * (eta1 / 2), own.at[i] / TWO_PI);
    }
    own.storage = moduli;
    own.loss = own.loss ? loss : NULL;
    TRY(relaxation_fit(&own, has_viscosity, &fit->shear, err));
    if (!has_viscosity) fit->shear.viscosity = eta1 / 2;
    double K_over_G = 2 * (1 + poisson) / (3 * (1 - 2 * poisson));
    fit->bulk = K_over_G * fit->shear.rest;
    fit->young = 2 * (1 + poisson) * fit->shear.rest;
    fit->eta1 = 2 * fit->shear.viscosity;
    for (int32_t k = 0; k < fit->shear.count; k++) {
        double modulus = fit->shear.modulus[k];
        fit->relaxation.branch[fit->relaxation.count++] =
            (SceneBranch){fit->shear.time[k], modulus, bulk_relaxes ? K_over_G * modulus : 0};
    }
    double sum = 0, rows = 0;
    for (int32_t i = 0; i < data->data.count; i++) {
        double found[2];
        material_fit_at(fit, data, data->data.at[i], found);
        for (int32_t d = 0; d < (data->data.loss ? 2 : 1); d++, rows++) {
            double off = fabs(found[d] / (d ? data->data.loss : data->data.storage)[i] - 1);
            sum += off * off;
            fit->worst = fmax(fit->worst, off);
        }
    }
    fit->misfit = sqrt(sum / rows);
cleanup:
    memory_free(moduli);
    return error_is_clean(err);
}

bool scene_material_file(const Scene *scene, const SceneMaterial *region, MaterialData *data,
                         MaterialFit *fit, const char **key, Error *err)
{
    const SceneNumbers *wlf = &scene->material.wlf;
    const char *path = region ? region->from : scene->material.from;
    int32_t eta1 = scene_key_index("material.eta1");
    bool found = region ? region->eta_from_file : scene->material.eta_from_file;
    bool has_eta = !found && (region ? region->given[MATERIAL_ETA1] : scene->given[eta1]);
    double own_eta = region ? region->number[MATERIAL_ETA1] : scene->material.eta1;
    double poisson = region ? scene_material_number(scene, region, MATERIAL_POISSON)
                            : scene->material.poisson;
    *data = (MaterialData){0};
    if (wlf->count != 0 && wlf->count != 4)
        return REFUSE_AT(err, key, "material.wlf", "%d numbers; wanted: [c1, c2, T_ref, T]",
                         wlf->count);
    bool done = material_data_read(path, scene->units, wlf->count > 0 ? wlf->value : NULL,
                                   scene->material.shift, data, err) &&
                material_fit(data, poisson, scene->material.bulk == BULK_RELAXES,
                             has_eta ? own_eta : (double)NAN, fit, err);
    return ERROR_AT(key, region ? "materials" : "material.from", done);
}

static const char BESIDE[] = "gives young and relaxation: leave these out beside it";

static bool is_given(const Scene *scene, const char *key)
{
    return scene->given[scene_key_index(key)];
}

// Results hold the moduli that were found, in the place of the file: they can be computed again
// without it.
bool scene_material_files(Scene *scene, const char **key, Error *err)
{
    MaterialData data;
    MaterialFit fit;
    for (int32_t k = 0; k < scene->materials.count; k++) {
        SceneMaterial *region = &scene->materials.region[k];
        const bool *given = region->given;
        if (!region->has_from) continue;
        if (given[MATERIAL_YOUNG] || region->has_relaxation)
            return REFUSE_AT(err, key, "materials", "%s: `from` %s", region->group, BESIDE);
        bool found = scene_material_file(scene, region, &data, &fit, key, err);
        material_data_destroy(&data);
        if (!found) return false;
        static const int32_t list[] = {MATERIAL_YOUNG, MATERIAL_ETA1, MATERIAL_ETA2};
        const double number[] = {fit.young, fit.eta1, 0};
        region->eta_from_file = !given[MATERIAL_ETA1];
        for (int32_t i = 0; i < 3; i++) {
            if (!given[list[i]]) region->number[list[i]] = number[i];
            region->given[list[i]] = true;
        }
        region->relaxation = fit.relaxation;
        region->has_relaxation = true;
        region->has_from = false;
    }
    if (!is_given(scene, "material.from")) return true;
    if (is_given(scene, "material.young") || is_given(scene, "material.relaxation"))
        return REFUSE_AT(err, key, "material.from", "%s", BESIDE);
    bool done = scene_material_file(scene, NULL, &data, &fit, key, err);
    material_data_destroy(&data);
    if (!done) return false;
    scene->material.young = fit.young;
    scene->material.eta_from_file = !is_given(scene, "material.eta1");
    if (scene->material.eta_from_file) scene->material.eta1 = fit.eta1;
    if (!is_given(scene, "material.eta2")) scene->material.eta2 = 0;
    scene->material.relaxation = fit.relaxation;
    static const char *const keys[] = {"material.young", "material.eta1", "material.eta2",
                                       "material.relaxation"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        scene->given[scene_key_index(keys[i])] = true;
    scene->given[scene_key_index("material.from")] = false;
    return true;
}
