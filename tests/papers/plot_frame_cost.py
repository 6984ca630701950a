#!/usr/bin/env python3
"""Plots what terrane_frames prints: milliseconds of a frame against merges and splits in it, for models
of several sizes and fronts of the same length; and what one of either costs in a model of which size.

terrane_frames > frames.csv; plot_frame_cost.py frames.csv PICTURE.svg
"""

import csv
import math
import pathlib
import sys

WIDTH, HEIGHT, TOP, BOTTOM = 900, 340, 40, 44
COLOURS = ("#b35806", "#1b7837", "#2166ac", "#762a83")


def walks_of(text):
    """{(front to the nearest 100, triangles): rows}."""
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    walks = {}
    for row in rows:
        front = round(float(row["looked_at"]), -2) if row["step_deg"] == "0.00" else front
        walks.setdefault((front, int(row["full_triangles"])), []).append(
            {name: float(value) for name, value in row.items()})
    return walks


def per_change_us(walk):
    """Slope of the line through all steps, by least squares."""
    x, y = [row["changes"] for row in walk], [row["median_ms"] for row in walk]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return 1e3 * (sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y))
                  / sum((a - mean_x) ** 2 for a in x))


def per_node_ns(walk):
    return 1e6 * walk[0]["median_ms"] / walk[0]["looked_at"]


class Panel:
    """Axes between two abscissas of the picture."""

    def __init__(self, left, right, most_x, most_y, place_x=lambda x: x):
        self.left, self.right, self.most_x, self.most_y = left, right, most_x, most_y
        self.place_x = place_x
        self.out = []

    def place(self, x, y):
        share = self.place_x(x) / self.place_x(self.most_x) if self.most_x else 0
        return (self.left + share * (self.right - self.left),
                HEIGHT - BOTTOM - y / self.most_y * (HEIGHT - BOTTOM - TOP))

    def text(self, x, y, text, anchor="middle", colour="black"):
        self.out.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{text}</text>')

    def axes(self, title, below, ticks, steps, form):
        bottom, top = HEIGHT - BOTTOM, TOP
        self.out.append(f'<path d="M{self.left} {top}V{bottom}H{self.right}" fill="none" stroke="black"/>')
        self.text((self.left + self.right) / 2, HEIGHT - 8, below)
        self.text(self.left, TOP - 22, title, "start")
        for x in ticks:
            self.text(self.place(x, 0)[0], bottom + 16, f"{x:,.0f}")
        for k in range(steps + 1):
            y = self.most_y * k / steps
            self.text(self.left - 6, self.place(0, y)[1] + 4, form.format(y), "end")

    def line(self, points, colour, dash=""):
        places = [self.place(x, y) for x, y in points]
        self.out.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in places)}" fill="none" '
                        f'stroke="{colour}" stroke-width="2"{dash}/>')
        self.out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in places]
        return places[-1]


def svg(walks):
    sizes = sorted({triangles for _, triangles in walks})
    fronts = sorted({front for front, _ in walks})
    most = max(row["changes"] for walk in walks.values() for row in walk)
    high = max(row["median_ms"] for walk in walks.values() for row in walk)
    frames = Panel(56, 400, most, math.ceil(high * 20) / 20)
    frames.axes("a frame, ms", "splits and merges in it", [0, 50, 100, 150, 200], 5, "{:.2f}")
    for (front, triangles), walk in walks.items():
        colour = COLOURS[sizes.index(triangles)]
        frames.line([(row["changes"], row["median_ms"]) for row in walk], colour)
    for front in fronts:
        walk = walks[front, sizes[-1]]
        x, y = frames.place(walk[2]["changes"], walk[0]["median_ms"])
        frames.text(x + 4, y + (18 if front == fronts[-1] else 14), f"front of {front:,.0f}", "start")
    for k, triangles in enumerate(reversed(sizes)):
        colour = COLOURS[sizes.index(triangles)]
        frames.text(392, HEIGHT - BOTTOM - 96 + 16 * k, f"{triangles:,} triangles", "end", colour)

    decades = lambda x: math.log10(max(x, 5000) / 5000)  # noqa: E731
    costs = Panel(500, 790, 5e6, 800, decades)
    costs.axes("cost of one, ns", "triangles of the model", [1e4, 1e5, 1e6], 4, "{:.0f}")
    for front, dash in zip(fronts, ("", ' stroke-dasharray="5 3"')):
        of_front = {triangles: walk for (f, triangles), walk in walks.items() if f == front}
        for what, colour, cost in (("change", "#b35806", lambda w: 1e3 * per_change_us(w)),
                                   ("merge of the front", "#2166ac", per_node_ns)):
            x, y = costs.line([(n, cost(walk)) for n, walk in sorted(of_front.items())], colour, dash)
            if front == fronts[0]:
                costs.text(x + 8, y + 4, what, "start", colour)
    return "\n".join(
        [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
         'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>']
        + frames.out + costs.out) + "\n</svg>\n"


def table(walks):
    for (front, triangles), walk in walks.items():
        print(f"{triangles} triangles, front {front:.0f}, shown {walk[0]['shown']:.0f}: "
              f"{per_node_ns(walk):.1f} ns a merge of the front, {per_change_us(walk):.2f} us a change")


if __name__ == "__main__":
    read = walks_of(pathlib.Path(sys.argv[1]).read_text())
    table(read)
    pathlib.Path(sys.argv[2]).write_text(svg(read))
