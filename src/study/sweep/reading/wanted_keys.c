// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/reading/wanted_keys.h"

#include "base/text.h"

#include <stdio.h>
#include <string.h>

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
