#!/usr/bin/env python3
"""`terrane build --scheme geodetic` as a user runs it."""

import json
import math
import pathlib
import tempfile
import time
import unittest

from program import bytes_below, finish_after_kills, terrane

USAGE, INPUT = 2, 3


def write_hills(file):
    """100 x 80 samples of 0.01 degrees around (7.5, 46.6), with a hole."""
    lines = ["ncols 100", "nrows 80", "xllcorner 7", "yllcorner 46.2", "cellsize 0.01",
             "NODATA_value -9999"]
    for row in range(80):
        heights = [800 + 300 * math.sin(column / 9) * math.cos(row / 7) for column in range(100)]
        if 30 < row < 40:
            heights[50:56] = [-9999] * 6
        lines.append(" ".join(f"{height:.2f}" for height in heights))
    file.write_text("\n".join(lines) + "\n")


class Geodetic(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.dem = self.folder / "hills.asc"
        write_hills(self.dem)

    def build(self, name, *more, crs="EPSG:4326"):
        return terrane("build", self.dem, "-o", self.folder / name, "--crs", crs,
                       "--scheme", "geodetic", "--tolerance", "5", *more)

    def refuse(self, status, arguments, *words):
        got, _, said = terrane("--quiet", "build", self.dem, "-o", self.folder / "out", *arguments)
        self.assertEqual(got, status, said)
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        for word in words:
            self.assertIn(word, said)

    def test_gives_the_same_bytes_with_one_thread_and_two_and_is_then_up_to_date(self):
        for name, jobs in (("one", "1"), ("two", "2")):
            status, _, said = self.build(name, "--jobs", jobs)
            self.assertEqual(status, 0, said)
        self.assertEqual(bytes_below(self.folder / "one"), bytes_below(self.folder / "two"))
        self.assertIn("up to date", self.build("one")[1])
        self.assertEqual(list(self.folder.glob("*.tif")), [])

    def test_a_killed_build_goes_on_to_the_same_bytes(self):
        started = time.monotonic()
        self.build("whole")
        duration_s = time.monotonic() - started
        status, _, said = finish_after_kills(
            ["--quiet", "build", self.dem, "-o", self.folder / "killed", "--crs", "EPSG:4326",
             "--scheme", "geodetic", "--tolerance", "5"], duration_s)
        self.assertEqual(status, 0, said)
        self.assertEqual(bytes_below(self.folder / "killed"), bytes_below(self.folder / "whole"))

    def test_a_build_that_was_killed_as_it_tidied_up_is_tidied_up(self):
        self.build("out")
        (self.folder / "out/.work").mkdir()
        (self.folder / "out/.work/key").write_text("0123456789abcdef")
        self.assertIn("up to date", self.build("out")[1])
        self.assertFalse((self.folder / "out/.work").exists())

    def test_every_zoom_is_within_its_tolerance_and_info_tells(self):
        self.build("out")
        summary = json.loads((self.folder / "out/terrane.json").read_text())
        self.assertEqual([zoom["zoom"] for zoom in summary["zooms"]],
                         list(range(len(summary["zooms"]))))
        for zoom in summary["zooms"]:
            self.assertLessEqual(zoom["max_error_m"], zoom["tolerance_m"])
        status, printed, said = terrane("info", self.folder / "out")
        self.assertEqual(status, 0, said)
        self.assertIn("DEM samples", printed)

    def test_says_what_it_assumed_of_the_heights(self):
        self.assertIn("--geoid egm96", self.build("assumed")[2])
        self.assertNotIn("--geoid egm96", self.build("said", "--geoid", "none")[2])
        self.assertIn("EGM96", self.build("compound", crs="EPSG:4326+5773")[2])

    def test_the_settings_that_were_written_repeat_the_run(self):
        self.build("first", "--fill", "100", "--attribution", "hills", "--geoid", "egm96")
        status, _, said = terrane("--quiet", "build", "--config", self.folder / "first/build.toml",
                                  "-o", self.folder / "again")
        self.assertEqual(status, 0, said)
        self.assertEqual(bytes_below(self.folder / "first"), bytes_below(self.folder / "again"))

    def test_the_same_meshes_as_3d_tiles(self):
        self.build("mesh")
        status, _, said = self.build("tiles", "--format", "3dtiles-terrain")
        self.assertEqual(status, 0, said)
        mesh, tiles = (json.loads((self.folder / name / "terrane.json").read_text())
                       for name in ("mesh", "tiles"))
        self.assertEqual([zoom["triangles"] for zoom in mesh["zooms"]],
                         [zoom["triangles"] for zoom in tiles["zooms"]])
        tileset = json.loads((self.folder / "tiles/tileset.json").read_text())
        self.assertEqual(len(tileset["root"]["children"]), 2)
        self.assertEqual(len(list((self.folder / "tiles").rglob("*.glb"))),
                         sum(zoom["tiles"] for zoom in tiles["zooms"]))
        self.assertIn("up to date", self.build("tiles", "--format", "3dtiles-terrain")[1])
        # another format in the same folder leaves nothing of the first
        self.build("tiles")
        self.assertEqual(bytes_below(self.folder / "tiles").keys(),
                         bytes_below(self.folder / "mesh").keys())

    def test_refuses_a_tolerance_that_tiles_half_round_the_earth_cannot_hold(self):
        row = " ".join(str(100 * (column % 7)) for column in range(72))
        self.dem.write_text("ncols 72\nnrows 36\nxllcorner -180\nyllcorner -90\ncellsize 5\n" +
                            (row + "\n") * 36)
        self.refuse(USAGE, ["--crs", "EPSG:4326", "--scheme", "geodetic", "--geoid", "none",
                            "--max-zoom", "2", "--tolerance", "100"], "--tolerance 100", "zoom 1")

    def test_refuses_what_cannot_be_in_one_line(self):
        crs = ["--crs", "EPSG:4326"]
        geodetic = [*crs, "--scheme", "geodetic"]
        self.refuse(USAGE, [*crs, "--scheme", "mercator"], "mercator", "geodetic")
        self.refuse(USAGE, [*geodetic, "--format", "3dtiles"], "quantized-mesh")
        self.refuse(USAGE, [*geodetic, "--format", "3dtiles-terrain", "--water", self.dem],
                    "--water", "quantized-mesh")
        self.refuse(USAGE, [*geodetic, "--format", "3dtiles-terrain", "--compression", "meshopt"],
                    "--compression meshopt", "16 bits")
        self.refuse(USAGE, [*geodetic, "--skirts", "auto"], "--skirts", "quantized-mesh")
        self.refuse(USAGE, [*crs, "--max-zoom", "9"], "--max-zoom", "--scheme geodetic")
        self.refuse(USAGE, ["--geoid", "egm96"], "--geoid egm96", "CRS")
        self.refuse(USAGE, [*geodetic, "--geoid", "egm1066"], "egm1066", "egm96")
        self.refuse(USAGE, [*geodetic, "--max-zoom", "99"], "--max-zoom 99")
        self.refuse(USAGE, [*geodetic, "--tolerance", "0.001"], "--tolerance")
        self.refuse(INPUT, ["--scheme", "geodetic"], "CRS")

    def test_the_tolerance_holds_at_the_dems_own_samples(self):
        self.build("out", "--geoid", "egm96")
        summary = json.loads((self.folder / "out/terrane.json").read_text())
        self.assertEqual(summary["zooms"][-1]["held_to"], "DEM samples")
        status, _, said = terrane("--quiet", "verify", self.folder / "out", "--json",
                                  self.folder / "report.json")
        self.assertEqual(status, 0, said)
        report = json.loads((self.folder / "report.json").read_text())
        self.assertTrue(report["holds"])
        finest = report["zooms"][-1]
        self.assertEqual(finest["samples"], 100 * 80 - 9 * 6)
        self.assertLessEqual(finest["max_error_m"], 5)
        self.assertGreater(finest["border_vertices"], 0)

    def test_a_zoom_too_coarse_for_the_tolerance_is_said_and_held_to_posts(self):
        status, _, said = self.build("out", "--max-zoom", "6")
        self.assertEqual(status, 0, said)
        self.assertIn("--max-zoom", said)
        summary = json.loads((self.folder / "out/terrane.json").read_text())
        self.assertEqual(summary["zooms"][-1]["held_to"], "finest posts")
        self.assertGreater(summary["resampling"]["max_error_m"], 5)


if __name__ == "__main__":
    unittest.main()
