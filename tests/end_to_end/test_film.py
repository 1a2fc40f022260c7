# SPDX-License-Identifier: GPL-2.0-or-later
"""Films, made as users make them and decoded by ffmpeg: length, rate, size; known slip rates and a known field read back
through the colour map; what a kill and a full disk leave; errors."""
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

import render_fixture as fixture

PROGRAM = Path(os.environ["AMONTONS_BIN"]) / "amontons"
SIZE, RATE, SECONDS = (640, 360), 10, 2
SLOW, FAST = 0.5, 50.0           # slip rates over V: before and in the last tenth of the history
DECADES = (-2, 2)                # of the scale: from V/100 to the half decade above 50 V
WINDOW = (0.0048, 0.0066)        # of U: a cycle
SCENE = f"""mesh: {{file: {os.environ["AMONTONS_SOURCE"]}/meshes/block.geo, set: {{length: 1, height: 0.5, nx: 40, nz: 20}}}}
material: {{young: 1, poisson: 0.34, density: 1, eta1: 1, eta2: 1}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-5, height: 0.25, width: 0.05}}
time: {{until: {{U: 0.007}}}}
output: {{figures: [], fields: film, window: {{from_U: {WINDOW[0]}, to_U: {WINDOW[1]}}}}}
"""
FIELDS = {0.0: 0.0, 40.0: 0.5, 80.0: 1.0}   # time: velocity of the whole block


def film(result, path, *options, status=0, **how):
    done = subprocess.run([PROGRAM, "film", result, "-o", path, "--size", "x".join(map(str, SIZE)), "--fps", str(RATE),
                           "--seconds", str(SECONDS), *options], capture_output=True, text=True, **how)
    assert done.returncode == status, done.stderr
    return done


def make_history(folder):
    """100 units of time in 200 steps; slow slip, then fast slip in the last tenth, at x < 0.5 only."""
    def change(data, attributes):
        rows, nodes = 201, len(data["nodes/x"])
        t = np.linspace(0, 100, rows)
        rate = np.where(data["nodes/x"] < 0.5, 1.0, 0)[None, :] * np.where(t < 90, SLOW, FAST)[:, None] * fixture.V
        for name in list(data):
            if name.startswith(("series/", "interface/")):
                data[name] = np.zeros((rows, nodes) if name.startswith("interface/") else rows)
        data["series/time"], data["series/rod_displacement"], data["series/mu"] = t, t * fixture.V, t / 400
        data["interface/slip_rate"], data["interface/status"] = rate, np.where(rate > 0, 2, 1)
    fixture.make(str(folder), nodes=21, change=change, tables=False)


def make_fields(folder):
    """Four quads, at rest but for a velocity that is the same everywhere."""
    (folder / "fields").mkdir()
    lines = []
    for k, (when, speed) in enumerate(FIELDS.items()):
        grid, points = vtkUnstructuredGrid(), vtkPoints()
        for z in (0, 0.25, 0.5):
            for x in (0, 0.5, 1):
                points.InsertNextPoint(x, z, 0)
        grid.SetPoints(points)
        for corner in (0, 1, 3, 4):
            grid.InsertNextCell(VTK_QUAD, 4, (corner, corner + 1, corner + 4, corner + 3))
        for name, value in (("displacement", (0, 0, 0)), ("velocity", (speed, 0, 0)), ("stress_elastic", (0, 0, 0)),
                            ("stress", (0, 0, 0)), ("von_mises", 0.0)):
            array = numpy_to_vtk(np.tile(value, (9, 1)).astype(float).reshape(9, -1), deep=True)
            array.SetName(name)
            grid.GetPointData().AddArray(array)
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(folder / f"fields/bulk_{k}.vtu"))
        writer.SetInputData(grid)
        writer.Write()
        lines.append(f'<DataSet timestep="{when}" part="0" name="bulk" file="fields/bulk_{k}.vtu"/>')
    (folder / "fields.pvd").write_text('<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0" byte_order='
                                       '"LittleEndian">\n<Collection>\n' + "\n".join(lines) + "\n</Collection>\n</VTKFile>\n")


def decode(path):
    """[frames, height, width, 3] by ffmpeg's own decoders."""
    done = subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True,
                          check=True)
    assert not done.stderr, done.stderr
    return np.frombuffer(done.stdout, np.uint8).reshape(-1, SIZE[1], SIZE[0], 3).astype(np.int16)


