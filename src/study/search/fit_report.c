// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/fit_report.h"

#include "algebra/dense.h"
#include "io/text/csv_writer.h"
#include "study/search/fit_figures.h"
#include "study/search/search_answer.h"

#include <math.h>
#include <stdio.h>

enum { WORST_SHOWN = 3 };
static const double OFF = 2;   // errors, from which on a measurement is said not to fit
static const double HARDLY = 0.5;   // of ln of a combination of keys: known to no more than that

static const char *key_name(const Fit *fit, int32_t k)
{
    return fit->search.study->search.keys[k].key;
}

// --- which combinations are known ---------------------------------------------------------------

// d ln key / d scaled, at the best; 0: the key is not above 0 there.
static double log_slope(const Fit *fit, int32_t k)
{
    const SearchKey *key = &fit->search.study->search.keys[k];
    double at = fit_unscaled(fit, k, fit->best[k]);
    if (key->scale == SEARCH_LOG) return log(key->most / key->least);
    return at > 0 ? (key->most - key->least) / at : 0;
}

// "material.eta1 * friction.critical_velocity^-0.94": parts below a twentieth are left out.
static void print_product(const Fit *fit, const double *powers, FILE *out)
{
    int32_t n = fit->response.keys, shown = 0;
    for (int32_t k = 0; k < n; k++) {
        double power = round(100 * powers[k]) / 100;
        if (fabs(power) < 0.05) continue;
        fprintf(out, "%s%s", shown++ ? " * " : "", key_name(fit, k));
        if (power != 1) fprintf(out, "^%.2g", power);
    }
}

// Products of powers of the keys, by how well they are known: eigenvectors of the curvature in
// logarithms.
static void print_combinations(const Fit *fit, FILE *out)
{
    int32_t n = fit->response.keys;
    double matrix[STUDY_SEARCH_MAX * STUDY_SEARCH_MAX], values[STUDY_SEARCH_MAX];
    double work[DENSE_EIGEN_WORK(STUDY_SEARCH_MAX)];
    if (n < 2) return;
    response_curvature(&fit->response, fit->best, matrix);
    for (int32_t i = 0; i < n; i++)
        for (int32_t k = 0; k < n; k++) {
            if (log_slope(fit, k) == 0) return;
            matrix[i * n + k] /= log_slope(fit, i) * log_slope(fit, k);
        }
    if (!dense_eigen(matrix, n, values, work)) return;
    for (int32_t k = n - 1; k >= 0; k--) {
        double *vector = &matrix[k * n], largest = 0;
        for (int32_t i = 0; i < n; i++)
            if (fabs(vector[i]) > fabs(largest)) largest = vector[i];
        double error = sqrt(fit_threshold(fit, 1) / fmax(values[k], 0)) / fabs(largest);
        for (int32_t i = 0; i < n; i++) vector[i] /= largest;
        fprintf(out, k == n - 1 ? "  the data know " : k > 0 ? ", " : " and ");
        print_product(fit, vector, out);
        fprintf(out, " ");
        if (error < HARDLY)
            fprintf(out, "to %.2g %%", 100 * error);
        else
            fprintf(out, error < 10 ? "to a factor of %.2g" : "not at all", exp(error));
        if (k == 0 && error >= HARDLY) fprintf(out, ": they do not tell these apart");
    }
    fprintf(out, "\n");
}

// --- words --------------------------------------------------------------------------------------

// The worst first.
static void print_worst(const Fit *fit, FILE *out)
{
    double before = INFINITY;
    int32_t count = 0, off = 0;
    for (int32_t k = 0; k < fit->measured.count; k++) off += fabs(fit_errors_off(fit, k)) > OFF;
    fprintf(
        out,
        "  %d of %d measurements are off by more than %g errors (1 in 20 is to be expected)%s\n",
        off, fit->measured.count, OFF, off ? ":" : "");
    while (count < WORST_SHOWN) {
        int32_t worst = -1;
        for (int32_t k = 0; k < fit->measured.count; k++) {
            double by = fabs(fit_errors_off(fit, k));
            if (by < before && by > OFF && (worst < 0 || by > fabs(fit_errors_off(fit, worst))))
                worst = k;
        }
        if (worst < 0) break;
        const Datum *datum = &fit->measured.list[worst];
        const char *condition = fit->measured.conditions[datum->condition];
        fprintf(out, "    %s%s%s", condition, *condition ? ": " : "", datum->name);
        if (*datum->along) fprintf(out, " at %s = %.4g", datum->along, datum->at);
        fprintf(out, " measured %.4g +- %.2g, found %.4g: off by %.1f errors\n", datum->value,
                datum->error, response_at(&fit->response, worst, fit->best),
                fabs(fit_errors_off(fit, worst)));
        before = fabs(fit_errors_off(fit, worst));
        count++;
    }
}

