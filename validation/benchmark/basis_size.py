#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""How small could the basis of the reduction be? Figure 1 on n x n cells, repeated in numpy without the program.

    validation/benchmark/basis_size.py [--cells 20 40] [--tolerance 2e-2 2e-3] [--no-best] [--no-vibration]

Interior unknowns r with which the error of S (docs/method.md, section 9) stays within what is allowed:

- one point: the eigenvalues of the static modes' error there above what is allowed. No basis has fewer.
- bound: likewise of several points. With F_p the answers less the static ones, in units of what is allowed, N no larger than any A_p,
  weights w_p of sum 1, a basis of r must leave no eigenvalue of sum w_p F_p F_p' (in N) but r above 1.
- best found: sum of the errors' powers made least over all bases of r unknowns (L-BFGS, from POD's), r by bisection.
- POD: of the answers at all points of a grid, in units of what is allowed, in the energy of K.
- weighted POD: the directions that the last one answers badly weigh more in the next, of ROUNDS; at the program's points only.
- program: the greedy choice, point by point in the program's order; compared with the program's own number.
- vibration: the lowest modes with the interface held (Craig and Bampton), for motions alone: the load takes nearly all of them.

Worst errors over what is allowed are asked on a grid and at points drawn at random. A minute and a half of processor time at
20 x 20, some five at 40 x 40."""
import argparse
import json
import math
import os
import subprocess
import tempfile
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy
from scipy.linalg import cho_factor, cho_solve, cholesky, eigh, qr, solve_triangular
from scipy.optimize import minimize

from measured_run import PROGRAM, ROOT, commit, markdown_table
from strip_block import Block, Mesh, Point, Strip

NEGLIGIBLE = 1e-3   # of what is allowed: what the space that bases are looked for in leaves out
ROUNDS = 12
STAGES = ((4, 30), (10, 40), (30, 60))   # powers, and the iterations with each
WINDOWS = ((0.2, 0.6), (0.2, 0.7), (0.3, 0.7), (0.3, 0.8), (0.4, 0.8))   # parts of the way up the strip


def symmetric(a):
    return (a + a.T) / 2


def whiten(low, a):
    """L^-1 a L^-T"""
    half = solve_triangular(low, a, lower=True)
    return symmetric(solve_triangular(low, half.T, lower=True))


class Space:
    """What all answers of the strip span beyond the static modes, orthonormal in K. All bases are looked for in it."""

    def __init__(self, mesh, strip, points, tolerance):
        self.mesh, self.strip = mesh, strip
        stiffness, batch = mesh.inner[0], []
        kept = numpy.zeros((len(mesh.load), 0))
        for point in points:
            batch += self.wanted(point, tolerance)
            if sum(part.shape[1] for part in batch) > 400 or point is points[-1]:
                kept = numpy.hstack([kept] + batch)
                value, turn = eigh(symmetric(kept.T @ (stiffness @ kept)))
                kept, batch = kept @ turn[:, value > NEGLIGIBLE / 5], []
        kept /= numpy.sqrt(numpy.einsum("ij,ij->j", kept, stiffness @ kept))
        low = cholesky(symmetric(kept.T @ (stiffness @ kept)), lower=True)
        kept = solve_triangular(low, kept.T, lower=True).T
        self.size = kept.shape[1]
        self.damping, self.mass = kept.T @ (mesh.inner[1] @ kept), kept.T @ (mesh.mass[:, None] * kept)
        self.static_damping = (mesh.inner[1] @ mesh.static + mesh.coupling[1]).T @ kept
        self.static_mass = (mesh.mass[:, None] * mesh.static).T @ kept
        self.load = kept.T @ mesh.load

    def wanted(self, point, tolerance):
        """Differences of answers with a noticeable error, and the answer to the load, in units of what is allowed."""
        mesh, allowed = self.mesh, self.strip.allowed(point, tolerance)
        answer = mesh.answers(point)
        low = cholesky(answer.schur, lower=True)
        value, y = eigh(whiten(low, answer.missing))
        y = solve_triangular(low, y[:, value > NEGLIGIBLE * allowed], lower=True, trans="T")
        load = answer.loaded / math.sqrt(allowed * (mesh.load @ answer.loaded))
        return [answer.beyond @ y / math.sqrt(allowed), load[:, None]]


class Basis:
    def __init__(self, space, modes):
        self.modes = modes
        self.damping, self.mass = modes.T @ space.damping @ modes, modes.T @ space.mass @ modes

    def first(self, count):
        part = object.__new__(Basis)
        part.modes = self.modes[:, :count]
        part.damping, part.mass = self.damping[:count, :count], self.mass[:count, :count]
        return part


class Ask:
    """One point. pull: [size, m + 1] what static modes leave out, by interface motion with y'Sy = 1, last the load with energy
    1; fields: the answers to these; missing: errors of the static modes alone. answer: of the full mesh, else the space's;
    of_load: whether its answer counts."""

    def __init__(self, space, point, tolerance, answer=None, of_load=True):
        self.point, self.allowed, self.of_load = point, space.strip.allowed(point, tolerance), of_load
        v, i = point.viscosity, point.inertia
        full = (1 - v) * numpy.eye(space.size) + v * space.damping + i * space.mass
        coupling = v * space.static_damping + i * space.static_mass
        factor = cho_factor(full, lower=True)
        loaded = cho_solve(factor, space.load)
        if answer:
            schur, missing, energy = answer.schur, answer.missing, space.mesh.load @ answer.loaded
        else:
            missing, energy = coupling @ cho_solve(factor, coupling.T), space.load @ loaded
            schur = space.mesh.static_schur(point) - missing
        low = cholesky(symmetric(schur), lower=True)
        self.missing = whiten(low, missing)
        self.pull = numpy.column_stack([solve_triangular(low, coupling, lower=True).T, space.load / math.sqrt(energy)])
        self.fields = cho_solve(factor, self.pull)

    def factor(self, basis):
        v, i = self.point.viscosity, self.point.inertia
        inner = (1 - v) * numpy.eye(len(basis.mass)) + v * basis.damping + i * basis.mass
        return cholesky(inner, lower=True)

    def errors(self, basis):
        """(S_r - S) over S, and of the load's energy, both over what is allowed"""
        half = solve_triangular(self.factor(basis), basis.modes.T @ self.pull, lower=True)
        found, load = half[:, :-1], half[:, -1]
        return (self.missing - found.T @ found) / self.allowed, (1 - load @ load) / self.allowed

    def worst(self, basis):
        motions, load = self.errors(basis)
        last = len(motions) - 1
        return max(eigh(motions, eigvals_only=True, subset_by_index=[last, last])[0], load if self.of_load else 0)

    def residual(self, basis):
        """Fields that the basis lacks: of the motions that are off by more than is allowed, and of the load."""
        half = solve_triangular(self.factor(basis), basis.modes.T @ self.pull, lower=True)
        lacking = self.fields - basis.modes @ solve_triangular(self.factor(basis), half, lower=True, trans="T")
        motions, load = self.errors(basis)
        value, y = eigh(motions)
        return numpy.column_stack([lacking[:, :-1] @ y[:, value > 1]] + ([lacking[:, -1]] if load > 1 else []))


