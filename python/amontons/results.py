# SPDX-License-Identifier: GPL-2.0-or-later
"""What computations leave: numbers, histories read when asked for, pictures through matplotlib where it is there."""
from __future__ import annotations

import ctypes
import json
import xml.etree.ElementTree
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

import numpy as np

from . import _structs as c
from ._library import path_of
from .notebook import result_html

_SHORT = {"t": "series/time", "U": "series/rod_displacement", "x": "nodes/x"}
_FOLDERS = ("series", "interface", "nodes", "pads", "probes")
_TABLES = ("events", "peaks", "pads", "pad_slidings")   # of run.json, a map a row
_SHOWN = ("force", "slip-map", "contact-density", "state-map", "probes", "profile")   # of a result, in a notebook
_NUMBERS = ("mu_M", "mu_hold", "mu_max", "l_c_over_L")
# Components of a probe's values by how many these are: a vector has as many as there are axes, a strain 3 in the plane.
_VECTORS = {2: ("x", "z"), 3: ("x", "y", "z")}
_STRAINS = {3: ("xx", "zz", "xz"), 6: ("xx", "yy", "zz", "xy", "yz", "xz")}


def _inside(folder: Path, name: str) -> Path:
    """The path of a file in a result folder, which somebody may have sent; ValueError where a link leads out of it, or a
    name that one of its files gives. The folder itself may be a link."""
    parts, path = PurePosixPath(name).parts, folder
    if name.startswith("/") or ".." in parts:
        raise ValueError(f"{name} leads out of {folder}, whose files name it: only what lies inside is read")
    for part in parts:
        path = path / part
        if path.is_symlink():
            raise ValueError(f"{path} is a symbolic link, and inside of a result none is followed: put in its place what it leads "
                             "to, or move it away")
    return path


def _open_arrays(path: Path) -> Any:
    """An HDF5 file; ValueError where it leads to another file, as none of ours does."""
    import h5py
    if not path.is_file():
        raise FileNotFoundError(f"{path} is not a file")
    file = h5py.File(path, "r")

    # HDF5 goes through each group once, however many links lead to it, and follows none by name.
    links: list[tuple[bytes, int]] = []
    try:
        file.id.links.visit(lambda name, link: links.append((name, link.type)), info=True)
        for name, kind in links:
            where = f"{path}: {name.decode(errors='replace')}"
            if kind != h5py.h5l.TYPE_HARD:
                raise ValueError(f"{where} is a link by name, which is not followed")
            item = file[name]
            if isinstance(item, h5py.Group):
                continue
            if not isinstance(item, h5py.Dataset):
                raise ValueError(f"{where} is neither array nor group")
            if item.external or item.is_virtual:
                raise ValueError(f"the data of {where} lie in another file, which is not read")
    except BaseException:
        file.close()
        raise
    return file


