# SPDX-License-Identifier: GPL-2.0-or-later
"""Lists the arrays of an HDF5 file with their shapes: python3 docs/examples/contents.py FILE.h5"""
import sys

import h5py

with h5py.File(sys.argv[1]) as file:
    def show(name, item):
        if isinstance(item, h5py.Dataset):
            print(f"{name:32} {item.dtype.name:8} {list(item.shape)}")
    file.visititems(show)
