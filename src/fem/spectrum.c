// SPDX-License-Identifier: GPL-2.0-or-later
#include "fem/spectrum.h"

#include <math.h>
#include <string.h>

// A branch of the block's plane or space: a relaxation time, and the moduli of its spring against
// shear and against a strain of all axes alike.
typedef struct PlaneBranch {
    double time, shear, bulk;
} PlaneBranch;

// G, or K, of a Prony series as a function of s, s < 0 but none of -1/tau.
static double relaxed_modulus(const Material *material, double shear, double bulk, double s)
{
    double sum = shear * material_shear(material) + bulk * material_bulk(material);
    for (int32_t k = 0; k < material->branch_count; k++) {
        const Branch *branch = &material->branch[k];
        double rate = s * branch->time;
        sum += (shear * branch->shear + bulk * branch->bulk) * rate / (1 + rate);
    }
    return sum;
}

// made [2 * BRANCHES_MAX]; returns their number. In plane stress the plate's thickness follows both
// moduli: by the correspondence principle the areal modulus is
//
//     k(s) = 9 K G/H,   H = 3 K + 4 G,
//
// with s for the rate: again a Prony series, with poles at times of branches that resist shear and
// volume and at the roots of H, of which one lies between any two poles of H and one beyond the
// last. (1/k is 1/(3 G) + 4/(9 K), and the series of springs and Maxwell solids is one.)
static int32_t plane_branches(const Material *material, int32_t dim, PlaneBranch *made)
{
    int32_t count = 0, n = material->branch_count;
    if (material->plane_strain) {   // or in space
        for (int32_t k = 0; k < n; k++) {
            const Branch *branch = &material->branch[k];
            double lambda = branch->bulk - 2 * branch->shear / 3;
            made[k] = (PlaneBranch){branch->time, branch->shear, lambda + 2 * branch->shear / dim};
        }
        return n;
    }
    for (int32_t k = 0; k < n; k++) {
        const Branch *branch = &material->branch[k];
        double shear = branch->shear, bulk = branch->bulk;
        made[count++] = (PlaneBranch){.time = branch->time,
                                      .shear = shear,
                                      .bulk = 9 * bulk * shear / (3 * bulk + 4 * shear)};
    }
    for (int32_t k = 0; k < n; k++) {   // the root between -1/tau_k and the next pole, or 0
        double low = -1 / material->branch[k].time, high = 0, slope = 0;
        for (int32_t j = 0; j < n; j++) {
            double pole = -1 / material->branch[j].time;
            if (pole > low) high = fmin(high, pole);
        }
        for (;;) {   // H rises from -infinity to infinity, or to its value at 0
            double middle = 0.5 * (low + high);
            if (!(low < middle && middle < high)) break;
            *(relaxed_modulus(material, 4, 3, middle) > 0 ? &high : &low) = middle;
        }
        for (int32_t j = 0; j < n; j++) {
            const Branch *branch = &material->branch[j];
            double rate = 1 + low * branch->time;
            slope += (3 * branch->bulk + 4 * branch->shear) * branch->time / (rate * rate);
        }
        double residue = 9 * relaxed_modulus(material, 1, 0, low) *
                         relaxed_modulus(material, 0, 1, low) / (low * slope);
        made[count++] = (PlaneBranch){.time = -1 / low, .bulk = fmax(residue, 0)};
    }
    return count;
}

// One shape where the bulk modulus of each branch is the same part of its shear modulus, else one
// for shear and one for a strain of all axes alike; in the place of the latter K, where it is of
// this material alone: K v is known in every stage.
static bool take_material(const Material *material, int32_t region, int32_t dim, bool only,
                          Spectrum *spectrum)
{
    static const double ALIKE = 1e-12, NOTHING = 1e-14;   // parts of the sum of all
    PlaneBranch branch[2 * BRANCHES_MAX];
    int32_t count = plane_branches(material, dim, branch), first = spectrum->shape_count;
    double shear = 0, bulk = 0;
    bool alike = true;
    for (int32_t k = 0; k < count; k++) shear += branch[k].shear, bulk += branch[k].bulk;
    for (int32_t k = 0; k < count; k++)
        alike = alike && fabs(branch[k].bulk * shear - branch[k].shear * bulk) <=
                             ALIKE * shear * (shear + bulk);
    alike = alike && shear > 0;
    double part = alike ? bulk / shear : 0;   // of the first shape's bulk modulus in its shear
    int32_t shapes = alike || !(bulk > 0) || !(shear > 0) ? 1 : 2;
    if (shear + bulk == 0) return true;
    if (first + shapes > SPECTRUM_SHAPES_MAX) return false;
    spectrum->shape_count += shapes;
    if (shear > 0) spectrum->shape[first] = (SpectrumShape){region, {2, part - 2.0 / dim}};
    if (!alike) spectrum->shape[first + shapes - 1] = (SpectrumShape){region, {0, 1}};
    Moduli elastic = material_elastic(material);
    bool by_whole = only && shapes == 2;
    if (by_whole) spectrum->shape[1].moduli = elastic;
    spectrum->matrix_count += by_whole ? 1 : shapes;
    for (int32_t k = 0; k < count; k++) {
        if (!(branch[k].shear + branch[k].bulk > NOTHING * (shear + bulk))) continue;
        // The number of the time in the spectrum, a new one where it is not there.
        int32_t time = 0;
        while (time < spectrum->count && spectrum->time[time] != branch[k].time) time++;
        if (time == SPECTRUM_TIMES_MAX) return false;
        if (time == spectrum->count) spectrum->time[spectrum->count++] = branch[k].time;
        double as_whole = by_whole ? branch[k].bulk / moduli_bulk(elastic, dim) : 0;
        if (shear > 0)
            spectrum->share[time][first] += branch[k].shear - as_whole * moduli_shear(elastic);
        if (!alike)
            spectrum->share[time][first + shapes - 1] += by_whole ? as_whole : branch[k].bulk;
    }
    return true;
}

