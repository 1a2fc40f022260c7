# SPDX-License-Identifier: GPL-2.0-or-later
"""What if the rod stops for a while? A block that is stepped from Python, its rod held at F_T/F_N = 0.25.

    python3 docs/examples/stop_and_go.py [KEY=VALUE ...]
"""
import sys
from pathlib import Path

import amontons
import matplotlib.pyplot as plt
import numpy as np

scene = Path(__file__).with_name("block.yaml")
given = dict(word.split("=") for word in sys.argv[1:])
V = 1e-5


def pushed(hold):
    """(t, F_T/F_N) of each step; the rod stands for the time `hold` when 0.25 is reached for the second time."""
    simulation = amontons.Simulation(scene, {"time.until": {"U": 0.008}, **given})
    seen, since, above, times = [], None, False, 0
    for step in simulation:
        seen.append((step.t, step.mu))
        times += step.mu >= 0.25 and not above
        above = step.mu >= 0.25
        if since is None and hold > 0 and times == 2:
            simulation.set_rod_velocity(0)
            since = step.t
        if since is not None and since + hold <= step.t and hold > 0:
            simulation.set_rod_velocity(V)
            hold = 0
    return np.array(seen).T


figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for hold in (0, 100):
    t, mu = pushed(hold)
    axes.plot(t, mu, label=f"rod stands for {hold} $t_0$", linewidth=1)
    print(f"rod stands for {hold}: largest F_T/F_N after the start {mu[t > 400].max():.4f}")
axes.set(xlabel="$t / t_0$", ylabel="$F_T / F_N$")
axes.legend()
Path("results").mkdir(exist_ok=True)
figure.savefig("results/stop_and_go.png", dpi=150)
