# SPDX-License-Identifier: GPL-2.0-or-later
"""The quick part of the stress matrix: each extreme ends in a right answer or an honest refusal;
and the matrix is seen to notice what is wrong."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

FOLDER = Path(os.environ["AMONTONS_SOURCE"], "validation", "benchmark")
sys.path.insert(0, str(FOLDER))
CPU = 20 * int(os.environ.get("AMONTONS_PATIENCE", "1"))   # seconds of a case; they take 2, sanitizers ten times as long
import measured_run  # noqa: E402
import stress  # noqa: E402
import stress_cases  # noqa: E402
from measured_run import run  # noqa: E402


class Stress(unittest.TestCase):
    def test_quick_matrix(self):
        with tempfile.TemporaryDirectory() as folder:
            ended = subprocess.run([sys.executable, FOLDER / "stress.py", "--quick", "--cpu", str(CPU),
                                    "-o", folder], capture_output=True, text=True)
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
            table = Path(folder, "stress.csv").read_text().splitlines()
        self.assertEqual(len(table), 1 + len(stress_cases.listed(True)))

    def test_without_a_build(self):
        """The whole benchmark says so in one line."""
        for words in (["run", "--quick"], ["stress.py"]):
            ended = subprocess.run([sys.executable, FOLDER / words[0], *words[1:]], capture_output=True, text=True,
                                   env={**os.environ, "AMONTONS_BIN": "/proc/none"})
            self.assertEqual((ended.returncode, ended.stderr),
                             (1, "/proc/none/amontons is not built: `./amontons run --help` builds it\n"))

    def judged(self, case, cpu_limit=CPU):
        word, faults, _ = stress.judge(case, run(stress.SCENE, case.settings, cpu_limit), cpu_limit)
        return word, faults

    def test_a_wrong_answer_is_noticed(self):
        """Without the certificate large steps hide the runaway; the twin does not."""
        settings = ["time.certificate=false", "time.tolerance=1", "time.energy_tolerance=1"]
        case = stress_cases.Case("broken", "steps not certified", settings, twin=["title=usual"])
        word, faults = self.judged(case)
        self.assertEqual(word, "done")
        self.assertTrue(faults and "twin" in faults[0], faults)

    def test_an_endless_run_is_noticed(self):
        case = stress_cases.Case("broken", "1e-6 v_c", ["rod.velocity=3.4e-10", "time.watch=0"])
        self.assertEqual(self.judged(case, 1)[0], "no end")

    def test_a_refusal_is_noticed(self):
        case = stress_cases.Case("broken", "refused", ["friction.mu_static=-1"])
        word, faults = self.judged(case)
        self.assertEqual((word, faults), ("refused", ["should have been computed"]))

    def test_table_names_files_of_the_project(self):
        """... relative to it, whatever machine the table is made on."""
        said = run(stress.SCENE, ["groups.rod=leading"]).said
        self.assertIn("error: validation/benchmark/stress.yaml: rod.kind: push", said)

    def test_missing_and_needless_warnings(self):
        """Said in run.json and on standard error where viscosity cannot bear the weakening."""
        thin = run(stress.SCENE, ["material.eta1=0.01", "material.eta2=0.01"], CPU)
        self.assertIn("amontons: warning: slip is not resolved: friction weakens faster", thin.said)
        self.assertIn("of 17 contact nodes", thin.report["warnings"][0])
        none = run(stress.SCENE, ["material.eta1=0"], CPU)
        self.assertIn("ill-posed", none.said)
        usual = run(stress.SCENE, [], CPU)
        self.assertEqual((usual.said, usual.report["warnings"]), ("", []))

    def test_version_without_git(self):
        """A source archive has no repository, a bare system no git."""
        version = r"^amontons \d+\.\d+\.\d+( \([\w-]+(, changed)?\))?$"
        with tempfile.TemporaryDirectory() as empty:
            with mock.patch.dict(os.environ, PATH=empty):
                self.assertRegex(measured_run.commit(), version)
            with mock.patch.object(measured_run, "ROOT", Path(empty)):
                self.assertRegex(measured_run.commit(), version)


if __name__ == "__main__":
    unittest.main()
