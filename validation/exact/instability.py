# SPDX-License-Identifier: GPL-2.0-or-later
"""Velocity-weakening friction against its exact growth rates, by time stepping (the command
`stability`: growth.py)."""
from pathlib import Path

import numpy as np

from harness import Chart, Run, observed_order

HERE = Path(__file__).resolve().parent
GROUP = "exact instability"


def exponents(t, v, rank):
    """The exponents of a sum of `rank` exponentials, fastest growth first (matrix pencil: Hua and
    Sarkar, IEEE Trans. Acoust. 38, 1990)."""
    columns = len(v) // 3
    hankel = np.array([v[i:i + columns + 1] for i in range(len(v) - columns)])
    _, _, right = np.linalg.svd(hankel, full_matrices=False)
    space = right[:rank].conj().T
    z = np.linalg.eigvals(np.linalg.pinv(space[:-1]) @ space[1:])
    s = np.log(z.astype(complex)) / (t[1] - t[0])
    s = s[np.abs(s.imag) * (t[1] - t[0]) < 1]   # faster is noise from sample to sample
    return s[np.argsort(-s.real)]


# --- a rigid block --------------------------------------------------------------------------------

def rigid_block(study):
    """rho H v' = tau - mu(v) P: v - v* grows as exp(lambda t), lambda = (mu_S - mu_K) P/(rho H v_c)."""
    exact, steady = 0.3 * 1e-3 / (0.1 * 1e-3), 5e-4
    errors, stiffness = [], [1e1, 1e2, 1e3]
    for young in stiffness[-1:] if study.quick else stiffness:
        run = Run(study, HERE / "rigid_block.yaml", "rigid-block", {"material.young": young})
        t, v = run["time"], run["slip_rate"].astype(float) @ run["weight"] / run["weight"].sum()
        # Until the law's kink; not before the pressure has settled, which moving off disturbs.
        linear = (v < 9.5e-4) & (t > 0.1)
        rate = np.polyfit(t[linear], np.log(np.abs(v[linear] - steady)), 1)[0]
        errors.append(abs(rate / exact - 1))
    study.add(GROUP, "rigid block", "growth rate", exact, rate, errors[-1], 1e-3,
              note="" if study.quick else "error at E = 10, 100, 1000: "
              + ", ".join(f"{e:.1e}" for e in errors))


# --- one shear column -----------------------------------------------------------------------------

SHEAR = 1 / (2 * 1.34)   # G for E = 1, nu = 0.34
V_C, V, MU = 1e-3, 9.2e-4, 4e-3


def dispersion(s, w, eta):
    """(G + eta s) q coth(q H) - s w, q = sqrt(rho s^2 / (G + eta s)), H = rho = 1."""
    q = np.sqrt(s * s / (SHEAR + eta * s))
    return (SHEAR + eta * s) * q / np.tanh(q) - s * w


def newton(s, w, eta):
    for _ in range(60):
        h = 1e-6
        slope = (dispersion(s + h, w, eta) - dispersion(s - h, w, eta)) / (2 * h)
        s = s - dispersion(s, w, eta) / slope
    return s


def exact_root(w, eta):
    """The root that grows fastest."""
    found = []
    with np.errstate(all="ignore"):
        for real in np.linspace(-1, 6, 15):
            for imaginary in np.linspace(0, 3, 7):
                s = newton(complex(real + 1e-3, imaginary), w, eta)
                if np.isfinite(s) and abs(dispersion(s, w, eta)) < 1e-9 and abs(s) > 1e-6:
                    found.append(s)
    best = max(found, key=lambda s: s.real)
    return complex(best.real, abs(best.imag))


def discrete_root(w, cells, eta=0.05):
    """The root of the same column cut into cells with lumped mass, the exact solution of what is
    stepped in time: cosh(k h) = 1 + h^2 s^2/(2 (G + eta s)), and at the base
    (h/2) s^2 + (G + eta s) (1 - u_1/u_0)/h = s w."""
    h, root = 1 / cells, exact_root(w, eta)

    def balance(s):
        mu = SHEAR + eta * s
        k = np.arccosh(1 + h * h * s * s / (2 * mu)) / h
        return h / 2 * s * s + mu * (1 - np.sinh(k * (1 - h)) / np.sinh(k)) / h - s * w
    for _ in range(60):
        slope = (balance(root + 1e-6) - balance(root - 1e-6)) / 2e-6
        root = root - balance(root) / slope
    return complex(root.real, abs(root.imag))


def column_settings(w, cells):
    p = w * V_C / MU
    return {"load.tractions": f"[{{group: contact, x: 0, z: {-p}}}, {{group: top, x: {0.08 * MU * p}, z: 0}}]",
            "mesh.set": f"{{width: {1 / cells}, nx: 1, nz: {cells}}}"}


