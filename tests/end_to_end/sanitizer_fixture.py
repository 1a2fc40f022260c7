# SPDX-License-Identifier: GPL-2.0-or-later
"""Python opens a library that was built with the address sanitizer only where its runtime is in the process first."""
import os
import re
import subprocess
import sys


def preload(library):
    """The environment to add for a Python that opens `library`; {} where it was built without."""
    needed = subprocess.run(["ldd", library], capture_output=True, text=True, check=True).stdout
    runtime = re.findall(r"/\S*libasan\S*", needed)
    return {"LD_PRELOAD": runtime[0], "ASAN_OPTIONS": "detect_leaks=0"} if runtime else {}


def begin_again_with(library):
    """This process anew, where it has to be."""
    more = preload(library)
    if more and "LD_PRELOAD" not in os.environ:
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | more)
