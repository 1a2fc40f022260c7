# SPDX-License-Identifier: GPL-2.0-or-later
"""Results, sweeps and pages that somebody sent: a link in them, or a name that their files give, leads to no file of the
user's, neither to be written nor to be read (src/io/files/folder.h). The folder of a result itself may be a link."""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
sys.path.insert(0, str(SOURCE / "validation/hostile"))
import cases  # noqa: E402
from sanitizer_fixture import preload  # noqa: E402

PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
LIST = "amontons.files"
SECRET = "machine example.org login me password hunter2"
SCENE = cases.SCENE.replace("history: true", "history: false")
INPUTS = {"scene.yaml": cases.SCENE.replace("figures: []", "figures: [force]\n  fields: {every_U: 4e-4}"), "plain.yaml": SCENE,
          "study.yaml": cases.STUDY.replace("scene.yaml", "plain.yaml") + "plot: {x: load.pressure, y: results.mu_max, compare: seen.csv}\n",
          "table.yaml": cases.STUDY.replace("scene.yaml", "plain.yaml") + "keep: table\n",
          "seen.csv": "load.pressure,results.mu_max\n0.0035,0.3\n", "block.geo": cases.ROOT / "meshes/block.geo"}
RUN = ["run", "scene.yaml", "-o", "out", "-q"]
SWEEP = ["sweep", "study.yaml", "-o", "many", "-q"]
TABLE = ["sweep", "table.yaml", "-o", "table", "-q"]
IS_LINK = "is a symbolic link, and inside of a result none is followed"


