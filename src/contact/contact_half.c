// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/contact_half.h"

#include "base/memory.h"
#include "fem/mesh.h"

#include <math.h>
#include <string.h>

// Largest distance of a node's image from a node, over the contact's breadth.
static const double APART = 1e-8;

// Largest difference of an entry of S and its image, over the largest entry: what is left out is a
// billionth.
static const double ALIKE = 1e-9;

// Diagonal entry of a node that is held, over the largest entry of S: far above any weakening that
// S could withstand.
static const double HELD = 1e9;

// Places in the order of one of their coordinates.
typedef struct Places {
    const double *first, *second;   // [count]
    int32_t count;
    double sum, apart;   // second of a node and of its image together
} Places;

// Lists those on the lower side and in the middle, and their images, which are looked for among the
// neighbours in the order. Returns false where one has none.
static bool list_half(const Places *places, int32_t *list, int32_t *image, int32_t *count)
{
    const double *first = places->first, *second = places->second;
    *count = 0;
    for (int32_t k = 0; k < places->count; k++) {
        int32_t found = -1;
        for (int32_t way = -1; way <= 1 && found < 0; way += 2)
            for (int32_t j = way < 0 ? k : k + 1; j >= 0 && j < places->count; j += way) {
                if (!(fabs(first[j] - first[k]) <= places->apart)) break;
                if (!(fabs(second[j] + second[k] - places->sum) <= places->apart)) continue;
                found = j;
                break;
            }
        if (found < 0) return false;
        if (found != k && second[k] > second[found]) continue;
        list[*count] = k;
        image[(*count)++] = found;
    }
    return true;
}

bool contact_half_find(const Interface *interface, ContactHalf *half, Error *err)
{
    int32_t contacts = interface->contact_count, rods = interface->rod_count, dim = interface->dim;
    *half = (ContactHalf){.both_count = interface->count};
    if (dim < 3 || contacts == 0) return true;
    half->unknown = NEW_ARRAY(int32_t, interface->count, err);
    half->image = NEW_ARRAY(int32_t, interface->count, err);
    half->sign = NEW_ARRAY(double, interface->count, err);
    half->node = NEW_ARRAY(int32_t, contacts, err);
    half->node_image = NEW_ARRAY(int32_t, contacts, err);
    half->rod = NEW_ARRAY(int32_t, rods, err);
    half->rod_image = NEW_ARRAY(int32_t, rods, err);
    if (!error_is_clean(err)) return false;

    // Nodes of the contact and of the rod's face, across the middle of the contact.
    double least = interface->y[0], most = least;
    for (int32_t i = 0; i < contacts; i++) {
        least = fmin(least, interface->y[i]);
        most = fmax(most, interface->y[i]);
    }
    double apart = APART * (most - least);
    Places floor = {interface->x, interface->y, contacts, least + most, apart};
    Places face = {interface->rod_z, interface->rod_y, rods, least + most, apart};
    Interface *side = &half->interface;
    bool found = list_half(&floor, half->node, half->node_image, &side->contact_count) &&
                 list_half(&face, half->rod, half->rod_image, &side->rod_count);
    *side = (Interface){.dim = dim,
                        .contact_count = found ? side->contact_count : 0,
                        .rod_count = found ? side->rod_count : 0};
    side->count = interface_rod(side, side->rod_count);

    // Their unknowns; motion along y changes its sign in the image.
    for (int32_t k = 0; k < side->count; k++) {
        int32_t i = dof_node(dim, k), axis = dof_axis(dim, k), j = k - interface_rod(side, 0);
        half->unknown[k] = j < 0 ? interface_unknown(interface, half->node[i], axis)
                                 : interface_rod(interface, half->rod[j]);
        half->image[k] = j < 0 ? interface_unknown(interface, half->node_image[i], axis)
                               : interface_rod(interface, half->rod_image[j]);
        half->sign[k] = j < 0 && axis == 1 ? -1 : 1;
    }
    return true;
}

void contact_half_destroy(ContactHalf *half)
{
    memory_free_all(half->unknown, half->image, half->sign, half->node, half->node_image, half->rod,
                    half->rod_image);
    *half = (ContactHalf){0};
}

// --- S ------------------------------------------------------------------------------------------

static double sign_of(const ContactHalf *half, int32_t k, bool antisymmetric)
{
    return antisymmetric ? -half->sign[k] : half->sign[k];
}

static bool in_middle(const ContactHalf *half, int32_t k)
{
    return half->unknown[k] == half->image[k];
}

