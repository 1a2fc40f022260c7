// SPDX-License-Identifier: GPL-2.0-or-later
// Checks of several keys together: each alone was checked when it was set (scene/value). The first
// contradiction is reported, at the line of the value that is wrong, with what would be right.
#include "scene/check.h"

#include "amontons.h"
#include "friction/friction_make.h"
#include "scene/materials.h"
#include "scene/programs.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

// sources: [keys of scene/keys] where each key's value stands, in the file or in a --set; no
// document: not given.
typedef struct Check {
    const Scene *scene;
    const SceneValue *sources;
    const YamlDocument *file;
    Error *err;
} Check;

// Sets the error at the value of `name`; where that is not given, at the map it belongs to.
static bool blame(const Check *check, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool blame(const Check *check, const char *name, const char *format, ...)
{
    char message[600], map[100];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    int32_t index = scene_key_index(name);
    if (index >= 0 && check->sources[index].document) {
        const SceneValue *source = &check->sources[index];
        return yaml_error(source->document, source->node, check->err, "%s: %s", name, message);
    }
    snprintf(map, sizeof map, "%s", name);
    YamlNode node = yaml_look_up(check->file, map);
    while (node == YAML_NO_NODE) {
        char *dot = strrchr(map, '.');
        if (dot)
            *dot = 0;
        else
            map[0] = 0;
        node = yaml_look_up(check->file, map);
    }
    return yaml_key_error(check->file, node, check->err, "%s: %s", name, message);
}

static bool is_given(const Check *check, const char *name)
{
    return check->scene->given[scene_key_index(name)];
}

// A scene that says where the rod stands, or has none, and gives no end of time is for `amontons
// static`; `amontons run` refuses it.
static bool is_static(const Scene *scene)
{
    static const char *const timed[] = {"time.until.U", "time.until.t", "time.until.periodic",
                                        "rod.velocity"};
    for (size_t k = 0; k < sizeof timed / sizeof timed[0]; k++)
        if (scene->given[scene_key_index(timed[k])]) return false;
    return scene->rod.kind == ROD_NONE || scene->given[scene_key_index("rod.displacement")];
}

// The word of a key of the map `friction`; NULL: it is none.
static const char *friction_word(const SceneKey *key)
{
    static const char map[] = "friction.";
    size_t length = sizeof map - 1;
    return strncmp(key->name, map, length) == 0 ? key->name + length : NULL;
}

// Keys without a default, and in SI those whose default of 1 would be 1 Pa or 1 kg/m3.
static bool check_required(const Check *check)
{
    const Scene *scene = check->scene;
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    for (int32_t k = 0; k < count; k++) {
        const SceneKey *key = &keys[k];
        const char *word = friction_word(key);
        bool of_table = key->offset == offsetof(Scene, friction_keys.velocity) ||
                        key->offset == offsetof(Scene, friction_keys.mu);
        bool needed = key->must_be_given || (key->given_in_si && scene->units == UNITS_SI);
        if (of_table && *scene->friction_keys.file)
            needed = false;
        else if (word && !key->standard)
            needed = friction_use(&scene->friction, word) == FRICTION_MUST;
        else if (strcmp(key->name, "rod.velocity") == 0)
            needed = scene->rod.kind != ROD_NONE && !is_static(scene);
        else if (strcmp(key->name, "load.pressure") == 0)
            needed = !(scene->load.force > 0);
        if (!needed || scene->given[k]) continue;
        char allowed[300];
        scene_key_allowed(key, allowed, sizeof allowed);
        return blame(check, key->name, "missing%s; allowed: %s (%s)",
                     key->standard ? ", which an SI scene must give" : "", allowed, key->sentence);
    }
    return true;
}

// The coefficient at rest is the largest: mu_K <= mu_S. One's own law is checked by
// scene/friction_law.
static bool check_friction(const Check *check)
{
    // A key of another law would do nothing.
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    for (int32_t k = 0; k < count; k++) {
        const char *word = friction_word(&keys[k]);
        if (word && check->scene->given[k] &&
            friction_use(&check->scene->friction, word) == FRICTION_UNUSED)
            return blame(check, keys[k].name, "the law `%s` does not read it; leave it out",
                         friction_law_name(&check->scene->friction));
    }
    if (*check->scene->friction_keys.file &&
        (is_given(check, "friction.velocity") || is_given(check, "friction.mu")))
        return blame(check, "friction.file", "give either a file or velocity and mu");
    if (friction_is_own(&check->scene->friction)) return true;
    const Scene *scene = check->scene;
    bool weakens = friction_has_drop(&scene->friction);
    double mu_static = scene->friction.mu_static, mu_kinetic = scene->friction.mu_kinetic;
    if (!weakens && is_given(check, "friction.mu_kinetic") && mu_kinetic != mu_static)
        return blame(check, "friction.mu_kinetic",
                     "the law `%s` has one coefficient, mu_static (%g); leave this key out or make "
                     "it the same",
                     friction_law_name(&scene->friction), mu_static);
    if (weakens && mu_kinetic > mu_static)
        return blame(check, "friction.mu_kinetic", "%g is more than mu_static (%g)", mu_kinetic,
                     mu_static);
    bool fades = friction_use(&scene->friction, "critical_velocity") == FRICTION_MUST;
    if (fades && !(scene->friction.critical_velocity > 0))
        return blame(check, "friction.critical_velocity",
                     "a weakening law needs it; allowed: a number > 0");
    return true;
}

// Branches know bulk moduli in space, which nu = 1/2 has none of.
static bool check_relaxation(const Check *check, const SceneMaterial *region, const char *key)
{
    const Scene *scene = check->scene;
    const SceneRelaxation *relaxation = scene_material_relaxation(scene, region);
    const char *name = region ? region->group : "", *dot = region ? "." : "";
    double poisson = region ? scene_material_number(scene, region, MATERIAL_POISSON)
                            : scene->material.poisson;
    if (relaxation->count > 0 && !(poisson < 0.5))
        return blame(check, key, "%s%srelaxation: poisson is %g; branches need less than 0.5", name,
                     dot, poisson);
    for (int32_t k = 0; k < relaxation->count; k++) {   // they may be formulas, or set one by one
        const SceneBranch *branch = &relaxation->branch[k];
        if (!(branch->time > 0 && branch->shear >= 0 && branch->bulk >= 0 &&
              branch->shear + branch->bulk > 0))
            return blame(check, key,
                         "%s%srelaxation.%d has time %g, shear %g and bulk %g; allowed: a time > "
                         "0, moduli >= 0 and not both 0",
                         name, dot, k, branch->time, branch->shear, branch->bulk);
        for (int32_t i = 0; i < k; i++)
            if (relaxation->branch[i].time == branch->time)
                return blame(check, key,
                             "%s%srelaxation: the time %g stands twice; add up the moduli", name,
                             dot, branch->time);
    }
    return true;
}

// The block and what rests on it: its load, its materials, the names of its boundaries.
static bool check_block(const Check *check)
{
    const Scene *scene = check->scene;

    if (scene->material.plane == PLANE_STRAIN && scene->material.poisson >= 0.5)
        return blame(check, "material.poisson", "%g; plane strain needs less than 0.5",
                     scene->material.poisson);
    if (scene->load.force > 0 && is_given(check, "load.pressure"))
        return blame(check, "load.force", "give either this or load.pressure");

    // Something must press the block down, hold it, or send it down: else there is no contact to
    // look at.
    bool held = scene->load.support_count > 0 || scene->start.velocity_z < 0;
    if (scene->load.pressure == 0 && scene->load.force == 0 && scene->load.traction_count == 0 &&
        !held)
        return blame(check, "load.pressure",
                     "0, and no load.tractions: nothing presses the block down");

    // The number of a material is that of the region, or else that of `material`.
    for (int32_t i = 0; i < scene->materials.count; i++) {
        const SceneMaterial *region = &scene->materials.region[i];
        double poisson = scene_material_number(scene, region, MATERIAL_POISSON);
        if (scene->material.plane == PLANE_STRAIN && poisson >= 0.5)
            return blame(check, "materials", "%s.poisson: %g; plane strain needs less than 0.5",
                         region->group, poisson);
        if (!check_relaxation(check, region, "materials")) return false;
    }
    if (!check_relaxation(check, NULL, "material.relaxation")) return false;

    // One boundary has one meaning. A block's own boundary may have the name that a base's floor
    // has where nothing is given.
    const char *top = scene->groups.top, *rod = scene->groups.rod;
    const char *floor = is_given(check, "groups.floor") ? scene->groups.floor : "";
    if (strcmp(top, rod) == 0) return blame(check, "groups.rod", "`%s` is groups.top as well", rod);
    if (strcmp(floor, top) == 0 || strcmp(floor, rod) == 0)
        return blame(check, "groups.floor", "`%s` is groups.%s as well", floor,
                     strcmp(floor, top) == 0 ? "top" : "rod");
    for (int32_t i = 0; i < scene->groups.contact.count; i++) {
        const char *contact = scene->groups.contact.name[i];
        if (strcmp(contact, top) == 0 || strcmp(contact, rod) == 0 || strcmp(contact, floor) == 0)
            return blame(check, "groups.contact", "`%s` is groups.%s as well", contact,
                         strcmp(contact, top) == 0   ? "top"
                         : strcmp(contact, rod) == 0 ? "rod"
                                                     : "floor");
    }

    // A unit of length needs a scene in SI.
    if (scene->units == UNITS_NORMALISED && is_given(check, "mesh.unit"))
        return blame(check, "mesh.unit",
                     "a normalised scene has no units of length: give mesh.scale, or units: si");
    return true;
}

// Wants as many factors as points of time or of U, which ascend from 0.
static bool check_points(const Check *check, const char *map, const SceneProgram *program)
{
    char t[40], U[40], factor[40];
    snprintf(t, sizeof t, "%s.t", map);
    snprintf(U, sizeof U, "%s.U", map);
    snprintf(factor, sizeof factor, "%s.factor", map);
    bool by_way = program->U.count > 0;
    const SceneNumbers *at = by_way ? &program->U : &program->t;
    const char *place = by_way ? U : t;
    if (program->factor.count == 0 && at->count == 0 && !program->repeat) return true;
    if (by_way && program->t.count > 0) return blame(check, U, "give either t or U");
    if (at->count < 2) return blame(check, place, "a program needs two points or more");
    if (program->factor.count != at->count)
        return blame(check, factor, "%d numbers for %d points", program->factor.count, at->count);
    if (at->value[0] != 0) return blame(check, place, "begins at %g, not at 0", at->value[0]);
    for (int32_t k = 1; k < at->count; k++) {
        if (at->value[k] < at->value[k - 1])
            return blame(check, place, "%g comes after %g", at->value[k], at->value[k - 1]);
        if (at->value[k] == (k > 1 ? at->value[k - 2] : 0))
            return blame(check, place, "%g stands %s", at->value[k],
                         at->value[k] == 0 ? "twice: say what it begins with" : "three times");
    }
    return true;
}

static double least_factor(const SceneProgram *program)
{
    double least = INFINITY;
    for (int32_t k = 0; k < program->factor.count; k++)
        least = fmin(least, program->factor.value[k]);
    return least;
}

// Checks how rod and load move, and when the run ends.
static bool check_course(const Check *check)
{
    const Scene *scene = check->scene;
    const SceneProgram *rod = &scene->rod.program, *load = &scene->load.program;
    bool moves = scene->rod.kind != ROD_NONE;

    // Keys of the rod need a rod. A program that is given by U needs a U that rises, and a program
    // of the load begins with 1.
    if (!moves && is_given(check, "rod.stiffness"))
        return blame(check, "rod.stiffness", "the scene has no rod (rod.kind: none); leave it out");
    if (!check_points(check, "rod.program", rod) || !check_points(check, "load.program", load))
        return false;
    if (scene_has_program(rod) && !moves)
        return blame(check, "rod.program", "the scene has no rod (rod.kind: none); leave it out");
    if (load->U.count > 0 && !moves)
        return blame(check, "load.program.U", "the scene has no rod (rod.kind: none); give t");
    if (rod->U.count > 0 && !(least_factor(rod) > 0))
        return blame(
            check, "rod.program.factor",
            "by U it must be above 0 everywhere, or the rod never gets on; by t it need not be");
    if (load->U.count > 0 && !(least_factor(rod) > 0))
        return blame(check, "load.program.U",
                     "rod.program holds the rod or takes it back, and so U; give t");
    if (scene_has_program(load) && load->factor.value[0] != 1)
        return blame(check, "load.program.factor",
                     "begins with %g, not with 1: the block relaxes under load.pressure and "
                     "load.tractions as they are",
                     load->factor.value[0]);

    // An end by U needs a rod that gets there; a scene that is no static one must say when to stop.
    if (scene->time.until_U > 0 && !moves)
        return blame(check, "time.until.U", "the scene has no rod (rod.kind: none); give t");
    if (!(scene->time.until_U > 0) && !(scene->time.until_t > 0) && !is_static(scene))
        return blame(check, "time.until",
                     "says not when to stop; allowed: {U: LENGTH}, {t: TIME}, and with either "
                     "`periodic: true` (stop then at the latest)");
    RodCourse course = scene_rod_course(scene);
    bool arrives = isfinite(rod_course_arrival(&course, scene->time.until_U));
    if (scene->time.until_U > 0 && !(scene->time.until_t > 0) && !arrives)
        return blame(check, "time.until.U",
                     "rod.program never takes the rod so far: less, or an end by t");

    // Slidings are counted in whole numbers; the least step is not above the largest.
    if (scene->time.until_slidings != floor(scene->time.until_slidings))
        return blame(check, "time.until.slidings", "%g is no whole number",
                     scene->time.until_slidings);
    if (scene->time.step_max > 0 && scene->time.step_min > scene->time.step_max)
        return blame(check, "time.step_min", "%g is more than step_max (%g)", scene->time.step_min,
                     scene->time.step_max);
    return true;
}

// Checks how the window begins and ends, and what is written in it; then the pictures.
static bool check_output(const Check *check)
{
    const Scene *scene = check->scene;
    const SceneWindow *window = &scene->output.window;
    WindowDef def = scene_window(scene);
    if (!(def.to_U > def.from_U))
        return blame(check, "output.window.to_U", "%g is not more than from_U (%g)", def.to_U,
                     def.from_U);
    if (!(def.to_t > def.from_t))
        return blame(check, "output.window.to_t", "%g is not more than from_t (%g)", def.to_t,
                     def.from_t);
    if (window->history && !scene->output.history)
        return blame(check, "output.window.history", "output.history is false");
    if (def.given && !scene->output.fields && !window->history)
        return blame(check, "output.window",
                     "nothing is written in it: output.fields is none; give it, as in {every_step: "
                     "true}, or history: true for the steps of history.h5");

    if (scene->output.figures.count > 0 && !scene->output.history)
        return blame(check, "output.figures",
                     "pictures are drawn from the history: they need output.history: true, also "
                     "under `set` of a study, whose points keep none otherwise");
    if (scene->output.probes.count > 0 && !scene->output.history)
        return blame(check, "output.probes",
                     "what probes read stands in the history: they need output.history: true, also "
                     "under `set` of a study, whose points keep none otherwise");
    if (scene->output.compare[0] && scene->output.figures.count == 0)
        return blame(check, "output.compare", "output.figures names no picture to draw it in");
    const char *cycle = scene->output.cycle;
    if (cycle[0] && strcmp(cycle, "first") != 0 && strcmp(cycle, "last") != 0 &&
        strcmp(cycle, "all") != 0)
        return blame(check, "output.cycle",
                     "first, last or all is allowed; amontons render --cycle 3 draws any");
    for (int32_t k = 0; k < scene->output.figures.count; k++) {
        if (strcmp(scene->output.figures.name[k], "field") == 0 && !scene->output.fields)
            return blame(check, "output.figures",
                         "`field` draws the block as it is stored: it needs output.fields");
        if (strcmp(scene->output.figures.name[k], "probes") == 0 && scene->output.probes.count == 0)
            return blame(check, "output.figures",
                         "`probes` draws what output.probes reads: there are none");
        if (strcmp(scene->output.figures.name[k], "field-strip") == 0)
            return blame(check, "output.figures",
                         "`field-strip` needs a sliding, which no run is sure to have: draw it "
                         "afterwards, `amontons render RESULT --figure field-strip`");
    }
    return true;
}

// Where there are several materials, only the mesh tells whether friction acts on one of them:
// run/warnings.
const char *amontons_scene_warning(const Scene *scene)
{
    if (!(friction_law_drop(&scene->friction) > 0) || scene->material.eta1 > 0) return NULL;
    for (int32_t i = 0; i < scene->materials.count; i++)
        if (scene_material_number(scene, &scene->materials.region[i], MATERIAL_ETA1) > 0)
            return NULL;
    if (scene->material.relaxation.count > 0)
        return "material.eta1 is 0, and branches of `relaxation` are elastic at once: with "
               "friction that weakens, the shortest wave that the mesh can hold grows fastest, so "
               "the answer has no limit as the mesh gets finer (an ill-posed problem); give eta1 "
               "beside them, as E'' over 2 pi f at the highest frequency that was measured, or a "
               "law that remembers (friction.law: rate-and-state)";
    return "material.eta1 is 0: with friction that weakens, the shortest wave that the mesh can "
           "hold grows fastest, so the answer has no limit as the mesh gets finer (an ill-posed "
           "problem)";
}

// true: the scene can be meshed. Whether the mesh has the groups is not known yet.
bool scene_check(const Scene *scene, const SceneValue *sources, const YamlDocument *file,
                 Error *err)
{
    Check check = {.scene = scene, .sources = sources, .file = file, .err = err};
    return check_required(&check) && check_friction(&check) && check_block(&check) &&
           check_course(&check) && check_output(&check);
}
