// SPDX-License-Identifier: GPL-2.0-or-later
// A scene as the effective model sees it (equation 1 of Otsuki and Matsukawa 2013, in model1d.h),
// theory, simulation, results. The scene's plane decides E_1: E/(1 - nu^2) in plane stress, the
// paper's case, and the confined modulus in plane strain. Of the mesh only L and H are used.
//
// Symbols of the paper: u(x, t) of the interface, theta H the depth over which the shear stress
// falls off (alpha here, 0.2), pressure 2 P x/L.
#include "study/line/model1d.h"

#include "algebra/dense.h"
#include "base/clock.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "friction/friction.h"
#include "model/loads.h"
#include "model/scene_mesh.h"
#include "run/result/result_folder.h"

#include <math.h>
#include <stdio.h>

enum { NODES_MIN = 3, NODES_MAX = 2000, MODES_COUNTED = 40 };
static const double FLAT = 1e-9;   // of L: how well the contact must fill the block's face

// The paper's alpha; 81 nodes are 80 cells of the line.
Model1dOptions amontons_model1d_options(void)
{
    return (Model1dOptions){.alpha = 0.2, .nodes = 81};
}

// Refuses a scene that the model has no terms for, rather than leave parts out, and options that it
// cannot take. ERROR_INPUT names the key.
static bool check_input(const Scene *scene, const Model1dOptions *options, Error *err)
{
    const char *path = scene->path;
    if (scene->rod.kind == ROD_NONE || !(scene->rod.velocity > 0))
        return REFUSE(err,
                      "%s: the 1D model is driven by a rod: rod.velocity must be above 0 and "
                      "rod.kind push or bonded",
                      path);
    if (scene->rod.program.factor.count > 0 || scene->load.program.factor.count > 0)
        return REFUSE(err, "%s: %s.program: the 1D model has one load and one rod velocity", path,
                      scene->rod.program.factor.count > 0 ? "rod" : "load");
    if (scene->time.until_slidings > 0 || scene->time.until_mu_below > 0)
        return REFUSE(
            err,
            "%s: time.until: the 1D model ends by U, t or `periodic`, not by slidings or mu_below",
            path);
    if (scene->rod.stiffness > 0)
        return REFUSE(err, "%s: rod.stiffness: the 1D model's rod goes where it is driven", path);
    if (scene->friction.remembers)
        return REFUSE(err,
                      "%s: friction.law: the 1D model's closed forms are of friction that depends "
                      "on slip rate alone; `%s` remembers (`amontons run` takes it)",
                      path, friction_law_name(&scene->friction));
    if (!(friction_law_drop(&scene->friction) > 0))
        return REFUSE(err,
                      "%s: the 1D model's slip starts from mu_kinetic and ends at mu_static: it "
                      "needs a weakening friction.law (this one is `%s`) with friction.mu_static "
                      "above friction.mu_kinetic",
                      path, friction_law_name(&scene->friction));
    if (scene->contact_laws.count > 0 || *scene->friction_keys.along)
        return REFUSE(
            err, "%s: friction.contacts, friction.along: the 1D model has one law along its line",
            path);
    if (*scene->contact.gap || *scene->contact.profile)
        return REFUSE(
            err, "%s: contact.gap, contact.profile: the 1D model's line lies on a flat substrate",
            path);
    if (scene->material.relaxation.count > 0)
        return REFUSE(err,
                      "%s: material.relaxation: the 1D model's line has no branches (`amontons "
                      "stability` takes them)",
                      scene->path);
    if (scene->materials.count > 0)
        return REFUSE(err,
                      "%s: materials: the 1D model's line is of one material (`amontons stability` "
                      "and `run` take regions)",
                      path);
    if (scene->friction.strengthens)
        return REFUSE(err,
                      "%s: friction.law: the 1D model's closed forms take a line that has slid to "
                      "be left at mu_kinetic; this `%s` strengthens again at faster slip "
                      "(`amontons stability` and `run` take it)",
                      path, friction_law_name(&scene->friction));
    if (!(scene->load.pressure > 0 || scene->load.force > 0))
        return REFUSE(err, "%s: the 1D model needs load.pressure or load.force above 0", path);
    if (scene->load.traction_count > 0 || scene->load.support_count > 0)
        return REFUSE(err,
                      "%s: the 1D model has a pressure on top and a rod only, no load.tractions or "
                      "load.supports",
                      path);

    // Options: alpha is the paper's fit (0.2); a line of fewer than three nodes has no inside.
    if (!(options->alpha > 0 && options->alpha <= 10))
        return REFUSE(err, "alpha is %g; above 0 up to 10 is allowed", options->alpha);
    if (options->theory_only) return true;
    if (options->nodes < NODES_MIN || options->nodes > NODES_MAX)
        return REFUSE(err, "the line has %d nodes; %d to %d are allowed", options->nodes, NODES_MIN,
                      NODES_MAX);
    if (scene->time.scheme == SCHEME_EXPLICIT)
        return REFUSE(err,
                      "%s: the 1D model is stepped implicitly: --set time.scheme=sdirk2, or ask "
                      "for its theory only",
                      path);
    if (!(scene->time.until_U > 0) && !(scene->time.until_t > 0))
        return REFUSE(err, "%s: says not when to stop (time.until)", path);
    return true;
}