def column_signal(study, w, cells, step, duration=8.0, disturb=2e-6, certificate=True):
    """Slip rate of the base less V, at even times while the law is linear. Read off the friction, which
    the history holds in double precision: tau = p (mu_S - mu_S v/v_c)."""
    run = Run(study, HERE / "column.yaml", "column",
              {**column_settings(w, cells), "start.velocity_x": V + disturb, "time.until.t": duration,
               "time.step_max": step, "time.step_min": step,
               "time.certificate": str(certificate).lower()})
    spread = np.abs(run["slip_rate"] - V).max(axis=1)
    end = np.argmax(spread > 0.07 * V_C) or len(spread)
    load = w * V_C / MU * run["weight"].sum()
    v = V_C * (1 - run["pads/shear"] / (MU * load)) - V
    return run["time"][:end], v[:end]


def column_root(study, w, cells, step, rank=8, after=0.3, **more):
    """Of the fastest exponential in the signal; `after` some time, when the modes that decay and are
    not among its `rank` have gone."""
    t, v = column_signal(study, w, cells, step, **more)
    start = int(after / step)
    s = exponents(t[start:], v[start:], rank)[0]
    return complex(s.real, abs(s.imag))


# What grows fast is followed from less, to have as many steps of it.
REAL = {"duration": 3.5, "rank": 4, "disturb": 1e-9, "after": 1.0}


def column(study):
    """Growth rates below, between and above the thresholds, on one mesh with one step. Allowed is what
    the cells leave, which converges at order 2 (below): more, the closer s is to being born."""
    cases = [(0.2, "growing oscillation", 0.01, 8, 8, 1e-3)]
    if not study.quick:
        cases += [(0.03, "decaying oscillation", 0.01, 8, 8, 1e-3), (0.5, "growing fast", 0.01, 5, 8, 2e-3),
                  (0.75, "real growth", 0.0025, 3, 4, 6e-3), (0.8, "real growth", 0.0025, 3, 4, 8e-3)]
    cells = 16 if study.quick else 64
    for w, text, step, duration, rank, allowed in cases:
        exact = exact_root(w, 0.05)
        more = REAL if rank == 4 else {"duration": duration}
        ours = column_root(study, w, cells, step, **more)
        study.add(GROUP, f"shear column, {cells} cells, w = {w:g}, {text}", "s = Re + i Im", f"{exact:.5f}",
                  f"{ours:.5f}", abs(ours - exact) / abs(exact), allowed)


def mesh_convergence(study):
    """Q4: order 2 in the cell; near the critical threshold, where s answers most, errors are large."""
    for w, cells, step, more in ((0.2, [8, 16, 32], 0.0025, {}),
                                 (0.75, [16, 32, 64], 0.0025, REAL)):
        exact, errors = exact_root(w, 0.05), []
        for n in cells:
            errors.append(abs(column_root(study, w, n, step, **more) - exact) / abs(exact))
        order = observed_order([1 / n for n in cells], errors)
        study.add(GROUP, f"shear column, w = {w:g}", "s on " + ", ".join(map(str, cells)) + " cells",
                  f"{exact:.5f}", ", ".join(f"{e:.1e}" for e in errors), errors[-1], 6e-3,
                  order="2 expected", seen=order, least=1.8)
        study.charts.append(Chart(f"Shear column, w = {w:g}: error of s in time",
                                  "h / H", "relative error", {"Q4": ([1 / n for n in cells], errors)}, True))


def step_convergence(study):
    """Against the exact root of the same cells: only the steps are left."""
    for w, steps, more in ((0.2, [0.32, 0.16, 0.08], {"duration": 12}),
                           (0.75, [0.08, 0.04, 0.02], REAL)):
        exact = discrete_root(w, 32)
        errors = [abs(column_root(study, w, 32, step, certificate=False, **more) - exact) / abs(exact)
                  for step in steps]
        study.add(GROUP, f"shear column, w = {w:g}", "s with dt = " + ", ".join(map(str, steps)),
                  f"{exact:.5f}", ", ".join(f"{e:.1e}" for e in errors), errors[-1], 2e-3,
                  order="2 expected", seen=observed_order(steps, errors), least=1.75)


