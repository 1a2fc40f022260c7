# SPDX-License-Identifier: GPL-2.0-or-later
"""Rod and load by programs, ends by events: a stiff block does what a rigid one does, by an integrator of its own; U
and the load are those of the tables; both schemes agree; a run that is cut and gone on with is the same; refusals."""
import re
import unittest

import numpy

from drive_fixture import EXAMPLES, Driven, rigid_block

EXAMPLE = EXAMPLES / "program.yaml"
BY_WAY = ("load.program={U: [0, 0.001, 0.002], factor: [1, 1, 1.2]}", "rod.program={U: [0, 0.001, 0.004], factor: [1, 1, 3]}")
BY_TIME = ("load.program={t: [0, 5, 5, 10], factor: [1, 1, 1.1, 1], repeat: true}",
           "rod.program={t: [0, 10, 20, 20, 30], factor: [1, 1, 0, 0.5, 1], repeat: true}", "time.until={t: 50}")


def drive(t):
    """U of the example: V = 1e-4 until 12000, at rest until 14000, then falling to -V within 2000."""
    back = min(max(t - 14000, 0), 2000)
    return 1e-4 * (min(t, 12000) - back**2 / 4000 - max(t - 16000, 0))


def load(t):
    return 0.003 * (1 + 0.3 * min(max((t - 15000) / 5000, 0), 1))


