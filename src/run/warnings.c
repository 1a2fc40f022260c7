// SPDX-License-Identifier: GPL-2.0-or-later
// A contact node that slips alone gains energy when weakening gives it more than viscosity takes,
//
//     -mu' p w_i  >  S_C[t_i, t_i],     mu' the steepest, p the mean pressure, w_i the weight.
//
// S_C of one node hardly depends on the mesh and w_i shrinks with it, so this is a matter of
// element size: above it l_sc is shorter than an element. With branches of a material the least of
// S[t_i,t_i] over real rates takes the place of S_C, as what grows is no faster than they follow.
//
// Only the run shows whether the length over which slip runs away, on whichever pad it does, has
// enough cells. Of 48 blocks, pads and grooves (46 of set A, 2 of set B; those of validation/pads
// and Figure 1) on a mesh and on one of half the size, mu_hold moved by more than 0.7 % in 15 of 20
// with fewer than 8 cells there (median 0.9 %, largest 3.9 %), and in 7 of 28 with more (median 0.3
// %, largest 3.2 %).
#include "run/warnings.h"

#include "record/drops.h"
#include "friction/friction.h"
#include "model/step_rule.h"
#include "scene/keys.h"
#include "scene/materials.h"
#include "scene/programs.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void warnings_add(RunWarnings *warnings, const char *format, ...)
{
    if (warnings->count == RUN_WARNINGS_MAX) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(warnings->text[warnings->count++], RUN_WARNING_SIZE, format, arguments);
    va_end(arguments);
}

int32_t undamped_nodes(const Certificate *certificate, double load, double *worst)
{
    const Interface *interface = certificate->moving.interface;
    const Friction *friction = certificate->moving.contact_friction;
    double length = 0;
    *worst = 0;
    if (!certificate->alone || !(friction->drop > 0)) return 0;   // the scene was warned of
    int32_t count = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) length += interface->weight[i];
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double slope = friction_steepest(friction_at(friction, i));
        double ratio = slope * load / length * interface->weight[i] / certificate->alone[i];
        count += ratio > 1;
        *worst = ratio > *worst ? ratio : *worst;
    }
    return count;
}

bool warnings_of_viscosity(const Scene *scene, const Model *model, RunWarnings *warnings)
{
    if (!(friction_law_drop(model_law(model)) > 0) || amontons_scene_warning(scene)) return false;
    bool found = false;
    for (int32_t k = 0; k < model->materials.count; k++) {
        if (!model->on_contact[k] || model->materials.list[k].eta1 > 0) continue;
        found = true;
        warnings_add(warnings,
                     "eta1 is 0 in %s, which touches the floor: with friction that weakens, the "
                     "shortest wave that the mesh can hold grows fastest, so the answer has no "
                     "limit as the mesh gets finer (an ill-posed problem)",
                     k == 0 ? "material" : scene->materials.region[k - 1].group);
    }
    return found;
}

// A branch is a spring in a run where its time is so many of the run's: its stress falls by this
// part.
static const double STANDING = 1e3;

void warnings_of_branches(const Model *model, RunWarnings *warnings)
{
    if (model->folded_time > 0)
        warnings_add(
            warnings,
            "branches of `relaxation` with times of %.3g or less are taken as a viscosity: "
            "waves within an element are a thousand times slower",
            model->folded_time);
    double slowest = materials_relaxation_time(&model->materials);
    double end = step_rule_end(model->scene);
    if (end > 0 && slowest > STANDING * end)
        warnings_add(warnings,
                     "branches of `relaxation` with times up to %.3g do not relax in a run of "
                     "%.3g: they are springs in it%s",
                     slowest, end,
                     model->scene->start.state == START_RELAXED
                         ? ", which gave way while the block settled"
                         : "");
}

// A scene in units of eta1 has as its viscosity what its length makes of it; one in SI means a
// material.
void warnings_of_damping(const Model *model, RunWarnings *warnings)
{
    const Scene *scene = model->scene;
    const Material *floor = &model->materials.list[model->contact_region];
    double damping = material_wave_damping(floor, fmax(model->length, model->height));
    if (scene->units != UNITS_SI || !(floor->eta1 > 0) || damping <= 1) return;
    double rate = material_speeds(floor).shear / (2 * fmax(model->length, model->height));
    warnings_add(warnings,
                 "no wave runs in the block: eta1 of %s is %.3g times what damps its longest one "
                 "critically; a viscosity taken from slow motion does this; a table of E' and E'' "
                 "about %.3g Hz (material: {from: FILE}), or branches, have the damping of waves",
                 scene_region_name(scene, model->contact_region), damping, rate);
}

