#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What each tuned constant of the program decides: every one at half and at twice its value.

    validation/benchmark/constants.py [--quick] [--page FILE] [-o FOLDER] [NAME ...]

The program has no knobs for these numbers. Its source is copied into FOLDER, one definition is
patched, the program is built there and a fixed set of short scenes is run: accepted steps, Newton
iterations and the answers of run.json are compared with those of the program as it is. How much
any other course to the same answer changes them is measured first: loads that differ in the tenth
digit, tolerances and steps that differ by 2 %. constants_listed.py beside this file has the list.
NAME: only these, by their name or as file.NAME; --quick: the first scenes only.

Each variant leaves a file in FOLDER (default results/constants); a run that was ended goes on
where it was, as long as the source is the same. The table goes to FOLDER/constants.md and, with
--page, into FILE as well, below what was written there by hand (--page docs/constants.md)."""
import argparse
import datetime
import hashlib
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from constants_listed import CONSTANTS, NOT_A_CHOICE, ROOT, places
from measured_run import commit, markdown_table

COPIED = ("src", "python", "render", "packaging", "meshes", "validation", "tests", "CMakeLists.txt",
          "CMakePresets.json")
PROBLEMS = "test_property_contact_problems"
TARGETS = ("amontons", "amontons_gmsh", "amontons_hdf5", PROBLEMS)
CPU_LIMIT, WALL_LIMIT = 60, 600      # seconds of a scene; they take less than 3
COST, ANSWER = 0.01, 0.001           # relative: less does not matter
FACTORS = {"half": 0.5, "twice": 2}
# Other courses to the same answer, for what any change of the steps brings about.
LOADS = (1e-9, 2e-9)                 # over the scene's, less 1
STEPS = ("time.tolerance=0.0049", "time.tolerance=0.0051", "time.wave_step=0.197",
         "time.wave_step=0.203")     # by default 0.005 and 0.2
QUIET = ["output.history=false", "output.fields=none", "output.figures=[]"]
PADS = ["mesh.file=../../meshes/pads.geo", "mesh.set={}"]
# steps and iterations are costs; the others answers
COSTS = ("steps", "newton")
ANSWERS = ("mu_M", "mu_hold", "mu_max", "l_sc", "l_c")


@dataclass(frozen=True)
class Scene:
    letter: str
    what: str
    file: str             # below validation
    settings: tuple
    pressure: float = 0   # copies differ in this load; 0: there is none
    kind: str = "run"     # "explicit": a run, too

    @property
    def command(self):
        return "stability" if self.kind == "stability" else "run"


def stress(letter, what, *settings):
    return Scene(letter, what, "benchmark/stress.yaml", settings, 0.003)


SCENES = [
    Scene("a", "Figure 1, 40 x 20 cells", "paper/fig1.yaml", ("mesh.set.nx=40", "mesh.set.nz=20"),
          0.003),
    stress("b", "rod at 1e-8 v_c", "rod.velocity=3.4e-12"),
    stress("c", "1e-2 v_c", "friction.critical_velocity=3.4e-6"),
    Scene("d", "set B, a block", "paper/set-b.yaml", ("time.until.U=2e-5",), 5.75e-5),
    Scene("e", "set A, 4 pads", "pads/pads.yaml", ("time.until.U=0.03",), 0.006),
    Scene("f", "set B, 4 pads", "pads/pads-b.yaml",
          ("mesh.set.size_contact=0.0005", "time.until.U=2e-5"), 5.75e-5),
    Scene("g", "set B, 8 pads, up to the first sliding", "pads/pads-b.yaml",
          ("mesh.set.n=8", "mesh.set.size_contact=0.0005", "time.until.U=4.5e-6"), 5.75e-5),
    Scene("h", "set B, 12 pads, up to the first sliding", "pads/pads-b.yaml",
          ("mesh.set.n=12", "mesh.set.size_contact=0.0005", "time.until.U=8e-6"), 5.75e-5),
    stress("i", "mu_S 5, 1e-2 v_c", "friction.mu_static=5", "time.until.U=0.0658"),
    stress("j", "12 pads, mu_S 2", *PADS, "mesh.set.n=12", "mesh.set.cells_pad=2",
           "mesh.set.cells_gap=2", "mesh.set.nz=6", "friction.mu_static=2", "time.until.U=0.02"),
    stress("k", "viscosity 0.1, eta2 = 10 eta1", "material.eta1=0.1"),
    stress("l", "thrown forwards", "start.velocity_x=1e-2", "rod.kind=bonded"),
    stress("m", "exponential law", "friction.law=exponential-weakening"),
    Scene("n", "explicit steps, 8 x 4 cells", "benchmark/explicit.yaml",
          ("mesh.set.nx=8", "mesh.set.nz=4", "time.until.U=0.005"), 0.003, "explicit"),
    Scene("o", "stability of Figure 1's block", "paper/fig1.yaml",
          ("mesh.set.nx=40", "mesh.set.nz=20"), 0.003, "stability"),
    Scene("p", "random contact problems", PROBLEMS, (), kind="problems"),
]


# --- one scene ----------------------------------------------------------------------------------

def call(words, folder, cache):
    """(exit status, what was printed, processor seconds); status None: it did not end."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT, CPU_LIMIT + 5))
    environment = dict(os.environ, AMONTONS_CACHE=str(cache), OPENBLAS_NUM_THREADS="1")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([str(word) for word in words], cwd=folder, capture_output=True,
                              text=True, env=environment, preexec_fn=limit, timeout=WALL_LIMIT)
    except subprocess.TimeoutExpired:
        return None, "", WALL_LIMIT
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    ended = None if done.returncode < -1 else done.returncode
    return ended, done.stdout + done.stderr, after.ru_utime - before.ru_utime


