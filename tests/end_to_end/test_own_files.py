# SPDX-License-Identifier: GPL-2.0-or-later
"""Every file that any command writes or reads: what somebody has put in its place, a file, a link or a pipe, is neither lost nor
waited for. What is ours is in the list of its folder (src/io/files/own_list.h); a command that lists less fails here."""
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
sys.path.insert(0, str(SOURCE / "validation/hostile"))
import cases  # noqa: E402
from preload_fixture import preload  # noqa: E402

PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
PATIENCE = 60 * float(os.environ.get("AMONTONS_PATIENCE", 1))
STUDY = cases.STUDY.replace("scene: scene.yaml", "scene: plain.yaml")
AGES = "law: ageing, healing: 0.01, healing_time: 1, slip_distance: 1e-3, "   # so that there are states
FILM = ["--seconds", "0.1", "--size", "640x360", "--quiet"]
INPUTS = {
    "scene.yaml": cases.SCENE.replace("law: linear-weakening, ", AGES).replace("figures: []", "figures: [force]\n  fields: {every_U: 4e-4}"),
    "plain.yaml": cases.SCENE.replace("history: true", "history: false").replace("block.geo, set: {nx: 6, nz: 4}", "block.msh"),
    "study.yaml": STUDY + "rank: {by: results.mu_max}\nplot: {x: load.pressure, y: results.mu_max}\n",
    "fit.yaml": "scene: plain.yaml\nset: {time.until: {U: 0.004}}\nsearch: {material.young: {log: [0.8, 1.2]}}\n"
                "fit: {measured: measured.csv, designs: 4}\n",
    "lengths.csv": "F_T/F_N,l/L\n0.1,0.5\n",
    "measured.csv": "load.pressure,mu_max,mu_max_error\n0.003,0.35,0.05\n",
    "table.yaml": STUDY + "keep: table\n", "plot.yaml": cases.PLOT,
    "block.geo": cases.ROOT / "meshes/block.geo", "block.msh": cases.square()}
# What each writes without being told a name; those behind a result need it.
COMMANDS = {
    "run": ["run", "scene.yaml", "-o", "out", "--quiet"],
    "static": ["static", "plain.yaml", "-o", "static", "--quiet"],
    "model1d": ["model1d", "plain.yaml", "-o", "line", "--quiet"],
    "stability": ["stability", "scene.yaml", "-o", "rates", "--quiet", "--from", "end", "--set", "time.until={U: 0.005}",
                  "output.fields=none", "output.figures=[]"],
    "sweep": ["sweep", "study.yaml", "-o", "many", "--quiet"],
    "fit": ["fit", "fit.yaml", "-o", "fitted", "--quiet"],
    "table": ["sweep", "table.yaml", "-o", "table", "--quiet"],
    "accuracy": ["run", "plain.yaml", "-o", "bar", "--to", "50%", "--quiet", "--set", "mesh={file: block.geo}",
                 "time.until={U: 0.008}", "output.history=true", "output.figures=[force]"],
    "plot": ["render", "plot.yaml"],
    "states": ["render", "out", "--figure", "state-map"],
    "data": ["render", "out", "--figure", "slip-map", "--figure", "precursors", "--figure", "front-speed", "--compare", "lengths.csv"],
    "pdf": ["render", "out", "--format", "pdf", "--figure", "force"],
    "svg": ["render", "out", "--format", "svg", "--figure", "force"],
    "report": ["report", "out"],
    "mp4": ["film", "out", *FILM],
    "webm": ["film", "out", "-o", "film.webm", *FILM],
    "gif": ["film", "out", "-o", "film.gif", "--fps", "20", *FILM],
}
LIST = "amontons.files"
READERS = [["info", "out"], ["render", "out"], ["report", "out"], ["film", "out", *FILM], [*COMMANDS["run"], "--resume"],
           [*COMMANDS["run"], "--overwrite"], ["info", "many"], COMMANDS["sweep"], ["render", "many"], ["report", "many"]]
STANDARD = b"somebody's, and long enough to be worth something\n"


def kind_of(path):
    """Files of one kind are written by the same lines: bulk_000001.vtu and bulk_000002.vtu, two figures."""
    return path.parent.name, path.suffix


def one_of_each(paths):
    return list({kind_of(path): path for path in paths}.values())