bool warnings_of_resolution(const Certificate *certificate, double load, RunWarnings *warnings)
{
    double worst = 0;
    int32_t undamped = undamped_nodes(certificate, load, &worst);
    if (undamped > 0)
        warnings_add(
            warnings,
            "slip is not resolved: friction weakens faster than viscosity can damp at %d of %d "
            "contact nodes, each taken alone; slip turns unstable on less than an element, and "
            "what comes out depends on the mesh; elements %.2g times as long would do",
            undamped, certificate->moving.interface->contact_count, 1 / worst);
    return undamped > 0;
}

// Cells on the length over which what is remembered makes slip unstable.
static const double MEMORY_CELLS = 8;

void warnings_of_memory(const Model *model, double load, RunWarnings *warnings)
{
    const Interface *interface = &model->interface;
    const Material *floor = &model->materials.list[model->contact_region];
    double shear = moduli_shear(material_elastic(floor)), length = 0, least = INFINITY;
    int32_t coarse = 0, count = interface->contact_count;
    if (!friction_remembers(&model->friction, count)) return;
    for (int32_t i = 0; i < count; i++) length += interface->weight[i];
    for (int32_t i = 0; i < count; i++) {
        const FrictionNode *node = friction_at(&model->friction, i);
        double state[STATES_MAX], lost = 0;   // of mu over slip
        FrictionRates rates;
        friction_start_state(node, state);
        friction_rates(node, model->scales.slip_velocity, state, &rates);
        for (int32_t k = 0; k < rates.states; k++)
            lost += fabs(rates.mu_state[k] * rates.rate_speed[k]);
        double reach = shear / (load / length * lost);
        double cell = interface->dim == 2 ? interface->weight[i] : sqrt(interface->weight[i]);
        coarse += MEMORY_CELLS * cell > reach;
        least = fmin(least, reach);
    }
    if (coarse > 0)
        warnings_add(warnings,
                     "slip is not resolved: what contacts remember is lost over so little slip "
                     "that it turns unstable on %.2g of length, and at %d of %d contact nodes "
                     "cells are longer than an eighth of it",
                     least, coarse, count);
}

// Largest displacement gradient without a warning. The theory of small strains leaves out half its
// square in the strains and its first power in where forces act, relative to what it keeps: at 5 %
// this is more than any error bar that a run gives.
static const double GRADIENT_SMALL = 0.05;

// Across how much of the block's length, in space of its floor, region k takes the load.
static double loaded_width(const Model *model, int32_t k)
{
    const Interface *interface = &model->interface;
    double width = model->materials.width[k] > 0 ? model->materials.width[k]
                                                 : model->length * model->breadth;
    double contact = 0;
    if (k != model->contact_region) return width;
    for (int32_t i = 0; i < interface->contact_count; i++) contact += interface->weight[i];
    return fmin(width, contact);
}

void warnings_of_strain(const Model *model, double mu, RunWarnings *warnings)
{
    const Materials *materials = &model->materials;
    double largest = GRADIENT_SMALL, push = fmax(mu, 0);
    int32_t worst = -1;
    if (model->system.dof_count == 0) return;   // the run failed before there was a block to step
    Schedule program = scene_schedule(&model->scene->load.program);
    double load = model->scales.load * schedule_largest(&program);
    for (int32_t k = 0; k < materials->count; k++) {
        if (materials->count > 1 && !(materials->area[k] > 0)) continue;
        double pressure = load / loaded_width(model, k);
        double gradient = material_gradient(&materials->list[k], pressure, push * pressure);
        if (gradient <= largest) continue;
        largest = gradient;
        worst = k;
    }
    if (worst < 0) return;
    const Material *material = &materials->list[worst];
    double pressure = load / loaded_width(model, worst);
    warnings_add(
        warnings,
        "strains are not small: at the largest load ratio, %.3g, the mean stresses shear `%s` by "
        "%.2g %% and compress it by %.2g %%; from %g %% on what the theory of small strains leaves "
        "out is more than the error bars: answers hold to that part only",
        push, scene_region_name(model->scene, worst),
        100 * material_gradient(material, 0, push * pressure),
        100 * material_gradient(material, pressure, 0), 100 * GRADIENT_SMALL);
}

