# SPDX-License-Identifier: GPL-2.0-or-later
"""Mesh and basis on disk: a second run gives the same bits without gmsh or a factorisation, and
whatever stands in the cache, a run never fails for it."""
import fcntl
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

from preload_fixture import preload

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BIN = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin"))
MODULES = Path(os.environ.get("AMONTONS_MODULES", BIN))
SHIFTED = BIN.parent / "tests" / "shifted_memory.so"
SCENE = SOURCE / "validation" / "paper" / "fig1.yaml"
SHORT = ["mesh.set.nx=8", "mesh.set.nz=8", "time.until.U=0.0034",
         "output.figures=[]"]
# Every run puts its files on the disk (fsync), which a disk takes its time for.
PLACE = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
PLAIN = ["output.fields=none"]
FIELDS = ["output.fields={every_U: 1e-3}"]


class Cached(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-cached-", dir=PLACE))
        self.addCleanup(shutil.rmtree, self.folder)
        self.cache = self.folder / "cache"
        self.runs = 0

    def run_scene(self, *more, scene=SCENE, cache=None, modules=MODULES, settings=SHORT, **variables):
        """The folder of a run that went well, and its run.json."""
        self.runs += 1
        folder = self.folder / f"run-{self.runs}"
        environment = dict(os.environ, AMONTONS_CACHE=str(self.cache if cache is None else cache),
                           AMONTONS_MODULES=str(modules), **variables)
        done = subprocess.run([BIN / "amontons", "run", scene, "-o", folder, "--quiet", "--set",
                               *settings, *more], env=environment, capture_output=True, text=True,
                              timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads((folder / "run.json").read_text())
        self.assertEqual(report["status"], "done")
        return folder, report

    def model(self, *settings, **where):
        return self.run_scene(*settings, **where)[1]["model"]

    def files(self):
        return sorted(self.cache.glob("*")) if self.cache.is_dir() else []

    def endings(self):
        return sorted(path.suffix for path in self.files())

    def assert_same_history(self, one, other):
        arrays = []
        with h5py.File(one / "history.h5") as left, h5py.File(other / "history.h5") as right:
            left.visititems(lambda name, item: arrays.append(name)
                            if isinstance(item, h5py.Dataset) else None)
            self.assertGreater(len(arrays), 10)
            for name in arrays:
                a, b = left[name][()], right[name][()]
                self.assertEqual(np.asarray(a).tobytes(), np.asarray(b).tobytes(), name)

    def assert_same_fields(self, one, other):
        names = sorted(path.name for path in one.rglob("*.vt[up]"))
        self.assertGreater(len(names), 4)
        self.assertEqual(names, sorted(path.name for path in other.rglob("*.vt[up]")))
        for path in one.rglob("*.vt[up]"):
            self.assertEqual(path.read_bytes(), (other / path.relative_to(one)).read_bytes(), path)


class SameBits(Cached):
    def test_second_run(self):
        none, uncached = self.run_scene(*PLAIN, cache="")
        self.assertFalse(self.cache.exists())
        first, made = self.run_scene(*PLAIN)
        self.assertEqual(self.endings(), [".basis", ".mesh"])
        second, read = self.run_scene(*PLAIN)
        self.assertEqual([run["model"]["from_cache"] for run in (uncached, made, read)],
                         [False, False, True])
        self.assert_same_history(none, first)
        self.assert_same_history(none, second)
        for key in ("results", "errors", "step_sizes", "scene"):
            self.assertEqual(read[key], made[key], key)
        for key in made["model"].keys() - {"from_cache", "mesh_by"}:
            self.assertEqual(read["model"][key], made["model"][key], key)
        self.assertEqual([run["model"]["mesh_by"] for run in (made, read)], ["gmsh", "cache"])
        outside = [run["timing_s"]["outside_loop_cpu"] for run in (made, read)]
        self.assertLess(0, outside[1])
        self.assertLess(2 * outside[1], outside[0])   # gmsh alone takes several times that
        self.assertTrue(all(run["model"]["cache_note"] is None for run in (uncached, made, read)))

    def test_kernels_that_round_by_alignment(self):
        """OpenBLAS's for Prescott do, and it takes them for processors that it does not know: the same bits wherever
        memory lies, also what CHOLMOD asks for itself and what is on the stack, and from the cache."""
        settings = [*PLAIN, "mesh.set.nx=13", "mesh.set.nz=9"]   # odd numbers of rows
        kernels = {"OPENBLAS_CORETYPE": "Prescott"}
        first, _ = self.run_scene(*settings, **kernels)
        self.assertTrue(SHIFTED.exists())
        for shift in ("16", "32", "48"):
            for cache in ("", None):
                folder, report = self.run_scene(*settings, cache=cache, **preload(SHIFTED), MEMORY_SHIFT=shift,
                                                LONGER="x" * int(shift), **kernels)
                self.assertEqual(report["model"]["from_cache"], cache is None)
                self.assertEqual(report["kernels"]["openblas"], "Prescott")
                self.assert_same_history(first, folder)
        # Of other kernels: rounded otherwise, so that it is not taken.
        self.assertFalse(self.model(*settings, OPENBLAS_CORETYPE="Nehalem")["from_cache"])

    def test_fields(self):
        """Modes of the whole mesh are kept when first asked for, with the basis they belong to."""
        without, _ = self.run_scene(*FIELDS, cache="")
        self.run_scene(*PLAIN)
        for known in (False, True):
            cached, report = self.run_scene(*FIELDS)
            self.assertEqual(report["model"]["from_cache"], known)
            self.assertIsNone(report["model"]["cache_note"])
            self.assertEqual(self.endings(), [".basis", ".mesh", ".modes"])
            self.assert_same_fields(without, cached)
            self.assert_same_history(without, cached)

    def test_no_gmsh_and_no_vtk(self):
        """Where gmsh and VTK are missing a mesh that is new fails, one in the cache does not."""
        bare = self.folder / "modules"
        bare.mkdir()
        for module in MODULES.glob("amontons_*.so"):
            if module.stem not in ("amontons_gmsh", "amontons_vtk"):
                (bare / module.name).symlink_to(module)
        done = subprocess.run([BIN / "amontons", "run", SCENE, "-o", self.folder / "fails", "--set",
                               *SHORT, *PLAIN], capture_output=True, text=True, timeout=60,
                              env=dict(os.environ, AMONTONS_CACHE=str(self.cache),
                                       AMONTONS_MODULES=str(bare)))
        self.assertEqual(done.returncode, 1)
        self.assertIn("amontons_gmsh", done.stderr)
        self.run_scene(*PLAIN)
        self.assertTrue(self.model(*PLAIN, modules=bare)["from_cache"])
        whole, read = (self.run_scene(*PLAIN, "reduction.use=never", modules=modules)
                       for modules in (MODULES, bare))   # the mesh is known, too
        self.assertGreater(read[1]["timing_s"]["mesh"], 0)
        self.assertEqual(read[1]["model"]["mesh_by"], "cache")
        self.assert_same_history(whole[0], read[0])

    def test_one_shape_for_many_scenes(self):
        self.run_scene(*PLAIN)
        for setting in ("load.pressure=0.004", "rod.velocity=2e-5", "friction.mu_static=0.4",
                        "friction.law=exponential-weakening", "start.friction=off",
                        "rod.kind=bonded", "material.density=120"):
            self.assertTrue(self.model(*PLAIN, setting)["from_cache"], setting)
        self.assertEqual(len(self.files()), 2)
        self.assertFalse(self.model(*PLAIN, "mesh.set.nz=12")["from_cache"])
        self.assertFalse(self.model(*PLAIN, "reduction.tolerance=1e-3")["from_cache"])
        self.assertEqual(len(self.files()), 5)   # the tolerance asks for no new mesh

    def test_what_has_no_shape(self):
        for setting in ("reduction.cache=false", "reduction.use=never"):
            self.assertFalse(self.model(*PLAIN, setting)["from_cache"], setting)
            self.assertEqual(self.endings(), [".mesh"], setting)

    def test_what_another_run_left_does_not_decide(self):
        """A short run on 40 x 40 cells: the same bits without a cache, with an empty one, with its own basis and with what a
        longer run under another load has left."""
        wide = [*PLAIN, "mesh.set.nx=40", "mesh.set.nz=40", "time.until.U=5e-4"]
        none, plain = self.run_scene(*wide, cache="")
        others = self.folder / "others"
        self.run_scene(*wide, "time.until.U=1e-3", "load.pressure=0.004", "reduction.use=always", cache=others)
        for again, cache in ((False, None), (True, None), (True, others)):
            cached, report = self.run_scene(*wide, cache=cache)
            self.assertEqual(report["model"]["from_cache"], again)
            self.assertEqual(report["model"]["reduced_dofs"], plain["model"]["reduced_dofs"])
            self.assert_same_history(none, cached)

    def test_moving_start(self):
        """It moves the interface: the same bits from the cache."""
        moves = [*PLAIN, "start.velocity_x=1e-5"]
        none, _ = self.run_scene(*moves, cache="")
        self.run_scene(*PLAIN)
        cached, report = self.run_scene(*moves)
        self.assertTrue(report["model"]["from_cache"])
        self.assert_same_history(none, cached)

    def test_blocks_that_fly_at_other_speeds(self):
        """Where no load presses, forces are measured by the impact's: it is none of the shape's."""
        flying = ["load.pressure=0", "rod.kind=none", "time.until={t: 2}", "time.energy_tolerance=1"]
        for speed in ("-1e-3", "-2e-2"):
            moving = [*flying, f"start.velocity_z={speed}", *PLAIN]
            one, cached = self.run_scene(*moving, settings=SHORT[:3] + SHORT[4:])
            other, made = self.run_scene(*moving, cache="", settings=SHORT[:3] + SHORT[4:])
            self.assertEqual(cached["errors"], made["errors"])
            self.assertEqual(cached["steps"], made["steps"])
        self.assertTrue(cached["model"]["from_cache"])

    def test_rod_on_the_leading_face(self):
        """It may pull there, and a basis so stored does not let it push."""
        leads = [*PLAIN, "groups.rod=leading"]
        for again in (False, True):
            _, report = self.run_scene(*leads, "rod.kind=bonded")
            self.assertEqual(report["model"]["mesh_by"], "cache" if again else "gmsh")
            done = subprocess.run([BIN / "amontons", "run", SCENE, "-o", self.folder / f"push-{again}",
                                   "--quiet", "--set", *SHORT, *leads], capture_output=True, text=True,
                                  env=dict(os.environ, AMONTONS_CACHE=str(self.cache)), timeout=60)
            self.assertEqual(done.returncode, 2)
            self.assertIn("leading half of the block", done.stderr)

    def test_msh_and_include(self):
        """A mesh by its content, text or not; a .geo that draws on others is meshed each time."""
        text = SCENE.read_text()
        scene = self.folder / "msh.yaml"
        scene.write_text(text.replace(text[text.index("  file:"):text.index("material:")],
                                      "  file: block.msh\n"))
        for binary in ([], ["-bin"]):
            subprocess.run(["gmsh", "-2", SOURCE / "meshes" / "block.geo", "-setnumber", "nx", "8",
                            "-setnumber", "nz", "8", *binary, "-o", self.folder / "block.msh"],
                           check=True, capture_output=True)
            for again in (False, True):   # read once each; both hold the same nodes: one basis
                _, report = self.run_scene(*PLAIN, scene=scene, settings=SHORT[3:])
                self.assertEqual(report["model"]["mesh_by"], "cache" if again else "gmsh")
                self.assertEqual(report["model"]["from_cache"], again or bool(binary))
                self.assertEqual(report["model"]["elements"], 64)
        (self.folder / "all.geo").write_text(f'Include "{SOURCE}/meshes/block.geo";\n')
        scene = self.folder / "include.yaml"
        scene.write_text(SCENE.read_text().replace("../../meshes/block.geo", "all.geo"))
        count = len(self.files())   # gmsh makes it out of the same nodes: the same basis
        for _ in range(2):
            _, report = self.run_scene(*PLAIN, scene=scene, settings=SHORT[:2] + SHORT[3:])
            self.assertTrue(report["model"]["from_cache"])
            self.assertEqual(report["model"]["mesh_by"], "gmsh")
            self.assertIn("draws on more than its own text", json.dumps(report))
        self.assertEqual(len(self.files()), count)


class DryRun(Cached):
    def say(self, *words):
        done = subprocess.run([BIN / "amontons", "run", SCENE, "--dry-run", "-o", self.folder / "dry",
                               "--set", *SHORT, *PLAIN, *words], capture_output=True, text=True,
                              env=dict(os.environ, AMONTONS_CACHE=str(self.cache)), timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertFalse((self.folder / "dry").exists())
        return done.stdout

    def test_dry_run(self):
        """It says how large the run is, makes nothing but the mesh, and knows what the cache holds."""
        said = self.say()
        self.assertIn("64 elements, 9 contact nodes, 162 unknowns", said)
        self.assertIn("reduced before stepping; the reduction is not in the cache", said)
        self.assertRegex(said, r"about [0-9.e-]+ GB of memory")
        self.assertEqual(self.endings(), [".mesh"])
        self.run_scene(*PLAIN)
        self.assertIn("reduced before stepping; the reduction is in the cache", self.say())
        self.assertIn("not reduced: steps are those of the whole mesh", self.say("reduction.use=never"))

    def test_says_how_the_mesh_was_moved(self):
        """In the words of `info`; nothing where the mesh stands as it was drawn."""
        self.assertNotIn("moved", self.say())
        self.assertIn("mesh coordinates times 2\n", self.say("mesh.scale=2"))
        self.assertIn("mesh moved by (0.5, 0)\n", self.say("mesh.shift=[0.5, 0]"))


class Refused(Cached):
    def refused(self, *settings, **environment):
        done = subprocess.run([BIN / "amontons", "run", SCENE, "-o", self.folder / "refused", "--quiet", "--overwrite", "--set", "mesh.set.nx=8",
                               "mesh.set.nz=8", *settings], capture_output=True, text=True, timeout=60,
                              env={**os.environ, "AMONTONS_CACHE": str(self.cache), **environment})
        self.assertEqual(done.returncode, 2, done.stderr)
        return done.stderr

    def test_numbers_too_far_apart(self):
        """Where rounding leaves nothing of a reduction `always` is refused, and it says what goes without."""
        for settings in (["material.poisson=0.4999999999", "material.plane=strain"],
                         ["mesh.set.height=1e6", "rod.height=5e5", "rod.width=1e6"], ["material.eta2=1e12"]):
            said = self.refused(*settings, "reduction.use=always")
            self.assertNotIn("warning", said)   # of a run that has no answer
            for word in ["fig1.yaml", "reduction.use", "auto steps on the whole mesh", "while reducing the bulk"]:
                self.assertIn(word, said)

    def test_not_reduced_where_numbers_are_too_far_apart(self):
        """What `never` does, said so; the cache has nothing of it."""
        far = [*PLAIN, "material.eta2=1e12", "time.until.U=1e-3"]
        never, _ = self.run_scene(*far, "reduction.use=never", cache="")
        for _ in range(2):
            folder, report = self.run_scene(*far)
            self.assertIn("the block is not reduced, steps are those of the whole mesh: while reducing the bulk",
                          "".join(report["warnings"]))
            self.assertEqual(report["model"]["reduced_dofs"], report["model"]["full_dofs"])
            self.assert_same_history(never, folder)
        self.assertEqual(self.endings(), [".mesh"])

    def test_what_cannot_be_reduced(self):
        for setting, words in (("time.scheme=explicit", "explicit steps"), ("material.eta1=0", "without viscosity"),
                               ("start.state=undeformed", "a start")):
            self.assertIn(words, self.refused(setting, "reduction.use=always"))

    def test_limit(self):
        said = self.refused(AMONTONS_CACHE_LIMIT="abc")
        self.assertIn("AMONTONS_CACHE_LIMIT: found `abc`; allowed: a number of bytes", said)


class OneBasis(Cached):
    """Blocks of one shape, whatever their length, step on one basis: made once."""
    LENGTHS = (0.25, 1, 4)

    def settings(self, length):
        return [f"mesh.set={{length: {length}, height: {length / 2}, nx: 10, nz: 10}}",
                f"rod={{velocity: 1e-5, height: {length / 4}, width: {length / 10}}}",
                f"time.until.U={0.0036 * length}", "output.figures=[]", *PLAIN]

    def run_length(self, length, *more, **where):
        return self.run_scene(*more, settings=self.settings(length), **where)

    def test_every_length(self):
        peaks = {}
        for k, length in enumerate(self.LENGTHS):
            folder, report = self.run_length(length)
            self.assertEqual(report["model"]["from_cache"], k > 0)
            self.assertEqual(report["model"]["length"], length)
            again, read = self.run_length(length)
            self.assertEqual(read["model"]["mesh_by"], "cache")
            self.assert_same_history(folder, again)
            alone, made = self.run_length(length, cache="")
            self.assertFalse(made["model"]["from_cache"])
            self.assert_same_history(folder, alone)   # to the last bit, whoever made the basis
            peaks[length] = [peak["mu"] for peak in report["results"]["peaks"]]
        self.assertEqual(self.endings(), [".basis"] + 3 * [".mesh"])
        self.assertGreater(peaks[0.25][0], 1.02 * peaks[4][0])   # they are not the same block

    def test_against_the_full_mesh(self):
        self.run_length(1)
        for length in (0.25, 4):
            _, report = self.run_length(length)
            self.assertTrue(report["model"]["from_cache"])
            _, full = self.run_length(length, "reduction.use=never")
            mine, wanted = ([peak["mu"] for peak in one["results"]["peaks"]]
                            for one in (report, full))
            self.assertGreater(len(wanted), 0)
            np.testing.assert_allclose(mine, wanted, rtol=1e-3)
            # At L = 4 waves are as short as these elements: what is said there is what is allowed.
            self.assertLess(report["errors"]["reduction"], 0.09 if length == 4 else 0.002)
            self.assertGreater(report["errors"]["reduction"], 1e-7)
            self.assertEqual(full["errors"]["reduction"], 0)

    def test_another_shape(self):
        """A rod that is not scaled along, or other proportions, need their own."""
        self.run_length(1)
        for setting in ("rod.height=0.3", "mesh.set.height=0.6", "material.poisson=0.3",
                        "material.eta2=0.5"):
            self.assertFalse(self.run_length(1, setting)[1]["model"]["from_cache"], setting)

    def test_fields(self):
        self.run_length(1, "output.fields={every_U: 5e-3}")
        folder, report = self.run_length(4, "output.fields={every_U: 5e-3}")
        self.assertTrue(report["model"]["from_cache"])
        alone, _ = self.run_length(4, "output.fields={every_U: 5e-3}", cache="")
        self.assert_same_fields(folder, alone)


class NotTrusted(Cached):
    def spoil(self, ending, change):
        path, = self.cache.glob("*" + ending)
        path.write_bytes(change(path.read_bytes()))

    def assert_rebuilt(self, reason, *settings):
        first = self.folder / "run-1"
        folder, report = self.run_scene(*settings)
        self.assertFalse(report["model"]["from_cache"])
        self.assertIn(reason, report["model"]["cache_note"])
        self.assert_same_history(first, folder)
        again = self.model(*settings)   # and put right
        self.assertTrue(again["from_cache"])
        self.assertIsNone(again["cache_note"])

    def test_spoilt_files(self):
        self.run_scene(*PLAIN)
        half = lambda data: data[:len(data) // 2]
        flip = lambda data: data[:5000] + bytes([data[5000] ^ 1]) + data[5001:]
        older = lambda data: data.replace(b"amontons-cache 6", b"amontons-cache 5", 1)
        for change, reason in ((half, "cut off"), (flip, "checksum"), (older, "version"),
                               (lambda data: b"", "version"),
                               (lambda data: data + b"x", "checksum")):
            self.spoil(".basis", change)
            self.assert_rebuilt(reason, *PLAIN)

    def test_spoilt_mesh(self):
        """It is made again, its basis is not."""
        first, _ = self.run_scene(*PLAIN)
        self.spoil(".mesh", lambda data: data[:-1])
        for mesh_by in ("gmsh", "cache"):   # and put right
            folder, report = self.run_scene(*PLAIN)
            self.assertEqual((report["model"]["mesh_by"], report["model"]["from_cache"]), (mesh_by, True))
            self.assert_same_history(first, folder)

    def test_spoilt_modes(self):
        self.run_scene(*FIELDS)
        self.spoil(".modes", lambda data: data[:-1])
        self.assertTrue(self.model(*PLAIN)["from_cache"])   # not asked for
        self.assert_rebuilt("cut off", *FIELDS)
        path, = self.cache.glob("*.modes")
        path.unlink()
        folder, report = self.run_scene(*FIELDS)
        self.assertFalse(report["model"]["from_cache"])
        self.assert_same_fields(self.folder / "run-1", folder)

    def test_nowhere_to_write(self):
        (self.folder / "file").write_text("")
        model = self.model(*PLAIN, cache=self.folder / "file" / "cache")
        self.assertFalse(model["from_cache"])
        self.assertIn("is not kept for the next run", model["cache_note"])
        if os.path.isdir("/proc/self"):   # a folder in which not even root makes files
            self.assertIn("is not kept", self.model(*PLAIN, cache="/proc/self")["cache_note"])

    def test_full_disk(self):
        """A limit on file sizes stands in for a full disk: results fit, the basis does not."""
        folder = self.folder / "small"
        done = subprocess.run(
            ["bash", "-c", "trap '' XFSZ; ulimit -f 20; exec \"$@\"", "-", BIN / "amontons", "run",
             SCENE, "-o", folder, "--quiet", "--set", *SHORT, *PLAIN, "output.history=false"],
            env=dict(os.environ, AMONTONS_CACHE=str(self.cache)), capture_output=True, text=True,
            timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        note = json.loads((folder / "run.json").read_text())["model"]["cache_note"]
        self.assertIn("is not kept for the next run", note)
        self.assertIn("File too large", note)
        self.assertEqual(self.endings(), [".mesh"])   # some kilobytes: there was room

    def test_side_by_side(self):
        """Four first runs at once: all go well, one builds the basis and the others read it, one
        basis is left and no lock."""
        environment = dict(os.environ, AMONTONS_CACHE=str(self.cache))
        runs = [subprocess.Popen([BIN / "amontons", "run", SCENE, "-o", self.folder / f"side-{k}",
                                  "--quiet", "--set", *SHORT, *PLAIN], env=environment)
                for k in range(4)]
        self.assertEqual([run.wait(60) for run in runs], [0] * 4)
        self.assertEqual(self.endings(), [".basis", ".mesh"])
        self.assertTrue(self.model(*PLAIN)["from_cache"])
        reports = [json.loads((self.folder / f"side-{k}" / "run.json").read_text())
                   for k in range(4)]
        self.assertEqual(sorted(report["model"]["from_cache"] for report in reports),
                         [False, True, True, True])
        for k in range(1, 4):
            self.assert_same_history(self.folder / "side-0", self.folder / f"side-{k}")
            self.assertIsNone(reports[k]["model"]["cache_note"])


class Command(Cached):
    def ask(self, *words, cache=None):
        environment = dict(os.environ, AMONTONS_CACHE=str(self.cache if cache is None else cache))
        done = subprocess.run([BIN / "amontons", "cache", *words], env=environment, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def test_lists_and_cleans(self):
        self.run_scene(settings=[*SHORT, *PLAIN])
        files = self.files()
        said = self.ask()
        size = sum(path.stat().st_size for path in files)
        self.assertIn(f"{self.cache}: {len(files)} files, {size / 1e6:.1f} MB; at most 2000.0 MB are kept\n", said)
        for path in files:
            self.assertIn(f" {path.name}\n", said)
        (self.cache / "of the user").touch()
        self.assertIn(f"removed {len(files)} files", self.ask("--clean"))
        self.assertEqual([path.name for path in self.files()], ["of the user"])
        self.assertIn(": 0 files", self.ask())
        self.assertIn("there is no cache", self.ask(cache=""))

    def test_cleans_locks(self):
        """Of a killed process they are empty, and go; what a running process holds stays, and is no failure."""
        self.cache.mkdir()
        killed, held, part = (self.cache / (letter * 32 + ending) for letter, ending in
                              (("a", ".lock"), ("b", ".lock"), ("c", ".basis.part")))
        killed.touch()
        self.assertIn("removed 1 files", self.ask("--clean"))
        self.assertEqual(self.files(), [])
        (self.cache / ("d" * 32 + ".mesh")).write_bytes(b"x" * 100)
        for path in (killed, held, part):
            path.touch()
        with held.open("r+b") as one, part.open("r+b") as other:
            fcntl.flock(one, fcntl.LOCK_EX)
            fcntl.flock(other, fcntl.LOCK_EX)
            self.assertIn("removed 2 files", self.ask("--clean"))
            self.assertEqual(self.files(), [held, part])


if __name__ == "__main__":
    unittest.main()
