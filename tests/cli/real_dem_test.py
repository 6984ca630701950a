#!/usr/bin/env python3
"""real_dem_test.py DEM TOLERANCE [LEVELS_PER_OCTAVE]: `terrane build`, `terrane verify` on a real DEM."""

import json
import pathlib
import sys
import tempfile

from program import DATA, SKIPPED, terrane

TRINIDAD = pathlib.Path("/usr/share/ncarg/data/cdf/trinidad.nc")

# name: (file that must be there, arguments of terrane build)
DEMS = {
    "st_helens": ("st_helens/SainteHelens_post1980_30m.dem", []),
    "crater_lake_west": ("crater_lake/crater_garland_nad27_utm10.tif", []),
    "crater_lake_voids": ("crater_lake/N42W123.hgt", []),
    "new_zealand": ("awkward/nz_elev_nan_nodata.tif", []),
    "cape_town": ("awkward/cape_town_srtm_sea_nodata.tif", []),
    "rotated": ("awkward/rotated30_garland_ARTIFICIAL.vrt", []),
    "vancouver_mosaic": ("awkward/vancouver_N49W124_N49W123.vrt", []),
    "vancouver_files": ("awkward/N49W124.tif", ["awkward/N49W123.tif"]),
    "two_bands_1": ("st_helens/before_after_2band.vrt", ["--band", "1"]),
    "two_bands_2": ("st_helens/before_after_2band.vrt", ["--band", "2"]),
}


def build_arguments(name):
    if name == "trinidad_feet":
        present = TRINIDAD.exists()
        return present, [f"NETCDF:{TRINIDAD}:data", "--crs", "EPSG:4326", "--vertical-unit", "foot"]
    file, more = DEMS[name]
    more = [DATA / word if word.startswith("awkward/") else word for word in more]
    return (DATA / file).exists(), [DATA / file, *more]


def main(name, tolerance_m, levels_per_octave="1"):
    present, arguments = build_arguments(name)
    if not present:
        print(f"skipped: {arguments[0]} is not there")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        status, printed, said = terrane("--quiet", "build", *arguments, "-o", out,
                                        "--tolerance", tolerance_m,
                                        "--levels-per-octave", levels_per_octave)
        print(printed, said)
        if status != 0:
            return 1
        status, printed, said = terrane("--quiet", "verify", out, "--json", out / "report.json")
        print(printed, said)
        report = json.loads((out / "report.json").read_text())
        samples = report["levels"][0]["samples"]
        print(f"{samples} samples checked at level 0")
        return 0 if status == 0 and report["holds"] and samples > 10000 else 1


sys.exit(main(*sys.argv[1:]))
