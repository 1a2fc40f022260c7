# SPDX-License-Identifier: GPL-2.0-or-later
"""Laws of one's own that remember. A formula of each built-in law gives its history; two states do on a rigid block what
SciPy's Radau says, by formulas and by the plug-in that is shipped; runs that are cut off go on to the same bits; explicit
steps, laws of pressure and rate and state in space find what implicit steps in the plane do."""
import importlib.util
import subprocess
import sys
import time
import unittest

import h5py
import numpy
from scipy.integrate import solve_ivp

from drive_fixture import PROGRAM, SOURCE, Driven

_found = importlib.util.spec_from_file_location("kills", SOURCE / "validation/kills/kills.py")
kills = importlib.util.module_from_spec(_found)
_found.loader.exec_module(kills)

PLUGIN = PROGRAM.resolve().parent.parent / "tests/two_states.so"
GIVEN = "mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4, "
PARTS = "direct_effect: 0.01, evolution_effect: 0.02, mu_reference: 0.3, reference_velocity: 1e-4, slip_distance: 1e-4"
ASINH = "a * asinh(v / (2 * V_0) * exp((f_0 + b * psi) / a))"
# Scales that rate and state has by itself: what it meets at V and at the speed of sound.
SCALES = "mu_static: 0.3, mu_kinetic: 0.20789659628, critical_velocity: 1e-4, "
SAME = {
    "ageing": (f"{{law: ageing, {GIVEN} healing: 0.03, healing_time: 10, slip_distance: 1e-4, rest: 10}}",
               f"{{law: formula, {GIVEN} healing: 0.03, healing_time: 10, slip_distance: 1e-4, rest: 10, "
               "formula: '(mu_K + (mu_S - mu_K) * max(0, 1 - v / v_c)) * (1 + beta * log(1 + theta / theta_0))', "
               "state: {theta: {rate: '1 - v * theta / D_c', start: 0}}}"),
    "slip-weakening": ("{law: slip-weakening, mu_static: 0.38, mu_kinetic: 0.25, healing_time: 100, slip_distance: 1e-3}",
                       "{law: formula, mu_static: 0.38, mu_kinetic: 0.25, critical_velocity: 1e-5, healing_time: 100, "
                       "slip_distance: 1e-3, formula: 'mu_K + (mu_S - mu_K) * max(phi, 0)', "
                       "state: {phi: {rate: '(1 - phi) / healing_time - v * phi / D_c'}}}"),
    "rate-and-state": (f"{{law: rate-and-state, {PARTS}}}",
                       f"{{law: formula, {SCALES} {PARTS}, formula: '{ASINH}', "
                       "state: {psi: {rate: '(V_0 * exp(-psi) - v) / D_c'}}}"),
    "slip law": (f"{{law: rate-and-state, {PARTS}, evolution: slip}}",
                 f"{{law: formula, {SCALES} {PARTS}, formula: '{ASINH}', "
                 "state: {psi: {rate: '-(v / D_c) * (psi + log(max(v, 1e-300) / V_0))', start: 0}}}"),
}
TWO = ("{law: formula, velocity_max: 10, formula: '0.01 * asinh(v / 2e-4 * exp((0.3 + 0.011 * psi + 0.006 * chi) / 0.01))', "
       "state: {psi: {rate: '(1e-4 * exp(-psi) - v) / 0.01'}, chi: {rate: '(1e-4 * exp(-chi) - v) / 0.03'}}}")
STIFF = """mesh: {{file: {source}/meshes/block.geo, set: {{length: 1.0, height: 0.5, nx: 6, nz: 3}}}}
material: {{young: 1000, poisson: 0.34, eta1: 1000, eta2: 1000}}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-4, stiffness: 0.001, height: 0.1}}
time: {{until: {{U: 1.7}}}}
friction: {friction}
"""
MASS, LOAD, STIFFNESS, V = 0.5, 0.003, 0.001, 1e-4


