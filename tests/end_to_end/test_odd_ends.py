# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers, limits and plug-ins that once ended the program, or let it end well with nothing."""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
sys.path.insert(0, str(SOURCE / "validation/hostile"))
import cases  # noqa: E402
from preload_fixture import preload  # noqa: E402
from sanitizer_fixture import runtime as sanitizer_runtime  # noqa: E402

PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
PATIENCE = 60 * float(os.environ.get("AMONTONS_PATIENCE", 1))
FIT = ("scene: scene.yaml\nset: {time.until: {U: 0.004}, output.history: false}\nsearch: {material.young: {log: [0.8, 1.2]}}\n"
       "fit: {measured: measured.csv, designs: 4}\n")
PLUGIN = """#include <stdlib.h>
#include "amontons_friction.h"
const char amontons_friction_far[40000] = {1};   // code lies pages behind the file's begin
int amontons_friction_interface(void) { return 1; }
double amontons_friction_coefficient(const AmontonsFriction *given, double speed)
{ static int calls; if (++calls > 300) exit(0); (void)given; (void)speed; return 0.3; }
double amontons_friction_slope(const AmontonsFriction *given, double speed) { (void)given; (void)speed; return 0; }
"""
# HDF5 as it is with a file that it crashes on.
CRASHES = "#include <signal.h>\nlong H5Fopen(const char *name, unsigned flags, long access) { (void)name, (void)flags, (void)access; return raise(SIGSEGV); }\n"
PLOT = """x: {label: x}
y: {label: y}
series: [{label: mu, x: "out/history.h5:series/time", y: "out/history.h5:series/mu"}]
"""
AT_ONCE = "#include <stdlib.h>\n__attribute__((constructor)) static void go(void) { exit(0); }\n"


