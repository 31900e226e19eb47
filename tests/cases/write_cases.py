"""The kinds of files that people bring, small: meshes from other programs, sources that touch or overlap, water that
leaves, coordinates of maps, wrong units. write(FOLDER) writes them and returns what each is to come to."""
import json
import math
import pathlib
import random
import struct


def block(low, high, **more):
    return {"shape": "box", "min": low, "max": high, **more}


def tank(low, high):
    return block(low, high, fluid="inside")


def mesh(file, fluid=None, **more):
    return {"shape": "mesh", "file": file, **({"fluid": fluid} if fluid else {}), **more}


def block_faces(low, high):
    corners = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    squares = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, [(q[0], q[k], q[k + 1]) for q in squares for k in (1, 2)]


def revolved(profile, around):
    """A surface about y of a profile of (radius, y); outwards where y falls along its outside."""
    points, rings = [], []
    for radius, y in profile:
        ring = range(len(points), len(points) + (around if radius > 0 else 1))
        turns = [2 * math.pi * k / around for k in range(len(ring))]
        points += [(radius * math.cos(turn), y, radius * math.sin(turn)) for turn in turns]
        rings.append(ring)
    faces = []
    for upper, lower in zip(rings, rings[1:]):
        for k in range(around):
            a, b, c, d = (ring[(k + step) % around % len(ring)] for ring in (upper, lower) for step in (0, 1))
            faces += [face for face in ((a, b, d), (a, d, c)) if len(set(face)) == 3]
    return points, faces


def ball_faces(center, radius, rings=16):
    angles = [math.pi * k / rings for k in range(rings + 1)]
    inner = [(radius * math.sin(a), radius * math.cos(a)) for a in angles[1:-1]]
    points, faces = revolved([(0, radius)] + inner + [(0, -radius)], 2 * rings)
    return [tuple(p + c for p, c in zip(point, center)) for point in points], faces


def cup_faces(radius, thickness, rings=12):
    angles = [math.pi / 2 * k / rings for k in range(1, rings + 1)]
    inner = [(radius * math.sin(a), -radius * math.cos(a)) for a in angles]
    outer = [(r * (1 + thickness / radius), y * (1 + thickness / radius)) for r, y in reversed(inner)]
    end = [*outer, (0, -radius - thickness)] if thickness else []
    return revolved([(0, -radius)] + inner + end, 36)


def sheet_faces(corner, a, b, cells):
    """A parallelogram of squares, from a corner along two vectors."""
    at = lambda i, j: tuple(c + i / cells * p + j / cells * q for c, p, q in zip(corner, a, b))
    points = [at(i, j) for i in range(cells + 1) for j in range(cells + 1)]
    rows = [[i * (cells + 1) + j for j in range(cells + 1)] for i in range(cells + 1)]
    squares = [(rows[i][j], rows[i][j + 1], rows[i + 1][j + 1], rows[i + 1][j])
               for i in range(cells) for j in range(cells)]
    return points, squares


class Writer:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.expected = {}

    def obj(self, name, *parts):
        lines, first = [], 1
        for points, faces in parts:
            lines += ["v %.9g %.9g %.9g" % point for point in points]
            lines += ["f " + " ".join(str(k + first) for k in face) for face in faces]
            first += len(points)
        (self.folder / name).write_text("\n".join(lines) + "\n")

    def binary_stl(self, name, part):
        points, faces = part
        facets = [struct.pack("<12fH", 0, 0, 0, *(c for k in face for c in points[k]), 0) for face in faces]
        (self.folder / name).write_bytes(b"part".ljust(80) + struct.pack("<I", len(facets)) + b"".join(facets))

    def text_stl(self, name, part, noise):
        """Every triangle has its own corners, which differ by as much as `noise` (m) from those of others."""
        drawn, lines = random.Random(1), ["solid part"]
        for face in part[1]:
            lines += ["facet normal 0 0 0", "outer loop"]
            for k in face:
                lines.append("vertex " + " ".join("%.12g" % (c + drawn.uniform(-noise, noise)) for c in part[0][k]))
            lines += ["endloop", "endfacet"]
        (self.folder / name).write_text("\n".join(lines) + "\nendsolid part\n")

    def scene(self, name, fluid, surfaces, expected, spacing=0.05, duration=0.5, **more):
        scene = {"format": 1, "duration": duration, "particle_spacing": spacing, "fluid": fluid,
                 "boundary": {"surfaces": surfaces}, **more}
        (self.folder / f"{name}.json").write_text(json.dumps(scene, indent=1) + "\n")
        self.expected[name] = expected


