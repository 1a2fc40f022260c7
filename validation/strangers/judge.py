# SPDX-License-Identifier: GPL-2.0-or-later
"""Answers of strangers' problems against their references: readings, references with their own error, verdicts, counts.

A reading is taken from what a run lists, not from the run's own choice of what counts: the peaks (for mu_M) and load drops
(for mu_hold) of the second half of U. mu_M is their mean, or F_T/F_N of steady sliding where there are none; mu_hold the lowest
where they repeat, else the lowest decile. Of a block that slid once or more and then slides steadily, the last of each."""
import math
import statistics
from dataclasses import dataclass

import numpy

ANSWERS = ("mu_M", "mu_hold")
LADDER = (1.2, 1.45, 1.75, 2.1, 2.5, 3, 3.6, 4.3, 5.2, 6.2, 7.5)     # mesh.set.refine of references, as far as it takes
LATE_LEAST = 3          # peaks, or drops, that a reading needs, some in each of the last two quarters
MESHES = 5              # the finest of a reference, that count
OWN_MAX = 1 / 3         # of a bar: a reference's own error may be so large
HELD_LEAST, WORST, MEDIAN, UNKNOWN_MOST = 0.91, 3, (0.2, 0.8), 0.10
KINDS = ("held", "broken", "not known", "refused", "no reference")


# --- one run ------------------------------------------------------------------------------------

def decile(values):
    return float(numpy.quantile(values, 0.1))


def reading(report, end):
    """{answer: value or None} of a plain run to U = end, `drift`: how peaks and drops of its last quarter differ from those
    of the quarter before, and `late`: how many of each there were."""
    results = report["results"]
    found = {"drift": {}, "late": {}}
    of_drops = min if results["drops"]["period"] else decile
    for name, items, of in (("mu_M", results["peaks"], statistics.mean), ("mu_hold", results["drops"]["list"], of_drops)):
        late = [item["mu"] for item in items if item["U"] > end / 2]
        third = [item["mu"] for item in items if end / 2 < item["U"] <= 3 * end / 4]
        fourth = [item["mu"] for item in items if item["U"] > 3 * end / 4]
        found[name] = of(late) if len(late) >= LATE_LEAST and third and fourth else None
        found["drift"][name] = of(fourth) - of(third) if third and fourth else 0
        found["late"][name] = len(late)
    if results["mu_steady"] is not None and not any(found["late"].values()):
        if results["mu_M_is"] == "steady sliding":
            found["mu_M"] = results["mu_steady"]
        else:
            for name, items in (("mu_M", results["peaks"]), ("mu_hold", results["drops"]["list"])):
                found[name] = items[-1]["mu"] if items else None
    return found


def too_short(asked, rows):
    """Whether runs of this length cannot decide, however fine the mesh: too few peaks or drops on one of `rows`, or what drifts within
    them alone makes a reference's own error more than it may be."""
    for name in ANSWERS:
        if any(0 < row["late"][name] < LATE_LEAST for row in rows):
            return True
        drift = abs(statistics.mean(row["drift"][name] for row in rows)) / 2
        if asked[f"{name}_error"] and drift > OWN_MAX * asked[f"{name}_error"]:
            return True
    return False


# --- references ---------------------------------------------------------------------------------

@dataclass
class Reference:
    value: float            # None: the block does not slide, or its load does not drop
    own: float = 0          # its own error
    meshes: int = 0
    finest: float = 0       # mesh.set.refine


def gathered(rows, answer):
    """{refine: [values]} of the finest meshes, all of whose pressures were run; a value may be None. rows: of {"refine",
    "pressure", "drift", answers}."""
    meshes = {}
    for row in rows:
        meshes.setdefault(row["refine"], []).append(row[answer])
    whole = [(refine, values) for refine, values in sorted(meshes.items()) if len(values) == 3]
    return dict(whole[-MESHES:])


