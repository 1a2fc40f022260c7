# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python module against the program: the same numbers, to the bit; its structs against the compiler's; views without
copies; errors with file, line and key; Ctrl-C; pictures and tables."""
import base64
import csv
import copy
import ctypes
import gc
import importlib.util
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import types
import unittest
import unittest.mock
from pathlib import Path

import numpy as np
from scipy.integrate import trapezoid

from sanitizer_fixture import begin_again_with

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BIN = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin"))
MODULE = BIN.resolve().parent / "python"
sys.path.insert(0, str(MODULE))
begin_again_with(BIN / "libamontons.so")
import amontons                         # noqa: E402
from amontons import _structs           # noqa: E402

FIG1 = SOURCE / "validation" / "paper" / "fig1.yaml"
SMALL = {"mesh.set.nx": 8, "mesh.set.nz": 8, "time.until": {"U": 0.004}, "output.fields": None, "output.figures": []}
HEADERS = ["amontons_simulation.h", "amontons_stability.h", "amontons_model1d.h", "amontons_optimise.h", "amontons_cache.h"]


def has(module):
    return importlib.util.find_spec(module) is not None


class Built(unittest.TestCase):
    @unittest.skipUnless((MODULE.parent / "build.ninja").exists() and shutil.which("ninja"), "not built by ninja")
    def test_whoever_builds_the_program_has_the_module(self):
        """./amontons demo builds the target `amontons` alone; docs/python.md says that the module is there then."""
        inputs = subprocess.run(["ninja", "-C", MODULE.parent, "-t", "graph", "amontons"], capture_output=True, text=True, check=True)
        for name in ("__init__.py", "_structs.py"):
            self.assertIn(f"python/amontons/{name}", inputs.stdout)


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-python-"))
        self.addCleanup(shutil.rmtree, self.folder)


class Structs(InFolder):
    def test_as_the_compiler_lays_them_out(self):
        structs = {name: kind for name, kind in vars(_structs).items()
                   if isinstance(kind, type) and issubclass(kind, ctypes.Structure) and name != "Structure"}
        self.assertGreater(len(structs), 15)
        lines = []
        for name, struct in structs.items():
            lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
            lines += [f'printf("{name}.{field} %zu %zu\\n", offsetof({name}, {field}), sizeof((({name} *)0)->{field}));'
                      for field, *_ in struct._fields_]
        program = self.folder / "sizes"
        text = "".join(f'#include "{header}"\n' for header in HEADERS) + "#include <stddef.h>\nint main(void)\n{\n"
        subprocess.run(["cc", f"-I{SOURCE / 'src'}", "-x", "c", "-", "-o", program], check=True, text=True,
                       input=text + "\n".join(lines) + "\n}\n")
        said = dict(line.split(" ", 1) for line in subprocess.run([program], capture_output=True, text=True,
                                                                  check=True).stdout.splitlines())
        for name, struct in structs.items():
            self.assertEqual(said.pop(name), str(ctypes.sizeof(struct)), name)
            for field, *_ in struct._fields_:
                place = getattr(struct, field)
                self.assertEqual(said.pop(f"{name}.{field}"), f"{place.offset} {place.size}", f"{name}.{field}")
        self.assertEqual(said, {})

    def test_all_functions_are_known(self):
        listing = subprocess.run(["nm", "-D", "--defined-only", BIN / "libamontons.so"], capture_output=True, text=True,
                                 check=True).stdout
        self.assertEqual({line.split()[-1] for line in listing.splitlines() if " amontons_" in line},
                         set(_structs.FUNCTIONS))
        self.assertIn("[count] stress", _structs.ContactView.__doc__)

    @unittest.skipUnless(shutil.which("mypy"), "no mypy here")
    def test_types(self):
        done = subprocess.run(["mypy", "--ignore-missing-imports", "--cache-dir", self.folder, MODULE / "amontons"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)


class Run(InFolder):
    def test_same_as_the_program(self):
        words = [word for key, value in SMALL.items() for word in
                 ("--set", f"{key}={'none' if value is None else json.dumps(value)}")]
        subprocess.run([BIN / "amontons", "run", FIG1, *words, "-q", "-o", self.folder / "program"], check=True)
        program = amontons.open_result(self.folder / "program")
        seen = []
        module = amontons.run(FIG1, SMALL, self.folder / "module", progress=lambda step: seen.append((step.U, step.mu)))
        self.assertEqual(list(program.history), list(module.history))
        for name in program.history:
            self.assertEqual(program.history[name].tobytes(), module.history[name].tobytes(), name)
        self.assertEqual(program.report["results"]["mu_max"], module.mu_max)
        self.assertEqual(program.mu_max, module.mu_max)
        self.assertEqual(module.history.mu.max(), module.mu_max)
        self.assertEqual(np.array(seen)[:, 1].tobytes(), module.history.mu.tobytes())
        self.assertEqual(module.counters["accepted"] + 1, len(module.history.U))
        self.assertIs(module.history.slip_rate, module.history["interface/slip_rate"])
        self.assertEqual(module.history.numbers["mu_static"], 0.38)
        with self.assertRaisesRegex(AttributeError, "series/mu"):
            module.history.no_such_array

    def test_reduces_as_the_program_does(self):
        """The program has OpenMP and the allocator its own way, a host's are the host's (docs/library.md)."""
        keys = {**SMALL, "mesh.set.nx": 24, "mesh.set.nz": 24, "reduction.use": "always", "reduction.cache": False,
                "time.until": {"U": 2e-4}}
        words = [f"{key}={'none' if value is None else json.dumps(value)}" for key, value in keys.items()]
        subprocess.run([BIN / "amontons", "run", FIG1, "-q", "-o", self.folder / "program", "--set", *words], check=True)
        call = f"import amontons; amontons.run({str(FIG1)!r}, {keys!r}, {str(self.folder / 'module')!r})"
        subprocess.run([sys.executable, "-c", call], check=True, env={**os.environ, "PYTHONPATH": str(MODULE), "OMP_NUM_THREADS": "4"})
        program, module = (amontons.open_result(self.folder / name) for name in ("program", "module"))
        self.assertFalse(module.report["model"]["from_cache"])
        self.assertLess(module.report["model"]["reduced_dofs"], module.report["model"]["full_dofs"])
        for name in program.history:
            self.assertEqual(program.history[name].tobytes(), module.history[name].tobytes(), name)

    def test_without_a_folder(self):
        result = amontons.run(FIG1, {**SMALL, "output.fields": {"every_U": 2e-3}})
        folder = result.folder
        self.assertTrue(result.history.mu.max() > 0.3)
        self.assertGreaterEqual(len(result.fields), 2)
        self.assertTrue(all(field.bulk.is_file() and field.interface.is_file() for field in result.fields))
        del result
        gc.collect()
        self.assertFalse(folder.exists())

    def test_errors_carry_file_line_and_key(self):
        scene = self.folder / "wrong.yaml"
        scene.write_text("title: x\nload:\n  pressure: -3\n")
        with self.assertRaises(amontons.InputError) as caught:
            amontons.run(scene)
        failure = caught.exception
        self.assertEqual((failure.file, failure.line, failure.column, failure.key), (str(scene), 3, 13, "load.pressure"))
        self.assertIsInstance(failure, ValueError)
        with self.assertRaisesRegex(amontons.AmontonsError, "did you mean `load.pressure`") as caught:
            amontons.static(FIG1, {"load.presure": 1})
        self.assertEqual(caught.exception.key, "load.presure")
        with self.assertRaises(amontons.ComputeError) as caught:
            amontons.run(FIG1, {**SMALL, "time.energy_tolerance": 1e-14})
        self.assertIsNone(caught.exception.line)
        amontons.run(FIG1, SMALL, self.folder / "there")
        with self.assertRaisesRegex(amontons.InputError, "there"):
            amontons.run(FIG1, SMALL, self.folder / "there")

    def test_a_zero_byte(self):
        """C would take the text before it, and write there."""
        result = amontons.run(FIG1, SMALL, self.folder / "run")
        simulation = amontons.Simulation(FIG1, SMALL)
        cut = f"{self.folder}/cut\0off"
        for call in (lambda: amontons.run(FIG1, SMALL, cut), lambda: amontons.run(cut), lambda: amontons.info(cut),
                     lambda: amontons.run(FIG1, {**SMALL, "title": "a\0b"}), lambda: simulation.save(cut),
                     lambda: simulation.restore(cut), lambda: amontons.static(FIG1, SMALL, cut),
                     lambda: amontons.film(result, cut + ".gif"), lambda: amontons.film(result, "film.gif", to="U=1\0"),
                     lambda: amontons.render(result, ["force\0"]), lambda: amontons.render(result, ["force"], format="png\0"),
                     lambda: amontons.render_plot(cut, "a.png"), lambda: amontons.info(FIG1, picture=cut),
                     lambda: amontons.sweep(cut, folder=self.folder / "sweep")):
            with self.assertRaisesRegex(amontons.InputError, "zero byte"):
                call()
        self.assertEqual([path.name for path in self.folder.iterdir()], ["run"])

    @unittest.skipUnless(has("h5py"), "no h5py here")
    def test_histories_of_strangers(self):
        """Forty groups in one another, each with two links to the next: 2^40 ways, of which one is gone; links that leave the file."""
        import h5py
        path = self.folder / "history.h5"
        with h5py.File(path, "w") as file:
            file["series/time"] = [0.0, 1.0]
            group = file
            for _ in range(40):
                inner = group.create_group("a")
                group["b"] = inner
                group = inner
            group["last"] = [2.0]
        history = amontons.open_result(self.folder).history
        self.assertEqual(list(history["series/time"]), [0, 1])
        self.assertEqual(len(history), 2)
        del history
        for link in (h5py.SoftLink("/series/time"), h5py.ExternalLink("/etc/passwd", "/x")):
            path.unlink()
            with h5py.File(path, "w") as file:
                file["series/time"] = [0.0, 1.0]
                file["series/mu"] = link
            with self.assertRaisesRegex(ValueError, "history.h5: series/mu is a link by name"):
                amontons.open_result(self.folder).history
        path.unlink()
        with h5py.File(path, "w") as file:
            file.create_dataset("x", (2,), "f8", external=[(str(self.folder / "other"), 0, 16)])
        with self.assertRaisesRegex(ValueError, "the data of .*history.h5: x lie in another file"):
            amontons.open_result(self.folder).history

    def test_odd_calls(self):
        """Each crashed, or took None for a name."""
        simulation = amontons.Simulation(FIG1, SMALL)
        result = self.folder / "nothing"
        for call in (lambda: amontons.film(result, "x.mp4", of=5), lambda: amontons.film(result, "x.mp4", stop=5), lambda: amontons.film(result, None),
                     lambda: amontons.render(None), lambda: amontons.render(result, "force"), lambda: amontons.render(result, at=5),
                     lambda: amontons.run(None), lambda: amontons.run(FIG1, SMALL, 5), lambda: amontons.open_result(None),
                     lambda: amontons.info(None), lambda: amontons.static(FIG1, SMALL, 5), lambda: amontons.sweep(5),
                     lambda: amontons.run(FIG1, ["load.pressure"]), lambda: amontons.stability(FIG1, "a"),
                     lambda: amontons.render_plot("a.yaml", None), lambda: copy.copy(simulation), lambda: copy.deepcopy(simulation)):
            with self.assertRaises(TypeError):
                call()
        with self.assertRaisesRegex(FileNotFoundError, "no run.json and no history.h5"):    # opened, with no answers
            amontons.open_result(self.folder)
        self.assertEqual(amontons.run(FIG1, SMALL, os.fsencode(self.folder / "bytes")).folder, self.folder / "bytes")
        simulation.advance()
        simulation.__del__()
        for call in (lambda: list(simulation), simulation.advance, simulation.save, simulation.finish, lambda: simulation.position,
                     lambda: simulation.set_pressure(1.0)):
            with self.assertRaisesRegex(ValueError, "closed"):
                call()

    def test_arrays_outlive_their_simulation(self):
        """They keep the library's memory, as a step's contact does; nobody can write there."""
        simulation = amontons.Simulation(FIG1, SMALL)
        for _ in range(5):
            step = simulation.advance()
        arrays = [simulation.x, simulation.pressure, simulation.slip_rate, simulation.status]
        kept, first = [array.copy() for array in arrays], step.contact.pressure[0]
        simulation.__del__()
        again = [amontons.Simulation(FIG1, SMALL) for _ in range(3)]   # takes what was freed
        for array, before in zip((simulation.x, simulation.pressure, *arrays[2:]), kept):
            np.testing.assert_array_equal(array, before)
        del simulation, again
        for array, before in zip(arrays, kept):
            np.testing.assert_array_equal(array, before)
            with self.assertRaises(ValueError):
                array.flags.writeable = True
        contact = step.contact
        del arrays, step, array
        gc.collect()
        self.assertEqual(contact.pressure[0], first)

    def test_what_a_callback_raises_comes_through(self):
        def give_up(step):
            if step.U > 1e-3:
                raise ZeroDivisionError("enough")
        with self.assertRaisesRegex(ZeroDivisionError, "enough"):
            amontons.run(FIG1, SMALL, self.folder / "part", progress=give_up)
        report = amontons.open_result(self.folder / "part").report
        self.assertEqual((report["status"], report["failure"]), ("failed", "interrupted"))

    def interrupt(self, work):
        """Ctrl-C once `work` has said that it is under way; what the process prints then."""
        script = textwrap.dedent(f"""
            import sys; sys.path.insert(0, {str(MODULE)!r})
            import amontons
            try:
                {work}
            except KeyboardInterrupt:
                print("stopped", flush=True)
        """)
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, cwd=self.folder)
        self.assertEqual(process.stdout.readline(), "begun\n")
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, 0)
        return said

    def test_ctrl_c(self):
        long_run = {**SMALL, "time.until": {"U": 10}}
        said = self.interrupt(f"amontons.run({str(FIG1)!r}, {long_run!r}, 'long', "
                              "progress=lambda step: step.t == 0 and print('begun', flush=True))")
        self.assertEqual(said, "stopped\n")
        self.assertEqual(amontons.open_result(self.folder / "long").report["failure"], "interrupted")

    def test_ctrl_c_again_while_it_reduces(self):
        """None leaves before the library's thread has ended: it would go on over a scene that is gone."""
        large = {**SMALL, "mesh.set.nx": 200, "mesh.set.nz": 200, "reduction.use": "always", "reduction.cache": False}
        script = textwrap.dedent(f"""
            import sys; sys.path.insert(0, {str(MODULE)!r})
            import amontons, signal, threading, time
            try:
                threading.Timer(0.3, print, ("begun",), {{"flush": True}}).start()
                amontons.run({str(FIG1)!r}, {large!r}, "large")
            except KeyboardInterrupt:
                signal.signal(signal.SIGINT, signal.SIG_IGN)      # one that comes while Python itself ends is not about the library
                print("stopped", [thread.name for thread in threading.enumerate()], flush=True)
        """)
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, cwd=self.folder)
        self.assertEqual(process.stdout.readline(), "begun\n")
        for _ in range(5):
            process.send_signal(signal.SIGINT)
            time.sleep(0.02)
        said = process.communicate(timeout=120)[0]
        self.assertEqual((process.returncode, said), (0, "stopped ['MainThread']\n"))
        self.assertEqual(amontons.open_result(self.folder / "large").report["failure"], "interrupted")

    def test_ctrl_c_between_steps(self):
        said = self.interrupt(f"[print('begun', flush=True) for k, step in enumerate(amontons.Simulation({str(FIG1)!r}, "
                              f"{ {**SMALL, 'time.until': {'U': 10}}!r})) if k == 0]")
        self.assertEqual(said, "stopped\n")


