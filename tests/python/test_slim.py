"""SLIM surfaces of the Python module, against a sphere."""

import math
import os
import pathlib
import tempfile
import unittest

import numpy as np

import migiwa


def sphere(count=4000):
    """Points spread evenly over the unit sphere."""
    k = np.arange(count) + 0.5
    z, angle = 1 - 2 * k / count, k * math.pi * (3 - math.sqrt(5))
    r = np.sqrt(1 - z * z)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z])


class Slim(unittest.TestCase):
    def test_a_sphere_is_found_again(self):
        points = sphere()
        surface = migiwa.SlimSurface.fit_points(points, points, degree=2, nodes=300)
        self.assertTrue(surface.closed)
        self.assertEqual(surface.degree, 2)
        self.assertEqual(len(surface), len(surface.radii))
        self.assertIn(str(len(surface)), repr(surface))
        self.assertLess(abs(len(surface) - 300), 30)
        np.testing.assert_allclose(np.linalg.norm(surface.centres, axis=1), 1, atol=0.01)
        rng = np.random.default_rng(2)
        asked = rng.normal(size=(300, 3))
        asked *= (rng.uniform(0.9, 1.1, 300) / np.linalg.norm(asked, axis=1))[:, None]
        radius = np.linalg.norm(asked, axis=1)
        answer = surface.distances(asked)
        np.testing.assert_allclose(answer.distance, radius - 1, atol=2e-3)
        np.testing.assert_allclose(answer.normal, asked / radius[:, None], atol=0.03)
        values = surface.evaluate(asked)
        self.assertTrue((np.sign(values.value) == np.sign(radius - 1))[abs(radius - 1) > 0.01].all())
        self.assertTrue((values.weight > 0).all())
        self.assertLess(surface.largest_error, 5e-3)
        self.assertLessEqual(surface.mean_error, surface.largest_error)

        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "ball.json"
            surface.save(file)
            np.testing.assert_array_equal(migiwa.SlimSurface.read(file).distances(asked).distance, answer.distance)
            scene = migiwa.Scene(particle_spacing=0.05, boundary={"surfaces": [
                {"shape": "slim", "fluid": "outside", "file": file}]})
            np.testing.assert_allclose(scene.distances(asked * 1.1).distance, 1.1 * radius - 1, atol=5e-3)

    def test_a_mesh_file(self):
        file = pathlib.Path(os.environ["MIGIWA_SOURCE"]) / "scenes/hard/shell.obj"
        surface = migiwa.SlimSurface.fit(file, tolerance=0.02)
        self.assertGreater(len(surface), 10)

    def test_bad_input(self):
        points = sphere(200)
        for call in (
            lambda: migiwa.SlimSurface.fit("gone.obj"),
            lambda: migiwa.SlimSurface.read("gone.json"),
            lambda: migiwa.SlimSurface.fit_points(points[:20], points[:20]),
            lambda: migiwa.SlimSurface.fit_points(points, points[:-1]),
            lambda: migiwa.SlimSurface.fit_points(points, points * math.nan),
            lambda: migiwa.SlimSurface.fit_points(points, points, degree=4),
            lambda: migiwa.SlimSurface.fit_points(points, points, tolerance=-1),
            lambda: migiwa.SlimSurface.fit_points(points, points, tolerance=math.nan),
            lambda: migiwa.SlimSurface.fit_points(points, points, nodes=0),
            lambda: migiwa.SlimSurface.fit_points(points, points, nodes=5, tolerance=1),
            lambda: migiwa.SlimSurface.fit_points(points, points, threads=-1),
            lambda: migiwa.SlimSurface.fit_points(np.tile(points[:1], (100, 1)), points[:100]),
        ):
            self.assertRaises(ValueError, call)
        for call in (
            lambda: migiwa.SlimSurface.fit_points("abc", points),
            lambda: migiwa.SlimSurface.fit_points(points, points, degree="2"),
            lambda: migiwa.SlimSurface.fit(3),
        ):
            self.assertRaises(TypeError, call)


if __name__ == "__main__":
    unittest.main()
