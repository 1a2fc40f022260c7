// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_make.h"

#include "friction/friction_look.h"
#include "friction/friction_start.h"

#include <math.h>
#include <string.h>

// `word` stands in `words`, which have blanks between them. words NULL: there are none.
static bool has_word(const char *words, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = words; at; at = strchr(at, ' ')) {
        at += *at == ' ';
        if (strncmp(at, word, length) == 0 && (at[length] == ' ' || !at[length])) return true;
    }
    return false;
}

FrictionUse friction_use(const FrictionLaw *law, const char *key)
{
    const FrictionOperations *operations = friction_operations(law);
    if (has_word(operations->must, key)) return FRICTION_MUST;
    bool may = has_word(operations->may, key) || has_word("law along contacts", key);
    return may ? FRICTION_MAY : FRICTION_UNUSED;
}

bool friction_make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    const FrictionOperations *operations = friction_operations(law);
    if (operations->own) law->end = source->end;
    if (operations->rested) {
        if (!(source->rest > 0) && !(source->rod_velocity > 0))
            return REFUSE_AT(err, key, "rest",
                             "missing: without a rod that moves nothing says what the contacts "
                             "remember; allowed: a number > 0");
        law->remembers = true;
        law->states = 1;
        law->start[0] = source->rest > 0 ? friction_rested(law, source->rest)
                                         : operations->steady(law, source->rod_velocity);
    }
    if (operations->make && !operations->make(source, law, key, err)) return false;
    if (!operations->own) return true;
    if (!law->remembers) return ERROR_AT(key, operations->mu_key, friction_look(law, err));
    if (law->feels_pressure && isnan(source->pressure))
        return true;   // made again when it is known
    return friction_start(source, law, key, err);
}
