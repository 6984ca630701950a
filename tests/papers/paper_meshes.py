"""The generated meshes of Gieng et al. 1998, section 7: the saddle and the torus, as OFF files."""

import math


def grid_faces(columns, rows, index):
    for j in range(rows):
        for i in range(columns):
            a, b, c, d = index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)
            yield from ((a, b, c), (a, c, d))


def off(points, faces):
    faces = list(faces)
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in points]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces]
    return "\n".join(lines) + "\n"


def saddle():
    """z = x^2 - y^2 over a square, in 101 x 99 cells: 19,998 triangles as in Table 1."""
    points = [(x, y, x * x - y * y) for y in (2 * j / 99 - 1 for j in range(100))
              for x in (2 * i / 101 - 1 for i in range(102))]
    return off(points, grid_faces(101, 99, lambda i, j: j * 102 + i))


def torus(m=50, n=50):
    """Radii 1 and 0.4, in 50 x 50 quads: 5,000 triangles as in Table 1."""
    angles = [(2 * math.pi * i / m, 2 * math.pi * j / n) for i in range(m) for j in range(n)]
    points = [(math.cos(u) * (1 + 0.4 * math.cos(v)), math.sin(u) * (1 + 0.4 * math.cos(v)),
               0.4 * math.sin(v)) for u, v in angles]
    return off(points, torus_faces(m, n))


def torus_faces(m, n):
    for i in range(m):
        for j in range(n):
            a, b = i * n + j, (i + 1) % m * n + j
            c, d = (i + 1) % m * n + (j + 1) % n, i * n + (j + 1) % n
            yield from ((a, b, c), (a, c, d))