def packet_times(path):
    done = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "packet=pts_time", "-of", "csv=p=0", path],
                          capture_output=True, text=True, check=True)
    return np.array(sorted(float(line.strip(",")) for line in done.stdout.split()))


def runs(mask):
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    return list(zip(edges[::2], edges[1::2]))


def long_lines(picture, axis, share):
    """Middles of dark lines along an axis that are longer than a share of the picture."""
    dark = np.all(picture < 170, axis=-1)
    longest = [max((b - a for a, b in runs(line)), default=0) for line in (dark if axis == 0 else dark.T)]
    return [(a + b) / 2 for a, b in runs(np.array(longest) > share * dark.shape[1 - axis])]


class OfHistory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons_film_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.result = cls.folder / "result"
        make_history(cls.result)


class Films(OfHistory):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        film(cls.result, cls.folder / "frames" / "run-%03d.png")
        names = sorted(path.name for path in (cls.folder / "frames").iterdir())
        assert names == [f"run-{k:03d}.png" for k in range(1, RATE * SECONDS + 1)], names
        cls.frames = decode(cls.folder / "frames" / "run-%03d.png")

    def test_kinds(self):
        """All frames, evenly timed, and the same pictures as the PNGs."""
        for ending, away in (("mp4", 3), ("webm", 4), ("gif", 6)):
            path = self.folder / f"film.{ending}"
            film(self.result, path)
            self.assertEqual([p.name for p in self.folder.glob("film.*")], [path.name], "nothing but the film is left")
            times = packet_times(path)
            self.assertEqual(len(times), RATE * SECONDS)
            np.testing.assert_allclose(times, np.arange(RATE * SECONDS) / RATE, atol=1e-3)
            frames = decode(path)
            self.assertEqual(frames.shape, self.frames.shape)
            self.assertLess(np.abs(frames - self.frames).mean(), away)
            path.unlink()
        self.assertLess(np.abs(self.frames[0] - self.frames[-1]).mean(), 60)

    def profile(self, k):
        """Inside the frame of the slip rate, the left one of the two upper ones. It is found in the first picture, whose
        bars are bright."""
        first = self.frames[0][:250, :385]
        left, right = long_lines(first, 1, 0.5)
        top, bottom = long_lines(first, 0, 0.5)
        return self.frames[k][int(top) + 2:int(bottom) - 1, int(left) + 2:int(right) - 1]

    def test_slip_rates(self):
        """As high as the logarithm of the slip rate, at x < 0.5 alone; one colour a rate."""
        colors = []
        for k, rate in ((3, SLOW), (RATE * SECONDS - 2, FAST)):
            inside = self.profile(k)
            height, width, _ = inside.shape
            filled = ~np.all(inside > 240, axis=-1)
            column = filled[:, width // 4]
            wanted = (np.log10(rate) - DECADES[0]) / (DECADES[1] - DECADES[0])
            self.assertAlmostEqual(column.sum() / height, wanted, delta=0.02)
            self.assertLess(filled[:, 3 * width // 4].sum() / height, 0.04)   # the foot of what sticks
            ends = np.flatnonzero(filled[height - height // 8])
            self.assertAlmostEqual(ends[-1] / width, 0.475, delta=0.01)   # half way from the last node that slips
            bar = inside[height - height // 8, width // 8:3 * width // 8]
            self.assertEqual(np.ptp(bar, axis=0).max(), 0)
            colors.append(bar[0])
        self.assertGreater(colors[0].sum(), colors[1].sum() + 200)   # the map gets darker

    def test_time(self):
        """Half of the film is the rapid tenth of the time; the cursor goes on evenly."""
        cursors = []
        for picture in self.frames[1:-1]:
            band = np.all(picture[290:335] < 60, axis=-1)
            cursors.append(int(np.argmax(band[:, 50:-20].sum(axis=0))) + 50)
        steps = np.diff(cursors)
        self.assertGreater(steps.min(), 0)
        self.assertLessEqual(np.ptp(steps), 2)
        rapid = [k for k in range(len(self.frames)) if self.profile(k)[40, 20].sum() < 500]
        self.assertAlmostEqual(len(rapid) / len(self.frames), 0.5, delta=0.16)
        self.assertEqual(rapid, list(range(rapid[0], len(self.frames))))

    def test_sparse_fields_are_said(self):
        """Of the 2 s rapid slip has 1 and the time from 60 to 90, which the field stored at 80 is the nearest to, a third; with
        a field in every tenth of a second of film nothing is said; without any that there is no block."""
        result = self.folder / "sparse"
        make_history(result)
        self.assertRegex(film(result, self.folder / "none.mp4").stdout, "shows no block.*--set output.fields=film")
        make_fields(result)
        said = re.search(r"stands still for up to (\d\.\d) s .*--set output.fields=film", film(result, self.folder / "sparse.mp4").stdout)
        self.assertAlmostEqual(float(said[1]), 1 + 1 / 3, delta=0.2)
        self.assertNotIn("output.fields", film(result, self.folder / "early.mp4", "--seconds", "1", "--to", "t=80").stdout)
        self.assertEqual(film(result, self.folder / "quiet.mp4", "--quiet").stdout, "")

    def test_fields(self):
        """Each frame shows the field stored nearest in time, in the colour that the bar has for it."""
        result = self.folder / "with_fields"
        make_history(result)
        make_fields(result)
        film(result, self.folder / "block", "--of", "velocity", "--to", "t=80", "--fps", "2", "--seconds", "4")
        frames = decode(self.folder / "block" / "frame-%04d.png")
        middles = frames[:, 130, 120]
        left, right = long_lines(frames[0][:250, 250:350], 1, 0.4)[-2:]   # of the colour bar
        edge = np.all(frames[0][:250, 250 + int(left)] < 215, axis=-1)
        top, bottom = max(runs(edge), key=lambda run: run[1] - run[0])
        bar = frames[0][top + 2:bottom - 2, 250 + int((left + right) / 2)][::-1]
        for k, middle in enumerate(middles):
            t = 80 * k / (len(frames) - 1)
            stored = FIELDS[min(FIELDS, key=lambda when: abs(when - t))]
            wanted = bar[int(round(stored * (len(bar) - 1)))]
            self.assertLessEqual(np.abs(middle - wanted).max(), 6, f"t = {t}")


class OfRun(unittest.TestCase):
    def test_a_run_that_stores_fields_for_a_film(self):
        """In a window from one U to another: the block moves from frame to frame, also where slip is rapid, and stands outside of it."""
        folder = Path(tempfile.mkdtemp(prefix="amontons_film_"))
        self.addCleanup(shutil.rmtree, folder)
        (folder / "scene.yaml").write_text(SCENE)
        subprocess.run([PROGRAM, "run", folder / "scene.yaml", "-o", folder / "result", "--quiet"], check=True,
                       env=os.environ | {"AMONTONS_CACHE": str(folder / "cache")})
        said = film(folder / "result", folder / "frames", "--from", f"U={WINDOW[0]}", "--to", f"U={WINDOW[1]}", "--seconds", "15").stdout
        self.assertNotIn("output.fields", said)
        block = decode(folder / "frames/frame-%04d.png")[:, 60:210, 10:300]
        moved = [np.abs(b - a).max() > 0 for a, b in zip(block, block[1:])]
        self.assertGreater(np.mean(moved), 0.8, "every frame but a few shows another state of the block")
        said = film(folder / "result", folder / "all", "--seconds", "10").stdout
        self.assertRegex(said, "stands still for up to")


class Ends(OfHistory):
    def start(self, path, made=None):
        running = subprocess.Popen([PROGRAM, "film", self.result, "-o", path, "--size", "640x360", "--fps", "30", "--seconds",
                                    "60", "--overwrite"], stderr=subprocess.PIPE, text=True, start_new_session=True)
        part = made or Path(f"{path}.part")
        while running.poll() is None and not part.exists():
            time.sleep(0.01)
        return running, part

    def test_signals(self):
        """To the program alone, as `kill` does, or to all, as Ctrl-C: nothing is left. SIGKILL leaves the .part."""
        path = self.folder / "long.mp4"
        path.write_bytes(b"an earlier film")
        for number, send in ((signal.SIGTERM, os.kill), (signal.SIGINT, os.killpg), (signal.SIGKILL, os.killpg)):
            running, part = self.start(path)
            send(running.pid, number)
            said = running.communicate()[1]
            if number != signal.SIGKILL:
                self.assertEqual(running.returncode, 1)
                self.assertRegex(said, r"stopped after \d+ of 1800 frames; there is no film")
                self.assertFalse(part.exists())
            self.assertEqual(path.read_bytes(), b"an earlier film")

    def test_stopped_frames_stay(self):
        """PNGs that are written have their names already, and the message says so."""
        first = self.folder / "stopped" / "frame-0001.png"
        running, _ = self.start(first.parent, first)
        os.kill(running.pid, signal.SIGTERM)
        self.assertRegex(running.communicate()[1], r"stopped after \d+ of 1800 frames; those that are written stay")
        self.assertTrue(first.exists())

    def test_full_disk(self):
        """A limit of sizes is met like a full disk."""
        path = self.folder / "large.webm"
        done = film(self.result, path, status=1, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)))
        self.assertIn("large.webm: cannot write: File too large", done.stderr)
        self.assertEqual(list(self.folder.glob("large*")), [])

    def refused(self, *words, name="film.mp4", options=(), result=None, status=2):
        done = film(result or self.result, self.folder / name, *options, status=status)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertEqual(list(self.folder.glob(name)), [])

    def test_per_cent_in_names(self):
        """A folder, and a film that is named after it, may have one; a pattern is the name of a PNG."""
        half = self.folder / "50% load"
        half.mkdir()
        (half / "result 50%d").symlink_to(self.result)
        few = ("--seconds", "0.3", "--quiet")
        done = subprocess.run([PROGRAM, "film", half / "result 50%d", *few], capture_output=True, text=True, timeout=100, cwd=half)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater((half / "result 50%d.mp4").stat().st_size, 1000)
        film(self.result, half / "run-%02d.png", *few)
        self.assertEqual(sorted(path.name for path in half.glob("run*")), [f"run-{k:02}.png" for k in (1, 2, 3)])
        film(self.result, half / "frames", *few)
        self.assertEqual(len(list((half / "frames").glob("*.png"))), 3)

    def test_errors(self):
        self.refused("film.avi", ".mp4, .webm or .gif", "PNG frames", name="film.avi")
        self.refused("one number", name="frames-%s.png")
        self.refused("one number", name="%d-%d.png")
        self.refused("one number", name="new/run.png")
        self.assertFalse((self.folder / "new").exists(), "nothing is made for a name that is refused")
        done = film(self.result, "x/" * 2045 + "a.mp4.mp4", status=2)   # its first 4095 bytes are another film's name
        self.assertIn("at most 4095 are allowed", done.stderr)
        self.refused("1280x720", options=("--size", "big"))
        self.refused("even numbers", options=("--size", "641x360"))
        self.refused("--seconds 0", "above 0", options=("--seconds", "0"))
        self.refused("from 2 to 100000 frames", options=("--seconds", "0.01"))
        self.refused("U=0.0117 or t=120", options=("--from", "0.1"))
        self.refused("nothing lies between", options=("--from", "t=50", "--to", "t=20"))
        self.refused("no bulk sliding", options=("--cycle", "last"))
        self.refused("10, 20, 25 or 50", name="film.gif", options=("--fps", "30"))
        self.refused("there is no field called", "von_mises", options=("--of", "heat"))
        self.refused("of velocity: the run stored no fields", "output: {fields: film}", options=("--of", "velocity"))
        self.refused("--fields is gone", "--set output.fields=film", options=("--fields",))
        self.refused("no history", result=self.folder)

    def test_frames_are_not_mixed(self):
        frames = self.folder / "taken"
        frames.mkdir()
        (frames / "frame-0001.png").write_text("of another film")
        done = film(self.result, frames, status=2)
        self.assertRegex(done.stderr, "frame-0001.png.* and no amontons.files")

    def test_no_libav(self):
        modules = self.folder / "modules"
        modules.mkdir()
        for module in PROGRAM.parent.glob("amontons_*.so"):
            if module.stem != "amontons_libav":
                (modules / module.name).symlink_to(module)
        done = film(self.result, self.folder / "film.mp4", status=1, env={**os.environ, "AMONTONS_MODULES": str(modules)})
        self.assertIn("amontons_libav.so", done.stderr)
        self.assertEqual(list(self.folder.glob("film.mp4*")), [])


if __name__ == "__main__":
    unittest.main()
