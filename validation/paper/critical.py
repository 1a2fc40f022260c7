# SPDX-License-Identifier: GPL-2.0-or-later
"""Critical lengths of the block and of the 1D model: theory, growth rates and simulation in one figure.

`amontons stability` has l_sc and l_c of the block without time stepping, `amontons model1d` those of the paper's line
(alpha = 0.2): by the paper's formula, with all terms kept, and as its own simulation finds them at its first peak.
"""
import json
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np

QUIET = {"output.figures": "[]", "output.fields": "none", "output.history": "false"}
PRESSURES = {"A": np.geomspace(1e-3, 1e-1, 13), "B": np.geomspace(1e-5, 1e-3, 9)}
SCENES = {"A": ("fig1", 1.0), "B": ("set-b", 0.04)}
CYCLE = {"A": 10, "B": 30}        # rod's way to run, over P L: three slidings at least


def ask(place, command, scene, folder, settings):
    """The numbers of one command, of an earlier call where there are some; None where it found no sliding to start from."""
    path = folder / f"{command}.json"
    if place.fresh or not path.exists():
        shutil.rmtree(folder, ignore_errors=True)
        words = [str(place.program), command, str(scene), "--quiet", "-o", str(folder)]
        for key, value in {**QUIET, **settings}.items():
            words += ["--set", f"{key}={value}"]
        subprocess.run(words, check=False, capture_output=True)
    return json.loads(path.read_text()) if path.exists() else None


def cells_of(place):
    return 20 if place.quick else 80


def folder_of(place, name, k):
    return place.folder / "critical" / f"{name}{k}-{cells_of(place)}"


def measure(place, here, name):
    """One dict for each pressure of set `name`, with l/L by every way there is; nan where there is none."""
    scene, length = SCENES[name]
    scene = here / f"{scene}.yaml"

    def one(k, P):
        settings = {"load.pressure": f"{P:.8g}", "mesh.set.nx": cells_of(place), "mesh.set.nz": cells_of(place),
                    "time.until": f"{{U: {CYCLE[name] * P * length:.8g}, periodic: true}}"}
        folder = folder_of(place, name, k)
        folder.mkdir(parents=True, exist_ok=True)
        line = ask(place, "model1d", scene, folder / "line", settings)
        block = ask(place, "stability", scene, folder / "block", settings)
        return {"P": P, "PL": P * length, **read(line["theory"], "line_", LINE_KEYS),
                **read(line["simulation"], "simulated_", SIMULATED_KEYS),
                **read(block["results"] if block else {}, "block_", BLOCK_KEYS)}

    pressures = PRESSURES[name][::2] if place.quick else PRESSURES[name]
    with ThreadPoolExecutor(place.jobs) as pool:
        return list(pool.map(one, range(len(pressures)), pressures))


LINE_KEYS = {"l_c": "l_c_over_L", "l_c_full": "l_c_full_over_L", "l_sc_full": "l_sc_full_over_L", "l_c_at_V": "l_c_at_V_full_over_L",
             "mu": "mu_M", "mu_full": "mu_M_full"}
SIMULATED_KEYS = {"l_c": "first_l_c_over_L", "mu": "first_mu"}
BLOCK_KEYS = {"l_c": "l_c_over_L", "l_c_at_V": "l_c_at_V_over_L", "l_sc": "l_sc_over_L", "mu": "mu_M_adiabatic", "mu_at_V": "mu_M"}


def read(source, prefix, keys):
    number = lambda value: np.nan if value is None else float(value)  # noqa: E731
    return {prefix + key: number(source.get(name)) for key, name in keys.items()}


def within(values):
    """A front that reaches the end has no critical length."""
    return [value if np.isfinite(value) and value <= 1 else None for value in values]


def figure(rows, dynamic, name):
    """Plot of l_c/L against P L: the 1D curves as lines, the block's as marks. dynamic: (P L, l_c/L) of time stepping."""
    x = [row["PL"] for row in rows]
    curve = lambda key: within(row[key] for row in rows)  # noqa: E731
    series = [
        {"label": "1D, paper's formula", "x": x, "y": curve("line_l_c"), "line": "thin", "color": 1},
        {"label": "1D, all terms", "x": x, "y": curve("line_l_c_full"), "line": "dashed", "color": 1},
        {"label": "1D, simulated", "x": x, "y": curve("simulated_l_c"), "line": "none", "color": 1, "marker": "triangle",
         "filled": False},
        {"label": "block, growth rates, V → 0", "x": x, "y": curve("block_l_c"), "color": 2},
        {"label": "block, the same at V", "x": x, "y": curve("block_l_c_at_V"), "line": "dashed", "color": 2},
        {"label": "block, first oscillation (l_{sc})", "x": x, "y": curve("block_l_sc"), "line": "thin", "color": 4},
        {"label": "block, time stepping", "x": [p for p, _ in dynamic], "y": within(l for _, l in dynamic), "line": "none",
         "color": 3, "marker": "circle"}]
    return {"title": f"critical length against pressure, set {name}", "height": 0.85,
            "x": {"label": "~{P}_{ext} ~{L}", "scale": "log"}, "y": {"label": "~{l} / ~{L}", "scale": "log", "range": [0.01, 1.3]},
            "series": series}


def figure_growth(place, name, k):
    """Real part of the fastest rate against l/L at one pressure: the line by the paper and with all terms, and the block."""
    folder = folder_of(place, name, k)
    with h5py.File(folder / "line" / "model1d.h5") as file:
        front, omega, rate = (file[f"points/{key}"][:] for key in ("front", "omega_re", "rate_re"))
    length = SCENES[name][1]
    points = json.loads((folder / "block" / "stability.json").read_text())["points"]
    series = [{"label": "1D, paper's ~{ω}_{0}", "x": list(front / length), "y": list(omega), "line": "thin", "color": 1},
              {"label": "1D, all terms", "x": list(front / length), "y": list(rate), "line": "dashed", "color": 1},
              {"label": "block", "x": [p["l_over_L"] for p in points], "y": [p["rate_re"] for p in points], "marker": "circle",
               "color": 2},
              {"x": [0, 1], "y": [0, 0], "line": "thin"}]
    return {"title": f"growth rate against front position, set {name}", "x": {"label": "~{l} / ~{L}", "range": [0, 1]},
            "y": {"label": "largest Re ~{λ}  (~{E}/η_{1})", "range": [-8, 40]}, "series": series}
