# SPDX-License-Identifier: GPL-2.0-or-later
"""The pictures, read back by VTK and measured: what stands in a history must be found at its place
with its colour. The module is called as the program calls it, through its one entry."""
import ctypes
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import render_fixture as fixture
from sanitizer_fixture import begin_again_with

MODULES = os.environ["AMONTONS_MODULES"]
FIGURES = ("force", "slip-map", "contact-density")
INK, CURVE, RED, BLUE = (20, 20, 26), (13, 69, 140), (191, 31, 31), (20, 89, 179)
STICK, OPEN = (249, 250, 251), (140, 143, 148)
DECADES = (-2, 3.5)   # of the fixture's slip map: the fastest slip is 2040 V
ERROR_INPUT, ERROR_FILE, ERROR_LIBRARY = 1, 2, 4


class Error(ctypes.Structure):
    _fields_ = [("code", ctypes.c_int), ("line", ctypes.c_int32), ("file", ctypes.c_char_p),
                ("message", ctypes.c_char * 2000)]


class Style(ctypes.Structure):
    _fields_ = [("format", ctypes.c_char_p), ("width", ctypes.c_double), ("dpi", ctypes.c_double),
                ("dark", ctypes.c_bool), ("overwrite", ctypes.c_bool), ("height", ctypes.c_double), ("depth", ctypes.c_double),
                *((name, ctypes.c_char_p) for name in ("style", "title", "inset", "legend", "limits", "from", "to", "cycle", "pixels", "line",
                                                       "compare", "warnings"))]


class Field(ctypes.Structure):
    _fields_ = [("of", ctypes.c_char_p), ("at", ctypes.c_char_p), ("edges", ctypes.c_bool),
                ("cut", ctypes.c_char_p)]


class Request(ctypes.Structure):
    _fields_ = [("figures", ctypes.POINTER(ctypes.c_char_p)), ("figure_count", ctypes.c_int32),
                ("style", Style), ("field", Field), ("panels", ctypes.c_char_p)]


begin_again_with(os.path.join(MODULES, "amontons_render.so"))
LIBRARY = ctypes.CDLL(os.path.join(MODULES, "amontons_render.so"))
LIBRARY.amontons_render.restype = ctypes.c_bool


def render(folder, *figures, panels=None, **style):
    """(code, message) of the call; code 0: drawn. 20 pixels a millimetre where no dots are asked for."""
    style.setdefault("dpi", 508)
    error = Error()
    names = (ctypes.c_char_p * max(len(figures), 1))(*[name.encode() for name in figures])
    request = Request(names, len(figures), Style(**style), Field(), panels)
    done = LIBRARY.amontons_render(folder.encode(), ctypes.byref(request), ctypes.byref(error))
    assert done == (error.code == 0)
    return error.code, error.message.decode()


def path_of(folder, figure, ending="png"):
    return os.path.join(folder, "figures", f"{figure}.{ending}")


def read_bytes(folder, figure):
    with open(path_of(folder, figure), "rb") as file:
        return file.read()


def read_picture(folder, figure):
    """[height, width, 3] integers, first row at the top."""
    reader = vtkPNGReader()
    reader.SetFileName(path_of(folder, figure))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return values.reshape(height, width, 3)[::-1].astype(int)


def is_color(picture, color, tolerance=2):
    return np.all(np.abs(picture - np.array(color)) <= tolerance, axis=-1)


