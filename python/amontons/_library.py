# SPDX-License-Identifier: GPL-2.0-or-later
"""The shared library: where it is, its functions, its errors as exceptions, Ctrl-C while it computes."""
from __future__ import annotations

import ctypes
import json
import os
import re
import threading
from pathlib import Path
from typing import Any, Callable, Mapping

from . import _structs as c

__all__ = ["AmontonsError", "InputError", "FileError", "LibraryError", "ComputeError"]


# --- errors ---------------------------------------------------------------------------------------

class AmontonsError(Exception):
    """What the library refused or could not do; the message says what is wrong, where, and how to mend it.

    file, line, column: where in a scene or study; for a setting `file` is "--set KEY=VALUE"; None: not said.
    key: the key that is meant, "load.pressure"; None: not said.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.message = message
        found = re.match(r"(?:[^\n]*?: )??([^\n:]+):(\d+):(\d+): (?:([\w.]+): )?", message)
        self.file: str | None = found[1] if found else None
        self.line: int | None = int(found[2]) if found else None
        self.column: int | None = int(found[3]) if found else None
        self.key: str | None = found[4] if found else None


class InputError(AmontonsError, ValueError):
    """A scene, study, mesh or argument is wrong."""


class FileError(AmontonsError, OSError):
    """A file cannot be read or written."""


class LibraryError(AmontonsError):
    """A library that amontons needs (gmsh, HDF5, VTK, Cairo, OSMesa, libav) cannot be used."""


class ComputeError(AmontonsError):
    """The computation failed."""


EXCEPTIONS = {c.ERROR_INPUT: InputError, c.ERROR_FILE: FileError, c.ERROR_LIBRARY: LibraryError,
              c.ERROR_COMPUTE: ComputeError}


def raise_error(error: c.Error) -> None:
    """Raises what `error` says; nothing where it is clean. It is clean again afterwards."""
    code, message = error.code, error.message.decode(errors="replace")
    ctypes.memset(ctypes.byref(error), 0, ctypes.sizeof(error))
    if code == c.ERROR_INTERRUPT:
        raise KeyboardInterrupt(message)
    if code == c.ERROR_MEMORY:
        raise MemoryError(message)
    if code != c.ERROR_NONE:
        raise EXCEPTIONS[code](message)


# --- the library ----------------------------------------------------------------------------------

def _open() -> ctypes.CDLL:
    """Beside this module in an installed tree or a build folder, else where the loader looks."""
    for folder in Path(__file__).resolve().parents[1:5]:
        for place in (folder, folder / "bin"):
            if (place / c.LIBRARY).is_file():
                return ctypes.CDLL(str(place / c.LIBRARY))
    try:
        return ctypes.CDLL(c.LIBRARY)
    except OSError as failure:
        raise ImportError(f"{c.LIBRARY} is neither beside {__file__} nor where the system looks: {failure}") from None


lib = _open()
for _name, (_result, _arguments) in c.FUNCTIONS.items():
    _function = getattr(lib, _name)
    _function.restype, _function.argtypes = _result, _arguments


def call(function: Callable[..., bool], *arguments: Any) -> None:
    """Calls a function of the library that takes an Error last, and raises what it reports."""
    error = c.Error()
    if not function(*arguments, ctypes.byref(error)):
        raise_error(error)


def call_stoppable(function: Callable[..., bool], stop: ctypes.c_int, *arguments: Any) -> None:
    """The same in a thread of its own, so that Ctrl-C reaches Python: it sets `stop`, which the library looks at.
    Raises what a callback raised (stop.failure)."""
    try:
        _call_in_thread(function, stop, *arguments)
    except KeyboardInterrupt:
        raise getattr(stop, "failure", None) or KeyboardInterrupt from None


def _call_in_thread(function: Callable[..., bool], stop: ctypes.c_int, *arguments: Any) -> None:
    if threading.current_thread() is not threading.main_thread():
        call(function, *arguments)
        return
    failures: list[BaseException] = []

    ended = threading.Event()   # not Thread.join: after an interrupt Python 3.11 takes the thread for ended

    def work() -> None:
        try:
            call(function, *arguments)
        except BaseException as failure:   # whatever it is, it is raised below
            failures.append(failure)
        ended.set()

    interrupts: list[BaseException] = []
    thread = threading.Thread(target=work, name="amontons")   # `arguments` live as long as it, whatever comes
    try:
        thread.start()
    except BaseException:
        stop.value = 1
        raise
    while not ended.is_set():   # however often it is interrupted
        try:
            ended.wait()
        except BaseException as interrupt:
            stop.value = 1
            interrupts.append(interrupt)
    for failure in interrupts + failures:
        raise failure


def yaml_text(value: Any) -> str:
    """A setting's value as a scene has it: {"U": 0.01} -> '{"U": 0.01}', None -> "none"; a str is taken as it is."""
    if isinstance(value, str):
        return value
    if value is None:
        return "none"
    return json.dumps(value, default=lambda other: other.tolist() if hasattr(other, "tolist") else str(other))