def worst(asks, basis):
    return max(ask.worst(basis) for ask in asks)


def fewest(asks, basis):
    """Of the first columns, so that no error is above what is allowed; None: all are too few."""
    def enough(count):
        for k, ask in enumerate(asks):
            if ask.worst(basis.first(count)) > 1:
                asks.insert(0, asks.pop(k))   # asked first the next time
                return False
        return True

    asks, low, high = list(asks), 0, basis.modes.shape[1]
    if not enough(high):
        return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if enough(middle) else (middle, high)
    return high


def greedy(space, asks):
    modes = space.load[:, None] / numpy.linalg.norm(space.load)
    for ask in asks:
        new = ask.residual(Basis(space, modes))
        if new.shape[1] == 0:
            continue
        new /= numpy.linalg.norm(new, axis=0)
        for _ in range(2):
            new = qr(new - modes @ (modes.T @ new), mode="economic")[0]
        modes = numpy.column_stack([modes, new])
    return Basis(space, modes)


def principal(space, asks, weights=None):
    """weights: by point, [m + 1, m + 1]"""
    total = numpy.zeros((space.size, space.size))
    for k, ask in enumerate(asks):
        total += (ask.fields @ weights[k] if weights else ask.fields) @ ask.fields.T / ask.allowed
    return Basis(space, eigh(total)[1][:, ::-1])


