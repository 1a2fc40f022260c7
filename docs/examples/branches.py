# SPDX-License-Identifier: GPL-2.0-or-later
"""Two cycles of stick and slip that coexist: which one comes, and what does the contact hold in nearly all runs? Runs within a window of
pressures, 1 % wide, on one mesh.

    python3 docs/examples/branches.py [KEY=VALUE ...]
"""
import sys
from pathlib import Path

import amontons
import matplotlib.pyplot as plt
import numpy as np

scene = Path(__file__).with_name("block.yaml")
given = dict(word.split("=") for word in sys.argv[1:])
P, L, RUNS = 0.00262, 1.36, 8 if given else 48
block = {"mesh.set.length": L, "mesh.set.height": L / 2, "rod.height": L / 4, "rod.width": L / 20,
         "time.until": {"U": 20 * P * L, "periodic": True}, "output.history": False}

pressures = P * np.linspace(0.995, 1.005, RUNS)
runs = [amontons.run(scene, {"load.pressure": pressure, **block, **given}) for pressure in pressures]
mu, hold = (np.array([getattr(run, name) for run in runs]) for name in ("mu_M", "mu_hold"))

print(f"mu_M of {RUNS} runs: mean {mu.mean():.4f}, spread {np.ptp(mu):.4f}")
sorted_mu = np.sort(mu)
gap = np.diff(sorted_mu).argmax()          # branches: what the widest gap divides, where it is 1 % or more
cut = sorted_mu[gap:gap + 2].mean() if np.diff(sorted_mu)[gap] > 0.01 * mu.mean() else -np.inf
for name, part in (("upper branch", mu > cut), ("lower branch", mu <= cut)):
    if part.any():
        print(f"{name}: mu_M {mu[part].mean():.4f}, chance {part.mean():.0%}")
print("quantiles 5, 50, 95 %:  mu_M " + ", ".join(f"{q:.4f}" for q in np.quantile(mu, [0.05, 0.5, 0.95])) +
      ";  mu_hold " + ", ".join(f"{q:.4f}" for q in np.quantile(hold, [0.05, 0.5, 0.95])))
print(f"held in 19 of 20 runs: {np.quantile(hold, 0.05):.4f}")

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained", sharey=True,
                                     gridspec_kw={"width_ratios": [3, 2]})
left.plot(100 * (pressures / P - 1), mu, "o", markersize=4, label=r"$\mu_M$ of a run")
left.plot(100 * (pressures / P - 1), hold, "_", markersize=6, color="tab:red", label=r"$\mu_\mathrm{hold}$")
left.axhline(mu.mean(), color="black", linewidth=0.8, label=r"mean of $\mu_M$")
left.set(xlabel="pressure, % off $P$ = 0.00262", ylabel="$F_T / F_N$")
left.legend(fontsize=8)
right.step(np.arange(1, RUNS + 1) / RUNS, np.sort(mu), where="pre", label="mu_M")
right.step(np.arange(1, RUNS + 1) / RUNS, np.sort(hold), where="pre", color="tab:red", label="mu_hold")
right.axvline(0.05, color="gray", linestyle=":", linewidth=1)
right.set(xlabel="part of the runs with less", xlim=(0, 1))
Path("results").mkdir(exist_ok=True)
figure.savefig("results/branches.png", dpi=150)
