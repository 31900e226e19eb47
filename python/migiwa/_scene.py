"""Scenes: from files, from dicts, built in code."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Mapping, NamedTuple, Optional, Union

import numpy
from numpy.typing import NDArray

from . import _core
from ._errors import InputError

Path = Union[str, "os.PathLike[str]"]
Floats = NDArray[numpy.float64]


class Walls(NamedTuple):
    """What walls are at N points."""

    gamma: Floats
    """The part of the kernel's support that no solid covers, shape (N,)."""
    gradient: Floats
    """Its gradient (1/m), shape (N, 3)."""
    distance: Floats
    """To the nearest wall (m), positive in the fluid, shape (N,); infinite without walls."""


class Distances(NamedTuple):
    """Where a wall or a surface is, seen from N points."""

    distance: Floats
    """Signed (m), shape (N,): positive in the fluid, or outside of a surface."""
    normal: Floats
    """Unit normal at the nearest point, shape (N, 3), into the fluid or outwards."""


def points_of(points: Any, name: str = "points") -> Floats:
    """The points as float64, shape (N, 3). Raises ValueError or TypeError for anything else."""
    array = numpy.asarray(points)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"expected {name} as an array of numbers, found {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"expected {name} of shape (N, 3), found {array.shape}")
    return numpy.ascontiguousarray(array, dtype=numpy.float64)


