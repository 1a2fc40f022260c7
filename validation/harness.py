# SPDX-License-Identifier: GPL-2.0-or-later
"""What the validation cases share: rows of the report, calls of amontons, gmsh and FreeFem++, and
the invariants that are checked on every result, whatever it is compared with."""
import json
import os
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

SOURCE = Path(__file__).resolve().parents[1]
PROGRAMS = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build/bin"))
FREEFEM = Path(__file__).resolve().parent / "freefem"

# name: shape, order and incomplete of meshes/block.geo
ELEMENTS = {"T3": ("triangle", 1, 0), "T6": ("triangle", 2, 0), "Q4": ("quad", 1, 0),
            "Q8": ("quad", 2, 1), "Q9": ("quad", 2, 0)}


@dataclass
class Row:
    """One line of the report. `reference` comes from outside, `ours` was computed just now."""
    group: str
    case: str
    quantity: str
    reference: object
    ours: object
    error: float
    tolerance: float
    order: str = ""        # of a convergence study: what is expected, and why
    seen: float = None     # order observed
    least: float = None    # the row fails where less is seen; given wherever `seen` is
    note: str = ""

    def __post_init__(self):
        assert (self.seen is None) == (self.least is None), "an order that is shown is required"

    @property
    def passed(self):
        rises = self.least is None or self.seen >= self.least
        return bool(np.isfinite(self.error)) and self.error <= self.tolerance and rises

    @property
    def order_text(self):
        if self.seen is None:
            return self.order
        return f"{self.order}, {self.seen:.2f} observed, at least {self.least:g} required"


@dataclass
class Control:
    """A deliberate mistake in the program, and what of `rows` and `invariants` it broke."""
    group: str
    mistake: str           # its name (validation/mistakes/mistake.h)
    broken: str            # what is wrong, in words
    rows: list
    invariants: list
    refused: str = ""      # the program's own error, where it did not get to a result

    @property
    def failed(self):
        return [r for r in self.rows if not r.passed]

    @property
    def broken_invariants(self):
        return [i for i in self.invariants if not i[2] <= i[3]]

    @property
    def caught(self):
        broke = bool(self.failed or self.broken_invariants or self.refused)
        return broke != (self.mistake == "none")   # which must break nothing


@dataclass
class Study:
    """What one validation run gathers. `quick`: the subset for CTest."""
    quick: bool = False
    folder: Path = None
    mistake: str = ""                                # run the program that makes it
    rows: list = field(default_factory=list)
    controls: list = field(default_factory=list)
    invariants: list = field(default_factory=list)   # (case, name, value, tolerance)
    charts: list = field(default_factory=list)       # Chart
    count: int = 0

    def new_folder(self, name):
        self.count += 1
        return self.folder / f"{self.count:03d}-{name}"

    def add(self, *arguments, **named):
        self.rows.append(Row(*arguments, **named))

    def check(self, case, name, value, tolerance):
        self.invariants.append((case, name, float(value), tolerance))

    def call(self, program, words):
        """Runs `program` of ours, or its mistaken twin; bases of shapes are this study's own."""
        name = f"{program}_mistaken" if self.mistake else program
        environment = dict(os.environ, AMONTONS_MISTAKE=self.mistake,
                           AMONTONS_CACHE=str(self.folder / "cache"))
        return call([PROGRAMS / name, *words], env=environment)

    def control(self, group, mistake, broken, compute):
        """compute(study), whose rows pass, on the program with one function of it replaced."""
        study = Study(quick=True, folder=self.new_folder(mistake), mistake=mistake)
        (study.folder / "cache").mkdir(parents=True)
        for mesh in (self.folder / "cache").glob("*.mesh"):   # gmsh's, whatever is mistaken
            shutil.copy(mesh, study.folder / "cache")
        refused = ""
        try:
            compute(study)
        except Refused as error:
            refused = str(error)
        self.controls.append(Control(group, mistake, broken, study.rows, study.invariants, refused))


@dataclass
class Chart:
    """Curves for the report's page: name -> (x, y)."""
    title: str
    x_label: str
    y_label: str
    curves: dict
    logarithmic: bool = False


def relative(ours, reference):
    """The largest difference over the largest reference."""
    ours, reference = np.asarray(ours, float), np.asarray(reference, float)
    scale = np.abs(reference).max()
    return float(np.abs(ours - reference).max() / (scale if scale > 0 else 1))