class Programs(Driven):
    UNTIL = 0.005

    def test_rigid_block(self):
        """Forwards with one load, back with another one; the second sliding ends the run."""
        found = self.run_scene("rigid", scene=EXAMPLE)
        begins, ends = rigid_block.march(0.5, load, 0.001, drive, (0.38, 0.25, 3.4e-4), 36000, step=0.02, resting=5.0)
        rapid = found["kind"] == 2
        self.assertEqual((rapid.sum(), len(ends)), (2, 2))
        self.assertLess(found["time"][-1], ends[-1][0] + 100)
        numpy.testing.assert_allclose(found["t_stop"][rapid], [t for t, _ in ends], rtol=1e-4)
        stops = numpy.searchsorted(found["time"], found["t_stop"][rapid])
        numpy.testing.assert_allclose(found["rod_force"][stops], [force for _, force in ends], rtol=1e-4)
        numpy.testing.assert_allclose([found["rod_force"].max(), found["rod_force"].min()],
                                      [force for _, force in begins], rtol=5e-4)
        times = found["time"]
        numpy.testing.assert_allclose(found["rod_displacement"], [drive(t) for t in times], atol=1e-12)
        quiet = numpy.abs(times[:, None] - found["t_stop"][rapid]).min(axis=1) > 100
        numpy.testing.assert_allclose(found["normal_force"][quiet], [load(t) for t in times[quiet]], rtol=1e-4)

    def test_schemes_agree(self):
        for name, program in (("way", BY_WAY), ("time", BY_TIME)):
            implicit, explicit = (self.run_scene(f"{name}-{scheme}", *program, f"time.scheme={scheme}")
                                  for scheme in ("sdirk2", "explicit"))
            times = numpy.linspace(1, implicit["time"][-1], 200)
            times = times[numpy.abs((times + 0.5) % 5 - 0.5) > 0.5]   # but for the jumps
            for key in ("rod_force", "normal_force", "rod_displacement"):
                both = [numpy.interp(times, series["time"], series[key]) for series in (implicit, explicit)]
                numpy.testing.assert_allclose(*both, atol=0.012 * numpy.abs(both[1]).max(), err_msg=f"{name}: {key}")
            if name == "time":   # steps end at the points, or an eighth of the longest that resolves waves beside them
                points = numpy.arange(5, 50, 5)
                apart = numpy.abs(implicit["time"][:, None] - points).min(axis=0)
                self.assertLess(apart.max(), 0.125 * 0.2 * (1 - 0.34**2) ** 0.5)
            if name == "way":   # time of the way: V, then growing with U to 3 V, level again
                wanted = 10 + 15 * numpy.log(3) + 0.001 / 3e-4
                self.assertAlmostEqual(implicit["time"][-1], wanted, delta=1e-3 * wanted)

    def test_gone_on_with(self):
        """Ended earlier and gone on with: the same, but for the steps to that end."""
        whole = self.run_scene("whole", *BY_TIME)
        self.run_scene("cut", *BY_TIME[:2], "time.until={t: 23}")
        cut = self.run_scene("cut", *BY_TIME, flags=["--resume"])
        for key in ("mu", "rod_displacement"):
            both = [numpy.interp(whole["time"], series["time"], series[key]) for series in (whole, cut)]
            numpy.testing.assert_allclose(*both, atol=5e-3 * both[0].max())
        self.assertAlmostEqual(cut["time"][-1], 50, delta=0.1)

    def test_mu_below(self):
        found = self.run_scene("below", "time.until={U: 0.05, mu_below: 0.2}")
        self.assertTrue(found["mu"][-1] < 0.2 <= found["mu"][-2])
        self.assertLess(found["rod_displacement"][-1], 0.03)
        self.assertGreater(found["mu"].max(), 0.25)

    def test_fields_on_the_way_back(self):
        """A file each time the rod has moved so far, there and back."""
        self.run_scene("back", "rod={velocity: 1e-4, kind: bonded, program: {t: [0, 10, 10, 20], factor: [1, 1, -1, -1]}}",
                       "time.until={t: 20}", "output.fields={every_U: 2.5e-4}")
        times = re.findall(r'timestep="([^"]+)"', (self.folder / "back/fields.pvd").read_text())
        reached = [int(1e-4 * min(t, 20 - t) / 2.5e-4) for t in sorted(set(map(float, times)))]
        self.assertEqual(reached, [0, 1, 2, 3, 2, 1, 0])

    def test_refusals(self):
        for words, *settings in (
                ("rod.program.factor: 2 numbers for 3 points", "rod.program={t: [0, 1, 2], factor: [1, 2]}"),
                ("rod.program.t: begins at 1", "rod.program={t: [1, 2], factor: [1, 2]}"),
                ("rod.program.t: 1 comes after 2", "rod.program={t: [0, 2, 1], factor: [1, 2, 1]}"),
                ("rod.program.t: 1 stands three times", "rod.program={t: [0, 1, 1, 1], factor: [1, 2, 1, 1]}"),
                ("rod.program.U: give either t or U", "rod.program={t: [0, 1], U: [0, 1], factor: [1, 2]}"),
                ("rod.program.factor: by U it must be above 0", "rod.program={U: [0, 1], factor: [1, 0]}"),
                ("load.program.factor: begins with 2", "load.program={t: [0, 1], factor: [2, 2]}"),
                ("load.program.U: rod.program holds", "load.program={U: [0, 1], factor: [1, 2]}",
                 "rod.program={t: [0, 1], factor: [1, 0]}"),
                ("time.until.U: rod.program never takes the rod so far", "rod.program={t: [0, 1], factor: [1, 0]}"),
                ("reduction.use, as set: `always`", "load.program={t: [0, 1], factor: [1, 2]}", "reduction.use=always"),
                ("time.until.slidings: 1.5 is no whole number", "time.until={U: 1, slidings: 1.5}")):
            with self.subTest(words):
                self.assertIn(words, self.call("run", *settings, status=2, flags=("-q",)))
        self.assertIn("time.until: the 1D model ends by", self.call("model1d", "time.until.slidings=2", status=2,
                                                                     flags=["-o", self.folder / "none"]))
        for command in ("stability", "model1d"):
            self.assertIn("rod.program: the", self.call(command, BY_WAY[1], status=2, flags=["-o", self.folder / "none"]))


if __name__ == "__main__":
    unittest.main()
