# SPDX-License-Identifier: GPL-2.0-or-later
"""meshio, where it can read what VTK writes."""
import base64
import binascii
import unittest

import meshio


def read(path):
    """Skips the test where meshio reads no raw appended data, of whichever program: it turns them into texts of base64, one
    behind the other, and relies on Python to decode the first alone, as Python did before its security fixes of 2026."""
    try:
        stops = base64.b64decode("QQ==QQ==") == b"A"
    except binascii.Error:
        stops = False
    if not stops:
        raise unittest.SkipTest("meshio reads no raw appended data with this Python, which decodes base64 beyond its padding")
    return meshio.read(path)
