#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What a stage costs by the size of its basis: callgrind's counts of Figure 1 on n x n cells to U = 0.012, without a cache.

    validation/benchmark/basis_stage.py [--program build/bin/amontons] [--cells 20 40] [--tolerance 0.5 0.1 2e-2 2e-3 2e-4]

The loop with relaxing, a stage: all of it; what it does with the contact; products with M, C, K and the interior's inverse, and
their fit to m^2, m r and r^2, m unknowns of the interface, r of the interior. A level is a step size, factored when first used; its
fit: r^3, r^2 m, r m^2. Four minutes at 20 and 40 cells, 80 as many again."""
import argparse
import json
import tempfile
from pathlib import Path

import numpy

from cold import FIG1, count
from measured_run import PROGRAM, commit, markdown_table

PRODUCTS = ("interface_operator_condense", "interface_operator_expand", "bulk_operator_apply")


def measure(program, cells, tolerance):
    """(m, r, stages, levels, instructions by function)"""
    settings = [f"mesh.set.nx={cells}", f"mesh.set.nz={cells}", f"reduction.tolerance={tolerance}", "time.until.U=0.012"]
    with tempfile.TemporaryDirectory() as folder:
        found = count(program, FIG1, settings, folder)
        run = json.loads(Path(folder, "result/run.json").read_text(encoding="utf-8"))
    interface = 2 * run["model"]["contact_nodes"] + run["model"]["rod_nodes"]
    steps = run["steps"]
    return interface, run["model"]["reduced_dofs"] - interface, steps["solves"], steps["factorisations"], found


def fit(name, terms, values):
    """By least squares of the relative deviation."""
    terms, values = numpy.array(terms, float), numpy.array(values, float)
    factors = numpy.linalg.lstsq(terms / values[:, None], numpy.ones(len(values)), rcond=None)[0]
    off = numpy.abs(terms @ factors / values - 1).max()
    print(f"{name}: {', '.join(f'{x:.3g}' for x in factors)}; off by {off:.0%} at most")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--cells", type=int, nargs="+", default=[20, 40])
    parser.add_argument("--tolerance", type=float, nargs="+", default=[0.5, 0.1, 2e-2, 2e-3, 2e-4])
    options = parser.parse_args()
    rows, of_products, of_levels = [], [], []
    for cells in options.cells:
        for tolerance in options.tolerance:
            m, r, stages, levels, found = measure(options.program, cells, tolerance)
            level = found["dt_level_operator"] / levels
            products = sum(found[name] for name in PRODUCTS) / stages
            stage = (found["step_control_advance"] - found["dt_level_operator"]) / stages
            rows.append([cells, f"{tolerance:g}", m, r, f"{stage / 1e3:.0f}", f"{found['contact_solve'] / stages / 1e3:.0f}",
                         f"{products / 1e3:.1f}", f"{level / 1e6:.2f}", stages, levels])
            of_products.append(([1, m * m, m * r, r * r], products))
            of_levels.append(([1, r ** 3, r * r * m, r * m * m], level))
    head = ["cells", "tolerance", "m", "r", "10^3 a stage", "its contact", "its products", "10^6 a level", "stages", "levels"]
    print(f"version {commit()}\n\n{markdown_table(head, rows)}\n")
    fit("products: 1, m^2, m r, r^2", *zip(*of_products))
    fit("a level: 1, r^3, r^2 m, r m^2", *zip(*of_levels))


if __name__ == "__main__":
    main()
