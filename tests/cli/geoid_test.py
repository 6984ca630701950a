#!/usr/bin/env python3
"""`terrane build --geoid` for the DEM's own grid: heights against those that GDAL and PROJ make."""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from program import SKIPPED, terrane

COLUMNS, ROWS, CELL, HEIGHT = 60, 50, 0.01, 500
USAGE = 2


def undulations():
    """EGM96 at each sample, by GDAL."""
    points = [f"{7 + column * CELL} {47 - row * CELL} 0" for row in range(ROWS)
              for column in range(COLUMNS)]
    raised = subprocess.run(["gdaltransform", "-s_srs", "EPSG:4326+5773", "-t_srs", "EPSG:4979"],
                            input="\n".join(points), check=True, capture_output=True,
                            text=True).stdout.splitlines()
    return [float(line.split()[2]) for line in raised]


class OwnGrid(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.dem = self.folder / "flat.asc"
        lines = [f"ncols {COLUMNS}", f"nrows {ROWS}", "xllcenter 7",
                 f"yllcenter {47 - (ROWS - 1) * CELL}", f"cellsize {CELL}"]
        lines += [" ".join([str(HEIGHT)] * COLUMNS)] * ROWS
        self.dem.write_text("\n".join(lines) + "\n")

    def build(self, name, *more, crs="EPSG:4326"):
        status, _, said = terrane("build", self.dem, "-o", self.folder / name, "--crs", crs,
                                  "--tolerance", "1", *more)
        self.assertEqual(status, 0, said)
        return said, json.loads((self.folder / name / "terrane.json").read_text())["dem"]

    def assert_over_egm96(self, dem):
        geoid = undulations()
        self.assertGreater(max(geoid) - min(geoid), 0.2)
        self.assertAlmostEqual(dem["min_height_m"], HEIGHT + min(geoid), delta=0.02)
        self.assertAlmostEqual(dem["max_height_m"], HEIGHT + max(geoid), delta=0.02)

    def test_raises_what_is_over_the_geoid(self):
        self.assert_over_egm96(self.build("out", "--geoid", "egm96")[1])
        status, printed, said = terrane("--quiet", "verify", self.folder / "out")
        self.assertEqual(status, 0, printed + said)
        status, _, said = terrane("build", "--config", self.folder / "out/build.toml", "-o",
                                  self.folder / "again")
        self.assertEqual(status, 0, said)
        self.assertEqual((self.folder / "again/terrane.json").read_bytes(),
                         (self.folder / "out/terrane.json").read_bytes())

    def test_a_compound_crs_is_believed(self):
        said, dem = self.build("out", crs="EPSG:4326+5773")
        self.assertIn("over EGM96, as its CRS says", said)
        self.assert_over_egm96(dem)
        status, printed, said = terrane("--quiet", "verify", self.folder / "out")
        self.assertEqual(status, 0, printed + said)
        said, dem = self.build("as_it_is", "--geoid", "none", crs="EPSG:4326+5773")
        self.assertEqual((dem["min_height_m"], dem["max_height_m"]), (HEIGHT, HEIGHT))

    def test_says_what_it_assumed_where_the_dem_says_nothing(self):
        said, dem = self.build("out")
        self.assertIn("does not say what its heights are over", said)
        self.assertEqual((dem["min_height_m"], dem["max_height_m"]), (HEIGHT, HEIGHT))
        self.assertNotIn("does not say", self.build("none", "--geoid", "none")[0])

    def test_water_stands_at_its_height_over_the_geoid(self):
        pond = self.folder / "pond.geojson"
        ring = [[7.2, 46.7], [7.35, 46.7], [7.35, 46.8], [7.2, 46.8], [7.2, 46.7]]
        pond.write_text(json.dumps({"type": "Feature", "properties": {}, "geometry": {
            "type": "Polygon", "coordinates": [ring]}}))
        said, dem = self.build("out", "--geoid", "egm96", "--water", pond, "--water-height", "400")
        raised = subprocess.run(
            ["gdaltransform", "-s_srs", "EPSG:4326+5773", "-t_srs", "EPSG:4979"], input="\n".join(
                f"{x} {y} 400" for x, y in ring[:4]), check=True, capture_output=True,
            text=True).stdout.splitlines()
        corners = [float(line.split()[2]) for line in raised]
        # flat, so over the ellipsoid at one height: between those that its corners ask for
        self.assertGreaterEqual(dem["min_height_m"], min(corners) - 0.02)
        self.assertLessEqual(dem["min_height_m"], max(corners) + 0.02)
        self.assertIn(f"water at {dem['min_height_m']:.3f} m", said)
        status, printed, said = terrane("--quiet", "verify", self.folder / "out")
        self.assertEqual(status, 0, printed + said)

    def test_refuses_a_geoid_without_a_place(self):
        status, _, said = terrane("--quiet", "build", self.dem, "-o", self.folder / "out",
                                  "--geoid", "egm96")
        self.assertEqual(status, USAGE, said)
        self.assertIn("--geoid egm96: flat.asc has no CRS", said)


if __name__ == "__main__":
    if not shutil.which("gdaltransform"):
        print("skipped: gdal-bin is missing")
        sys.exit(SKIPPED)
    unittest.main()
