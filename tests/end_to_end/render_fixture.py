# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes result folders for test_render.py: history.h5 by the table of src/io/hdf5/result_file.h, as a
stick-slip run would leave it. Nothing is computed from mechanics: the history is drawn up so that
every feature a figure must show stands at a known place.

    render_fixture.py FOLDER     writes a demonstration history into FOLDER
"""
import os
import sys

import h5py
import numpy as np

V, V_CRITICAL, MU_STATIC, MU_KINETIC, LENGTH, PRESSURE = 1e-5, 3.4e-4, 0.38, 0.1, 1.0, 0.003
SLIDES = (0.0021, 0.0034, 0.0047)       # U where bulk sliding starts
U_END, BOUNDED = 0.006, 5               # end of the run, rapid precursors before each sliding
REACH_CRITICAL = 0.62                   # l_c / L

SCALARS = ("time", "rod_displacement", "mu", "rod_force", "normal_force", "step_size", "front",
           "max_slip_rate", "certified", "energy_error")
FIELDS = ("slip_rate", "slip", "pressure", "shear", "status")


def bounded_starts(slide, start):
    """U of the rapid precursors of the cycle from `start` to `slide`: closer and closer."""
    length = slide - start
    return [slide - length * share for share in (0.16, 0.11, 0.07, 0.04, 0.018)[:BOUNDED]]


def event_times(start, duration, count):
    """Steps of a rapid event: many, within `duration` of U."""
    return start + duration * (np.arange(count) + 1) / count


def history_rows():
    """[(U, kind, phase, reach)] of all steps; phase 0 to 1 through a rapid event, else None."""
    rows, start = [], 0.0
    for slide in SLIDES:
        bounded = bounded_starts(slide, start)
        quiet = np.linspace(start, slide, 120)[1:-1]
        for U in quiet:
            if any(0 <= U - U0 <= 1.0e-5 for U0 in bounded):
                continue
            rows.append((U, "slow", None, slow_reach(U, start, slide)))
        for U0 in bounded:
            reach = slow_reach(U0, start, slide) * 1.15
            for k, U in enumerate(event_times(U0, 1.0e-5, 60)):
                rows.append((U, "bounded", k / 59, reach))
        for k, U in enumerate(event_times(slide, 4.0e-5, 150)):
            rows.append((U, "leading", k / 149, LENGTH))
        start = slide + 4.0e-5
    for U in np.linspace(start, U_END, 100)[1:]:
        rows.append((U, "slow", None, slow_reach(U, start, start + 0.00126)))
    rows.sort(key=lambda row: row[0])
    return [(0.0, "slow", None, 0.0)] + rows


def slow_reach(U, start, slide):
    return REACH_CRITICAL * np.clip((U - start) / (slide - start), 0, 1) ** 0.8


def front_position(U, kind, phase, reach):
    if kind == "slow":
        return reach
    return max(reach / 1.15 if kind == "bounded" else REACH_CRITICAL, reach * min(1, 1.6 * phase))


def rate_profile(kind, phase, reach, x):
    """|slip rate| at x: the rod's own velocity behind the slow front, a pulse in rapid events."""
    rate = np.where(x < reach, 0.8 * V * (1.2 - x / max(reach, 1e-9)), 0.0)
    if kind == "slow":
        return rate
    front = reach * min(1.0, 1.6 * phase)
    peak = 3.0e-4 if kind == "bounded" else 2.0e-2
    envelope = np.sin(np.pi * min(1.0, 0.05 + 0.95 * phase)) + 0.02
    fast = np.where(x <= front, peak * envelope * np.exp(-(front - x) / 0.35), 0.0)
    return np.maximum(rate, fast)


def mu_curve(U_rows, kinds):
    """Rises by 0.19 a cycle from MU_KINETIC, drops a little at precursors, falls at sliding."""
    mu, value, last = [], 0.0, 0.0
    for U, kind, phase, _ in kinds:
        step = U - last
        rate = {"slow": 160.0, "bounded": -220.0, "leading": -4000.0}[kind]
        value = max(value + rate * step, 0.07)
        if U == 0:
            value = 0.0
        mu.append(value)
        last = U
    return np.array(mu)


