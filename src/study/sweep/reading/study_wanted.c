// SPDX-License-Identifier: GPL-2.0-or-later
// Reads what a study wants of its points: `record`, `rank` and `plot`. A quantity that is drawn or
// ranked by becomes a column of the table if it is none yet.
#include "study/sweep/reading/study.h"

#include "base/formula.h"
#include "base/text.h"
#include "scene/keys.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { TOP_STANDARD = 10, TOP_MAX = 1000 };

// Results that a study may name by one word, and those that it records by default.
static const struct {
    const char *name, *path;   // in `record`; in run.json
    bool standard;
} KNOWN_RECORDS[] = {
    {"mu_M", "results.mu_M", true},   // macroscopic static friction coefficient
    {"mu_M_error", "results.mu_M_error", false},   // its error
    {"spread", "results.mu_M_spread", true},   // largest minus smallest of the peaks in mu_M
    {"period", "results.period", true},   // peaks repeat after so many slidings; 0: not
    {"low", "results.mu_M_low", true},   // lowest of the peaks in mu_M
    {"high", "results.mu_M_high", true},   // highest of them
    {"peaks", "results.mu_M_peaks", true},   // how many they are
    {"l_c", "results.l_c_over_L", true},   // critical length over L, from the dynamics
    {"l_sc", "results.l_sc_over_L", true},   // front over L where the certificate is lost
    {"slip_cells", "results.slip_cells", false},   // cells that slipped where slow slip turned fast
    {"steps", "steps.accepted", true},   // steps accepted
    {"unsolved", "steps.unsolved_retries", true},   // steps undone, the contact without solution
    {"solve_s", "timing_s.solve", true},   // time in the loop of steps, s
    {"total_s", "timing_s.total", true},   // wall time of the point, s
    {"energy_error", "errors.energy", true},   // energy ledger, relative
    {"contact_error", "errors.complementarity", true},   // contact conditions, relative
    {"moment_error", "errors.moment", true},   // balance of moments, relative
    {"reduction_error", "errors.reduction", true},   // reduced bulk against the full one
    {"mu_max", "results.mu_max", true},   // largest mu of the whole run
    {"F_N", "results.F_N", false},   // normal force of the whole block
    {"F_T_M", "results.F_T_M", false},   // force of the rod at mu_M, of the whole block
    {"F_T_hold", "results.F_T_hold", false},   // that at mu_hold
    {"mu_hold", "results.mu_hold", true},   // holding coefficient
    {"mu_hold_error", "results.mu_hold_error", false},   // its error
    {"mu_drops", "results.drops.mean", false},   // mean of the load drops
    {"mu_drops_error", "results.drops.mean_error", false},   // error of that mean
    {"drops", "results.drops.counted", false},   // load drops in mu_hold
    {"drops_period", "results.drops.period", false},   // they repeat after so many; 0: not
    {"drops_enough", "results.drops.enough", false},   // 1: they repeat, or mean known to 2 %
    {"run_in_over", "results.run_in.over", false},   // 1: the whole contact has come to a regime
    {"mu_steady", "results.mu_steady", false},   // mu at which the block slides at the end
    {"mu_first_pad", "results.mu_first_pad", false},   // lowest mu at which a whole pad slides
    {"first_mu", "results.peaks.0.mu", false},   // first peak, from the start state
    {"contact_nodes", "model.contact_nodes", false},   // nodes on the interface
    {"reduced_dofs", "model.reduced_dofs", false},   // unknowns stepped; 0: the full mesh
};
enum { KNOWN_RECORD_COUNT = sizeof KNOWN_RECORDS / sizeof KNOWN_RECORDS[0] };

// --- what is recorded ---------------------------------------------------------------------------

static void add_record(Study *study, const char *name, const char *path, const char *given_by,
                       YamlNode node)
{
    StudyRecord *record = &study->records[study->record_count++];
    *record = (StudyRecord){.given_by = given_by, .node = node};
    snprintf(record->name, sizeof record->name, "%s", name);
    snprintf(record->path, sizeof record->path, "%s", path);
}

