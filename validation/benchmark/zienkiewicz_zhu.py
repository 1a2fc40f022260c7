# SPDX-License-Identifier: GPL-2.0-or-later
"""The recovery-based error indicator of O. C. Zienkiewicz and J. Z. Zhu, Int. J. Numer. Methods Eng. 24 (1987) 337,
of a state of linear elasticity on quads of order 1; used by estimators.py.

Stress is continuous, that of finite elements jumps from cell to cell. So a stress is made that is interpolated from nodes,
where it is the mean of the cells around (their projection, with a lumped mass matrix), and the energy of the difference
stands for the energy of the error."""
import numpy

CORNERS = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])      # of the square that each cell is the image of
GAUSS = CORNERS / numpy.sqrt(3)                                 # two by two points, all of weight 1


def shape_values():
    """[point, node]"""
    return numpy.prod(1 + GAUSS[:, None] * CORNERS, axis=2) / 4


def shape_slopes():
    """[point, direction, node]"""
    one = 1 + GAUSS[:, None] * CORNERS
    return numpy.stack([CORNERS[:, 0] * one[:, :, 1], CORNERS[:, 1] * one[:, :, 0]], axis=1) / 4


def plane_stress(young, poisson):
    """Stress (xx, zz, xz) from strain (xx, zz, twice xz)."""
    return young / (1 - poisson**2) * numpy.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson) / 2]])


def stress_of(position, displacement, cells, stiffness):
    """Stress [cell, point, component] and the area [cell, point] that each point stands for."""
    slopes = shape_slopes()
    jacobian = numpy.einsum("qia,eaj->eqij", slopes, position[cells])
    gradient = numpy.einsum("eqij,qja,eak->eqik", numpy.linalg.inv(jacobian), slopes, displacement[cells])
    strain = numpy.stack([gradient[..., 0, 0], gradient[..., 1, 1], gradient[..., 0, 1] + gradient[..., 1, 0]], axis=-1)
    return strain @ stiffness, numpy.linalg.det(jacobian)


def recovered(stress, area, cells, node_count):
    """The continuous stress at the same points."""
    values = shape_values()
    total, share = numpy.zeros((node_count, 3)), numpy.zeros(node_count)
    numpy.add.at(total, cells, numpy.einsum("qa,eq,eqc->eac", values, area, stress))
    numpy.add.at(share, cells, numpy.einsum("qa,eq->ea", values, area))
    return numpy.einsum("qa,eac->eqc", values, (total / share[:, None])[cells])


def energies(position, displacement, cells, young, poisson):
    """Of each cell: twice its elastic energy, and the same of the error as recovery sees it. position, displacement:
    [node, 2]; cells: [cell, 4] around."""
    stiffness = plane_stress(young, poisson)
    compliance = numpy.linalg.inv(stiffness)
    stress, area = stress_of(position, displacement, cells, stiffness)
    difference = recovered(stress, area, cells, len(position)) - stress
    return (numpy.einsum("eq,eqc,cd,eqd->e", area, part, compliance, part) for part in (stress, difference))
