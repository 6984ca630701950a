#!/usr/bin/env python3
"""Builds squares of a DEM, from small to large, and plots CPU time per sample.

time_per_sample.py [--mirrored] [--beside] TERRANE DEM PICTURE.svg [SIDE ...]     sides in samples

The squares are from the DEM's middle; with --mirrored, its middle square of 1,000 samples is repeated,
every other time mirrored: then squares of all sizes have the same terrain. With --beside, the last is
built on a core of its own, and the others in turn on a second one all the while: what slows the machine
down for some time then slows them all. Prints a Markdown table.
Samples are those with data; time is that of the process and its threads, the mean of all builds.
"""

import array
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

SIDES = (1000, 1450, 2000, 2900, 4100, 5800, 8200, 10000)
PERIOD = 1000  # samples of what is mirrored
WIDTH, HEIGHT, LEFT, BOTTOM, RIGHT, TOP = 560, 320, 60, 44, 20, 20


def shape_of(dem):
    said = json.loads(subprocess.run(["gdalinfo", "-json", dem], check=True,
                                     capture_output=True, text=True).stdout)
    return said["size"]


def cut(dem, side, file):
    """Writes the middle square of a DEM, as large as it has one."""
    columns, rows = shape_of(dem)
    side_columns, side_rows = min(side, columns), min(side, rows)
    subprocess.run(["gdal_translate", "-q", "-of", "ENVI", "-ot", "Float32", "-srcwin",
                    str((columns - side_columns) // 2), str((rows - side_rows) // 2),
                    str(side_columns), str(side_rows), dem, file], check=True)


def mirror(dem, side, file):
    """Writes a square that repeats the DEM's middle one, every other time mirrored."""
    cut(dem, PERIOD, file)
    heights = array.array("f", file.read_bytes())
    rows = [heights[k * PERIOD:(k + 1) * PERIOD] for k in range(PERIOD)]
    times = math.ceil(side / (2 * PERIOD))
    with file.open("wb") as out:
        for row in ((rows + rows[::-1]) * times)[:side]:
            out.write((((row + row[::-1]) * times)[:side]).tobytes())
    header = file.with_suffix(".hdr")
    header.write_text(re.sub(r"(?m)^(samples|lines)( *= *)\d+", rf"\g<1>\g<2>{side}",
                             header.read_text()))


def start(terrane, square, core=None):
    """A build, on one core if it is given; its tiles go beside the square."""
    bind = None if core is None else lambda: os.sched_setaffinity(0, {core})
    return subprocess.Popen([terrane, "--quiet", "build", square, "--tolerance", "5", "--jobs", "1",
                             "-o", tiles_of(square)], stdout=subprocess.DEVNULL, preexec_fn=bind)


def tiles_of(square):
    return square.with_suffix("")


def has_ended(process):
    return os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None


def finish(process, square):
    """(samples with data, CPU seconds, peak memory in MB, levels); removes the tiles."""
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{square}: could not be built")
    summary = json.loads((tiles_of(square) / "terrane.json").read_text())
    shutil.rmtree(tiles_of(square))
    return (summary["dem"]["samples_with_data"], usage.ru_utime + usage.ru_stime,
            usage.ru_maxrss / 1024, len(summary["levels"]))


def build_one_by_one(terrane, squares):
    for square in squares:
        yield square, [finish(start(terrane, square), square)]


def build_beside(terrane, squares):
    """Builds all but the last again and again until that one is done."""
    *others, largest = squares
    first_core, second_core, *_ = sorted(os.sched_getaffinity(0))
    built = {square: [] for square in squares}
    long_one = start(terrane, largest, second_core)
    for square in itertools.cycle(others):
        process = start(terrane, square, first_core)
        while not has_ended(process) and not has_ended(long_one):
            time.sleep(0.05)
        if has_ended(long_one):
            process.kill()
            process.wait()
            break
        built[square].append(finish(process, square))
    built[largest].append(finish(long_one, largest))
    return built.items()


def svg(points):
    """Points (samples, microseconds per sample), samples to a logarithmic scale."""
    low = math.floor(math.log10(min(x for x, _ in points)))
    high = max(low + 1, math.ceil(math.log10(max(x for x, _ in points))))
    most = 1.25 * max(y for _, y in points)

    def place(x, y):
        along = (math.log10(x) - low) / (high - low)
        return (LEFT + along * (WIDTH - LEFT - RIGHT),
                HEIGHT - BOTTOM - y / most * (HEIGHT - BOTTOM - TOP))

    (x0, y0), (x1, y1) = place(10 ** low, 0), place(10 ** high, most)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
           'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>',
           f'<path d="M{x0} {y1}V{y0}H{x1}" fill="none" stroke="black"/>']
    for power in range(low, high + 1):
        x = place(10 ** power, 0)[0]
        label = f"{10 ** power / 1e6:g} M"
        out.append(f'<text x="{x:.1f}" y="{y0 + 16}" text-anchor="middle">{label}</text>')
    for k in range(6):
        y = most * k / 5
        out.append(f'<text x="{x0 - 6}" y="{place(10 ** low, y)[1] + 4:.1f}" '
                   f'text-anchor="end">{y:.1f}</text>')
    out.append(f'<text x="{(x0 + x1) / 2}" y="{HEIGHT - 8}" text-anchor="middle">'
               'samples with data</text>')
    out.append(f'<text x="14" y="{(y0 + y1) / 2}" transform="rotate(-90 14 {(y0 + y1) / 2})" '
               'text-anchor="middle">CPU microseconds per sample</text>')
    places = [place(x, y) for x, y in points]
    out.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in places)}" '
               'fill="none" stroke="#2166ac" stroke-width="2"/>')
    out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="#2166ac"/>' for x, y in places]
    return "\n".join(out) + "\n</svg>\n"


def main(*arguments):
    write_square = mirror if "--mirrored" in arguments else cut
    build_all = build_beside if "--beside" in arguments else build_one_by_one
    terrane, dem, picture, *sides = [a for a in arguments if not a.startswith("--")]
    print("| square | samples with data | levels | builds | CPU time | per sample | peak memory |\n"
          "|---|---|---|---|---|---|---|", flush=True)
    points = []
    with tempfile.TemporaryDirectory() as folder:
        squares = [pathlib.Path(folder) / f"{side}.bil" for side in map(int, sides or SIDES)]
        for side, square in zip(sides or SIDES, squares):
            write_square(dem, int(side), square)
        for square, builds in build_all(terrane, squares):
            if not builds:
                sys.exit(f"{square}: not built before the last one was done")
            samples, _, memory_mb, levels = builds[0]
            seconds = sum(build[1] for build in builds) / len(builds)
            points.append((samples, seconds / samples * 1e6))
            print(f"| {square.stem} | {samples:,} | {levels} | {len(builds)} | {seconds:.1f} s | "
                  f"{points[-1][1]:.2f} us | {memory_mb:.0f} MB |", flush=True)
            pathlib.Path(picture).write_text(svg(points))


if __name__ == "__main__":
    main(*sys.argv[1:])
