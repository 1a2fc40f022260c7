// SPDX-License-Identifier: GPL-2.0-or-later
// A study: one base scene and how it is varied. Read from a YAML file; the points it stands for are
// scenes, each made on demand (study_point). study_read reads it, with study_wanted for results.
//
//     title: mu_M against pressure
//     scene: fig1.yaml                          # relative to the study's folder
//     set: {mesh.set.nx: 40, mesh.set.height: = 0.5 * mesh.set.length}
//     cases: [{rod.kind: push}, {rod.kind: bonded}]
//     vary:                                     # the full product, the last key fastest
//       mesh.set.length: [0.25, 1, 4]
//       load.pressure: {log: [1e-4, 1e-2], points: 7}
//     keep: table                               # of points nothing but their numbers
//     record: [mu_M, period, results.mu_max]
//     rank: {by: mu_M, order: highest, top: 10, against: {rod.kind: push}}
//     plot: {x: load.pressure, y: mu_M, series: mesh.set.length, log: x}   # or a list of plots
//
// One that searches (study/search) has `search`, and `where` and `best` where they are wanted, in
// place of `cases`: designs, each computed at all points of `vary`.
//
//     search: {mesh.set.n: {whole: [1, 12]}, mesh.set.pad_height: {log: [0.01, 0.2]}}
//     where: [{value: = mesh.set.n * mesh.set.pad_height, most: 0.6}]
//     best: {over: worst, designs: 40, seed: 1}   # or mean, deviation, front
//
// Or it fits measurements (study/search/fit):
//
//     fit: {measured: measured.csv, sure: 95%, designs: 40, seed: 1}
//
// A plot, also that of `amontons render --plot`, has quantities that are columns of the sweep's
// table, or formulas over columns that begin with `=`:
//
//     {x: load.pressure, y: mu_M, series: mesh.set.length, log: x}          curves
//     {x: load.pressure, y: mesh.set.length, color: mu_M, contours: l_c}    a map
//     {x: load.pressure, y: mu_M, compare: measured.csv}    beside measurements
//
// A value that begins with `=` is a formula (scene/formulas) over the numbers of the scene;
// formulas are worked out last, in the order of the file. Later ones win: the base scene, what
// every sweep sets (STUDY_STANDARD), `set`, --set, `cases`, `vary`, formulas. What varies may be
// given nowhere else, but in a formula of `cases` over itself.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_H

#include "io/text/yaml_document.h"
#include "scene/scene.h"

enum {
    STUDY_AXES_MAX = 16,
    STUDY_COLUMNS_MAX = 64,
    STUDY_RECORDS_MAX = 64,
    STUDY_SETTINGS_MAX = 200,   // for a point
    STUDY_RANGE_MAX = 10000,   // points of a range
    STUDY_POINTS_MAX = 1000000,
    STUDY_PLOTS_MAX = 8,
    STUDY_ALSO_MAX = 3,
    STUDY_SEARCH_MAX = 12,   // keys that are searched
    STUDY_LIMITS_MAX = 16,
    STUDY_DESIGNS_MAX = 1000,
};

// A sweep wants numbers: nothing is kept of a point but run.json, and it ends when it is periodic.
#define STUDY_STANDARD                                                                             \
    "{time.until.periodic: true, output.history: false, output.fields: none, output.figures: []}"

enum { STUDY_NAME_SIZE = SCENE_KEY_SIZE, PLOT_TEXT_SIZE = 200, PLOT_FOLDER_SIZE = 512 };

typedef enum PlotKey {
    PLOT_X,
    PLOT_Y,
    PLOT_COLOR,   // given: the plot is a map
    PLOT_CONTOURS,
    PLOT_SERIES,   // a key: a curve for each of its values
    PLOT_PANELS,   // a key: a panel for each of its values
    PLOT_KEYS,
} PlotKey;

typedef struct StudyPlot {
    char name[STUDY_NAME_SIZE];   // of its files
    char text[PLOT_KEYS][PLOT_TEXT_SIZE];   // empty: not given
    YamlNode node[PLOT_KEYS];   // where it stands
    bool log_given, log_x, log_y;
    char compare[PLOT_FOLDER_SIZE];   // a table of measurements, as seen from the file's folder, or
        // from the working folder where there is none; empty: none
} StudyPlot;

