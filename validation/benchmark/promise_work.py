# SPDX-License-Identifier: GPL-2.0-or-later
"""What an error bar costs beside a mesh that is fixed beforehand, on the same cases; part of promise.py.

Who fixes a mesh must fix one that is sure to do: of all cases, the error that 19 of 20 stay below counts. Who asks for a
bar pays for as many meshes as the case at hand needs."""
import statistics

import numpy

from figure import draw
from measured_run import markdown_table

CELLS = (10, 20, 40, 56, 80)     # along a block, and up it
SURE = 0.95


def sure_error(errors):
    """The error that SURE of the cases stay below; between two cases as numpy.quantile has it."""
    return float(numpy.quantile(errors, SURE))


def rows_of(fixed, asked):
    """fixed: cells -> [(relative error, cpu s)]; asked: wanted -> the same. (name, sure error, median error, median cpu s,
    mean cpu s) of each."""
    named = [(f"{cells} x {cells} cells", runs) for cells, runs in fixed.items()]
    named += [(f"to {100 * wanted:g} %", runs) for wanted, runs in asked.items()]
    rows = []
    for name, runs in named:
        errors, seconds = zip(*runs)
        rows.append((name, sure_error(errors), statistics.median(errors), statistics.median(seconds), statistics.mean(seconds)))
    return rows


def text_of(fixed, asked, folder):
    """The section of promise.md, and its figure."""
    rows = rows_of(fixed, asked)
    curves = {"fixed meshes": rows[:len(fixed)], "error bar asked for": rows[len(fixed):]}
    draw(folder / "promise-work", "Blocks of set A: error that 19 of 20 stay below", "processor time, mean of cases, s",
         "relative error of mu_M", {name: ([row[4] for row in part], [row[1] for row in part]) for name, part in curves.items()})
    table = [[name, f"{100 * sure:.2f}", f"{100 * median:.2f}", f"{middle:.1f}", f"{mean:.1f}"]
             for name, sure, median, middle, mean in rows]
    count = len(next(iter(fixed.values())))
    return (f"### Error against work, {count} blocks of set A\n\nQuads of order 1; one run on a fixed mesh knows no error of its "
            "own.\n\n" + markdown_table(["mesh", "19 of 20 err by less than, %", "median error, %", "cpu s, median",
                                         "cpu s, mean"], table) + "\n\n![work](promise-work.png)\n")
