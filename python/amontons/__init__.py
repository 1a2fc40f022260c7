# SPDX-License-Identifier: GPL-2.0-or-later
"""When does an elastic block start to slide, and how? ::

    import amontons
    result = amontons.run("scene.yaml", {"load.pressure": 0.006})
    print(result.mu_M, result.history.mu.max())

run, forecast, static, stability, model1d, sweep, optimise, fit, render, film, info, cache are the commands of the program `amontons`;
Simulation steps one simulation; errors are AmontonsError and what is derived from it. docs/python.md shows all of it.
"""
from ._library import AmontonsError, ComputeError, FileError, InputError, LibraryError
from ._structs import NODE_OPEN, NODE_SLIPS, NODE_STICKS, NODE_WEAKENS
from .commands import (cache, clean_cache, compare, data_folder, film, fit, forecast, info, kernels, keys, model1d,
                       open_result, optimise, read_table, render, render_plot, render_sweep, run, stability, static, sweep,
                       version)
from .notebook import NotebookProgress
from .results import Answer, Field, History, Result
from .simulation import Simulation

__version__ = version()
__all__ = ["AmontonsError", "Answer", "ComputeError", "Field", "FileError", "History", "InputError", "LibraryError",
           "NODE_OPEN", "NODE_SLIPS", "NODE_STICKS", "NODE_WEAKENS", "NotebookProgress", "Result", "Simulation", "cache", "clean_cache",
           "compare", "data_folder", "film", "fit", "forecast", "info", "kernels", "keys", "model1d", "open_result",
           "optimise", "read_table", "render", "render_plot", "render_sweep", "run", "stability", "static", "sweep", "version"]
