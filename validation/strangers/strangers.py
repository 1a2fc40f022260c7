#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Do error bars hold on problems that nobody has looked at?

    validation/strangers/strangers.py [--set tuning|judging] [--only N[,M]] [-j N] [-o FOLDER]

Eight hundred and fifty scenes (problems.py) are asked for 1, 2 or 3 % with `--to`, within a minute each; references come from plain runs
on finer meshes at three pressures (judge.py), until their own error is below a third of the bar, or --limit is used up. Each
problem is a file of FOLDER (default results/strangers), written after every run: the same command goes on where it was
stopped. Small meshes first. Leaves table.md and table.csv in FOLDER. The first 750 are for tuning; of
the others only counts are told, unless --show-judging is given. Exit status 1: an acceptance number is not met.

A new program is judged in a new folder; --references FOLDER (or a .jsonl) takes the runs of references from an earlier one,
which do not depend on bars."""
import argparse
import concurrent.futures
import csv
import json
import re
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
import judge                                                    # noqa: E402
import problems                                                 # noqa: E402
from measured_run import PROGRAM, commit, markdown_table, run   # noqa: E402

WITHIN = 60                 # s, of each request
USUAL = 70                  # s of processor time of a problem, its reference included
ASK_LIMIT = 600             # s of processor time after which a request is ended
WINDOW = (0.995, 1, 1.005)  # of pressure: ends and middle of the program's own window
LONGER = 3                  # runs with too few drops in their second half, or that drift, are made so many times as long,
LONGEST = 27                # at most so many times in all,
STEADY = 1e-3               # drift, relative, that such a one may have
MANY = 36                   # one with so many or more, of either kind, so many times as short
QUIET = ["output.history=false"]


# --- what was computed --------------------------------------------------------------------------

class Kept:
    """The file of one problem: {"scene": digest, "asked": {...}, "longer": factor on U, "runs": [...]}."""

    def __init__(self, folder, one, earlier=None):
        self.path, self.digest = folder / f"{one.number:03d}.json", problems.digest([one])
        self.data = {"number": one.number, "problem": self.digest, "asked": None, "longer": 1, "runs": [], "unknowns": None}
        if self.path.exists() and (data := json.loads(self.path.read_text()))["problem"] == self.digest:
            self.data = data
        elif earlier and earlier["problem"] == self.digest:
            self.data |= {key: earlier[key] for key in ("longer", "runs")}
            if not any(row.get(name) for row in self.data["runs"] for name in judge.ANSWERS):
                self.data["runs"] = []      # cheap, and an earlier version may not have known steady sliding

    def forget_cut(self, limit):
        """A run that the limit of an earlier call cut off is made again where there is now twice the time that it had."""
        whole = [row for row in self.data["runs"] if row.get("said") != "too long"]
        cut = sum(row["seconds"] for row in self.data["runs"] if row not in whole)
        if limit - sum(row["seconds"] for row in whole) > 2 * cut:
            self.data["runs"] = whole

    def save(self):
        part = self.path.with_suffix(".json.new")
        part.write_text(json.dumps(self.data))
        os.replace(part, self.path)


def earlier_of(place):
    """{number: data} of a folder or a .jsonl."""
    if not place:
        return {}
    texts = place.read_text().splitlines() if place.is_file() else [path.read_text() for path in sorted(place.glob("[0-9]*.json"))]
    return {row["number"]: row for row in map(json.loads, texts)}


# --- computing ----------------------------------------------------------------------------------

def size(scene):
    """Unknowns of the scene's own mesh, as --dry-run says; None: refused, and why."""
    done = subprocess.run([PROGRAM, "run", scene, "--dry-run"], capture_output=True, text=True)
    found = re.search(r"(\d+) unknowns", done.stdout)
    return (int(found[1]), "") if done.returncode == 0 and found else (None, done.stderr.strip())