class Links(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stock = Path(tempfile.mkdtemp(prefix="amontons_links_"))
        cases.put(cls.stock, INPUTS)
        cls.cache = {"AMONTONS_CACHE": str(cls.stock / "cache")}
        for words in (RUN, SWEEP):
            cls.words(cls.stock, *words)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.stock)

    @classmethod
    def words(cls, folder, *words, status=0):
        done = subprocess.run([PROGRAM, *words], cwd=folder, env=os.environ | cls.cache, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
        if done.returncode != status:
            raise AssertionError(f"{words}: {done.returncode}: {done.stdout}")
        return done.stdout

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons_links_"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copytree(self.stock, self.folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("cache"))
        self.elsewhere = self.folder / "elsewhere"
        cases.put(self.elsewhere, {"keys": "mine", "netrc": SECRET + "\n", "run.json": '{"name": "mine"}', "force.png": "mine",
                              "force.csv": "mine", "share-0.points": "mine", LIST: "# a list\nrun.json\nforce.png\nforce.csv\nkeys\n"})
        self.before = self.all_elsewhere()

    def all_elsewhere(self):
        return {path.relative_to(self.elsewhere): path.read_bytes() for path in self.elsewhere.rglob("*") if path.is_file()}

    def refused(self, *words, says=IS_LINK):
        """The command ends with status 2 and says why; the user's folder is as it was."""
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, env=os.environ | self.cache, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(self.all_elsewhere(), self.before, words)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn(says, done.stderr)

    def linked(self, name, target=None):
        """A link in the place of `name`."""
        path = self.folder / name
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        path.unlink(missing_ok=True)
        path.symlink_to(target or self.elsewhere)

    def test_files_set_aside_are_put_back_inside(self):
        """The first command of whoever was sent a scene with its result beside it."""
        cases.put(self.folder, {"scene-result/amontons.aside/d/keys": "theirs", f"scene-result/amontons.aside/{LIST}": "d/keys\n"})
        self.linked("scene-result/d")
        self.refused("run", "scene.yaml", "-q")

    def test_figures_and_fields_are_made_inside(self):
        for name, words in (("figures", ["render", "out"]), ("figures", ["render", "out", "--figure", "force", "--overwrite"]),
                            ("figures", [*RUN, "--overwrite"]), ("fields", [*RUN, "--overwrite"]), ("figures", ["compare", "out", "seen.csv"])):
            with self.subTest(name=name, words=words[:2]):
                shutil.rmtree(self.folder / "out")
                shutil.copytree(self.stock / "out", self.folder / "out")
                self.linked(f"out/{name}")
                if words[0] == "compare":
                    (self.folder / "seen.csv").write_text("U,F_T/F_N\n4e-4,0.1\n")
                self.refused(*words)
        shutil.copy(self.folder / "many/figures/plot.json", self.elsewhere)   # of a sweep each is drawn beside itself
        self.before = self.all_elsewhere()
        self.linked("many/figures")
        self.refused("render", "many")

    def test_folders_of_a_sweep_lie_inside(self):
        point = next((self.folder / "many/points").iterdir()).name
        inside = ("", "/run.json", "/checkpoint.bin", "/history.h5")
        for name in ("points", *(f"points/{point}{file}" for file in inside), "figures", "slurm"):
            for more in ([], ["--fresh"], ["--retry"]):
                with self.subTest(name=name, more=more):
                    shutil.rmtree(self.folder / "many")
                    shutil.copytree(self.stock / "many", self.folder / "many")
                    self.linked(f"many/{name}")
                    if name == "points":
                        shutil.copytree(self.stock / f"many/points/{point}", self.elsewhere / point, dirs_exist_ok=True)
                        self.before = self.all_elsewhere()
                    self.refused(*SWEEP, *more)
        self.linked("many/slurm")
        self.refused("sweep", "table.yaml", "-o", "many", "-q")   # which looks for shares, and removes them

    def test_a_point_of_somebodys_is_not_removed(self):
        """A run.json that no list has, in the place of a point's."""
        path = next((self.folder / "many/points").iterdir()) / "run.json"
        (path.parent / LIST).write_text("# nothing\n")
        path.write_text('{"name": "mine"}')
        for more in ([], ["--fresh"]):
            said = self.words(self.folder, *SWEEP, *more, status=2)
            self.assertIn("is not in the list of what amontons wrote", said)
            self.assertEqual(path.read_text(), '{"name": "mine"}')

    def test_pages_show_nothing_from_outside(self):
        """Links in the places of all that the page of a sweep, or of a run, reads."""
        for name in ("answer.txt", "sweep.csv", "sweep.h5", "ranking.csv", "figures/best.png", "figures"):
            with self.subTest(name):
                shutil.rmtree(self.folder / "many")
                shutil.copytree(self.stock / "many", self.folder / "many")
                if name == "figures/best.png":
                    (self.folder / "many/answer.txt").write_text("best")
                self.linked(f"many/{name}", None if name == "figures" else self.elsewhere / "netrc")
                self.refused("report", "many")
                self.assertFalse((self.folder / "many/report.html").exists())
        for name in ("run.json", "history.h5", "fields", "fields.pvd"):
            self.linked(f"out/{name}", self.elsewhere if name == "fields" else self.elsewhere / "netrc")
            self.refused("report", "out")
            (self.folder / "out" / name).unlink()

    def test_a_figure_of_a_page_lies_inside(self):
        self.linked("many/figures/a.json", self.elsewhere / "netrc")
        self.words(self.folder, "report", "many")
        page = (self.folder / "many/report.html").read_text()
        self.assertNotIn("hunter2", page)
        self.assertIn("figures/a.json is a symbolic link", page)

    def test_tables_of_a_figure_lie_inside(self):
        """Absolute, above the folder, and through a link; that of the sweep is drawn."""
        shutil.copy(self.folder / "many/sweep.h5", self.elsewhere / "own.h5")
        self.linked("many/near.h5", self.elsewhere / "own.h5")
        column = "result/results.mu_max"
        for table, good in (("../sweep.h5", True), (str(self.elsewhere / "own.h5"), False), ("../../elsewhere/own.h5", False), ("../near.h5", False)):
            with self.subTest(table):
                data = f"{table}:{column}"
                (self.folder / "many/figures/plot.json").write_text(json.dumps({"x": {"label": "a"}, "y": {"label": "b"}, "series": [{"x": data, "y": data}]}))
                self.words(self.folder, "report", "many", "--overwrite")
                page = (self.folder / "many/report.html").read_text()
                self.assertEqual("leads out of" in page or "is a symbolic link" in page, not good)
                self.assertEqual("The points of the sweep." in page, good)
        (self.folder / "plot.yaml").write_text(f"x: {{label: a}}\ny: {{label: b}}\nseries: [{{x: 'elsewhere/own.h5:{column}', y: 'elsewhere/own.h5:{column}'}}]\n")
        self.words(self.folder, "render", "plot.yaml")   # a file that the user names may name any

    def test_measurements_of_a_sweep_stay_in_its_page(self):
        """They lie where the study has them; a page takes them from beside the figure, or says that it has none."""
        self.words(self.folder, "report", "many")
        page = (self.folder / "many/report.html").read_text()
        self.assertNotIn("Without the measurements", page)
        (self.folder / "many/figures/plot-compared.csv").unlink()
        self.words(self.folder, "report", "many", "--overwrite")
        less = (self.folder / "many/report.html").read_text()
        self.assertRegex(less, "Without the measurements many/figures/[./]*/seen.csv")
        self.assertLess(len(less), len(page))

    def test_the_run_of_a_page_lies_inside(self):
        cases.put(self.folder, {"private/run/run.json": (self.folder / "out/run.json").read_text().replace("Hostile", SECRET)})
        path = self.folder / "many/sweep.csv"
        rows = list(csv.reader(path.read_text().splitlines()))
        for run in ("../private/run", str(self.folder / "private/run")):
            for row in rows[1:]:
                row[rows[0].index("run")] = run
            with open(path, "w", newline="") as file:
                csv.writer(file).writerows(rows)
            self.refused("report", "many", says="leads out of")

    def test_what_else_reads_a_result(self):
        self.linked("out/run.json", self.elsewhere / "netrc")
        self.refused("info", "out")
        self.linked("out/history.h5", self.elsewhere / "netrc")
        for words in (["render", "out"], ["film", "out", "--seconds", "0.1"]):
            self.refused(*words)
        self.linked("many/sweep.h5", self.elsewhere / "netrc")
        self.refused("render", "many", "--plot", "{x: load.pressure, y: results.mu_max, name: two}")

    def test_a_folder_that_is_a_link_serves_as_before(self):
        """results -> /big/disk/results: run, again, pictures, page, sweep, again."""
        for name in ("out", "many"):
            shutil.rmtree(self.folder / name)
            (self.folder / f"disk/{name}").mkdir(parents=True)
            (self.folder / name).symlink_to(f"disk/{name}")
        for words in (RUN, [*RUN, "--overwrite"], ["render", "out"], ["report", "out"], ["report", "out"], ["info", "out"], SWEEP,
                      [*SWEEP, "--fresh"], ["render", "many"], ["report", "many"], ["report", "many"]):
            self.words(self.folder, *words)
        self.assertTrue((self.folder / "disk/out/figures/force.png").is_file())
        for words in (RUN, [*RUN, "--overwrite"]):
            self.words(self.folder, *words, status=2 if words is RUN else 0)
        (self.folder / "project").symlink_to(self.folder / "disk")
        self.words(self.folder, "run", "scene.yaml", "-o", "project/out", "-q", "--overwrite")

    def test_notebooks_show_nothing_from_outside(self):
        pictures = self.folder / "out/figures"
        script = "import amontons, sys\nresult = amontons.open_result('out')\n" + "{}\n"

        def python(line):
            env = os.environ | {"PYTHONPATH": str(PROGRAM.resolve().parent.parent / "python")} | preload(PROGRAM.parent / "libamontons.so")
            return subprocess.run([sys.executable, "-c", script.format(line)], cwd=self.folder, env=env, capture_output=True, text=True)

        show = "print(result._repr_html_().count('<img'), result._repr_png_())"
        self.assertTrue(python(show).stdout.startswith("1 b'"), python(show).stderr)
        self.linked("out/figures/force.png", self.elsewhere / "netrc")
        self.assertEqual(python(show).stdout, "0 None\n")
        shutil.copytree(self.stock / "out/figures", self.elsewhere / "figures")
        shutil.rmtree(pictures)
        pictures.symlink_to(self.elsewhere / "figures")
        self.assertEqual(python(show).stdout, "0 None\n")
        self.assertIn("bulk_000000.vtu", python("print(result.fields[0].bulk)").stdout)
        for name in ("../elsewhere/bulk.vtu", str(self.elsewhere / "bulk.vtu")):
            (self.folder / "out/fields.pvd").write_text(f'<VTKFile><DataSet timestep="0" file="{name}"/></VTKFile>')
            self.assertIn("leads out of out", python("result.fields").stderr)
        for name, line in (("run.json", "result.report"), ("history.h5", "result.history"), ("fields.pvd", "result.fields")):
            self.linked(f"out/{name}", self.elsewhere / "netrc")
            self.assertIn(IS_LINK, python(line).stderr)


if __name__ == "__main__":
    unittest.main()
