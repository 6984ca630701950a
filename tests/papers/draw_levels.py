#!/usr/bin/env python3
"""Draws a mesh as a picture, shaded with its edges: the figures of docs/papers.md.

draw_levels.py MESH.ply PICTURE.png [--size 420] [--turn DEG] [--tilt DEG] [--height FACTOR]

Reads the binary PLY that `terrane levels --extract` writes. Plain Python: no library to install.
"""

import argparse
import math
import pathlib
import struct
import zlib

PAPER, LIGHT, DARK, EDGE = (255, 255, 255), (236, 231, 219), (84, 88, 92), (38, 52, 74)
SUN = (-0.45, 0.35, 0.82)


def read_ply(file):
    header, body = file.read_bytes().split(b"end_header\n", 1)
    counts = {line.split()[1]: int(line.split()[2])
              for line in header.decode().splitlines() if line.startswith("element")}
    points = list(struct.iter_unpack("<3d", body[:24 * counts["vertex"]]))
    faces = [face[1:] for face in struct.iter_unpack("<B3i", body[24 * counts["vertex"]:])]
    return points, faces


def looked_at(points, turn, tilt, height):
    """Points turned about z, then tilted: x right, y up, z towards the eye."""
    ct, st, cp, sp = math.cos(turn), math.sin(turn), math.cos(tilt), math.sin(tilt)
    seen = []
    for x, y, z in points:
        x, y, z = ct * x - st * y, st * x + ct * y, height * z
        seen.append((x, cp * y + sp * z, cp * z - sp * y))
    return seen


def normal(a, b, c):
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(e * e for e in n)) or 1
    return [e / length for e in n]


class Picture:
    def __init__(self, points, size):
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        self.scale = 0.96 * size / max(max(xs) - min(xs), 1e-300)
        self.width = size
        self.height = int((max(ys) - min(ys)) * self.scale + 0.04 * size) + 1
        self.left, self.top = min(xs) - 0.02 * size / self.scale, max(ys) + 0.02 * size / self.scale
        self.pixels = bytearray(bytes(PAPER) * (self.width * self.height))
        self.depth = [-math.inf] * (self.width * self.height)

    def place(self, p):
        return (p[0] - self.left) * self.scale, (self.top - p[1]) * self.scale, p[2]

    def triangle(self, corners, shade, edges):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = map(self.place, corners)
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0:
            return
        fill = [round(d + shade * (e - d)) for d, e in zip(DARK, LIGHT)]
        # the height over a side, in pixels: near 0 is on the edge
        sides = [math.hypot(cx - bx, cy - by), math.hypot(ax - cx, ay - cy),
                 math.hypot(bx - ax, by - ay)]
        for y in range(max(0, math.ceil(min(ay, by, cy))),
                       min(self.height - 1, math.floor(max(ay, by, cy))) + 1):
            for x in range(max(0, math.ceil(min(ax, bx, cx))),
                           min(self.width - 1, math.floor(max(ax, bx, cx))) + 1):
                wa = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                wb = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                wc = 1 - wa - wb
                if wa < 0 or wb < 0 or wc < 0:
                    continue
                at = y * self.width + x
                z = wa * az + wb * bz + wc * cz
                if z <= self.depth[at]:
                    continue
                self.depth[at] = z
                colour = fill
                if edges:
                    off = min(w * abs(area) / s for w, s in zip((wa, wb, wc), sides) if s > 0)
                    if off < 0.9:
                        ink = 0.75 * (1 - off / 0.9)
                        colour = [round(f + ink * (e - f)) for f, e in zip(fill, EDGE)]
                self.pixels[3 * at:3 * at + 3] = bytes(colour)

    def png(self, smaller):
        """The picture, every square of pixels averaged to one; 32 shades a channel keep it small."""
        width, height = self.width // smaller, self.height // smaller
        palette, rows = {}, bytearray()
        for y in range(height):
            rows.append(0)
            for x in range(width):
                at = [3 * ((y * smaller + j) * self.width + x * smaller + i)
                      for i in range(smaller) for j in range(smaller)]
                colour = bytes(sum(self.pixels[k + c] for k in at) // len(at) // 8 * 255 // 31
                               for c in range(3))
                rows.append(palette.setdefault(colour, len(palette)))

        def chunk(kind, data):
            return (struct.pack(">I", len(data)) + kind + data
                    + struct.pack(">I", zlib.crc32(kind + data)))
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3,
                                                                   0, 0, 0))
                + chunk(b"PLTE", b"".join(palette)) + chunk(b"IDAT", zlib.compress(bytes(rows), 9))
                + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--size", type=int, default=420, help="width in pixels")
    parser.add_argument("--turn", type=float, default=20, help="about z, in degrees")
    parser.add_argument("--tilt", type=float, default=50, help="0: from the side, 90: from above")
    parser.add_argument("--height", type=float, default=1, help="z is drawn so many times as high")
    parser.add_argument("--no-edges", action="store_true")
    options = parser.parse_args()
    points, faces = read_ply(options.mesh)
    seen = looked_at(points, math.radians(options.turn), math.radians(90 - options.tilt),
                     options.height)
    smaller = 2
    picture = Picture(seen, options.size * smaller)
    for face in faces:
        corners = [seen[v] for v in face]
        n = normal(*[points[v] for v in face])
        shade = max(0.0, sum(a * b for a, b in zip(n, SUN)))
        picture.triangle(corners, shade, not options.no_edges)
    options.picture.write_bytes(picture.png(smaller))


if __name__ == "__main__":
    main()
