#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Do error bars hold where friction remembers? Ten cases, laid down before anything was computed.

    validation/memory/cases.py [--list] [--limit N] [-o FOLDER]

Blocks and pads of set A with `ageing` and `rate-and-state` in turn; pressure, velocity and the law's numbers are points of Halton
sequences. A case without bulk sliding is passed over for the next one. Each is asked for at 3 % with `--to`. Its reference is the mean of
two meshes, finer than what such a bar needs as a rule, at two pressures, 0.5 % below and above; its own error is half of what the
meshes differ by. cases.sha256 is the digest of the list, kept before the first run (tests look whether it is still that of the list).
Every run is kept in FOLDER/cases.jsonl (default validation/memory) as it ends: the same command goes on where it was stopped."""
import argparse
import hashlib
import math
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
import promise   # noqa: E402
from measured_run import markdown_table, run   # noqa: E402
from promise import Kept, between, flow, halton, rounded   # noqa: E402

COUNT, DRAWN = 10, 20          # asked for; drawn, as some do not slide as a whole
WANTED, WITHIN = 0.03, 90      # s
WINDOW = (0.995, 1.005)
REFERENCES = (80, 100)         # cells along the contact; a window and a mesh: four runs
SHEAR_MODULUS = 1 / (2 * 1.34)
DESIGNS = (("block", "ageing"), ("block", "rate-and-state"), ("pads", "ageing"), ("pads", "rate-and-state"), ("block", "rate-and-state"))


@dataclass(frozen=True)
class Case:
    name: str
    scene: Path
    settings: tuple
    pressure: float
    mesh: dict
    is_block: bool


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


def mesh_of(one, cells):
    if one.is_block:
        return one.mesh | {"nx": cells, "nz": cells // 2}
    return one.mesh | {"size_contact": 1 / cells, "size_bulk": 4 / cells}


def listed():
    return "".join(f"{one.name}; {'; '.join(one.settings)}; {one.mesh}\n" for one in map(case, range(DRAWN)))


def digest():
    return hashlib.sha256(listed().encode()).hexdigest()


def reference_run(one, cells, factor):
    ended = run(one.scene, [*promise.QUIET, *one.settings, flow(mesh_of(one, cells)), f"load.pressure={one.pressure * factor:.9g}"], 600)
    results = ended.report.get("results", {})
    return {"mu": results.get("mu_M"), "is": results.get("mu_M_is"), "seconds": ended.seconds, "said": ended.said[-200:]}


def reference(one, kept):
    """(mean, its own error); None: no bulk sliding."""
    means = []
    for cells in REFERENCES:
        rows = [kept.obtain(one, f"reference {cells} at {factor}", lambda c=cells, f=factor: reference_run(one, c, f)) for factor in WINDOW]
        if any(row["mu"] is None or row["is"] != "peaks" for row in rows):
            return None
        means.append(statistics.mean(row["mu"] for row in rows))
    return statistics.mean(means), abs(means[1] - means[0]) / 2


def ask(one):
    ended = run(one.scene, [*promise.QUIET, *one.settings, flow(mesh_of(one, 40)), f"load.pressure={one.pressure}"], 600,
                words=["--to", f"{WANTED}", "--within", f"{WITHIN}s"])
    results, found = ended.report.get("results", {}), ended.report.get("accuracy", {})
    return {"mu": results.get("mu_M"), "bar": results.get("mu_M_error"), "met": found.get("met"), "seconds": ended.seconds,
            "nodes": [level["contact_nodes"] for level in found.get("levels", [])], "said": ended.said[-200:]}


def known(kept):
    """As judged, of what was computed before."""
    found = []
    for one in map(case, range(DRAWN)):
        if (one.name, f"to {WANTED}") in kept.rows:
            found.append((one, *reference(one, kept), kept.rows[one.name, f"to {WANTED}"]))
    return found


def judged(kept, limit):
    """(case, reference, its own error, answer) of the first cases that slide as a whole."""
    found = []
    for one in map(case, range(DRAWN)):
        if len(found) == limit:
            break
        truth = reference(one, kept)
        if truth:
            found.append((one, *truth, kept.obtain(one, f"to {WANTED}", lambda c=one: ask(c))))
    return found


def section(found):
    """Of the page: a sentence and a table."""
    if not found:
        return "No case was computed yet.\n"
    rows, ratios = [], []
    for one, mean, own, answer in found:
        if answer["mu"] is None or not answer["bar"]:
            rows.append([one.name, f"{mean:.4f}", f"{100 * own / mean:.2f}", "not known", "", "no", answer["nodes"], f"{answer['seconds']:.1f}"])
            continue
        error = answer["mu"] - mean
        ratios.append(abs(error) / answer["bar"])
        rows.append([one.name, f"{mean:.4f}", f"{100 * own / mean:.2f}", f"{100 * error / mean:+.2f}" + " **no**" * (ratios[-1] > 1),
                     f"{100 * answer['bar'] / mean:.2f}", "yes" if answer["met"] else "no", ", ".join(map(str, answer["nodes"])),
                     f"{answer['seconds']:.1f}"])
    held = sum(ratio <= 1 for ratio in ratios)
    worst = f"; the worst error is {max(ratios):.2f} bars, the median {statistics.median(ratios):.2f}" if ratios else ""
    return (f"{held} of {len(ratios)} bars hold the reference ({len(found) - len(ratios)} of {len(found)} answers are not known){worst}.\n\n"
            + markdown_table(["case", "mu_M", "own error, %", "answer: error, %", "bar, %", "met", "contact nodes", "s"], rows) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--list", action="store_true", help="the cases and their digest alone")
    parser.add_argument("--limit", type=int, default=COUNT)
    parser.add_argument("-o", "--output", type=Path, default=HERE)
    words = parser.parse_args()
    if words.list:
        print(listed() + digest())
        return 0
    words.output.mkdir(parents=True, exist_ok=True)
    found = judged(Kept(words.output / "cases.jsonl"), words.limit)
    print(section(found))
    return 0 if all(answer["bar"] and abs(answer["mu"] - mean) <= answer["bar"] or math.isnan(mean) for _, mean, _, answer in found) else 1


if __name__ == "__main__":
    sys.exit(main())
