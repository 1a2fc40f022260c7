# SPDX-License-Identifier: GPL-2.0-or-later
"""A spring between drive and rod: a stiff block on it does what a rigid one does, by an integrator of its own; a stiff
spring is none; both schemes and statics agree; what cannot be is refused."""
import json
import unittest

import numpy

from drive_fixture import EXAMPLES, Driven, rigid_block

EXAMPLE = EXAMPLES / "stick_slip.yaml"


class Machine(Driven):
    UNTIL = 0.006

    def test_rigid_block(self):
        """Three slips: when, from which force to which, how fast."""
        found = self.run_scene("rigid", scene=EXAMPLE)
        wanted = rigid_block.cycles(0.5, 0.003, 0.001, 1e-4, (0.38, 0.25, 3.4e-4), 3, step=0.02)
        rapid = found["kind"] == 2
        self.assertEqual(rapid.sum(), 3)
        for start, stop, slip in zip(found["t_start"][rapid], found["t_stop"][rapid], wanted):
            during = (found["time"] >= start - 10) & (found["time"] <= stop)
            force = found["rod_force"][during]
            self.assertAlmostEqual(force.max() / slip["F_max"], 1, delta=1e-4)
            self.assertAlmostEqual(force[-1] / slip["F_stop"], 1, delta=1e-4)
            self.assertAlmostEqual(found["max_slip_rate"][during].max() / slip["fastest"], 1, delta=1e-4)
            self.assertAlmostEqual(stop / slip["t_stop"], 1, delta=1e-4)
        numpy.testing.assert_allclose(numpy.diff(found["t_stop"][rapid]), wanted[1]["t_stop"] - wanted[0]["t_stop"],
                                      rtol=1e-4)
        pull = 0.001 * (found["rod_displacement"] - found["rod_way"])
        numpy.testing.assert_allclose(found["rod_force"], pull, atol=1e-9 * pull.max())

    def test_stiff_spring_is_none(self):
        plain, stiff = self.run_scene("plain"), self.run_scene("stiff", "rod.stiffness=1e8")
        U = numpy.linspace(1e-4, 0.003, 60)
        mu = [numpy.interp(U, found["rod_displacement"], found["mu"]) for found in (plain, stiff)]
        numpy.testing.assert_allclose(*mu, atol=2e-4 * mu[0].max())
        self.assertAlmostEqual(stiff["mu"].max() / plain["mu"].max(), 1, delta=2e-3)
        numpy.testing.assert_allclose(stiff["rod_way"], stiff["rod_displacement"], atol=1e-10)
        self.assertNotIn("rod_way", plain)
        scene = json.loads((self.folder / "plain/run.json").read_text())["scene"]
        self.assertNotIn("stiffness", scene["rod"])

    def test_crown_settles_without_the_rod(self):
        """Its middle touches first, and contact is settled in steps so short that beside the block the spring is rounding."""
        shape = {"length": 0.38745, "height": 0.11549, "crown": 7.987e-05, "nx": 32, "nz": 10}
        found = self.run_scene("crown", *(f"mesh.set.{key}={value}" for key, value in shape.items()),
                               "material.poisson=0.36874", "material.eta2=0.81841", "material.plane=strain", "friction.mu_static=0.55427",
                               "friction.mu_kinetic=0.11386", "friction.critical_velocity=6.915e-6", "load.pressure=0.00016259",
                               "rod.velocity=4.7991e-7", "rod.height=0.048876", "rod.width=0.011163", "rod.stiffness=0.046951",
                               "time.until.U=1e-6")
        self.assertAlmostEqual(found["normal_force"][-1] / (0.00016259 * 0.38745), 1, delta=1e-3)

    def test_explicit_steps(self):
        found, times = [], numpy.linspace(5, 60, 60)
        for scheme in ("sdirk2", "explicit"):
            series = self.run_scene(scheme, "rod.stiffness=0.5", f"time.scheme={scheme}")
            found.append([numpy.interp(times, series["time"], series[name]) for name in ("mu", "rod_way")])
        numpy.testing.assert_allclose(*found, atol=0.012 * found[0][0].max())

    def test_statics(self):
        """A block that sticks and is glued to the rod is a spring: F = a + b R, and F = k (d - R)."""
        force, stuck = {}, ("friction.mu_static=1000", "rod.kind=bonded")
        for name, settings in (("low", ["rod.displacement=0"]), ("high", ["rod.displacement=1e-3"]),
                               ("soft", ["rod.displacement=1e-3", "rod.stiffness=0.4"])):
            self.call("static", *stuck, *settings, flags=("-q", "-o", self.folder / f"static-{name}"))
            results = json.loads((self.folder / f"static-{name}/static.json").read_text())["results"]
            force[name] = results["rod_force"]
        slope = (force["high"] - force["low"]) / 1e-3
        way = (0.4 * 1e-3 - force["low"]) / (0.4 + slope)
        self.assertAlmostEqual(force["soft"] / (0.4 * (1e-3 - way)), 1, delta=1e-9)
        self.assertAlmostEqual(results["rod_way"] / way, 1, delta=1e-9)

    def test_softer_runs_away_sooner(self):
        """Growth rates follow: l_c is shorter on a softer machine, and a stiff one gives that of none."""
        lengths = []
        for settings in ([], ["rod.stiffness=1e9"], ["rod.stiffness=0.05"]):
            self.call("stability", *settings, flags=("-q", "--from", "start", "--overwrite", "-o", self.folder / "path"))
            lengths.append(json.loads((self.folder / "path/stability.json").read_text())["results"]["l_c_over_L"])
        self.assertAlmostEqual(lengths[1] / lengths[0], 1, delta=1e-3)
        self.assertLess(lengths[2], 0.95 * lengths[0])

    def test_refusals(self):
        for words, settings in (
                ("rod.stiffness: the scene has no rod", ["rod={kind: none, stiffness: 1}", "time.until={t: 1}"]),
                ("rod.stiffness: found `0`; allowed: none, or a number > 0", ["rod.stiffness=0"])):
            self.assertIn(words, self.call("run", *settings, status=2, flags=("-q",)))
        self.assertIn("rod.stiffness: the 1D model's rod goes where it is driven",
                      self.call("model1d", "rod.stiffness=1", status=2, flags=["--theory"]))


if __name__ == "__main__":
    unittest.main()
