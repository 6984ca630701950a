#!/usr/bin/env python3
"""`terrane build --format terrarium|terrain-rgb`: the pictures, decoded by code of this test, against
formulas, and against gdalwarp where the folder with real DEMs is there."""

import array
import json
import math
import pathlib
import shutil
import struct
import subprocess
import tempfile
import time
import unittest
import zlib

from program import DATA, bytes_below, finish_after_kills, terrane

USAGE, INPUT = 2, 3
WEST, NORTH, CELL = 7.0, 47.0, 0.01  # of the first sample of the made-up DEM
COLUMNS, ROWS = 100, 80
HOLE = range(40, 60)
REAL = DATA / "crater_lake/N42W123.hgt"


def plane(longitude, latitude):
    """Steep: half a pixel aside is 5 m."""
    return 900 + 1000 * (longitude - 7) - 700 * (latitude - 46)


def write_plane(file, hole=False, lowest=None):
    lines = [f"ncols {COLUMNS}", f"nrows {ROWS}", f"xllcenter {WEST}",
             f"yllcenter {NORTH - (ROWS - 1) * CELL}", f"cellsize {CELL}", "NODATA_value -99999"]
    for row in range(ROWS):
        heights = [plane(WEST + column * CELL, NORTH - row * CELL) for column in range(COLUMNS)]
        if hole and row in HOLE:
            heights[HOLE.start:HOLE.stop] = [-99999] * len(HOLE)
        if lowest is not None:
            heights[0] = lowest
        lines.append(" ".join(f"{height:.4f}" for height in heights))
    file.write_text("\n".join(lines) + "\n")


