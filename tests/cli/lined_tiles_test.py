#!/usr/bin/env python3
"""Lines and water in tiles: in place at every level, however they cross tiles and each other."""

import json
import math
import pathlib
import random
import tempfile
import unittest

from plane_lines import NearestSegment, along
from program import terrane
from world_obj import read_world_obj

WEST, SOUTH, CELL = 7.0, 46.0, 0.0005  # degrees; the corner of the first cell
METRES_PER_DEGREE = (77_400.0, 111_150.0)  # of longitude and latitude there, to a part in 1,000


class Grid:
    """A DEM over a small part of the Alps, in places as (column, row)."""

    def __init__(self, folder, columns, rows, height):
        self.folder, self.columns, self.rows = folder, columns, rows
        self.dem = folder / "dem.asc"
        text = "\n".join(" ".join(f"{height(c, r):.2f}" for c in range(columns))
                         for r in range(rows))
        self.dem.write_text(f"ncols {columns}\nnrows {rows}\nxllcorner {WEST}\nyllcorner {SOUTH}\n"
                            f"cellsize {CELL}\nNODATA_value -9999\n{text}")

    def degrees(self, place):
        return [WEST + (place[0] + 0.5) * CELL, SOUTH + (self.rows - 0.5 - place[1]) * CELL]

    def layer(self, name, geometry, parts):
        file = self.folder / name
        file.write_text(json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {}, "geometry": {"type": geometry,
                                                               "coordinates": part}}
            for part in parts]}))
        return file

    def lines(self, lines):
        return self.layer("lines.geojson", "LineString",
                          [[self.degrees(p) for p in line] for line in lines])

    def water(self, polygons):
        return self.layer("water.geojson", "Polygon",
                          [[[self.degrees(p) for p in ring] for ring in rings]
                           for rings in polygons])

    def build(self, *options):
        out = self.folder / "tiles"
        return out, *terrane("--quiet", "build", self.dem, "--crs", "EPSG:4326", "--tile-cells",
                             16, *options, "-o", out)


class FlatGround(unittest.TestCase):
    """Where nothing but a line needs edges, every part of it is near one at every level."""

    def test_a_line_stays_in_place_within_the_tolerance_of_each_level(self):
        with tempfile.TemporaryDirectory() as name:
            grid = Grid(pathlib.Path(name), 100, 70, lambda c, r: 500)
            # a ripple of 14 m, which 32 m allow to go; and a wave that stays
            lines = [[(c, 20 + 0.25 * math.sin(c / 2)) for c in range(3, 97)],
                     [(50 + 20 * math.sin(r / 6), r) for r in range(2, 68)]]
            out, status, _, said = grid.build("--lines", grid.lines(lines), "--tolerance", 4)
            self.assertEqual((status, said), (0, ""))
            status, said, _ = terrane("--quiet", "verify", out)
            self.assertEqual(status, 0, said)
            counts = []
            for number, level in enumerate(
                    json.loads((out / "terrane.json").read_text())["levels"]):
                mesh = grid.folder / "level.obj"
                terrane("--quiet", "export", out, "--level", number, "-o", mesh)
                counts.append(self.judge(grid, lines, mesh, level["tolerance_m"]))
            print("\ntriangles by level:", counts)
            self.assertLess(counts[-1], counts[0] / 2)

    def judge(self, grid, lines, mesh, tolerance_m):
        def metres(p):
            return (p[0] - WEST) * METRES_PER_DEGREE[0], (p[1] - SOUTH) * METRES_PER_DEGREE[1]
        vertices, triangles = read_world_obj(mesh)
        flat = [metres(v) for v in vertices]
        edges = {tuple(sorted((t[k], t[(k + 1) % 3]))) for t in triangles for k in range(3)}
        near = NearestSegment([(flat[a], flat[b]) for a, b in edges], 50)
        off_m = max(near.distance(p) for line in lines
                    for p in along([metres(grid.degrees(p)) for p in line], 2))
        self.assertLessEqual(off_m, 1.002 * tolerance_m)
        return len(triangles)


class RandomFeatures(unittest.TestCase):
    """Tangles, near misses, lines along tile borders, lakes with islands, holes: all hold."""

    def features(self, rng, columns, rows):
        lines, lakes = [], []
        for _ in range(rng.choice([1, 3, 6])):
            kind = rng.choice(["walk", "walk", "along", "bundle"])
            if kind == "walk":
                place, line = [rng.uniform(0, columns), rng.uniform(0, rows)], []
                for _ in range(rng.choice([5, 60, 200])):
                    line.append(tuple(place))
                    place = [v + rng.gauss(0, rng.choice([0.3, 2])) for v in place]
                lines.append(line)
            elif kind == "along":
                column = 16 * rng.randint(1, (columns - 2) // 16)
                lines.append([(column, rng.randint(0, 5)), (column, rng.randint(10, rows - 1)),
                              (column + rng.randint(-5, 5), rows - 2)])
            else:
                ends = [(rng.uniform(0, columns), rng.uniform(0, rows)) for _ in "ab"]
                for _ in range(4):
                    lines.append([tuple(v + rng.gauss(0, 0.003) for v in end) for end in ends])
        for _ in range(rng.choice([1, 3])):
            x, y, radius = rng.uniform(5, columns), rng.uniform(5, rows), rng.uniform(3, 12)
            if any(math.hypot(x - a, y - b) < 1.5 * (radius + r) for a, b, r in lakes):
                continue
            lakes.append((x, y, radius))
        return lines, [self.lake(rng, *lake) for lake in lakes]

    @staticmethod
    def lake(rng, x, y, radius):
        def ring(size):
            corners = rng.choice([5, 40, 200])
            points = []
            for i in range(corners):
                here, angle = size * rng.uniform(0.8, 1.2), 2 * math.pi * i / corners
                points.append((x + here * math.cos(angle), y + here * math.sin(angle)))
            return points + points[:1]
        return [ring(radius)] + ([ring(0.3 * radius)] if radius > 6 else [])

    def check(self, seed):
        rng = random.Random(seed)
        columns, rows = rng.choice([(60, 45), (90, 70), (33, 100)])
        holes = [(rng.uniform(0, columns), rng.uniform(0, rows), rng.uniform(1, 6))
                 for _ in range(rng.choice([0, 0, 3]))]
        rough_m = rng.choice([0, 1, 10])

        def height(column, row):
            if any(math.hypot(column - x, row - y) < size for x, y, size in holes):
                return -9999
            return (800 + 60 * math.sin(0.11 * column) * math.cos(0.07 * row) +
                    rough_m * rng.uniform(-1, 1))
        with tempfile.TemporaryDirectory() as name:
            grid = Grid(pathlib.Path(name), columns, rows, height)
            lines, lakes = self.features(rng, columns, rows)
            out, status, _, said = grid.build(
                "--lines", grid.lines(lines), "--water", grid.water(lakes), "--water-height", 795,
                "--tolerance", rng.choice([1, 2, 5, 20]), "--levels-per-octave",
                rng.choice([1, 1, 2, 3]))
            self.assertEqual((status, said), (0, ""), seed)
            status, said, _ = terrane("--quiet", "verify", out)
            self.assertEqual(status, 0, f"seed {seed}: {said}")

    def test_all_hold_every_invariant(self):
        for seed in range(30):
            self.check(seed)


if __name__ == "__main__":
    unittest.main()
