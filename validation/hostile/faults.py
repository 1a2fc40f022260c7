#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Every call to the system that may fail does so once: each open, write, sync, rename, mkdir,
truncate, close, fork and allocation of a run, a sweep and a render; and every write from the nth on,
as on a full disk. Of allocations that the same chain of callers makes again and again (a loop) it is
the first, when there is nothing yet to free, and the last, when there is all. Each must end with a sentence, or with the whole answer; what has its final name
must be whole; and the next run must be right.

    validation/hostile/faults.py [-o FOLDER] [--only WORD ...] [--every N] [-j N] [--anew]

tests/faults/file_faults.c makes them fail. (Every allocation of a run, and that nothing leaks:
tests/faults/test_run_memory.c.) Prints a table and leaves faults.md and faults.csv in FOLDER (default
results/hostile). Some 1400 faults take ten minutes on two idle cores; cut off, the same command goes on behind what faults.csv has, --anew
begins again. Exit status 1: some fault ended as none should.
"""
import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py

import cases
from cases import ROOT, SCENE, STUDY
from tries import PROGRAM, SCRATCH, answer_of

sys.path.append(str(ROOT / "tests/end_to_end"))
from preload_fixture import preload      # noqa: E402
from sanitizer_fixture import runtime  # noqa: E402   (a sanitizer wants to be loaded first)

SHIM = Path(os.environ.get("AMONTONS_FAULTS", PROGRAM.parents[1] / "tests/file_faults.so")).resolve()
OUTPUTS = ["--set", "output.figures=[force]", "--set", "output.fields={every_U: 4e-4}"]
# What is done, and what must stand before.
WORK = {
    "run": ["run", "scene.yaml", "-o", "out", "--quiet", *OUTPUTS],
    "sweep": ["sweep", "study.yaml", "-o", "points", "-j", "1", "--quiet"],
    "render": ["render", "out", "--figure", "force"],
    "info": ["info", "out"],
}
PATIENCE = 300   # s


class Stock:
    """A folder with scene, study and a good result, and the faults of each work."""
    def __init__(self, folder, works):
        self.scratch, self.good = folder, folder / "good"
        cases.put(self.good, {"scene.yaml": SCENE, "study.yaml": STUDY, "block.geo": ROOT / "meshes/block.geo"})
        assert call(WORK["run"], self.good).returncode == 0
        self.answer = answer_of(self.good / "out")
        self.faults = {}
        for work in works:
            folder = self.fresh(work)
            assert call(WORK[work], folder, f"count:{folder}/counts").returncode == 0
            self.faults[work] = list(faults_of(folder / "counts"))
            if work == "sweep":
                self.table = values_of(folder)

    def fresh(self, name):
        """A folder in which `name` is done: with the result where that is looked at."""
        folder = self.scratch / name
        leave_out = ("out",) if name.startswith(("run", "sweep")) else ()
        shutil.copytree(self.good, folder, ignore=lambda _, names: [n for n in names if n in leave_out])
        return folder


def faults_of(path):
    """What to let fail, as FILE_FAULT has it, by the list of calls: kind, number, callers."""
    calls = [line.split() for line in path.read_text().splitlines()]
    first, last = {}, {}
    for kind, number, callers in calls:
        first.setdefault((kind, callers), number)
        last[kind, callers] = number
    for kind, number, callers in calls:
        if kind != "memory" or number in (first[kind, callers], last[kind, callers]):
            yield f"{kind}:{number}"
        if kind == "write":
            yield f"{kind}:{number}+"


def call(words, folder, fault=""):
    """The program, with a cache of its own in the folder."""
    env = os.environ | {"AMONTONS_CACHE": str(folder / "cache")}
    env |= preload(runtime(SHIM), SHIM) | {"FILE_FAULT": fault} if fault else {}
    return subprocess.run([PROGRAM, *words], cwd=folder, env=env, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=PATIENCE)


def values_of(folder):
    """The table of a sweep without times."""
    with open(folder / "points/sweep.csv", newline="") as file:
        return [{key: cell for key, cell in row.items() if "time" not in key and "second" not in key}
                for row in csv.DictReader(file)]


def half_written(folder):
    """Files under their final names that are not whole."""
    for path in sorted(folder.rglob("*")):
        if path.name == "history.h5":
            try:
                with h5py.File(path) as file:
                    file["series/mu"][:]
            except (OSError, KeyError) as fault:
                yield f"{path.name}: {fault}"
        elif path.suffix in (".vtu", ".vtp", ".pvd") and "</VTKFile>" not in path.read_text(errors="replace")[-40:]:
            yield f"{path.name} is cut off"
        elif path.suffix == ".png" and b"IEND" not in path.read_bytes()[-12:]:
            yield f"{path.name} is cut off"
        elif path.suffix == ".json" and not path.read_text().rstrip().endswith("}"):
            yield f"{path.name} is cut off"


def judge(work, folder, ended, stock):
    """What is wrong with how it ended."""
    if ended is None:
        yield f"no end in {PATIENCE} s"
        return
    if not 0 <= ended.returncode <= 2:
        yield f"crash, status {ended.returncode}"
    if ended.returncode > 0 and not re.search(r"(?m)^amontons( \w+)?: (error|warning): .|failed", ended.stderr + ended.stdout):
        yield "no sentence"
    yield from half_written(folder)
    if ended.returncode == 0:
        if work == "run" and answer_of(folder / "out") != stock.answer:
            yield "done, with another answer"
        if work == "sweep" and values_of(folder) != stock.table:
            yield "done, with another table"
        if work in ("run", "render") and not (folder / "out/figures/force.png").exists():
            yield "done, without the picture"
    if work in ("run", "sweep"):
        again = call(WORK[work] + (["--overwrite"] if work == "run" else ["--retry"]), folder)
        if again.returncode != 0:
            yield f"the next one: {again.stderr.strip()[-200:]}"
        elif (answer_of(folder / "out") != stock.answer if work == "run" else values_of(folder) != stock.table):
            yield "the next one has another answer"


def fail_once(number, work, fault, stock):
    """(work, fault, how it ended, what is wrong)."""
    folder = stock.fresh(f"{work}{number}")
    try:
        ended = call(WORK[work], folder, fault)
    except subprocess.TimeoutExpired:
        ended = None
    wrong = list(judge(work, folder, ended, stock))
    shutil.rmtree(folder, ignore_errors=True)
    word = "no end" if ended is None else {0: "done", 1: "failed", 2: "refused"}.get(ended.returncode, "crash")
    return work, fault, word, wrong, (ended.stderr if ended else "").strip()


def table(rows, stock):
    """Markdown: a row for each kind of call in each work."""
    lines = ["| work | calls | how many | whole answer | a sentence | wrong |", "|---|---|---|---|---|---|"]
    kinds = dict.fromkeys((work, fault.split(":")[0] + " and all later" * fault.endswith("+")) for work, fault, *_ in rows)
    for work, kind in kinds:
        mine = [row for row in rows if row[0] == work and
                row[1].split(":")[0] + " and all later" * row[1].endswith("+") == kind]
        done = sum(word == "done" and not wrong for _, _, word, wrong, _ in mine)
        said = sum(word in ("failed", "refused") and not wrong for _, _, word, wrong, _ in mine)
        lines.append(f"| {work} | {kind} | {len(mine)} | {done} | {said} | {len(mine) - done - said} |")
    return "\n".join(lines)


FIELDS = ["work", "fault", "ended", "wrong", "said"]


def earlier(path):
    """Rows that an earlier call left."""
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return [(row["work"], row["fault"], row["ended"], row["wrong"].split("; ") if row["wrong"] else [], row["said"])
                for row in csv.DictReader(file)]


def try_all(options, path):
    """(rows, stock); each is put into the file `path` as it comes."""
    if options.anew:
        path.unlink(missing_ok=True)
    rows = earlier(path)
    done = {row[:2] for row in rows}
    with tempfile.TemporaryDirectory(dir=SCRATCH) as scratch, ThreadPoolExecutor(options.j) as pool:
        stock = Stock(Path(scratch), options.only or WORK)
        faults = [(work, fault) for work, faults in stock.faults.items() for fault in faults]
        faults = [fault for fault in faults[::options.every] if fault not in done]
        faults.sort(key=lambda fault: "memory" in fault[1])   # the many allocations last
        with open(path, "a", newline="") as file:
            writer = csv.writer(file)
            if not rows:
                writer.writerow(FIELDS)
            for row in pool.map(lambda pair: fail_once(pair[0], *pair[1], stock), enumerate(faults)):
                work, fault, word, wrong, said = row
                writer.writerow([work, fault, word, "; ".join(wrong), " ".join(said.split())[:300]])
                file.flush()
                rows.append(row)
    return rows, stock


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/hostile")
    parser.add_argument("--only", nargs="*", help="works, of " + ", ".join(WORK))
    parser.add_argument("--every", type=int, default=1, help="one fault of so many")
    parser.add_argument("-j", type=int, default=os.cpu_count(), help="faults at a time")
    parser.add_argument("--anew", action="store_true", help="forget what was tried")
    options = parser.parse_args()
    started = time.monotonic()
    options.output.mkdir(parents=True, exist_ok=True)
    rows, stock = try_all(options, options.output / "faults.csv")
    text = table(rows, stock)
    for work, fault, word, wrong, said in rows:
        if wrong:
            print(f"{work}, {fault}: {word}; {'; '.join(wrong)}; {said[-200:]}")
    (options.output / "faults.md").write_text(text + "\n")
    wrong = sum(bool(row[3]) for row in rows)
    print(f"{text}\n\n{len(rows)} faults in {time.monotonic() - started:.0f} s, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