def observed_order(sizes, errors):
    """Slope of log(error) against log(size) between the last two."""
    return float(np.log(errors[-2] / errors[-1]) / np.log(sizes[-2] / sizes[-1]))


# --- programs -------------------------------------------------------------------------------------

class Refused(RuntimeError):
    """A program of ours says that it found no result (exit status 1)."""


def call(words, **named):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, **named)
    if done.returncode == 1 and Path(words[0]).parent == PROGRAMS:
        raise Refused(f"{' '.join(map(str, words))}\n{done.stderr[-3000:]}")
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, words))}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done


def mesh_set(element, **more):
    """A scene's mesh.set for one of ELEMENTS."""
    shape, order, incomplete = ELEMENTS[element]
    values = {"shape": shape, "order": order, "incomplete": incomplete, **more}
    return "{" + ", ".join(f"{k}: {v}" for k, v in values.items()) + "}"


def settings(sets):
    return [word for key, value in sets.items() for word in ("--set", f"{key}={value}")]


class Static:
    """`amontons static`: sums in .results, arrays by node."""

    def __init__(self, study, scene, name, sets=None, slack=1):
        folder = study.new_folder(name)
        study.call("amontons", ["static", scene, "-q", "-o", folder, *settings(sets or {})])
        report = json.loads((folder / "static.json").read_text())
        self.results, self.errors, self.scene = report["results"], report["errors"], report["scene"]
        with h5py.File(folder / "static.h5") as file:
            self.position = file["nodes/position"][:]
            self.displacement = file["nodes/displacement"][:]
            self.reaction = file["nodes/reaction"][:]
            self.stress = file["nodes/stress"][:]
            self.contact = file["contact/node"][:]
            self.status = file["contact/status"][:]
            self.weight = file["contact/weight"][:]
            self.jump = file["contact/jump"][:]
        self.check(study, name, slack)

    def check(self, study, name, slack):
        """No penetration, no pull, the cone, complementarity; equations, forces, moments, energy.
        slack: how many times more rounding a badly conditioned bulk leaves."""
        u, r = self.jump, self.reaction[self.contact]
        length, force = np.abs(self.displacement).max(), np.abs(self.reaction).max()
        held = {s["group"] for s in self.scene["load"]["supports"]}
        if not any(g.startswith("contact") for g in held):
            drawn = self.position[self.contact, -1]   # a curved contact: gaps far larger than u, and r of open nodes is rounding
            gap, pressing, mu = (drawn + u[:, -1]) / max(length, drawn.max()), r[:, -1] / force, self.scene["friction"]["mu_static"]
            shear = np.linalg.norm(r[:, :-1], axis=1)
            if not any(self.scene.get("contact", {}).get(key) for key in ("gap", "profile")):
                study.check(name, "penetration", max(0, -gap.min()), 1e-15)
                study.check(name, "gap times pressure", np.abs(gap * pressing).max(), 1e-9 * slack if drawn.any() else 1e-12)
            study.check(name, "pull", max(0, -pressing.min()), 1e-9 * slack)
            # Each of its two terms is as exact as a reaction is: where mu is 100, as for "no slip", the second counts a hundredfold.
            study.check(name, "Coulomb cone", max(0, (shear / force - mu * pressing).max()), 1e-9 * (1 + mu) * slack)
            work = (r[:, :-1] * u[:, :-1]).sum(axis=1)
            study.check(name, "slip against friction", max(0, work.max() / force / length), 1e-10)
            study.check(name, "equilibrium: complementarity", self.errors["complementarity"], 1e-9 * slack)
        for key in ("residual", "force", "moment", "energy"):
            study.check(name, f"equilibrium: {key}", self.errors[key], 1e-9 * slack)