def thresholds(study):
    """Where Re s = 0 (subcritical: eta/H, about), and where the pair becomes real (critical)."""
    exact = subcritical_exact()
    ws = [0.04, 0.08]
    rates = [column_root(study, w, 32, 0.01).real for w in ws]
    ours = ws[0] - rates[0] * (ws[1] - ws[0]) / (rates[1] - rates[0])
    study.add(GROUP, "shear column", "subcritical threshold of (mu_S - mu_K) p/v_c", exact, ours,
              abs(ours / exact - 1), 2e-3, note="linear between w = 0.04 and 0.08; eta/H = 0.05")
    exact = critical_exact()
    below = column_root(study, 0.66, 32, 0.01, duration=8, rank=4, disturb=1e-7, after=1.0)
    above = column_root(study, 0.72, 32, 0.0025, **REAL)
    bracket = 0.66 < exact < 0.72 and below.imag > 0.1 and above.imag < 1e-6
    near = 0.05 + 2 * np.sqrt(SHEAR / 3)
    study.add(GROUP, "shear column", "critical threshold: oscillating below, real above",
              f"{exact:.4f}", f"s(0.66) = {below:.3f}, s(0.72) = {above:.3f}", 0 if bracket else 1, 0,
              note=f"eta/H + 2 sqrt(rho G/3) = {near:.3f}")


def subcritical_exact():
    low, high = 0.0, 0.3
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if exact_root_near(middle) < 0 else (low, middle)
    return low


def exact_root_near(w):
    return newton(complex(0.01, 0.96), w, 0.05).real


def critical_exact():
    """The smallest w at which a real positive root exists: the minimum of w(s) over s > 0."""
    s = np.linspace(0.05, 8, 4000)
    q = np.sqrt(s * s / (SHEAR + 0.05 * s))
    return float(((SHEAR + 0.05 * s) * q / np.tanh(q) / s).min())


# --- without viscosity ----------------------------------------------------------------------------

def ill_posed(study):
    """Without viscosity the shortest wave that the mesh has grows fastest, so a disturbed steady slip
    ends the sooner the finer the mesh: no limit under refinement. With it there is one."""
    cells = [8, 16, 32] if study.quick else [8, 16, 32, 64]
    times = {eta: [stopping_time(study, n, eta) for n in cells] for eta in (0.5, 0.0)}
    ratio = {eta: t[-2] / t[-1] for eta, t in times.items()}
    shown = {eta: ", ".join(f"{x:.3g}" for x in t) for eta, t in times.items()}
    study.add(GROUP, "layer with viscosity", "time to lose half its speed, by mesh",
              "converges (ratio 1)", shown[0.5], abs(ratio[0.5] - 1), 0.02)
    study.add(GROUP, "layer without viscosity", "the same", "no limit (ratio about 2)", shown[0.0],
              max(0, 1.6 - ratio[0.0]), 0)
    study.charts.append(Chart("Time in which disturbed slip loses half its speed", "cells",
                              "time", {"eta1 = 0.5": (cells, times[0.5]),
                                       "eta1 = 0": (cells, times[0.0])}, True))
    said = warnings_of(study)
    study.add(GROUP, "layer without viscosity", "run.json warns", "yes", "yes" if said else "no",
              0 if said else 1, 0, note=said[:60])


LAYER = {"friction.mu_static": 0.4, "start.state": "undeformed", "rod.velocity": 9.5e-4, "start.velocity_x": 9.5e-4,
         "load.tractions": "[{group: contact, x: 0, z: -2.5e-3}]", "time.step_min": 1e-9}


def stopping_time(study, n, eta):
    run = Run(study, HERE / "column.yaml", f"layer-{n}", {
        **LAYER, "mesh.set": f"{{width: 1, nx: {n}, nz: {n}}}", "material.eta1": eta,
        "material.eta2": eta, "time.until.t": 0.8, "time.step_max": 1e-3})
    t, v = run["time"], run["slip_rate"].astype(float) @ run["weight"] / run["weight"].sum()
    k = int(np.argmax(v < 4.75e-4))
    return float(np.interp(4.75e-4, [v[k], v[k - 1]], [t[k], t[k - 1]])) if k else float("inf")


def warnings_of(study):
    run = Run(study, HERE / "column.yaml", "layer-warned", {
        **LAYER, "mesh.set": "{width: 1, nx: 4, nz: 4}", "material.eta1": 0, "material.eta2": 0,
        "time.until.t": 0.01, "time.step_max": 1e-3})
    return " ".join(run.report.get("warnings", []))


def controls(study, group, rigid_block, column):
    """The two mistakes that `group` must catch, each by the check that it would spoil."""
    study.control(group, "half-slip-rate", "friction weakens with half the slip rate", rigid_block)
    study.control(group, "shear-viscosity", "eta1 in place of eta1/2 in shear", column)


def run(study):
    rigid_block(study)
    column(study)
    if not study.quick:
        mesh_convergence(study)
        step_convergence(study)
        thresholds(study)
    ill_posed(study)
    controls(study, GROUP, rigid_block, column)
