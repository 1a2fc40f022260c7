// SPDX-License-Identifier: GPL-2.0-or-later
// Makes the label of a figure's axis for a column of a sweep's table.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_QUANTITY_LABEL_H
#define AMONTONS_STUDY_SWEEP_SHOWING_QUANTITY_LABEL_H

#include <stdbool.h>

enum { QUANTITY_LABEL_SIZE = 90 };

typedef struct QuantityLabel {
    char words[QUANTITY_LABEL_SIZE];
    const char *unit;   // of SI, to be written with the prefix that suits; NULL: none
    const char *column;   // what tables of measurements call it; NULL: no name of its own
} QuantityLabel;

const char *label_last_word(const char *key);   // "length" of mesh.set.length
// Words with render/canvas/text's marks, the paper's symbol where there is one: "~{l}_{c}" of a
// result, called as `record` does; of a key "pressure ~{P}_{ext}" and "Pa", or in normalised units
// "pressure ~{P}_{ext} / ~{E}".
QuantityLabel quantity_label(const char *name, bool is_si);

#endif
