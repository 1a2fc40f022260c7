// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/training_points.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <math.h>

// Levels of inertia that the basis is built at, a factor of LEVEL_RATIO_LIMIT apart at most, from
// LEVEL_LOWEST times the slowest mode of the interior, below which it follows like a spring, to
// that of one element. Then those between two of them are treated likewise, so that two levels are
// a factor of 10 apart. (Factors from 7 to 1000 give bases of the same error; of 1e6 not.) Half
// way little is added but at the highest, yet there a basis that rounding has spoilt shows: without
// those levels a block with nu = 0.4999 in plane strain was reduced wrongly, and nothing told it.
static const double LEVEL_RATIO_LIMIT = 100, LEVEL_LOWEST = 0.1;

// The last level stands for infinity: there the error is only checked.
static const double BEYOND_LIMIT = 1e6;

// K and C are isotropic, so the static response at a viscosity depends on the quotients of A's
// areal and shear moduli alone, of all regions. At a viscosity v each is its elastic value times
// 1 - v + v t, t its viscous time, and no quotient changes more than that of the longest and the
// shortest time. The basis is built at viscosities where that quotient differs by this factor at
// most, and at the lowest inertia, where the whole block moves, half way between, too.
// (With eta2 = eta1 in plane stress the two ends suffice elsewhere.)
static const double VISCOSITY_RATIO = 2;

// Where inertia acts within an element the mesh itself has an error, of about a quarter of
// inertia's share (a thin layer in linear elements with lumped mass). A tolerance of 0.01 allows a
// tenth of it.
static const double MESH_SHARE = 2.5;

// Errors of S below this are its rounding.
static const double ERROR_LIMIT = 1e-10;

// With branches a viscosity v stands for the rate v/(1 - v) at which they are asked, and moduli
// change along the way in turns. What counts is by how much their quotients do, summed up: the
// length of a path, in logarithms, on which points stand at equal distances. (Where quotients do
// not turn back it is the same as without branches.)
enum { PATH_STEPS = 2000 };
static const double PATH_BEYOND = 1e5;   // times the fastest rate of the materials, either way

typedef struct ViscosityPath {
    int32_t steps;
    double at[2 * TRAINING_VISCOSITIES_MAX - 1];   // [2 * steps + 1] ends of steps, and half way
    double stiffest;   // largest modulus on the path over its elastic value
} ViscosityPath;

// The logarithms of the two moduli of each material at A of viscosity v over their elastic values;
// returns their number.
static int32_t list_moduli(const Materials *materials, const BulkScales *scales,
                           const Spectrum *spectrum, double v, double *logarithm)
{
    int32_t count = 0;
    OperatorTerms terms = {.damping = v / scales->damping,
                           .stiffness = (1 - v) / scales->stiffness};
    double weight[SPECTRUM_SHAPES_MAX];
    terms.stiffness += spectrum_weights(spectrum, terms.damping, terms.stiffness, weight);
    for (int32_t k = 0; k < materials->count; k++) {
        if (!materials_use(materials, k)) continue;
        Moduli elastic = material_elastic(&materials->list[k]),
               viscous = material_viscous(&materials->list[k]);
        Moduli sum = {terms.stiffness * elastic.deviator + terms.damping * viscous.deviator,
                      terms.stiffness * elastic.trace + terms.damping * viscous.trace};
        for (int32_t j = 0; j < spectrum->matrix_count; j++) {
            if (spectrum->shape[j].region != k) continue;
            sum.deviator += weight[j] * spectrum->shape[j].moduli.deviator;
            sum.trace += weight[j] * spectrum->shape[j].moduli.trace;
        }
        double unit = scales->stiffness;
        logarithm[count++] = log(unit * moduli_shear(sum) / moduli_shear(elastic));
        logarithm[count++] =
            log(unit * (moduli_axial(sum) + sum.trace) / (moduli_axial(elastic) + elastic.trace));
    }
    return count;
}

// The viscosity of step k of PATH_STEPS, by equal factors of the rate between its ends.
static double path_viscosity(int32_t k, double slowest, double fastest)
{
    if (k == 0 || k == PATH_STEPS) return k > 0;
    double rate = slowest * pow(fastest / slowest, (k - 1.0) / (PATH_STEPS - 2));
    return rate / (1 + rate);
}

