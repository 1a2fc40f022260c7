// SPDX-License-Identifier: GPL-2.0-or-later
// Functions that the files that read a study share.
#include "study/sweep/reading/study.h"

#include "base/memory.h"
#include "base/text.h"
#include "base/units.h"
#include "scene/items.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Reads a finite number without a unit.
bool study_plain_number(const Study *study, YamlNode node, double *value)
{
    const char *text = yaml_text(study->file, node);
    int32_t length = text_number(text, value);
    return yaml_kind(study->file, node) == YAML_SCALAR && length > 0 && !text[length] &&
           isfinite(*value);
}

bool study_pair(const Study *study, YamlNode node, const char *key, double pair[2],
                char unit[STUDY_UNIT_SIZE])
{
    const char *total, *dimension = scene_dimension(key, &total);
    int32_t units = 0, read = 0;
    unit[0] = 0;
    if (yaml_kind(study->file, node) != YAML_LIST || yaml_count(study->file, node) != 2)
        return false;
    YAML_EACH (end, study->file, node) {
        const char *text = yaml_text(study->file, end);
        int32_t length = text_number(text, &pair[read]);
        if (study_plain_number(study, end, &pair[read++])) continue;
        length += (int32_t)strspn(text + length, " ");
        if (yaml_kind(study->file, end) != YAML_SCALAR || length == 0 || !dimension) return false;
        bool known = unit_to_si(text + length, dimension, &pair[read - 1]);
        if (!known && units == 0 && total) {   // both ends are of the whole block then
            dimension = total;
            known = unit_to_si(text + length, dimension, &pair[read - 1]);
        }
        if (!known) return false;
        units++;
    }
    if (units == 1) return false;   // both or none
    if (units == 2) {
        const char *base = unit_examples(dimension);
        snprintf(unit, STUDY_UNIT_SIZE, " %.*s", (int)strcspn(base, ","), base);
    }
    return true;
}

bool study_whole(const Study *study, const WantedKey *key, int32_t most, int32_t *value, Error *err)
{
    double number = 0;
    char allowed[60];
    if (key->node == YAML_NO_NODE) return true;
    bool good = study_plain_number(study, key->node, &number) && number == floor(number) &&
                number >= 1 && number <= most;
    *value = good ? (int32_t)number : 0;
    snprintf(allowed, sizeof allowed, "a whole number from 1 to %d", most);
    return good || yaml_refuse(study->file, key->node, key->name, allowed, err);
}

// -1: no key of this name varies.
int32_t study_column(const Study *study, const char *name)
{
    for (int32_t k = 0; k < study->column_count; k++)
        if (strcmp(study->columns[k], name) == 0) return k;
    return -1;
}

// A key that is given in several places is one column.
int32_t study_add_column(Study *study, const char *key, Error *err)
{
    int32_t column = study_column(study, key);
    if (column >= 0) return column;
    if (study->column_count < STUDY_COLUMNS_MAX) {
        snprintf(study->columns[study->column_count], STUDY_NAME_SIZE, "%s", key);
        return study->column_count++;
    }
    FAIL(err, ERROR_INPUT, "%s: more than %d keys vary", study->path, STUDY_COLUMNS_MAX);
cleanup:
    return -1;
}

const char *study_find_given(const Study *study, const bool *among, const char *key,
                             const YamlDocument *document, YamlNode node)
{
    int32_t column = study_column(study, key);
    if (column >= 0 && among[column]) return study->columns[column];
    YAML_EACH (item, document, node) {
        char path[STUDY_NAME_SIZE];
        snprintf(path, sizeof path, "%.40s.%.50s", key, yaml_key(document, item));
        const char *found = study_find_given(study, among, path, document, item);
        if (found) return found;
    }
    return NULL;
}

// Frees a study that is half read, too.
void study_destroy(Study *study)
{
    for (int32_t k = 0; k < study->made_count; k++) yaml_destroy(study->made[k]);
    for (int32_t k = 0; k < STUDY_AXES_MAX; k++) memory_free(study->axes[k].values);
    for (int32_t k = 0; k < study->design_count; k++) {
        memory_free(study->designs[k].text);
        yaml_destroy(study->designs[k].file);
    }
    memory_free_all(study->designs, study->case_list);
    yaml_destroy(study->file);
    scene_source_close(study->source);
    *study = (Study){.set = YAML_NO_NODE, .cases = YAML_NO_NODE, .rank.baseline = YAML_NO_NODE};
}

// --- maps of few keys ---------------------------------------------------------------------------

bool wanted_find(const YamlDocument *file, YamlNode map, const char *what, WantedKey *keys,
                 int32_t count, Error *err)
{
    char allowed[160] = "; allowed: ", hint[TEXT_HINT_SIZE];
    const char *names[WANTED_KEYS_MAX];
    for (int32_t k = 0; k < count; k++) {
        size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s", k ? ", " : "", keys[k].name);
        keys[k].node = YAML_NO_NODE;
        names[k] = keys[k].name;
    }
    if (yaml_kind(file, map) != YAML_MAP)
        return yaml_refuse(file, map, what, "a map, as in {by: mu_M}, {x: load.pressure}", err);
    YAML_EACH (item, file, map) {
        const char *key = yaml_key(file, item);
        int32_t k = 0;
        while (k < count && strcmp(key, names[k]) != 0) k++;
        if (k == count)
            return yaml_key_error(file, item, err, "%s: unknown key `%.60s`%s", what, key,
                                  text_hint(key, names, count, allowed, hint));
        keys[k].node = item;
    }
    return true;
}

bool wanted_choice(const YamlDocument *file, const WantedKey *key, const char *const *words,
                   int32_t count, int32_t *choice, Error *err)
{
    char allowed[100] = "";
    *choice = 0;
    if (key->node == YAML_NO_NODE) return true;
    for (int32_t k = 0; k < count; k++) {
        size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s", k ? ", " : "", words[k]);
        if (strcmp(yaml_text(file, key->node), words[k]) != 0) continue;
        *choice = k;
        return true;
    }
    return yaml_refuse(file, key->node, key->name, allowed, err);
}
