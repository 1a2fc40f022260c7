// SPDX-License-Identifier: GPL-2.0-or-later
// Makes the label of a figure's axis for a column of a sweep's table.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_QUANTITY_LABEL_H
#define AMONTONS_STUDY_SWEEP_SHOWING_QUANTITY_LABEL_H

#include <stdbool.h>
#include <stddef.h>

enum { QUANTITY_LABEL_SIZE = 90 };

typedef struct QuantityLabel {
    char words[QUANTITY_LABEL_SIZE];
    const char *unit;   // of SI, to be written with the prefix that suits; NULL: none
    const char *column;   // what tables of measurements call it; NULL: no name of its own
} QuantityLabel;

const char *label_last_word(const char *key);   // "length" of mesh.set.length
// "~{P}_{ext}" of load.pressure; a key without symbol is its last word. size: of `symbol`.
void label_symbol(const char *key, char *symbol, size_t size);
// The paper's symbol where there is one, with render/canvas/text's marks. name: as `record` has it.
QuantityLabel label_of_record(const char *name);
// "pressure" and "Pa", or "pressure / E" in normalised units.
QuantityLabel label_of_key(const char *name, bool is_si);

#endif
