// SPDX-License-Identifier: GPL-2.0-or-later
// A law whose functions stand in a shared object that somebody else wrote (amontons_friction.h).
// The object stays open until the program ends: copies of a law may be anywhere. Its code is run
// only for a scene that is trusted.
#include "friction/laws/law.h"

#include "base/child_process.h"
#include "io/files/open_file.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The symbols of a plug-in and where their addresses go; those of laws with states come last.
enum { SPEED_ALONE = 2, SYMBOLS = 5, SECONDS_MAX = 20 };

// The loader looks for a name without a slash among the system's libraries.
static bool load(const char *path, FrictionPlugin *plugin, Error *err)
{
    static const char *const names[SYMBOLS] = {"coefficient", "slope", "states", "start", "rates"};
    void *places[SYMBOLS] = {&plugin->coefficient, &plugin->slope, &plugin->states, &plugin->start,
                             &plugin->rates};
    char name[PATH_MAX];
    int (*interface)(void) = NULL;
    snprintf(name, sizeof name, "%s%s", strchr(path, '/') ? "" : "./", path);
    void *handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!handle) return REFUSE(err, "cannot be opened: %s", dlerror());
    void *version = dlsym(handle, "amontons_friction_interface");
    if (!version)
        return REFUSE(err, "%s has no function amontons_friction_interface (amontons_friction.h)",
                      path);
    memcpy(&interface, &version, sizeof interface);
    if (interface() < 1 || interface() > AMONTONS_FRICTION_INTERFACE)
        return REFUSE(err, "%s was built for version %d of amontons_friction.h, not 1 to %d", path,
                      interface(), AMONTONS_FRICTION_INTERFACE);
    bool remembers = dlsym(handle, "amontons_friction_rates") != NULL;
    for (int32_t k = remembers ? SPEED_ALONE : 0; k < (remembers ? SYMBOLS : SPEED_ALONE); k++) {
        snprintf(name, sizeof name, "amontons_friction_%s", names[k]);
        void *address = dlsym(handle, name);
        if (!address) return REFUSE(err, "%s has no function %s (amontons_friction.h)", path, name);
        memcpy(places[k], &address, sizeof address);   // POSIX: object to function pointer
    }
    return true;
}

static bool try_load(void *path, FILE *reply, Error *err)
{
    FrictionPlugin plugin;
    (void)reply;
    return load(path, &plugin, err);
}

static bool make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    FrictionPlugin *plugin = &law->plugin;
    AmontonsFriction *given = &plugin->given;
    if (source->parameter_count > AMONTONS_FRICTION_PARAMETERS_MAX)
        return REFUSE_AT(err, key, "file", "takes at most %d friction.parameters, not %d",
                         AMONTONS_FRICTION_PARAMETERS_MAX, source->parameter_count);
    *given = (AmontonsFriction){.mu_static = law->mu_static,
                                .mu_kinetic = law->mu_kinetic,
                                .critical_velocity = law->critical_velocity,
                                .parameter_count = source->parameter_count};
    for (int32_t k = 0; k < source->parameter_count; k++)
        given->parameters[k] = source->parameters[k];
    if (!source->trusted)
        return REFUSE_AT(err, key, "file",
                         "%s is a program that would be run: give --trust (in Python trust=True) "
                         "if you know where it comes from",
                         source->file);

    // One that was cut short ends the process that loads it, and so may one that is whole: a
    // process of its own tries it first, where there may be one. The loader would wait for a pipe.
    ChildWork work = {.path = source->file,
                      .reader = "the system's loader",
                      .seconds = SECONDS_MAX,
                      .advice = "it does not come to an end",
                      .read = try_load,
                      .context = (void *)source->file};
    bool opened = open_check(source->file, err) && (!child_is_wanted() || child_do(&work, err)) &&
                  load(source->file, plugin, err);
    if (!ERROR_AT(key, "file", opened)) return false;
    if (!plugin->rates) return true;
    law->remembers = law->feels_pressure = true;
    law->states = plugin->states(given);
    if (law->states < 1 || law->states > STATES_MAX)
        return REFUSE_AT(err, key, "file", "%s has %d states; allowed: 1 to %d", source->file,
                         law->states, STATES_MAX);
    return true;
}

static double value(const FrictionLaw *law, double speed, double *slope)
{
    *slope = law->plugin.slope(&law->plugin.given, speed);
    return law->plugin.coefficient(&law->plugin.given, speed);
}

static void find_rates(const FrictionLaw *law, double speed, double pressure, const double *state,
                       FrictionRates *rates)
{
    law->plugin.rates(&law->plugin.given, speed, pressure, state, rates);
}

static void start(const FrictionLaw *law, const FrictionSource *source, double *state)
{
    law->plugin.start(&law->plugin.given, source->rod_velocity, source->rest, state);
}

const FrictionOperations friction_plugin = {
    .must = "file",
    .may = "mu_static mu_kinetic critical_velocity parameters velocity_max rest",
    .own = true,
    .has_drop = true,
    .spent = 1,
    .make = make,
    .value = value,
    .mu = find_rates,
    .rate = find_rates,
    .start = start,
    .state_key = "file",
    .mu_key = "file",
    .state_unit = "its own"};
