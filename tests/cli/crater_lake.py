"""Crater Lake as SRTM and its shoreline as USGS have it: what the tests about water know of it."""

import array
import json
import math
import subprocess

from plane_lines import is_inside
from program import DATA

CRATER_LAKE = DATA / "crater_lake/N42W123.hgt"
SHORELINE = DATA / "crater_lake/crater_lake_shoreline.gpkg"
METRES_PER_DEGREE = 111_091.57  # of latitude at 42.94 degrees: M pi / 180 on WGS84


def is_there():
    return CRATER_LAKE.exists() and SHORELINE.exists()


def cut_dem(folder):
    """The DEM of the lake and its surroundings, 180 x 130 samples."""
    dem = folder / "lake.tif"
    subprocess.run(["gdal_translate", "-q", "-srcwin", "985", "5", "180", "130", CRATER_LAKE, dem],
                   check=True)
    return dem


def read_polygon(folder):
    """Rings in degrees: the shore, then islands."""
    file = folder / "shore.json"
    subprocess.run(["ogr2ogr", "-f", "GeoJSON", file, SHORELINE, "-lco", "COORDINATE_PRECISION=9"],
                   check=True)
    geometry = json.loads(file.read_text())["features"][0]["geometry"]
    rings = geometry["coordinates"]
    return rings[0] if geometry["type"] == "MultiPolygon" else rings


class PlaneMap:
    """Degrees to a flat map in metres, exact to a thousandth over the lake."""

    def __init__(self, origin):
        self.west, self.north = origin[:2]
        self.east_m = METRES_PER_DEGREE * 1.0036 * math.cos(math.radians(42.94))

    def __call__(self, p):
        return (p[0] - self.west) * self.east_m, (p[1] - self.north) * METRES_PER_DEGREE


class Voids:
    """Samples of N42W123.hgt without data."""

    SIDE, CELLS_PER_DEGREE, VOID = 1201, 1200, -32768

    def __init__(self):
        heights = array.array("h", CRATER_LAKE.read_bytes())
        heights.byteswap()
        self.voids = {divmod(i, self.SIDE) for i, h in enumerate(heights) if h == self.VOID}

    def beside(self, longitude, latitude, rings):
        """Is a sample of the cell void, and on land, so that water does not fill it?"""
        column, row = (longitude + 123) * self.CELLS_PER_DEGREE, (43 - latitude) * self.CELLS_PER_DEGREE
        corners = {(int(row) + j, int(column) + i) for i in (0, 1) for j in (0, 1)} & self.voids
        return any(not is_inside((c / self.CELLS_PER_DEGREE - 123, 43 - r / self.CELLS_PER_DEGREE),
                                 rings) for r, c in corners)
