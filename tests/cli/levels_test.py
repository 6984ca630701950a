#!/usr/bin/env python3
"""terrane levels: meshes and DEMs in, one file of levels out, and every level back from it."""

import json
import math
import pathlib
import struct
import tempfile
import unittest

from program import bytes_below, terrane

USAGE, INPUT, TOPOLOGY, OUTPUT = 2, 3, 4, 5
DEM = "synthetic:caldera?size=65&seed=1"


def torus_off(m, n):
    points = [(math.cos(u) * (1 + 0.4 * math.cos(v)), math.sin(u) * (1 + 0.4 * math.cos(v)),
               0.4 * math.sin(v))
              for u in (2 * math.pi * i / m for i in range(m))
              for v in (2 * math.pi * j / n for j in range(n))]
    faces = []
    for i in range(m):
        for j in range(n):
            a, b = i * n + j, (i + 1) % m * n + j
            c, d = (i + 1) % m * n + (j + 1) % n, i * n + (j + 1) % n
            faces += [(a, b, c), (a, c, d)]
    return off(points, faces)


def off(points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [f"{x} {y} {z}" for x, y, z in points]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces]
    return "\n".join(lines) + "\n"


def read_ply(file):
    """Points with their targets, and faces, of a PLY that terrane wrote."""
    header, body = file.read_bytes().split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    counts = {line.split()[1]: int(line.split()[2]) for line in lines if line[:7] == "element"}
    width = sum(line.startswith("property double") for line in lines)
    points = [struct.unpack_from(f"<{width}d", body, i * 8 * width)
              for i in range(counts["vertex"])]
    start = counts["vertex"] * 8 * width
    faces = [struct.unpack_from("<3i", body, start + 13 * i + 1) for i in range(counts["face"])]
    return points, faces


def triangles(points, faces, place=slice(0, 3)):
    """The triangles by the places of their corners, less degenerate ones."""
    found = set()
    for face in faces:
        corners = [points[v][place] for v in face]
        if len(set(corners)) == 3:
            k = corners.index(min(corners))
            found.add(tuple(corners[k:] + corners[:k]))
    return found


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.torus = self.folder / "torus.off"
        self.torus.write_text(torus_off(24, 16))

    def levels(self, *arguments):
        status, printed, said = terrane("--quiet", "levels", *arguments)
        self.assertEqual(status, 0, said)
        return printed

    def refuse(self, arguments, status, *words):
        before = set(self.folder.rglob("*"))
        got, printed, said = terrane("--quiet", "levels", *arguments)
        self.assertEqual(got, status, said)
        self.assertEqual(printed, "")
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        for word in words:
            self.assertIn(word, said)
        self.assertEqual(set(self.folder.rglob("*")), before)


