// SPDX-License-Identifier: GPL-2.0-or-later
// A block on a floor with what its certificate is asked with: a state of its contact, and levels of
// dt. For the tests of stepping/certificate.
#ifndef AMONTONS_TESTS_STEPPING_CERTIFICATE_RIG_H
#define AMONTONS_TESTS_STEPPING_CERTIFICATE_RIG_H

#include "stepping/certificate.h"
#include "block_rig.h"

typedef struct CertificateRig {
    BlockRig rig;
    Certificate certificate;
    State seen;   // at first all stick
    DtLevels dt_levels;
} CertificateRig;

// longest, shortest: of the levels, time. Not to be moved afterwards, as parts point into it.
static inline void certificate_rig_build(const RigDef *def, double longest, double shortest,
                                         CertificateRig *built)
{
    Error err = {0};
    rig_build(def, &built->rig);
    assert_true(certificate_create(&built->rig.block, &built->certificate, &err));
    assert_true(state_create(&built->rig.system, &built->rig.interface, &built->seen, &err));
    dt_levels_init(&built->rig.system, longest, shortest, &built->dt_levels);
}

// Contact matrix of level k.
static inline ContactMatrix *certificate_rig_level(CertificateRig *built, int32_t k)
{
    Error err = {0};
    assert_non_null(dt_level_operator(&built->dt_levels, k, PART_WHOLE, &err));
    return dt_level_contact(&built->dt_levels, k, PART_WHOLE);
}

static inline void certificate_rig_destroy(CertificateRig *built)
{
    dt_levels_destroy(&built->dt_levels);
    state_destroy(&built->seen);
    certificate_destroy(&built->certificate);
    rig_destroy(&built->rig);
}

#endif