def reference(rows, answer):
    """Mean of the meshes; where a straight line over the size of cells has a slope of twice its standard error or more, mean of
    the finest third, moved by half of what the line says is left to ever smaller cells. Own error: the standard error of that
    mean, what it was moved by, half of the drift within runs, in quadrature. None: too few meshes, or some slide and some do not."""
    meshes = gathered(rows, answer)
    if len(meshes) < 3:
        return None
    finest = max(meshes)
    there = [value is not None for values in meshes.values() for value in values]
    if not any(there) and not any(row["late"][answer] or row["program"][answer] for row in rows):
        return Reference(None, 0, len(meshes), finest)
    if not all(there):
        return None
    of = statistics.mean if answer == "mu_M" else min       # as of the program: mean and lowest of the window
    sizes, means = [1 / refine for refine in meshes], [of(values) for values in meshes.values()]
    slope, scatter = line_through(sizes, means)
    finer = sorted(zip(sizes, means))[:max(2, len(means) // 3) if slope else None]
    way = -slope * statistics.mean(size for size, _ in finer) / 2
    single = math.sqrt(statistics.mean(statistics.pvariance(values) for values in meshes.values()) * 3 / 2 / (3 * len(finer)))
    error = max(scatter / math.sqrt(len(finer)), single if answer == "mu_M" else 0)
    drift = statistics.mean(row["drift"][answer] for row in rows) / 2
    return Reference(statistics.mean(mean for _, mean in finer) + way, math.hypot(error, way, drift), len(meshes), finest)


def line_through(sizes, means):
    """(slope, standard deviation beside it); slope 0 where it is below twice its standard error."""
    count, middle = len(sizes), statistics.mean(sizes)
    spread = sum((size - middle) ** 2 for size in sizes)
    slope = sum((size - middle) * mean for size, mean in zip(sizes, means)) / spread
    level = statistics.mean(means)
    rest = sum((mean - level - slope * (size - middle)) ** 2 for size, mean in zip(sizes, means))
    scatter = math.sqrt(rest / (count - 2))
    if abs(slope) > 2 * scatter / math.sqrt(spread):
        return slope, scatter
    return 0, statistics.stdev(means)


# --- verdicts -----------------------------------------------------------------------------------

@dataclass
class Verdict:
    number: int
    answer: str
    kind: str               # of KINDS
    ratio: float = math.nan     # |error| / bar
    said: str = ""


def reaches(truth, asked):
    """Whether the reference goes to meshes as fine as the finest of the answer, or to the end of its ladder. A branch that
    only fine meshes come to, as where slip gets past the last nodes, is no fault of the finer ones."""
    finest = max((level["refine"] for level in asked["levels"]), default=1)
    return truth.finest >= min(finest, LADDER[-1]) * (1 - 1e-9)


def decides(truth, value, bar):
    """Whether its own error is below a third of the bar; or the answer so far off, or so near, that it does not matter."""
    error = abs(value - truth.value)
    return truth.own <= OWN_MAX * bar or error - 3 * truth.own > bar or error + 3 * truth.own <= bar


def verdict(number, answer, asked, truth):
    """asked: {"status", "mu_M", "mu_M_error", "levels", ...} of a run with --to; truth: its Reference, or None."""
    if asked["status"] != 0:
        return Verdict(number, answer, "refused", said=asked["said"][:200])
    value, bar = asked[answer], asked[f"{answer}_error"]
    if truth is None:
        return Verdict(number, answer, "not known" if value is not None and bar is None else "no reference")
    if truth.value is None:
        return Verdict(number, answer, "held", 0, "none, rightly") if value is None else \
            Verdict(number, answer, "broken", math.inf, f"{value:.4f}, but the reference has none")
    if value is None:
        return Verdict(number, answer, "not known", said=f"none, but the reference has {truth.value:.4f}")
    if bar is None:
        return Verdict(number, answer, "not known", said=f"off by {100 * (value / truth.value - 1):.1f} %")
    error = abs(value - truth.value)
    known = decides(truth, value, bar) and reaches(truth, asked)
    kind = "no reference" if not known else "held" if error <= bar else "broken"
    return Verdict(number, answer, kind, error / bar)


@dataclass
class Count:
    kinds: dict
    median: float
    worst: float
    failed: list            # sentences of acceptance numbers that are not met


def count(verdicts):
    kinds = {kind: sum(one.kind == kind for one in verdicts) for kind in KINDS}
    ratios = [one.ratio for one in verdicts if one.kind in ("held", "broken") and one.said != "none, rightly"]
    median, worst = (statistics.median(ratios), max(ratios)) if ratios else (math.nan, math.nan)
    bars, held = len(ratios), len(ratios) - kinds["broken"]
    known = len(verdicts) - kinds["no reference"]
    failed = []
    if bars and held < HELD_LEAST * bars:
        failed.append(f"{held} of {bars} bars hold, {100 * held / bars:.1f} %; {100 * HELD_LEAST:g} % are asked for")
    if worst >= WORST:
        failed.append(f"the worst error is {worst:.1f} bars; below {WORST} is asked for")
    if ratios and not MEDIAN[0] <= median <= MEDIAN[1]:
        failed.append(f"the median error is {median:.2f} bars; {MEDIAN[0]} to {MEDIAN[1]} is asked for")
    if known and kinds["not known"] > UNKNOWN_MOST * known:
        failed.append(f"{kinds['not known']} of {known} are not known; at most {100 * UNKNOWN_MOST:g} % are asked for")
    if kinds["refused"]:
        failed.append(f"{kinds['refused']} were refused")
    return Count(kinds, median, worst, failed)
