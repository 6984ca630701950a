#!/usr/bin/env python3
"""`terrane verify` on 3D Tiles terrain: it finds what is broken on purpose, also in what a hand that knows
glTF would get wrong, and judges the poles and the meridian of 180 degrees."""

import json
import math
import pathlib
import shutil
import struct
import tempfile
import unittest

from geodetic_test import write_hills
from program import terrane

ANSWER_IS_NO = 1


class Glb:
    """A glb taken apart, to be changed in place."""

    def __init__(self, file):
        self.file = file
        data = file.read_bytes()
        length, = struct.unpack_from("<I", data, 12)
        self.json = json.loads(data[20:20 + length])
        self.binary = bytearray(data[28 + length:])

    @property
    def primitive(self):
        return self.json["meshes"][0]["primitives"][0]

    def place(self, accessor):
        """Where the values of an accessor begin, and how many there are."""
        about = self.json["accessors"][accessor]
        return self.json["bufferViews"][about["bufferView"]].get("byteOffset", 0), about["count"]

    def vector(self, name, k, value=None):
        at = self.place(self.primitive["attributes"][name])[0] + 12 * k
        if value is not None:
            struct.pack_into("<3f", self.binary, at, *value)
        return struct.unpack_from("<3f", self.binary, at)

    def write(self):
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        self.file.write_bytes(
            struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.binary)) +
            struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)


