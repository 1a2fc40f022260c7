# SPDX-License-Identifier: GPL-2.0-or-later
"""What estimators.py has the program compute: mu_M of a block on a mesh, and the error that its elastic state shows
shortly before the first rapid event."""
import tempfile
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import zienkiewicz_zhu
from measured_run import run
from promise import QUIET, flow

GRADE = 4              # length of the leading cell over that of the trailing one
BEFORE = 0.98          # of the rod's way to the first rapid event
FIRST_PART = 1 / 6     # of a case's way, two slidings of some twelve: the first rapid event is in it
WRITTEN = 66           # states in it
EDGE = 0.1             # of length and height: what counts as near the rod's face, near the contact


def even(case, cells):
    return [flow(case.mesh | {"nx": cells, "nz": cells})]


def trailing(case, cells):
    """Cells get shorter towards the trailing end."""
    size = {key: case.mesh[key] for key in ("length", "height")}
    return ["mesh.file=../benchmark/trailing.geo", flow(size | {"n": cells, "grade": GRADE})]


def mesh_run(case, mesh):
    """mu_M on this mesh, and the processor time, mesh and reduction included."""
    with tempfile.TemporaryDirectory() as cache:
        ended = run(case.scene, [*QUIET, *case.settings, *mesh, f"load.pressure={case.pressure}",
                                 f"time.until={{U: {case.way:.6g}}}"], 600, cache=cache)
    return {"mu": ended.report["results"]["mu_M"], "seconds": ended.seconds}


def written(folder):
    """Time and file of each state that was written."""
    for entry in ElementTree.parse(Path(folder, "fields.pvd")).iter("DataSet"):
        if entry.attrib["name"] == "bulk":
            yield float(entry.attrib["timestep"]), Path(folder, entry.attrib["file"])


def read_state(file):
    """Position and displacement [node, 2] and cells [cell, 4]."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    position, displacement = (vtk_to_numpy(array)[:, :2].astype(float) for array in
                              (grid.GetPoints().GetData(), grid.GetPointData().GetArray("displacement")))
    return position, displacement, vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)


def state_error(case, cells):
    """Of the last state well before the first rapid event: relative error of its energy norm, where it comes from, and what
    the run and its fields cost."""
    way = FIRST_PART * case.way
    with tempfile.TemporaryDirectory() as folder:
        ended = run(case.scene, ["output.history=false", "output.figures=[]", f"output.fields={{every_U: {way / WRITTEN:.9g}}}",
                                 *case.settings, *even(case, cells), f"load.pressure={case.pressure}",
                                 f"time.until={{U: {way:.9g}}}"], 600, into=f"{folder}/state", cache=f"{folder}/cache")
        rapid = next(event["t_start"] for event in ended.report["results"]["events"] if event["kind"] != "quasi-static")
        time, file = max(pair for pair in written(f"{folder}/state") if pair[0] <= BEFORE * rapid)
        position, displacement, around = read_state(file)
    material = ended.report["scene"]["material"]
    energy, error = zienkiewicz_zhu.energies(position, displacement, around, material["young"], material["poisson"])
    middle = position[around].mean(axis=1) / position.max(axis=0)
    shares = (float(error[middle[:, axis] < EDGE].sum() / error.sum()) for axis in (0, 1))
    return {"relative": float(numpy.sqrt(error.sum() / (energy.sum() + error.sum()))), "before": time / rapid,
            "seconds": ended.seconds, **dict(zip(("at_rod_face", "at_contact"), shares))}


@dataclass(frozen=True)
class Plan:
    cases: slice
    cells: tuple       # along even meshes, twice as many each time
    looked_at: tuple   # those of them whose states are looked at, and beside which a mesh with short cells is put


FULL = Plan(slice(None), (10, 20, 40, 80), (20, 40))
QUICK = Plan(slice(2, 3), (3, 6, 12), (6, 12))


def compute(case, kept, before, plan, more):
    """Of one case: (name of the mesh, cells) -> run, and cells -> state. before: what promise.py kept; its runs on fixed meshes
    are the even ones here, and are taken from there. more: False: nothing is computed, None stands for what is not there."""
    def obtain(what, compute_one):
        return kept.obtain(case, what, compute_one) if more else kept.rows.get((case.name, what))

    def even_run(cells):
        return before.rows.get((case.name, f"fixed {cells}")) or \
            obtain(f"even {cells}", lambda: mesh_run(case, even(case, cells)))
    runs = {("even", n): even_run(n) for n in plan.cells}
    states = {n: obtain(f"state {n}", lambda n=n: state_error(case, n)) for n in plan.looked_at}
    runs |= {("trailing", n): obtain(f"trailing {n}", lambda n=n: mesh_run(case, trailing(case, n)))
             for n in plan.looked_at}
    return runs, states
