# SPDX-License-Identifier: GPL-2.0-or-later
"""The extremes that stress.py runs: settings of stress.yaml, and what is asked of each run."""
import math
from dataclasses import dataclass

# stress.yaml: P, V, v_c and how far the rod must go for the first slidings at that P
PRESSURE, VELOCITY, CRITICAL, WAY = 0.003, 1e-5, 3.4e-4, 0.005


@dataclass(frozen=True)
class Case:
    group: str
    name: str
    settings: list
    twin: object = ()          # settings of a scene with the same answer; (): finer steps; None
    agree: float = 0.02        # largest relative difference of the twins' first peaks
    may_refuse: bool = False   # no right answer need exist
    must_refuse: bool = False
    must_warn: bool = False
    late: bool = False         # the impact of the rod, not a peak, is the largest mu
    quick: bool = False        # belongs to the subset that CTest runs


def refused(group, name, settings, **more):
    return Case(group, name, settings, twin=None, may_refuse=True, must_refuse=True, **more)


def mesh(**settings):
    return [f"mesh.set.{name}={value}" for name, value in settings.items()]


def meshes():
    thin = "mesh"
    return [
        Case(thin, "cells 1000 times longer than high: a plate", mesh(nx=16, nz=64, height=0.004)),
        Case(thin, "cells 1000 times higher than long", mesh(nx=400, nz=1, height=2.5)
             + ["rod.height=1.25", "rod.width=2.5", "time.until.U=0.01"]),
        Case(thin, "graded 1e4 to 1 towards the contact", mesh(nx=16, nz=24, grade_z=1e4)
             + ["rod.width=0.3"], quick=True),
        Case(thin, "4 cells", mesh(nx=4, nz=2)),
        Case(thin, "1 cell", mesh(nx=1, nz=1) + ["rod.height=0.5", "rod.width=0.1"]),
        Case(thin, "400 x 2 cells", mesh(nx=400, nz=2) + ["rod.height=0.25", "rod.width=0.1",
                                                       "time.until.U=0.001"]),
        Case(thin, "400 cells, graded", mesh(nx=400, nz=8, grade_z=20)
             + ["rod.width=0.2", "time.until.U=0.001"]),
        Case(thin, "free triangles of order 2", mesh(nx=16, nz=8, shape="triangle", order=2,
                                                     layout="free")),
    ]


def loads():
    cases = []
    for power in (-4, -3, -2, -1, 1, 2, 3, 4):
        factor = 10.0**power
        cases.append(Case("pressure", f"{factor:g} P", [f"load.pressure={PRESSURE * factor}",
                          f"time.until.U={WAY * factor}",
                          f"rod.velocity={VELOCITY * min(factor, 1)}"], must_warn=power > 1,
                          may_refuse=power > 2, quick=power == -4))
    cases.append(Case("pressure", "1e-4 P, the rod as fast as ever: a blow", ["load.pressure=3e-7",
                      "time.until.U=5e-7"], late=True, may_refuse=True))
    for power in (-8, 8, -50, 50):
        factor = 10.0**power
        cases.append(Case("linear", f"P, V, v_c and U times {factor:g}; twin: times 1",
                          [f"load.pressure={PRESSURE * factor}", f"time.until.U={WAY * factor}",
                           f"rod.velocity={VELOCITY * factor}",
                           f"friction.critical_velocity={CRITICAL * factor}"],
                          twin=["time.until.U=0.005"], agree=1e-6, quick=power == 8))
    return cases


def materials():
    cases = [Case("poisson", f"nu {nu}, plane {plane}", [f"material.poisson={nu}",
                                                         f"material.plane={plane}"],
                  quick=(nu, plane) == (0.4999, "strain"))
             for nu, plane in ((0.4999, "stress"), (0.4999, "strain"), (0.5, "stress"),
                               (0, "stress"), (-0.99, "stress"))]
    cases.append(refused("poisson", "nu 0.5, plane strain",
                         ["material.poisson=0.5", "material.plane=strain"]))
    # At 1000 on 16 cells a node more in the precursor before it moves the first peak by 4 %.
    for ratio in (1e-3, 1e-2, 1e2, 1e3):
        finer = ["mesh.set.nx=32", "mesh.set.nz=16"] if ratio == 1e3 else []
        cases.append(Case("viscosity", f"eta2/eta1 = {ratio:g}",
                          [f"material.eta2={ratio}", *finer], quick=ratio == 1e3))
    for scale in (1e-1, 1e-2, 1e-3, 1e-6):
        cases.append(Case("viscosity", f"eta1 = eta2 = {scale:g}",
                          [f"material.eta1={scale}", f"material.eta2={scale}"], may_refuse=True,
                          must_warn=scale <= 1e-2))
    cases += [Case("viscosity", "none at all", ["material.eta1=0", "material.eta2=0"],
                   may_refuse=True, must_warn=True, quick=True),
              Case("viscosity", "eta1 = 0, eta2 = 1", ["material.eta1=0"], may_refuse=True,
                   must_warn=True),
              Case("viscosity", "none, constant friction",
                   ["material.eta1=0", "material.eta2=0", "friction.law=coulomb",
                    "friction.mu_kinetic=0.38"], may_refuse=True,
                   twin=["material.eta1=1e-2", "material.eta2=1e-2", "friction.law=coulomb",
                         "friction.mu_kinetic=0.38"])]
    return cases


