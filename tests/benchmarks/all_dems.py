#!/usr/bin/env python3
"""Builds and verifies every DEM of a folder at several tolerances and levels per octave.

all_dems.py TERRANE DATA [NAME ...]     NAME: parts of the names of those to build; without, all

Prints a Markdown table; ends with 1 if anything does not hold. By hand: it takes an hour.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

DEMS = (
    ("st_helens/SainteHelens_post1980_30m.dem",),
    ("st_helens/mtsthelens_before1980_30m.dem",),
    ("st_helens/mtsthelens_after1980_10m_feet.dem",),
    ("st_helens/mount_st_helens_23.7m_utm10.tif",),
    ("crater_lake/crater_garland_nad27_utm10.tif",),
    ("crater_lake/crater_0513_nad27.vrt",),
    ("crater_lake/N42W123.hgt",),
    ("crater_lake/N42W123.hgt", "--water", "crater_lake/crater_lake_shoreline.gpkg"),
    ("crater_lake/craterlake-bathymetry_nodata.vrt",),
    ("awkward/N46E008.tif",),
    ("awkward/vancouver_N49W124_N49W123.vrt",),
    ("awkward/cape_town_srtm_sea_nodata.tif",),
    ("awkward/nz_elev_nan_nodata.tif",),
    ("awkward/rmnp-dem.tif",),
    ("awkward/zion_srtm_uint16.tif",),
    ("awkward/zion_srtm_uint16.tif", "--lines", "awkward/zion_park_boundary.gpkg"),
    ("awkward/rotated30_garland_ARTIFICIAL.vrt",),
    ("large/os50_squareN_f32.vrt",),
)


def timed(arguments):
    """(exit status, standard output, CPU seconds)."""
    process = subprocess.Popen([str(a) for a in arguments], stdout=subprocess.PIPE, text=True)
    said = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    return os.waitstatus_to_exitcode(status), said, usage.ru_utime + usage.ru_stime


def row(terrane, data, words, tolerance, levels_per_octave):
    arguments = [data / w if "/" in w else w for w in words]
    name = pathlib.Path(words[0]).name + (f" {words[1]}" if len(words) > 1 else "")
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        status, _, build_s = timed([terrane, "--quiet", "build", *arguments, "--tolerance", tolerance,
                                    "--levels-per-octave", levels_per_octave, "-o", out])
        if status != 0:
            return False, f"| {name} | {tolerance} m | {levels_per_octave} | not built: {status} |"
        report_file = pathlib.Path(folder) / "report.json"
        status, _, verify_s = timed([terrane, "--quiet", "verify", out, "--json", report_file])
        report = json.loads(report_file.read_text())
        level = report["levels"][0]
        holds = status == 0 and report["holds"]
        return holds, (f"| {name} | {tolerance} m | {levels_per_octave} | {len(report['levels'])} | "
                       f"{level['samples']:,} | {level['triangles']:,} | {level['max_error_m']:.4f} m | "
                       f"{build_s:.1f} s | {verify_s:.1f} s | {'all hold' if holds else 'NO'} |")


def main(terrane, data, *names):
    print("| DEM | tolerance | levels per octave | levels | samples | level 0 triangles | its error | "
          "build | verify | |\n|---|---|---|---|---|---|---|---|---|---|", flush=True)
    all_hold = True
    for words in DEMS:
        if names and not any(name in " ".join(words) for name in names):
            continue
        for tolerance in 1, 5, 20:
            for levels_per_octave in 1, 3:
                holds, text = row(terrane, pathlib.Path(data), words, tolerance, levels_per_octave)
                all_hold &= holds
                print(text, flush=True)
    return 0 if all_hold else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
