# SPDX-License-Identifier: GPL-2.0-or-later
"""Branches of a generalised Maxwell solid against exact solutions: standing waves of a column, whose roots are those of
rho s^2 + k^2 M(s); a strip whose pressure swings, from which storage and loss modulus are read back; tau -> 0 and infinity."""
from pathlib import Path

import numpy as np

from exact.bulk import column_exact
from harness import Run, observed_order

HERE = Path(__file__).resolve().parent
GROUP = "materials with a spectrum"
NU, PRESSURE = 0.34, 0.003
SHEAR, BULK = 1 / (2 * (1 + NU)), 1 / (3 * (1 - 2 * NU))   # of E = 1
BRANCHES = [(0.05, 0.3, 0.2), (0.6, 0.2, 0.0)]   # time, G, K


def relaxation(branches):
    """The scene's list."""
    return "[" + ", ".join(f"{{time: {t!r}, shear: {g!r}, bulk: {k!r}}}" for t, g, k in branches) + "]"


def standing_waves(z, t, modulus, eta, branches, cells):
    """A column of height 1 fixed below whose top is loaded at once, cut into `cells` with lumped mass. M(s) = modulus + eta s +
    sum m s tau/(1 + s tau); each of its modes sin(k z) answers with the roots of s^2 + K^2 M(s), K = 2 sin(k h/2)/h, all of
    them poles of the load's response: 1/(s (s^2 + K^2 M)) by its residues. branches: (tau, m)."""
    u = np.zeros_like(z)
    for m in range(cells):
        k = (m + 0.5) * np.pi
        wave = 2 * np.sin(k / cells / 2) * cells
        below = np.poly1d([1.0])   # the product of all 1 + s tau
        for tau, _ in branches:
            below *= np.poly1d([tau, 1])
        stiff = np.poly1d([eta, modulus]) * below
        for tau, strength in branches:
            stiff += np.poly1d([strength * tau, 0]) * (below / np.poly1d([tau, 1]))[0]
        response = np.poly1d([1, 0, 0]) * below + wave**2 * stiff
        roots = response.roots
        assert len(roots) == 2 + len(branches) and roots.real.max() < 0
        slope = response.deriv()
        rest = sum(below(s) / (s * slope(s)) * np.exp(s * t) for s in roots).real
        u += (-1) ** m * 2 * PRESSURE * (1 / (wave**2 * modulus) + rest) * np.sin(k * z)
    return u


# scene, moduli of shear and bulk in that of the wave, in plane strain; eta1 and eta2 in its viscosity; axis; sign
WAVES = {"longitudinal": ("wave.yaml", 4 / 3, 1, (1, 1), 1, -1), "shear": ("shear_wave.yaml", 1, 0, (0.5, 0), 0, 1)}
ETA = 0.01


def wave_error(study, kind, step, branches, exact, sets=None):
    """Largest difference over all nodes and times, of the largest displacement. exact(z, t, modulus, eta, combine)."""
    scene, of_shear, of_bulk, viscous, component, sign = WAVES[kind]
    run = Run(study, HERE / scene, f"rubber-{kind}",
              {"mesh.set": "{length: 0.25, height: 1, nx: 1, nz: 16}", "material.plane": "strain", "material.eta1": ETA,
               "material.eta2": ETA, "material.relaxation": relaxation(branches), "time.step_max": step, "time.step_min": step,
               **(sets or {})}, ledger=1e-2)
    worst, largest = 0, 0
    for t, points, u, _ in run.frames():
        expected = sign * exact(points[:, 1], t, of_shear * SHEAR + of_bulk * BULK, (viscous[0] + viscous[1]) * ETA,
                                lambda g, k: of_shear * g + of_bulk * k)
        worst, largest = max(worst, np.abs(u[:, component] - expected).max()), max(largest, np.abs(expected).max())
    return worst / largest


def waves(study):
    def exact(z, t, modulus, eta, combine):
        return standing_waves(z, t, modulus, eta, [(tau, combine(g, k)) for tau, g, k in BRANCHES], 16)
    steps = [4e-3, 2e-3] if study.quick else [4e-3, 2e-3, 1e-3]
    for kind in WAVES:
        errors = [wave_error(study, kind, step, BRANCHES, exact) for step in steps]
        study.add(GROUP, f"standing {kind} waves with two branches", "displacement at every node to t = 1.5", "roots of modes",
                  f"dt = {steps[-1]:g}", errors[-1], 1e-5, order="2 expected",
                  seen=observed_order(steps, errors), least=1.7)


