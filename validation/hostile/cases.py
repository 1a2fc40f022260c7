# SPDX-License-Identifier: GPL-2.0-or-later
"""What tries.py does to the program, described in lists: each function yields tries of one group. A
try has a folder of its own with scene.yaml, block.geo and block.msh of `stock`."""
import os
import random
import re
import shutil
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = """title: Hostile
mesh: {file: block.geo, set: {nx: 6, nz: 4}}
material: {young: 1, poisson: 0.34, density: 1, eta1: 1, eta2: 1, plane: stress}
friction: {law: linear-weakening, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}
load: {pressure: 0.003}
rod: {velocity: 1e-5, kind: push}
time:
  until: {U: 0.0008}
output:
  history: true
  figures: []
"""
STUDY = """title: Two loads
scene: scene.yaml
set: {time.until.U: 2e-4}
vary:
  load.pressure: [0.003, 0.004]
record: [results.mu_max]
"""
PLOT = """title: Two points
x: {label: a, scale: log, range: [1e-3, 1]}
y: {label: b}
legend: below
series:
  - {label: one, x: [0.001, 0.01], y: [0.38, null], low: [0.3, 0.2], high: [0.4, 0.3], color: 1}
inset: {place: [0.5, 0.05, 0.97, 0.5], x: {label: c}, y: {label: d}, series: []}
"""
REFUSED, FAILED, DONE = 2, 1, 0
RUN = ["run", "scene.yaml", "-o", "out", "--quiet"]


@dataclass
class Try:
    group: str
    name: str
    words: list                # of the command line
    files: dict = field(default_factory=dict)   # name -> text, bytes or Path, put into the folder
    may: tuple = (DONE, FAILED, REFUSED)        # how it may end
    says: str = ""             # must stand in the error
    shell: str = ""            # a line of sh around it; "$@" is the program with its words
    answer: bool = False       # where it is done: the same bits as an undisturbed run
    seconds: float = 0         # >0: sent `signal` after so long
    signal: int = 0
    env: dict = field(default_factory=dict)
    keeps: tuple = ()          # files that must stand as they were
    slow: bool = False         # takes seconds: only where all are tried


def square(nx=3, nz=2):
    """A block of quadrilaterals in the format 4.1, as text."""
    node = lambda i, j: 1 + i + j * (nx + 1)
    curves = [[(node(i, 0), node(i + 1, 0)) for i in range(nx)],
              [(node(i, nz), node(i + 1, nz)) for i in range(nx)],
              [(node(0, j), node(0, j + 1)) for j in range(nz)]]
    cells = [(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))
             for j in range(nz) for i in range(nx)]
    count = (nx + 1) * (nz + 1)
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "4", '1 1 "contact"',
             '1 2 "top"', '1 3 "rod"', '2 9 "body"', "$EndPhysicalNames", "$Entities", "0 3 1 0",
             "1 0 0 0 1 0 0 1 1 0", "2 0 .5 0 1 .5 0 1 2 0", "3 0 0 0 0 .5 0 1 3 0",
             "1 0 0 0 1 .5 0 1 9 3 1 2 3", "$EndEntities", "$Nodes", f"1 {count} 1 {count}",
             f"2 1 0 {count}", *map(str, range(1, count + 1)),
             *(f"{i / nx} {j / nz / 2} 0" for j in range(nz + 1) for i in range(nx + 1)),
             "$EndNodes", "$Elements", f"4 {2 * nx + nz + nx * nz} 1 {2 * nx + nz + nx * nz}"]
    tag = 0
    for at, (dimension, kind, items) in enumerate([(1, 1, curve) for curve in curves] +
                                                  [(2, 3, cells)]):
        lines.append(f"{dimension} {at % 3 + 1} {kind} {len(items)}")
        for item in items:
            tag += 1
            lines.append(" ".join(map(str, (tag, *item))))
    return "\n".join(lines + ["$EndElements", ""])


# --- damage ---------------------------------------------------------------------------------------

