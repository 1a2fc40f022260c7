# SPDX-License-Identifier: GPL-2.0-or-later
"""Output by window: the steps written are those of a run that writes all, the run itself is the same to the last bit, also
where it was killed within the window; explicit steps; windows that the run does not come to."""
import importlib.util
import json
import re
import signal
import subprocess
import time

import numpy

from drive_fixture import EXAMPLES, PROGRAM, SOURCE, Driven

EXAMPLE = EXAMPLES / "rupture.yaml"
ALL = ("output.window={}", "output.fields=none")
ROWS = "output.window.history=true"

_found = importlib.util.spec_from_file_location("kills", SOURCE / "validation/kills/kills.py")
kills = importlib.util.module_from_spec(_found)
_found.loader.exec_module(kills)


class Windows(Driven):
    UNTIL = 0.03

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.all = cls.run_scene(cls(), "all", *ALL, scene=EXAMPLE)

    def written(self, name):
        times = re.findall(r'timestep="([^"]+)"', (self.folder / name / "fields.pvd").read_text())
        self.assertEqual(len(list((self.folder / name / "fields").iterdir())), len(times))
        return numpy.array(times[::2], dtype=float)

    @staticmethod
    def due(times, every):
        """The first, then one in each interval."""
        return numpy.append(True, numpy.diff(numpy.floor(times / every)) > 0)

    def sliding(self, series, number):
        """Rows from the step before the rapid event to its last one."""
        rapid = numpy.flatnonzero(series["kind"] == 2)[number - 1]
        first, last = (numpy.flatnonzero(series["time"] == series[key][rapid])[0] for key in ("t_start", "t_stop"))
        return slice(first - 1, last + 1)

    def window(self, number):
        """That of a sliding, from the step before it to its end: where it is differs from processor to processor."""
        U = self.all["rod_displacement"][self.sliding(self.all, number)]
        return f"from_U: {float(U[0]) - 1e-10!r}, to_U: {float(U[-1]) + 1e-10!r}"

    def test_slow_motion(self):
        """As the example: every step of the second sliding, in a run that is what it is without them."""
        found = self.run_scene("sliding", f"output.window={{{self.window(2)}}}", scene=EXAMPLE)
        for key, values in self.all.items():
            numpy.testing.assert_array_equal(found[key], values, err_msg=key)
        times = self.all["time"][self.sliding(self.all, 2)]
        numpy.testing.assert_allclose(self.written("sliding"), times, rtol=1e-12)
        self.assertIn(len(times), range(20, 100))
        reports = [json.loads((self.folder / name / "run.json").read_text()) for name in ("all", "sliding")]
        for key in ("results", "errors"):
            self.assertEqual(reports[0][key], reports[1][key])
        self.assertEqual(*(report["steps"]["accepted"] for report in reports))

    def test_to_the_end(self):
        """From the end of the first sliding of three; the history as well, and pictures of it."""
        first = self.sliding(self.all, 1).stop - 1
        window = (f"output.window={{from_t: {float(self.all['time'][first]) - 1e-6!r}}}", ROWS, "output.fields={every_t: 5}", "output.figures=[force]")
        found = self.run_scene("last", *window, scene=EXAMPLE)
        for key in ("time", "mu", "certified", "energy_error", "step_size"):
            numpy.testing.assert_array_equal(found[key], self.all[key][first:], err_msg=key)
        numpy.testing.assert_array_equal(found["t_stop"], self.all["t_stop"])
        numpy.testing.assert_allclose(self.written("last"), found["time"][self.due(found["time"], 5)], rtol=1e-12)

    def test_from_to(self):
        found = self.run_scene("part", "output.window={from_U: 1e-3, to_U: 2e-3}", ROWS,
                               "output.fields={every_t: 2}", scene=EXAMPLE)
        U = self.all["rod_displacement"]
        inside = (U >= 1e-3) & (U <= 2e-3)
        numpy.testing.assert_array_equal(found["time"], self.all["time"][inside])
        numpy.testing.assert_allclose(self.written("part"), found["time"][self.due(found["time"], 2)], rtol=1e-12)

    def test_killed(self):
        """Within the window, whose files so far are whole, and gone on with."""
        for name, window, more in (("sliding", self.window(2), []),
                                   ("end", "from_U: 6.1e-3", ["output.fields={every_t: 1}"])):
            words = [PROGRAM, "run", EXAMPLE, "--set", f"output.window={{{window}}}", "--set", ROWS,
                     *(word for setting in more for word in ("--set", setting)), "-q", "-o"]
            subprocess.run([*words, self.folder / f"{name}-whole"], check=True)
            cut = self.folder / f"{name}-cut"
            process = subprocess.Popen([*words, cut, "--checkpoint", "0.002s"])
            while not ((cut / "fields/bulk_000005.vtu").exists() and (cut / "checkpoint.bin").exists()):
                self.assertIsNone(process.poll())
                time.sleep(0.001)
            process.kill()
            process.wait()
            self.assertEqual(process.returncode, -signal.SIGKILL)
            for path in (cut / "fields").glob("*.vt?"):
                self.assertTrue(path.read_text(errors="replace").rstrip().endswith("</VTKFile>"), path)
            subprocess.run([*words, cut, "--resume"], check=True)
            self.assertEqual(kills.differences(self.folder / f"{name}-whole", cut), [])

    def test_gone_on_with(self):
        """The run ended before the window's sliding, and is given a later end."""
        window = (f"output.window={{{self.window(2)}}}", "output.fields={every_step: true}")
        self.run_scene("early", *window, "time.until={U: 4.5e-3}", scene=EXAMPLE)
        self.assertFalse((self.folder / "early/fields.pvd").exists())
        found = self.run_scene("early", *window, scene=EXAMPLE, flags=["--resume"])
        numpy.testing.assert_allclose(self.written("early"), found["time"][self.sliding(found, 2)], rtol=1e-12)

    def test_explicit(self):
        scheme = ("time.scheme=explicit", "time.until={t: 80}")
        whole = self.run_scene("explicit-all", *ALL, *scheme, scene=EXAMPLE)
        found = self.run_scene("explicit", "output.window={from_t: 20, to_t: 60}", ROWS, "output.fields=none", *scheme, scene=EXAMPLE)
        inside = (whole["time"] >= 20) & (whole["time"] <= 60)
        numpy.testing.assert_array_equal(found["time"], whole["time"][inside])

    def test_beyond_the_run(self):
        """Said, and no reason to fail, though pictures were asked for."""
        found = self.run_scene("far", "output.window={from_U: 1}", ROWS, "output.figures=[force, field]", scene=EXAMPLE)
        self.assertEqual(len(found["time"]), 0)
        warnings = json.loads((self.folder / "far/run.json").read_text())["warnings"]
        self.assertEqual(len(warnings), 1)
        self.assertIn("nothing written in output.window: ", warnings[0])
        self.assertIn("does not come to it", warnings[0])
        self.assertFalse((self.folder / "far/fields.pvd").exists())
