# SPDX-License-Identifier: GPL-2.0-or-later
"""output.probes: what points inside the bodies see, at every step.

Held against fields of the same run, interpolated by VTK; against a uniform state in closed form; and against FreeFem++ on
the same mesh, whose strains it evaluates itself at the points.
"""
import csv
import shutil
import subprocess
import textwrap
import unittest

import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkProbeFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from cache_fixture import OwnCache
from test_resume import FIG1, PROGRAM, SOURCE

MESHES = SOURCE / "meshes"
GAUGES = {"foot": [0.13, 0.04], "middle": [0.52, 0.23], "edge": [0.98, 0.46]}
SMALL = ["mesh.set={nx: 16, nz: 8, height: 0.5, length: 1}", "time.until={U: 0.004}", "output.figures=[]",
         "output.fields={every_U: 1e-3, at_events: true}"]

PATCH = """
mesh: {file: %s/block.geo, set: {nx: 6, nz: 4, shape: triangle, order: %d}}
material: {young: 2, poisson: 0.3, eta1: 1, eta2: 1}
friction: {law: coulomb, mu_static: 0}
load: {pressure: 0.003%s}
rod: {kind: none}
time: {until: {t: 1}}
output: {figures: [], probes: {a: {at: [0.21, 0.17]}, b: {at: [0.77, 0.42]}}}
"""

# Displacement and strain at the probes: FreeFEM's own elements and derivatives.
EDP = """
load "gmsh"
mesh Th = gmshload("block.msh");
fespace Vh(Th, P2);
Vh ux, uz, vx, vz;
real E = 2, nu = 0.3, dev = E/(1+nu), lam = E*nu/(1-nu^2);
solve glued([ux, uz], [vx, vz]) =
    int2d(Th)(dev*(dx(ux)*dx(vx) + dy(uz)*dy(vz)) + dev/2*(dy(ux)+dx(uz))*(dy(vx)+dx(vz))
              + lam*(dx(ux)+dy(uz))*(dx(vx)+dy(vz)))
  + int1d(Th, TOP)(0.003*vz) + on(CONTACT, ux=0, uz=0);
ofstream out("found.txt");
out.precision(15);
real[int] px = [0.21, 0.77], pz = [0.17, 0.42];
for (int k = 0; k < 2; k++) {
    real a = px[k], b = pz[k];
    out << ux(a,b) << " " << uz(a,b) << " " << dx(ux)(a,b) << " " << dy(uz)(a,b) << " "
        << (dy(ux)(a,b) + dx(uz)(a,b))/2 << endl;
}
"""


