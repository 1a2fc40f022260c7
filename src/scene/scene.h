// SPDX-License-Identifier: GPL-2.0-or-later
// A scene: everything that defines one simulation, read from a YAML file by the key table
// (scene/keys) and `--set key=value` overrides. All values are in the units of the file
// (`units: normalised` or `si`), lengths and times included: nothing is rescaled.
#ifndef AMONTONS_SCENE_SCENE_H
#define AMONTONS_SCENE_SCENE_H

#include "base/error.h"
#include "friction/friction.h"
#include "io/mesh/mesh_file.h"
#include "io/text/yaml_document.h"
#include "scene/scene_values.h"

enum { SCENE_KEYS_MAX = 144 };   // of scene/keys
enum { SCENE_KEY_SIZE = 96 };   // of a key's name as a user gives it, with the zero at its end

typedef enum SceneUnits { UNITS_NORMALISED, UNITS_SI } SceneUnits;
typedef enum ScenePlane { PLANE_STRESS, PLANE_STRAIN } ScenePlane;
typedef enum SceneBulk { BULK_ELASTIC, BULK_RELAXES } SceneBulk;
typedef enum SceneRodEnds { ROD_ENDS_EXACT, ROD_ENDS_NODES } SceneRodEnds;
typedef enum SceneRodKind { ROD_PUSH, ROD_BONDED, ROD_NONE } SceneRodKind;
typedef enum SceneStartFriction { START_FRICTION_OFF, START_FRICTION_ON } SceneStartFriction;
typedef enum SceneStartRod { START_ROD_AWAY, START_ROD_HELD } SceneStartRod;
typedef enum SceneStartState { START_RELAXED, START_UNDEFORMED } SceneStartState;
typedef enum SceneScheme { SCHEME_SDIRK2, SCHEME_EXPLICIT } SceneScheme;
typedef enum SceneReduce { REDUCE_AUTO, REDUCE_ALWAYS, REDUCE_NEVER } SceneReduce;
typedef enum SceneAccuracy { ACCURACY_DRAFT, ACCURACY_STANDARD, ACCURACY_FINE } SceneAccuracy;

// The units of a drawing, and how many metres they have.
#define SCENE_LENGTHS(X)                                                                           \
    X(LENGTH_M, "m", 1)                                                                            \
    X(LENGTH_CM, "cm", 1e-2)                                                                       \
    X(LENGTH_MM, "mm", 1e-3)                                                                       \
    X(LENGTH_UM, "um", 1e-6)                                                                       \
    X(LENGTH_NM, "nm", 1e-9)                                                                       \
    X(LENGTH_KM, "km", 1e3)                                                                        \
    X(LENGTH_INCH, "inch", 0.0254)
typedef enum SceneLength {
#define X(symbol, name, metres) symbol,
    SCENE_LENGTHS(X)
#undef X
} SceneLength;

