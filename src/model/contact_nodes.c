// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/contact_nodes.h"

#include "base/formula.h"
#include "base/memory.h"
#include "fem/mesh.h"
#include "scene/friction_law.h"
#include "scene/profile.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool look_up(const void *context, const char *name, double *value)
{
    const double *y = context;
    if (!y || strcmp(name, "y") != 0) return false;
    *value = *y;
    return true;
}

// Reads a formula of a place in the contact, such as friction.along and contact.gap: it has one
// variable, x; y is a number in it, and it is read anew at each y. y: NULL in the plane, where
// there is no such name.
static bool read_place_formula(const char *text, const double *y, Formula *formula, Error *err)
{
    FormulaNames names = {.look_up = look_up,
                          .context = y,
                          .variable = "x",
                          .unknown = y ? "is no number here: x and y alone"
                                       : "is no number here: x alone"};
    return formula_read(text, &names, formula, err);
}

// --- friction laws ------------------------------------------------------------------------------

enum { SAMPLES = 32 };   // of a formula over the part of a node; exact where it is straight

// Part of the contact that a node stands for: a segment along x, in space a square in it.
typedef struct Part {
    double from, to;   // places, length
    double y[2];   // likewise; not used in the plane
} Part;

// The mean over a part: by the factor of the node's place alone a jump would lie up to half a cell
// off, and mu of all meshes that share this would agree on what it makes of it. Not weighted by
// shape functions, as those of order 2 are negative in places. text: a formula of x, in space also
// of y; empty: 1.
static bool take_mean(Part part, bool plane, const char *text, double *factor, Error *err)
{
    Formula formula;
    double ignored, mean = 0;
    int32_t rows = plane ? 1 : SAMPLES, taken = 0;
    if (!*text) return true;
    for (int32_t j = 0; j < rows; j++) {
        double y = part.y[0] + (j + 0.5) / rows * (part.y[1] - part.y[0]);
        if (!read_place_formula(text, plane ? NULL : &y, &formula, err)) return false;
        for (int32_t k = 0; k < SAMPLES; k++) {
            double x = part.from + (k + 0.5) / SAMPLES * (part.to - part.from);
            double value = formula_at(&formula, x, &ignored);
            if (!(value >= 0 && isfinite(value)))
                return REFUSE(err, "at x = %g the factor is %g; a number >= 0 is needed", x, value);
            mean += (value - mean) / ++taken;   // to the bit the value where it is level
        }
    }
    *factor *= mean;
    return true;
}

// Makes the laws: the scene's, and behind it that of item k at law_of[k]. Nodes of one law point to
// one entry, so that both sides of a contact can be compared (stepping/half_step).
static bool make_laws(Model *model, int32_t law_of[SCENE_CONTACT_LAWS_MAX], Error *err)
{
    const Scene *scene = model->scene;
    const SceneContactLaws *items = &scene->contact_laws;
    const Interface *interface = &model->interface;
    int32_t count = 1;
    const char *word = "law";
    char key[40];

    // Each item is of a group of contact that is there.
    for (int32_t k = 0; k < items->count; k++) {
        bool found = false;
        for (int32_t p = 0; p < interface->pad_count; p++)
            found = found || mesh_piece_is_of(interface->pad_name[p], items->item[k].group);
        if (!found)
            found = REFUSE(err, "`%s` is no contact group; the first is `%s`, of %d",
                           items->item[k].group, interface->pad_name[0], interface->pad_count);
        if (!scene_blame(scene, "friction.contacts", found, err)) return false;
    }
    model->laws = NEW_ARRAY(FrictionLaw, items->count + 1, err);
    if (!model->laws) return false;
    bool made = scene_law_at(scene, model->pressure, &model->laws[0], &word, err);
    snprintf(key, sizeof key, "friction.%s", word);
    if (!scene_blame(scene, key, made, err)) return false;
    for (int32_t k = 0; k < items->count; k++) {
        const SceneContactLaw *item = &items->item[k];
        law_of[k] = scene_has_contact_law(item) ? count : 0;
        for (int32_t j = 0; j < k && law_of[k] > 0; j++) {
            const SceneContactLaw *other = &items->item[j];
            bool same = other->kind == item->kind && other->mu_static == item->mu_static &&
                        other->mu_kinetic == item->mu_kinetic &&
                        other->critical_velocity == item->critical_velocity &&
                        strcmp(other->formula, item->formula) == 0;
            if (law_of[j] > 0 && same) law_of[k] = law_of[j];
        }
        if (law_of[k] < count) continue;
        made = scene_contact_law(scene, item, model->pressure, &model->laws[count], err);
        if (!scene_blame(scene, "friction.contacts", made, err)) return false;
        count++;
    }
    return true;
}