def cuts(text, count):
    """The text cut off at `count` places."""
    return [(f"cut at {at}", text[:at]) for at in
            (len(text) * k // (count + 1) for k in range(1, count + 1))]


def line_faults(text):
    """Each line left out, doubled, indented by a tab, its colon lost, opened by a bracket."""
    lines = text.splitlines(keepends=True)
    for k, line in enumerate(lines):
        for what, new in (("left out", ""), ("twice", line * 2), ("with a tab", "\t" + line),
                          ("without colon", line.replace(":", "", 1)), ("in brackets", "[" + line),
                          ("one level deeper", "   " + line), ("of nulls", "~: ~\n")):
            yield f"line {k + 1} {what}", "".join(lines[:k] + [new] + lines[k + 1:])


def odd_texts(text):
    """What no editor writes, and what attacks YAML readers."""
    yield "empty", ""
    yield "only a comment", "# nothing\n"
    yield "with a byte order mark", "\ufeff" + text
    yield "with CRLF", text.replace("\n", "\r\n")
    yield "in UTF-16", text.encode("utf-16")
    yield "with a byte that is no UTF-8", text.encode() + b"title: \xff\xfe\n"
    yield "with a zero byte", text.encode()[:40] + b"\0" + text.encode()[40:]
    yield "nested 20000 deep", "a: " + "[" * 20000
    yield "nested maps", "{a: " * 5000
    yield "laughs", "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
        f"{b}: &{b} [{','.join(['*' + a] * 9)}]\n" for a, b in zip("abcdefgh", "bcdefghi"))
    yield "an alias of itself", "a: &a [*a]\n"
    yield "two documents", text + "---\n" + text
    yield "a tag", "!!python/object:os.system x\n" + text
    yield "1 MB of one word", "a" * (1 << 20)
    yield "100000 keys", "".join(f"k{k}: 1\n" for k in range(100000))
    yield "binary", bytes(random.Random(1).randrange(256) for _ in range(4000))


def flips(data, count, seed, reach=None):
    """Bytes flipped, set, cleared or lost at random places; reach: how far from the beginning."""
    dice = random.Random(seed)
    for k in range(count):
        bad = bytearray(data)
        for _ in range(dice.choice([1, 1, 2, 8])):
            at = dice.randrange(min(len(bad), reach or len(bad)))
            width = dice.choice([1, 1, 4, 8])
            bad[at:at + width] = dice.choice([bytes([bad[at] ^ 1 << dice.randrange(8)]),
                                              b"\xff" * width, b"\0" * width])
        yield f"damage {k + 1}", bytes(bad[:dice.randrange(len(bad))] if k % 10 == 9 else bad)


# --- groups ---------------------------------------------------------------------------------------

VALUES = ["", "-1", "nan", "inf", "1e300", "1e-300", "0x10", "1,5", "true", "[]", "{a: 1}", "x" * 2000,
          "3 km", "\x07"]


def keys(stock):
    """Every key of a scene with values that no scene should have."""
    for key in re.findall(r"^\| `([\w.]+)`", stock.key_table, re.M):
        for value in VALUES:
            yield Try("key", f"{key}={value[:12]!r}", ["info", "scene.yaml", "--set", f"{key}={value}"],
                      says=key.split(".")[0])


def scenes(stock):
    for name, text in [*cuts(SCENE, 30), *line_faults(SCENE), *odd_texts(SCENE)]:
        yield Try("scene", name, ["info", "scene.yaml"], {"scene.yaml": text}, says="scene.yaml")


def meshes(stock):
    """Words of a mesh replaced, lines lost, doubled and swapped, two at a time."""
    dice = random.Random(18)
    odd = ["-1", "0", "99999", "1e9", "4294967295", "9223372036854775807", "nan", "x", "3", "15", "27"]
    for k in range(110):
        lines = square().split("\n")
        for _ in range(dice.choice([1, 1, 2])):
            at, kind = dice.randrange(len(lines)), dice.randrange(6)
            words = lines[at].split(" ")
            if kind < 3:
                words[dice.randrange(len(words))] = dice.choice(odd)
            lines[at:at + 1] = ([" ".join(words)] if kind < 3 else [] if kind == 3 else
                                [lines[at]] * 2 if kind == 4 else [" ".join(words[:-1])])
        yield Try("mesh", f"damage {k + 1}", ["info", "bad.msh"], {"bad.msh": "\n".join(lines)},
                  says="bad.msh")
    for name, text in cuts(square(), 12):
        yield Try("mesh", name, ["info", "bad.msh"], {"bad.msh": text}, says="bad.msh")


FIELD = 'Field[1] = ExternalProcess; Field[1].CommandLine = "rm own.txt; cat"; Background Field = 1; Point(1) = {0, 0, 0};\n'
GEOMETRIES = {
    "commands": 'SystemCall "rm own.txt";\n', "a command by a field": FIELD, "a command behind a comment": '// "\n' + FIELD,
    "a command behind a quote": "s = '\"'; SystemCall \"rm own.txt\"; t = '\"';\n",
    "a command behind what is skipped": 'If(0)\n s = "EndIf SystemCall"; t = " own.txt ";\nEndIf\n',
    "a command by a name": 'S2N["SystemCall"] "rm own.txt";\n', "a command of its own": 'Foo = 1; Foo "rm own.txt";\n',
    "a client": 'OnelabRun("x", "rm own.txt");\n', "prints": 'Print "own.txt";\n', "saves": 'Save "own.txt";\n',
    "a log": 'General.LogFileName = "own.txt";\nError("x");\n', "a plug-in that writes":
    'Plugin(AnalyseMeshQuality).Run; Plugin(Distance).FileName = "own.txt"; Plugin(Distance).Run;\n',
    "a folder": 'CreateDir "own.txt";\n', "sleeps": "Sleep 100000;\n", "asks": 'x = GetValue("how many?", 3);\n',
    "a shape that is a terminal": 'Merge "/dev/tty.step";\nMerge "/dev/zero";\n',
    "many threads": "General.NumThreads = 1000; Mesh.MaxNumThreads2D = 1000; Mesh.MaxNumThreads3D = 1000;\nMesh 2;\n",
    "a script that is a mesh": 'Merge "own.msh";\n',
 "writes": 'Printf("x") > "own.txt";\n',
    "merges": 'Merge "own.txt";\n', "includes itself": 'Include "bad.geo";\n',
    "an error": "Point(1) = {0, 0,\n", "no surface": "Point(1) = {0, 0, 0};\n",
    "Exit": "Exit;\n", "Abort": "Abort;\n", "Error": 'Error("no");\n', "calls itself":
    "Macro m\n Call m;\nReturn\nCall m;\n", "a name of 300 bytes": f'Physical Curve("{"n" * 300}") = {{1}};\n',
    "divides by zero": "Point(1) = {1/0, 0, 0};\n", "a mesh size of zero": "SetFactory(\"OpenCASCADE\");\n"
    "Rectangle(1) = {0, 0, 0, 1, 1};\nMesh.MeshSizeMax = 0;\nMesh.MeshSizeMin = 0;\n",
    "NUL bytes": "\0\0\0", "three dimensions": "SetFactory(\"OpenCASCADE\");\nBox(1) = {0,0,0,1,1,1};\n",
}


# gmsh takes a size of zero for none given, and says so; `info` shows a block in space. Both have a mesh.
GOOD_GEOMETRIES = "a mesh size of zero", "three dimensions"


def geometries(stock):
    for name, text in GEOMETRIES.items():
        may = (DONE,) if name in GOOD_GEOMETRIES else (FAILED, REFUSED)
        yield Try("geometry", name, ["info", "bad.geo"], {"bad.geo": text, "own.txt": "mine"}, may=may,
                  says="own.txt:1" if name == "merges" else "bad.geo", keeps=("own.txt",), slow=name == "calls itself")
    for setting in ("nx=40000000", "nx=1e300", "nx=-3", "nx=nan", "length=1e300", "length=0", "height=-1",
                    "grade_z=1e300", "nx=0.5", "unknown=1", "refine=1e9", "order=99"):
        yield Try("geometry", setting, ["info", "block.geo", "--set", setting], may=(FAILED, REFUSED),
                  says=setting.split("=")[0] if setting == "unknown=1" else "")


def results(stock):
    for name, data in flips((stock.result / "history.h5").read_bytes(), 70, 2, reach=20000):
        yield Try("history", name, ["render", "out"], {"out/history.h5": data,
                  "out/run.json": stock.result / "run.json"}, says="out")
    for name, data in flips((stock.result / "history.h5").read_bytes(), 10, 3, reach=20000):
        yield Try("history", f"drawn, {name}", ["render", "out", "--figure", "force"],
                  {"out/history.h5": data}, says="out")
    report = (stock.result / "run.json").read_text()
    for name, text in [*cuts(report, 30), *odd_texts(report)]:
        yield Try("run.json", name, ["info", "out"], {"out/run.json": text}, says="run.json")


def caches(stock):
    """A damaged cache may cost time, never an answer."""
    for file in sorted(stock.cache.iterdir()):
        if file.suffix in (".shape", ".basis"):
            for name, data in flips(file.read_bytes(), 20, file.suffix):
                files = {f"cache/{other.name}": other for other in stock.cache.iterdir()}
                yield Try("cache", f"{file.suffix}, {name}", RUN, files | {f"cache/{file.name}": data},
                          may=(DONE,), answer=True, env={"AMONTONS_CACHE": "cache"})


STUDIES = {
    "a key in set and in vary": STUDY.replace("time.until.U", "load.pressure"),
    "a key varied twice": STUDY.replace("record:", "  load.pressure: [1]\nrecord:"),
    "no such record": STUDY.replace("results.mu_max", "results.mu_mx"),
    "no such key": STUDY.replace("load.pressure", "load.presure"),
    "an empty list": STUDY.replace("[0.003, 0.004]", "[]"),
    "a hundred million points": STUDY.replace(
        "  load.pressure: [0.003, 0.004]", "\n".join(f"  {k}: [{','.join(map(str, range(1, 101)))}]" for k in
        ("load.pressure", "rod.velocity", "material.eta1", "material.eta2"))),
    "a scene that is not there": STUDY.replace("scene.yaml", "other.yaml"),
    "itself as its scene": STUDY.replace("scene.yaml", "study.yaml"),
    "a formula without end": STUDY.replace("[0.003, 0.004]", '"' + "(" * 5000 + '"'),
}


def studies(stock):
    for name, text in STUDIES.items():
        yield Try("study", name, ["sweep", "study.yaml", "-o", "out"], {"study.yaml": text},
                  may=(FAILED, REFUSED), says="other.yaml" if "not there" in name else "study.yaml")
    for name, text in [*cuts(STUDY, 20), *line_faults(STUDY), *odd_texts(STUDY)]:
        yield Try("study", name, ["sweep", "study.yaml", "-o", "out"], {"study.yaml": text})


def plots(stock):
    for name, text in [*cuts(PLOT, 20), *line_faults(PLOT), *odd_texts(PLOT)]:
        yield Try("plot", name, ["render", "plot.yaml"], {"plot.yaml": text}, says="plot.yaml")


# Every file that is read: the words that read it, what stands in it, and whether it is a text. One that is missing
# here is one that nobody tried.
FIT = """title: Fit
scene: scene.yaml
search: {material.eta1: {log: [0.5, 2]}}
fit: {measured: measured.csv, designs: 3}
"""
READ = {
    "scene.yaml": (RUN, SCENE, True),
    "block.geo": (["info", "block.geo"], ROOT / "meshes/block.geo", True),
    "block.msh": (["info", "block.msh"], square(), False),
    "study.yaml": (["sweep", "study.yaml", "-o", "sweep"], STUDY, True),
    "fit.yaml": (["fit", "fit.yaml", "-o", "fit"], FIT, True),
    "measured.csv": (["fit", "fit.yaml", "-o", "fit"], "load.pressure,mu_M,mu_M_error\n0.003,0.3,0.01\n", True),
    "plot.yaml": (["render", "plot.yaml"], PLOT, True),
    "profile.csv": ([*RUN, "--set", "contact.profile=profile.csv"], "x,gap\n0,0\n1,0\n", True),
    "law.csv": ([*RUN, "--set", "friction={law: table, table: law.csv}"], "v,mu\n0,0.3\n1,0.1\n", True),
    "law.so": ([*RUN, "--set", "friction={law: plugin, plugin: law.so}", "--trust"], "no library", False),
    "compared.csv": (["render", "out", "--figure", "force", "--compare", "compared.csv"], "U,F_T/F_N\n0,0\n1e-4,0.1\n", True),
    "out/run.json": (["info", "out"], "run.json", True),
    "out/history.h5": (["render", "out", "--figure", "force"], "history.h5", False),
    "out/history.h5.part": (["render", "out"], None, False),
    "out/checkpoint.bin": (["run", "scene.yaml", "-o", "out", "--extend", "U=0.0009"], "checkpoint.bin", False),
    "out/fields.pvd": (["film", "out", "-o", "film.mp4", "--of", "velocity"], None, True),
}
IN_ITS_PLACE = {"a pipe": "mkfifo", "a folder": "mkdir", "a link to a device": "ln -s /dev/zero",
                "a link to itself": "ln -s itself"}
RESULT = ("run.json", "history.h5", "checkpoint.bin")


def readers(stock):
    """Something else in the place of each file that is read, and a zero byte in each text."""
    whole = {f"out/{name}": stock.result / name for name in RESULT if (stock.result / name).exists()}
    for name, (words, content, is_text) in READ.items():
        files = {"fit.yaml": FIT, "measured.csv": READ["measured.csv"][1]} if "fit" in words else {}
        files |= whole if "out" in words and "run" not in words[:1] else {}
        files |= whole if "checkpoint" in name else {}
        if name.endswith(".part"):
            files.pop("out/history.h5", None)
        if content is not None and not name.startswith("out/"):
            files[name] = content
        for what, make in IN_ITS_PLACE.items():
            if "itself" in make:
                make = f"ln -s {Path(name).name}"
            optional = name in ("out/run.json", "out/history.h5.part", "out/fields.pvd") and "itself" in what
            may = (DONE, REFUSED, FAILED) if optional else (REFUSED, FAILED)
            yield Try("readers", f"{name} is {what}", words, files, may=may,
                      says="" if ".part" in name else Path(name).name,
                      shell=f'mkdir -p out; rm -rf {name}; {make} {name}; exec "$@"')
        if is_text and content is not None:
            text = (stock.result / content).read_text() if name.startswith("out/") else \
                content.read_text() if isinstance(content, Path) else content
            for at in (0, len(text) // 2, len(text)):
                bad = text[:at].encode() + b"\0" + text[at:].encode()
                yield Try("readers", f"{name} with a zero byte at {at}", words, files | {name: bad},
                          may=(REFUSED, FAILED), says=name)


def others(file, pipe):
    """[(name, change of an open HDF5 file)]: arrays in other files, links by name, numbers that cannot be."""
    import h5py
    import numpy

    def replace(make):
        def change(file):
            rows = file["series/mu"].shape[0]
            del file["series/mu"]
            make(file, rows)
        return change

    def virtual(file, rows):
        layout = h5py.VirtualLayout(shape=(rows,), dtype="f8")
        layout[:] = h5py.VirtualSource(pipe, "x", shape=(rows,))
        file.create_virtual_dataset("series/mu", layout)

    yield "array in another file", replace(
        lambda f, n: f.create_dataset("series/mu", (n,), "f8", external=[(pipe, 0, 8 * n)]))
    yield "virtual array", replace(virtual)
    yield "link out", replace(lambda f, n: f.__setitem__("series/mu", h5py.ExternalLink(pipe, "/x")))
    yield "link by name", replace(lambda f, n: f.__setitem__("series/mu", h5py.SoftLink("/series/time")))
    yield "group that is a link out", lambda f: (f.move("pads", "was"),
                                                 f.__setitem__("pads", h5py.ExternalLink(pipe, "/x")))
    names = []
    file.visititems(lambda name, item: names.append(name) if hasattr(item, "shape") else None)
    for name in names:
        for value in (-1, 2, 2000000000, 1e300, -1e300, numpy.inf, numpy.nan):
            kind = file[name].dtype
            if kind.kind in "iu" and not (numpy.isfinite(value) and
                                          numpy.iinfo(kind).min <= value <= numpy.iinfo(kind).max):
                continue
            yield f"{name} has {value}", lambda f, name=name, value=value: (
                f[name].size and f[name].__setitem__((0,) * f[name].ndim, value))
    for name in file.attrs:
        if not isinstance(file.attrs[name], str):
            for value in (-1, 0, 1e300, numpy.inf, numpy.nan):
                yield f"attribute {name} is {value}", lambda f, name=name, value=value: (
                    f.attrs.__setitem__(name, float(value)))


def histories(stock):
    """A stranger's history: nothing outside of it is read, written or waited for, and no number makes a loop."""
    import h5py
    pipe = str(stock.scratch / "pipe")
    if not os.path.exists(pipe):
        os.mkfifo(pipe)
    with h5py.File(stock.result / "history.h5") as whole:
        changes = list(others(whole, pipe))
    for number, (name, change) in enumerate(changes):
        made = stock.scratch / f"history{number}.h5"
        shutil.copy(stock.result / "history.h5", made)
        with h5py.File(made, "r+") as file:
            change(file)
        files = {"out/history.h5": made} | {f"out/{beside}": stock.result / beside
                                            for beside in ("run.json", "checkpoint.bin")}
        leads = number < 5
        asked = {"report": ["report", "out", "-o", "page.html"], "render": ["render", "out"]}
        if leads:
            asked["extend"] = ["run", "scene.yaml", "-o", "out", "--extend", "U=0.0009"]
        for what, words in asked.items():
            # A page is written without what cannot be read, and says so.
            may = (REFUSED, FAILED) if leads and what != "report" else (DONE, REFUSED, FAILED)
            yield Try("histories", f"{what}, {name}", words, files, may=may)


# Around the program; "$@" is it. The answer, where there is one, is that of an undisturbed run.
AROUND = {
    **{f"streams closed: {streams}": f'"$@" {streams}' for streams in
       ("<&-", ">&-", "2>&-", "<&- >&-", "<&- 2>&-", ">&- 2>&-", "<&- >&- 2>&-")},
    **{f"{name} of {value}": f"ulimit {option} {value}; exec \"$@\"" for name, option, values in
       (("address space, kB", "-v", (50000, 100000, 150000, 200000, 250000, 300000, 400000)),
        ("file size, kB", "-f", (0, 1, 4, 16, 64)), ("open files", "-n", (3, 4, 5, 6, 8, 12, 20)),
        ("stack, kB", "-s", (64, 256, 1024))) for value in values},
    "no environment": 'exec env -i AMONTONS_CACHE= "$@"',
    "folder removed below it": 'mkdir d; cp * d 2>/dev/null; cd d; rm -r ../d; exec "$@"',
    "standard output full": 'exec "$@" >/dev/full', "standard error full": 'exec "$@" 2>/dev/full',
    "standard output read by nobody": '"$@" | true', "standard error read by nobody": '"$@" 2>&1 | true',
    "umask 777": 'umask 777; exec "$@"', "niced, batch": 'exec nice -n 19 "$@"',
    "result folder is a file": 'echo mine >out; exec "$@"',
    "result folder is a link to nowhere": 'ln -s nowhere/at/all out; exec "$@"',
    "result folder is a link to itself": 'ln -s out out; exec "$@"',
    "result folder is full of folders": 'mkdir -p out/run.json out/history.h5; exec "$@"',
    "part files are folders": 'mkdir -p out/run.json.part out/history.h5.part; exec "$@"',
    "part files are links": 'mkdir out; ln -s ../own.txt out/history.h5.part; ln -s ../own.txt '
                            'out/run.json.part; exec "$@"',
    "scene is a pipe": 'mv scene.yaml s; mkfifo scene.yaml; cat s >scene.yaml & exec "$@"',
    "scene is a device": 'rm scene.yaml; ln -s /dev/zero scene.yaml; exec "$@"',
    "scene is a folder": 'rm scene.yaml; mkdir scene.yaml; exec "$@"',
    "mesh is a device": 'rm block.geo; ln -s /dev/zero block.geo; exec "$@"',
    "mesh is a pipe": 'rm block.geo; mkfifo block.geo; exec "$@"',
}
VARIABLES = [("AMONTONS_CACHE", "scene.yaml"), ("AMONTONS_CACHE", "/proc/none"), ("AMONTONS_CACHE", "x" * 5000),
             ("AMONTONS_MODULES", "/proc/none"), ("AMONTONS_CACHE_LIMIT", "x"), ("AMONTONS_CACHE_LIMIT", "-1"),
             ("AMONTONS_APART", ""), ("HOME", ""), ("TMPDIR", "/proc/none"), ("TZ", "Mars/Olympus"),
             ("LC_ALL", "xx_XX"), ("LANG", "tr_TR.UTF-8"), ("COLUMNS", "-7"), ("COLUMNS", "1" * 40),
             ("OPENBLAS_NUM_THREADS", "999"), ("OPENBLAS_CORETYPE", "none"), ("OMP_NUM_THREADS", "-1"),
             ("TERM", "x" * 900), ("NO_COLOR", "")]
OUTPUTS = ["", "scene.yaml", "/dev/null", "/dev/full", "/proc/x", "n" * 300, "a/" * 2500, "a/b/c/d", ".", "..",
           "-", "a\nb", "a b", "\u00fc", "/"]


def surroundings(stock):
    for name, line in AROUND.items():
        yield Try("around", name, RUN, {"own.txt": "mine"}, shell=line, answer=True, keeps=("own.txt",))
    for name, value in VARIABLES:
        yield Try("around", f"{name}={value[:20]}", RUN, env={name: value}, answer=True)
    for value in OUTPUTS:
        yield Try("around", f"-o {value[:20]!r}", ["run", "scene.yaml", "--quiet", "-o", value], {"own.txt": "mine"},
                  keeps=("own.txt", "scene.yaml", "block.geo"))


LIST = "amontons.files"   # of a folder of ours: src/io/files/own_list.h
EMPTY_LIST = "# Files that amontons wrote here; --overwrite removes these alone.\n"
FIELDS = ["--set", "output.figures=[force]", "output.fields={every_step: true}"]
# Every file that a command writes into a folder of results, and the command.
WRITTEN = {name: [*RUN, *FIELDS] for name in ("run.json", "history.h5", "checkpoint.bin", "fields.pvd", "fields/bulk_000000.vtu",
                                              "fields/interface_000000.vtp", "figures/force.png")}
WRITTEN |= {name: ["static", "scene.yaml", "-o", "out", "-q"] for name in ("static.json", "static.h5", "static.vtu")}
WRITTEN |= {name: ["model1d", "scene.yaml", "-o", "out", "-q"] for name in ("model1d.json", "model1d.h5")}
WRITTEN |= {name: ["stability", "scene.yaml", "-o", "out", "-q"] for name in ("stability.json", "stability.h5")}
WRITTEN |= {name: ["sweep", "study.yaml", "-o", "out", "-q"] for name in ("sweep.csv", "sweep.h5")}
# And every file with a name that is given, or follows from one.
NAMED = {"mine.mp4": ["film", "out", "-o", "mine.mp4", "--seconds", "0.1", "-q"], "out.gif": ["film", "out", "-o", "out.gif", "--seconds", "0.1", "-q"],
         "mine.html": ["report", "out", "-o", "mine.html"], "out/report.html": ["report", "out"], "comparison.html": ["report", "out", "out"],
         "mesh.png": ["info", "block.msh", "--picture", "mesh.png"], "plot.png": ["render", "plot.yaml"],
         "out/figures/force.png": ["render", "out", "--figure", "force"], "out/figures/force.csv": ["render", "out", "--figure", "force"]}


def own_files(stock):
    """What stands in the result folder and is not in its list stays, whatever becomes of the run."""
    own = {"out/figures/mine.png": "mine", "out/fields/mine.vtu": "mine", "out/mine.txt": "mine",
           "out/history.h5.bak": "mine"}
    for name, words in {"a good scene": RUN, "with --overwrite": RUN + ["--overwrite"],
                        "a bad scene": RUN + ["--set", "load.pressure=-1"],
                        "a bad scene, --overwrite": RUN + ["--overwrite", "--set", "load.pressure=-1"],
                        "figures anew": RUN + ["--overwrite", "--set", "output.figures=[force]"],
                        "a bad mesh": RUN + ["--overwrite", "--set", "mesh.file=none.geo"],
                        "fields anew": RUN + ["--overwrite", "--set", "output.fields={every_step: true}"]}.items():
        yield Try("own files", name, words, own | {f"out/{LIST}": EMPTY_LIST}, keeps=tuple(own))
        yield Try("own files", f"{name}, no list", words, own, may=(REFUSED,), keeps=tuple(own))
        linked = {"else/mine.png": "mine"}
        yield Try("own files", f"{name}, figures linked", words, linked, keeps=tuple(linked),
                  shell='mkdir -p out; ln -s ../else out/figures; exec "$@"')
    for name, words in WRITTEN.items():
        for place in (name, f"{name}.part"):
            if place == "checkpoint.bin.part" or (place.endswith(".part") and "/" in place):   # told when it is written
                continue
            mine = {f"out/{place}": "a series of mine, amontons run \"status\": \"done\""} | ({"study.yaml": STUDY} if "sweep" in words else {})
            again = words + (["--overwrite"] if "sweep" not in words else [])
            for how, beside in (("", {}), (" in a folder of ours", {f"out/{LIST}": EMPTY_LIST})):
                yield Try("own files", f"{words[0]} over {place}{how}", again, mine | beside, may=(REFUSED,), says=name.split("/")[0],
                          keeps=(f"out/{place}",))
    strange = {"mine.txt": "mine", "out/.mine": "mine", "behind/mine.txt": "mine"}
    paths = "../mine.txt\n.mine\ninner/mine.txt\ninner/../../mine.txt\n/etc/hostname\nfigures/../../mine.txt\n"
    yield Try("own files", "a list that leads out of its folder", RUN + ["--overwrite"], strange | {f"out/{LIST}": EMPTY_LIST + paths},
              keeps=tuple(strange), shell='ln -s ../behind out/inner; exec "$@"')
    yield Try("own files", "a list that is a link", RUN + ["--overwrite"], {"mine.txt": "mine"}, may=(REFUSED, FAILED), keeps=("mine.txt",),
              shell=f'mkdir out; ln -s ../mine.txt out/{LIST}; exec "$@"')


def named_files(stock):
    """A file that is named, or named by default outside of what the list has, gives way to --overwrite alone."""
    result = {f"out/{path.relative_to(stock.result)}": path for path in stock.result.rglob("*") if path.is_file()} | {"plot.yaml": PLOT}
    for name, words in NAMED.items():
        files = result | {name: "mine"}
        yield Try("own files", f"{words[0]} over {name}", words, files, may=(REFUSED,), says=name.split("/")[-1], keeps=(name,))
        part = result | {f"{name}.part": "mine"}
        yield Try("own files", f"{words[0]} over {name}.part", words, part, may=(REFUSED,), says=f"{name.split('/')[-1]}.part",
                  keeps=(f"{name}.part",))


def signals(stock):
    """Stopped at any moment: nothing half-written under a final name, and the next run is right."""
    for number, name in ((9, "KILL"), (15, "TERM"), (2, "INT"), (1, "HUP"), (13, "PIPE")):
        for k in range(8):
            yield Try("signal", f"{name} after {5 + 12 * k} ms", RUN, seconds=0.005 + 0.012 * k, signal=number)


WORDS = ["", "runn", "run", "run x", "run --set", "run scene.yaml --set a", "run scene.yaml --set =1",
         "run scene.yaml -o", "run scene.yaml scene.yaml", "run --help x", "help nothing", "--version x", "-x",
         "run scene.yaml --to 0%", "run scene.yaml --to x", "run scene.yaml --within -1", "run scene.yaml --to 1e-300%",
         "run scene.yaml --nothing", "info", "info nothing", "info scene.yaml --picture /proc/none/a.png",
         "info block.geo --set nx", "info .", "info /", "info /dev/null", "render", "render scene.yaml", "render .",
         "render out --figure x", "sweep", "sweep scene.yaml -o out", "sweep scene.yaml -j 0", "sweep scene.yaml -j x",
         "sweep scene.yaml -j 99999999999", "static", "static nothing.yaml -o out", "stability scene.yaml --from x",
         "model1d", "model1d nothing.yaml", "cache --clean x", "cache --clean --nothing", "run scene.yaml -o out --quiet=3",
         "run -- --help", "run scene.yaml -o out -o out2 --set time.until.U=x"]


def command_lines(stock):
    for line in WORDS:
        yield Try("words", line, line.split(" ") if line else [])
    yield Try("words", "a megabyte of settings", ["run", "scene.yaml"] + ["--set", "title=" + "x" * 900] * 1000)
    yield Try("words", "bytes that are no UTF-8", ["run", b"\xff\xfe.yaml", "--set", b"title=\xff"])


GROUPS = [geometries, keys, scenes, meshes, results, caches, studies, plots, surroundings, own_files, named_files, signals,
          command_lines, readers, histories]


def put(folder, files):
    for name, what in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(what, Path):
            shutil.copy(what, path)
        else:
            path.write_bytes(what if isinstance(what, bytes) else what.encode())
