#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""How far two folders of the pads study agree: two versions, or two machines.

    validation/pads/compare.py OLD NEW

Where load drops repeat in both, mu_hold is compared; where they do in neither, mu_hold and the mean of
the drops, in units of their bars (95 %, of both together). Rounding alone decides which drops a run
has that do not repeat, and now and then between two that do: what is in the bars is chance, what is
far outside is a change of the program.
"""
import argparse
import math
from pathlib import Path

from study import read_points

SHOWN = 0.01   # differences of mu_hold that are listed


def pairs(old, new):
    """Points that both folders have, each scene once."""
    found = {}
    for path in sorted(old.glob("*/sweep.csv")):
        other = new / path.relative_to(old).parent
        if not (other / "sweep.csv").exists():
            continue
        after = {point.place: point for point in read_points(other)}
        for before in read_points(path.parent):
            if before.place in after and before.hold and after[before.place].hold:
                found.setdefault(before.place, (before, after[before.place]))
    return list(found.values())


def name_of(point):
    varied = [f"{key} {point.mesh[key]:g}" for key in ("n", "pad_height", "fill", "gap") if key in point.mesh]
    return f"{point.sweep}, P = {point.P:g}, {' '.join(varied)}"


def in_bars(pair, value, error):
    """The difference in units of both bars together; None where there is none."""
    (a, b), (u, v) = ([getattr(point, name) for point in pair] for name in (value, error))
    return abs(b - a) / math.hypot(u, v) if None not in (a, b, u, v) and (u or v) else None


def show_regular(title, found):
    parts = sorted(abs(new.hold / old.hold - 1) for old, new in found)
    print(f"{title}: {len(parts)} runs")
    if parts:
        print(f"  mu_hold within 0.1 %: {sum(p <= 1e-3 for p in parts)}, within 1 %: {sum(p <= 1e-2 for p in parts)}, "
              f"at most {100 * parts[-1]:.2g} %")
    for old, new in found:
        if abs(new.hold / old.hold - 1) > SHOWN:
            print(f"    {name_of(old)}: {old.hold:.4f} to {new.hold:.4f}, period {old.period} to {new.period}")


def show_chaotic(found):
    print(f"drops that do not repeat: {len(found)} runs")
    for title, value, error in (("mu_hold", "hold", "hold_error"), ("mean of drops", "mean", "mean_error")):
        off = [d for d in (in_bars(pair, value, error) for pair in found) if d is not None]
        if off:
            print(f"  {title}: {sum(d <= 1 for d in off)} of {len(off)} within both bars, at most {max(off):.2g} of them, "
                  f"root mean square {math.sqrt(sum(d * d for d in off) / len(off)):.2g} (0.51 where bars are right)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path, help="results folder of validation/pads/study.py")
    parser.add_argument("new", type=Path, help="another one")
    options = parser.parse_args()
    found = pairs(options.old, options.new)
    if not found:
        parser.error(f"{options.old} and {options.new} have no point in common: give two folders that "
                     "validation/pads/study.py -o DIR has written")
    kinds = [(bool(old.period), bool(new.period)) for old, new in found]
    of = lambda *kind: [pair for pair, its in zip(found, kinds) if its in kind]
    repeat = of((True, True))
    show_regular("drops that repeat, same period", [p for p in repeat if p[0].period == p[1].period])
    show_regular("another period", [p for p in repeat if p[0].period != p[1].period])
    show_regular("in one of both", of((True, False), (False, True)))
    show_chaotic(of((False, False)))
    print(f"steps: {sum(old.steps for old, _ in found)} and {sum(new.steps for _, new in found)}")


if __name__ == "__main__":
    main()
