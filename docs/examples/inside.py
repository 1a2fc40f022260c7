# SPDX-License-Identifier: GPL-2.0-or-later
"""What happens inside the block when slip turns fast? The velocity of every node just before slip has crossed the contact.

    python3 docs/examples/inside.py [KEY=VALUE ...]
"""
import sys
from pathlib import Path

import amontons
import matplotlib.pyplot as plt
import numpy as np

scene = Path(__file__).with_name("block.yaml")
V = 1e-5
given = dict(word.split("=") for word in sys.argv[1:])

simulation = amontons.Simulation(scene, {"time.until": {"U": 0.008}, **given}, whole_block=True)
corners = np.array([element[:4] for element in simulation.elements])
triangles = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
x, z = simulation.position.T
for step in simulation:
    if step.slidings == 2:   # slip has just crossed the contact for the second time: the state before is kept
        break
    if step.max_slip_rate > 2 * V:
        when, front, velocity = step.t, step.front, simulation.velocity
print(f"t = {when:.2f}: slip has come to x = {front:.3f}, at up to {velocity[:, 0].max() / V:.0f} times the rod's velocity")

figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
drawn = axes.tripcolor(x, z, triangles, velocity[:, 0] / V, shading="gouraud", cmap="inferno")
figure.colorbar(drawn, label="velocity along $x$ / $V$")
axes.set(xlabel="$x / L_0$", ylabel="$z / L_0$", aspect="equal")
Path("results").mkdir(exist_ok=True)
figure.savefig("results/inside.png", dpi=150)
