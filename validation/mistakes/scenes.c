// SPDX-License-Identifier: GPL-2.0-or-later
// Mistakes in what a scene of a real contact has: regions, laws and gaps of contacts, programs, the
// machine, output by window, branches of materials. scenes.py says which tests must see them.
#include "mistake.h"

#include "reduction/machine.h"
#include "reduction/reduction_block.h"
#include "fem/mesh.h"
#include "friction/friction_start.h"
#include "contact/rod_course.h"
#include "model/contact_nodes.h"
#include "record/observation.h"
#include "scene/keys.h"
#include "scene/materials.h"
#include "scene/profile.h"
#include "stepping/branches.h"
#include "stepping/energy.h"
#include "stepping/state.h"
#include "stepping/moving_set.h"

#include <math.h>
#include <string.h>

REPLACED(scene_material_number);
REPLACED(reduction_block_hash);
REPLACED(model_lay_laws);
REPLACED(model_lay_gaps);
REPLACED(mesh_gap);
REPLACED(scene_profile_at);
REPLACED(scene_hash);
REPLACED(load_factor);
REPLACED(load_next);
REPLACED(rod_course_way);
REPLACED(machine_soften);
REPLACED(machine_refer);
REPLACED(window_archive);
REPLACED(friction_state);
REPLACED(friction_rested);
REPLACED(moving_set_find);
REPLACED(friction_paced);
REPLACED(friction_start);
REPLACED(friction_find_steady);
REPLACED(friction_set_pressure);
REPLACED(formula_partials);
REPLACED(friction_solve_states);
REPLACED(state_archive);
REPLACED(spectrum_find);
REPLACED(branches_start_stage);
REPLACED(energy_store);

static bool made(Mistake mistake)
{
    return mistake_made() == mistake;
}

// --- regions and contacts -----------------------------------------------------------------------

double __wrap_scene_material_number(const Scene *scene, const SceneMaterial *region, int32_t k)
{
    bool left_out = (made(MISTAKE_REGION_DENSITY) && k == MATERIAL_DENSITY) ||
                    (made(MISTAKE_REGION_VISCOSITY) && (k == MATERIAL_ETA1 || k == MATERIAL_ETA2));
    const SceneMaterial whole = {0};
    return __real_scene_material_number(scene, left_out ? &whole : region, k);
}

void __wrap_reduction_block_hash(const ReductionBlock *block, const Mesh *mesh, const int32_t *dofs,
                                 int32_t dof_count, Hash *hash)
{
    ReductionBlock other = *block;
    if (made(MISTAKE_REGION_KEY)) other.materials.count = 1;
    __real_reduction_block_hash(&other, mesh, dofs, dof_count, hash);
}

bool __wrap_model_lay_laws(Model *model, Error *err)
{
    return made(MISTAKE_ONE_LAW) || __real_model_lay_laws(model, err);
}

bool __wrap_model_lay_gaps(Model *model, Error *err)
{
    return made(MISTAKE_FLAT_FLOOR) || __real_model_lay_gaps(model, err);
}

double __wrap_mesh_gap(const Mesh *mesh, int32_t node)
{
    return made(MISTAKE_FLAT_MESH) ? 0 : __real_mesh_gap(mesh, node);
}

// Of the point before it; of a map with x and y in each other's place.
double __wrap_scene_profile_at(const SceneProfile *profile, double x, double y)
{
    if (made(MISTAKE_MAP_TURNED) && profile->y) return __real_scene_profile_at(profile, y, x);
    if (!made(MISTAKE_PROFILE_STEPS)) return __real_scene_profile_at(profile, x, y);
    int32_t k = 0;
    while (k + 1 < profile->count && profile->x[k + 1] <= x) k++;
    return profile->gap[k];
}

bool __wrap_scene_hash(const Scene *scene, bool (*counts)(const char *key), Hash *hash, Error *err)
{
    static Scene other;
    if (!made(MISTAKE_PROFILE_NAME)) return __real_scene_hash(scene, counts, hash, err);
    other = *scene;
    memset(other.contact.profile, 0, sizeof other.contact.profile);
    hash_text(hash, scene->contact.profile);
    return __real_scene_hash(&other, counts, hash, err);
}

// --- programs and the machine -------------------------------------------------------------------

// That at the beginning of the stretch: stairs for ramps.
double __wrap_load_factor(const LoadCourse *course, double time)
{
    double from;
    if (!course || !made(MISTAKE_LOAD_STAIRS)) return __real_load_factor(course, time);
    double x = course->by_way ? rod_displacement(course->rod, time) : time;
    if (course->schedule.count == 0) return 1;
    return course->schedule.factor[schedule_segment(&course->schedule, x, &from)];
}

double __wrap_load_next(const LoadCourse *course, double time)
{
    return made(MISTAKE_LOAD_POINTS) ? INFINITY : __real_load_next(course, time);
}

// With the velocity of now all the time.
double __wrap_rod_course_way(const RodCourse *course, double time)
{
    if (!made(MISTAKE_ROD_WAY)) return __real_rod_course_way(course, time);
    return rod_course_velocity(course, time) * time;
}

bool __wrap_machine_soften(const Machine *machine, double reach, int32_t count, double *schur,
                           MachineColumn *column, Error *err)
{
    Machine other = *machine;
    bool in_step = reach > 0;
    if (made(MISTAKE_MACHINE_RIGID) && in_step) other.stiffness *= 2;
    return __real_machine_soften(&other, reach, count, schur, column, err);
}

void __wrap_machine_refer(MachineColumn *column, double *g)
{
    if (made(MISTAKE_MACHINE_FORCE)) column->force *= 0.99;
    __real_machine_refer(column, g);
}

// --- output by window ---------------------------------------------------------------------------