def ask(one, scene):
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as cache:        # what a user pays who tries this shape for the first time
        ended = run(scene, QUIET, ASK_LIMIT, cache=cache, words=["--to", str(one.wanted), "--within", f"{WITHIN}s"])
    results, found = ended.report.get("results", {}), ended.report.get("accuracy") or {}
    keep = ("refine", "contact_nodes", "undamped", "other_drops", "slip_cells", "end_wait", "runs", "seconds", "seconds_expected")
    return {"version": commit(), "status": ended.status, "said": ended.said[-600:], "seconds": ended.seconds,
            "wall": time.monotonic() - began, "wanted": one.wanted,
            **{key: results.get(key) for name in judge.ANSWERS for key in (name, f"{name}_error", f"{name}_error_parts")},
            "mu_M_is": results.get("mu_M_is"), "met": found.get("met"), "of": found.get("of"), "ended": found.get("ended"), "cut": found.get("cut"),
            "levels": [{key: level.get(key) for key in keep} | {name: level[name]["value"] for name in judge.ANSWERS}
                       for level in found.get("levels", [])],
            "warnings": ended.report.get("warnings", [])}


def finer(one, scene, refine):
    """Settings of a mesh whose cells are so many times as small. A mesh without the parameter has its size."""
    if one.shape != "wedge":
        return [f"mesh.set.refine={refine}"]
    size = float(one.scene.partition("size: ")[2].partition(",")[0].rstrip("}"))
    return [f"mesh.set.size={size / refine:.6g}"]


def value_in(text, key):
    """The number behind `key: ` in a scene, its unit left out."""
    return float(text.partition(f"{key}: ")[2].replace(",", " ").replace("}", " ").split()[0])


def reference_run(one, scene, place, longer, limit):
    refine, factor = place
    unit = " kPa" if " kPa" in one.scene else ""
    end = longer * value_in(one.scene, "until: {U")
    settings = [*QUIET, *finer(one, scene, refine), f"time.until.U={end:.6g}",
                f"load.pressure={factor * value_in(one.scene, 'pressure'):.9g}{unit}"]
    ended = run(scene, settings + ["reduction.use=never"] * one.whole, max(5, round(limit)))
    row = {"version": commit(), "refine": refine, "pressure": factor, "seconds": ended.seconds, "status": ended.status}
    if not ended.report.get("results"):
        return row | {"said": "too long" if ended.timed_out else ended.said[-300:]}
    report = ended.report
    return row | judge.reading(report, end) | {
        "program": {name: report["results"][name] for name in ("mu_M_is", *judge.ANSWERS)}, "nodes": report["model"]["contact_nodes"],
        "steps": report["steps"]["accepted"], "slip_cells": report["results"].get("slip_cells"),
        "solve": report["timing_s"]["solve"], "warnings": report["warnings"]}


def enough(asked, runs):
    """Whether the reference is known well enough for each bar that was given."""
    for name in judge.ANSWERS:
        truth, value, bar = judge.reference(runs, name), asked[name], asked[f"{name}_error"]
        if truth is None or not judge.reaches(truth, asked):
            return False
        if truth.value is not None and value is not None and bar and not judge.decides(truth, value, bar):
            return False
    return True


def spent(kept):
    return sum(row["seconds"] for row in kept.data["runs"])


def other_length(row):
    if "late" not in row:
        return 1
    too_few = all(row[name] is None for name in judge.ANSWERS)
    return LONGER if too_few else 1 / LONGER if min(row["late"].values()) >= MANY else 1


def settled(row):
    """Whether a run that was made shorter has its run-in behind it."""
    return "late" in row and all(row[name] and abs(row["drift"][name]) <= STEADY * row[name] for name in judge.ANSWERS)


def extend(one, scene, kept, limit):
    """Runs of the reference until it is known well enough, or the limit of processor time is met. Where the first mesh shows that
    they are too short to decide they are begun anew, longer; not where the scene's own program says what happens when."""
    in_time = any(word.startswith(("program", "ramp", "holds")) for word in one.features)
    for refine in judge.LADDER:
        if kept.data["asked"] and enough(kept.data["asked"], good(kept)):
            return
        if not in_time and len(good(kept)) == len(kept.data["runs"]) == len(WINDOW) and \
                kept.data["longer"] < LONGEST and judge.too_short(kept.data["asked"], good(kept)):
            kept.data |= {"longer": kept.data["longer"] * LONGER, "lengthened": True, "runs": []}
            return extend(one, scene, kept, limit)
        done = {row["pressure"] for row in kept.data["runs"] if row["refine"] == refine}
        for factor in (f for f in WINDOW if f not in done):
            left = limit - spent(kept)
            if left < 5 or any(row["status"] for row in kept.data["runs"][-2:]):
                return
            row = reference_run(one, scene, (refine, factor), kept.data["longer"], left)
            if not kept.data["runs"] and kept.data["longer"] == 1 and not kept.data.get("lengthened") and (longer := other_length(row)) != 1:
                other = reference_run(one, scene, (refine, factor), longer, left)
                if longer > 1 or settled(other):
                    kept.data["longer"], row = longer, other
            kept.data["runs"].append(row)
            kept.save()


