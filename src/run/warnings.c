// SPDX-License-Identifier: GPL-2.0-or-later
// A contact node that slips alone gains energy when weakening gives it more than viscosity takes,
//
//     -mu'(0) p w_i  >  S_C[t_i, t_i],     p the mean pressure, w_i the node's weight.
//
// S_C of one node hardly depends on the mesh and w_i shrinks with it, so this is a matter of
// element size: above it l_sc is shorter than an element.
#include "run/warnings.h"

#include <stdarg.h>
#include <stdio.h>

void warnings_add(RunWarnings *warnings, const char *format, ...)
{
    if (warnings->count == RUN_WARNINGS_MAX) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(warnings->text[warnings->count++], RUN_WARNING_SIZE, format, arguments);
    va_end(arguments);
}

void warnings_of_resolution(const Certificate *certificate, double load, RunWarnings *warnings)
{
    const Interface *interface = certificate->moving.interface;
    double slope = -friction_slope(certificate->moving.law, 0), length = 0;
    if (!(slope > 0) || !certificate->damping) return;   // no damping: the scene was warned of
    const double *schur = interface_operator_schur(certificate->damping);
    int32_t unstable = 0;
    double worst = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) length += interface->weight[i];
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int64_t t = interface_tangent(i);
        double ratio = slope * load / length * interface->weight[i] /
                       schur[t * interface->count + t];
        unstable += ratio > 1;
        worst = ratio > worst ? ratio : worst;
    }
    if (unstable > 0)
        warnings_add(warnings,
                     "slip is not resolved: friction weakens faster than viscosity can damp at %d "
                     "of %d contact nodes, each taken alone; slip turns unstable on less than an "
                     "element, and what comes out depends on the mesh; elements %.2g times as "
                     "long would do",
                     unstable, interface->contact_count, 1 / worst);
}