typedef enum SearchScale { SEARCH_LINEAR, SEARCH_LOG, SEARCH_WHOLE } SearchScale;

typedef struct SearchKey {
    char key[STUDY_NAME_SIZE];
    SearchScale scale;
    double least, most;
    char unit[12];   // " m": numbers are handed to the scene with it; "": as they are
} SearchKey;

// Limits of one formula of `where`: a design is computed only if the value is between them.
typedef struct SearchLimit {
    YamlNode formula;
    double least, most;   // infinite: no limit
} SearchLimit;

// Rule by which the value of a design follows from its values at the points of `vary`.
typedef enum SearchOver {
    OVER_WORST,
    OVER_MEAN,
    OVER_DEVIATION,   // the standard deviation: least is best
    OVER_FRONT,   // each point is an aim of its own (study/search/pareto_front)
} SearchOver;

typedef struct StudySearch {
    YamlNode node;   // of `search`; YAML_NO_NODE: the study does not search
    int32_t key_count, limit_count;
    SearchKey keys[STUDY_SEARCH_MAX];
    SearchLimit limits[STUDY_LIMITS_MAX];
    SearchOver over;
    int32_t designs;   // that are chosen by the search
    uint32_t seed;
    bool fits;   // measurements: it has `fit`, not `best`
    YamlNode measured;   // of `fit`: a path, or a list of them
    double sure;   // of its regions: 0.95
    double quantile;   // of chi^2 with one degree of freedom, at `sure`: 3.841
} StudySearch;
typedef struct StudyRecord {
    char name[STUDY_NAME_SIZE];   // of the column
    char path[STUDY_NAME_SIZE];   // in run.json
    const char *given_by;   // "record", "by", "x", "y", ...; static storage
    YamlNode node;   // where the study names it; YAML_NO_NODE: nowhere
    bool is_shown;   // ranked by or drawn
} StudyRecord;

typedef struct StudyCase {
    const YamlDocument *document;   // not owned
    YamlNode map;   // of the scene's keys
} StudyCase;

// Cases that a search adds.
typedef struct StudyDesigns {
    char *text;   // a list of maps; owned, like the next
    YamlDocument *file;   // what it says
} StudyDesigns;

typedef struct StudyAxis {
    char key[STUDY_NAME_SIZE];
    const YamlDocument *document;   // not owned: the study's, or a range's in `made`
    YamlNode list;
    int32_t count;
    YamlNode *values;   // [count] of the list; owned
} StudyAxis;

typedef enum RankAgainst { AGAINST_FIRST, AGAINST_BEST, AGAINST_KEYS } RankAgainst;

typedef struct StudyAim {
    int32_t record;   // of `records`
    bool lowest;   // is best
} StudyAim;

typedef struct StudyRank {
    bool wanted;
    int32_t record;   // ranked by this column of `records`
    bool lowest;   // is best
    int32_t also_count;
    StudyAim also[STUDY_ALSO_MAX];   // further aims of a front
    int32_t top;   // rows to show
    RankAgainst against;   // what a gain is measured from: the first point, the best, or ...
    YamlNode baseline;   // ... the same point with these keys, a map; YAML_NO_NODE else
    double refine;   // of a search: smallest accuracy.mu that designs may get; 0: none is smaller
} StudyRank;

typedef struct Study {
    char path[SCENE_TEXT_SIZE], title[SCENE_TEXT_SIZE];
    char scene[SCENE_TEXT_SIZE];   // path of the base scene
    SceneSource *source;   // it; owned
    YamlDocument *file;   // owned, like the next
    YamlDocument *made[STUDY_SETTINGS_MAX];   // of ranges, --set and STUDY_STANDARD
    int32_t made_count;
    YamlDocument *standard;   // one of `made`
    SceneSetting overrides[STUDY_SETTINGS_MAX];   // --set; documents in `made`
    char override_keys[STUDY_SETTINGS_MAX][SCENE_KEY_SIZE];
    int32_t override_count;
    YamlNode set, cases;   // YAML_NO_NODE: none
    int32_t case_count;   // at least 1
    StudyCase *case_list;   // [case_count] NULL: none; owned
    int32_t case_room;
    int32_t design_count, design_room;
    StudyDesigns *designs;   // [design_room] of a search, in the order they came; owned
    int32_t axis_count;
    StudyAxis axes[STUDY_AXES_MAX];
    int32_t column_count;   // scene keys that vary, in the order of the file
    char columns[STUDY_COLUMNS_MAX][STUDY_NAME_SIZE];
    bool varied[STUDY_COLUMNS_MAX];   // by `vary`
    bool chosen[STUDY_COLUMNS_MAX];   // by `vary` or `cases`, not by a formula of `set`
    int32_t record_count;
    StudyRecord records[STUDY_RECORDS_MAX];
    int32_t point_count;
    bool keep_table;   // `keep: table`: points leave no folders
    StudyRank rank;
    StudySearch search;
    int32_t plot_count;
    StudyPlot plots[STUDY_PLOTS_MAX];
} Study;

