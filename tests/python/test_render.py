"""Pictures of the Python module: those of the program, to the last byte."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import matplotlib.image
import numpy as np

import migiwa

FILE = pathlib.Path(os.environ["MIGIWA_SOURCE"]) / "scenes/corner_drop.json"


class Pictures(unittest.TestCase):
    def test_they_are_the_programs(self):
        simulation = migiwa.Simulation(migiwa.Scene.read(FILE))
        simulation.run_until(0.1)
        picture = simulation.render((320, 200))
        self.assertEqual((picture.shape, picture.dtype), ((200, 320, 3), np.uint8))
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["MIGIWA_PROGRAM"], "render", FILE, "--out", folder, "--times", "0.1", "--size",
                            "320x200", "--quiet"], check=True, capture_output=True)
            known = matplotlib.image.imread(next(pathlib.Path(folder).glob("*.png")))
        np.testing.assert_array_equal(picture, (known[..., :3] * 255).round().astype(np.uint8))
        other = simulation.render((320, 200), view={"color": "gamma"})
        self.assertFalse(np.array_equal(picture, other))
        simulation.step()

    def test_bad_input(self):
        simulation = migiwa.Simulation(migiwa.Scene.read(FILE))
        self.assertRaises(ValueError, simulation.render, (0, 10))
        self.assertRaises(ValueError, simulation.render, (10**5, 100))
        self.assertRaises(ValueError, simulation.render, (1, 2, 3))
        self.assertRaises(TypeError, simulation.render, ("a", "b"))
        self.assertRaises(TypeError, simulation.render, 3)
        self.assertRaises(migiwa.InputError, simulation.render, (100, 100), view={"colour": "gamma"})
        simulation.close()
        self.assertRaises(RuntimeError, simulation.render)


if __name__ == "__main__":
    unittest.main()