def good(kept):
    return [row for row in kept.data["runs"] if "late" in row]


def compute(one, kept, options):
    scene = one.write(options.output / "scenes")
    if kept.data["asked"] is None:
        kept.data["asked"] = ask(one, scene)
        kept.save()
    if not options.asks and kept.data["asked"]["status"] == 0:
        extend(one, scene, kept, options.limit)


# --- telling ------------------------------------------------------------------------------------

def verdicts_of(one, kept):
    return [judge.verdict(one.number, name, kept.data["asked"], judge.reference(good(kept), name)) for name in judge.ANSWERS]


def cells_of(one, kept, found):
    asked, cells = kept.data["asked"], [one.number, one.shape, ", ".join(one.features), f"{100 * one.wanted:g}"]
    for each in found:
        truth = judge.reference(good(kept), each.answer)
        value, bar = asked[each.answer], asked[f"{each.answer}_error"]
        cells += ["none" if value is None else f"{value:.4f}" + (f" ± {bar:.4f}" if bar else ", not known"),
                  "" if truth is None else "none" if truth.value is None else f"{truth.value:.4f} ± {truth.own:.4f}",
                  each.kind + (f", {each.ratio:.2f}" if each.ratio == each.ratio else "")]
    nodes = ", ".join(str(level["contact_nodes"]) for level in asked["levels"])
    return [*cells, {True: "yes", False: "no"}.get(asked["met"], ""), nodes, f"{asked['seconds']:.0f}"]


HEAD = ["", "shape", "what is in it", "asked, %", "mu_M", "reference", "verdict, bars", "mu_hold", "reference", "verdict, bars",
        "met", "contact nodes", "cpu s"]


def counts_text(title, pairs):
    """A paragraph on [(problem, kept)]."""
    found = [each for one, kept in pairs for each in verdicts_of(one, kept)]
    asked = [kept.data["asked"] for _, kept in pairs]
    lines = [f"**{title}**: {len(pairs)} problems computed, {len(found)} answers."]
    for name, some in [*((name, [each for each in found if each.answer == name]) for name in judge.ANSWERS), ("both", found)]:
        total = judge.count(some)
        kinds = ", ".join(f"{total.kinds[kind]} {kind}" for kind in judge.KINDS)
        lines.append(f"- {name}: {kinds}; |error| / bar: median {total.median:.2f}, worst {total.worst:.2f}.")
    lines.append(f"- {sum(bool(one['met']) for one in asked)} met the request within {WITHIN} s; processor time "
                 f"{statistics.median(one['seconds'] for one in asked):.1f} s in the median, {max(one['seconds'] for one in asked):.0f} s "
                 f"at most; {sum(one['wall'] > 1.25 * WITHIN for one in asked)} took more than 1.25 times the time they were given.")
    lines += [f"- **not met**: {sentence}." for sentence in judge.count(found).failed]
    return "\n".join(lines)


def write_tables(folder, pairs, show_judging):
    shown = [(one, kept) for one, kept in pairs if one.tuning or show_judging]
    rows = [cells_of(one, kept, verdicts_of(one, kept)) for one, kept in shown]
    parts = [(title, [(one, kept) for one, kept in pairs if one.tuning == tuning])
             for title, tuning in (("Tuning", True), ("Judging", False))]
    texts = [counts_text(title, some) for title, some in parts if some]
    if all(some for _, some in parts):
        texts.append(counts_text("All", pairs))
    versions = ", ".join(sorted({kept.data["asked"]["version"] for _, kept in pairs}))
    text = "\n\n".join([f"Version {versions}.", *texts, markdown_table(HEAD, rows)]) + "\n"
    (folder / "table.md").write_text(text)
    with (folder / "table.csv").open("w") as file:
        csv.writer(file).writerows([HEAD, *rows])
    return "\n\n".join(texts)