// overrides: "key=value" as after --set, for every point; a key that is varied is refused. Values
// are checked when the scenes of the points are made (study_scene).
// ERROR_INPUT: file:line:column, the key, what was found and what is allowed.
bool study_read(const char *path, const char *const *overrides, int32_t override_count,
                bool trusted, Study *study, Error *err);
// Adds further cases to a study that searches, from the list of maps in `text`.
bool study_add_designs(Study *study, const char *text, Error *err);
void study_destroy(Study *study);   // also of one half read

// --- scenes, one for each point (study_point)
typedef struct PointChoice {
    int32_t point;   // 0 to point_count - 1: cases outermost, then the keys of `vary` in order
    const StudyCase *trial;   // in place of the case of `point`; NULL: its own
    bool baseline;   // with the keys of rank.baseline: what `point` is measured against
} PointChoice;

bool study_scene(const Study *study, const PointChoice *choice, Scene *scene, Error *err);
// The value of a column's key in a scene, as text; *number is NaN where it is no number.
void study_scene_value(const Scene *scene, const char *key, char *words, int32_t size,
                       double *number);
// Adds "load.pressure=0.003" to `words`, which has room for `size` bytes.
void study_add_words(const Scene *scene, const char *key, char *words, int32_t size);

// --- results that a study asks for (study_wanted)
bool study_read_wanted(Study *study, Error *err);   // `record`, `rank` and `plot`
// The path in run.json of what `record` calls `name`; NULL: no name of its list, nor a path of
// results.
const char *study_record_path(const char *name);
const char *plot_key_name(PlotKey key);   // "x"; static storage
// One plot, also that of `amontons render --plot`. Does not check what the names stand for.
bool plot_read(const YamlDocument *file, YamlNode map, StudyPlot *plot, Error *err);

// --- what the files that read a study share
typedef struct WantedKey {
    const char *name;   // "by"
    YamlNode node;   // found under it; YAML_NO_NODE: not given
} WantedKey;

enum { WANTED_KEYS_MAX = 16 };

// Finds `keys` ([count]) in `map`, called `what`; refuses every other key.
bool wanted_find(const YamlDocument *file, YamlNode map, const char *what, WantedKey *keys,
                 int32_t count, Error *err);
// The index in `words` ([count]) of the text at `key`, which may be missing: 0 then.
bool wanted_choice(const YamlDocument *file, const WantedKey *key, const char *const *words,
                   int32_t count, int32_t *choice, Error *err);

// Makes `key` a column, once; its index; -1: the error says why not.
int32_t study_add_column(Study *study, const char *key, Error *err);
// The index in `columns` of the key `name`; -1: it does not vary.
int32_t study_column(const Study *study, const char *name);
// The first column that a value given under `key` sets, by itself or in the map it is, and that is
// one of `among`; NULL: none.
const char *study_find_given(const Study *study, const bool *among, const char *key,
                             const YamlDocument *document, YamlNode node);
bool study_plain_number(const Study *study, YamlNode node, double *value);   // false: is none
// [from, to] of a key, in SI base units where both have units; unit: the base unit then ("m"), with
// which numbers are to be handed to the scene, else "". false: it is none.
enum { STUDY_UNIT_SIZE = 12 };
bool study_pair(const Study *study, YamlNode node, const char *key, double pair[2],
                char unit[STUDY_UNIT_SIZE]);
// A whole number from 1 to `most`; *value stays where the key is missing.
bool study_whole(const Study *study, const WantedKey *key, int32_t most, int32_t *value,
                 Error *err);

#endif
