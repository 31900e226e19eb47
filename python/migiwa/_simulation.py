"""Scenes in motion."""

from __future__ import annotations

import json
import os
from types import TracebackType
from typing import Any, Callable, Mapping, NamedTuple, Optional, Sequence

import numpy
from numpy.typing import NDArray

from . import _core
from ._errors import MissingError
from ._scene import Path, Scene

Floats32 = NDArray[numpy.float32]


class Trouble(NamedTuple):
    """Something that went wrong in a run, or that a guard prevented."""

    kind: str
    step: int
    detail: str


class Surface(NamedTuple):
    """A closed mesh around the liquid, of V vertices and T triangles."""

    positions: Floats32
    """Of the vertices (m) relative to ``scene.origin``, shape (V, 3)."""
    triangles: NDArray[numpy.uint32]
    """Three vertices each, counter-clockwise seen from outside the liquid, shape (T, 3)."""
    normals: Floats32
    """At the vertices, out of the liquid, shape (V, 3)."""
    velocities: Floats32
    """Of the liquid at the vertices (m/s), shape (V, 3)."""
    wet: NDArray[numpy.bool_]
    """Whether the liquid touches a wall at a triangle, shape (T,)."""


class Simulation:
    """A scene in motion. The same scene gives the same state for any number of threads, and as the program does.

    ``threads`` 0 takes all of the machine. While it steps, other threads of Python run; meanwhile, and after ``close``,
    it raises RuntimeError for whatever else is asked of it. So it does in a process that was forked from its own.

    The arrays ``positions``, ``velocities``, ``density``, ``gamma``, ``lambda_``, ``pressure`` and ``ids`` show its
    memory without a copy, read-only, in one order, which changes from frame to frame; ``ids`` tell particles apart. An
    array belongs to its frame: at the next step it keeps its values and the memory, and the simulation goes on in a
    copy. ``is_current`` tells whether an array still is that of the present frame.
    """

    def __init__(self, scene: Scene, *, threads: int = 0) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"expected a migiwa.Scene, found {type(scene).__name__}")
        self._simulation = _core.Simulation(scene._scene, threads)

    @classmethod
    def resume(cls, scene: Scene, file: Path, *, threads: int = 0) -> "Simulation":
        """Goes on from a save of the same scene, be it the program's or ``save``'s. Raises InputError with every difference."""
        simulation = cls(scene, threads=threads)
        simulation._simulation._resume(os.fspath(file))
        return simulation

    def __enter__(self) -> "Simulation":
        return self

    def __exit__(
        self, kind: Optional[type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None:
        self.close()

    def close(self) -> None:
        """Ends it and gives its memory back. Arrays that are still held keep their values."""
        self._simulation.close()

    def step(self, frames: int = 1) -> None:
        """Advances by frames of ``scene.time_step`` each. Raises NumericalError where the simulation stops itself."""
        self._simulation._step(frames)

    def advance(self, seconds: float) -> None:
        """Advances by a time (s), to the nearest frame."""
        self.run_until(self.time + seconds)

    def run_until(self, time: Optional[float] = None, each_frame: Optional[Callable[[], Any]] = None) -> None:
        """Advances to the frame on which a time (s) falls; left out: the scene's duration.

        ``each_frame`` is called after every frame and may read arrays and change settings; if it returns False, the
        run ends. What it raises ends the run, too, and is raised here. The last tenth of the run is measured for the
        report, as by ``migiwa simulate``.
        """
        self._simulation._run_until(self.scene.duration if time is None else time, each_frame)

    @property
    def scene(self) -> Scene:
        """With the settings in force."""
        return Scene._of(self._simulation._scene_copy())

    def set(self, changes: Mapping[str, Any]) -> None:
        """Changes settings from the next frame on: ``simulation.set({"/solver/max_iterations": 5})``.

        Takes JSON pointers of the scene's solver, effects and of how walls are corrected. Raises InputError for values
        that are not valid, and ValueError for what needs a new simulation; nothing has changed then.
        """
        self._simulation._apply(self.scene.changed(changes)._scene)

    def on_velocities(self, callback: Callable[[Floats32, Floats32, float], None]) -> None:
        """Has ``callback(velocities, positions, dt)`` change velocities (m/s) in place, in every substep of dt (s).

        This is where effects act on velocities: after the density was corrected, so a force adds acceleration times dt.
        Both arrays are copies, float32, of shape (N, 3) (m/s, m relative to ``scene.origin``). What the callback raises
        is raised by the step, whose frame is completed without the callback. It must leave finite numbers.
        """
        if not callable(callback):
            raise TypeError(f"expected something to call, found {type(callback).__name__}")
        self._simulation._on_velocities(callback)

    @property
    def positions(self) -> Floats32:
        """Positions (m) relative to ``scene.origin``, float32, shape (N, 3); rows are 16 bytes apart."""
        return self._simulation.positions

    @property
    def velocities(self) -> Floats32:
        """Velocities (m/s), float32, shape (N, 3); rows are 16 bytes apart."""
        return self._simulation.velocities

    @property
    def density(self) -> Floats32:
        """Density over that at rest (1), after the last iteration, float32, shape (N,)."""
        return self._simulation.density

    @property
    def gamma(self) -> Floats32:
        """The part of each particle's support that no solid covers (1), float32, shape (N,)."""
        return self._simulation.gamma

    @property
    def lambda_(self) -> Floats32:
        """lambda of the last iteration times the squared support radius (1), float32, shape (N,)."""
        return self._simulation.lambda_

    @property
    def pressure(self) -> Floats32:
        """Pressure of the last step (Pa), float32, shape (N,); empty until ``watch_pressure`` and a step."""
        return self._simulation.pressure

    @property
    def ids(self) -> NDArray[numpy.uint32]:
        """Numbers that tell particles apart from frame to frame, uint32, shape (N,)."""
        return self._simulation.ids

    @property
    def neighbours(self) -> NDArray[numpy.uint32]:
        """How many neighbours each particle has, uint32, shape (N,): a copy."""
        return self._simulation.neighbours

    def is_current(self, array: NDArray[Any]) -> bool:
        """Whether an array, or a part of one, shows the memory of the present frame."""
        return self._simulation._is_current(array)

    def watch_pressure(self, on: bool = True) -> None:
        """Has ``pressure`` filled from the next frame on. The state is the same either way."""
        self._simulation._watch_pressure(on)

    @property
    def time(self) -> float:
        """Simulated time (s)."""
        return self._simulation.time

    @property
    def frame(self) -> int:
        """Frames so far."""
        return self._simulation.frame

    @property
    def threads(self) -> int:
        """Threads that it computes with."""
        return self._simulation.threads

    @property
    def stopped(self) -> bool:
        """Whether it has stopped itself; ``trouble`` says why."""
        return self._simulation.stopped

    @property
    def closed(self) -> bool:
        """Whether ``close`` was called."""
        return self._simulation.closed

    @property
    def state_hash(self) -> str:
        """Hash of ids, positions and velocities, 16 hexadecimal digits, as in reports of the program."""
        return self._simulation.state_hash

    @property
    def trouble(self) -> list[Trouble]:
        """What went wrong so far, and what guards prevented."""
        return [Trouble(*one) for one in self._simulation._trouble]

    def report(self) -> dict[str, Any]:
        """What the run did: the keys of ``migiwa simulate --report`` (docs/report.md)."""
        result: dict[str, Any] = json.loads(self._simulation._report())
        return result

    def measures(self) -> dict[str, Any]:
        """Of settled water: height (m), edge crowding, spacings, speed (m/s); the report's "settled".

        Of the last tenth of a run that ``run_until`` has just ended, otherwise of the present frame.
        """
        result: dict[str, Any] = self.report()["settled"]
        return result

    def render(
        self, size: tuple[int, int] = (1280, 720), *, view: Optional[Mapping[str, Any]] = None, panels: bool = False
    ) -> NDArray[numpy.uint8]:
        """A picture as ``migiwa render`` draws it: uint8, shape (height, width, 3). Needs EGL, and no display.

        ``size``: width and height (pixels). ``view``: keys of the scene's view, such as {"color": "gamma"}. Raises
        MissingError where OpenGL is missing.
        """
        width, height = size
        try:
            from . import _render
        except ImportError as error:
            raise MissingError(f"pictures need the part of the package that draws them: {error}") from None
        scene = self.scene.changed({f"/view/{key}": value for key, value in (view or {}).items()})
        return _render.render(self._simulation._capsule(), scene._scene, width, height, panels)

    def surface(self, *, resolution: float = 0.5, smoothing: int = 10, smallest: float = 0) -> Surface:
        """The surface of the liquid as ``migiwa surface`` makes it; without particles a mesh of nothing.

        ``resolution``: cells of the grid over the particle spacing, 0.1 to 2. ``smoothing``: passes over the free
        surface, 0 to 100. ``smallest``: pieces of less than so many particles' volume are left out.
        """
        return Surface(*self._simulation._surface(resolution, smoothing, smallest))

    def save(self, file: Path) -> None:
        """Saves the state, to go on with ``resume`` or ``migiwa simulate --resume``."""
        self._simulation._save(os.fspath(file))

    def write_particles(self, file: Path, fields: Sequence[str] = ()) -> None:
        """Writes the particles in the order of their ids, as .vtk, .ply or .obj by the file's ending.

        ``fields``: some of "velocity", "density", "gamma" and what else docs/export.md lists; none for .obj.
        """
        name = os.fspath(file)
        if isinstance(fields, str):
            raise TypeError("expected a sequence of names for fields, found one text")
        self._simulation._write_particles(name, os.path.splitext(name)[1][1:], list(fields))

    def __len__(self) -> int:
        return len(self._simulation)

    def __repr__(self) -> str:
        if self.closed:
            return "<migiwa.Simulation, closed>"
        return f"<migiwa.Simulation of {len(self)} particles at {self.time:.4g} s>"
