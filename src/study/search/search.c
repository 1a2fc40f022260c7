// SPDX-License-Identifier: GPL-2.0-or-later
// A search that is gone on with makes the same choices from the same values: what is finished is
// found again as in every sweep.
#include "study/search/search.h"

#include "base/formula.h"
#include "base/memory.h"
#include "base/module.h"
#include "io/text/json_reader.h"
#include "scene/formulas.h"
#include "study/sweep/computing/point.h"
#include "study/sweep/reading/study.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum {
    TRIES_MAX = 1000,   // choices that limits refuse, one after the other
    REFUSALS_KEPT = 20,   // of these a chooser knows while there is no design
    KNOWN_MAX = 200,   // choices of designs that are known, one after the other: no others are left
    REFUSED_MAX = 20,   // scenes that are refused before there is any design: the study is wrong
};
// Steps of a key's range: designs that are nearer are one, as no bar tells them apart. Of no fit.
enum { LATTICE = 40 };
static const double REFUSED = 0.5;   // below the worst, in parts of what values differ by

double search_scaled(const SearchKey *key, double value)
{
    return key->scale == SEARCH_LOG ? log(value) : value;
}

double search_unscaled(const SearchKey *key, double scaled)
{
    return key->scale == SEARCH_LOG ? exp(scaled) : scaled;
}

// --- computing ----------------------------------------------------------------------------------

bool search_compute(Search *search, const int32_t *which, int32_t count, Error *err)
{
    Designs *designs = &search->designs;
    int32_t first = search->sweep->point_count;
    char *text = NULL, *report = NULL;
    Design *list = NEW_ARRAY(Design, count, err);
    TRY(list);
    if (count == 0) goto cleanup;
    for (int32_t k = 0; k < count; k++) list[k] = designs->list[which[k]];
    TRY(text = designs_text(designs, list, count, err));
    TRY(sweep_add(search->sweep, text, err));
    TRY(sweep_compute(search->sweep, err));
    for (int32_t k = 0; k < count; k++) {
        int32_t d = which[k], point = first + k * designs->conditions;
        designs->list[d].point = point;
        for (int32_t c = 0; c < designs->conditions; c++) {
            memory_free(report);
            report = point_report(search->sweep, point + c, err);
            TRY(error_is_clean(err));
            bool done = point_status(report) == POINT_DONE;
            if (!done && report && search->failed++ == 0)
                json_find_text(report, "message", search->failure, sizeof search->failure);
            TRY(search->judge.take(search, d, c, done ? report : NULL, err));
        }
        search->judge.judge(search, d);
    }
cleanup:
    memory_free_all(list, text, report);
    return error_is_clean(err);
}

bool search_compute_from(Search *search, int32_t first, Error *err)
{
    int32_t which[DESIGNS_MAX], count = 0;
    for (int32_t d = first; d < search->designs.count; d++) which[count++] = d;
    return search_compute(search, which, count, err);
}

// --- designs ------------------------------------------------------------------------------------

// A scene that two keys together make impossible is no design: it is passed over, and counted.
static bool make_scene(Search *search, const StudyCase *trial, int32_t condition, bool *allowed,
                       Error *err)
{
    Error refusal = {0};
    const Designs *designs = &search->designs;
    int32_t point = designs->texts ? 0 : condition;
    *allowed = study_scene(search->study, &(PointChoice){.point = point, .trial = trial},
                           search->scene, &refusal);
    if (*allowed) return true;
    if (refusal.code != ERROR_INPUT) {
        *err = refusal;
        return false;
    }
    if (designs->origins) error_context(&refusal, "%s", designs->origins[condition]);
    if (search->refused == 0) search->refusal = refusal;
    return true;
}

