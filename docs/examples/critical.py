# SPDX-License-Identifier: GPL-2.0-or-later
"""How long may slow slip become? Growth rates along the quasi-static path, at three pressures.

    python3 docs/examples/critical.py [KEY=VALUE ...]
"""
import sys
from pathlib import Path

import amontons
import matplotlib.pyplot as plt

scene = Path(__file__).with_name("block.yaml")
given = dict(word.split("=") for word in sys.argv[1:])

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for pressure in (0.002, 0.003, 0.006):
    answer = amontons.stability(scene, {"load.pressure": pressure, "time.until": {"U": 10 * pressure}, **given})
    points = answer.points
    line, = axes.plot(points["front"], points["rate_re"], label=f"$P$ = {pressure}")
    axes.axvline(answer.l_c_rod, color=line.get_color(), linestyle=":")
    print(f"P = {pressure}: l_sc {answer.l_sc:.3f}, l_c {answer.l_c_rod:.3f}, mu there {answer.mu_rod:.4f}")
axes.axhline(0, color="black", linewidth=0.8)
axes.plot([], [], ":", color="gray", label="$l_c$")
axes.set(xlabel="front $l\\,/\\,L_0$", ylabel="growth rate (real part) $\\cdot\\,t_0$", ylim=(-0.5, 2.5), xlim=(0, 1))
axes.legend()
Path("results").mkdir(exist_ok=True)
figure.savefig("results/critical.png", dpi=150)