bool spectrum_find(const Materials *materials, int32_t dim, Spectrum *spectrum, Error *err)
{
    *spectrum = (Spectrum){0};
    for (int32_t k = 0; k < materials->count; k++) {
        if (materials->list[k].branch_count == 0 || !materials_use(materials, k)) continue;
        if (!take_material(&materials->list[k], k, dim, materials->count == 1, spectrum))
            return REFUSE(err,
                          "the branches of all regions together have more than %d different times, "
                          "or more than %d regions have some; fewer branches or the same times",
                          SPECTRUM_TIMES_MAX, SPECTRUM_SHAPES_MAX / 2);
    }
    return true;
}

bool spectrum_fold(double fastest, Materials *materials, Spectrum *spectrum)
{
    int32_t kept = 0, count = spectrum->count;
    for (int32_t k = 0; k < count; k++) {
        double time = spectrum->time[k];
        for (int32_t j = 0; time <= fastest && j < spectrum->shape_count; j++) {
            const SpectrumShape *shape = &spectrum->shape[j];
            double viscosity = time * spectrum->share[k][j];
            materials->list[shape->region].eta1 += viscosity * shape->moduli.deviator;
            materials->list[shape->region].eta2 += viscosity * shape->moduli.trace;
        }
        if (time <= fastest) continue;
        spectrum->time[kept] = time;
        memcpy(spectrum->share[kept++], spectrum->share[k], sizeof *spectrum->share);
    }
    spectrum->count = kept;
    if (kept == 0) spectrum->shape_count = spectrum->matrix_count = 0;
    for (int32_t k = kept; k < count; k++) memset(spectrum->share[k], 0, sizeof *spectrum->share);
    for (int32_t k = 0; kept < count && k < materials->count; k++) {
        Material *material = &materials->list[k];
        int32_t slow = 0;
        for (int32_t b = 0; b < material->branch_count; b++)
            if (material->branch[b].time > fastest) material->branch[slow++] = material->branch[b];
        material->branch_count = slow;
    }
    return kept < count;
}

double spectrum_weights(const Spectrum *spectrum, double damping, double stiffness, double *weight)
{
    double whole = 0;
    memset(weight, 0, (size_t)spectrum->matrix_count * sizeof *weight);
    for (int32_t k = 0; k < spectrum->count; k++) {
        double factor = spectrum_factor(spectrum->time[k], damping, stiffness);
        for (int32_t j = 0; j < spectrum->shape_count; j++)
            *(j < spectrum->matrix_count ? &weight[j] : &whole) += factor * spectrum->share[k][j];
    }
    return whole;
}

Spectrum spectrum_scaled(const Spectrum *spectrum, double share, double time)
{
    Spectrum made = *spectrum;
    for (int32_t k = 0; k < made.count; k++) {
        made.time[k] *= time;
        for (int32_t j = 0; j < made.matrix_count; j++) made.share[k][j] *= share;
    }
    for (int32_t j = made.matrix_count; j < made.shape_count; j++) {
        made.shape[j].moduli.deviator *= share;
        made.shape[j].moduli.trace *= share;
    }
    return made;
}

void spectrum_hash(const Spectrum *spectrum, Hash *hash)
{
    if (spectrum->count == 0) return;
    hash_number(hash, spectrum->matrix_count);
    for (int32_t j = 0; j < spectrum->shape_count; j++) {
        hash_number(hash, spectrum->shape[j].region);
        hash_number(hash, spectrum->shape[j].moduli.deviator);
        hash_number(hash, spectrum->shape[j].moduli.trace);
    }
    for (int32_t k = 0; k < spectrum->count; k++) {
        hash_number(hash, spectrum->time[k]);
        for (int32_t j = 0; j < spectrum->shape_count; j++)
            hash_number(hash, spectrum->share[k][j]);
    }
}