def frictions():
    cases = [Case("friction", f"mu_S {high:g}, mu_K {low:g}",
                  [f"friction.mu_static={high}", f"friction.mu_kinetic={low}",
                   f"time.until.U={WAY * max(high, 1e-6) / 0.38}",
                   f"rod.velocity={VELOCITY * min(max(high, 1e-6) / 0.38, 1)}"], quick=high == 5)
             for high, low in ((1.2, 0.2), (5, 0.1), (5, 5), (0.38, 0), (1e-6, 1e-7), (0, 0))]
    for power in (-4, -3, -2, -1, 1, 2, 3, 4):
        factor = 10.0**power
        cases.append(Case("v_c", f"{factor:g} v_c",
                          [f"friction.critical_velocity={CRITICAL * factor}"],
                          must_warn=power <= -2, quick=power == -4))
    cases.append(Case("v_c", "1e-4 v_c, exponential", ["friction.law=exponential-weakening",
                      "friction.critical_velocity=3.4e-8"], must_warn=True))
    return cases


def drives():
    cases = [Case("V", f"{speed:g} v_c", [f"rod.velocity={speed * CRITICAL}"],
                  quick=speed in (1e-12, 1e-8), late=speed == 1)
             for speed in (1e-12, 1e-8, 1e-6, 1e-4, 1e-2, 1)]
    cases += [Case("V", f"{speed:g} v_c, U to 0.5", [f"rod.velocity={speed * CRITICAL}",
                                                     "time.until.U=0.5",
                                                     "time.energy_tolerance=0.01"],
                   quick=speed == 100, late=True)
              for speed in (10, 100)]
    cases.append(Case("V", "100 v_c, energy_tolerance 1e-3", [f"rod.velocity={100 * CRITICAL}",
                      "time.until.U=0.5"], may_refuse=True, late=True))
    backwards = "start.velocity_x=-1e-3"
    return cases + [
        refused("drive", "backwards: V below 0", ["rod.velocity=-1e-5"], quick=True),
        refused("drive", "V = 0", ["rod.velocity=0"]),
        Case("drive", "pulled: bonded to the leading face", ["groups.rod=leading",
             "rod.kind=bonded"]),
        refused("drive", "pushed on the leading face", ["groups.rod=leading"]),
        Case("drive", "thrown backwards, away from the rod", [backwards], late=True,
             quick=True),
        Case("drive", "thrown backwards, rod bonded: slip reverses", [backwards,
             "rod.kind=bonded"], late=True),
        Case("drive", "thrown forwards at 1000 V, rod bonded", ["start.velocity_x=1e-2",
             "rod.kind=bonded"], late=True, may_refuse=True),
        Case("drive", "rod held while the block relaxes, bonded", ["start.rod=held",
             "rod.kind=bonded"]),
    ]


