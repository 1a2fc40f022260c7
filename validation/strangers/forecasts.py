#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What the next mesh of a search takes, from the runs of now.jsonl.

    validation/strangers/forecasts.py"""
import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
from measured_run import markdown_table                         # noqa: E402


def quantile(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))]


def meshes_table(path, least):
    """Time of a run over that of one on the mesh before, times a power of their nodes: wall time on busy machines, of runs
    that took `least` s and more."""
    steps = []      # (nodes over those before, time over that before, problem)
    for one in map(json.loads, path.read_text().splitlines()):
        levels = (one["asked"] or {}).get("levels") or []
        times = [level["seconds"] / max(len(level["runs"]), 1) for level in levels]
        steps += [(here["contact_nodes"] / before["contact_nodes"], after / time, one["number"])
                  for before, here, time, after in zip(levels, levels[1:], times, times[1:]) if after >= least]
    rows = []
    for name, low, high in (("next mesh", 1.05, 1.35), ("far jump", 1.35, 3)):
        for power in (1.5, 2, 2.6):
            of = [time / nodes**power for nodes, time, _ in steps if low <= nodes < high]
            rows.append([name, len(of), power, *(f"{quantile(of, part):.2f}" for part in (0.05, 0.1, 0.5, 0.9, 0.95))])
    return markdown_table(["", "meshes", "power", "5 % take less than", "10 %", "median", "90 %", "95 %"], rows)


if __name__ == "__main__":
    print(meshes_table(Path(__file__).with_name("now.jsonl"), 4))