class OddEnds(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons_odd_"))
        self.addCleanup(shutil.rmtree, self.folder)
        cases.put(self.folder, {"scene.yaml": cases.SCENE, "block.geo": cases.ROOT / "meshes/block.geo", "fit.yaml": FIT})

    def call(self, *words, **environment):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, env=os.environ | {"AMONTONS_CACHE": ""} | environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=PATIENCE)
        return done.returncode, done.stdout

    def test_measured_beyond_all_measure(self):
        for value, error, words in (("1e155", "0.05", "at most 1e+30"), ("-1e300", "1", "at most"), ("0.35", "1e-200", "so many digits"),
                                    ("0.35", "1e300", "at most"), ("0", "1e-300", "so many digits")):
            (self.folder / "measured.csv").write_text(f"load.pressure,mu_max,mu_max_error\n0.003,{value},{error}\n")
            status, said = self.call("fit", "fit.yaml", "-o", "fitted", "-q")
            self.assertEqual(status, 2, said)
            self.assertIn("measured.csv", said)
            self.assertIn(words, said)

    def test_a_bar_that_is_cut_in_its_first_run(self):
        status, said = self.call("run", "scene.yaml", "-o", "out", "--to", "1%", "--within", "0.05s", "--set", "time.until.U=0.01")
        self.assertEqual(status, 0, said)
        self.assertIn("its first run was cut short", said)
        self.assertNotIn("contact nodes, at pressures", said)

    def test_a_run_that_fails_before_its_first_step(self):
        """Has no answer and no error: neither is 0."""
        failing = ("--set", "time.step_min=1e3", "-q")
        self.assertEqual(self.call("run", "scene.yaml", "-o", "out", *failing)[0], 1)
        report = json.loads((self.folder / "out/run.json").read_text())
        self.assertEqual(report["status"], "failed")
        results = report["results"]
        for name in ("mu_M", "mu_M_error", "mu_M_known_to", "mu_hold", "mu_hold_error", "mu_max", "mu_max_known_to", "mu_steady", "mu_steady_error",
                     "mu_first_pad"):
            self.assertIsNone(results[name], name)
        self.assertEqual(results["mu_M_is"], "none: the run failed before its first step")
        self.assertFalse(results["run_in"]["over"])
        self.assertEqual(set(report["errors"].values()), {None})
        (self.folder / "study.yaml").write_text("scene: scene.yaml\nvary: {time.step_min: [1e3]}\nrecord: [mu_M, mu_hold, mu_max]\n")
        self.call("sweep", "study.yaml", "-o", "swept", "-q")
        with open(self.folder / "swept/sweep.csv", newline="") as file:
            row, = csv.DictReader(file)
        self.assertEqual([row[name] for name in ("mu_M", "mu_hold", "mu_max", "status")], ["", "", "", "failed"])

    def test_little_address_space(self):
        """OpenBLAS waits for ever for the buffer of a thread that cannot have one: no such thread is made."""
        for kilobytes in (195000, 215000, 240000, 280000, 350000):
            said = self.call_bash(f'ulimit -v {kilobytes}; exec "$0" run scene.yaml -o out --overwrite -q --set reduction.use=always')
            self.assertIn(said[0], (0, 1), said)

    def test_a_ledger_that_does_not_close(self):
        """Is laid to an ill-posed problem only where the run was warned of that, not of something else."""
        for setting, ill in (("contact={gap: 0.3 * abs(x - 0.5)}", False), ("material.eta1=0", True)):
            status, said = self.call("run", "scene.yaml", "-o", "out", "--overwrite", "-q", "--set", setting, "time.energy_tolerance=1e-15")
            self.assertEqual(status, 1, said)
            self.assertIn("warning", said)
            self.assertIn("the energy ledger does not close", said)
            self.assertEqual("the problem is ill-posed" in said, ill, said)

    def call_bash(self, command):
        done = subprocess.run(["bash", "-c", command, PROGRAM], cwd=self.folder, env=os.environ | {"AMONTONS_CACHE": ""}, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=PATIENCE)
        return done.returncode, done.stdout

    def build(self, name, text):
        (self.folder / f"{name}.c").write_text(text)
        subprocess.run(["cc", "-shared", "-fPIC", f"-I{SOURCE / 'src'}", f"{name}.c", "-o", f"{name}.so"], cwd=self.folder, check=True)

    def test_plug_ins_that_end_the_program(self):
        self.build("exits", PLUGIN)
        self.build("at_once", AT_ONCE)
        (self.folder / "cut.so").write_bytes((self.folder / "exits.so").read_bytes()[:20000])
        for name, wanted, words in (("exits", 1, "ended the program in the middle of its work"), ("cut", 2, "cut.so"), ("at_once", 2, "at_once.so")):
            status, said = self.call("run", "scene.yaml", "-o", name, "-q", "--trust", "--set",
                                     f"friction={{law: plugin, file: {name}.so, mu_static: 0.3}}", "output.history=false")
            self.assertEqual(status, wanted, said)
            self.assertIn(words, said)
            self.assertFalse((self.folder / name / "amontons.lock").exists())

    @unittest.skipIf(sanitizer_runtime(PROGRAM), "a library before the sanitizer's")
    def test_histories_that_crash_hdf5(self):
        """Are read in a child process first, also where a plot file names one and where a run goes on with one."""
        few = ("--set", "output.figures=[]", "output.fields=none")
        self.assertEqual(self.call("run", "scene.yaml", "-o", "out", "-q", *few, "time.until.U=0.0005")[0], 0)
        self.build("crashes", CRASHES)
        (self.folder / "plot.yaml").write_text(PLOT)
        self.assertEqual(self.call("render", "plot.yaml")[0], 0)
        before = (self.folder / "out/history.h5").read_bytes()
        crashing = preload(self.folder / "crashes.so")
        for words, path in ((("render", "plot.yaml", "--overwrite"), "plot.yaml"),
                            (("run", "scene.yaml", "-o", "out", "-q", *few, "time.until.U=0.0006", "--resume"), "out")):
            status, said = self.call(*words, **crashing)
            self.assertEqual(status, 2, said)
            self.assertIn(f"{path}: HDF5 crashes while reading it", said)
        self.assertEqual((self.folder / "out/history.h5").read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
