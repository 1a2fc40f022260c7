# SPDX-License-Identifier: GPL-2.0-or-later
"""A law of one's own that remembers goes wherever built-in laws go. The same law, rate and state, is given by its name and by
formulas, and each command must say the same of both: sweeps over its numbers with what is read off velocity steps, error
bars, searches and fits, shares of a table, windows, films, pages,
Python and C."""
import csv
import json
import os
import re
import subprocess
import sys
import unittest

import h5py
import numpy

from drive_fixture import PROGRAM, SOURCE, Driven
from sanitizer_fixture import preload

PARTS = "direct_effect: 0.01, evolution_effect: 0.02, mu_reference: 0.3, reference_velocity: 1e-5, slip_distance: 2e-4"
# Scales that rate and state has by itself: what it meets at V and at the speed of sound.
BUILT_IN = f"{{law: rate-and-state, {PARTS}}}"
OWN = (f"{{law: formula, {PARTS}, formula: 'a * asinh(v / (2 * V_0) * exp((f_0 + b * psi) / a))', "
       "state: {psi: {rate: '(V_0 * exp(-psi) - v) / D_c'}}}")
SCENE = f"""mesh: {{file: {SOURCE}/meshes/block.geo, set: {{nx: 10, nz: 5}}}}
material: {{poisson: 0.34}}
friction: FRICTION
load: {{pressure: 0.01}}
rod: {{velocity: 1e-5}}
time: {{until: {{U: 0.02}}}}
output: {{figures: []}}
"""
# A block far stiffer than its machine: velocity steps are those of the contacts.
STEPS = f"""mesh: {{file: {SOURCE}/meshes/block.geo, set: {{length: 1.0, height: 0.5, nx: 6, nz: 3}}}}
material: {{young: 1000, poisson: 0.34, eta1: 1000, eta2: 1000}}
friction: FRICTION
load: {{pressure: 0.003}}
rod: {{velocity: 1e-4, kind: bonded, height: 0.1, program: {{t: [0, 1, 1000, 1000, 1500], factor: [0, 1, 1, 10, 10]}}}}
time: {{until: {{t: 1500}}, step_max: 0.2}}
output: {{history: false}}
"""