def joined(motions, load):
    both = numpy.zeros((len(motions) + 1,) * 2)
    both[:-1, :-1], both[-1, -1] = motions, load
    return both


def power(a, exponent):
    value, y = eigh(a)
    return (y * numpy.maximum(value, 0) ** exponent) @ y.T


def weighted(space, asks):
    """The smallest of ROUNDS; third powers of the last one's errors are added to the weights."""
    weights = [numpy.eye(ask.fields.shape[1]) for ask in asks]
    best = None
    for _ in range(ROUNDS):
        basis = principal(space, asks, weights)
        count = fewest(asks, basis)
        if best is None or count < best.modes.shape[1]:
            best = basis.first(count)
        less = basis.first(best.modes.shape[1] - max(1, count // 25))
        for k, ask in enumerate(asks):
            weights[k] = weights[k] + 5 * power(joined(*ask.errors(less)), 3)
    return best


def powers_of_errors(flat, space, asks, exponent):
    """log of the sum of tr(errors^exponent), over the exponent, and its gradient: -2 (b - A V q) W q', q = (V'AV)^-1 V'b."""
    modes = flat.reshape(space.size, -1)
    applied = [modes, space.damping @ modes, space.mass @ modes]
    total, gradient = 0, numpy.zeros_like(modes)
    for ask in asks:
        v, i = ask.point.viscosity, ask.point.inertia
        image = (1 - v) * applied[0] + v * applied[1] + i * applied[2]
        pulled = modes.T @ ask.pull
        q = cho_solve(cho_factor(symmetric(modes.T @ image), lower=True), pulled)
        errors = joined(ask.missing - pulled[:, :-1].T @ q[:, :-1], 1 - pulled[:, -1] @ q[:, -1]) / ask.allowed
        value, y = eigh(errors)
        value = numpy.maximum(value, 0)
        total += (value ** exponent).sum()
        weight = (y * value ** (exponent - 1)) @ y.T
        gradient -= 2 / ask.allowed * ((ask.pull - image @ q) @ weight) @ q.T
    return math.log(total) / exponent, gradient.ravel() / total


def best_of(space, asks, start, count):
    modes = start.modes[:, :count]
    for exponent, iterations in STAGES:
        found = minimize(powers_of_errors, modes.ravel(), args=(space, asks, exponent), jac=True, method="L-BFGS-B",
                         options={"maxiter": iterations, "maxcor": 20})
        modes = numpy.linalg.qr(found.x.reshape(space.size, count))[0]
    return Basis(space, modes)


def best_found(space, asks, start, low, high):
    """By bisection to 3 %."""
    best = start.first(high)
    while high - low > max(1, 0.03 * high):
        middle = (low + high) // 2
        basis = best_of(space, asks, start, middle)
        if worst(asks, basis) <= 1:
            best, high = basis, middle
        else:
            low = middle
    return best


def one_point(asks):
    return max(int((eigh(ask.missing, eigvals_only=True) > ask.allowed).sum()) for ask in asks)


def bound_in(space, tolerance, window):
    """N = C + inertia M at the window's lower end: here C <= K, and no A is smaller. (Weights by trial: any give a bound.)"""
    levels = numpy.linspace(*window, 5)
    asks = [Ask(space, Point(v, space.strip.level(part)), tolerance) for part in levels for v in (0.0, 1.0)]
    low = cholesky(space.damping + space.strip.level(window[0]) * space.mass, lower=True)
    seen = []
    for ask in asks:
        y = eigh(ask.missing)[1]
        in_norm = low.T @ ask.fields / math.sqrt(ask.allowed)
        seen += [in_norm[:, :-1] @ y, in_norm[:, -1:]]   # motions and load are bounded each for itself
    weights, most = numpy.full(len(seen), 1 / len(seen)), 0
    for _ in range(40):
        value, y = eigh(sum(w * (f @ f.T) for w, f in zip(weights, seen)))
        count = int((value > 1).sum())
        most = max(most, count)
        near = y[:, ::-1][:, max(0, count - 3):count + 6]
        weights *= numpy.sqrt([((near.T @ f) ** 2).sum() for f in seen])
        weights /= weights.sum()
    return most


def vibration(mesh, strip, points, tolerance):
    """How many of the lowest modes with the interface held, at the highest inertias of these points."""
    root = 1 / numpy.sqrt(mesh.mass)
    value, modes = eigh((mesh.inner[0].multiply(root).T.multiply(root)).toarray())
    modes *= root[:, None]   # orthonormal in M; in K below
    modes /= numpy.sqrt(value)
    space = object.__new__(Space)
    space.mesh, space.strip, space.size = mesh, strip, len(value)
    space.damping, space.mass = modes.T @ (mesh.inner[1] @ modes), numpy.diag(1 / value)
    space.static_damping = (mesh.inner[1] @ mesh.static + mesh.coupling[1]).T @ modes
    space.static_mass = (mesh.mass[:, None] * mesh.static).T @ modes
    space.load = modes.T @ mesh.load
    basis = object.__new__(Basis)
    basis.modes, basis.damping, basis.mass = numpy.eye(space.size), space.damping, space.mass
    hardest = [point for point in points if point.inertia > 0.01 * strip.element][:4]
    return fewest([Ask(space, point, tolerance, of_load=False) for point in hardest], basis)


def of_program(cells, tolerance):
    with tempfile.TemporaryDirectory() as folder:
        settings = [f"mesh.set.nx={cells}", f"mesh.set.nz={cells}", f"reduction.tolerance={tolerance}",
                    "reduction.cache=false", "output.figures=[]", "output.fields=none", "time.until.U=1e-5"]
        subprocess.run([PROGRAM, "run", ROOT / "validation/paper/fig1.yaml", "--quiet", "-o", f"{folder}/result",
                        *[f"--set={setting}" for setting in settings]], check=True)
        with open(f"{folder}/result/run.json", encoding="utf-8") as file:
            return json.load(file)["model"]["reduced_dofs"]


def study(cells, tolerances, options):
    block = Block(cells)
    strip, mesh = Strip(block), Mesh(block)
    grid = strip.grid(40, 5) if cells <= 20 else strip.grid(24, 3)
    space = Space(mesh, strip, grid + strip.visits(), min(tolerances))
    drawn = [(point, mesh.answers(point)) for point in strip.random(40, 1)]
    interface = len(block.interface)
    for tolerance in tolerances:
        asks = [Ask(space, point, tolerance) for point in grid]
        visits = [Ask(space, point, tolerance) for point in strip.visits()]
        random = [Ask(space, point, tolerance, answer) for point, answer in drawn]

        def row(name, basis, asks=asks, random=random, case=f"{cells} x {cells}, {tolerance:g}"):
            count = basis.modes.shape[1]
            print(markdown_row(case, name, count, interface + count, worst(asks, basis), worst(random, basis)), flush=True)

        def row_of_count(name, count, case=f"{cells} x {cells}, {tolerance:g}"):
            print(markdown_row(case, name, count, interface + count if count else None, None, None), flush=True)

        row_of_count("one point", one_point(asks))
        bound = max(bound_in(space, tolerance, window) for window in WINDOWS)
        row_of_count("bound", bound)
        chosen, pod = greedy(space, visits), principal(space, asks)
        pod_count = fewest(asks, pod)
        if options.best:
            some = [Ask(space, point, tolerance) for point in strip.grid(20 if cells <= 20 else 16, 3 if cells <= 20 else 2)]
            row("best found", best_found(space, some, pod, bound, pod_count))
        row("weighted POD", weighted(space, visits[:-1]))
        row("POD", pod.first(pod_count))
        row("program", chosen)
        row_of_count("program itself", of_program(cells, tolerance) - interface)
        if options.vibration:
            row_of_count("vibration", vibration(mesh, strip, strip.visits(), tolerance))


def markdown_row(*cells):
    return "| " + " | ".join("" if c is None else f"{c:.2f}" if isinstance(c, float) else str(c) for c in cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--cells", type=int, nargs="+", default=[20, 40])
    parser.add_argument("--tolerance", type=float, nargs="+", default=[2e-2, 2e-3])
    parser.add_argument("--no-best", dest="best", action="store_false")
    parser.add_argument("--no-vibration", dest="vibration", action="store_false")
    options = parser.parse_args()
    head = ["cells, tolerance", "basis", "r", "m + r", "worst error over allowed, grid", "at random"]
    print(f"version {commit()}\n\n{markdown_table(head, [])}", flush=True)
    for cells in options.cells:
        study(cells, options.tolerance, options)


if __name__ == "__main__":
    main()
