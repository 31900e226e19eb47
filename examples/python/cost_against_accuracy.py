"""What accuracy costs: the density error that is left at several numbers of iterations, with gamma and without, over time."""

import sys
import time

import matplotlib.pyplot as plt

import migiwa

until = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
scene = migiwa.Scene(
    particle_spacing=0.1,
    fluid=[migiwa.box([0, 0, 0], [0.6, 1, 1])],
    boundary={"surfaces": [migiwa.box([0, 0, 0], [2, 1.5, 1], fluid="inside")]},
    solver={"time_step": 0.01, "min_iterations": 1, "tolerance": 0.0005},
)
for handling in ("gamma", "none"):
    costs, errors = [], []
    for iterations in (1, 2, 4, 8):
        changes = {"/boundary/handling": handling, "/solver/max_iterations": iterations}
        with migiwa.Simulation(scene.changed(changes)) as simulation:
            began = time.perf_counter()
            simulation.run_until(until)
            costs.append((time.perf_counter() - began) / simulation.time)
            report = simulation.report()
        errors.append(report["density_error"]["mean"])
        print(f"{handling}, {iterations} iterations: {costs[-1]:.3f} s a second, mean density error {errors[-1]:.2%}")
    plt.loglog(costs, errors, "o-", label=handling)
plt.xlabel("cost (s a simulated second)")
plt.ylabel("mean density error")
plt.legend()
plt.savefig("cost_against_accuracy.png", dpi=150)
