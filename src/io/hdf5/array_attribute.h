// SPDX-License-Identifier: GPL-2.0-or-later
// Attributes of an HDF5 object: single numbers and texts. Negative: HDF5 failed, and its error
// stack says why. Called by io/hdf5/array_file_module.
#ifndef AMONTONS_IO_HDF5_ARRAY_ATTRIBUTE_H
#define AMONTONS_IO_HDF5_ARRAY_ATTRIBUTE_H

#include <hdf5.h>
#include <stdint.h>

// One cannot be changed in place: an old one of this name is removed first.
herr_t attribute_write_number(hid_t object, const char *name, double value);
herr_t attribute_write_text(hid_t object, const char *name, const char *value);   // h5py: str

// A scalar or an array of one, whatever its stored type.
herr_t attribute_read_number(hid_t object, const char *name, double *value);
// Cut to `size`. A text of fixed length is none of ours.
herr_t attribute_read_text(hid_t object, const char *name, char *value, int32_t size);

// Numbers and texts of one object to another, but that called `left_out`.
herr_t attribute_copy_all(hid_t from, hid_t to, const char *left_out);

#endif
