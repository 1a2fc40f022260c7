// SPDX-License-Identifier: GPL-2.0-or-later
// Lists in one place what history.h5 holds: names, stored types, shapes, units, and a sentence
// each. io/hdf5/result_file writes and reads by it; the table of docs/results.md is generated from
// it.
#ifndef AMONTONS_IO_HDF5_RESULT_TABLES_H
#define AMONTONS_IO_HDF5_RESULT_TABLES_H

// Values of interface/status. Callers of the library have them as NODE_OPEN and so on (amontons.h).
typedef enum StoredStatus {
    STATUS_OPEN,
    STATUS_STICKS,
    STATUS_WEAKENS,   // slips where friction falls with the slip rate
    STATUS_SLIPS   // slips where it does not
} StoredStatus;

typedef enum ResultColumns {
    COLUMNS_ONE,
    COLUMNS_NODES,   // one a contact node, by x
    COLUMNS_PADS,   // one a pad: nodes/pad numbers them
    COLUMNS_PROBES   // several a probe, in the order of the attribute `probes`
} ResultColumns;

// Rows are accepted steps: the state at the END of the step, row 0 the start. In space slip_rate,
// slip and shear have a last axis: along x, along y.
// X(symbol, name, stored type, columns, unit, description)
#define RESULT_SERIES(X)                                                                           \
    X(SERIES_TIME, "series/time", ARRAY_FLOAT64, ONE, "time", "t, 0 when the rod starts")          \
    X(SERIES_ROD, "series/rod_displacement", ARRAY_FLOAT64, ONE, "length", "U = V t")              \
    X(SERIES_ROD_WAY, "series/rod_way", ARRAY_FLOAT64, ONE, "length",                              \
      "R, way of the rod itself, U - F_T / rod.stiffness; absent where the rod is rigid")          \
    X(SERIES_MU, "series/mu", ARRAY_FLOAT64, ONE, "1", "F_T / F_N, rod force over applied load")   \
    X(SERIES_ROD_FORCE, "series/rod_force", ARRAY_FLOAT64, ONE, "force/width",                     \
      "F_T, force of the rod on the block along x")                                                \
    X(SERIES_NORMAL_FORCE, "series/normal_force", ARRAY_FLOAT64, ONE, "force/width",               \
      "resultant of the contact pressure")                                                         \
    X(SERIES_STEP, "series/step_size", ARRAY_FLOAT64, ONE, "time",                                 \
      "dt of the step that ended here")                                                            \
    X(SERIES_FRONT, "series/front", ARRAY_FLOAT64, ONE, "length",                                  \
      "l: the slip region grown from the trailing edge, over gaps too, ends at this x")            \
    X(SERIES_MAX_SLIP_RATE, "series/max_slip_rate", ARRAY_FLOAT64, ONE, "velocity",                \
      "largest |slip rate| on the interface")                                                      \
    X(SERIES_CERTIFIED, "series/certified", ARRAY_UINT8, ONE, "1",                                 \
      "1: the slip set is certified dissipative, 0: waves are resolved")                           \
    X(SERIES_ENERGY_ERROR, "series/energy_error", ARRAY_FLOAT64, ONE, "energy/width",              \
      "work done minus energy stored and dissipated, since the start")                             \
    X(SERIES_SLIP_RATE, "interface/slip_rate", ARRAY_FLOAT32, NODES, "velocity",                   \
      "d u_x / dt at the contact nodes")                                                           \
    X(SERIES_SLIP, "interface/slip", ARRAY_FLOAT32, NODES, "length", "u_x since the rod's start")  \
    X(SERIES_PRESSURE, "interface/pressure", ARRAY_FLOAT32, NODES, "stress", "p >= 0, pressing")   \
    X(SERIES_SHEAR, "interface/shear", ARRAY_FLOAT32, NODES, "stress",                             \
      "tau: friction stress on the block, positive against the drive (towards -x)")                \
    X(SERIES_STATUS, "interface/status", ARRAY_UINT8, NODES, "1",                                  \
      "0 open, 1 stick, 2 slip where friction weakens, 3 slip where it does not")                  \
    X(SERIES_GAP, "interface/gap", ARRAY_FLOAT32, NODES, "length",                                 \
      "how far the block stands over the floor; 0 where they touch")                               \
    X(SERIES_STATE, "interface/state", ARRAY_FLOAT32, NODES, "time",                               \
      "theta of friction that remembers (`slip-weakening`: phi, part of strength, 1; one's own: "  \
      "several along a last axis, in their own units); absent where nothing is remembered")        \
    X(SERIES_AREA, "interface/contact_area", ARRAY_FLOAT32, NODES, "1",                            \
      "area of the real contacts over that when the rod starts, 0 where open: 1 + beta ln(1 + "    \
      "theta/theta_0) over its value then, `slip-weakening`: phi; absent of other laws")           \
    X(SERIES_PAD_NORMAL, "pads/normal_force", ARRAY_FLOAT64, PADS, "force/width",                  \
      "load of each pad")                                                                          \
    X(SERIES_PAD_SHEAR, "pads/shear", ARRAY_FLOAT64, PADS, "force/width",                          \
      "friction on each pad, positive against the drive")                                          \
    X(SERIES_PAD_SHEAR_ACROSS, "pads/shear_across", ARRAY_FLOAT64, PADS, "force/width",            \
      "the same across the drive, towards -y; in space only")                                      \
    X(SERIES_PAD_SLIP, "pads/slip", ARRAY_FLOAT64, PADS, "length",                                 \
      "mean of interface/slip along the drive")                                                    \
    X(SERIES_PAD_SLIP_ACROSS, "pads/slip_across", ARRAY_FLOAT64, PADS, "length",                   \
      "the same across the drive; in space only")                                                  \
    X(SERIES_PAD_SLIPPING, "pads/slipping", ARRAY_FLOAT64, PADS, "length", "how much of it slips") \
    X(SERIES_PROBE_DISPLACEMENT, "probes/displacement", ARRAY_FLOAT64, PROBES, "length",           \
      "u_x, u_z of each probe of the scene, in space u_x, u_y, u_z; absent without probes")        \
    X(SERIES_PROBE_VELOCITY, "probes/velocity", ARRAY_FLOAT64, PROBES, "velocity",                 \
      "the same of velocities")                                                                    \
    X(SERIES_PROBE_STRAIN, "probes/strain", ARRAY_FLOAT64, PROBES, "1",                            \
      "xx, zz, xz of each probe, in space xx, yy, zz, xy, yz, xz; xz is half the shear angle")     \
    X(SERIES_PROBE_STRESS, "probes/stress", ARRAY_FLOAT64, PROBES, "stress",                       \
      "the same of stresses, elastic and viscous")