class OwnEverywhere(Driven):
    UNTIL = 0.006

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name, law in (("built", BUILT_IN), ("own", OWN)):
            (cls.folder / f"{name}.yaml").write_text(SCENE.replace("FRICTION", law))
            law = law.replace("2e-4", "0.05").replace("1e-5", "1e-4").replace("evolution_effect: 0.02", "evolution_effect: 0.015")
            (cls.folder / f"{name}-steps.yaml").write_text(STEPS.replace("FRICTION", law))

    def amontons(self, *words):
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, cwd=self.folder,
                              env={**os.environ, "AMONTONS_CACHE": str(self.folder / "cache")})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def study(self, command, name, text, *words):
        """A study of the scene `name`; the rows of its table."""
        (self.folder / f"{name}-study.yaml").write_text(f"scene: {name}.yaml\n{text}")
        out = f"{name}-{command}-{len(words)}"
        self.amontons(command, f"{name}-study.yaml", "-q", "-o", out, *words)
        return self.rows(f"{out}/sweep.csv")

    def rows(self, path):
        with open(self.folder / path, newline="") as file:
            return list(csv.DictReader(file))

    def test_sweep_over_numbers_of_the_formulas(self):
        """b and D_c of the formulas vary; direct effect, change and slip distance are columns, and the closed forms."""
        text = ("vary: {friction.evolution_effect: [0.012, 0.015], friction.slip_distance: [0.04, 0.05]}\n"
                "record: [results.program.direct_per_ln, results.program.change_per_ln, results.program.slip_distance]\n")
        rows = self.study("sweep", "own-steps", text)
        self.assertEqual(len(rows), 4)
        left = numpy.log(9 / (10 ** numpy.exp(-1) - 1))   # the ageing law, from V to 10 V
        for row in rows:
            b, D_c = float(row["friction.evolution_effect"]), float(row["friction.slip_distance"])
            self.assertAlmostEqual(float(row["results.program.direct_per_ln"]), 0.01, delta=3e-4)
            self.assertAlmostEqual(float(row["results.program.change_per_ln"]), 0.01 - b, delta=2e-4)
            self.assertAlmostEqual(float(row["results.program.slip_distance"]) / (D_c * left), 1, delta=0.05)
            self.assertLess(float(row["results.program.slip_distance_error"]), 0.06 * D_c * left)
        built = self.study("sweep", "built-steps", text)
        name = "results.program.slip_distance"
        for one, other in zip(rows, built):
            self.assertAlmostEqual(float(one[name]) / float(other[name]), 1, delta=1e-3)

    def test_table_of_velocity_steps(self):
        """The law of docs/examples/measured_law.yaml: velocity steps read its table, a and D_c back, as the cookbook says."""
        program = "{t: [0, 1, 1000, 1000, 1500], factor: [0, 1, 1, 10, 10]}"
        self.amontons("run", SOURCE / "docs/examples/measured_law.yaml", "-q", "-o", "table-steps", "--set", "material={young: 1000, poisson: 0.34, "
                      "eta1: 1000, eta2: 1000}", "mesh.set.nx=6", "mesh.set.nz=3", "friction.slip_distance=0.015", "time={until: {t: 1500}, step_max: 0.2}",
                      "output={figures: []}", f"rod={{velocity: 1e-4, kind: bonded, height: 0.1, program: {program}}}")
        found = json.loads((self.folder / "table-steps/run.json").read_text())["results"]["program"]
        step, = found["steps"]
        for name, v in (("mu_before", 1e-4), ("mu_after", 1e-3)):
            wanted = numpy.interp(numpy.log(v), (-16, -13, -10, -7, -4), (0.46, 0.42, 0.34, 0.22, 0.16))
            self.assertAlmostEqual(step[name], wanted, delta=3e-4, msg=name)
        self.assertAlmostEqual(step["direct_per_ln"], 0.015, delta=3e-4)
        self.assertAlmostEqual(step["slip_distance"] / 0.015, 1.9, delta=0.1)

    def test_examples_of_the_page(self):
        """Each law of docs/scenes.md that remembers runs."""
        page = (SOURCE / "docs/scenes.md").read_text()
        part = page[page.index("### Friction that remembers"):page.index("### Friction by contact, and along it")]
        blocks = [re.sub("^    ", "", block, flags=re.M) for block in re.findall(r"\n\n((?:    .*\n)+)", part)]
        laws = [law for block in blocks for law in (block.splitlines() if block.count("friction:") > 1 else [block])]
        self.assertEqual(len(laws), 4)
        for law in laws:
            text = re.sub(r"friction: FRICTION\n", lambda _: law + "\n", SCENE).replace("U: 0.02", "U: 0.002")
            (self.folder / "page.yaml").write_text(text)
            self.amontons("run", "page.yaml", "-q", "--overwrite", "-o", "page")

    def test_rate_of_pressure(self):
        """The scene of docs/scenes.md: chi in the place of theta, whose rate has dp/dt (Linker and Dieterich). That rate, integrated
        along the slip rate and pressure of a node, gives its friction, while the load is raised by a third within D_c/75."""
        law = re.search(r"`alpha` = 0.2[^`]*?\n\n((?:    .*\n)+)", (SOURCE / "docs/scenes.md").read_text())[1]
        text = "\n".join(line[4:] for line in law.splitlines())
        load = "load: {pressure: 0.003, program: {t: [0, 100, 102], factor: [1, 1, 1.3]}}"
        scene = re.sub(r"friction: FRICTION\n", lambda _: text + "\n", STEPS).replace("load: {pressure: 0.003}", load)
        scene = re.sub(r"factor: \[0, 1, 1, 10, 10\]", "factor: [0, 1, 1, 1, 1]", scene)
        (self.folder / "pressed.yaml").write_text(scene.replace("t: 1500}", "t: 200}").replace("history: false", "figures: []"))
        self.amontons("run", "pressed.yaml", "-q", "-o", "pressed")
        with h5py.File(self.folder / "pressed/history.h5") as file:
            t, chi = file["series/time"][()], file["interface/state"][()]
            p, tau, v = (file[f"interface/{name}"][()].astype(float) for name in ("pressure", "shear", "slip_rate"))
        a, b, D_c, V_0, alpha, first = 0.01, 0.015, 0.015, 1e-4, 0.2, numpy.searchsorted(t, 2)
        for i in (0, 3, 6):
            psi = chi[first, i] - alpha / b * numpy.log(p[first, i] / 0.003)
            for k in range(first, len(t) - 1):
                h, slip_rate = (t[k + 1] - t[k]) / 10, (v[k, i] + v[k + 1, i]) / 2
                for _ in range(10):   # of the midpoint rule
                    pressed = alpha / b * numpy.log(p[k + 1, i] / p[k, i]) / (10 * h)
                    middle = psi + h / 2 * ((V_0 * numpy.exp(-psi) - slip_rate) / D_c - pressed)
                    psi += h * ((V_0 * numpy.exp(-middle) - slip_rate) / D_c - pressed)
                mu = a * numpy.arcsinh(v[k + 1, i] / (2 * V_0) * numpy.exp((0.3 + b * psi) / a))
                self.assertAlmostEqual(mu, tau[k + 1, i] / p[k + 1, i], delta=1e-4, msg=(i, t[k + 1]))
        self.assertGreater(p.max() / p.min(), 2)

    def test_bars(self):
        """A bar is met, and holds what the built-in law's says."""
        found = []
        for name in ("built", "own"):
            self.amontons("run", f"{name}.yaml", "--to", "10%", "-q", "-o", f"{name}-bar")
            results = json.loads((self.folder / f"{name}-bar/run.json").read_text())["results"]
            self.assertLess(results["mu_M_error"], 0.1 * results["mu_M"])
            found.append((results["mu_M"], results["mu_M_error"]))
        self.assertLess(abs(found[0][0] - found[1][0]), found[0][1] + found[1][1])

    def test_window(self):
        """What is kept of a part of the run has the bits of the run in full."""
        self.amontons("run", "own.yaml", "-q", "-o", "full")
        self.amontons("run", "own.yaml", "-q", "-o", "window", "--set", "output.window={from_U: 0.01, to_U: 0.012, history: true}")
        with h5py.File(self.folder / "full/history.h5") as full, h5py.File(self.folder / "window/history.h5") as window:
            t, state = window["series/time"][()], window["interface/state"][()]
            first = numpy.searchsorted(full["series/time"][()], t[0])
            self.assertLess(len(t), len(full["series/time"]))
            self.assertEqual(full["interface/state"][first:first + len(t)].tobytes(), state.tobytes())
            self.assertEqual(window.attrs["states"], "psi")

    def test_film_and_page(self):
        self.amontons("run", "own.yaml", "-q", "-o", "filmed")
        self.amontons("film", "filmed", "-o", "film.gif", "--of", "psi", "--seconds", "1", "--size", "640x360", "--quiet")
        self.assertGreater((self.folder / "film.gif").stat().st_size, 20000)
        self.amontons("report", "filmed", "-o", "page.html")
        self.assertIn("What friction remembers at each place", (self.folder / "page.html").read_text())

    def test_python_and_c(self):
        """The module steps it by the C interface: its state is the history's, and a step gone back to comes to the same bits."""
        script = """
import sys
import numpy, amontons
simulation = amontons.Simulation("own.yaml", {"time.until": {"U": 0.004}}, "stepped")
states = [simulation.state.copy()]
for step in simulation:
    states.append(simulation.state.copy())
    if len(states) == 20:
        saved = simulation.save()
end = simulation.state.copy()
simulation.finish()
history = amontons.open_result("stepped").history
assert numpy.array(states, "f4").tobytes() == history.state.tobytes()
assert history.numbers["states"] == "psi"
again = amontons.Simulation("own.yaml", {"time.until": {"U": 0.004}})
again.restore(saved)
for step in again:
    pass
assert again.state.tobytes() == end.tobytes()
print(len(states))
"""
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd=self.folder,
                              env={**os.environ, "PYTHONPATH": str(PROGRAM.resolve().parent.parent / "python")} | preload(PROGRAM.parent / "libamontons.so"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(int(done.stdout), 20)

    def test_search_and_fit(self):
        """Over D_c and b: a design that is better than the first, and b found again from mu_max at two loads."""
        text = ("set: {time.until.U: 0.008, mesh.set.nx: 6, mesh.set.nz: 3}\nrank: {by: mu_max}\n"
                "search: {friction.evolution_effect: {linear: [0.015, 0.03]}}\nbest: {designs: 5, seed: 1}\n")
        rows = self.study("optimise", "own", text)
        mu = [float(row["mu_max"]) for row in rows]
        self.assertGreaterEqual(len(mu), 5)
        self.assertGreater(max(mu) - min(mu), 0.003)
        text = "set: {time.until.U: 0.008, mesh.set.nx: 6, mesh.set.nz: 3}\n"
        rows = self.study("sweep", "own", text + "vary: {load.pressure: [0.006, 0.01]}\nrecord: [mu_max]\n")
        with open(self.folder / "measured.csv", "w") as file:
            file.write("load.pressure,mu_max,mu_max_error\n" + "".join(f"{row['load.pressure']},{row['mu_max']},0.001\n" for row in rows))
        self.study("fit", "own", text + "search: {friction.evolution_effect: {linear: [0.015, 0.03]}}\nfit: {measured: measured.csv, designs: 6}\n")
        said = (self.folder / "own-fit-0/answer.txt").read_text() if (self.folder / "own-fit-0/answer.txt").exists() else ""
        self.assertIn("friction.evolution_effect", said)

    def test_table_in_shares(self):
        """`keep: table`, by two processes, has the rows that one has."""
        text = "vary: {friction.slip_distance: [1e-4, 2e-4, 4e-4]}\nset: {time.until.U: 0.006, mesh.set.nx: 6, mesh.set.nz: 3}\nrecord: [mu_max]\nkeep: table\n"
        one, two = self.study("sweep", "own", text), self.study("sweep", "own", text, "-j", "2")
        self.assertEqual([row["mu_max"] for row in one], [row["mu_max"] for row in two])
        self.assertEqual(len({row["mu_max"] for row in one}), 3)

    def test_negative_coefficient(self):
        """A formula that falls below 0 where a run leads ends it, with the place, the speed and the states; by explicit steps, too."""
        falls = "friction={law: formula, formula: '0.3 - 0.003 * s', state: {s: {rate: 1, start: START}}}"
        pressed = "friction={law: formula, formula: '0.4 - 90 * p'}"
        program = "load.program={t: [0, 100], factor: [1, 2]}"
        for settings, when in (((falls.replace("START", "0"), "time.until.U=0.02"), 100),
                               ((falls.replace("START", "96"), "time.scheme=explicit"), 4), ((pressed, program), 48)):
            said = self.call("run", *settings, status=1, flags=("-q", "--overwrite", "-o", "negative"))
            found = re.search(r"at U = (\S+), t = (\S+) friction has come to a coefficient of (-\S+), at contact node \d+, x = \S+: "
                              r"velocity \S+, pressure (\d\.?[\de-]+)(?:, state (\S+)\.)?", said)
            self.assertIsNotNone(found, said)
            U, t, mu, pressure = map(float, found.groups()[:4])
            self.assertAlmostEqual(U, 1e-4 * t, delta=1e-5 * U)
            self.assertAlmostEqual(t, when, delta=0.1 * when)
            wanted = 0.3 - 0.003 * float(found[5]) if found[5] else 0.4 - 90 * pressure
            self.assertAlmostEqual(mu, wanted, delta=1e-5)
        # The quasi-static path of `stability` ends, too.
        fast = "friction={law: formula, formula: '0.3 - 0.1 * s', state: {s: {rate: 30 - v / 1e-4, start: 0}}}"
        said = self.call("stability", fast, status=1, flags=("-q", "--from", "start"))
        self.assertRegex(said, "on the quasi-static path.*friction has come to a coefficient of -")
        kept = "friction={law: formula, formula: 'max(0, 0.3 - 0.003 * s)', state: {s: {rate: 1, start: 0}}}"
        self.call("run", kept, "time.until.U=0.012", flags=("-q", "--overwrite", "-o", "negative"))


if __name__ == "__main__":
    unittest.main()
