# SPDX-License-Identifier: GPL-2.0-or-later
"""The block of Figure 1 on n x n cells, normalised, with the unknowns that its interface keeps, and where in the strip of
docs/method.md, section 9, a reduction of it is asked. Assembled here, without the program. Used by basis_size.py."""
import math
from dataclasses import dataclass

import numpy
import scipy.sparse
from scipy.sparse.linalg import splu

POISSON, HEIGHT, STRIP = 0.34, 0.5, (0.225, 0.275)
MESH_SHARE, LEVEL_RATIO_LIMIT, LEVEL_LOWEST = 2.5, 100, 0.1   # of src/reduction/reduction.c, training_points.c
GAUSS = 1 / math.sqrt(3)


def element(dx, dz, deviator, trace):
    """Of a rectangle of four nodes, counter-clockwise from the lower left one; stiffness or viscosity."""
    law = numpy.array([[deviator + trace, trace, 0], [trace, deviator + trace, 0], [0, 0, deviator / 2]])
    corners = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    matrix = numpy.zeros((8, 8))
    for xi in (-GAUSS, GAUSS):
        for eta in (-GAUSS, GAUSS):
            slope_x = corners[:, 0] * (1 + corners[:, 1] * eta) / 4 * 2 / dx
            slope_z = corners[:, 1] * (1 + corners[:, 0] * xi) / 4 * 2 / dz
            strain = numpy.zeros((3, 8))
            strain[0, 0::2] = strain[2, 1::2] = slope_x
            strain[1, 1::2] = strain[2, 0::2] = slope_z
            matrix += strain.T @ law @ strain * dx * dz / 4
    return matrix


def solver(matrix):
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve


class Block:
    """stiffness, damping: sparse; mass: its diagonal; load; interface, interior: unknowns."""

    def __init__(self, cells):
        dx, dz = 1 / cells, HEIGHT / cells
        node = numpy.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)   # [z, x]
        corners = numpy.stack([node[:-1, :-1], node[:-1, 1:], node[1:, 1:], node[1:, :-1]], -1).reshape(-1, 4)
        unknowns = (2 * corners[:, :, None] + numpy.arange(2)).reshape(-1, 8)
        self.size = 2 * node.size
        row, column = numpy.repeat(unknowns, 8, axis=1).ravel(), numpy.tile(unknowns, (1, 8)).ravel()

        def assemble(matrix):
            values = numpy.tile(matrix.ravel(), len(corners))
            return scipy.sparse.csc_matrix((values, (row, column)), shape=(self.size, self.size))

        self.stiffness = assemble(element(dx, dz, 1 / (1 + POISSON), POISSON / (1 - POISSON ** 2)))
        self.damping = assemble(element(dx, dz, 0.5, 0.5))
        self.mass = numpy.bincount(unknowns.ravel(), minlength=self.size) * dx * dz / 4
        self.load = numpy.zeros(self.size)
        self.load[2 * node[-1, 1:-1] + 1] = -1
        self.load[2 * node[-1, [0, -1]] + 1] = -0.5
        # A node of the face takes part where its stretch, half way to its neighbours, reaches into the rod's strip.
        height = numpy.arange(cells + 1) * dz
        inside = (height + dz / 2 > STRIP[0] + 1e-9) & (height - dz / 2 < STRIP[1] - 1e-9)
        contact = (2 * node[0][:, None] + numpy.arange(2)).ravel()
        self.interface = numpy.concatenate([contact, 2 * node[inside, 0]])
        self.interior = numpy.setdiff1d(numpy.arange(self.size), self.interface)

    def split(self, matrix):
        """Rows of the interior: those columns, and those of the interface."""
        rows = matrix.tocsr()[self.interior]
        return rows[:, self.interior].tocsc(), rows[:, self.interface].toarray()


@dataclass(frozen=True)
class Point:
    """A = (1 - viscosity) K + viscosity C + inertia M"""
    viscosity: float
    inertia: float