def _plain(value: Any, pointer: str, place: str, faults: list[tuple[str, str]]) -> Any:
    """The value as JSON has it. What JSON does not have becomes a fault and null."""
    if isinstance(value, numpy.ndarray):
        value = value.tolist()
    elif isinstance(value, numpy.generic):
        value = value.item()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, Mapping):
        result = {}
        for key, item in value.items():
            if isinstance(key, str):
                inner = key.replace("~", "~0").replace("/", "~1")
                result[key] = _plain(item, f"{pointer}/{inner}", place, faults)
            else:
                faults.append((f"{place}:{pointer or '/'}", f"expected keys that are texts, found {key!r}"))
        return result
    if isinstance(value, (list, tuple)):
        return [_plain(item, f"{pointer}/{at}", place, faults) for at, item in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        faults.append((f"{place}:{pointer or '/'}", f"expected a finite number, found {value}"))
        return None
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    faults.append((f"{place}:{pointer or '/'}", f"expected what JSON can hold, found {type(value).__name__}"))
    return None


def json_text(value: Any, pointer: str, place: str) -> str:
    """The value as a JSON text. Raises InputError with the pointer of everything that JSON cannot hold."""
    faults: list[tuple[str, str]] = []
    try:
        plain = _plain(value, pointer, place, faults)
    except RecursionError:
        raise InputError([(f"{place}:{pointer or '/'}", "expected a value of some levels, found one within itself")]) from None
    if faults:
        raise InputError(faults)
    return json.dumps(plain)


def _changes(changes: Optional[Mapping[str, Any]], place: str) -> list[tuple[str, str]]:
    if changes is None:
        return []
    if not isinstance(changes, Mapping):
        raise TypeError(f"expected a mapping from JSON pointers to values for set, found {type(changes).__name__}")
    return [(_pointer(pointer), json_text(value, pointer, place)) for pointer, value in changes.items()]


def _pointer(pointer: Any) -> str:
    if not isinstance(pointer, str):
        raise TypeError(f"expected a JSON pointer as a text, found {type(pointer).__name__}")
    if "=" in pointer:
        raise ValueError(f"expected a JSON pointer, found {pointer!r}")
    return pointer


class Scene:
    """A scene that was found valid. It never changes.

    Scene({"particle_spacing": 0.05, ...}) takes the keys of a scene file (docs: scenes/README.md), also as keyword
    arguments; numbers and arrays of NumPy are fine. "format": 1 may be left out. Relative names of files in it are
    relative to ``folder``; ``name`` is that of the scene in faults. ``set`` maps JSON pointers to values that replace
    those of the scene, as ``--set`` of the program does.

    Raises InputError with every fault and its JSON pointer.
    """

    def __init__(
        self,
        keys: Optional[Mapping[str, Any]] = None,
        *,
        folder: Path = ".",
        file_name: str = "scene.json",
        set: Optional[Mapping[str, Any]] = None,
        **more: Any,
    ) -> None:
        if keys is not None and not isinstance(keys, Mapping):
            raise TypeError(f"expected the keys of a scene as a mapping, found {type(keys).__name__}")
        place = os.path.normpath(os.path.join(os.fspath(folder), file_name))
        text = json_text({"format": 1, **(keys or {}), **more}, "", place)
        self._scene = _core.Scene._parse(text, place, _changes(set, place))

    @classmethod
    def read(cls, file: Path, *, set: Optional[Mapping[str, Any]] = None) -> "Scene":
        """The scene of a file. Raises InputError with every fault, as ``migiwa check`` lists them."""
        place = os.fspath(file)
        if not isinstance(place, str):
            raise TypeError(f"expected the name of a file as a text, found {type(place).__name__}")
        return cls._of(_core.Scene._read(place, _changes(set, place)))

    @classmethod
    def _of(cls, core: _core.Scene) -> "Scene":
        scene = cls.__new__(cls)
        scene._scene = core
        return scene

    def to_dict(self) -> dict[str, Any]:
        """Every key with its value in force, defaults included. A Scene of it is the same scene."""
        result: dict[str, Any] = json.loads(self._scene._text())
        return result

    def changed(self, changes: Mapping[str, Any]) -> "Scene":
        """Another scene with other values at JSON pointers: ``scene.changed({"/solver/max_iterations": 5})``."""
        place = self._scene.file
        return Scene._of(_core.Scene._parse(self._scene._text(), place, _changes(changes, place)))

    @property
    def file(self) -> str:
        """The file that it was read from, or what stands for it in faults."""
        return self._scene.file

    @property
    def name(self) -> str:
        """What the scene calls itself."""
        return self._scene.name

    @property
    def duration(self) -> float:
        """Simulated time at the end (s)."""
        return self._scene.duration

    @property
    def particle_spacing(self) -> float:
        """Distance of particles at rest (m)."""
        return self._scene.particle_spacing

    @property
    def support_radius(self) -> float:
        """Of the kernels (m)."""
        return self._scene.support_radius

    @property
    def time_step(self) -> float:
        """Simulated time of a frame (s)."""
        return self._scene.time_step

    @property
    def origin(self) -> tuple[float, float, float]:
        """What positions of a simulation are relative to (m): zero but in a scene far from zero."""
        return self._scene.origin

    @property
    def warnings(self) -> list[str]:
        """What is valid and probably not meant, a sentence each."""
        return self._scene.warnings

    def gamma(self, points: Any, *, method: Optional[str] = None, threads: int = 0) -> Walls:
        """gamma, its gradient and the distance of walls at points (m), shape (N, 3).

        By the scene's method, or by another one of ``boundary.gamma.method``. Walls that move are where they are at the
        start. ``threads`` 0 takes all of the machine.
        """
        at = points_of(points)
        scene = self if method is None else self.changed({"/boundary/handling": "gamma", "/boundary/gamma/method": method})
        return Walls(*scene._scene._gamma(at, threads))

    def distances(self, points: Any) -> Distances:
        """Distance to the nearest wall (m), positive in the fluid, and its normal, at points (m), shape (N, 3)."""
        return Distances(*self._scene._distances(points_of(points)))

    def __repr__(self) -> str:
        return f"<migiwa.Scene {self.file!r}>"


def box(min: Any, max: Any, **more: Any) -> dict[str, Any]:
    """A box between two corners (m), for "fluid" or, with ``fluid="inside"`` or ``"outside"``, for surfaces."""
    return {"shape": "box", "min": min, "max": max, **more}


def sphere(center: Any, radius: Any, **more: Any) -> dict[str, Any]:
    """A sphere (m), for "fluid" or, with ``fluid="inside"`` or ``"outside"``, for surfaces."""
    return {"shape": "sphere", "center": center, "radius": radius, **more}


def plane(point: Any, normal: Any, **more: Any) -> dict[str, Any]:
    """A wall through a point (m); its normal points into the fluid."""
    return {"shape": "plane", "point": point, "normal": normal, **more}


def schema() -> dict[str, Any]:
    """The JSON Schema of scenes."""
    result: dict[str, Any] = json.loads(_core._schema())
    return result
