// SPDX-License-Identifier: GPL-2.0-or-later
// A plot described in a YAML (or JSON) file: curves, marks, error bars, levels, maps. Studies write
// such files; `amontons render PLOT.yaml` draws them.
//
//     title: mu_M against pressure            # above the plot
//     height: 0.75                            # over the width; default 0.75
//     x: {label: "~{P}_{ext}", scale: log, range: [1e-3, 1e-1]}   # linear; the data's
//                                             # unit: Pa beside a label: written behind it, as
//                                             # kPa or MPa where that makes the numbers short
//     y: {label: "~{\u03bc}_{M}"}          # or {names: [a, b]}: these stand at y = 1, 2, ...
//     legend: below                           # the frame; or none
//     series:
//       - label: "~{L} = 1"                   # none: not in the legend
//         x: [0.001, 0.01]
//         y: [0.38, 0.24]                     # null: a gap
//         low: [0.37, 0.23]                   # with `high`: error bars, along x where y has names
//         high: [0.38, 0.25]
//         color: 1                            # of seven; 0: ink
//         marker: circle                      # or square, triangle, down, cross, none
//         filled: false
//         line: thin                          # or solid, dashed, none
//     inset: {place: [0.5, 0.05, 0.97, 0.5], x: ..., y: ..., series: [...]}   # of the frame;
//                                             # its series are not in the legend
//
//     x: {column: load.pressure}              # what the column is called in page.compare's table
//     page: {style: columns, height: 60, legend: none}   # an option of `amontons render`; what the
//                                             # command is given goes before it
//
// A map shows in colours what was found at points; those of a grid as cells, half way to their
// neighbours, others as discs. Contours are of a grid alone:
//
//     color: {label: "~{\u03bc}_{M}"}             # or with unit and range, as an axis
//     contours: {label: "~{l}_{c} / ~{L}"}     # lines at handy values (MAP_MANY: of medians)
//     map: {x: [...], y: [...], value: [...], contour: [...], open: [0, 1, 2, ...]}
//                                             # open 1: a ring, 2: a square around the point
//
// Several panels with the same axes on one page; what stands beside `panels` is drawn in each:
//
//     panels: [{title: "~{V} = 1", series: [...]}, {title: ..., map: {...}}]
//
// In the place of any list of numbers may stand the column of a table, FILE.h5:NAME, as seen from
// the plot's folder: "../sweep.h5:result/mu_M".
#ifndef AMONTONS_RENDER_PLOT_PLOT_FILE_H
#define AMONTONS_RENDER_PLOT_PLOT_FILE_H

#include "render/plot/plot.h"

// ERROR_INPUT gives file:line:column, the key and what is allowed.
bool plot_file_read(const char *path, Plot *plot, Error *err);

// The same of the file `name` inside of the folder `root`, which may be a stranger's: neither it
// nor its tables may lie elsewhere (io/files/folder). Measurements that lie elsewhere are read
// from NAME-compared.csv beside it, or left out: plot->left_out.
bool plot_file_read_inside(const char *root, const char *name, Plot *plot, Error *err);

void plot_destroy(Plot *plot);   // zeroed is fine

#endif
