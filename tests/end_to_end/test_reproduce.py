# SPDX-License-Identifier: GPL-2.0-or-later
"""What `./amontons reproduce` computes by itself: the 1D theory in closed form, and the parts of a peak's load."""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
PAPER = SOURCE / "validation" / "paper"
FEW = 9
sys.path[:0] = [str(PAPER), str(PAPER.parent)]
sys.dont_write_bytecode = True

import bars        # noqa: E402
import fronts      # noqa: E402
import interface   # noqa: E402
import paper_report   # noqa: E402
import refinement   # noqa: E402
import windows     # noqa: E402
import theory      # noqa: E402


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-reproduce-"))
        self.addCleanup(shutil.rmtree, self.folder)


class Theory(InFolder):
    def test_is_the_programs(self):
        """The critical length of the supplement's formula against `amontons model1d`, which finds roots of omega_0."""
        for scene, material, length, pressure in [("fig1", theory.A, 1, 0.003), ("fig1", theory.A, 1, 0.05),
                                                  ("set-b", theory.B, 0.04, 5.75e-5), ("set-b", theory.B, 0.04, 1e-3)]:
            with self.subTest(f"{scene} {pressure}"):
                done = subprocess.run([PROGRAM, "model1d", PAPER / f"{scene}.yaml", "--theory", "-o", self.folder / "out",
                                       "--overwrite", "--set", f"load.pressure={pressure}"], capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                text = (self.folder / "out/model1d.json").read_text()
                found = json.loads(text)["theory"]
                self.assertAlmostEqual(material.critical_part(length, pressure) / found["l_c_over_L"], 1, places=6)
                self.assertAlmostEqual(material.mu(length, pressure) / found["mu_M"], 1, places=6)

    def test_inverse(self):
        for part in (0.01, 0.3, 1, 20):
            P = theory.B.pressure(0.04, part)
            self.assertAlmostEqual(theory.B.critical_part(0.04, P) / part, 1, places=9)


class Answers(unittest.TestCase):
    """Figure 2 is drawn from bars.md."""

    def test_table_is_read(self):
        rows = bars.read_table("## Title\n\n| P | mu_M | mu_hold | warned of |\n|---|---|---|---|\n| 1e-05 | 0.3 ± 0.02 | none |  |\n"
                               "| 2.5e-4 | 0.2, not known | 0.25 ± 0.01 | error bar not met |\n")
        self.assertEqual([row["P"] for row in rows], [1e-5, 2.5e-4])
        self.assertEqual([row["mu_M"] for row in rows], [(0.3, 0.02), (0.2, None)])
        self.assertEqual([row["mu_hold"] for row in rows], ["none", (0.25, 0.01)])

    def test_page_is_read(self):
        """Every row of the page that is published has its mu_M, and a sweep's own rows read alike."""
        for title, text in bars.sections(PAPER / "bars.md").items():
            rows = bars.read_table(text)
            self.assertGreater(len(rows), 20, title)
            self.assertTrue(all(row["mu_M"] == "none" or row["mu_M"][0] > 0 for row in rows), title)
        read = bars.read_rows([{"mu_M": "0.3", "mu_M_error": "0.02", "mu_hold": "", "mu_hold_error": "", "warnings": ""},
                               {"mu_M": "0.2", "mu_M_error": "0.01", "mu_hold": "0.2", "mu_hold_error": "",
                                "warnings": "error bar not met: the mesh's part of it is not known"}])
        self.assertEqual([(row["mu_M"], row["mu_hold"]) for row in read], [((0.3, 0.02), "none"), ((0.2, None), (0.2, None))])

    def test_beside_the_line(self):
        row = {"mesh.set.length": 1, "load.pressure": 0.05, "mu_M": (theory.A.mu(1, 0.05) / 1.25, 0.01)}
        self.assertIn("| 25 |", paper_report.line_against([row], theory.A))
        pairs = [SimpleNamespace(length=1, P=P, fine=SimpleNamespace(mu=mu)) for P, mu in ((0.05, 0.2), (0.1, 0.3))]
        rows = [{"mesh.set.length": 1, "load.pressure": P, "mu_M": mu} for P, mu in ((0.05, (0.201, 0.002)), (0.1, (0.31, 0.004)))]
        self.assertIn("Of 2 points the windows' mean (below) is within the bar at 1, at most 2.5 bars off",
                      paper_report.windows_against(rows, pairs))


class Parts(InFolder):
    def write(self, shear):
        x = np.linspace(0, 2, 5)
        weight = np.array([0.25, 0.5, 0.5, 0.5, 0.25])
        rows = 6
        pressure = np.tile([1.0, 2, 3, 4, 5], (rows, 1))
        mu = np.array([0.3, 0.1, 0.2, 0.25, 0.3, 0.1])
        with h5py.File(self.folder / "history.h5", "w") as file:
            for name, value in [("series/rod_displacement", np.arange(rows)), ("series/mu", mu),
                                ("series/front", [2, 0, 0.5, 1, 1, 2]), ("nodes/x", x), ("nodes/weight", weight),
                                ("interface/pressure", pressure), ("interface/shear", shear),
                                ("events/kind", [2, 1, 2]), ("events/U_start", [0, 2.5, 4]), ("events/U_stop", [0.5, 2.6, 5]),
                                ("events/reach", [2, 1, 2])]:
                file[name] = value
            file.attrs.update(length=2, normal_force=6, pressure=3, mu_static=0.4, mu_kinetic=0.1)
        return weight, pressure

    def test_sum_is_the_distance_from_the_line(self):
        random = np.random.default_rng(3)
        weight, pressure = self.write(random.uniform(0, 2, (6, 5)))
        history = interface.History(self.folder)
        self.assertEqual(history.cycles(), [(1, 4)])
        parts = interface.peak_made_of(history)
        mu = (history.shear[4] * weight).sum() / (pressure[4] * weight).sum()
        total = sum(parts[key] for key in ("by_behind", "by_left", "by_carried", "by_load"))
        self.assertAlmostEqual(total, mu - (0.1 + 0.3 * 0.5), places=12)
        self.assertAlmostEqual(parts["f"], (0.25 * 1 + 0.5 * 2 + 0.5 * 3) / 6, places=12)

    def test_on_the_line(self):
        """mu_S behind, mu_K ahead: nothing is left over but the load not being uniform."""
        shear = np.tile(np.array([1.0, 2, 3, 4, 5]) * [0.4, 0.4, 0.4, 0.1, 0.1], (6, 1))
        self.write(shear)
        parts = interface.peak_made_of(interface.History(self.folder))
        for key in ("by_behind", "by_left", "by_carried"):
            self.assertAlmostEqual(parts[key], 0, places=12)
        self.assertAlmostEqual(parts["behind"], 0.4, places=12)
        self.assertAlmostEqual(parts["ahead"], 0.1, places=12)


class Fronts(unittest.TestCase):
    RUN = {"model": {"length": 2.0, "wave_speeds": {"longitudinal": 1.0, "shear": 0.6, "rayleigh": 0.5}}, "results": {"events": []}}

    def event(self, times, kind="bounded rapid"):
        return {"kind": kind, "front_times": times, "front_start": 1.0, "reach": 1.6, "U_start": 1, "U_stop": 2, "peak_slip_rate": 6,
                "front_speed": 0.4}

    def test_way_to_the_leading_edge(self):
        """Sets out at station 5 in both directions, with speed 4, then 0.5, and stops at station 15 of 20."""
        times = [None] * 21
        for k in range(5):
            times[k] = 1 + 0.1 * (5 - k)
        for k in range(5, 11):
            times[k] = 1 + (k - 5) * 0.1 / 4
        for k in range(11, 16):
            times[k] = times[10] + (k - 10) * 0.1 / 0.5
        front = fronts.Front(self.event(times), self.RUN)
        self.assertAlmostEqual(front.x[0], 0.25)
        self.assertAlmostEqual(front.x[-1], 0.75)
        np.testing.assert_allclose(front.speeds, [4] * 5 + [0.5] * 5)
        self.assertAlmostEqual(front.mean_speed(0.5, 0.75), 0.5)
        self.assertAlmostEqual(front.mean_speed(0.25, 0.75), 1 / (0.5 / 4 + 0.5 / 0.5))
        self.assertTrue(np.isnan(front.mean_speed(0.76, 0.9)))
        row = fronts.catalogue_row(front, 2, 3)
        self.assertEqual(row[0], "bounded rapid")
        np.testing.assert_allclose(row[3:], [0.5, 0.8, 3, 2, 0.25, 4, 1, 1])

    def test_nowhere(self):
        front = fronts.Front(self.event([None] * 21), self.RUN)
        self.assertEqual(len(front.speeds), 0)
        self.assertTrue(np.isnan(fronts.catalogue_row(front, 1, 1)[-1]))

    def test_last_cycle(self):
        kinds = ["leading rapid", "bounded rapid", "leading rapid", "quasi-static", "bounded rapid", "bounded rapid", "leading rapid",
                 "bounded rapid"]
        run = {**self.RUN, "results": {"events": [self.event([k] * 21, kind) for k, kind in enumerate(kinds)]}}
        self.assertEqual([f.event["front_times"][0] for f in fronts.rapid_of_last_cycle(run)], [4, 5, 6])


class Windows(unittest.TestCase):
    @staticmethod
    def row(P, mu, length=1.0, l_c=0.5, low=None, period=1):
        return {"mesh.set.length": length, "load.pressure": P, "mu_M": mu, "mu_max": 9.0, "low": mu if low is None else low, "high": mu,
                "period": period, "l_c": l_c}

    def test_groups_and_means(self):
        """Pressures close together make a window; a trend in ln P is no scatter; branches reach below."""
        rows = [self.row(P, 0.3 - 0.1 * np.log(P)) for P in (0.9, 1.0, 1 / 0.9, 2.0)]
        rows += [self.row(1.0, 0.2, 4.0), self.row(1.1, 0.24, 4.0, low=0.18, period=2)]
        found = windows.windows(rows[::-1])
        self.assertEqual([(w.length, len(w.rows)) for w in found], [(1.0, 3), (1.0, 1), (4.0, 2)])
        self.assertAlmostEqual(found[0].P, 1)
        self.assertAlmostEqual(found[0].mu, 0.3)
        self.assertAlmostEqual(found[0].scatter, 0)
        self.assertAlmostEqual(found[2].mu, 0.22)
        self.assertAlmostEqual(found[2].low, 0.18)

    def test_one_mesh_has_one_column(self):
        """A quick report has no numbers of the finer mesh that it did not compute, and says so."""
        window = windows.Window([self.row(1, 0.3)])
        window.centre.update(status="done", folder=Path("nowhere"))
        pair = refinement.Pair(window, window, 20)
        self.assertEqual(paper_report.even_table([pair], finer=True).count("| 0.3 |"), 2)
        one = paper_report.even_table([pair], finer=False)
        self.assertEqual(one.count("| 0.3 |"), 1)
        for word in ("twice", "difference"):
            self.assertNotIn(word, one)
        parts = {key: "" for key in "critical_a critical_b line words profile readings adiabatic catalogue velocity".split()}
        parts.update(cells=20, depends="(left out: quick)", even_a=one, even_b=one)
        with tempfile.TemporaryDirectory() as folder:
            place = SimpleNamespace(folder=Path(folder), figures=Path(folder), quick=True, jobs=1, pictures=[], seconds={})
            with redirect_stdout(StringIO()):
                paper_report.write(place, parts)
            text = (place.folder / "REPORT.md").read_text()
        self.assertIn("Not computed: any finer mesh", text)
        for word in ("twice as many", "difference, %", "80 by 80", "of 2N"):
            self.assertNotIn(word, text)

    def test_reasons(self):
        window = lambda *pairs, l_c=0.5: windows.Window([self.row(P, mu, l_c=l_c) for P, mu in pairs])  # noqa: E731
        fine = window((1, 0.3))
        self.assertEqual(windows.reason(window((1, 0.302)), fine, 40), "")
        self.assertIn("2.0 cells", windows.reason(window((1, 0.32), l_c=0.05), fine, 40))
        self.assertIn("let go", windows.reason(window((1, 0.32), l_c=0.97), fine, 40))
        self.assertIn("scatter", windows.reason(window((1, 0.32)), fine, 40))


class Refinement(InFolder):
    @staticmethod
    def window(P, mu, l_c, scatter=0.0, runs=5):
        """Runs about P whose values go up and down by `scatter`, relative."""
        factors = np.exp(np.linspace(-0.12, 0.12, runs)) if runs > 1 else [1.0]
        signs = np.resize([1, -2, 1], runs) if runs == 3 else np.zeros(runs)
        return windows.Window([Windows.row(P * f, mu * (1 + s * scatter), l_c=l_c) for f, s in zip(factors, signs)])

    def test_settled(self):
        """Agreement counts where l_c has 8 cells, of 40 or as long as the end ones of 80 graded; and ends 2 short of L, or at mu_S."""
        pair = lambda mu, l_c, cells=40, grade=1: refinement.Pair(  # noqa: E731
            self.window(1, 0.3, l_c), self.window(1, mu, l_c), cells, grade)
        self.assertTrue(pair(0.302, 0.21).settled(0.38))
        self.assertFalse(pair(0.302, 0.19).settled(0.38))
        self.assertFalse(pair(0.304, 0.21).settled(0.38))
        self.assertTrue(pair(0.302, float("nan")).settled(0.38))
        self.assertFalse(pair(0.302, 0.96).settled(0.38))
        self.assertTrue(pair(0.302, 0.96).settled(0.305))
        self.assertTrue(pair(0.302, 0.96, 80, 3).settled(0.38))
        self.assertTrue(pair(0.302, 0.05, 80, 3).settled(0.38))
        self.assertFalse(pair(0.302, 0.046, 80, 3).settled(0.38))

    def test_error_of_a_mean(self):
        window = self.window(1, 0.3, 0.5, scatter=0.01, runs=3)
        pair = refinement.Pair(window, window, 40)
        self.assertAlmostEqual(pair.scatter(), 100 * 0.01 * np.sqrt(2))
        self.assertAlmostEqual(pair.error(), pair.scatter() / np.sqrt(3))

    def test_doubles_where_it_must(self):
        """Four points: one needs nothing, one no more than 80 and 160 cells, two 320, one of them a single run there."""
        truth = {1.0: (0.5, 0), 2.0: (0.1, 0), 4.0: (0.03, 0), 8.0: (0.03, 0.02)}
        mu = lambda P, cells: 0.3 * (1 + 0.05 * (40 / cells) ** 2 / truth[P][0] / 10)  # noqa: E731
        even = [refinement.Pair(self.window(P, mu(P, 40), truth[P][0]), self.window(P, mu(P, 80), truth[P][0]), 40) for P in truth]
        asked = []

        def compute(cells, grade_x, points):
            self.assertEqual(grade_x, 3)
            asked.append((cells, [round(P, 3) for _, P in points]))
            out = []
            for centre in sorted({min(truth, key=lambda c, P=P: abs(np.log(P / c))) for _, P in points}):
                runs = sum(abs(np.log(P / centre)) < 0.2 for _, P in points)
                out.append(self.window(centre, mu(centre, cells), truth[centre][0], truth[centre][1], runs))
            return out[::-1]
        found = refinement.refine(even, theory.Material("", 0.3, 0.38, 0.1, 0.1), compute)
        self.assertEqual([(pair.cells, pair.grade) for pair in found], [(40, 1), (80, 3), (160, 3), (160, 3)])
        self.assertEqual([len(pair.fine.rows) for pair in found], [5, 3, 1, 3])
        self.assertEqual([cells for cells, _ in asked], [80, 160, 320])
        self.assertEqual(asked[0][1], [1.774, 2.0, 2.255, 3.548, 4.0, 4.51, 7.095, 8.0, 9.02])
        self.assertEqual(asked[2][1], [4.0, 7.095, 8.0, 9.02])
        for pair in found:
            self.assertAlmostEqual(pair.coarse.mu, mu(round(pair.P), pair.cells), places=3)

    def test_study_of_points(self):
        text = refinement.study_text((PAPER / "fig2a.yaml").read_text(), PAPER, [(4.0, 0.02), (1.0, 0.1)])
        (self.folder / "points.yaml").write_text(text)
        done = subprocess.run([PROGRAM, "sweep", self.folder / "points.yaml", "-q", "-o", self.folder / "out", "--set",
                               "groups.rod=nowhere"], capture_output=True, text=True, timeout=500)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(done.stderr.count("nowhere"), 2, done.stderr)

    def test_cells_at_the_ends(self):
        """The lengths of the first and the longest cell of graded meshes, by the mesh itself."""
        for grade_x in (refinement.GRADED, refinement.STEEP):
            words = [word for setting in refinement.settings(80, grade_x) for word in ("--set", setting)]
            done = subprocess.run([PROGRAM, "run", PAPER / "fig1.yaml", "-q", "-o", self.folder / str(grade_x), *words, "--set",
                                   "mesh.set.nz=2", "--set", "time.until.U=1e-8", "--set", "output.figures=[]", "--set",
                                   "output.fields=none"], capture_output=True, text=True, timeout=500)
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(self.folder / str(grade_x) / "history.h5") as file:
                cells = 80 * np.diff(file["nodes/x"][:])
            self.assertAlmostEqual(cells[0] / refinement.FIRST_CELL[grade_x], 1, delta=0.05)
            if grade_x == refinement.GRADED:
                self.assertAlmostEqual(cells.max() / refinement.LONGEST_CELL, 1, delta=0.01)

    def test_grade(self):
        """By hand, 160 graded cells with 0.00875 L the longest: viscosity holds 6.8e-4/(0.28 P L) in A, 7.8e-7/(P L) in B."""
        def graded(material, length, P, l_c=0.1):
            rows = [Windows.row(P, 0.3, length=length, l_c=l_c)]
            return refinement.grade(material, refinement.Pair(windows.Window(rows), windows.Window(rows), 40))
        self.assertEqual([graded(theory.A, 4, P) for P in (0.0464, 0.069, 0.07, 0.1)], [3, 3, 1, 1])
        self.assertEqual([graded(theory.B, 0.08, P) for P in (1e-4, 1e-3, 1.2e-3)], [3, 3, 1])
        self.assertEqual(graded(theory.B, 0.02, 2e-5, 0.96), 100)


class Studies(InFolder):
    def test_all_can_be_read(self):
        """Every study of the paper: nothing is wrong but the parameter of the mesh that is asked for here, at all points, or at
        FEW of a long range, its ends among them."""
        for study in sorted(PAPER.glob("*.yaml")):
            text = study.read_text()
            if "\nscene:" not in text:
                continue
            with self.subTest(study.name):
                out, few = self.folder / study.stem, self.folder / study.name
                text = re.sub(r"\bpoints: (\d+)", lambda found: f"points: {min(int(found[1]), FEW)}", text)
                few.write_text(re.sub(r"(?m)^scene: ", f"scene: {PAPER}/", text))
                done = subprocess.run([PROGRAM, "sweep", few, "-q", "-o", out, "--set", "mesh.set.unheard_of=1"],
                                      capture_output=True, text=True, timeout=500)
                self.assertEqual(done.returncode, 1, done.stderr)
                with open(out / "sweep.csv", newline="", encoding="utf-8") as table:
                    rows = list(csv.DictReader(table))
                self.assertGreater(len(rows), 1)
                for row in rows:
                    self.assertIn("takes no parameter 'unheard_of'", row["message"])

    def test_tables(self):
        self.assertEqual(paper_report.table(["a", "b"], [(1, float("nan")), ("x", 123456.0)]),
                         "| a | b |\n|---|---|\n| 1 | - |\n| x | 1.235e+05 |\n")
        self.assertEqual(windows.mu_of({"mu_M": float("nan"), "mu_max": 0.3}), 0.3)
        self.assertEqual(windows.mu_of({"mu_M": 0.2, "mu_max": 0.3}), 0.2)


if __name__ == "__main__":
    unittest.main()
