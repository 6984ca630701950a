#!/usr/bin/env python3
"""build_tile_sets.py FOLDER: builds what the clients read, each tile set in a folder of its own.

`trinidad` is a part of a real DEM that Debian packages (libncarg-data), with its samples beside it;
the others are real DEMs that may be missing. Ends with 77 (skipped) without GDAL's programs or
libncarg-data.
"""

import json
import os
import pathlib
import random
import shutil
import subprocess
import sys

TERRANE = os.environ["TERRANE"]
DATA = pathlib.Path(os.environ["TERRANE_TEST_DATA"])
TRINIDAD = pathlib.Path("/usr/share/ncarg/data/cdf/trinidad.nc")
SKIPPED = 77

METRES_PER_FOOT = 0.3048
COLUMNS, ROWS = 449, 385
POINTS = 200

# name: DEM (of TERRANE_TEST_DATA, or "trinidad") and options of `terrane build`
TRINIDAD_8M = "--tolerance 8 --attribution Terrane_test"
ST_HELENS = "st_helens/SainteHelens_post1980_30m.dem"
CRATER_LAKE = "crater_lake/crater_garland_nad27_utm10.tif"
WATER = " --water {data}/crater_lake/crater_lake_shoreline.gpkg"
TILE_SETS = {
    "trinidad": ("trinidad", TRINIDAD_8M),
    "trinidad-split": ("trinidad", TRINIDAD_8M + " --tile-cells 16 --tileset-tiles 50"),
    "trinidad-implicit": ("trinidad", TRINIDAD_8M + " --implicit --skirts auto --colour hypsometric"),
    "trinidad-draco": ("trinidad", TRINIDAD_8M + " --compression draco --colour hypsometric"),
    "trinidad-float": ("trinidad", TRINIDAD_8M + " --positions float --compression none"
                       " --material unlit --colour slope --skirts 100"),
    "trinidad-texture": ("trinidad", TRINIDAD_8M + " --texture {folder}/shade.tif --skirts auto"),
    "st_helens": (ST_HELENS, "--tolerance 4"),
    "st_helens-draco": (ST_HELENS, "--tolerance 4 --compression draco --positions float"
                        " --skirts auto"),
    "st_helens-float": (ST_HELENS, "--tolerance 4 --positions float --colour slope --skirts 20"),
    "crater_lake": (CRATER_LAKE, "--tolerance 4 --skirts auto --material unlit"
                    " --colour hypsometric" + WATER),
    "crater_lake-draco": (CRATER_LAKE, "--tolerance 4 --compression draco --colour slope" + WATER),
    "crater_lake-none": (CRATER_LAKE, "--tolerance 4 --compression none" + WATER),
    # the image covers a part of the DEM
    "crater_lake-webp": (CRATER_LAKE, "--tolerance 4 --texture-format webp --material unlit"
                         " --texture {data}/crater_lake/craterlake-imagery-30m.tif" + WATER),
}


def make_trinidad(folder):
    """Cuts a part of the DEM out, and writes down where some of its samples are and how high."""
    dem = folder / "trinidad.tif"
    if not dem.exists():
        subprocess.run(["gdal_translate", "-q", "-a_srs", "EPSG:4326", "-srcwin", "300", "400",
                        str(COLUMNS), str(ROWS), f"NETCDF:{TRINIDAD}:data", dem], check=True)
        # an image in another CRS than the DEM
        subprocess.run(["gdaldem", "hillshade", "-q", "-z", "0.3048", "-s", "111120", dem,
                        folder / "flat.tif"], check=True)
        subprocess.run(["gdalwarp", "-q", "-t_srs", "EPSG:32613", "-dstalpha", "-r", "bilinear",
                        folder / "flat.tif", folder / "shade.tif"], check=True)
    listed = subprocess.run(["gdal_translate", "-q", "-of", "XYZ", dem, "/vsistdout/"], check=True,
                            capture_output=True, text=True).stdout.splitlines()
    # not the outermost samples: a ray along the rim may pass beside it
    inside = [row * COLUMNS + column for row in range(1, ROWS - 1)
              for column in range(1, COLUMNS - 1)]
    samples = [list(map(float, listed[n].split()))
               for n in sorted(random.Random(1).sample(inside, POINTS))]
    points = [[lon, lat, feet * METRES_PER_FOOT] for lon, lat, feet in samples]
    (folder / "trinidad_points.json").write_text(json.dumps(points))
    return [dem, "--vertical-unit", "foot"]


def main():
    folder = pathlib.Path(sys.argv[1])
    if not shutil.which("gdal_translate") or not TRINIDAD.exists():
        print("skipped: gdal-bin or libncarg-data is missing")
        return SKIPPED
    folder.mkdir(parents=True, exist_ok=True)
    trinidad = make_trinidad(folder)
    for name, (dem, options) in TILE_SETS.items():
        if dem != "trinidad" and not (DATA / dem).exists():
            print(f"without {name}: {DATA / dem} is not there")
            continue
        source = trinidad if dem == "trinidad" else [DATA / dem]
        subprocess.run([TERRANE, "--quiet", "build", *source, "-o", folder / name,
                        *options.format(folder=folder, data=DATA).split()], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
