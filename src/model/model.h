// SPDX-License-Identifier: GPL-2.0-or-later
// The model of a scene: everything that does not change in time. Mesh, material, friction law, bulk
// and where it meets floor and rod, ready to be stepped (model/obtain), solved in statics
// (model/assemble) or led along a quasi-static path (study/stability). What acts and moves, such as
// the rod's place, belongs to who computes with the model.
#ifndef AMONTONS_MODEL_MODEL_H
#define AMONTONS_MODEL_MODEL_H

#include "reduction/reduced_bulk.h"
#include "friction/friction.h"
#include "contact/rod.h"
#include "io/cache/store.h"
#include "record/probes.h"
#include "scene/scene.h"

// Part of the face around the strip's end node that the strip covers.
typedef struct RodEnd {
    int32_t region[2];   // the material below the node and that above
    double below;   // which part of it is below, 1
} RodEnd;

enum { NOT_REDUCED_SIZE = 200 };

typedef struct Model {
    const Scene *scene;   // not owned; outlives the model
    Materials materials;
    RodEnd rod_end[2];   // the lower and the upper end of the rod's strip
    int32_t contact_region;   // of which of them the contact (its first pad) is
    int32_t floor_region;   // of which of them the base's floor is; 0 where it is rigid
    bool on_contact[MATERIALS_MAX];   // which of them have a side in the contact
    // Branches that relax within this are a viscosity, as not even waves within an element are so
    // fast (model/assemble); 0: there are none, time.
    double folded_time;
    Friction friction;
    FrictionNode *friction_nodes;   // [contact_count] where they differ, or laws remember
        // (model/contact_nodes); owned
    FrictionLaw *laws;   // [contacts of the scene + 1] laws that nodes point to; owned
    Mesh mesh;   // owned, like all that follows
    Bulk bulk;   // its loads; M, C and K where the full mesh is stepped
    Bulk bulk_of_nodes;   // the same in displacements of nodes in the place of jumps, for explicit
        // steps over a base; empty elsewhere
    struct {
        double size, resultant;   // largest nodal load, sum of all towards the plane; per unit of
            // load_reference()
    } unit_load;   // of the bulk
    Interface interface;
    ReducedBulk reduced;   // count 0: the full mesh is stepped
    BulkOperator system;   // what is stepped: the reduced bulk or the full one
    double length, height;   // L, H of the block, length
    double breadth;   // of the block along y, length; 1 in the plane, where forces are per width
    double middle;   // x of its middle, length
    double pressure;   // on the top, load.pressure or that of load.force; stress
    MeshPlace tractions[SCENE_LIST_MAX];   // [scene->load.traction_count] stress
    double machine_stiffness;   // force/width over length, in space force over length; 0: rigid
    ProbePlace probes[SCENE_PROBES_MAX];   // [scene->output.probes.count] where they are
    MeshOrigin mesh_origin;   // where it was read
    ObservationScales scales;   // what forces, times and velocities are measured with
    bool block_is_held;   // by a support: its forces are not known
    bool is_reduced;   // else the whole mesh is stepped
    bool from_cache;   // the basis was: nothing of the full mesh was factored
    double memory;   // that a run takes at most, about, bytes; 0: not known
    bool one_by_one;   // parts of its reduction are built so, for memory
    char not_reduced[NOT_REDUCED_SIZE];   // why a reduction that was tried failed; empty: none was
    char cache_note[CACHE_NOTE_SIZE];   // why what is cached was not used or kept; empty: nothing
    double seconds_mesh, seconds_reduce;   // wall time to read the mesh; for all the rest, s
} Model;

void model_destroy(Model *model);   // zeroed and half-built too

// An empty model of `scene`, with its materials and law: the same numbers, other structs.
Model model_of(const Scene *scene);

// The scene's law, completed by what the mesh says (scene/friction_law).
static inline const FrictionLaw *model_law(const Model *model)
{
    return model->laws ? model->laws : &model->scene->friction;
}

// The slip that the drop of friction can drive, (mu_S - mu_K) p H / E with p the mean pressure and
// E that of the mean material, length. For Coulomb friction, which has no drop, mu_S stands in its
// place; without friction 1.
// Tolerances of slip are measured by it, so that they hold for any load and any units.
double model_friction_slip(const Model *model);

// The slowest rate at which steady slip at the rod's velocity forgets what the contact remembers,
// 1/time; INFINITY: nothing is remembered.
double model_forgets(const Model *model);

// The slip that a fall of the coefficient by 1 can drive, p H / E, length.
double model_slip_per_mu(const Model *model);

// Time that waves take along the block in its fastest material, or through the base that it stands
// on, whichever is longer. Friction feeds no faster oscillation on a soft layer: waves of a stiff
// block above it hardly come through.
double model_crossing(const Model *model);

// The mean E of the short-time response over that of the long-time one; 1: no branches. By so much
// less slip can a drop of friction drive at once.
double model_stiffening(const Model *model);

// Time in which the block settles: waves along it, viscosity, the slowest branch.
double model_settling_time(const Model *model);

// Length by which the machine springs back when the load falls by that drop; 0: it is rigid.
double model_machine_yield(const Model *model);

// A rod of this kind at rest, its origin at 0, with the springs of its ends: soft ends get E* of
// the elastic and of the viscous stiffness (contact/rod), and the machine's spring. Owned by the
// caller.
bool model_build_rod(const Model *model, RodKind kind, Rod *rod, Error *err);

// Machine behind the rod, for a BulkOperator of the model's interface.
Machine model_machine(const Model *model);

// Finds the strip in which the rod touches a block of this height: its centre over the plane and
// its extent, length.
void model_rod_strip(const Scene *scene, double height, double *middle, double *width);

#endif
