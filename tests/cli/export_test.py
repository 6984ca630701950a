#!/usr/bin/env python3
"""terrane export: meshes are read and counted here, by code of this test's own."""

import collections
import json
import math
import pathlib
import struct
import tempfile
import unittest

from program import terrane

# a square of 193 x 193 samples 30 m apart: several tiles at every level but the last
DEM = "synthetic:caldera?size=193&seed=1"
USAGE, INPUT = 2, 3


# a piece of the Earth around this place
LONGITUDE_DEG, LATITUDE_DEG = 7.65, 45.97
CELL_DEG = 0.0004


def write_hills(file, size=161):
    """An ESRI ASCII grid in degrees, its middle sample at the place above."""
    reach_deg = size * CELL_DEG / 2
    lines = [f"ncols {size}", f"nrows {size}", f"xllcorner {LONGITUDE_DEG - reach_deg:.9f}",
             f"yllcorner {LATITUDE_DEG - reach_deg:.9f}", f"cellsize {CELL_DEG}"]
    for row in range(size):
        lines.append(" ".join(f"{50 * math.sin(row / 9) * math.cos(column / 7):.2f}"
                              for column in range(size)))
    file.write_text("\n".join(lines) + "\n")


def read_ply(file):
    head, data = file.read_bytes().split(b"end_header\n", 1)
    vertices = int(head.split(b"element vertex ")[1].split()[0])
    faces = int(head.split(b"element face ")[1].split()[0])
    points = [struct.unpack_from("<3d", data, 24 * i) for i in range(vertices)]
    triangles = []
    for i in range(faces):
        corners, *triangle = struct.unpack_from("<B3I", data, 24 * vertices + 13 * i)
        assert corners == 3
        triangles.append(tuple(triangle))
    return points, triangles


def read_obj(file):
    points, triangles = [], []
    for line in file.read_text().splitlines():
        if line.startswith("v "):
            points.append(tuple(float(number) for number in line.split()[1:]))
        elif line.startswith("f "):
            triangles.append(tuple(int(number) - 1 for number in line.split()[1:]))
    return points, triangles


def read_glb(file):
    """The document, and for each mesh its points (x east, y north, z up) and triangles."""
    data = file.read_bytes()
    magic, version, length, json_bytes, json_kind = struct.unpack_from("<4sIIII", data)
    assert (magic, version, length, json_kind) == (b"glTF", 2, len(data), 0x4E4F534A)
    document = json.loads(data[20:20 + json_bytes])
    binary = data[20 + json_bytes + 8:]

    def values(accessor, code, per_value):
        accessor = document["accessors"][accessor]
        view = document["bufferViews"][accessor["bufferView"]]
        return list(struct.iter_unpack(f"<{per_value}{code}", binary[
            view["byteOffset"]:view["byteOffset"] + view["byteLength"]]))

    meshes = []
    for node in document["nodes"]:
        primitive = document["meshes"][node["mesh"]]["primitives"][0]
        tx, ty, tz = node["translation"]
        points = [(x + tx, -(z + tz), y + ty)
                  for x, y, z in values(primitive["attributes"]["POSITION"], "f", 3)]
        triangles = values(primitive["indices"], "I", 3)
        meshes.append((points, triangles))
    return document, meshes


def border_edges(triangles):
    """Edges with a triangle on one side only; fails where an edge has more than one on a side."""
    sides = collections.Counter()
    for a, b, c in triangles:
        for edge in ((a, b), (b, c), (c, a)):
            sides[edge] += 1
    assert max(sides.values()) == 1, "an edge has two triangles on one side"
    return [(a, b) for a, b in sides if (b, a) not in sides]


