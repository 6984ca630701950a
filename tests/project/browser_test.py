#!/usr/bin/env python3
"""Builds tiles, serves them with `terrane serve` and looks at them with a headless Chromium.

What is asserted of the page is in viewer/web/test/browser: view.mjs, flight.mjs, looks.mjs and
archive.mjs. Ends with 77 (skipped) where Chromium, Node, the viewer or the DEM is missing.
"""

import argparse
import contextlib
import pathlib
import re
import shutil
import subprocess
import sys

import aerial_image

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BROWSER = ROOT / "viewer/web/test/browser"
IMAGES = ROOT / "docs/images/viewer"
SKIPPED = 77


# view.mjs wants several tiles at the farthest camera, and no more than 50,000 triangles at any: a
# software renderer is slow beyond
TERRAINS = {
    "caldera": ("synthetic:caldera?size=513&seed=1", "1"),
    "st_helens": ("st_helens/SainteHelens_post1980_30m.dem", "2"),
    "crater_lake": ("crater_lake/N42W123.hgt", "2"),
}
SHORELINE = "crater_lake/crater_lake_shoreline.gpkg"


def dem_and_tolerance_of(terrain, data):
    dem, tolerance_m = TERRAINS[terrain]
    return dem if dem.startswith("synthetic:") else str(data / dem), tolerance_m


def cut_lake(dem, work):
    """The lake and its mountain, without the voids on its cliffs."""
    window, filled = work / "window.tif", work / "lake.tif"
    subprocess.run(["gdal_translate", "-q", "-srcwin", "900", "0", "301", "250", dem, window],
                   check=True)
    subprocess.run(["gdal_fillnodata.py", "-q", window, filled], check=True)
    return str(filled)


def reason_to_skip(terrain, dem, viewer_built):
    if not viewer_built:
        return "the web viewer is not part of this build"
    for tool in ("node", "chromium", *(["gdal_fillnodata.py"] if terrain == "crater_lake" else [])):
        if not shutil.which(tool):
            return f"{tool} is missing"
    if not dem.startswith("synthetic:") and not pathlib.Path(dem).exists():
        return f"{dem} is not there"
    return None


@contextlib.contextmanager
def served(terrane, folder):
    """Runs `terrane serve` on a free port; gives its URL."""
    server = subprocess.Popen([terrane, "serve", str(folder), "--port", "0"],
                              stdout=subprocess.PIPE, text=True)
    try:
        printed = []
        for line in server.stdout:
            printed.append(line)
            if url := re.search(r"http://\S+", line):
                yield url[0]
                return
        raise SystemExit(f"terrane serve printed no URL, but: {''.join(printed)}")
    finally:
        server.terminate()
        server.wait()


def run_check(url, script, *arguments):
    return subprocess.run(["node", BROWSER / script, "--url", url, *arguments]).returncode


def check_imagery(options, dem, tolerance_m):
    image = options.work / "air.ppm"
    aerial_image.write_image(image)
    tiles = options.work / "tiles_with_images"
    subprocess.run([options.terrane, "build", dem, "-o", tiles, "--tolerance", tolerance_m,
                    "--texture", image], check=True)
    with served(options.terrane, tiles) as url:
        return run_check(url, "looks.mjs", "--images", IMAGES, "--imagery")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("terrain", choices=sorted(TERRAINS))
    parser.add_argument("--terrane", required=True)
    parser.add_argument("--data", required=True, type=pathlib.Path)
    parser.add_argument("--viewer-built", default="")
    parser.add_argument("--work", required=True, type=pathlib.Path)
    options = parser.parse_args()

    dem, tolerance_m = dem_and_tolerance_of(options.terrain, options.data)
    if reason := reason_to_skip(options.terrain, dem, options.viewer_built):
        print(f"skipped: {reason}")
        return SKIPPED

    options.work.mkdir(parents=True, exist_ok=True)
    tiles = options.work / "tiles"
    water = []
    if options.terrain == "crater_lake":
        dem, water = cut_lake(dem, options.work), ["--water", options.data / SHORELINE]
    subprocess.run([options.terrane, "build", dem, "-o", tiles, "--tolerance", tolerance_m, *water],
                   check=True)
    with served(options.terrane, tiles) as url:
        checks = [["view.mjs", "--screenshot", options.work / "screenshot.png", "--steps", "12"],
                  ["flight.mjs", "--cameras", "6", "--flight", "20", "--steps", "5"]]
        if water:
            checks = [["looks.mjs", "--images", IMAGES, "--water"],
                      ["flight.mjs", "--cameras", "8", "--flight", "8", "--steps", "2",
                       "--pieces", "2"]]
        if options.terrain == "caldera":
            archive = options.work / "caldera.pmtiles"
            subprocess.run([options.terrane, "pack", tiles, "-o", archive], check=True)
            checks += [["looks.mjs", "--images", IMAGES],
                       ["archive.mjs", "--archive", archive, "--dist", options.viewer_built]]
        codes = [run_check(url, *check) for check in checks]
    if options.terrain == "caldera":
        codes.append(check_imagery(options, dem, tolerance_m))
    return max(codes)


if __name__ == "__main__":
    sys.exit(main())