// A design is allowed if its scenes, those of `vary` or of what was measured, are accepted and keep
// all of `where`; the first comes last, as limits are checked at it.
bool search_add(Search *search, double *x, int32_t *added, Error *err)
{
    const Study *study = search->study;
    Designs *designs = &search->designs;
    Design design = {.choice = -1};
    YamlDocument *document = NULL;
    char *text = NULL;
    bool allowed = true;
    *added = -1;
    designs_round(study, x);
    if (designs->count == DESIGNS_MAX || designs_find(designs, x) >= 0) return true;
    memcpy(design.x, x, sizeof design.x);
    TRY(text = designs_text(designs, &design, 1, err));
    TRY(yaml_parse("a design of the search", text, 0, &document, err));
    StudyCase trial = {document, yaml_first(document, YAML_ROOT)}, first = trial;
    for (int32_t c = 1; c < designs->conditions && allowed; c++) {
        if (designs->texts) trial.map = yaml_next(document, trial.map);
        TRY(make_scene(search, &trial, c, &allowed, err));
    }
    if (allowed) TRY(make_scene(search, &first, 0, &allowed, err));
    search->refused += !allowed;

    for (int32_t k = 0; k < study->search.limit_count && allowed; k++) {
        const SearchLimit *limit = &study->search.limits[k];
        double value = 0;
        const char *formula = strchr(yaml_text(study->file, limit->formula), '=') + 1;
        if (!formula_value(formula, scene_number, search->scene, &value, err)) {
            error_context(err, "%s:%d: where", study->path, yaml_line(study->file, limit->formula));
            goto cleanup;
        }
        allowed = value >= limit->least && value <= limit->most;
    }
    if (allowed) *added = designs_add(designs, x, -1);
cleanup:
    yaml_destroy(document);
    memory_free(text);
    return error_is_clean(err);
}

// Value as the chooser is told it. Misfits are on a logarithmic scale, as they differ by powers of
// ten.
static double on_scale(const Search *search, double value)
{
    return search->study->search.fits ? log1p(value) : value;
}

// Value that the chooser is told for a design; design: -1 if it was refused. A design that is
// refused, has no result, or has a bar nearly as large as its value counts as below the worst.
static double told_of(const Search *search, int32_t design)
{
    double sure = NAN, low = INFINITY, high = -INFINITY, sign = search->designs.lowest ? -1 : 1;
    for (int32_t d = 0; d < search->designs.count; d++) {
        double value = search->designs.list[d].value;
        if (isnan(value)) continue;
        low = fmin(low, sign * on_scale(search, value));
        high = fmax(high, sign * on_scale(search, value));
    }
    double below_the_worst = low <= high ? low - REFUSED * (high - low) : 0;
    if (design >= 0) sure = design_sure(&search->designs, &search->designs.list[design]);
    return fmax(sign * on_scale(search, sure), below_the_worst);
}

static bool tell(Search *search, int32_t choice, int32_t design, Error *err)
{
    return search->module->tell(search->chooser, choice, told_of(search, design), err);
}

// Opens a chooser that knows the designs so far.
static bool open_chooser(Search *search, uint32_t seed, Error *err)
{
    const StudySearch *keys = &search->study->search;
    int32_t n = keys->key_count, count = search->designs.count;
    double least[STUDY_SEARCH_MAX], most[STUDY_SEARCH_MAX];
    bool whole[STUDY_SEARCH_MAX];
    double *places = NEW_ARRAY(double, (int64_t)count *(n + 1) + 1, err), *values = NULL;
    TRY(places);
    values = places + (int64_t)count * n;
    for (int32_t k = 0; k < n; k++) {
        least[k] = search_scaled(&keys->keys[k], keys->keys[k].least);
        most[k] = search_scaled(&keys->keys[k], keys->keys[k].most);
        whole[k] = keys->keys[k].scale == SEARCH_WHOLE;
    }
    for (int32_t d = 0; d < count; d++) {
        const Design *one = &search->designs.list[d];
        for (int32_t k = 0; k < n; k++)
            places[d * n + k] = search_scaled(&keys->keys[k], one->x[k]);
        values[d] = told_of(search, d);
    }
    ChooserSpace space = {n, least, most, whole, seed, count, places, values};
    ChooserModuleFunction module =
        (ChooserModuleFunction)module_function("dlib", "amontons_chooser_module", err);
    TRY(module);
    search->module = module();
    search->module->destroy(search->chooser);
    TRY(search->chooser = search->module->create(&space, err));
cleanup:
    memory_free(places);
    return error_is_clean(err);
}