static void print_parameter(const Fit *fit, const FitParameter *parameter, FILE *out)
{
    double share = 100 * fit->search.study->search.sure;
    bool none = parameter->low_open && parameter->high_open;
    fprintf(out, "  %s: ", parameter->key);
    if (none) {
        fprintf(out, "anything from %.4g to %.4g fits\n", parameter->low, parameter->high);
        return;
    }
    fprintf(out, "%.4g, %.0f %% from %.4g to %.4g%s\n", parameter->value, share, parameter->low,
            parameter->high,
            parameter->low_open || parameter->high_open ? ", an end of the range: it may be beyond"
                                                        : "");
}

static void print_answer(const Fit *fit, const FitSummary *summary, FILE *out)
{
    int32_t freedom = fit_freedom(fit), best = designs_best(&fit->search.designs);
    char words[OPTIMISE_WORDS_SIZE];
    fprintf(out, "%d measurements, %d keys, %d designs: misfit %.4g", summary->measurements,
            summary->parameter_count, summary->designs, summary->misfit);
    if (freedom > 0)
        fprintf(out, " (%d +- %.1f where scene and errors are right)", freedom,
                sqrt(2.0 * freedom));
    fprintf(out, "\n");
    for (int32_t k = 0; k < summary->parameter_count; k++)
        print_parameter(fit, &summary->parameters[k], out);
    print_combinations(fit, out);
    print_worst(fit, out);
    if (summary->widened > 1)
        fprintf(out, "  regions are %.2g times as wide as the errors make them, as the misfit is\n",
                summary->widened);
    fprintf(out, "  %.2g %% of the errors' squares are the program's own%s\n",
            100 * summary->own_share,
            summary->own_share > 0.2 ? "; a smaller accuracy.mu makes regions smaller" : "");
    search_print_exhausted(&fit->search, out);
    if (fit->search.refused > 0)
        fprintf(out, "  %d more designs have no scene, the first: %s\n", fit->search.refused,
                fit->search.refusal.message);
    if (fit->search.designs.count > summary->designs)
        fprintf(out,
                "  %d more designs failed or lack what was measured, and do not count; --retry "
                "computes failed points again\n",
                fit->search.designs.count - summary->designs);
    design_words(fit->search.study, &fit->search.designs.list[best], words);
    fprintf(out, "  nearest design: %s; its first run again: amontons run %s/best.yaml -o fitted\n",
            words, fit->search.options->folder);
}

// --- fit.csv ------------------------------------------------------------------------------------

static bool write_table(const Fit *fit, Error *err)
{
    static const char *const names[] = {"condition", "name",  "along",     "at", "measured",
                                        "error",     "found", "own_error", "off"};
    char path[POINT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/fit.csv", fit->search.options->folder);
    CsvWriter *csv = csv_create(path, err);
    if (!csv) return false;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) csv_text(csv, names[k]);
    csv_end_row(csv);
    for (int32_t k = 0; k < fit->measured.count; k++) {
        const Datum *datum = &fit->measured.list[k];
        csv_text(csv, fit->measured.conditions[datum->condition]);
        csv_text(csv, datum->name);
        csv_text(csv, datum->along);
        csv_number(csv, *datum->along ? datum->at : (double)NAN);
        csv_number(csv, datum->value);
        csv_number(csv, datum->error);
        csv_number(csv, response_at(&fit->response, k, fit->best));
        csv_number(csv, fit->response.own[k]);
        csv_number(csv, fit_errors_off(fit, k));
        csv_end_row(csv);
    }
    return csv_finish(csv, err);
}

bool fit_report(const Fit *fit, const FitSummary *summary, Error *err)
{
    SearchAnswer answer;
    if (!search_answer_begin(&answer, err)) return false;
    print_answer(fit, summary, answer.out);
    return search_answer_end(&fit->search, &answer, err) && write_table(fit, err) &&
           fit_figures(fit, err) &&
           search_leave_best(&fit->search, designs_best(&fit->search.designs), 0, err);
}
