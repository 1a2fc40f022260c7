# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of what friction remembers: the state map's colours are those of the states that were written, in powers of ten or
in numbers, the smallest in a pixel; its table; a film and the contact of a block in space by a state's name."""
import csv
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

import render_fixture as fixture
import test_film
import test_render as pictures
from test_render import Frame, bar_colors, invert, is_color, read_picture, render

SOURCE = os.environ["AMONTONS_SOURCE"]
NAMES = "psi\ntheta"
DIPS = (0.00212, 50)   # U, in a sliding, and node at which theta falls for one short step


def exponent(U, x):
    """Of theta: from -2 to 3."""
    return 4 * x - 2 + U / fixture.U_END


def remember(data, attributes):
    """psi = x - 1/2 at all times, theta of five decades; one step alone is a hundred times younger."""
    U, x = data["series/rod_displacement"], data["nodes/x"]
    theta = 10 ** exponent(U[:, None], x[None, :])
    row, node = np.searchsorted(U, DIPS[0]), DIPS[1]
    theta[row, node] /= 100
    data["interface/state"] = np.stack([np.tile(x - 0.5, (len(U), 1)), theta], axis=2)
    attributes["states"], attributes["state_unit"] = NAMES, "time"


class StatePictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="amontons_states_")
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.data, _ = fixture.make(cls.folder, change=remember)

    def map_of(self, picture, half):
        """Frame and bar of a panel, the upper or the lower half of the page."""
        middle = picture.shape[0] // 2
        part = picture[:middle] if half == 0 else picture[middle:]
        frame = Frame(part)
        ink = pictures.groups(is_color(part, pictures.INK).sum(axis=0) > 0.4 * part.shape[0])
        return part, frame, bar_colors(part, ink, frame)

    def test_colors(self):
        """A panel a state: theta in powers of ten, psi, which is below 0 in part, in numbers; frames below each other."""
        self.assertEqual(render(self.folder, "state-map"), (0, ""))
        picture = read_picture(self.folder, "state-map")
        frames = []
        for half, low, high in ((0, -0.6, 0.6), (1, -2, 3)):
            part, frame, bar = self.map_of(picture, half)
            frames.append((frame.left, frame.right))
            for share in (0.03, 0.3, 0.62, 0.9):
                for x in (0.1, 0.4, 0.7, 0.95):
                    seen = low + (high - low) * invert(part[frame.pixel(share, x)], bar)
                    wanted = x - 0.5 if half == 0 else exponent(share * fixture.U_END, x)
                    self.assertAlmostEqual(seen, wanted, delta=0.02 * (high - low), msg=(half, share, x))
        self.assertEqual(*frames)

    def test_smallest_in_a_pixel(self):
        """A dip of one step, far shorter than a column, is seen; where the largest is asked for it is not."""
        U, node = DIPS
        wanted = exponent(U, self.data["nodes/x"][node])
        for pixels, dip in ((None, 2), (b"largest", 0)):
            self.assertEqual(render(self.folder, "state-map", pixels=pixels), (0, ""))
            part, frame, bar = self.map_of(read_picture(self.folder, "state-map"), 1)
            row, column = frame.pixel(U / fixture.U_END, self.data["nodes/x"][node])
            seen = min(-2 + 5 * invert(part[row, k], bar) for k in range(column - 4, column + 5))
            self.assertAlmostEqual(seen, wanted - dip, delta=0.1, msg=pixels)

    def test_table(self):
        self.assertEqual(render(self.folder, "state-map"), (0, ""))
        with open(Path(self.folder, "figures/state-map.csv")) as file:
            head, *rows = csv.reader(file)
        self.assertEqual(head, ["U", "t", *(f"{what} {name}" for name in ("psi", "theta") for what in ("least", "median", "largest"))])
        theta = self.data["interface/state"][:, :, 1]
        wanted = np.stack([theta.min(axis=1), np.median(theta, axis=1), theta.max(axis=1)], axis=1)
        np.testing.assert_allclose(np.array(rows, float)[:, 5:], wanted, rtol=1e-5)

    def test_limits_and_panels(self):
        self.assertEqual(render(self.folder, panels=b"slip-map,state-map"), (0, ""))
        self.assertEqual(render(self.folder, "state-map", limits=b"1,100"), (0, ""))
        part, frame, bar = self.map_of(read_picture(self.folder, "state-map"), 1)
        self.assertAlmostEqual(2 * invert(part[frame.pixel(0.3, 0.8)], bar), exponent(0.3 * fixture.U_END, 0.8), delta=0.05)

    def test_without_states(self):
        """Not drawn unless asked for, and then refused in words."""
        folder = tempfile.mkdtemp(prefix="amontons_states_")
        self.addCleanup(shutil.rmtree, folder)
        fixture.make(folder)
        self.assertEqual(render(folder), (0, ""))
        self.assertFalse(Path(folder, "figures/state-map.png").exists())
        code, said = render(folder, "state-map")
        self.assertEqual(code, pictures.ERROR_INPUT)
        self.assertIn("remembers nothing", said)
        fixture.make(self.folder + "/all", change=remember)
        self.assertEqual(render(self.folder + "/all"), (0, ""))
        self.assertTrue(Path(self.folder, "all/figures/state-map.png").exists())

    def test_film(self):
        """As high as the logarithm of theta along the contact, now."""
        result = Path(self.folder, "filmed")

        def aged(data, attributes):
            remember(data, attributes)
            data["interface/state"] = data["interface/state"][:, :, 1:]
            attributes["states"] = "theta"
        fixture.make(str(result), change=aged)
        test_film.film(result, result / "frames/f-%03d.png", "--of", "theta")
        frame = test_film.decode(result / "frames/f-%03d.png")[1]
        inside = frame[:250, :385]
        left, right = test_film.long_lines(inside, 1, 0.5)
        top, bottom = test_film.long_lines(inside, 0, 0.5)
        inside = inside[int(top) + 2:int(bottom) - 1, int(left) + 2:int(right) - 1]
        height, width, _ = inside.shape
        filled = (~np.all(inside > 251, axis=-1)).sum(axis=0) / height
        for x in (0.2, 0.5, 0.9):
            self.assertAlmostEqual(filled[int(x * width)], (exponent(0, x) + 2) / 5, delta=0.04, msg=x)
        said = test_film.film(result, result / "none.mp4", "--of", "age", status=2).stderr
        self.assertIn("there is no field called", said)


