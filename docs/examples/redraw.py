#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The figures of a result once more, by matplotlib: for who wants them otherwise. Needs python3-matplotlib, python3-h5py.

    python3 docs/examples/redraw.py RESULT            # force, slip-map and contact-density as *-redrawn.pdf in RESULT/figures
    python3 docs/examples/redraw.py RESULT --csv      # and force.csv, front.csv: what the curves are drawn from
"""
import sys
from pathlib import Path

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = Path(next(word for word in sys.argv[1:] if not word.startswith("-"))) / "figures"
HERE.mkdir(exist_ok=True)
WIDTH = 86 / 25.4   # inches; 178 for two columns
plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.5, "lines.linewidth": 0.8, "savefig.dpi": 600})

with h5py.File(HERE.parent / "history.h5") as file:
    U, mu, front = (file[f"series/{name}"][:] for name in ("rod_displacement", "mu", "front"))
    x, rate, status = file["nodes/x"][:], np.abs(file["interface/slip_rate"][:]), file["interface/status"][:]
    number = {name: float(value) for name, value in file.attrs.items() if np.isscalar(value) and not isinstance(value, (str, bytes))}
    units = file.attrs["units"]
    peaks = [file[f"peaks/{name}"][:] for name in ("U", "mu", "counts")] if "peaks" in file else [[], [], []]
    events = [file[f"events/{name}"][:] for name in ("kind", "U_start", "U_stop")] if "events" in file else [[], [], []]
LENGTH = " (m)" if (units.decode() if isinstance(units, bytes) else units) == "si" else r" / $L_0$"


def save(figure, name):
    figure.savefig(HERE / f"{name}-redrawn.pdf", bbox_inches="tight")
    plt.close(figure)


def force():
    figure, axes = plt.subplots(figsize=(WIDTH, 0.62 * WIDTH))
    axes.plot(U, mu)
    counts = np.asarray(peaks[2], bool)
    for mask, face in ((counts, "black"), (~counts, "white")):
        if mask.any():
            axes.plot(np.asarray(peaks[0])[mask], np.asarray(peaks[1])[mask], "o", ms=3, mfc=face, mec="black",
                      label=r"counts for $\mu_M$" if face == "black" else "does not count")
    for name, label in (("mu_static", r"$\mu_S$"), ("mu_macroscopic", r"$\mu_M$"), ("mu_kinetic", r"$\mu_K$")):
        if np.isfinite(number.get(name, np.nan)):
            axes.axhline(number[name], ls="--", lw=0.5, color="gray")
            axes.annotate(label, (1.01, number[name]), xycoords=("axes fraction", "data"), va="center")
    axes.set(xlabel="$U$" + LENGTH, ylabel="$F_T / F_N$", xlim=(U[0], U[-1]))
    if len(peaks[0]):
        axes.legend()
    save(figure, "force")


def map_of(values, name, label, **options):
    figure, axes = plt.subplots(figsize=(WIDTH, 0.62 * WIDTH))
    mesh = axes.pcolormesh(U, x, values.T, rasterized=True, shading="nearest", **options)
    axes.set(xlabel="$U$" + LENGTH, ylabel="$x$" + LENGTH)
    figure.colorbar(mesh, label=label)
    save(figure, name)


def slip_map():
    with np.errstate(divide="ignore"):
        map_of(np.log10(rate / abs(number["rod_velocity"])), "slip-map", r"$\log_{10}$ of slip rate / $V$", vmin=-2, cmap="magma_r")


def contact_density():
    """The last sliding, with as much of U before it as a tenth of a cycle."""
    slides = [(start, stop) for kind, start, stop in zip(*events) if kind == 2 and np.isfinite(start + stop)]
    density = np.where(status == 0, np.nan, np.maximum(0, 1 - rate / number["critical_velocity"]))
    if slides:
        before = slides[-2][1] if len(slides) > 1 else U[0]
        inside = (U > slides[-1][0] - 0.1 * (slides[-1][0] - before)) & (U < slides[-1][1])
        figure, axes = plt.subplots(figsize=(WIDTH, 0.62 * WIDTH))
        mesh = axes.pcolormesh(U[inside], x, density[inside].T, rasterized=True, shading="nearest", cmap="magma")
        axes.set(xlabel="$U$" + LENGTH, ylabel="$x$" + LENGTH)
        figure.colorbar(mesh, label=r"contact density $\phi$")
        save(figure, "contact-density")


if "--csv" in sys.argv:
    np.savetxt(HERE / "force.csv", np.column_stack([U, mu]), delimiter=",", header="U,F_T/F_N", comments="")
    np.savetxt(HERE / "front.csv", np.column_stack([U, front]), delimiter=",", header="U,x", comments="")
force()
slip_map()
contact_density()
