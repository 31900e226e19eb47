#!/usr/bin/env python3
"""Writes the meshes of scenes/hard/slim_*.json: a bowl of wall thickness 0.1 m as a closed mesh, whole, and broken
in the ways that meshes are broken. `python3 tests/hard_cases/make_shells.py scenes/hard` writes the same files again."""
import math
import pathlib
import random
import sys

AROUND, ALONG = 32, 8  # faces around the axis, and from pole to rim
INNER, OUTER = 0.4, 0.5  # radii (m)


def shell():
    """Vertices, and triangles wound so that normals point out of the solid. The poles come first."""
    vertices = [(0.0, -INNER, 0.0), (0.0, -OUTER, 0.0)]
    rings = {}
    for radius in (INNER, OUTER):
        for k in range(1, ALONG + 1):
            angle = 0.5 * math.pi * k / ALONG
            rings[radius, k] = len(vertices)
            for j in range(AROUND):
                turn = 2 * math.pi * j / AROUND
                vertices.append((radius * math.sin(angle) * math.cos(turn), -radius * math.cos(angle),
                                 radius * math.sin(angle) * math.sin(turn)))
    triangles = []

    def quad(a, b, c, d):
        triangles.append((a, b, c))
        triangles.append((a, c, d))

    for j in range(AROUND):
        n = (j + 1) % AROUND
        triangles.append((0, rings[INNER, 1] + n, rings[INNER, 1] + j))
        triangles.append((1, rings[OUTER, 1] + j, rings[OUTER, 1] + n))
        for k in range(1, ALONG):
            quad(rings[INNER, k] + j, rings[INNER, k] + n, rings[INNER, k + 1] + n, rings[INNER, k + 1] + j)
            quad(rings[OUTER, k] + n, rings[OUTER, k] + j, rings[OUTER, k + 1] + j, rings[OUTER, k + 1] + n)
        quad(rings[INNER, ALONG] + j, rings[INNER, ALONG] + n, rings[OUTER, ALONG] + n, rings[OUTER, ALONG] + j)
    return vertices, triangles


def write(path, about, vertices, triangles):
    with open(path, "w", encoding="ascii") as out:
        out.write(f"# {about}\n")
        for vertex in vertices:
            out.write("v " + " ".join(f"{x:.6g}" for x in vertex) + "\n")
        for triangle in triangles:
            out.write("f " + " ".join(str(k + 1) for k in triangle) + "\n")


def holed(vertices, triangles):
    """A patch of the inner side, 0.3 m wide at the bottom, is missing."""
    def inner_bottom(k):
        x, y, z = vertices[k]
        return math.dist((x, y, z), (0, 0, 0)) < 0.5 * (INNER + OUTER) and math.hypot(x, z) < 0.12
    return vertices, [t for t in triangles if not any(inner_bottom(k) for k in t)]


def slivered(vertices, triangles):
    """Every fifth triangle is cut into three whose new corner lies a millionth of an edge beside one of its edges."""
    vertices, out = list(vertices), []
    for number, (a, b, c) in enumerate(triangles):
        if number % 5 > 0:
            out.append((a, b, c))
            continue
        near = [0.5 * (p + q) + 1e-6 * (r - 0.5 * (p + q))
                for p, q, r in zip(vertices[a], vertices[b], vertices[c])]
        vertices.append(tuple(near))
        k = len(vertices) - 1
        out += [(a, b, k), (b, c, k), (c, a, k)]
    return vertices, out


def inverted(vertices, triangles):
    """A quarter of the triangles, drawn at random, are wound the other way."""
    draw = random.Random(15)
    return vertices, [(a, c, b) if draw.random() < 0.25 else (a, b, c) for a, b, c in triangles]


def crossing(vertices, triangles):
    """Two bowls stand 0.06 m apart, so that each wall cuts through the other."""
    count = len(vertices)
    moved = [(x + 0.06, y + 0.02, z) for x, y, z in vertices]
    return vertices + moved, triangles + [tuple(k + count for k in t) for t in triangles]


def main():
    folder = pathlib.Path(sys.argv[1])
    whole = shell()
    write(folder / "shell.obj", "A bowl of 0.1 m thickness.", *whole)
    for name, change in (("holed", holed), ("slivered", slivered), ("inverted", inverted), ("crossing", crossing)):
        write(folder / f"shell_{name}.obj", " ".join(change.__doc__.split()), *change(*whole))


main()
