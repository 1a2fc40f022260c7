# SPDX-License-Identifier: GPL-2.0-or-later
"""The quick part of the validation against exact solutions."""
import unittest

from validation_fixture import Report, schemes


class Exact(Report):
    def test_exact(self):
        text = self.run_groups("bulk", "rubber", "speeds", "statics", "instability", "growth", "impact",
                               "orders")
        self.assertGreaterEqual(text.count("| pass |"), 100)
        self.assertGreaterEqual(text.count("| caught |"), 21)
        self.assertIn("(charts.png)", text)
        for scheme in schemes():
            self.assertIn(f"| {scheme}, stick-slip", text)


if __name__ == "__main__":
    unittest.main()
