#!/usr/bin/env python3
"""Water and lines that a mesh keeps: flat, in place, islands and all."""

import json
import pathlib
import subprocess
import tempfile
import unittest

from crater_lake import SHORELINE, PlaneMap, Voids, cut_dem, is_there, read_polygon
from plane_lines import NearestSegment, along, has_cycle, is_inside
from program import terrane

INPUT = 3


def read_obj(file):
    vertices, triangles, lines = [], [], []
    for text in file.read_text().splitlines():
        words = text.split()
        if words[0] == "v":
            vertices.append(tuple(map(float, words[1:])))
        elif words[0] in "fl":
            (triangles if words[0] == "f" else lines).append(
                tuple(int(word) - 1 for word in words[1:]))
    return vertices, triangles, lines


class CraterLake(unittest.TestCase):
    """The whole lake with its five islands, on SRTM at 3 arc-seconds."""

    def check(self, tolerance_m):
        if not is_there():
            self.skipTest("Crater Lake is not there")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            mesh = folder / "lake.obj"
            status, _, said = terrane("--quiet", "simplify", cut_dem(folder), "--water", SHORELINE,
                                      "--tolerance", tolerance_m, "-o", mesh)
            self.assertEqual((status, said), (0, ""))
            vertices, triangles, lines = read_obj(mesh)
            degrees = read_polygon(folder)
        voids = Voids()

        metres = PlaneMap(degrees[0][0])
        rings = [[metres(p) for p in ring] for ring in degrees]
        flat = [metres(v) for v in vertices]

        # the shore: edges of the mesh, all at one height
        edges = {tuple(sorted((t[k], t[(k + 1) % 3]))) for t in triangles for k in range(3)}
        self.assertTrue(all(line in edges for line in lines))
        self.assertEqual({vertices[v][2] for line in lines for v in line}, {1882.0})

        # in place, both ways, where the DEM has data
        bin_m = 100
        to_mesh = NearestSegment([(flat[a], flat[b]) for a, b in lines], bin_m)
        to_polygon = NearestSegment([pair for ring in rings for pair in zip(ring, ring[1:])], bin_m)
        off_m, skipped, points = 0, 0, 0
        for ring in degrees:
            for p in along(ring, 2e-5):
                points += 1
                if voids.beside(*p, degrees):
                    skipped += 1
                else:
                    off_m = max(off_m, to_mesh.distance(metres(p)))
        back_m = max(to_polygon.distance(p) for a, b in lines for p in along((flat[a], flat[b]), 2))
        print(f"\ntolerance {tolerance_m} m: shore of {len(lines)} edges; polygon to mesh "
              f"{off_m:.3f} m ({100 * skipped / points:.1f} % of it beside voids), mesh to polygon "
              f"{back_m:.3f} m")
        self.assertLessEqual(max(off_m, back_m), 1.001 * tolerance_m)
        self.assertLess(skipped, 0.1 * points)

        # each of the five islands still has a line around it (two of them touch the shore)
        self.assertEqual(len(rings), 6)
        for island in rings[1:]:
            near = NearestSegment(list(zip(island, island[1:])), bin_m)
            around = [line for line in lines
                      if all(near.distance(flat[v]) <= tolerance_m for v in line)]
            self.assertTrue(has_cycle(around), island[0])

        # flat: every triangle with its middle in the water has three corners at the one height
        far_west, far_east = min(p[0] for p in rings[0]), max(p[0] for p in rings[0])
        far_south = min(p[1] for p in rings[0])
        wet = 0
        for t in triangles:
            x, y = sum(flat[v][0] for v in t) / 3, sum(flat[v][1] for v in t) / 3
            if not (far_west < x < far_east and far_south < y):
                continue
            if to_polygon.distance((x, y)) > tolerance_m and is_inside((x, y), rings):
                wet += 1
                self.assertEqual({vertices[v][2] for v in t}, {1882.0}, (x, y))
        print(f"{wet} triangles of water, all at 1882 m")
        self.assertGreater(wet, 20)

    def test_at_one_metre(self):
        self.check(1)

    def test_at_five_metres(self):
        self.check(5)

    def test_at_twenty_metres(self):
        self.check(20)


class BadLayers(unittest.TestCase):
    """One clear line that names the layer and what to do; nothing written."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.dem = self.folder / "dem.asc"
        rows = "\n".join(" ".join(str(c + r) for c in range(20)) for r in range(20))
        self.dem.write_text("ncols 20\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 0.001\n" + rows)

    def layer(self, name, geometry, coordinates):
        file = self.folder / name
        file.write_text(json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {},
             "geometry": {"type": geometry, "coordinates": coordinates}}]}))
        return file

    def refuse(self, arguments, *words, dem_options=("--crs", "EPSG:4326")):
        before = set(self.folder.rglob("*"))
        status, printed, said = terrane("--quiet", "simplify", self.dem, *dem_options, *arguments,
                                        "-o", self.folder / "out.obj")
        self.assertEqual((status, printed), (INPUT, ""), said)
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        for word in words:
            self.assertIn(word, said)
        self.assertEqual(set(self.folder.rglob("*")), before)

    def test_a_file_that_is_not_there(self):
        self.refuse(["--lines", self.folder / "gone.gpkg"], "gone.gpkg", "cannot be opened")

    def test_points_are_no_lines_and_lines_no_water(self):
        self.refuse(["--lines", self.layer("p.geojson", "Point", [1, 1])], "p.geojson", "lines")
        lines = self.layer("l.geojson", "LineString", [[1, 1], [2, 2]])
        self.refuse(["--water", lines], "l.geojson", "polygons", "--lines")

    def test_a_layer_beside_the_dem_says_where_the_dem_is(self):
        far = self.layer("far.geojson", "LineString", [[100, 10], [101, 11]])
        self.refuse(["--lines", far], "far.geojson", "beside the DEM", "CRS")

    def test_a_crs_on_one_side_only(self):
        lines = self.layer("l.geojson", "LineString", [[10, 10], [20, 20]])
        self.refuse(["--lines", lines], "l.geojson", "--crs", dem_options=())

    def test_a_layer_that_is_not_named_among_several(self):
        lines = self.layer("l.geojson", "LineString", [[0.01, 0.01], [0.015, 0.012]])
        several = self.folder / "several.gpkg"
        for name in ("rivers", "roads"):
            subprocess.run(["ogr2ogr", "-f", "GPKG", "-update", "-append", several, lines, "-nln",
                            name], check=True, capture_output=True)
        self.refuse(["--lines", several], "2 layers", "rivers, roads")
        self.refuse(["--lines", f"{several}:rails"], "no layer 'rails'")
        status, _, said = terrane("--quiet", "simplify", self.dem, "--crs", "EPSG:4326", "--lines",
                                  f"{several}:rivers", "-o", self.folder / "out.obj")
        self.assertEqual((status, said), (0, ""))
        self.assertTrue(read_obj(self.folder / "out.obj")[2])


if __name__ == "__main__":
    unittest.main()
