#!/usr/bin/env python3
"""The lake in tiles: flat, its shore in place and its islands there at every level.

Judged on what terrane export welds out of the written tiles, with geodesy of its own.
"""

import json
import pathlib
import tempfile
import unittest

from crater_lake import METRES_PER_DEGREE, SHORELINE, PlaneMap, Voids, cut_dem, is_there, read_polygon
from plane_lines import NearestSegment, along, has_cycle, is_inside
from program import bytes_below, terrane
from world_obj import read_world_obj

WATER_M = 1882.0  # what SRTM has all along the shore


class Lake:
    """What is known of the lake, and what a level makes of it."""

    def __init__(self, folder):
        self.degrees = read_polygon(folder)
        self.metres = PlaneMap(self.degrees[0][0])
        self.rings = [[self.metres(p) for p in ring] for ring in self.degrees]
        self.shore = [pair for ring in self.rings for pair in zip(ring, ring[1:])]
        self.voids = Voids()

    def judge(self, test, mesh, tolerance_m, step_m):
        vertices, triangles = read_world_obj(mesh)
        flat = [self.metres(v) for v in vertices]
        # a vertex is on the lattice: half a step up or down, and as little by its plan
        is_level = [abs(v[2] - WATER_M) <= 0.55 * step_m for v in vertices]
        edges = {tuple(sorted((t[k], t[(k + 1) % 3]))) for t in triangles for k in range(3)}
        level_edges = [(a, b) for a, b in edges if is_level[a] and is_level[b]]
        bin_m = max(100, 2 * tolerance_m)

        # the shore is edges of the mesh, within the tolerance, where the DEM has data
        to_mesh = NearestSegment([(flat[a], flat[b]) for a, b in level_edges], bin_m)
        off_m, skipped, points = 0, 0, 0
        for ring in self.degrees:
            for p in along(ring, max(4, tolerance_m / 4) / METRES_PER_DEGREE):
                points += 1
                if self.voids.beside(*p, self.degrees):
                    skipped += 1
                else:
                    off_m = max(off_m, to_mesh.distance(self.metres(p)))
        test.assertLessEqual(off_m, tolerance_m)
        test.assertLess(skipped, 0.1 * points)

        # what is not flat does not reach into the water
        to_shore = NearestSegment(self.shore, bin_m)
        box = [f(p[k] for p in self.rings[0]) for k in (0, 1) for f in (min, max)]
        wet, worst_m = 0, 0
        for t in triangles:
            corners = [flat[v] for v in t]
            if (max(p[0] for p in corners) < box[0] or min(p[0] for p in corners) > box[1] or
                    max(p[1] for p in corners) < box[2]):
                continue
            middle = sum(p[0] for p in corners) / 3, sum(p[1] for p in corners) / 3
            if all(is_level[v] for v in t):
                wet += is_inside(middle, self.rings)
                worst_m = max([worst_m] + [abs(vertices[v][2] - WATER_M) for v in t])
                continue
            for p in [middle, *along(corners + corners[:1], max(40, tolerance_m))]:
                if is_inside(p, self.rings):
                    test.assertLessEqual(to_shore.distance(p), tolerance_m, (p, t))
        test.assertGreater(wet, 20)

        # each of the five islands still has a line around it (two of them touch the shore)
        test.assertEqual(len(self.rings), 6)
        for island in self.rings[1:]:
            near = NearestSegment(list(zip(island, island[1:])), bin_m)
            is_near = {v for edge in level_edges for v in edge
                       if near.distance(flat[v]) <= tolerance_m}
            around = [edge for edge in level_edges if is_near.issuperset(edge)]
            test.assertTrue(has_cycle(around), island[0])
        return (f"shore off by {off_m:.3f} m at most ({100 * skipped / points:.1f} % of it beside "
                f"voids), {wet} triangles of water within {worst_m * 1000:.1f} mm of one height")


class LakeTiles(unittest.TestCase):
    def setUp(self):
        if not is_there():
            self.skipTest("Crater Lake is not there")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.dem = cut_dem(self.folder)

    def build(self, *options):
        out = self.folder / "tiles"
        status, said, trouble = terrane("--quiet", "build", self.dem, "--water", SHORELINE,
                                        *options, "-o", out)
        self.assertEqual((status, trouble), (0, ""))
        return out, said

    def check(self, tolerance_m, *options):
        out, _ = self.build("--tolerance", tolerance_m, *options)
        status, said, _ = terrane("--quiet", "verify", out)
        self.assertEqual(status, 0, said)
        self.assertIn(" 0 samples at another height", said)
        self.assertRegex(said, r"level +water +uneven +wrong_side\n +0 +\d{3,} +0 +0\n")
        lake = Lake(self.folder)
        for number, level in enumerate(json.loads((out / "terrane.json").read_text())["levels"]):
            mesh = self.folder / "level.obj"
            terrane("--quiet", "export", out, "--level", number, "-o", mesh)
            found = lake.judge(self, mesh, level["tolerance_m"], level["step_m"][2])
            print(f"\nlevel {number}, {level['tolerance_m']:g} m: {found}")

    def test_from_one_metre(self):
        self.check(1)

    def test_from_twenty_metres_with_two_levels_per_octave(self):
        self.check(20, "--levels-per-octave", 2)

    def test_water_is_told_from_land_in_every_format(self):
        triangles = set()
        for options in ("--compression none --skirts auto", "--compression draco --colour slope",
                        "--positions float --implicit --skirts 50"):
            out, _ = self.build("--tolerance", 20, "--force", *options.split())
            report = self.folder / "report.json"
            status, said, _ = terrane("--quiet", "verify", out, "--json", report)
            self.assertEqual(status, 0, said)
            levels = json.loads(report.read_text())["levels"]
            triangles.add(tuple(level["water_triangles"] for level in levels))
        self.assertEqual(len(triangles), 1, triangles)
        self.assertGreater(min(triangles.pop()), 100)

    def test_another_shore_in_the_same_file_builds_again(self):
        shore = self.folder / "shore.geojson"
        rings = read_polygon(self.folder)
        for expected, count in ("levels", 6), ("up to date", 6), ("levels", 5):
            shore.write_text(json.dumps({"type": "FeatureCollection", "features": [
                {"type": "Feature", "properties": {},
                 "geometry": {"type": "Polygon", "coordinates": rings[:count]}}]}))
            status, said, trouble = terrane("--quiet", "build", self.dem, "--water", shore,
                                            "--tolerance", 20, "-o", self.folder / "tiles")
            self.assertEqual((status, trouble), (0, ""))
            self.assertIn(expected, said)

    def test_any_number_of_threads_writes_the_same_bytes(self):
        written = []
        for jobs in 1, 3:
            out = self.folder / f"{jobs}"
            # TBB may complain of few cores
            status, _, trouble = terrane("--quiet", "build", self.dem, "--water", SHORELINE,
                                         "--tolerance", 20, "--jobs", jobs, "-o", out)
            self.assertEqual(status, 0, trouble)
            written.append(bytes_below(out))
        self.assertEqual(*written)


if __name__ == "__main__":
    unittest.main()
