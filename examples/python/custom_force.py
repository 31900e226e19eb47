"""Forces of one's own: a drop that a spring holds to the origin swings like any mass on a spring."""

import numpy as np

import migiwa

stiffness, damping = 40.0, 0.0  # of acceleration over distance (1/s^2) and over velocity (1/s)
scene = migiwa.Scene(
    particle_spacing=0.05, gravity=[0, 0, 0], fluid=[migiwa.sphere([0.5, 0, 0], 0.15)], solver={"time_step": 0.002}
)
simulation = migiwa.Simulation(scene)


def spring(velocities, positions, dt):
    # The same for all water, so that the drop keeps its shape.
    velocities -= (stiffness * positions.mean(axis=0) + damping * velocities.mean(axis=0)) * dt


def write_down():
    times.append(simulation.time)
    places.append(simulation.positions.mean(axis=0)[0])


simulation.on_velocities(spring)
times, places = [0.0], [0.5]
simulation.run_until(1.2, write_down)
known = 0.5 * np.cos(np.sqrt(stiffness) * np.array(times))
print(f"after {times[-1]:.2f} s at {places[-1]:.4f} m; farthest from 0.5 cos(w t): {abs(places - known).max():.4f} m")
