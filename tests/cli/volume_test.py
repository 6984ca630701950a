#!/usr/bin/env python3
"""`terrane volume`: files read back by meshio, volumes known on paper, and bad input.

Needs Debian's python3-meshio and its numpy: run with /usr/bin/python3.
"""

import json
import pathlib
import struct
import sys
import tempfile
import unittest

from program import SKIPPED, bytes_below, terrane

try:
    import meshio
    import numpy as np
except ImportError as missing:
    print(f"{missing}: install python3-meshio")
    sys.exit(SKIPPED)

USAGE, INPUT, OUTPUT = 2, 3, 5

BOX = """
[box]
west_m = 100
east_m = 500
south_m = -500
north_m = -100
bottom_m = 0
top_m = 200
"""
GROUND = """
[[surface]]
name = "ground"
dem = "synthetic:flat?size=65&spacing=10"
tolerance_m = 5
"""
LAKE = """
[[surface]]
name = "lake"
level_m = 120
inside = "{folder}/lake.csv"
tolerance_m = 5
"""
MATERIALS = """
[[material]]
name = "rock"
where = "below ground"
[[material]]
name = "water"
where = "below lake"
[[material]]
name = "air"
empty = true
[[field]]
name = "density"
tolerance = 0.5
[field.of]
rock = 2600
water = "1000 + 0.05 * (120 - z)"
"""
# 200 m x 100 m of water, 20 m deep, with an island of 40 m x 50 m
LAKE_VOLUME = (200 * 100 - 40 * 50) * 20
LAKE_WKT = ("id,WKT\n1,\"POLYGON((200 -300,400 -300,400 -200,200 -200,200 -300),"
            "(250 -275,290 -275,290 -225,250 -225,250 -275))\"\n")
CUBE = """v 200 -400 50\nv 300 -400 50\nv 200 -300 50\nv 300 -300 50
v 200 -400 150\nv 300 -400 150\nv 200 -300 150\nv 300 -300 150
f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5
f 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 6
"""
BODY = """
[[surface]]
name = "body"
mesh = "{folder}/body.obj"
tolerance_m = 4
[[material]]
name = "ore"
where = "below body"
[[material]]
name = "rock"
"""


class VolumeCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "lake.csv").write_text(LAKE_WKT)
        (self.folder / "body.obj").write_text(CUBE)

    def model(self, *parts):
        file = self.folder / "model.toml"
        file.write_text("".join(parts).replace("{folder}", str(self.folder)))
        return file

    def build(self, *parts, options=()):
        out = self.folder / "out"
        status, printed, said = terrane("--quiet", "volume", self.model(*parts), "-o", out, *options)
        self.assertEqual(status, 0, said)
        return out, json.loads((out / "volume.json").read_text()), printed


def tetra_volumes(mesh):
    corners = mesh.points[mesh.cells_dict["tetra"]]
    edges = corners[:, 1:] - corners[:, :1]
    return np.linalg.det(edges) / 6


def vtu_array(file, name):
    """One Float64 array of a VTU. (meshio 5.0 moves offsets while it looks for them, and takes one
    array for another where a new offset is equal to an old one.)"""
    data = file.read_bytes()
    head, body = data.split(b'<AppendedData encoding="raw">\n_', 1)
    tag = next(line for line in head.decode().splitlines() if f'Name="{name}"' in line)
    offset = int(tag.split('offset="')[1].split('"')[0])
    count = int(np.frombuffer(body, "<u8", 1, offset)[0]) // 8
    return np.frombuffer(body, "<f8", count, offset + 8)


def read_ply(file):
    """Corners and materials of the triangles (meshio takes no property beside a list)."""
    head, body = file.read_bytes().split(b"end_header\n", 1)
    points, faces = (int(line.split()[2]) for line in head.decode().splitlines()
                     if line.startswith("element"))
    at = np.frombuffer(body, "<f8", 3 * points).reshape(-1, 3)
    face = np.dtype([("count", "u1"), ("corners", "<i4", 3), ("material", "u1")])
    listed = np.frombuffer(body, face, faces, 24 * points)
    return at[listed["corners"]], listed["material"]


