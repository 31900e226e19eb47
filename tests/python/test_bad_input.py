"""What must end in an exception: wrong arguments, use at the wrong time, failing callbacks, threads, forks."""

import copy
import math
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import migiwa


def tank(**more):
    return migiwa.Scene(
        {
            "particle_spacing": 0.1,
            "fluid": [migiwa.box([0, 0, 0], [0.5, 0.5, 0.5])],
            "boundary": {"surfaces": [migiwa.box([0, 0, 0], [1, 1, 1], fluid="inside")]},
            **more,
        }
    )


def squeezed():
    """A lid that leaves the water no room."""
    lid = migiwa.box([0, 0.5, 0], [0.5, 0.7, 0.5], fluid="outside", motion={"velocity": [0, -1, 0]})
    return migiwa.Scene(particle_spacing=0.1, fluid=[migiwa.box([0, 0, 0], [0.5, 0.5, 0.5])],
                        boundary={"surfaces": [migiwa.box([0, 0, 0], [0.5, 1, 0.5], fluid="inside"), lid]})


class Arguments(unittest.TestCase):
    def test_wrong_types(self):
        simulation = migiwa.Simulation(tank())
        for call in (
            lambda: migiwa.Simulation({"particle_spacing": 0.1}),
            lambda: migiwa.Simulation(tank(), threads="2"),
            lambda: simulation.step("1"),
            lambda: simulation.step(1.5),
            lambda: simulation.run_until("1"),
            lambda: simulation.run_until(1, each_frame=3),
            lambda: simulation.on_velocities(3),
            lambda: simulation.set(3),
            lambda: simulation.save(3),
            lambda: simulation.is_current([1, 2]),
            lambda: simulation.surface(resolution="fine"),
            lambda: simulation.surface(smoothing=1.5),
            lambda: copy.deepcopy(simulation),
            lambda: pickle.dumps(simulation),
            lambda: pickle.dumps(tank()),
            lambda: migiwa._core.Simulation(None, 1),
            lambda: migiwa._core.Scene(),
            lambda: migiwa.SlimSurface(),
        ):
            self.assertRaises(TypeError, call)

    def test_wrong_values(self):
        simulation = migiwa.Simulation(tank())
        for call in (
            lambda: migiwa.Simulation(tank(), threads=-1),
            lambda: migiwa.Simulation(tank(), threads=257),
            lambda: simulation.step(-1),
            lambda: simulation.run_until(math.nan),
            lambda: simulation.run_until(math.inf),
            lambda: simulation.run_until(-1),
            lambda: simulation.advance(-1),
            lambda: simulation.run_until(1e300),
            lambda: simulation.surface(resolution=0.01),
            lambda: simulation.surface(resolution=math.nan),
            lambda: simulation.surface(smoothing=-1),
            lambda: simulation.surface(smallest=-1),
        ):
            self.assertRaises(ValueError, call)
        self.assertRaises(migiwa.InputError, migiwa.Simulation, tank(particle_spacing=0.1).changed(
            {"/boundary/gamma/method": "monte_carlo"}))
        with self.assertRaises((TypeError, OverflowError)):
            simulation.step(10**30)
        simulation.step(0)
        self.assertEqual(simulation.frame, 0)

    def test_a_class_without_its_inside(self):
        for kind, name in ((migiwa.Simulation, "step"), (migiwa.Scene, "to_dict"), (migiwa.SlimSurface, "save")):
            with self.assertRaises(AttributeError):
                getattr(kind.__new__(kind), name)("x") if name == "save" else getattr(kind.__new__(kind), name)()


