#!/usr/bin/env python3
"""`terrane verify` on heights as pictures: it finds what is broken on purpose."""

import json
import pathlib
import shutil
import struct
import tempfile
import unittest
import zlib

from program import terrane
from raster_test import read_png, write_plane

ANSWER_IS_NO, INPUT = 1, 3
FINEST = 7


def write_png(file, rows):
    """Rows of bytes as an 8-bit RGB picture, without filters."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    header = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                     chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))) +
                     chunk(b"IEND", b""))


class RasterVerify(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.dem = cls.folder / "plane.asc"
        write_plane(cls.dem, hole=True)
        cls.build("sound")
        # the tile with the middle of the DEM
        cls.tile = max((cls.folder / f"sound/{FINEST}").rglob("*.png"),
                       key=lambda file: file.stat().st_size).relative_to(cls.folder / "sound")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def build(cls, name, *more, form="terrarium", dem=None):
        status, _, said = terrane("--quiet", "build", dem or cls.dem, "-o", cls.folder / name, "--crs",
                                  "EPSG:4326", "--format", form, "--raster-px", "256", *more)
        assert status == 0, said

    def verify(self, out):
        status, printed, said = terrane("--quiet", "verify", out, "--json",
                                        self.folder / "report.json")
        return status, printed + said

    def report(self):
        return json.loads((self.folder / "report.json").read_text())

    def broken(self, fault, change, *words, zoom=FINEST):
        out = self.folder / "broken"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(self.folder / "sound", out)
        change(out)
        status, said = self.verify(out)
        self.assertEqual(status, ANSWER_IS_NO, said)
        self.assertGreater(self.report()["zooms"][zoom]["faults"][fault], 0, said)
        for word in words:
            self.assertIn(word, "\n".join(self.report()["problems"]))

    def test_what_was_built_holds(self):
        self.build("mapbox", "--fill", "-5", form="terrain-rgb")
        for name, half_step in (("sound", 1 / 512), ("mapbox", 0.05)):
            status, said = self.verify(self.folder / name)
            self.assertEqual(status, 0, said)
            self.assertIn("All invariants hold.", said)
            finest = self.report()["zooms"][FINEST]
            self.assertGreater(finest["pixels"], 4000)
            # bilinear between samples of a plane is the plane
            self.assertLess(finest["max_difference_m"], half_step + 0.005)

    def test_one_over_180_degrees_holds_too_and_one_coarser_than_the_dem(self):
        dem = self.folder / "fiji.asc"
        dem.write_text(self.dem.read_text().replace("xllcenter 7.0", "xllcenter 179.5"))
        self.build("fiji", dem=dem)
        self.assertEqual(*self.expected_and_found("fiji"))
        self.build("coarse", "--max-zoom", "5")
        self.assertEqual(*self.expected_and_found("coarse"))

    def expected_and_found(self, name):
        status, said = self.verify(self.folder / name)
        return (0, ""), (status, "" if status == 0 else said)

    def raise_pixel(self, file, metres):
        rows = [bytearray(row) for row in read_png(file.read_bytes())]
        # a pixel with data
        row, column = next((r, c) for r in range(20, len(rows)) for c in range(20, 256)
                           if rows[r][3 * c:3 * c + 2] != b"\x80\x00")
        rows[row][3 * column + 1] = (rows[row][3 * column + 1] + metres) % 256
        write_png(file, rows)

    def test_finds_a_pixel_that_no_sample_has(self):
        self.broken("off_dem", lambda out: self.raise_pixel(out / self.tile, 100), "the DEM around it")

    def test_finds_a_coarser_pixel_that_is_no_mean(self):
        self.broken("means", lambda out: self.raise_pixel(
            max((out / "6").rglob("*.png"), key=lambda file: file.stat().st_size), 1), "no mean", zoom=6)

    def test_finds_tiles_that_are_missing_beside_or_cut_short(self):
        self.broken("missing", lambda out: (out / self.tile).unlink(), "there is no file")
        self.broken("unexpected", lambda out: shutil.copytree(
            (out / self.tile).parent, out / f"{FINEST}/3"), "beside the bounds")

        def cut(out):
            data = (out / self.tile).read_bytes()
            (out / self.tile).write_bytes(data[:len(data) // 2])
        self.broken("unreadable", cut, "cut short")

        def spoil(out):
            data = bytearray((out / self.tile).read_bytes())
            data[len(data) // 2] ^= 1
            (out / self.tile).write_bytes(data)
        self.broken("unreadable", spoil, "checksum")

    def test_finds_what_is_misstated(self):
        def lie(out):
            summary = json.loads((out / "terrane.json").read_text())
            summary["zooms"][FINEST]["tiles"] += 1
            (out / "terrane.json").write_text(json.dumps(summary))
        self.broken("misstated", lie, "states")

    def test_refuses_bounds_of_other_tiles(self):
        out = self.folder / "broken"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(self.folder / "sound", out)
        listing = json.loads((out / "tiles.json").read_text())
        listing["bounds"] = [-180, -85, 180, 85]
        (out / "tiles.json").write_text(json.dumps(listing))
        status, _, said = terrane("--quiet", "verify", out)
        self.assertEqual(status, INPUT)
        self.assertIn("tiles.json", said)

    def test_says_that_it_reads_no_webp(self):
        self.build("webp", "--raster-image", "webp")
        status, _, said = terrane("--quiet", "verify", self.folder / "webp")
        self.assertEqual(status, INPUT)
        self.assertIn("--raster-image png", said)
        self.assertEqual(len(said.strip().splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
