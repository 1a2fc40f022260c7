# SPDX-License-Identifier: GPL-2.0-or-later
"""What our writers store, read by programs that are not ours: VTK's Python reader, meshio, h5py.

The unit tests of io/fields/field_file and io/hdf5/result_file write their files into AMONTONS_TEST_OUTPUT; the
values come from formulas that both sides know, so every comparison is exact.
"""
import os
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

import h5py
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import meshio_fixture

TESTS = os.path.join(os.environ["AMONTONS_BIN"], "..", "tests")

K = numpy.arange(25)
POINTS = numpy.stack([0.1 * (K % 5), 0.1 * (K // 5), 0.0 * K], axis=1)
VECTORS = ((K + 1) / 3.0)[:, None] + numpy.arange(3.0)
SCALARS = 1.0 / (K + 7)
CELLS = [
    ("quad", 9, [0, 1, 6, 5]),
    ("quad8", 23, [1, 3, 13, 11, 2, 8, 12, 6]),
    ("quad9", 28, [10, 12, 22, 20, 11, 17, 21, 15, 16]),
    ("triangle", 5, [3, 4, 9]),
    ("triangle6", 22, [12, 14, 24, 13, 19, 18]),
]
LINES = [[0, 1], [1, 2], [2, 3], [3, 4]]
SERIES, STEPS, NODES = 18, 300, 5


def read_with_vtk(reader, path):
    failures = []
    reader.AddObserver("ErrorEvent", lambda *_: failures.append(path))
    reader.SetFileName(path)
    reader.Update()
    assert not failures, failures
    return reader.GetOutput()


def arrays_of(attributes):
    return {
        attributes.GetArrayName(k): vtk_to_numpy(attributes.GetArray(k))
        for k in range(attributes.GetNumberOfArrays())
    }


class Damaged(unittest.TestCase):
    def test_a_sentence_each(self):
        """Whatever is wrong with a .vtu, one line says it: none of VTK's own log."""
        with tempfile.TemporaryDirectory(prefix="amontons_fields_") as place:
            result = Path(place) / "result"
            program, scene = Path(os.environ["AMONTONS_BIN"]) / "amontons", Path(os.environ["AMONTONS_SOURCE"]) / "validation/paper/fig1.yaml"
            subprocess.run([program, "run", scene, "--set", "mesh.set.nx=8", "mesh.set.nz=8", "time.until.U=1e-3", "output.figures=[]",
                            "output.fields.every_U=1e-3", "-q", "-o", result], check=True, stdout=subprocess.DEVNULL)
            files = {path: path.read_bytes() for path in result.glob("fields/*.vtu")}
            for damage in (lambda b: b[:len(b) // 2] + bytes(200) + b[len(b) // 2 + 200:], lambda b: b[:3000], lambda b: b[:300],
                           lambda b: b"", lambda b: b"\n", lambda b: b.replace(b"vtkZLib", b"vtkNone"),
                           lambda b: b.replace(b'NumberOfCells="', b'NumberOfCells="9'), lambda b: b.replace(b"Points", b"Pionts"),
                           lambda b: b.replace(b"UnstructuredGrid", b"PolyData"), lambda b: b.replace(b'type="Float', b'type="Flaot')):
                for path, whole in files.items():
                    path.write_bytes(damage(whole))
                done = subprocess.run([program, "render", result, "--figure", "field"], capture_output=True, text=True)
                self.assertIn(done.returncode, (1, 2), done.stderr)
                where = r"(fields/bulk_\d+\.vtu|HDF5 or VTK crashes)"   # VTK does, where a type is unknown
                self.assertRegex(done.stderr, rf"\Aamontons: error: [^\n\x1b]*{where}[^\n\x1b]*\n\Z")
                self.assertNotIn("0x", done.stderr.replace(str(result), ""))   # no address; the name of the folder is chance


class FieldFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="amontons_fields_")
        environment = dict(os.environ, AMONTONS_TEST_OUTPUT=cls.folder.name)
        for program in ("test_io_field_file", "test_io_result_file"):
            subprocess.run([os.path.join(TESTS, program)], env=environment, check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def same(self, found, expected):
        self.assertEqual(found.shape, expected.shape)
        self.assertEqual(found.dtype, expected.dtype)
        numpy.testing.assert_array_equal(found, expected)

    def check_point_arrays(self, arrays, count):
        self.assertEqual(set(arrays), {"displacement", "von_mises"})
        self.same(arrays["displacement"], VECTORS[:count])
        self.same(arrays["von_mises"].ravel(), SCALARS[:count])

    def test_bulk_with_vtk(self):
        grid = read_with_vtk(vtk.vtkXMLUnstructuredGridReader(), self.path("bulk.vtu"))
        self.same(vtk_to_numpy(grid.GetPoints().GetData()), POINTS)
        self.assertEqual(grid.GetNumberOfCells(), len(CELLS))
        for k, (_, number, nodes) in enumerate(CELLS):
            cell = grid.GetCell(k)
            self.assertEqual(cell.GetCellType(), number)
            self.assertEqual([cell.GetPointId(n) for n in range(cell.GetNumberOfPoints())], nodes)
        self.check_point_arrays(arrays_of(grid.GetPointData()), 25)
        self.assertEqual(arrays_of(grid.GetFieldData())["TimeValue"].tolist(), [1.0 / 3.0])

    def test_bulk_with_meshio(self):
        mesh = meshio_fixture.read(self.path("bulk.vtu"))
        self.same(mesh.points, POINTS)
        self.assertEqual([block.type for block in mesh.cells], [name for name, _, _ in CELLS])
        for block, (_, _, nodes) in zip(mesh.cells, CELLS):
            self.assertEqual(block.data.tolist(), [nodes])
        self.check_point_arrays(mesh.point_data, 25)

    def test_interface_with_vtk(self):
        lines = read_with_vtk(vtk.vtkXMLPolyDataReader(), self.path("interface.vtp"))
        self.same(vtk_to_numpy(lines.GetPoints().GetData()), POINTS[:5])
        self.assertEqual(lines.GetNumberOfLines(), 4)
        self.assertEqual(lines.GetNumberOfCells(), 4)
        for k, nodes in enumerate(LINES):
            cell = lines.GetCell(k)
            self.assertEqual([cell.GetPointId(0), cell.GetPointId(1)], nodes)
        self.check_point_arrays(arrays_of(lines.GetPointData()), 5)
        self.assertEqual(arrays_of(lines.GetFieldData())["TimeValue"].tolist(), [1e-7])

    def test_collection(self):
        root = xml.etree.ElementTree.parse(self.path("fields.pvd")).getroot()
        self.assertEqual(root.attrib["type"], "Collection")
        rows = [(float(e.attrib["timestep"]), e.attrib["part"], e.attrib["name"], e.attrib["file"])
                for e in root.find("Collection")]
        self.assertEqual(rows, [
            (0.0, "0", "bulk", "fields/bulk_000000.vtu"),
            (0.0, "1", "interface", "fields/interface_000000.vtp"),
            (1.0 / 3.0, "0", "bulk", "fields/bulk_000001.vtu"),
            (1.0 / 3.0, "1", "interface", "fields/interface_000001.vtp"),
        ])

    def test_history_with_h5py(self):
        with h5py.File(self.path("history.h5"), "r") as history:
            self.assertEqual(history.attrs["title"], "Figure 1")
            self.assertEqual(history.attrs["units"], "normalised")
            self.assertEqual(history.attrs["critical_velocity"], 3.4e-4)
            self.assertEqual(history.attrs["mu_macroscopic"], 0.25)
            self.assertNotIn("critical_length", history.attrs)
            self.same(history["nodes/x"][:], numpy.linspace(0.0, 1.0, NODES))
            self.same(history["nodes/pad"][:], numpy.array([0, 0, 1, 1, 2], dtype=numpy.int32))
            self.same(history["peaks/U"][:], numpy.array([0.001, 0.0025, 0.004]))
            self.assertEqual(history["events/kind"].shape, (0,))
            self.assertNotIn("reach", history["events"])
            step, node = numpy.arange(STEPS)[:, None], numpy.arange(NODES)[None, :]
            found = {}
            for group in ("series", "interface"):
                for name, dataset in history[group].items():
                    found[group + "/" + name] = dataset[:].astype(float)
                    self.assertIsInstance(dataset.attrs["unit"], str)
                    self.assertGreater(len(dataset.attrs["description"]), 3)
            self.assertEqual(len(found), SERIES)
            # Each series is one of these patterns, and no two are the same one; those that choose have few values.
            choices = {"interface/status": 4, "series/certified": 2}
            seen = {}
            for name, values in found.items():
                at = 3 * step + node if values.ndim == 2 else 3 * step[:, 0]
                seen[name] = [s for s in range(SERIES) if (values == (7 * s + at) % choices.get(name, 250)).all()]
            sure = [seen[name][0] for name in found if name not in choices and len(seen[name]) == 1]
            left = set(range(SERIES)) - set(sure)
            self.assertEqual(len(sure), SERIES - len(choices))
            self.assertEqual(len(left), len(choices))
            for name in choices:
                self.assertTrue(left & set(seen[name]), name)
            self.assertEqual(seen["series/time"], [0])
            self.assertEqual(history["interface/slip_rate"].dtype, numpy.float32)
            self.assertEqual(history["interface/status"].dtype, numpy.uint8)
            self.assertEqual(history["interface/slip"].compression, "gzip")
            self.assertTrue(history["interface/slip"].shuffle)


if __name__ == "__main__":
    unittest.main()
