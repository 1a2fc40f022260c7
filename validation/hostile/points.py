#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Points that a review found: each tried on the built program, one function a point (those of callers of the library and of
processes in points_calls.py, of answers in points_answers.py; each of the three can be called alone).

    validation/hostile/points.py [--only NAME ...]

A function takes an empty folder and yields (what was tried, what happened, good or not), as often as it tries something.
Prints a table in Markdown. Exit status 1: some point is bad.
"""
import os
import sys
from pathlib import Path

import cases
import points_answers
import points_calls
from point_table import call, last_line, main, put_scene, refused

# --- the points: name, function ------------------------------------------------------------------

POINTS = {}


def point(function):
    POINTS[function.__name__] = function
    return function


@point
def pipes_in_place(folder):
    """5. A pipe in the place of a file that is read."""
    put_scene(folder)
    call(folder, *cases.RUN)
    for name, words in (("out/history.h5", ["render", "out"]),
                        ("out/run.json", ["report", "out"]), ("out/checkpoint.bin", [*cases.RUN, "--resume"]),
                        ("scene.yaml", ["run", "scene.yaml", "-o", "new"]), ("block.geo", ["info", "block.geo"])):
        path = folder / name
        held = path.read_bytes()
        path.unlink()
        os.mkfifo(path)
        status, said = call(folder, *words, seconds=20)
        yield f"{' '.join(words[:2])}, {name} is a pipe", last_line(said), status in (0, 1, 2)
        path.unlink()
        path.write_bytes(held)


@point
def files_of_somebody(folder):
    """6. What is not ours is not written over."""
    put_scene(folder)
    call(folder, *cases.RUN)
    (folder / "plot.yaml").write_text(cases.PLOT)
    film = ["--seconds", "0.1", "--size", "640x360", "-q"]
    for name, words in (("mine.mp4", ["film", "out", "-o", "mine.mp4", *film]), ("out.mp4", ["film", "out", *film]),
                        ("mine.html", ["report", "out", "-o", "mine.html"]), ("out/report.html", ["report", "out"]),
                        ("comparison.html", ["report", "out", "out"]), ("plot.png", ["render", "plot.yaml"]),
                        ("mine.png", ["info", "scene.yaml", "--picture", "mine.png"]),
                        ("out/figures/force.png", ["render", "out", "-f", "force"])):
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("somebody's")
        status, said = call(folder, *words)
        yield (f"{' '.join(words[:2])} over {name} of somebody", last_line(said),
               refused(status, said, Path(name).name) and path.read_text() == "somebody's")
        status, said = call(folder, *words, "--overwrite")
        yield "the same with --overwrite", last_line(said), status == 0 and path.read_bytes() != b"somebody's"


@point
def links_of_parts(folder):
    """7. Nothing is written through a link."""
    put_scene(folder)
    call(folder, *cases.RUN)
    film = ["--seconds", "0.1", "--size", "640x360", "-q"]
    victim = folder / "victim"
    cache = {"AMONTONS_CACHE": "cache"}
    (folder / "cache").mkdir()
    for name, words in (("out.mp4.part", ["film", "out", *film]), ("out/report.html.part", ["report", "out"]),
                        ("out/figures/force.png.part", ["render", "out", "-f", "force"]),
                        ("new/history.h5.part", ["run", "scene.yaml", "-o", "new", "--overwrite"]),
                        ("new/amontons.lock", ["run", "scene.yaml", "-o", "new", "--overwrite"])):
        victim.write_text("precious")
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.symlink_to(victim)
        status, said = call(folder, *words, env=cache)
        yield (f"{' '.join(words[:2])}, {name} is a link", last_line(said),
               status in (0, 1, 2) and victim.read_text() == "precious")
        path.unlink(missing_ok=True)


@point
def a_secret_in_a_page(folder):
    """8. A page holds no file that a link in the result leads to."""
    put_scene(folder)
    call(folder, *cases.RUN)
    (folder / "secret").write_bytes(b"GIF89a, the key of my house")
    (folder / "out/film.gif").symlink_to(folder / "secret")
    status, said = call(folder, "report", "out")
    page = (folder / "out/report.html").read_text()
    yield "out/film.gif is a link to a secret", last_line(said), status == 0 and "data:image/gif" not in page


@point
def runs_that_do_not_begin(folder):
    """10. The earlier result stays until the new run has made its first step."""
    put_scene(folder)
    call(folder, *cases.RUN)
    held = lambda: {path.name: path.read_bytes() for path in (folder / "out").iterdir() if path.is_file()}
    before = held()
    for what, more, shell in (("gap 1e50", ["--set", "contact.profile=gap.txt"], None),
                              ("step_min 1", ["--set", "time.step_min=1"], None),
                              ("ulimit -f 1", [], 'ulimit -f 1; trap "" XFSZ; exec "$@"')):
        (folder / "gap.txt").write_text("0 1e50\n1 1e50\n")
        status, said = call(folder, *cases.RUN, "--overwrite", *more, shell=shell)
        yield f"{what}, --overwrite", last_line(said), status in (1, 2) and held() == before


if __name__ == "__main__":
    sys.exit(main(POINTS | points_calls.POINTS | points_answers.POINTS))
