# SPDX-License-Identifier: GPL-2.0-or-later
"""What docs/, the README and the pages of src/ and validation/ say is so: files that they name exist, links and
anchors lead somewhere, formulas are closed, tables of keys, of run.json and of a sweep's columns are the program's, and
the glossary's words are in use."""
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build/bin")) / "amontons"
DOCS = sorted((SOURCE / "docs").glob("*.md"))
PAGES = [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", SOURCE / "src/README.md", *DOCS, *sorted(SOURCE.glob("validation/**/*.md"))]
FOLDERS = "src|tests|validation|render|docs|meshes"


def without_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)


def anchors(page):
    """Of its headings, as GitHub makes them."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", without_code(page.read_text()), re.M):
        words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
        anchor = base = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        count = 0
        while anchor in found:
            count += 1
            anchor = f"{base}-{count}"
        found.add(anchor)
    return found


def section(page, heading):
    text = (SOURCE / page).read_text()
    return re.search(rf"^#+ {re.escape(heading)}\n(.*?)(?=^#|\Z)", text, re.S | re.M)[1]


class Text(unittest.TestCase):
    def test_named_files_exist(self):
        named = 0
        for page in [p for p in PAGES if "validation" not in p.parts]:
            for path in re.findall(rf"`((?:{FOLDERS})/[\w./*-]*)", page.read_text()):
                with self.subTest(f"{page.name}: {path}"):
                    self.assertTrue(list(SOURCE.glob(path.rstrip("/."))))
                named += 1
        self.assertGreater(named, 100)

    def test_walk_through_names_files(self):
        """`contact/rod` in src/README.md is src/contact/rod.h or .c, or a folder."""
        text, named = (SOURCE / "src/README.md").read_text(), 0
        folders = "|".join(f.name for f in (SOURCE / "src").iterdir() if f.is_dir())
        for path in re.findall(rf"`((?:{folders})/[\w/]+)`", text):
            with self.subTest(path):
                self.assertTrue(list(SOURCE.glob(f"src/{path}.[ch]")) or (SOURCE / "src" / path).is_dir())
            named += 1
        self.assertGreater(named, 40)
        functions = re.findall(rf"`(\w+)` in\s+`((?:{folders})/[\w/]+)`", text)
        for name, path in functions:
            self.assertIn(f"{name}(", (SOURCE / f"src/{path}.c").read_text())
        self.assertGreater(len(functions), 2)

    def test_callers_are_there(self):
        """What a header says calls it is a file, a folder or a function of src or render."""
        files = [path for top in ("src", "render") for path in (SOURCE / top).rglob("*.[ch]*")]
        places = {f"/{path.relative_to(SOURCE).with_suffix('')}" for path in files}
        words, named = set(re.findall(r"\w+", "\n".join(path.read_text() for path in files if path.suffix != ".h"))), 0
        for header in (path for path in files if path.suffix == ".h"):
            text = re.sub(r"\n// ?", " ", header.read_text().split("#ifndef")[0])
            for said in re.findall(r"[Cc]alled (?:\w+ )?by ([^.]*)", text):
                for name in re.findall(r"[a-z]\w*[/_][\w/]*", said):
                    with self.subTest(f"{header.relative_to(SOURCE)}: {name}"):
                        self.assertTrue(name in words or any(place.endswith(f"/{name}") or f"/{name.rstrip('/')}/" in place
                                                             for place in places))
                    named += 1
        self.assertGreater(named, 150)   # that any are found: a header that has few readers names them

    def test_walk_through_is_read_in_five_minutes(self):
        """At 250 words a minute, a path counted as one."""
        self.assertLess(len((SOURCE / "src/README.md").read_text().split()), 5 * 250)

    def test_walk_through_names_all_folders(self):
        listed = re.findall(r"^    (\w+)/ ", (SOURCE / "src/README.md").read_text(), re.M)
        self.assertEqual(set(listed), {f.name for f in (SOURCE / "src").iterdir() if f.is_dir()})

    def test_links(self):
        for page in PAGES:
            for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text())):
                if "://" in target:
                    continue
                path, _, anchor = target.partition("#")
                with self.subTest(f"{page.relative_to(SOURCE)}: {target}"):
                    goal = page.parent / path if path else page
                    self.assertTrue(goal.exists())
                    if anchor:
                        self.assertIn(anchor, anchors(goal))

    def test_the_cookbook_counts_its_studies(self):
        words = ("ten", "eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen")
        count = words[len(re.findall(r"^## \d+\. ", (SOURCE / "docs/cookbook.md").read_text(), re.M)) - 10]
        for page, says in (("docs/cookbook.md", "# Cookbook: {} studies"), ("docs/tutorial.md", "[{} studies](cookbook.md)"),
                           ("README.md", "| {} studies to copy")):
            self.assertIn(says.format(count), (SOURCE / page).read_text())

    def test_rows_stand_once(self):
        """Within a table no row has the same words as another."""
        for page in DOCS:
            rows = {}
            for number, line in enumerate(page.read_text().splitlines(), 1):
                if not line.startswith("|"):
                    rows = {}
                elif not set(line) <= set("|- "):
                    self.assertNotIn(line, rows, f"{page.name}:{number}")
                    rows[line] = number

    def test_costs_stand_once(self):
        costs = re.findall(r"^set\((cost_\w+) ", (SOURCE / "tests/CMakeLists.txt").read_text(), re.M)
        self.assertEqual(len(costs), len(set(costs)))

    def test_every_page_is_linked(self):
        linked = re.findall(r"\]\((docs/[\w.]+)\)", (SOURCE / "README.md").read_text())
        self.assertEqual(set(linked), {f"docs/{page.name}" for page in DOCS})

    def test_formulas_are_closed(self):
        for page in PAGES:
            text = re.sub(r"`[^`\n]*`", "", without_code(page.read_text()))
            with self.subTest(page.name):
                self.assertEqual(text.count("$$") % 2, 0)
                for paragraph in re.sub(r"\$\$.*?\$\$", "", text, flags=re.S).split("\n\n"):
                    self.assertEqual(paragraph.count("$") % 2, 0, paragraph)

    def test_sections_of_the_method(self):
        """Each names its files and tests, and cites only what the list of literature holds."""
        text = (SOURCE / "docs/method.md").read_text()
        body, literature = text.split("## Literature")
        parts = re.split(r"^## \d+\. ", body, flags=re.M)[1:]
        self.assertGreaterEqual(len(parts), 15)
        for part in parts:
            with self.subTest(part.split("\n")[0]):
                self.assertRegex(part, r"\n- Code: `src/")
                self.assertRegex(part, r"\n- Tests: `")
        known = {int(n) for n in re.findall(r"^(\d+)\. ", literature, re.M)}
        cited = {int(n) for n in re.findall(r"\[(\d+)\](?!\()", body)}
        self.assertEqual(cited - known, set())


class Program(unittest.TestCase):
    def test_every_command_is_listed(self):
        told = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True).stdout
        commands = re.findall(r"^  (\w+) +[A-Z]+ ", told, re.M)
        self.assertGreaterEqual(len(commands), 7)
        listed = re.findall(r"^\| `\./amontons (\w+)", (SOURCE / "docs/commands.md").read_text(), re.M)
        self.assertLessEqual(set(commands), set(listed))

    def test_key_table(self):
        told = subprocess.run([PROGRAM, "info", "keys"], capture_output=True, text=True).stdout
        page = (SOURCE / "docs/scenes.md").read_text()
        table = re.search(r"<!-- keys -->\n(.*?)\n<!-- /keys -->", page, re.S)[1]
        self.assertEqual(told.strip(), table.strip())

    def test_columns_of_a_sweep(self):
        told = subprocess.run([PROGRAM, "sweep", "--help"], capture_output=True, text=True).stdout
        names = re.search(r"paths in run.json, or ([\w,\s]+)\.", told)[1]
        rows = re.findall(r"^\| `(\w+)` \|", section("docs/sweeps.md", "What `record` may name"), re.M)
        self.assertEqual(rows, re.split(r",\s+", names.strip()))

    def test_glossary(self):
        """Names in `code` and the words of each term are ones that the program, its files or the docs use."""
        glossary = (SOURCE / "docs/glossary.md").read_text()
        used = "".join(p.read_text() for p in [*SOURCE.glob("src/**/*.[ch]"), SOURCE / "README.md",
                                               *(d for d in DOCS if d.name != "glossary.md")])
        terms = re.findall(r"\*\*([^*]+)\*\*", glossary)
        self.assertGreater(len(terms), 60)
        for term in terms:
            for word in re.findall(r"[a-z]{4,}", term.lower()):
                with self.subTest(term):
                    self.assertRegex(used, rf"(?i)\b{word}")
        names = set(re.findall(r"`([^`]+)`", glossary))
        self.assertGreater(len(names), 20)
        for name in sorted(names):
            for word in re.findall(r"\w+", name):
                with self.subTest(name):
                    self.assertIn(word, used)


class Meshes(unittest.TestCase):
    def test_parameters(self):
        """docs/meshes.md has each parameter of a .geo, with the default and the words that stand there."""
        for geometry in sorted(SOURCE.glob("meshes/*.geo")):
            rows = re.findall(r"^\| `(\w+)` \| (\S+) \| (.*) \|$", section("docs/meshes.md", geometry.name), re.M)
            body = re.search(r"DefineConstant\[\n(.*?)\n\];", geometry.read_text(), re.S)[1]
            body = re.sub(r"\n +// ", " ", body)
            said = re.findall(r"^ +(\w+) = \"?([\w.]+)\"?,? +// (.*)$", body, re.M)
            self.assertGreater(len(said), 5)
            self.assertEqual(rows, said, geometry.name)


def documented():
    """Keys of run.json in docs/results.md; `.low` after `branches[].mu` is `branches[].low`."""
    keys, prefix = set(), ""
    for line in section("docs/results.md", "run.json").split("\n"):
        found = re.match(r"\*\*.*\*\* \(`(\w+)`", line)
        if found or line.startswith("**"):
            prefix = found[1] + "." if found else ""
        cells = line.split(" | ")
        if not line.startswith("| `"):
            continue
        parent = ""
        for name in re.findall(r"`([^`]+)`", cells[0]):
            if name.startswith("."):
                name = parent + name
            parent = name.rpartition(".")[0]
            keys.add(prefix + name)
    return keys


def paths(value, name=""):
    """Every key of a parsed JSON value, `[]` for a list's entries."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from paths(inner, f"{name}.{key}" if name else key)
    elif isinstance(value, list) and value:
        for inner in value:
            yield from paths(inner, name + "[]")
    else:
        yield name