// Elastic and viscous constants of the line from the block's, L and H from the mesh, which is read
// for that and to see that its one contact is the whole lower face, and is not kept.
static bool translate_scene(const Scene *scene, const Model1dOptions *options, Model1d *model,
                            Error *err)
{
    Mesh mesh = {0};
    MeshContact contact = {0};
    double young = scene->material.young, poisson = scene->material.poisson;
    double confined = young / ((1 + poisson) * (1 - poisson));
    if (scene->material.plane == PLANE_STRAIN)
        confined = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
    *model = (Model1d){.alpha = options->alpha,
                       .density = scene->material.density,
                       .elastic_x = confined,
                       .elastic_shear = young / (2 * (1 + poisson)),
                       .viscous_x = scene->material.eta1 + scene->material.eta2,
                       .viscous_shear = scene->material.eta1 / 2,
                       .velocity = scene->rod.velocity,
                       .young = young,
                       .speed = sqrt(confined / scene->material.density),
                       .law = scene->friction};
    TRY(scene_mesh_read(scene, NULL, &mesh, NULL, err));
    if (mesh.dim > 2)
        FAIL(err, ERROR_INPUT,
             "%s: is a mesh in space, and the 1D model a line along a block in the plane",
             scene->mesh.file);
    TRY(scene_check_thickness(scene, &mesh, err));
    TRY(scene_pressure(scene, &mesh, &model->pressure, err));
    TRY(mesh_contact(&mesh, scene->groups.contact.name, scene->groups.contact.count, &contact,
                     err));
    model->length = mesh.x_max - mesh.x_min;
    model->height = mesh.z_max - mesh.z_min;
    model->drive = scene->rod.height > 0 ? scene->rod.height : model->height / 2;
    double begins = mesh_place(&mesh, contact.nodes[0])[0];
    double ends = mesh_place(&mesh, contact.nodes[contact.node_count - 1])[0];
    bool whole = begins - mesh.x_min <= FLAT * model->length &&
                 mesh.x_max - ends <= FLAT * model->length;
    bool flat = true;
    for (int32_t i = 0; i < contact.node_count; i++)
        flat = flat && mesh_gap(&mesh, contact.nodes[i]) == 0;
    if (contact.pad_count != 1 || !whole || !flat)
        FAIL(err, ERROR_INPUT,
             "%s: the 1D model has one contact along the whole block, flat from x = %g to %g; here "
             "%d contact curves%s reach from %g to %g",
             scene->mesh.file, mesh.x_min, mesh.x_max, contact.pad_count,
             flat ? "" : " that are not flat", begins, ends);
cleanup:
    mesh_contact_destroy(&contact);
    mesh_destroy(&mesh);
    return error_is_clean(err);
}