class Times(unittest.TestCase):
    def test_after_the_end(self):
        simulation = migiwa.Simulation(tank())
        simulation.step()
        simulation.close()
        simulation.close()
        self.assertTrue(simulation.closed)
        self.assertIn("closed", repr(simulation))
        for name in ("positions", "ids", "time", "frame", "scene", "state_hash", "trouble", "stopped", "neighbours"):
            with self.assertRaises(RuntimeError):
                getattr(simulation, name)
        for call in (simulation.step, simulation.run_until, simulation.report, lambda: len(simulation),
                     lambda: simulation.set({"/solver/max_iterations": 3}), lambda: simulation.save("x.save"),
                     lambda: simulation.on_velocities(print), lambda: simulation.is_current(np.zeros(3)),
                     simulation.surface, simulation.watch_pressure, simulation.measures,
                     lambda: simulation.write_particles("x.ply")):
            self.assertRaises(RuntimeError, call)
        with migiwa.Simulation(tank()) as other:
            other.step()
        self.assertTrue(other.closed)

    def test_a_simulation_that_has_stopped(self):
        simulation = migiwa.Simulation(squeezed())
        with self.assertRaises(migiwa.NumericalError) as caught:
            simulation.run_until(1)
        self.assertIn("squeezed", str(caught.exception))
        self.assertTrue(simulation.stopped)
        self.assertEqual(simulation.trouble[-1].kind, "squeezed")
        self.assertRaises(migiwa.NumericalError, simulation.step)
        self.assertRaises(migiwa.NumericalError, simulation.run_until, 2)
        self.assertTrue(np.isfinite(simulation.positions).all())

    def test_within_a_callback(self):
        simulation = migiwa.Simulation(tank())
        failures = []

        def each_frame():
            for call in (simulation.step, simulation.close, lambda: simulation.run_until(2)):
                try:
                    call()
                except RuntimeError as error:
                    failures.append(str(error))
            simulation.set({"/solver/max_iterations": 4})

        simulation.run_until(0.01, each_frame)
        self.assertEqual(len(failures), 3 * simulation.frame)

    def test_within_a_step(self):
        simulation = migiwa.Simulation(tank())
        failures = []

        def force(velocities, positions, dt):
            for call in (simulation.step, simulation.close, lambda: simulation.positions, simulation.report):
                try:
                    call()
                except RuntimeError as error:
                    failures.append(str(error))

        simulation.on_velocities(force)
        simulation.step()
        self.assertGreaterEqual(len(failures), 4)


class FailingCallbacks(unittest.TestCase):
    def test_what_each_frame_raises_is_raised(self):
        simulation = migiwa.Simulation(tank())

        def fail():
            if simulation.frame == 3:
                raise KeyError("third")

        self.assertRaises(KeyError, simulation.run_until, 1, fail)
        self.assertEqual(simulation.frame, 3)
        simulation.step()
        self.assertEqual(simulation.frame, 4)

    def test_what_a_force_raises_is_raised(self):
        plain, simulation = migiwa.Simulation(tank()), migiwa.Simulation(tank())
        plain.set({})  # settings that are taken over have gamma evaluated anew
        calls = []

        def fail(velocities, positions, dt):
            calls.append(dt)
            velocities[:] = 100
            if len(calls) == 1:
                raise ZeroDivisionError

            velocities[:] = math.nan

        simulation.on_velocities(fail)
        self.assertRaises(ZeroDivisionError, simulation.step)
        plain.step()
        self.assertEqual(simulation.state_hash, plain.state_hash)
        self.assertRaises(ValueError, simulation.step)
        self.assertRaises(ValueError, simulation.run_until, 1)
        plain.step(2)
        self.assertEqual(simulation.state_hash, plain.state_hash)

    def test_a_force_has_to_return_nothing(self):
        simulation = migiwa.Simulation(tank())
        simulation.on_velocities(lambda velocities, positions, dt: velocities + 1)
        self.assertRaises(TypeError, simulation.step)
        other = migiwa.Simulation(tank())
        other.on_velocities(lambda: None)
        self.assertRaises(TypeError, other.step)

    def test_arrays_of_a_force_are_its_own(self):
        simulation = migiwa.Simulation(tank())
        held = []

        def keep(velocities, positions, dt):
            self.assertFalse(positions.flags.writeable)
            held.append((velocities, positions))

        simulation.on_velocities(keep)
        simulation.step(5)
        hash_before = simulation.state_hash
        for velocities, _ in held:
            velocities[:] = 1e9
        self.assertEqual(simulation.state_hash, hash_before)
        simulation.step()

    def test_an_interrupt_ends_a_run(self):
        simulation = migiwa.Simulation(tank())
        signal.signal(signal.SIGALRM, lambda *_: (_ for _ in ()).throw(KeyboardInterrupt()))
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        try:
            self.assertRaises(KeyboardInterrupt, simulation.run_until, 1e4)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        simulation.step()


