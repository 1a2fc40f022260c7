// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/contact_laws.h"

#include "base/memory.h"
#include "scene/contact_laws.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 32 };   // of a formula over the part of a node; exact where it is straight

static bool no_name(const void *context, const char *name, double *value)
{
    (void)context, (void)name, (void)value;
    return false;
}

// Where the part of the contact begins that node i stands for: as long as its weight, behind those
// of the nodes of its pad before it.
static double part_of(const Interface *interface, int32_t i)
{
    double from = NAN;
    for (int32_t k = 0; k < i; k++) {
        if (interface->pad[k] != interface->pad[i]) continue;
        from = (isnan(from) ? interface->x[k] : from) + interface->weight[k];
    }
    return isnan(from) ? interface->x[i] : from;
}

// Of node i, the mean over its part: taken at its place alone, a jump would lie up to half a cell
// off, and mu of all meshes that share this would agree on what it makes of it. text: a formula of
// x, empty: 1.
static bool factor_at(const Interface *interface, int32_t i, const char *text, double *factor,
                      Error *err)
{
    static const FormulaNames names = {no_name, NULL, "x", "is no number here: x alone"};
    Formula formula;
    double ignored, sum = 0;
    if (!*text) return true;
    TRY(formula_read(text, &names, &formula, err));
    double from = part_of(interface, i);
    for (int32_t k = 0; k < SAMPLES; k++) {
        double x = from + (k + 0.5) / SAMPLES * interface->weight[i];
        double value = formula_at(&formula, x, &ignored);
        if (!(value >= 0 && isfinite(value)))
            FAIL(err, ERROR_INPUT, "at x = %g the factor is %g; a number >= 0 is needed", x, value);
        sum += value;
    }
    *factor *= sum / SAMPLES;
cleanup:
    return error_is_clean(err);
}

// The item of the curve on which node i lies; NULL: none.
static const SceneContactLaw *item_of(const Model *model, int32_t i)
{
    const SceneContactLaws *laws = &model->scene->contact_laws;
    const char *name = model->interface.pad_name[model->interface.pad[i]];
    for (int32_t k = 0; k < laws->count; k++)
        if (strcmp(laws->item[k].group, name) == 0) return &laws->item[k];
    return NULL;
}

static bool check_groups(const Model *model, Error *err)
{
    const SceneContactLaws *laws = &model->scene->contact_laws;
    const Interface *interface = &model->interface;
    for (int32_t k = 0; k < laws->count; k++) {
        bool found = false;
        for (int32_t p = 0; p < interface->pad_count; p++)
            found = found || strcmp(interface->pad_name[p], laws->item[k].group) == 0;
        if (!found)
            FAIL(err, ERROR_INPUT, "`%s` is no contact curve; the first is `%s`, of %d",
                 laws->item[k].group, interface->pad_name[0], interface->pad_count);
    }
cleanup:
    return error_is_clean(err);
}

bool model_lay_laws(Model *model, Error *err)
{
    const Scene *scene = model->scene;
    const Interface *interface = &model->interface;
    int32_t count = interface->contact_count;
    if (scene->contact_laws.count == 0 && !*scene->own_friction.along) return true;
    TRY(scene_blame(scene, "friction.contacts", check_groups(model, err), err));
    TRY((model->node_laws = NEW_ARRAY(FrictionLaw, count, err)));
    for (int32_t i = 0; i < count; i++) {
        const SceneContactLaw *item = item_of(model, i);
        double factor = 1;
        bool done = factor_at(interface, i, scene->own_friction.along, &factor, err);
        TRY(scene_blame(scene, "friction.along", done, err));
        done = !item || factor_at(interface, i, item->along, &factor, err);
        TRY(scene_blame(scene, "friction.contacts", done, err));
        FrictionLaw law = scene->friction;
        done = !item || scene_contact_law(scene, item, &law, err);
        TRY(scene_blame(scene, "friction.contacts", done, err));
        model->node_laws[i] = friction_scaled(&law, factor);
    }
    model->law = friction_spread(model->node_laws, count);
cleanup:
    return error_is_clean(err);
}
