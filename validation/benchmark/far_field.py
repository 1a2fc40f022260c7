#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""How many motions does the bulk need far from the interface? Figure 1 on n x n cells, in numpy and without the program.

    validation/benchmark/far_field.py [--cells 40] [--distance 8 12 16 24] [--least 0.25] [--at-rest 1e-12] [--step 6]
                                      [--chunk 24] [--share 0.75]

Unknowns farther than `distance` elements from the interface become motions, as src/reduction/far_samples.c finds them, in one patch (the program: many, in layers):
answers to random motions of the interface, at rest and in turns at inertias `step` apart, `chunk` at once, until less than
`share` of them is new; new is what has an energy of `least` times tolerance^2, `at-rest` at rest. Shown: motions, unknowns that are left, motions asked,
and the worst error of S at points drawn at random, over what is allowed. 40 x 40 cells take 20 s."""
import argparse
import math
import os
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy
import scipy.sparse
from scipy.linalg import cholesky, eigh, solve_triangular

from measured_run import markdown_table
from strip_block import Block, Point, Strip, solver

TOLERANCE, FALLEN, LIFT = 2e-2, 5, 1


def symmetric(a):
    return (a + a.T) / 2


class System:
    """K, C, M of some unknowns; interface: those that stay, the first ones."""

    def __init__(self, stiffness, damping, mass, interface):
        order = numpy.concatenate([interface, numpy.setdiff1d(numpy.arange(len(mass)), interface)])
        self.matrices = [matrix.tocsr()[order][:, order].tocsc() for matrix in (stiffness, damping)]
        self.mass, self.count = mass[order], len(interface)

    def matrix(self, point):
        mixed = (1 - point.viscosity) * self.matrices[0] + point.viscosity * self.matrices[1]
        return (mixed + point.inertia * scipy.sparse.diags(self.mass)).tocsc()

    def schur(self, point):
        """S, and a solver of the interior with the interior's rows of the interface's columns."""
        matrix, m = self.matrix(point), self.count
        solve, coupling = solver(matrix[m:, m:].tocsc()), matrix[m:, :m].toarray()
        return symmetric(matrix[:m, :m].toarray() - coupling.T @ solve(coupling)), solve, coupling


class Motions:
    """Of the unknowns `far`, orthonormal in K."""

    def __init__(self, stiffness):
        self.stiffness, self.kept = stiffness, numpy.zeros((stiffness.shape[0], 0))

    def add(self, fields, least):
        for _ in range(3):
            fields = fields - self.kept @ (self.kept.T @ (self.stiffness @ fields))
        value, turn = eigh(symmetric(fields.T @ (self.stiffness @ fields)))
        new = value > max(least, 1e-13 * value[-1])
        self.kept = numpy.hstack([self.kept, fields @ (turn[:, new] / numpy.sqrt(value[new]))])
        return numpy.count_nonzero(new)


def distances(block):
    """In elements, of the unknowns from the interface."""
    pattern = (abs(block.stiffness) + abs(block.damping)).tocsr() > 0
    seen, distance = numpy.zeros(block.size, bool), numpy.zeros(block.size, int)
    seen[block.interface] = True
    for step in range(1, block.size):
        new = (pattern @ seen) & ~seen
        if not new.any():
            return distance
        distance[new], seen = step, seen | new


def points_asked(strip, distance, step):
    top = strip.element * (FALLEN / distance) ** 2
    levels = 1 + int(max(math.log(top / strip.lowest) / math.log(step), 1))
    return [Point(0, 0), Point(1, strip.lowest)] + [Point((k + 1) % 2, strip.lowest * step ** k) for k in range(1, levels)]


def find_motions(full, load, far, motions, points, given):
    asked, random = 0, numpy.random.default_rng(1)
    m = full.count
    for point in points:
        schur, solve, coupling = full.schur(point)
        if point.inertia == 0:
            schur = schur + LIFT * numpy.trace(schur) / m * numpy.eye(m)
        low, held = cholesky(schur, lower=True), solve(load[m:])
        extra = [held / math.sqrt(load[m:] @ held)]
        for _ in range(0, m, given.chunk):
            moved = solve_triangular(low, random.choice([-1.0, 1.0], (m, given.chunk)), lower=True, trans="T")
            fields = numpy.column_stack([-solve(coupling @ moved)] + extra)
            least = given.at_rest if point.inertia == 0 else given.least * TOLERANCE ** 2
            new = motions.add(fields[far - m], least)
            asked += given.chunk
            if new <= given.share * fields.shape[1]:
                break
            extra = []
    return asked


def left(full, near, far, motions):
    """The system in near unknowns and motions, M diagonal."""
    kept = motions.kept
    mass = kept.T @ (full.mass[far][:, None] * kept)
    value, turn = eigh(symmetric(mass))
    kept = kept @ turn
    basis = scipy.sparse.bmat([[scipy.sparse.identity(len(near)), None], [None, scipy.sparse.csc_matrix(kept)]]).tocsc()
    order = numpy.concatenate([near, far])
    matrices = [basis.T @ matrix[order][:, order] @ basis for matrix in full.matrices]
    return System(*matrices, numpy.concatenate([full.mass[near], value]), numpy.arange(full.count))


def row(cells, distance, given):
    block = Block(cells)
    strip = Strip(block)
    full = System(block.stiffness, block.damping, block.mass, block.interface)
    order = numpy.concatenate([block.interface, block.interior])
    away = distances(block)[order]
    near, far = numpy.flatnonzero(away <= distance), numpy.flatnonzero(away > distance)
    motions = Motions(full.matrices[0][far][:, far].tocsc())
    asked = find_motions(full, block.load[order], far, motions, points_asked(strip, distance, given.step), given)
    small, worst = left(full, near, far, motions), 0
    for point in strip.random(12, seed=2):
        wanted, found = full.schur(point)[0], small.schur(point)[0]
        worst = max(worst, eigh(found - wanted, wanted, eigvals_only=True)[-1] / strip.allowed(point, TOLERANCE))
    return [f"{cells} x {cells}", distance, block.size, len(near) + motions.kept.shape[1], motions.kept.shape[1], asked,
            f"{worst:.3f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, nargs="+", default=[40])
    parser.add_argument("--distance", type=int, nargs="+", default=[8, 12, 16, 24])
    parser.add_argument("--least", type=float, default=0.25)
    parser.add_argument("--at-rest", type=float, default=1e-12)
    parser.add_argument("--step", type=float, default=6)
    parser.add_argument("--chunk", type=int, default=24)
    parser.add_argument("--share", type=float, default=0.75)
    given = parser.parse_args()
    rows = [row(cells, distance, given) for cells in given.cells for distance in given.distance]
    print(markdown_table(["cells", "distance", "unknowns", "left", "motions", "asked", "worst error"], rows))


if __name__ == "__main__":
    main()
