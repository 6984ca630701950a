#!/usr/bin/env python3
"""build_terrain_sets.py FOLDER: builds the terrain of the geodetic quadtree that the clients read.

`trinidad` is a part of a real DEM that Debian packages, taken as over sea level; its samples stand
beside it, raised to the ellipsoid by PROJ. Others are real DEMs that may be missing. Ends with 77
(skipped) without GDAL's programs or libncarg-data.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

from build_tile_sets import DATA, SKIPPED, TRINIDAD, make_trinidad

TERRANE = os.environ["TERRANE"]
ETOPO5 = pathlib.Path(os.environ.get("TERRANE_ETOPO5", "/usr/share/ferret-vis/data/etopo5.cdf"))

# name: DEM and options of `terrane build`
TERRAIN_SETS = {
    "trinidad": ("trinidad", "--geoid egm96 --tolerance 8"),
    "trinidad-3dtiles": ("trinidad", "--geoid egm96 --tolerance 8 --format 3dtiles-terrain"),
    "crater_lake": ("crater_lake/crater_garland_nad27_utm10.tif",
                    f"--geoid egm96 --tolerance 4 --water "
                    f"{DATA / 'crater_lake/crater_lake_shoreline.gpkg'}"),
    "crater_lake-3dtiles": ("crater_lake/crater_garland_nad27_utm10.tif", "--geoid egm96 --tolerance 16"
                            " --max-zoom 12 --format 3dtiles-terrain"),
}


def raise_to_the_ellipsoid(file):
    """Adds EGM96 to the heights of a list of points, by GDAL and PROJ."""
    points = json.loads(file.read_text())
    raised = subprocess.run(
        ["gdaltransform", "-s_srs", "EPSG:4326+5773", "-t_srs", "EPSG:4979"],
        input="\n".join(" ".join(map(repr, point)) for point in points), check=True,
        capture_output=True, text=True).stdout.splitlines()
    file.write_text(json.dumps([list(map(float, line.split())) for line in raised]))


def build_earth(folder):
    """The whole Earth with its sea floor, if Debian's ferret-datasets is there."""
    if not ETOPO5.exists():
        print(f"without earth: {ETOPO5} is not there (ferret-datasets)")
        return
    dem = folder / "earth.tif"
    if not dem.exists():
        subprocess.run(["gdal_translate", "-q", "-a_srs", "EPSG:4326", f"NETCDF:{ETOPO5}:ROSE", dem],
                       check=True)
    for name, options in (("earth", "--tolerance 400 --max-zoom 3"),
                          ("earth-3dtiles", "--tolerance 800 --max-zoom 2 --format 3dtiles-terrain")):
        subprocess.run([TERRANE, "--quiet", "build", dem, "-o", folder / name, "--scheme", "geodetic",
                        "--geoid", "egm96", *options.split()], check=True)


def main():
    folder = pathlib.Path(sys.argv[1])
    if not shutil.which("gdal_translate") or not TRINIDAD.exists():
        print("skipped: gdal-bin or libncarg-data is missing")
        return SKIPPED
    folder.mkdir(parents=True, exist_ok=True)
    trinidad = make_trinidad(folder)
    raise_to_the_ellipsoid(folder / "trinidad_points.json")
    shutil.copyfile(folder / "trinidad_points.json", folder / "trinidad-3dtiles_points.json")
    build_earth(folder)
    for name, (dem, options) in TERRAIN_SETS.items():
        if dem != "trinidad" and not (DATA / dem).exists():
            print(f"without {name}: {DATA / dem} is not there")
            continue
        source = trinidad if dem == "trinidad" else [DATA / dem]
        subprocess.run([TERRANE, "--quiet", "build", *source, "-o", folder / name,
                        "--scheme", "geodetic", *options.split()], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
