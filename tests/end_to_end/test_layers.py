# SPDX-License-Identifier: GPL-2.0-or-later
"""The folders of src are layers: a file includes its own folder and those above it in the list; contact/ and
reduction/ are neighbours that do not know each other. The rooms of a large folder are layers, too. No two files, and no two folders, include or call each other, neither directly nor through others;
nor do scripts of validation/ import each other so.

Also: nothing below scene/ knows a scene or the public header, no study knows another, but that a search is sweeps, render/ sees base/ and the result
format only, cli/ sees the public headers only, and modules export amontons_ symbols only.
"""
import ast
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
MODULES = Path(os.environ.get("AMONTONS_MODULES", SOURCE / "build/bin"))

LAYERS = ["base", "io", "algebra", "fem", "friction", "contact", "reduction", "stepping", "record", "answers", "scene", "model", "run", "study", "page", "cli"]
BELOW_SCENE = LAYERS[:LAYERS.index("scene")]
PUBLIC = ("amontons.h", "amontons_cache.h", "amontons_model1d.h", "amontons_optimise.h", "amontons_pictures.h", "amontons_simulation.h",
          "amontons_stability.h")
LEAVES = ("render/quantities.h", "render/picture_options.h")   # of render: names of what it shows; they include nothing of it
CAIRO = r"render/canvas/(canvas|drawing|text)\.[ch]"
NEIGHBOURS = [{"contact", "reduction"}, {"friction", "reduction"}]
STUDIES = ["study/stability", "study/line", "study/sweep", "study/search"]
# A room includes itself and the rows above it; rooms of a row do not know each other. What is in none includes all.
ROOMS = {
    "friction": ["laws"],
    "io": ["files", "text hdf5 video cache", "mesh", "fields"],
    "run": ["result", "info static"],
    "study/sweep": ["reading", "computing", "showing"],
    "render": ["canvas view", "plot figures", "film frames mesh"],
}
OWN_INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)


def split(folder):
    """("io", "mesh") of "io/mesh", ("fem", "") of "fem": where it stands, and which room of it."""
    home = next((home for home in ROOMS if folder.startswith(home + "/")), None)
    return (home, folder[len(home) + 1:]) if home else (folder, "")


def rooms_allow(folder, target):
    """Whether a file in `folder` may include one in `target`, as far as their rooms say."""
    (home, room), (target_home, target_room) = split(folder), split(target)
    if home != target_home or not room:
        return True
    row = {name: k for k, names in enumerate(ROOMS[home]) for name in names.split()}
    return target_room == room or row.get(target_room, len(row)) < row[room]


def allowed(folder, include):
    """Whether a file in `folder` ("fem", "render/plot", "" for amontons.h) may include `include`."""
    layer = folder.split("/")[0]
    if include in ("amontons_error.h", "amontons_words.h"):
        return folder in ("base", "")   # what base/error.h and base/text.h show to everybody
    if include == "amontons_friction.h":
        return folder in ("friction/laws", "")   # what a plug-in and friction/laws/plugin share
    generated = {"build_record.h": "run", "computing_sources.h": "base", "page_resources.h": "page", "cli_help.h": "cli"}
    if include in generated:
        return layer == generated[include]
    if layer in BELOW_SCENE and include in PUBLIC or layer in (*BELOW_SCENE, "scene", "model") and include.startswith("render/"):
        return False
    if folder == "":
        return include.startswith(("base/", "amontons"))   # the public header and its parts
    if include in ("render/render.h", *LEAVES):
        return True
    if not rooms_allow(folder, include.rpartition("/")[0]):
        return False
    if layer == "render":
        return include.startswith(("base/", "render/")) or include in (
            "amontons_pictures.h",   # what render/render.h is asked
            "io/files/folder.h", "io/files/own_list.h", "io/files/part_file.h", "io/text/html_writer.h", "io/text/yaml_document.h",
            "io/text/csv_reader.h", "io/text/csv_writer.h",   # measurements; what a figure shows
            "io/hdf5/array_file.h", "io/hdf5/result_file.h", "io/hdf5/result_tables.h", "io/video/video_file.h", "io/mesh/mesh_file.h", "io/fields/field_read.h",
            "io/mesh/shape_functions.h", "io/mesh/element_faces.h")   # fields inside an element and on its faces
    if folder == "cli":
        return include in PUBLIC or include.startswith("cli/")
    if include in PUBLIC:
        return True
    target, *inner = include.split("/")[:-1]
    if target == layer == "study" and inner[:1] != folder.split("/")[1:2]:
        return folder == "study/search" and inner[0] == "sweep"   # a search is sweeps; else one kind of study knows no other
    if {target, layer} in NEIGHBOURS:
        return False
    return target in LAYERS and LAYERS.index(target) <= LAYERS.index(layer)


