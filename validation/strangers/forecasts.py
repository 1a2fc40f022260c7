#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What the next mesh of a search takes, over what it was expected to take, from the runs of a .jsonl of strangers.py.

    validation/strangers/forecasts.py [FILE [FIRST]]        # default: now.jsonl, problems from 601 on

A mesh that was cut short counts if it had taken three times what was expected by then, else it tells nothing. Versions that
did not keep what was expected (`seconds_expected`) are counted by the rule of today, time goes with the square of the cells
along the contact."""
import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.path.insert(0, str(Path(__file__).parent))
sys.dont_write_bytecode = True
import problems                                                 # noqa: E402
from measured_run import markdown_table                         # noqa: E402

SHORTEST = (0.3, 1, 4)      # s that a mesh took at least, or was expected to


def quantile(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))]


def kinds_of(one):
    found = ["all"]
    if any(word in one.features for word in problems.MEMORY):
        found.append("laws with memory")
    if "machine" in one.features:
        found.append("machines")
    if "space" in one.features:
        found.append("in space")
    return found


def ratios_of(asked):
    """[(what was taken over what was expected, the larger of both in s)]"""
    found, levels = [], asked.get("levels") or []
    for before, here in zip(levels, levels[1:]):
        first = min(len(here["runs"]), 2 if here["refine"] > 1.99 * before["refine"] and len(here["runs"]) > 1 else 1)
        took = here["seconds"] * first / max(len(here["runs"]), 1)
        expected = here.get("seconds_expected") or \
            before["seconds"] / max(len(before["runs"]), 1) * first * (here["refine"] / before["refine"])**2
        found.append((took / expected, max(took, expected)))
    cut = asked.get("cut") or {}
    if cut.get("seconds_expected") and cut["run"] == 1 and cut["seconds"] >= 3 * cut["seconds_expected"]:
        found.append((cut["seconds"] / cut["seconds_expected"], cut["seconds"]))
    return found


def table(path, first):
    """Of the problems with this number and higher ones."""
    ratios = {}
    for row in map(json.loads, path.read_text().splitlines()):
        if row["number"] < first:
            continue
        for kind in kinds_of(problems.problem(row["number"])):
            ratios.setdefault(kind, []).extend(ratios_of(row["asked"] or {}))
    rows = []
    for kind, found in ratios.items():
        for least in SHORTEST:
            of = [ratio for ratio, seconds in found if seconds >= least]
            if of:
                near = sum(1 / 3 <= ratio <= 3 for ratio in of)
                rows.append([kind, least, len(of), f"{100 * near / len(of):.0f} %",
                             *(f"{quantile(of, part):.2f}" for part in (0.05, 0.5, 0.95))])
    return markdown_table(["", "s, least", "meshes", "within a factor of 3", "5 %", "median", "95 %"], rows)


if __name__ == "__main__":
    given = sys.argv[1:]
    print(table(Path(given[0]) if given else Path(__file__).with_name("now.jsonl"), int(given[1]) if given[1:] else 601))