void __wrap_window_archive(Window *window, Archive *archive)
{
    if (!made(MISTAKE_WINDOW_FORGOTTEN)) __real_window_archive(window, archive);
}

// --- friction that remembers --------------------------------------------------------------------

void __wrap_friction_state(const FrictionNode *node, double speed, double *state)
{
    FrictionNode other = *node;
    FrictionLaw law = *node->law;
    bool kept = friction_is_own(&law) ? made(MISTAKE_STATES_KEPT) : made(MISTAKE_MEMORY_KEPT);
    if (made(MISTAKE_MEMORY_EVOLUTION)) law.slip_law = false;
    other.law = &law;
    __real_friction_state(&other, kept ? 0 : speed, state);
}

double __wrap_friction_rested(const FrictionLaw *law, double rest)
{
    return __real_friction_rested(law, made(MISTAKE_MEMORY_FRESH) ? 1e-9 * rest : rest);
}

// g_theta of the other sign, without what states do to each other, or no memory at all, in what is
// linearised.
void __wrap_moving_set_find(MovingSet *set, const State *state, bool with_open)
{
    __real_moving_set_find(set, state, with_open);
    for (int32_t a = 0; a < set->count; a++) {
        int32_t i = set->list[a].node;
        if (made(MISTAKE_MEMORY_GROWS)) set->list[a].fading *= -1;
        if (made(MISTAKE_MEMORY_BLIND)) set->list[a].memory = 0;
        for (int32_t k = 0; i >= 0 && k < STATES_MAX; k++)
            for (int32_t j = 0; j < STATES_MAX; j++) {
                if (made(MISTAKE_STATES_GROWS)) set->rates[i].rate_state[k][j] *= -1;
                if (made(MISTAKE_STATES_ALONE) && j != k) set->rates[i].rate_state[k][j] = 0;
            }
    }
}

// What is remembered answers at once.
bool __wrap_friction_solve_states(const FrictionRates *rates, double reach, double *x)
{
    return made(MISTAKE_STATES_UNSOLVED) || __real_friction_solve_states(rates, reach, x);
}

// The quasi-static path remembers as its own slow rod would.
FrictionNode __wrap_friction_paced(const FrictionNode *node, double pace)
{
    bool own = made(MISTAKE_STATES_CLOCK) && friction_is_own(node->law);
    return __real_friction_paced(node, own || made(MISTAKE_MEMORY_CLOCK) ? 1 : pace);
}

// --- laws of one's own --------------------------------------------------------------------------

// With twice the states of equilibrium; without the rest before.
bool __wrap_friction_start(const FrictionSource *source, FrictionLaw *law, const char **key,
                           Error *err)
{
    FrictionSource other = *source;
    if (made(MISTAKE_STATES_FRESH)) other.rest = 0;
    bool started = __real_friction_start(&other, law, key, err);
    for (int32_t k = 0; made(MISTAKE_STATES_START) && k < law->states; k++) law->start[k] *= 2;
    return started;
}

// Of what `stability` lets slip.
bool __wrap_friction_find_steady(FrictionNode *node, double speed)
{
    return made(MISTAKE_STATES_STEADY) || __real_friction_find_steady(node, speed);
}

double __wrap_friction_set_pressure(FrictionNode *node, double pressure, double speed)
{
    return made(MISTAKE_STATES_PRESSURE) ? 0 : __real_friction_set_pressure(node, pressure, speed);
}

// Rates of states (formula k > 0, by the ends before it) do not know the others; derivatives by the
// second state are left out. Variables: v, the states and p.
double __wrap_formula_partials(const Formula *formula, const int32_t *ends, const double *x,
                               int32_t count, double *slope)
{
    double other[FORMULA_VARIABLES_MAX];
    int32_t k = 0;
    while (ends[-k] > 0) k++;
    memcpy(other, x, sizeof other);
    for (int32_t j = 1; made(MISTAKE_STATES_APART) && k > 0 && j < FORMULA_VARIABLES_MAX; j++)
        if (j != k) other[j] = 0;
    double value = __real_formula_partials(formula, ends, other, count, slope);
    if (made(MISTAKE_STATES_DERIVATIVE) && count > 2) slope[2] = 0;
    return value;
}

// The first state of a node alone is kept.
void __wrap_state_archive(State *state, Archive *archive)
{
    __real_state_archive(state, archive);
    for (int32_t k = 0; made(MISTAKE_STATES_CUT) && k < state->contact_count * STATES_MAX; k++)
        if (archive_reads(archive) && k % STATES_MAX > 0) state->theta[k] = 0;
}

// --- branches of materials ----------------------------------------------------------------------

// Branches of one material are in the next.
bool __wrap_spectrum_find(const Materials *materials, int32_t dim, Spectrum *spectrum, Error *err)
{
    bool found = __real_spectrum_find(materials, dim, spectrum, err);
    for (int32_t j = 0; made(MISTAKE_BRANCH_BESIDE) && j < spectrum->shape_count; j++)
        spectrum->shape[j].region = (spectrum->shape[j].region + 1) % materials->count;
    return found;
}

// Stretches of a later stage begin where the step did.
void __wrap_branches_start_stage(const Branches *branches, double step, int32_t i,
                                 const State *from, State *to, double *rhs)
{
    int32_t earlier = made(MISTAKE_BRANCH_LATE) ? 0 : i;
    __real_branches_start_stage(branches, step, earlier, from, to, rhs);
}

// What springs of branches store is forgotten.
void __wrap_energy_store(const State *state, EnergyLedger *ledger)
{
    __real_energy_store(state, ledger);
    for (int32_t k = 0; made(MISTAKE_BRANCH_ENERGY) && k < state->branch_count; k++)
        ledger->elastic -= ledger->branch[k].stored;
}
