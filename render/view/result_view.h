// SPDX-License-Identifier: GPL-2.0-or-later
// A result as the figures see it: read once through io/hdf5/result_file, checked, the space-time
// arrays only when a figure asks. Called by render.c and the figures.
#ifndef AMONTONS_RENDER_VIEW_RESULT_VIEW_H
#define AMONTONS_RENDER_VIEW_RESULT_VIEW_H

#include "render/view/contact_plane.h"

// Kinds of events as io/hdf5 stores them (record/events).
typedef enum ViewEventKind {
    VIEW_QUASI_STATIC,
    VIEW_BOUNDED,
    VIEW_LEADING,
    VIEW_SLIGHT,
    VIEW_EVENT_KINDS
} ViewEventKind;

typedef struct ViewEvent {
    int32_t kind;   // ViewEventKind
    double U_start, U_stop;   // length
    double reach;   // x, length; NaN: not known
} ViewEvent;

// Precursors and slidings, and what tables call them.
#define VIEW_WORD_PRECURSOR "precursor"
#define VIEW_WORD_SLIDING "sliding"
static inline bool view_event_counts(const ViewEvent *event)
{
    return event->kind == VIEW_BOUNDED || event->kind == VIEW_LEADING;
}
static inline const char *view_event_word(const ViewEvent *event)
{
    return event->kind == VIEW_LEADING ? VIEW_WORD_SLIDING : VIEW_WORD_PRECURSOR;
}

typedef struct ViewPeak {
    double U, mu;   // length, 1
    bool counts;   // for mu_M
} ViewPeak;

// Values over something whose numbers do not fall: of the whole history, or of a figure.
typedef struct ViewCurve {
    int64_t count;
    double *at, *value;   // [count]
} ViewCurve;
double curve_value(const ViewCurve *curve,
                   double at);   // linear between points; NaN: beyond its ends
// The last but one, or one before it, of [count] values that do not fall which is not above `at`;
// the first where all are.
int64_t curve_place(const double *values, int64_t count, double at);

// The cycle that figures of one cycle show: a number from 1, the first loading, or one of these.
// render/view/zoom reads it.
enum { VIEW_CYCLE_CHOSEN = 0, VIEW_CYCLE_LAST = -1, VIEW_CYCLE_ALL = -2 };

typedef struct ResultView {
    ArrayFile *file;   // owned
    char *title;   // of the scene; may be empty; owned
    bool si;   // lengths are metres; else normalised
    int64_t rows;   // accepted steps, at least 2
    double *t;   // [rows] time; owned
    double *U;   // [rows] rod displacement, length; owned
    double *mu;   // [rows] 1; owned
    int32_t nodes;   // contact nodes, at least 1; in space those of the line along the middle
    double *x;   // [nodes] ascending, length; owned
    double *pad;   // [nodes] number of the pad; owned
    int32_t all_nodes;   // of the contact
    int32_t *line;   // [nodes] which of them are shown; NULL in the plane: all; owned
    char *pad_names;   // a line a pad, by number; empty: without names; owned
    char *warnings;   // of the run, one a line; empty: none; owned
    double *slip_rate;   // [rows * nodes] velocity, or NULL: not read yet; owned
    double *slip;   // [rows * nodes] length, or NULL: not read yet; owned
    double *front;   // [rows] x, or NULL: not read yet; owned
    double *status;   // [rows * nodes] 0: open, or NULL: not read yet; owned
    double *area;   // [rows * nodes] of the real contacts over that at rest, or NULL: not read yet;
        // owned
    ViewCurve precursors;   // of that figure; `at` NULL: not computed yet; owned
    ViewCurve front_speed;   // likewise
    ContactPlane plane;   // in space; patch_count 0: not read yet; owned
    double *contact_status;   // [rows * all_nodes] in space, or NULL: not read yet; owned
    int32_t cycle;   // asked for
    int32_t states;   // of friction that remembers; 0: it does not
    int32_t state;   // which of them SERIES_STATE is read as
    char *state_names, *state_unit;   // a line each; "time", "1", ...; owned
    int32_t probes;   // points inside the bodies; 0: there are none
    char *probe_names;   // a line each; owned
    double number[RESULT_NUMBERS_COUNT];   // NaN: not known
    int32_t event_count, peak_count;   // 0 in a run that did not end
    ViewEvent *events;   // [event_count] owned
    ViewPeak *peaks;   // [peak_count] owned
    int32_t rapid_count;   // events that are not quasi-static and have ended
    double (*rapid)[2];   // [rapid_count] U from and to; owned
} ResultView;

// ERROR_INPUT names `folder` when it holds no history, or one without the two steps a picture
// needs, or whose rod does not move.
bool result_view_open(const char *folder, ResultView *view, Error *err);
void result_view_close(ResultView *view);   // zeroed is fine

bool result_view_read_slip_rate(ResultView *view, Error *err);
bool result_view_read_status(ResultView *view, Error *err);
// The plane, and contact_status. ERROR_INPUT: the block is in the plane.
bool result_view_read_plane(ResultView *view, Error *err);
bool result_view_read_slip(ResultView *view, Error *err);
bool result_view_read_front(ResultView *view, Error *err);

// *values [rows * nodes], the caller's, or where the whole contact is wanted [rows * all_nodes]; in
// space |v| of slip rates, their size of shear. `rows` may shrink. ERROR_INPUT also where there is
// no state.
bool result_view_read(ResultView *view, ResultSeries series, bool whole, double **values,
                      Error *err);
// The same of [count] rows of the history alone: *values [count * nodes] in their order.
bool result_view_read_at(ResultView *view, ResultSeries series, bool whole, const int64_t *rows,
                         int32_t count, double **values, Error *err);

// The name of the state that is chosen.
enum { VIEW_STATE_SIZE = 64 };
void result_view_state_name(const ResultView *view, char name[VIEW_STATE_SIZE]);

// The state called `name`, "state" the first, is the one that SERIES_STATE stands for from now on.
// False: there is none such.
bool result_view_choose_state(ResultView *view, const char *name);

// Another line along the drive than that in the middle: "y=0.2", the nodes nearest to it.
// ERROR_INPUT also where the block is in the plane. Before any series of nodes is read.
bool result_view_choose_line(ResultView *view, const char *words, Error *err);

// The least and the largest finite U; the same of mu while U is from U[0] to U[1], infinite and in
// the wrong order where there is none.
void result_view_range(const ResultView *view, double *low, double *high);
void result_view_mu_range(const ResultView *view, const double U[2], double range[2]);

// Pads are numbered from 0 without gaps; one is the least.
int32_t result_view_pads(const ResultView *view);
// Number `k` of such names, a line each, and how long it is; 0: there is none.
const char *result_view_name(const char *names, int32_t k, int *length);

// Name of a pad in pictures: "contact_3" is pad 3, a name of the user's own stands as it is;
// without names, numbers from 1.
enum { PAD_NAME_SIZE = 96 };
void result_view_pad(const ResultView *view, int32_t pad, char name[PAD_NAME_SIZE]);

double result_view_trailing_end(const ResultView *view);   // x, length
// The row whose entry of `values` [rows], U or t, is nearest to `value`.
int64_t result_view_nearest_row(const ResultView *view, const double *values, double value);
// The last row before the rod is at `start`, and the last one up to `stop`; 0 where there is none.
void result_view_event_rows(const ResultView *view, double start, double stop, int64_t *before,
                            int64_t *last);
// The block where its length is known, all contact nodes in any case.
void result_view_x_extent(const ResultView *view, double *low, double *high);

#endif