def shapes():
    tall = mesh(height=5, nx=4, nz=20) + ["friction.mu_static=1", "time.until.U=0.5"]
    pads = ["mesh.file=../../meshes/pads.geo", "mesh.set={}"]
    return [
        Case("tall", "H = 5 L, pushed at 0.9 H: tips", tall + ["rod.height=4.5"], may_refuse=True,
             quick=True),
        Case("tall", "H = 5 L, pushed at 0.1 H: slides", tall + ["rod.height=0.5"]),
        Case("tall", "H = 2 L, pushed at the top", mesh(height=2, nx=8, nz=16)
             + ["rod.height=1.9", "rod.width=0.2", "time.until.U=0.05"], may_refuse=True),
        Case("feet", "one foot of 1e-4 L", pads + mesh(n=1, contact_length=1e-4, cells_pad=1, nz=8)
             + ["time.until.U=1e-4"], may_refuse=True),
        Case("feet", "one foot of 0.1 L, one cell", pads + mesh(n=1, contact_length=0.1,
             cells_pad=1, nz=8), may_refuse=True, quick=True),
        Case("feet", "4 pads, the last 1000 times as long", pads + mesh(n=4, pad_ratio=1000,
             cells_pad=4, nz=8)),
        Case("feet", "4 pads 1e-3 high", pads + mesh(n=4, pad_height=1e-3, cells_pad=4, nz=8)),
        Case("feet", "4 pads 10 times as high as long", pads + mesh(n=4, pad_height=1.5, fill=0.6,
             cells_pad=4, cells_pad_height=20, nz=8)
             + ["rod.height=1.75", "time.until.U=0.05"], may_refuse=True),
        Case("feet", "12 pads, friction 5", pads + mesh(n=12, cells_pad=2, cells_gap=2, nz=6)
             + ["friction.mu_static=5", "time.until.U=0.05"], may_refuse=True, must_warn=True,
             twin=None),   # the mesh does not bear it, and it takes 20 s
    ]


def steps():
    usual = []   # twin: the scene as it is
    return [
        Case("steps", "proposed 1e4 times too long", ["time.step_max=84000", "time.wave_step=1"],
             quick=True),
        Case("steps", "proposed 1e4 times too long, tolerance 1", ["time.step_max=84000",
             "time.wave_step=1", "time.tolerance=1"], agree=0.05, may_refuse=True),
        Case("steps", "none shorter than 10", ["time.step_min=10", "time.step_max=100"],
             may_refuse=True, twin=usual or ["title=usual"]),
        Case("steps", "tolerance 1e-7", ["time.tolerance=1e-7"], twin=["title=usual"], agree=0.005),
        Case("steps", "tolerance 1e-12", ["time.tolerance=1e-12", "time.until.U=1e-4"],
             may_refuse=True, twin=["title=usual", "time.until.U=1e-4"], agree=0.005, late=True),
        Case("steps", "wave_step 1e-4", ["time.wave_step=1e-4", "time.until.U=0.0026"],
             twin=["time.until.U=0.0026"]),
        Case("steps", "until U = 1e-12", ["time.until.U=1e-12"],
             twin=None),
        Case("steps", "relaxed to 1e-15 of V", ["start.tolerance=1e-15"], may_refuse=True),
        Case("steps", "no time to relax", ["start.duration_max=1e-6"], may_refuse=True),
        Case("steps", "undeformed at t = 0", ["start.state=undeformed"],
             may_refuse=True),
        Case("steps", "undeformed, energy_tolerance 0.05", ["start.state=undeformed",
             "time.energy_tolerance=0.05"]),
        Case("steps", "reduction to 1e-12", ["reduction.tolerance=1e-12", "reduction.use=always"],
             twin=["reduction.use=never"], agree=1e-4),
        Case("steps", "reduction at will", ["reduction.tolerance=1", "reduction.use=always"],
             agree=0.02),
    ]


def si(length, young, density):
    """The same scene in SI: one block length is L0 = eta/sqrt(rho E)."""
    speed = math.sqrt(young / density)
    viscosity = length * math.sqrt(density * young)
    values = {"units": "si", "material.young": young, "material.density": density,
              "material.eta1": viscosity, "material.eta2": viscosity,
              "load.pressure": PRESSURE * young, "rod.velocity": VELOCITY * speed,
              "friction.critical_velocity": CRITICAL * speed, "time.until.U": WAY * length,
              "mesh.set.length": length, "mesh.set.height": length / 2}
    return [f"{key}={value}" for key, value in values.items()]


def units():
    cases = [Case("units", f"SI: L {length:g} m, E {young:g} Pa, rho {density:g}; twin: normalised",
                  si(length, young, density), twin=["title=usual"], agree=1e-5,
                  quick=length == 1e-9 and young == 70e9)
             for length, young, density in ((1, 70e9, 2700), (1e-9, 70e9, 2700), (1e6, 70e9, 2700),
                                            (1e-9, 1e-6, 1e-3), (1e6, 1e15, 1e6), (1e-3, 1, 1e4),
                                            (1e-30, 1e9, 1e3), (1e30, 1e9, 1e3))]
    return cases


def listed(quick):
    cases = [Case("base", "stress.yaml as it is", [], quick=True)]
    for group in (meshes, loads, materials, frictions, drives, shapes, steps, units):
        cases += group()
    return [case for case in cases if case.quick] if quick else cases