def read_glb(file):
    """Of each material its name and the corners of its triangles, east, north and up."""
    data = file.read_bytes()
    magic, version, size, json_size, kind = struct.unpack("<4sIII4s", data[:20])
    assert (magic, version, size, kind) == (b"glTF", 2, len(data), b"JSON")
    told = json.loads(data[20:20 + json_size])
    binary = data[28 + json_size:]
    assert told["buffers"] == [{"byteLength": len(binary)}]

    def array(number, width):
        accessor = told["accessors"][number]
        view = told["bufferViews"][accessor["bufferView"]]
        kind = {5123: "<u2", 5125: "<u4", 5126: "<f4"}[accessor["componentType"]]
        return np.frombuffer(binary, kind, accessor["count"] * width,
                             view.get("byteOffset", 0)).reshape(-1, width)
    x, y, z = told["nodes"][0]["translation"]
    for primitive in told["meshes"][0]["primitives"]:
        position = primitive["attributes"]["POSITION"]
        at = array(position, 3)
        np.testing.assert_array_equal(told["accessors"][position]["min"], at.min(axis=0))
        np.testing.assert_array_equal(told["accessors"][position]["max"], at.max(axis=0))
        world = np.stack([at[:, 0] + x, -(at[:, 2] + z), at[:, 1] + y], axis=1)
        yield (told["materials"][primitive["material"]]["name"],
               world[array(primitive["indices"], 1).reshape(-1, 3)])


def areas_of(corners):
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                          axis=1) / 2