class InSpace(unittest.TestCase):
    def test_contact_plane(self):
        """Each node has, where it is, the colour of its theta at that moment."""
        folder = Path(tempfile.mkdtemp(prefix="amontons_states_"))
        self.addCleanup(shutil.rmtree, folder)
        law = "{law: ageing, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4, healing: 0.03, healing_time: 1, slip_distance: 1e-5, rest: 100}"
        (folder / "cube.yaml").write_text(f"""mesh: {{file: {SOURCE}/meshes/block3d.geo, set: {{length: 0.5, breadth: 0.4, height: 0.3, nx: 5, ny: 4, nz: 3}}}}
material: {{poisson: 0.34}}
friction: {law}
load: {{pressure: 0.003}}
rod: {{velocity: 2e-5}}
time: {{until: {{U: 3.5e-3}}}}
""")
        subprocess.run([test_film.PROGRAM, "run", folder / "cube.yaml", "-q", "-o", folder / "cube"], check=True)
        with h5py.File(folder / "cube/history.h5") as file:
            U, theta = file["series/rod_displacement"][()], file["interface/state"][()]
            x, y = file["nodes/x"][()], file["nodes/y"][()]
            self.assertEqual((file.attrs["states"], file.attrs["state_unit"]), ("theta", "time"))
        row = int(np.argmax(np.log(theta).std(axis=1)))
        self.assertGreater(theta[row].max() / theta[row].min(), 30)
        subprocess.run([test_film.PROGRAM, "render", folder / "cube", "--figure", "contact-plane", "--of", "theta", "--at", f"U={float(U[row])!r}",
                        "--warnings", "none"], check=True)
        picture = read_picture(str(folder / "cube"), "contact-plane-theta")
        frame = Frame(picture)
        ink = pictures.groups(is_color(picture, pictures.INK).sum(axis=0) > 0.3 * picture.shape[0])
        bar = bar_colors(picture, ink, frame)
        seen = [invert(picture[frame.pixel(0.02 + 0.96 * a, 0.02 + 0.96 * b)], bar) for a, b in zip(x / x.max(), y / y.max())]
        slope, level = np.polyfit(np.log10(theta[row]), seen, 1)
        decades = 1 / slope
        self.assertAlmostEqual(decades, round(decades), delta=0.05)   # whole powers of ten from end to end
        self.assertLess(np.abs(level + slope * np.log10(theta[row]) - seen).max(), 0.02)


if __name__ == "__main__":
    unittest.main()
