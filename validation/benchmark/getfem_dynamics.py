#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The driven block in time, by GetFEM's bricks: a peer that peers.py sets beside amontons.

    validation/benchmark/getfem_dynamics.py -mesh block.msh -out mu.txt -top 3 -dt 0.1 -steps 100 ...

Stiffness and viscosity are assembled by GetFEM on the gmsh mesh (msh 2.2, triangles); each stage of
the two-stage SDIRK is a model A v = rhs + r with a basic contact brick for the floor (Alart and
Curnier's augmented Lagrangian, on nodes, friction on the velocity) and one without friction for the
rod, solved by GetFEM's Newton method. The brick takes a friction coefficient a node, but not one
that falls with the slip rate: that is found by solving again with mu(v) of the last solution, until
it stays. Prints steps, seconds, models solved. Writes "t mu" a step. The words on the command line
are those of dynamics.edp. Needs Debian's python3-getfem."""
import sys
import time

import getfem
import numpy as np

GAMMA = 1 - 1 / np.sqrt(2)
FIXED_POINT = 1e-9         # of mu(v), absolute
OUTER_MAX = 200
RESIDUAL = 1e-14           # of Newton's method: forces, of which the largest is some 1e-3


def words():
    found = dict(zip(sys.argv[1::2], sys.argv[2::2]))
    numbers = {key.lstrip("-"): float(value) for key, value in found.items()
               if key not in ("-mesh", "-out")}
    return found["-mesh"], found["-out"], numbers


class Block:
    """K, C, M, load and the dofs of floor and rod; dofs as GetFEM numbers them."""

    def __init__(self, path, pressure, top):
        mesh = getfem.Mesh("import", "gmsh", path)
        self.fem = getfem.MeshFem(mesh, 2)
        self.fem.set_fem(getfem.Fem("FEM_PK(2,1)"))
        rule = getfem.MeshIm(mesh, getfem.Integ("IM_TRIANGLE(2)"))
        lumped = getfem.MeshIm(mesh, getfem.Integ("IM_NC(2,1)"))   # points are the vertices
        self.count = self.fem.nbdof()
        young, nu = 1.0, 0.34
        form = "(({})*Sym(Grad_u)+({})*Trace(Grad_u)*Id(2)):Grad_Test_u"
        self.stiffness = self.assemble(rule, 2, form.format(young / (1 + nu),
                                                            young * nu / (1 - nu**2)))
        self.damping = self.assemble(rule, 2, form.format(1, 1))
        self.mass = self.assemble(lumped, 1, "[1,1].Test_u")
        self.load = self.assemble(rule, 1, f"[0,-{pressure!r}].Test_u", top)
        points = self.fem.basic_dof_nodes()
        x, z = points[0], points[1]
        along = np.arange(self.count) % 2 == 0       # u_x
        height = z.max()
        small = 1e-9 * height
        floor = np.flatnonzero(along & (z < small))
        self.floor = floor[np.argsort(x[floor])]     # u_x of each contact node; u_z is the next
        self.rod = np.flatnonzero(along & (x < small) & (z > small) &
                                  (abs(z - height / 2) <= height / 20 + small))
        self.normal_force = -self.load.sum()

    def assemble(self, rule, order, form, region=-1):
        """order 1: a vector, 2: a matrix."""
        return getfem.asm("generic", rule, order, form, region, "u", 1, self.fem,
                          np.zeros(self.count))


def picking(rows, columns, value):
    matrix = getfem.Spmat("empty", len(rows), columns)
    for i, dof in enumerate(rows):
        matrix.add(i, int(dof), value)
    return matrix


def combine(*terms):
    total = None
    for factor, matrix in terms:
        part = getfem.Spmat("copy", matrix)
        part.scale(factor)
        total = part if total is None else getfem.Spmat("add", total, part)
    return total


class Stage:
    """The model A v = rhs + r."""

    def __init__(self, block, scaled, friction):
        self.block, self.friction, self.solved = block, friction, 0
        mass = getfem.Spmat("empty", block.count)
        for i, value in enumerate(block.mass):
            mass.add(i, i, float(value))
        matrix = combine((1 / scaled, mass), (1.0, block.damping), (scaled, block.stiffness))
        self.matrix = matrix
        floor, rod = block.floor, block.rod
        model = self.model = getfem.Model("real")
        model.add_fem_variable("v", block.fem)
        model.add_variable("pressing", len(floor))
        model.add_variable("shear", len(floor))
        model.add_variable("push", len(rod))
        model.add_explicit_matrix("v", "v", matrix, 1, 1)
        self.right = model.add_explicit_rhs("v", np.zeros(block.count))
        scale = np.asarray(matrix.diag()).mean()
        model.add_initialized_data("r", [scale])
        model.add_initialized_data("one", [1.0])
        model.add_initialized_data("mu", np.full(len(floor), friction.mu_static))
        model.add_initialized_data("floor_gap", np.zeros(len(floor)))
        model.add_initialized_data("rod_gap", np.zeros(len(rod)))
        count = block.count
        model.add_basic_contact_brick(
            "v", "pressing", "shear", "r", picking(floor + 1, count, -1.0),
            picking(floor, count, 1.0), "mu", "floor_gap", "one", 1)
        model.add_basic_contact_brick("v", "push", "r", picking(rod, count, -1.0), "rod_gap",
                                      "one", 1)

    def solve(self, rhs, floor_bound, rod_bound):
        """v, and the rod's forces. Starts from the last solution."""
        model, friction = self.model, self.friction
        model.set_private_rhs(self.right, rhs)
        model.set_variable("floor_gap", -floor_bound)
        model.set_variable("rod_gap", -rod_bound)
        for _ in range(OUTER_MAX):
            model.solve("max_iter", 60, "max_res", RESIDUAL, "lsolver", "mumps")   # superlu ends in a segmentation fault
            self.solved += 1
            v = np.asarray(model.variable("v"))
            before = np.asarray(model.variable("mu"))
            mu = friction(np.abs(v[self.block.floor]))
            model.set_variable("mu", mu)
            if np.abs(mu - before).max() < FIXED_POINT:
                return v, -np.asarray(model.variable("push"))
        raise SystemExit("mu(v) does not settle")


class Friction:
    def __init__(self, mu_static, mu_kinetic, critical):
        self.mu_static, self.mu_kinetic, self.critical = mu_static, mu_kinetic, critical

    def __call__(self, speed):
        return np.maximum(self.mu_kinetic, self.mu_static - (self.mu_static - self.mu_kinetic)
                          * speed / self.critical)


def relaxed(block):
    """Displacement at rest under the load, without friction; where along x does not matter."""
    model = getfem.Model("real")
    model.add_fem_variable("u", block.fem)
    model.add_explicit_matrix("u", "u", block.stiffness, 1, 1)
    model.add_explicit_rhs("u", block.load)
    held = picking(np.append(block.floor + 1, block.floor[0]), block.count, 1.0)
    model.add_variable("reaction", len(block.floor) + 1)
    model.add_constraint_with_multipliers("u", "reaction", held, np.zeros(len(block.floor) + 1))
    model.solve()
    return np.asarray(model.variable("u"))


def main():
    path, out, number = words()
    block = Block(path, number["pressure"], int(number["top"]))
    step, speed = number["dt"], number["speed"]
    scaled = GAMMA * step
    stage = Stage(block, scaled, Friction(number["muS"], number["muK"], number["vc"]))
    u, v = relaxed(block), np.zeros(block.count)
    origin = u[block.rod]
    started = time.process_time()

    def advance(momentum, predictor, at):
        elastic = np.asarray(block.stiffness.mult(predictor))
        return stage.solve(momentum / scaled + block.load - elastic,
                           -predictor[block.floor + 1] / scaled,
                           (origin + speed * at - predictor[block.rod]) / scaled)

    with open(out, "w") as file:
        for k in range(int(number["steps"])):
            v1, _ = advance(block.mass * v, u, k * step + scaled)
            predictor = u + (1 - GAMMA) * step * v1
            middle = v + (1 - GAMMA) / GAMMA * (v1 - v)
            v, push = advance(block.mass * middle, predictor, (k + 1) * step)
            u = predictor + scaled * v
            print(f"{(k + 1) * step:.15g} {push.sum() / block.normal_force:.15g}", file=file)
    print(f"unknowns {block.count} steps {int(number['steps'])} seconds "
          f"{time.process_time() - started:.3f} models {stage.solved}")


if __name__ == "__main__":
    main()
