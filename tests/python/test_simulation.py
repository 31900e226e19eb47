"""Simulations of the Python module: the program's states, views without copies, settings, callbacks, files."""

import gc
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import migiwa

ROOT = pathlib.Path(os.environ["MIGIWA_SOURCE"])
PROGRAM = os.environ["MIGIWA_PROGRAM"]
ARRAYS = ("positions", "velocities", "density", "gamma", "lambda_", "ids")


def tank(**more):
    return migiwa.Scene(
        {
            "particle_spacing": 0.1,
            "fluid": [migiwa.box([0, 0, 0], [0.5, 0.5, 0.5])],
            "boundary": {"surfaces": [migiwa.box([0, 0, 0], [1, 1, 1], fluid="inside")]},
            **more,
        }
    )


def drop(**more):
    """Water that nothing holds."""
    return migiwa.Scene({"particle_spacing": 0.1, "gravity": [0, 0, 0], "fluid": [migiwa.box([0, 0, 0], [0.3, 0.3, 0.3])], **more})


def address(array):
    return array.__array_interface__["data"][0]


def program_report(folder, *arguments):
    report = pathlib.Path(folder) / "report.json"
    subprocess.run([PROGRAM, "simulate", *map(str, arguments), "--quiet", "--report", report], check=True)
    return json.loads(report.read_text())


class AsTheProgram(unittest.TestCase):
    def test_the_hash_and_the_report_are_the_programs(self):
        file = ROOT / "scenes/dam_break.json"
        with tempfile.TemporaryDirectory() as folder:
            known = program_report(folder, file, "--until", "0.1")
        simulation = migiwa.Simulation(migiwa.Scene.read(file))
        simulation.run_until(0.1)
        self.assertEqual(simulation.state_hash, known["state_hash"])
        found = simulation.report()
        self.assertEqual(set(found), set(known))
        for key in ("steps", "particles", "settled", "max_speed", "iterations", "handling"):
            if key in known:
                self.assertEqual(found[key], known[key], key)
        self.assertEqual(simulation.measures(), known["settled"])
        by_steps = migiwa.Simulation(migiwa.Scene.read(file), threads=1)
        by_steps.step(simulation.frame)
        self.assertEqual(by_steps.state_hash, known["state_hash"])

    def test_saves_go_to_and_fro(self):
        with tempfile.TemporaryDirectory() as folder:
            scene_file = pathlib.Path(folder) / "tank.json"
            scene_file.write_text(json.dumps(tank().to_dict()))
            save = pathlib.Path(folder) / "half.save"
            scene = migiwa.Scene.read(scene_file)
            simulation = migiwa.Simulation(scene)
            simulation.run_until(0.2)
            simulation.save(save)
            resumed = migiwa.Simulation.resume(scene, save)
            self.assertEqual((resumed.time, resumed.state_hash), (simulation.time, simulation.state_hash))
            simulation.run_until(0.4)
            resumed.run_until(0.4)
            self.assertEqual(resumed.state_hash, simulation.state_hash)
            known = program_report(folder, scene_file, "--until", "0.4", "--resume", save)
            self.assertEqual(known["state_hash"], simulation.state_hash)
            with self.assertRaises(migiwa.InputError) as caught:
                migiwa.Simulation.resume(tank(gravity=[0, -1, 0]), save)
            self.assertIn("gravity", str(caught.exception))
            self.assertRaises(migiwa.InputError, migiwa.Simulation.resume, scene, scene_file)
            self.assertRaises(migiwa.InputError, simulation.save, pathlib.Path(folder) / "no/such/folder")


