// SPDX-License-Identifier: GPL-2.0-or-later
// Functions on scenes for callers of the library; scene_read reads scenes.
#include "scene/scene.h"

#include "amontons.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "base/text.h"
#include "scene/keys.h"

#include <string.h>

static bool read_new(const char *path, const char *const *overrides, int32_t override_count,
                     bool trusted, Scene **scene, Error *err)
{
    *scene = NULL;
    Scene *made = NEW_ARRAY(Scene, 1, err);
    TRY(made);
    if (!decimal_point_is_set()) FAIL(err, ERROR_MEMORY, "no memory for a locale with a point");
    TRY(scene_read(path, overrides, override_count, trusted, made, err));
    *scene = made;
    made = NULL;
cleanup:
    memory_free(made);
    return error_is_clean(err);
}

bool amontons_scene_read(const char *path, const char *const *overrides, int32_t override_count,
                         Scene **scene, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    return read_new(path, overrides, override_count, false, scene, err);
}

bool amontons_scene_read_trusted(const char *path, const char *const *overrides,
                                 int32_t override_count, Scene **scene, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    return read_new(path, overrides, override_count, true, scene, err);
}

void amontons_scene_destroy(Scene *scene)
{
    memory_free(scene);
}

bool amontons_scene_is_si(const Scene *scene)
{
    return scene->units == UNITS_SI;
}

const char *amontons_scene_title(const Scene *scene)
{
    return scene->title;
}

bool amontons_scene_reference(FILE *out, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    scene_write_reference(out);
    if (fflush(out) != 0 || ferror(out))
        return FAULT(err, ERROR_FILE, "cannot write the key reference");
    return true;
}

int32_t amontons_nearest_name(const char *word, const char *const *names, int32_t count)
{
    return text_nearest(word, names, count);
}
