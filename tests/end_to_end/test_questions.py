# SPDX-License-Identifier: GPL-2.0-or-later
"""validation/questions: the scene of every point of its studies is accepted, and the page says what its template says."""
import ctypes
import os
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

from sanitizer_fixture import begin_again_with

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BIN = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin"))
sys.path.insert(0, str(BIN.resolve().parent / "python"))
begin_again_with(BIN / "libamontons.so")
from amontons import _structs as structs            # noqa: E402
from amontons._library import c_text, lib           # noqa: E402

QUESTIONS = SOURCE / "validation" / "questions"


class Questions(unittest.TestCase):
    def plan(self, study):
        """How many points a sweep has. It is told to stop before it begins, when all their scenes have been read."""
        folder = tempfile.mkdtemp(prefix="amontons-questions-")
        self.addCleanup(shutil.rmtree, folder)
        error, summary = structs.Error(), structs.SweepSummary()
        options = structs.SweepOptions(folder=c_text(folder), stop=ctypes.pointer(ctypes.c_int(1)))
        lib.amontons_sweep(c_text(study), ctypes.byref(options), ctypes.byref(summary), ctypes.byref(error))
        self.assertIn(b"stopped", error.message, study)
        self.assertEqual((summary.computed, summary.failed), (0, 0), study)
        return summary.pending

    def test_scenes_are_accepted(self):
        script = (QUESTIONS / "questions.py").read_text(encoding="utf-8")
        studies = sorted(QUESTIONS.glob("*.yaml"))
        self.assertGreater(len(studies), 10)
        for study in studies:
            self.assertIn(f'"{study.stem}"', script)
            self.assertGreater(self.plan(study), 2, study)

    def test_page_is_its_template_filled_in(self):
        """Words are changed in page.in, and numbers by questions.py alone."""
        template, page = (" ".join((QUESTIONS / name).read_text(encoding="utf-8").split()) for name in ("page.in", "README.md"))
        pattern = "(.+?)".join(re.escape(part) for part in re.split(r"\[\[[^]]+\]\]", template))
        self.assertTrue(re.fullmatch(pattern, page), "run validation/questions/questions.py")


if __name__ == "__main__":
    unittest.main()
