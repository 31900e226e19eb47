"""The paper's Figure 3: how far Eq. 14 is from gamma by Monte Carlo, where two planes meet at a right angle."""

import sys

import matplotlib.pyplot as plt
import numpy as np

import migiwa

size = int(sys.argv[1]) if len(sys.argv) > 1 else 60
scene = migiwa.Scene(
    particle_spacing=0.05,
    boundary={"surfaces": [migiwa.plane([0, 0, 0], [0, 1, 0]), migiwa.plane([0, 0, 0], [1, 0, 0])]},
)
h = scene.support_radius

along = (np.arange(size) + 0.5) / size * h
x, y = np.meshgrid(along, along)
points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
monte_carlo = scene.changed({"/boundary/gamma/samples": 20000})

mean = scene.gamma(points, method="mean").gamma
reference = monte_carlo.gamma(points, method="monte_carlo").gamma
error = (mean - reference).reshape(size, size)
print(f"largest error of Eq. 14: {abs(error).max():.3f}, at its mean {abs(error).mean():.3f}")

picture = plt.pcolormesh(x / h, y / h, error, cmap="RdBu_r", vmin=-0.25, vmax=0.25)
plt.colorbar(picture, label="γ of Eq. 14 − γ by Monte Carlo")
plt.xlabel("distance to one plane over h")
plt.ylabel("distance to the other over h")
plt.gca().set_aspect("equal")
plt.savefig("figure3.png", dpi=150)