def make(folder, nodes=81, pads=1, units="normalised", tables=True, name="history.h5",
         change=None, length=LENGTH):
    """One result. `change(data)`: a last word on the dictionary of arrays before it is written.
    `length`: metres of the block where units are "si"; U and x scale with it."""
    kinds = history_rows()
    U = np.array([row[0] for row in kinds])
    x = pad_positions(nodes, pads)
    rate = np.array([rate_profile(kind, phase, reach, x) for _, kind, phase, reach in kinds])
    mu = mu_curve(U, kinds)
    time = U / V
    slip = np.cumsum(rate * np.diff(time, prepend=0)[:, None], axis=0)
    pressure = PRESSURE * (0.4 + 1.2 * x)[None, :] * np.ones_like(rate)
    status = np.where(rate > V_CRITICAL, 3, np.where(rate > 0, 2, 1))
    data = {
        "series/time": time, "series/rod_displacement": U, "series/mu": mu,
        "series/rod_force": mu * PRESSURE, "series/normal_force": np.full_like(mu, PRESSURE),
        "series/step_size": np.diff(time, prepend=0),
        "series/front": np.array([front_position(*row) for row in kinds]),
        "series/max_slip_rate": rate.max(axis=1), "series/certified": (rate.max(axis=1) < V * 2),
        "series/energy_error": np.zeros_like(mu),
        "interface/slip_rate": rate, "interface/slip": slip, "interface/pressure": pressure,
        "interface/shear": pressure * MU_STATIC, "interface/status": status,
        "nodes/x": x, "nodes/weight": np.gradient(x) if nodes > 1 else np.ones(1),
        "nodes/pad": np.minimum((x * pads).astype(int), pads - 1),
    }
    if tables:
        data.update(event_tables(U, mu))
    attributes = {
        "title": "fixture", "units": units, "version": "0", "length": LENGTH, "pressure": PRESSURE,
        "normal_force": PRESSURE, "rod_velocity": V, "critical_velocity": V_CRITICAL,
        "mu_static": MU_STATIC, "mu_kinetic": MU_KINETIC, "speed_longitudinal": 1.063,
        "speed_shear": 0.611, "speed_rayleigh": 0.562,
    }
    if tables:
        attributes["mu_macroscopic"] = float(np.mean(data["peaks/mu"][1:]))
        attributes["critical_length"] = REACH_CRITICAL
    if units == "si":
        scale_lengths(data, attributes, length)
    if change:
        change(data, attributes)
    write(os.path.join(folder, name), data, attributes)
    return data, attributes


def pad_positions(nodes, pads):
    """Nodes ordered by x; pads have gaps of 40 % of a pad between them."""
    if pads == 1:
        return np.linspace(0, LENGTH, nodes)
    each, pitch = nodes // pads, LENGTH / (pads - 0.4 + 0.0)
    return np.concatenate([np.linspace(0, 0.6 * pitch, each) + k * pitch for k in range(pads)])


def event_tables(U, mu):
    kind, U_start, U_stop, reach, start = [], [], [], [], 0.0
    peaks_U, peaks_mu = [], []
    for slide in SLIDES:
        for U0 in bounded_starts(slide, start):
            kind.append(1), U_start.append(U0), U_stop.append(U0 + 1e-5)
            reach.append(slow_reach(U0, start, slide) * 1.15)
        kind.append(2), U_start.append(slide), U_stop.append(slide + 4e-5), reach.append(LENGTH)
        top = np.argmax(np.where((U > start) & (U <= slide + 1e-6), mu, -1))
        peaks_U.append(U[top]), peaks_mu.append(mu[top])
        start = slide + 4e-5
    count = len(kind)
    table = {"kind": kind, "U_start": U_start, "U_stop": U_stop, "t_start": np.array(U_start) / V,
             "t_stop": np.array(U_stop) / V, "reach": reach, "peak_slip_rate": [3e-4] * count,
             "front_speed": [np.nan] * count}
    tables = {"events/" + name: np.array(column, float) for name, column in table.items()}
    tables["peaks/U"], tables["peaks/mu"] = np.array(peaks_U), np.array(peaks_mu)
    tables["peaks/counts"] = np.array([0.0] + [1.0] * (len(peaks_U) - 1))
    return tables


def scale_lengths(data, attributes, length):
    for name in ("series/rod_displacement", "series/front", "nodes/x", "interface/slip",
                 "events/U_start", "events/U_stop", "events/reach", "peaks/U"):
        if name in data:
            data[name] = data[name] * length
    for name in ("interface/slip_rate",):
        data[name] = data[name] * length
    for name in ("length", "critical_length", "rod_velocity", "critical_velocity"):
        if name in attributes:
            attributes[name] *= length


def stored_type(name):
    if name == "nodes/pad":
        return np.int32
    if name in ("series/certified", "interface/status"):
        return np.uint8
    return np.float32 if name.startswith("interface/") else np.float64


def write(path, data, attributes):
    folder = os.path.dirname(path)
    os.makedirs(folder, exist_ok=True)
    open(os.path.join(folder, "amontons.files"), "a").close()   # a result of ours: what is drawn there may be drawn again
    with h5py.File(path, "w") as file:
        for name, values in data.items():
            file.create_dataset(name, data=np.asarray(values).astype(stored_type(name)))
        for name, value in attributes.items():
            file.attrs[name] = value


if __name__ == "__main__":
    made, _ = make(sys.argv[1])
    print(len(made["series/mu"]), "steps in", sys.argv[1])
