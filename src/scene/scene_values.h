// SPDX-License-Identifier: GPL-2.0-or-later
// Values of keys that are more than a number or a word; parts of scene/scene.
#ifndef AMONTONS_SCENE_SCENE_VALUES_H
#define AMONTONS_SCENE_SCENE_VALUES_H

#include "friction/laws/law.h"
#include "io/mesh/mesh_file.h"

enum {
    SCENE_TEXT_SIZE = 512,
    SCENE_LIST_MAX = 32,
    SCENE_NUMBERS_MAX = 64,
    SCENE_CONTACT_LAWS_MAX = 16,
    SCENE_MATERIALS_MAX = 16,
    SCENE_BRANCHES_MAX = 20,
    SCENE_PROBES_MAX = 32
};

typedef enum SceneAnswer { ANSWER_OF_M, ANSWER_OF_HOLD } SceneAnswer;

typedef struct SceneNames {
    int32_t count;
    char name[SCENE_LIST_MAX][GROUP_NAME_SIZE];
} SceneNames;

typedef struct SceneNumbers {
    int32_t count;
    double value[SCENE_NUMBERS_MAX];
} SceneNumbers;

// rod.program, load.program: a factor over time or over U, one of the two.
typedef struct SceneProgram {
    SceneNumbers t, U, factor;   // as many of each; none: there is no program
    bool repeat;
} SceneProgram;

// output.window: 0 is not given.
typedef struct SceneWindow {
    double from_U, to_U, from_t, to_t;
    bool history;   // it, too, is written in the window alone
} SceneWindow;

// A point inside a body that is watched: an entry of output.probes.
typedef struct SceneProbe {
    char name[GROUP_NAME_SIZE];
    bool has_place;
    SceneNumbers at;   // [dim], length
} SceneProbe;

typedef struct SceneProbes {
    int32_t count;
    SceneProbe probe[SCENE_PROBES_MAX];
} SceneProbes;

typedef struct SceneTraction {
    char group[GROUP_NAME_SIZE];
    double x, y, z;   // stress, or force of the whole group; y: in space only
    bool is_total[3];   // whether x, y and z are forces
} SceneTraction;

// Nodes of a group that do not move along some of the axes; y: in space only.
typedef struct SceneSupport {
    char group[GROUP_NAME_SIZE];
    bool has_direction;
    int32_t direction;   // the word that the scene has: x, y, z, both, all
    bool x, y, z;   // what it stands for
} SceneSupport;

// The numbers of a material, in the order of scene/materials.
enum {
    MATERIAL_YOUNG,
    MATERIAL_POISSON,
    MATERIAL_DENSITY,
    MATERIAL_ETA1,
    MATERIAL_ETA2,
    SCENE_MATERIAL_NUMBERS
};

// A branch of a generalised Maxwell solid: relaxation time, shear and bulk modulus of its spring.
typedef struct SceneBranch {
    double time, shear, bulk;
} SceneBranch;

// material.relaxation: [{time, shear, bulk}].
typedef struct SceneRelaxation {
    int32_t count;
    SceneBranch branch[SCENE_BRANCHES_MAX];
} SceneRelaxation;

// Numbers of a region that differ from `material`: an entry of `materials` (scene/materials).
typedef struct SceneMaterial {
    char group[GROUP_NAME_SIZE];   // a physical surface
    bool given[SCENE_MATERIAL_NUMBERS];
    double number[SCENE_MATERIAL_NUMBERS];   // where given
    bool has_relaxation, has_from, eta_from_file;   // eta_from_file: found with the branches
    SceneRelaxation relaxation;   // where given
    char from[SCENE_TEXT_SIZE];   // measured moduli, resolved like mesh.file; has_from: given, and
        // not yet made into numbers (scene/material_file)
} SceneMaterial;

typedef struct SceneMaterials {
    int32_t count;
    SceneMaterial region[SCENE_MATERIALS_MAX];
} SceneMaterials;

typedef enum SceneInterpolation {
    INTERPOLATION_CUBIC,
    INTERPOLATION_LINEAR,
    INTERPOLATION_LOG
} SceneInterpolation;
typedef enum SceneEvolution { EVOLUTION_AGEING, EVOLUTION_SLIP } SceneEvolution;

// friction.state: {NAME: {rate: FORMULA, start: FORMULA}}.
typedef struct SceneStates {
    int32_t count;
    FrictionStateText state[STATES_MAX];
} SceneStates;

// Keys of the map `friction` beside the kind of law and its three numbers.
typedef struct SceneFrictionKeys {
    SceneNumbers velocity, mu, parameters;
    SceneInterpolation interpolation;
    char formula[SCENE_TEXT_SIZE];
    SceneStates states;   // of a formula
    char file[SCENE_TEXT_SIZE];   // of a plug-in or a table, resolved against the scene's folder
    double velocity_max;   // 0: the speed of sound
#define X(number, symbol) double number;   // 0: not given
    FRICTION_NUMBERS(X)
#undef X
    SceneEvolution evolution;
    double rest;   // of the contacts before the rod moves, time; 0: not given
    char along[SCENE_TEXT_SIZE];   // factor on mu, a formula of x; empty: 1
} SceneFrictionKeys;

// Law of one contact curve that differs from the scene's: an item of friction.contacts
// (scene/friction_law).
typedef struct SceneContactLaw {
    char group[GROUP_NAME_SIZE];
    bool has_law, has_static, has_kinetic, has_critical;   // what the item gives
    FrictionKind kind;   // this, like the numbers, the item's or else the scene's
    double mu_static, mu_kinetic, critical_velocity;
    char formula[SCENE_TEXT_SIZE], along[SCENE_TEXT_SIZE];   // empty: not given
} SceneContactLaw;

typedef struct SceneContactLaws {
    int32_t count;
    SceneContactLaw item[SCENE_CONTACT_LAWS_MAX];
} SceneContactLaws;

#endif
