// SPDX-License-Identifier: GPL-2.0-or-later
// An answer on meshes of falling cell size, several runs on each, and the error bar that follows.
// The runs of a level differ in pressure by less than anybody knows it: where branches coexist they
// fall on one or the other. mu_M is their mean, mu_hold their lowest. A bar is meant to hold the
// answer of the limit in 19 of 20 cases; its parts, added in quadrature:
//
//   drops      twice the standard error that the finite number of load drops leaves
//   branches   twice the standard error of the mean over runs, the spread of a level's runs taken
//              from the levels at least as fine; both weighed as the levels are. The first
//              sliding is one value a run: there the spread of a single run is added
//   mesh       value = a + b / n on n nodes along the contact is estimated from the levels together
//              (Bayes: values scatter from mesh to mesh, as slip stops at nodes, and by what few
//              runs leave of branches; how far, the levels say themselves: what is usual counts as
//              one level more).
//              a, the limit of ever smaller cells, is the answer, Student's 95 % of its deviation
//              the part. At least what steps and reduction leave. Levels whose cells are too long
//              for slip (`undamped`), and those coarser than all on which the same pads slide as
//              on the last (`other_drops`), have no part in it; where the last nodes of the
//              contact hold the block they scatter more, and three times what mu rises by
//              meanwhile (`end_wait`) is added. One level: its own value, nothing known. A bar that
//              is short enough is met where levels differ by a factor of two in cell size
//              (levels_span_left), or of four (levels_confirm_left) if time allows: where pads may
//              slide otherwise on finer meshes all of it, else a small part (run/accuracy, is_met).
//
// How often bars hold, and by how much, is measured by validation/benchmark/promise.py.
#ifndef AMONTONS_ANSWERS_ERROR_BARS_H
#define AMONTONS_ANSWERS_ERROR_BARS_H

#include "answers/answers.h"
#include "record/drops.h"

// --- which pads slide together ------------------------------------------------------------------

// Which pads slide together at the load drops of a run, and whether two meshes differ in it. Coarse
// meshes may agree on mu of a regime that finer ones do not have: two pads that slide by turns
// there, and each by itself here. Filled by run/accuracy.
enum { PATTERNS_MAX = 32 };

typedef struct Pattern {
    uint64_t pads;   // bit p: pad p slid over all its length; of more than 64 pads some share a bit
    int32_t drops;   // load drops with it
} Pattern;

typedef struct Patterns {
    int32_t count;
    Pattern list[PATTERNS_MAX];   // [count] those that were seen first
    int32_t drops;   // load drops in all
} Patterns;

void patterns_add(Patterns *patterns, uint64_t pads);
// Adds the load drops from number `first` of the list on.
void patterns_add_drops(Patterns *patterns, const Drops *drops, int32_t first);

// One of them has a pattern that the other lacks, and that is no chance: if the pattern were
// equally likely in all drops of both, it would be so in fewer than 5 of 100 cases (Fisher's exact
// test).
bool patterns_differ(const Patterns *one, const Patterns *other);

// --- levels and bars ----------------------------------------------------------------------------

enum { LEVELS_MAX = 24, LEVEL_RUNS_MAX = 9 };

// The last one is the peak of the first loading: one value a run, of which no bar is asked.
typedef enum AnswerKind { ANSWER_MU_M, ANSWER_MU_HOLD, ANSWER_MU_FIRST, ANSWER_KINDS } AnswerKind;

typedef struct LevelRun {
    double pressure;   // over the scene's
    double way;   // that the drive went, length
    Estimate answer[ANSWER_KINDS];   // value NaN: the run has none; error: a bar
    int32_t peaks, period;   // that count; they repeat after so many, 0: they do not
    RunIn run_in;   // not over, but for a trend whose way is part of the error: it has no answer
    int64_t steps;
} LevelRun;

// An answer by all levels so far. parts.mesh is NaN where it is not known, and the bar with it.
typedef struct ErrorBar {
    double value, bar;
    ErrorParts parts;
    bool apart;   // the last level's own value was outside the bar, which was widened to hold it
} ErrorBar;