def violations(root):
    """Every include in src/ and render/ that the layers do not allow, as "file includes what"."""
    found = []
    files = [*root.glob("src/**/*"), *root.glob("render/**/*")]
    for path in sorted(f for f in files if f.suffix in (".c", ".h", ".cc")):
        place = path.relative_to(root).parts
        folder = "/".join(place[place[0] == "src":-1])
        home, room = split(folder)
        if home not in [*LAYERS, *STUDIES, "render", ""] or folder in ("study", "io") or \
                room and room not in " ".join(ROOMS[home]).split():
            found.append(f"{'/'.join(place)}: {folder} is not a layer")
            continue
        for include in OWN_INCLUDE.findall(path.read_text()):
            if not allowed(folder, include):
                found.append(f"{'/'.join(place)} includes {include}")
    return found


def sources(root):
    """Every C and C++ file of src/ and render/, with its unit: a .c and its .h are one, "src/base/error"."""
    return {path: str(path.relative_to(root).with_suffix("")) for top in ("src", "render")
            for path in sorted((root / top).rglob("*")) if path.suffix in (".c", ".h", ".cc")}


def include_graph(root):
    """For each unit, the other units whose headers it includes."""
    units = sources(root)
    graph = {unit: set() for unit in units.values()}
    for path, unit in units.items():
        for include in OWN_INCLUDE.findall(path.read_text()):
            targets = {units.get(root / "src" / include), units.get(root / include)}
            graph[unit] |= targets - {None, unit}
    return graph


def folder_graph(root):
    """The same of folders; a file beside the rooms of its folder stands for itself."""
    def place(unit):
        folder = unit.rpartition("/")[0]
        return unit if folder.removeprefix("src/") in ROOMS else folder
    graph = {}
    for unit, includes in include_graph(root).items():
        graph.setdefault(place(unit), set()).update(place(target) for target in includes)
        for target in includes:
            graph.setdefault(place(target), set())
    return {folder: targets - {folder} for folder, targets in graph.items()}


def import_graph(root):
    """For each Python file of validation/, those of it that it imports: of its own folder, else of that name in another."""
    files = [path for path in (root / "validation").rglob("*") if path.suffix == ".py"]
    graph = {}
    for path in files:
        nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
        names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        names |= {node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module}
        graph[str(path.relative_to(root))] = {
            str(file.relative_to(root)) for name in names for file in files if file != path and file.stem == name
            and (file.parent == path.parent or not path.with_name(f"{name}.py").exists())}
    return graph


def call_graph(root, build):
    """For each unit, the other units that define what its object files in `build` leave undefined.

    The path of an object tells its source: src/CMakeFiles/TARGET.dir/base/error.c.o. What the sanitizers or gcov
    add is defined in none of them, or not with external linkage.
    """
    units = sources(root)
    objects = {}
    for path in build.rglob("*.o"):
        source = root / re.sub(r"CMakeFiles/[^/]+\.dir/", "", str(path.relative_to(build)))[:-len(".o")]
        if source in units:
            objects[str(path)] = units[source]
    listing = subprocess.run(["nm", "--print-file-name", *objects], capture_output=True, text=True, check=True).stdout
    symbols = [(objects[line.split(":", 1)[0]], *line.split()[-2:]) for line in listing.splitlines()]
    defined = {name: unit for unit, kind, name in symbols if kind in "TDBRCSG"}
    graph = {unit: set() for unit in units.values()}
    for unit, kind, name in symbols:
        if kind == "U" and name in defined:
            graph[unit] |= {defined[name]} - {unit}
    return graph


