# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands of the program as functions. Quantities are in the units of the scene's file."""
from __future__ import annotations

import csv
import ctypes
import shutil
import tempfile
import weakref
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _structs as c
from ._library import (Scene, c_text, c_text_or_none, c_word, call, call_stoppable, fields, lib, path_of, printed, setting_words,
                       settings_map, words)
from .results import Answer, Result, plain

Settings = Mapping[str, Any]
Progress = Callable[[c.StepView], object]

# Points that callbacks hand over: [points] with the fields of the C struct.
_NUMPY = {ctypes.c_double: "f8", ctypes.c_int32: "i4", ctypes.c_int64: "i8", ctypes.c_bool: "?"}


def _callback(kind: Any, function: Callable[[Any], object] | None, stop: Any) -> Any:
    """`function` as the library calls it; NULL for None. What it raises stops the computation."""
    def show(view: Any, _: Any) -> None:
        try:
            if function is not None and not hasattr(stop, "failure"):
                function(view.contents)
        except BaseException as failure:   # ctypes would print it and go on
            stop.failure = failure
            stop.value = 1

    return kind() if function is None else kind(show)


def _gather(kind: Any, struct: Any, stop: Any) -> tuple[Any, list[tuple[Any, ...]]]:
    """A callback that keeps all points it is shown, and the list they go into."""
    kept: list[tuple[Any, ...]] = []
    names = [name for name, *_ in struct._fields_]
    return _callback(kind, lambda point: kept.append(tuple(getattr(point, name) for name in names)), stop), kept


def _table(struct: Any, kept: list[tuple[Any, ...]]) -> np.ndarray:
    return np.array(kept, dtype=[(name, _NUMPY[kind]) for name, kind, *_ in struct._fields_])


def run(scene: Any, settings: Settings | None = None, folder: Any = None, *, overwrite: bool = False,
        resume: bool = False, trust: bool = False, progress: Progress | None = None) -> Result:
    """One simulation: `amontons run`. settings: {"load.pressure": 0.006}, as --set.

    folder: of the results. None: one that is removed with the Result, and no pictures are drawn.
    trust: the scene's .geo may run commands and write files, its friction law may be a plug-in: of scenes you know.
    resume: go on with the run in `folder` that was cut off, or, with a later time.until, beyond its end.
    progress: called after every step with a StepView (t, U, mu, fraction, ...), which it must not keep.
    Ctrl-C ends the run after the present step (KeyboardInterrupt); what was computed is in `folder`.
    """
    given = settings_map(settings)
    temporary = folder is None
    if temporary:
        folder, overwrite = tempfile.mkdtemp(prefix="amontons-"), True
        given = {"output.figures": [], **given}
    try:
        result = _run_in(Scene(scene, given, trust), folder, overwrite, resume, progress)
    except BaseException:
        if temporary:
            shutil.rmtree(folder, ignore_errors=True)
        raise
    if temporary:
        weakref.finalize(result, shutil.rmtree, folder, ignore_errors=True)
    return result


def _run_in(read: Scene, folder: Any, overwrite: bool, resume: bool, progress: Progress | None) -> Result:
    stop = ctypes.c_int(0)
    summary = c.RunSummary()
    options = c.RunOptions(folder=c_text_or_none(folder), overwrite=overwrite, resume=resume,
                           on_step=_callback(c.StepCallback, progress, stop), stop=ctypes.pointer(stop))
    call_stoppable(lib.amontons_run, stop, read, ctypes.byref(options), ctypes.byref(summary))
    finish = getattr(progress, "finish", None)
    if finish:
        finish()
    result = Result(folder)
    result.summary = summary
    return result


def forecast(scene: Any, settings: Settings | None = None, *, trust: bool = False) -> Answer:
    """How large a run would be: `amontons run --dry-run`. Attributes: those of RunForecast
    (elements, contact_nodes, unknowns, reduced, held; mesh: processor seconds to read it; memory: bytes; mesh_moved: how
    the mesh was scaled and moved)."""
    read = Scene(scene, settings, trust)
    expected = c.RunForecast()
    call(lib.amontons_forecast, read, ctypes.byref(expected))
    return Answer(expected)