// Theory at evenly spaced fronts up to l = L, and where it loses stability.
static bool find_theory(Model1dSimulation *simulation, Model1dSummary *summary, Error *err)
{
    const Model1d *model = &simulation->model;
    double *work = NEW_ARRAY(double, model1d_rates_work(MODEL1D_MODES), err);
    simulation->points = NEW_ARRAY(Model1dPoint, MODEL1D_POINTS, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t k = 0; k < MODEL1D_POINTS; k++) {
        double l = model->length * (k + 1) / MODEL1D_POINTS;
        GrowthRate omega = model1d_omega(model, 0, l);
        Model1dRates rates;
        if (!model1d_rates(model, l, MODEL1D_MODES, work, &rates))
            FAIL(err, ERROR_LIBRARY, "LAPACK found no eigenvalues with the front at l = %g", l);
        Model1dPoint point = {.front = l,
                              .U = model1d_rod(model, l),
                              .mu = model1d_mu(model, l),
                              .mu_line = model1d_mu_line(model, l),
                              .omega_re = omega.re,
                              .omega_im = omega.im,
                              .rate_re = rates.rightmost.re,
                              .rate_im = rates.rightmost.im,
                              .front_seen = NAN,
                              .mu_seen = NAN};
        for (int32_t n = 0; n < MODES_COUNTED; n++)
            point.growing += model1d_omega(model, n, l).re > 0;
        simulation->points[simulation->point_count++] = point;
    }

    // Lengths over L and mu there, thrice: by the paper's formula (which may give l_c beyond L:
    // mu_S then), with all terms, and with all terms at the scene's V. A front that reaches the end
    // without a loss slides there, at mu_M = mu(L).
    double length = model->length;
    Model1dLosses losses;
    TRY(model1d_losses(model, &losses, err));
    summary->range = model1d_range(model) / length;
    summary->l_sc = model1d_l_sc(model, 0) / length;
    summary->l_c = model1d_l_c(model) / length;
    summary->l_c_small = model1d_l_c_small(model) / length;
    summary->mu_c = model1d_mu_line(model, fmin(summary->l_c, 1) * length);
    summary->l_sc_full = losses.l_sc / length;
    summary->l_c_full = losses.l_c / length;
    summary->l_rod_full = losses.l_rod / length;
    summary->mu_c_full = model1d_mu(model, isnan(losses.l_c) ? length : losses.l_c);
    summary->mu_rod_full = model1d_mu(model, isnan(losses.l_rod) ? length : losses.l_rod);
cleanup:
    memory_free(work);
    return error_is_clean(err);
}

// Theory always, steps unless options say otherwise; results last, so that a failed simulation
// leaves none.
bool amontons_model1d(const Scene *scene, const Model1dOptions *options, Model1dSummary *summary,
                      Error *err)
{
    NUMBERS_HAVE_A_POINT;
    Model1dSimulation simulation = {.scene = scene, .options = options};
    ResultFolder folder = {0};
    double started = clock_seconds();
    *summary = (Model1dSummary){.first_mu = NAN,
                                .first_l_sc = NAN,
                                .first_l_c = NAN,
                                .mu_M = NAN,
                                .mu_M_spread = NAN,
                                .l_sc_seen = NAN,
                                .l_c_seen = NAN};
    TRY(dense_begin(err));
    TRY(check_input(scene, options, err));
    TRY(result_folder_claim(options->folder, options->overwrite, &folder, err));
    TRY(translate_scene(scene, options, &simulation.model, err));
    TRY(result_folder_clear(&folder, err));
    TRY(find_theory(&simulation, summary, err));
    if (!options->theory_only) {
        TRY(model1d_simulate(&simulation, err));
        const StepCounters *steps = &simulation.control.counters;

        // The first peak is kept apart: it starts from u_0, as in theory; later ones from the
        // stress that sliding left.
        const Drops *drops = &simulation.drops;
        Answers answers = answers_of(drops);
        double length = simulation.model.length;
        summary->simulated = true;
        for (int32_t k = drops->count - 1; k >= 0; k--) {
            if (!drops->list[k].bulk) continue;
            Drop peak = drops_as(drops, DROP_BULK, k);
            summary->first_mu = peak.mu;
            summary->first_l_sc = peak.front_uncertified / length;
            summary->first_l_c = peak.critical_length / length;
        }
        summary->mu_M = answers.mu_M.value;
        summary->mu_M_spread = answers.mu_M_spread;
        summary->l_sc_seen = answers.subcritical_length / length;
        summary->l_c_seen = answers.critical_length / length;
        summary->period = answers.period;
        summary->peaks = answers.peaks;
        summary->peaks_counted = answers.peaks_counted;
        summary->bounded = simulation.events.kinds[EVENT_BOUNDED];
        summary->leading = simulation.events.kinds[EVENT_LEADING];
        summary->quasi_static_error = simulation.quasi_static_error;
        summary->energy_error = simulation.energy_error;
        summary->contact_error = simulation.contact_error;
        summary->accepted = steps->accepted;
        summary->rejected = steps->rejected_error + steps->rejected_energy +
                            steps->rejected_uncertified + steps->unsolved;
    }
    summary->seconds = clock_seconds() - started;
    if (options->folder) {
        snprintf(summary->folder, sizeof summary->folder, "%s", options->folder);
        TRY(model1d_write(&simulation, summary, err));
    }
    TRY(result_folder_settle(&folder, err));
    for (int32_t k = 0; options->on_point && k < simulation.point_count; k++)
        options->on_point(&simulation.points[k], options->context);
cleanup:
    history_destroy(&simulation.history);
    contact_arrays_destroy(&simulation.contact);
    drops_destroy(&simulation.drops);
    events_destroy(&simulation.events);
    step_control_destroy(&simulation.control);
    chain_destroy(&simulation.chain);
    memory_free(simulation.points);
    result_folder_release(&folder);
    return error_is_clean(err);
}
