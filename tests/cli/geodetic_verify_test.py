#!/usr/bin/env python3
"""`terrane verify` on terrain of the geodetic quadtree: it finds what is broken on purpose."""

import gzip
import json
import pathlib
import shutil
import struct
import tempfile
import unittest

from geodetic_test import write_hills
from program import terrane

ANSWER_IS_NO = 1

# bytes from the start of a quantized-mesh tile
MINIMUM, SPHERE_RADIUS, HORIZON, COUNT, VERTICES = 24, 56, 64, 88, 92


class GeodeticVerify(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        dem = cls.folder / "hills.asc"
        write_hills(dem)
        status, _, said = terrane(
            "--quiet", "build", dem, "-o", cls.folder / "sound", "--crs", "EPSG:4326", "--scheme",
            "geodetic", "--tolerance", "5", "--geoid", "none")
        assert status == 0, said
        summary = json.loads((cls.folder / "sound/terrane.json").read_text())
        cls.finest = len(summary["zooms"]) - 1
        # a tile with neighbours
        layer = json.loads((cls.folder / "sound/layer.json").read_text())
        (square,) = layer["available"][-1]
        cls.tile = f"{cls.finest}/{square['startX'] + 1}/{square['startY'] + 1}.terrain"

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def broken(self, fault, change, *words, zoom=None):
        """Changes a copy; the fault must be counted, and no fault of a kind that is not named."""
        out = self.folder / "broken"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(self.folder / "sound", out)
        change(out)
        status, printed, said = terrane("--quiet", "verify", out, "--json",
                                        self.folder / "report.json")
        self.assertEqual(status, ANSWER_IS_NO, said)
        report = json.loads((self.folder / "report.json").read_text())
        found = report["zooms"][self.finest if zoom is None else zoom]["faults"]
        self.assertGreater(found[fault], 0, printed)
        for word in words:
            self.assertIn(word, "\n".join(report["problems"]))
        return report

    def change_tile(self, edit):
        """A change of the bytes of one tile."""
        def change(out):
            file = out / self.tile
            data = bytearray(gzip.decompress(file.read_bytes()))
            edit(data)
            file.write_bytes(gzip.compress(bytes(data)))
        return change

    def test_what_was_built_holds(self):
        status, printed, said = terrane("--quiet", "verify", self.folder / "sound")
        self.assertEqual(status, 0, printed + said)
        self.assertIn("All invariants hold.", printed)

    def test_finds_tiles_that_are_not_there_or_not_listed(self):
        self.broken("missing", lambda out: (out / self.tile).unlink(), self.tile[:-8])
        self.broken("unexpected", lambda out: shutil.copy(
            out / self.tile, out / f"{self.finest}/0/0.terrain"
            if (out / f"{self.finest}/0").mkdir() is None else None), "0/0.terrain")

    def test_finds_a_tile_that_is_cut_short(self):
        def cut(out):
            data = (out / self.tile).read_bytes()
            (out / self.tile).write_bytes(data[:len(data) // 2])
        self.broken("unreadable", cut, self.tile[:-8])

    def test_finds_a_tile_that_is_lifted(self):
        def lift(data):
            for at in (MINIMUM, MINIMUM + 4):
                struct.pack_into("<f", data, at, struct.unpack_from("<f", data, at)[0] + 20)
        report = self.broken("borders", self.change_tile(lift), "border vertices differ")
        self.assertGreater(report["zooms"][-1]["samples_over_tolerance"], 100)
        self.assertGreaterEqual(report["zooms"][-1]["faults"]["misstated"], 1)

    def test_finds_a_sphere_too_small_and_a_point_behind_the_horizon(self):
        def shrink(data):
            radius, = struct.unpack_from("<d", data, SPHERE_RADIUS)
            struct.pack_into("<d", data, SPHERE_RADIUS, 0.99 * radius)
        self.broken("spheres", self.change_tile(shrink), "bounding sphere")

        def hide(data):
            struct.pack_into("<3d", data, HORIZON, 0, 0, 0)
        self.broken("horizon", self.change_tile(hide), "occlusion point")

    def test_finds_a_vertex_that_left_the_border(self):
        def move(data):
            # u is coded as differences: the first vertex takes all others with it
            count, = struct.unpack_from("<I", data, COUNT)
            at, low = 0, []
            for k in range(count):
                code, = struct.unpack_from("<H", data, VERTICES + 2 * k)
                at += (code >> 1) ^ -(code & 1)
                low.append(at)
            k = next(k for k in range(1, count) if low[k] == 0 or low[k - 1] == 0)
            k = k if low[k] == 0 else k - 1
            for place, step in ((k, 40), (k + 1, -40)):
                code, = struct.unpack_from("<H", data, VERTICES + 2 * place)
                delta = ((code >> 1) ^ -(code & 1)) + step
                struct.pack_into("<H", data, VERTICES + 2 * place,
                                 ((delta << 1) ^ (delta >> 31)) & 0xffff)
        report = self.broken("edge_lists", self.change_tile(move), "border list")
        self.assertGreater(report["zooms"][-1]["faults"]["cover"], 0)
        self.assertGreater(report["zooms"][-1]["faults"]["borders"], 0)

    def test_finds_an_index_beyond_the_high_water_mark_and_a_triangle_upside_down(self):
        def first_index(data):
            count, = struct.unpack_from("<I", data, COUNT)
            return VERTICES + 6 * count + 4

        def jump(data):
            struct.pack_into("<H", data, first_index(data), 7)
        self.broken("indices", self.change_tile(jump), "high-water mark")

        def turn(data):
            # two corners that were there before change places
            at = first_index(data)
            while not all(struct.unpack_from("<2H", data, at)):
                at += 6
            first, second = struct.unpack_from("<2H", data, at)
            struct.pack_into("<2H", data, at, second, first)
        report = self.broken("cover", self.change_tile(turn))
        self.assertGreater(report["zooms"][-1]["faults"]["folded"], 0)

    def test_finds_what_the_summary_misstates(self):
        def lie(out):
            file = out / "terrane.json"
            summary = json.loads(file.read_text())
            summary["zooms"][-1]["triangles"] += 1
            summary["zooms"][-1]["max_error_m"] = 0.5
            file.write_text(json.dumps(summary))
        report = self.broken("misstated", lie, "states an error of 0.5 m")
        self.assertEqual(report["zooms"][-1]["faults"]["misstated"], 2)

    def test_finds_a_root_that_is_not_listed(self):
        def leave_out(out):
            file = out / "layer.json"
            layer = json.loads(file.read_text())
            layer["available"][0] = [{"startX": 1, "startY": 0, "endX": 1, "endY": 0}]
            file.write_text(json.dumps(layer))
        self.broken("missing", leave_out, "0/0/0", "root", zoom=0)


if __name__ == "__main__":
    unittest.main()
