// SPDX-License-Identifier: GPL-2.0-or-later
// Many runs over a study's points, one process each. amontons_sweep, in amontons.h, is the entry;
// this is what its files share.
//
//     DIR/points/<hash>/run.json   one finished point, under a hash of its full scene
//     DIR/sweep.csv, DIR/sweep.h5  the table, a row a point in the study's order
//     DIR/ranking.csv              the same points, the best first, where the study asks (`rank`)
//     DIR/figures/*.png            pictures of the ranking and of the study's `plot`
//     DIR/slurm/                   scripts and output of the elements, with --slurm
//     DIR/lock                     one sweep at a time
//
// A point is an ordinary run: with `output.history: true` in the study its folder holds all of a
// result. It is finished when its run.json stands there; an interrupted one is not.
#ifndef AMONTONS_STUDY_SWEEP_SWEEP_H
#define AMONTONS_STUDY_SWEEP_SWEEP_H

#include "amontons.h"
#include "base/hash.h"
#include "study/sweep/study.h"

typedef enum PointStatus { POINT_PENDING, POINT_DONE, POINT_FAILED } PointStatus;

typedef struct SweepPoint {
    PointStatus status;
    char hash[HASH_TEXT_SIZE];
    int32_t same_as;   // an earlier point with the same scene; its own index: none
    int32_t baseline;   // the point that `rank` measures it against; -1: none
    bool reused;   // was finished when the sweep began
    double seconds;   // in this sweep
} SweepPoint;

typedef struct Sweep {
    const SweepOptions *options;   // not owned
    Study study;   // owned
    char folder[AMONTONS_PATH_SIZE];
    int lock;   // file descriptor; -1: none
    SweepPoint *points;   // [study.point_count]; owned
    double started;   // wall clock, s
    double busy;   // seconds of all points computed so far
    int32_t computed, failed, finished, reused;
} Sweep;

// --- sweep_point: what stands on disk of a point
enum { POINT_PATH_SIZE = AMONTONS_PATH_SIZE + 64, POINT_WORDS_SIZE = 512 };
// The mesh file hashed last: one shared by all points is read once. Begins zeroed.
typedef struct PointMesh {
    Hash hash;
    char path[SCENE_TEXT_SIZE];
} PointMesh;

// A name for all that decides what a point comes to: version, mesh file, every key but the title.
bool point_hash(const Scene *scene, PointMesh *mesh, char hash[HASH_TEXT_SIZE], Error *err);
void point_folder(const Sweep *sweep, int32_t point, char folder[POINT_PATH_SIZE]);
// run.json of the point (memory_free); NULL without an error when there is none.
char *point_report(const Sweep *sweep, int32_t point, Error *err);
PointStatus point_status(const char *report);   // of a run.json, or NULL
const char *point_status_name(PointStatus status);   // "pending"; static storage
void point_remove(const Sweep *sweep, int32_t point);
bool point_run(const Sweep *sweep, int32_t point, Error *err);   // in this process
// run.json for a point that left none: `failure` in a word or two, `message` in full.
bool point_write_failure(const Sweep *sweep, int32_t point, const char *failure,
                         const char *message, Error *err);
// "load.pressure=0.003 mesh.set.nx=40"
void point_words(const Sweep *sweep, const Scene *scene, char words[POINT_WORDS_SIZE]);

// --- sweep_pool, sweep_slurm: compute what is pending
bool pool_run(Sweep *sweep, Error *err);
bool slurm_run(Sweep *sweep, Error *err);
// Cancels what an earlier sweep in this folder, itself killed, left to Slurm.
bool slurm_end_leftovers(Sweep *sweep, Error *err);
// ERROR_INTERRUPT once options->stop is set.
bool sweep_check_stop(const Sweep *sweep, Error *err);
bool sweep_is_waiting(const Sweep *sweep, int32_t point);   // to be computed, by itself
// What computed `point` is gone: the report that it left is counted and the caller told. seconds:
// it took; NaN: as the report says. *left: whether there is a report.
bool sweep_take_ended(Sweep *sweep, int32_t point, double seconds, bool *left, Error *err);
// The same of one that left none: first the report of its failure is written, `failure` in a word
// or two, `message` in full.
bool sweep_take_lost(Sweep *sweep, int32_t point, double seconds, const char *failure,
                     const char *message, Error *err);

// --- sweep_element: one point for Slurm; element e computes points[e] ([count])
bool elements_write(const Sweep *sweep, const char *path, const int32_t *points, int32_t count,
                    Error *err);

// --- sweep_table: sweep.csv and sweep.h5
enum { WORDS_MAX = 64, WORD_SIZE = 64 };

// Words in a column of keys that are no numbers; the table holds their index.
typedef struct WordList {
    int32_t count;
    char words[WORDS_MAX][WORD_SIZE];
} WordList;

// The numbers of the table, column after column; NaN where there is none.
typedef struct SweepTable {
    double *keys;   // [column_count][point_count]; owned, like all below
    double *records;   // [record_count][point_count]
    double *status;   // [point_count] a PointStatus
    double *period;   // [point_count] of peaks or, ranked by them, of falls; 0: none
    double *low, *high;   // [point_count] bounds of mu_M: of its own peaks where they are
        // periodic, of all peaks but the first where not; ranked by mu_trusted: bounds of that
    WordList *words;   // [column_count]
} SweepTable;

bool table_write(const Sweep *sweep, SweepTable *table, Error *err);
void table_destroy(SweepTable *table);   // zeroed is fine

// --- sweep_rank: ranking.csv
typedef struct RankRow {
    int32_t point;
    double value, low, high;   // what it is ranked by; bounds of mu_M or mu_trusted, else NaN
    double gain;   // over the baseline, 1; NaN: there is none
    bool as_good;   // its bounds meet those of the best
} RankRow;

typedef struct Ranking {
    RankRow *rows;   // [count] the best first; points without a value last; owned
    int32_t count, ranked;   // all points; those with a value
} Ranking;

bool ranking_make(const Sweep *sweep, const SweepTable *table, Ranking *ranking, Error *err);
bool ranking_write(const Sweep *sweep, const SweepTable *table, const Ranking *ranking, Error *err);
// The first rows, as many as `rank` says, to options->out.
bool ranking_print(const Sweep *sweep, const SweepTable *table, const Ranking *ranking, Error *err);
void ranking_destroy(Ranking *ranking);   // zeroed is fine

// --- sweep_figures: figures/ranking.png and figures/plot.png, by the module `render`
bool figure_of_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                       Error *err);
bool figure_of_plot(const Sweep *sweep, const SweepTable *table, Error *err);

#endif