// Fixed arrays over contact nodes, ordered by x. X(symbol, name, stored type, unit, description)
#define RESULT_NODES(X)                                                                            \
    X(NODES_X, "nodes/x", ARRAY_FLOAT64, "length", "position of the contact nodes")                \
    X(NODES_Y, "nodes/y", ARRAY_FLOAT64, "length", "the same across the drive; in space only")     \
    X(NODES_LINE, "nodes/line", ARRAY_INT32, "1",                                                  \
      "1: on the line along the middle of the contact that fronts are read off; in space only")    \
    X(NODES_WEIGHT, "nodes/weight", ARRAY_FLOAT64, "length", "integral of the shape function")     \
    X(NODES_PAD, "nodes/pad", ARRAY_INT32, "1", "which pad the node is on, from 0")

// Faces by which the contact is drawn, in space only. X(symbol, name, stored type, unit,
// description)
#define RESULT_FACES(X)                                                                            \
    X(FACES_NODES, "faces/nodes", ARRAY_INT32, "1",                                                \
      "faces of the contact by their points: contact nodes, behind them faces/corners; -1: no "    \
      "more")                                                                                      \
    X(FACES_CORNERS, "faces/corners", ARRAY_FLOAT64, "length",                                     \
      "x and y of corners that touch nothing, as those of TET10; absent: none")

// Places of the probes, where there are any. X(symbol, name, stored type, unit, description)
#define RESULT_PROBES(X)                                                                           \
    X(PROBES_AT, "probes/at", ARRAY_FLOAT64, "length",                                             \
      "x and z of each probe in the undeformed block, in space x, y, z; absent without probes")

