# SPDX-License-Identifier: GPL-2.0-or-later
"""Which mesh each point of figures 2a and 2b takes: the first pair of N and 2N cells that agree and whose cells l_c holds.

Pairs in turn: 40 and 80 even cells; 80 and 160, then 160 and 320, finer towards both ends of the contact, where slip sets out
and where pressure is highest, and towards the contact. They have 40 rows, and cost what their contact nodes do.
"""
import json

import numpy as np

from windows import AGREE, CELLS_RESOLVED, END_CELLS, difference

EVEN = 40
FINER = (80, 160, 320)
GRADED, STEEP = 3, 100                   # the middle cell over the end's; STEEP where the last nodes decide
NAMES = {1: "", GRADED: "graded", STEEP: "steep"}
FIRST_CELL = {1: 1, GRADED: 0.48, STEEP: 0.032}     # the end's, over L/N
LONGEST_CELL = 1.4                       # of GRADED, over L/N
LOWEST_ROW = {1: {80: 1, 160: 4, 320: 12}, GRADED: {80: 3, 160: 8, 320: 24}, STEEP: {80: 60, 160: 120, 320: 240}}   # grade_z
AT_STATIC = 0.98                         # mu_M over mu_S where the whole contact is about to slip
STEADY = AGREE / 4                       # runs of a window that scatter less, relative: one of them will do


def grade(material, pair):
    """Of a point's finer meshes. Cells must be no longer, wherever slip runs, than the length that viscosity holds weakening
    on, (eta1 + eta2) v_c / ((mu_S - mu_K) P); where that leaves none to spare, they are even."""
    drop = material.mu_static - material.mu_kinetic
    held = material.eta_t * material.critical_velocity / (drop * pair.P * pair.length)
    if LONGEST_CELL / FINER[1] > held:
        return 1
    return STEEP if pair.waits(material.mu_static) else GRADED


def settings(cells, grade_x):
    """The lowest row is about as high as the end's cell is long; where that is very short, as high as is enough."""
    return [f"mesh.set.nx={cells}", "mesh.set.nz=40", f"mesh.set.grade_x={grade_x}", f"mesh.set.grade_z={LOWEST_ROW[grade_x][cells]}",
            "reduction.use=always"]


class Pair:
    """One point on two meshes: windows of N = `cells` and of 2N."""

    def __init__(self, coarse, fine, cells, grade_x=1):
        self.coarse, self.fine, self.cells, self.grade = coarse, fine, cells, grade_x
        self.length, self.P = coarse.length, coarse.P

    def difference(self):
        return difference(self.coarse, self.fine)

    def cells_in_front(self):
        """l_c in cells of N, as long as those where slip sets out."""
        return self.coarse.l_c * self.cells / FIRST_CELL[self.grade]

    def agrees(self):
        return abs(self.difference()) <= AGREE

    def waits(self, mu_static):
        """Sliding waits for the last nodes to let go, and not because all of the contact holds mu_S: finer cells let go sooner."""
        left = (1 - self.coarse.l_c) * self.cells / FIRST_CELL[self.grade]
        return left < END_CELLS and self.fine.mu < AT_STATIC * mu_static

    def settled(self, mu_static):
        """Where slip is slow there is no l_c: agreement is enough."""
        return self.agrees() and not (self.cells_in_front() < CELLS_RESOLVED or self.waits(mu_static))

    def scatter(self):
        """Per cent, of a single run on either mesh."""
        return 100 * max(window.scatter / window.mu for window in (self.coarse, self.fine))

    def error(self):
        """Per cent: standard error of the finer window's mean, from that scatter."""
        return self.scatter() / np.sqrt(len(self.fine.rows))


def study_text(base, folder, points):
    """The study `base` with its scene and settings, at these (length, pressure) in place of what it varies."""
    lines = [f"scene: {json.dumps(str(folder / line.split(':')[1].strip()))}" if line.startswith("scene:") else line
             for line in base.split("cases:")[0].splitlines()]
    lines += ["cases:"] + [f"  - {{mesh.set.length: {length!r}, load.pressure: {P!r}}}" for length, P in points]
    return "\n".join(lines) + "\n"


def pressures(window, cells):
    """Of the window on the mesh of `cells`: both ends and the middle; on the last the middle alone where runs do not scatter."""
    rows = window.rows
    middle = len(rows) // 2
    one = cells == FINER[-1] and window.scatter <= STEADY * window.mu
    return [rows[k]["load.pressure"] for k in ([middle] if one else sorted({0, middle, len(rows) - 1}))]


def nearest(window, at):
    """The key in `at`, of windows, whose window stands at the same length and pressure."""
    return min((k for k in at if at[k].length == window.length), key=lambda k: abs(np.log(at[k].P / window.P)))


def refine(pairs, material, compute):
    """`pairs`, in place of those not settled finer ones. compute(cells, grade_x, points): windows of runs at (length, pressure)."""
    pairs = list(pairs)
    wanted = {k: grade(material, pair) for k, pair in enumerate(pairs) if not pair.settled(material.mu_static)}
    for grade_x in (STEEP, GRADED, 1):
        coarse = {k: pairs[k].coarse for k in wanted if wanted[k] == grade_x}
        for cells in FINER:
            if not coarse:
                break
            points = sorted((window.length, P) for window in coarse.values() for P in pressures(window, cells))
            fine = {nearest(window, coarse): window for window in compute(cells, grade_x, points)}
            if cells > FINER[0]:
                for k, window in fine.items():
                    pairs[k] = Pair(coarse[k], window, cells // 2, grade_x)
                fine = {k: window for k, window in fine.items() if not pairs[k].settled(material.mu_static)}
            coarse = fine
    return pairs
