# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures and files of a block in space. Faces of the contact: each node's part is as large as its weight; in the .vtp
polygons that VTK's reader takes, with the history's vectors; .vtu that VTK's and meshio's readers take. The figure of the contact: each node has its
colour where it is. The block in perspective: only what is asked for is cut away."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import meshio_fixture

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
SCENE = f"""mesh: {{file: {SOURCE}/meshes/block3d.geo, set: {{length: 0.5, breadth: 0.4, height: 0.3, %s}}}}
material: {{poisson: 0.34}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 2e-5}}
time: {{until: {{U: %g}}}}
output: {{figures: [], fields: {{every_U: 5e-4, at_events: true}}}}
"""
HEXAHEDRA = "nx: 5, ny: 4, nz: 3"
BACKGROUND, STICK = (255, 255, 255), (249, 250, 251)


def array(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def picture(path):
    """[height, width, 3], first row at the top."""
    reader = vtk.vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(height, width, 3)[::-1].astype(int)


def polygon_areas(data):
    points = vtk_to_numpy(data.GetPoints().GetData())
    for k in range(data.GetNumberOfPolys()):
        cell = data.GetCell(k)
        x, y = points[[cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())], :2].T
        yield abs((x * numpy.roll(y, -1) - y * numpy.roll(x, -1)).sum()) / 2


# Nodes of order 2 in VTK's order: each stands between two corners.
EDGES = {"tetra10": ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)),
         "hexahedron27": ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))}


def near(pixels, color, tolerance=3):
    return (numpy.abs(pixels - numpy.array(color)) <= tolerance).all(axis=-1)


class SpacePictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.place.name)
        cls.run_scene("cube", HEXAHEDRA, 3.5e-3)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    @classmethod
    def run_scene(cls, name, sizes, until):
        path = cls.folder / f"{name}.yaml"
        path.write_text(SCENE % (sizes, until))
        subprocess.run([PROGRAM, "run", path, "-q", "-o", cls.folder / name], check=True, stdout=subprocess.DEVNULL)

    def render(self, name, *words, fails=False):
        done = subprocess.run([PROGRAM, "render", self.folder / name, "--overwrite", *words], capture_output=True, text=True)
        if fails:
            self.assertNotEqual(done.returncode, 0)
            return done.stderr
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def history(self, name):
        with h5py.File(self.folder / name / "history.h5") as file:
            return {f"{group}/{key}": item[()] for group in file for key, item in file[group].items()}

    def last_contact(self, name):
        path = sorted((self.folder / name / "fields").glob("*.vtp"))[-1]
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(path))
        reader.Update()
        data = reader.GetOutput()
        time = data.GetFieldData().GetArray("TimeValue").GetValue(0)
        return data, time

    def test_faces_carry_the_weights(self):
        """A corner of a parallelogram has a quarter of it, of a triangle a third; a mid-side of a T6 face too."""
        for name, sizes, each in (("cube", HEXAHEDRA, 4), ("tet4", "nx: 3, ny: 2, nz: 2, shape: tet", 3),
                                  ("tet10", "nx: 3, ny: 2, nz: 2, shape: tet, order: 2", 6)):
            if name != "cube":
                self.run_scene(name, sizes, 1e-4)
            arrays = self.history(name)
            faces, nodes = arrays["faces/nodes"], len(arrays["nodes/x"])
            self.assertEqual(faces.shape[1], each)
            places = numpy.column_stack([arrays["nodes/x"], arrays["nodes/y"]])
            if each == 6:
                places = numpy.vstack([places, arrays["faces/corners"]])
            corners = faces[:, :4 if each == 4 else 3]
            x, y = places[corners].transpose(2, 0, 1)
            size = numpy.abs((x * numpy.roll(y, -1, axis=1) - y * numpy.roll(x, -1, axis=1)).sum(axis=1)) / 2
            self.assertAlmostEqual(size.sum(), 0.5 * 0.4, 12)
            own = faces[:, 3:] if each == 6 else faces
            shares = numpy.bincount(own.ravel(), numpy.repeat(size / own.shape[1], own.shape[1]), nodes)
            numpy.testing.assert_allclose(shares, arrays["nodes/weight"], rtol=1e-12, atol=0)

    def test_polygons_and_vectors(self):
        data, time = self.last_contact("cube")
        arrays = self.history("cube")
        row = int(numpy.argmin(numpy.abs(arrays["series/time"] - time)))
        self.assertEqual((data.GetNumberOfPolys(), data.GetNumberOfLines(), data.GetNumberOfPoints()), (20, 0, 30))
        self.assertAlmostEqual(sum(polygon_areas(data)), 0.5 * 0.4, 12)
        points = vtk_to_numpy(data.GetPoints().GetData())
        numpy.testing.assert_allclose(points[:, 0], arrays["nodes/x"], atol=1e-15)
        numpy.testing.assert_allclose(points[:, 1], arrays["nodes/y"], atol=1e-15)
        scale = numpy.abs(arrays["interface/shear"]).max()
        self.assertEqual(array(data, "shear").shape, (30, 3))
        numpy.testing.assert_allclose(array(data, "shear")[:, :2], arrays["interface/shear"][row], atol=1e-6 * scale)
        numpy.testing.assert_allclose(array(data, "slip_rate")[:, :2], arrays["interface/slip_rate"][row], atol=1e-6 * 2e-5)
        self.assertTrue((array(data, "slip_rate")[:, 2] == 0).all())
        numpy.testing.assert_allclose(array(data, "pressure"), arrays["interface/pressure"][row], atol=1e-6 * 0.003)
        self.assertGreater(numpy.abs(array(data, "displacement")[:, 1]).max(), 0)   # the block gets wider

    def test_corners_that_touch_nothing(self):
        """Faces of TET10 are four triangles; the corner has the mean of the two mid-sides beside it on one of its faces."""
        self.run_scene("tets", "nx: 2, ny: 2, nz: 2, shape: tet, order: 2", 1e-4)
        data, _ = self.last_contact("tets")
        arrays = self.history("tets")
        faces, nodes = arrays["faces/nodes"], len(arrays["nodes/x"])
        self.assertEqual(data.GetNumberOfPolys(), 4 * len(faces))
        self.assertAlmostEqual(sum(polygon_areas(data)), 0.2, 12)
        pressure = array(data, "pressure")
        for corner in range(nodes, len(pressure)):
            beside = [pressure[[face[3 + k], face[3 + (k + 2) % 3]]].mean() for face in faces for k in range(3) if face[k] == corner]
            self.assertLess(numpy.abs(numpy.array(beside) - pressure[corner]).min(), 1e-12)

    def test_block_is_read(self):
        """By VTK and meshio alike: elements and points; the stresses six a point."""
        for sizes, kind in ((HEXAHEDRA, "hexahedron"), ("nx: 2, ny: 2, nz: 1, order: 2", "hexahedron27"),
                            ("nx: 2, ny: 2, nz: 2, shape: tet, order: 2", "tetra10"), ("nx: 2, ny: 2, nz: 2, shape: wedge", "wedge")):
            self.run_scene(kind, sizes, 1e-4)
            path = sorted((self.folder / kind / "fields").glob("*.vtu"))[-1]
            mesh = meshio_fixture.read(path)
            self.assertEqual([block.type for block in mesh.cells], [kind])
            self.assertEqual(mesh.point_data["stress"].shape, (len(mesh.points), 6))
            reader = vtk.vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(path))
            reader.Update()
            grid = reader.GetOutput()
            for k in range(grid.GetNumberOfCells()):
                nodes = mesh.cells[0].data[k]
                turned = [0, 2, 1, 3, 5, 4] if kind == "wedge" else slice(None)   # VTK's begins seen from outside, meshio's from inside
                self.assertEqual([grid.GetCell(k).GetPointId(i) for i in range(len(nodes))], list(nodes[turned]))
                sides = mesh.points[nodes[[1, 3 if "hexa" in kind else 2, 4 if "hexa" in kind else 3]]] - mesh.points[nodes[0]]
                self.assertGreater(numpy.linalg.det(sides), 0)
                for i, ends in enumerate(EDGES.get(kind, ())):
                    middle = mesh.points[nodes[list(ends)]].mean(axis=0)
                    self.assertLess(numpy.abs(mesh.points[nodes[len(set(sum(EDGES[kind], ()))) + i]] - middle).max(), 1e-12)
            numpy.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), mesh.points)

    def draw_up(self, name):
        """A history whose slip rates are known: one node is fast in the last step, the others stick."""
        source, target = self.folder / "cube", self.folder / name
        subprocess.run(["cp", "-r", source, target], check=True)
        with h5py.File(target / "history.h5", "r+") as file:
            rates = file["interface/slip_rate"]
            rates[...] = 0
            where = numpy.flatnonzero((numpy.abs(file["nodes/x"][:] - 0.3) < 1e-9) & (numpy.abs(file["nodes/y"][:] - 0.1) < 1e-9))
            rates[-1, where[0]] = (0, 2e-3)   # across the drive
            return file["series/rod_displacement"][-1]

    def test_each_node_has_its_colour(self):
        until = self.draw_up("drawn")
        self.render("drawn", "--figure", "contact-plane", "--at", f"U={until}", "--warnings", "none")
        pixels = picture(self.folder / "drawn/figures/contact-plane.png")
        inside = near(pixels, STICK, 1)
        rows, columns = numpy.flatnonzero(inside.sum(axis=1) > 300), numpy.flatnonzero(inside.sum(axis=0) > 300)
        top, bottom, left, right = rows[0], rows[-1], columns[0], columns[-1]
        self.assertAlmostEqual((bottom - top) / (right - left), 0.8, delta=0.02)   # to scale
        fast = pixels[top:bottom, left:right].sum(axis=2) < 250   # dark: 100 V on a scale up to 100
        y, x = numpy.nonzero(fast[3:-3, 3:-3])
        self.assertAlmostEqual((x.mean() + 3) / (right - left), 0.6, delta=0.01)
        self.assertAlmostEqual(1 - (y.mean() + 3) / (bottom - top), 0.25, delta=0.01)
        self.assertAlmostEqual(len(x) / fast.size, 1 / 20, delta=0.003)   # a cell's area around an inner node

    def odd_share(self, name, quantity, at, values):
        """Of the maps that `render` draws, how much has the colour of the odd node; the rest has one colour, too."""
        target = self.folder / "odd"
        subprocess.run(["cp", "-r", self.folder / name, target], check=True)
        with h5py.File(target / "history.h5", "r+") as file:
            times = file["series/rod_displacement"][:][list(at)]
            for array, value in values.items():
                file[array][...] = value
        self.render("odd", "--figure", "contact-plane", "--of", quantity, "--at", ",".join(f"U={U}" for U in times), "--dpi", "150",
                    "--warnings", "none")
        pixels = picture(target / f"figures/contact-plane-{quantity}.png").reshape(-1, 3)
        subprocess.run(["rm", "-r", target], check=True)
        colors, counts = numpy.unique(pixels, axis=0, return_counts=True)
        drawn = counts[(colors != BACKGROUND).any(axis=1)]
        most, odd = numpy.sort(drawn)[:-3:-1]
        return odd / (most + odd)

    def test_each_quantity(self):
        """One node differs from all others; it has its weight of the contact, also on faces of tetrahedra."""
        for name, sizes in (("cube", HEXAHEDRA), ("triangles", "nx: 3, ny: 2, nz: 2, shape: tet"),
                            ("triangles 2", "nx: 2, ny: 2, nz: 2, shape: tet, order: 2")):
            if name != "cube":
                self.run_scene(name, sizes, 3e-4)
            arrays = self.history(name)
            weight, rows = arrays["nodes/weight"], len(arrays["series/time"])
            for k, quantity in enumerate(("contact_density", "shear", "shear_over_pressure", "slip")):
                odd, other = numpy.argsort(weight)[[-1 - k, 0]]
                one = numpy.zeros((rows, len(weight)))
                one[:, odd] = 1
                if quantity == "slip":      # the other one has slipped as far from the first moment on
                    one[0, odd], one[:, other] = 0, 1
                vector = numpy.stack([one, 0 * one], axis=-1)
                values = {"contact_density": {"interface/slip_rate": 1e-3 * vector, "interface/status": 1},
                          "shear": {"interface/shear": 1 + vector},
                          "shear_over_pressure": {"interface/shear": 1 + vector, "interface/pressure": 5},
                          "slip": {"interface/slip": vector}}[quantity]
                at = (0, -1) if quantity == "slip" else (-1,)
                share = self.odd_share(name, quantity, at, values)
                self.assertAlmostEqual(share * len(at), weight[odd] / weight.sum(), delta=0.01, msg=f"{name} {quantity}")

    def test_lines(self):
        """Of a history in which nodes are as fast as their y says, each line has its own colour: that of its nodes alone."""
        target = self.folder / "lines"
        subprocess.run(["cp", "-r", self.folder / "cube", target], check=True)
        with h5py.File(target / "history.h5", "r+") as file:
            rates, y = file["interface/slip_rate"], file["nodes/y"][:]
            rates[...] = 0
            rates[:, :, 0] = 2e-7 * 10**(10 * y)[None, :]   # from V/100 at y = 0 to 100 V at 0.4
            del file["events"]
        found = []
        for words in ("y=0", "y=0.11", "y=0.4"):
            self.render("lines", "--figure", "slip-map", "--line", words, "--warnings", "none")
            pixels = picture(target / "figures/slip-map.png")
            middle = pixels[pixels.shape[0] // 2, pixels.shape[1] // 2]
            found.append(int(middle.sum()))
        self.assertTrue(found[0] > found[1] + 100 > found[2] + 200, found)   # the faster the darker
        self.assertIn("a line is given by its y", self.render("cube", "--figure", "slip-map", "--line", "0.2", fails=True))

    def test_moments(self):
        """Those that are asked for, up to twelve; without a word those of the last rapid event."""
        self.render("cube", "--figure", "contact-plane")
        self.render("cube", "--figure", "contact-plane", "--of", "arrival")
        self.render("cube", "--figure", "contact-plane", "--of", "pressure", "--at", "U=0.001,t=60", "--format", "pdf")
        drawn = {path.name for path in (self.folder / "cube/figures").iterdir()}
        self.assertTrue({"contact-plane.png", "contact-plane-arrival.png", "contact-plane-pressure.pdf"} <= drawn)
        self.assertIn("12 moments at most", self.render("cube", "--figure", "contact-plane", "--at", ",".join(["U=1e-3"] * 13), fails=True))
        self.assertIn("known are: slip_rate, contact_density,", self.render("cube", "--figure", "contact-plane", "--of", "wetness", fails=True))

    def test_what_is_cut_away(self):
        """Half of the block takes less paper; what is left is drawn as before."""
        words = ("--figure", "field", "--of", "displacement", "--warnings", "none", "--dpi", "300")
        self.render("cube", *words)
        whole = picture(self.folder / "cube/figures/field-displacement.png")
        self.render("cube", *words, "--cut", "y=0.2")
        half = picture(self.folder / "cube/figures/field-displacement.png")
        gone = ~near(whole, BACKGROUND) & near(half, BACKGROUND)
        come = near(whole, BACKGROUND) & ~near(half, BACKGROUND)
        self.assertGreater(gone.sum(), 0.02 * gone.size)
        self.assertLess(come.sum(), 0.002 * come.size)   # the rod's strip ends elsewhere
        self.assertIn("a cut is x, y or z", self.render("cube", "--figure", "field", "--cut", "q=1", fails=True))

    def test_film_and_page(self):
        for words in (("film", self.folder / "cube", "-o", self.folder / "cube.gif", "--seconds", "1", "--fps", "2", "--size", "640x360", "-q"),
                      ("report", self.folder / "cube", "-o", self.folder / "cube.html")):
            done = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater((self.folder / "cube.gif").stat().st_size, 5000)
        self.assertIn("slip rate over the contact at moments", (self.folder / "cube.html").read_text())

    def test_older_histories(self):
        """Without faces all is drawn but the contact as a plane, which says so."""
        target = self.folder / "older"
        subprocess.run(["cp", "-r", self.folder / "cube", target], check=True)
        with h5py.File(target / "history.h5", "r+") as file:
            del file["faces"]
        self.render("older")
        self.assertIn("does not have the faces of the contact", self.render("older", "--figure", "contact-plane", fails=True))
        self.assertFalse(json.loads((target / "run.json").read_text())["status"] != "done")


class Meshes(unittest.TestCase):
    def test_mesh(self):
        """A mesh in space by its groups: what looks away is not seen but in the key, both contacts (which bear numbers) are, below the block and as large."""
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/mesh.png"
            subprocess.run([PROGRAM, "info", SOURCE / "meshes/pads3d.geo", "--set", "n=2", "m=1", "fill_y=1", "--picture", path], check=True, stdout=subprocess.DEVNULL)
            pixels = picture(path)
            key = int(0.915 * len(pixels))
            colors = {"contact_1": (13, 115, 77), "contact_2": (115, 158, 26), "top": (26, 82, 168), "rod": (204, 56, 20), "leading": (204, 168, 204),
                      "left": (250, 237, 173), "right": (158, 158, 153)}
            seen = {name: near(pixels, color) for name, color in colors.items()}
            self.assertEqual([name for name, mask in seen.items() if not mask[key:].any()], ["contact_1", "contact_2"])
            part = {name: mask[:key].mean() for name, mask in seen.items()}
            self.assertEqual((part["leading"], part["right"]), (0, 0))
            self.assertGreater(min(part[name] for name in ("top", "rod", "left")), 0.03)
            self.assertAlmostEqual(part["contact_1"] / part["contact_2"], 1, delta=0.2)   # perspective
            rows = {name: numpy.flatnonzero(seen[name][:key].any(axis=1)) for name in ("contact_1", "top")}
            self.assertGreater(rows["contact_1"][0], rows["top"][-1])


if __name__ == "__main__":
    unittest.main()