typedef struct Scene {
    char path[SCENE_TEXT_SIZE];   // of the scene file, as given
    char title[SCENE_TEXT_SIZE];
    SceneUnits units;
    double thickness;   // of a block in the plane, length; 0: not given, forces are per width
    struct {
        char file[SCENE_TEXT_SIZE];   // resolved against the scene file's folder
        int32_t parameter_count;
        MeshParameter parameters[SCENE_LIST_MAX];   // mesh.set.*
        SceneLength unit;   // of the drawing
        double scale;   // of its coordinates, beside its unit
        SceneNumbers shift;   // by so much it is moved, [dim], length; none: onto the substrate
    } mesh;
    struct {
        char top[GROUP_NAME_SIZE], rod[GROUP_NAME_SIZE];   // groups.top, groups.rod
        char floor[GROUP_NAME_SIZE];   // groups.floor: the upper side of the base, if there is one
        SceneNames contact;   // groups.contact: one name or a list; empty: every curve
            // group called "contact" or "contact_..."
        SceneNames body;   // regions that are the block; none: all
    } groups;
    struct {
        double young, poisson, density, eta1, eta2;
        SceneRelaxation relaxation;
        char from[SCENE_TEXT_SIZE];   // measured moduli, as in SceneMaterial
        bool eta_from_file;   // eta1 was found with the branches
        SceneNumbers wlf;   // c1, c2, T_ref, T: of all files
        double shift;   // of their times, 1
        SceneBulk bulk;   // whether it relaxes in what files give
        ScenePlane plane;
    } material;
    SceneMaterials materials;   // of single regions
    FrictionLaw friction;   // scene/keys stores its kind, mu_S, mu_K and v_c here, and what is
        // given otherwise in friction_keys; scene/friction_law completes it
    SceneFrictionKeys friction_keys;
    SceneContactLaws contact_laws;   // friction.contacts
    struct {
        char gap[SCENE_TEXT_SIZE];   // formula of x, length; empty: 0
        char profile[SCENE_TEXT_SIZE];   // file (scene/profile), resolved like mesh.file; empty: 0
    } contact;
    struct {
        double pressure;
        double force;   // on the top, in the place of the pressure; 0: not given
        int32_t traction_count;   // load.tractions: [{group, x, y, z}]
        SceneTraction tractions[SCENE_LIST_MAX];
        int32_t support_count;   // load.supports: [{group, direction}]
        SceneSupport supports[SCENE_LIST_MAX];
        SceneProgram program;   // of all loads
    } load;
    struct {
        double velocity, displacement;   // V; how far it is moved in `amontons static`
        double stiffness, height, width, breadth;   // of its spring; of the strip; 0: not given
        bool
            stiffness_is_total;   // of the whole machine, force/length; else per width of the block
        SceneRodKind kind;
        SceneRodEnds ends;
        bool whole;   // all of its group, no strip
        SceneProgram program;   // of the velocity
    } rod;
    struct {
        SceneStartFriction friction;
        SceneStartRod rod;   // away (default) or held
        SceneStartState state;   // relaxed (default) or undeformed
        double velocity_x, velocity_z;   // of the whole block at t = 0
        double tolerance;   // relaxed when every speed is below this times V
        double duration_max;   // of the relaxation, in viscous times; an error beyond
    } start;
    struct {
        double until_U, until_t;   // 0: not given; one of them must be
        bool until_periodic;
        double until_slidings, until_mu_below;   // 0: not asked
        SceneScheme scheme;
        SceneAccuracy accuracy;
        double tolerance;   // of a step, relative; 0: by accuracy
        double step_max, step_min;   // 0: chosen from the block's size and speeds
        double wave_step;   // longest step while not certified, in L / c_L
        double watch;   // how long oscillations are followed before being stepped over, L / c_L
        bool certificate;   // limit the step by the certificate (off only to study it)
        double energy_tolerance;   // of the ledger, relative to the work done
        double periodic_tolerance;   // peaks agree within this, relative
    } time;
    struct {
        double mu, within;   // bar wanted, relative (0: one run); of this computer's time, s
        double window;   // of pressures, relative width
        SceneAnswer of;   // whose bar it is
    } accuracy;
    struct {
        SceneReduce use;
        double tolerance;   // of the interior basis, relative
        bool cache;   // keep the basis on disk for the next run of the shape
    } reduction;
    struct {
        bool history, fields;   // fields: none, or {every_U, every_t, every_step, at_events, film}
        double fields_every_U, fields_every_t;
        bool fields_every_step, fields_at_events, fields_film;
        SceneWindow window;
        SceneProbes probes;   // points inside the bodies
        bool whole_block;   // not a key: the whole mesh is wanted by the caller of the library
        SceneNames figures;   // names of PICTURE_FIGURES
        char cycle[SCENE_TEXT_SIZE];   // that they show; empty: as they choose
        char compare[SCENE_TEXT_SIZE];   // measurements beside them, resolved like mesh.file
    } output;
    bool trusted;   // not a key: its .geo and plug-in may do what they want
    bool given[SCENE_KEYS_MAX];   // by key of scene_keys(): stands in the file or a --set
    int32_t line[SCENE_KEYS_MAX];   // where, in the file `path`, from 1; 0: not in that file
} Scene;

// Reads and checks a scene; `overrides` ([override_count]) are "key=value" as typed after --set,
// the value in YAML's flow style. An override of a single key replaces its value; one of a whole
// map ("time.until={t: 5}") replaces the map. mesh.file is relative to the scene file's folder.
// Errors (ERROR_INPUT) give file:line:column (or the --set text), the key, what was found and what
// is allowed; an unknown key comes with the nearest known one.
bool scene_read(const char *path, const char *const *overrides, int32_t override_count,
                bool trusted, Scene *scene, Error *err);

// Passes on whether a use of the value of `key` was `done`. If not, the error is wrong input, and
// says where it stands: "FILE:LINE: KEY: ...", without a line where the file does not give it.
bool scene_blame(const Scene *scene, const char *key, bool done, Error *err);

// Takes "key=value", as after --set, apart: *document (to be destroyed by the caller, NULL after a
// failure) holds the value at its root, and errors about it name the --set. ERROR_INPUT: there is
// no `=`, no key, a key too long to be one, or no YAML.
bool scene_override_parse(const char *text, char key[SCENE_KEY_SIZE], YamlDocument **document,
                          Error *err);

// `key` as after --set, the value a node of another document (a study's), which errors show.
typedef struct SceneSetting {
    const char *key;
    const YamlDocument *document;   // not owned
    YamlNode node;
} SceneSetting;

typedef struct SceneSource SceneSource;   // a file read once, for many scenes of other settings
bool scene_source_open(const char *path, bool trusted, SceneSource **source, Error *err);
void scene_source_close(SceneSource *source);   // also of one half opened
// The scene of the file with `settings` ([count]), of which later ones win; formulas among them are
// worked out last, in their order, each over the scene that all else and those before make.
bool scene_source_make(SceneSource *source, const SceneSetting *settings, int32_t count,
                       Scene *scene, Error *err);

#endif
