# SPDX-License-Identifier: GPL-2.0-or-later
"""`amontons sweep`: tables against single runs, kills and resumes, failing points, any number of processes."""
import csv
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
TIMES = ("solve_s", "total_s")   # of the machine, not of the study
STUDY = f"""
title: test
scene: {SOURCE}/validation/paper/fig1.yaml
set: {{mesh.set.nx: 10, mesh.set.nz: 10, mesh.set.height: = 0.5 * mesh.set.length, rod.height: 0, rod.width: 0}}
vary:
  mesh.set.length: [1, 2]
  load.pressure: [0.003, 0.006]
  rod.kind: [push, bonded]
"""
HEAD = STUDY.split("vary:")[0]
QUICK = [f"  - {{mesh.set.length: {L}, load.pressure: {P}, rod.kind: {kind}}}\n"
         for L in (1, 2) for P in (0.003, 0.006) for kind in ("push", "bonded")]
# Points that no machine finishes: a test that waits for one to end it knows what is at work.
ENDLESS = [f"  - {{mesh.set.nx: 96, mesh.set.nz: 96, time.tolerance: 1e-12, load.pressure: {P}}}\n"
           for P in (0.0031, 0.0032)]


class Sweep(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cache = tempfile.mkdtemp(prefix="amontons-cache-")   # shared: shapes are made once
        cls.addClassCleanup(shutil.rmtree, cls.cache)
        cls.place = {**os.environ, "AMONTONS_CACHE": cls.cache}

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-sweep-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def study(self, text=STUDY, name="study.yaml"):
        path = self.folder / name
        path.write_text(text)
        return path

    def call(self, *words):
        return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, timeout=200, env=self.place,
                              cwd=self.folder)

    def sweep(self, *words, study=None, out="out", status=0):
        done = self.call("sweep", study or self.study(), "-o", self.folder / out, *words)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def table(self, out="out"):
        with open(self.folder / out / "sweep.csv", newline="") as file:
            return list(csv.DictReader(file))

    def without_times(self, out):
        return [{key: value for key, value in row.items() if key not in TIMES} for row in self.table(out)]

    def test_tables_of_somebody(self):
        """What has the name of a table of ours and is none stays, and is named."""
        for name in ("sweep.csv", "sweep.h5", "ranking.csv"):
            (self.folder / "theirs" / name).parent.mkdir(exist_ok=True)
            (self.folder / "theirs" / name).write_text("mine")
            self.assertIn(f"theirs/{name} is there", self.sweep(out="theirs", status=2).stderr)
            self.assertEqual((self.folder / "theirs" / name).read_text(), "mine")
            (self.folder / "theirs" / name).unlink()

    def test_included_file_changes(self):
        """The mesh that gmsh makes decides what is known before, not the bytes of the outer file alone."""
        inner, outer = self.folder / "height.geo", self.folder / "block.geo"
        block = (SOURCE / "meshes/block.geo").read_text()
        self.assertEqual(block.count("    height = 0.5, "), 1)
        outer.write_text('Include "height.geo";\n' + block.replace("    height = 0.5, ", "    height = inner, "))
        study = self.study(f"title: t\nscene: {SOURCE}/validation/paper/fig1.yaml\n"
                           f"set: {{mesh.file: {outer}, mesh.set: {{nx: 10, nz: 10}}, output.fields: none}}\n"
                           "vary: {load.pressure: [0.006]}\n")
        found = []
        for height in (0.5, 0.5, 0.8):
            inner.write_text(f"inner = {height};\n")
            self.sweep("-j", "1", study=study)
            with open(self.folder / "out/sweep.csv", newline="") as file:
                found.append(list(csv.DictReader(file))[0])
        self.assertEqual(found[0]["total_s"], found[1]["total_s"])   # known before
        self.assertNotEqual(found[0]["run"], found[2]["run"])
        self.assertNotEqual(found[0]["mu_M"], found[2]["mu_M"])

    def test_table_is_what_single_runs_say(self):
        self.sweep()
        rows = self.table()
        self.assertEqual([(float(r["mesh.set.length"]), float(r["load.pressure"]), r["rod.kind"]) for r in rows],
                         [(L, P, k) for L in (1, 2) for P in (0.003, 0.006) for k in ("push", "bonded")])
        row = rows[6]
        done = self.call("run", SOURCE / "validation/paper/fig1.yaml", "-o", "single", "--quiet", "--set",
                         "mesh.set.nx=10", "mesh.set.nz=10", "mesh.set.length=2", "mesh.set.height=1",
                         "rod.height=0", "rod.width=0", "time.until.periodic=true", "load.pressure=0.006", "rod.kind=push",
                         "output.figures=[]", "output.fields=none", "output.history=false")
        self.assertEqual(done.returncode, 0, done.stderr)
        run = json.loads((self.folder / "single/run.json").read_text())
        self.assertEqual(float(row["mu_M"]), run["results"]["mu_M"])
        self.assertEqual(int(row["steps"]), run["steps"]["accepted"])
        self.assertEqual(float(row["mesh.set.height"]), 1)
        self.assertEqual(row["status"], "done")
        point = json.loads((self.folder / "out" / row["run"] / "run.json").read_text())
        self.assertEqual(point["results"], run["results"])

    def test_hdf5_holds_the_same(self):
        self.sweep()
        rows = self.table()
        with h5py.File(self.folder / "out/sweep.h5") as file:
            np.testing.assert_array_equal(file["result/mu_M"][:], [float(row["mu_M"] or "nan") for row in rows])
            np.testing.assert_array_equal(file["scene/load.pressure"][:], [0.003, 0.003, 0.006, 0.006] * 2)
            words = file.attrs["rod.kind words"]
            words = (words.decode() if isinstance(words, bytes) else words).split("|")
            self.assertEqual([words[int(k)] for k in file["scene/rod.kind"][:]], ["push", "bonded"] * 4)
            self.assertEqual(set(file["result/status"][:]), {1})

    def test_any_number_of_processes(self):
        self.sweep("-j", "1", out="one")
        self.sweep("-j", "5", out="five")
        self.assertEqual(self.without_times("one"), self.without_times("five"))

    def test_gmsh_is_loaded_once(self):
        """By a process for all its meshes; the loader says so."""
        study = self.study(f"title: t\nscene: {SOURCE}/validation/paper/fig1.yaml\n"
                           f"set: {{mesh.set.nx: 6, mesh.set.nz: 6, time.until.U: 1e-5, output.fields: none}}\n"
                           f"vary: {{mesh.set.height: [0.6, 0.7, 0.8]}}\n")
        words = self.folder / "words"
        words.mkdir()
        done = subprocess.run([PROGRAM, "sweep", study, "-o", self.folder / "out", "-j", "1"],
                              capture_output=True, text=True, timeout=200,
                              env={**self.place, "AMONTONS_CACHE": str(self.folder / "cache"),
                                   "LD_DEBUG": "files", "LD_DEBUG_OUTPUT": str(words / "loader")})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(self.table("out")), 3)
        said = [line for file in words.iterdir() for line in file.read_text().splitlines()]
        self.assertTrue([line for line in said if "calling init:" in line and "libopenblas" in line])
        self.assertEqual(sum("calling init:" in line and "libgmsh" in line for line in said), 1)

    def test_finished_points_stay(self):
        first = self.sweep()
        self.assertIn("8 points: 8 computed", first.stdout)
        before = (self.folder / "out/sweep.csv").read_bytes()
        stamps = {p: p.stat().st_mtime_ns for p in (self.folder / "out/points").glob("*/run.json")}
        self.assertEqual(len(stamps), 8)
        again = self.sweep()
        self.assertIn("8 points: 0 computed", again.stdout)
        self.assertIn("8 computed before", again.stdout)
        self.assertEqual((self.folder / "out/sweep.csv").read_bytes(), before)
        # Another order, a value more: only that is computed.
        study = self.study(STUDY.replace("[0.003, 0.006]", "[0.006, 0.004, 0.003]"))
        self.assertIn("12 points: 4 computed", self.sweep(study=study).stdout)
        self.assertEqual(stamps, {p: p.stat().st_mtime_ns for p in stamps})
        self.assertIn("8 computed", self.sweep("--fresh").stdout)

    def test_half_a_report_is_computed_again(self):
        """A disk that lost half of a run.json: its point is computed again, no other, to the same table."""
        study = self.study(HEAD + "cases:\n" + "".join(QUICK[:2]))
        self.sweep(study=study)
        before, path = self.without_times("out"), next((self.folder / "out/points").glob("*/run.json"))
        path.write_text(path.read_text()[:path.stat().st_size // 2])
        self.assertIn("2 points: 1 computed", self.sweep(study=study).stdout)
        self.assertEqual(self.without_times("out"), before)

    def test_same_bits_whoever_fills_the_cache(self):
        """The basis is made by the first point that asks, for all lengths and pressures: it must not show which."""
        tables = []
        for order, folder in ((1, "up"), (-1, "down")):
            lengths, pressures = [1, 1.7][::order], [0.0061, 0.0047, 0.0033][::order]
            study = self.study(STUDY.replace("[1, 2]", str(lengths)).replace("[0.003, 0.006]", str(pressures)))
            done = subprocess.run([PROGRAM, "sweep", study, "-o", self.folder / folder, "-j", "1"], cwd=self.folder,
                                  env={**self.place, "AMONTONS_CACHE": str(self.folder / f"cache-{folder}")},
                                  capture_output=True, text=True, timeout=200)
            self.assertEqual(done.returncode, 0, done.stderr)
            rows = [{k: v for k, v in row.items() if k != "point"} for row in self.without_times(folder)]
            tables.append(sorted(rows, key=lambda row: row["run"]))
        self.assertEqual(*tables)

    def start(self, study, jobs):
        process = subprocess.Popen([PROGRAM, "sweep", study, "-o", self.folder / "out", "-j", jobs], env=self.place,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def wait(self, condition):
        end = time.monotonic() + 120
        while not condition():
            self.assertLess(time.monotonic(), end, "waited for two minutes")
            time.sleep(0.01)

    @staticmethod
    def children(process):
        return [int(pid) for pid in subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True,
                                                   check=False).stdout.split()]

    @staticmethod
    def state(pid):
        """R, S, T (stopped), Z (ended, not yet waited for) ...; None: gone."""
        try:
            return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
        except OSError:
            return None

    def killed(self, how):
        """Stops a sweep that has finished three points and works on two that never end."""
        process = self.start(self.study(HEAD + "cases:\n" + "".join(QUICK[:3] + ENDLESS + QUICK[3:])), "2")
        points = self.folder / "out/points"
        self.wait(lambda: len(list(points.glob("*/run.json"))) == 3 and len(self.children(process)) == 2)
        process.send_signal(how)
        errors = process.communicate(timeout=120)[1].decode()
        self.wait(lambda: subprocess.run(["pgrep", "-f", str(self.folder)], capture_output=True, check=False).stdout == b"")
        finished = {p for p in points.glob("*/run.json") if json.loads(p.read_text())["status"] == "done"}
        self.assertEqual(len(finished), 3)
        return finished, errors, process.returncode

    def resumed(self, finished):
        study = self.study(HEAD + "cases:\n" + "".join(QUICK))
        stamps = {p: p.stat().st_mtime_ns for p in finished}
        self.assertIn("8 points: 5 computed", self.sweep(study=study).stdout)
        self.assertEqual(stamps, {p: p.stat().st_mtime_ns for p in stamps})
        self.sweep(study=study, out="whole")
        self.assertEqual(self.without_times("out"), self.without_times("whole"))

    def test_killed_and_resumed(self):
        finished, _, status = self.killed(signal.SIGKILL)
        self.assertEqual(status, -signal.SIGKILL)
        self.resumed(finished)

    def test_interrupted_and_resumed(self):
        finished, errors, status = self.killed(signal.SIGINT)
        self.assertEqual(status, 1)
        self.assertIn("interrupted", errors)
        self.assertEqual([row["status"] for row in self.table()], ["done"] * 3 + ["pending"] * 7)
        self.resumed(finished)

    def test_points_that_finish_as_the_signal_comes(self):
        """The pool asleep, both its points finish; then the signal: the table must know them."""
        process = self.start(self.study(), "2")
        self.wait(lambda: len(self.children(process)) == 2 or process.poll() is not None)
        process.send_signal(signal.SIGSTOP)
        self.wait(lambda: self.state(process.pid) in ("T", "Z", None))   # from here on it waits for no child
        self.wait(lambda: all(self.state(child) in ("S", "Z") for child in self.children(process)) and   # no more to do
                  len(list((self.folder / "out/points").glob("*/run.json"))) >= 2)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGCONT)
        process.communicate(timeout=120)
        states = [row["status"] for row in self.table()]
        found = [json.loads(p.read_text())["status"] for p in (self.folder / "out/points").glob("*/run.json")]
        self.assertGreaterEqual(found.count("done"), 2)
        self.assertEqual(states.count("done"), found.count("done"))

    def test_failing_points(self):
        study = self.study(STUDY.replace("vary:", "cases: [{groups.top: top}, {groups.top: roof}]\nvary:"))
        done = self.sweep(study=study, status=1)
        self.assertIn("8 of 16 points failed", done.stderr)
        self.assertIn("groups.top=roof", done.stderr)
        rows = self.table()
        self.assertEqual([row["status"] for row in rows], ["done"] * 8 + ["failed"] * 8)
        self.assertTrue(all("has no group 'roof'" in row["message"] for row in rows[8:]))
        self.assertTrue(all(row["mu_M"] == "" for row in rows[8:]))
        again = self.sweep(study=study, status=1)
        self.assertIn("16 points: 0 computed", again.stdout)
        self.assertIn("16 points: 8 computed", self.sweep("--retry", study=study, status=1).stdout)

    def test_crashing_point(self):
        """A process that dies by a signal costs its own point only, neither those before nor those after it."""
        process = self.start(self.study(HEAD + "cases:\n" + "".join(QUICK[:2] + ENDLESS[:1] + QUICK[2:])), "1")
        self.wait(lambda: [len(list((self.folder / "out/points").glob(names))) for names in ("*/run.json", "*")] == [2, 3])
        os.kill(self.children(process)[0], signal.SIGSEGV)
        process.communicate(timeout=120)
        self.assertEqual(process.returncode, 1)
        self.assertEqual([row["status"] for row in self.table()], ["done"] * 2 + ["failed"] + ["done"] * 6)
        self.assertIn("signal 11", self.table()[2]["message"])

    def test_table_alone(self):
        """`keep: table`: the same rows without a folder a point; taken up again also where a kill cut a line."""
        text = HEAD + "keep: table\ncases:\n" + "".join(QUICK[:4]) + "  - {groups.top: roof}\n"
        self.sweep(study=self.study(text.replace("keep: table\n", "")), out="folders", status=1)
        study, reports = self.study(text), self.folder / "out/reports"
        wanted = [row | {"run": row["run"].split("/")[1]} for row in self.without_times("folders")]
        self.assertIn("5 points: 5 computed", self.sweep(study=study, status=1).stdout)
        self.assertEqual(self.without_times("out"), wanted)
        self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()),
                         ["amontons.files", "reports", "sweep.csv", "sweep.h5"])
        self.assertIn("5 points: 0 computed", self.sweep(study=study, status=1).stdout)
        lines = reports.read_bytes().splitlines(True)
        reports.write_bytes(b"".join(lines[:2]) + lines[2][:200])
        self.assertIn("5 points: 3 computed", self.sweep(study=study, status=1).stdout)
        self.assertEqual(self.without_times("out"), wanted)
        self.assertEqual(reports.read_bytes().count(b"\n"), 5)
        for more, said in (("set: {output.history: true, ", "no folder for a history"), ("keep: rows\nset: {", "keep: ")):
            wrong = self.sweep(study=self.study(text.replace("set: {", more, 1)), out="wrong", status=2)
            self.assertIn(said, wrong.stderr)

    def test_crash_with_the_table_alone(self):
        process = self.start(self.study(HEAD + "keep: table\ncases:\n" + "".join(QUICK[:2] + ENDLESS[:1] + QUICK[2:3])), "1")
        reports = self.folder / "out/reports"
        self.wait(lambda: reports.exists() and reports.read_bytes().count(b"\n") == 2)   # the third is handed out
        os.kill(self.children(process)[0], signal.SIGSEGV)
        process.communicate(timeout=120)
        self.assertEqual([row["status"] for row in self.table()], ["done", "done", "failed", "done"])
        self.assertIn("signal 11", self.table()[2]["message"])

    def test_ranking(self):
        """The order and the gains as the table has them; both pictures; what is wrong with a baseline."""
        wanted = "rank: {by: mu_M, top: 3, against: {rod.kind: push, load.pressure: 0.006}}\n"
        study = self.study(STUDY + wanted + "plot: {x: load.pressure, y: mu_M, series: mesh.set.length, log: x}\n")
        done = self.sweep(study=study)
        rows = self.table()
        value = [float(row["mu_M"]) for row in rows]
        order = sorted(range(8), key=lambda k: -value[k])
        with open(self.folder / "out/ranking.csv", newline="") as file:
            ranked = list(csv.DictReader(file))
        self.assertEqual([int(row["point"]) for row in ranked], order)
        for row in ranked:
            k = int(row["point"])
            self.assertEqual(float(row["mu_M"]), value[k])
            base = value[2 if k < 4 else 6]   # the same length, pushed at 0.006
            self.assertAlmostEqual(float(row["gain_percent"]), 100 * (value[k] / base - 1), places=9)
            self.assertEqual("not periodic" in row["note"], rows[k]["period"] == "0")
            self.assertEqual(row["mu_M_error"], rows[k]["mu_M_error"])
        shown = done.stdout.split("mu_M, highest first; gain over the same point with")[1].split("\n\n")[0].splitlines()
        self.assertEqual(len(shown), 6)   # title, head, three rows, how many more
        self.assertRegex(shown[2], rf"^ +1 .* {value[order[0]]:.2f} ")
        self.assertIn("5 more in ranking.csv", shown[5])
        self.assertNotIn("look beyond", done.stdout)   # of two values one is always at an edge
        for name in ("ranking", "plot"):
            self.assertGreater((self.folder / f"out/figures/{name}.png").stat().st_size, 10000)
            self.assertEqual(self.call("render", self.folder / f"out/figures/{name}.json").returncode, 0)
        failing = STUDY.replace("vary:", "cases: [{groups.top: roof}, {groups.top: top}]\nvary:")
        self.sweep(study=self.study(failing + "rank: {by: mu_M, order: lowest, against: best}\n"), status=1)
        with open(self.folder / "out/ranking.csv", newline="") as file:
            ranked = list(csv.DictReader(file))
        self.assertEqual([int(row["point"]) for row in ranked], [*(k + 8 for k in sorted(range(8), key=lambda k: value[k])), *range(8)])
        self.assertEqual([row["note"] for row in ranked[8:]], ["failed"] * 8)
        self.assertEqual({row["rank"] for row in ranked[8:]}, {""})
        done = self.sweep(study=self.study(STUDY + "plot: {x: rod.kind, y: mu_M}\n"), status=2)
        self.assertIn("rod.kind has words, not numbers", done.stderr)
        done = self.sweep(study=self.study(STUDY + "rank: {by: mu_M, against: {load.pressure: 7}}\n"), status=2)
        self.assertRegex(done.stderr, r":9:\d+: against: no point of the study has these values")

    def test_maps(self):
        """A map, its panels and formulas hold the table's numbers; others are drawn afterwards."""
        text = HEAD + "vary: {mesh.set.length: [1, 2], load.pressure: [0.003, 0.006], rod.kind: [push, bonded]}\n"
        self.sweep(study=self.study(text + "plot:\n"
                   "  - {x: load.pressure, y: mesh.set.length, color: mu_M, contours: l_c, panels: rod.kind}\n"
                   "  - {x: = load.pressure * mesh.set.length, y: mu_M, panels: mesh.set.length, name: both}\n"))
        rows, figures = self.table(), self.folder / "out/figures"
        plot = json.loads((figures / "map.json").read_text())
        self.assertEqual([panel["title"] for panel in plot["panels"]], ["kind = push", "kind = bonded"])
        for panel, kind in zip(plot["panels"], ("push", "bonded")):
            mine = [row for row in rows if row["rod.kind"] == kind]
            for name, column in ("x", "load.pressure"), ("y", "mesh.set.length"), ("value", "mu_M"), ("contour", "l_c"):
                self.assertEqual(panel["map"][name], [float(row[column]) for row in mine])
            self.assertEqual(panel["map"]["open"], [float(bool(row["warnings"])) for row in mine])
        plot = json.loads((figures / "both.json").read_text())
        for panel, length in zip(plot["panels"], (1, 2)):
            self.assertEqual({x / length for s in panel["series"] for x in s["x"]}, {0.003, 0.006})
            self.assertEqual({s["marker"] for s in panel["series"]}, {"circle"})
        for name in ("map", "both"):
            self.assertGreater((figures / f"{name}.png").stat().st_size, 10000)
        self.assertEqual(self.call("render", self.folder / "out", "--format", "svg").returncode, 0)
        self.assertIn("<svg", (figures / "map.svg").read_text())
        draw = ("render", self.folder / "out", "--plot")
        self.assertEqual(self.call(*draw, "{x: mu_M, y: = 2 * l_c, name: later}").returncode, 0)
        drawn = json.loads((figures / "later.json").read_text())["series"][0]
        self.assertEqual(sorted(drawn["y"]), sorted(2 * float(row["l_c"]) for row in rows))
        # A label, or a formula, keeps the errors; of a formula they are what the columns' own do to it.
        drawn = {}
        for name, y in ("plain", "mu_M"), ("named", "held at last = mu_M"), ("twice", "= 2 * mu_M"):
            self.assertEqual(self.call(*draw, f"{{x: load.pressure, y: {y}, name: {name}, panels: rod.kind, series: mesh.set.length}}").returncode, 0)
            drawn[name] = json.loads((figures / f"{name}.json").read_text())
        self.assertEqual(drawn["named"]["y"]["label"], "held at last")
        for one, of_name, of_two in zip(*(drawn[name]["panels"][0]["series"] for name in ("plain", "named", "twice"))):
            if "error" not in one:
                continue
            self.assertTrue(any(one["error"]))
            for mine, named, doubled in zip(one["error"], of_name["error"], of_two["error"]):
                self.assertEqual(mine is None, named is None)
                if mine is not None:
                    self.assertAlmostEqual(named, mine, delta=1e-9)
                    self.assertAlmostEqual(doubled, 2 * mine, delta=1e-9)
        for words, said in ("{x: mu_M, y: load.presure}", "did you mean `load.pressure`"), \
                           ("{x: load.pressure, y: mesh.set.length, color: mu_M}", "name the key in which they differ"), \
                           ("{x: mu_M}", "`y` must be given"), ("{x: mu_M, y: = l_c +}", "the formula ends"), \
                           ("{x: mu_M, y: l_c, with: /proc/none}", "in `vary`, and as `series` of its plot"):
            done = self.call(*draw, words)
            self.assertEqual((done.returncode, said in done.stderr), (2, True), done.stderr)

    def test_errors_beside_results(self):
        """Whatever run.json calls X_error is the error of X: a column in both tables; so is X_known_to, which is drawn."""
        study = self.study(STUDY + "plot: {x: load.pressure, y: mu_M, series: rod.kind}\n"
                           "record: [mu_M, results.drops.mean, mu_hold_error, warnings, l_c, status, mu_hold]\n")   # two are always there
        self.sweep(study=study)
        self.assertEqual([name for name in self.table()[0] if name.split(".")[0] not in ("mesh", "load", "rod")],
                         ["point", "mu_M", "mu_M_error", "mu_M_known_to", "results.drops.mean", "results.drops.mean_error", "mu_hold_error",
                          "l_c", "mu_hold", "mu_hold_known_to", "status", "message", "warnings", "run"])
        rows, known = self.table(), {}
        for row in rows:
            results = json.loads((self.folder / "out" / row["run"] / "run.json").read_text())["results"]
            for column, error in ("mu_M_error", results["mu_M_error"]), ("results.drops.mean_error", results["drops"]["mean_error"]):
                self.assertEqual(float(row[column]) if row[column] else None, error)
            mu, error = results["mu_M"], results["mu_M_known_to"]
            self.assertEqual(float(row["mu_M_known_to"]) if row["mu_M_known_to"] else None, error)
            known[mu] = (None, None) if error is None else (mu - error, mu + error)
        with h5py.File(self.folder / "out/sweep.h5") as file:
            np.testing.assert_array_equal(file["result/mu_M_error"][:], [float(row["mu_M_error"] or "nan") for row in rows])
            self.assertNotIn("result/mu_hold_error_error", file)
        curves = [c for c in json.loads((self.folder / "out/figures/plot.json").read_text())["series"] if "low" in c]
        drawn = {y: (low, high) for c in curves for y, low, high in zip(c["y"], c["low"], c["high"])}
        self.assertEqual(drawn.keys(), known.keys())
        for mu, bounds in drawn.items():
            np.testing.assert_allclose(np.array(bounds, float), np.array(known[mu], float), rtol=1e-12)

    def test_ranks_that_errors_leave_open(self):
        """Ranks and gains against the rule, worked out from the table; what is printed is what is written."""
        study = self.study(STUDY.replace("[0.003, 0.006]", "[0.0024, 0.0025, 0.003, 0.006]") +
                           "rank: {by: mu_M, top: 16, against: {rod.kind: push, load.pressure: 0.003}}\n")
        said = self.sweep(study=study).stdout
        shown = said.split("mu_M, highest first")[1].split("\n\n")[0].splitlines()
        self.assertRegex(said, r"At \d+ of \d+ points there is no error bar")
        self.assertRegex(said, r"The best is at the edge of what was varied: load\.pressure = 0\.00\d+; look beyond\n")
        rows = self.table()
        value, error = (np.array([float(row[name] or "nan") for row in rows]) for name in ("mu_M", "mu_M_known_to"))
        with open(self.folder / "out/ranking.csv", newline="") as file:
            ranked = list(csv.DictReader(file))
        self.assertGreater(len({row["rank_to"] for row in ranked}), 2)
        open_ranks = 0
        for place, row in enumerate(ranked, 1):
            k, base = int(row["point"]), 4 if int(row["point"]) < 8 else 12
            decided = np.abs(value - value[k]) > np.sqrt(error**2 + error[k]**2)   # not where an error is not known
            first, last = 1 + np.sum(decided & (value > value[k])), len(value) - np.sum(decided & (value < value[k]))
            self.assertEqual((int(row["rank"]), int(row["rank_from"]), int(row["rank_to"])), (place, first, last))
            note = f"not decided between {first} and {last}"
            open_ranks += first < last
            self.assertEqual(note in row["note"], first < last)
            self.assertEqual(note in shown[place + 1], first < last)
            self.assertEqual("error not known" in row["note"], np.isnan(error[k]))
            ratio = value[k] / value[base]
            gain = 0 if k == base else 100 * ratio * np.sqrt((error[k] / value[k])**2 + (error[base] / value[base])**2)
            if np.isnan(error[k] + error[base]):
                self.assertEqual(row["gain_percent_error"], "")
            else:
                self.assertAlmostEqual(float(row["gain_percent_error"]), gain, places=9)
        self.assertGreater(open_ranks, 1)
        self.assertEqual(shown[1].split(), ["rank", "mesh.set.length", "load.pressure", "rod.kind", "mu_M", "gain"])
        self.assertFalse([line for line in shown if "+-" in line])   # no error bar was asked for
        done = self.sweep(study=self.study(STUDY + "rank: {by: l_c, against: first}\n"))   # run.json has no l_c_error
        self.assertRegex(done.stdout, r"l_c, highest first; gain over .*; no errors are known of it\n.* l_c +gain\n")

    def test_refine_is_of_a_search(self):
        done = self.sweep(study=self.study(STUDY + "rank: {by: mu_M, refine: 1%}\n"), status=2)
        self.assertIn("set a smaller accuracy.mu, or search by `amontons optimise`", done.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_warnings(self):
        """On the terminal, in both tables and in both pictures, of the points whose run.json has them."""
        study = self.study(STUDY.replace("[0.003, 0.006]", "[0.003, 0.06]").replace("nx: 10", "nx: 20") + "rank: {by: mu_max}\n"
                           "plot: {x: load.pressure, y: mu_max, series: mesh.set.length}\n")
        done = self.sweep(study=study)
        rows = self.table()
        said = [json.loads((self.folder / "out" / row["run"] / "run.json").read_text())["warnings"] for row in rows]
        self.assertEqual([row["warnings"] for row in rows], [" // ".join(words) for words in said])
        count = sum(1 for words in said if words)
        self.assertIn(count, range(1, 8))
        self.assertRegex(done.stdout, rf"\n{count} of 8 points: slip is not resolved: .* at 21 of 21 contact nodes.* elements [\d.]+ to [\d.]+ times .*\n  points ")
        self.assertEqual(len(re.findall(r"  warned  ", done.stderr)), count)
        self.assertEqual(len(re.findall(r"  mu_max 0\.\d+  ", done.stderr)), 8)   # what is ranked
        with h5py.File(self.folder / "out/sweep.h5") as file:
            words = file.attrs["warnings words"].split("|")
            self.assertEqual([words[int(k)] for k in file["result/warnings"][:]], [row["warnings"] for row in rows])
        with open(self.folder / "out/ranking.csv", newline="") as file:
            self.assertEqual({row["point"]: row["warnings"] for row in csv.DictReader(file)},
                             {row["point"]: row["warnings"] for row in rows})
        for name, value in ("plot", "y"), ("ranking", "x"):
            series = json.loads((self.folder / f"out/figures/{name}.json").read_text())["series"]
            self.assertEqual([c["label"] for c in series if c["label"].startswith("open")],
                             ["open: warned"], "one symbol, one entry")
            # Where cells are too long for slip nothing is known of the error, which the plot draws: no bar is its sign.
            self.assertEqual(sum(c["label"] == "without a bar: error not known" for c in series), int(name == "plot"))
            drawn = [v for c in series if c["line"] == "none" and not c["filled"] and not c["label"] for v in c[value]]
            self.assertEqual(sorted(v for v in drawn if v is not None),
                             sorted(float(row["mu_max"]) for row, words in zip(rows, said) if words))

    def test_steady_sliding(self):
        """At a small pressure the block slides slowly, without drops: its mu_M is mu(V), in table, ranking and map, and says so;
        one that has not slid yet is a hole with its reason."""
        study = (HEAD + "cases:\n  - {load.pressure: 0.0003, time.until.U: 0.0012}\n  - {load.pressure: 0.003, time.until.U: 0.008}\n"
                 "  - {load.pressure: 0.0006, time.until.U: 2e-4}\nrank: {by: mu_M}\n"
                 "record: [mu_M, mu_steady, results.mu_M_is]\nplot: {x: load.pressure, y: mu_M}\n")
        done = self.sweep(study=self.study(study))
        slow, fast, short = self.table()
        scene = json.loads((self.folder / "out" / slow["run"] / "run.json").read_text())["scene"]
        law, V = scene["friction"], scene["rod"]["velocity"]
        exact = law["mu_static"] - (law["mu_static"] - law["mu_kinetic"]) * V / law["critical_velocity"]
        self.assertLess(abs(float(slow["mu_M"]) / exact - 1), 2e-3)
        self.assertEqual((slow["mu_steady"], slow["results.mu_M_is"]), (slow["mu_M"], "steady sliding"))
        self.assertEqual((fast["mu_steady"], fast["results.mu_M_is"]), ("", "peaks"))
        self.assertEqual((short["mu_M"], short["results.mu_M_is"]), ("", "none: the block as a whole did not slide in this run"))
        self.assertIn("1 of 3 points: no mu_M: the block as a whole did not slide in this run\n", done.stdout)
        self.assertIn("1 of 3 points: steady sliding: mu_M is F_T/F_N at which the block slides slowly as a whole\n  points 0\n", done.stdout)
        series = json.loads((self.folder / "out/figures/plot.json").read_text())["series"]
        drawn = [v for c in series for v in c["y"] if v is not None]
        self.assertTrue(any(abs(v - float(slow["mu_M"])) < 1e-12 for v in drawn))

    def test_points_without_a_result(self):
        study = STUDY.replace("[0.003, 0.006]", "[0.003, 0.3]")
        for words in ("rank: {by: mu_M}\n", "plot: {x: load.pressure, y: mu_M}\n"):
            done = self.sweep(study=self.study(study + words))
            missing = [row["point"] for row in self.table() if not row["mu_M"]]
            self.assertEqual(missing, ["2", "3", "6", "7"])
            self.assertIn("4 of 8 points: no mu_M: the block as a whole did not slide in this run\n  points 2 to 3, 6 to 7\n", done.stdout)

    def test_equal_points_are_computed_once(self):
        study = self.study(STUDY.replace("[1, 2]", "[1, 1.0]"))
        self.assertIn("8 points: 4 computed", self.sweep(study=study).stdout)
        rows = self.without_times("out")
        for k in range(4):
            self.assertEqual({**rows[k], "point": ""}, {**rows[k + 4], "point": ""})

    def test_one_sweep_a_folder(self):
        import fcntl
        (self.folder / "out").mkdir()
        with open(self.folder / "out/amontons.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            done = self.sweep(status=1)
        self.assertIn("another sweep is running", done.stderr)

    def test_settings_and_history(self):
        self.sweep("--set", "output.history=true", "--set", "mesh.set.nx=6", "mesh.set.nz=6")
        for row in self.table():
            run = json.loads((self.folder / "out" / row["run"] / "run.json").read_text())
            self.assertEqual(run["model"]["contact_nodes"], 7)
            self.assertTrue((self.folder / "out" / row["run"] / "history.h5").exists())

    def test_wrong_studies(self):
        for old, new, message in [
                ("[0.003, 0.006]", "[0.003, -1]", r":7:26: load\.pressure: found `-1`; allowed: a number >= 0"),
                ("load.pressure", "load.presure", r":7:3: load\.presure: unknown key; did you mean `load\.pressure`"),
                ("0.5 *", "0.5 +* 2", r":4:\d+: mesh\.set\.height: `\* 2 mesh"),
                ("fig1.yaml", "fig9.yaml", r"fig9\.yaml: No such file"),
                ("vary:", "vary", r"not YAML|study\.yaml:\d+:\d+")]:
            with self.subTest(new):
                done = self.sweep(study=self.study(STUDY.replace(old, new)), status=2)
                self.assertRegex(done.stderr, message)
                self.assertFalse((self.folder / "out").exists())

    def test_paths_that_run_json_lacks(self):
        """Known with the first point that is done: the rest is not computed for an empty column."""
        for words, message in [
                ("record: [mu_M, results.mu_maxx]", r":9:16: record: run\.json has no `results\.mu_maxx`\n"),
                ("rank: {by: results.drops.men}", r":9:12: by: .*`results\.drops\.men`\n"),
                ("plot: {x: load.pressure, y: result.mu_M}", r":9:29: y: .*`result\.mu_M`\n"),
                ("record: [results.peaks.0.mmu]", r"run\.json has no `results\.peaks\.0\.mmu`\n"),
                ("record: [zz.zz]", r"run\.json has no `zz\.zz`\n"),
                ("record: [results.drops]", r"record: `results\.drops` of run\.json has many values: name one")]:
            with self.subTest(words):
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                done = self.sweep("-j", "1", study=self.study(STUDY + words + "\n"), status=2)
                self.assertRegex(done.stderr, message)
                self.assertEqual(len(list((self.folder / "out/points").glob("*/run.json"))), 1)
                again = self.sweep("-j", "1", study=self.study(STUDY + words + "\n"), status=2)   # nor when it is known before
                self.assertRegex(again.stderr, message)
        # What a run may have and these have not is no mistake.
        self.sweep(study=self.study(STUDY + "record: [results.peaks.99.mu, scene.rod.kind, results.pads.7.l_c]\n"))
        self.assertEqual([row["scene.rod.kind"] for row in self.table()], ["push", "bonded"] * 4)

    def test_wrong_words(self):
        for words, message in [((), "needs a study"), (("a", "b"), "one study"), (("a", "-j", "0"), "-j 0"),
                               (("a", "-j", "x"), "-j x"), (("a", "-o", ""), "no name")]:
            done = self.call("sweep", *words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(message, done.stderr)

    def test_no_slurm(self):
        done = subprocess.run([PROGRAM, "sweep", self.study(), "-o", self.folder / "out", "--slurm"], text=True,
                              capture_output=True, env={**self.place, "PATH": "/proc/none"}, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"--slurm needs Slurm's commands .* in PATH: cannot run `scontrol`: No such file")
        self.assertIn("8 points: 8 computed", self.sweep().stdout)   # nothing stands in the way

    def test_element_by_hand(self):
        """What Slurm's jobs call, without a Slurm: a share of one point, refused where the study has another."""
        (self.folder / "out/slurm").mkdir(parents=True)
        (self.folder / "out/slurm/share-3.points").write_text(f"5 {'0' * 32} 1 0\n")
        for index, message in [("", "that `amontons sweep --slurm` submits"), ("4", "out/slurm/share-4.points"),
                               ("3", "was changed after the sweep began")]:
            done = subprocess.run([PROGRAM, "sweep", "--element", "-o", self.folder / "out", "--set", "rod.velocity=9e-6", "--", self.study()],
                                  text=True, check=False, capture_output=True, env={**self.place, "SLURM_ARRAY_TASK_ID": index})
            self.assertEqual(done.returncode, 2)
            self.assertIn(message, done.stderr)
        self.assertEqual(len(list(self.folder.glob("out/**/run.json"))), 0)   # the sweep records why

    def test_help_names_all_records(self):
        text = re.sub(r"\s+", " ", self.call("sweep", "--help").stdout)
        names = re.findall(r'\{"(\w+)", "[\w.]+", (?:true|false)\}', (SOURCE / "src/study/sweep/reading/study_wanted.c").read_text())
        self.assertGreater(len(names), 15)
        for name in names:
            self.assertRegex(text, rf"\b{name}\b")

    def test_quiet_and_lines(self):
        done = self.sweep("--quiet")
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        done = self.sweep("--fresh")
        self.assertEqual(len(re.findall(r"^ \d/8 .*mesh\.set\.length=\d load\.pressure=0\.00\d rod\.kind=\w+.* mu_M .*left\)$",
                                        done.stderr, re.M)), 8)


if __name__ == "__main__":
    unittest.main()