// No motion of that kind has it.
static bool is_still(const ContactHalf *half, int32_t k, bool antisymmetric)
{
    return in_middle(half, k) && sign_of(half, k, antisymmetric) < 0;
}

bool contact_half_matrix(const ContactHalf *half, const double *schur, bool antisymmetric,
                         double *out)
{
    int64_t size = half->interface.count, whole = half->both_count;
    double largest = 0, off = 0;
    for (int64_t k = 0; k < whole; k++) largest = fmax(largest, schur[k * (whole + 1)]);
    for (int32_t b = 0; b < size; b++) {
        // A column of S and that of its image, whose motion is `turned` times the column's own.
        const double *own_column = schur + whole * half->unknown[b];
        const double *image_column = schur + whole * half->image[b];
        double turned = sign_of(half, b, antisymmetric);
        bool still = is_still(half, b, antisymmetric);
        for (int32_t a = 0; a < size; a++) {
            double *entry = out + size * b + a;
            if (still || is_still(half, a, antisymmetric)) {
                *entry = a != b ? 0 : antisymmetric ? HELD * largest : own_column[half->unknown[a]];
                continue;
            }
            // The entry, those of the row's and of the column's image, and that of both.
            int32_t unknown = half->unknown[a], image = half->image[a];
            double sign = sign_of(half, a, antisymmetric);
            double own = own_column[unknown], there = sign * own_column[image];
            double across = turned * image_column[unknown];
            double opposite = turned * sign * image_column[image];
            *entry = own;
            if (unknown != image) *entry += there;
            if (own_column != image_column) *entry += across;
            if (own_column != image_column && unknown != image) *entry += opposite;
            off = fmax(off, fmax(fabs(own - opposite), fabs(there - across)));
        }
    }
    return off <= ALIKE * largest;
}

// --- motions, forces, statuses ------------------------------------------------------------------

void contact_half_fold(const ContactHalf *half, bool antisymmetric, const double *motion,
                       double *out)
{
    for (int32_t k = 0; k < half->interface.count; k++)
        out[k] = 0.5 * (motion[half->unknown[k]] +
                        sign_of(half, k, antisymmetric) * motion[half->image[k]]);
}

void contact_half_fold_forces(const ContactHalf *half, bool antisymmetric, const double *force,
                              double *out)
{
    contact_half_fold(half, antisymmetric, force, out);
    for (int32_t k = 0; k < half->interface.count; k++)
        if (!in_middle(half, k)) out[k] *= 2;
}

void contact_half_add(const ContactHalf *half, bool antisymmetric, const double *motion,
                      double *out)
{
    for (int32_t k = 0; k < half->interface.count; k++) {
        out[half->unknown[k]] += motion[k];
        if (!in_middle(half, k)) out[half->image[k]] += sign_of(half, k, antisymmetric) * motion[k];
    }
}

void contact_half_add_forces(const ContactHalf *half, bool antisymmetric, const double *force,
                             double *out)
{
    for (int32_t k = 0; k < half->interface.count; k++) {
        double share = in_middle(half, k) ? force[k] : 0.5 * force[k];
        out[half->unknown[k]] += share;
        if (!in_middle(half, k)) out[half->image[k]] += sign_of(half, k, antisymmetric) * share;
    }
}

void contact_half_symmetrise(const ContactHalf *half, double *motion, double *work)
{
    contact_half_fold(half, false, motion, work);
    memset(motion, 0, (size_t)half->both_count * sizeof *motion);
    contact_half_add(half, false, work, motion);
}

void contact_half_symmetrise_forces(const ContactHalf *half, double *force, double *work)
{
    contact_half_fold_forces(half, false, force, work);
    memset(force, 0, (size_t)half->both_count * sizeof *force);
    contact_half_add_forces(half, false, work, force);
}

void contact_half_fold_statuses(const ContactHalf *half, const uint8_t *status,
                                const uint8_t *touches, const ContactSolution *out)
{
    for (int32_t i = 0; i < half->interface.contact_count; i++)
        out->status[i] = status[half->node[i]];
    for (int32_t j = 0; j < half->interface.rod_count; j++)
        out->rod_touches[j] = touches[half->rod[j]];
}

void contact_half_unfold_statuses(const ContactHalf *half, const ContactSolution *from,
                                  uint8_t *status, uint8_t *touches)
{
    for (int32_t i = 0; i < half->interface.contact_count; i++)
        status[half->node[i]] = status[half->node_image[i]] = from->status[i];
    for (int32_t j = 0; j < half->interface.rod_count; j++)
        touches[half->rod[j]] = touches[half->rod_image[j]] = from->rod_touches[j];
}