class Run:
    """`amontons run`: run.json in .report, history arrays by name. ledger: how far its energies may
    be off, of what was turned over; more than the 1e-3 that a scene allows is to be argued. moment: how far
    moments may be, of load times length; more than 1e-11 is to be argued. conditions: the same of those of contact, of the largest
    force (the solver's own limit is 1e-9 for each of its equations, of which a node in space has three)."""

    def __init__(self, study, scene, name, sets=None, ledger=1e-3, moment=1e-11, conditions=1e-9):
        self.folder = study.new_folder(name)
        study.call("amontons", ["run", scene, "-q", "-o", self.folder, *settings(sets or {})])
        self.report = json.loads((self.folder / "run.json").read_text())
        self.series = {}
        with h5py.File(self.folder / "history.h5") as file:
            for group in ("series", "interface", "nodes"):
                for key, item in file[group].items():
                    self.series[key] = item[:]
            self.series["pads/shear"] = file["pads/shear"][:]
        self.check(study, name, ledger, moment, conditions)

    def check(self, study, name, ledger, moment, conditions):
        """Every accepted step, as the run judged it (double precision), and once more from the
        stored history (single precision: 1e-6)."""
        errors, scene = self.report["errors"], self.report["scene"]
        study.check(name, "energy ledger", errors["energy"], ledger)
        study.check(name, "complementarity, all conditions of contact", errors["complementarity"], conditions)
        study.check(name, "penetration", errors["penetration"] / self.report["model"]["height"], 1e-15)
        if not scene["load"]["supports"]:   # they take up what moment there is
            study.check(name, "moment balance", errors["moment"], moment)
        if scene["time"]["scheme"] != "explicit":   # C v lags half a step there, by design
            # What rounding leaves of K u in a row, times the row's arm, is what it leaves of the moment; arms are 0.3 of the length
            # in the mean over a block, so that of all rows together it is 3.3 times that, and of one row less.
            study.check(name, "full equation", errors["equation"], max(1e-10, 3.3 * moment))
        pressure, shear = self.series["pressure"], self.series["shear"]
        scale, mu = np.abs(pressure).max() or 1.0, scene["friction"]["mu_static"]
        study.check(name, "pull", max(0, -pressure.min() / scale), 0)
        shear = np.linalg.norm(shear, axis=-1) if shear.ndim > pressure.ndim else np.abs(shear)     # a vector in space
        study.check(name, "Coulomb cone", max(0, (shear - mu * pressure).max() / scale), 1e-6)

    def __getitem__(self, key):
        return self.series[key]

    def frames(self):
        """[(time, positions, displacement, velocity)] of the fields that were written."""
        listing = (self.folder / "fields.pvd").read_text()
        entries = re.findall(r'timestep="([^"]+)"[^>]*file="(fields/bulk[^"]+)"', listing)
        for time, name in entries:
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(self.folder / name))
            reader.Update()
            grid = reader.GetOutput()
            arrays = [grid.GetPoints().GetData(), *map(grid.GetPointData().GetArray,
                                                       ("displacement", "velocity"))]
            axes = 2 if grid.GetBounds()[4:] == (0, 0) else 3   # VTK's third is 0 in the plane
            yield (float(time), *(vtk_to_numpy(a)[:, :axes].astype(float) for a in arrays))


def schemes():
    """The integrators there are: what the program itself allows for time.scheme."""
    done = subprocess.run([PROGRAMS / "amontons", "run", SOURCE / "validation/exact/creep.yaml", "--set",
                           "time.scheme=unknown"], capture_output=True, text=True)
    return re.search(r"time.scheme: .*allowed: one of (.+)", done.stderr).group(1).split(", ")


def make_mesh(path, geo, parameters, order=1):
    """gmsh meshes meshes/GEO.geo into msh 2.2; gives the physical numbers of its curves, surfaces and volumes."""
    words = ["gmsh", "-3" if geo.endswith("3d") else "-2", "-v", "1", SOURCE / "meshes" / f"{geo}.geo", "-format", "msh22", "-o", path]
    for key, value in {**parameters, "order": order}.items():
        words += ["-setstring" if isinstance(value, str) else "-setnumber", key, value]
    call(words)
    return dict((name, number) for number, name in
                re.findall(r'^[123] (\d+) "(\w+)"', Path(path).read_text(), re.M))


def freefem(script, order, mesh, curves, out):
    """Runs validation/freefem/SCRIPT.edp with P1 or P2 elements on the msh 2.2 file `mesh`."""
    environment = dict(os.environ, FF_LOADPATH="/usr/lib/freefem++",
                       FF_INCLUDEPATH=f"{FREEFEM}/P{order};{FREEFEM}")
    words = ["FreeFem++", "-nw", "-ne", "-v", "0", script, "-mesh", mesh, "-out", out]
    for name, number in curves.items():
        words += [f"-{name}", number]
    call(words, env=environment)
    return np.loadtxt(out)


def have_freefem():
    return shutil.which("FreeFem++") is not None


def match(points, others):
    """For each of `points` the row of `others` at the same place."""
    def key(p):
        return [tuple(q) for q in np.round(p, 9) + 0.0]
    where = {k: i for i, k in enumerate(key(others))}
    return np.array([where[k] for k in key(points)])


def scratch():
    return Path(tempfile.mkdtemp(prefix="amontons-validation-"))