// The column of `name`, which stands at `node` under the key `what` (static storage): a name of
// KNOWN_RECORDS or a path in run.json. What no column holds yet gets one.
static bool find_record(Study *study, const char *name, const char *what, YamlNode node,
                        int32_t *column, Error *err)
{
    const char *names[KNOWN_RECORD_COUNT];
    char hint[TEXT_HINT_SIZE];
    const char *path = strchr(name, '.') && strlen(name) < STUDY_NAME_SIZE ? name : NULL;
    for (*column = 0; *column < study->record_count; ++*column)
        if (strcmp(name, study->records[*column].name) == 0) return true;
    for (int32_t k = 0; k < KNOWN_RECORD_COUNT; k++) {
        names[k] = KNOWN_RECORDS[k].name;
        if (strcmp(name, names[k]) == 0) path = KNOWN_RECORDS[k].path;
    }
    if (path && study->record_count == STUDY_RECORDS_MAX)
        return yaml_error(study->file, node, err, "%s: more than %d columns", what,
                          STUDY_RECORDS_MAX);
    if (path) {
        add_record(study, name, path, what, node);
        return true;
    }
    return yaml_error(
        study->file, node, err, "%s: unknown name `%.60s`%s", what, name,
        text_hint(name, names, KNOWN_RECORD_COUNT,
                  "; allowed: a name that `amontons sweep --help` lists, or a path in "
                  "run.json, as in results.mu_max",
                  hint));
}

const char *study_record_path(const char *name)
{
    for (int32_t k = 0; k < KNOWN_RECORD_COUNT; k++)
        if (strcmp(name, KNOWN_RECORDS[k].name) == 0) return KNOWN_RECORDS[k].path;
    return strncmp(name, "results.", 8) == 0 ? name : NULL;
}

// --- rank ---------------------------------------------------------------------------------------

// The quantity that is ranked by becomes a column of the table if it is none yet.
static bool read_rank(Study *study, Error *err)
{
    static const char *const orders[] = {"highest", "lowest"};
    static const char *const baselines[] = {"first", "best"};
    enum { BY, ORDER, TOP, AGAINST, REFINE, ALSO, RANK_KEYS };
    WantedKey keys[RANK_KEYS] = {{.name = "by"},      {.name = "order"},  {.name = "top"},
                                 {.name = "against"}, {.name = "refine"}, {.name = "also"}};
    const YamlDocument *file = study->file;
    StudyRank *rank = &study->rank;
    int32_t order = 0, choice = 0;
    YamlNode map = yaml_look_up(file, "rank");
    if (map == YAML_NO_NODE) return true;
    if (!wanted_find(file, map, "rank", keys, RANK_KEYS, err)) return false;
    YamlNode by = keys[BY].node, against = keys[AGAINST].node, refine = keys[REFINE].node;
    YamlNode also = keys[ALSO].node;
    if (by == YAML_NO_NODE)
        return yaml_error(file, map, err, "rank: `by` must be given, as in {by: mu_M}");
    if (!find_record(study, yaml_text(file, by), "by", by, &rank->record, err)) return false;
    study->records[rank->record].is_shown = true;
    if (!wanted_choice(file, &keys[ORDER], orders, 2, &order, err)) return false;

    // against: first, best, or the keys that make a point its own baseline.
    rank->baseline = YAML_NO_NODE;
    if (against == YAML_NO_NODE || yaml_kind(file, against) == YAML_SCALAR) {
        if (!wanted_choice(file, &keys[AGAINST], baselines, 2, &choice, err)) return false;
        rank->against = choice ? AGAINST_BEST : AGAINST_FIRST;
    } else {
        if (yaml_kind(file, against) != YAML_MAP)
            return yaml_refuse(file, against, "against",
                               "first, best, or a map of varied keys, as in {mesh.set.n: 1}", err);
        rank->against = AGAINST_KEYS;
        rank->baseline = against;
        YAML_EACH (item, file, against) {
            if (study_find_given(study, study->chosen, yaml_key(file, item), file, item)) continue;
            return yaml_key_error(file, item, err,
                                  "against: neither `vary` nor `cases` has the key `%.60s`",
                                  yaml_key(file, item));
        }
    }

    // refine: a share such as 0.005 or 0.5%. Designs that are computed again differ in accuracy.mu:
    // a column.
    if (refine != YAML_NO_NODE) {
        const char *text = yaml_text(file, refine);
        int32_t length = text_number(text, &rank->refine);
        bool percent = length > 0 && strcmp(text + length, "%") == 0;
        if (percent) rank->refine /= 100;
        if (length == 0 || (text[length] && !percent) || !(rank->refine > 0 && rank->refine < 1))
            return yaml_refuse(file, refine, "refine",
                               "the smallest error bar worth computing, as in 0.5%", err);
        if (study_add_column(study, "accuracy.mu", err) < 0) return false;
    }

    // also: further aims, {mu_first_pad: highest, scene.mesh.set.pad_height: lowest}.
    if (also != YAML_NO_NODE) {
        if (study->search.node == YAML_NO_NODE || study->search.over != OVER_FRONT)
            return yaml_error(file, also, err, "also: only of a search with `over: front`");
        if (yaml_kind(file, also) != YAML_MAP || yaml_count(file, also) > STUDY_ALSO_MAX)
            return yaml_refuse(file, also, "also",
                               "at most 3 results, as in {mu_first_pad: highest}", err);
        YAML_EACH (item, file, also) {
            StudyAim *aim = &rank->also[rank->also_count++];
            WantedKey key = {yaml_key(file, item), item};
            if (!wanted_choice(file, &key, orders, 2, &choice, err)) return false;
            if (!find_record(study, key.name, "also", item, &aim->record, err)) return false;
            study->records[aim->record].is_shown = true;
            aim->lowest = choice == 1;
        }
        if (!error_is_clean(err)) return false;
    }
    rank->wanted = true;
    rank->lowest = order == 1;
    rank->top = TOP_STANDARD;
    return study_whole(study, &keys[TOP], TOP_MAX, &rank->top, err);
}