def listed(folder, path):
    """Whether the list of the file's folder, or of the one above that, has it."""
    for inner in (path.parent, path.parent.parent):
        if (folder / inner / LIST).is_file():
            return str(path.relative_to(inner)) in (folder / inner / LIST).read_text().splitlines()
    return False


def call(folder, words, stdin=subprocess.DEVNULL):
    """Status and words; a status of None: it did not end."""
    env = os.environ | {"AMONTONS_CACHE": str(folder / "cache")}
    try:
        done = subprocess.run([PROGRAM, *words], cwd=folder, env=env, stdin=stdin, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        return None, "no end"
    return done.returncode, done.stdout.decode(errors="replace")


def files_in(folder):
    return {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}


def put(path, kind, victim):
    """Something of somebody's in the place of `path`."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    if kind == "file":
        path.write_bytes(STANDARD)
    elif kind == "link":
        path.symlink_to(victim)
    else:
        os.mkfifo(path)


def stands(path, kind):
    mode = path.lstat().st_mode if os.path.lexists(path) else 0
    return {"file": stat.S_ISREG(mode) and path.read_bytes() == STANDARD if mode else False, "link": stat.S_ISLNK(mode),
            "pipe": stat.S_ISFIFO(mode)}[kind]


class OwnFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons_own_"))
        cls.stock, cls.written = cls.folder / "stock", {}
        cases.put(cls.stock, INPUTS)
        for name, words in COMMANDS.items():
            before = files_in(cls.stock)
            status, said = call(cls.stock, words)
            if status != 0:
                raise AssertionError(f"{name}: {said}")
            cls.written[name] = sorted(files_in(cls.stock) - before)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def fresh(self, command=None):
        """A copy of the stock, as it was before `command`."""
        self.count = getattr(self, "count", 0) + 1
        folder = self.folder / f"{self._testMethodName}-{self.count}"
        shutil.copytree(self.stock, folder)
        names = list(COMMANDS)
        for name in names[names.index(command):] if command else []:
            for path in self.written[name]:
                (folder / path).unlink()
        for inner in sorted(folder.rglob("*"), reverse=True):
            if inner.is_dir() and not any(inner.iterdir()):
                inner.rmdir()
        for held in folder.rglob(LIST):
            kept = [line for line in held.read_text().splitlines() if line.startswith("#") or (held.parent / line).exists()]
            held.write_text("\n".join(kept) + "\n")
        self.addCleanup(shutil.rmtree, folder)
        return folder

    def test_every_file_in_a_folder_of_ours_is_listed(self):
        for name, paths in self.written.items():
            for path in paths:
                if path.parts[0] != "cache" and len(path.parts) > 1 and not path.name.startswith("amontons."):
                    with self.subTest(command=name, file=str(path)):
                        self.assertTrue(listed(self.stock, path))

    def test_what_is_somebodys_stays(self):
        """In the place of the file and of its .part: one file of each kind that a command writes."""
        for name, paths in self.written.items():
            for path in one_of_each(paths):
                if path.name == LIST or "points" in path.parts:   # ours by name; a folder named by a hash, what is in it goes
                    continue
                for place in (path, path.with_name(path.name + ".part")):
                    for kind in ("file", "link", "pipe") if name in ("run", "table", "mp4", "report") else ("file",):
                        if path.parts[0] == "cache" and kind == "file":
                            continue
                        with self.subTest(command=name, place=str(place), kind=kind):
                            self.try_place(name, place, kind)

    def try_place(self, name, place, kind):
        folder = self.fresh(name)
        victim = folder / "victim"
        victim.write_bytes(STANDARD)
        put(folder / place, kind, victim)
        status, said = call(folder, COMMANDS[name])
        self.assertIn(status, (0, 1, 2), said)
        self.assertEqual(victim.read_bytes(), STANDARD)
        self.assertTrue(stands(folder / place, kind) or place.parts[0] == "cache", said)   # named by a hash: ours
        if status != 0:
            of_all = "and no amontons.files"   # a folder without a list, with something in it, is somebody's as a whole
            self.assertTrue(place.name.removesuffix(".part") in said or of_all in said, said)
        if status == 0:   # a cache that cannot be written costs time, nothing else; reports are added to
            self.assertTrue("cache" in place.parts or name == "cache" or place.name == "reports.part", said)

    def test_a_foreign_history_is_not_destroyed(self):
        """A text file with any word in it, in a folder without a list, with and without --overwrite."""
        for words in (COMMANDS["run"], [*COMMANDS["run"], "--overwrite"], COMMANDS["sweep"][:-2] + ["out"]):
            folder = self.fresh("run")
            shutil.rmtree(folder / "out", ignore_errors=True)
            cases.put(folder, {"out/history.h5": "a series of mine, amontons run"})
            status, said = call(folder, words)
            self.assertEqual(status, 2, said)
            self.assertIn("history.h5", said)
            self.assertEqual((folder / "out/history.h5").read_text(), "a series of mine, amontons run")

    def test_without_locks(self):
        """A file system that refuses flock: said once, and gone on with."""
        folder = self.fresh()
        cases.put(folder, {"none.c": "#include <errno.h>\nint flock(int f, int o) { (void)f; (void)o; errno = ENOLCK; return -1; }\n"})
        subprocess.run(["cc", "-shared", "-fPIC", "none.c", "-o", "none.so"], cwd=folder, check=True)
        env = os.environ | {"AMONTONS_CACHE": str(folder / "cache"), **preload(folder / "none.so")}
        for words in (["run", "scene.yaml", "-o", "free"], ["sweep", "study.yaml", "-o", "frees"]):
            done = subprocess.run([PROGRAM, *words], cwd=folder, env=env, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual((done.stdout + done.stderr).count("has no locks"), 1, done.stderr)

    def test_a_list_of_a_stranger_reaches_nothing_outside(self):
        folder = self.fresh()
        mine = {"mine.txt": "mine", "out/.mine": "mine", "behind/mine.txt": "mine"}
        cases.put(folder, mine)
        (folder / "out/inner").symlink_to("../behind")
        with open(folder / "out" / LIST, "a") as file:
            file.write(f"../mine.txt\n{folder}/mine.txt\n.mine\ninner/mine.txt\ninner/../../mine.txt\n")
        status, said = call(folder, [*COMMANDS["run"], "--overwrite"])
        self.assertEqual(status, 0, said)
        for name, text in mine.items():
            self.assertEqual((folder / name).read_text(), text)

    def test_a_killed_run_that_was_copied_is_resumed_or_overwritten(self):
        folder = self.fresh("run")
        words = [*COMMANDS["run"], "--set", "time.until={U: 1}", "output.figures=[]", "output.fields=none"]
        with subprocess.Popen([PROGRAM, *words], cwd=folder, env=os.environ | {"AMONTONS_CACHE": ""}) as process:
            while process.poll() is None and not (folder / "out/history.h5.part").exists() or not (folder / "out/history.h5.part").stat().st_size:
                pass
            process.kill()
        shutil.copytree(folder / "out", folder / "copy", copy_function=shutil.copyfile)   # no mode bits
        status, said = call(folder, ["run", "scene.yaml", "-o", "copy", "--quiet"])
        self.assertEqual(status, 2, said)
        self.assertIn("--overwrite", said)
        status, said = call(folder, ["run", "scene.yaml", "-o", "copy", "--quiet", "--overwrite"])
        self.assertEqual(status, 0, said)

    def test_pipes_are_not_waited_for(self):
        """In the place of every file that is read."""
        inputs = [(path, [words for words in COMMANDS.values() if path in words]) for path in INPUTS if path != "block.geo"]
        inputs += [("block.geo", [["run", "scene.yaml", "-o", "new"], ["info", "block.geo"]]), ("block.msh", [["info", "block.msh"]])]
        read = [(str(path), [words for words in READERS if path.parts[0] in words])
                for name in ("run", "sweep") for path in one_of_each(self.written[name])
                if path.parts[0] != "cache" and path.name != LIST]
        read += [(str(path), [COMMANDS["run"] + ["--overwrite"]]) for path in self.written["run"] if path.parts[0] == "cache"]
        for path, commands in [*inputs, *read]:
            for words in commands:
                with self.subTest(file=path, command=words[0:2]):
                    folder = self.fresh()
                    put(folder / path, "pipe", None)
                    status, said = call(folder, words)
                    self.assertIn(status, (0, 1, 2), said)
                    if path in INPUTS:
                        self.assertEqual(status, 2, said)
                        self.assertIn(path, said)
                    # What the list has is ours, whatever lies there: --overwrite and a picture drawn anew replace it.
                    ours = path.startswith("cache/") or listed(folder, Path(path))
                    self.assertTrue(stands(folder / path, "pipe") or status == 0 and ours, said)

    def test_open_pipes_are_for_the_command_line(self):
        """A shell's pipe that never ends: no file names it, and no link leads there. A command may, and finds what is in it."""
        folder = self.fresh()
        plain = INPUTS["plain.yaml"]
        law = "friction: {law: table, file: /dev/stdin}"
        files = {
            "friction.yaml": re.sub("(?m)^friction:.*", law, plain),
            "gap.yaml": plain + "contact: {profile: /dev/fd/0}\n",
            "moduli.yaml": plain.replace("young: 1, poisson: 0.34", "from: /proc/self/fd/0, poisson: 0.34"),
            "compare.yaml": INPUTS["scene.yaml"].replace("figures: [force]", "figures: [force]\n  compare: /dev/stdin"),
            "named.yaml": INPUTS["study.yaml"].replace("scene: plain.yaml", "scene: /dev/stdin"),
            "measured.yaml": INPUTS["fit.yaml"].replace("measured.csv", "/dev/stdin"),
            "page.yaml": cases.PLOT + "page: {compare: /dev/stdin}\n",
            "included.geo": 'Printf(Include "/dev/stdin");\n' + (SOURCE / "meshes/block.geo").read_text()}
        cases.put(folder, files)
        ends = os.pipe()
        try:
            for words in (["info", "friction.yaml"], ["info", "gap.yaml"], ["info", "moduli.yaml"], ["run", "compare.yaml", "-o", "new"],
                          ["sweep", "named.yaml", "-o", "many"], ["fit", "measured.yaml", "-o", "fitted"], ["render", "page.yaml", "--overwrite"],
                          ["info", "included.geo"], ["info", "included.geo", "--trust"]):
                with self.subTest(words):
                    status, said = call(folder, words, ends[0])
                    self.assertEqual(status, 2, said)
                    self.assertIn("may be named on the command line alone", said)
            for path in ("out/run.json", "out/history.h5", "out/checkpoint.bin", "scene.yaml"):
                with self.subTest(path):
                    (folder / path).unlink(missing_ok=True)
                    (folder / path).symlink_to("/dev/stdin")
                    for words in (["info", "out"], ["render", "out"], [*COMMANDS["run"], "--resume"]):
                        self.assertIsNotNone(call(folder, words, ends[0])[0], words)
            os.write(ends[1], plain.replace("block.msh", f"{folder}/block.msh").encode())
            os.close(ends[1])
            ends = ends[:1]
            status, said = call(folder, ["run", "/dev/stdin", "-o", "piped", "--quiet"], ends[0])
            self.assertEqual(status, 0, said)
        finally:
            for end in ends:
                os.close(end)

    def test_named_files_give_way_to_overwrite_alone(self):
        for words, named in ((["film", "out", *FILM], "mine.mp4"), (["report", "out"], "mine.html")):
            folder = self.fresh()
            mine = folder / named
            mine.write_bytes(STANDARD)
            status, said = call(folder, [*words, "-o", named])
            self.assertEqual(status, 2)
            self.assertIn(f"{named} is there already: name another file, or say --overwrite", said)
            self.assertEqual(mine.read_bytes(), STANDARD)
            self.assertEqual(call(folder, [*words, "-o", named, "--overwrite"])[0], 0)
            self.assertNotEqual(mine.read_bytes(), STANDARD)
            self.assertEqual(call(folder, [*words, "-o", named])[0], 2)   # ours by now, and named all the same

    def test_a_run_that_does_not_begin_leaves_the_earlier_result(self):
        folder = self.fresh()
        before = {path: (folder / path).read_bytes() for path in self.written["run"]}
        for more in (["--set", "time.until={U: 1e60}", "time.step_min=1"], []):
            with self.subTest(more):
                words = [PROGRAM, *COMMANDS["run"], "--overwrite", *more]
                limited = words if more else ["bash", "-c", 'ulimit -f 1; trap "" XFSZ; exec "$@"', "bash", *words]
                done = subprocess.run(limited, cwd=folder, env=os.environ | {"AMONTONS_CACHE": ""}, capture_output=True)
                self.assertNotEqual(done.returncode, 0)
                after = {path: (folder / path).read_bytes() for path in before if (folder / path).exists()}
                self.assertEqual(set(after), set(before), done.stderr)
                self.assertEqual(after, before)
                self.assertEqual([p for p in files_in(folder / "out") if "out" / p not in {*before, *self.written["data"], *self.written["states"]}
                                  and p.name not in ("report.html", "force.pdf", "force.svg")], [])


if __name__ == "__main__":
    unittest.main()