def counts_of_run(report):
    steps, found = report["steps"], report["results"]
    return {"steps": steps["accepted"], "newton": steps["contact_iterations"],
            "rejected": steps["rejected"], "certificates": steps["certificates"],
            "unknowns": report["model"]["reduced_dofs"],
            "mu_M": found["mu_M"], "mu_max": found["mu_max"],
            "mu_hold": found.get("mu_hold", found.get("mu_trusted")),
            "energy": report["errors"]["energy"]}


def counts_of_stability(report):
    found = report["results"]
    return {"steps": report["path_steps"], "mu_M": found["mu_M"], "l_sc": found["l_sc_over_L"],
            "l_c": found["l_c_over_L"]}


def counts_of_problems(said):
    """The test's own limits on these counts are not asked, only whether problems are solved."""
    wrong = re.findall(r"trial \d+[^\n]*|judged[^\n]*", said)
    path = re.search(r"problems solved by the path in (\d+) steps", said)
    given_up = re.search(r"problems given up after ([\d.]+) iterations", said)
    if wrong or not path or not given_up:
        return {"failed": (wrong or ["no count"])[0][:60]}
    return {"steps": int(path[1]), "newton": float(given_up[1])}


def compute(scene, tree, settings=(), cache=""):
    """What is left of a scene; {"failed": why} where it has no result. cache: a folder of bases."""
    programs = tree / "build"
    if scene.kind == "problems":
        status, said, _ = call([programs / "tests" / PROBLEMS], tree, cache)
        return {"failed": "no end"} if status is None else counts_of_problems(said)
    out = tree / "result"
    words = [programs / "bin/amontons", scene.command, tree / "validation" / scene.file, "-o", out,
             "--quiet", "--overwrite"]
    for setting in (*QUIET, *scene.settings, *settings):
        words += ["--set", setting]
    status, said, seconds = call(words, tree, cache)
    if status != 0:
        message = re.findall(r"error: ([^\n]*)", said)
        return {"failed": "no end" if status is None else (message or ["?"])[0][:60]}
    report = json.loads((out / f"{scene.command}.json").read_text())
    counts = counts_of_stability if scene.kind == "stability" else counts_of_run
    return {**counts(report), "seconds": seconds}


# --- variants -----------------------------------------------------------------------------------

def source_files(root):
    for name in COPIED:
        top = root / name
        yield from sorted(f for f in ([top] if top.is_file() else top.rglob("*"))
                          if f.is_file() and "__pycache__" not in f.parts)


def key_of(root, scenes):
    """Results belong to one source of the program and one set of scenes."""
    digest = hashlib.sha256(repr(scenes).encode())
    for path in source_files(root):
        if path.relative_to(root).parts[0] in ("src", "meshes", "CMakeLists.txt"):
            digest.update(str(path.relative_to(root)).encode() + path.read_bytes())
    return digest.hexdigest()[:12]


def build(tree, targets=TARGETS):
    """Empty where all is well, else what the compiler says."""
    done = subprocess.run(["cmake", "--build", "build", "--target", *targets], cwd=tree,
                          capture_output=True, text=True)
    return "" if done.returncode == 0 else (re.findall(r"error: ([^\n]*)", done.stdout) or ["?"])[0]


def copy_tree(tree):
    shutil.rmtree(tree, ignore_errors=True)
    for path in source_files(ROOT):
        to = tree / path.relative_to(ROOT)
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(path, to)
    subprocess.run(["cmake", "--preset", "release"], cwd=tree, check=True, capture_output=True)
    if said := build(tree):
        raise SystemExit(f"the program as it is does not build: {said}")


