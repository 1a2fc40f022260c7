# SPDX-License-Identifier: GPL-2.0-or-later
"""A column of two viscoelastic layers, its top loaded at once, by Laplace's transform.

Held along x a layer has the modulus M(s) = E/(1 - nu^2) + s (eta1 + eta2), and rho s^2 u = M(s) u''.
With k = s sqrt(rho/M), Z = M k, the base held and the stress -P/s on top,

    stress at the base = (-P/s) Z1 / (Z1 cosh(k1 h1) cosh(k2 h2) + Z2 sinh(k1 h1) sinh(k2 h2))

where Z2's layer lies above. The inverse is summed on Talbot's contour (Abate and Valko, Int. J. Numer.
Meth. Eng. 60, 2004), which shares nothing with time stepping: no modes, so the damping may be anything."""
import numpy as np

NODES = 48                # of the contour: 1e-10 at the times asked for
LAYER = {"young": 0.25, "poisson": 0.2, "density": 0.5, "eta": 0.2}
BODY = {"young": 1, "poisson": 0.34, "density": 1, "eta": 0.1}
HEIGHTS, PRESSURE = (0.4, 0.6), 0.003


def talbot(transform, t):
    """f(t) from f(s), an array over places."""
    k = np.arange(1, NODES)
    theta = k * np.pi / NODES
    cot = 1 / np.tan(theta)
    delta = np.concatenate([[2 * NODES / 5], 2 * theta * NODES / 5 * (cot + 1j)])
    gamma = np.concatenate([[0.5 * np.exp(delta[0])],
                            (1 + 1j * theta * (1 + cot ** 2) - 1j * cot) * np.exp(delta[1:])])
    return sum(2 / (5 * t) * (g * transform(d / t)).real for g, d in zip(gamma, delta))


def waves(layer, s):
    """k and Z of a layer."""
    modulus = layer["young"] / (1 - layer["poisson"] ** 2) + s * layer["eta"]
    k = s * np.sqrt(layer["density"] / modulus + 0j)
    return k, modulus * k


def base_stress(s):
    (k1, z1), (k2, z2) = waves(LAYER, s), waves(BODY, s)
    a, b = k1 * HEIGHTS[0], k2 * HEIGHTS[1]
    return -PRESSURE / s * z1 / (z1 * np.cosh(a) * np.cosh(b) + z2 * np.sinh(a) * np.sinh(b))


def displacement(z, t):
    """u_z at the heights z."""
    def transform(s):
        (k1, z1), (k2, z2) = waves(LAYER, s), waves(BODY, s)
        amplitude, a = base_stress(s) / z1, k1 * HEIGHTS[0]
        above = z - HEIGHTS[0]
        lower = amplitude * np.sinh(k1 * z)
        upper = amplitude * (np.sinh(a) * np.cosh(k2 * above)
                             + z1 / z2 * np.cosh(a) * np.sinh(k2 * above))
        return np.where(above <= 0, lower, upper)
    return talbot(transform, t)


def column_error(frames):
    """The largest difference of u_z over the largest u_z, of frames (t, points, u, v)."""
    worst = largest = 0
    for t, points, u, _ in frames:
        if t == 0:
            continue
        exact = displacement(points[:, 1], t)
        worst, largest = max(worst, np.abs(u[:, 1] - exact).max()), max(largest, np.abs(exact).max())
    return worst / largest


def column(study, group):
    """Of second order in cell and step together."""
    from pathlib import Path
    from harness import Run, observed_order
    scene = Path(__file__).resolve().parent / "layers_column.yaml"
    errors, sizes = [], [0.25, 0.5, 1] if study.quick else [0.25, 0.5, 1, 2]
    for refine in sizes:
        run = Run(study, scene, "layers-column",
                  {"mesh.set.refine": refine, "time.step_max": 2e-3 / refine,
                   "time.step_min": 2e-3 / refine}, ledger=1)
        errors.append(column_error(run.frames()))
    order = observed_order([1 / size for size in sizes], errors)
    study.add(group, "column of two layers", "displacement to t = 3, all nodes", "Laplace inverted",
              f"{int(40 * sizes[-1])} cells", errors[-1], 2e-4, order="2 expected", seen=order, least=1.7,
              note="errors " + ", ".join(f"{e:.1e}" for e in errors))
