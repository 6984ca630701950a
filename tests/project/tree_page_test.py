#!/usr/bin/env python3
"""Builds a merge tree, serves it with `terrane serve` and looks at its page with a headless Chromium.

What the page shows has to be what `terrane view-cut` writes for the same cameras, triangle by triangle.
What else is asserted is in viewer/web/test/browser/tree.mjs. Ends with 77 (skipped) where Chromium, Node,
the viewer or its WebAssembly is missing.
"""

import argparse
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys

from browser_test import served

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TREE = ROOT / "viewer/web/test/browser/tree.mjs"
SKIPPED = 77
PICTURE = "640,480"  # that of browser.mjs


def knobbly_torus(columns=120, rows=60):
    """A PLY: closed, 2 * columns * rows triangles, about (10, -20, 5), in two colours."""
    lines = ["ply", "format ascii 1.0", f"element vertex {columns * rows}",
             *(f"property double {axis}" for axis in "xyz"),
             *(f"property uchar {name}" for name in ("red", "green", "blue")),
             f"element face {2 * columns * rows}", "property list uchar int vertex_indices",
             "end_header"]
    for i in range(columns):
        for j in range(rows):
            u, v = 2 * math.pi * i / columns, 2 * math.pi * j / rows
            r = 0.4 + 0.03 * math.sin(7 * u) * math.sin(5 * v) + 0.01 * math.sin(31 * u + 17 * v)
            x, y = (1 + r * math.cos(v)) * math.cos(u), (1 + r * math.cos(v)) * math.sin(u)
            colour = "180 60 40" if i % 40 < 20 else "60 90 170"
            lines.append(f"{10 + x:.9f} {-20 + y:.9f} {5 + r * math.sin(v):.9f} {colour}")
    for i in range(columns):
        for j in range(rows):
            a, b = i * rows + j, (i + 1) % columns * rows + j
            c, d = (i + 1) % columns * rows + (j + 1) % rows, i * rows + (j + 1) % rows
            lines += [f"3 {a} {b} {c}", f"3 {a} {c} {d}"]
    return "\n".join(lines) + "\n"


def cameras():
    """(eye, target, settings of the page, options of view-cut): a walk, then each criterion."""
    middle = (10, -20, 5)

    def about(degrees, away, up):
        u = math.radians(degrees)
        return [middle[0] + away * math.cos(u), middle[1] + away * math.sin(u), middle[2] + up]

    walk = [(about(degrees, 3, 1), middle, {"tolerancePx": 2}, ["--pixels", "2"])
            for degrees in (0, 1, 2, 30, 200)]
    near = about(-60, 1.9, 0.8)
    side = [10.4, -20.9, 5]
    return walk + [
        (near, side, {"frustum": True}, ["--frustum"]),
        (near, side, {"backFaces": True}, ["--back-faces"]),
        (near, side, {"tolerancePx": 4, "silhouettes": True}, ["--pixels", "4", "--silhouette", "2"]),
        (near, side, {"tolerancePx": 4, "highlight": True, "lightAzimuthDeg": 0, "lightHeightDeg": 90},
         ["--pixels", "4", "--highlight", "64", "--light=0,0,1"]),
        (near, side, {"tolerancePx": 4, "colours": True}, ["--pixels", "4", "--colour", "64"]),
        (near, side, {"tolerancePx": 40, "measure": "length"}, ["--pixels", "40", "--switch-distance"]),
        (near, side, {"tolerancePx": 0.5, "frustum": True, "backFaces": True},
         ["--pixels", "0.5", "--frustum", "--back-faces"]),
    ]


def read_triangles(file):
    """Nine numbers for each triangle of a PLY that view-cut wrote."""
    data = file.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    counts = [int(line.split()[-1]) for line in header.decode().splitlines()
              if line.startswith("element")]
    size = 24 + 3 * (b"property uchar red" in header)
    points = [struct.unpack_from("<3d", body, size * v) for v in range(counts[0])]
    faces = body[size * counts[0]:]
    return [[x for v in struct.unpack_from("<3i", faces, 13 * t + 1) for x in points[v]]
            for t in range(counts[1])]


def cuts_of(terrane, tree, work):
    cuts = []
    for eye, target, settings, criteria in cameras():
        out = work / "cut.ply"
        subprocess.run([terrane, "--quiet", "view-cut", tree, "-o", out, "--size", PICTURE,
                        "--camera=" + ",".join(map(repr, eye)),
                        "--target=" + ",".join(map(repr, target)), *criteria],
                       check=True, stdout=subprocess.DEVNULL)
        cuts.append({"eye": eye, "target": target, "settings": settings,
                     "triangles": read_triangles(out)})
    return cuts


def reason_to_skip(viewer_built, engine_built):
    if not viewer_built:
        return "the web viewer is not part of this build"
    if not engine_built:
        return "the viewer was built without WebAssembly (emscripten)"
    missing = [tool for tool in ("node", "chromium") if not shutil.which(tool)]
    return f"{missing[0]} is missing" if missing else None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--terrane", required=True)
    parser.add_argument("--viewer-built", default="")
    parser.add_argument("--engine-built", default="")
    parser.add_argument("--work", required=True, type=pathlib.Path)
    options = parser.parse_args()
    if reason := reason_to_skip(options.viewer_built, options.engine_built):
        print(f"skipped: {reason}")
        return SKIPPED

    options.work.mkdir(parents=True, exist_ok=True)
    mesh, tree = options.work / "torus.ply", options.work / "torus.tree"
    mesh.write_text(knobbly_torus())
    subprocess.run([options.terrane, "--quiet", "merge-tree", mesh, "-o", tree], check=True)
    cuts = options.work / "cuts.json"
    cuts.write_text(json.dumps(cuts_of(options.terrane, tree, options.work)))
    with served(options.terrane, tree) as url:
        return subprocess.run(["node", TREE, "--url", url, "--cuts", cuts,
                               "--screenshot", options.work / "frozen.png"]).returncode


if __name__ == "__main__":
    sys.exit(main())
