#!/usr/bin/env python3
"""What `terrane levels --swap-cycles` changes at the levels: the table of docs/papers.md.

cycle_swaps.py TERRANE [SHARE]   puts a vertex into the middle of that share of the saddle's and the
torus' triangles (0.3), which makes a cycle of each, and prints levels with and without swapping.
"""

import json
import pathlib
import random
import subprocess
import sys
import tempfile

import paper_meshes


def with_cycles(text, share):
    """An OFF mesh with a vertex in the middle of a share of its triangles, at random."""
    lines = text.splitlines()
    vertices, faces, _ = map(int, lines[1].split())
    points = [tuple(map(float, line.split())) for line in lines[2:2 + vertices]]
    chosen, result = random.Random(1), []
    for line in lines[2 + vertices:2 + vertices + faces]:
        a, b, c = map(int, line.split()[1:])
        if chosen.random() >= share:
            result.append((a, b, c))
            continue
        points.append(tuple(sum(points[v][k] for v in (a, b, c)) / 3 for k in range(3)))
        d = len(points) - 1
        result += [(a, b, d), (b, c, d), (c, a, d)]
    return paper_meshes.off(points, result)


def levels(terrane, folder, weights, *options):
    report = folder / "report.json"
    done = subprocess.run([terrane, "levels", folder / "mesh.off", "-o", folder / "a.levels",
                           "--weights", weights, "--report", report, *options],
                          capture_output=True, text=True, check=True)
    swaps = [line.split("mesh.off: ")[1] for line in done.stderr.splitlines() if "cycles" in line]
    return json.loads(report.read_text())["levels"], swaps


def main():
    terrane, share = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 0.3
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for mesh in ("saddle", "torus"):
            text = getattr(paper_meshes, mesh)()
            (folder / "mesh.off").write_text(with_cycles(text, share))
            for options in ((), ("--swap-cycles",)):
                found, swaps = levels(terrane, folder, mesh, *options)
                print(mesh, found[0]["triangles"], *options, *swaps)
                for level in found[9:30:10]:  # the paper counts M_0 as level 1
                    print(f"  level {level['level'] + 1}: {level['triangles']} triangles, rejected",
                          {k: v for k, v in level["rejected"].items() if v},
                          f"largest distance {level['max_error']:.4f} RMS {level['rms_error']:.4f}")


if __name__ == "__main__":
    main()