def value_of(constant):
    """The constant's text in its file; one place or none at all."""
    text = (ROOT / "src" / constant.file).read_text()
    found = places(constant, text)
    if len(found) != 1:
        raise SystemExit(f"{constant.name} stands {len(found)} times in src/{constant.file}, "
                         "not once: constants_listed.py is behind")
    return text[slice(*found[0])]


def scaled(value, factor):
    """`value` as text times factor; an integer stays one, at least 1."""
    if re.fullmatch(r"\d+", value) and int(value) != 0:
        return str(max(1, round(int(value) * factor)))
    return repr(float(value) * factor)


def compute_variant(constant, value, tree, scenes):
    """The scenes with the constant's definition replaced by `value`; the source is put back."""
    noticed = [scene for scene in scenes if constant.reaches(scene.kind)]
    cache = "" if constant.changes_basis else tree / "cache"
    if constant.is_key:
        settings = [f"{constant.name}={value}"]
        return {scene.letter: compute(scene, tree, settings, cache=cache) for scene in noticed}
    path = tree / "src" / constant.file
    text = path.read_text()
    (start, end), = places(constant, text)
    try:
        path.write_text(text[:start] + value + text[end:])
        said = build(tree, TARGETS if constant.reaches("problems") else ("amontons",))
        if said:
            return {"build": said}
        return {scene.letter: compute(scene, tree, cache=cache) for scene in noticed}
    finally:
        path.write_text(text)


def kept(folder, name, make):
    """The result in FOLDER, made and written first where there is none."""
    path = folder / f"{name}.json"
    if not path.exists():
        found = make()
        path.with_suffix(".part").write_text(json.dumps(found, indent=1))
        path.with_suffix(".part").rename(path)
    return json.loads(path.read_text())


# --- the table ----------------------------------------------------------------------------------

def compare(now, usual, names):
    """The largest relative change of these counts, and whether it is more than copies differ by
    and than what matters; now: of a variant, usual: of the copies, the first as it is."""
    worst, matters = 0.0, False
    least = COST if names is COSTS else ANSWER
    for name in names:
        values = [copy[name] for copy in usual if copy.get(name) is not None]
        if usual[0].get(name) is None:
            continue
        if now.get(name) is None:          # there is no answer any more
            worst, matters = math.inf, matters or len(values) == len(usual)
            continue
        # A mean of peaks may be near 0, where a block was thrown; friction's own size is not.
        unit = usual[0].get("mu_max", values[0]) if name.startswith("mu") else values[0]
        outside = not (min(values) - least * abs(unit) <= now[name]
                       <= max(values) + least * abs(unit))
        change = (now[name] - values[0]) / abs(unit) if unit else 0.0
        if (outside, abs(change)) > (matters, abs(worst)):
            worst, matters = change, outside
    return worst, matters


@dataclass
class Effect:
    costs: tuple          # (largest change, matters, letter)
    answers: tuple
    failed: list          # "letter: why"
    same: bool            # to the last digit, in all scenes


def effect_of(found, usual, scenes):
    if "build" in found:
        return Effect((0, False, ""), (0, False, ""), [f"does not build: {found['build']}"], False)
    best = {COSTS: (0.0, False, ""), ANSWERS: (0.0, False, "")}
    failed, same = [], True
    for scene in scenes:
        now, copies = found.get(scene.letter), usual[scene.letter]
        if now is None:
            continue
        if "failed" in now:
            if "failed" not in copies[0]:
                failed.append(f"{scene.letter}: {now['failed']}")
            continue
        same = same and all(now.get(name) == copies[0].get(name) for name in COSTS + ANSWERS)
        for names in best:
            change, matters = compare(now, copies, names)
            if (matters, abs(change)) > (best[names][1], abs(best[names][0])):
                best[names] = (change, matters, scene.letter)
    return Effect(best[COSTS], best[ANSWERS], failed, same and not failed)


def verdict(effects):
    if any(effect.failed for effect in effects):
        return "**guards**"
    if all(effect.same for effect in effects):
        return "not noticed"
    if any(effect.answers[1] for effect in effects):
        return "**matters for mu**"
    if any(effect.costs[1] for effect in effects):
        return "**matters for cost**"
    return "does not matter"


def shown(part):
    change, matters, letter = part
    if not letter or change == 0:
        return "0"
    text = "lost" if math.isinf(change) else f"{100 * change:+.2g} %"
    return f"{text} ({letter})" if matters else f"({text})"


def row_of(constant, value, effects):
    cells = [f"`{constant.name}`", f"{value}", constant.file, constant.decides, constant.chosen]
    for effect in effects:
        cells += ["; ".join(effect.failed) or shown(effect.costs),
                  "" if effect.failed else shown(effect.answers)]
    return cells + [verdict(effects)]


