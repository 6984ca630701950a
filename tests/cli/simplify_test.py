#!/usr/bin/env python3
"""`terrane simplify`: one mesh within the tolerance of every sample, or one clear line."""

import json
import math
import pathlib
import struct
import subprocess
import tempfile
import unittest

from program import DATA, terrane

USAGE, INPUT, OUTPUT = 2, 3, 5
COLUMNS, ROWS, NODATA = 50, 40, -9999


def height(column, row):
    if 20 < column < 27 and 10 < row < 15 + column % 3:
        return NODATA
    hill = 40 * math.sin(0.2 * column) * math.cos(0.15 * row) + (7 * column + row) % 3
    return round(4 * hill) / 4  # the program reads floats: quarters are the same there


def write_grid(file):
    """An ESRI ASCII grid of 10 m cells: sample (0, 0) at (500005, 4000005 + 10 (ROWS - 1))."""
    lines = [f"ncols {COLUMNS}", f"nrows {ROWS}", "xllcorner 500000", "yllcorner 4000000",
             "cellsize 10", f"NODATA_value {NODATA}"]
    lines += [" ".join(str(height(c, r)) for c in range(COLUMNS)) for r in range(ROWS)]
    file.write_text("\n".join(lines) + "\n")


def read_obj(file):
    vertices, triangles = [], []
    for line in file.read_text().splitlines():
        words = line.split()
        if words[0] == "v":
            vertices.append(tuple(map(float, words[1:])))
        elif words[0] == "f":
            triangles.append(tuple(int(word) - 1 for word in words[1:]))
    return vertices, triangles


def read_ply(file):
    head, body = file.read_bytes().split(b"end_header\n", 1)
    count = [int(line.split()[2]) for line in head.decode().splitlines() if "element" in line]
    vertices = list(struct.iter_unpack("<3d", body[:24 * count[0]]))
    triangles = [face[1:] for face in struct.iter_unpack("<B3i", body[24 * count[0]:])]
    assert len(triangles) == count[1]
    return vertices, triangles


def worst_error_m(vertices, triangles):
    """The largest vertical distance, and how many samples no triangle covers: triangle by sample."""
    worst, uncovered = 0, 0
    for row in range(ROWS):
        for column in range(COLUMNS):
            if height(column, row) == NODATA:
                continue
            x, y = 500005 + 10 * column, 4000005 + 10 * (ROWS - 1 - row)
            distances = [abs(z - height(column, row))
                         for z in surfaces_at(x, y, vertices, triangles)]
            uncovered += not distances
            worst = max([worst, *distances])
    return worst, uncovered


def surfaces_at(x, y, vertices, triangles):
    for a, b, c in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = vertices[a], vertices[b], vertices[c]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        u = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
        v = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
        if u >= -1e-9 and v >= -1e-9 and u + v <= 1 + 1e-9:
            yield az + u * (bz - az) + v * (cz - az)


