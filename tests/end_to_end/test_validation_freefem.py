# SPDX-License-Identifier: GPL-2.0-or-later
"""The quick part of the validation against FreeFem++, which is really executed."""
import unittest

from validation_fixture import Report


class FreeFem(Report):
    def test_freefem(self):
        text = self.run_groups("freefem")
        self.assertGreaterEqual(text.count("| pass |"), 40)
        self.assertGreaterEqual(text.count("| caught |"), 6)
        self.assertEqual(text.count("| nothing broke |"), 1)


if __name__ == "__main__":
    unittest.main()
