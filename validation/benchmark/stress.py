#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Extremes: every run ends with a right answer or an honest refusal.

    validation/benchmark/stress.py [-o FOLDER] [--only WORD ...] [--quick] [--no-cycles]

Runs stress.yaml with one extreme at a time (stress_cases.py) and leaves stress.md and stress.csv in
FOLDER (default results/stress). A run that says it is done is believed only when its invariants
hold and a twin agrees: the same scene at finer steps, or a scene that must give the same number.
Exit status 1: some run ended in a number that is not finite, a crash, an endless loop, a refusal
without a reason, or a wrong answer.
"""
import argparse
import csv
import math
import statistics
import sys
from pathlib import Path

import stress_cases
from measured_run import ROOT, commit, markdown_table, run

SCENE = Path(__file__).resolve().parent / "stress.yaml"
FINER = ["time.tolerance=1e-4", "time.wave_step=0.05"]
# Largest violations allowed; of energy the scene says. Contact is measured against the mean nodal
# force and against V.
BOUNDS = {"complementarity": 1e-6, "moment": 1e-8, "equation": 1e-8}
HEAD = ["group", "case", "ended", "steps", "rejected", "unsolved", "mu, largest", "peaks",
        "twin differs by", "energy", "contact", "moment", "equation", "cpu s", "MB", "what it said"]


def answer(case, ended):
    """What twins compare: the first peak of mu; where there is none, or the rod's impact stands out
    of mu, the mean of mu over the second half of the run."""
    peaks = ended.report.get("results", {}).get("peaks") or []
    return (peaks[0]["mu"] if peaks and not case.late else
            ended.late_mu if math.isfinite(ended.late_mu) else ended.report["results"]["mu_max"])


def is_number(value):
    return isinstance(value, (int, float)) and math.isfinite(value)


def done_faults(case, ended):
    """What is wrong with a run that says it is done."""
    report = ended.report
    bounds = BOUNDS | {"energy": report["scene"]["time"]["energy_tolerance"]}
    shortest = min((size["dt"] for size in report["step_sizes"] if size["accepted"]), default=math.nan)
    faults = [f"{name} {report['errors'][name]} is above {bound} (shortest step {shortest:.1g})"
              for name, bound in bounds.items()
              if not is_number(report["errors"][name]) or report["errors"][name] > bound]
    if not is_number(answer(case, ended)):
        faults.append(f"mu is {answer(case, ended)}")
    return faults


def compare(case, ended, cpu_limit):
    """Relative difference of the answers of a run and its twin; None: there was no twin."""
    if case.twin is None:
        return None
    settings = case.twin if case.twin else case.settings + FINER
    twin = run(SCENE, settings, 4 * cpu_limit)
    if twin.status != 0:
        return math.nan
    mine, other = answer(case, ended), answer(case, twin)
    scale = max(abs(mine), abs(other), 1e-3 * (ended.report["results"]["mu_max"] or 0), 1e-12)
    return abs(mine - other) / scale


def judge(case, ended, cpu_limit):
    """(how it ended, what is wrong with that, twin's difference)."""
    if ended.timed_out:
        return "no end", [f"stopped after {cpu_limit} s of processor time"], None
    if ended.status < 0:
        return "crash", [f"signal {-ended.status}"], None
    if ended.status > 0:
        faults = [] if ended.said.strip() else ["no reason given"]
        if not case.may_refuse:
            faults.append("should have been computed")
        return ("refused" if ended.status == 2 else "gave up"), faults, None
    faults = done_faults(case, ended)
    warned = ended.report.get("warnings") or []
    if case.must_warn and not warned:
        faults.append("should have warned")
    if case.must_refuse:
        faults.append("should have been refused")
    difference = compare(case, ended, cpu_limit) if not faults else None
    if difference is not None and not difference <= case.agree and not warned:
        faults.append(f"its twin differs by {difference:.2g}")
    return ("done, warned" if warned else "done"), faults, difference


def show(value, form=".2g"):
    return format(value, form) if is_number(value) else "-"


def row(case, ended, word, faults, difference):
    report = ended.report
    steps, errors = report.get("steps", {}), report.get("errors", {})
    warned = report.get("warnings") or []
    said = " ".join(ended.said.split()) or "; ".join(warned)
    bad = f"**WRONG**: {'; '.join(faults)}. " if faults else ""
    return [case.group, case.name, word, steps.get("accepted", "-"), steps.get("rejected", "-"),
            steps.get("unsolved_retries", "-"),
            show(report.get("results", {}).get("mu_max"), ".4f"),
            len(report.get("results", {}).get("peaks") or []), show(difference),
            show(errors.get("energy")), show(errors.get("complementarity")),
            show(errors.get("moment")), show(errors.get("equation")), f"{ended.seconds:.2f}",
            f"{ended.memory:.0f}", bad + said[:300]]


def drift(cpu_limit):
    """1000 cycles at 10x10: (row, faults). Mean of the last 100 peaks against peaks 100 to 200."""
    mesh = ["mesh.set.nx=10", "mesh.set.nz=10", "output.history=false"]
    short = run(SCENE, mesh + ["time.until.U=0.2"], cpu_limit)
    ended = run(SCENE, mesh + ["time.until.U=2.1"], 10 * cpu_limit)
    case = stress_cases.Case("long run", "1000 cycles of sliding, 10x10", [])
    word, faults = "done", [] if ended.status == 0 else [f"exit status {ended.status}"]
    if faults:
        return row(case, ended, word, faults, None), faults
    peaks = [peak["mu"] for peak in ended.report["results"]["peaks"]]
    early, late = peaks[100:200], peaks[-100:]
    difference = abs(statistics.mean(late) / statistics.mean(early) - 1)
    noise = math.hypot(statistics.stdev(early), statistics.stdev(late)) / 10
    line = row(case, ended, word, [], difference)
    line[-1] = (f"{len(peaks)} peaks; mean of 100 to 200 {statistics.mean(early):.5f}, of the last "
                f"100 {statistics.mean(late):.5f}, standard error {noise:.5f}; memory grew by "
                f"{ended.memory - short.memory:.1f} MB over a tenth of the cycles")
    if len(peaks) < 1000:
        faults.append("fewer than 1000 cycles")
    if difference > 0.005:
        faults.append("the mean peak drifts")
    if ended.memory - short.memory > 20:
        faults.append("memory grows")
    return line, faults


def write(folder, rows):
    folder.mkdir(parents=True, exist_ok=True)
    wrong = sum("**WRONG**" in line[-1] for line in rows)
    text = (f"## Stress matrix\n\nVersion {commit()}: {len(rows)} runs, {wrong} wrong. Errors are "
            f"the largest over a run, relative; a twin is the same scene at finer steps unless the case says otherwise.\n\n")
    (folder / "stress.md").write_text(text + markdown_table(HEAD, rows) + "\n")
    with open(folder / "stress.csv", "w", newline="") as file:
        csv.writer(file).writerows([HEAD, *rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/stress")
    parser.add_argument("--only", nargs="*", help="cases with one of these words in group or name")
    parser.add_argument("--quick", action="store_true", help="some dozen cases, no long run")
    parser.add_argument("--no-cycles", action="store_true", help="no long run")
    parser.add_argument("--cpu", type=int, default=60, help="processor seconds a run may take")
    options = parser.parse_args()
    rows, wrong = [], 0
    for case in stress_cases.listed(options.quick):
        words = f"{case.group} {case.name}"
        if options.only and not any(word in words for word in options.only):
            continue
        ended = run(SCENE, case.settings, options.cpu)
        word, faults, difference = judge(case, ended, options.cpu)
        rows.append(row(case, ended, word, faults, difference))
        wrong += bool(faults)
        line = rows[-1]
        print(f"{words}: {word}, {line[3]} steps, mu {line[6]}, twin {line[8]}, {line[-3]} s"
              f"  {line[-1][:150]}", flush=True)
    if not (options.quick or options.no_cycles or options.only):
        line, faults = drift(options.cpu)
        rows.append(line)
        wrong += bool(faults)
        print(line)
    write(options.output, rows)
    print(f"{len(rows)} runs, {wrong} wrong; {options.output}/stress.md")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
