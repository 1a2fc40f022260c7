#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Do error bars hold where friction remembers? Ten cases, laid down before anything was computed (ten_cases.py says how).

    validation/memory/cases.py [--list] [--limit N] [-o FOLDER]

Blocks and pads of set A with `ageing` and `rate-and-state` in turn; pressure, velocity and the law's numbers are points of Halton
sequences. Every run is kept in FOLDER/cases.jsonl (default validation/memory) as it ends: the same command goes on where it was
stopped. cases.sha256 is the digest of the list."""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "validation/benchmark"))
sys.dont_write_bytecode = True
import promise   # noqa: E402
from promise import between, halton, rounded   # noqa: E402
from ten_cases import Case, TenCases   # noqa: E402

SHEAR_MODULUS = 1 / (2 * 1.34)
DESIGNS = (("block", "ageing"), ("block", "rate-and-state"), ("pads", "ageing"), ("pads", "rate-and-state"), ("block", "rate-and-state"))


def ageing(index):
    """beta, theta_0 and D_c over the range in which healing is seen and does not rule."""
    beta, healing_time = rounded(between(0.01, 0.1, halton(index, 5))), rounded(between(1, 30, halton(index, 7)))
    distance = rounded(between(3e-5, 1e-3, halton(index, 11)))
    return (f"{{law: ageing, mu_static: 0.35, mu_kinetic: 0.1, critical_velocity: 3.4e-4, healing: {beta:g}, "
            f"healing_time: {healing_time:g}, slip_distance: {distance:g}}}")


def rate_and_state(index, pressure):
    """a and b - a; D_c by the length G D_c/(b P), from a fifth of the block to nearly all of it."""
    direct, drop = rounded(between(0.005, 0.02, halton(index, 5))), between(0.02, 0.05, halton(index, 7))
    evolution = rounded(direct + drop)
    distance = rounded(between(0.2, 0.7, halton(index, 11)) * evolution * pressure / SHEAR_MODULUS)
    return (f"{{law: rate-and-state, direct_effect: {direct:g}, evolution_effect: {evolution:g}, mu_reference: 0.32, "
            f"reference_velocity: 1e-5, slip_distance: {distance:g}}}")


def case(number):
    shape, law = DESIGNS[number % len(DESIGNS)]
    index = number + 1
    pressure, velocity = rounded(between(0.003, 0.012, halton(index, 2))), rounded(between(3e-6, 3e-5, halton(index, 3)))
    friction = ageing(index) if law == "ageing" else rate_and_state(index, pressure)
    settings = (f"friction={friction}", f"rod.velocity={velocity:g}", f"time.until={{U: {10 * pressure:g}}}")
    name = f"{number}: {shape}, {law}, P = {pressure:g}, V = {velocity:g}"
    if shape == "block":
        return Case(name, promise.BLOCK, settings, pressure, {"length": 1, "height": 0.5, "shape": "quad"}, True)
    mesh = {"n": 2 + number % 2, "total_height": 0.5, "pad_height": 0.05, "fill": 0.6, "ends": "open"}
    return Case(name, promise.PADS, settings, pressure, mesh, False)


CASES = TenCases(case)

if __name__ == "__main__":
    sys.exit(CASES.main(__doc__.splitlines()[0], HERE))
