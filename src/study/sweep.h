// SPDX-License-Identifier: GPL-2.0-or-later
// Many runs over a study's points, one process each. amontons_sweep, in amontons.h, is the entry;
// this is what its files share.
//
//     DIR/points/<hash>/run.json   one finished point, under a hash of its full scene
//     DIR/sweep.csv, DIR/sweep.h5  the table, a row a point in the study's order
//     DIR/lock                     one sweep at a time
//
// A point is an ordinary run: with `output.history: true` in the study its folder holds all of a
// result. It is finished when its run.json stands there; an interrupted one is not.
#ifndef AMONTONS_STUDY_SWEEP_H
#define AMONTONS_STUDY_SWEEP_H

#include "amontons.h"
#include "base/hash.h"
#include "study/study.h"

typedef enum PointStatus { POINT_PENDING, POINT_DONE, POINT_FAILED } PointStatus;

typedef struct SweepPoint {
    PointStatus status;
    char hash[HASH_TEXT_SIZE];
    int32_t same_as;   // an earlier point with the same scene; its own index: none
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
bool point_hash(const Scene *scene, Hash *mesh, char mesh_path[SCENE_TEXT_SIZE],
                char hash[HASH_TEXT_SIZE], Error *err);
void point_folder(const Sweep *sweep, int32_t point, char folder[POINT_PATH_SIZE]);
// run.json of the point (memory_free); NULL without an error when there is none.
char *point_report(const Sweep *sweep, int32_t point, Error *err);
PointStatus point_status(const char *report);   // of a run.json, or NULL
void point_remove(const Sweep *sweep, int32_t point);
// run.json for a point that left none: `failure` in a word or two, `message` in full.
bool point_write_failure(const Sweep *sweep, int32_t point, const char *failure,
                         const char *message, Error *err);
// "load.pressure=0.003 mesh.set.nx=40"
void point_words(const Sweep *sweep, const Scene *scene, char words[POINT_WORDS_SIZE]);

// --- sweep_pool: computes what is pending
bool pool_run(Sweep *sweep, Error *err);
void sweep_tell(Sweep *sweep, int32_t point, const char *report);   // the callback

// --- sweep_table: sweep.csv and sweep.h5
bool table_write(const Sweep *sweep, Error *err);

#endif