def open_result(folder: Any) -> Result:
    """The result of an earlier run."""
    return Result(folder)


def static(scene: Any, settings: Settings | None = None, folder: Any = None, *, overwrite: bool = False,
           trust: bool = False) -> Answer:
    """Equilibrium under a given load: `amontons static`. Attributes: those of StaticSummary (normal_force, shear_force,
    open, sticking, slipping, ...), forces per width. folder: for static.json, .h5 and .vtu; None: nothing is written."""
    read = Scene(scene, settings, trust)
    summary = c.StaticSummary()
    call(lib.amontons_static, read, c_text_or_none(folder), overwrite, ctypes.byref(summary))
    return Answer(summary)


def stability(scene: Any, settings: Settings | None = None, folder: Any = None, *, overwrite: bool = False,
              slidings: int = 1, whole: bool = False, at_end: bool = False, trust: bool = False,
              progress: Progress | None = None) -> Answer:
    """Where slow slip turns fast: `amontons stability`. Attributes: those of StabilitySummary (l_sc, l_c, mu_c, ...),
    lengths over L, NaN: nowhere; `points`: a numpy array of the states of the path, fields as in StabilityPoint.

    slidings: the path begins when so many slidings have ended, 0: at the relaxed start. whole: also beyond l_c.
    at_end: no path, only the state in which the scene's run ends."""
    read = Scene(scene, settings, trust)
    stop = ctypes.c_int(0)
    summary = c.StabilitySummary()
    on_point, kept = _gather(c.StabilityCallback, c.StabilityPoint, stop)
    options = c.StabilityOptions(slidings=slidings, whole=whole, at_end=at_end, folder=c_text_or_none(folder),
                                 overwrite=overwrite, on_step=_callback(c.StepCallback, progress, stop), on_point=on_point,
                                 stop=ctypes.pointer(stop))
    call_stoppable(lib.amontons_stability, stop, read, ctypes.byref(options), ctypes.byref(summary))
    return Answer(summary, _table(c.StabilityPoint, kept))


def model1d(scene: Any, settings: Settings | None = None, folder: Any = None, *, overwrite: bool = False,
            alpha: float = 0.2, nodes: int = 81, theory_only: bool = False, trust: bool = False,
            progress: Progress | None = None) -> Answer:
    """The paper's effective 1D model of a scene: `amontons model1d`. Attributes: those of Model1dSummary (l_sc, l_c,
    mu_c, mu_M, ...), lengths over L; `points`: a numpy array, fields as in Model1dPoint."""
    read = Scene(scene, settings, trust)
    stop = ctypes.c_int(0)
    summary = c.Model1dSummary()
    on_point, kept = _gather(c.Model1dCallback, c.Model1dPoint, stop)
    options = lib.amontons_model1d_options()
    options.alpha, options.nodes, options.theory_only = alpha, nodes, theory_only
    options.folder, options.overwrite = c_text_or_none(folder), overwrite
    options.on_step, options.on_point = _callback(c.StepCallback, progress, stop), on_point
    options.stop = ctypes.pointer(stop)
    call_stoppable(lib.amontons_model1d, stop, read, ctypes.byref(options), ctypes.byref(summary))
    return Answer(summary, _table(c.Model1dPoint, kept))


