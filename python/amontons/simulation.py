# SPDX-License-Identifier: GPL-2.0-or-later
"""A simulation stepped from Python."""
from __future__ import annotations

import ctypes
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from . import _structs as c
from ._library import Owner, Scene, c_text, c_text_or_none, call, lib, raise_error
from .notebook import progress_html
from .results import Answer


class _Memory:
    """The library's simulation: destroyed when neither its Simulation nor an array over it is left."""

    def __init__(self, *given: Any) -> None:
        self.handle = ctypes.c_void_p()
        self.given = given   # what the library was handed at creation

    def __del__(self) -> None:
        if lib is not None and self.handle:
            lib.amontons_simulation_destroy(self.handle)


def _view(owner: Any, pointer: Any, kind: Any, *shape: int) -> np.ndarray:
    """A read-only array over memory of the library, which lives as long as `owner`."""
    count = int(np.prod(shape))
    buffer = (kind * max(count, 1)).from_address(ctypes.cast(pointer, ctypes.c_void_p).value)
    buffer.owner = owner   # numpy keeps the buffer, the buffer keeps the simulation
    return np.frombuffer(memoryview(buffer).toreadonly(), dtype=kind, count=count).reshape(shape)


class Simulation(Owner):
    """One simulation, step by step::

        simulation = amontons.Simulation("scene.yaml", {"load.pressure": 0.006})
        for step in simulation:
            print(step.t, step.U, step.mu, simulation.slip_rate.max())

    `step` is one StepView, written anew in each step: copy what you keep. x, slip_rate, slip, pressure, shear, status
    are numpy arrays over the simulation's own memory, [nodes] each (in space slip_rate, slip, shear are [nodes, 2],
    along x and y, and there is y, too; in the plane y is None): no copies, always those of the last accepted step. state
    is that of friction that remembers ([nodes, states] where there are several), None where nothing does.

    folder: for results, written by `finish`; None: nothing is written. whole_block: `displacement` will be asked for.
    trust: as for `run`.
    """

    def __init__(self, scene: Any, settings: Mapping[str, Any] | None = None, folder: Any = None, *,
                 overwrite: bool = False, whole_block: bool = False, trust: bool = False) -> None:
        self._scene = Scene(scene, settings, trust)
        self._options = c.RunOptions(folder=c_text_or_none(folder), overwrite=overwrite, whole_block=whole_block)
        self._finished = ctypes.c_bool(False)
        self._block: c.BlockView | None = None
        self.step = c.StepView()
        self._memory: _Memory | None = None
        memory = _Memory(self._scene, self._options)
        call(lib.amontons_simulation_create, self._scene, ctypes.byref(self._options), ctypes.byref(memory.handle))
        self._memory = memory
        self.step.memory = memory   # its contact points there
        lib.amontons_simulation_view(memory.handle, ctypes.byref(self.step))
        contact = self.step.contact
        n, directions = contact.count, contact.tangents
        vector = (n,) if directions == 1 else (n, directions)
        self.x = _view(self._memory, contact.x, ctypes.c_double, n)
        self.y = _view(self._memory, contact.y, ctypes.c_double, n) if contact.y else None
        self.slip_rate = _view(self._memory, contact.slip_rate, ctypes.c_double, *vector)
        self.slip = _view(self._memory, contact.slip, ctypes.c_double, *vector)
        self.pressure = _view(self._memory, contact.pressure, ctypes.c_double, n)
        self.shear = _view(self._memory, contact.shear, ctypes.c_double, *vector)
        self.status = _view(self._memory, contact.status, ctypes.c_uint8, n)
        remembered = (n,) if contact.states == 1 else (n, contact.states)
        self.state = _view(self._memory, contact.state, ctypes.c_double, *remembered) if contact.state else None

    def __del__(self) -> None:
        self._memory = None   # arrays that are left keep it

    def _repr_html_(self) -> str:
        """How far it is, in a notebook."""
        return progress_html(self.step) if self._memory else "a simulation that is closed"

    @property
    def finished(self) -> bool:
        """The scene's end is reached."""
        return self._finished.value

    @property
    def _open(self) -> Any:
        """The handle, for every function that takes one: NULL would crash the library."""
        if not self._memory:
            raise ValueError("this simulation is closed")
        return self._memory.handle

    def advance(self) -> c.StepView:
        """One accepted step, also beyond the scene's end where there is room for one."""
        call(lib.amontons_simulation_step, self._open, ctypes.byref(self.step), ctypes.byref(self._finished))
        return self.step

    def __iter__(self) -> Iterator[c.StepView]:
        """Steps up to the scene's end."""
        error = c.Error()
        one_step, step, finished = lib.amontons_simulation_step, self.step, self._finished
        arguments = (ctypes.byref(step), ctypes.byref(finished), ctypes.byref(error))
        while not finished.value:
            if not one_step(self._open, *arguments):
                raise_error(error)
            yield step

    def set_rod_velocity(self, velocity: float) -> None:
        """The rod moves on with this velocity from where it is; 0: it stands, below 0: back."""
        call(lib.amontons_simulation_set_rod_velocity, self._open, velocity)

    def set_pressure(self, pressure: float) -> None:
        """The pressure on the top from now on, put on at once, stress; step.mu is over the load that acts. Where
        load.pressure is the only load, and on the full mesh ({"reduction.use": "never"})."""
        call(lib.amontons_simulation_set_pressure, self._open, pressure)

    def save(self, path: Any = None) -> bytes:
        """The state: everything on which the next steps depend, to the last bit; also into the file `path`."""
        state = c.SavedState()
        call(lib.amontons_simulation_save, self._open, ctypes.byref(state))
        try:
            if path is not None:
                call(lib.amontons_state_write, ctypes.byref(state), c_text(path))
            return ctypes.string_at(state.bytes, state.size)
        finally:
            lib.amontons_state_free(ctypes.byref(state))

    def restore(self, state: Any) -> None:
        """Puts back a saved state: bytes of `save`, or the path of a file (checkpoint.bin of a run, too). This simulation
        must be of the same scene (time.until, title and pictures may differ), mesh and version; else InputError."""
        if isinstance(state, (bytes, bytearray, memoryview)):
            kept = (ctypes.c_char * len(state)).from_buffer_copy(state)
            saved = c.SavedState(ctypes.addressof(kept), len(state))
            call(lib.amontons_simulation_restore, self._open, ctypes.byref(saved))
        else:
            saved = c.SavedState()
            call(lib.amontons_state_read, c_text(state), ctypes.byref(saved))
            try:
                call(lib.amontons_simulation_restore, self._open, ctypes.byref(saved))
            finally:
                lib.amontons_state_free(ctypes.byref(saved))
        self._finished.value = False
        lib.amontons_simulation_view(self._open, ctypes.byref(self.step))

    def _look(self) -> c.BlockView:
        block = c.BlockView()
        call(lib.amontons_simulation_block, self._open, ctypes.byref(block))
        return block

    @property
    def position(self) -> np.ndarray:
        """[nodes, 2] x and z of all nodes of the mesh, undeformed, length."""
        block = self._look()
        return _view(self._memory, block.position, ctypes.c_double, block.nodes, block.dimensions)

    @property
    def displacement(self) -> np.ndarray:
        """[nodes, 2] of all nodes of the mesh, length: a copy, recovered when asked for (whole_block=True)."""
        block = self._look()
        return _view(self._memory, block.displacement, ctypes.c_double, block.nodes, block.dimensions).copy()

    @property
    def velocity(self) -> np.ndarray:
        """[nodes, 2] of all nodes of the mesh: a copy, recovered when asked for (whole_block=True)."""
        block = self._look()
        return _view(self._memory, block.velocity, ctypes.c_double, block.nodes, block.dimensions).copy()

    @property
    def elements(self) -> list[np.ndarray]:
        """The node numbers of each element, from 0, corners first, in gmsh's order."""
        block = self._look()
        first = _view(self._memory, block.first_node, ctypes.c_int32, block.elements + 1)
        nodes = _view(self._memory, block.element_nodes, ctypes.c_int32, int(first[-1]))
        return np.split(nodes, first[1:-1])

    def finish(self) -> Answer:
        """Writes results and pictures where there is a folder; no step can follow. Attributes: those of RunSummary (mu_M, ...)."""
        summary = c.RunSummary()
        call(lib.amontons_simulation_finish, self._open, ctypes.byref(summary))
        return Answer(summary)
