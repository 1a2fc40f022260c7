# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction that remembers: a stiff block does what a rigid one does by SciPy's Radau, on both sides of the critical
stiffness; velocity steps and slide-hold-slide give the closed forms; a memory that does nothing changes no bit; a run
that is cut off and gone on with is the same; what does not go is refused."""
import importlib.util
import json
import subprocess
import sys
import time
import unittest

import h5py
import numpy

from drive_fixture import PROGRAM, SOURCE, Driven

sys.path.insert(0, str(SOURCE / "validation/memory"))
_found = importlib.util.spec_from_file_location("rigid_memory", SOURCE / "validation/memory/rigid_block.py")
rigid = importlib.util.module_from_spec(_found)
_found.loader.exec_module(rigid)
_found = importlib.util.spec_from_file_location("kills", SOURCE / "validation/kills/kills.py")
kills = importlib.util.module_from_spec(_found)
_found.loader.exec_module(kills)

# A thousand times as stiff as the paper's block, and a machine far softer: all of it slips at once.
STIFF = """mesh: {{file: {source}/meshes/block.geo, set: {{length: 1.0, height: 0.5, nx: 6, nz: 3}}}}
material: {{young: 1000, poisson: 0.34, eta1: 1000, eta2: 1000}}
friction: {friction}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-4, stiffness: 0.001, height: 0.1}}
time: {{until: {{U: {until}}}}}
"""
MASS, LOAD, STIFFNESS, V = 0.5, 0.003, 0.001, 1e-4
AGEING = "{law: ageing, mu_static: 0.38, mu_kinetic: 0.25, critical_velocity: 3.4e-4, healing: 0.03, healing_time: 10, " \
    "slip_distance: 1e-3, rest: 10}"
WEAKENING = "{law: slip-weakening, mu_static: 0.38, mu_kinetic: 0.25, healing_time: 2000, slip_distance: 0.01, rest: 1000}"
NUMBERS = {"direct_effect": 0.01, "evolution_effect": 0.015, "mu_reference": 0.3, "reference_velocity": 1e-4}


def rate_state(**more):
    return "{law: rate-and-state, " + ", ".join(f"{key}: {value}" for key, value in (NUMBERS | more).items()) + "}"


class Memory(Driven):
    UNTIL = 0.006

    def write(self, friction, until):
        (self.folder / "stiff.yaml").write_text(STIFF.format(source=SOURCE, friction=friction, until=until))
        return "stiff.yaml"

    def states(self, name):
        with h5py.File(self.folder / name / "history.h5") as file:
            return file["interface/state"][()]

    def test_rigid_block_that_sticks(self):
        """Three slips: when, from which force to which, how fast, and what is left of the memory."""
        for friction, law, start in (
                (AGEING, rigid.Ageing(0.38, 0.25, 3.4e-4, 0.03, 10, 1e-3), 10.0),
                (WEAKENING, rigid.SlipWeakening(0.38, 0.25, 2000, 0.01), 1 - numpy.exp(-0.5))):
            found = self.run_scene("sticks", "time.tolerance=5e-4", scene=self.write(friction, 4), flags=("--overwrite",))
            state = self.states("sticks")
            rapid = numpy.flatnonzero(found["kind"] == 2)
            wanted = rigid.slips(MASS, LOAD, STIFFNESS, V, law, start, min(len(rapid), 3))
            self.assertGreaterEqual(len(wanted), 2)
            for k, slip in zip(rapid, wanted):
                during = (found["time"] >= found["t_start"][k] - 10) & (found["time"] <= found["t_stop"][k])
                force, last = found["rod_force"][during], numpy.flatnonzero(during)[-1]
                most = slip["F_max"]
                self.assertAlmostEqual(force.max() / most, 1, delta=1e-4)
                self.assertAlmostEqual(force[-1] / most, slip["F_stop"] / most, delta=1e-4)
                self.assertAlmostEqual(found["max_slip_rate"][during].max() / slip["fastest"], 1, delta=1e-4)
                self.assertAlmostEqual(found["t_stop"][k] / slip["t_stop"], 1, delta=1e-4)
                numpy.testing.assert_allclose(law.mu(V, state[last]), law.mu(V, slip["state_slow"]), rtol=2e-4)

    def test_limit_cycle(self):
        """k = 0.67 k_c, the fourth cycle."""
        for evolution in ("ageing", "slip"):
            scene = self.write(rate_state(slip_distance=0.01, evolution=evolution), 1.7)
            found = self.run_scene(evolution, scene=scene)
            law = rigid.RateState(0.01, 0.015, 0.3, V, 0.01, slip_law=evolution == "slip")
            inside = found["time"] > 12500
            T = found["time"][inside]
            _, v, _, F = rigid.creep(MASS, LOAD, STIFFNESS, law, [(0, V)], 0.0, T)
            force, fastest = found["rod_force"][inside], found["max_slip_rate"][inside]
            for name, ours, theirs in (("F_max", force.max(), F.max()), ("F_min", force.min(), F.min()),
                                       ("v_max", fastest.max(), v.max()), ("time", T[force.argmax()], T[F.argmax()])):
                self.assertAlmostEqual(ours / theirs, 1, delta=3e-4 if name == "v_max" else 1e-4, msg=f"{evolution}: {name}")

    def test_below_the_critical_weakening(self):
        """k = 1.17 k_c: the way into steady slip by Radau, and its end by the Jacobian of Ruina's analysis with inertia."""
        a, b, D_c, k, N, m = 0.01, 0.015, 0.0175, STIFFNESS, LOAD, MASS
        found = self.run_scene("decays", "rod.kind=bonded", scene=self.write(rate_state(slip_distance=D_c), 3))
        t, force = found["time"], found["rod_force"]
        law = rigid.RateState(a, b, 0.3, V, D_c)
        F = rigid.creep(m, N, k, law, [(0, V)], 0.0, t[::10])[3][:len(t[::10])]
        for ours, theirs in ((force.max(), F.max()), (force[force.argmax():].min(), F[F.argmax():].min())):
            self.assertAlmostEqual(ours / theirs, 1, delta=1e-4)
        # x' = v, m v' = -k x - N (a v/V + b psi), psi' = -(v + V psi)/D_c
        rates = numpy.linalg.eigvals([[0, 1, 0], [-k / m, -N * a / V / m, -N * b / m], [0, -1 / D_c, -V / D_c]])
        rate = rates[rates.imag > 0][0]
        self.assertLess(rate.real, 0)
        tops = [i for i in range(1, len(force) - 1) if force[i - 1] < force[i] >= force[i + 1] and t[i] > 12000]
        periods = numpy.diff(t[tops])
        numpy.testing.assert_allclose(periods[-3:], 2 * numpy.pi / rate.imag, rtol=5e-3)
        decay = numpy.log((force[tops[-4]] - 0.3 * N) / (force[tops[-1]] - 0.3 * N)) / (t[tops[-1]] - t[tops[-4]])
        self.assertAlmostEqual(decay / -rate.real, 1, delta=0.02)

    def test_velocity_steps(self):
        """On a rigid machine: mu jumps by a ln 10 and goes on as psi does at constant slip, then back."""
        a, b, D_c = 0.01, 0.015, 5e-3
        for evolution in ("ageing", "slip"):
            scene = self.write(rate_state(slip_distance=D_c, evolution=evolution), 1)
            found = self.run_scene("steps", "rod.stiffness=none", "rod.kind=bonded", "time.until={t: 200}",
                                   "rod.program={t: [0, 1, 100, 100], factor: [0, 1, 1, 10]}", scene=scene, flags=("--overwrite",))
            t, mu = found["time"], found["mu"]
            before = mu[(t > 95) & (t < 100)]
            numpy.testing.assert_allclose(before, 0.3, atol=5e-5)
            after = t - 100
            late = after > 1      # the block has its new speed
            fades = numpy.exp(-10 * V * numpy.maximum(after, 0) / D_c)
            theta = 0.1 + 0.9 * fades if evolution == "ageing" else numpy.exp(numpy.log(0.1) * (1 - fades))
            wanted = 0.3 + a * numpy.log(10) + b * numpy.log(theta)
            numpy.testing.assert_allclose(mu[late], wanted[late], atol=5e-5)
            self.assertAlmostEqual(mu[-1], 0.3 - 0.005 * numpy.log(10), delta=5e-5)

    def test_slide_hold_slide(self):
        """The peak after a hold: b ln of the time that was held."""
        D_c = 1e-4
        peaks = []
        for hold in (100, 1000, 10000):
            scene = self.write(rate_state(slip_distance=D_c), 1)
            found = self.run_scene("hold", "rod.stiffness=none", "rod.kind=bonded", f"time.until={{t: {hold + 60}}}",
                                   f"rod.program={{t: [0, 1, 50, 50, {50 + hold}, {50 + hold}], factor: [0, 1, 1, 0, 0, 1]}}",
                                   scene=scene, flags=("--overwrite",))
            with h5py.File(self.folder / "hold/history.h5") as file:    # of the contact: the rod's has the blow
                local = file["pads/shear"][()] / file["pads/normal_force"][()]
            peaks.append(local[found["time"] > 50 + hold].max())
        numpy.testing.assert_allclose(numpy.diff(peaks), 0.015 * numpy.log(10), rtol=0.01)

    def test_explicit_reference(self):
        """Central differences with states by the midpoint rule on the same mesh: forces, states and peaks."""
        ageing = "friction={law: ageing, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4, healing: 0.03, " \
            "healing_time: 10, slip_distance: 1e-4}"
        creeping = "friction=" + rate_state(slip_distance=1e-4, evolution_effect=0.02)
        for name, law, until in (("ageing", ageing, 0.006), ("creeping", creeping, 0.003)):
            found, states, times = [], [], numpy.linspace(1, until / V, 150)
            for scheme in ("sdirk2", "explicit"):
                series = self.run_scene(f"{name}-{scheme}", law, f"time.scheme={scheme}", f"time.until.U={until}",
                                        "time.accuracy=fine")
                found.append(numpy.interp(times, series["time"], series["mu"]))
                state = self.states(f"{name}-{scheme}")
                states.append([numpy.interp(times, series["time"], numpy.log1p(state[:, i])) for i in (0, 3, 8)])
            self.assertAlmostEqual(found[0].max() / found[1].max(), 1, delta=2e-3)
            # Not each: a sliding sets out some 0.1 earlier or later.
            self.assertLess(numpy.abs(found[0] - found[1]).mean(), 2e-3 * found[0].max())
            self.assertLess(numpy.abs(numpy.subtract(*states)).mean(), 0.02)

    def test_memory_of_nothing(self):
        """beta = 0: to the bit."""
        self.run_scene("plain")
        self.run_scene("nothing", "friction={law: ageing, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4, "
                       "healing: 0, healing_time: 10, slip_distance: 1e-4}")
        with h5py.File(self.folder / "plain/history.h5") as plain, h5py.File(self.folder / "nothing/history.h5") as nothing:
            self.assertNotIn("state", plain["interface"])
            self.assertEqual(nothing["interface/state"].attrs["unit"], "time")
            for group in ("series", "interface", "events"):
                for name, item in plain[group].items():
                    self.assertEqual(item[()].tobytes(), nothing[group][name][()].tobytes(), name)

    def test_goes_on(self):
        words = ["--set", f"friction={AGEING}", "rod.velocity=1e-5", "time.until.U=0.1", "-q"]
        for _ in range(2):      # the second time from the cache, as the one that is cut
            self.call_run("whole", [*words, "--overwrite"])
        process = subprocess.Popen(self.words("cut", [*words, "--checkpoint", "0.02s"]), cwd=self.folder)
        while not (self.folder / "cut/checkpoint.bin").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.002)
        process.kill()
        process.communicate()
        self.call_run("cut", [*words, "--resume"])
        self.assertEqual(kills.differences(self.folder / "whole", self.folder / "cut"), [])

    def words(self, name, words):
        return [PROGRAM, "run", "scene.yaml", *words, "-o", name]

    def call_run(self, name, words):
        subprocess.run(self.words(name, words), cwd=self.folder, check=True)

    def test_refusals(self):
        ageing = f"friction={AGEING}"
        for command, words, settings in (
                ("run", "friction.slip_distance: missing", ["friction.law=ageing", "friction.healing=0.1", "friction.healing_time=1"]),
                ("run", "friction.healing: the law `linear-weakening` does not read it", ["friction.healing=0.1"]),
                ("run", "friction.rest: missing", ["friction={law: slip-weakening, mu_static: 0.3, mu_kinetic: 0.2, healing_time: 1, "
                                                   "slip_distance: 1}", "rod={kind: none}", "time.until={t: 1}"]),
                ("static", "what holds at rest goes by what the contacts remember", [ageing, "rod.displacement=1e-3"]),
                ("model1d", "`ageing` remembers", [ageing])):
            self.assertIn(words, self.call(command, *settings, status=2, flags=("-q",) if command != "model1d" else ("--theory",)))


if __name__ == "__main__":
    unittest.main()
