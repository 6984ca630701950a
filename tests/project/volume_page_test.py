#!/usr/bin/env python3
"""Writes a volume with `terrane volume` and looks at its page with a headless Chromium.

A lake with an island over flat ground: the material at every place is known on paper. What is
asserted of the page is in viewer/web/test/browser/volume.mjs. Ends with 77 (skipped) where Chromium,
Node or the viewer is missing.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
VOLUME = ROOT / "viewer/web/test/browser/volume.mjs"
SKIPPED = 77
ROCK, WATER, AIR = 0, 1, 2

MODEL = """
[box]
west_m = 100
east_m = 500
south_m = -500
north_m = -100
bottom_m = 0
top_m = 200
[[surface]]
name = "ground"
dem = "synthetic:flat?size=65&spacing=10"   # 100 m high
tolerance_m = 5
[[surface]]
name = "lake"
level_m = 150
inside = "{folder}/lake.csv"
tolerance_m = 5
[[material]]
name = "rock"
where = "below ground"
[[material]]
name = "water"
where = "below lake"
[[material]]
name = "air"
empty = true
[[field]]
name = "density"
unit = "kg/m3"
tolerance = 5
[field.of]
rock = 2600
water = "1000 + 0.05 * (150 - z)"
"""
# 200 m x 100 m of water, 50 m deep, with an island of 40 m x 50 m
LAKE = ("id,WKT\n1,\"POLYGON((200 -300,400 -300,400 -200,200 -200,200 -300),"
        "(250 -275,290 -275,290 -225,250 -225,250 -275))\"\n")


def upright(direction_deg, offset_m):
    return {"kind": "upright", "directionDeg": direction_deg, "offsetM": offset_m}


def known():
    """Sections, and places in them with their materials; x = 300, y = -300, z = 100 in the middle."""
    def places(at, materials):
        return [{"at": place, "material": material} for place, material in zip(at, materials)]
    return {
        "empty": [AIR],
        "sections": [
            # facing north through the island: water, island of air, water
            {"section": upright(0, 50),
             "places": places([[225, -250, 125], [270, -250, 125], [350, -250, 125],
                               [350, -250, 50], [450, -250, 125], [350, -250, 180]],
                              [WATER, AIR, WATER, ROCK, AIR, AIR])},
            # beside the lake
            {"section": upright(0, -60),
             "places": places([[225, -360, 125], [350, -360, 50]], [AIR, ROCK])},
            # north of the island
            {"section": upright(0, 90),
             "places": places([[270, -210, 125], [270, -210, 165]], [WATER, AIR])},
            # level, under the water's surface and under the ground
            {"section": {"kind": "level", "directionDeg": 0, "offsetM": 25},
             "places": places([[225, -250, 125], [270, -250, 125], [450, -250, 125]],
                              [WATER, AIR, AIR])},
            {"section": {"kind": "level", "directionDeg": 0, "offsetM": -50},
             "places": places([[225, -250, 50], [450, -400, 50]], [ROCK, ROCK])},
        ],
        "screenshot_section": upright(20, 40),
    }


def reason_to_skip(viewer_built):
    if not viewer_built:
        return "the web viewer is not part of this build"
    missing = [tool for tool in ("node", "chromium") if not shutil.which(tool)]
    return f"{missing[0]} is missing" if missing else None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--terrane", required=True)
    parser.add_argument("--viewer-built", default="")
    parser.add_argument("--work", required=True, type=pathlib.Path)
    options = parser.parse_args()
    if reason := reason_to_skip(options.viewer_built):
        print(f"skipped: {reason}")
        return SKIPPED

    options.work.mkdir(parents=True, exist_ok=True)
    (options.work / "lake.csv").write_text(LAKE)
    (options.work / "model.toml").write_text(MODEL.replace("{folder}", str(options.work)))
    (options.work / "known.json").write_text(json.dumps(known()))
    out = options.work / "out"
    subprocess.run([options.terrane, "volume", options.work / "model.toml", "-o", out], check=True)
    return subprocess.run(["node", VOLUME, "--folder", out, "--known", options.work / "known.json",
                           "--screenshot", options.work / "screenshot.png"]).returncode


if __name__ == "__main__":
    sys.exit(main())
