# SPDX-License-Identifier: GPL-2.0-or-later
"""`amontons stability` as its users call it: table, files, options, refusals."""
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
FIG1 = SOURCE / "validation" / "paper" / "fig1.yaml"
COARSE = ["--set", "mesh.set.nx=20", "mesh.set.nz=20", "load.pressure=0.006"]


def stability(*words, scene=FIG1, coarse=COARSE):
    return subprocess.run([PROGRAM, "stability", *map(str, words), scene, *coarse],
                          capture_output=True, text=True, timeout=120)


def rows(text):
    """The numbers of the table's lines, "-" as 0 and the certificate as 0 or 1."""
    table = []
    for line in text.splitlines()[1:]:
        words = line.split()
        if not words:
            break
        table.append([{"-": 0, "yes": 1, "no": 0}.get(word, word) for word in words])
    return numpy.array(table, dtype=float)


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-stability-"))
        self.addCleanup(shutil.rmtree, self.folder)


class Answers(InFolder):
    @classmethod
    def setUpClass(cls):
        cls.kept = Path(tempfile.mkdtemp(prefix="amontons-stability-"))
        cls.addClassCleanup(shutil.rmtree, cls.kept)
        cls.done = stability("-o", cls.kept)
        cls.report = json.loads((cls.kept / "stability.json").read_text())

    def test_table_is_the_report(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.assertEqual(self.done.stdout.split()[:4], ["l", "slipping", "U", "mu"])
        table, points = rows(self.done.stdout), self.report["points"]
        self.assertEqual(len(table), len(points))
        names = ["l_over_L", "slipping", "U", "mu", "rate_re", "rate_im", "real_rate", "load",
                 "certified"]
        for name, column in zip(names, table.T):
            numpy.testing.assert_allclose(column, [point[name] for point in points], rtol=1e-3,
                                          atol=1e-4)
        found = self.report["results"]
        self.assertIn(f"l_c/L                  {found['l_c_over_L']:.4f}", self.done.stdout)
        self.assertIn(f"mu_M at V              {found['mu_M']:.4f}", self.done.stdout)

    def test_answers_follow_from_the_points(self):
        points, found = self.report["points"], self.report["results"]
        element = found["element_over_L"]
        self.assertAlmostEqual(element, 1 / 20)

        def first(lost):
            return next(point["l_over_L"] for point in points if lost(point))

        for value, lost in ((found["l_sc_over_L"], lambda point: point["rate_re"] > 0),
                            (found["l_c_over_L"], lambda point: point["real_rate"] > 0),
                            (found["l_c_scan_over_L"], lambda point: point["load"] >= 1)):
            self.assertLessEqual(value, first(lost) + 1e-9)
            self.assertGreaterEqual(value, first(lost) - element - 1e-9)
        self.assertAlmostEqual(found["l_sc_certificate_over_L"],
                               first(lambda point: not point["certified"]))
        self.assertLessEqual(abs(found["l_sc_certificate_over_L"] - found["l_sc_over_L"]), element)
        self.assertEqual(self.report["status"], "done")
        self.assertEqual(self.report["slidings_before"], 2)
        self.assertEqual(self.report["scene"]["load"]["pressure"], 0.006)

    def test_modes(self):
        points, found = self.report["points"], self.report["results"]
        with h5py.File(self.kept / "stability.h5") as file:
            x, critical = file["nodes/x"][:], file["critical/slip"][:]
            modes, rate = file["modes/slip"][:], file["points/rate"][:]
            for name in ("nodes/x", "critical/slip", "modes/slip", "points/front", "points/rate"):
                self.assertTrue(file[name].attrs["description"])
        numpy.testing.assert_allclose(x, numpy.linspace(0, 1, 21), atol=1e-12)
        numpy.testing.assert_allclose(rate[:, 0], [point["rate_re"] for point in points])
        shape = modes.reshape(len(points), 2, 21)
        size = numpy.hypot(shape[:, 0], shape[:, 1])
        slips = numpy.array([point["slipping"] for point in points])
        numpy.testing.assert_allclose(size.max(axis=1)[slips > 0], 1, atol=1e-6)
        for point, slip in zip(points, size):   # only what slips takes part
            self.assertEqual(numpy.count_nonzero(slip), point["slipping"])
        self.assertAlmostEqual(critical.max(), 1)
        self.assertTrue(numpy.all(critical >= 0))
        self.assertTrue(numpy.all(critical[x > found["l_c_over_L"] + found["element_over_L"]] == 0))
        # The paper's cos(pi x / 2 l): largest at the trailing edge or near it, falling to the front.
        peak = critical.argmax()
        self.assertTrue(numpy.all(numpy.diff(critical[peak:]) <= 1e-12))

    def test_run_sees_the_growth_too(self):
        words = ["time.until={U: 0.01}", "output.figures=[]", "output.fields=none"]
        done = subprocess.run([PROGRAM, "run", FIG1, "-q", "-o", self.folder / "run", *COARSE,
                               *words], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        run, found = json.loads((self.folder / "run/run.json").read_text()), self.report["results"]
        peak = run["results"]["peaks"][2]   # the one after the two slidings
        for key, wanted in (("l_c_growth_over_L", found["l_c_over_L"]),
                            ("l_c_over_L", found["l_c_at_V_over_L"]),
                            ("l_sc_over_L", found["l_sc_certificate_over_L"])):
            self.assertLessEqual(abs(peak[key] - wanted), found["element_over_L"], key)

    def test_start_and_whole(self):
        start = stability("--from", "start", "--whole")
        self.assertEqual(start.returncode, 0, start.stderr)
        self.assertEqual(start.stderr, "")   # nothing was stepped before
        table = rows(start.stdout)
        self.assertAlmostEqual(table[-1, 0], 1)
        # The last row is where the front was found at the end, perhaps after the block fell: the
        # one before is still nearly at mu_S.
        self.assertGreater(table[-2, 3], 0.35)
        self.assertLess(rows(self.done.stdout)[0, 3], 0.2)   # at rest after sliding: about mu_K

    def test_end(self):
        """A stiff block without a rod: v - v* grows as exp(lambda t), lambda = (mu_S - mu_K) P/(rho H v_c),
        which is 3 here."""
        scene = SOURCE / "validation/exact/rigid_block.yaml"
        done = stability("--from", "end", "--set", "time.until.t=0.3", "material.young=1e3",
                         "-o", self.folder / "end", scene=scene, coarse=[])
        self.assertEqual(done.returncode, 0, done.stderr)
        table = rows(done.stdout)
        self.assertEqual(len(table), 1)
        self.assertAlmostEqual(table[0, 4], 3, delta=3e-3)
        report = json.loads((self.folder / "end/stability.json").read_text())
        self.assertEqual(report["points"][0]["slipping"], 21)
        self.assertAlmostEqual(report["points"][0]["real_rate"], 3, delta=3e-3)
        for key, value in report["results"].items():   # one state has no lengths
            if key not in ("element_over_L", "pad", "why"):
                self.assertIsNone(value, key)
        self.assertEqual(report["results"]["why"], [])

    def test_quiet(self):
        done = stability("--quiet", "--slidings", "1", "-o", self.folder / "deep" / "er")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        report = json.loads((self.folder / "deep/er/stability.json").read_text())
        self.assertEqual(report["slidings_before"], 1)
        again = stability("--quiet", "-o", self.folder / "deep/er")
        self.assertEqual(again.returncode, 2)
        self.assertIn("holds an earlier result (stability.h5)", again.stderr)
        over = stability("--quiet", "-o", self.folder / "deep/er", "--overwrite")
        self.assertEqual(over.returncode, 0, over.stderr)


PART = """// A block that stands on a part of its lower face, in the middle.
DefineConstant[part = 0.1, cell = 0.0125];
Point(1) = {0, 0, 0, 4 * cell};
Point(2) = {0.5 - part / 2, 0, 0, cell};
Point(3) = {0.5 + part / 2, 0, 0, cell};
Point(4) = {1, 0, 0, 4 * cell};
Point(5) = {1, 0.5, 0, 4 * cell};
Point(6) = {0, 0.5, 0, 4 * cell};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};
Line(4) = {4, 5};  Line(5) = {5, 6};  Line(6) = {6, 1};
Curve Loop(1) = {1:6};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("contact") = {2};
Physical Curve("top") = {5};
Physical Curve("rod") = {6};
"""


class Why(InFolder):
    """The sentences, against runs."""

    def words(self, name, *sets, scene=SOURCE / "validation/pads/pads.yaml", more=()):
        out = self.folder / name
        done = stability(*more, "-o", out, "--set", *sets, scene=scene, coarse=[])
        self.assertEqual(done.returncode, 0, done.stderr)
        said = re.sub(r"\s+", " ", done.stdout)
        results = json.loads((out / "stability.json").read_text())["results"]
        for sentence in results["why"]:
            self.assertIn(sentence, said)
        return results, " ".join(results["why"])

    def run_scene(self, *sets, scene=SOURCE / "validation/pads/pads.yaml"):
        out = self.folder / "run"
        done = subprocess.run([PROGRAM, "run", scene, "-q", "-o", out, "--overwrite", "--set", *sets,
                               "output.figures=[]", "output.fields=none"], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((out / "run.json").read_text())["results"]

    def test_contact_that_would_not_run_away(self):
        """Runs on contacts shorter and longer than the one that is said to be steady."""
        low = ["rod.height=0.05", "rod.width=0.1"]
        found, said = self.words("whole", *low, "mesh.set.nx=80", "mesh.set.nz=40", "load.pressure=0.006",
                                 scene=FIG1, more=["--from", "start"])
        length = found["steady_contact"]
        self.assertIn(f"A contact shorter than {length:.2g}", said)
        (self.folder / "part.geo").write_text(PART)
        for part, slides in ((length / 1.4, False), (length * 1.4, True)):
            run = self.run_scene(f"mesh.file={self.folder / 'part.geo'}", f"mesh.set={{part: {part}}}", *low,
                                 f"load.pressure={0.006 * part}", f"time.until.U={0.03 * part}", scene=FIG1)
            self.assertEqual(len(run["peaks"]) > 1, slides, (part, run["mu_max"]))

    def test_mu_is_that_of_runs(self):
        """Within half a percent, at V: 0.4 % and 1.5 % above where slow slip is taken to meet mu_S."""
        for sets in (["mesh.set.n=4", "time.until.U=0.016"],
                     ["mesh.set.n=8", "load.pressure=0.001", "time.until.U=0.0035"]):
            found, _ = self.words("-".join(sets), *sets)
            run = self.run_scene(*sets)
            self.assertAlmostEqual(found["mu_M"] / run["peaks"][2]["mu"], 1, delta=3e-3)

    def test_pads_that_go_with_others(self):
        found, said = self.words("eight", "mesh.set.n=8", "load.pressure=0.003")
        self.assertEqual(found["pad"], "contact_2")
        self.assertIn(f"Slip runs away once all of contact_2 slips, at mu {found['mu_M']:.4f}.", said)
        self.assertIn("It cannot run away alone", said)
        self.assertIn("slip of contact_1 takes part", said)

    def test_nothing_runs_away(self):
        found, said = self.words("coulomb", "friction.mu_kinetic=0.38", more=["--from", "start"])
        self.assertRegex(said, "^Nothing runs away before all of the contact slips: it then slides, at mu 0.3[78]")
        self.assertIsNone(found["steady_contact"])


class Refusals(InFolder):
    def assert_refused(self, words, *parts, scene=FIG1):
        done = stability(*words, scene=scene)
        self.assertEqual((done.returncode, done.stdout), (2, ""), words)
        for part in parts:
            self.assertIn(part, done.stderr)

    def test_words(self):
        self.assert_refused(["--from", "peak"], "--from peak: allowed are sliding, start and end")
        for count in ("0", "x", "2.5", "1e9", ""):
            self.assert_refused(["--slidings", count], "a whole number from 1 to 1000")
        self.assert_refused(["--slidings", "2", "--from", "start"], "no meaning with --from start")
        self.assert_refused(["--from", "end", "--whole"], "--whole has no meaning with --from end")
        self.assert_refused(["-o", ""], "the folder has no name")
        self.assert_refused(["other.yaml"], "takes one scene")
        alone = subprocess.run([PROGRAM, "stability"], capture_output=True, text=True)
        self.assertEqual(alone.returncode, 2)
        self.assertIn("stability needs a scene", alone.stderr)

    def test_scenes(self):
        self.assert_refused([], "none.yaml", scene=self.folder / "none.yaml")
        self.assert_refused(["--set", "time.until={U: 1e-3}"], "0 of 2 slidings", "--from start")
        self.assert_refused(["--set", "time.scheme=explicit"], "time.scheme=sdirk2")
        self.assert_refused(["--from", "end", "--set", "start.velocity_x=0", "friction.mu_kinetic=0.4"],
                            "nothing slips at the scene's end",
                            scene=SOURCE / "validation/exact/rigid_block.yaml")
        folder = self.folder / "kept"
        self.assert_refused(["-o", folder, "--set", "time.scheme=explicit"])
        self.assertFalse(folder.exists())

    def test_help(self):
        shown = subprocess.run([PROGRAM, "stability", "--help"], capture_output=True, text=True)
        text = re.sub(r"\s+", " ", shown.stdout)
        self.assertEqual(shown.returncode, 0)
        for word in ("SCENE", "--from", "--slidings", "--whole", "--set", "l_c", "Example",
                     "amontons stability validation/paper/fig1.yaml"):
            self.assertIn(word, text)
        self.assertLessEqual(max(map(len, shown.stdout.splitlines())), 80)

    def test_interrupt(self):
        words = [PROGRAM, "stability", FIG1, "--set", "rod.velocity=1e-8", "time.watch=0",
                 "mesh.set.nx=20",
                 "mesh.set.nz=20", "-o", self.folder / "result"]
        run = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(1.5)
        run.send_signal(signal.SIGINT)
        _, said = run.communicate(timeout=20)
        self.assertEqual(run.returncode, 1)
        self.assertIn("stopped", said)
        self.assertFalse((self.folder / "result" / "stability.json").exists())


class Memory(InFolder):
    """Friction that remembers: what `amontons run` and published lengths say."""
    SCENE = SOURCE / "validation/memory/paper.yaml"
    AGEING = "friction={law: ageing, mu_static: 0.3545, mu_kinetic: 0.0933, critical_velocity: 3.4e-4, healing: %s, " \
        "healing_time: 10, slip_distance: 1e-4}"
    CREEPING = "friction={law: rate-and-state, mu_reference: 0.38, reference_velocity: 1e-7, direct_effect: 0.02, " \
        "evolution_effect: 0.06, slip_distance: 1e-4}"

    def found(self, *settings, words=(), mesh=(20, 10)):
        done = stability("-o", self.folder / "stable", "--overwrite", *words, scene=self.SCENE,
                         coarse=["--set", f"mesh.set.nx={mesh[0]}", f"mesh.set.nz={mesh[1]}", *settings])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.said = " ".join(done.stdout.split())
        return json.loads((self.folder / "stable/stability.json").read_text())

    def run_mu(self, *settings):
        subprocess.run([PROGRAM, "run", self.SCENE, "--set", "mesh.set.nx=20", "mesh.set.nz=10", "output.figures=[]", *settings, "-q",
                        "--overwrite", "-o", self.folder / "run"], check=True, timeout=240)
        return json.loads((self.folder / "run/run.json").read_text())["results"]["mu_M"]

    def test_memory_of_nothing(self):
        """healing: 0 is linear weakening, point by point, of a rod so slow that mu of its slip is that of rest."""
        weakens = self.AGEING.split("healing:")[0].replace("ageing", "linear-weakening").rstrip(", ") + "}"
        plain, nothing = (self.found(law, "rod.velocity=1e-10", words=("--from", "start")) for law in (weakens, self.AGEING % 0))
        self.assertEqual(len(plain["points"]), len(nothing["points"]))
        growing = 0
        for one, other in zip(plain["points"], nothing["points"]):
            grows = max(one["rate_re"], other["rate_re"]) > 0     # with memory slower rates are looked for: more of what decays is found
            growing += grows
            for key in ("l_over_L", "U", "mu", "mu_at_V", "load") + (("rate_re", "rate_im") if grows else ()):
                part = 1e-3 if key.startswith("rate") else 1e-5     # the path's own rod is not as slow, and mu counts in the coupling
                self.assertAlmostEqual(one[key], other[key], delta=part * max(abs(one[key]), 1), msg=key)
        self.assertGreater(growing, 3)
        self.assertIsNone(nothing["results"]["critical_stiffness"])

    def test_runs_agree(self):
        """mu at V of laws that stick as the paper's does (2 % on Figure 1's block), and the rise of rate and state to where it runs away."""
        self.assertAlmostEqual(self.found(self.AGEING % 0.03)["results"]["mu_M"] / self.run_mu(self.AGEING % 0.03), 1, delta=0.03)
        weakens = "friction={law: slip-weakening, mu_static: 0.38, mu_kinetic: 0.1, healing_time: 100, slip_distance: 1e-3}"
        self.assertAlmostEqual(self.found(weakens)["results"]["mu_M"] / self.run_mu(weakens), 1, delta=0.03)
        creeps = self.CREEPING.replace("1e-7", "1e-5"), "load.pressure=0.001"
        found = self.found(*creeps, words=("--from", "start"))
        self.run_mu(*creeps)
        first = json.loads((self.folder / "run/run.json").read_text())["results"]["peaks"][0]["mu"]
        self.assertAlmostEqual(found["results"]["mu_M"] / first, 1, delta=0.02)
        self.assertAlmostEqual(found["results"]["critical_stiffness"], 0.04 * 0.001 / 1e-4, delta=1e-6)
        self.assertIn("is steady on a stiffness above 0.4 (critical)", self.said)

    def test_nucleation_length(self):
        """Slip of rate k_c on a part of a half-space whose normals are held: 2.316 G'/k_c (Uenishi and Rice, 2003: the half-length
        0.579 G*/k_c of a crack between two half-spaces). On 7 elements 4 % less: the step from one node to the next is an error of
        first order."""
        found = self.found(self.CREEPING, "load.pressure=0.03", "rod.velocity=1e-7", "time.until={t: 1}", words=("--from", "end"), mesh=(64, 32))
        critical = found["results"]["critical_stiffness"]
        self.assertAlmostEqual(critical, 0.04 * 0.03 / 1e-4, delta=1e-4)
        poisson = 0.34 / 1.34     # that of plane strain with the moduli of plane stress
        modulus = 1 / (2 * 1.34) * 4 * (1 - poisson) / (3 - 4 * poisson)
        self.assertAlmostEqual(found["results"]["nucleation_length"] / (2.316 * modulus / critical), 1, delta=0.06)


SPACE = f"""material: {{poisson: 0.34, plane: strain}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{height: 0.25, width: 0.06, velocity: 2e-5}}
mesh: {{file: {SOURCE}/meshes/block.geo, set: {{length: 1, height: 0.5, nx: 16, nz: 8}}}}
time: {{until: {{U: 0.02, periodic: true}}}}
output: {{figures: [], fields: none, history: false}}
"""


class InSpace(InFolder):
    def points(self, *settings):
        path = self.folder / "scene.yaml"
        path.write_text(SPACE)
        words = [word for setting in settings for word in ("--set", setting)]
        done = stability("--from", "start", "-o", self.folder / "stable", "--overwrite", scene=path, coarse=words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((self.folder / "stable/stability.json").read_text())["points"]

    def test_held_across_is_plane_strain(self):
        """One cell across, held there: the same path, and all modes of the plane are among those of space, where both rows may also
        slip against each other: nothing grows slower than in the plane, and what runs away in both has one rate."""
        flat = self.points("reduction.use=never")
        deep = self.points(f"mesh={{file: {SOURCE}/meshes/block3d.geo, set: {{length: 1, breadth: 0.3, height: 0.5, nx: 16, ny: 1, nz: 8}}}}",
                           "load.supports=[{group: left, direction: y}, {group: right, direction: y}]", "reduction.use=never")
        self.assertEqual([2 * point["slipping"] for point in flat], [point["slipping"] for point in deep])
        alike = 0
        for plane, space in zip(flat, deep):
            for key in ("U", "mu", "mu_at_V", "slipping_over_A"):
                self.assertAlmostEqual(space[key] / plane[key], 1, delta=1e-6, msg=key)
            self.assertGreater(space["rate_re"], plane["rate_re"] - 1e-5 * abs(plane["rate_re"]) - 1e-6)
            if plane["load"] and space["load"] and max(plane["load"], space["load"]) < 1e3:
                self.assertGreater(space["load"], plane["load"] * (1 - 1e-5))   # parabolas between shifts
                alike += abs(space["load"] / plane["load"] - 1) < 1e-5
        self.assertGreaterEqual(alike, 8)
        runs_away = [(plane["real_rate"], space["real_rate"]) for plane, space in zip(flat, deep) if plane["real_rate"]]
        self.assertAlmostEqual(runs_away[0][1] / runs_away[0][0], 1, delta=1e-5)

    def test_run(self):
        """Of a block that slides by itself: mu at V and the area that slips before, as runs have them."""
        path = self.folder / "scene.yaml"
        path.write_text(SPACE)
        cube = ["--set", f"mesh={{file: {SOURCE}/meshes/block3d.geo, set: {{length: 0.5, breadth: 0.5, height: 0.5, nx: 8, ny: 8, nz: 8}}}}"]
        done = stability("-o", self.folder / "stable", scene=path, coarse=cube)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("of the contact slips, its front at", done.stdout)
        found = json.loads((self.folder / "stable/stability.json").read_text())["results"]
        subprocess.run([PROGRAM, "run", path, *cube, "-q", "-o", self.folder / "run"], check=True, timeout=240)
        run = json.loads((self.folder / "run/run.json").read_text())["results"]
        self.assertAlmostEqual(found["mu_M"] / run["mu_M"], 1, delta=0.02)
        self.assertAlmostEqual(found["A_c_at_V_over_A"], run["A_c_over_A"], delta=0.15)
        with h5py.File(self.folder / "stable/stability.h5") as file:
            self.assertEqual(len(file["nodes/y"]), 81)


if __name__ == "__main__":
    unittest.main()
