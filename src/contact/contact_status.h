// SPDX-License-Identifier: GPL-2.0-or-later
// Status of a contact node: it is open, sticks, or slips forward or backward along the drive. In
// space its velocity has the direction itself (contact/slip); these two give the sign of its
// component along the drive. While a problem is being solved what slips is CONTACT_SLIP_FORWARD.
#ifndef AMONTONS_CONTACT_CONTACT_STATUS_H
#define AMONTONS_CONTACT_CONTACT_STATUS_H

#include <stdbool.h>
#include <stdint.h>

// symbol, name
#define CONTACT_STATUSES(X)                                                                        \
    X(CONTACT_OPEN, "open")                                                                        \
    X(CONTACT_STICK, "stick")                                                                      \
    X(CONTACT_SLIP_FORWARD, "slip forward")                                                        \
    X(CONTACT_SLIP_BACKWARD, "slip backward")

typedef enum ContactStatus {
#define X(symbol, name) symbol,
    CONTACT_STATUSES(X)
#undef X
} ContactStatus;

static inline bool status_slips(uint8_t status)
{
    return status == CONTACT_SLIP_FORWARD || status == CONTACT_SLIP_BACKWARD;
}

static inline uint8_t status_of_slip(double along_drive)
{
    return along_drive < 0 ? CONTACT_SLIP_BACKWARD : CONTACT_SLIP_FORWARD;
}

// +1 or -1: the direction of v_t in the plane.
static inline double status_direction(uint8_t status)
{
    return status == CONTACT_SLIP_FORWARD ? 1.0 : -1.0;
}

#endif