// --- plots --------------------------------------------------------------------------------------

enum { WORD_LOG = PLOT_KEYS, WORD_NAME, WORD_WITH, WORD_COMPARE, PLOT_WORDS };

static const char *const PLOT_NAMES[PLOT_WORDS] = {"x",      "y",   "color", "contours", "series",
                                                   "panels", "log", "name",  "with",     "compare"};

const char *plot_key_name(PlotKey key)
{
    return PLOT_NAMES[key];
}

// text: [size], kept where the key is missing.
static bool read_plot_text(const YamlDocument *file, const WantedKey *key, char *text, size_t size,
                           Error *err)
{
    if (key->node == YAML_NO_NODE) return true;
    const char *given = yaml_text(file, key->node);
    if (!*given || strlen(given) >= size)
        return yaml_refuse(file, key->node, key->name, "a name or a formula, not too long", err);
    memcpy(text, given, strlen(given) + 1);
    return true;
}

bool plot_read(const YamlDocument *file, YamlNode map, StudyPlot *plot, Error *err)
{
    static const char *const logs[] = {"none", "x", "y", "both"};
    WantedKey keys[PLOT_WORDS];
    int32_t log = 0;
    *plot = (StudyPlot){0};
    for (int32_t k = 0; k < PLOT_WORDS; k++) keys[k] = (WantedKey){.name = PLOT_NAMES[k]};
    if (!wanted_find(file, map, "plot", keys, PLOT_WORDS, err)) return false;
    if (keys[WORD_WITH].node != YAML_NO_NODE)
        return yaml_error(file, keys[WORD_WITH].node, err,
                          "plot: `with` is gone: one study with the key in which the sweeps differ "
                          "in `vary`, and as `series` of its plot, draws them in one frame");
    for (int32_t k = 0; k < PLOT_KEYS; k++) {
        plot->node[k] = keys[k].node;
        if (!read_plot_text(file, &keys[k], plot->text[k], PLOT_TEXT_SIZE, err)) return false;
    }
    if (!wanted_choice(file, &keys[WORD_LOG], logs, 4, &log, err)) return false;
    plot->log_given = keys[WORD_LOG].node != YAML_NO_NODE;
    plot->log_x = log == 1 || log == 3;
    plot->log_y = log == 2 || log == 3;

    // The name becomes that of a file.
    bool is_map = plot->text[PLOT_COLOR][0], good = true;
    snprintf(plot->name, sizeof plot->name, "%s", is_map ? "map" : "plot");
    if (!read_plot_text(file, &keys[WORD_NAME], plot->name, sizeof plot->name, err)) return false;
    for (const char *at = plot->name; *at; at++)
        good = good && (isalnum((unsigned char)*at) || *at == '-' || *at == '_');
    if (!good || strcmp(plot->name, "ranking") == 0)
        return yaml_refuse(file, keys[WORD_NAME].node, "name",
                           "a name of letters, digits, - and _, but not `ranking`", err);

    if (!read_plot_text(file, &keys[WORD_COMPARE], plot->compare, PLOT_FOLDER_SIZE, err))
        return false;

    // Keys that must fit together.
    for (PlotKey key = PLOT_X; key <= PLOT_Y; key++) {
        if (plot->text[key][0]) continue;
        return yaml_error(file, map, err,
                          "plot: `%s` must be given, as in {x: load.pressure, y: mu_M}",
                          PLOT_NAMES[key]);
    }
    if (is_map && plot->text[PLOT_SERIES][0])
        yaml_error(file, plot->node[PLOT_SERIES], err,
                   "series: a map has none; `panels` draws one for each value of a key");
    if (!is_map && plot->text[PLOT_CONTOURS][0])
        yaml_error(file, plot->node[PLOT_CONTOURS], err,
                   "contours: only a map has them, which needs `color`");
    if (is_map && plot->compare[0])
        yaml_error(file, map, err, "compare: measurements are drawn over curves, not over a map");
    return error_is_clean(err);
}

