#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Points that a review found in what is answered, and in which words: tried as in points.py.

    validation/hostile/points_answers.py [--only NAME ...]
"""
import csv
import json
import re
import shutil
import sys

import cases
from point_table import PROGRAM, call, last_line, main, put_scene, refused

POINTS = {}
OBEYED = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f]")   # by a terminal; ends of lines and tabs are not
RUN = ["run", "scene.yaml", "--quiet", "-o"]


def point(function):
    POINTS[function.__name__] = function
    return function


def first_line(said):
    return (said.splitlines() or ["nothing said"])[0]


def results(folder, name):
    return json.loads((folder / name / "run.json").read_text())["results"]


def put_study(folder, text):
    (folder / "study.yaml").write_text(cases.STUDY + text)
    return ["sweep", "study.yaml", "--quiet", "-o", "swept"]


def rows(folder):
    with open(folder / "swept/sweep.csv", newline="") as file:
        return [row["results.mu_max"] for row in csv.DictReader(file)]


def computed(folder, words, program=PROGRAM):
    """How many points; None: another status."""
    words = [word for word in words if word != "--quiet"]
    status, said = call(folder, *words, shell=f'shift; "{program}" "$@"')
    found = re.search(r"(\d+) computed", said)
    return int(found[1]) if status == 0 and found else None


@point
def terminal(folder):
    """9: ESC and BEL in a folder's name."""
    odd = folder / "a\033[31m\007b"
    odd.mkdir()
    put_scene(odd)
    (odd / "study.yaml").write_text(cases.STUDY)
    for words in (["run", odd / "scene.yaml", "-o", odd / "out"], ["run", odd / "scene.yaml", "-o", odd / "out"], ["info", odd / "out"],
                  ["info", odd / "scene.yaml"], ["info", odd / "block.geo"], ["run", odd / "none.yaml"], ["report", odd / "out"],
                  ["render", odd], ["film", odd], ["static", odd], ["stability", odd], ["model1d", odd],
                  ["sweep", odd / "study.yaml", "-o", odd / "swept"], [odd]):
        _, said = call(folder, *words)
        name = "\\x1b[31m\\x07b"
        yield f"{words[0] if len(words) > 1 else 'no command'}, ESC and BEL", last_line(OBEYED.sub("?", said)), not OBEYED.search(said) and name in said


@point
def characters(folder):
    """9: what neither XML nor Cairo can hold, in a title and a key."""
    put_scene(folder)
    for written in ("\\uFFFE", "\\e[31m", "\\uFDD0", "\\x85", "\ufffe", "\x9b"):
        (folder / "odd.yaml").write_text(cases.SCENE.replace("Hostile", f'"a{written}b"'))
        status, said = call(folder, "run", "odd.yaml", "-o", "out")
        yield f"title {written!r}", first_line(said), refused(status, said, "odd.yaml:1:8: title: ") and "U+" in said
    status, said = call(folder, "run", "scene.yaml", "-o", "out", "--set", "title=\ufffe")
    yield "--set title", first_line(said), refused(status, said, "--set title:1:7")
    yield "nothing computed", "", not (folder / "out").exists()


@point
def foreign_history(folder):
    """11: a checkpoint and the history of another run."""
    put_scene(folder)
    call(folder, *RUN, "one")
    call(folder, *RUN, "other", "--set", "load.pressure=0.004")
    shutil.copyfile(folder / "other/history.h5", folder / "one/history.h5")
    before = {path.name: path.read_bytes() for path in (folder / "one").iterdir() if path.is_file()}
    for words in (["--extend", "U=0.0009"], ["--resume"]):
        status, said = call(folder, *RUN, "one", *words)
        same = before == {path.name: path.read_bytes() for path in (folder / "one").iterdir() if path.is_file()}
        yield words[0], last_line(said), refused(status, said, "history") and same


@point
def damaged_reports(folder):
    """11: a digit of a result in `reports` of `keep: table`."""
    put_scene(folder)
    words = put_study(folder, "keep: table\n")
    first = computed(folder, words)
    wanted, reports = rows(folder), folder / "swept/reports"
    whole = reports.read_bytes()
    for key in (b'"mu_max":0.', b'"version":"0.'):
        at = whole.index(key) + len(key)
        reports.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1:])
        again = computed(folder, words)
        yield f"{key.decode()}", f"{first}, then {again} computed", first == 2 and again == 1 and rows(folder) == wanted


@point
def other_sources(folder):
    """12: rows, bases and states of a build of other sources: a copy of the program with another hash in its library."""
    put_scene(folder)
    built = re.search('"([0-9a-f]{64})"', (PROGRAM.parents[1] / "generated/computing_sources.h").read_text())[1].encode()
    shutil.copytree(PROGRAM.parent, folder / "bin", symlinks=True)
    library = next(path for path in (folder / "bin").glob("libamontons.so.*") if not path.is_symlink())
    library.write_bytes(library.read_bytes().replace(built, built[::-1]))
    other = folder / "bin/amontons"
    for keep in ("", "keep: table\n"):
        words = put_study(folder, keep)
        counts = [computed(folder, words, program) for program in (PROGRAM, PROGRAM, other, other, PROGRAM)]
        yield f"a sweep, {keep.strip() or 'folders'}", f"computed: {counts}", counts == [2, 0, 2, 0, 0]
        shutil.rmtree(folder / "swept")
    call(folder, *RUN, "run")
    status, said = call(folder, *RUN, "run", "--extend", "U=0.0009", shell=f'shift; "{other}" "$@"')
    yield "a checkpoint", last_line(said), refused(status, said, "other sources")