class Stepped(InFolder):
    def test_views_follow_the_steps(self):
        result = amontons.run(FIG1, SMALL, self.folder / "run")
        history = result.history
        simulation = amontons.Simulation(FIG1, SMALL)
        self.assertEqual(simulation.x.tobytes(), history.x.tobytes())
        place = simulation.slip_rate.__array_interface__["data"][0]
        mu, rates, status = [simulation.step.mu], [simulation.slip_rate.copy()], [simulation.status.copy()]
        for step in simulation:
            mu.append(step.mu)
            rates.append(simulation.slip_rate.copy())
            status.append(simulation.status.copy())
        self.assertEqual(np.array(mu).tobytes(), history.mu.tobytes())
        self.assertEqual(np.array(rates, dtype="f4").tobytes(), history.slip_rate.tobytes())   # stored as float32
        self.assertEqual(np.array(status).tobytes(), history.status.tobytes())
        self.assertEqual(simulation.slip_rate.__array_interface__["data"][0], place)
        self.assertTrue(simulation.finished)
        self.assertEqual(simulation.finish().mu_max, result.mu_max)
        with self.assertRaises(ValueError):
            simulation.slip[0] = 1

    def test_nothing_follows_the_end(self):
        """Its history is closed."""
        simulation = amontons.Simulation(FIG1, SMALL, self.folder / "run")
        simulation.advance()
        state, mu = simulation.save(), simulation.step.mu
        simulation.finish()
        written = (self.folder / "run/run.json").read_bytes()
        for more in (simulation.advance, lambda: next(iter(simulation)), simulation.finish, simulation.save,
                     lambda: simulation.restore(state), lambda: simulation.set_rod_velocity(0),
                     lambda: simulation.set_pressure(1)):
            with self.assertRaisesRegex(amontons.InputError, "is finished"):
                more()
        self.assertEqual((simulation.step.mu, (self.folder / "run/run.json").read_bytes()), (mu, written))

    def test_arrays_outlive_the_name(self):
        pressure = amontons.Simulation(FIG1, SMALL).pressure
        gc.collect()
        self.assertAlmostEqual(pressure.mean(), 0.003, delta=0.001)

    def test_states_are_put_back(self):
        """As bytes and from a file, here and in another simulation; a run in a folder goes on as well."""
        simulation, other = (amontons.Simulation(FIG1, SMALL) for _ in range(2))
        for _ in range(100):
            simulation.advance()
        state = simulation.save(self.folder / "state")
        self.assertEqual(state, (self.folder / "state").read_bytes())
        for _ in range(60):
            simulation.advance()
        slip, mu = simulation.slip.copy(), simulation.step.mu
        for one, given in ((simulation, state), (other, self.folder / "state")):
            one.restore(given)
            for _ in range(60):
                one.advance()
            self.assertEqual((one.step.mu, one.slip.tolist()), (mu, slip.tolist()))
        with self.assertRaisesRegex(amontons.InputError, "checksum"):
            other.restore(state[:-40] + bytes(40))
        whole = amontons.run(FIG1, SMALL)
        amontons.run(FIG1, {**SMALL, "time.until": {"U": 0.001}}, self.folder / "cut")
        cut = amontons.run(FIG1, SMALL, self.folder / "cut", resume=True)
        self.assertAlmostEqual(cut.history.U[-1], whole.history.U[-1], delta=1e-5)

    def test_steering(self):
        simulation = amontons.Simulation(FIG1, {**SMALL, "reduction.use": "never"})
        for step in simulation:
            if step.U > 1e-3:
                break
        U, t = step.U, step.t
        simulation.set_rod_velocity(5e-5)
        step = simulation.advance()
        self.assertAlmostEqual(step.U, U + 5e-5 * (step.t - t), places=15)
        simulation.set_pressure(0.006)
        for step in simulation:
            if step.t > t + 30:
                break
        self.assertAlmostEqual(trapezoid(simulation.pressure, simulation.x), 0.006, delta=3e-4)
        with self.assertRaisesRegex(amontons.InputError, "above 0"):
            simulation.set_pressure(-1)
        with self.assertRaisesRegex(amontons.InputError, "rod velocity of -1e\\+308 is not possible"):
            simulation.set_rod_velocity(-1e308)

    def test_whole_block(self):
        simulation = amontons.Simulation(FIG1, SMALL, whole_block=True)
        start = simulation.displacement
        for _ in simulation:
            pass
        moved = simulation.displacement - start
        floor = np.flatnonzero(simulation.position[:, 1] < 1e-9)
        floor = floor[np.argsort(simulation.position[floor, 0])]
        np.testing.assert_allclose(moved[floor, 0], simulation.slip, atol=1e-15)
        self.assertEqual((moved.shape, len(simulation.elements)), ((81, 2), 64))
        self.assertEqual(simulation.velocity.shape, (81, 2))
        with self.assertRaisesRegex(amontons.InputError, "whole_block"):
            amontons.Simulation(FIG1, SMALL).displacement