class Threads(unittest.TestCase):
    def test_two_simulations_in_two_threads(self):
        known = migiwa.Simulation(tank(), threads=1)
        known.step(60)
        hashes = []

        def run():
            simulation = migiwa.Simulation(tank(), threads=2)
            held = []
            simulation.run_until(60 * simulation.scene.time_step, lambda: held.append(simulation.positions[:1].sum()))
            hashes.append(simulation.state_hash)

        threads = [threading.Thread(target=run) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(hashes, [known.state_hash] * 2)

    def test_one_simulation_in_two_threads(self):
        simulation = migiwa.Simulation(tank())
        thread = threading.Thread(target=lambda: simulation.run_until(simulation.scene.time_step * 400))
        failures = answers = 0
        thread.start()
        while thread.is_alive():
            try:
                simulation.positions.sum()
                answers += 1
            except RuntimeError:
                failures += 1
            time.sleep(0.001)
        thread.join()
        # The lock is given up while it computes.
        self.assertGreater(failures, 0)
        self.assertEqual(simulation.frame, 400)

    def test_another_thread_between_two_frames(self):
        """While a callback of a run waits, others must not begin what the next step would disturb."""
        plain, simulation = migiwa.Simulation(tank(), threads=1), migiwa.Simulation(tank(), threads=2)
        plain.run_until(0.1)
        failures, done = [], threading.Event()

        def meddle():
            while not done.is_set():
                for call in (simulation.report, simulation.surface, simulation.close, lambda: simulation.positions,
                             lambda: simulation.set({"/solver/max_iterations": 1}), lambda: simulation.save(os.devnull)):
                    try:
                        call()
                    except RuntimeError as error:
                        failures.append(str(error))

        thread = threading.Thread(target=meddle)

        def each_frame():
            if simulation.frame == 1:
                thread.start()
            time.sleep(0.002)
            self.assertEqual(len(simulation.positions), 125)
            if simulation.frame == plain.frame:
                done.set()
                thread.join()

        simulation.run_until(0.1, each_frame)
        self.assertGreater(len(failures), 6 * plain.frame)
        self.assertEqual(simulation.state_hash, plain.state_hash)

    def test_a_fork_within_a_callback(self):
        def end_of(run):
            """What becomes of a child that comes back from a callback into the step of its parent."""
            parent, children = os.getpid(), []

            def fork():
                if not children:
                    children.append(os.fork())

            try:
                run(fork)
                code = 1
            except RuntimeError as error:
                code = 0 if "fork" in str(error) else 2
            except BaseException:
                code = 3
            if os.getpid() != parent:
                os._exit(code)
            self.assertEqual(code, 1)
            return os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1])

        simulation = migiwa.Simulation(tank(), threads=2)
        self.assertEqual(end_of(lambda fork: simulation.run_until(0.05, fork)), 0)
        self.assertEqual(end_of(lambda fork: simulation.run_until(0.1, lambda: fork() or simulation.frame < 5)), 0)
        other = migiwa.Simulation(tank(), threads=2)
        forks = []
        other.on_velocities(lambda velocities, positions, dt: forks.pop()() if forks else None)
        self.assertEqual(end_of(lambda fork: (forks.append(fork), other.step())), 0)
        self.assertEqual(end_of(lambda fork: (forks.append(fork), other.run_until(0.05))), 0)
        child = []

        def leave(velocities, positions, dt):
            if not child:
                child.append(os.fork())
                if child[0] == 0:
                    sys.exit(7)

        last = migiwa.Simulation(tank(), threads=2)
        last.on_velocities(leave)
        try:
            last.step()
        except SystemExit as left:
            os._exit(left.code)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child[0], 0)[1]), 7)

    def test_the_interpreter_ends_while_a_thread_computes(self):
        """Python ends daemon threads that ask for its lock: not within a step, whose memory would be left as it is."""
        start = """
import os, sys, threading, time, migiwa
scene = migiwa.Scene(particle_spacing=0.1, fluid=[migiwa.box([0, 0, 0], [0.5, 0.5, 0.5])])
simulation = migiwa.Simulation(scene, threads=2)
threading.excepthook = lambda failure: None
threading.Thread(target=lambda: {}, daemon=True).start()
time.sleep(0.3)
{}
"""
        force = "simulation.on_velocities(lambda velocities, positions, dt: None) or "
        for work in ("simulation.run_until(1e4)", "simulation.run_until(1e4, lambda: None)", "simulation.step(10**7)",
                     force + "simulation.run_until(1e4)", "[scene.gamma([[0, 0, 0]]) for _ in range(10**7)]"):
            for end in ("", "sys.exit(0)"):
                with self.subTest(work=work, end=end):
                    ended = subprocess.run([sys.executable, "-c", start.format(work, end)], capture_output=True, text=True,
                                           timeout=60)
                    self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        forked = start.format("simulation.run_until(1e4)", "child = os.fork()\nsys.exit(child and os.waitpid(child, 0)[1])")
        began = time.monotonic()
        self.assertEqual(subprocess.run([sys.executable, "-c", forked], capture_output=True).returncode, 0)
        self.assertLess(time.monotonic() - began, 30)

    def test_a_fork(self):
        simulation = migiwa.Simulation(tank(), threads=2)
        simulation.step()
        held = simulation.positions
        total = float(held.sum())
        child = os.fork()
        if child == 0:
            code = 1
            try:
                simulation.step()
            except RuntimeError as error:
                code = 2 if "fork" in str(error) else 3
            if code == 2 and float(held.sum()) == total:
                try:
                    simulation.close()
                except RuntimeError:
                    del simulation
                    fresh = migiwa.Simulation(tank(), threads=2)
                    fresh.step()
                    code = 0 if float(fresh.positions.sum()) == total else 4
            os._exit(code)
        _, status = os.waitpid(child, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), 0)
        simulation.step()


if __name__ == "__main__":
    unittest.main()
