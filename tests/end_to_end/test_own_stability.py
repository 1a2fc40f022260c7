# SPDX-License-Identifier: GPL-2.0-or-later
"""`stability` with laws of one's own that remember: a formula of each built-in law has its numbers; two coupled states on a
rigid block have the critical stiffness and the growth rates of the whole linearised system (numpy), which SciPy's Radau led
there; pressure that friction asks for is that of each node."""
import json
import unittest

import h5py
import numpy
from scipy.integrate import solve_ivp

from drive_fixture import PROGRAM, SOURCE, Driven
from test_own_memory import ASINH, GIVEN

CREEP = "direct_effect: 0.02, evolution_effect: 0.06, mu_reference: 0.6, reference_velocity: 1e-5, slip_distance: 1e-4"
# Scales that rate and state has by itself: what it meets at V = V_0, and at the speed of sound, 1.
SCALES = f"mu_static: 0.6, mu_kinetic: {0.6 - 0.04 * numpy.log(1e5):.17g}, critical_velocity: 1e-5, "
SAME = {
    "ageing": (f"{{law: ageing, {GIVEN} healing: 0.03, healing_time: 10, slip_distance: 1e-4}}",
               f"{{law: formula, {GIVEN} healing: 0.03, healing_time: 10, slip_distance: 1e-4, "
               "formula: '(mu_K + (mu_S - mu_K) * max(0, 1 - v / v_c)) * (1 + beta * log(1 + theta / theta_0))', "
               "state: {theta: {rate: '1 - v * theta / D_c'}}}"),
    "slip-weakening": ("{law: slip-weakening, mu_static: 0.38, mu_kinetic: 0.1, healing_time: 100, slip_distance: 1e-3}",
                       "{law: formula, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 1e-5, healing_time: 100, "
                       "slip_distance: 1e-3, formula: 'mu_K + (mu_S - mu_K) * max(phi, 0)', "
                       "state: {phi: {rate: '(1 - phi) / healing_time - v * phi / D_c'}}}"),
    "rate-and-state": (f"{{law: rate-and-state, {CREEP}}}",
                       f"{{law: formula, {SCALES} {CREEP}, formula: '{ASINH}', "
                       "state: {psi: {rate: '(V_0 * exp(-psi) - v) / D_c'}}}"),
    "slip law": (f"{{law: rate-and-state, {CREEP}, evolution: slip}}",
                 f"{{law: formula, {SCALES} {CREEP}, formula: '{ASINH}', "
                 "state: {psi: {rate: '-(v / D_c) * (psi + log(max(v, 1e-300) / V_0))', start: 0}}}"),
}
# Two states that pull at each other, from where they are not in equilibrium.
A, V, B, D, PULL, START = 0.01, 1e-4, (0.011, 0.006), (0.01, 0.03), (20, 10), (0.3, -0.2)
TWO = (f"{{law: formula, velocity_max: 10, formula: '{A} * asinh(v / 2e-4 * exp((0.1 + {B[0]} * psi + {B[1]} * chi) / {A}))', "
       f"state: {{psi: {{rate: '(1e-4 * exp(-psi) - v) / {D[0]} + {PULL[0]} * v * (chi - psi)', start: {START[0]}}}, "
       f"chi: {{rate: '(1e-4 * exp(-chi) - v) / {D[1]} + {PULL[1]} * v * (psi - chi)', start: {START[1]}}}}}}}")
STIFF = """mesh: {{file: {source}/meshes/block.geo, set: {{length: 1.0, height: 0.5, nx: 6, nz: 3}}}}
material: {{young: 1000, poisson: 0.34, eta1: 1000, eta2: 1000}}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-4, height: 0.1}}
time: {{until: {{t: 1}}, accuracy: fine}}
friction: {friction}
"""
MASS, LOAD = 0.5, 0.003


def scale(psi):
    return 2e-4 * numpy.exp(-(0.1 + B[0] * psi[0] + B[1] * psi[1]) / A)


def rates(v, psi):
    return [(1e-4 * numpy.exp(-psi[k]) - v) / D[k] + PULL[k] * v * (psi[1 - k] - psi[k]) for k in (0, 1)]


def motion(t, y, stiffness):
    """x, u = asinh(v/v_s) and the states of a rigid block on a spring, from rest."""
    x, u, *psi = y
    v = scale(psi) * numpy.sinh(u)
    evolves = rates(v, psi)
    turns = sum(b * rate for b, rate in zip(B, evolves)) / A * numpy.tanh(u)
    return [v, (stiffness * (V * t - x) - LOAD * A * u) / (MASS * scale(psi) * numpy.cosh(u)) + turns, *evolves]