class Views(unittest.TestCase):
    def test_arrays_are_views_of_one_memory(self):
        simulation = migiwa.Simulation(tank())
        for name in ARRAYS:
            first, second = getattr(simulation, name), getattr(simulation, name)
            self.assertEqual(address(first), address(second), name)
            self.assertFalse(first.flags.owndata, name)
            self.assertFalse(first.flags.writeable, name)
            self.assertEqual(len(first), len(simulation), name)
            self.assertTrue(simulation.is_current(first), name)
            self.assertTrue(simulation.is_current(first[3:]), name)
        self.assertEqual(simulation.positions.shape, (125, 3))
        self.assertEqual(simulation.positions.strides, (16, 4))
        self.assertEqual(sorted(simulation.ids), list(range(125)))
        self.assertFalse(simulation.is_current(simulation.positions.copy()))
        self.assertFalse(simulation.is_current(np.zeros(3)))

    def test_a_held_array_keeps_its_frame(self):
        simulation = migiwa.Simulation(tank())
        simulation.step(3)
        held = {name: getattr(simulation, name) for name in ARRAYS}
        part = simulation.positions[::7, 1]
        copies = {name: array.copy() for name, array in held.items()}
        part_copy = part.copy()
        places = {name: address(array) for name, array in held.items()}
        plain = migiwa.Simulation(tank())
        plain.step(13)
        simulation.step(10)
        for name, array in held.items():
            np.testing.assert_array_equal(array, copies[name])
            self.assertEqual(address(array), places[name])
            self.assertFalse(simulation.is_current(array), name)
            self.assertNotEqual(address(getattr(simulation, name)), places[name])
        np.testing.assert_array_equal(part, part_copy)
        self.assertEqual(simulation.state_hash, plain.state_hash)

    def test_arrays_outlast_their_simulation(self):
        simulation = migiwa.Simulation(tank())
        simulation.step()
        held = simulation.positions
        copy = held.copy()
        simulation.close()
        np.testing.assert_array_equal(held, copy)
        again = migiwa.Simulation(tank())
        again.step()
        left = again.positions
        del again
        gc.collect()
        np.testing.assert_array_equal(left, copy)

    def test_they_cannot_be_written(self):
        simulation = migiwa.Simulation(tank())
        with self.assertRaises(ValueError):
            simulation.positions[0] = 1
        with self.assertRaises(ValueError):
            simulation.velocities[:] *= 2
        with self.assertRaises((AttributeError, TypeError)):
            simulation.positions = 1
        self.assertRaises(ValueError, simulation.positions.setflags, write=True)

    def test_pressure_is_watched_on_request(self):
        simulation = migiwa.Simulation(tank())
        simulation.step()
        self.assertEqual(len(simulation.pressure), 0)
        simulation.watch_pressure()
        simulation.step()
        self.assertEqual(len(simulation.pressure), 125)
        simulation.watch_pressure(False)
        self.assertEqual(len(simulation.pressure), 0)