def probe_vtu(path, points):
    """Arrays of a .vtu at points [n, 3], and its time."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    places, wanted = vtkPoints(), vtkPolyData()
    places.SetDataTypeToDouble()
    for point in points:
        places.InsertNextPoint(*point)
    wanted.SetPoints(places)
    probe = vtkProbeFilter()
    probe.SetInputData(wanted)
    probe.SetSourceData(reader.GetOutput())
    probe.Update()
    data = probe.GetOutput().GetPointData()
    found = {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)).astype(float) for k in range(data.GetNumberOfArrays())}
    return found, reader.GetOutput().GetFieldData().GetArray("TimeValue").GetValue(0)


class Probes(OwnCache):
    def run_scene(self, scene, result, *settings, status=0):
        words = [PROGRAM, "run", scene, "-q", "--overwrite", "-o", self.folder / result]
        for setting in settings:
            words += ["--set", setting]
        done = subprocess.run(words, capture_output=True, text=True, timeout=300, env=self.environment)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr if status else self.folder / result

    def scene(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def arrays(self, folder):
        with h5py.File(folder / "history.h5") as file:
            found = {name: file[name][()] for name in
                     ("series/time", "probes/at", "probes/displacement", "probes/velocity", "probes/strain", "probes/stress")}
            self.assertEqual(file["probes/strain"].attrs["unit"], "1")
            found["names"] = file.attrs["probes"]
        return found

    def expect_vtu(self, folder, points):
        """At all times that both have."""
        found, times = self.arrays(folder), 0
        dim = found["probes/at"].shape[1]
        for path in sorted((folder / "fields").glob("bulk_*.vtu")):
            shown, time = probe_vtu(path, points)
            row = int(numpy.argmin(numpy.abs(found["series/time"] - time)))
            self.assertAlmostEqual(found["series/time"][row], time, delta=1e-9)
            self.assertTrue(numpy.all(shown["vtkValidPointMask"] == 1))
            for name in ("displacement", "velocity"):
                scale = numpy.max(numpy.abs(shown[name])) + 1e-30
                away = numpy.abs(found["probes/" + name][row] - shown[name][:, :dim])
                self.assertLessEqual(numpy.max(away), 1e-9 * scale, name)
            scale = numpy.max(numpy.abs(shown["stress"]))
            away = numpy.abs(found["probes/stress"][row] - shown["stress"])
            self.assertLessEqual(numpy.max(away), 1e-9 * scale)
            times += 1
        self.assertGreater(times, 2)
        return found

    def test_reduced_block_as_paraview_shows_it(self):
        probes = "output.probes=" + str({name: {"at": at} for name, at in GAUGES.items()}).replace("'", "")
        folder = self.run_scene(FIG1, "reduced", *SMALL, probes)
        found = self.expect_vtu(folder, [[x, z, 0] for x, z in GAUGES.values()])
        self.assertEqual(found["names"].decode() if isinstance(found["names"], bytes) else found["names"],
                         "foot\nmiddle\nedge")
        numpy.testing.assert_array_equal(found["probes/at"], list(GAUGES.values()))
        self.assertEqual(found["probes/strain"].shape[1:], (3, 3))
        self.assertEqual(len(found["probes/strain"]), len(found["series/time"]))
        whole = self.arrays(self.run_scene(FIG1, "whole", *SMALL, probes, "reduction.use=never"))
        scale = numpy.max(numpy.abs(whole["probes/strain"]))
        self.assertLess(numpy.max(numpy.abs(whole["probes/strain"][0] - found["probes/strain"][0])), 1e-3 * scale)

    def test_no_other_answer(self):
        """Neither the steps nor anything else of the run is changed by them; a run from the cache gets its modes."""
        plain = self.run_scene(FIG1, "plain", *SMALL[:3], "output.fields=none")
        seen = self.run_scene(FIG1, "seen", *SMALL[:3], "output.fields=none", "output.probes.g.at=[0.5, 0.1]")
        with h5py.File(plain / "history.h5") as one, h5py.File(seen / "history.h5") as other:
            numpy.testing.assert_array_equal(one["series/mu"][()], other["series/mu"][()])
            self.assertNotIn("probes", one)
            self.assertEqual(other["probes/strain"].shape[1:], (1, 3))

    def test_branches(self):
        folder = self.run_scene(FIG1, "branches", *SMALL, "material.relaxation=[{time: 20, shear: 0.2, bulk: 0.1}]",
                                "output.probes={a: {at: [0.3, 0.1]}, b: {at: [0.7, 0.3]}}")
        self.expect_vtu(folder, [[0.3, 0.1, 0], [0.7, 0.3, 0]])

    def test_both_bodies(self):
        scene = self.scene("bodies.yaml", f"""
mesh: {{file: {MESHES}/base.geo, set: {{nx: 12, nz: 6}}}}
material: {{poisson: 0.34}}
friction: {{law: linear-weakening, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003, supports: [{{group: bottom, direction: both}}]}}
rod: {{velocity: 1e-5, height: 0.25, width: 0.05}}
time: {{until: {{U: 0.002}}}}
output: {{figures: [], fields: {{every_U: 5e-4}}, probes: {{over: {{at: [0.37, 0.01]}}, under: {{at: [0.41, -0.2]}}}}}}
""")
        folder = self.run_scene(scene, "bodies")
        self.expect_vtu(folder, [[0.37, 0.01, 0], [0.41, -0.2, 0]])
        said = self.run_scene(scene, "away", "output.probes={deep: {at: [0.5, -30]}}", status=2)
        self.assertIn("the nearest node is one of the base, at", said)
        self.assertIn("outside of the block and its base", said)

    def test_space(self):
        scene = self.scene("space.yaml", f"""