def circles(graph):
    """The sets of units that reach one another."""
    def reached(start):
        seen, waiting = set(), [start]
        while waiting:
            new = graph[waiting.pop()] - seen
            seen |= new
            waiting += new
        return seen
    reach = {unit: reached(unit) for unit in graph}
    found = {frozenset(u for u in reach[unit] if unit in reach[u]) for unit in graph if unit in reach[unit]}
    return sorted(found, key=sorted)


# Of the linker, and of gcov's runtime, which the coverage preset puts into every module.
FOREIGN_SYMBOLS = re.compile(r"__bss_start|_edata|_end|_init|_fini|__gcov_\w+|mangle_path")


def exported(module):
    """The symbols that a shared object defines for others, but for the linker's and gcov's own."""
    listing = subprocess.run(["nm", "-D", "--defined-only", module], capture_output=True, text=True,
                             check=True).stdout
    symbols = {line.split()[-1].split("@")[0] for line in listing.splitlines()}
    return {symbol for symbol in symbols if not FOREIGN_SYMBOLS.fullmatch(symbol)}


class Layers(unittest.TestCase):
    def test_sources(self):
        self.assertEqual(violations(SOURCE), [])

    def test_sees_faults(self):
        """Each rule catches the file that breaks it, and nothing else."""
        faults = {
            "src/base/a.c": "io/hdf5/array_file.h",
            "src/fem/a.c": "contact/rod.h",
            "src/fem/b.c": "amontons_error.h",
            "src/fem/c.c": "reduction/reduction.h",
            "src/contact/b.c": "reduction/machine.h",
            "src/reduction/b.c": "friction/friction.h",
            "src/run/info/a.c": "run/simulation_state.h",
            "src/run/static/a.c": "run/info/info_curves.h",
            "render/view/a.c": "render/canvas/page.h",
            "src/reduction/a.h": "contact/rod.h",
            "src/stepping/a.h": "scene/scene.h",
            "src/contact/a.c": "amontons.h",
            "src/friction/a.c": "contact/interface.h",
            "src/run/a.c": "cli/options.h",
            "src/cli/a.c": "scene/scene.h",
            "src/study/line/a.c": "study/sweep/sweep.h",
            "src/record/a.c": "scene/scene.h",
            "src/record/b.c": "answers/answers.h",
            "src/answers/a.c": "scene/scene.h",
            "src/io/fields/a.cc": "render/render.h",
            "src/scene/a.c": "render/quantities.h",
            "src/run/c.c": "render/view/block.h",
            "src/io/files/a.c": "io/text/json_writer.h",
            "src/io/text/a.c": "io/hdf5/array_file.h",
            "src/io/mesh/a.c": "io/fields/field_file.h",
            "src/study/sweep/reading/a.c": "study/sweep/computing/point.h",
            "src/study/sweep/showing/a.c": "study/sweep/sweep.h",
            "src/run/b.c": "utils/list.h",
            "src/amontons.h": "scene/scene.h",
            "render/a.c": "record/history.h",
            "render/film/b.c": "io/fields/field_file.h",
            "render/plot/a.c": "render/figures/map_page.h",
        }
        good = {
            "src/io/mesh/good.c": ["io/mesh/mesh_file.h", "io/cache/cache_folder.h", "io/files/folder.h", "base/error.h"],
            "src/study/sweep/good.c": ["study/sweep/showing/table.h", "study/sweep/sweep.h"],
            "src/study/sweep/computing/good.c": ["study/sweep/reading/study.h", "run/simulation_state.h"],
            "src/fem/good.c": ["fem/mesh.h", "io/mesh/mesh_file.h", "base/error.h"],
            "src/contact/good.c": ["contact/rod.h", "fem/mesh.h"],
            "src/reduction/good.c": ["reduction/machine.h", "fem/mesh.h"],
            "src/stepping/good.c": ["contact/rod.h", "reduction/machine.h"],
            "src/answers/good.c": ["record/drops.h", "answers/regime.h"],
            "src/study/line/good.c": ["study/line/model1d.h", "run/simulation_state.h"],
            "src/run/good.c": ["amontons.h", "scene/scene.h", "stepping/state.h", "render/render.h"],
            "src/cli/good.c": ["amontons.h", "cli/options.h"],
            "src/scene/good.c": ["amontons_pictures.h", "record/history.h"],
            "src/run/result/good.c": ["render/quantities.h", "render/picture_options.h"],
            "render/film/good.c": ["render/render.h", "render/canvas/page.h", "render/view/zoom.h"],
            "render/good.c": ["render/render.h", "io/hdf5/result_file.h", "base/memory.h"],
        }
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name, includes in [*((f, [i]) for f, i in faults.items()), *good.items()]:
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text("".join(f'#include "{i}"\n' for i in includes))
            for name in ("src/utils/list.c", "src/io/list.c", "src/fem/list/list.c", "src/io/misc/list.c"):
                (root / name).parent.mkdir(exist_ok=True)
                (root / name).write_text("")
            expected = [f"{name} includes {include}" for name, include in faults.items()]
            expected += [f"src/{name}/list.c: {name} is not a layer" for name in ("utils", "io", "fem/list", "io/misc")]
            self.assertEqual(sorted(violations(root)), sorted(expected))

    def test_no_library_below_its_layer(self):
        """Each library is behind one of our files: nothing else includes its header."""
        owners = {
            "gmshc.h": r"src/io/mesh/mesh_\w+_module\.c",
            "cholmod.h": r"src/algebra/sparse\w*\.[ch]",
            "hdf5.h": r"src/io/hdf5/(array_(file_module|series)|hdf5_library)\.[ch]",
            "libfyaml.h": r"src/io/text/yaml_\w+\.[ch]",
            "cairo[\\w-]*.h": CAIRO,
            "(?:osmesa|egl|gl|glext).h": r"nothing: render/canvas/gl_names.h has their names",
            "png.h": r"render/canvas/png_encode\.c",
            "vtk\\w*.h": r"src/io/fields/field_file_module\.cc",
        }
        for path in sorted(f for top in ("src", "render") for f in (SOURCE / top).rglob("*.[ch]*")):
            name = str(path.relative_to(SOURCE))
            for header, owner in owners.items():
                if re.search(rf"#\s*include\s+<(?:\w+/)?{header}>", path.read_text()):
                    self.assertRegex(name, owner, f"{name} includes {header}")


    def test_commands_say_all_in_one_place(self):
        """What is printed goes through cli/say.c, which shows what a terminal would obey; main.c has only words of its own
        and the loader's, before anything else is loaded."""
        prints = re.compile(r"\b(?:f|v|vf|d)?printf\(|\bf?put[sc]\w*\(|\bfwrite\(|\bperror\(")
        self.assertTrue(prints.search((SOURCE / "src/cli/say.c").read_text()))
        for path in (SOURCE / "src/cli").glob("*.c"):
            if path.name not in ("say.c", "main.c"):
                self.assertEqual(prints.findall(path.read_text()), [], path.name)