def minutes(seconds):
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"


def check(chosen, folder):
    """Whether the program takes every scene; no answer is computed."""
    bad = 0
    for one in chosen:
        unknowns, said = size(one.write(folder / "scenes"))
        bad += unknowns is None
        if unknowns is None:
            print(f"{one.number} {one.shape}: {said}")
    print(f"{len(chosen) - bad} of {len(chosen)} scenes are accepted by `amontons run --dry-run`")
    return bad


def chosen_of(options):
    only = {int(word) for word in options.only.split(",")} if options.only else None
    return [one for one in problems.problems() if (not only or one.number in only)
            and options.set in (None, "tuning" if one.tuning else "judging")]


def work(todo, options):
    """Computes, and tells how long it may go on by what problems took so far; before the first by what the median one takes."""
    print(f"{len(todo)} problems to compute or complete, perhaps {minutes(USUAL * len(todo) / options.jobs)} on free cores", flush=True)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        began = time.monotonic()
        running = {pool.submit(compute, one, kept, options): (one, kept) for one, kept in todo}
        try:
            for at, future in enumerate(concurrent.futures.as_completed(running), 1):
                one, kept = running[future]
                future.result()
                left, told = (time.monotonic() - began) * (len(todo) / at - 1), ""
                if one.tuning or options.show_judging:
                    told = "; ".join(f"{each.answer} {each.kind}" + (f" {each.ratio:.2f}" if each.ratio == each.ratio else "")
                                     for each in verdicts_of(one, kept))
                print(f"{at}/{len(todo)}: {one.number} {one.shape}, asked {kept.data['asked']['seconds']:.0f} s, reference "
                      f"{spent(kept):.0f} s; {told}; {minutes(left)} left", flush=True)
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/strangers")
    parser.add_argument("--set", choices=("tuning", "judging"))
    parser.add_argument("--only", metavar="N[,M]")
    parser.add_argument("-j", "--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=120, metavar="S", help="processor time of a reference (%(default)s s)")
    parser.add_argument("--asks", action="store_true", help="no runs of references")
    parser.add_argument("--references", type=Path, metavar="PLACE", help="folder or .jsonl with the references of an earlier version")
    parser.add_argument("--show-judging", action="store_true", help="tell of the judging part one by one: rules are then no longer judged by it")
    parser.add_argument("--scenes", action="store_true", help="only write the scenes into FOLDER/scenes")
    parser.add_argument("--check", action="store_true", help="only see whether the program takes every scene")
    parser.add_argument("--table", action="store_true", help="only tell what was computed")
    parser.add_argument("--pack", type=Path, metavar="FILE.jsonl", help="gather what was computed, a line a problem")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    chosen = chosen_of(options)
    if options.scenes:
        return print("\n".join(str(one.write(options.output / "scenes")) for one in chosen))
    if options.check:
        return 1 if check(chosen, options.output) else 0
    earlier = earlier_of(options.references)
    pairs = [(one, Kept(options.output, one, earlier.get(one.number))) for one in chosen]
    if not options.table:
        for one, kept in pairs:
            kept.forget_cut(options.limit)
            if kept.data.get("unknowns") is None:
                kept.data["unknowns"] = size(one.write(options.output / "scenes"))[0]
                kept.save()
        todo = [pair for pair in pairs if not finished(pair[1], options)]
        work(sorted(todo, key=lambda pair: pair[1].data["unknowns"] or 0), options)
    known = [pair for pair in pairs if pair[1].data["asked"]]
    if options.pack:
        options.pack.write_text("".join(json.dumps(kept.data) + "\n" for _, kept in known))
    if not known:
        return 0
    print(write_tables(options.output, known, options.show_judging))
    return 1 if judge.count([each for one, kept in known for each in verdicts_of(one, kept)]).failed else 0


def finished(kept, options):
    asked, runs = kept.data["asked"], kept.data["runs"]
    if asked is None:
        return False
    return bool(options.asks or asked["status"] or enough(asked, good(kept)) or options.limit - spent(kept) < 5
                or any(row["status"] for row in runs[-2:]))


if __name__ == "__main__":
    sys.exit(main())
