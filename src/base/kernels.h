// SPDX-License-Identifier: GPL-2.0-or-later
// Which of OpenBLAS's kernels compute: those that the processor can run, also where OpenBLAS does
// not know it. OpenBLAS chooses by family and model when it is loaded; 0.3.21 takes Prescott's
// (SSE3, a fifth of the speed) for an Intel processor of later years. A choice by the variable
// OPENBLAS_CORETYPE stays. Read by run/report and run/info/version.
#ifndef AMONTONS_BASE_KERNELS_H
#define AMONTONS_BASE_KERNELS_H

// Takes the kernels of kernels_possible() where OpenBLAS's own are less; those of a later OpenBLAS,
// not known here, stay. No thread may be inside OpenBLAS: the library calls it when it is loaded.
void kernels_follow_processor(void);

// OpenBLAS's word for those in use, "Haswell"; static storage.
const char *kernels_name(void);

// The same word where nothing better is possible here; else that of the better ones ("SkylakeX"
// where OPENBLAS_CORETYPE asks for less).
const char *kernels_possible(void);

#endif
