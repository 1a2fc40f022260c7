// SPDX-License-Identifier: GPL-2.0-or-later
// Which of OpenBLAS's kernels compute, and which the processor could run. OpenBLAS goes by family
// and model when it is loaded; 0.3.21 takes Prescott's (SSE3, a fifth of the speed) for a processor
// that it does not know, unless the variable OPENBLAS_CORETYPE says which. Read by run/report and
// run/info/version.
#ifndef AMONTONS_BASE_KERNELS_H
#define AMONTONS_BASE_KERNELS_H

// OpenBLAS's word for those in use, "Haswell"; static storage.
const char *kernels_name(void);

// The same word where nothing better is possible here; else that of the better ones ("SkylakeX"
// where OpenBLAS took less, by itself or as OPENBLAS_CORETYPE asks). Those of a later OpenBLAS, not
// known here, count as the best.
const char *kernels_possible(void);

#endif