static void find_path(const Materials *materials, const BulkScales *scales,
                      const Spectrum *spectrum, ViscosityPath *path)
{
    ViscousTimes range = materials_viscous_range(materials);
    double unit = scales->damping / scales->stiffness, length[PATH_STEPS + 1] = {0};
    double slowest = unit / fmax(range.volume, range.shear), fastest = slowest;
    double now[2 * MATERIALS_MAX], before[2 * MATERIALS_MAX];
    slowest = fmin(slowest, unit / fmin(range.volume, range.shear));
    fastest = fmax(fastest, unit / fmin(range.volume, range.shear));
    for (int32_t k = 0; k < spectrum->count; k++) {
        slowest = fmin(slowest, unit / spectrum->time[k]);
        fastest = fmax(fastest, unit / spectrum->time[k]);
    }
    slowest /= PATH_BEYOND;
    fastest *= PATH_BEYOND;
    *path = (ViscosityPath){.stiffest = 1};
    for (int32_t k = 0; k <= PATH_STEPS; k++) {
        double low = INFINITY, high = -INFINITY;
        int32_t count =
            list_moduli(materials, scales, spectrum, path_viscosity(k, slowest, fastest), now);
        for (int32_t i = 0; i < count; i++) {
            double change = k > 0 ? now[i] - before[i] : 0;
            low = fmin(low, change);
            high = fmax(high, change);
            path->stiffest = fmax(path->stiffest, exp(now[i]));
            before[i] = now[i];
        }
        length[k] = (k > 0 ? length[k - 1] : 0) + high - low;
    }
    double parts = ceil(length[PATH_STEPS] / log(VISCOSITY_RATIO) - 1e-6);
    path->steps = (int32_t)fmin(fmax(parts, 1), TRAINING_VISCOSITIES_MAX - 1);
    for (int32_t i = 0, k = 0; i <= 2 * path->steps; i++) {
        double wanted = length[PATH_STEPS] * i / (2.0 * path->steps);
        while (k < PATH_STEPS && length[k] < wanted) k++;
        path->at[i] = i == 2 * path->steps ? 1 : path_viscosity(k, slowest, fastest);
    }
}

// The viscosity at which the quotient named at VISCOSITY_RATIO has gone the `part` of its way from
// K to C: (1 - v + v volume) = quotient (1 - v + v shear).
static double viscosity_at(double part, double volume, double shear)
{
    if (part <= 0 || part >= 1 || fabs(volume / shear - 1) < 1e-9) return part;
    double quotient = pow(volume / shear, part);
    return (1 - quotient) / (1 - quotient + quotient * shear - volume);
}

static void list_path(const Materials *materials, const BulkScales *scales,
                      const Spectrum *spectrum, ViscosityPath *path)
{
    if (spectrum->count > 0) {
        find_path(materials, scales, spectrum, path);
        return;
    }

    // The viscous times of the two moduli, normalised, of all regions.
    ViscousTimes range = materials_viscous_range(materials);
    double unit = scales->stiffness / scales->damping;
    double volume = unit * range.volume, shear = unit * range.shear;
    double parts = ceil(fabs(log(volume / shear)) / log(VISCOSITY_RATIO));
    *path = (ViscosityPath){.steps = (int32_t)fmin(fmax(parts, 1), TRAINING_VISCOSITIES_MAX - 1),
                            .stiffest = 1};
    for (int32_t k = 0; k <= path->steps; k++)
        path->at[2 * k] = viscosity_at((double)k / path->steps, volume, shear);
    for (int32_t k = 0; k < path->steps; k++)
        path->at[2 * k + 1] = viscosity_at((k + 0.5) / path->steps, volume, shear);
}

int32_t training_viscosities(const Materials *materials, const BulkScales *scales,
                             const Spectrum *spectrum, double *viscosity)
{
    ViscosityPath path;
    list_path(materials, scales, spectrum, &path);
    for (int32_t k = 0; k <= path.steps; k++) viscosity[k] = path.at[2 * k];
    return path.steps + 1;
}

double parameter_error_allowed(const TrainingPoints *training, ParameterPoint point,
                               double tolerance)
{
    double share = point.inertia / training->element_inertia;
    return fmax(tolerance * (tolerance + MESH_SHARE * share), ERROR_LIMIT);
}

OperatorTerms parameter_terms(ParameterPoint point, const BulkScales *scales)
{
    return (OperatorTerms){.mass = point.inertia / scales->mass,
                           .damping = point.viscosity / scales->damping,
                           .stiffness = (1 - point.viscosity) / scales->stiffness};
}

