"""Pictures as the program draws them."""

import numpy
from numpy.typing import NDArray

from ._core import Scene

def render(simulation: object, scene: Scene, width: int, height: int, panels: bool) -> NDArray[numpy.uint8]: ...