// A quantity of a plot, whose formula may name several columns.
typedef struct QuantityRead {
    Study *study;
    const char *what;   // the key it stands under
    YamlNode node;
    bool is_shown;
    Error *err;
} QuantityRead;

// A key that varies, or what is recorded. As FormulaLookUp: false, with the error set: neither.
static bool find_quantity(const void *context, const char *name, double *ignored)
{
    const QuantityRead *read = context;
    Study *study = read->study;
    int32_t column = 0;
    const char *part;
    *ignored = 1;
    if (study_column(study, name) >= 0) return true;
    if (scene_key_index(name) >= 0 || scene_key_above(name, &part) >= 0)
        return yaml_error(study->file, read->node, read->err, "%s: `%.60s` does not vary",
                          read->what, name);
    if (!find_record(study, name, read->what, read->node, &column, read->err)) return false;
    study->records[column].is_shown |= read->is_shown;
    return true;
}

// Each quantity that is drawn becomes a column of the table if it is none yet.
static bool read_plot(Study *study, YamlNode node, Error *err)
{
    if (study->plot_count == STUDY_PLOTS_MAX)
        return yaml_refuse(study->file, node, "plot", "at most 8 plots", err);
    StudyPlot *plot = &study->plots[study->plot_count];
    if (!plot_read(study->file, node, plot, err)) return false;
    for (PlotKey key = PLOT_X; key < PLOT_SERIES; key++) {
        QuantityRead read = {study, PLOT_NAMES[key], plot->node[key], key != PLOT_CONTOURS, err};
        FormulaNames names = {
            .look_up = find_quantity, .context = &read, .unknown = "is no column"};
        const char *text = plot->text[key], *equals = strchr(text, '=');
        Formula formula;
        Error found = {0};
        double ignored = 0;
        if (!equals && text[0] && !find_quantity(&read, text, &ignored)) return false;
        if (!equals || formula_read(equals + 1, &names, &formula, &found)) continue;
        return error_is_clean(err) &&   // else it was a name
               yaml_error(study->file, plot->node[key], err, "%s: %.200s", PLOT_NAMES[key],
                          found.message);
    }
    for (PlotKey key = PLOT_SERIES; key < PLOT_KEYS; key++)
        if (plot->text[key][0] && study_column(study, plot->text[key]) < 0)
            return yaml_refuse(study->file, plot->node[key], PLOT_NAMES[key], "a key that varies",
                               err);
    for (int32_t k = 0; k < study->plot_count; k++)
        if (strcmp(study->plots[k].name, plot->name) == 0)
            return yaml_refuse(study->file, node, "plot",
                               "a `name` that no other plot of the study has", err);
    study->plot_count++;
    return error_is_clean(err);
}

bool study_read_wanted(Study *study, Error *err)
{
    static const char *const always[] = {"status", "message", "warnings",
                                         "run"};   // columns of every table

    // Columns: the standard ones of KNOWN_RECORDS, or those of `record`.
    YamlNode list = yaml_look_up(study->file, "record");
    if (list == YAML_NO_NODE) {
        for (int32_t k = 0; k < KNOWN_RECORD_COUNT; k++)
            if (KNOWN_RECORDS[k].standard)
                add_record(study, KNOWN_RECORDS[k].name, KNOWN_RECORDS[k].path, "", YAML_NO_NODE);
    } else {
        int32_t ignored = 0, count = yaml_count(study->file, list);
        if (yaml_kind(study->file, list) != YAML_LIST || count == 0 || count > STUDY_RECORDS_MAX)
            return yaml_refuse(study->file, list, "record", "a list of at most 64 names", err);
        YAML_EACH (item, study->file, list) {
            const char *name = yaml_text(study->file, item);
            bool is_there = false;
            for (size_t k = 0; name && k < sizeof always / sizeof *always; k++)
                is_there = is_there || strcmp(name, always[k]) == 0;
            if (!is_there && !find_record(study, name, "record", item, &ignored, err)) return false;
        }
    }
    if (!read_rank(study, err)) return false;

    YamlNode plots = yaml_look_up(study->file, "plot");   // one, or a list of them
    if (plots == YAML_NO_NODE) return true;
    if (yaml_kind(study->file, plots) != YAML_LIST) return read_plot(study, plots, err);
    YAML_EACH (node, study->file, plots)
        if (!read_plot(study, node, err)) return false;
    return error_is_clean(err);
}