mesh: {{file: {MESHES}/block3d.geo, set: {{length: 1, breadth: 0.5, height: 0.5, nx: 6, ny: 3, nz: 3}}}}
material: {{poisson: 0.34}}
friction: {{law: linear-weakening, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-5, height: 0.25, width: 0.1}}
time: {{until: {{U: 0.002}}}}
output: {{figures: [], fields: {{every_U: 5e-4}}, probes: {{g: {{at: [0.3, 0.2, 0.1]}}, h: {{at: [0.7, 0.4, 0.3]}}}}}}
""")
        folder = self.run_scene(scene, "space")
        found = self.expect_vtu(folder, [[0.3, 0.2, 0.1], [0.7, 0.4, 0.3]])
        self.assertEqual(found["probes/strain"].shape[1:], (2, 6))
        self.assertIn("[x, y, z]", self.run_scene(scene, "flat", "output.probes={g: {at: [0.3, 0.2]}}", status=2))

    def test_uniform_state(self):
        """Pressed on a plane without friction: sigma_zz = -P, all else 0, at every point."""
        for order in (1, 2):
            scene = self.scene("patch.yaml", PATCH % (MESHES, order, ""))
            found = self.arrays(self.run_scene(scene, "patch"))
            for k in range(2):
                numpy.testing.assert_allclose(found["probes/stress"][0, k], [0, -0.003, 0], atol=1e-9)
                numpy.testing.assert_allclose(found["probes/strain"][0, k], [0.3 * 0.0015, -0.0015, 0], atol=1e-9)
                numpy.testing.assert_allclose(found["probes/displacement"][0, k, 1],
                                              -0.0015 * found["probes/at"][k, 1], atol=1e-9)

    @unittest.skipUnless(shutil.which("FreeFem++") and shutil.which("gmsh"), "FreeFem++ and gmsh are not here")
    def test_freefem(self):
        """A glued block's gradients on one mesh: displacements agree as far as the block has relaxed, strains, which one
        program averages at nodes and the other takes in the element, as far as the mesh resolves them."""
        held = ", supports: [{group: contact, direction: both}]"
        scene = self.scene("glued.yaml", (PATCH % (MESHES, 2, held)).replace("nx: 6, nz: 4", "nx: 20, nz: 10"))
        found = self.arrays(self.run_scene(scene, "glued", "start.tolerance=1e-9"))
        subprocess.run(["gmsh", "-2", MESHES / "block.geo", "-setnumber", "nx", "20", "-setnumber", "nz", "10", "-setstring",
                        "shape", "triangle", "-format", "msh22", "-o", self.folder / "block.msh"], check=True,
                       capture_output=True)
        names = {}
        for line in (self.folder / "block.msh").read_text(encoding="utf-8").split("$EndPhysicalNames")[0].splitlines()[4:]:
            words = line.split()
            if len(words) == 3:
                names[words[2].strip('"')] = words[1]
        text = EDP.replace("TOP", names["top"]).replace("CONTACT", names["contact"])
        (self.folder / "glued.edp").write_text(textwrap.dedent(text), encoding="utf-8")
        done = subprocess.run(["FreeFem++", "-nw", "glued.edp"], cwd=self.folder, capture_output=True, text=True,
                              env={**self.environment, "FF_LOADPATH": "/usr/lib/freefem++"})
        self.assertEqual(done.returncode, 0, done.stdout)
        wanted = numpy.loadtxt(self.folder / "found.txt")
        numpy.testing.assert_allclose(found["probes/displacement"][0], wanted[:, :2], atol=1e-7 * 0.00075)
        numpy.testing.assert_allclose(found["probes/strain"][0], wanted[:, 2:], atol=2e-3 * 0.0015)

    def test_resumed_to_the_bit(self):
        words = [*SMALL[:1], "output.fields=none", "output.figures=[]", "output.probes.g.at=[0.5, 0.1]"]
        whole = self.arrays(self.run_scene(FIG1, "straight", *words, "time.until={U: 0.01}"))
        command = [PROGRAM, "run", FIG1, "-q", "-o", self.folder / "cut"]
        for setting in (*words, "time.until={U: 0.01}"):
            command += ["--set", setting]
        process = subprocess.Popen([*command, "--overwrite", "--checkpoint", "0.01s"], stderr=subprocess.PIPE, env=self.environment)
        while not (self.folder / "cut" / "checkpoint.bin").exists() and process.poll() is None:
            pass
        process.kill()
        process.communicate()
        if not (self.folder / "cut" / "run.json").exists():
            done = subprocess.run([*command, "--resume"], capture_output=True, text=True, env=self.environment)
            self.assertEqual(done.returncode, 0, done.stderr)
        found = self.arrays(self.folder / "cut")
        for name in ("series/time", "probes/displacement", "probes/velocity", "probes/strain", "probes/stress"):
            numpy.testing.assert_array_equal(found[name], whole[name])

    def test_window(self):
        folder = self.run_scene(FIG1, "window", *SMALL[:1], "output.fields=none", "output.figures=[]", "time.until={U: 0.008}",
                                "output.window={from_U: 3.3e-3, to_U: 3.4e-3, history: true}", "output.probes.g.at=[0.5, 0.1]")
        found = self.arrays(folder)
        self.assertGreater(len(found["series/time"]), 3)
        self.assertEqual(len(found["series/time"]), len(found["probes/strain"]))

    def render(self, folder, *words, status=0):
        done = subprocess.run([PROGRAM, "render", folder, "--dpi", "120", *words], capture_output=True, text=True, timeout=120,
                              env=self.environment)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr

    def table(self, path):
        with open(path, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        return {name: numpy.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}

    def test_figures(self):
        folder = self.run_scene(FIG1, "figures", *SMALL[:1], "time.until={U: 0.006}", "output.fields=none",
                                "output.probes={foot: {at: [0.2, 0.02]}, top: {at: [0.8, 0.4]}}", "output.figures=[probes]")
        self.assertTrue((folder / "figures" / "probes.png").exists())
        found, shown = self.arrays(folder), self.table(folder / "figures" / "probes.csv")
        for k, name in enumerate(("foot", "top")):
            for c, axes in enumerate(("xx", "zz", "xz")):
                numpy.testing.assert_allclose(shown[f"{name} strain_{axes}"], found["probes/strain"][:, k, c], rtol=1e-8)
                numpy.testing.assert_allclose(shown[f"{name} stress_{axes}"], found["probes/stress"][:, k, c], rtol=1e-8)
            numpy.testing.assert_allclose(shown[f"{name} displacement_z"], found["probes/displacement"][:, k, 1], rtol=1e-8)
        self.render(folder, "--figure", "probes", "--of", "velocity", "--from", "U=0.001")
        self.assertTrue((folder / "figures" / "probes-velocity.png").exists())
        self.assertIn("known are: strain, stress, displacement, velocity",
                      self.render(folder, "--figure", "probes", "--of", "force", status=2))

    def test_profile(self):
        """Around a sliding: equal loads before and after it; with --at the arrays of the history; what is open has a gap."""
        folder = self.run_scene(FIG1, "profile", *SMALL[:1], "time.until={U: 0.008}", "output.fields=none", "output.figures=[]")
        self.render(folder, "--figure", "profile")
        shown = self.table(folder / "figures" / "profile.csv")
        moments = list(dict.fromkeys(shown["U"]))
        self.assertEqual(len(moments), 3)
        with h5py.File(folder / "history.h5") as file:
            series = {name: file[name][()].astype(float) for name in
                      ("series/rod_displacement", "series/mu", "interface/pressure", "interface/shear", "interface/slip",
                       "interface/gap", "interface/status")}
        load = [shown["F_T/F_N"][shown["U"] == U][0] for U in moments]
        self.assertAlmostEqual(load[0], load[2], delta=0.02)
        self.assertGreater(load[1], load[0] + 0.1)
        rows = [int(numpy.argmin(numpy.abs(series["series/rod_displacement"] - U))) for U in moments]
        for U, row in zip(moments, rows):
            here = shown["U"] == U
            numpy.testing.assert_allclose(shown["p"][here], series["interface/pressure"][row], rtol=1e-7, atol=1e-12)
            numpy.testing.assert_allclose(shown["gap"][here], series["interface/gap"][row], rtol=1e-7, atol=1e-12)
            numpy.testing.assert_allclose(shown["slip"][here], series["interface/slip"][row] - series["interface/slip"][rows[0]],
                                          rtol=1e-6, atol=1e-12)
            numpy.testing.assert_array_equal(numpy.isnan(shown["tau/p"][here]), series["interface/status"][row] == 0)
        is_open = series["interface/status"] == 0
        self.assertTrue(numpy.any(is_open))
        self.assertTrue(numpy.all(series["interface/gap"][is_open] >= -1e-12))
        self.assertTrue(numpy.all(series["interface/gap"][~is_open] == 0))
        self.render(folder, "--figure", "profile", "--at", "mu=0.2")
        shown = self.table(folder / "figures" / "profile.csv")
        self.assertGreaterEqual(len(set(shown["U"])), 2)
        self.assertLess(numpy.max(numpy.abs(shown["F_T/F_N"] - 0.2)), 0.02)
        self.render(folder, "--figure", "profile", "--at", "U=0.001,U=0.002")
        self.assertIn("never rises through 0.9", self.render(folder, "--figure", "profile", "--at", "mu=0.9", status=2))
        for moment in "U=0.5", "t=-20":
            self.assertIn("outside of the history", self.render(folder, "--figure", "profile", "--at", moment, status=2))

    def test_compare(self):
        """Made measurements: strains off by 2 and 3 per cent, in millionths; the misfit by its definition."""
        folder = self.run_scene(FIG1, "compare", *SMALL[:1], "time.until={U: 0.004}", "output.fields=none", "output.figures=[]",
                                "output.probes={foot: {at: [0.2, 0.02]}, top: {at: [0.8, 0.4]}}")
        found = self.arrays(folder)
        with h5py.File(folder / "history.h5") as file:
            U, mu = file["series/rod_displacement"][()], file["series/mu"][()]
        rows = numpy.unique(numpy.searchsorted(U, numpy.linspace(0.0005, 0.0035, 20)))
        foot, top = found["probes/strain"][rows, 0, 2], found["probes/strain"][rows, 1, 0]
        lines = ["U,F_T/F_N,foot strain_xz (um/m),top strain_xx,top strain_xx error"]
        lines += [",".join(repr(float(value)) for value in (U[row], mu[row] + 0.01, 1.02e6 * a, 1.03 * b, abs(b)))
                  for row, a, b in zip(rows, foot, top)]
        lines += ["5,0.1,0,0,1"]     # beyond the end of the run
        measured = self.folder / "measured.csv"
        measured.write_text("\n".join(lines) + "\n", encoding="utf-8")
        done = subprocess.run([PROGRAM, "compare", folder, measured], capture_output=True, text=True, env=self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(folder / "figures" / "misfit.csv", encoding="utf-8", newline="") as file:
            misfits = {row["figure"]: row for row in csv.DictReader(file)}
        self.assertEqual(list(misfits), ["force", "probes"])
        self.assertAlmostEqual(float(misfits["force"]["misfit"]), 0.01, delta=1e-9)
        off = numpy.concatenate([0.02 * foot, 0.03 * top])
        self.assertAlmostEqual(float(misfits["probes"]["misfit"]) / numpy.sqrt(numpy.mean(off ** 2)), 1, delta=1e-6)
        self.assertEqual((misfits["probes"]["points"], misfits["probes"]["covered"]), (str(2 * len(rows) + 2), str(2 * len(rows))))
        self.assertIn("misfit 0.01, %d of %d points" % (len(rows), len(rows) + 1), done.stdout)
        names = {path.name for path in (folder / "figures").iterdir()}
        self.assertLessEqual({"force.png", "probes.png", "force-compared.csv", "probes-compared.csv"}, names)
        self.assertNotIn("slip-map.png", names)
        with open(folder / "figures" / "probes-compared.csv", encoding="utf-8", newline="") as file:
            self.assertEqual({row["column"] for row in csv.DictReader(file)}, {"foot strain_xz", "top strain_xx"})
        for words, said in (([folder], "a result folder and a table"), ([folder, self.folder / "no.csv"], "no.csv")):
            done = subprocess.run([PROGRAM, "compare", *words], capture_output=True, text=True, env=self.environment)
            self.assertEqual(done.returncode, 2)
            self.assertIn(said, done.stderr)

    def test_refused(self):
        def said(*settings):
            return self.run_scene(FIG1, "refused", *SMALL[:3], *settings, status=2)
        outside = said("output.probes={gauge: {at: [0.5, 0.7]}}")
        self.assertIn("`gauge` is at (0.5, 0.7), outside of the block", outside)
        self.assertIn("its nearest node is at (0.5, 0.5), 0.2 away", outside)
        self.assertIn("from (0, 0) to (1, 0.5)", outside)
        self.assertIn("allowed: [x, z]", said("output.probes={g: {at: [0.5, 0.1, 0.2]}}"))
        self.assertIn("a probe needs its `at`", said("output.probes={g: {}}"))
        self.assertIn("allowed: at", said("output.probes={g: {at: [0.5, 0.1], place: 3}}"))
        self.assertIn("there are none", said("output.figures=[probes]"))
        self.assertIn("need output.history: true", said("output.probes={g: {at: [0.5, 0.1]}}", "output.history=false"))


if __name__ == "__main__":
    unittest.main()