class Surfaces(unittest.TestCase):
    def test_the_mesh_is_the_programs(self):
        with tempfile.TemporaryDirectory() as folder:
            scene_file = pathlib.Path(folder) / "tank.json"
            scene_file.write_text(json.dumps(tank().to_dict()))
            subprocess.run([PROGRAM, "surface", scene_file, "--every", "0.1", "--until", "0.1", "--out", folder, "--quiet"],
                           check=True, capture_output=True)
            known = pathlib.Path(folder, "tank_surface_000001.ply").read_bytes()
            simulation = migiwa.Simulation(migiwa.Scene.read(scene_file))
            simulation.run_until(0.1)
        surface = simulation.surface()
        header, content = known.split(b"end_header\n", 1)
        self.assertIn(b"element vertex %d\n" % len(surface.positions), header)
        self.assertIn(b"element face %d\n" % len(surface.triangles), header)
        vertices = np.frombuffer(content, "<f4", 9 * len(surface.positions)).reshape(-1, 9)
        np.testing.assert_array_equal(vertices, np.hstack([surface.positions, surface.normals, surface.velocities]))
        self.assertEqual(surface.wet.dtype, bool)
        self.assertTrue(surface.wet.any() and not surface.wet.all())

    def test_it_is_closed_around_the_waters_volume(self):
        simulation = migiwa.Simulation(drop())
        surface = simulation.surface(resolution=0.25)
        edges = surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        there, back = ({tuple(edge) for edge in part.tolist()} for part in (edges, edges[:, ::-1]))
        self.assertEqual(there, back)
        self.assertEqual(len(there), len(edges))
        self.assertFalse(surface.wet.any())
        corners = surface.positions[surface.triangles].astype(float)
        volume = np.einsum("ni,ni->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
        self.assertAlmostEqual(volume, 27 * 0.1**3, delta=0.2 * 27 * 0.1**3)

    def test_without_water_it_is_empty(self):
        surface = migiwa.Simulation(migiwa.Scene(particle_spacing=0.1)).surface()
        self.assertEqual((surface.positions.shape, surface.triangles.shape, len(surface.wet)), ((0, 3), (0, 3), 0))


class Settings(unittest.TestCase):
    def test_changes_take_effect(self):
        simulation = migiwa.Simulation(tank())
        simulation.step()
        simulation.set({"/solver/max_iterations": 1, "/solver/min_iterations": 1, "/boundary/handling": "none",
                        "/effects/viscosity": {"xsph": 0.1}})
        settings = simulation.scene.to_dict()
        self.assertEqual(settings["solver"]["max_iterations"], 1)
        self.assertEqual(settings["boundary"]["handling"], "none")
        self.assertEqual(settings["effects"]["viscosity"]["xsph"], 0.1)
        simulation.step()
        self.assertEqual(set(np.asarray(simulation.gamma)), {1.0})

    def test_what_is_refused_changes_nothing(self):
        simulation = migiwa.Simulation(tank())
        before = simulation.scene.to_dict()
        with self.assertRaises(migiwa.InputError) as caught:
            simulation.set({"/solver/max_iterations": -3})
        self.assertEqual(caught.exception.faults[0].pointer, "/solver/max_iterations")
        self.assertRaises(ValueError, simulation.set, {"/particle_spacing": 0.05})
        self.assertRaises(ValueError, simulation.set, {"/gravity": [0, 0, 0]})
        self.assertRaises(migiwa.InputError, simulation.set, {"/boundary/gamma/method": "monte_carlo"})
        self.assertEqual(simulation.scene.to_dict(), before)
        simulation.step()


class Callbacks(unittest.TestCase):
    def test_each_frame(self):
        simulation = migiwa.Simulation(tank())
        times = []
        simulation.run_until(0.05, lambda: times.append(simulation.time))
        self.assertEqual(len(times), simulation.frame)
        self.assertAlmostEqual(times[-1], 0.05)
        simulation.run_until(1, lambda: simulation.frame < 15)
        self.assertEqual(simulation.frame, 15)

    def test_held_arrays_of_each_frame(self):
        simulation = migiwa.Simulation(tank())
        held = []
        simulation.run_until(0.05, lambda: held.append((simulation.positions, simulation.positions.copy())))
        for array, copy in held:
            np.testing.assert_array_equal(array, copy)

    def test_a_force_accelerates(self):
        simulation = migiwa.Simulation(drop())
        pull = np.array([1.0, -2.0, 0.5], np.float32)

        def force(velocities, positions, dt):
            self.assertEqual(velocities.shape, positions.shape)
            velocities += pull * dt

        simulation.on_velocities(force)
        simulation.run_until(0.5)
        np.testing.assert_allclose(simulation.velocities, np.tile(pull * 0.5, (27, 1)), atol=2e-3)
        # Settings that are changed later leave it in force.
        simulation.set({"/solver/max_iterations": 3})
        simulation.run_until(1)
        np.testing.assert_allclose(simulation.velocities, np.tile(pull, (27, 1)), atol=2e-3)

    def test_a_force_that_does_nothing_changes_nothing(self):
        plain, simulation = migiwa.Simulation(tank()), migiwa.Simulation(tank())
        plain.set({})  # settings that are taken over have gamma evaluated anew
        simulation.on_velocities(lambda velocities, positions, dt: None)
        plain.step(20)
        simulation.step(20)
        self.assertEqual(plain.state_hash, simulation.state_hash)


class Files(unittest.TestCase):
    def test_particles_are_written_in_the_order_of_ids(self):
        with tempfile.TemporaryDirectory() as folder:
            simulation = migiwa.Simulation(tank())
            simulation.step(5)
            for ending in ("vtk", "ply", "obj"):
                simulation.write_particles(f"{folder}/p.{ending}", fields=() if ending == "obj" else ("velocity",))
            lines = pathlib.Path(folder, "p.obj").read_text().splitlines()
            written = np.array([line.split()[1:] for line in lines if line.startswith("v ")], np.float32)
            order = np.argsort(simulation.ids)
            np.testing.assert_array_equal(written, simulation.positions[order])
            self.assertIn(b"velocity 3 125 float", pathlib.Path(folder, "p.vtk").read_bytes())
            self.assertRaises(ValueError, simulation.write_particles, f"{folder}/p.xyz")
            self.assertRaises(ValueError, simulation.write_particles, f"{folder}/p.vtk", fields=["velocty"])
            self.assertRaises(ValueError, simulation.write_particles, f"{folder}/p.obj", fields=["velocity"])
            self.assertRaises(TypeError, simulation.write_particles, f"{folder}/p.vtk", fields="velocity")
            self.assertRaises(migiwa.InputError, simulation.write_particles, f"{folder}/no/p.vtk")


if __name__ == "__main__":
    unittest.main()
