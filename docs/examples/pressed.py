# SPDX-License-Identifier: GPL-2.0-or-later
"""How does a block stand on the floor while it is pushed? Pressure along the contact from the static equilibrium.

    python3 docs/examples/pressed.py [KEY=VALUE ...]
"""
import sys
from pathlib import Path

import amontons
import h5py
import matplotlib.pyplot as plt

scene = Path(__file__).with_name("block.yaml")
given = dict(word.split("=") for word in sys.argv[1:])

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for push in (0, 0.0005, 0.001):   # how far the rod stands inside the undeformed block
    folder = Path("results/pressed")
    answer = amontons.static(scene, {"rod.displacement": push, **given}, folder, overwrite=True)
    with h5py.File(folder / "static.h5") as held:
        row = held["contact/node"][:]
        x = held["nodes/position"][:][row, 0]
        pressure = held["nodes/reaction"][:][row, 1] / held["contact/weight"][:]
    along = x.argsort()
    axes.plot(x[along], pressure[along] / 0.003, label=f"rod at {push} $L_0$")
    print(f"rod at {push}: F_T/F_N {answer.rod_force / answer.normal_force:.4f}, {answer.slipping} nodes slip")
axes.set(xlabel="$x / L_0$", ylabel="contact pressure / $P$", ylim=(0, 2))
axes.legend()
Path("results").mkdir(exist_ok=True)
figure.savefig("results/pressed.png", dpi=150)
