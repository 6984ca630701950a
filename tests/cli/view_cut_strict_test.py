#!/usr/bin/env python3
"""What view-cut shows of a real terrain, judged at every sample by code that shares nothing with it.

view_cut_strict_test.py [CAMERAS]: St. Helens within 1 to 8 px of every sample in the picture. Ends
with 77 (skipped) where the DEM is missing.
"""

import math
import pathlib
import random
import sys
import tempfile

from levels_test import read_ply
from program import DATA, SKIPPED, terrane

DEM = DATA / "st_helens" / "SainteHelens_post1980_30m.dem"
WIDTH, HEIGHT, FOV = 1280, 720, 45


def unit(v):
    length = math.sqrt(sum(e * e for e in v))
    return tuple(e / length for e in v)


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


class Camera:
    def __init__(self, eye, target):
        self.eye = eye
        self.forward = unit([t - e for t, e in zip(target, eye)])
        self.right = unit(cross(self.forward, (0, 0, 1)))
        self.up = cross(self.right, self.forward)
        self.focal = HEIGHT / 2 / math.tan(math.radians(FOV / 2))

    def picture(self, p):
        """Pixels from the middle; None for what is behind."""
        q = [a - b for a, b in zip(p, self.eye)]
        depth = sum(a * b for a, b in zip(q, self.forward))
        if depth <= 0:
            return None
        return (self.focal * sum(a * b for a, b in zip(q, self.right)) / depth,
                self.focal * sum(a * b for a, b in zip(q, self.up)) / depth)


class Samples:
    """The vertices of the full mesh, which are the DEM's samples, by column and row."""

    def __init__(self, points):
        self.points = points
        xs, ys = sorted({p[0] for p in points}), sorted({p[1] for p in points})
        self.x0, self.y0 = xs[0], ys[0]
        self.dx = (xs[-1] - xs[0]) / (len(xs) - 1)
        self.dy = (ys[-1] - ys[0]) / (len(ys) - 1)
        self.at = {(round((x - self.x0) / self.dx), round((y - self.y0) / self.dy)): i
                   for i, (x, y, _) in enumerate(points)}

    def heights_shown(self, points, faces):
        """Over each sample, of the triangle that it is farthest inside of, or least outside."""
        shown, inside = [None] * len(self.points), [-1e-3] * len(self.points)
        for face in faces:
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (points[v] for v in face)
            area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            assert area > 0, "a triangle is turned over in plan"
            columns = range(math.floor((min(ax, bx, cx) - self.x0) / self.dx + 0.01),
                            math.ceil((max(ax, bx, cx) - self.x0) / self.dx - 0.01) + 1)
            rows = range(math.floor((min(ay, by, cy) - self.y0) / self.dy + 0.01),
                         math.ceil((max(ay, by, cy) - self.y0) / self.dy - 0.01) + 1)
            for column in columns:
                for row in rows:
                    i = self.at.get((column, row))
                    if i is None:
                        continue
                    x, y, _ = self.points[i]
                    wa = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                    wb = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                    least = min(wa, wb, 1 - wa - wb)
                    if least > inside[i]:
                        inside[i] = least
                        shown[i] = wa * az + wb * bz + (1 - wa - wb) * cz
        return shown


def worst_px(samples, shown, camera):
    worst, compared = 0.0, 0
    for (x, y, z), height in zip(samples.points, shown):
        assert height is not None, f"the sample at {x}, {y} is under no triangle"
        there = camera.picture((x, y, z))
        if there is None or abs(there[0]) > WIDTH / 2 or abs(there[1]) > HEIGHT / 2:
            continue
        here = camera.picture((x, y, height))
        worst = max(worst, math.dist(there, here))
        compared += 1
    return worst, compared


def main():
    if not DEM.exists():
        print(f"skipped: {DEM} is not here")
        sys.exit(SKIPPED)
    cameras = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        tree, cut = folder / "a.tree", folder / "cut.ply"

        def run(*arguments):
            status, _, err = terrane("--quiet", *arguments)
            assert status == 0, err
        run("merge-tree", DEM, "-o", tree)
        # the finest of the published levels: every sample, and none of the tree's code
        run("levels", DEM, "--stop", "level=1", "-o", folder / "a.levels")
        run("levels", folder / "a.levels", "--extract", 0, "-o", cut)
        points, faces = read_ply(cut)
        assert len(faces) == 296203, "the DEM's valid domain"
        samples = Samples(points)
        chance = random.Random(1)
        for _ in range(cameras):
            eye = (chance.uniform(-5000, 15000), chance.uniform(-19000, 5000),
                   chance.uniform(2600, 9000))
            target = (chance.uniform(2000, 8000), chance.uniform(-12000, -2000), 1500)
            pixels, frustum = chance.choice((1, 2, 8)), chance.choice(((), ("--frustum",)))
            run("view-cut", tree, "--pixels", pixels, *frustum, "--camera",
                ",".join(map(str, eye)), "--target", ",".join(map(str, target)), "-o", cut)
            points, faces = read_ply(cut)
            worst, compared = worst_px(samples, samples.heights_shown(points, faces),
                                       Camera(eye, target))
            print(f"{len(faces)} triangles: {worst:.3f} of {pixels} px at {compared} samples")
            # places are whole lattice steps of 4 mm; a camera is 60 m away at least
            assert worst <= pixels * 1.001, "the error on the screen is over the tolerance"


if __name__ == "__main__":
    main()