def write(folder):
    """Returns by the name of a scene what its run is to come to, in the columns of run_cases.py: a value, or the least
    and the largest."""
    w = Writer(folder)
    weightless = {"gravity": [0, 0, 0], "duration": 0.1}
    near_none = (0, 0.5)  # energy that is gained (J/kg)
    kept = {"exit": 0, "left": 0, "lost": 0, "gain": near_none}

    # A tank from a CAD program is what the box is.
    water = [block([0, 0, 0], [1, 0.5, 0.5])]
    w.binary_stl("tank.stl", block_faces((0, 0, 0), (1, 1, 0.5)))
    w.scene("tank_mesh", water, [mesh("tank.stl", "inside")], {**kept, "particles": 2000, "warnings": 0})
    w.scene("tank_box", water, [tank([0, 0, 0], [1, 1, 0.5])], {**kept, "particles": 2000, "warnings": 0})

    # Open meshes, and those that are thinner than a particle.
    w.obj("sheet.obj", sheet_faces((-0.6, 0, -0.6), (1.2, 0, 0), (0, 0, 1.2), 6))
    w.scene("sheet", [block([-0.2, 0.1, -0.2], [0.2, 0.5, 0.2])], [mesh("sheet.obj", "outside")],
            {"exit": 0, "lost": 0, "gain": near_none, "warnings": 1}, duration=1)
    w.obj("tee.obj", sheet_faces((-0.5, 0, -0.5), (0.5, 0, 0), (0, 0, 1), 4),
          sheet_faces((0, 0, -0.5), (0.5, 0, 0), (0, 0, 1), 4), sheet_faces((0, 0, -0.5), (0, 0.6, 0), (0, 0, 1), 4))
    w.scene("tee", [block([-0.3, 0.05, -0.3], [-0.05, 0.5, 0.3])], [mesh("tee.obj", "outside")],
            {"exit": 0, "lost": 0, "gain": near_none}, duration=0.5)
    tap = [{"shape": "disc", "center": [0, 0.4, 0], "radius": 0.05, "direction": [0, -1, 0], "speed": 1}]
    for name, thickness in (("open", 0), ("2mm", 0.002), ("20mm", 0.02)):
        w.obj(f"cup_{name}.obj", cup_faces(0.15, thickness))
        w.scene(f"cup_{name}", [block([-0.06, 0.02, -0.06], [0.06, 0.15, 0.06])],
                [mesh(f"cup_{name}.obj", "outside")], {"exit": 0, "lost": 0, "gain": near_none}, spacing=0.02,
                duration=1, emitters=tap)

    # Parts of one mesh that overlap, touch, or lie within each other.
    w.obj("balls.obj", ball_faces((0, 0.5, 0), 0.4), ball_faces((0.35, 0.5, 0), 0.4))
    w.scene("balls_fluid", [mesh("balls.obj")], [], {"exit": 0, "particles": (6500, 6940)}, spacing=0.04, **weightless)
    w.scene("balls_wall", [block([-1, 0, -1], [1, 1.2, 1])],
            [tank([-1, 0, -1], [1, 1.5, 1]), mesh("balls.obj", "outside")],
            {**kept, "particles": (33500, 35500)}, duration=0.1)
    w.obj("touching.obj", block_faces((0, 0, 0), (0.5, 0.5, 0.5)), block_faces((0.5, 0, 0), (1, 0.5, 0.5)))
    w.scene("touching", [mesh("touching.obj")], [], {"exit": 0, "particles": 2000}, **weightless)

    # Sources that touch or overlap.
    basin = tank([0, 0, 0], [2, 2, 0.5])
    w.scene("layers", [block([0, 0, 0], [2, 0.33, 0.5]), block([0, 0.33, 0], [2, 0.66, 0.5])], [basin],
            {**kept, "particles": 5200})
    w.scene("overlap", [block([0, 0, 0], [2, 0.5, 0.5]), block([0, 0.25, 0], [2, 0.75, 0.5])], [basin],
            {**kept, "particles": 6000, "warnings": 1})

    # Water that leaves, or is taken away.
    table = block([-0.3, -0.2, -0.3], [0.3, 0, 0.3], fluid="outside")
    spilled = [block([-0.2, 0.05, -0.2], [0.2, 0.3, 0.2])]
    w.scene("table", spilled, [table], {"exit": 0, "lost": 0, "left": (100, 320)}, duration=3)
    w.scene("drained", spilled, [table], {"exit": 0, "lost": 0, "left": 0, "drained": (50, 320)}, duration=1,
            drains=[block([-3, -2, -3], [3, -0.3, 3])])

    # Corners that differ in the last digits.
    for name, noise in (("1nm", 1e-9), ("100nm", 1e-7)):
        w.text_stl(f"cracks_{name}.stl", ball_faces((0, 0.15, 0), 0.15), noise)
        w.scene(f"cracks_{name}", [mesh(f"cracks_{name}.stl")], [tank([-0.5, 0, -0.5], [0.5, 1, 0.5])],
                {**kept, "particles": (1650, 1780), "warnings": 1}, spacing=0.02, duration=0.1)

    # Coordinates of maps.
    for name, east in (("near", 0.0), ("far", 431250.0)):
        w.obj(f"ball_{name}.obj", ball_faces((east, 0, 0), 0.5))
        w.scene(f"ball_{name}", [block([-0.3, -0.3, -0.3], [0.3, 0.3, 0.3])],
                [mesh(f"ball_{name}.obj", "inside", transform={"translate": [-east, 0, 0]})],
                {**kept, "particles": (1700, 1728)})
    w.scene("far_tank", [block([5000, 5000, 5000], [5000.5, 5000.5, 5001])], [tank([5000] * 3, [5001] * 3)],
            {**kept, "particles": 2000, "warnings": 0})

    # Many walls.
    posts = [block([x, 0, z], [x + 0.04, 0.3, z + 0.04], fluid="outside")
             for x in (0.2 + 0.16 * i for i in range(12)) for z in (0.2 + 0.16 * j for j in range(12))]
    w.scene("posts", [block([0, 0.35, 0], [2.2, 0.5, 2.2])], [tank([0, 0, 0], [2.2, 1, 2.2]), *posts],
            {**kept, "particles": 5808}, duration=0.3)

    # Scenes that hold a mistake.
    w.scene("two_tanks", [block([0, 0, 0], [0.5, 0.5, 0.5])], [tank([0, 0, 0], [1, 1, 1]), tank([2, 0, 0], [3, 1, 1])],
            {"exit": 2})
    w.scene("half_outside", [block([-1, 0, 0], [1, 0.5, 1])], [tank([0, 0, 0], [1, 1, 1])],
            {**kept, "particles": 4000, "warnings": 1})
    w.binary_stl("millimetres.stl", ball_faces((0, 0, 0), 150))
    w.scene("millimetres", [block([0, 0, 0], [1, 0.5, 1])],
            [tank([0, 0, 0], [2, 1, 1]), mesh("millimetres.stl", "outside", transform={"translate": [1, 500, 0.5]})],
            {**kept, "warnings": 1}, duration=0.05)
    w.scene("tiny_step", [block([0, 0, 0], [0.2, 0.2, 0.2])], [tank([0, 0, 0], [1, 1, 1])], {"exit": 2},
            solver={"time_step": 1e-20})

    # A needle across its bounding box: 300 m long, 0.3 m wide.
    far, ends = 300 / math.sqrt(3), []
    for at in (0, far):
        ends += [(at + u, at + v, at - u - v) for u, v in ((0, 0), (0.3, 0), (0, 0.3))]
    w.obj("needle.obj", (ends, [(0, 2, 1), (3, 4, 5), (0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)]))
    w.scene("needle", [mesh("needle.obj")], [], {"exit": 0, "particles": (180000, 192000)}, spacing=0.05,
            **{**weightless, "duration": 0.01})
    return w.expected