typedef struct Level {
    double refine;   // mesh.set.refine
    int32_t contact_nodes;
    double nodes_along;   // along its length (contact/interface), of which a cell is 1/nodes_along
    bool space;   // of a block in space
    bool undamped;   // friction weakens faster than viscosity can damp on a cell: no answer
    int32_t pads;   // pieces of its contact
    Patterns patterns;   // which of them slid at the load drops of its runs
    bool other_drops;   // others than on the last level and on all between: no answer
    double slip_cells;   // least that slipped before slow slip turned fast; NaN: not known
    double end_wait;   // what mu rises by while the last nodes of the contact hold (run/one_mesh)
    int32_t run_count;
    LevelRun runs[LEVEL_RUNS_MAX];
    ErrorBar answer[ANSWER_KINDS];
    double seconds;   // wall time
    double making;   // of them for mesh and basis, where these are made once
    double seconds_expected;   // by the level before, for its first runs; NaN: the first level
} Level;

// A run that time or the caller ended before its answer was known. It has no part in any bar.
typedef struct LevelCut {
    double mesh, run;   // numbers of both, from 1; 0: none was
    double contact_nodes;   // 0: there was no mesh yet
    double U, part;   // reached, length; over the longest way that it may go; NaN: no step yet
    double seconds, seconds_expected;   // of its level so far; as of a Level
    double mu_M, mu_hold;   // so far; NaN: none
} LevelCut;

typedef struct Levels {
    double wanted;   // bar over value
    bool met;
    bool of_hold;   // `wanted` is of mu_hold, whatever runs have
    AnswerKind asked;   // what it is of
    const char *ended;   // why no more was computed; static storage
    LevelCut cut;   // the last that was
    int32_t count;
    Level list[LEVELS_MAX];   // [count] the coarsest first
} Levels;

extern const char *const ANSWER_NAMES[ANSWER_KINDS];   // "mu_M", "mu_hold", "mu_first"

// The last level has at least a whole run, and so have all before.
const Level *levels_last(const Levels *levels);   // NULL: there is none
bool levels_have_runs(const Levels *levels);
// Adds a run to the last level, which has room, and estimates anew.
void levels_add_run(Levels *levels, double pressure, double way, const Answers *answers,
                    int64_t steps);
// Some run of the last level went no farther than this.
bool levels_reach(const Levels *levels, double way);

// Fills the bars of the last level from the runs of all, and `asked`: mu_M where every run of that
// level has it, else mu_hold, or as `of_hold` says.
void levels_estimate(Levels *levels);
// By all levels, kept in the last one; NULL: there is no level.
const ErrorBar *levels_answer(const Levels *levels, AnswerKind kind);

// Number of levels that count: they are not `undamped`, all their runs have such an answer, at
// their drops the same pads slide as on the last level, and their last nodes do not hold the block
// up by more than is wanted.
int32_t levels_known(const Levels *levels, AnswerKind kind);
// Ratio of cell sizes from the last level to one twice as fine as the coarsest that counts. A
// bar needs at least this span: neighbours agree by chance, and coarse meshes alone agree on a
// value that only they have.
double levels_span_left(const Levels *levels, AnswerKind kind);   // 1: none is left
// The same ratio to a level that is four times as fine as the first, which confirms a bar.
double levels_confirm_left(const Levels *levels);   // 1: none is left
// Coarse levels may all have other drops than fine ones: on several pads, and where levels differ
// in it. There a bar wants to be confirmed whatever that costs.
bool levels_may_differ(const Levels *levels);

// Value from the level's own runs: mean of mu_M, lowest mu_hold; NaN: a run has none.
double level_value(const Level *level, AnswerKind kind);

// Number of cells that slip on the last level where slow slip turns fast, by the part of the
// contact that does on all levels; all cells where slip never turns fast. The fewer they are, the
// longer is the mesh's part of a bar.
double levels_cells(const Levels *levels);

// A run of the last level has no answer, as its run-in was not over.
bool levels_run_in(const Levels *levels);

// Error within which the answer of all levels is known: the bar, or what the last mesh alone
// usually leaves.
double levels_known_to(const Levels *levels, AnswerKind kind);

// Sets how far the answers are known: the error that one mesh alone usually leaves, together with
// the error that the drops of a run leave. NaN: nothing is known.
void level_answer_for(const Level *level, Answers *answers);

// Puts value, error and parts of both answers in the place of those of one run; without any whole
// run that one's answers stay, of whose errors nothing is known. Where the mesh's part of a bar is
// not known the last mesh alone says how far answers are.
void levels_answer_for(const Levels *levels, Answers *answers);

// Order of convergence from the last three levels, for the asked answer: ln(difference before /
// last difference) over ln of the last cell sizes' ratio; NaN: not three levels.
double levels_order(const Levels *levels);

void levels_write_json(const Levels *levels, JsonWriter *json);   // one object, `accuracy`

#endif
