# SPDX-License-Identifier: GPL-2.0-or-later
"""The quick part of the validation in space."""
import unittest

from validation_fixture import Report


class Space(Report):
    def test_space(self):
        text = self.run_groups("space")
        self.assertGreaterEqual(text.count("| pass |"), 25)
        self.assertGreaterEqual(text.count("| caught |"), 4)
        for case in ("Hertz, sphere", "Cattaneo-Mindlin, sphere", "flat round punch", "a plate slides and turns", "weakening"):
            self.assertIn(f"| {case}" if case != "weakening" else case, text)


if __name__ == "__main__":
    unittest.main()