double base_slip(const Model *model, const State *state)
{
    const Interface *interface = &model->interface;
    const double *x = interface->x;
    double slip = 0, weight = 0, low = INFINITY, high = -INFINITY;
    if (!model->mesh.is_base || !state->displacement) return NAN;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t dof = model->system.interface_dofs[interface_tangent(interface, i)];
        slip += interface->weight[i] * fabs(state->displacement[dof]);
        weight += interface->weight[i];
        low = fmin(low, x[i]);
        high = fmax(high, x[i]);
    }
    return slip / weight / (high - low);
}

// Slip over the length of the contact from which on pairs of the start are not those that touch.
static const double BASE_SLIP_SMALL = 0.05;

void warnings_of_base(double slip, RunWarnings *warnings)
{
    if (!(slip >= BASE_SLIP_SMALL)) return;   // NaN: no base
    warnings_add(warnings,
                 "the block went far over its base: %.2g %% of the contact's length; each contact "
                 "node stays with the piece of floor that it began on, so that ends and changes of "
                 "the base, and waves in it, are met where they were at the start",
                 100 * slip);
}

// Part of the way along the drive that the block's sides may go ahead or behind, or the block go
// across the drive, before a warning. A symmetric block keeps within rounding.
static const double ROTATION_SEEN = 0.01;

void warnings_of_rotation(const Scene *scene, const Rotation *rotation, RunWarnings *warnings)
{
    const char *unit = scene->units == UNITS_SI ? " m" : "";
    double share = rotation_share(rotation);
    if (share <= ROTATION_SEEN) return;
    warnings_add(warnings,
                 "the block does not go straight: it turned about z by %.2g rad and went %.2g%s "
                 "across the drive, on a way of %.2g%s: %.2g %% of it at its sides",
                 rotation->angle, rotation->drift, unit, rotation->way, unit, 100 * share);
}

static bool gives_parameter(const Scene *scene, const char *name)
{
    for (int32_t k = 0; k < scene->mesh.parameter_count; k++)
        if (strcmp(scene->mesh.parameters[k].name, name) == 0) return true;
    return false;
}

// Advice for a mesh with contact cells of half the size, by the parameters that the scene gives.
static const char *finer_mesh(const Scene *scene)
{
    static const struct {
        const char *parameter, *words;
    } ways[] = {{"size_contact", "halve mesh.set.size_contact"},
                {"cells_pad", "double mesh.set.cells_pad and cells_gap"},
                {"nx", "double mesh.set.nx"}};
    for (size_t w = 0; w < sizeof ways / sizeof ways[0]; w++)
        if (gives_parameter(scene, ways[w].parameter)) return ways[w].words;
    return "make the cells of the contact half as long (mesh.set.refine: 2 in the shipped meshes)";
}

void warnings_of_slip(const Scene *scene, const Interface *interface, const Event *least,
                      RunWarnings *warnings)
{
    char where[GROUP_NAME_SIZE + 32] = "the contact";
    if (!least || least->slip_cells >= SLIP_CELLS_ENOUGH) return;
    if (interface->pad_count > 1)
        snprintf(where, sizeof where, "pad \"%s\"", interface->pad_name[least->pad]);
    if (least->slip_cells == 0) {
        warnings_add(warnings,
                     "slip is not resolved: on %s a node went from rest to fast slip at once, with "
                     "no slow slip before: %s, and compare mu_M and mu_hold",
                     where, finer_mesh(scene));
        return;
    }
    warnings_add(warnings,
                 "slip is not resolved: slow slip turned fast when only %.3g cell%s of %s slipped "
                 "(a length of %.3g); with fewer than %g mu_M and mu_hold can be several per cent "
                 "off: %s, and compare",
                 least->slip_cells, least->slip_cells == 1 ? "" : "s", where, least->slip_length,
                 (double)SLIP_CELLS_ENOUGH, finer_mesh(scene));
}

