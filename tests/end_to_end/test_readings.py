# SPDX-License-Identifier: GPL-2.0-or-later
"""What is read off velocity steps and slide-hold-slide: on a stiff block and a rigid machine the closed forms, within the
errors that the results name, and these small enough to mean something."""
import json
import math
import subprocess
import unittest

from drive_fixture import PROGRAM, SOURCE, Driven

# A thousand times as stiff as the paper's block, so that all of it slides alike.
STIFF = f"""mesh: {{file: {SOURCE}/meshes/block.geo, set: {{length: 1.0, height: 0.5, nx: 6, nz: 3}}}}
material: {{young: 1000, poisson: 0.34, eta1: 1000, eta2: 1000}}
load: {{pressure: 0.003}}
output: {{history: false}}
"""
V, A, B = 1e-4, 0.01, 0.015


def rate_state(distance, evolution="ageing"):
    return "friction={law: rate-and-state, direct_effect: 0.01, evolution_effect: 0.015, mu_reference: 0.3, reference_velocity: 1e-4, " \
        f"slip_distance: {distance}, evolution: {evolution}}}"


def driven(times, factors, repeat=""):
    return f"rod={{velocity: 1e-4, kind: bonded, height: 0.1, program: {{t: {times}, factor: {factors}{repeat}}}}}"


class Readings(Driven):
    UNTIL = 0.001

    def read(self, *settings, flags=("--overwrite",)):
        """results.program, and the lines that the run ends with."""
        (self.folder / "stiff.yaml").write_text(STIFF)
        words = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run([PROGRAM, "run", "stiff.yaml", "-o", "result", *words, *flags], capture_output=True, text=True,
                              cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((self.folder / "result/run.json").read_text())["results"].get("program"), done.stdout

    def assert_within(self, found, name, wanted, part):
        """By the error that is said, which is at most this part of it."""
        error = found[f"{name}_error"]
        self.assertLessEqual(abs(found[name] - wanted), error, name)
        self.assertLess(error, part * abs(wanted), name)

    def test_velocity_steps(self):
        D_c, ln = 0.05, math.log(10)
        program = driven([0, 1, 1000, 1000, 1500, 1500, 6500], [0, 1, 1, 10, 10, 1, 1])
        for evolution in ("slip", "ageing"):
            found, said = self.read(rate_state(D_c, evolution), program, "time.until={t: 6500}", "time.step_max=0.2")
            self.assertEqual((len(found["steps"]), found["holds"], found["healing_per_decade"]), (2, [], None))
            for step, ratio in zip(found["steps"], (10, 0.1)):
                self.assertIsNone(step["why_not"])
                self.assertAlmostEqual(step["velocity"] / step["velocity_before"], ratio)
                self.assert_within(step, "direct", A * math.log(ratio), 0.05)
                self.assert_within(step, "direct_per_ln", A, 0.05)
                self.assert_within(step, "change_per_ln", A - B, 0.06)
                # Ageing at constant slip rate: theta over its end is 1 + (ratio - 1) exp(-slip/D_c).
                left = math.log((ratio - 1) / (ratio ** math.exp(-1) - 1)) if evolution == "ageing" else 1
                self.assert_within(step, "slip_distance", D_c * left, 0.05)
            self.assertIn("velocity steps  2: direct effect 0.010", said)
            self.assertIn("change -0.0050 +- 0.00", said)
        self.assertAlmostEqual(found["steps"][0]["U"], 0.09995)

    def test_law_without_memory(self):
        """The whole change at once, and nothing evolves."""
        law = "friction={mu_static: 0.38, mu_kinetic: 0.3, critical_velocity: 3.4e-4}"
        found, said = self.read(law, driven([0, 1, 100, 100, 200], [0, 1, 1, 2, 2]), "time.until={t: 200}", "time.step_max=0.2")
        step, = found["steps"]
        self.assertAlmostEqual(step["mu_before"], 0.38 - 0.08 * V / 3.4e-4, delta=1e-6)
        wanted = -0.08 * V / 3.4e-4
        self.assert_within(step, "direct", wanted, 0.06)
        self.assertAlmostEqual(step["change_per_ln"], wanted / math.log(2), delta=1e-6)
        self.assertIsNone(step["slip_distance"])
        self.assertEqual(step["why_not"], "no change of mu with slip stands out")
        self.assertNotIn("slip distance", said)

    def test_slide_hold_slide(self):
        """b ln 10 a decade; each to 0.3 %, as the contact slides on by some 1e-7 while its stress relaxes."""
        times, factors, now = [0, 1, 50], [0, 1, 1], 50
        for hold in (1e3, 1e4, 1e5):
            times += [now, now + hold, now + hold, now + hold + 100]
            factors += [0, 0, 1, 1]
            now += hold + 100
        found, said = self.read(rate_state(1e-4), driven(times, factors), f"time.until={{t: {now}}}", "time.step_max=100")
        self.assertEqual([hold["duration"] for hold in found["holds"]], [1e3, 1e4, 1e5])
        for hold in found["holds"]:
            self.assertAlmostEqual(hold["mu_before"], 0.3, delta=1e-6)
            self.assertAlmostEqual(hold["healing"] / (B * math.log(hold["duration"])), 1, delta=3e-3)
            self.assertIsNone(hold["why_not"])
        self.assert_within(found, "healing_per_decade", B * math.log(10), 0.01)
        self.assertEqual(found["steps"], [])
        self.assertIn("holds           3: healing 0.0345 +- 0.000", said)

    def test_not_steady(self):
        """A step before the last has come to an end: no level, and words that say so."""
        found, said = self.read(rate_state(0.05), driven([0, 1, 100, 100, 120, 120], [0, 1, 1, 10, 10, 1]), "time.until={t: 200}",
                                "time.step_max=0.2")
        first, second = found["steps"]
        self.assertEqual(first["why_not"], "mu was not steady after")
        self.assertIsNotNone(first["direct"])
        self.assertIsNone(first["change_per_ln"])
        self.assertEqual(second["why_not"], "mu was not steady before")
        self.assertIsNone(second["direct"])
        self.assertIn("velocity steps  2: direct effect", said)

    def test_gone_on_with(self):
        """Cut off within the step, which then is read as a whole: the same but for the one step that ended there (5e-4)."""
        program = driven([0, 1, 100, 100], [0, 1, 1, 10])
        settings = (rate_state(5e-3, "slip"), program, "time.step_max=0.2", "output.history=true")
        whole, _ = self.read(*settings, "time.until={t: 200}")
        self.read(*settings, "time.until={t: 101}")
        cut, _ = self.read(*settings, "time.until={t: 200}", flags=("--resume",))
        for name, value in whole["steps"][0].items():
            if value is not None:
                self.assertAlmostEqual(cut["steps"][0][name], value, delta=1e-3 * abs(value) + 1e-7, msg=name)

    def test_programs_without_jumps(self):
        found, said = self.read(rate_state(1e-3), driven([0, 1, 10], [0, 1, 2]), "time.until={t: 10}", "time.step_max=0.2")
        self.assertIsNone(found)
        self.assertNotIn("velocity steps", said)


if __name__ == "__main__":
    unittest.main()
