# SPDX-License-Identifier: GPL-2.0-or-later
"""`amontons fit`: numbers that data were made with are found again, from results and from a curve; what the data do not know is
said; a fit that is gone on with; errors that name the place."""
import csv
import json
import math
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
# Runs of some 20 ms. The search begins at mu_static = 0.5, critical_velocity = 1e-3.
HEAD = f"""scene: {SOURCE}/validation/paper/fig1.yaml
set:
  mesh.set.nx: 10
  mesh.set.nz: 6
  time.until.U: = 3 * load.pressure
"""
START = "  friction.mu_static: 0.5\n  friction.critical_velocity: 1e-3\n"
TRUTH = "  friction.mu_static: 0.42\n  friction.critical_velocity: 4e-4\n"
SEARCH = """search:
  friction.mu_static: {linear: [0.3, 0.6]}
  friction.critical_velocity: {log: [1e-4, 2e-3]}
fit: {measured: measured.csv, designs: 16}
"""
PRESSURES = (0.002, 0.004, 0.006, 0.009)


class Fit(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-fit-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.place = {**os.environ, "AMONTONS_CACHE": str(self.folder / "cache")}

    def call(self, command, text, *words, status=0):
        study = self.folder / "study.yaml"
        study.write_text(text)
        done = subprocess.run([PROGRAM, command, study, *words], capture_output=True, text=True, timeout=300, env=self.place,
                              cwd=self.folder)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def table(self, path):
        with open(self.folder / path, newline="") as file:
            return list(csv.DictReader(file))

    def measure(self, rows, name="measured.csv"):
        with open(self.folder / name, "w", newline="") as file:
            csv.writer(file).writerows(rows)

    def measure_peaks(self, error=0.003):
        """mu_max of the true numbers, moved by the errors that stand there, at each pressure."""
        self.call("sweep", HEAD + TRUTH + f"vary: {{load.pressure: {list(PRESSURES)}}}\nrecord: [mu_max]\n", "-q", "-o", "truth")
        moved = (0.6, -0.9, 0.4, -0.3)
        rows = [[f"{pressure:g}", float(row["mu_max"]) + error * by, error]
                for pressure, row, by in zip(PRESSURES, self.table("truth/sweep.csv"), moved)]
        self.measure([["load.pressure", "mu_max", "mu_max_error"], *rows])

    def regions(self, said):
        return {key: (float(value), float(low), float(high)) for key, value, low, high in
                re.findall(r"^  (\S+): (\S+), 95 % from (\S+) to ([^,\s]+)", said, re.M)}

    def test_finds_what_data_were_made_with(self):
        self.measure_peaks()
        said = self.call("fit", HEAD + START + SEARCH, "-j", "2", "-o", "out").stdout
        found = self.regions(said)
        for key, true, wide in (("friction.mu_static", 0.42, 0.06), ("friction.critical_velocity", 4e-4, 3e-4)):
            value, low, high = found[key]
            self.assertTrue(low < value < high and low < true < high, said)
            self.assertLess(high - low, wide)
        rows = self.table("out/fit.csv")
        self.assertEqual([row["condition"] for row in rows], [f"load.pressure: {pressure:g}" for pressure in PRESSURES])
        misfit = 0
        for row in rows:
            off = (float(row["found"]) - float(row["measured"])) / math.hypot(float(row["error"]), float(row["own_error"]))
            self.assertAlmostEqual(float(row["off"]), off)
            misfit += off**2
        self.assertAlmostEqual(float(re.search(r"misfit (\S+)", said)[1]), misfit, delta=2e-3 * misfit)
        for name in ("measured", "profile_friction.mu_static", "region_friction.mu_static_friction.critical_velocity"):
            self.assertTrue((self.folder / f"out/figures/{name}.png").stat().st_size > 5000)
        again = self.call("fit", HEAD + START + SEARCH, "-j", "2", "-o", "out").stdout
        self.assertIn("\n0 points computed", again)
        self.assertEqual(self.regions(again), found)

    def test_what_the_data_do_not_know(self):
        """Inertia has next to no part in when the block first slides."""
        self.measure_peaks()
        other = SEARCH.replace("friction.mu_static: {linear: [0.3, 0.6]}", "material.density: {log: [0.8, 1.25]}")
        said = self.call("fit", HEAD + TRUTH + other, "-j", "2", "-o", "out").stdout
        self.assertIn("material.density: anything from 0.8 to 1.25 fits", said)
        self.assertRegex(said, r"the data know .*critical_velocity.* to \S+ %.* material.density.* (to a factor of|not at all)")

    def measure_curve(self, error=0.004, truth="material.young: [0.8]", more=""):
        """F_T/F_N over the way of the rod while it rises, with Young's modulus 0.8."""
        self.call("sweep", HEAD + f"  output.history: true\n{more}vary: {{{truth}}}\n", "-q", "-o", "truth")
        import h5py
        folder = next((self.folder / "truth/points").iterdir())
        with h5py.File(folder / "history.h5") as file:
            way, mu = file["series/rod_displacement"][:], file["series/mu"][:]
        head = ["series/rod_displacement", "series/mu", "series/mu_error"]
        self.measure([head, *[[way[k], mu[k] + by * error, error] for k, by in ((8, 0.5), (12, -0.75), (16, 0.25))]])

    def test_no_design_twice(self):
        """The chooser settles on the best it has: what is nearer than half a per cent of the range is not computed again. A
        search that has no more designs ends, and says so."""
        self.measure_curve(error=0.0004)
        study = HEAD + "  output.history: true\nsearch: {material.young: {log: [0.3, 3]}}\nfit: {measured: measured.csv, designs: 20}\n"
        self.assertNotIn("fewer designs", self.call("fit", study, "-q", "-j", "2", "-o", "out").stdout)
        places = [math.log10(float(row["material.young"])) for row in self.table("out/sweep.csv")]
        chosen = sorted(places[:20])
        self.assertGreater(min(b - a for a, b in zip(chosen, chosen[1:])), 0.0049)
        few = study.replace("material.young: {log: [0.3, 3]}", "mesh.set.nz: {whole: [4, 8]}")
        self.assertIn("fewer designs than asked for", self.call("fit", few, "-j", "2", "-o", "few").stdout)
        self.assertEqual(len(self.table("few/sweep.csv")), 5)

    def test_a_curve(self):
        self.measure_curve()
        study = HEAD + "  output.history: true\nsearch: {material.young: {log: [0.3, 3]}}\nfit: {measured: [measured.csv], designs: 8}\n"
        value, low, high = self.regions(self.call("fit", study, "-j", "2", "-o", "out").stdout)["material.young"]
        self.assertTrue(low < 0.8 < high and high - low < 0.2, (value, low, high))
        self.assertTrue((self.folder / "out/figures/fitted.png").is_file())
        plot = json.loads((self.folder / "out/figures/fitted.json").read_text())
        data, run = plot["series"]
        found = [min(zip(run["x"], run["y"]), key=lambda point: abs(point[0] - way))[1] for way in data["x"]]
        self.assertLess(max(abs(a - b) for a, b in zip(found, data["y"])), 5 * 0.004, "the run of the best design lies on the data")
        said = self.call("fit", study.replace("history: true", "history: false"), "-o", "none", status=2).stderr
        self.assertIn("output.history: true", said)

    def test_a_branch(self):
        """The modulus of one branch, from a curve that was made with it."""
        branches = "  material.relaxation: [{time: 1e5, shear: 0.1}, {time: 5, shear: 0.02}]\n"
        self.measure_curve(truth="material.relaxation.0.shear: [0.3]", more=branches)
        study = HEAD + "  output.history: true\n" + branches + \
            "search: {material.relaxation.0.shear: {log: [0.1, 1]}}\nfit: {measured: [measured.csv], designs: 8}\n"
        value, low, high = self.regions(self.call("fit", study, "-j", "2", "-o", "out").stdout)["material.relaxation.0.shear"]
        self.assertTrue(low < 0.3 < high and high - low < 0.2, (value, low, high))

    def test_slide_hold_slide(self):
        """Times held and peaks of mu give healing and slip distance of the ageing law, within their errors."""
        (self.folder / "held.yaml").write_text(f"""mesh: {{file: {SOURCE}/meshes/block.geo, set: {{length: 1.0, height: 0.5, nx: 6, nz: 3}}}}
material: {{young: 1000, poisson: 0.34, eta1: 1000, eta2: 1000}}
load: {{pressure: 0.003}}
friction: {{law: ageing, mu_static: 0.38, mu_kinetic: 0.38, critical_velocity: 1, healing: 0.03, healing_time: 10, slip_distance: 1e-3}}
rod: {{velocity: 1e-4, kind: bonded, height: 0.1, program: {{t: [0, 1, 100, 100, 130, 130, 230, 230, 530, 530, 630, 630, 3630, 3630, 3730], factor: [0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1]}}}}
time: {{until: {{t: 3730}}, step_max: 0.2}}
output: {{history: false}}
""")
        head = "scene: held.yaml\n"
        self.call("sweep", head + "vary: {friction.healing: [0.03]}\n", "-q", "-o", "truth")
        folder = next((self.folder / "truth/points").iterdir())
        holds = json.loads((folder / "run.json").read_text())["results"]["program"]["holds"]
        self.assertEqual([round(hold["duration"]) for hold in holds], [30, 300, 3000])
        rows = [[f"{hold['duration']:.9g}".replace(".", ","), f"{hold['mu_before'] + hold['healing'] + 0.0005 * by:.9g}".replace(".", ","), "0,0005"]
                for hold, by in zip(holds, (0.5, -0.8, 0.3))]
        table = "# slide-hold-slide\nHold time (s);friction coefficient (-);friction coefficient std\n" + "".join(";".join(row) + "\n" for row in rows)
        (self.folder / "measured.csv").write_text(table)
        study = head + "search: {friction.healing: {log: [0.01, 0.1]}, friction.slip_distance: {log: [2e-4, 5e-3]}}\n" \
            "fit: {measured: measured.csv, designs: 12}\n"
        regions = self.regions(self.call("fit", study, "-j", "2", "-o", "out").stdout)
        for key, true, part in (("friction.healing", 0.03, 0.3), ("friction.slip_distance", 1e-3, 0.8)):
            value, low, high = regions[key]
            self.assertTrue(low < true < high, (key, value, low, high))
            self.assertLess(high - low, 2 * part * true, key)

    def test_mistakes(self):
        good = [["load.pressure", "mu_max", "mu_max_error"], ["0.002", "0.4", "0.01"], ["0.004", "0.4", "0.01"]]
        text = HEAD + START + SEARCH
        for rows, study, wanted in (
                (good, text.replace("measured: measured.csv, ", ""), "fit: `measured` must be given"),
                (good, text.replace("measured: measured.csv", "measured: {a: 1}"), "measured: found .*a table's path"),
                (good, text.replace("measured: ", "sure: 94%, measured: "), "sure: found `94%`; allowed: 95%, 68%"),
                (good, text.replace("measured.csv", "none.csv"), "none.csv"),
                (good, text + "best: {designs: 3}\n", "best: not in a study with `fit`"),
                (good, text + "vary: {load.pressure: [1, 2]}\n", "vary: in a study with `fit` conditions are columns"),
                (good, text.replace(SEARCH, ""), "nothing to search"),
                (good, text[:text.index("fit:")], "what was measured"),
                ([["load.pressure", "mu_max"], *good[1:]], text, "measured.csv:2: 3 cells, the first row has 2"),
                ([row[:2] for row in good], text, "measured.csv:1:15: mu_max has no error: a column mu_max_error"),
                ([["load.presure", *good[0][1:]], *good[1:]], text, "measured.csv:1:1: load.presure is neither a key of the scene"),
                ([good[0], ["0.002", "high", "0.01"], good[1]], text, "measured.csv:2:7: mu_max: `high` is no number"),
                ([good[0], ["0.002", "0.4", "0"], good[1]], text, "measured.csv:2:11: mu_max_error: `0`: an error is above 0"),
                ([[*good[0], "mu_max"], *([*row, "1"] for row in good[1:])], text, "mu_max stands twice, in column 2 and in column 4"),
                ([["load.pressure", "load.pressure (kPa)", *good[0][1:]], ["1", "1", "0.4", "0.01"]], text, "load.pressure a second time"),
                (good, text.replace("measured: measured.csv", "measured: [measured.csv, ./measured.csv]"), "measured: found .* each table once"),
                (good[:2], text, "1 measurements cannot tell 2 keys"),
                ([["series/mu", "series/mu_error"], ["1", "1"]], text, "a curve has one column without an error"),
                ([*good, ["-1", "0.4", "0.01"]], text, r"measured.csv:4:1: .*load.pressure: found `-1`"),
                ([*good, ["much", "0.4", "0.01"]], text, r"measured.csv:4:1: .*load.pressure: found `much`"),
                ([*good, ["", "0.4", "0.01"]], text, "measured.csv:4:1: load.pressure: is empty"),
                ([*good, ["0.003, title: x", "0.4", "0.01"]], text, "measured.csv:4:1: load.pressure: `0.003, title: x` is no plain value")):
            self.measure(rows)
            said = self.call("fit", study, "-o", "out", status=2).stderr
            self.assertRegex(said, wanted)
        self.assertFalse((self.folder / "out").exists())
        self.measure(good)
        self.assertIn("is for `amontons fit`", self.call("optimise", text, "-o", "out", status=2).stderr)
        self.assertIn("designs are chosen by `amontons fit`", self.call("sweep", text, "-o", "out", status=2).stderr)


if __name__ == "__main__":
    unittest.main()
