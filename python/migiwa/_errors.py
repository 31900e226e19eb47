"""What goes wrong, as exceptions."""

from __future__ import annotations

import re
from typing import NamedTuple


class Fault(NamedTuple):
    """One thing that is wrong with what was given."""

    place: str
    """``FILE:/json/pointer``, ``FILE:line:column`` or the name of an argument."""
    message: str
    """``expected ..., found ...`` and, where there is one, the remedy."""

    @property
    def pointer(self) -> str:
        """The JSON pointer in the scene, or an empty text where the place has none."""
        found = re.search(r"(?::|^--set )(/.*)$", self.place)
        return found.group(1) if found else ""


class InputError(ValueError):
    """What was given is wrong: a scene, a file, a setting. Carries every fault found."""

    def __init__(self, faults: list[tuple[str, str]]) -> None:
        self.faults = [Fault(*fault) for fault in faults]
        super().__init__("\n".join(f"{fault.place}: {fault.message}" for fault in self.faults))


class MissingError(RuntimeError):
    """Something that this machine lacks: an EGL device, room on a disk."""


class NumericalError(RuntimeError):
    """The simulation has stopped itself: a lost particle, no room left between walls, a state that is not finite."""