def slopes(v, psi):
    """mu and both rates by v and the states, by complex steps."""
    found, step = numpy.empty((3, 3)), 1e-30
    for column in range(3):
        at = numpy.array([v, *psi], dtype=complex)
        at[column] += 1j * step
        found[:, column] = numpy.imag([A * numpy.arcsinh(at[0] / scale(at[1:])), *rates(at[0], at[1:])]) / step
    return found


def rightmost(stiffness, v, psi, mass=MASS):
    """Of all rates of x, v and the states; of a body without mass v follows from the others."""
    by = slopes(v, psi)
    if mass > 0:
        matrix = numpy.zeros((4, 4))
        matrix[0, 1] = 1
        matrix[1] = [-stiffness / mass, *(-LOAD * by[0] / mass)]
        matrix[2:, 1:] = by[1:]
    else:
        speed = -numpy.array([stiffness / LOAD, *by[0, 1:]]) / by[0, 0]
        matrix = numpy.vstack([speed, numpy.outer(by[1:, 0], speed)])
        matrix[1:, 1:] += by[1:, 1:]
    found = numpy.linalg.eigvals(matrix)
    return found[found.real.argmax()]


def critical_stiffness():
    low, high, steady = 0, 1, (0, 0)     # psi = chi = ln(V_0/V) = 0
    while high - low > 1e-12 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if rightmost(middle, V, steady, 0).real > 0 else (low, middle)
    return high


class OwnStability(Driven):
    UNTIL = 0.006

    def stability(self, name, friction, scene, *settings, flags=()):
        folder = self.folder / name
        self.call("stability", f"friction={friction}", *settings, scene=scene, flags=("-q", "-o", folder, *flags))
        return json.loads((folder / "stability.json").read_text())

    def test_same_as_built_in(self):
        """To rounding, which the path amplifies: U, mu, rates, lengths and stiffnesses."""
        for name, laws in SAME.items():
            start = () if name == "ageing" else ("--from", "start")
            known, found = (self.stability(f"{name}-{k}", law, SOURCE / "validation/memory/paper.yaml", "mesh.set.nx=20", "mesh.set.nz=10",
                                           "load.pressure=0.002", flags=start) for k, law in enumerate(laws))
            self.assertEqual(len(found["points"]), len(known["points"]), name)
            for one, other in zip(known["points"], found["points"]):
                for key in one:
                    self.assertAlmostEqual(other[key] or 0, one[key] or 0, delta=1e-6 * abs(one[key] or 0) + 1e-9, msg=f"{name}: {key}")
            for key, value in known["results"].items():
                if isinstance(value, float):
                    self.assertAlmostEqual(found["results"][key], value, delta=1e-6 * abs(value), msg=f"{name}: {key}")
            self.assertGreater(len(known["points"]), 2)

    def test_two_states(self):
        """On both sides of the critical stiffness: a pair that grows, and one that decays."""
        critical = critical_stiffness()
        (self.folder / "two.yaml").write_text(STIFF.format(source=SOURCE, friction=TWO))
        for part, until in ((0.9, 7200), (1.6, 4500)):
            stiffness = part * critical
            drive = f"rod.stiffness={stiffness!r}", f"time.until.t={until}"
            report = self.stability(f"at-{part}", TWO, "two.yaml", *drive, flags=("--from", "end"))
            self.assertAlmostEqual(report["results"]["critical_stiffness"] / critical, 1, delta=1e-9)     # the contact is 1 long
            self.run_scene(f"run-{part}", *drive, scene="two.yaml")
            with h5py.File(self.folder / f"run-{part}/history.h5") as file:
                time, v, psi = file["series/time"][-1], file["series/max_slip_rate"][-1], file["interface/state"][-1, 3]
            led = solve_ivp(motion, (0, time), [0, 0, *START], args=(stiffness,), method="Radau", rtol=1e-10, atol=1e-12).y[:, -1]
            self.assertAlmostEqual(v / (scale(led[2:]) * numpy.sinh(led[1])), 1, delta=2e-3)
            self.assertLess(numpy.abs(psi - led[2:]).max(), 2e-3)
            rate, point = rightmost(stiffness, v, psi), report["points"][0]
            self.assertEqual(rate.real > 0, part < 1)
            self.assertAlmostEqual(point["rate_re"], rate.real, delta=2e-5 * abs(rate))
            self.assertAlmostEqual(point["rate_im"], abs(rate.imag), delta=2e-5 * abs(rate))


if __name__ == "__main__":
    unittest.main()