def groups(mask):
    """Middles of the runs of true values, as places between pixels."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    return [(first + last) / 2 for first, last in zip(edges[::2], edges[1::2])]


class Frame:
    """The frame of an axis system, found by its long straight lines."""

    def __init__(self, picture, color=INK):
        mask = is_color(picture, color)
        rows = groups(mask.sum(axis=1) > 0.4 * picture.shape[1])
        self.columns = groups(mask.sum(axis=0) > 0.4 * picture.shape[0])
        self.top, self.bottom = rows[0], rows[-1]
        self.left, self.right = self.columns[:2]

    def pixel(self, across, up):
        """(row, column) of a point given as shares of the frame."""
        return (int(self.bottom - up * (self.bottom - self.top)),
                int(self.left + across * (self.right - self.left)))


def bar_colors(picture, columns, frame):
    """Colours of the bar beside a map, from bottom to top, and whether a patch is below it."""
    middle = int((columns[-2] + columns[-1]) / 2)
    lines = groups(is_color(picture, INK)[:, middle])
    top, bottom = lines[0], lines[1]
    assert abs(top - frame.top) < 3
    inside = picture[int(top) + 4:int(bottom) - 3, middle][::-1]
    shares = (bottom - np.arange(int(top) + 4, int(bottom) - 3)[::-1] - 0.5) / (bottom - top)
    return inside, shares


def invert(color, bar):
    """The share of the bar that has this colour."""
    colors, shares = bar
    distance = np.abs(colors - color).sum(axis=1)
    assert distance.min() <= 6, (color, distance.min())
    return shares[np.argmin(distance)]


def lab(colors):
    """CIELAB (D65) of sRGB bytes."""
    value = colors / 255
    linear = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
    xyz = linear @ np.array([[0.4124, 0.2126, 0.0193], [0.3576, 0.7152, 0.1192],
                             [0.1805, 0.0722, 0.9505]]) / [0.9505, 1.0, 1.089]
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz * 841 / 108 + 4 / 29)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], 1)


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="amontons_render_")
        cls.data, cls.attributes = fixture.make(cls.folder)
        start = time.process_time()
        cls.result = render(cls.folder)
        cls.seconds = time.process_time() - start
        cls.picture = {name: read_picture(cls.folder, name) for name in FIGURES}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def row_at(self, U):
        """The step that ends at U or next after it."""
        return np.searchsorted(self.data["series/rod_displacement"], U)

    def test_all_figures_in_time(self):
        self.assertEqual(self.result, (0, ""))
        self.assertEqual(sorted(os.listdir(os.path.join(self.folder, "figures"))),
                         sorted([name + ".png" for name in FIGURES] + ["events.csv", "force.csv", "slip-map.csv"]))
        self.assertLess(self.seconds, 3)   # of processor time: a second each

    def test_size_and_metadata(self):
        for name in FIGURES:
            content = read_bytes(self.folder, name)
            self.assertGreaterEqual(self.picture[name].shape[1], 1600)
            place = content.index(b"pHYs") + 4
            across, down, unit = struct.unpack(">IIB", content[place:place + 9])
            self.assertEqual((across, unit), (down, 1))
            printed = self.picture[name].shape[1] / across   # metres
            self.assertAlmostEqual(printed, 0.086, delta=1e-4)
            self.assertIn(b"Software\0amontons ", content)
            self.assertIn(b"Title\0", content)
            self.assertNotIn(b"tIME", content)

    def test_same_bytes_twice(self):
        other = tempfile.mkdtemp(prefix="amontons_render_")
        fixture.make(other)
        code = f"import test_render as t; assert t.render({other!r})[0] == 0"
        environment = dict(os.environ, LP_NUM_THREADS="1")
        subprocess.run([sys.executable, "-c", code], check=True, env=environment,
                       cwd=os.path.dirname(os.path.abspath(__file__)))
        for name in FIGURES:
            self.assertEqual(read_bytes(self.folder, name), read_bytes(other, name), name)
        shutil.rmtree(other)

    def test_background_and_text(self):
        for name in FIGURES:
            self.assertEqual(tuple(self.picture[name][1, 1]), (255, 255, 255))
            frame = Frame(self.picture[name])
            below = self.picture[name][int(frame.bottom) + 30:, :]
            self.assertGreater(is_color(below, INK).sum(), 500, "numbers under the axis")

    def test_force_curve(self):
        picture, frame = self.picture["force"], Frame(self.picture["force"])
        levels = self.levels(picture, frame)
        U, mu = self.data["series/rod_displacement"], self.data["series/mu"]
        blue = is_color(picture, CURVE, 8)
        for wanted in (0.0006, 0.0011, 0.0027, 0.0040, 0.0055):
            row, column = frame.pixel(wanted / fixture.U_END, 0)
            found = np.flatnonzero(blue[int(frame.top):row - 4, column]) + int(frame.top)
            seen = levels(found.mean() + 0.5)
            self.assertAlmostEqual(seen, np.interp(wanted, U, mu), delta=0.003, msg=wanted)

    def levels(self, picture, frame):
        """mu of a row of pixels, from the dashed lines at mu_S and mu_K."""
        inside = picture[:, int(frame.left) + 5:int(frame.right) - 5]
        grey = groups(is_color(inside, (115, 115, 120), 4).sum(axis=1) > 0.3 * inside.shape[1])
        self.assertEqual(len(grey), 3)
        slope = (fixture.MU_KINETIC - fixture.MU_STATIC) / (grey[2] - grey[0])
        mu_M = fixture.MU_STATIC + slope * (grey[1] - grey[0])
        self.assertAlmostEqual(mu_M, self.attributes["mu_macroscopic"], delta=0.002)
        return lambda row: fixture.MU_STATIC + slope * (row - grey[0])

    def test_force_inset(self):
        """The inset's frame, and the box on the curve that it enlarges."""
        red = is_color(self.picture["force"], RED)
        wide = groups(red.sum(axis=1) > 0.4 * red.shape[1])
        self.assertEqual(len(wide), 2)
        frame = Frame(self.picture["force"])
        box = np.argwhere(red[int(wide[1]) + 150:])   # and the lines that lead to it, from above
        box = box[box[:, 0] > box[:, 0].max() - 5]
        right = (box[:, 1].max() - frame.left) / (frame.right - frame.left) * fixture.U_END
        self.assertAlmostEqual(right, fixture.SLIDES[-1], delta=6e-5)
        left = groups(red[int(wide[0]):int(wide[1])].sum(axis=0) > 100)[0]
        ticks = groups(red[int(wide[0]):int(wide[1]) + 4, int(left) - 14])   # the long ones only
        self.assertGreaterEqual(len(ticks), 2, "two numbers make a scale")
        inset = self.picture["force"][int(wide[0]) + 5:int(wide[1]) - 5]
        self.assertGreater(is_color(inset, CURVE, 8).any(axis=0).sum(), 800)

    def test_slip_map_colors(self):
        """Colours at known steps and nodes give back log10(slip rate / V)."""
        picture, frame = self.picture["slip-map"], Frame(self.picture["slip-map"])
        bar = bar_colors(picture, frame.columns, frame)
        x, checked = self.data["nodes/x"], 0
        for U in (0.0005, 0.0012, 0.0016, 0.0029, 0.0042, 0.0054):
            rates = self.data["interface/slip_rate"][self.row_at(U)] / fixture.V
            for i in (2, 20, 34, 50, 77):
                color = picture[frame.pixel(U / fixture.U_END, x[i])]
                if rates[i] == 0:
                    self.assertLessEqual(np.abs(color - STICK).max(), 1)
                    continue
                seen = DECADES[0] + (DECADES[1] - DECADES[0]) * invert(color, bar)
                self.assertAlmostEqual(seen, np.log10(rates[i]), delta=0.05, msg=(U, i))
                checked += 1
        self.assertGreater(checked, 8)

    def test_ticks_stand_at_their_values(self):
        """The map fills its frame from x = 0 to 1 and U = 0 to 0.006: so must the ticks."""
        picture, frame = self.picture["slip-map"], Frame(self.picture["slip-map"])
        ink = is_color(picture, INK, 90)
        for beside, ticks in ((14, 6), (7, 21)):   # pixels: there, minor ticks have ended or not
            top = int(frame.top) - 9   # the title is above
            found = groups(ink[top:int(frame.bottom) + 9, int(frame.left) - beside])
            wanted = frame.bottom - top - np.linspace(0, 1, ticks) * (frame.bottom - frame.top)
            np.testing.assert_allclose(sorted(found), sorted(wanted), atol=1.01)
        start = int(frame.left) - 9
        found = groups(ink[int(frame.bottom) + 14, start:int(frame.right) + 10])
        wanted = frame.left - start + np.linspace(0, 1, 7) * (frame.right - frame.left)
        np.testing.assert_allclose(found, wanted, atol=1.01)

    def test_slip_map_shows_rapid_events(self):
        """Each lasts less than two of the picture's columns; the fastest step inside must show."""
        picture, frame = self.picture["slip-map"], Frame(self.picture["slip-map"])
        bar = bar_colors(picture, frame.columns, frame)
        starts = fixture.bounded_starts(fixture.SLIDES[0], 0.0) + list(fixture.SLIDES)
        row, _ = frame.pixel(0, self.data["nodes/x"][30])
        for U0 in starts:
            duration = 4e-5 if U0 in fixture.SLIDES else 1e-5
            U = self.data["series/rod_displacement"]
            inside = (U > U0) & (U <= U0 + duration)
            wanted = np.log10(self.data["interface/slip_rate"][inside, 30].max() / fixture.V)
            _, column = frame.pixel((U0 + duration / 2) / fixture.U_END, 0)
            seen = [DECADES[0] + (DECADES[1] - DECADES[0]) * invert(picture[row, k], bar)
                    for k in range(column - 4, column + 5)
                    if np.abs(picture[row, k] - STICK).max() > 1]
            self.assertAlmostEqual(max(seen), wanted, delta=0.05, msg=U0)

    def test_contact_density_colors(self):
        picture, frame = self.picture["contact-density"], Frame(self.picture["contact-density"])
        ink = Frame.__new__(Frame)
        ink.columns = groups(is_color(picture, INK).sum(axis=0) > 0.4 * picture.shape[0])
        bar = bar_colors(picture, ink.columns, frame)
        low, high = self.window()
        x, seen_low = self.data["nodes/x"], 1.0
        for share in np.linspace(0.05, 0.93, 40):
            U = low + share * (high - low)
            near = [U + k * (high - low) / (frame.right - frame.left) for k in range(-3, 4)]
            rows = range(self.row_at(near[0]), self.row_at(near[-1]) + 1)
            phi = 1 - np.minimum(self.data["interface/slip_rate"][rows] / fixture.V_CRITICAL, 1)
            for i in (3, 24, 37):
                seen = invert(picture[frame.pixel(share, x[i])], bar)
                self.assertGreater(seen, phi[:, i].min() - 0.02, (U, i))
                self.assertLess(seen, phi[:, i].max() + 0.02, (U, i))
                seen_low = min(seen_low, seen)
        self.assertLess(seen_low, 0.6, "a precursor was among the points")

    def window(self):
        """The part of U that holds the last precursors before the last sliding."""
        slide = fixture.SLIDES[-1]
        first = fixture.bounded_starts(slide, fixture.SLIDES[-2] + 4e-5)[0]
        return slide - 1.08 * (slide - first), slide + 0.08 * (slide - first)

    def test_map_is_uniform(self):
        """Equal steps of the value are equal distances in CIELAB; lightness falls all the way."""
        picture, frame = self.picture["slip-map"], Frame(self.picture["slip-map"])
        colors, shares = bar_colors(picture, frame.columns, frame)
        places, seen = np.linspace(0.02, 0.98, 17), lab(colors)
        seen = np.stack([np.interp(places, shares, seen[:, k]) for k in range(3)], axis=1)
        steps = np.linalg.norm(np.diff(seen, axis=0), axis=1)
        self.assertLess(steps.max() / steps.min(), 1.1)   # bytes round, and chords are not arcs
        self.assertTrue(np.all(np.diff(seen[:, 0]) < -2))


