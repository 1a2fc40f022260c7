// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/contact_half.h"

#include "base/memory.h"
#include "fem/mesh.h"

#include <math.h>
#include <string.h>

// Between a node and its image, over the contact's breadth.
static const double APART = 1e-8;

// By how much entries of S may differ from their images, over the largest: what is left out is a
// billionth.
static const double ALIKE = 1e-9;

// On the diagonal of what is held, over the largest of S: far above any weakening that S could
// withstand.
static const double HELD = 1e9;

// Places in the order of one of their coordinates.
typedef struct Places {
    const double *first, *second;   // [count]
    int32_t count;
    double sum, apart;   // second of a node and of its image together
} Places;

// The image of k, looked for among its neighbours in the order; -1: there is none.
static int32_t image_of(const Places *places, int32_t k)
{
    for (int32_t way = -1; way <= 1; way += 2)
        for (int32_t j = way < 0 ? k : k + 1; j >= 0 && j < places->count; j += way) {
            if (!(fabs(places->first[j] - places->first[k]) <= places->apart)) break;
            if (fabs(places->second[j] + places->second[k] - places->sum) <= places->apart)
                return j;
        }
    return -1;
}

// Those on the lower side and in the middle. false: one has no image.
static bool list_half(const Places *places, int32_t *list, int32_t *image, int32_t *count)
{
    *count = 0;
    for (int32_t k = 0; k < places->count; k++) {
        int32_t j = image_of(places, k);
        if (j < 0) return false;
        if (j != k && places->second[k] > places->second[j]) continue;
        list[*count] = k;
        image[(*count)++] = j;
    }
    return true;
}

static void list_unknowns(const Interface *whole, ContactHalf *half)
{
    Interface *interface = &half->interface;
    int32_t dim = whole->dim;
    for (int32_t k = 0; k < interface->count; k++) {
        int32_t i = dof_node(dim, k), axis = dof_axis(dim, k), j = k - interface_rod(interface, 0);
        half->unknown[k] = j < 0 ? interface_unknown(whole, half->node[i], axis)
                                 : interface_rod(whole, half->rod[j]);
        half->image[k] = j < 0 ? interface_unknown(whole, half->node_image[i], axis)
                               : interface_rod(whole, half->rod_image[j]);
        half->sign[k] = j < 0 && axis == 1 ? -1 : 1;
    }
}

static bool allocate(const Interface *interface, ContactHalf *half, Error *err)
{
    half->unknown = NEW_ARRAY(int32_t, interface->count, err);
    half->image = NEW_ARRAY(int32_t, interface->count, err);
    half->sign = NEW_ARRAY(double, interface->count, err);
    half->node = NEW_ARRAY(int32_t, interface->contact_count, err);
    half->node_image = NEW_ARRAY(int32_t, interface->contact_count, err);
    half->rod = NEW_ARRAY(int32_t, interface->rod_count, err);
    half->rod_image = NEW_ARRAY(int32_t, interface->rod_count, err);
    return error_is_clean(err);
}

bool contact_half_find(const Interface *interface, ContactHalf *half, Error *err)
{
    int32_t contacts = interface->contact_count, rods = interface->rod_count;
    *half = (ContactHalf){.whole = interface->count};
    if (interface->dim < 3 || contacts == 0) return true;
    if (!allocate(interface, half, err)) return false;
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
    *side = (Interface){.dim = interface->dim,
                        .contact_count = found ? side->contact_count : 0,
                        .rod_count = found ? side->rod_count : 0};
    side->count = interface_rod(side, side->rod_count);
    list_unknowns(interface, half);
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

// A column of S, and that of its image.
typedef struct Columns {
    const double *own, *across;
    double sign;   // of the image's motion over its own
} Columns;

// Row a, whose image moves by `sign` times its own. Returns by how much the images of its entries
// are off.
static double fill_entry(const ContactHalf *half, Columns columns, int32_t a, double sign,
                         double *out)
{
    int32_t unknown = half->unknown[a], image = half->image[a];
    double own = columns.own[unknown], there = sign * columns.own[image];
    double across = columns.sign * columns.across[unknown];
    double opposite = columns.sign * sign * columns.across[image];
    *out = own;
    if (unknown != image) *out += there;
    if (columns.own != columns.across) *out += across;
    if (columns.own != columns.across && unknown != image) *out += opposite;
    return fmax(fabs(own - opposite), fabs(there - across));
}

bool contact_half_matrix(const ContactHalf *half, const double *schur, bool antisymmetric,
                         double *out)
{
    int64_t size = half->interface.count, whole = half->whole;
    double largest = 0, off = 0;
    for (int64_t k = 0; k < whole; k++) largest = fmax(largest, schur[k * (whole + 1)]);
    for (int32_t b = 0; b < size; b++) {
        Columns columns = {.own = schur + whole * half->unknown[b],
                           .across = schur + whole * half->image[b],
                           .sign = sign_of(half, b, antisymmetric)};
        for (int32_t a = 0; a < size; a++) {
            double *entry = out + size * b + a;
            *entry = 0;
            if (!is_still(half, a, antisymmetric) && !is_still(half, b, antisymmetric))
                off =
                    fmax(off, fill_entry(half, columns, a, sign_of(half, a, antisymmetric), entry));
            else if (a == b)
                *entry = antisymmetric ? HELD * largest : columns.own[half->unknown[a]];
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
    memset(motion, 0, (size_t)half->whole * sizeof *motion);
    contact_half_add(half, false, work, motion);
}

void contact_half_symmetrise_forces(const ContactHalf *half, double *force, double *work)
{
    contact_half_fold_forces(half, false, force, work);
    memset(force, 0, (size_t)half->whole * sizeof *force);
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
