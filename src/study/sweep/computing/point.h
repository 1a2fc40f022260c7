// SPDX-License-Identifier: GPL-2.0-or-later
// A sweep, its points, and their files. An interrupted point is not finished.
//
//     DIR/points/<hash>/run.json   one finished point, under a hash of its full scene
//     DIR/reports                  in its place one file for all points, with `keep: table`
//     DIR/sweep.csv, DIR/sweep.h5  the table, a row a point in the study's order
//     DIR/ranking.csv              the same points, the best first, where the study asks (`rank`)
//     DIR/figures/*.png            pictures of the ranking and of the study's `plot`
//     DIR/slurm/                   scripts and output of the elements, with --slurm
//     DIR/amontons.lock            one sweep at a time
//
// A point is an ordinary run: with `output.history: true` in the study its folder holds all of a
// result. It is finished when its run.json exists.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_POINT_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_POINT_H

#include "amontons.h"
#include "base/hash.h"
#include "io/files/file_lock.h"
#include "study/sweep/computing/reports.h"
#include "study/sweep/reading/study.h"

typedef enum PointStatus { POINT_PENDING, POINT_DONE, POINT_FAILED } PointStatus;

typedef struct SweepPoint {
    PointStatus status;
    char hash[HASH_TEXT_SIZE];
    int32_t same_as;   // an earlier point with the same scene; its own index: none
    int32_t baseline;   // the point that `rank` measures it against; -1: none
    bool reused;   // was finished when the sweep began
    ReportPlace place;   // of its report, with `keep: table`
    double seconds;   // in this sweep
} SweepPoint;

// The mesh file hashed last: one shared by all points is read once. Begins zeroed.
typedef struct PointMesh {
    Hash hash;
    char path[SCENE_TEXT_SIZE];
} PointMesh;

typedef struct Sweep {
    const SweepOptions *options;   // not owned
    Study study;   // owned
    char folder[AMONTONS_PATH_SIZE];
    Reports reports;   // open: `keep: table`
    FileLock lock;   // held from plan to close
    SweepPoint *points;   // [study.point_count]; owned
    int32_t point_count;   // points so far: a search adds some in each round
    Scene *scene;   // of the point that point_scene was asked for last; owned
    PointMesh mesh;
    void *by_hash;   // tree of points (tsearch), the first of each hash; owned
    double started;   // wall clock, s
    bool checked;   // what the study records is in run.json
    int32_t planned;   // points to compute or to find: all; of a search as many as are expected
    int32_t computed, failed, finished;
} Sweep;

enum { POINT_PATH_SIZE = AMONTONS_PATH_SIZE + 64, POINT_WORDS_SIZE = 512 };

// The scene of a point. It stands until the next is asked for. NULL: the error says why.
const Scene *point_scene(const Sweep *sweep, int32_t point, Error *err);
// A name for all that decides what a point comes to: version, mesh file, every key but the title.
bool point_hash(Sweep *sweep, const Scene *scene, char hash[HASH_TEXT_SIZE], Error *err);
// Sets `same_as` of all points with the same hash to the first of them. From then on points_look_up
// finds that point by its hash.
bool points_find_same(Sweep *sweep, Error *err);
int32_t points_look_up(const Sweep *sweep, const char *hash);   // -1: none
void points_note_place(void *sweep, const char *hash, ReportPlace place);   // for a ReportFound
void points_forget(void **tree);   // of tsearch, whose points stay
// run.json of the point (memory_free); NULL without an error when there is none.
char *point_report(const Sweep *sweep, int32_t point, Error *err);
// The number at `path` in a run.json, its error as it stands there, and how far it is known: `bar`
// with the mesh's part, `known_to` with what a mesh usually leaves where that is not known. NaN:
// none, also where `report` is NULL.
typedef struct PointValue {
    double value, error, bar, known_to;
} PointValue;
PointValue point_value(const char *report, const char *path);
PointStatus point_status(const char *report);   // of a run.json, or NULL
const char *point_status_name(PointStatus status);   // "pending"; static storage
// Checks that the point's folder, and what is read from it, lie in the sweep's own: no link leads
// elsewhere.
bool point_check_place(const Sweep *sweep, int32_t point, Error *err);
// Removes run.json and, with `anew`, the checkpoint. ERROR_INPUT: one is there and not ours.
bool point_remove(Sweep *sweep, int32_t point, bool anew, Error *err);
// Path of a file of the point, such as "run.json"; "": of its folder.
void point_path(const Sweep *sweep, int32_t point, const char *file,
                char path[POINT_PATH_SIZE + 16]);
// Runs a point in this process. *report: with `keep: table` what run.json would hold, but for the
// scene and the list of events, on one line (memory_free); else NULL.
bool point_run(const Sweep *sweep, int32_t point, char **report, Error *err);
bool point_keep(Sweep *sweep, int32_t point, const char *report, Error *err);   // in the sweep's
// run.json for a point that left none: `failure` in a word or two, `message` in full.
bool point_write_failure(Sweep *sweep, int32_t point, const char *failure, const char *message,
                         Error *err);
// "load.pressure=0.003 mesh.set.nx=40"
void point_words(const Sweep *sweep, const Scene *scene, char words[POINT_WORDS_SIZE]);

// --- points are counted as they end, and reported to the caller (options->on_point): tally
// Points from `first` on that an earlier sweep finished: computed again only where the options say
// so.
bool sweep_take_finished(Sweep *sweep, int32_t first, Error *err);
bool sweep_is_waiting(const Sweep *sweep, int32_t point);   // to be computed, by itself
// ERROR_INTERRUPT once options->stop is set.
bool sweep_check_stop(const Sweep *sweep, Error *err);
// The process of `point` has ended: its report is counted and reported. seconds: it took;
// NaN: as in run.json. *left: whether there is a run.json.
bool sweep_take_ended(Sweep *sweep, int32_t point, double seconds, bool *left, Error *err);
// The same of one that left none: first the report of its failure is written, `failure` in a word
// or two, `message` in full.
bool sweep_take_lost(Sweep *sweep, int32_t point, double seconds, const char *failure,
                     const char *message, Error *err);
// Is called when all are computed: points with the same scene get the status of the first of them.
void sweep_share_results(Sweep *sweep);
void sweep_summarise(const Sweep *sweep, SweepSummary *summary);

// --- pending points are computed
// In processes of this computer. jobs: points at a time; 0: as many as there are cores. Every
// step-th point is looked at.
bool pool_run(Sweep *sweep, int32_t jobs, int32_t step, Error *err);
// As Slurm job arrays, an element a share; waits for them.
bool slurm_run(Sweep *sweep, Error *err);
// Cancels what an earlier sweep in this folder, itself killed, left to Slurm.
bool slurm_end_leftovers(const Sweep *sweep, Error *err);

#endif
