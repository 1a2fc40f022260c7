// SPDX-License-Identifier: GPL-2.0-or-later
// Maps of few keys. Called by all that read a study.
#ifndef AMONTONS_STUDY_SWEEP_READING_WANTED_KEYS_H
#define AMONTONS_STUDY_SWEEP_READING_WANTED_KEYS_H

#include "io/text/yaml_document.h"

typedef struct WantedKey {
    const char *name;   // "by"
    YamlNode node;   // found under it; YAML_NO_NODE: not given
} WantedKey;

enum { WANTED_KEYS_MAX = 16 };

// Finds `keys` ([count]) in `map`, called `what`; refuses every other key.
bool wanted_find(const YamlDocument *file, YamlNode map, const char *what, WantedKey *keys,
                 int32_t count, Error *err);
// The index in `words` ([count]) of the text at `key`, which may be missing: 0 then.
bool wanted_choice(const YamlDocument *file, const WantedKey *key, const char *const *words,
                   int32_t count, int32_t *choice, Error *err);

#endif
