#!/usr/bin/env python3
"""Crater Lake as air, water and rock against its bathymetry and its shoreline.

The water is compared with depth summed over the grid's cells, and every piece of water with the
polygon, both by code of this test alone. Needs Debian's python3-meshio.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from program import DATA, SKIPPED, terrane

try:
    import meshio
    import numpy as np
except ImportError as missing:
    print(f"{missing}: install python3-meshio")
    sys.exit(SKIPPED)

LAKE = DATA / "crater_lake"
BED = LAKE / "craterlake-bathymetry_nodata.vrt"
SHORE = LAKE / "crater_lake_shoreline.gpkg"
ROOT = pathlib.Path(__file__).resolve().parents[2]
LEVEL_M, TOLERANCE_M = 1882, 20
A, E2 = 6378137.0, 0.00669437999014  # WGS84


def radii(latitude):
    """Radii of curvature along the meridian and across it, in metres."""
    w = 1 - E2 * np.sin(latitude) ** 2
    return A * (1 - E2) / w ** 1.5, A / np.sqrt(w)


def output_of(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True,
                          check=True).stdout


def summed_depth():
    """Cubic metres between the level and the bed, cell by cell on the ellipsoid."""
    xyz = np.array([line.split() for line in
                    output_of("gdal_translate", "-q", "-of", "XYZ", BED, "/vsistdout/").splitlines()],
                   dtype=float)
    step_x = np.diff(np.unique(xyz[:, 0])).min()
    step_y = np.diff(np.unique(xyz[:, 1])).min()
    held = xyz[xyz[:, 2] > -32767]
    latitude = np.radians(held[:, 1])
    along, across = radii(latitude)
    area = along * np.radians(step_y) * across * np.cos(latitude) * np.radians(step_x)
    return (np.maximum(LEVEL_M - held[:, 2], 0) * area).sum()


def shoreline(origin):
    """The polygon's sides, in metres east and north of a place."""
    text = output_of("ogr2ogr", "-f", "GeoJSON", "/vsistdout/", SHORE)
    geometry = json.loads(text)["features"][0]["geometry"]
    polygons = geometry["coordinates"]
    if geometry["type"] == "Polygon":
        polygons = [polygons]
    longitude, latitude = np.radians(origin)
    along, across = radii(latitude)
    sides = []
    for ring in (ring for polygon in polygons for ring in polygon):
        at = np.radians(np.array(ring)[:, :2]) - (longitude, latitude)
        # terms of second order are 2 m at 5 km, those left out some centimetres
        x = across * at[:, 0] * np.cos(latitude + at[:, 1])
        y = along * at[:, 1] + across * np.sin(latitude) * np.cos(latitude) * at[:, 0] ** 2 / 2
        points = np.stack([x, y], axis=1)
        sides.append(np.concatenate([points[:-1], points[1:]], axis=1))
    return np.concatenate(sides)


def distance_outside(points, sides):
    """How far each point lies outside the polygon, 0 for those inside."""
    distance = np.full(len(points), np.inf)
    crossings = np.zeros(len(points), dtype=int)
    for ax, ay, bx, by in sides:
        span = np.array([bx - ax, by - ay])
        t = np.clip(((points - (ax, ay)) @ span) / (span @ span), 0, 1)
        distance = np.minimum(distance,
                              np.hypot(*(points - (ax, ay) - t[:, None] * span).T))
        over = (ay > points[:, 1]) != (by > points[:, 1])
        if ay != by:
            crossings += over & (points[:, 0] < ax + (points[:, 1] - ay) / (by - ay) * (bx - ax))
    return np.where(crossings % 2 == 1, 0, distance)


class CraterLake(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not BED.exists():
            raise unittest.SkipTest(f"{BED} is not there")
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = pathlib.Path(folder.name)
        status, cls.printed, said = terrane("--quiet", "volume",
                                            ROOT / "config" / "volume" / "crater_lake.toml", "-o",
                                            cls.out, "--tolerance", TOLERANCE_M, cwd=LAKE)
        assert status == 0, said
        cls.told = json.loads((cls.out / "volume.json").read_text())
        mesh = meshio.read(cls.out / "materials.vtu")
        cls.corners = mesh.points[mesh.cells_dict["tetra"]]
        cls.material = mesh.cell_data["material"][0].ravel()

    def test_the_errors_are_within_the_tolerance(self):
        for surface in self.told["surfaces"]:
            self.assertLessEqual(surface["max_error_m"], TOLERANCE_M)

    def test_water_is_as_much_as_depth_summed_over_the_grid(self):
        water = self.told["materials"][1]["volume_m3"]
        self.assertAlmostEqual(water, summed_depth(), delta=0.01 * summed_depth())

    def test_no_water_lies_outside_the_shoreline_or_over_the_level(self):
        frame = self.told["frame"]
        water = self.corners[self.material == 1]
        volumes = np.abs(np.linalg.det(water[:, 1:] - water[:, :1])) / 6
        water = water[volumes > 1e-3].reshape(-1, 3)  # cuts leave pieces without extent
        self.assertLessEqual(water[:, 2].max(), LEVEL_M + TOLERANCE_M)
        sides = shoreline((frame["longitude_deg"], frame["latitude_deg"]))
        self.assertLessEqual(distance_outside(np.unique(water[:, :2], axis=0), sides).max(),
                             TOLERANCE_M)


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    sys.exit(SKIPPED if result.skipped and result.wasSuccessful() else not result.wasSuccessful())