class Simplify(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.dem = self.folder / "dem.asc"
        write_grid(self.dem)

    def simplify(self, out, *more):
        status, printed, said = terrane("--quiet", "simplify", self.dem, "-o", self.folder / out,
                                        *more)
        self.assertEqual((status, said), (0, ""))
        return printed

    def test_obj_and_ply_hold_the_same_mesh_within_the_tolerance_of_every_sample(self):
        self.simplify("a.obj", "--tolerance", "2")
        self.simplify("a.ply", "--tolerance", "2")
        mesh = read_obj(self.folder / "a.obj")
        self.assertEqual(mesh, read_ply(self.folder / "a.ply"))
        self.assertLess(len(mesh[1]), 1500)  # of 3,800
        worst_m, uncovered = worst_error_m(*mesh)
        self.assertLessEqual(worst_m, 2 + 1e-9)
        self.assertEqual(uncovered, 0)

    def test_the_report_states_what_was_measured(self):
        printed = self.simplify("a.ply", "--tolerance", "3", "--report", self.folder / "r.json")
        report = json.loads((self.folder / "r.json").read_text())
        mesh = read_ply(self.folder / "a.ply")
        self.assertEqual(report["vertices"], len(mesh[0]))
        self.assertEqual(report["triangles"], len(mesh[1]))
        self.assertAlmostEqual(report["max_error_m"], worst_error_m(*mesh)[0], places=6)
        self.assertIn(f"{len(mesh[1])} of {report['input_triangles']} triangles", printed)

    def test_the_same_dem_gives_the_same_bytes(self):
        for name in ("a.glb", "b.glb"):
            self.simplify(name)
        self.assertEqual((self.folder / "a.glb").read_bytes(),
                         (self.folder / "b.glb").read_bytes())

    def refuse(self, status, arguments, *words):
        before = set(self.folder.rglob("*"))
        got, printed, said = terrane("--quiet", "simplify", *arguments)
        self.assertEqual((got, printed), (status, ""), said)
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        for word in words:
            self.assertIn(word, said)
        self.assertEqual(set(self.folder.rglob("*")), before)

    def test_bad_arguments_and_input_are_refused_in_one_line_and_nothing_is_written(self):
        out = self.folder / "a.obj"
        self.refuse(USAGE, [self.dem, "-o", self.folder / "a.stl"], "a.stl", ".glb")
        self.refuse(USAGE, [self.dem, "-o", out, "--tolerance", "-1"], "--tolerance")
        self.refuse(USAGE, [self.dem, "-o", out, "--vertical-unit", "furlong"], "furlong")
        self.refuse(INPUT, [self.folder / "gone.tif", "-o", out], "gone.tif")
        self.refuse(INPUT, [self.dem, "-o", out, "--band", "2"], "dem.asc", "--band")
        self.refuse(OUTPUT, [self.dem, "-o", "/proc/a.obj"], "/proc/a.obj")


class RealDem(unittest.TestCase):
    def test_st_helens_keeps_five_metres_with_the_samples_on_its_slanted_rim(self):
        dem = DATA / "st_helens/SainteHelens_post1980_30m.dem"
        if not dem.exists():
            self.skipTest(f"{dem} is not there")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            status, _, said = terrane("--quiet", "simplify", dem, "--tolerance", "5", "-o",
                                      folder / "a.glb", "--report", folder / "r.json")
            self.assertEqual((status, said), (0, ""))
            report = json.loads((folder / "r.json").read_text())
        self.assertEqual(report["input_triangles"], 296203)  # docs of the DEM: its valid domain
        self.assertLessEqual(report["max_error_m"], 5)
        self.assertLess(report["triangles"], 24000)

    def test_st_helens_needs_about_half_the_triangles_of_the_best_count_known(self):
        """Hoppe's library needs 32,731 / 12,109 / 3,955 triangles on this grid at 5 / 10 / 20 m;
        these are the counts that were asked of terrane."""
        dem = DATA / "st_helens/SainteHelens_post1980_30m.dem"
        if not dem.exists():
            self.skipTest(f"{dem} is not there")
        asked = {1: {5: 19500, 10: 7700, 20: 2560}, 3: {5: 16500, 10: 6400, 20: 2150}}
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            subprocess.run(["gdal_translate", "-q", "-srcwin", "5", "4", "317", "460", dem,
                            folder / "dem.tif"], check=True)
            for effort, counts in asked.items():
                for tolerance_m, most in counts.items():
                    status, _, said = terrane(
                        "--quiet", "simplify", folder / "dem.tif", "--tolerance", tolerance_m,
                        "--effort", effort, "-o", folder / "a.ply",
                        "--report", folder / "r.json")
                    self.assertEqual((status, said), (0, ""))
                    report = json.loads((folder / "r.json").read_text())
                    self.assertEqual(report["input_triangles"], 290088)
                    self.assertLessEqual(report["max_error_m"], tolerance_m)
                    self.assertLessEqual(report["triangles"], most, f"{tolerance_m} m")


if __name__ == "__main__":
    unittest.main()
