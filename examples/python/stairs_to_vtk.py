"""A scene built in code, water down a staircase, written as VTK files for ParaView."""

import sys

import migiwa

until = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
steps = [
    migiwa.box([0.3 * k, 0, 0], [0.3 * (k + 1), 0.6 - 0.15 * k, 0.4], fluid="outside") for k in range(4)
]
scene = migiwa.Scene(
    name="Stairs",
    particle_spacing=0.04,
    fluid=[migiwa.box([0, 0.6, 0], [0.3, 1.0, 0.4])],
    boundary={"surfaces": [migiwa.box([0, 0, 0], [2, 1.5, 0.4], fluid="inside"), *steps]},
)
written = []


def write():
    if simulation.frame % 20 == 0:
        written.append(f"stairs_{len(written):04}.vtk")
        simulation.write_particles(written[-1], fields=["velocity", "density", "gamma"])


simulation = migiwa.Simulation(scene)
write()
simulation.run_until(until, write)
print(f"{len(simulation)} particles, {len(written)} files, the last one {written[-1]}")