def two_states(times):
    """The spring's force and the slip rate of a rigid block from rest, by Radau; in u = asinh(v/v_s) and the states."""
    a, V_0, states = 0.01, 1e-4, ((0.011, 0.01), (0.006, 0.03))

    def scale(psi):
        return 2 * V_0 * numpy.exp(-(0.3 + sum(b * p for (b, _), p in zip(states, psi))) / a)

    def motion(t, y):
        x, u, *psi = y
        v = scale(psi) * numpy.sinh(u)
        rates = [(V_0 * numpy.exp(-p) - v) / D for (_, D), p in zip(states, psi)]
        turns = sum(b * rate for (b, _), rate in zip(states, rates)) / a * numpy.tanh(u)
        return [v, (STIFFNESS * (V * t - x) - LOAD * a * u) / (MASS * scale(psi) * numpy.cosh(u)) + turns, *rates]
    done = solve_ivp(motion, (0, times[-1] + 1), [0, 0, 0, 0], t_eval=times, method="Radau", rtol=1e-10, atol=1e-12)
    x, u, psi, chi = done.y
    return STIFFNESS * (V * times - x), scale((psi, chi)) * numpy.sinh(u)


class OwnMemory(Driven):
    UNTIL = 0.006

    def history(self, name, *arrays):
        with h5py.File(self.folder / name / "history.h5") as file:
            return [file[array][()] for array in arrays]

    def test_same_as_built_in(self):
        """To rounding, over the first slidings: later ones amplify it."""
        for name, laws in SAME.items():
            found = []
            for k, law in enumerate(laws):
                self.run_scene(f"{name}-{k}", f"friction={law}", "time.until.U=0.004", "mesh.set.nx=16")
                found.append(self.history(f"{name}-{k}", "series/time", "series/mu", "interface/slip", "interface/state"))
            self.assertEqual(len(found[0][0]), len(found[1][0]), name)
            for a, b in zip(found[0][:3], found[1][:3]):
                self.assertLess(numpy.abs(a - b).max(), 1e-6 * numpy.abs(a).max(), name)
            if "rate" not in name and "law" not in name:   # these show theta, formulas psi
                self.assertLess(numpy.abs(found[0][3] - found[1][3]).max(), 1e-4 * numpy.abs(found[0][3]).max(), name)

    def test_frozen(self):
        """A state that stays is a number in mu(v): to rounding."""
        law = "(mu_K + (mu_S - mu_K) * max(0, 1 - v / v_c)) * (0.5 + 0.5 * sqrt(THETA / 50))"
        series = ("series/time", "series/mu", "interface/slip", "interface/status")
        self.run_scene("number", f"friction={{law: formula, {GIVEN} formula: '{law.replace('THETA', '50')}'}}", "time.until.U=0.004")
        self.run_scene("frozen", f"friction={{law: formula, {GIVEN} formula: '{law.replace('THETA', 'theta')}', "
                       "state: {theta: {rate: '0 * v', start: 50}}}", "time.until.U=0.004")
        wanted, found = self.history("number", *series), self.history("frozen", *series)
        self.assertEqual(len(wanted[0]), len(found[0]))
        for a, b in zip(wanted, found):
            self.assertLess(numpy.abs(a.astype(float) - b).max(), 1e-7 * numpy.abs(a).max())
        self.assertTrue((self.history("frozen", "interface/state")[0] == 50).all())

    def test_two_states(self):
        """A limit cycle at 0.65 of the critical stiffness, by formulas and by the plug-in."""
        (self.folder / "two.yaml").write_text(STIFF.format(source=SOURCE, friction=TWO))
        found = self.run_scene("formulas", "time.accuracy=fine", scene="two.yaml")
        inside = found["time"] > 12000
        T, force, fastest = found["time"][inside], found["rod_force"][inside], found["max_slip_rate"][inside]
        F, v = two_states(T)
        for name, ours, theirs, delta in (("F_max", force.max(), F.max(), 1e-4), ("F_min", force.min(), F.min(), 1e-4),
                                          ("v_max", fastest.max(), v.max(), 1e-4),
                                          ("time", T[force.argmax()], T[F.argmax()], 1e-4)):
            self.assertAlmostEqual(ours / theirs, 1, delta=delta, msg=name)
        with h5py.File(self.folder / "formulas/history.h5") as file:
            self.assertEqual(file["interface/state"].shape[1:], (7, 2))
            self.assertEqual(file.attrs["states"].split("\n"), ["psi", "chi"])
        law = f"friction={{law: plugin, file: {PLUGIN}, velocity_max: 10, parameters: [0.3, 1e-4, 0.01, 0.011, 0.01, 0.006, 0.03]}}"
        other = self.run_scene("plugin", law, "time.accuracy=fine", scene="two.yaml", flags=("--trust",))
        self.assertEqual(len(other["time"]), len(found["time"]))
        self.assertLess(numpy.abs(other["mu"] - found["mu"]).max(), 1e-6)

    def test_explicit_reference(self):
        """Two states that all act within the run: forces and states on the same mesh."""
        law = "friction=" + TWO.replace("/ 0.01'", "/ 1e-4'").replace("/ 0.03'", "/ 4e-4'")
        times, found = numpy.linspace(1, 28, 100), []
        for scheme in ("sdirk2", "explicit"):
            series = self.run_scene(f"two-{scheme}", law, f"time.scheme={scheme}", "time.until.U=0.003", "time.accuracy=fine")
            state, = self.history(f"two-{scheme}", "interface/state")
            found.append([numpy.interp(times, series["time"], series["mu"]),
                          *(numpy.interp(times, series["time"], state[:, i, k]) for i in (0, 4, 8) for k in (0, 1))])
        self.assertLess(numpy.abs(numpy.subtract(*found)[0]).max(), 2e-3 * found[0][0].max())
        self.assertGreater(numpy.abs(found[0][1] - found[0][2]).max(), 0.5)   # two states, not one twice
        self.assertLess(numpy.abs(numpy.subtract(*found)[1:]).max(), 0.02)

    def test_pressure(self):
        """mu(v, p): implicit steps find the peak of explicit ones, and not that of the mean pressure."""
        law = "friction={law: formula, formula: '(0.1 + 0.28 * max(0, 1 - v / 3.4e-4)) * (0.8 + 0.4 * exp(-PRESSURE / 0.003))'}"
        peaks = [self.run_scene("pressure", law.replace("PRESSURE", word), f"time.scheme={scheme}", flags=("--overwrite",))["mu"].max()
                 for word, scheme in (("p", "sdirk2"), ("p", "explicit"), ("0.003", "sdirk2"))]
        self.assertAlmostEqual(peaks[0] / peaks[1], 1, delta=1e-3)
        self.assertGreater(abs(peaks[0] / peaks[2] - 1), 5e-3)

    def test_by_contact_and_along(self):
        """Half the friction all along is half of mu; on its one contact curve the same formula is the same law."""
        law = SAME["ageing"][1]
        self.run_scene("all", f"friction={law}", "time.until.U=0.002")
        self.run_scene("half", f"friction={law[:-1]}, along: 0.5}}", "time.until.U=0.002", "load.pressure=0.006")
        whole, = self.history("all", "interface/state")
        self.assertGreater(whole.max(), 20)
        all_mu, half_mu = self.history("all", "series/mu")[0].max(), self.history("half", "series/mu")[0].max()
        self.assertAlmostEqual(half_mu / all_mu, 0.5, delta=0.05)
        self.run_scene("again", f"friction={law[:-1]}, contacts: [{{group: contact, along: 1}}]}}", "time.until.U=0.002")
        self.assertEqual(whole.tobytes(), self.history("again", "interface/state")[0].tobytes())

    def test_goes_on(self):
        words = ["--set", f"friction={TWO}", "rod.velocity=1e-5", "time.until.U=0.1", "-q"]

        def call(name, more):
            subprocess.run([PROGRAM, "run", "scene.yaml", *words, *more, "-o", name], cwd=self.folder, check=True)
        for _ in range(2):      # the second time from the cache, as the one that is cut
            call("whole", ["--overwrite"])
        process = subprocess.Popen([PROGRAM, "run", "scene.yaml", *words, "--checkpoint", "0.02s", "-o", "cut"], cwd=self.folder)
        while not (self.folder / "cut/checkpoint.bin").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.002)
        process.kill()
        process.communicate()
        call("cut", ["--resume"])
        self.assertEqual(kills.differences(self.folder / "whole", self.folder / "cut"), [])

    def test_space(self):
        """Rate and state on a block that is held across is that of plane strain; on one that is free, explicit steps agree."""
        law = f"friction={{law: rate-and-state, {PARTS}}}".replace("slip_distance: 1e-4", "slip_distance: 2e-4")
        size = "length: 1, height: 0.5, nx: 10, nz: 5"
        flat = [law, f"mesh={{file: {SOURCE}/meshes/block.geo, set: {{{size}}}}}", "material.plane=strain"]
        held = [law, f"mesh={{file: {SOURCE}/meshes/block3d.geo, set: {{{size}, breadth: 0.1, ny: 1}}}}",
                "load.supports=[{group: left, direction: y}, {group: right, direction: y}]"]
        drive = ["load.pressure=0.01", "rod.height=0.21", "rod.width=0.12", "time.until.U=0.008"]
        for name, settings in (("flat", flat), ("held", held)):
            self.run_scene(name, *settings, *drive)
        (t, mu), (time_held, mu_held) = (self.history(name, "series/time", "series/mu") for name in ("flat", "held"))
        self.assertGreater(mu.max() / mu[-1], 1.05)   # it has slid
        self.assertLess(numpy.abs(numpy.interp(t, time_held, mu_held) - mu).max(), 1e-5 * mu.max())
        free = [law, f"mesh={{file: {SOURCE}/meshes/block3d.geo, set: {{length: 0.5, breadth: 0.3, height: 0.3, nx: 4, ny: 3, nz: 3}}}}",
                "load.pressure=0.01", "time.until.U=0.004"]
        peaks = [self.run_scene(scheme, *free, f"time.scheme={scheme}")["mu"].max() for scheme in ("sdirk2", "explicit")]
        self.assertAlmostEqual(peaks[0] / peaks[1], 1, delta=2e-3)
        state, rate = self.history("sdirk2", "interface/state", "interface/slip_rate")
        self.assertGreater(numpy.abs(rate[:, :, 1]).max(), 1e-3 * numpy.abs(rate).max())   # it turns
        self.assertTrue(numpy.isfinite(state).all())

    def test_refusals(self):
        for words, setting in (
                ("the law `linear-weakening` does not read it", "friction.state={theta: {rate: 1 - v}}"),
                ("friction.state.theta: a state needs its `rate`", "friction={law: formula, formula: 0.3, state: {theta: {start: 1}}}"),
                ("`min` cannot be the name of a state", "friction={law: formula, formula: 0.3, state: {min: {rate: v}}}"),
                ("or a number of friction", "friction={law: formula, formula: 0.3 + D_c, slip_distance: 1, state: {D_c: {rate: -D_c}}}"),
                ("x, its rate: `/ 2`", "friction={law: formula, formula: 0.3 + x, state: {x: {rate: -x +/ 2}}}"),
                ("x, its start: `v` is no", "friction={law: formula, formula: 0.3 + x, state: {x: {rate: -x, start: v}}}"),
                ("the rate of x is inf", "friction={law: formula, formula: 0.3 + x, state: {x: {rate: 1/x, start: 0}}}"),
                ("unknown key `begin`; allowed: rate, start", "friction={law: formula, formula: 0.3, state: {x: {begin: 1}}}"),
                ("a map {rate: FORMULA, start: FORMULA}", "friction={law: formula, formula: 0.3, state: {x: 1}}"),
                ("the coefficient is -9.7: it must not be negative",
                 "friction={law: formula, formula: 0.3 - x, state: {x: {rate: 1 - v * x, start: 10}}}"),
                ("no state of steady slip is found", "friction={law: formula, formula: 0.3, state: {x: {rate: 1}}}")):
            self.assertIn(words, self.call("run", setting, status=2, flags=("-q", "-o", self.folder / "refused")))

    def test_formulas_that_end(self):
        """The root of a state that falls through 0, a thousandth of time later: said as that, not as a contact without solution."""
        said = self.call("run", "friction={law: formula, formula: 0.3 + 0 * x, state: {x: {rate: -1 - 0 * sqrt(x), start: 1e-3}}}",
                         status=1, flags=("-q", "-o", self.folder / "ends"))
        self.assertRegex(said, r"at t = 0.00(1|0999)\d* friction comes to states, or to a mu \(-?nan")


if __name__ == "__main__":
    unittest.main()
