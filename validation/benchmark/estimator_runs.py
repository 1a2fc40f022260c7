# SPDX-License-Identifier: GPL-2.0-or-later
"""What estimators.py has the program compute: mu_M of a block on a mesh, and the error that its elastic state shows
shortly before the first rapid event."""
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import zienkiewicz_zhu
from measured_run import run
from promise import QUIET, WINDOW, flow

GRADE = 4          # the longest cell over the shortest
BEFORE = 0.98      # of the rod's way to the first rapid event
EDGE = 0.1         # of length and height: what counts as near the rod's face, near the contact
SHORTENED = {"trailing": f"short at the trailing end, 1 to {GRADE}", "ends": f"short at both ends, 1 to {GRADE}"}


@dataclass(frozen=True)
class Plan:
    cases: slice
    coarse: tuple      # cells along meshes with a run at each pressure, halved each time
    fine: tuple        # the same, one run
    factors: tuple     # of pressure
    shortened: tuple   # of SHORTENED


FULL = Plan(slice(None), (10, 20, 40), (80,), WINDOW, tuple(SHORTENED))
QUICK = Plan(slice(2, 3), (3, 6, 12), (), (1,), ("trailing",))


def mesh_settings(case, kind, cells):
    """kind: "even", or one of SHORTENED."""
    if kind == "trailing":
        size = {key: case.mesh[key] for key in ("length", "height")}
        return ["mesh.file=../benchmark/trailing.geo", flow(size | {"n": cells, "grade": GRADE})]
    return [flow(case.mesh | {"nx": cells, "nz": cells} | ({"grade_x": GRADE} if kind == "ends" else {}))]


def first_rapid(report):
    """The rod's way to the first rapid event; None: there is none."""
    return next((event["U_start"] for event in report["results"]["events"] if event["kind"] != "quasi-static"), None)


def mesh_runs(case, kind, cells, factors):
    """mu_M at these parts of the case's pressure, and the processor time of each run; the first makes mesh and reduction."""
    found = {"mu": [], "seconds": [], "rapid": None}
    with tempfile.TemporaryDirectory() as cache:
        for factor in factors:
            ended = run(case.scene, [*QUIET, *case.settings, *mesh_settings(case, kind, cells),
                                     f"load.pressure={case.pressure * factor:.9g}", f"time.until={{U: {case.way:.6g}}}"],
                        600, cache=cache)
            found["mu"].append(ended.report["results"]["mu_M"])
            found["seconds"].append(ended.seconds)
            if factor == 1:
                found["rapid"] = first_rapid(ended.report)
                found["nodes"] = ended.report["model"]["contact_nodes"]
    return found


def read_state(folder):
    """Position and displacement [node, 2] and cells [cell, 4] of the last state that was written."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(max(Path(folder, "fields").glob("bulk_*.vtu"))))
    reader.Update()
    grid = reader.GetOutput()
    position, displacement = (vtk_to_numpy(array)[:, :2].astype(float) for array in
                              (grid.GetPoints().GetData(), grid.GetPointData().GetArray("displacement")))
    return position, displacement, vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)


def state_error(case, cells, rapid):
    """Relative error of the state's energy norm, where it comes from, and what the run and its fields cost."""
    way = BEFORE * rapid
    with tempfile.TemporaryDirectory() as folder:
        # Fields come at the first step at or beyond each multiple: the last multiple is just within the run.
        ended = run(case.scene, ["output.history=false", "output.figures=[]",
                                 f"output.fields={{every_U: {0.499 * way:.9g}}}", *case.settings,
                                 *mesh_settings(case, "even", cells), f"load.pressure={case.pressure}",
                                 f"time.until={{U: {way:.9g}}}"], 600, into=f"{folder}/state", cache=f"{folder}/cache")
        position, displacement, around = read_state(f"{folder}/state")
    material = ended.report["scene"]["material"]
    energy, error = zienkiewicz_zhu.energies(position, displacement, around, material["young"], material["poisson"])
    middle = position[around].mean(axis=1) / position.max(axis=0)
    shares = (float(error[middle[:, axis] < EDGE].sum() / error.sum()) for axis in (0, 1))
    return {"relative": float(numpy.sqrt(error.sum() / (energy.sum() + error.sum()))), "seconds": ended.seconds,
            **dict(zip(("at_rod_face", "at_contact"), shares))}


def fine_runs(case, before, cells):
    """One run; taken from what promise.py has left, if it is there: its runs on fixed meshes are the same."""
    row = before.rows.get((case.name, f"fixed {cells}"))
    if row is None:
        return mesh_runs(case, "even", cells, (1,))
    return {"mu": [row["mu"]], "seconds": [row["seconds"]], "nodes": cells + 1}


def compute(case, kept, before, plan):
    """Everything of one case: (kind, cells) -> runs, and cells -> state. before: what promise.py kept."""
    def obtain(kind, cells, compute_one):
        return kept.obtain(case, f"{kind} {cells}", compute_one)
    meshes = {("even", n): obtain("even", n, lambda n=n: mesh_runs(case, "even", n, plan.factors)) for n in plan.coarse}
    states = {n: obtain("state", n, lambda n=n: state_error(case, n, meshes["even", n]["rapid"])) for n in plan.coarse[1:]}
    meshes |= {("even", n): obtain("even", n, lambda n=n: fine_runs(case, before, n)) for n in plan.fine}
    meshes |= {(kind, n): obtain(kind, n, lambda k=kind, n=n: mesh_runs(case, k, n, plan.factors))
               for kind in plan.shortened for n in plan.coarse[1:]}
    return meshes, states