class Commands(InFolder):
    def program(self, *words):
        done = subprocess.run([BIN / "amontons", *map(str, words)], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_forecast(self):
        """Numbers of the mesh as in the run that follows."""
        expected = amontons.forecast(FIG1, SMALL)
        model = amontons.run(FIG1, SMALL).report["model"]
        self.assertEqual((expected.contact_nodes, expected.unknowns), (model["contact_nodes"], model["full_dofs"]))
        said = self.program("run", FIG1, "--dry-run", *[
            word for key, value in SMALL.items()
            for word in ("--set", f"{key}={'none' if value is None else json.dumps(value)}")])
        self.assertIn(f"{expected.elements} elements, {expected.contact_nodes} contact nodes", said)
        self.assertTrue(expected.reduced)
        self.assertIn("reduced before stepping", said)
        with self.assertRaisesRegex(amontons.InputError, "pressure"):
            amontons.forecast(FIG1, {"load.pressure": "much"})

    def test_static(self):
        scene = SOURCE / "validation/freefem/friction.yaml"
        answer = amontons.static(scene, folder=self.folder / "static")
        report = json.loads((self.folder / "static/static.json").read_text())
        self.assertEqual(answer.shear_force, report["results"]["shear_force"])
        self.assertEqual(answer.sticking + answer.slipping + answer.open, report["model"]["contact_nodes"])
        self.assertIn("shear_force=", repr(answer))

    def test_stability(self):
        answer = amontons.stability(FIG1, SMALL, self.folder / "path", slidings=0)
        report = json.loads((self.folder / "path/stability.json").read_text())
        self.assertIn(answer.l_c, list(report["results"].values()))
        self.assertEqual(len(answer.points), answer.as_dict()["points"])
        self.assertTrue((np.diff(answer.points["front"]) >= 0).all())

    def test_optimise(self):
        """The best is the row of the table with the largest value."""
        study = self.folder / "study.yaml"
        study.write_text(f"scene: {FIG1}\nset: {{mesh.set.nx: 8, mesh.set.nz: 8, time.until.U: 0.02}}\nrank: {{by: mu_max}}\n"
                         "search: {load.pressure: {log: [0.003, 0.006]}}\nbest: {designs: 3}\n")
        seen = []
        found = amontons.optimise(study, folder=self.folder / "best", progress=lambda view: seen.append(view.words))
        rows = list(csv.DictReader(open(self.folder / "best/sweep.csv", newline="")))
        best = max(rows, key=lambda row: float(row["mu_max"]))
        self.assertEqual(found["best"], {"load.pressure": float(best["load.pressure"])})
        self.assertAlmostEqual(found["value"], float(best["mu_max"]), places=9)
        self.assertEqual((found["designs"], found["computed"]), (len(rows), len(seen)))

    def test_model1d(self):
        answer = amontons.model1d(FIG1, theory_only=True, folder=self.folder / "line")
        report = json.loads((self.folder / "line/model1d.json").read_text())
        self.assertTrue(any(answer.l_c in part.values() for part in report.values() if isinstance(part, dict)))
        self.assertGreater(len(answer.points), 10)

    def test_sweep(self):
        study = self.folder / "study.yaml"
        settings = ", ".join(f"{key}: {'none' if value is None else json.dumps(value)}" for key, value in SMALL.items())
        study.write_text(f"scene: {FIG1}\nset: {{{settings}}}\nvary: {{load.pressure: [0.002, 0.006]}}\n"
                         "record: [mu_max]\n")
        ended = []
        table = amontons.sweep(study, folder=self.folder / "sweep", jobs=2,
                               progress=lambda view: ended.append(view.finished))
        self.assertEqual(ended, [1, 2])
        self.assertEqual(list(table["load.pressure"]), [0.002, 0.006])
        mu = amontons.run(FIG1, {**SMALL, "load.pressure": 0.006}).mu_max
        self.assertAlmostEqual(table["mu_max"][1], mu, places=8)
        if has("pandas"):
            self.assertEqual(type(table).__name__, "DataFrame")
        sys.modules["pandas"] = None   # as where it is not installed
        try:
            plain = amontons.read_table(self.folder / "sweep/sweep.csv")
        finally:
            del sys.modules["pandas"]
        self.assertIsInstance(plain, dict)
        self.assertEqual(list(plain["mu_max"]), list(table["mu_max"]))

    def test_info_and_keys(self):
        self.assertEqual(amontons.keys(), self.program("info", "keys"))
        self.assertEqual(amontons.info(FIG1, SMALL), self.program("info", FIG1, *[
            word for key, value in SMALL.items()
            for word in ("--set", f"{key}={'none' if value is None else json.dumps(value)}")]))
        amontons.info(FIG1, SMALL, picture=self.folder / "mesh.png")
        self.assertEqual((self.folder / "mesh.png").read_bytes()[:4], b"\x89PNG")
        self.assertEqual(amontons.data_folder(), SOURCE)
        self.assertIn(amontons.version(), self.program("--version"))

    def test_kernels_beside_numpy(self):
        """numpy came first, with kernels of its choice: it is one library, and what a host has chosen stays."""
        script = (f"import os; import numpy; del os.environ['OPENBLAS_CORETYPE']; import sys; sys.path.insert(0, {str(MODULE)!r}); "
                  "a = numpy.arange(4e4).reshape(200, 200) % 7; before = a @ a; import amontons; "
                  "print(amontons.kernels(), (a @ a == before).all())")   # whole numbers are not rounded
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=self.folder,
                              env=os.environ | {"OPENBLAS_CORETYPE": "Prescott"})
        self.assertRegex(done.stdout, r"^Prescott True\n$")

    def test_pictures(self):
        result = amontons.run(FIG1, SMALL, self.folder / "run")
        self.assertGreater(result.history.mu.max(), 0.01)     # from now on h5py has the file open, too
        self.assertEqual([path.name for path in amontons.render(result, ["force"])], ["force.png"])
        half = result.history.U[-1] / 2
        (self.folder / "measured.csv").write_text(f"U,mu\n{half},{np.interp(half, result.history.U, result.history.mu) + 0.01}\n1,0.3\n")
        found = amontons.compare(result, self.folder / "measured.csv", overwrite=True)
        self.assertEqual([found[name][0] for name in ("figure", "points", "covered")], ["force", 2, 1])
        self.assertAlmostEqual(found["misfit"][0], 0.01, delta=1e-6)
        made = amontons.film(result, self.folder / "frames", seconds=0.2, rate=10, width=640, height=360, to="U=0.001")
        self.assertEqual(sorted(path.name for path in made.iterdir()), ["amontons.files", "frame-0001.png", "frame-0002.png"])
        with self.assertRaisesRegex(amontons.InputError, ".mp4, .webm or .gif"):
            amontons.film(result, self.folder / "film.avi")
        if not has("matplotlib"):
            self.skipTest("no matplotlib here")
        import matplotlib
        matplotlib.use("Agg")
        axes = result.plot_force()
        line = axes.lines[0].get_xydata()
        np.testing.assert_array_equal(line[:, 1], result.history.mu)
        axes.figure.savefig(self.folder / "force.png")
        result.plot_slip_map().figure.savefig(self.folder / "map.png")

    @unittest.skipUnless(has("pandas"), "no pandas here")
    def test_tables(self):
        probes = {"a": {"at": [0.3, 0.1]}, "b 2": {"at": [0.6, 0.2]}}
        result = amontons.run(FIG1, {**SMALL, "time.until": {"U": 0.004}, "output.probes": probes})
        table, history = result.history.to_pandas(), result.history
        self.assertEqual(history.probes, ["a", "b 2"])
        self.assertEqual(table.index.name, "t")
        np.testing.assert_array_equal(table.index, history.t)
        np.testing.assert_array_equal(table["U"], history.U)
        np.testing.assert_array_equal(table["mu"], history.mu)
        np.testing.assert_array_equal(table["b 2 strain_xz"], history["probes/strain"][:, 1, 2])
        np.testing.assert_array_equal(table["a displacement_z"], history.displacement[:, 0, 1])
        np.testing.assert_array_equal(table["pads contact normal_force"], history["pads/normal_force"])
        events = result.to_pandas("events")
        self.assertEqual(list(events["U_start"]), [event["U_start"] for event in result.events])
        self.assertEqual(len(result.to_pandas("pads")), len(result.pads))
        with self.assertRaisesRegex(ValueError, "there are: events, peaks, pads, pad_slidings"):
            result.to_pandas("nothing")

    def test_no_pandas(self):
        result = amontons.run(FIG1, {**SMALL, "time.until": {"U": 0.001}})
        with unittest.mock.patch.dict(sys.modules, {"pandas": None}):
            for table in (result.history.to_pandas, result.to_pandas):
                with self.assertRaisesRegex(ImportError, "python3-pandas"):
                    table()

    def test_notebook(self):
        """What Jupyter asks of an object; IPython stands in for itself."""
        shown = []

        class Handle:
            def update(self, html):
                shown.append(html)

        display = types.ModuleType("IPython.display")
        display.HTML, display.display = str, lambda html, display_id: Handle()
        with unittest.mock.patch.dict(sys.modules, {"IPython": types.ModuleType("IPython"), "IPython.display": display}):
            result = amontons.run(FIG1, {**SMALL, "title": "A <block>", "output.figures": ["force"]}, self.folder / "shown",
                                  progress=amontons.NotebookProgress())
        self.assertIn("F_T/F_N", shown[0])
        self.assertIn(f"U = {result.history.U[-1]:.6g}", shown[-1])
        page, picture = result._repr_html_(), (self.folder / "shown" / "figures" / "force.png").read_bytes()
        self.assertEqual(result._repr_png_(), picture)
        self.assertIn(base64.b64encode(picture).decode(), page)
        self.assertIn("A &lt;block&gt;: done", page)
        self.assertIn("mu_max", page)
        self.assertIsNone(amontons.run(FIG1, SMALL)._repr_png_())
        simulation = amontons.Simulation(FIG1, SMALL)
        simulation.advance()
        self.assertIn(f"U = {simulation.step.U:.6g}", simulation._repr_html_())
        with unittest.mock.patch.dict(sys.modules, {"IPython": None, "IPython.display": None}):
            with self.assertRaisesRegex(ImportError, "IPython"):
                amontons.NotebookProgress()

    def test_cache(self):
        os.environ["AMONTONS_CACHE"] = str(self.folder / "cache")
        try:
            amontons.run(FIG1, SMALL)
            files = sorted(path.name for path in (self.folder / "cache").iterdir())
            found = amontons.cache()
            self.assertEqual(sorted(name for name, *_ in found["entries"]), files)
            self.assertEqual(found["bytes"], sum(size for _, size, _ in found["entries"]))
            self.assertEqual((amontons.clean_cache()["files"], amontons.cache()["files"]), (len(files), 0))
        finally:
            os.environ["AMONTONS_CACHE"] = ""

    @unittest.skipUnless(has("matplotlib"), "no matplotlib here")
    def test_page(self):
        """The examples of docs/python.md, as they stand there."""
        blocks = re.findall(r"```python\n(.*?)```", (SOURCE / "docs/python.md").read_text(), re.S)
        said = [subprocess.run([sys.executable, "-c", block], capture_output=True, text=True, cwd=self.folder, check=True,
                               env=dict(os.environ, PYTHONPATH=str(MODULE), MPLBACKEND="Agg")).stdout for block in blocks]
        self.assertEqual(len(said), 2)
        self.assertTrue((self.folder / "force.png").is_file())
        self.assertIn("slip may grow; fastest at x =", said[1])


if __name__ == "__main__":
    unittest.main()
