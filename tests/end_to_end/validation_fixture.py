# SPDX-License-Identifier: GPL-2.0-or-later
"""The quick part of validation/run, group by group, for tests that may run side by side."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "validation"))
from harness import schemes  # noqa: E402, F401


class Report(unittest.TestCase):
    def run_groups(self, *groups):
        """The report of these groups, in which nothing failed and no mistake was missed."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([SOURCE / "validation/run", "--quick", "-o", folder, *groups],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            text = (Path(folder) / "report.md").read_text()
            self.assertNotIn("FAIL", text)
            self.assertNotIn("MISSED", text)
            if "(charts.png)" in text:
                self.assertEqual((Path(folder) / "charts.png").read_bytes()[:4], b"\x89PNG")
            return text