// Tables known at the end of a run (absent in a killed one). X(symbol, name, unit, description)
#define RESULT_TABLES(X)                                                                           \
    X(PEAKS_U, "peaks/U", "length", "rod displacement at each peak of mu before bulk sliding")     \
    X(PEAKS_MU, "peaks/mu", "1", "mu at the peak")                                                 \
    X(PEAKS_COUNTS, "peaks/counts", "1", "1: counts for mu_M, 0: before load drops had settled")   \
    X(EVENTS_KIND, "events/kind", "1",                                                             \
      "0 quasi-static, 1 bounded rapid, 2 leading rapid, 3 slight rapid")                          \
    X(EVENTS_U_START, "events/U_start", "length", "rod displacement when it starts")               \
    X(EVENTS_U_STOP, "events/U_stop", "length", "rod displacement when it stops")                  \
    X(EVENTS_T_START, "events/t_start", "time", "when it starts")                                  \
    X(EVENTS_T_STOP, "events/t_stop", "time", "when it stops")                                     \
    X(EVENTS_REACH, "events/reach", "length", "largest x it came to, on the pads it ran over")     \
    X(EVENTS_SLIPPED, "events/slipped", "length^2",                                                \
      "how much of the contact slipped, of slow slip at most at once; in space only")              \
    X(EVENTS_PEAK_RATE, "events/peak_slip_rate", "velocity", "largest slip rate")                  \
    X(EVENTS_FRONT_SPEED, "events/front_speed", "velocity",                                        \
      "mean speed of the front along the contact; nan: none")

// Attributes of the file's root. Texts: title, units ("normalised" or "si"), version, pads (their
// names, a line each), states and probes (likewise), state_unit, warnings (absent: none).
// X(symbol, name, unit, description)
#define RESULT_NUMBERS(X)                                                                          \
    X(NUMBER_FORMAT, "format", "1",                                                                \
      "2 in space, where slip_rate, slip and shear are vectors; absent in the plane")              \
    X(NUMBER_LENGTH, "length", "length", "L, extent of the block along x")                         \
    X(NUMBER_TRAILING, "trailing_end", "length", "x at which the block begins")                    \
    X(NUMBER_PRESSURE, "pressure", "stress", "P_ext on the top")                                   \
    X(NUMBER_LOAD, "normal_force", "force/width", "F_N, the applied load")                         \
    X(NUMBER_THICKNESS, "thickness", "length",                                                     \
      "in the plane: forces times this are those of the whole block; absent: not given")           \
    X(NUMBER_ROD_VELOCITY, "rod_velocity", "velocity", "V")                                        \
    X(NUMBER_CRITICAL_VELOCITY, "critical_velocity", "velocity", "v_c of the friction law")        \
    X(NUMBER_MU_STATIC, "mu_static", "1", "mu_S, local; absent of rate and state")                 \
    X(NUMBER_MU_KINETIC, "mu_kinetic", "1", "mu_K, local; likewise")                               \
    X(NUMBER_C_LONGITUDINAL, "speed_longitudinal", "velocity", "c_L")                              \
    X(NUMBER_C_SHEAR, "speed_shear", "velocity", "c_S")                                            \
    X(NUMBER_C_RAYLEIGH, "speed_rayleigh", "velocity", "c_R")                                      \
    X(NUMBER_WAVE_DAMPING, "wave_damping", "1",                                                    \
      "of the longest wave of the block, over critical damping; above 1 no wave runs")             \
    X(NUMBER_ROD_LOW, "rod_low", "length",                                                         \
      "lowest z of the strip that the rod pushes; absent: none")                                   \
    X(NUMBER_ROD_HIGH, "rod_high", "length", "highest z of it")                                    \
    X(NUMBER_ROD_BREADTH, "rod_breadth", "length",                                                 \
      "how broad it is in space; absent: as the face")                                             \
    X(NUMBER_MU_M, "mu_macroscopic", "1", "mu_M; absent until known")                              \
    X(NUMBER_L_C, "critical_length", "length",                                                     \
      "l_c from the dynamics; absent until known, and with several pads")

typedef enum ResultSeries {
#define X(symbol, name, type, columns, unit, description) symbol,
    RESULT_SERIES(X) RESULT_SERIES_COUNT
#undef X
} ResultSeries;

typedef enum ResultNodes {
#define X(symbol, name, type, unit, description) symbol,
    RESULT_NODES(X) RESULT_NODES_COUNT
#undef X
} ResultNodes;

typedef enum ResultFaces {
#define X(symbol, name, type, unit, description) symbol,
    RESULT_FACES(X) RESULT_FACES_COUNT
#undef X
} ResultFaces;

typedef enum ResultProbes {
#define X(symbol, name, type, unit, description) symbol,
    RESULT_PROBES(X) RESULT_PROBES_COUNT
#undef X
} ResultProbes;

typedef enum ResultTable {
#define X(symbol, name, unit, description) symbol,
    RESULT_TABLES(X) RESULT_TABLES_COUNT
#undef X
} ResultTable;

typedef enum ResultNumber {
#define X(symbol, name, unit, description) symbol,
    RESULT_NUMBERS(X) RESULT_NUMBERS_COUNT
#undef X
} ResultNumber;

#endif
