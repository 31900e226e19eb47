"""Scenes of the Python module: what is valid, and every fault with its pointer."""

import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import migiwa

ROOT = pathlib.Path(os.environ["MIGIWA_SOURCE"])
TANK = {
    "particle_spacing": 0.1,
    "fluid": [migiwa.box([0, 0, 0], [0.5, 0.5, 0.5])],
    "boundary": {"surfaces": [migiwa.box([0, 0, 0], [1, 1, 1], fluid="inside")]},
}


def faults_of(make):
    try:
        make()
    except migiwa.InputError as error:
        return {fault.pointer: fault.message for fault in error.faults}
    raise AssertionError("expected an InputError, found none")


class Scenes(unittest.TestCase):
    def test_a_file_a_dict_and_code_are_the_same_scene(self):
        file = ROOT / "scenes/dam_break.json"
        read = migiwa.Scene.read(file)
        keys = json.loads(file.read_text())
        self.assertEqual(migiwa.Scene(keys).to_dict(), read.to_dict())
        self.assertEqual(migiwa.Scene(read.to_dict()).to_dict(), read.to_dict())
        built = migiwa.Scene(**{key: value for key, value in keys.items() if key != "format"})
        self.assertEqual(built.to_dict(), read.to_dict())
        self.assertEqual((read.duration, read.particle_spacing), (keys["duration"], keys["particle_spacing"]))
        self.assertAlmostEqual(read.support_radius, 2.25 * read.particle_spacing)

    def test_arrays_and_numbers_of_numpy_are_numbers(self):
        plain = migiwa.Scene(TANK)
        scene = migiwa.Scene(TANK, particle_spacing=np.float32(0.1), gravity=np.array([0, -9.81, 0]))
        self.assertEqual(scene.to_dict()["gravity"], plain.to_dict()["gravity"])
        self.assertAlmostEqual(scene.particle_spacing, 0.1, places=7)

    def test_changes_are_those_of_set(self):
        scene = migiwa.Scene(TANK, set={"/solver/max_iterations": 7})
        self.assertEqual(scene.to_dict()["solver"]["max_iterations"], 7)
        self.assertEqual(scene.changed({"/boundary/handling": "none"}).to_dict()["boundary"]["handling"], "none")
        read = migiwa.Scene.read(ROOT / "scenes/dam_break.json", set={"/particle_spacing": 0.2})
        self.assertEqual(read.particle_spacing, 0.2)

    def test_files_are_relative_to_the_folder(self):
        scene = {"particle_spacing": 0.1, "boundary": {"surfaces": [
            {"shape": "mesh", "fluid": "outside", "file": pathlib.Path("bucket.obj")}]}}
        self.assertIn("/boundary/surfaces/0/file", faults_of(lambda: migiwa.Scene(scene)))
        migiwa.Scene(scene, folder=ROOT / "scenes/truth")

    def test_every_fault_has_its_pointer(self):
        faults = faults_of(lambda: migiwa.Scene(TANK, particle_spacing=-1, solver={"iterations": 3}, gravity=[0, 1]))
        self.assertEqual(set(faults), {"/particle_spacing", "/solver/iterations", "/gravity"})
        self.assertIn("did you mean", faults["/solver/iterations"])
        self.assertIn("found -1", faults["/particle_spacing"])

    def test_faults_are_those_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "bad.json"
            file.write_text(json.dumps({"format": 1, "particle_spacing": 0, "fluid": [{"shape": "cube"}], "gravty": 1}))
            program = subprocess.run([os.environ["MIGIWA_PROGRAM"], "check", file], capture_output=True, text=True)
            with self.assertRaises(migiwa.InputError) as caught:
                migiwa.Scene.read(file)
            for line in str(caught.exception).splitlines():
                self.assertIn(line, program.stderr)
            self.assertEqual(len(caught.exception.faults), 3)
            with self.assertRaises(migiwa.InputError) as in_code:
                migiwa.Scene(json.loads(file.read_text()))
            self.assertEqual([fault.message for fault in in_code.exception.faults],
                             [fault.message for fault in caught.exception.faults])

    def test_what_json_cannot_hold_is_a_fault_in_its_place(self):
        faults = faults_of(lambda: migiwa.Scene(TANK, gravity=[0, math.nan, 0], duration=math.inf, name=b"x",
                                                solver={3: 4}, view=object()))
        self.assertEqual(set(faults), {"/gravity/1", "/duration", "/name", "/solver", "/view"})
        self.assertIn("nan", faults["/gravity/1"])
        cyclic = {}
        cyclic["boundary"] = cyclic
        self.assertRaises(migiwa.InputError, migiwa.Scene, cyclic)

    def test_a_file_that_is_not_there(self):
        self.assertRaises(migiwa.InputError, migiwa.Scene.read, "gone.json")
        self.assertRaises(migiwa.InputError, migiwa.Scene.read, "/")
        self.assertRaises(TypeError, migiwa.Scene.read, 3)
        self.assertRaises(TypeError, migiwa.Scene.read, b"gone.json")

    def test_wrong_types(self):
        self.assertRaises(TypeError, migiwa.Scene, [1, 2])
        self.assertRaises(TypeError, migiwa.Scene, "scene.json")
        self.assertRaises(TypeError, migiwa.Scene, TANK, set=["/a=1"])
        self.assertRaises(TypeError, migiwa.Scene, TANK, set={3: 1})
        self.assertRaises(ValueError, migiwa.Scene, TANK, set={"/a=b": 1})
        self.assertRaises(migiwa.InputError, migiwa.Scene, TANK, set={"solver": 1})

    def test_the_schema_is_the_shipped_one(self):
        self.assertEqual(migiwa.schema(), json.loads((ROOT / "scenes/scene.schema.json").read_text()))