void parameter_factors(ParameterPoint point, const BulkScales *scales, const Spectrum *spectrum,
                       double *factor)
{
    OperatorTerms terms = parameter_terms(point, scales);
    factor[BULK_STIFFNESS] = 1 - point.viscosity;
    factor[BULK_DAMPING] = point.viscosity;
    factor[BULK_MASS] = point.inertia;
    factor[BULK_STIFFNESS] += scales->stiffness * spectrum_weights(spectrum, terms.damping,
                                                                   terms.stiffness,
                                                                   factor + BULK_SHAPE);
}

static void add(TrainingPoints *training, const ReductionErrors *errors, double viscosity,
                int32_t level)
{
    training->points[training->count++] =
        (TrainingPoint){{viscosity, errors->inertia[level]}, level};
}

// Every other level first: at those between them less is missing.
void training_points_list(const Materials *materials, const BulkScales *scales,
                          const Spectrum *spectrum, double slowest, double element_inertia,
                          ReductionErrors *errors, TrainingPoints *training)
{
    ViscosityPath path;
    list_path(materials, scales, spectrum, &path);
    element_inertia *= path.stiffest;
    if (materials->count > 1) {
        // Where regions differ in eta/E, C may be far softer or stiffer than K: slower and faster
        // modes.
        ViscousTimes range = materials_viscous_range(materials);
        double unit = scales->stiffness / scales->damping;
        slowest *= fmin(1, unit * range.volume);
        element_inertia *= fmax(1, unit * range.shear);
    }

    // Levels, ascending: even ones are built at first, odd ones lie between, the last beyond. On a
    // mesh of a few elements the slowest mode is hardly below that of one element.
    double lowest = fmin(LEVEL_LOWEST * slowest, element_inertia / LEVEL_RATIO_LIMIT);
    double parts = log(element_inertia / lowest) / log(LEVEL_RATIO_LIMIT);
    int32_t steps = (int32_t)fmin(ceil(parts), (REDUCTION_LEVELS_MAX - 2) / 2);
    for (int32_t k = 0; k <= 2 * steps; k++)
        errors->inertia[k] = lowest * pow(element_inertia / lowest, k / (2.0 * steps));
    errors->inertia[2 * steps + 1] = BEYOND_LIMIT * element_inertia;
    errors->count = 2 * steps + 2;
    *training = (TrainingPoints){.element_inertia = element_inertia};
    for (int32_t pass = 0; pass < 2; pass++) {
        for (int32_t level = pass; level < errors->count - 1; level += 2)
            for (int32_t k = 0; k <= path.steps; k++) add(training, errors, path.at[2 * k], level);
        for (int32_t k = 0; pass == 0 && k < path.steps; k++)
            add(training, errors, path.at[2 * k + 1], 0);
    }
}

// Inverse ones, for the slowest mode.
enum { SLOWEST_ITERATIONS = 4 };

// Inverse iteration, x'M x = 1 before each.
bool inertia_slowest(const BulkOperator *full, const BulkScales *scales, InterfaceOperator *statics,
                     double *slowest, Error *err)
{
    int32_t dofs = full->dof_count;
    double *x = NEW_ARRAY(double, dofs, err), *rhs = NEW_ARRAY(double, dofs, err);
    double *pull = NEW_ARRAY(double, full->interface_count, err);
    if (!x || !rhs || !pull) goto cleanup;
    for (int32_t k = 0; k < dofs; k++) x[k] = 1;
    for (int32_t j = 0; j < full->interface_count; j++) x[full->interface_dofs[j]] = 0;
    for (int32_t round = 0; round < SLOWEST_ITERATIONS; round++) {
        bulk_operator_apply(full, BULK_MASS, x, rhs);
        for (int32_t k = 0; k < dofs; k++) rhs[k] /= scales->mass;
        double size = sqrt(dense_dot(x, rhs, dofs));
        for (int32_t k = 0; k < dofs; k++) rhs[k] /= size;
        TRY(interface_operator_respond_held(statics, rhs, x, pull, err));
        *slowest = 1 / dense_dot(x, rhs, dofs);
    }
cleanup:
    memory_free_all(x, rhs, pull);
    return error_is_clean(err);
}

double inertia_element(const Bulk *bulk, const BulkScales *scales, const int32_t *interface_dofs,
                       int32_t interface_count)
{
    double largest = 0;
    for (int32_t j = 0; j < interface_count; j++) {
        int32_t dof = interface_dofs[j];
        double stiffness = bulk->stiffness[sparse_entry(&bulk->pattern, dof, dof)];
        largest = fmax(largest, stiffness / bulk->mass[dof] * scales->mass / scales->stiffness);
    }
    return largest;
}