class Volume(VolumeCase):
    def test_another_reader_finds_cells_that_fill_the_box(self):
        out, told, _ = self.build(BOX, GROUND, LAKE, MATERIALS)
        mesh = meshio.read(out / "cells.vtu")
        volumes = tetra_volumes(mesh)
        self.assertEqual(len(volumes), told["cells"]["count"])
        self.assertEqual(len(mesh.points), told["cells"]["vertices"])
        self.assertTrue((volumes > 0).all())
        self.assertAlmostEqual(volumes.sum(), 400 * 400 * 200, delta=1)
        for name in ("distance to ground", "distance to lake", "density of water"):
            self.assertEqual(mesh.point_data[name].size, len(mesh.points))
        for name in ("material", "level", "error of ground", "error of lake", "error of density"):
            self.assertEqual(mesh.cell_data[name][0].size, len(volumes))
        self.assertLessEqual(mesh.cell_data["error of lake"][0].max(), 5)
        # a distance that was computed is that to the plane z = 100
        near = np.abs(mesh.points[:, 2] - 100) < 5
        np.testing.assert_allclose(mesh.point_data["distance to ground"].ravel()[near],
                                   mesh.points[near, 2] - 100, atol=1e-6)

    def test_the_page_gets_the_same_cells_as_plain_arrays(self):
        out, told, _ = self.build(BOX, GROUND, LAKE, MATERIALS)
        data = (out / "cells.bin").read_bytes()
        types = {"float32": "<f4", "uint32": "<u4", "uint8": "u1"}

        def array(name):
            at = told["cells_bin"][name]
            self.assertEqual(at["offset"] % 4, 0)
            flat = np.frombuffer(data, types[at["type"]], at["count"] * at["components"],
                                 at["offset"])
            return flat.reshape(at["count"], at["components"])
        mesh = meshio.read(out / "cells.vtu")
        middle = (np.array(told["box_m"]["low"]) + told["box_m"]["high"]) / 2
        np.testing.assert_allclose(array("positions") + middle, mesh.points, atol=1e-4)
        for k, name in enumerate(["ground", "lake"]):
            distance = vtu_array(out / "cells.vtu", f"distance to {name}")
            np.testing.assert_allclose(array("distances")[:, k], distance, rtol=1e-6, atol=1e-4)
        for k, name in enumerate(["rock", "water", "air"]):
            value = vtu_array(out / "cells.vtu", f"density of {name}")
            np.testing.assert_allclose(array("values")[:, k], value, rtol=1e-6)
        corners = array("corners")
        self.assertEqual([set(cell) for cell in corners],
                         [set(cell) for cell in mesh.cells_dict["tetra"]])
        # a cell of one material is parted by nothing
        self.assertEqual((array("parting").ravel() == 0).tolist(),
                         (mesh.cell_data["material"][0].ravel() >= 0).tolist())
        self.assertEqual(told["materials"][1]["where"], [{"surface": "lake", "side": "below"}])
        self.assertTrue(told["materials"][2]["is_empty"])

    def test_pieces_have_the_volumes_of_the_materials_and_their_fields(self):
        out, told, _ = self.build(BOX, GROUND, LAKE, MATERIALS)
        mesh = meshio.read(out / "materials.vtu")
        volumes, material = tetra_volumes(mesh), mesh.cell_data["material"][0].ravel()
        self.assertGreaterEqual(volumes.min(), -1e-6)
        for number, about in enumerate(told["materials"]):
            self.assertAlmostEqual(volumes[material == number].sum(), about["volume_m3"], delta=1)
        # the walls of the lake stand within the tolerance of their places
        self.assertAlmostEqual(volumes[material == 1].sum(), LAKE_VOLUME,
                               delta=5 * 20 * (2 * 300 + 2 * 90))
        self.assertAlmostEqual(volumes[material == 0].sum(), 400 * 400 * 100, delta=1)
        corners = mesh.cells_dict["tetra"][material == 1].ravel()
        z = mesh.points[corners, 2]
        np.testing.assert_allclose(mesh.point_data["density"].ravel()[corners], 1000 + 0.05 * (120 - z),
                                   atol=0.5)

    def test_a_mesh_file_is_a_surface(self):
        _, told, _ = self.build(BOX, BODY)
        self.assertAlmostEqual(told["materials"][0]["volume_m3"], 1e6, delta=4 * 6e4)
        self.assertLessEqual(told["surfaces"][0]["max_error_m"], 4)

    def test_a_section_shows_what_the_plane_meets(self):
        section = '[[section]]\nname = "cut"\nnormal = [0, 1, 0]\noffset_m = -250.5\n'
        out, _, _ = self.build(BOX, GROUND, LAKE, MATERIALS, section)
        corners, material = read_ply(out / "cut.ply")
        areas = areas_of(corners)
        self.assertAlmostEqual(areas.sum(), 400 * 200, delta=1)
        # 200 m of water less 40 m of island, 20 m deep; walls within the tolerance
        self.assertAlmostEqual(areas[material == 1].sum(), 160 * 20, delta=4 * 5 * 20)
        self.assertTrue((out / "cut.svg").read_text().startswith("<svg"))
        shown = dict(read_glb(out / "cut.glb"))
        self.assertEqual(list(shown), ["rock", "water", "air"])
        for number, name in enumerate(shown):
            self.assertAlmostEqual(areas_of(shown[name]).sum(), areas[material == number].sum(),
                                   delta=0.1)
            np.testing.assert_allclose(shown[name][:, :, 1], -250.5, atol=1e-3)
        top = shown["water"][:, :, 2]
        self.assertTrue((top > 95 - 1e-3).all() and (top < 125).all())

    def test_a_section_beside_the_box_is_empty(self):
        section = '[[section]]\nname = "cut"\nnormal = [0, 1, 0]\noffset_m = 900\n'
        out, _, _ = self.build(BOX, GROUND, LAKE, MATERIALS, section)
        data = (out / "cut.glb").read_bytes()
        self.assertEqual(len(data), struct.unpack("<I", data[8:12])[0])
        self.assertNotIn("meshes", json.loads(data[20:]))

    def test_the_same_input_gives_the_same_bytes(self):
        out, _, _ = self.build(BOX, GROUND, LAKE, MATERIALS)
        first = bytes_below(out)
        self.build(BOX, GROUND, LAKE, MATERIALS)
        self.assertEqual(bytes_below(out), first)

    def test_stops_at_the_number_of_cells_and_says_so(self):
        _, told, printed = self.build(BOX, GROUND, LAKE, MATERIALS, options=["--most-cells", "500"])
        self.assertLess(told["cells"]["count"], 600)
        self.assertIn("stopped before", printed)

    def test_info_repeats_what_was_said(self):
        out, _, printed = self.build(BOX, GROUND, LAKE, MATERIALS)
        self.assertEqual(terrane("volume", "--info", out)[:2], (0, printed))


