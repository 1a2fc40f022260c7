// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/hdf5/array_attribute.h"

#include <stdio.h>
#include <string.h>

// stored, given: types in the file and of `value`.
static herr_t write_one(hid_t object, const char *name, hid_t stored, hid_t given,
                        const void *value)
{
    if (H5Aexists(object, name) > 0) H5Adelete(object, name);
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
    herr_t status = attribute < 0 ? -1 : H5Awrite(attribute, given, value);
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return status;
}

herr_t attribute_write_number(hid_t object, const char *name, double value)
{
    return write_one(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

herr_t attribute_write_text(hid_t object, const char *name, const char *value)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    herr_t status = write_one(object, name, type, type, &value);
    H5Tclose(type);
    return status;
}

herr_t attribute_read_number(hid_t object, const char *name, double *value)
{
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0) return -1;
    hid_t space = H5Aget_space(attribute);
    bool is_one = H5Sget_simple_extent_npoints(space) == 1;
    herr_t status = is_one ? H5Aread(attribute, H5T_NATIVE_DOUBLE, value) : -1;
    H5Sclose(space);
    H5Aclose(attribute);
    return status;
}

// HDF5 allocates the text.
herr_t attribute_read_text(hid_t object, const char *name, char *value, int32_t size)
{
    char *stored = NULL;
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0) return -1;
    hid_t type = H5Aget_type(attribute);
    herr_t status = H5Tis_variable_str(type) > 0 ? H5Aread(attribute, type, &stored) : -1;
    if (status >= 0 && stored)
        snprintf(value, (size_t)size, "%s", stored);
    else
        status = -1;
    if (stored) H5free_memory(stored);
    H5Tclose(type);
    H5Aclose(attribute);
    return status;
}

typedef struct Copy {
    hid_t to;
    const char *left_out;
} Copy;

static herr_t copy_one(hid_t from, const char *name, const H5A_info_t *info, void *self)
{
    const Copy *copy = self;
    char *text = NULL;
    double number = 0;
    (void)info;
    if (strcmp(name, copy->left_out) == 0) return 0;
    hid_t attribute = H5Aopen(from, name, H5P_DEFAULT);
    if (attribute < 0) return -1;
    hid_t type = H5Aget_type(attribute);
    bool is_text = H5Tis_variable_str(type) > 0;
    herr_t status = is_text ? H5Aread(attribute, type, &text)
                            : attribute_read_number(from, name, &number);
    if (status >= 0)
        status = is_text ? attribute_write_text(copy->to, name, text ? text : "")
                         : attribute_write_number(copy->to, name, number);
    if (text) H5free_memory(text);
    H5Tclose(type);
    H5Aclose(attribute);
    return status;
}

herr_t attribute_copy_all(hid_t from, hid_t to, const char *left_out)
{
    Copy copy = {to, left_out};
    return H5Aiterate2(from, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, copy_one, &copy);
}
