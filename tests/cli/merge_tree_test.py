#!/usr/bin/env python3
"""terrane merge-tree and terrane view-cut: a mesh or a DEM in, and what a camera needs of it out."""

import collections
import json
import pathlib
import re
import struct
import tempfile
import unittest

from levels_test import read_ply, torus_off, triangles
from program import terrane

USAGE, INPUT = 2, 3
DEM = "synthetic:caldera?size=65&seed=1"


class MergeTree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_well(self, *arguments):
        status, out, err = terrane("--quiet", *arguments)
        self.assertEqual((status, err), (0, ""))
        return out

    def torus_tree(self, *options):
        mesh, tree = self.folder / "torus.off", self.folder / "torus.tree"
        mesh.write_text(torus_off(40, 20))
        self.run_well("merge-tree", mesh, "-o", tree, *options)
        return tree

    def cut(self, tree, *options, name="cut.ply"):
        out, report = self.folder / name, self.folder / "cut.json"
        self.run_well("view-cut", tree, "-o", out, "--report", report, *options)
        return out, json.loads(report.read_text())

    def edge_uses(self, faces):
        uses = collections.Counter()
        for face in faces:
            uses.update(frozenset((face[k], face[(k + 1) % 3])) for k in range(3))
        return set(uses.values())

    def test_no_error_gives_the_mesh_back(self):
        out, report = self.cut(self.torus_tree(), "--pixels", 0)
        points, faces = read_ply(out)
        self.assertEqual((len(points), len(faces)), (800, 1600))
        self.assertEqual((report["triangles"], report["full_triangles"]), (1600, 1600))
        self.assertLess(max(abs((x * x + y * y) ** 0.5 - 1) for x, y, _ in points), 0.401)

    def test_a_cut_is_closed_and_finer_near_the_camera(self):
        tree = self.torus_tree()
        out, report = self.cut(tree, "--camera", "3,0,0.5", "--pixels", 4)
        points, faces = read_ply(out)
        self.assertEqual(len(faces), report["triangles"])
        self.assertLess(len(faces), 1600)
        self.assertEqual(self.edge_uses(faces), {2})
        near = sum(points[face[0]][0] > 0 for face in faces)
        self.assertGreater(near, len(faces) - near)

    def test_a_budget_is_kept(self):
        _, report = self.cut(self.torus_tree(), "--camera", "4,0,1", "--budget", 500, "--back-faces",
                             "--silhouette", "0.5")
        self.assertLessEqual(report["triangles"], 500)
        self.assertGreater(report["triangles"], 300)

    def test_a_dem_keeps_its_plan(self):
        tree = self.folder / "dem.tree"
        self.run_well("merge-tree", DEM, "-o", tree)
        out, _ = self.cut(tree, "--pixels", 2, "--frustum")
        points, faces = read_ply(out)
        doubled = [(points[b][0] - points[a][0]) * (points[c][1] - points[a][1]) -
                   (points[b][1] - points[a][1]) * (points[c][0] - points[a][0])
                   for a, b, c in faces]
        self.assertGreater(min(doubled), 0)
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        area = (max(xs) - min(xs)) * (max(ys) - min(ys))
        self.assertAlmostEqual(sum(doubled) / 2 / area, 1, delta=1e-9)

    def test_triangle_collapses_make_a_tree_too(self):
        mesh, levels = self.folder / "torus.off", self.folder / "torus.levels"
        mesh.write_text(torus_off(40, 20))
        self.run_well("levels", mesh, "-o", levels)
        tree = self.folder / "levels.tree"
        self.run_well("merge-tree", levels, "-o", tree)
        finest = self.folder / "finest.ply"
        self.run_well("levels", levels, "--extract", "0", "-o", finest)
        out, _ = self.cut(tree, "--pixels", 0)
        self.assertEqual(triangles(*read_ply(out)), triangles(*read_ply(finest)))

    def test_the_published_settings_are_there(self):
        tree = self.torus_tree("--order", "length", "--region", "both", "--share", "1")
        _, report = self.cut(tree, "--switch-distance", "--pixels", 60, "--highlight", 20, "--light",
                             "1,0,1")
        self.assertLess(report["triangles"], 1600)

    def test_colours_of_a_ply_come_along_and_ask_for_detail(self):
        lines = torus_off(40, 20).split("\n")
        vertices, faces = (int(n) for n in lines[1].split()[:2])
        left = [float(line.split()[0]) < 0 for line in lines[2:2 + vertices]]
        painted = [f"{line} {'250 10 20' if is_left else '10 20 250'}"
                   for line, is_left in zip(lines[2:], left)]
        header = ["ply", "format ascii 1.0", f"element vertex {vertices}",
                  *(f"property float {axis}" for axis in "xyz"),
                  *(f"property uchar {name}" for name in ("red", "green", "blue")),
                  f"element face {faces}", "property list uchar int vertex_indices", "end_header"]
        mesh, tree = self.folder / "torus.ply", self.folder / "torus.tree"
        mesh.write_text("\n".join(header + painted + lines[2 + vertices:]))
        self.run_well("merge-tree", mesh, "-o", tree)
        _, plain = self.cut(tree, "--pixels", 20)
        out, coloured = self.cut(tree, "--pixels", 20, "--colour", 10)
        self.assertGreater(coloured["triangles"], 2 * plain["triangles"])
        head, body = out.read_bytes().split(b"end_header\n", 1)
        self.assertIn(b"property uchar blue", head)
        count = int(re.search(rb"element vertex (\d+)", head)[1])
        for v in range(count):
            x, _, _, red, _, blue = struct.unpack_from("<3d3B", body, 27 * v)
            if abs(x) > 1e-3:
                self.assertEqual((red, blue), (250, 20) if x < 0 else (10, 250))

    def test_the_same_input_gives_the_same_bytes(self):
        first = self.torus_tree().read_bytes()
        self.assertEqual(self.torus_tree().read_bytes(), first)

    def test_glb_is_gltf_2(self):
        out, _ = self.cut(self.torus_tree(), name="cut.glb")
        self.assertEqual(struct.unpack_from("<4sI", out.read_bytes()), (b"glTF", 2))

    def test_bad_input_is_refused_by_name(self):
        tree = self.torus_tree()
        broken = self.folder / "broken.tree"
        broken.write_bytes(tree.read_bytes()[:-100])
        for arguments, expected, words in [
                (("view-cut", broken, "-o", self.folder / "a.ply"), INPUT, ("broken.tree", "damaged")),
                (("view-cut", self.folder / "torus.off", "-o", self.folder / "a.ply"), INPUT,
                 ("torus.off", "merge-tree")),
                (("view-cut", tree, "-o", self.folder / "a.stl"), USAGE, ("a.stl", ".ply")),
                (("view-cut", tree, "-o", self.folder / "a.ply", "--camera", "0,0,1", "--target",
                  "0,0,0"), USAGE, ("camera", "up")),
                (("view-cut", tree, "-o", self.folder / "a.ply", "--fov", "180"), USAGE, ("--fov",)),
                (("merge-tree", self.folder / "torus.off", "-o", tree, "--share", "0"), USAGE,
                 ("share",))]:
            status, _, err = terrane("--quiet", *arguments)
            self.assertEqual(status, expected, err)
            for word in words:
                self.assertIn(word, err)


if __name__ == "__main__":
    unittest.main()
