# SPDX-License-Identifier: GPL-2.0-or-later
"""Measurements beside what is computed: what each figure compares, and its misfit, worked out once more from history.h5 and
run.json; the tables that go with figures; compare in scenes, plots and on the command line."""
import csv
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

PROGRAM = Path(os.environ["AMONTONS_BIN"]) / "amontons"
SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
SCENE = f"""title: A block
mesh: {{file: {SOURCE}/meshes/block.geo, set: {{length: 1, height: 0.5, nx: 40, nz: 20}}}}
material: {{young: 1, poisson: 0.34, density: 1, eta1: 1, eta2: 1}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-5, height: 0.25, width: 0.05}}
time: {{until: {{U: 0.009}}}}
output: {{figures: []}}
"""


def call(folder, *words, status=0):
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True,
                          env=os.environ | {"AMONTONS_CACHE": str(folder / "cache")})
    if done.returncode != status:
        raise AssertionError(f"{words}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def table(path):
    """Columns by name, numbers."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) if row[name] else np.nan for row in rows]) for name in rows[0]}


def words_of(pdf):
    return subprocess.run(["pdftotext", "-layout", pdf, "-"], capture_output=True, text=True, check=True).stdout


def misfit(measured, computed, error=None):
    return np.sqrt(np.nanmean(((measured - computed) / (1 if error is None else error))**2))


class Compared(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons-compare-"))
        (cls.folder / "scene.yaml").write_text(SCENE)
        call(cls.folder, "run", "scene.yaml", "-o", "out", "--quiet")
        with h5py.File(cls.folder / "out/history.h5") as file:
            cls.t, cls.U, cls.mu, cls.front = (file[f"series/{name}"][:] for name in ("time", "rod_displacement", "mu", "front"))
            cls.x, cls.rate, cls.status = (file[name][:] for name in ("nodes/x", "interface/slip_rate", "interface/status"))
            cls.c_R, cls.critical = file.attrs["speed_rayleigh"], file.attrs["critical_velocity"]
        cls.events = json.loads((cls.folder / "out/run.json").read_text())["results"]["events"]
        cls.slide = [event for event in cls.events if event["kind"] == "leading rapid"]
        assert len(cls.slide) > 2, "the run slides"

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def compare(self, figure, text, *options, status=0):
        """What NAME-compared.csv and the legend say."""
        (self.folder / "measured.csv").write_text(text)
        done = call(self.folder, "render", "out", "--figure", figure, "--format", "pdf", "--compare", "measured.csv", *options,
                    status=status)
        if status:
            return done.stderr
        figures = self.folder / "out/figures"
        return table(figures / f"{figure}-compared.csv"), words_of(figures / f"{figure}.pdf")

    def expect_misfit(self, said, away, parts=None):
        self.assertIn(f"misfit {away:.3g}", said)
        if parts is not None:
            self.assertIn(f"{parts:.3g} of its errors", said)

    def test_force_by_time_and_by_way(self):
        at = np.array([0.3, 0.5, 0.83]) * self.t[-1]
        computed = np.interp(at, self.t, self.mu)
        measured, error = computed + [0.01, -0.02, 0.03], np.array([0.01, 0.01, 0.02])
        rows = "".join(f"{a},{m},{e}\n" for a, m, e in zip(at, measured, error))
        found, said = self.compare("force", "t,F_T/F_N,error\n" + rows)
        np.testing.assert_allclose(found["computed"], computed, rtol=1e-6)
        np.testing.assert_allclose(found["U"], np.interp(at, self.t, self.U), rtol=1e-8)
        self.expect_misfit(said, misfit(measured, computed), misfit(measured, computed, error))

    def test_a_run_beside_itself(self):
        """force.csv and slip-map.csv are what --compare reads: no misfit."""
        call(self.folder, "render", "out", "--figure", "force", "--figure", "slip-map")
        for name, column, values in (("force", "F_T/F_N", self.mu), ("slip-map", "x", self.front)):
            text = (self.folder / f"out/figures/{name}.csv").read_text()
            stored = table(self.folder / f"out/figures/{name}.csv")
            np.testing.assert_allclose(stored[column], values, rtol=5.1e-9, atol=1e-12)
            np.testing.assert_allclose(stored["t"], self.t, rtol=5.1e-9)
            found, _ = self.compare(name, text)
            np.testing.assert_allclose(found["computed"][::50], found[column][::50], rtol=1e-3, atol=1e-3)

    def test_lengths_over_the_load_ratio(self):
        """The farthest that slip had come, and the largest load, since the sliding before the last that counts."""
        call(self.folder, "render", "out", "--figure", "precursors")
        curve = self.farthest()
        ratios = np.array([0.2, 0.25, 0.29])
        theirs = np.interp(ratios, curve["F_T/F_N"], curve["l/L"])
        away = [np.abs(theirs - self.reached(before["U_stop"], after["U_start"], ratios)).max()
                for before, after in zip(self.slide, self.slide[1:])]
        self.assertLess(min(away), 1.1 / 40, "to an element, in one of the cycles")
        self.assertTrue((np.diff(curve["l/L"]) >= 0).all() and (np.diff(curve["F_T/F_N"]) >= 0).all())

    def test_lengths_beside_precursors(self):
        """A measured precursor stands beside the computed one nearest in load; one over the whole contact beside a sliding; one
        farther from all than they are apart beside none. A run beside itself has no misfit."""
        call(self.folder, "render", "out", "--figure", "precursors", "--cycle", "all")
        stored = self.folder / "out/figures/precursors.csv"
        rows = self.rows(stored)
        loads, lengths = (np.array([float(row[name]) for row in rows if row["event"] == "precursor"]) for name in ("F_T/F_N", "l/L"))
        self.assertGreater(len(loads), 2)
        counted = [event for event in self.events if event["kind"] == "bounded rapid"]
        np.testing.assert_allclose(lengths, [event["reach"] for event in counted], rtol=1e-8)
        np.testing.assert_allclose(loads, [self.mu[np.searchsorted(self.U, event["U_start"]) - 1] for event in counted], rtol=1e-8)
        gap = np.diff(np.sort(loads)).max()
        measured = [(loads[0] + 1e-5, 0.5), (loads.max() + 0.9 * gap, 0.6), (loads.min() - 1.1 * gap, 0.1), (0.3, 1)]
        found, said = self.compare("precursors", "F_T/F_N,l/L,error\n" + "".join(f"{a},{b},0.1\n" for a, b in measured), "--cycle", "all")
        np.testing.assert_allclose(found["computed"], [lengths[0], lengths[np.argmax(loads)], np.nan, 1], rtol=1e-8)
        np.testing.assert_allclose(found["computed F_T/F_N"][:2], [loads[0], loads.max()], rtol=1e-8)
        self.expect_misfit(said, misfit(found["l"], found["computed"]), misfit(found["l"], found["computed"], 0.1))
        found, said = self.compare("precursors", stored.read_text(), "--cycle", "all")
        self.assertEqual(len(found["l"]), len([row for row in rows if row["event"] != "farthest so far"]))
        self.assertIn("misfit", said)
        self.assertLess(misfit(found["l"], found["computed"]), 1e-6)

    def rows(self, path):
        with open(path, newline="") as file:
            return list(csv.DictReader(file))

    def farthest(self):
        """Of the table of lengths: what is no event."""
        rows = [row for row in self.rows(self.folder / "out/figures/precursors.csv") if row["event"] == "farthest so far"]
        return {name: np.array([float(row[name]) for row in rows]) for name in ("F_T/F_N", "l/L", "cycle")}

    def reached(self, low, high, ratios):
        inside = np.flatnonzero((self.U >= low) & (self.U <= high))
        inside = inside[inside >= inside[np.argmin(self.front[inside])]]
        front = self.front.copy()
        for event in self.events:
            if event["kind"] == "bounded rapid" and low <= event["U_start"] <= high:
                front[self.U >= event["U_start"]] = np.maximum(front[self.U >= event["U_start"]], event["reach"])
        load, length = (np.maximum.accumulate(values[inside]) for values in (self.mu, front))
        return length[np.minimum(np.searchsorted(load, ratios), len(length) - 1)]   # the first row at or beyond each

    def test_areas(self):
        """max(0, 1 - |v| / v_c) of the nearest node, linear between steps; what is open has none."""
        row = np.searchsorted(self.U, self.slide[-1]["U_start"])
        places = [(row, 5), (row + 3, 12), (row + 3, 39), (row - 5, 0)]
        density = np.where(self.status == 0, 0, np.maximum(0, 1 - np.abs(self.rate) / self.critical))
        expected = np.array([density[r, i] for r, i in places])
        text = "U,x,A/A_0\n" + "".join(f"{self.U[r]:.17g},{self.x[i]},{density[r, i] + 0.01}\n" for r, i in places)
        found, said = self.compare("contact-density", text)
        np.testing.assert_allclose(found["computed"], expected, atol=1e-6)
        self.expect_misfit(said, 0.01)

    def test_areas_of_contacts_that_age(self):
        """1 + beta ln(1 + theta/theta_0) over its value at the start, from theta in the history; the same file in every figure."""
        call(self.folder, "run", "scene.yaml", "-o", "ages", "--quiet", "--set", "mesh.set.nx=16", "mesh.set.nz=8", "time.until.U=0.004",
             "friction={law: ageing, mu_static: 0.35, mu_kinetic: 0.1, critical_velocity: 3.4e-4, healing: 0.05, healing_time: 10, "
             "slip_distance: 1e-4, rest: 100}")
        with h5py.File(self.folder / "ages/history.h5") as file:
            U, x, theta, status = (file[name][:] for name in ("series/rod_displacement", "nodes/x", "interface/state", "interface/status"))
        area = (1 + 0.05 * np.log(1 + theta / 10)) / (1 + 0.05 * np.log(1 + theta[0] / 10))
        places = [(row, i) for row in (len(U) // 3, len(U) // 2, len(U) - 2) for i in (2, 7, 12) if status[row, i] != 0]
        self.assertGreater(len(places), 3)
        (self.folder / "areas.csv").write_text("U,x,A/A_0\n" + "".join(f"{U[r]:.17g},{x[i]},{area[r, i] + 0.01}\n" for r, i in places))
        said = call(self.folder, "compare", "ages", "areas.csv").stdout
        self.assertRegex(said, rf"contact-area +misfit 0\.0(1|099)\d*, {len(places)} of {len(places)} points")
        self.assertNotIn("contact-density", said)
        call(self.folder, "render", "ages", "--figure", "profile", "--format", "pdf")
        shown = table(self.folder / "ages/figures/profile.csv")
        self.assertIn("A / A", words_of(self.folder / "ages/figures/profile.pdf"))
        for way in set(shown["U"]):
            row = np.argmin(abs(U - way))
            np.testing.assert_allclose(shown["A/A_0"][shown["U"] == way], np.where(status[row] == 0, 0, area[row]), atol=2e-6)
        found = table(self.folder / "ages/figures/contact-area-compared.csv")
        np.testing.assert_allclose(found["computed"], [area[r, i] for r, i in places], atol=2e-6)   # stored with 24 bits

    def test_front_speeds(self):
        """The times at which the front came to each station stand in run.json, found while the run went on."""
        call(self.folder, "render", "out", "--figure", "front-speed")
        rows = self.rows(self.folder / "out/figures/front-speed.csv")
        sliding = [row["event"] == "sliding" for row in rows]
        curve = {name: np.abs([float(row[name]) for row, kept in zip(rows, sliding) if kept]) for name in ("x/L", "v/c_R")}
        best = min(self.slide, key=lambda event: self.away(event, curve))
        self.assertLess(self.away(best, curve), 0.02)
        (self.folder / "measured.csv").write_text("")
        found, said = self.compare("front-speed", "x/L,v/c_R\n0.7,1\n")
        np.testing.assert_allclose(found["computed"], np.interp(0.7, curve["x/L"], curve["v/c_R"]) * self.c_R, rtol=1e-6)
        self.expect_misfit(said, abs(1 - found["computed"][0] / self.c_R))
        self.assertIn("R", said)
        found, _ = self.compare("front-speed", (self.folder / "out/figures/front-speed.csv").read_text())
        self.assertEqual(len(found["v"]), sum(sliding), "precursors stand beside no sliding")
        np.testing.assert_allclose(found["computed"], found["v"], rtol=1e-6)

    def test_front_speeds_of_all_events(self):
        """Each event by its cycle, kind and U; speeds below 0 ran towards the trailing end."""
        call(self.folder, "render", "out", "--figure", "front-speed", "--cycle", "all")
        rows = self.rows(self.folder / "out/figures/front-speed.csv")
        counted = {event["U_start"]: event for event in self.events if event["kind"] in ("bounded rapid", "leading rapid")}
        starts = sorted(counted)
        self.assertTrue(rows and {row["event"] for row in rows} == {"precursor", "sliding"})
        for row in rows:
            start = min(starts, key=lambda U: abs(U - float(row["U"])))
            event, cycle = counted[start], 1 + sum(slide["U_start"] < start for slide in self.slide)
            self.assertEqual((row["event"], int(row["cycle"])), ({"bounded rapid": "precursor"}.get(event["kind"], "sliding"), cycle))
            of_run = event["front_speeds"][round((float(row["x/L"]) - 0.025) / 0.05)]
            if of_run is not None and abs(of_run) < self.c_R:
                self.assertGreater(float(row["v/c_R"]) * of_run, 0)

    def test_events(self):
        """A row for each event that counts: load ratios beside it, and the work of friction in it, worked out once more."""
        call(self.folder, "render", "out", "--figure", "force")
        with open(self.folder / "out/figures/events.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        counted = [event for event in self.events if event["kind"] in ("bounded rapid", "leading rapid")]
        names = {"bounded rapid": "precursor", "leading rapid": "sliding"}
        self.assertEqual([row["event"] for row in rows], [names[event["kind"]] for event in counted])
        slidings = np.cumsum([0] + [row["event"] == "sliding" for row in rows])[:-1]
        self.assertEqual([int(row["cycle"]) for row in rows], list(slidings + 1))
        with h5py.File(self.folder / "out/history.h5") as file:
            slip, shear, weight, pressure = (file[name][:].astype(float) for name in
                                             ("interface/slip", "interface/shear", "nodes/weight", "interface/pressure"))
            load = file.attrs["normal_force"]
        for row, event in zip(rows, counted):
            first, last = np.searchsorted(self.U, event["U_start"]) - 1, np.searchsorted(self.U, event["U_stop"], "right") - 1
            part = slice(first, last + 1)
            work = (weight * (shear[part][1:] + shear[part][:-1]) / 2 * np.diff(slip[part], axis=0)).sum()
            wanted = {"U": event["U_start"], "t": event["t_start"], "F_T/F_N before": self.mu[first], "F_T/F_N after": self.mu[last],
                      "F_T before": load * self.mu[first], "length": event["reach"], "front": self.front[first + 1:last + 1].max(), "largest slip rate": event["peak_slip_rate"],
                      "torque before": pressure[first] @ (weight * (self.x - 0.5)), "torque after": pressure[last] @ (weight * (self.x - 0.5)),
                      "work of friction": work, "steps": last - first, "resolved": last - first >= 8}
            for name, value in wanted.items():
                np.testing.assert_allclose(float(row[name]), value, rtol=1e-6, err_msg=name)

    def test_cycles(self):
        """The precursors of the first loading, and of all cycles one behind the other."""
        call(self.folder, "render", "out", "--figure", "precursors", "--cycle", "first")
        first = self.farthest()
        self.assertEqual(set(first["cycle"]), {1})
        self.assertLess(abs(first["F_T/F_N"][-1] / self.mu[self.U <= self.slide[0]["U_start"]].max() - 1), 1e-6)
        call(self.folder, "render", "out", "--figure", "precursors", "--cycle", "all")
        self.assertEqual(set(self.farthest()["cycle"]), set(range(1, len(self.slide) + 1)))

    def away(self, event, curve):
        times = np.array([np.nan if value is None else value for value in event["front_times"]])
        speed = 0.05 / np.abs(np.diff(times)) / self.c_R
        mine = speed[np.rint((curve["x/L"] - 0.025) / 0.05).astype(int)]
        return np.nanmedian(np.abs(mine / curve["v/c_R"] - 1)) if np.isfinite(mine).all() else np.inf

    def test_what_no_figure_shows_is_said(self):
        said = self.compare("force", "F_T/F_N,l/L\n0.2,0.5\n", status=2)
        self.assertIn("the figure that shows them is precursors", said)
        said = self.compare("force", "U,l/L\n0.2,0.5\n", status=2)
        self.assertIn("it needs the columns", said)
        (self.folder / "measured.csv").write_text("F_T/F_N,l/L\n0.2,0.5\n")
        call(self.folder, "render", "out", "--compare", "measured.csv")   # no figure named: the one that shows them, too
        self.assertTrue((self.folder / "out/figures/precursors.png").is_file())

    def test_a_scene(self):
        (self.folder / "lengths.csv").write_text("F_T/F_N,l/L\n0.2,0.5\n")
        changed = SCENE.replace("figures: []", "figures: [precursors], compare: lengths.csv")
        (self.folder / "scenes").mkdir(exist_ok=True)
        (self.folder / "scenes/compare.yaml").write_text(changed.replace("lengths", "../lengths"))
        call(self.folder, "run", "scenes/compare.yaml", "-o", "by-scene", "--quiet")
        self.assertEqual(len(table(self.folder / "by-scene/figures/precursors-compared.csv")["l"]), 1)
        (self.folder / "missing.yaml").write_text(changed.replace("lengths", "nothing"))
        said = call(self.folder, "run", "missing.yaml", "-o", "missing", status=2).stderr
        self.assertRegex(said, r"missing.yaml:\d+: output.compare: cannot read")
        self.assertFalse((self.folder / "missing/history.h5").exists())
        (self.folder / "none.yaml").write_text(changed.replace("[precursors]", "[]"))
        self.assertIn("output.figures names no picture", call(self.folder, "run", "none.yaml", status=2).stderr)

    def test_a_plot_of_a_sweep(self):
        """Linear in the logarithm of the pressure, as the axis is; from the study's folder, the command, and a plot file."""
        (self.folder / "study").mkdir(exist_ok=True)
        (self.folder / "study/study.yaml").write_text(
            "title: By pressure\nscene: ../scene.yaml\nset: {time.until.U: 0.006}\nvary: {load.pressure: [0.002, 0.004, 0.008]}\n"
            "plot: {x: load.pressure, y: results.mu_max, log: x, compare: seen.csv}\n")
        (self.folder / "study/seen.csv").write_text("load.pressure,results.mu_max,error\n0.003,0.3,0.02\n0.009,0.3,0.02\n")
        call(self.folder, "sweep", "study/study.yaml", "-o", "swept", "--quiet")
        plot = json.loads((self.folder / "swept/figures/plot.json").read_text())
        curve = plot["series"][0]
        expected = np.interp(np.log(0.003), np.log(curve["x"]), curve["y"])   # the second lies beyond the curve
        said = f"misfit {abs(0.3 - expected):.3g}, {abs(0.3 - expected) / 0.02:.3g} of its errors"
        stored = table(self.folder / "swept/figures/plot-compared.csv")
        np.testing.assert_allclose(stored["load.pressure"], [0.003, 0.009])
        np.testing.assert_allclose(stored["results.mu_max"], [0.3, 0.3])
        np.testing.assert_allclose(stored["error"], [0.02, 0.02])
        np.testing.assert_allclose(stored["computed"], [expected, np.nan], rtol=1e-12)
        call(self.folder, "render", "swept", "--format", "pdf")
        self.assertIn(said, words_of(self.folder / "swept/figures/plot.pdf"))
        call(self.folder, "render", "swept", "--plot", "{x: load.pressure, y: results.mu_max, log: x, name: two}", "--compare",
             "study/seen.csv", "--format", "pdf")
        self.assertIn(said, words_of(self.folder / "swept/figures/two.pdf"))
        (self.folder / "study/hand.yaml").write_text(
            "x: {label: a, scale: log}\ny: {label: b}\nseries: [{x: [1, 100], y: [0, 2], line: thin}]\npage: {compare: hand.csv}\n")
        (self.folder / "study/hand.csv").write_text("x,y\n10,1.5\n")
        call(self.folder, "render", "study/hand.yaml", "--format", "pdf")
        self.assertIn("misfit 0.5", words_of(self.folder / "study/hand.pdf"))
        self.assertEqual((self.folder / "study/hand-compared.csv").read_text().splitlines(), ["x,y,error,computed", "10,1.5,,1"])
        (self.folder / "study/hand.csv").write_text("a,b\n10,1.5\n")
        self.assertIn("it needs the columns x and y", call(self.folder, "render", "study/hand.yaml", status=2).stderr)


if __name__ == "__main__":
    unittest.main()
