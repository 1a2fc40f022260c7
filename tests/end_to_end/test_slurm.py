# SPDX-License-Identifier: GPL-2.0-or-later
"""`amontons sweep --slurm` on a real Slurm of one node: tables against the pool's, ended elements, Ctrl-C, kills."""
import csv
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from slurm_fixture import Slurm

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
TIMES = ("solve_s", "total_s")   # of the machine, not of the study
STUDY = f"""
title: test
scene: {SOURCE}/validation/paper/fig1.yaml
set: {{mesh.set.nx: 10, mesh.set.nz: 10, rod.height: 0, rod.width: 0}}
vary:
  load.pressure: [0.003, 0.004, 0.006]
  rod.kind: [push, bonded]
rank: {{by: mu_M}}
"""
FAILING = STUDY.replace("vary:", "cases: [{groups.top: top}, {groups.top: roof}]\nvary:")
TABLE = STUDY.replace("set: {", "keep: table\nset: {time.until.U: 1e-7, ").replace(
    "[0.003, 0.004, 0.006]", "{log: [0.003, 0.006], points: 30}")
ENDLESS = STUDY.replace("set: {", "cases: [{}, {mesh.set.nx: 96, mesh.set.nz: 96, time.tolerance: 1e-12}]\nset: {")


class Sweep(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        reason = Slurm.missing()
        if reason:
            raise unittest.SkipTest(f"no Slurm: {reason}")
        cls.slurm = Slurm(array_size=9)   # eight elements an array: of twelve points four compute two
        cls.addClassCleanup(cls.slurm.stop)
        reason = cls.slurm.start()
        if reason:
            raise unittest.SkipTest(reason)
        # One cache, filled: the basis that the first point of a shape leaves is that of all others.
        cls.cache = tempfile.mkdtemp(prefix="amontons-cache-")
        cls.addClassCleanup(shutil.rmtree, cls.cache)
        (Path(cls.cache) / "study.yaml").write_text(STUDY)
        subprocess.run([PROGRAM, "sweep", "study.yaml", "-j", "1", "--quiet"], cwd=cls.cache, check=True,
                       env={**os.environ, "AMONTONS_CACHE": cls.cache})

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons it's a sweep-"))   # a shell would stumble over it
        self.addCleanup(shutil.rmtree, self.folder)
        for state in ("PENDING", "RUNNING"):
            self.addCleanup(self.slurm.call, "scancel", f"--state={state}")
        self.place = {**self.slurm.environment, "AMONTONS_CACHE": self.cache}
        self.study(STUDY)

    def study(self, text):
        (self.folder / "study.yaml").write_text(text)

    def start(self, *words, out="out"):
        process = subprocess.Popen([PROGRAM, "sweep", "study.yaml", "-o", out, *words], cwd=self.folder, env=self.place,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def sweep(self, *words, out="out", status=0):
        process = self.start(*words, out=out)
        stdout, stderr = process.communicate(timeout=200)
        self.assertEqual(process.returncode, status, stderr)
        return stdout, stderr

    def table(self, out="out"):
        with open(self.folder / out / "sweep.csv", newline="") as file:
            return [{key: value for key, value in row.items() if key not in TIMES} for row in csv.DictReader(file)]

    def elements(self, *states):
        """(job, index) of the elements in one of the states."""
        lines = self.slurm.call("squeue", "-h", "-r", "-t", ",".join(states), "-o", "%F %K").stdout.split("\n")
        return [tuple(line.split()) for line in lines if line]

    def at_work(self):
        """The processes of this sweep's elements, by their index; not their children, which read a mesh."""
        found = {}
        for process in sorted(Path("/proc").glob("[0-9]*"), key=lambda path: int(path.name), reverse=True):
            try:
                words = (process / "cmdline").read_text().split("\0")
                variables = dict(line.split("=", 1) for line in (process / "environ").read_text().split("\0") if "=" in line)
            except (OSError, UnicodeDecodeError):   # gone, or not ours
                continue
            if "--element" in words and any(str(self.folder) in word for word in words):
                found[variables["SLURM_ARRAY_TASK_ID"]] = int(process.name)
        return found

    def wait(self, condition):
        end = time.monotonic() + 60
        while not condition():
            self.assertLess(time.monotonic(), end, "waited for a minute")
            time.sleep(0.1)

    def held(self, *words):
        """A sweep whose six elements wait to be released."""
        process = self.start("--slurm=--hold", *words)
        self.wait(lambda: len(self.elements("PENDING")) == 6)
        return process

    def release(self):
        for job in {job for job, _ in self.elements("PENDING")}:
            self.slurm.call("scontrol", "release", job)

    def test_table_and_lines_are_the_pools(self):
        self.study(FAILING)
        pool = self.sweep("-j", "2", "--set", "rod.velocity=9e-6", out="pool", status=1)
        slurm = self.sweep("--slurm", "--set", "rod.velocity=9e-6", status=1)
        self.assertEqual(self.table("pool"), self.table())
        self.assertEqual((self.folder / "pool/ranking.csv").read_bytes(), (self.folder / "out/ranking.csv").read_bytes())
        self.assertIn("has no group 'roof'", self.table()[6]["message"])
        self.assertRegex(slurm[1], r"(?m)^12/12  groups.top=\w+ load.pressure=0.00\d rod.kind=\w+ +(mu_M|FAILED)")
        self.assertEqual(pool[0].split("mu_M, highest")[1], slurm[0].split("mu_M, highest")[1])
        shares = [len(path.read_text().splitlines()) for path in (self.folder / "out/slurm").glob("share-*.points")]
        self.assertEqual(sorted(shares), [1] * 4 + [2] * 4)
        self.assertIn("12 points: 0 computed", self.sweep("--slurm", "--set", "rod.velocity=9e-6", status=1)[0])
        self.assertFalse((self.folder / "out/slurm/running").exists())

    def test_a_search(self):
        """Elements are told of designs that stand in no file; the course is that of processes here."""
        self.study(STUDY[:STUDY.index("vary:")] + "search: {load.pressure: {log: [0.003, 0.006]}}\nrank: {by: mu_max}\n"
                   "best: {designs: 3}\n")
        for words in (["-o", "pool"], ["-o", "out", "--slurm"]):
            done = subprocess.run([PROGRAM, "optimise", "study.yaml", "-j", "2", "--set", "time.until.U=0.003", *words], cwd=self.folder,
                                  env=self.place, capture_output=True, text=True, timeout=200)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.table("pool"), self.table())
        self.assertGreater(len(list((self.folder / "out/slurm").glob("*.out"))), 4)

    def test_a_fit(self):
        """Designs at each of two conditions that were measured; the same numbers as by processes here."""
        self.study(STUDY[:STUDY.index("vary:")].replace("set: {", "set: {time.until.U: 0.003, ") +
                   "search: {friction.mu_static: {linear: [0.3, 0.5]}}\nfit: {measured: measured.csv, designs: 4}\n")
        (self.folder / "measured.csv").write_text("load.pressure,mu_max,mu_max_error\n0.003,0.38,0.02\n0.006,0.34,0.02\n")
        for words in (["-o", "pool"], ["-o", "out", "--slurm"]):
            done = subprocess.run([PROGRAM, "fit", "study.yaml", "-j", "2", *words], cwd=self.folder, env=self.place, capture_output=True,
                                  text=True, timeout=200)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.table("pool"), self.table())
        self.assertEqual((self.folder / "pool/fit.csv").read_text(), (self.folder / "out/fit.csv").read_text())
        self.assertGreater(len(list((self.folder / "out/slurm").glob("*.out"))), 7)

    def test_cancelled_element(self):
        process = self.held()
        job, index = self.elements("PENDING")[3]
        self.slurm.call("scancel", f"{job}_{index}")
        self.release()
        process.communicate(timeout=100)
        self.assertEqual(process.returncode, 1)
        rows = self.table()
        failed = [row for row in rows if row["status"] == "failed"]
        self.assertEqual(len(failed), 1)
        self.assertRegex(failed[0]["message"], r"left the queue .* PENDING \(JobHeldUser\): cancelled before it began")
        self.assertEqual([row["status"] for row in rows].count("done"), 5)
        self.assertIn("6 points: 0 computed", self.sweep("--slurm", status=1)[0])
        self.assertIn("6 points: 1 computed", self.sweep("--slurm", "--retry")[0])
        self.sweep(out="pool")
        self.assertEqual(self.table("pool"), self.table())

    def test_crashing_element(self):
        """A process that dies by a signal, and one that is cancelled at work, cost their own points only."""
        self.study(ENDLESS.replace("[0.003, 0.004, 0.006]", "[0.003]"))
        process = self.start("--slurm")
        points = self.folder / "out/points"
        self.wait(lambda: len(list(points.glob("*/run.json"))) == 2 and len(self.at_work()) == 2)
        (job, first), (_, second) = sorted(self.elements("RUNNING"))
        os.kill(self.at_work()[first], signal.SIGSEGV)
        self.assertEqual(self.slurm.call("scancel", f"{job}_{second}").returncode, 0)
        process.communicate(timeout=100)
        rows = self.table()
        self.assertEqual([row["status"] for row in rows], ["done"] * 2 + ["failed"] * 2)
        self.assertRegex(rows[2]["message"], r"the Slurm job ended as FAILED by signal 11 \(Segmentation fault\)")
        self.assertRegex(rows[3]["message"], "the Slurm job ended as CANCELLED")

    def test_interrupted_and_resumed(self):
        process = self.held()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=100)
        self.assertEqual(process.returncode, 1)
        self.assertIn("interrupted", errors)
        self.assertEqual(self.elements("PENDING", "RUNNING"), [])
        self.assertEqual([row["status"] for row in self.table()], ["pending"] * 6)
        self.assertIn("6 points: 6 computed", self.sweep("--slurm", "-j", "1")[0])
        self.sweep(out="pool")
        self.assertEqual(self.table("pool"), self.table())

    def test_killed_and_resumed(self):
        """What a killed sweep leaves to Slurm is cancelled by the next one, whichever way that computes."""
        process = self.held()
        process.kill()
        process.wait()
        self.assertEqual(len(self.elements("PENDING")), 6)
        self.assertIn("6 points: 6 computed", self.sweep("-j", "2")[0])
        self.assertEqual(self.elements("PENDING", "RUNNING"), [])

    def test_changed_study(self):
        """An element computes what was asked when the sweep began, or nothing."""
        process = self.held()
        self.study(STUDY.replace("0.003", "0.0031"))
        self.release()
        process.communicate(timeout=100)
        rows = self.table()
        self.assertEqual([row["status"] for row in rows], ["failed"] * 2 + ["done"] * 4)
        self.assertIn("was changed after the sweep began", rows[0]["message"])

    def test_shares(self):
        """Without folders of points an element computes many; what it has done stays when it is killed."""
        self.study(TABLE)
        process = self.start("--slurm=--hold", "-j", "2")
        self.wait(lambda: len(self.elements("PENDING")) == 2)
        lists = [path.read_text().split("\n")[:-1] for path in sorted((self.folder / "out/slurm").glob("share-*.points"))]
        numbers = [[int(line.split()[0]) for line in lines] for lines in lists]
        self.assertEqual(sorted(sum(numbers, [])), [k for k in range(60) if k % 4])   # each fourth was tried before
        self.assertEqual([len(share) for share in numbers], [23, 22])
        job, index = self.elements("PENDING")[0]
        self.slurm.call("scancel", f"{job}_{index}")
        self.release()
        _, errors = process.communicate(timeout=100)
        self.assertEqual(process.returncode, 1)
        self.assertRegex(errors, "2[23] points are not computed, the same command goes on: .*cancelled before it began")
        waiting = [int(row["point"]) for row in self.table() if row["status"] == "pending"]
        self.assertEqual(waiting, sorted(numbers[int(index)]))
        self.assertRegex(self.sweep("--slurm")[0], f"60 points: {len(waiting)} computed")
        self.sweep(out="pool")
        self.assertEqual(self.table("pool"), self.table())
        left = {path.name for path in self.folder.glob("out/**/*")} - {path.name for path in self.folder.glob("out/slurm/*")}
        self.assertEqual(left, {"amontons.files", "reports", "slurm", "sweep.csv", "sweep.h5", "ranking.csv"})
        self.assertEqual(list((self.folder / "out/slurm").glob("share-*")), [])

    def test_killed_with_shares(self):
        """What elements had done when the sweep was killed is found by the next one."""
        self.study(TABLE.replace("1e-7", "0.006"))
        process = self.start("--slurm", "-j", "1")
        share = self.folder / "out/slurm/share-0.reports"
        self.wait(lambda: share.exists() and share.read_bytes().count(b"\n") > 2)
        process.kill()
        process.wait()
        self.wait(lambda: share.read_bytes().count(b"\n") > 4)   # it goes on without the sweep
        found = self.sweep("-j", "2")[0]
        self.assertGreaterEqual(int(re.search(r"(\d+) computed before", found)[1]), 15 + 5)
        self.assertEqual(list((self.folder / "out/slurm").glob("share-*")), [])

    def test_refusals(self):
        _, errors = self.sweep("--slurm=--partition=none", status=1)
        self.assertRegex(errors, "sbatch refuses the array: .*invalid partition")
        self.assertFalse((self.folder / "out/slurm/running").exists())
        _, errors = self.sweep("--slurm=$(touch no)", status=2)
        self.assertIn("expected options of sbatch", errors)


if __name__ == "__main__":
    unittest.main()