// The next design that is allowed and new. *added: there is one.
static bool choose(Search *search, bool *added, Error *err)
{
    const StudySearch *keys = &search->study->search;
    int32_t design = -1, repeated = 0;
    for (int32_t k = 0; k < TRIES_MAX && repeated < KNOWN_MAX && design < 0; k++) {
        if (search->designs.count == 0 && search->refused >= REFUSED_MAX) {
            *err = search->refusal;
            return false;
        }
        // Refusals alone teach nothing, and each of them makes the next choice dearer.
        if (search->designs.count == 0 && k > 0 && k % REFUSALS_KEPT == 0)
            TRY(open_chooser(search, keys->seed + (uint32_t)k, err));
        double x[STUDY_SEARCH_MAX] = {0};
        int32_t number = 0;
        TRY(search->module->choose(search->chooser, x, &number, err));
        for (int32_t i = 0; i < keys->key_count; i++) {
            const SearchKey *key = &keys->keys[i];
            double least = search_scaled(key, key->least), most = search_scaled(key, key->most);
            double step = (most - least) / LATTICE;
            if (key->scale != SEARCH_WHOLE && !keys->fits)
                x[i] = least + step * round((x[i] - least) / step);
            x[i] = search_unscaled(key, x[i]);
        }
        TRY(search_add(search, x, &design, err));
        int32_t known = design < 0 ? designs_find(&search->designs, x) : design;
        if (design < 0 && known >= 0) repeated++;
        if (design >= 0)
            search->designs.list[design].choice = number;
        else
            TRY(tell(search, number, known, err));
    }
    *added = design >= 0;
    search->exhausted = search->exhausted || !*added;
    if (search->designs.count == 0)
        FAIL(
            err, ERROR_INPUT,
            "%s: none of %d designs within the ranges of `search` is within all limits of `where`: "
            "widen one or the other",
            search->study->path, TRIES_MAX);
cleanup:
    return error_is_clean(err);
}

bool search_designs(Search *search, int32_t count, Error *err)
{
    const StudySearch *keys = &search->study->search;
    bool added = true;
    if (!open_chooser(search, keys->seed, err)) return false;

    // The start: the scene with `set`, at the first point of `vary`, if all that is searched has a
    // value there within its range. One that lacks what a formula takes from a searched key is
    // none.
    if (search->designs.count == 0) {
        double x[STUDY_SEARCH_MAX] = {0};
        Error ignored = {0};
        bool within =
            study_scene(search->study, &(PointChoice){.point = 0}, search->scene, &ignored);
        for (int32_t k = 0; k < keys->key_count && within; k++) {
            char words[SCENE_TEXT_SIZE];
            study_scene_value(search->scene, keys->keys[k].key, words, sizeof words, &x[k]);
            within = x[k] >= keys->keys[k].least && x[k] <= keys->keys[k].most;
        }
        if (within && !search_add(search, x, &search->start, err)) return false;
    }
    if (search->designs.count == 1 && !search_compute_from(search, 0, err)) return false;

    for (int32_t chosen = 0; chosen < count && added;) {
        int32_t first = search->designs.count;
        for (int32_t k = 0; k < search->side_by_side && chosen < count && added; k++) {
            if (!choose(search, &added, err)) return false;
            chosen += added;
        }
        if (!search_compute_from(search, first, err)) return false;
        for (int32_t d = first; d < search->designs.count; d++)
            if (!tell(search, search->designs.list[d].choice, d, err)) return false;
    }
    return true;
}

// --- begin and end ------------------------------------------------------------------------------

bool search_open(Search *search, const char *path, const SweepOptions *options, bool fits,
                 Error *err)
{
    search->options = options;
    search->start = -1;
    if (!sweep_open(path, options, &search->sweep, err)) return false;
    search->study = &search->sweep->study;
    if (search->study->search.node == YAML_NO_NODE)
        return REFUSE(err,
                      "%s: nothing to search: a study for `%s` has `search`, as in `search: {%s}}`",
                      path, fits ? "fit" : "optimise",
                      fits ? "material.eta1: {log: [0.1, 10]" : "mesh.set.n: {whole: [1, 12]");
    if (search->study->search.fits != fits)
        return REFUSE(err, "%s: %s", path,
                      fits ? "what was measured? say `fit: {measured: measured.csv}`"
                           : "a study with `fit` is for `amontons fit`");
    return true;
}

bool search_begin(Search *search, int32_t conditions, char *const *texts, Error *err)
{
    const SweepOptions *options = search->options;
    if (!(search->scene = NEW_ARRAY(Scene, 1, err))) return false;
    if (!designs_create(search->study, conditions, texts, &search->designs, err)) return false;
    int64_t cores = options->jobs > 0 ? options->jobs : sysconf(_SC_NPROCESSORS_ONLN);
    search->side_by_side = (int32_t)fmax(1, floor((double)cores / search->designs.conditions));
    search->sweep->planned = search->designs.conditions * search->study->search.designs;
    return true;
}

void search_close(Search *search, Error *err)
{
    Error ignored = {0};
    bool whole = error_is_clean(err), stopped = err->code == ERROR_INTERRUPT;
    if (search->sweep && search->sweep->lock.held) {
        sweep_share_results(search->sweep);
        if (whole || stopped) sweep_show(search->sweep, NULL, whole, whole ? err : &ignored);
    }
    if (search->module) search->module->destroy(search->chooser);
    designs_destroy(&search->designs);
    memory_free(search->scene);
    sweep_close(search->sweep);
}
