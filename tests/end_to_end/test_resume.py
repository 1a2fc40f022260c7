# SPDX-License-Identifier: GPL-2.0-or-later
"""A run that was cut off goes on: stopped, killed, or out of disk; --extend; what is refused, and in which words. Compared
with a run left alone as validation/kills/kills.py does it, which also tries more kinds of runs and 200 kills."""
import fcntl
import importlib.util
import json
import os
import resource
import shutil
import signal
import subprocess
import threading
import time
import unittest
from pathlib import Path

from cache_fixture import OwnCache

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
FIG1 = SOURCE / "validation" / "paper" / "fig1.yaml"
PLAIN = ["--set", "mesh.set.nx=8", "mesh.set.nz=8", "output.fields=none", "output.figures=[]"]
END = 0.12      # of U: some tenths of a second

_found = importlib.util.spec_from_file_location("kills", SOURCE / "validation" / "kills" / "kills.py")
kills = importlib.util.module_from_spec(_found)
_found.loader.exec_module(kills)


class Resume(OwnCache):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for _ in range(2):      # the second time from the cache, as all that follow
            done = cls.run_scene("whole", f"time.until.U={END}", "--overwrite")
            assert done.returncode == 0, done.stderr
        cls.whole = cls.folder / "whole"

    @classmethod
    def words(cls, result, *words):
        return [PROGRAM, "run", FIG1, *PLAIN, *words, "-q", "-o", cls.folder / result]

    @classmethod
    def run_scene(cls, result, *words, **more):
        return subprocess.run(cls.words(result, *words), capture_output=True, text=True, timeout=60,
                              env=cls.environment, **more)

    def begin(self, result, *words):
        """Until it has its first checkpoint."""
        process = subprocess.Popen(self.words(result, *words, "--checkpoint", "0.02s"), stderr=subprocess.PIPE,
                                   text=True, env=self.environment)
        while not (self.folder / result / "checkpoint.bin").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.002)
        return process

    def expect(self, done, status, words=""):
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertIn(words, done.stderr)

    def expect_whole(self, result):
        self.assertEqual(kills.differences(self.whole, self.folder / result), [])

    def test_killed(self):
        process = self.begin("killed", f"time.until.U={END}")
        process.kill()
        process.communicate()
        self.assertEqual(process.returncode, -signal.SIGKILL)
        self.expect(self.run_scene("killed", f"time.until.U={END}"), 2, "go on with it (--resume)")
        self.expect(self.run_scene("killed", f"time.until.U={END}", "load.pressure=0.0031", "--resume"), 2,
                    "another scene or mesh")
        self.expect(self.run_scene("killed", f"time.until.U={END}", "--resume"), 0)
        self.expect_whole("killed")
        self.assertEqual(json.loads((self.folder / "killed" / "run.json").read_text())["resumed"], 1)

    def test_stopped_then_extended(self):
        """A run to a far end is stopped; its end is chosen anew, twice."""
        process = self.begin("stopped", "time.until.U=100")
        process.send_signal(signal.SIGTERM)
        _, shown = process.communicate()
        self.assertEqual(process.returncode, 1)
        self.assertIn("--resume goes on from there", shown)
        reached = float(shown.split("U = ")[1].split()[0])
        self.assertLess(reached, END)
        report = (self.folder / "stopped" / "run.json").read_bytes()
        self.expect(self.run_scene("stopped", "--extend", f"U={0.5 * reached}"), 2, "give a later end")
        self.assertEqual((self.folder / "stopped" / "run.json").read_bytes(), report)
        self.expect(self.run_scene("stopped", "--extend", f"U={END}"), 0)
        self.expect_whole("stopped")
        self.expect(self.run_scene("stopped", "--extend", f"U={END + 0.001}"), 0)
        extended = json.loads((self.folder / "stopped" / "run.json").read_text())
        self.assertEqual((extended["status"], extended["resumed"]), ("done", 2))
        rod = kills.arrays(self.folder / "stopped" / "history.h5")["series/rod_displacement"]
        self.assertGreater(rod[1][0], json.loads((self.whole / "run.json").read_text())["steps"]["accepted"] + 1)

    def test_error_bar_stopped(self):
        """It does not go on, says so, and keeps what its meshes gave."""
        process = subprocess.Popen([PROGRAM, "run", FIG1, *PLAIN, "time.until.U=0.06", "--to", "0.01%", "-o",
                                    self.folder / "bar"], stderr=subprocess.PIPE, text=True, env=self.environment)
        shown = ""
        while not shown.startswith("mesh 2:"):
            shown = process.stderr.readline()
            self.assertTrue(shown)
        process.send_signal(signal.SIGINT)
        _, shown = process.communicate()
        self.assertEqual(process.returncode, 1)
        self.assertRegex(shown, "stopped on mesh .* of an error bar; so far mu_M = 0.3.* the same command begins anew")
        kept = json.loads((self.folder / "bar" / "figures" / "accuracy.json").read_text())
        self.assertGreaterEqual(len(kept["series"][0]["x"]), 2)

    def test_disk_full(self):
        """As far as a file of 200 kB goes."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (200000, 200000))
        done = self.run_scene("full", f"time.until.U={END}", "--checkpoint", "0.01s", preexec_fn=limit)
        self.expect(done, 1, "history.h5.part: File too large")
        self.expect(self.run_scene("full", f"time.until.U={END}", "--resume"), 0)
        self.expect_whole("full")

    def test_history_of_another_shape(self):
        """Rows are copied from arrays that are as long as the run's own series are wide."""
        import h5py
        for name, width in (("interface/slip_rate", 1000000), ("interface/status", 3), ("pads/slip", 1000)):
            result = name.replace("/", "-")
            shutil.copytree(self.whole, self.folder / result)
            with h5py.File(self.folder / result / "history.h5", "r+") as file:
                rows, kind = file[name].shape[0], file[name].dtype
                del file[name]
                file.create_dataset(name, (rows, width), kind, maxshape=(None, width), chunks=(1, width))
            self.expect(self.run_scene(result, "--extend", f"U={END + 0.001}"), 2, f"{name} is not as this run writes it: it has {width} numbers")

    def test_misuse(self):
        for words, said in ((["--resume", "--overwrite"], "removes what"), (["--extend", "V=1"], "U=0.02 or t=500"),
                            (["--checkpoint", "soon"], "such as 30s"), (["--resume"], "no checkpoint.bin"),
                            (["--resume", "--to", "1%"], "several runs")):
            self.expect(self.run_scene("none", *words), 2, said)
        damaged = self.folder / "damaged"
        shutil.copytree(self.whole, damaged)
        state = bytearray((damaged / "checkpoint.bin").read_bytes())
        state[len(state) // 2] ^= 1
        (damaged / "checkpoint.bin").write_bytes(state)
        self.expect(self.run_scene("damaged", f"time.until.U={END}", "--resume"), 2, "checksum does not hold")
        self.expect_whole("damaged")

    def test_sweep(self):
        """A point whose process died goes on; another one, whose checkpoint is of no use, begins anew."""
        study = self.folder / "study.yaml"
        study.write_text(f"scene: {FIG1}\nset: {{mesh.set.nx: 8, mesh.set.nz: 8, time.until.U: {END},\n"
                         "  output.history: true, output.fields: none, output.figures: []}\n"
                         "vary: {load.pressure: [0.003, 0.0031]}\nrecord: [mu_M]\n")
        words = [PROGRAM, "sweep", study, "-j", "1", "-q", "-o", self.folder / "sweep"]
        subprocess.run(words, check=True, env=self.environment)
        table = (self.folder / "sweep" / "sweep.csv").read_text()
        first, second = (path.parent for path in (self.folder / "sweep" / "points").glob("*/run.json"))
        for point in (first, second):
            (point / "run.json").unlink()
        (second / "checkpoint.bin").write_bytes(b"")
        subprocess.run(words, check=True, env=self.environment)
        self.assertEqual((self.folder / "sweep" / "sweep.csv").read_text(), table)
        self.assertEqual([json.loads((point / "run.json").read_text())["resumed"] for point in (first, second)], [1, 0])
        (first / "run.json").unlink()
        lock = open(self.folder / "sweep" / "amontons.lock", "w")      # of points that die a moment after their sweep
        fcntl.flock(lock, fcntl.LOCK_EX)
        threading.Timer(0.2, lock.close).start()
        subprocess.run([*words, "--fresh"], check=True, env=self.environment)
        self.assertEqual(json.loads((first / "run.json").read_text())["resumed"], 0)


if __name__ == "__main__":
    unittest.main()