TABLE = "## At half and at twice"      # what stands above this line of a page was written by hand
HEAD = ["constant", "value", "file", "decides", "chosen by", "half: cost", "mu", "twice: cost", "mu",
        "verdict"]


def spread_rows(usual, scenes):
    """What copies of a scene differ by."""
    rows = []
    for scene in scenes:
        copies = usual[scene.letter]
        row = [scene.letter, scene.what]
        for name in ("steps", "newton", "mu_M", "mu_hold"):
            values = [copy[name] for copy in copies if copy.get(name) is not None]
            if copies[0].get(name) is None:
                row.append("")
                continue
            spread = (max(values) - min(values)) / abs(values[0])
            row.append(f"{values[0]:.5g}" + f" ({100 * spread:.2g} %)" * (spread > 0))
        rows.append(row)
    return rows


def page(rows, usual, scenes, command):
    others = [[f"`{name}`", file, why] for file, names in NOT_A_CHOICE.items()
              for name, why in names.items()]
    today = datetime.date.today().isoformat()
    return f"""{TABLE}

`{command}`, version {commit()}, {today}. Each number at half and at twice its value (whole
numbers rounded, at least 1): its definition was patched, the program built, and the scenes below
were run.

`cost`: the largest relative change of accepted steps or Newton iterations; `mu`: of mu_M, mu_hold,
the largest mu, l_sc or l_c; the letter says in which scene. A change counts where it is more than
{100 * COST:g} % of the cost, {100 * ANSWER:g} % of an answer, beyond what other courses to the same
answer spread over: loads that differ in the tenth digit, `time.tolerance` and `time.wave_step`
changed by 2 %. The largest change that does not count stands in brackets. *Not noticed*: every
count and answer is the same to the last digit. *Guards*: a scene fails. Processor time is not
compared.

{markdown_table(HEAD, rows)}

## The scenes

In brackets: what other courses to the same answer spread over.

{markdown_table(["", "scene", "steps", "Newton", "mu_M", "mu_hold"], spread_rows(usual, scenes))}

In the random contact problems (tests/property) `steps` are those of the path and `Newton` the iterations
after which a problem is given up where no path is followed.

## Numbers that are no choice

{markdown_table(["constant", "file", "why"], others)}
"""


# --- all of it ----------------------------------------------------------------------------------

def chosen(names):
    found = [c for c in CONSTANTS if not names or c.name in names or c.label in names]
    missing = [n for n in names if not any(n in (c.name, c.label) for c in CONSTANTS)]
    if missing:
        raise SystemExit(f"no such constant: {' '.join(missing)}")
    return found


def copies_of(scene):
    """Settings of runs that should answer the same; the first is the scene itself."""
    if scene.kind == "problems":
        return [()]
    loads = [(f"load.pressure={scene.pressure * (1 + change):.17g}",) for change in LOADS]
    return [(), *loads, *([setting] for setting in STEPS if scene.kind == "run")]


def measure_usual(tree, scenes):
    usual = {}
    for scene in scenes:
        usual[scene.letter] = [compute(scene, tree, copy, tree / "cache")
                               for copy in copies_of(scene)]
        print(scene.letter, usual[scene.letter][0], flush=True)
    return usual


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/constants")
    parser.add_argument("--quick", action="store_true", help="three scenes only")
    parser.add_argument("--page", type=Path)
    parser.add_argument("names", nargs="*", metavar="NAME")
    options = parser.parse_args()
    scenes = SCENES[:3] if options.quick else SCENES
    values = {constant: value_of(constant) for constant in chosen(options.names)}
    folder = options.output.resolve() / key_of(ROOT, scenes)
    folder.mkdir(parents=True, exist_ok=True)
    tree = folder / "tree"
    copy_tree(tree)
    usual = kept(folder, "as-it-is", lambda: measure_usual(tree, scenes))
    rows = []
    for constant, value in values.items():
        effects = []
        for word, factor in FACTORS.items():
            found = kept(folder, f"{constant.label}-{word}", lambda: compute_variant(
                constant, scaled(value, factor), tree, scenes))
            effects.append(effect_of(found, usual, scenes))
        rows.append(row_of(constant, value, effects))
        print(" | ".join(rows[-1][:3] + rows[-1][5:]), flush=True)
    words = ["validation/benchmark/constants.py"] + ["--quick"] * options.quick + options.names
    text = page(rows, usual, scenes, " ".join(words))
    for path in filter(None, (options.output / "constants.md", options.page)):
        above = path.read_text().split(TABLE)[0] if path.exists() else ""
        path.write_text(above + text)
        print(path)


if __name__ == "__main__":
    sys.exit(main())