void warnings_of_bar(const Levels *levels, RunWarnings *warnings)
{
    const ErrorBar *answer = levels_answer(levels, levels->asked);
    const Level *last = &levels->list[levels->count - 1];
    bool alike = levels_span_left(levels, levels->asked) > 1;
    if (isnan(answer->parts.mesh))
        warnings_add(warnings, "error bar not met: the mesh's part of it is not known (%s: %s)",
                     last->undamped       ? "cells are too long for slip"
                     : levels->count == 1 ? "one mesh"
                                          : "only the last mesh has an answer",
                     levels->ended);
    else
        warnings_add(warnings,
                     "error bar not met: %s is known to %.1f %%%s, asked for %.1f %% (%s)",
                     ANSWER_NAMES[levels->asked], 100 * answer->bar / answer->value,
                     alike ? " by meshes less than twice as fine as one another" : "",
                     100 * levels->wanted, levels->ended);
}

void warnings_of_last_mesh(const Levels *levels, RunWarnings *warnings)
{
    const Level *last = &levels->list[levels->count - 1];
    int32_t other = 0;
    while (levels->list[other].other_drops) other++;
    if (other > 0 && other == levels->count - 1)
        warnings_add(warnings,
                     "%s at the load drops of the last mesh than on all before it, of up to %d "
                     "contact nodes, which have no part in the answers",
                     last->pads > 1 ? "other pads slide" : "other parts of the contact slide",
                     levels->list[other - 1].contact_nodes);
    if (levels->count > 1 && levels_may_differ(levels) && levels_confirm_left(levels) > 1)
        warnings_add(warnings,
                     "on finer meshes %s: the bar is not confirmed, as no mesh four times as fine "
                     "as the first was reached (%s)",
                     last->pads > 1 ? "other pads may slide"
                                    : "other parts of the contact may slide",
                     levels->ended);
    for (AnswerKind kind = 0; kind < ANSWER_KINDS; kind++)
        if (last->answer[kind].apart)
            warnings_add(warnings,
                         "the last mesh and all meshes together disagree: %s is %.4f there and "
                         "%.4f by all%s",
                         ANSWER_NAMES[kind], level_value(last, kind), last->answer[kind].value,
                         isnan(last->answer[kind].bar)
                             ? ""
                             : ", so the error bar is as long as they are apart");
}

void warnings_of_shape(const Scene *scene, double length, double height, RunWarnings *warnings)
{
    if (height <= length || gives_parameter(scene, "height")) return;
    if (gives_parameter(scene, "length"))
        warnings_add(warnings,
                     "the block is %.3g times as high as long: mesh.set.length is given and "
                     "mesh.set.height is not, so it is %.4g, that of the mesh file, over a length "
                     "of %.4g: set mesh.set.height",
                     height / length, height, length);
}

// A block longer than this was drawn in mm, most likely, m.
static const double LENGTH_PLAUSIBLE = 20;
// Speeds of longitudinal waves in solids, m/s: soft gels have some 1, diamond 18 000.
static const double SOUND_SLOWEST = 0.2, SOUND_FASTEST = 3e4;

void warnings_of_units(const Model *model, RunWarnings *warnings)
{
    const Scene *scene = model->scene;
    if (scene->units != UNITS_SI) return;
    bool by_scene = scene->mesh.scale != 1 || scene->given[scene_key_index("mesh.unit")];
    if (model->length > LENGTH_PLAUSIBLE && !by_scene)
        warnings_add(
            warnings,
            "a block of %.3g m: an SI scene takes the coordinates of a mesh for metres; one "
            "that is drawn in mm needs `mesh: {unit: mm}`",
            model->length);
    for (int32_t k = 0; k < model->materials.count; k++) {
        const Material *material = &model->materials.list[k];
        double sound = material_speeds(material).longitudinal;
        if (sound >= SOUND_SLOWEST && sound <= SOUND_FASTEST) continue;
        warnings_add(
            warnings,
            "sound of %.3g m/s in `%s`: no solid has that; are Young's modulus, %.3g Pa, and "
            "density, %.4g kg/m3, in these units (3.3 GPa, 1190 kg/m3)?",
            sound, scene_region_name(scene, k), material->young, material->density);
        return;
    }
}

