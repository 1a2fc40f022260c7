// SPDX-License-Identifier: GPL-2.0-or-later
// A block on a floor with what its certificate is asked with: a state of its contact, and the rungs
// of steps. For the tests of stepping/certificate.
#ifndef AMONTONS_TESTS_STEPPING_CERTIFICATE_RIG_H
#define AMONTONS_TESTS_STEPPING_CERTIFICATE_RIG_H

#include "stepping/certificate.h"
#include "block_rig.h"

typedef struct CertificateRig {
    BlockRig rig;
    Certificate certificate;
    State seen;   // at first all stick
    Ladder ladder;
} CertificateRig;

// longest, shortest: of the rungs, time. Not to be moved afterwards, as parts point into it.
static inline void certificate_rig_build(const RigDef *def, double longest, double shortest,
                                         CertificateRig *built)
{
    Error err = {0};
    rig_build(def, &built->rig);
    assert_true(certificate_create(&built->rig.block, &built->certificate, &err));
    assert_true(state_create(&built->rig.system, &built->rig.interface, &built->seen, &err));
    ladder_init(&built->rig.system, longest, shortest, &built->ladder);
}

// What the contact sees of rung k.
static inline ContactMatrix *certificate_rig_rung(CertificateRig *built, int32_t k)
{
    Error err = {0};
    assert_non_null(ladder_rung(&built->ladder, k, PART_WHOLE, &err));
    return ladder_contact(&built->ladder, k, PART_WHOLE);
}

static inline void certificate_rig_destroy(CertificateRig *built)
{
    ladder_destroy(&built->ladder);
    state_destroy(&built->seen);
    certificate_destroy(&built->certificate);
    rig_destroy(&built->rig);
}

#endif