class WallsOfScenes(unittest.TestCase):
    def test_gamma_is_a_half_a_quarter_an_eighth(self):
        scene = migiwa.Scene(TANK)
        walls = scene.gamma([[0.5, 0.5, 0.5], [0.5, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])
        np.testing.assert_allclose(walls.gamma, [1, 0.5, 0.25, 0.125], atol=1e-3)
        np.testing.assert_allclose(walls.distance, [0.5, 0, 0, 0], atol=1e-6)

    def test_the_gradient_is_that_of_differences(self):
        scene = migiwa.Scene(TANK)
        d = 1e-3
        at = np.array([[0.5, 0.06, 0.5]])
        across = np.array([[0, d, 0]])
        difference = (scene.gamma(at + across).gamma - scene.gamma(at - across).gamma) / (2 * d)
        np.testing.assert_allclose(scene.gamma(at).gradient[0], [0, difference[0], 0], rtol=0.01, atol=0.01)

    def test_a_method_can_be_named(self):
        scene = migiwa.Scene(TANK)
        points = np.array([[0.02, 0.02, 0.5]])
        self.assertGreater(scene.gamma(points, method="mean").gamma[0], scene.gamma(points).gamma[0] + 0.05)
        self.assertIn("/boundary/gamma/method", faults_of(lambda: scene.gamma(points, method="men")))

    def test_distances_are_those_of_a_sphere(self):
        scene = migiwa.Scene(particle_spacing=0.1,
                             boundary={"surfaces": [migiwa.sphere([0, 0, 0], 1, fluid="outside")]})
        points = np.random.default_rng(1).normal(size=(200, 3))
        radius = np.linalg.norm(points, axis=1)
        answer = scene.distances(points)
        np.testing.assert_allclose(answer.distance, radius - 1, atol=1e-6)
        np.testing.assert_allclose(answer.normal, points / radius[:, None], atol=1e-6)

    def test_bad_points(self):
        scene = migiwa.Scene(TANK)
        for ask in (scene.gamma, scene.distances):
            for bad in ([1, 2, 3], [[1, 2]], np.zeros((2, 3, 1)), np.zeros((0,)), 3, [[0, 0, math.nan]], [[0, 0, math.inf]]):
                self.assertRaises(ValueError, ask, bad)
            for bad in ("abc", [["a", "b", "c"]], np.zeros((1, 3), complex), [[None, 1, 2]], object()):
                self.assertRaises(TypeError, ask, bad)
            ask(np.zeros((0, 3)))
            ask(np.asfortranarray(np.ones((5, 3), np.float32))[::2])
        self.assertRaises(ValueError, scene.gamma, [[0, 0, 0]], threads=-1)
        self.assertRaises(ValueError, scene.gamma, [[0, 0, 0]], threads=1000)


if __name__ == "__main__":
    unittest.main()
