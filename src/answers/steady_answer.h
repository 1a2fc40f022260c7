// SPDX-License-Identifier: GPL-2.0-or-later
// The answer of a run that ends in steady sliding (record/steady), and what mu_M of a run is.
// Called by run/ at the end of a run.
#ifndef AMONTONS_ANSWERS_STEADY_ANSWER_H
#define AMONTONS_ANSWERS_STEADY_ANSWER_H

#include "answers/answers.h"
#include "record/steady.h"

// Where no bulk sliding counts mu_M is that of steady sliding, its error half the range in which it
// keeps; other meshes have another, as with load drops.
void steady_answer(const Steady *steady, Answers *answers);
// The meaning of mu_M: "peaks", "steady sliding", or "none: " and why.
const char *steady_words(const Steady *steady, const Answers *answers);   // static storage
// Into results: mu_M_is, mu_steady, its error and from where on.
void steady_write_json(const Steady *steady, const Answers *answers, JsonWriter *json);

#endif