class Levels(Folder):
    def test_blends_begin_at_a_level_and_end_at_the_next(self):
        out = self.folder / "torus.levels"
        self.assertIn("768", self.levels(self.torus, "-o", out, "--weights", "torus"))
        shapes = {}
        for what in ("0", "3", "3:0", "3:1", "4"):
            ply = self.folder / "mesh.ply"
            self.levels(out, "--extract", what, "-o", ply)
            shapes[what] = triangles(*read_ply(ply))
        self.assertEqual(len(shapes["0"]), 768)
        self.assertEqual(shapes["3:0"], shapes["3"])
        self.assertEqual(shapes["3:1"], shapes["4"])

    def test_every_second_level_morphs_to_the_next_one(self):
        out = self.folder / "dem.levels"
        self.levels(DEM, "-o", out, "--stop", "level=5")
        self.levels(out, "--every", "2", "--format", "ply", "-o", self.folder / "all")
        names = sorted(file.name for file in (self.folder / "all").iterdir())
        self.assertEqual(names, ["level_000.ply", "level_002.ply", "level_004.ply"])
        points, faces = read_ply(self.folder / "all" / "level_000.ply")
        following = read_ply(self.folder / "all" / "level_002.ply")
        self.assertEqual(triangles(points, faces, slice(3, 6)), triangles(*following))

    def test_glb_is_a_gltf_with_one_morph_target_that_ends_at_the_next_level(self):
        out = self.folder / "torus.levels"
        self.levels(self.torus, "-o", out, "--stop", "level=4")
        self.levels(out, "--every", "4", "-o", self.folder / "all")
        data = (self.folder / "all" / "level_000.glb").read_bytes()
        magic, version, length, json_length, kind = struct.unpack_from("<4sIII4s", data)
        self.assertEqual((magic, version, length, kind), (b"glTF", 2, len(data), b"JSON"))
        gltf = json.loads(data[20:20 + json_length])
        primitive = gltf["meshes"][0]["primitives"][0]
        self.assertEqual(len(primitive["targets"]), 1)
        self.assertEqual(gltf["accessors"][primitive["indices"]]["count"], 3 * 768)

        def vectors(accessor):
            accessor = gltf["accessors"][accessor]
            view = gltf["bufferViews"][accessor["bufferView"]]
            start = 28 + json_length + view.get("byteOffset", 0)
            return [struct.unpack_from("<3f", data, start + 12 * i)
                    for i in range(accessor["count"])]
        ends = {tuple(round(p + d, 4) for p, d in zip(position, morph))
                for position, morph in zip(vectors(primitive["attributes"]["POSITION"]),
                                           vectors(primitive["targets"][0]["POSITION"]))}
        self.levels(out, "--extract", "4", "-o", self.folder / "last.ply")
        self.assertEqual(len(ends), len(read_ply(self.folder / "last.ply")[0]))

    def test_obj_holds_as_many_faces_as_the_level(self):
        out = self.folder / "torus.levels"
        self.levels(self.torus, "-o", out, "--stop", "level=2")
        self.levels(out, "--every", "1", "--format", "obj", "-o", self.folder / "all")
        text = (self.folder / "all" / "level_000_morphed.obj").read_text()
        self.assertEqual(sum(line.startswith("f ") for line in text.splitlines()), 768)

    def test_report_tells_each_level(self):
        report = self.folder / "report.json"
        self.levels(DEM, "-o", self.folder / "dem.levels", "--stop", "level=6", "--report", report)
        levels = json.loads(report.read_text())["levels"]
        self.assertEqual([level["level"] for level in levels], list(range(7)))
        self.assertEqual(levels[0]["triangles"], 2 * 64 * 64)
        for level in levels:
            self.assertEqual(level["uncovered"], 0)
            self.assertEqual(level["folded"], 0)
            self.assertGreaterEqual(level["max_vertical_error"], level["max_error"])
            self.assertGreaterEqual(level["max_error"], level["rms_error"])
            self.assertGreaterEqual(level["seconds"], 0)
            self.assertIn("overlap", level["rejected"])
        for finer, coarser in zip(levels, levels[1:]):
            self.assertLess(coarser["triangles"], finer["triangles"])

    def test_stops_where_it_is_told(self):
        def left(*stop):
            printed = self.levels(DEM, "-o", self.folder / "a.levels", "--stop", *stop)
            return int(printed.split("-> ")[1].split()[0])
        self.assertLessEqual(left("triangles=1000"), 1000)
        report = self.folder / "report.json"
        self.assertLess(left("error=100", "--report", report), 8192)
        self.assertLessEqual(json.loads(report.read_text())["levels"][-1]["max_vertical_error"], 100)
        self.assertEqual(left("level=0"), 8192)

    def test_same_bytes_with_one_thread_and_with_two(self):
        for weights in ("st-helens", "crater-lake"):
            for jobs in ("1", "2"):
                self.levels(DEM, "-o", self.folder / f"{weights}.{jobs}.levels", "--weights",
                            weights, "--jobs", jobs)
            files = bytes_below(self.folder)
            self.assertEqual(files[f"{weights}.1.levels"], files[f"{weights}.2.levels"])

    def test_swapping_edges_removes_cycles_and_says_how_many(self):
        points = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (3, 1, 0), (-4, 4, 0), (4, -4, 0)]
        faces = [(0, 1, 4), (1, 2, 4), (2, 0, 4), (0, 2, 3), (3, 5, 0), (0, 6, 1)]
        (self.folder / "cycle.off").write_text(off(points, faces))
        status, _, said = terrane("levels", self.folder / "cycle.off", "-o",
                                  self.folder / "a.levels", "--swap-cycles")
        self.assertEqual(status, 0, said)
        self.assertIn("of 1 cycles removed", said)


