#!/usr/bin/env python3
"""Plots what terrane_frames prints: milliseconds of a frame against merges and splits in it.

terrane_frames > frames.csv; plot_frame_cost.py frames.csv PICTURE.svg
"""

import csv
import pathlib
import sys

WIDTH, HEIGHT, LEFT, BOTTOM = 560, 320, 60, 40
COLOURS = ("#b35806", "#1b7837", "#2166ac", "#762a83")


def lines_of(text):
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    lines = {}
    for row in rows:
        lines.setdefault(int(row["full_triangles"]), []).append(
            (float(row["changes"]), float(row["median_ms"])))
    return lines


def svg(lines):
    most_x = max(x for line in lines.values() for x, _ in line)
    most_y = max(y for line in lines.values() for _, y in line) * 1.1

    def place(x, y):
        return (LEFT + x / most_x * (WIDTH - LEFT - 130), HEIGHT - BOTTOM - y / most_y * (HEIGHT - BOTTOM - 20))

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
           'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>']
    (x0, y0), (x1, y1) = place(0, 0), place(most_x, most_y)
    out.append(f'<path d="M{x0} {y1}V{y0}H{x1}" fill="none" stroke="black"/>')
    for k in range(6):
        x, y = most_x * k / 5, most_y * k / 5
        out.append(f'<text x="{place(x, 0)[0]:.1f}" y="{y0 + 16}" text-anchor="middle">{x:.0f}</text>')
        out.append(f'<text x="{x0 - 6}" y="{place(0, y)[1] + 4:.1f}" text-anchor="end">{y:.2f}</text>')
    out.append(f'<text x="{(x0 + x1) / 2}" y="{HEIGHT - 6}" text-anchor="middle">splits and merges in a frame</text>')
    out.append(f'<text x="14" y="{(y0 + y1) / 2}" transform="rotate(-90 14 {(y0 + y1) / 2})" '
               'text-anchor="middle">milliseconds</text>')
    labels = []  # heights of those that are there
    for colour, (triangles, line) in zip(COLOURS, sorted(lines.items(), reverse=True)):
        places = [place(x, y) for x, y in line]
        out.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in places)}" '
                   f'fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in places]
        x, y = places[-1]
        y = max([y] + [label + 14 for label in labels if label + 14 > y])
        labels.append(y)
        out.append(f'<text x="{x + 8:.1f}" y="{y + 4:.1f}" fill="{colour}">{triangles:,} triangles</text>')
    return "\n".join(out) + "\n</svg>\n"


if __name__ == "__main__":
    pathlib.Path(sys.argv[2]).write_text(svg(lines_of(pathlib.Path(sys.argv[1]).read_text())))
