"""Migiwa simulates liquids with particles, position based, with the density corrected at walls by gamma.

All quantities are in SI units.

>>> import migiwa
>>> scene = migiwa.Scene(particle_spacing=0.1, fluid=[migiwa.box([0, 0, 0], [1, 1, 1])])
>>> simulation = migiwa.Simulation(scene)
>>> len(simulation)
1000
"""

from ._core import __version__
from ._errors import Fault, InputError, MissingError, NumericalError
from ._scene import Distances, Scene, Walls, box, plane, schema, sphere
from ._simulation import Simulation, Surface, Trouble
from ._slim import SlimSurface, SlimValues

__all__ = [
    "Distances",
    "Fault",
    "InputError",
    "MissingError",
    "NumericalError",
    "Scene",
    "Simulation",
    "SlimSurface",
    "SlimValues",
    "Surface",
    "Trouble",
    "Walls",
    "__version__",
    "box",
    "plane",
    "schema",
    "sphere",
]
