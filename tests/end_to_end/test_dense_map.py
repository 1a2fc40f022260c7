# SPDX-License-Identifier: GPL-2.0-or-later
"""Marks of a map whose cells are smaller than marks: some stand for those around them, and colours are seen between them."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
from PIL import Image

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"


class DenseMap(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-map-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def picture(self, count, is_open):
        """Of count x count points, all of one value, in the left half of which is_open; the part of pixels that are marked
        in its left and in its right half."""
        x, y = np.meshgrid(np.arange(count), np.arange(count))
        points = {"x": x, "y": y, "value": 0 * x + 1, "open": is_open & (x < count / 2)}
        panel = {"map": {key: np.asarray(values, int).ravel().tolist() for key, values in points.items()}}
        plot = {"x": {"label": "x"}, "y": {"label": "y"}, "color": {"label": "c", "range": [0, 2]}, "panels": [panel]}
        (self.folder / "map.json").write_text(json.dumps(plot))
        subprocess.run([PROGRAM, "render", "map.json", "--overwrite", "--width", "60", "--dpi", "600"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        pixels = np.asarray(Image.open(self.folder / "map.png").convert("RGB")).astype(int)
        height, width = pixels.shape[:2]
        inside = pixels[height // 4:height * 3 // 5, width // 5:width * 3 // 5]
        colours, counts = np.unique(inside.reshape(-1, 3), axis=0, return_counts=True)
        marked = np.abs(inside - colours[counts.argmax()]).sum(axis=2) > 30
        return marked[:, :100].mean(), marked[:, -100:].mean()

    def test_a_long_name_of_colours(self):
        """It gets smaller where it would leave the page: no ink within a point of its edges."""
        for words in ("c", "a formula of several results, longer than the map is high, of its own kind"):
            plot = {"x": {"label": "x"}, "y": {"label": "y"}, "color": {"label": words, "range": [0, 2]},
                    "panels": [{"map": {"x": [0, 1, 0, 1], "y": [0, 0, 1, 1], "value": [0, 1, 2, 1]}}]}
            (self.folder / "map.json").write_text(json.dumps(plot))
            subprocess.run([PROGRAM, "render", "map.json", "--overwrite", "--dpi", "144", "--height", "50"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
            pixels = np.asarray(Image.open(self.folder / "map.png").convert("L"))
            name = pixels[:, -24:]   # the last 12 points of the width
            self.assertTrue((name < 128).any(), "the name is there")
            self.assertTrue((name[:1] > 200).all() and (name[-1:] > 200).all(), f"{words[:20]} is cut off")

    def test_marks(self):
        doubtful, sure = self.picture(66, True)
        self.assertTrue(0.01 < doubtful < 0.12, doubtful)   # each its own: a fifth and more
        self.assertEqual(sure, 0)
        self.assertEqual(self.picture(66, False), (0, 0))
        doubtful, sure = self.picture(12, True)   # each has its own
        self.assertTrue(sure == 0 < doubtful < 0.2, (sure, doubtful))   # a cell is a run and needs no mark


if __name__ == "__main__":
    unittest.main()
