"""SLIM surfaces: balls with a polynomial each, fitted to a mesh or to points."""

from __future__ import annotations

import os
from typing import Any, NamedTuple, Optional

from . import _core
from ._scene import Distances, Floats, Path, points_of


class SlimValues(NamedTuple):
    """What the blended polynomials say at N points."""

    value: Floats
    """f (m), shape (N,): zero on the surface; not a distance."""
    weight: Floats
    """Sum of the balls' weights, shape (N,); 0 where no ball reaches."""
    gradient: Floats
    """Of f, shape (N, 3)."""


class SlimSurface:
    """A fitted surface: ``SlimSurface.fit``, ``SlimSurface.fit_points`` or ``SlimSurface.read`` makes one."""

    _surface: _core.SlimSurface

    def __init__(self) -> None:
        raise TypeError("expected SlimSurface.fit, SlimSurface.fit_points or SlimSurface.read, found a call of the class")

    @classmethod
    def _of(cls, core: _core.SlimSurface) -> "SlimSurface":
        surface = cls.__new__(cls)
        surface._surface = core
        return surface

    @classmethod
    def fit(
        cls, file: Path, *, degree: int = 2, tolerance: Optional[float] = None, nodes: Optional[int] = None, threads: int = 0
    ) -> "SlimSurface":
        """Fits the mesh or the points of a file, to a tolerance (m) or with so many balls.

        Polynomials have a degree from 1 to 3. Left out, the tolerance is a thousandth of the diagonal.
        """
        wanted = _wanted(tolerance, nodes)
        return cls._of(_core.SlimSurface._fit_file(os.fspath(file), degree, *wanted, threads))

    @classmethod
    def fit_points(
        cls,
        points: Any,
        normals: Any,
        *,
        degree: int = 2,
        tolerance: Optional[float] = None,
        nodes: Optional[int] = None,
        threads: int = 0,
    ) -> "SlimSurface":
        """The same for at least 50 points (m) with normals out of the solid, both of shape (N, 3)."""
        wanted = _wanted(tolerance, nodes)
        return cls._of(
            _core.SlimSurface._fit_points(points_of(points), points_of(normals, "normals"), degree, *wanted, threads)
        )

    @classmethod
    def read(cls, file: Path) -> "SlimSurface":
        """A file that ``save`` or ``migiwa slim`` wrote."""
        return cls._of(_core.SlimSurface._read(os.fspath(file)))

    def save(self, file: Path) -> None:
        """Writes a file that a scene's ``slim`` wall can name."""
        self._surface._save(os.fspath(file))

    def distances(self, points: Any) -> Distances:
        """Signed distance (m), positive outside, and outward normal at points (m), shape (N, 3)."""
        return Distances(*self._surface._distances(points_of(points)))

    def evaluate(self, points: Any) -> SlimValues:
        """The blended polynomials at points (m), shape (N, 3)."""
        return SlimValues(*self._surface._values(points_of(points)))

    @property
    def centres(self) -> Floats:
        """Of the balls (m), shape (len, 3)."""
        return self._surface._nodes()[0]

    @property
    def radii(self) -> Floats:
        """Of the balls (m), shape (len,)."""
        return self._surface._nodes()[1]

    @property
    def degree(self) -> int:
        """Of the polynomials."""
        return self._surface.degree

    @property
    def closed(self) -> bool:
        """Whether it encloses a solid."""
        return self._surface.closed

    @property
    def notes(self) -> list[str]:
        """What was repaired in the input, a sentence each."""
        return self._surface.notes

    @property
    def largest_error(self) -> float:
        """Largest distance (m) from the surface of points that the fit has not seen."""
        return self._surface.largest_error

    @property
    def mean_error(self) -> float:
        """Mean of the same (m)."""
        return self._surface.mean_error

    def __len__(self) -> int:
        return len(self._surface)

    def __repr__(self) -> str:
        return f"<migiwa.SlimSurface of {len(self)} balls of degree {self.degree}>"


def _wanted(tolerance: Optional[float], nodes: Optional[int]) -> tuple[float, int]:
    if tolerance is not None and not tolerance > 0:
        raise ValueError(f"expected a tolerance of more than 0 m, found {tolerance}")
    if nodes is not None and not nodes > 0:
        raise ValueError(f"expected at least one node, found {nodes}")
    return tolerance or 0.0, nodes or 0