class Variants(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="amontons_render_")

    def tearDown(self):
        shutil.rmtree(self.folder)

    def draw(self, *figures, **options):
        self.assertEqual(render(self.folder, *figures, **options), (0, ""))

    def test_gaps_between_pads(self):
        """Hatched, and neither stick nor slip."""
        data, _ = fixture.make(self.folder, nodes=90, pads=3)
        self.draw("slip-map")
        picture = read_picture(self.folder, "slip-map")
        frame = Frame(picture)
        x, pad = data["nodes/x"], data["nodes/pad"]
        end, start = x[pad == 0].max(), x[pad == 1].min()
        for share in (0.2, 0.5, 0.8):
            row, column = frame.pixel(0.9, end + share * (start - end))
            near = picture[row, column - 30:column + 30]
            white = is_color(near, (255, 255, 255))
            self.assertTrue(0.5 < white.mean() < 1, "white between the hatching")
        row, column = frame.pixel(0.98, x[pad == 2].mean())
        self.assertTrue(is_color(picture[row, column], STICK))

    def test_a_front_a_pad(self):
        """The pad in the middle slips up to its node 10, the others stick: a line on each, none across a gap."""
        def slips(data, _):
            middle = np.flatnonzero(data["nodes/pad"] == 1)[:11]
            for array, rest, value in ("slip_rate", 0, 0.5 * fixture.V), ("status", 1, 2):
                data[f"interface/{array}"][:] = rest
                data[f"interface/{array}"][:, middle] = value
        data, _ = fixture.make(self.folder, nodes=90, pads=3, change=slips)
        self.draw("contact-density")
        picture = read_picture(self.folder, "contact-density")
        frame = Frame(picture)
        x, pad = data["nodes/x"], data["nodes/pad"]
        for across in (0.2, 0.7):
            column = frame.pixel(across, 0.5)[1]
            inside = slice(frame.pixel(0, 0.98)[0], frame.pixel(0, 0.02)[0])
            lines = groups(is_color(picture[inside, column], INK, 60))
            wanted = [frame.pixel(0, place)[0] - inside.start
                      for place in (x[pad == 2][0], x[pad == 1][10])]   # that of the first pad lies on the frame
            self.assertEqual(len(lines), 2)
            for line, row in zip(lines, wanted):
                self.assertAlmostEqual(line, row, delta=3)

    def test_pads_are_marked(self):
        """A bar beside the frame along each pad, none along the gaps and for a plain block; names of
        one's own take the room they need."""
        gray = (115, 117, 122)
        data, attributes = fixture.make(self.folder, nodes=90, pads=3)
        self.draw("slip-map")
        picture = read_picture(self.folder, "slip-map")
        frame = Frame(picture)
        x, pad = data["nodes/x"], data["nodes/pad"]
        beside = slice(int(frame.right) + 66, int(frame.right) + 90)   # beyond the name of l_c
        for k in range(3):
            row, _ = frame.pixel(0.5, x[pad == k].mean())
            self.assertTrue(is_color(picture[row, beside], gray).any(), k)
        for k in range(2):
            row, _ = frame.pixel(0.5, (x[pad == k].max() + x[pad == k + 1].min()) / 2)
            self.assertFalse(is_color(picture[row, beside], gray).any(), k)

        def named(_, attributes):
            attributes["pads"] = "contact_1\nthe middle foot\ncontact_3"
        fixture.make(self.folder, nodes=90, pads=3, change=named)
        self.draw("slip-map")
        self.assertLess(Frame(read_picture(self.folder, "slip-map")).right, frame.right - 30)
        fixture.make(self.folder)
        self.draw("slip-map")
        plain = read_picture(self.folder, "slip-map")
        wide = Frame(plain)
        self.assertGreater(wide.right, frame.right)
        row, _ = wide.pixel(0.5, 0.25)
        self.assertFalse(is_color(plain[row, int(wide.right) + 3:int(wide.right) + 25], gray).any())

    def test_what_the_density_map_shows_is_marked_and_named(self):
        """On one page with it: above the slip map a bar over the U of the contact-density map, and its letter
        in the same blue, as the frame of that map. Alone neither speaks of the other."""
        fixture.make(self.folder)
        self.draw("slip-map")
        self.assertFalse(is_color(read_picture(self.folder, "slip-map"), BLUE).any())
        self.draw("contact-density")
        self.assertFalse(is_color(read_picture(self.folder, "contact-density"), BLUE).any())
        self.draw(panels=b"slip-map,contact-density")
        picture = read_picture(self.folder, "panels")
        blue, half = is_color(picture, BLUE), picture.shape[0] // 2
        frame = Frame(picture[:half])
        below = Frame(picture[half:], BLUE)
        self.assertEqual((below.left, below.right), (frame.left, frame.right))
        bar = np.flatnonzero(blue[int(frame.top) - 9])
        end = frame.left + fixture.SLIDES[-1] / fixture.U_END * (frame.right - frame.left)
        self.assertTrue(bar[0] < end < bar[-1] + 2, (bar, end))
        self.assertTrue(np.diff(bar).max() == 1)
        words = blue[:int(frame.top) - 24]
        rows, columns = np.flatnonzero(words.any(axis=1)), np.flatnonzero(words.any(axis=0))
        self.assertGreater(len(groups(words[rows].any(axis=0))), 8, "letters")
        self.assertGreater(rows[0], 3)
        self.assertTrue(frame.left < columns[0] and columns[-1] <= frame.right + 1)

    def test_title(self):
        """Above the figure, which stays what it is; a long one is made to fit."""
        pictures = {}
        for title in "", "A block", "A block " * 40:
            fixture.make(self.folder, change=lambda data, attributes: attributes.update(title=title))
            self.draw("force", title=b"scene")
            pictures[title] = read_picture(self.folder, "force")
        self.draw("force")
        np.testing.assert_array_equal(read_picture(self.folder, "force"), pictures[""], "no title but where it is asked for")
        self.draw("force", title=b"A block")
        np.testing.assert_array_equal(read_picture(self.folder, "force"), pictures["A block"])
        plain, *titled = pictures.values()
        for picture in titled:
            head = picture.shape[0] - plain.shape[0]
            np.testing.assert_array_equal(picture[head:], plain)
            inked = np.flatnonzero(is_color(picture[:head], INK, 60).any(axis=0))
            self.assertGreater(inked[0], 10)
            self.assertLess(inked[-1], plain.shape[1] - 10)
            self.assertEqual(picture[:3].min(), 255)
        self.assertGreater(inked[-1], 0.9 * plain.shape[1])

    def test_a_level_far_above_leaves_room_to_the_curve(self):
        """mu_S three times the curve: an arrow and its value, and the curve as high as without it."""
        heights = []
        for mu in 0.38, 1.2:
            fixture.make(self.folder, change=lambda data, attributes: attributes.update(mu_static=mu))
            self.draw("force")
            picture = read_picture(self.folder, "force")
            frame = Frame(picture)
            rows = np.flatnonzero(is_color(picture, CURVE, 8)[int(frame.top + frame.bottom) // 2:].any(axis=1))
            heights.append((rows[-1] - rows[0]) / (frame.bottom - frame.top))
        self.assertGreater(heights[1], 0.4)
        self.assertGreaterEqual(heights[1], 0.95 * heights[0])

    def test_warnings_stand_below(self):
        """The figure is what it is without; below it, in a colour of their own, whole words only."""
        text = "slip is not resolved: " + "elements are long; " * 6 + "\nsecond"
        fixture.make(self.folder)
        self.draw(*FIGURES)
        without = {name: read_picture(self.folder, name) for name in FIGURES}
        fixture.make(self.folder, change=lambda data, attributes: attributes.update(warnings=text))
        self.draw(*FIGURES)
        for name in FIGURES:
            plain, warned = without[name], read_picture(self.folder, name)
            rows = plain.shape[0]
            self.assertGreater(warned.shape[0], rows + 60)
            np.testing.assert_allclose(warned[:rows - 20], plain[:rows - 20], atol=1)   # of 255: rounding
            words = is_color(warned, (158, 51, 13), 8)
            self.assertEqual(np.count_nonzero(words[:rows - 20]), 0)
            self.assertGreaterEqual(len(groups(words.any(axis=1))), 3, "lines")
            self.assertFalse(words[:, -20:].any(), "the last letters are cut off")
            self.assertGreater(len(groups(words.any(axis=0))), 10, "letters")

    def test_si_units(self):
        """Lengths get a handy unit: the same picture but for its numbers and names."""
        fixture.make(self.folder, units="si", length=0.1)
        self.draw("slip-map")
        si = read_picture(self.folder, "slip-map")
        fixture.make(self.folder)
        self.draw("slip-map")
        normalised = read_picture(self.folder, "slip-map")
        frame_si, frame = Frame(si), Frame(normalised)
        for place in ((0.1, 0.1), (0.4, 0.05), (0.8, 0.9), (0.95, 0.3)):
            self.assertTrue(is_color(si[frame_si.pixel(*place)], normalised[frame.pixel(*place)]))
        below = slice(int(frame.bottom) + 10, None)
        self.assertFalse(np.array_equal(si[below, :1000], normalised[below, :1000]))

    def test_open_nodes_have_no_contact(self):
        def lift(data, _):
            data["interface/status"] = data["interface/status"] * 1
            data["interface/status"][:, :10] = 0

        fixture.make(self.folder, change=lift)
        self.draw("contact-density")
        picture = read_picture(self.folder, "contact-density")
        frame = Frame(picture)
        self.assertTrue(is_color(picture[frame.pixel(0.02, 0.05)], OPEN))
        self.assertGreater(picture[frame.pixel(0.02, 0.5)].sum(), 600)    # phi near 1: light

    def test_weak_precursors_fill_the_scale(self):
        """At a tenth of v_c: the bar starts at 0.75 or 0.9, and they are as dark as it says."""
        for peak, low in ((0.2, 0.75), (0.08, 0.9)):
            def weaken(data, _):
                U, rate = data["series/rod_displacement"], data["interface/slip_rate"]
                before = U < fixture.SLIDES[-1]
                rate[before] *= peak * fixture.V_CRITICAL / rate[before & (U > 0.0035)].max()
            data, _ = fixture.make(self.folder, change=weaken)
            self.draw("contact-density")
            picture = read_picture(self.folder, "contact-density")
            frame = Frame(picture)
            columns = groups(is_color(picture, INK).sum(axis=0) > 0.4 * picture.shape[0])
            bar = bar_colors(picture, columns, frame)
            row = frame.pixel(0, data["nodes/x"][40])[0]
            last = int(frame.left + 0.9 * (frame.right - frame.left))   # sliding comes after
            seen = [low + (1 - low) * invert(color, bar)
                    for color in picture[row, int(frame.left) + 4:last]
                    if not is_color(color, INK, 120)]
            U = data["series/rod_displacement"]
            shown = (U > 0.0044) & (U < fixture.SLIDES[-1])
            wanted = 1 - data["interface/slip_rate"][shown, 40].max() / fixture.V_CRITICAL
            self.assertAlmostEqual(min(seen), wanted, delta=0.02 * (1 - low))

    def test_last_row_sets_the_scale(self):
        """Where no sliding is found: phi is 0.95 but in the last row, 0.3; the bar starts at 0.25."""
        def weaken(data, _):
            rate = data["interface/slip_rate"]
            rate[:] = 0.05 * fixture.V_CRITICAL
            rate[-1] = 0.7 * fixture.V_CRITICAL
        data, _ = fixture.make(self.folder, tables=False, change=weaken)
        self.draw("contact-density")
        picture = read_picture(self.folder, "contact-density")
        frame = Frame(picture)
        bar = bar_colors(picture, groups(is_color(picture, INK).sum(axis=0) > 0.4 * picture.shape[0]), frame)
        self.assertAlmostEqual(invert(picture[frame.pixel(0.5, data["nodes/x"][40])], bar), 0.7 / 0.75, delta=0.02)

    def test_killed_run(self):
        """history.h5.part, without tables: drawn, without an inset, as no event is known."""
        fixture.make(self.folder, tables=False, name="history.h5.part")
        self.draw()
        red = is_color(read_picture(self.folder, "force"), RED)
        self.assertLess(len(groups(red.sum(axis=1) > 0.4 * red.shape[1])), 2, "has no inset")

    def test_odd_histories(self):
        def nothing_slips(data, _):
            data["interface/slip_rate"] = data["interface/slip_rate"] * 0
            data["series/mu"] = np.linspace(0, 0.1, len(data["series/mu"]))

        def holes(data, _):
            for name in ("series/mu", "series/rod_displacement"):
                data[name] = data[name].copy()
                data[name][::7] = np.nan
            data["interface/slip_rate"][::5, ::3] = np.nan
            data["events/U_start"][::2] = np.nan
            data["peaks/mu"][0] = np.nan

        def no_numbers(data, attributes):
            for name in ("mu_static", "mu_kinetic", "mu_macroscopic", "critical_length", "length"):
                attributes.pop(name, None)

        def no_curve(data, _):
            data["series/mu"] = data["series/mu"] * 0 + np.nan

        cases = {"nothing slips": dict(change=nothing_slips, tables=False), "holes": dict(change=holes),
                 "no numbers": dict(change=no_numbers), "no curve": dict(change=no_curve),
                 "two nodes": dict(nodes=2), "one node": dict(nodes=1), "many": dict(nodes=2000)}
        for name, options in cases.items():
            with self.subTest(name):
                fixture.make(self.folder, **options)
                self.draw(dpi=600 / 86 * 25.4)
                for figure in FIGURES:
                    self.assertEqual(read_picture(self.folder, figure).shape[1], 600)

    def test_wanted_size(self):
        """A width in mm and dots per inch: letters keep their size in print."""
        fixture.make(self.folder)
        self.draw("force", width=100, dpi=254)
        wide = read_picture(self.folder, "force")
        self.assertEqual(wide.shape, (850, 1000, 3))
        self.draw("force", width=100, dpi=254, height=50, title=b"A block")
        self.assertEqual(read_picture(self.folder, "force").shape, (500, 1000, 3), "all of it")
        self.draw("force", style=b"columns", dpi=254)
        self.assertEqual(read_picture(self.folder, "force").shape, (round(1780 * 0.85 * (100 / 178) ** 0.5), 1780, 3))
        self.draw("force", dpi=0)
        self.assertEqual(read_picture(self.folder, "force").shape[1], round(86 / 25.4 * 600))
        self.draw("force", width=100, dpi=254)
        place = read_bytes(self.folder, "force").index(b"pHYs") + 4
        self.assertEqual(struct.unpack(">II", read_bytes(self.folder, "force")[place:place + 8]), (10000, 10000))
        for style in {"dpi": 50}, {"width": 10000}, {"width": 1e300}:
            code, message = render(self.folder, "force", **style)
            self.assertEqual(code, ERROR_INPUT)
            self.assertIn("200 to 8192", message)
        code, message = render(self.folder, "force", format=b"jpeg")
        self.assertEqual(code, ERROR_INPUT)
        self.assertIn("png, pdf, svg", message)

    def test_vector_files(self):
        """Drawn by poppler and librsvg, PDF and SVG show what the PNG shows; fonts are embedded; the same
        bytes come out twice."""
        fixture.make(self.folder)
        dpi, names = 300, ("force", "slip-map")
        self.draw(*names, dpi=dpi)
        plain = {name: read_picture(self.folder, name) for name in names}
        self.draw(*names, dpi=dpi, format=b"pdf")
        self.draw(*names, dpi=dpi, format=b"svg")
        for name in names:
            pdf, svg = path_of(self.folder, name, "pdf"), path_of(self.folder, name, "svg")
            with open(pdf, "rb") as file:
                content = file.read()
            self.assertNotIn(b"CreationDate", content)
            fonts = subprocess.run(["pdffonts", pdf], capture_output=True, text=True, check=True).stdout.splitlines()[2:]
            self.assertGreater(len(fonts), 0)
            for font in fonts:
                self.assertRegex(font, r"\+DejaVuSans .* yes yes yes ", "embedded, a subset, with letters to copy")
            words = subprocess.run(["pdftotext", pdf, "-"], capture_output=True, text=True, check=True).stdout
            self.assertIn("10−3", words)
            across, down = plain[name].shape[1], plain[name].shape[0]
            subprocess.run(["pdftoppm", "-png", "-singlefile", "-scale-to-x", str(across), "-scale-to-y", str(down),
                            pdf, os.path.join(self.folder, "figures", "drawn_pdf")], check=True)
            subprocess.run(["rsvg-convert", "-w", str(across), "-h", str(down), svg,
                            "-o", path_of(self.folder, "drawn_svg")], check=True)
            for drawn in "drawn_pdf", "drawn_svg":
                other = read_picture(self.folder, drawn)[:down, :across, :3]
                blurred = [picture[:down // 4 * 4, :across // 4 * 4].reshape(down // 4, 4, across // 4, 4, 3).mean(axis=(1, 3))
                           for picture in (plain[name], other)]
                away = np.abs(blurred[0] - blurred[1]).max(axis=-1)
                self.assertLess(away.mean(), 3, (name, drawn))
                self.assertLess((away > 60).mean(), 0.01, (name, drawn))

    def test_dark(self):
        """White lines on black, and the colour map turned round: what slips most is brightest."""
        fixture.make(self.folder)
        self.draw("slip-map")
        white = read_picture(self.folder, "slip-map")
        self.draw("slip-map", dark=True)
        dark = read_picture(self.folder, "slip-map")
        self.assertLess(dark[1, 1].max(), 40)
        for place in np.argwhere(is_color(white, INK))[::997]:
            self.assertGreater(dark[tuple(place)].min(), 200)
        frame = Frame(white)
        row, _ = frame.pixel(0, 0.2)
        inside = slice(int(frame.left) + 5, int(frame.right) - 5)
        slips = ~is_color(white[row, inside], STICK, 3)
        self.assertGreater(slips.sum(), 300)
        light = np.corrcoef(white[row, inside][slips].sum(axis=-1), dark[row, inside][slips].sum(axis=-1))
        self.assertLess(light[0, 1], -0.9)


class Errors(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="amontons_render_")

    def tearDown(self):
        os.environ.pop("AMONTONS_FONT", None)
        shutil.rmtree(self.folder)

    def expect(self, code, *words, figures=()):
        got, message = render(self.folder, *figures)
        self.assertEqual(got, code, message)
        for word in words:
            self.assertIn(word, message)
        pictures = os.path.join(self.folder, "figures")
        left = os.listdir(pictures) if os.path.isdir(pictures) else []
        self.assertEqual(left, [], "nothing half done is left")

    def test_unknown_figure(self):
        fixture.make(self.folder)
        self.expect(ERROR_INPUT, "slipmap", "force, slip-map, contact-density, contact-area, state-map, contact-plane, precursors, front-speed, "
                    "probes, pads, profile, field, field-strip",
                    figures=("force", "slipmap"))

    def test_no_folder(self):
        code, message = render(self.folder + "/nowhere")
        self.assertEqual(code, ERROR_INPUT)
        self.assertIn("nowhere", message)

    def test_no_history(self):
        self.expect(ERROR_INPUT, self.folder)

    def test_too_few_steps(self):
        for kept, words in ((0, "0 steps"), (1, "1 step")):
            def cut(data, _):
                for name in data:
                    if name.startswith(("series/", "interface/")):
                        data[name] = data[name][:kept]
            fixture.make(self.folder, change=cut)
            self.expect(ERROR_INPUT, words, self.folder)

    def test_rod_at_rest(self):
        def rest(data, _):
            data["series/rod_displacement"] = data["series/rod_displacement"] * 0
        fixture.make(self.folder, change=rest)
        self.expect(ERROR_INPUT, "rod does not move")

    def test_missing_number(self):
        def forget(data, attributes):
            del attributes["critical_velocity"], attributes["rod_velocity"]
        fixture.make(self.folder, change=forget)
        self.expect(ERROR_INPUT, "critical velocity", figures=("contact-density",))
        self.expect(ERROR_INPUT, "how fast the rod moves", figures=("slip-map",))

    def test_last_rows_not_flushed(self):
        """A run killed between two series: what all of them have is drawn."""
        def shorten(data, _):
            data["interface/slip_rate"] = data["interface/slip_rate"][:-40]
            data["series/mu"] = data["series/mu"][:-20]
        fixture.make(self.folder, change=shorten)
        self.assertEqual(render(self.folder, "force", "slip-map", "contact-density"), (0, ""))

    def test_arrays_that_do_not_fit(self):
        def narrow(data, _):
            data["interface/slip_rate"] = data["interface/slip_rate"][:, :-1]
        fixture.make(self.folder, change=narrow)
        self.expect(ERROR_FILE, "interface/slip_rate", "80", "81", figures=("slip-map",))

    def test_infinite_numbers(self):
        """No run writes them."""
        def infinite(data, _):
            data["interface/slip_rate"][5:50] = np.inf
        fixture.make(self.folder, change=infinite)
        self.expect(ERROR_FILE, "interface/slip_rate holds inf, beyond all measure", figures=("slip-map",))

    def test_fonts(self):
        fixture.make(self.folder)
        os.environ["AMONTONS_FONT"] = self.folder + "/proc/none.ttf"
        self.expect(ERROR_LIBRARY, "none.ttf")
        os.environ["AMONTONS_FONT"] = os.path.join(self.folder, "history.h5")
        self.expect(ERROR_LIBRARY, "history.h5", "not a font")

    def test_folder_cannot_be_made(self):
        fixture.make(self.folder)
        with open(os.path.join(self.folder, "figures"), "w") as file:
            file.write("a file in the way")
        code, message = render(self.folder)
        self.assertEqual(code, ERROR_INPUT)
        self.assertIn("figures is a file, not a folder", message)

    def test_name_is_taken(self):
        """A folder stands where the picture should: no half picture is left beside it."""
        fixture.make(self.folder)
        os.makedirs(path_of(self.folder, "force"))
        code, message = render(self.folder)
        self.assertEqual(code, ERROR_INPUT)
        self.assertIn("force.png", message)
        self.assertEqual(os.listdir(os.path.join(self.folder, "figures")), ["force.png"])

    def test_old_picture_survives(self):
        """A picture that cannot be drawn leaves the earlier one alone."""
        fixture.make(self.folder)
        self.assertEqual(render(self.folder, "force")[0], 0)
        before = read_bytes(self.folder, "force")
        os.environ["AMONTONS_FONT"] = "/proc/none.ttf"
        self.assertEqual(render(self.folder, "force")[0], ERROR_LIBRARY)
        self.assertEqual(read_bytes(self.folder, "force"), before)


class Fields(unittest.TestCase):
    """The block of a short run, drawn by the program: colours at nodes give back what its .vtu holds there."""

    @classmethod
    def setUpClass(cls):
        cls.program = os.path.join(os.environ.get("AMONTONS_BIN", MODULES), "amontons")
        cls.folder = tempfile.mkdtemp(prefix="amontons_fields_")
        with open(os.path.join(cls.folder, "scene.yaml"), "w") as file:
            file.write(SCENE.format(meshes=os.path.join(os.environ["AMONTONS_SOURCE"], "meshes")))
        cls.result = os.path.join(cls.folder, "result")
        cls.done = cls.call("run", os.path.join(cls.folder, "scene.yaml"), "-o", cls.result, "--quiet")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def call(cls, *words):
        return subprocess.run([cls.program, *words], capture_output=True, text=True)

    def read_frame(self, number):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(os.path.join(self.result, "fields", f"bulk_{number:06d}.vtu"))
        reader.Update()
        points = reader.GetOutput().GetPointData()
        return {"position": vtk_to_numpy(reader.GetOutput().GetPoints().GetData()),
                **{points.GetArrayName(k): vtk_to_numpy(points.GetArray(k))
                   for k in range(points.GetNumberOfArrays())}}

    def test_at_the_end_of_a_run(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.assertTrue(os.path.exists(path_of(self.result, "field")))

    def test_colors_are_the_data(self):
        last = len(os.listdir(os.path.join(self.result, "fields"))) // 2 - 1
        done = self.call("render", self.result, "--figure", "field", "--of", "stress_xz", "--at", "U=0.0037")
        self.assertEqual(done.returncode, 0, done.stderr)
        picture, data = read_picture(self.result, "field-stress_xz"), self.read_frame(last)
        frame = Frame(picture)
        moved = data["displacement"] - [data["displacement"][:, 0].mean(), 0, 0]
        words = self.magnification(moved, data["position"])
        place = data["position"] + words * moved
        low, high = place[:, 0].min(), place[:, 0].max()
        point = picture.shape[1] / (86 / 25.4 * 72)
        scale = (frame.right - frame.left - 20 * point) / (high - low)   # 15 and 5 points beside the block
        column = frame.left + 15 * point + (place[:, 0] - low) * scale
        row = frame.bottom - 7 * point - (place[:, 1] - place[:, 1].min()) * scale
        value = data["stress"][:, 2]
        inside = np.flatnonzero((data["position"][:, 0] > 0.2) & (data["position"][:, 0] < 0.8)
                                & (data["position"][:, 1] > 0.1) & (data["position"][:, 1] < 0.4))
        below = picture.copy()
        below[:int(frame.top) - 2] = 255   # without the power of ten above the bar
        colors, shares = bar_colors(below, frame.columns, frame)
        seen = []
        for i in inside:
            near = picture[int(row[i]) - 3:int(row[i]) + 4, int(column[i]) - 3:int(column[i]) + 4].reshape(-1, 3)
            away = np.abs(near[:, None] - colors[None]).sum(axis=2)
            clean = away.min(axis=1) <= 6   # no contour line
            if clean.any():
                seen.append((value[i], np.median(shares[away[clean].argmin(axis=1)])))
        stored, read = np.array(seen).T
        self.assertGreater(len(seen), 20)
        slope, start = np.polyfit(read, stored, 1)
        self.assertLess(np.abs(start + slope * read - stored).max(), 0.02 * slope)
        ends = [start, start + slope]   # of the bar: round numbers, about the range of the field
        steps = (m * 10.0 ** k for k in range(-9, 3) for m in (1, 2, 5))
        step = next(step for step in steps if slope / step < 6.1)   # the bar has six of them at most
        for end in ends:
            self.assertLess(abs(end / step - round(end / step)) * step, 0.03 * slope)

    def test_rod_is_as_high_as_it_is(self):
        """Its mark reaches from where the face is at the rod's lower end to where it is at its upper end, between nodes, too:
        of this mesh one node lies within."""
        done = self.call("render", self.result, "--figure", "field", "--at", "U=0.0037")
        self.assertEqual(done.returncode, 0, done.stderr)
        picture, data = read_picture(self.result, "field").astype(int), self.read_frame(len(os.listdir(os.path.join(self.result, "fields"))) // 2 - 1)
        moved = data["displacement"] - [data["displacement"][:, 0].mean(), 0, 0]
        place = data["position"] + self.magnification(moved, data["position"]) * moved
        face = np.flatnonzero(data["position"][:, 0] == 0)
        face = face[np.argsort(data["position"][face, 1])]
        low, high = np.interp((0.225, 0.275), data["position"][face, 1], place[face, 1])
        frame, point = Frame(picture), picture.shape[1] / (86 / 25.4 * 72)
        scale = (frame.right - frame.left - 20 * point) / np.ptp(place[:, 0])
        red = np.abs(picture - (204, 56, 20)).max(axis=2) < 3
        strip = red[:, :int(frame.left + 16 * point)].sum(axis=0).max()   # pixels of its highest column
        self.assertAlmostEqual(strip, (high - low) * scale, delta=3)

    @staticmethod
    def magnification(moved, position):
        most = 0.05 * np.ptp(position, axis=0).max() / np.abs(moved).max()
        power = 10 ** np.floor(np.log10(most))
        return max(factor * power for factor in (1, 2, 5) if factor * power <= most)

    def test_all_fields_and_formats(self):
        for of in "displacement", "strain_energy", "dissipation":
            done = self.call("render", self.result, "--figure", "field", "--of", of, "--edges", "--dpi", "200", "--format", "svg")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue(os.path.exists(path_of(self.result, "field-" + of, "svg")))

    def test_strip(self):
        """Frames of the sliding, in their order, from its beginning to its end."""
        done = self.call("render", self.result, "--figure", "field-strip", "--format", "pdf")
        self.assertEqual(done.returncode, 0, done.stderr)
        words = subprocess.run(["pdftotext", "-bbox", path_of(self.result, "field-strip", "pdf"), "-"],
                               capture_output=True, text=True, check=True).stdout
        found = re.findall(r'xMin="([0-9.]+)" yMin="([0-9.]+)"[^>]*>(0\.00\d{4,})<', words)
        shown = [float(number) for x, y, number in sorted(found, key=lambda word: (round(float(word[1])), float(word[0])))]
        with open(os.path.join(self.result, "run.json")) as file:
            slidings = [event for event in json.load(file)["results"]["events"] if event["kind"] == "leading rapid"]
        self.assertGreaterEqual(len(shown), 2)
        self.assertEqual(shown, sorted(shown))
        self.assertAlmostEqual(shown[0], slidings[-1]["U_start"], delta=1e-6)
        self.assertAlmostEqual(shown[-1], slidings[-1]["U_stop"], delta=1e-6)

    def test_errors(self):
        cases = {("--of", "von-mises"): "von_mises, stress_xx", ("--at", "0.003"): "U=0.0117",
                 ("--at", "U=5"): "outside of the history, which goes from 0 to "}
        for words, expected in cases.items():
            done = self.call("render", self.result, "--figure", "field", *words)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(expected, done.stderr)
        done = self.call("run", os.path.join(self.folder, "scene.yaml"), "-o", self.folder + "/none", "--set", "output.fields=none")
        self.assertEqual(done.returncode, 2)
        self.assertIn("needs output.fields", done.stderr)
        os.makedirs(self.folder + "/without")
        fixture.make(self.folder + "/without")
        done = self.call("render", self.folder + "/without", "--figure", "field")
        self.assertEqual(done.returncode, 2)
        self.assertIn("output.fields", done.stderr)

    def test_a_picture_that_cannot_be_drawn(self):
        """It is a warning of the run, whose answers and other pictures are there."""
        result = self.folder + "/some"
        done = self.call("run", os.path.join(self.folder, "scene.yaml"), "-o", result, "--set", "time.until.U=1e-3",
                         "output.figures=[force, state-map, slip-map]", "output.fields=none")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("a picture is not drawn: figure state-map: the friction of this result remembers nothing", done.stderr)
        with open(os.path.join(result, "run.json")) as file:
            report = json.load(file)
        self.assertEqual((report["status"], [words for words in report["warnings"] if "state-map" in words]),
                         ("done", ["a picture is not drawn: figure state-map: the friction of this result remembers nothing: there is no state"]))
        self.assertEqual(sorted(name for name in os.listdir(result + "/figures") if name.endswith(".png")), ["force.png", "slip-map.png"])

    def test_damaged_file(self):
        """A .vtu that is cut off or has another grid's numbers is named."""
        copy = self.folder + "/copy"
        shutil.copytree(self.result, copy)
        path = os.path.join(copy, "fields", "bulk_000000.vtu")
        with open(path, "rb") as file:
            content = file.read()
        for damaged in content[:len(content) // 2], b"", content.replace(b"displacement", b"misplacement", 1):
            with open(path, "wb") as file:
                file.write(damaged)
            done = self.call("render", copy, "--figure", "field", "--at", "U=0")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("bulk_000000.vtu", done.stderr)


SCENE = """
units: normalised
mesh: {{file: {meshes}/block.geo, set: {{length: 1, height: 0.5, nx: 6, nz: 4, shape: quad, order: 2}}}}
material: {{young: 1, poisson: 0.34, density: 1, eta1: 1, eta2: 1}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-5, height: 0.25, width: 0.05}}
time: {{until: {{U: 0.0037}}}}
output: {{fields: {{every_U: 1e-3, at_events: true}}, figures: [field]}}
"""


if __name__ == "__main__":
    unittest.main()