class TerrainTilesVerify(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        dem = cls.folder / "hills.asc"
        write_hills(dem)
        for form in ("3dtiles-terrain", "quantized-mesh"):
            status, _, said = terrane(
                "--quiet", "build", dem, "-o", cls.folder / form, "--crs", "EPSG:4326", "--scheme",
                "geodetic", "--format", form, "--tolerance", "5", "--geoid", "none")
            assert status == 0, said
        cls.sound = cls.folder / "3dtiles-terrain"
        cls.finest = len(json.loads((cls.sound / "terrane.json").read_text())["zooms"]) - 1
        # a tile with neighbours
        there = {(int(file.parent.name), int(file.stem))
                 for file in (cls.sound / f"east/{cls.finest}").rglob("*.glb")}
        x, y = min((x, y) for x, y in there
                   if {(x - 1, y), (x, y - 1)} <= there)
        cls.tile = f"east/{cls.finest}/{x}/{y}.glb"

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def verify(self, out):
        status, printed, said = terrane("--quiet", "verify", out, "--json", self.folder / "report.json")
        return status, printed + said, json.loads((self.folder / "report.json").read_text())

    def broken(self, fault, change, *words, zoom=None):
        """Changes a copy; the fault must be counted."""
        out = self.folder / "broken"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(self.sound, out)
        change(out)
        status, said, report = self.verify(out)
        self.assertEqual(status, ANSWER_IS_NO, said)
        faults = report["zooms"][self.finest if zoom is None else zoom]["faults"]
        self.assertGreater(faults[fault], 0, said)
        for word in words:
            self.assertIn(word, "\n".join(report["problems"]))
        return report["zooms"][self.finest if zoom is None else zoom]

    def change_tile(self, edit):
        def change(out):
            glb = Glb(out / self.tile)
            edit(glb)
            glb.write()
        return change

    def change_facts(self, name, k, value):
        """A change of one number in the metadata of the root's subtree: of its first tile."""
        def change(out):
            file = out / "subtrees/east/0/0/0.subtree"
            data = bytearray(file.read_bytes())
            length, = struct.unpack_from("<Q", data, 8)
            about = json.loads(data[24:24 + length])
            view = about["bufferViews"][about["propertyTables"][0]["properties"][name]["values"]]
            struct.pack_into("<d", data, 24 + length + view.get("byteOffset", 0) + 8 * k, value)
            file.write_bytes(data)
        return change

    def test_what_was_built_holds_and_is_the_surface_of_the_quantized_mesh(self):
        status, said, tiles = self.verify(self.sound)
        self.assertEqual(status, 0, said)
        self.assertIn("All invariants hold.", said)
        status, said, mesh = self.verify(self.folder / "quantized-mesh")
        self.assertEqual(status, 0, said)
        for a, b in zip(tiles["zooms"], mesh["zooms"], strict=True):
            self.assertEqual(a["border_vertices"], b["border_vertices"])
            # floats of the tile's size: 2^-22 of it
            self.assertAlmostEqual(a["max_error_m"], b["max_error_m"],
                                   delta=max(1e-3, 2.0037508e7 / 2 ** (22 + a["zoom"])))

    def test_finds_a_tile_that_is_not_there_and_one_that_is_not_listed(self):
        self.broken("missing", lambda out: (out / self.tile).unlink(), "there is no file")
        self.broken("unexpected", lambda out: shutil.copytree(
            out / f"east/{self.finest}", out / f"west/{self.finest}"), "is not listed")

    def test_finds_a_tile_that_is_cut_short(self):
        def cut(out):
            data = (out / self.tile).read_bytes()
            (out / self.tile).write_bytes(data[:len(data) // 2])
        self.broken("unreadable", cut, self.tile)

    def test_finds_a_tile_that_is_moved_by_its_matrix(self):
        def move(glb):
            glb.json["nodes"][0]["matrix"][12] += 0.25
        zoom = self.broken("borders", self.change_tile(move), "border vertices differ")
        self.assertGreater(zoom["faults"]["edge_lists"], 0)

    def test_finds_a_vertex_that_is_lifted_by_less_than_the_tolerance(self):
        def lift(glb):
            at, _ = glb.place(glb.primitive["extensions"]["CESIUM_tile_edges"]["left"])
            k, = struct.unpack_from("<H", glb.binary, at)
            x, y, z = glb.vector("POSITION", k)
            glb.vector("POSITION", k, (x, y + 2 ** -8, z))
        self.broken("borders", self.change_tile(lift), "border vertices differ")

    def test_finds_a_peak_that_no_sample_has(self):
        def lift(glb):
            _, count = glb.place(glb.primitive["attributes"]["POSITION"])
            borders = set()
            for accessor in glb.primitive["extensions"]["CESIUM_tile_edges"].values():
                at, n = glb.place(accessor)
                borders.update(struct.unpack_from(f"<{n}H", glb.binary, at))
            k = next(k for k in range(count) if k not in borders)
            # up, in glTF's axes, from the middle of the Earth
            matrix = glb.json["nodes"][0]["matrix"]
            place = [a + b for a, b in zip(glb.vector("POSITION", k), matrix[12:15])]
            length = math.hypot(*place)
            glb.vector("POSITION", k,
                       [a - b + 60 * a / length for a, b in zip(place, matrix[12:15])])
        zoom = self.broken("misstated", self.change_tile(lift), "states an error of")
        self.assertGreater(zoom["samples_over_tolerance"], 0)

    def test_finds_triangles_that_are_turned_left_out_or_there_twice(self):
        def turn(glb):
            at, _ = glb.place(glb.primitive["indices"])
            a, b = struct.unpack_from("<2H", glb.binary, at)
            struct.pack_into("<2H", glb.binary, at, b, a)
        self.assertGreater(self.broken("cover", self.change_tile(turn))["faults"]["folded"], 0)

        def leave_out(glb):
            glb.json["accessors"][glb.primitive["indices"]]["count"] -= 3
        self.broken("cover", self.change_tile(leave_out), "one side only")

        def double(glb):
            at, count = glb.place(glb.primitive["indices"])
            glb.binary[at + 2 * count - 6:at + 2 * count] = glb.binary[at:at + 6]
        self.broken("cover", self.change_tile(double))

    def test_finds_border_lists_that_lack_a_vertex_or_are_exchanged(self):
        def shorten(glb):
            glb.json["accessors"][glb.primitive["extensions"]["CESIUM_tile_edges"]["top"]]["count"] -= 1
        self.broken("cover", self.change_tile(shorten))

        def exchange(glb):
            edges = glb.primitive["extensions"]["CESIUM_tile_edges"]
            edges["left"], edges["right"] = edges["right"], edges["left"]
        self.broken("edge_lists", self.change_tile(exchange), "not on the border")

    def test_finds_normals_that_point_down(self):
        def turn(glb):
            glb.vector("NORMAL", 0, [-c for c in glb.vector("NORMAL", 0)])
        self.broken("normals", self.change_tile(turn), "1 normals")

    def test_finds_metadata_that_are_not_the_tiles(self):
        self.broken("heights", self.change_facts("min_height", 0, -500), "states heights", zoom=0)
        self.broken("spheres", self.change_facts("bounding_sphere", 3, 1e6), "bounding sphere", zoom=0)
        # that of the eastern half lies along y
        self.broken("horizon", self.change_facts("horizon_occlusion_point", 1, 0), "occlusion", zoom=0)

    def test_finds_a_root_whose_region_is_another(self):
        def shrink(out):
            file = out / "tileset.json"
            tileset = json.loads(file.read_text())
            tileset["root"]["children"][1]["boundingVolume"]["region"][5] -= 100
            file.write_text(json.dumps(tileset))
        self.broken("misstated", shrink, "the region of the eastern root", zoom=0)

    def test_judges_the_poles_and_the_meridian_of_180_degrees(self):
        dem = self.folder / "earth.asc"
        rows = [" ".join(f"{4000 * math.sin(c / 5) * math.sin(math.pi * (r + 0.5) / 36) + 4000:.1f}"
                         for c in range(72)) for r in range(36)]
        dem.write_text("ncols 72\nnrows 36\nxllcorner -180\nyllcorner -90\ncellsize 5\n" +
                       "\n".join(rows) + "\n")
        status, _, said = terrane(
            "--quiet", "build", dem, "-o", self.folder / "earth", "--crs", "EPSG:4326", "--scheme",
            "geodetic", "--format", "3dtiles-terrain", "--tolerance", "800", "--geoid", "none",
            "--max-zoom", "2")
        self.assertEqual(status, 0, said)
        status, said, report = self.verify(self.folder / "earth")
        self.assertEqual(status, 0, said)
        self.assertEqual(report["zooms"][2]["tiles"], 32)
        self.assertEqual(report["zooms"][2]["uncovered_samples"], 0)


if __name__ == "__main__":
    unittest.main()