def keys_of_run(scene, *settings):
    with tempfile.TemporaryDirectory() as folder:
        sets = ["output.history=false", "output.figures=[]", "output.fields=none", *settings]
        words = [word for value in sets for word in ("--set", value)]
        done = subprocess.run([PROGRAM, "run", SOURCE / scene, "-o", f"{folder}/run", "--quiet", *words],
                              capture_output=True, text=True)
        if done.returncode:
            raise AssertionError(done.stderr)
        return set(paths(json.loads(Path(f"{folder}/run/run.json").read_text())))


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.held = keys_of_run("validation/pads/pads.yaml", "mesh.set.n=2", "mesh.set.size_contact=0.05",
                               "mesh.set.size_bulk=0.1", "time.until.U=0.03", "accuracy.mu=50%")
        cls.held |= keys_of_run("validation/paper/fig1.yaml", "mesh.set={nx: 4, nz: 2}", "time.until={t: 4}",   # with jumps
                                "material.relaxation=[{time: 1, shear: 0.1}]",
                                "rod.program={t: [0, 1, 1, 2, 2, 3, 3], factor: [1, 1, 2, 2, 0, 0, 2]}")
        cls.held |= keys_of_run("docs/examples/fronts.yaml", "mesh.set.refine=0.5")   # with precursors
        cls.held |= keys_of_run("validation/paper/fig1.yaml", f"mesh.file={SOURCE}/meshes/block3d.geo",   # in space
                                "mesh.set={nx: 3, ny: 2, nz: 2}", "time.until.U=5e-3")

    def test_every_key_is_documented(self):
        keys = documented()
        self.assertGreater(len(keys), 80)
        for path in self.held:
            begins = any(path == key or path.startswith((key + ".", key + "[]")) or path + "[]" == key
                         or key.startswith(path + "[]") for key in keys)
            self.assertTrue(begins, f"run.json has {path}")

    def test_nothing_else_is_documented(self):
        for key in documented() - {"failure", "message"}:
            stem = key.removesuffix("[]")
            self.assertTrue(any(p == stem or p.startswith((stem + ".", stem + "[]")) for p in self.held),
                            f"run.json has no {key}")


if __name__ == "__main__":
    unittest.main()