class BadInput(VolumeCase):
    def refuse(self, parts, status, *words):
        """One line with all the words, and nothing written."""
        model = self.model(*parts)
        before = set(self.folder.rglob("*"))
        got, printed, said = terrane("--quiet", "volume", model, "-o", self.folder / "out")
        self.assertEqual(got, status, said)
        self.assertEqual(printed, "")
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        for word in words:
            self.assertIn(word, said)
        self.assertEqual(set(self.folder.rglob("*")), before)

    def test_open_mesh(self):
        (self.folder / "body.obj").write_text(CUBE.rsplit("f", 1)[0])
        self.refuse([BOX, BODY], INPUT, "body", "open")

    def test_mesh_that_intersects_itself(self):
        # a second cube, shifted into the first
        shifted = "".join(
            "v " + " ".join(str(float(c) + 31) for c in line.split()[1:]) + "\n"
            if line.startswith("v") else
            "f " + " ".join(str(int(c) + 8) for c in line.split()[1:]) + "\n"
            for line in CUBE.strip().splitlines())
        (self.folder / "body.obj").write_text(CUBE + shifted)
        self.refuse([BOX, BODY], INPUT, "body", "intersects itself")

    def test_mesh_that_the_box_misses(self):
        (self.folder / "body.obj").write_text(CUBE.replace("v ", "v 9"))
        self.refuse([BOX, BODY], INPUT, "body", "outside the box")

    def test_file_that_is_no_mesh(self):
        (self.folder / "body.obj").write_text("Dear Sir or Madam")
        self.refuse([BOX, BODY], INPUT, "body.obj")

    def test_bed_above_the_water(self):
        lake = LAKE.replace("120", "80") + 'over = "ground"\n'
        self.refuse([BOX, GROUND, lake, MATERIALS], INPUT, "lake", "20.0 m under ground")

    def test_bed_above_the_water_without_over_is_rock(self):
        _, told, _ = self.build(BOX, GROUND, LAKE.replace("120", "80"), MATERIALS)
        self.assertEqual(told["materials"][1]["volume_m3"], 0)

    def test_field_with_nan(self):
        bad = MATERIALS.replace('"1000 + 0.05 * (120 - z)"', '"log(-1)"')
        self.refuse([BOX, GROUND, LAKE, bad], INPUT, "density", "no number")

    def test_formula_that_is_none(self):
        bad = MATERIALS.replace('"1000 + 0.05 * (120 - z)"', '"1000 +"')
        self.refuse([BOX, GROUND, LAKE, bad], USAGE, "density", "1000 +")

    def test_dem_that_ends_inside_the_box(self):
        self.refuse([BOX.replace("500\n", "900\n", 1), GROUND, LAKE, MATERIALS], INPUT, "no height",
                    "box")

    def test_polygon_that_crosses_itself(self):
        (self.folder / "lake.csv").write_text('id,WKT\n1,"POLYGON((200 -300,400 -200,400 -300,'
                                              '200 -200,200 -300))"\n')
        self.refuse([BOX, GROUND, LAKE, MATERIALS], INPUT, "lake.csv", "Self-intersection")

    def test_box_without_extent(self):
        self.refuse([BOX.replace("top_m = 200", "top_m = -1"), GROUND, LAKE, MATERIALS], USAGE,
                    "model.toml", "top_m")

    def test_unknown_key_names_file_and_line(self):
        self.refuse([BOX, GROUND.replace("tolerance_m", "tolerence_m"), LAKE, MATERIALS], USAGE,
                    "model.toml:13", "tolerence_m")

    def test_material_of_an_unknown_surface(self):
        self.refuse([BOX, GROUND, LAKE, MATERIALS.replace("below lake", "below sea")], USAGE,
                    "water", "sea")

    def test_missing_model_file(self):
        status, _, said = terrane("volume", self.folder / "gone.toml", "-o", self.folder / "out")
        self.assertEqual(status, INPUT)
        self.assertIn("gone.toml", said)

    def test_output_that_cannot_be_written(self):
        status, _, said = terrane("--quiet", "volume", self.model(BOX, GROUND, LAKE, MATERIALS),
                                  "-o", "/proc/terrane")
        self.assertEqual(status, OUTPUT)
        self.assertIn("/proc/terrane", said)


if __name__ == "__main__":
    unittest.main()
