#!/usr/bin/env python3
"""verify_terrain_sets.py FOLDER: `terrane verify` holds every set that build_terrain_sets.py made against
its DEM, the whole Earth with its poles and the meridian of 180 degrees among them. Ends with 77 (skipped)
where there are none."""

import os
import pathlib
import subprocess
import sys

SKIPPED = 77


def main():
    folder = pathlib.Path(sys.argv[1])
    # the Earth's 9 million samples once: cli.terrain_tiles_verify has poles as 3D Tiles
    sets = sorted(file.parent for file in folder.glob("*/terrane.json")
                  if file.parent.name != "earth-3dtiles")
    if not sets:
        print(f"skipped: {folder} was not built")
        return SKIPPED
    failures = 0
    for tiles in sets:
        done = subprocess.run([os.environ["TERRANE"], "--quiet", "verify", tiles], check=False,
                              capture_output=True, text=True)
        print(f"{'ok  ' if done.returncode == 0 else 'FAIL'} {tiles.name}")
        if done.returncode != 0:
            failures += 1
            print(done.stdout + done.stderr)
    return min(failures, 1)


if __name__ == "__main__":
    sys.exit(main())