@point
def place_along_x(folder):
    """13: a mesh that does not begin at x = 0."""
    lengths = []
    for begin in (0, 100, -0.37):
        text = cases.square(6, 4)
        nodes = re.search(r"\$Nodes\n(.*?)\$EndNodes", text, re.S)
        moved = re.sub(r"(?m)^(\S+) (\S+) 0$", lambda found: f"{float(found[1]) + begin!r} {found[2]} 0", nodes[1])
        put_scene(folder)
        (folder / "block.msh").write_text(text.replace(nodes[1], moved))
        status, said = call(folder, *RUN, f"at{begin}", "--set", "mesh={file: block.msh}", "time.until.U=0.012", "load.pressure=0.003")
        found = results(folder, f"at{begin}") if status == 0 else {}
        lengths.append(found.get("l_c_over_L"))
        good = lengths[-1] is not None and abs(lengths[-1] - (lengths[0] or 9)) < 1e-9
        yield f"a block from x = {begin} on", f"l_c/L = {lengths[-1]}" if status == 0 else last_line(said), good


@point
def profile_heads(folder):
    """14: what heads a profile."""
    put_scene(folder)
    si = ["units=si", "material={young: 1, density: 1, eta1: 1, eta2: 1, poisson: 0.34}", "contact.profile=p.csv"]
    for head, good in (("x/mm, gap/um", True), ("mm, um", False), ("x_mm, gap_um", True), ("x [mm], gap [um]", True),
                       ("O.1, 0.2", False), ("x/mn, gap/um", False), ("x, gap/kg", False), ("place, depth", False), ("x", False)):
        (folder / "p.csv").write_text(f"{head}\n0, 0\n1000, 5\n")     # over all of the contact in mm alone
        status, said = call(folder, "info", "scene.yaml", "--set", *si)
        if good:
            status, said = call(folder, *RUN, "out", "--overwrite", "--set", *si, "time.until.U=1e-4", "time.energy_tolerance=1")
            yield head, last_line(said), status == 0
        else:
            yield head, last_line(said), refused(status, said, "p.csv:")


@point
def said_plainly(folder):
    """15: what was taken, or answered, without a word."""
    put_scene(folder)
    twice = "friction.contacts=[{group: contact, mu_static: 0.3}, {group: contact, mu_static: 0.2}]"
    dip = "friction={law: formula, formula: 0.3 - 0.4 * exp(-((v - 1.2e-4) / 1e-5)^2)}"
    for name, words, said_so in (("a group twice", ["--set", twice], "named twice"), ("a formula below 0 for a moment", ["--set", dip], "at velocity 0.0001"),
                                 ("--to 0%", ["--to", "0%"], "--to: found `0%`")):
        status, said = call(folder, *RUN, "out", *words)
        yield name, first_line(said), refused(status, said, said_so)
    status, said = call(folder, "run", "scene.yaml", "-o", "thrown", "--set", "start.velocity_x=1000")
    answer = next((line for line in said.splitlines() if "mu_M" in line), said)
    yield "thrown with 1000", answer, status == 0 and "from the start on" in answer and results(folder, "thrown")["mu_M"] is None


@point
def odd_places(folder):
    """16: a folder `50% load`, a damaged .vtu, numbers too far apart, a limit that is none."""
    put_scene(folder)
    half = folder / "50% load"
    call(folder, *RUN, half, "--set", "output.fields={every_U: 4e-4}")
    status, said = call(folder, "film", half, "--seconds", "0.1", "--quiet")
    yield "film of `50% load`", last_line(said), status == 0 and (folder / "50% load.mp4").exists()
    for path in (half / "fields").glob("*.vtu"):
        whole = path.read_bytes()
        path.write_bytes(whole[:len(whole) // 2] + bytes(100) + whole[len(whole) // 2 + 100:])
    status, said = call(folder, "render", half, "--figure", "field")
    yield "a damaged .vtu", last_line(said), refused(status, said, ".vtu") and len(said.splitlines()) == 1 and not OBEYED.search(said)
    for settings, key in ((["material.poisson=0.4999999999", "material.plane=strain"], "reduction.use"),
                          (["mesh.set.height=1e6"], "start.tolerance"), (["material.eta2=1e12"], "reduction.use")):
        status, said = call(folder, *RUN, "out", "--overwrite", "--set", *settings)
        yield settings[0], last_line(said), status == 0 or refused(status, said, key)
    status, said = call(folder, *RUN, "limit", env={"AMONTONS_CACHE": str(folder / "cache"), "AMONTONS_CACHE_LIMIT": "abc"})
    yield "AMONTONS_CACHE_LIMIT=abc", last_line(said), refused(status, said, "AMONTONS_CACHE_LIMIT: found `abc`")


if __name__ == "__main__":
    sys.exit(main(POINTS))
