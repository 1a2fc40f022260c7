#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Hostile tries: damaged files, odd words, hard surroundings, signals. Each must end with an answer
or a sentence that names what is wrong; never in a crash, an endless loop, a wrong answer or the
loss of a file.

    validation/hostile/tries.py [-o FOLDER] [--only GROUP ...] [--every N] [-j N] [--anew]

cases.py describes them. Prints a table and leaves tries.md and tries.csv in FOLDER (default
results/hostile). It may be cut off at any time: each try that ended is a row of tries.csv, and the same
command goes on with the others; --anew, or another program, begins again. Exit status 1: some try ended
as none should.
"""
import argparse
import contextlib
import csv
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

import cases
from cases import ROOT, SCENE, square

PROGRAM = Path(os.environ.get("AMONTONS_BIN", ROOT / "build/bin"), "amontons").resolve()
PATIENCE = 100     # seconds until a try counts as endless; a mesh may take 60 s of processor time
# Thousands of files are synced: in memory, where there is room.
SCRATCH = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
WORDS = {0: "done", 1: "failed", 2: "refused"}
COLUMNS = ["group", "try", "ended", "wrong", "seconds", "said"]


def key_of(attempt):
    """(group, try) as tries.csv has them: in one line."""
    return attempt.group, attempt.name.encode("unicode_escape").decode()


class Stock:
    """What tries start from: an undisturbed run with its result and its cache."""
    def __init__(self, folder):
        self.scratch = folder
        self.result, self.cache = folder / "good/out", folder / "good/cache"
        cases.put(folder / "good", {"scene.yaml": SCENE, "block.msh": square(),
                                    "block.geo": ROOT / "meshes/block.geo"})
        call = lambda *words: subprocess.run([PROGRAM, *words], cwd=folder / "good", check=True, text=True,
                                             capture_output=True, env=os.environ | {"AMONTONS_CACHE": "cache"})
        call(*cases.RUN)
        self.answer = answer_of(self.result)
        self.key_table = call("info", "keys").stdout


def answer_of(folder):
    """What must be the same bits: all of run.json that is no time, no path and no count of memory."""
    report = json.loads((folder / "run.json").read_text())
    return {key: report.get(key) for key in ("status", "results", "errors", "warnings")}


def run(attempt, folder):
    """(exit status as the shell has it, seconds or None for no end, what it said)."""
    words = [str(PROGRAM), *attempt.words]
    if attempt.shell:
        words = ["sh", "-c", attempt.shell, "sh", *words]
    env = os.environ | {"AMONTONS_CACHE": ""} | attempt.env
    started = time.monotonic()
    process = subprocess.Popen(words, cwd=folder, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, start_new_session=True)
    with ThreadPoolExecutor(1) as reader:
        said = reader.submit(process.stdout.read)
        try:
            if attempt.signal:
                time.sleep(attempt.seconds)
                process.send_signal(attempt.signal)
            process.wait(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            return None, PATIENCE, ""
        finally:
            seconds = time.monotonic() - started
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)      # it and what it began, which would hold the pipe open
            process.wait()
        return process.returncode, seconds, said.result().decode(errors="replace")


def faults(attempt, status, said, folder, stock):
    """What is wrong with how it ended: a list of sentences."""
    for name in attempt.keeps:
        path, was = folder / name, attempt.files.get(name)
        if not path.exists() or was is not None and path.read_text(errors="replace") != was:
            yield f"lost or changed {name}"
    if status is None:
        yield f"no end in {PATIENCE} s"
        return
    if attempt.signal:
        yield from after_signal(attempt, folder, stock)
        return
    if status == 127 and "error while loading shared libraries" in said:
        return   # the system's loader met the limit, before the program's first line
    if status < 0 or status > 2:
        yield f"crash, status {status}"
        return
    if status not in attempt.may:
        yield f"ended with status {status}"
    sentence = re.search(r"^amontons( \w+)?: (error: )?.", said, re.M)
    told = not re.search(r"2>&-|2>/dev/full|2>&1", attempt.shell)   # somebody could hear it
    if status and told and not sentence:
        yield "no sentence"
    if status == 2 and told and attempt.says not in said:
        yield f"does not name {attempt.says}"
    if status == 0 and attempt.answer and not (folder / "out/run.json").exists():
        yield "done, without a result" if "removed" not in attempt.name and "777" not in attempt.name else ""
    elif status == 0 and attempt.answer and answer_of(folder / "out") != stock.answer:
        yield "ANOTHER ANSWER"


def after_signal(attempt, folder, stock):
    """What a signal left can be looked at, and the same command with --overwrite is right."""
    looked = subprocess.run([PROGRAM, "info", "out"], cwd=folder, capture_output=True, text=True)
    if looked.returncode not in (0, 2):
        yield f"info on what is left: status {looked.returncode}"
    if attempt.signal in (2, 15) and (folder / "out/amontons.lock").exists():
        yield "left its lock"
    if (folder / "out/run.json").exists():
        json.loads((folder / "out/run.json").read_text())
    again = subprocess.run([PROGRAM, *attempt.words, "--overwrite"], cwd=folder, capture_output=True, text=True,
                           env=os.environ | {"AMONTONS_CACHE": ""})
    if again.returncode != 0:
        yield f"the next run: {again.stderr.strip()}"
    elif answer_of(folder / "out") != stock.answer:
        yield "the next run has ANOTHER ANSWER"


def attempt_once(attempt, number, stock):
    """A row of tries.csv."""
    folder = stock.scratch / f"try{number}"
    cases.put(folder, {"scene.yaml": SCENE, "block.msh": square(), "block.geo": ROOT / "meshes/block.geo"}
              | attempt.files)
    status, seconds, said = run(attempt, folder)
    found = [fault for fault in faults(attempt, status, said, folder, stock) if fault]
    word = ("signal" if attempt.signal and status is not None else "no end" if status is None else
            WORDS.get(status, "failed" if status == 127 else "crash"))
    shutil.rmtree(folder, ignore_errors=True)
    return dict(zip(COLUMNS, (*key_of(attempt), word, "; ".join(found), f"{seconds:.2f}",
                              " ".join(said.split())[-300:])))


def table(rows):
    """Markdown: a row a group."""
    words = ["done", "refused", "failed", "signal", "crash", "no end"]
    lines = ["| group | tries | " + " | ".join(words) + " | wrong |", "|---" * (len(words) + 3) + "|"]
    for group in [*dict.fromkeys(row["group"] for row in rows), "all"]:
        mine = [row for row in rows if group in (row["group"], "all")]
        counts = Counter(row["ended"] for row in mine)
        wrong = sum(bool(row["wrong"]) for row in mine)
        lines.append(f"| {group} | {len(mine)} | " + " | ".join(str(counts[word]) for word in words) +
                     f" | {wrong} |")
    return "\n".join(lines)


def program_digest():
    """Tells one build from another: what an earlier build did is tried again."""
    digest = hashlib.sha256()
    for path in sorted(path for path in PROGRAM.parent.iterdir() if path.is_file()):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def rows_of_before(folder, anew):
    """{(group, try): row} of tries.csv, when this program wrote them. Begins the file anew if not."""
    path, mark = folder / "tries.csv", folder / "program"
    digest = program_digest()
    if not anew and path.exists() and mark.exists() and mark.read_text() == digest:
        lines = path.read_text(errors="replace").splitlines(keepends=True)
        whole = [line for line in lines if line.endswith("\n")]      # the last one may have been cut off
        path.write_text("".join(whole), newline="")
        return {(row["group"], row["try"]): row for row in csv.DictReader(whole)}
    folder.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerow(COLUMNS)
    mark.write_text(digest)
    return {}


def attempt_all(todo, stock, jobs, path):
    """Rows of the tries, each written as it ends; what is wrong is printed at once."""
    rows, started = [], time.monotonic()
    with ThreadPoolExecutor(jobs) as pool, path.open("a", newline="") as file:
        pending = {pool.submit(attempt_once, attempt, number, stock) for number, attempt in enumerate(todo)}
        for future in as_completed(pending):
            row = future.result()
            rows.append(row)
            csv.DictWriter(file, COLUMNS, lineterminator="\n").writerow(row)
            file.flush()
            if row["wrong"]:
                print(f"{row['group']}: {row['try']}: {row['ended']}; {row['wrong']}; {row['said'][-200:]}", flush=True)
            if len(rows) % 100 == 0:
                left = (time.monotonic() - started) * (len(todo) / len(rows) - 1)
                print(f"{len(rows)} of {len(todo)} tries, perhaps {left / 60:.0f} min left", flush=True)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/hostile")
    parser.add_argument("--only", nargs="*", help="groups with one of these names")
    parser.add_argument("--every", type=int, default=1, help="one try of so many")
    parser.add_argument("-j", type=int, default=os.cpu_count(), help="tries at a time")
    parser.add_argument("--anew", action="store_true", help="also what was tried before with this program")
    options = parser.parse_args()
    before = rows_of_before(options.output, options.anew)
    with tempfile.TemporaryDirectory(dir=SCRATCH) as scratch:
        stock = Stock(Path(scratch))
        listed = [attempt for group in cases.GROUPS for attempt in group(stock)]
        if options.only:
            listed = [attempt for attempt in listed if attempt.group in options.only]
        if options.every > 1:
            listed = [attempt for attempt in listed if not attempt.slow][::options.every]
        started = time.monotonic()
        todo = [attempt for attempt in listed if key_of(attempt) not in before]
        done = attempt_all(todo, stock, options.j, options.output / "tries.csv")
    found = before | {(row["group"], row["try"]): row for row in done}
    rows = [found[key_of(attempt)] for attempt in listed]
    text = table(rows)
    (options.output / "tries.md").write_text(text + "\n")
    for row in rows:
        if row["wrong"] and (row["group"], row["try"]) in before:
            print(f"before: {row['group']}: {row['try']}: {row['ended']}; {row['wrong']}")
    wrong = sum(bool(row["wrong"]) for row in rows)
    print(f"{text}\n\n{len(rows)} tries, {len(todo)} of them now in {time.monotonic() - started:.0f} s, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