class Circles(unittest.TestCase):
    def test_includes(self):
        self.assertEqual(circles(include_graph(SOURCE)), [])

    def test_folders(self):
        self.assertEqual(circles(folder_graph(SOURCE)), [])

    def test_imports(self):
        self.assertEqual(circles(import_graph(SOURCE)), [])

    def test_calls(self):
        graph = call_graph(SOURCE, MODULES.parent)
        called = {unit for calls in graph.values() for unit in calls}
        self.assertIn("src/base/error", called)
        without = [p.name for p, unit in sources(SOURCE).items() if p.suffix != ".h" and not graph[unit] | {unit} & called
                   and p.name != "main.c"]   # which opens the commands by name
        self.assertEqual(without, [], "files that call nothing and that nothing calls")
        self.assertEqual(circles(graph), [])

    def test_sees_planted_circles(self):
        """A header that includes back, three files that call one another in turn, three folders, two scripts."""
        files = {
            "render/render.h": '#include "render/figures/map.h"\n',
            "render/figures/map.h": '#include "render/view/view.h"\n',
            "render/view/view.h": "",
            "render/view/block.h": '#include "render/render.h"\n#include "render/leaf.h"\n',
            "render/leaf.h": "",
            "validation/one/a.py": "import b\n",
            "validation/one/b.py": "def late():\n    from a import all_of_it\n",
            "validation/two/a.py": "import c\n",
            "validation/two/c.py": "import b\n",
            "src/base/a.h": '#include "base/b.h"\n',
            "src/base/a.c": '#include "base/a.h"\n',
            "src/base/b.h": "int b(void);\n",
            "src/base/b.c": '#include "base/a.h"\n#include "base/b.h"\n',
            "src/base/alone.c": '#include "base/a.h"\n',
            "src/io/one.c": "int two(void); int one(void) { return two(); }\n",
            "src/io/two.c": "int three(void); int two(void) { return three(); }\n",
            "render/three.c": "int one(void); int three(void) { return one(); }\n",
            "src/io/user.c": "int one(void); static int three(void) { return 3; }\n"
                             "int user(void) { return one() + three(); }\n",
        }
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            for name in (n for n in files if n.endswith(".c")):
                made = root / "build" / name.replace("/", "/CMakeFiles/some.dir/", 1)
                made.parent.mkdir(parents=True, exist_ok=True)
                subprocess.run(["cc", "-I", root / "src", "-c", root / name, "-o", f"{made}.o"], check=True)
            self.assertEqual(circles(include_graph(root)), [{"src/base/a", "src/base/b"}])
            self.assertEqual(circles(folder_graph(root)), [{"render/render", "render/figures", "render/view"}])
            self.assertEqual(circles(import_graph(root)), [{"validation/one/a.py", "validation/one/b.py"}])
            self.assertEqual(circles(call_graph(root, root / "build")), [{"render/three", "src/io/one", "src/io/two"}])


