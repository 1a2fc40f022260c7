// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/computing/record_check.h"

#include "base/text.h"
#include "io/text/json_reader.h"

#include <stdio.h>
#include <string.h>

enum { KEYS_MAX = 64 };

// The key of the object at `path` that is nearest to `given`; false: none is near.
static bool nearest_key(const char *report, const char *path, const char *given,
                        char key[STUDY_NAME_SIZE])
{
    char keys[KEYS_MAX][STUDY_NAME_SIZE];
    const char *names[KEYS_MAX];
    int32_t count = 0;
    while (count < KEYS_MAX && json_find_key(report, path, count, keys[count], STUDY_NAME_SIZE)) {
        names[count] = keys[count];
        count++;
    }
    int32_t nearest = text_nearest(given, names, count);
    if (nearest >= 0) memcpy(key, keys[nearest], STUDY_NAME_SIZE);
    return nearest >= 0;
}

// `path` word by word as run.json spells it; false: no such path is near.
static bool nearest_path(const char *report, const char *path, char nearest[STUDY_NAME_SIZE])
{
    *nearest = 0;
    while (*path) {
        char word[STUDY_NAME_SIZE], key[STUDY_NAME_SIZE];
        size_t length = strcspn(path, "."), used = strlen(nearest);
        snprintf(word, sizeof word, "%.*s", (int)length, path);
        bool is_index = length > 0 && strspn(word, "0123456789") == length;
        if (is_index)
            memcpy(key, word, sizeof key);
        else if (!nearest_key(report, nearest, word, key))
            return false;
        int more = snprintf(nearest + used, STUDY_NAME_SIZE - used, "%s%s", used ? "." : "", key);
        if (more < 0 || (size_t)more >= STUDY_NAME_SIZE - used) return false;
        path += length + (path[length] == '.');
    }
    return json_may_hold(report, nearest);
}

bool record_check(const Study *study, const char *report, Error *err)
{
    for (int32_t k = 0; k < study->record_count; k++) {
        const StudyRecord *record = &study->records[k];
        char known[STUDY_NAME_SIZE], first[STUDY_NAME_SIZE];
        if (record->node == YAML_NO_NODE || json_may_hold(report, record->path)) continue;
        if (json_find_key(report, record->path, 0, first, sizeof first))
            yaml_error(study->file, record->node, err,
                       "%s: `%s` of run.json has many values: name one, as in %s.%s",
                       record->given_by, record->path, record->path, first);
        else {
            bool near = nearest_path(report, record->path, known);
            yaml_error(study->file, record->node, err, "%s: run.json has no `%s`%s%s%s",
                       record->given_by, record->path, near ? "; did you mean `" : "",
                       near ? known : "", near ? "`?" : "");
        }
        return false;
    }
    return true;
}