def read_png(data):
    """Rows of bytes of an 8-bit RGB picture, by the PNG specification (2nd edition), chapter 9."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert (depth, colour, interlace) == (8, 2, 0)
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, stride, rows = zlib.decompress(packed), 3 * width, []
    above = bytearray(stride)
    for row in range(height):
        kind, line = raw[row * (stride + 1)], bytearray(raw[row * (stride + 1) + 1:][:stride])
        for i in range(stride):
            left, up = (line[i - 3] if i >= 3 else 0), above[i]
            corner = above[i - 3] if i >= 3 else 0
            if kind == 1:
                line[i] = (line[i] + left) & 255
            elif kind == 2:
                line[i] = (line[i] + up) & 255
            elif kind == 3:
                line[i] = (line[i] + (left + up) // 2) & 255
            elif kind == 4:
                guess = left + up - corner
                nearest = min((left, up, corner), key=lambda p, g=guess: abs(g - p))
                line[i] = (line[i] + nearest) & 255
        rows.append(bytes(line))
        above = line
    return rows


def read_webp(file):
    """The same of a WebP, by GDAL's program."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["gdal_translate", "-q", "-of", "ENVI", "-co", "INTERLEAVE=BIP", file,
                        f"{folder}/p"], check=True)
        raw = pathlib.Path(folder, "p").read_bytes()
    side = math.isqrt(len(raw) // 3)
    return [raw[row * 3 * side:(row + 1) * 3 * side] for row in range(side)]


def terrarium(red, green, blue):
    return red * 256 + green + blue / 256 - 32768


def terrain_rgb(red, green, blue):
    return -10000 + (red * 65536 + green * 256 + blue) * 0.1


def heights_of(rows, decode):
    return [[decode(*line[3 * i:3 * i + 3]) for i in range(len(line) // 3)] for line in rows]


def place_of(zoom, px, column, row):
    """Longitude and latitude of a position in pixels of the whole map (slippy map tilenames)."""
    across = px * 2 ** zoom
    latitude = math.degrees(math.atan(math.sinh(math.pi * (1 - 2 * row / across))))
    return column / across * 360 - 180, latitude


class Pictures:
    """Decoded tiles of a zoom as one map."""

    def __init__(self, folder, zoom, px, decode=terrarium):
        self.zoom, self.px = zoom, px
        self.tiles = {}
        for file in sorted((folder / str(zoom)).rglob("*.png")):
            self.tiles[int(file.parent.name), int(file.stem)] = heights_of(
                read_png(file.read_bytes()), decode)

    def pixels(self):
        """(column, row, height) of each."""
        for (x, y), rows in self.tiles.items():
            for j, line in enumerate(rows):
                for i, height in enumerate(line):
                    yield x * self.px + i, y * self.px + j, height

    def middle(self, column, row):
        return place_of(self.zoom, self.px, column + 0.5, row + 0.5)


def is_inside(longitude, latitude, margin):
    """Inside the samples, by so many cells?"""
    return (WEST + margin * CELL < longitude < WEST + (COLUMNS - 1 - margin) * CELL and
            NORTH - (ROWS - 1 - margin) * CELL < latitude < NORTH - margin * CELL)


class Raster(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.dem = self.folder / "plane.asc"
        write_plane(self.dem)

    def build(self, name, *more, form="terrarium", dem=None, crs=("--crs", "EPSG:4326")):
        status, printed, said = terrane("build", dem or self.dem, "-o", self.folder / name, *crs,
                                        "--format", form, *more)
        self.assertEqual(status, 0, said)
        return printed

    def worst(self, pictures, expected, margin):
        """Largest difference to a formula where the DEM is, and how many pixels are there."""
        worst, count = 0, 0
        for column, row, height in pictures.pixels():
            longitude, latitude = pictures.middle(column, row)
            if not is_inside(longitude, latitude, margin):
                continue
            worst = max(worst, abs(height - expected(column, row)))
            count += 1
        return worst, count

    def test_a_plane_stands_at_the_middles_of_pixels_to_half_a_step(self):
        for form, decode, step in (("terrarium", terrarium, 1 / 256), ("terrain-rgb", terrain_rgb, 0.1)):
            self.build(form, "--raster-px", "256", form=form)
            said = json.loads((self.folder / form / "tiles.json").read_text())
            self.assertEqual(said["maxzoom"], 7)  # pixels of 0.01099 degrees; zoom 6: 0.022
            pictures = Pictures(self.folder / form, 7, 256, decode)
            worst, count = self.worst(pictures, lambda c, r, p=pictures: plane(*p.middle(c, r)), 1)
            self.assertGreater(count, 5000)
            self.assertLess(worst, step / 2 + 0.001)

    def test_coarser_zooms_are_means_of_four(self):
        self.build("out", "--raster-px", "256")
        for zoom in (6, 5):
            finest = 2 ** (7 - zoom)
            pictures = Pictures(self.folder / "out", zoom, 256)

            def mean(column, row, n=finest):
                return sum(plane(*place_of(7, 256, n * column + i + 0.5, n * row + j + 0.5))
                           for i in range(n) for j in range(n)) / n ** 2

            worst, count = self.worst(pictures, mean, finest + 2)
            self.assertGreater(count, 200)
            self.assertLess(worst, 1 / 512 + 0.001)

    def test_what_has_no_data_is_the_fill_and_no_part_of_means(self):
        dem = self.folder / "hole.asc"
        write_plane(dem, hole=True)
        self.build("out", "--raster-px", "256", "--fill", "-5", dem=dem)
        for zoom in (7, 6):
            low, high = 1e9, -1e9
            filled = 0
            for _, _, height in Pictures(self.folder / "out", zoom, 256).pixels():
                if height == -5:
                    filled += 1
                else:
                    low, high = min(low, height), max(high, height)
            self.assertGreater(filled, 1000)
            # nothing in between: a mean with the fill in it would be
            self.assertGreater(low, plane(WEST, NORTH) - 15)
            self.assertLess(high, plane(WEST + COLUMNS * CELL, NORTH - ROWS * CELL) + 15)
        pictures = Pictures(self.folder / "out", 7, 256)
        for column, row, height in pictures.pixels():
            longitude, latitude = pictures.middle(column, row)
            inside = (WEST + 41 * CELL < longitude < WEST + 58 * CELL and
                      NORTH - 58 * CELL < latitude < NORTH - 41 * CELL)
            if inside or not is_inside(longitude, latitude, -2):
                self.assertEqual(height, -5)

    @unittest.skipUnless(shutil.which("gdal_translate"), "gdal-bin is missing")
    def test_webp_loses_nothing_and_512_pixels_are_a_zoom_less(self):
        self.build("png")
        self.build("webp", "--raster-image", "webp")
        self.assertEqual(json.loads((self.folder / "png/tiles.json").read_text())["maxzoom"], 6)
        files = sorted((self.folder / "webp/6").rglob("*.webp"))
        self.assertTrue(files)
        for file in files:
            twin = self.folder / "png" / file.relative_to(self.folder / "webp").with_suffix(".png")
            self.assertEqual(read_webp(file), read_png(twin.read_bytes()))

    def test_the_same_bytes_again_also_after_kills_and_is_then_up_to_date(self):
        started = time.monotonic()
        self.build("whole", "--max-zoom", "9")
        duration_s = time.monotonic() - started
        status, _, said = finish_after_kills(
            ["--quiet", "build", self.dem, "-o", self.folder / "killed", "--crs", "EPSG:4326",
             "--format", "terrarium", "--max-zoom", "9"], duration_s)
        self.assertEqual(status, 0, said)
        self.assertEqual(bytes_below(self.folder / "killed"), bytes_below(self.folder / "whole"))
        self.assertIn("up to date", self.build("whole", "--max-zoom", "9"))
        self.assertEqual(list(self.folder.glob("*.tif")), [])
        again = terrane("build", "--config", self.folder / "whole/build.toml", "-o",
                        self.folder / "again")
        self.assertEqual(again[0], 0, again[2])
        self.assertEqual(bytes_below(self.folder / "again"), bytes_below(self.folder / "whole"))

    def test_goes_on_over_the_antimeridian(self):
        dem = self.folder / "fiji.asc"
        text = self.dem.read_text().replace(f"xllcenter {WEST}", "xllcenter 179.5")
        dem.write_text(text)
        self.build("out", "--raster-px", "256", dem=dem)
        names = {int(file.name) for file in (self.folder / "out/7").iterdir()}
        self.assertEqual(names, {0, 127})
        self.assertEqual([file.name for file in (self.folder / "out/0").iterdir()], ["0"])
        heights = {height for _, _, height in Pictures(self.folder / "out", 7, 256).pixels()}
        self.assertGreater(len(heights), 5000)

    def test_info_pack_and_verify_know_it(self):
        self.build("out")
        status, printed, said = terrane("info", self.folder / "out")
        self.assertEqual(status, 0, said)
        self.assertIn("terrarium, 512 px a tile", printed)
        status, _, said = terrane("pack", self.folder / "out", "-o", self.folder / "out.pmtiles")
        self.assertEqual(status, 0, said)
        header = (self.folder / "out.pmtiles").read_bytes()[:127]
        self.assertEqual((header[99], header[100], header[101]), (2, 0, 6))  # PNG, zooms 0 to 6
        status, printed, said = terrane("verify", self.folder / "out")
        self.assertEqual(status, 0, printed + said)

    def refuse(self, status, arguments, *words):
        got, _, said = terrane("--quiet", "build", self.dem, "-o", self.folder / "out", *arguments)
        self.assertEqual(got, status, said)
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        for word in words:
            self.assertIn(word, said)

    def test_refuses_what_it_cannot_do_in_one_line(self):
        pictures = ["--crs", "EPSG:4326", "--format", "terrarium"]
        self.refuse(USAGE, [*pictures, "--raster-px", "300"], "--raster-px 300", "256 or 512")
        self.refuse(USAGE, [*pictures, "--raster-image", "jpeg"], "jpeg", "webp")
        self.refuse(USAGE, [*pictures, "--tolerance", "2"], "--tolerance")
        self.refuse(USAGE, [*pictures, "--geoid", "egm96"], "--geoid")
        self.refuse(USAGE, [*pictures, "--compression", "none"], "--compression")
        self.refuse(USAGE, [*pictures, "--scheme", "geodetic"], "--scheme")
        self.refuse(USAGE, [*pictures, "--max-zoom", "23"], "--max-zoom 23")
        self.refuse(USAGE, ["--raster-px", "256"], "--raster-px")
        self.refuse(INPUT, ["--format", "terrarium"], "--crs")
        write_plane(self.dem, lowest=-10900)
        self.refuse(USAGE, ["--crs", "EPSG:4326", "--format", "terrain-rgb"], "-10900", "terrarium")

    @unittest.skipUnless(REAL.exists() and shutil.which("gdalwarp"),
                         "the folder with real DEMs or gdal-bin is absent")
    def test_a_real_dem_is_what_gdalwarp_makes_of_it(self):
        self.build("out", "--raster-px", "256", "--nodata", "-32768", dem=REAL, crs=())
        zoom = json.loads((self.folder / "out/tiles.json").read_text())["maxzoom"]
        file = sorted((self.folder / "out" / str(zoom)).rglob("*.png"))[20]
        x, y = int(file.parent.name), int(file.stem)
        half = math.pi * 6378137
        size = 2 * half / 2 ** zoom
        subprocess.run(
            ["gdalwarp", "-q", "-t_srs", "EPSG:3857", "-r", "bilinear", "-et", "0", "-ot", "Float32",
             "-te", *map(repr, (x * size - half, half - (y + 1) * size, (x + 1) * size - half,
                                half - y * size)),
             "-ts", "256", "256", "-dstnodata", "-99999", "-of", "ENVI", REAL,
             self.folder / "warped"], check=True)
        warped = array.array("f", (self.folder / "warped").read_bytes())
        rows = heights_of(read_png(file.read_bytes()), terrarium)
        off = [abs(rows[i // 256][i % 256] - warped[i]) for i in range(len(warped))
               if warped[i] != -99999]
        self.assertGreater(len(off), 30000)
        self.assertLess(max(off), 1 / 256)


if __name__ == "__main__":
    unittest.main()
