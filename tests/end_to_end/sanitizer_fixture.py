# SPDX-License-Identifier: GPL-2.0-or-later
"""Python opens a library that was built with a sanitizer only where its runtime is in the process first."""
import functools
import os
import re
import subprocess
import sys


@functools.cache
def runtime(file):
    """The path of the address or thread sanitizer that `file` was built with; "": neither."""
    plain = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}   # ldd crashes with it
    needed = subprocess.run(["ldd", file], capture_output=True, text=True, check=True, env=plain).stdout
    found = re.search(r"/\S*lib[at]san\S*", needed)
    return found[0] if found else ""


def preload(library):
    """The environment to add for a Python that opens `library`; {} where it was built without."""
    first = runtime(library)
    return {"LD_PRELOAD": first, "ASAN_OPTIONS": "detect_leaks=0"} if first else {}


def begin_again_with(library):
    """This process anew, where it has to be."""
    more = preload(library)
    if more and "LD_PRELOAD" not in os.environ:
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | more)