class BadInput(Folder):
    def bad_mesh(self, text, status, *words, name="bad.off"):
        (self.folder / name).write_text(text)
        self.refuse([self.folder / name, "-o", self.folder / "a.levels"], status, name, *words)

    def test_edge_with_three_triangles(self):
        self.bad_mesh(off([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)],
                          [(0, 1, 2), (1, 0, 3), (0, 1, 4)]),
                      TOPOLOGY, "edge 0-1", "(0, 1, 2)", "Cut")

    def test_neighbours_that_face_opposite_sides(self):
        self.bad_mesh(off([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0)], [(0, 1, 2), (0, 1, 3)]),
                      TOPOLOGY, "triangles 0 and 1", "Orient")

    def test_vertex_that_is_not_finite(self):
        header = ("ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                  "property float y\nproperty float z\nelement face 1\n"
                  "property list uchar int vertex_indices\nend_header\n")
        body = struct.pack("<9fB3i", 0, 0, 0, 1, 0, 0, math.nan, 1, 0, 3, 0, 1, 2)
        (self.folder / "bad.ply").write_bytes(header.encode() + body)
        self.refuse([self.folder / "bad.ply", "-o", self.folder / "a.levels"], TOPOLOGY, "bad.ply",
                    "vertex 2", "Remove")

    def test_vertex_that_is_no_number(self):
        self.bad_mesh("v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n", INPUT, "triangle 0", "vertex 2",
                      name="bad.obj")

    def test_empty_file_and_a_file_of_something_else(self):
        self.bad_mesh("", INPUT, name="empty.obj")
        self.bad_mesh("Dear Sir or Madam", INPUT, name="letter.ply")
        self.bad_mesh("OFF\n1 0 0\n0 0 0\n", INPUT, "no face")

    def test_missing_mesh(self):
        self.refuse([self.folder / "gone.ply", "-o", self.folder / "a.levels"], INPUT, "gone.ply")

    def test_repeated_and_unused_elements_are_left_out_and_said(self):
        text = self.torus.read_text().splitlines()
        text[1] = "385 770 0"
        text.insert(2, "7 7 7")
        body = text[:387] + [" ".join(["3"] + [str(int(v) + 1) for v in face.split()[1:]])
                             for face in text[387:]]
        body += [body[387], "3 5 5 6"]
        (self.folder / "rough.off").write_text("\n".join(body) + "\n")
        status, _, said = terrane("levels", self.folder / "rough.off", "-o",
                                  self.folder / "a.levels")
        self.assertEqual(status, 0, said)
        for words in ("1 vertices that no triangle uses", "1 triangles that repeat a corner",
                      "1 triangles that are there twice"):
            self.assertIn(words, said)

    def test_damaged_levels(self):
        out = self.folder / "torus.levels"
        self.levels(self.torus, "-o", out)
        out.write_bytes(out.read_bytes()[:-20])
        self.refuse([out, "--extract", "1", "-o", self.folder / "a.ply"], INPUT, "torus.levels",
                    "damaged")

    def test_level_that_is_not_there(self):
        out = self.folder / "torus.levels"
        self.levels(self.torus, "-o", out, "--stop", "level=3")
        for what in ("4", "1:2", "x", "1:", "-1"):
            self.refuse([out, f"--extract={what}", "-o", self.folder / "a.ply"], USAGE)
        self.refuse([out, "-o", self.folder / "a.ply"], USAGE, "--extract")
        self.refuse([out, "--extract", "1", "-o", self.folder / "a.doc"], USAGE, "doc")

    def test_settings_out_of_range(self):
        for option in (("--share", "0"), ("--share", "2"), ("--weights", "1,2,0,0"),
                       ("--weights", "heavy"), ("--stop", "soon"), ("--stop", "level=-1"),
                       ("--jobs", "-2")):
            self.refuse([self.torus, "-o", self.folder / "a.levels", *option], USAGE, option[0])

    def test_output_that_cannot_be_written(self):
        self.refuse([self.torus, "-o", "/proc/terrane.levels"], OUTPUT, "/proc/terrane.levels")


if __name__ == "__main__":
    unittest.main()
