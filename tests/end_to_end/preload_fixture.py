# SPDX-License-Identifier: GPL-2.0-or-later
"""Libraries that are loaded before the program's own, from whatever folder."""
import os
from pathlib import Path


def preload(*libraries):
    """The environment that loads `libraries` first, what is preloaded already before them. LD_PRELOAD takes a space for the end
    of a name: so it gets names alone, and their folders go to LD_LIBRARY_PATH, whose names end at colons."""
    files = [Path(library) for library in libraries if library]
    before = os.environ.get("LD_PRELOAD", "")
    folders = [*dict.fromkeys(str(file.parent) for file in files), *filter(None, [os.environ.get("LD_LIBRARY_PATH")])]
    return {"LD_PRELOAD": " ".join(filter(None, [before, *(file.name for file in files)])), "LD_LIBRARY_PATH": ":".join(folders)}
