#!/usr/bin/env python3
"""Counts the triangles that a 3D Tiles client draws of a `terrane build` output for one camera.

tile_cut.py OUT X,Y,Z [--target X,Y,Z] [--pixels 1] [--height 720] [--fov 45]

X,Y,Z is where the camera is, in metres east, north and up from the middle of the root's box. The rule is
3D Tiles' own: a tile is replaced by its children while geometricError K / distance > pixels. With
--target X,Y,Z, what is outside the picture (16:9) is left out, tile by tile.
"""

import argparse
import json
import math
import pathlib
import struct


def triangles_of(glb):
    data = glb.read_bytes()
    length, = struct.unpack_from("<I", data, 12)
    gltf = json.loads(data[20:20 + length])
    return sum(gltf["accessors"][primitive["indices"]]["count"] // 3
               for mesh in gltf["meshes"] for primitive in mesh["primitives"]
               if primitive.get("mode", 4) == 4)


def corners(box):
    return [[box[k] + a * box[3 + k] + b * box[6 + k] + c * box[9 + k] for k in range(3)]
            for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]


def distance(eye, box):
    """Of a point from a box whose axes are at right angles."""
    squared = 0
    for axis in (box[3:6], box[6:9], box[9:12]):
        half = math.sqrt(sum(e * e for e in axis))
        along = sum((eye[k] - box[k]) * axis[k] for k in range(3)) / half
        squared += max(0, abs(along) - half) ** 2
    return math.sqrt(squared)


def may_be_seen(box, camera):
    """False only if all corners are beyond one side of the picture."""
    if camera is None:
        return True
    seen = [[sum((p[k] - camera["eye"][k]) * axis[k] for k in range(3)) for axis in camera["axes"]]
            for p in corners(box)]
    tan_y, tan_x = camera["tan_y"], camera["tan_y"] * 16 / 9
    sides = (lambda x, y, z: x - tan_x * z, lambda x, y, z: -x - tan_x * z,
             lambda x, y, z: y - tan_y * z, lambda x, y, z: -y - tan_y * z, lambda x, y, z: -z)
    return not any(all(side(*p) > 0 for p in seen) for side in sides)


def camera_towards(eye, target, tan_y):
    def unit(v):
        length = math.sqrt(sum(e * e for e in v))
        return [e / length for e in v]

    def cross(u, v):
        return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    forward = unit([t - e for t, e in zip(target, eye)])
    right = unit(cross(forward, [0, 0, 1]))
    return {"eye": eye, "axes": (right, cross(right, forward), forward), "tan_y": tan_y}


def count(tile, folder, eye, camera, scale, pixels):
    box = tile["boundingVolume"]["box"]
    if not may_be_seen(box, camera):
        return 0
    away = distance(eye, box)
    if tile.get("children") and tile["geometricError"] * scale > pixels * away:
        return sum(count(child, folder, eye, camera, scale, pixels) for child in tile["children"])
    return triangles_of(folder / tile["content"]["uri"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("eye")
    parser.add_argument("--target")
    parser.add_argument("--pixels", type=float, default=1)
    parser.add_argument("--height", type=float, default=720)
    parser.add_argument("--fov", type=float, default=45)
    options = parser.parse_args()
    root = json.loads((options.out / "tileset.json").read_text())["root"]
    middle = root["boundingVolume"]["box"][:3]

    def place(text):
        return [m + float(e) for m, e in zip(middle, text.split(","))]
    tan_y = math.tan(math.radians(options.fov / 2))
    eye = place(options.eye)
    camera = camera_towards(eye, place(options.target), tan_y) if options.target else None
    print(count(root, options.out, eye, camera, options.height / (2 * tan_y), options.pixels))


if __name__ == "__main__":
    main()