def limits(study):
    """A branch that relaxes at once is a viscosity, one that does not is a spring: the Kelvin-Voigt column's exact series."""
    for words, tau, m_g, m_k in (("tau = 1e-9: a viscosity", 1e-9, 0.02, 0.03), ("tau = 1e9: a spring", 1e9, 0.3, 0.2)):
        soon = tau < 1
        branch = (tau, m_g / tau if soon else m_g, m_k / tau if soon else m_k)

        def exact(z, t, modulus, eta, combine):
            more = combine(m_g, m_k)
            return column_exact(z, t, modulus + (0 if soon else more), eta + (more if soon else 0), cells=16)
        for kind in WAVES:
            error = wave_error(study, kind, 1e-3, [branch], exact, {"start.state": "undeformed"})
            study.add(GROUP, f"standing {kind} waves, {words}", "displacement at every node to t = 1.5", "exact series", "dt = 0.001",
                      error, 1e-5)


def swing(study, period, branches=BRANCHES):
    """(E', E'') read off the strain along a pressure that swings, after twenty of the longest relaxation times."""
    points, steps, frames, amplitude = 63, 1000, 20, 0.4
    periods = int(np.ceil(20 * max(t for t, _, _ in branches) / period)) + 2
    at = np.arange(points + 1)
    times = ", ".join(f"{x:.15g}" for x in at * period / points)
    factors = ", ".join(f"{x:.15g}" for x in 1 + amplitude * np.sin(2 * np.pi * at / points))
    run = Run(study, HERE / "creep.yaml", "rubber-driven",
              {"mesh.set": "{length: 1, height: 0.5, nx: 2, nz: 2}", "material.eta1": ETA, "material.eta2": ETA,
               "material.relaxation": relaxation(branches), "load.program": f"{{t: [{times}], factor: [{factors}], repeat: true}}",
               "time.until.t": periods * period, "time.step_max": period / steps, "time.step_min": period / steps,
               "start.state": "relaxed", "output.fields": f"{{every_t: {period / frames}}}"}, ledger=1e-3)
    seen = []
    for t, x, u, _ in run.frames():
        top = int(np.argmax(x[:, 1]))
        if t > (periods - 2) * period - 1e-9:
            seen.append((t, u[top, 1] / x[top, 1]))
    seen = np.array(seen)
    turns = np.exp(2j * np.pi * seen[:, 0] / period)
    fitted = np.linalg.lstsq(np.column_stack([np.ones(len(seen)), turns.real, turns.imag]), seen[:, 1], rcond=None)[0]
    load = -PRESSURE * amplitude * -1j * np.sinc(1 / points) ** 2   # of the polygon that the program is
    return load / (fitted[1] - 1j * fitted[2])


def young_of(s, branches=BRANCHES):
    """E(s) along a strip in plane stress with viscosities, for G(s) and the plate's areal modulus."""
    shear = SHEAR + sum(g * s * t / (1 + s * t) for t, g, _ in branches)
    bulk = BULK + sum(k * s * t / (1 + s * t) for t, _, k in branches)
    areal = 9 * bulk * shear / (3 * bulk + 4 * shear) + s * 1.5 * ETA
    shear = shear + s * ETA / 2
    return 4 * shear * areal / (shear + areal)


def driven(study):
    for period in (0.3, 3.0) if study.quick else (0.1, 0.3, 1.0, 3.0, 10.0):
        ours, exact = swing(study, period), young_of(2j * np.pi / period)
        for name, part in (("storage modulus E'", "real"), ("loss modulus E''", "imag")):
            mine, theirs = getattr(ours, part), getattr(exact, part)
            study.add(GROUP, f"driven strip, period {period:g}", name, theirs, mine, abs(mine / theirs - 1), 1e-4)


def controls(study):
    study.control(GROUP, "branch-energy", "what branches store is not in the ledger", waves)
    study.control(GROUP, "branch-late", "stretches of a second stage begin where the step did", waves)


def run(study):
    waves(study)
    limits(study)
    driven(study)
    controls(study)
