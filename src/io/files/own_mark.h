// SPDX-License-Identifier: GPL-2.0-or-later
// Every file that any command writes, by its name, and what each of ours of that name holds: whose
// a file is says its content. Nothing else is written over (io/files/part_file). A new file needs a
// row here (ctest -R own_files).
#ifndef AMONTONS_IO_FILES_OWN_MARK_H
#define AMONTONS_IO_FILES_OWN_MARK_H

#include "base/error.h"

// X(pattern of the name, or of folder and name, mark); the first that fits counts. No mark: ours by
// the name alone, as such a name is in a folder of our own. Tables have no comment in their first
// line, which would break their readers: they are told by the columns that all of ours have.
#define OWN_REPORT "\"status\": \""
#define OWN_SHORT "\"status\":"   // of a line of many reports
#define OWN_MARKS(X)                                                                               \
    X("run.json", OWN_REPORT)                                                                      \
    X("static.json", OWN_REPORT)                                                                   \
    X("stability.json", OWN_REPORT)                                                                \
    X("model1d.json", OWN_REPORT)                                                                  \
    X("checkpoint.bin", "amontons-state")                                                          \
    X("history.h5", "series")                                                                      \
    X("static.h5", "contact")                                                                      \
    X("stability.h5", "critical")                                                                  \
    X("model1d.h5", "profile")                                                                     \
    X("sweep.h5", "result")                                                                        \
    X("fields.pvd", "<Collection>\n")                                                              \
    X("static.vtu", "stress_elastic")                                                              \
    X("bulk_*.vtu", "stress_elastic")                                                              \
    X("interface_*.vtp", "slip_rate")                                                              \
    X("sweep.csv", ",status,message,warnings,run\n")                                               \
    X("ranking.csv", "rank,rank_from,rank_to,point,")                                              \
    X("fit.csv", "condition,name,along,at,measured,")                                              \
    X("best.yaml", "{\n  \"title\": \"")                                                           \
    X("answer.txt", "amontons run ")                                                               \
    X("reports", OWN_SHORT)                                                                        \
    X("accuracy.json", "\"contact nodes\"")                                                        \
    X("array.sh", " sweep --element ")                                                             \
    X("slurm/designs", "")                                                                         \
    X("share-*.points", "")                                                                        \
    X("share-*.reports", OWN_SHORT)                                                                \
    X("running", "")                                                                               \
    X("lock", "")                                                                                  \
    X("*.lock", "")                                                                                \
    X("figures/force.csv", "F_T/F_N\n")                                                            \
    X("figures/slip-map.csv", ",x")                                                                \
    X("figures/state-map.csv", ",least ")                                                          \
    X("figures/precursors.csv", "F_T/F_N,l/L\n")                                                   \
    X("figures/front-speed.csv", "x/L,v/c_R\n")                                                    \
    X("figures/*-compared.csv", ",computed")                                                       \
    X("figures/*.json", "{\n  \"title\": \"")                                                      \
    X("figures/*.h5", "description")                                                               \
    X("*.html", "<meta name='generator' content='amontons ")                                       \
    X("*.png", "Software\0amontons ")                                                              \
    X("*.pdf", "/Creator (amontons ")                                                              \
    X("*.svg", "<!-- amontons ")                                                                   \
    X("*.mp4", "made by amontons ")                                                                \
    X("*.webm", "made by amontons ")                                                               \
    X("*.gif", "made by amontons ")                                                                \
    X("*.@(shape|basis|modes|upper|field|mesh)", "")

// What a film says of its maker.
#define OWN_FILM "made by amontons " AMONTONS_VERSION

// Whether the file `path` is ours: a file, no link, that is empty or holds its mark.
bool own_mark_is_in(const char *path);

// ERROR_INPUT: `path` is there and is not ours. Names that the table lacks are not looked at.
bool own_mark_check(const char *path, Error *err);

#endif