class Modules(unittest.TestCase):
    def test_exports(self):
        modules = sorted(MODULES.glob("amontons_*.so"))
        self.assertEqual([m.stem for m in modules],
                         ["amontons_commands", "amontons_dlib", "amontons_gmsh", "amontons_hdf5", "amontons_libav", "amontons_render", "amontons_vtk"])
        for module in modules:
            foreign = [s for s in exported(module) if not s.startswith("amontons_")]
            self.assertEqual(foreign, [], module.name)

    def test_program_loads_no_heavy_library(self):
        """gmsh, HDF5, VTK and Cairo come with their modules, on first use; OpenGL with the first image, libav with the first film."""
        program = MODULES / "amontons_commands.so"   # the program itself links nothing (cli/main.c)
        needed = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
        self.assertIn("libamontons.so", needed)
        for library in ("libgmsh", "libhdf5", "libcurl", "libvtk", "libcairo", "libav"):
            self.assertNotIn(library, needed)
        drawn = subprocess.run(["ldd", MODULES / "amontons_render.so"], capture_output=True, text=True, check=True).stdout
        for library in ("libOSMesa", "libEGL", "libGL.so", "libav", "libswscale"):
            self.assertNotIn(library, drawn)
        if "libubsan" not in needed:   # which is in C++ itself
            self.assertNotIn("libstdc++", needed)


if __name__ == "__main__":
    unittest.main()