// Largest gap over the block's height, and steepest slope of a gap. The square of the slope is the
// error of pressing along z.
static const double GAP_LARGE = 0.5, GAP_STEEP = 0.2;

typedef struct Slope {
    double steepest;
    double at[2];   // x and y, half way between the nodes
} Slope;

// Notes the slope from contact node a to b, if one of them has a gap that may close.
static void note_slope(const Interface *interface, double reach, int32_t a, int32_t b, Slope *slope)
{
    const double *gap = interface->gap, *x = interface->x, *y = interface->y;
    double way = hypot(x[b] - x[a], y ? y[b] - y[a] : 0);
    double found = fabs(gap[b] - gap[a]) / way;
    if (fmin(gap[a], gap[b]) > reach || !(found > slope->steepest)) return;
    *slope = (Slope){found, {0.5 * (x[a] + x[b]), y ? 0.5 * (y[a] + y[b]) : 0}};
}

void warnings_of_gaps(const Model *model, RunWarnings *warnings)
{
    const Interface *interface = &model->interface;
    const double *gap = interface->gap;
    double largest = 0, least = INFINITY;
    if (!gap) return;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        largest = fmax(largest, gap[i]);
        least = fmin(least, gap[i]);
    }
    if (largest > GAP_LARGE * model->height)
        warnings_add(warnings,
                     "a gap as large as the block: up to %.3g under a block that is %.3g high; is "
                     "it in the scene's unit of length, and of the right sign?",
                     largest, model->height);
    // The block can reach gaps up to 10 times as deep as the mean pressure presses it down.
    double pressure = model->scales.load / (model->length * model->breadth);
    double reach = least + 10 * pressure / model->materials.mean.young * model->height;

    // The steepest slope between neighbours of a pad in the plane, in space between any two nodes
    // of a face.
    const ContactFaces *faces = &interface->faces;
    Slope slope = {.steepest = GAP_STEEP};
    int32_t count = interface->contact_count;
    for (int32_t i = 1; i < count && interface->dim == 2; i++)
        if (interface->pad[i] == interface->pad[i - 1])
            note_slope(interface, reach, i - 1, i, &slope);
    for (int32_t f = 0; f < faces->count; f++) {
        const int32_t *point = &faces->point[(int64_t)f * faces->width];
        int32_t points = contact_face_points(faces, f);
        for (int32_t a = 0; a < points; a++)
            for (int32_t b = 0; b < a; b++)
                if (point[a] < count && point[b] < count)   // the others are corners of T6
                    note_slope(interface, reach, point[a], point[b], &slope);
    }

    char across[40] = "";
    if (interface->y) snprintf(across, sizeof across, ", y = %.4g", slope.at[1]);
    if (slope.steepest > GAP_STEEP)
        warnings_add(
            warnings,
            "the floor is steep where the block may touch it: a slope of %.2g at x = %.4g%s; "
            "nodes come down along z and are pressed along z, an error of the square of "
            "the slope, %.0f %%",
            slope.steepest, slope.at[0], across, 100 * fmin(slope.steepest * slope.steepest, 1));
}

// Less of the strip than this may miss the face, relative to its width: rounding of either.
static const double STRIP_MISSED = 1e-3;

void warnings_of_rod(const Scene *scene, const Interface *interface, double height,
                     RunWarnings *warnings)
{
    double middle = 0, width = 0, from = interface->rod_face[0], to = interface->rod_face[1];
    if (scene->rod.whole || interface->rod_count == 0 || from == to) return;   // a face along x
    model_rod_strip(scene, height, &middle, &width);
    double low = middle - 0.5 * width, high = middle + 0.5 * width;
    double covered = fmin(high, to) - fmax(low, from);
    if (covered >= (1 - STRIP_MISSED) * width) return;
    warnings_add(warnings,
                 "the rod misses part of its face: its strip is %.4g <= z <= %.4g, group \"%s\" is "
                 "%.4g <= z <= %.4g; only %.0f %% of the strip pushes the block: move rod.height "
                 "or change rod.width",
                 low, high, scene->groups.rod, from, to, 100 * fmax(covered, 0) / width);
}