class History(Mapping):
    """The arrays of history.h5, each read when it is first asked for; docs/results.md lists them with their units.

    history["series/mu"] or history.mu, [steps]; history.U, history.t: displacement of the rod, length, and time,
    [steps]; history.slip_rate, .slip, .pressure, .shear, .status: [steps, nodes]; history.x: [nodes]. In space
    slip_rate, slip, shear are [steps, nodes, 2], along x and y; history.y, and history.line: 1 for the nodes along the
    middle of the contact, off which fronts are read. history.state: of friction that remembers, [steps, nodes], of
    several states [steps, nodes, states]. Row 0 is the start. history.numbers: the attributes of the file (length, normal_force, mu_static, ...).
    """

    def __init__(self, path: Path) -> None:
        self._file = _open_arrays(path)
        if "parts" in self._file.attrs:
            raise ValueError(f"{path} has only the last rows, those before are in {path.name}.1, ...: the run was killed, and an "
                             "earlier version of amontons wrote it, which alone can continue it (--resume) and join them")
        self._names: list[str] = []
        self._file.visititems(lambda name, item: self._names.append(name) if hasattr(item, "shape") else None)
        self._read: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._read:
            if name not in self._names:
                raise KeyError(f"{name}; there are: {', '.join(self._names)}")
            self._read[name] = self._file[name][()]
        return self._read[name]

    def __getattr__(self, name: str) -> np.ndarray:
        if not name.startswith("_"):
            for whole in (_SHORT.get(name, ""), *(f"{folder}/{name}" for folder in _FOLDERS)):
                if whole in self._names:
                    return self[whole]
        raise AttributeError(f"no array is called {name}; there are: {', '.join(self._names)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    @property
    def numbers(self) -> dict[str, Any]:
        return {name: value.item() if hasattr(value, "item") else value for name, value in self._file.attrs.items()}


    @property
    def probes(self) -> list[str]:
        """Names of the probes of the scene, in the order of history["probes/strain"][steps, probes, components]."""
        return [name for name in str(self.numbers.get("probes", "")).split("\n") if name]

    def to_pandas(self) -> Any:
        """The series as a table of pandas, a row for each step: the index is t; U, mu and the other series, `pads NAME ...`
        of each pad, `NAME strain_xx` of each probe. Needs pandas."""
        pandas = _pandas()
        columns = {name.split("/")[1]: self[name] for name in self._names if name.startswith("series/")}
        columns = {"U" if name == "rod_displacement" else name: values for name, values in columns.items()}
        t = columns.pop("time")
        pads = str(self.numbers.get("pads", "")).split("\n")
        for name in (name for name in self._names if name.startswith("pads/")):
            for k, values in enumerate(self[name].reshape(len(t), -1).T):
                pad = pads[k] if k < len(pads) and pads[k] else str(k)
                columns[f"pads {pad} {name.split('/')[1]}"] = values
        for name in (name for name in self._names if name.startswith("probes/") and name != "probes/at"):
            values, quantity = self[name], name.split("/")[1]
            for k, probe in enumerate(self.probes):
                names = _STRAINS if quantity in ("strain", "stress") else _VECTORS
                for c, component in enumerate(names[values.shape[2]]):
                    columns[f"{probe} {quantity}_{component}"] = values[:, k, c]
        return pandas.DataFrame(columns, index=pandas.Index(t, name="t"))


class Field(NamedTuple):
    """The files of one time, for ParaView, meshio or vtk: the whole block (.vtu) and the contact (.vtp)."""
    t: float
    bulk: Path
    interface: Path | None


class Result:
    """A result folder of a run. Attributes are those of RunSummary where this process computed it (mu_M, mu_hold,
    mu_max, peaks, ...); of a folder that was opened they come from run.json (`results`)."""

    def __init__(self, folder: Any) -> None:
        self.folder = path_of(folder)
        self.summary: c.RunSummary | None = None
        self._history: History | None = None
        # A run that was killed has left no more than its history, a stopped search of an error bar no more than run.json.
        if not any((self.folder / name).is_file() for name in ("run.json", "history.h5", "history.h5.part")):
            raise FileNotFoundError(f"{self.folder}: not a result folder: no run.json and no history.h5 in it")

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name == "summary":
            raise AttributeError(name)
        if self.summary is not None and hasattr(self.summary, name):
            return plain(getattr(self.summary, name))
        results = self.report.get("results", {})
        if name not in results:
            raise AttributeError(f"a result has no {name}; there are: {', '.join(results)}")
        return np.nan if results[name] is None else results[name]

    @property
    def report(self) -> dict[str, Any]:
        """All of run.json; docs/results.md says what it holds."""
        path = _inside(self.folder, "run.json")
        return json.loads(path.read_text()) if path.is_file() else {}

    @property
    def history(self) -> History:
        """Every accepted step; opened when first asked for."""
        if self._history is None:
            path = _inside(self.folder, "history.h5")
            self._history = History(path if path.is_file() else _inside(self.folder, "history.h5.part"))
        return self._history

    @property
    def fields(self) -> list[Field]:
        """The times at which output.fields wrote the whole block."""
        path = _inside(self.folder, "fields.pvd")
        if not path.is_file():
            return []
        times: dict[float, dict[str, Path]] = {}
        for entry in xml.etree.ElementTree.parse(path).iter("DataSet"):
            file = _inside(self.folder, entry.attrib["file"])
            times.setdefault(float(entry.attrib["timestep"]), {})[file.suffix] = file
        return [Field(t, files[".vtu"], files.get(".vtp")) for t, files in sorted(times.items())]

    @property
    def warnings(self) -> list[str]:
        """What makes an answer doubtful."""
        return list(self.report.get("warnings", []))

    def to_pandas(self, table: str = "events") -> Any:
        """`events`, `peaks`, `pads` or `pad_slidings` of run.json as a table of pandas, a row for each. Needs pandas."""
        if table not in _TABLES:
            raise ValueError(f"there is no table {table!r}; there are: {', '.join(_TABLES)}")
        return _pandas().DataFrame(self.report.get("results", {}).get(table) or [])

    def _pictures(self) -> list[Path]:
        """Those that it has drawn; what is no file in its own folder of figures is none of them."""
        figures = self.folder / "figures"
        if figures.is_symlink():
            return []
        paths = (figures / f"{name}.png" for name in _SHOWN)
        return [path for path in paths if path.is_file() and not path.is_symlink()]

    def _repr_png_(self) -> bytes | None:
        """The first of its pictures; a run that has drawn none has no picture."""
        pictures = self._pictures()
        return pictures[0].read_bytes() if pictures else None

    def _repr_html_(self) -> str:
        """Its answers, what it was warned of, and the pictures that it has drawn."""
        report = self.report
        results, rows = report.get("results", {}), []
        for name in _NUMBERS:
            value, error = results.get(name), results.get(f"{name}_error") or results.get(f"{name}_known_to")
            if value is not None:
                rows.append((name, f"{value:.4g}" + (f" ± {error:.2g}" if error is not None else "")))
        kinds = [event.get("kind") for event in results.get("events") or []]
        rows += [(f"{kind} events", str(kinds.count(kind))) for kind in dict.fromkeys(kinds)]
        title = (report.get("scene") or {}).get("title") or self.folder.name
        state = report.get("status", "has not ended")
        return result_html(f"{title}: {state}", rows, self.warnings, self._pictures())

    def plot_force(self, axes: Any = None) -> Any:
        """F_T/F_N against the displacement of the rod, with the peaks that count for mu_M. Needs matplotlib; returns
        the axes."""
        axes = axes if axes is not None else _new_axes()
        history = self.history
        axes.plot(history.U, history.mu, linewidth=0.8)
        if "peaks/U" in history:
            counts = history["peaks/counts"] > 0
            axes.plot(history["peaks/U"][counts], history["peaks/mu"][counts], "o", markersize=4,
                      label=f"$\\mu_M$ = {self.mu_M:.4f}" if np.isfinite(self.mu_M) else None)
            if counts.any():
                axes.legend(frameon=False)
        axes.set_xlabel(f"rod displacement U{self._unit('m')}")
        axes.set_ylabel("$F_T/F_N$")
        return axes

    def plot_slip_map(self, axes: Any = None, decades: float = 4) -> Any:
        """Slip rate over position and displacement of the rod, logarithmic, over so many decades; in space along the
        middle of the contact. Needs matplotlib; returns the axes."""
        axes = axes if axes is not None else _new_axes()
        history = self.history
        rate, x = np.abs(history.slip_rate), history.x
        if "nodes/line" in history:
            line = history.line > 0
            rate, x = np.linalg.norm(rate[:, line], axis=2), x[line]
        rate = rate / history.numbers["rod_velocity"]
        top = max(float(np.log10(np.maximum(rate.max(), 1e-300))), -300.0)
        shown = np.log10(np.maximum(rate, 10.0 ** (top - decades)))
        mesh = axes.pcolormesh(x, history.U, shown, shading="nearest", rasterized=True)
        axes.figure.colorbar(mesh, ax=axes, label="$\\log_{10}$(slip rate / V)")
        axes.set_xlabel(f"position x{self._unit('m')}")
        axes.set_ylabel(f"rod displacement U{self._unit('m')}")
        return axes

    def _unit(self, unit: str) -> str:
        return f" ({unit})" if self.history.numbers.get("units") == "si" else ""


def _pandas() -> Any:
    try:
        import pandas
    except ImportError:
        raise ImportError("tables need pandas (Debian: python3-pandas); arrays and run.json are there without it") from None
    return pandas


def _new_axes() -> Any:
    try:
        import matplotlib.pyplot as pyplot
    except ImportError:
        raise ImportError("plots need matplotlib (Debian: python3-matplotlib)") from None
    return pyplot.subplots()[1]


def plain(value: Any) -> Any:
    """A field of a struct as Python has it: text, list of texts, dict of a struct, or the number."""
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    if isinstance(value, c.RunWarnings):
        return [text.value.decode() for text in value.text[:value.count]]
    if isinstance(value, ctypes.Structure):
        return {name: plain(getattr(value, name)) for name, *_ in value._fields_}
    if isinstance(value, ctypes.Array):
        return [plain(item) if not hasattr(item, "value") else plain(item.value) for item in value]
    return value


class Answer:
    """The numbers of a computation as attributes, named and explained as in `struct` of the C header."""

    def __init__(self, struct: ctypes.Structure, points: np.ndarray | None = None) -> None:
        self.struct = struct
        if points is not None:
            self.points = points

    def __getattr__(self, name: str) -> Any:
        if name == "struct" or name.startswith("__"):
            raise AttributeError(name)
        return plain(getattr(self.struct, name))

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name for name, *_ in self.struct._fields_)]

    def as_dict(self) -> dict[str, Any]:
        return plain(self.struct)

    def __repr__(self) -> str:
        short = (f"{n}={plain(getattr(self.struct, n))}" for n, k, *_ in self.struct._fields_
                 if k in (ctypes.c_double, ctypes.c_int32, ctypes.c_int64, ctypes.c_bool))
        return f"{type(self.struct).__name__}({', '.join(short)})"
