#!/usr/bin/env python3
"""Writes bucket.obj, a round vessel, and bucket_water.obj, the water that turns in it once a second."""
import math

RADIUS, HEIGHT, MIDDLE, TURN, GRAVITY, SIDES = 0.25, 0.5, 0.2, 2 * math.pi, 9.81, 64


def write(name, top, rings_of_top):
    """A body of revolution about y over the floor y = 0 whose top is at top(r)."""
    points = [(0, 0, 0), (0, top(0), 0)]
    faces = []

    def ring(radius, height):
        first = len(points)
        for k in range(SIDES):
            angle = 2 * math.pi * k / SIDES
            points.append((radius * math.cos(angle), height, radius * math.sin(angle)))
        return first

    floor = ring(RADIUS, 0)
    tops = [ring(RADIUS * (k + 1) / rings_of_top, top(RADIUS * (k + 1) / rings_of_top)) for k in range(rings_of_top)]
    for k in range(SIDES):
        n = (k + 1) % SIDES
        faces.append((0, floor + k, floor + n))
        faces.append((1, tops[0] + n, tops[0] + k))
        rings = list(zip(tops, tops[1:])) + [(tops[-1], floor)]
        for inner, outer in rings:
            faces.append((inner + k, inner + n, outer + n))
            faces.append((inner + k, outer + n, outer + k))
    with open(name, "w", encoding="ascii") as file:
        for point in points:
            file.write("v %.6g %.6g %.6g\n" % point)
        for face in faces:
            file.write("f %d %d %d\n" % tuple(index + 1 for index in face))


write("bucket.obj", lambda radius: HEIGHT, 1)
write("bucket_water.obj", lambda radius: MIDDLE + TURN**2 * radius**2 / (2 * GRAVITY), 8)