def euler(points, triangles):
    edges = {tuple(sorted(edge)) for a, b, c in triangles for edge in ((a, b), (b, c), (c, a))}
    return len(points) - len(edges) + len(triangles)


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.out = cls.folder / "out"
        assert terrane("--quiet", "build", DEM, "-o", cls.out)[0] == 0
        cls.summary = json.loads((cls.out / "terrane.json").read_text())
        write_hills(cls.folder / "hills.asc")
        cls.earth = cls.folder / "earth"
        assert terrane("--quiet", "build", cls.folder / "hills.asc", "--crs", "EPSG:4326", "-o",
                       cls.earth)[0] == 0

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def export(self, name, *arguments, out=None):
        status, printed, said = terrane("--quiet", "export", out or self.out, "-o",
                                        self.folder / name, *arguments)
        self.assertEqual(status, 0, said)
        self.assertIn("triangles", printed)
        return self.folder / name

    def assert_one_sheet(self, points, triangles):
        """A disk: every vertex once, one border, no holes and no tears."""
        self.assertEqual(len(set(points)), len(points))
        self.assertEqual({corner for triangle in triangles for corner in triangle},
                         set(range(len(points))))
        border = border_edges(triangles)
        following = dict(border)
        self.assertEqual(len(following), len(border), "the border touches itself")
        at, steps = border[0][0], 0
        while steps == 0 or at != border[0][0]:
            at, steps = following[at], steps + 1
        self.assertEqual(steps, len(border), "there is more than one border")
        self.assertEqual(euler(points, triangles), 1)
        return border

    def test_every_level_is_one_sheet_with_the_triangles_of_its_tiles(self):
        for level in self.summary["levels"]:
            points, triangles = read_ply(self.export("level.ply", "--level", level["level"]))
            self.assertEqual(len(triangles), level["triangles"])
            self.assert_one_sheet(points, triangles)

    def test_the_border_lies_on_the_rim_of_the_dem(self):
        points, triangles = read_ply(self.export("rim.ply"))
        # a crack between tiles would be a border inside. The plane is curved a little: 1 m
        west, east = min(p[0] for p in points), max(p[0] for p in points)
        south, north = min(p[1] for p in points), max(p[1] for p in points)
        self.assertGreater(east - west, 1000)
        for edge in border_edges(triangles):
            for x, y, _ in (points[vertex] for vertex in edge):
                self.assertLess(min(x - west, east - x, y - south, north - y), 1)

    def test_obj_and_ply_hold_the_same_numbers(self):
        self.assertEqual(read_obj(self.export("same.obj", "--level", 1)),
                         read_ply(self.export("same.ply", "--level", 1)))

    def test_a_glb_holds_them_too_and_turns_them_y_up(self):
        points, triangles = read_ply(self.export("a.ply"))
        _, meshes = read_glb(self.export("a.glb"))
        self.assertEqual(meshes[0][1], triangles)
        # on the lattice, places are exact as floats
        self.assertEqual(meshes[0][0], points)

    def test_triangles_face_up(self):
        points, triangles = read_ply(self.export("up.ply"))
        for a, b, c in triangles:
            (ax, ay, _), (bx, by, _), (cx, cy, _) = points[a], points[b], points[c]
            self.assertGreater((bx - ax) * (cy - ay) - (by - ay) * (cx - ax), 0)

    def area_of(self, points, triangles):
        total = 0
        for a, b, c in triangles:
            (ax, ay, _), (bx, by, _), (cx, cy, _) = points[a], points[b], points[c]
            total += ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
        return total

    def test_an_area_of_the_earth_is_cut_out_along_its_borders(self):
        reach_deg = 0.015
        west, south, east, north = (LONGITUDE_DEG - reach_deg, LATITUDE_DEG - reach_deg,
                                    LONGITUDE_DEG + reach_deg, LATITUDE_DEG + reach_deg)
        points, triangles = read_ply(
            self.export("area.ply", f"--area={west},{south},{east},{north}", out=self.earth))
        self.assert_one_sheet(points, triangles)
        # lengths of a degree on WGS84 at a latitude (series in every textbook of geodesy)
        phi = math.radians(LATITUDE_DEG)
        north_m = 111132.954 - 559.822 * math.cos(2 * phi) + 1.175 * math.cos(4 * phi)
        east_m = 111412.84 * math.cos(phi) - 93.5 * math.cos(3 * phi)
        # the origin is the DEM's middle; meridians converge by 0.4 m on the way
        self.assertAlmostEqual(max(p[0] for p in points), reach_deg * east_m, delta=0.5)
        self.assertAlmostEqual(min(p[1] for p in points), -reach_deg * north_m, delta=0.5)
        wanted = 4 * reach_deg * reach_deg * east_m * north_m
        self.assertAlmostEqual(self.area_of(points, triangles) / wanted, 1, delta=1e-4)

    def test_an_area_of_a_dem_without_crs_is_in_its_metres(self):
        frame = self.summary["frame"]
        x, y = frame["x"], frame["y"]
        points, triangles = read_ply(
            self.export("local.ply", f"--area={x - 500},{y - 300},{x + 400},{y + 200}"))
        self.assert_one_sheet(points, triangles)
        self.assertEqual([min(p[0] for p in points), min(p[1] for p in points),
                          max(p[0] for p in points), max(p[1] for p in points)],
                         [-500, -300, 400, 200])
        self.assertAlmostEqual(self.area_of(points, triangles), 900 * 500, delta=1e-3)

    def test_two_halves_have_the_area_of_the_whole(self):
        halves = [read_ply(self.export(f"{name}.ply", f"--area={area}", out=self.earth))
                  for name, area in (("west", f"{LONGITUDE_DEG - 5},-90,{LONGITUDE_DEG},90"),
                                     ("east", f"{LONGITUDE_DEG},-90,{LONGITUDE_DEG + 5},90"))]
        whole = read_ply(self.export("both.ply", out=self.earth))
        self.assertAlmostEqual(sum(self.area_of(*half) for half in halves), self.area_of(*whole),
                               delta=1e-3)

    def test_an_area_may_span_the_antimeridian(self):
        text = (self.folder / "hills.asc").read_text()
        west = f"xllcorner {LONGITUDE_DEG - 161 * CELL_DEG / 2:.9f}"
        self.assertIn(west, text)
        (self.folder / "fiji.asc").write_text(text.replace(west, "xllcorner 179.970"))
        out = self.folder / "fiji"
        self.assertEqual(terrane("--quiet", "build", self.folder / "fiji.asc", "--crs", "EPSG:4326",
                                 "-o", out)[0], 0)
        points, triangles = read_ply(self.export("fiji.ply", "--area=179.99,45,-179.99,46.5",
                                                 out=out))
        self.assert_one_sheet(points, triangles)
        phi = math.radians(LATITUDE_DEG)
        east_m = 111412.84 * math.cos(phi) - 93.5 * math.cos(3 * phi)
        width_m = max(p[0] for p in points) - min(p[0] for p in points)
        self.assertAlmostEqual(width_m, 0.02 * east_m, delta=1)

    def test_a_stack_is_one_glb_with_lods(self):
        document, meshes = read_glb(self.export("stack.glb", "--stack"))
        levels = self.summary["levels"]
        self.assertEqual(document["extensionsUsed"], ["MSFT_lod"])
        self.assertEqual(document["scenes"][0]["nodes"], [0])
        self.assertEqual(document["nodes"][0]["extensions"]["MSFT_lod"]["ids"],
                         list(range(1, len(levels))))
        coverage = document["nodes"][0]["extras"]["MSFT_screencoverage"]
        self.assertEqual(len(coverage), len(levels))
        self.assertEqual(coverage, sorted(coverage, reverse=True))
        self.assertEqual([len(triangles) for _, triangles in meshes],
                         [level["triangles"] for level in levels])

    def test_a_stack_is_a_folder_too(self):
        folder = self.export("stack", "--stack", "--level", 1)
        listed = json.loads((folder / "stack.json").read_text())["levels"]
        self.assertEqual([level["level"] for level in listed],
                         [level["level"] for level in self.summary["levels"]][1:])
        for level in listed:
            _, meshes = read_glb(folder / level["file"])
            self.assertEqual(len(meshes[0][1]), level["triangles"])

    def test_an_archive_gives_the_same_mesh(self):
        terrane("--quiet", "pack", self.out, "-o", self.folder / "x.pmtiles")
        terrane("--quiet", "export", self.folder / "x.pmtiles", "-o", self.folder / "packed.ply")
        self.assertTrue((self.folder / "packed.ply").read_bytes() ==
                        self.export("folder.ply").read_bytes())

    def test_bad_wishes_get_one_clear_line(self):
        for status, word, arguments in (
                (USAGE, "levels 0", ["--level", 99, "-o", "x.ply"]),
                (USAGE, ".obj, .ply or .glb", ["-o", "x.stl"]),
                (USAGE, "empty", ["--area=1,4,2,3", "-o", "x.ply"]),
                (USAGE, "--area", ["--area=1,2,3", "-o", "x.ply"]),
                (INPUT, "--area", ["--area=1,2,3,4", "-o", "x.ply"]),
                (USAGE, ".glb, or a folder", ["--stack", "-o", "x.ply"])):
            got, printed, said = terrane("--quiet", "export", self.out, *arguments, cwd=self.folder)
            self.assertEqual(got, status, said)
            self.assertEqual(printed, "")
            self.assertIn(word, said)
            self.assertFalse((self.folder / "x.ply").exists())


if __name__ == "__main__":
    unittest.main()