def _number(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text


def read_table(path: Any) -> Any:
    """A table of a sweep (sweep.csv, ranking.csv): a pandas DataFrame where pandas is there, else a dict of numpy
    arrays by column."""
    try:
        import pandas
        return pandas.read_csv(path, float_precision="round_trip")
    except ImportError:
        with open(path, newline="") as file:
            rows = list(csv.reader(file))
        return {name: np.array([_number(row[k]) for row in rows[1:]]) for k, name in enumerate(rows[0])}


def _compute_study(function: Any, summary: Any, study: Any, settings: Settings | None,
                   progress: Callable[[c.SweepView], object] | None, **options: Any) -> None:
    """A function of the library that computes a study's points, until Ctrl-C stops it. options: of SweepOptions."""
    stop = ctypes.c_int(0)
    overrides, count = setting_words(settings)
    given = c.SweepOptions(overrides=overrides, override_count=count, on_point=_callback(c.SweepCallback, progress, stop),
                           stop=ctypes.pointer(stop), **options)
    call_stoppable(function, stop, c_text(study), ctypes.byref(given), ctypes.byref(summary))


def sweep(study: Any, settings: Settings | None = None, folder: Any = None, *, jobs: int = 0, retry: bool = False,
          fresh: bool = False, slurm: str | None = None, trust: bool = False,
          progress: Callable[[c.SweepView], object] | None = None) -> Any:
    """Many runs over varied keys: `amontons sweep`. The table, a row a point (read_table); points that failed have
    their reason in it. What is finished in `folder` is not computed again; None: a folder that is removed.

    jobs: processes at a time, 0: as many as there are cores. slurm: points as Slurm job arrays, with these words for
    sbatch. progress: called with a SweepView when a point has ended. Ctrl-C stops; the table is written.
    Processes are forked: no other thread should compute meanwhile."""
    if folder is None:
        with tempfile.TemporaryDirectory(prefix="amontons-") as temporary:
            return sweep(study, settings, temporary, jobs=jobs, slurm=slurm, trust=trust, progress=progress)
    _compute_study(lib.amontons_sweep, c.SweepSummary(), study, settings, progress, folder=c_text_or_none(folder), jobs=jobs,
                   slurm=c_text_or_none(slurm), retry=retry, trust=trust, fresh=fresh)
    return read_table(path_of(folder) / "sweep.csv")


def optimise(study: Any, settings: Settings | None = None, folder: Any = None, *, jobs: int = 0, retry: bool = False,
             slurm: str | None = None, trust: bool = False,
             progress: Callable[[c.SweepView], object] | None = None) -> dict[str, Any]:
    """The best design of a study that searches: `amontons optimise`. A dict: "best" ({key: value}), "value" and "bar" of what
    the study ranks by, "decided" (no other design may be better, with the bars of both), "start_value" and "start_bar" (of the
    scene as it is; nan: it is no design of the search), "designs", "computed" (points), "seconds". The table of all points is
    in `folder` (read_table); None: a folder that is removed. The rest as for `sweep`."""
    if folder is None:
        with tempfile.TemporaryDirectory(prefix="amontons-") as temporary:
            return optimise(study, settings, temporary, jobs=jobs, slurm=slurm, trust=trust, progress=progress)
    summary = c.OptimiseSummary()
    _compute_study(lib.amontons_optimise, summary, study, settings, progress, folder=c_text_or_none(folder), jobs=jobs,
                   slurm=c_text_or_none(slurm), retry=retry, trust=trust)
    pairs = (word.rpartition("=") for word in summary.best.decode().split())
    return {"best": {key: float(value) for key, _, value in pairs}, "value": summary.value, "bar": summary.bar,
            "decided": bool(summary.decided), "start_value": summary.start_value, "start_bar": summary.start_bar,
            "designs": summary.designs, "computed": summary.computed, "seconds": summary.seconds}


def fit(study: Any, settings: Settings | None = None, folder: Any = None, *, jobs: int = 0, retry: bool = False,
        slurm: str | None = None, trust: bool = False,
        progress: Callable[[c.SweepView], object] | None = None) -> dict[str, Any]:
    """The numbers of a scene that measurements speak for: `amontons fit`. A dict: "keys" ({key: {"value", "low", "high",
    "low_open", "high_open"}}: the best, its region, and whether that goes on beyond the range), "misfit", "measurements",
    "widened" (regions, as the misfit is above what errors explain), "own_share" (of the errors' squares, the program's own),
    "designs", "computed" (points), "seconds". A row a measurement is in `folder`/fit.csv (read_table). The rest as for `optimise`."""
    if folder is None:
        with tempfile.TemporaryDirectory(prefix="amontons-") as temporary:
            return fit(study, settings, temporary, jobs=jobs, slurm=slurm, trust=trust, progress=progress)
    summary = c.FitSummary()
    _compute_study(lib.amontons_fit, summary, study, settings, progress, folder=c_text_or_none(folder), jobs=jobs,
                   slurm=c_text_or_none(slurm), retry=retry, trust=trust)
    found = summary.parameters[:summary.parameter_count]
    return {"keys": {one.key.decode(): {"value": one.value, "low": one.low, "high": one.high, "low_open": bool(one.low_open),
                                        "high_open": bool(one.high_open)} for one in found},
            "misfit": summary.misfit, "measurements": summary.measurements, "widened": summary.widened,
            "own_share": summary.own_share, "designs": summary.designs, "computed": summary.computed, "seconds": summary.seconds}


def _picture_style(style: dict[str, Any]) -> Any:
    """Numbers and words go through the library's own table, as the command's do."""
    given, plain = c.PictureStyle(format=c_text(style.get("format", "png"))), {"dark", "overwrite", "format"}
    given.words = [(c_text(name.rstrip("_")), c_word(value)) for name, value in style.items() if name not in plain and value is not None]
    for name in plain & set(style) - {"format"}:
        setattr(given, name, style[name])
    for name, value in given.words:
        call(lib.amontons_picture_option, ctypes.byref(given), name, value)
    return given


def render(result: Any, figures: Sequence[str] = (), of: str | None = None, at: str | None = None, edges: bool = False,
           panels: Sequence[str] = (), cut: str | None = None, **style: Any) -> list[Path]:
    """Draws pictures of a stored result again: `amontons render`. figures: their names; (): all. panels: those
    to stand below each other in one, panels.png, in the place of figures. of, at, edges: what "field"
    shows ("stress_xz"), when ("U=0.0117"), and whether with the elements' edges; of "contact-plane" what and when. cut: where a
    block in space is cut open ("y=0.25"). style: format ("png", "pdf", "svg"), dark,
    overwrite (also files that amontons did not write), and each option of `amontons render --help` by its name: style="columns",
    width (mm), height, dpi, title, legend, limits="1%,99%", from_="U=0.01", ... The files, in the folder figures/ of the result."""
    folder = result.folder if isinstance(result, Result) else path_of(result)
    given = _picture_style(style)
    request = c.PictureRequest(figures=words(figures), figure_count=len(figures), style=given,
                               field=c.FieldChoice(of=c_text_or_none(of), at=c_text_or_none(at), edges=edges,
                                                   cut=c_text_or_none(cut)),
                               panels=c_text(",".join(panels)) if panels else None)
    call(lib.amontons_render_result, c_text(folder), ctypes.byref(request))
    return sorted((folder / "figures").glob(f"*.{style.get('format', 'png')}"))


def compare(result: Any, table: Any, **style: Any) -> Any:
    """Measurements beside a stored result: `amontons compare`. table: a .csv whose columns say what was measured
    (docs/experiment.md). Draws each figure that shows it; a table with a row for each, as read_table gives it: figure,
    points, covered (how many of them the result reaches), misfit and what it is over. style: as for render."""
    folder = result.folder if isinstance(result, Result) else path_of(result)
    given = _picture_style(style)
    said = ctypes.create_string_buffer(2000)
    call(lib.amontons_compare, c_text(folder), c_text(table), ctypes.byref(given), said, len(said))
    return read_table(folder / "figures/misfit.csv")


def render_plot(plot: Any, picture: Any, **style: Any) -> None:
    """Draws the curves that the YAML file `plot` describes into `picture`, whose name ends in .png, .pdf or .svg:
    `amontons render PLOT.yaml`. style: as for render, but the format."""
    given = _picture_style(style)
    call(lib.amontons_render_plot_file, c_text(plot), c_text(picture), ctypes.byref(given))


def render_sweep(folder: Any, plot: str | None = None, **style: Any) -> None:
    """Draws pictures of a stored sweep: what `plot` describes in the words of a study's `plot`, as in
    "{x: load.pressure, y: mu_M}", or without it those of its study again: `amontons render SWEEP`. style: as for render."""
    given = _picture_style(style)
    call(lib.amontons_render_sweep, c_text(folder), c_text_or_none(plot), ctypes.byref(given))


def film(result: Any, path: Any, **options: Any) -> Path:
    """A film of a stored result: `amontons film`. path: its ending (.mp4, .webm, .gif) says what is made; a folder gets
    PNG frames. options: seconds, rate (frames a second), width and height (pixels), of (field), magnification, and as for render
    ``from_`` and ``to`` ("U=0.0117"), cycle ("first", "last", "3"), depth (how far below its floor a base is drawn), title, dark, overwrite.
    Ctrl-C stops; there is then no film."""
    stop = ctypes.c_int(0)
    folder = result.folder if isinstance(result, Result) else path_of(result)
    own = {name for name, *_ in c.FilmRequest._fields_ if name != "style"} & set(options)
    style = _picture_style({name: value for name, value in options.items() if name not in own})
    request = c.FilmRequest(path=c_text(path), stop=ctypes.pointer(stop), style=style,
                            **fields(c.FilmRequest, {name: options[name] for name in own}))
    call_stoppable(lib.amontons_film, stop, c_text(folder), ctypes.byref(request))
    return path_of(path)


def info(path: Any, settings: Settings | None = None, picture: Any = None, *, overwrite: bool = False,
         trust: bool = False) -> str:
    """What a mesh (.msh, .geo), a scene or a result folder holds, in words: `amontons info`. picture: a PNG of the mesh
    and the rod to be drawn; overwrite: also over a file that amontons did not write."""
    overrides, count = setting_words(settings)
    options = c.InfoOptions(overrides=overrides, override_count=count, picture=c_text_or_none(picture),
                            overwrite=overwrite, trust=trust)
    return printed(lib.amontons_info, c_text(path), ctypes.byref(options))


def keys() -> str:
    """Every key that a scene may have, as a Markdown table: `amontons info keys`."""
    return printed(lib.amontons_scene_reference)


def cache() -> dict[str, Any]:
    """The cache of reductions: `amontons cache`. folder, files, bytes, limit; entries: a list of (name, bytes, when it was
    last used in s since 1970), the longest unused first."""
    kept: list[tuple[str, int, float]] = []
    summary = c.CacheSummary()
    show = _callback(c.CacheCallback, lambda entry: kept.append((plain(entry.name), entry.bytes, entry.used)),
                     ctypes.c_int(0))
    call(lib.amontons_cache_list, show, None, ctypes.byref(summary))
    return {**plain(summary), "entries": kept}


def clean_cache() -> dict[str, Any]:
    """Removes all of the cache: `amontons cache --clean`. files, bytes: what that was."""
    removed = c.CacheSummary()
    call(lib.amontons_cache_clean, ctypes.byref(removed))
    return plain(removed)


def data_folder() -> Path:
    """The folder of the meshes and example scenes that come with the library."""
    folder = ctypes.create_string_buffer(c.AMONTONS_PATH_SIZE)
    if not lib.amontons_data_folder(folder):
        raise FileNotFoundError("the meshes and scenes that belong to the library are not there")
    return Path(folder.value.decode())


def kernels() -> str:
    """OpenBLAS's word for the kernels that compute, "Haswell"; numpy's are the same where it is the same library."""
    return plain(lib.amontons_kernels(ctypes.byref(ctypes.c_char_p())))


def version() -> str:
    """"0.3.0"."""
    return plain(lib.amontons_version())
