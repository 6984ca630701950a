"""Meshes for the figures of Xia and Varshney 1996, as OFF text. Plain Python.

sphere(): the paper's, 8,192 triangles. scan(): stands in for a scanned model of about 70,000
triangles: a body with two lobes, a rough coat and a few sharp grooves. molecule(): stands in for the
molecular surface of about 110,000 triangles.
"""

import math
import random


def off(points, triangles):
    lines = [f"OFF\n{len(points)} {len(triangles)} 0"]
    lines += [f"{x:.9f} {y:.9f} {z:.9f}" for x, y, z in points]
    lines += [f"3 {a} {b} {c}" for a, b, c in triangles]
    return "\n".join(lines) + "\n"


def unit(p):
    length = math.sqrt(sum(e * e for e in p))
    return tuple(e / length for e in p)


def ball(corners, faces, frequency):
    """Each face of a polyhedron cut into frequency^2 triangles, on the unit sphere."""
    points, number, triangles = [], {}, []

    def vertex(weights):
        key = tuple(sorted((v, w) for v, w in weights if w))
        if key not in number:
            number[key] = len(points)
            points.append(unit([sum(w * corners[v][k] for v, w in key) for k in range(3)]))
        return number[key]

    for a, b, c in faces:
        def at(i, j):
            return vertex(((a, frequency - i - j), (b, i), (c, j)))
        for i in range(frequency):
            for j in range(frequency - i):
                triangles.append((at(i, j), at(i + 1, j), at(i, j + 1)))
                if i + j + 1 < frequency:
                    triangles.append((at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
    return points, triangles


def sphere(frequency=32):
    corners = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return off(*ball(corners, faces, frequency))


def radius(x, y, z):
    r = 1 + 0.25 * math.sin(2 * x + 1) * math.cos(2 * z) + 0.15 * math.sin(3 * y + 2 * z)
    for cx, cy, cz in ((0.3, 0.2, 0.93), (-0.35, 0.25, 0.9)):  # two lobes on top
        r += 0.7 * math.exp(-14 * ((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2))
    coat = math.sin(23 * x + 5 * y) * math.sin(29 * y - 7 * z) * math.sin(31 * z + 11 * x)
    r += 0.012 * coat * (1 + math.sin(3 * x)) + 0.004 * math.sin(71 * x) * math.sin(67 * y + 61 * z)
    for level in (-0.5, -0.1, 0.3):  # grooves
        r -= 0.03 * math.exp(-((z - level - 0.05 * math.sin(5 * x)) / 0.02) ** 2)
    return r


def scan(frequency=59):
    g = (1 + math.sqrt(5)) / 2
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
               (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
             (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
             (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    points, triangles = ball(corners, faces, frequency)
    points = [tuple(radius(*p) * e for e in p) for p in points]
    return off(points, triangles)


def atoms(count=60):
    """A chain that turns at random and stays together."""
    chance, places, at = random.Random(4), [], (0.0, 0.0, 0.0)
    for _ in range(count):
        step = unit([chance.gauss(0, 1) - 0.5 * e for e in at])
        at = tuple(a + 0.42 * e for a, e in zip(at, step))
        places.append((at, chance.uniform(0.3, 0.42)))
    return places


def field(places, cell):
    """Sum of a bell about each atom, less 1, at the points of a grid near them."""
    values = {}
    for centre, size in places:
        reach = math.ceil(2.2 * size / cell)
        middle = [round(e / cell) for e in centre]
        for i in range(middle[0] - reach, middle[0] + reach + 1):
            for j in range(middle[1] - reach, middle[1] + reach + 1):
                for k in range(middle[2] - reach, middle[2] + reach + 1):
                    squared = sum((cell * a - b) ** 2 for a, b in zip((i, j, k), centre))
                    bell = math.exp(2 * (1 - squared / size ** 2))
                    values[i, j, k] = values.get((i, j, k), -1.0) + bell
    return values


def molecule(cell=0.0385):
    """The surface on which the field is 0, by marching tetrahedra: six in a cube."""
    values = field(atoms(), cell)
    steps = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    orders = [(0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)]
    points, number, triangles = [], {}, []

    def crossing(a, b):
        key = (a, b) if a < b else (b, a)
        if key not in number:
            (va, vb) = (values.get(p, -1.0) for p in key)
            # not at a point of the grid: triangles would have no area
            t = min(max(va / (va - vb), 0.1), 0.9)
            number[key] = len(points)
            points.append(tuple(cell * (p + t * (q - p)) for p, q in zip(*key)))
        return number[key]

    def towards(triangle, inside, outside):
        a, b, c = (points[v] for v in triangle)
        u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        out = sum(e * (q - p) for e, p, q in zip(n, inside, outside))
        triangles.append(triangle if out > 0 else triangle[::-1])

    cubes = {tuple(a - b for a, b in zip(p, corner)) for p, value in values.items() if value > 0
             for corner in [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]}
    for cube in sorted(cubes):
        for order in orders:
            tetra = [cube]
            for axis in order:
                tetra.append(tuple(a + b for a, b in zip(tetra[-1], steps[axis])))
            inside = [p for p in tetra if values.get(p, -1.0) > 0]
            outside = [p for p in tetra if values.get(p, -1.0) <= 0]
            if len(inside) == 1 or len(outside) == 1:
                apex, others = (inside[0], outside) if len(inside) == 1 else (outside[0], inside)
                towards([crossing(apex, p) for p in others], inside[0], outside[0])
            elif len(inside) == 2:
                (a, b), (c, d) = inside, outside
                quad = [crossing(a, c), crossing(a, d), crossing(b, d), crossing(b, c)]
                towards(quad[:3], a, c)
                towards([quad[0], quad[2], quad[3]], a, c)
    return off(points, triangles)