bool model_lay_laws(Model *model, Error *err)
{
    const Scene *scene = model->scene;
    const Interface *interface = &model->interface;
    int32_t count = interface->contact_count, law_of[SCENE_CONTACT_LAWS_MAX];
    bool plane = !interface->y;
    Part part = {0};
    bool alike = scene->contact_laws.count == 0 && !*scene->friction_keys.along;
    if (alike && !scene->friction.remembers) return true;
    if (!make_laws(model, law_of, err)) return false;
    model->friction_nodes = NEW_ARRAY(FrictionNode, count, err);
    if (!model->friction_nodes) return false;

    // The box around the contact, in space.
    Part all = {interface->x[0], interface->x[count - 1], {INFINITY, -INFINITY}};
    for (int32_t i = 0; !plane && i < count; i++) {
        all.y[0] = fmin(all.y[0], interface->y[i]);
        all.y[1] = fmax(all.y[1], interface->y[i]);
    }
    for (int32_t i = 0; i < count; i++) {
        // `item` is the number of the item for the piece of contact on which the node lies, else of
        // the one for its group; -1: there is none.
        const SceneContactLaws *laws = &scene->contact_laws;
        const char *pad = interface->pad_name[interface->pad[i]];
        int32_t item = -1;
        for (int32_t k = 0; k < laws->count && item < 0; k++)
            if (strcmp(laws->item[k].group, pad) == 0) item = k;
        for (int32_t k = 0; k < laws->count && item < 0; k++)
            if (mesh_piece_is_of(pad, laws->item[k].group)) item = k;

        double factor = 1, x = interface->x[i], weight = interface->weight[i];
        if (plane) {
            // The part that node i stands for, behind that of the node before it: as long as its
            // weight, so that parts tile each connected piece of the contact and sums of w_i f_i
            // are integrals. Within an edge they meet where weights do: half way between its nodes,
            // or, of order 2 with Simpson's weights, at 1/6 and 5/6 of it. So each holds its node,
            // and is centred at it unless cells differ or end there. The first node of a piece,
            // which may belong to several pads, begins its part itself: the part before then ended
            // at its own node.
            bool begins = i == 0 || part.to - interface->x[i - 1] < 1e-6 * weight;
            double from = begins ? x : part.to;
            part = (Part){from, from + weight, {0}};
        } else {
            // A square around the node, as large as its weight, as far as it lies within the box.
            double half = 0.5 * sqrt(weight), y = interface->y[i];
            part = (Part){fmax(x - half, all.from),
                          fmin(x + half, all.to),
                          {fmax(y - half, all.y[0]), fmin(y + half, all.y[1])}};
        }
        bool done = take_mean(part, plane, scene->friction_keys.along, &factor, err);
        if (!scene_blame(scene, "friction.along", done, err)) return false;
        done = item < 0 || take_mean(part, plane, laws->item[item].along, &factor, err);
        if (!scene_blame(scene, "friction.contacts", done, err)) return false;
        model->friction_nodes[i] = friction_node(&model->laws[item < 0 ? 0 : law_of[item]], factor);
    }
    model->friction = friction_of_nodes(model->friction_nodes, count);
    return error_is_clean(err);
}

// --- gaps ---------------------------------------------------------------------------------------

// Measured no farther than the contact nodes reach: what lies beyond is not guessed.
static bool reaches_over(const char *path, const char *axis, const double measured[2],
                         const double contact[2], Error *err)
{
    // Rounding of positions, over the contact's length: a file may hold five digits, and this is
    // far less than a cell.
    static const double ROUNDING = 1e-4;
    double slack = ROUNDING * (contact[1] - contact[0]);
    if (measured[0] > contact[0] + slack || measured[1] < contact[1] - slack)
        return REFUSE(
            err,
            "%s goes from %s = %g to %g, the contact from %g to %g: it must reach over all of it",
            path, axis, measured[0], measured[1], contact[0], contact[1]);
    return true;
}

static bool add_profile(const Scene *scene, Interface *interface, Error *err)
{
    SceneProfile profile = {0};
    const char *path = scene->contact.profile;
    const double *y = interface->y;
    int32_t count = interface->contact_count;
    TRY(scene_profile_read(scene, &profile, err));
    if (profile.y && !y)
        FAIL(err, ERROR_INPUT, "%s has x, y and gap, but the mesh is in the plane: there is no y",
             path);
    TRY(reaches_over(path, "x", (double[]){profile.x[0], profile.x[profile.count - 1]},
                     (double[]){interface->x[0], interface->x[count - 1]}, err));
    if (profile.y) {
        double reach[2] = {y[0], y[0]};
        for (int32_t i = 0; i < count; i++) {
            reach[0] = fmin(reach[0], y[i]);
            reach[1] = fmax(reach[1], y[i]);
        }
        TRY(reaches_over(path, "y", (double[]){profile.y[0], profile.y[profile.rows - 1]}, reach,
                         err));
    }
    for (int32_t i = 0; i < count; i++)
        interface->gap[i] += scene_profile_at(&profile, interface->x[i], y ? y[i] : 0);
cleanup:
    scene_profile_destroy(&profile);
    return error_is_clean(err);
}

bool model_lay_gaps(Model *model, Error *err)
{
    const Scene *scene = model->scene;
    Interface *interface = &model->interface;
    Formula formula;
    bool profile = *scene->contact.profile;
    if (!*scene->contact.gap && !profile) return true;
    if (!interface->gap && !(interface->gap = NEW_ARRAY(double, interface->contact_count, err)))
        return false;

    // The formula: in the plane it is read once, in space anew for the y of each node.
    for (int32_t i = 0; *scene->contact.gap && i < interface->contact_count; i++) {
        const double *y = interface->y ? &interface->y[i] : NULL;
        double ignored, gap = 0;
        bool done = true;
        if (i == 0 || y) done = read_place_formula(scene->contact.gap, y, &formula, err);
        if (done) gap = formula_at(&formula, interface->x[i], &ignored);
        if (done && !(gap >= 0 && isfinite(gap)))
            done = REFUSE(err, "at x = %g the gap is %g; a number >= 0 is needed", interface->x[i],
                          gap);
        if (!scene_blame(scene, "contact.gap", done, err)) return false;
        interface->gap[i] += gap;
    }
    return !profile ||
           scene_blame(scene, "contact.profile", add_profile(scene, interface, err), err);
}