@dataclass(frozen=True)
class Answer:
    """At one point. schur: S; missing: S of static modes alone less S; beyond: [interior, interface] answers less the static ones;
    loaded: the answer to the load, interface held."""
    schur: numpy.ndarray
    missing: numpy.ndarray
    beyond: numpy.ndarray
    loaded: numpy.ndarray


class Mesh:
    """inner, coupling: K and C of the interior, and between it and the interface; static: the static modes' interior."""

    def __init__(self, block):
        both = (block.stiffness, block.damping)
        self.inner, self.coupling = zip(*[block.split(matrix) for matrix in both])
        self.outer = [matrix[block.interface][:, block.interface].toarray() for matrix in both]
        self.mass, self.outer_mass = block.mass[block.interior], numpy.diag(block.mass[block.interface])
        self.load = block.load[block.interior]
        self.static = -solver(self.inner[0])(self.coupling[0])

    @staticmethod
    def mixed(point, pair):
        return (1 - point.viscosity) * pair[0] + point.viscosity * pair[1]

    def matrix(self, point):
        return (self.mixed(point, self.inner) + point.inertia * scipy.sparse.diags(self.mass)).tocsc()

    def static_schur(self, point):
        """S of static modes alone"""
        outer = self.mixed(point, self.outer) + point.inertia * self.outer_mass
        beside = self.mixed(point, self.coupling).T @ self.static
        return outer + beside + beside.T + self.static.T @ (self.matrix(point) @ self.static)

    def answers(self, point):
        matrix = self.matrix(point)
        solve = solver(matrix)
        beyond = -solve(matrix @ self.static + self.mixed(point, self.coupling))
        missing = beyond.T @ (matrix @ beyond)
        missing = (missing + missing.T) / 2
        return Answer(self.static_schur(point) - missing, missing, beyond, solve(self.load))


class Strip:
    """slowest, element: the inertias at which the interior's slowest mode, and one element, are in balance."""

    def __init__(self, block):
        solve = splu(block.split(block.stiffness)[0]).solve
        mass, x = block.mass[block.interior], numpy.ones(len(block.interior))
        for _ in range(4):
            x /= math.sqrt(x @ (mass * x))
            right = mass * x
            x = solve(right)
            self.slowest = 1 / (x @ right)
        self.element = (block.stiffness.diagonal() / block.mass)[block.interface].max()
        self.lowest = min(LEVEL_LOWEST * self.slowest, self.element / LEVEL_RATIO_LIMIT)

    def level(self, part):
        return self.lowest * (self.element / self.lowest) ** part

    def allowed(self, point, tolerance):
        return max(tolerance * (tolerance + MESH_SHARE * point.inertia / self.element), 1e-10)

    def visits(self):
        """In the program's order, for this material: its moduli's quotient changes by less than 2 from K to C."""
        steps = math.ceil(math.log(self.element / self.lowest) / math.log(LEVEL_RATIO_LIMIT))
        points = []
        for first in (0, 1):
            for k in range(first, 2 * steps + 1, 2):
                points += [Point(v, self.level(k / (2 * steps))) for v in (0.0, 1.0)]
            if first == 0:
                points.append(Point(self.between(), self.level(0)))
        return points + points[-1:]

    @staticmethod
    def between():
        """The viscosity half way from K to C, by the quotient of areal and shear modulus."""
        elastic, areal = 1 / (1 + POISSON), 1 / (1 + POISSON) + 2 * POISSON / (1 - POISSON ** 2)
        volume, shear = 1.5 / areal, 0.5 / elastic
        quotient = math.sqrt(volume / shear)
        return (1 - quotient) / (1 - quotient + quotient * shear - volume)

    def grid(self, levels, viscosities):
        return [Point(v, self.level(part)) for part in numpy.linspace(0, 1, levels)
                for v in numpy.linspace(0, 1, viscosities)]

    def random(self, count, seed):
        draw = numpy.random.default_rng(seed).random((count, 2))
        return [Point(v, self.level(part)) for v, part in draw]