def c_text(value: Any) -> bytes:
    """A path or a word as C has it, from a str, bytes or a path; nothing else is meant for one, though all has a str()."""
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if not isinstance(value, (str, bytes)):
        raise TypeError(f"{value!r}: a str or a path is wanted, not {type(value).__name__}")
    encoded = value if isinstance(value, bytes) else str(value).encode(errors="surrogateescape")
    if b"\0" in encoded:
        raise InputError(f"{value!r}: a zero byte can stand in no path and no word")
    return encoded


def path_of(value: Any) -> Path:
    """The same where Python goes on with the path."""
    return Path(os.fsdecode(c_text(value)))


def c_text_or_none(value: Any) -> bytes | None:
    return None if value is None else c_text(value)


def c_word(value: Any) -> bytes:
    """A word that may be given as a number, as that of `width=86`."""
    return c_text(value) if isinstance(value, (str, bytes)) else c_text(yaml_text(value))


def fields(struct: Any, options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of a user as fields of a C struct: words where it has words, numbers where it has numbers. ctypes itself takes a
    number for an address."""
    kinds = {name: kind for name, kind, *_ in struct._fields_}
    options_of = [name for name, kind in kinds.items() if kind in (ctypes.c_char_p, ctypes.c_bool, ctypes.c_int32, ctypes.c_double)]
    given: dict[str, Any] = {}
    for name, value in options.items():
        if name not in options_of:
            raise TypeError(f"{name!r} is no option; there are {', '.join(options_of)}")
        given[name] = c_text_or_none(value) if kinds[name] is ctypes.c_char_p else value
    return given


def words(texts: Any) -> Any:
    """char *const[] of strings."""
    if isinstance(texts, (str, bytes)):
        raise TypeError(f"{texts!r}: a list of words is wanted, not one")
    texts = list(texts)
    return (ctypes.c_char_p * max(len(texts), 1))(*map(c_text, texts))


def settings_map(settings: Any) -> Mapping[str, Any]:
    """Settings as a user gave them; none are an empty map."""
    if settings is not None and not isinstance(settings, Mapping):
        raise TypeError(f"{settings!r}: a map of keys and their values is wanted, not {type(settings).__name__}")
    return settings or {}


def setting_words(settings: Mapping[str, Any] | None) -> tuple[Any, int]:
    """{"load.pressure": 0.006} -> the words behind --set, and how many."""
    settings = settings_map(settings)
    return words(f"{key}={yaml_text(value)}" for key, value in settings.items()), len(settings)


class Owner:
    """What owns memory of the library: copied, two would free it."""

    def __copy__(self) -> Any:
        raise TypeError(f"a {type(self).__name__} cannot be copied: it owns memory of the library")

    def __deepcopy__(self, _: Any) -> Any:
        return self.__copy__()

    def __reduce_ex__(self, _: Any) -> Any:
        return self.__copy__()


class Scene(Owner):
    """A scene that was read and checked, to be given to functions as it is. Destroyed with this object."""

    def __init__(self, path: Any, settings: Mapping[str, Any] | None, trust: bool = False) -> None:
        self._as_parameter_ = ctypes.c_void_p()
        read = lib.amontons_scene_read_trusted if trust else lib.amontons_scene_read
        call(read, c_text(path), *setting_words(settings), ctypes.byref(self._as_parameter_))

    def __del__(self) -> None:
        if lib is not None and getattr(self, "_as_parameter_", None):
            lib.amontons_scene_destroy(self)


def printed(function: Callable[..., bool], *before: Any) -> str:
    """What a function writes into the FILE that it takes before its Error."""
    libc = ctypes.CDLL(None)
    libc.open_memstream.restype = ctypes.c_void_p
    libc.fclose.argtypes = libc.free.argtypes = [ctypes.c_void_p]
    text, size = ctypes.c_void_p(), ctypes.c_size_t()
    stream = libc.open_memstream(ctypes.byref(text), ctypes.byref(size))
    try:
        call(function, *before, stream)
    finally:
        libc.fclose(stream)
        said = ctypes.string_at(text.value or 0, size.value) if text.value else b""
        libc.free(text)
    return said.decode()
