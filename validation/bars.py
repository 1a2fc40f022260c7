#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The studies with error bars of a folder, and one page of their answers.

    validation/bars.py validation/pads [-j N] [-o results/bars]
    validation/bars.py validation/pads/count-bars.yaml

Sweeps every *-bars.yaml of the folder, or those named (a call that is stopped goes on where it was), and writes FOLDER/bars.md: a
table a study, an answer with its bar a row; tables of other studies stay. The folder's README says which statements stand."""
import argparse
import csv
import json
import re
import resource
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
from measured_run import PROGRAM, markdown_table   # noqa: E402

ANSWERS = ("mu_M", "mu_hold")
NO_KEYS = {"point", "run", "status", "message", "warnings", "period", "slip_cells", "spread", "l_c", "total_s",
           "model.contact_nodes", *ANSWERS, *(f"{name}_{what}" for name in ANSWERS for what in ("error", "known_to"))}


def answer(row, name):
    """0.2713 +- 0.0036, without the bar where it is not known."""
    value, error = (float(row[key] or "nan") for key in (name, f"{name}_error"))
    if value != value:
        return "none"
    return f"{value:.4f} ± {error:.4f}" if bar_is_known(row, error) else f"{value:.4f}, not known"


def bar_is_known(row, error):
    return error == error and "mesh's part of it is not known" not in str(row["warnings"])


def why(row):
    """The first words of each warning about what is not met or not resolved."""
    return "; ".join(sorted({text.strip().split(":")[0] for text in row["warnings"].split(" // ") if text.strip()}))


def number(text, form):
    return format(float(text), form) if text else ""


def table(rows, study):
    keys = [key for key in rows[0] if key not in NO_KEYS and len({row[key] for row in rows}) > 1
            and not any(f"{key}: = " in line for line in study.splitlines())]   # formulas follow from the others
    lines = [[*(f"{float(row[key]):.4g}" if row[key][:1].isdigit() else row[key] for key in keys),
              *(answer(row, name) for name in ANSWERS), number(row["slip_cells"], ".3g"), number(row["total_s"], ".1f"), why(row)] for row in rows]
    return markdown_table([*keys, *ANSWERS, "cells that slip runs away on", "s", "warned of"], lines)


def sections(page):
    """{title: text} of a page that main wrote; figures are drawn from it (read_table)."""
    texts = page.read_text().split("\n## ")[1:] if page.exists() else []
    return {text.split("\n")[0]: "## " + text.strip() for text in texts}


def read_table(text):
    """Rows of the first table of a section as dicts; of an answer (value, bar), the bar None where it is not known."""
    lines = [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in text.splitlines() if line.startswith("|")]
    return [dict(zip(lines[0], map(read_cell, line))) for line in lines[2:]]


def read_cell(cell):
    value = re.fullmatch(r"(-?[\d.]+(?:e-?\d+)?)(?: ± ([\d.]+)|(, not known))?", cell)
    if not value:
        return cell
    if value[2] or value[3]:
        return float(value[1]), float(value[2]) if value[2] else None
    return float(value[1])


def read_rows(rows):
    """Rows of a sweep's table, as read_table has them."""
    found = []
    for row in rows:
        answers = {}
        for name in ANSWERS:
            value, error = (float(row[key] or "nan") for key in (name, f"{name}_error"))
            answers[name] = (value, error if bar_is_known(row, error) else None) if value == value else "none"
        found.append({**row, **answers})
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("place", type=Path, nargs="+", help="a folder, or studies of one")
    parser.add_argument("-j", "--jobs", default="1")
    parser.add_argument("--page", action="store_true", help="write the page from what was computed, and compute nothing")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/bars")
    words = parser.parse_args()
    whole = words.place[0].is_dir()
    home = words.place[0] if whole else words.place[0].parent
    studies = sorted(home.glob("*-bars.yaml")) if whole else words.place
    if not studies:
        parser.error(f"{home} has no *-bars.yaml")
    found = {} if whole else sections(home / "bars.md")
    page = [f"# Answers with error bars\n\nBy `validation/bars.py {home.resolve().relative_to(ROOT)}`. Bars of 95 % "
            "([docs/accuracy.md](../../docs/accuracy.md)); s: wall time of\na point, its mesh and reduction included, on a "
            "machine that did other things as well.\n"]
    for study in studies:
        folder = words.output / study.stem
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        if not words.page:
            subprocess.run([PROGRAM, "sweep", study, "-j", words.jobs, "-o", folder], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        rows = list(csv.DictReader((folder / "sweep.csv").open()))
        title = study.read_text().split("title: ")[1].split("\n")[0]
        version = json.loads((folder / rows[0]["run"] / "run.json").read_text())["version"]
        found[title] = f"## {title}\n\n`amontons sweep {study.resolve().relative_to(ROOT)}`, version {version}\n\n{table(rows, study.read_text())}"
        seconds = sum(getattr(after, key) - getattr(before, key) for key in ("ru_utime", "ru_stime"))
        if seconds > 1:   # else nothing was computed
            print(f"{study.name}: {seconds:.0f} s of processor time", file=sys.stderr)
    page += [found[title] for title in sorted(found)]
    (home / "bars.md").write_text("\n\n".join(text.strip() for text in page) + "\n")


if __name__ == "__main__":
    main()
