#!/usr/bin/env python3
"""Fields of `terrane volume` from rasters and VTK grids, against the functions they were made from.

The files are written by this test alone: raw numbers that a GDAL VRT points at, and VTK XML in every
encoding. Needs Debian's python3-meshio and its numpy: run with /usr/bin/python3.
"""

import base64
import json
import pathlib
import struct
import sys
import tempfile
import unittest
import zlib

from program import SKIPPED, terrane

try:
    import meshio
    import numpy as np
except ImportError as missing:
    print(f"{missing}: install python3-meshio")
    sys.exit(SKIPPED)

INPUT, USAGE = 3, 2
TOLERANCE = 0.5
BOX = "[box]\nwest_m = 100\neast_m = 500\nsouth_m = -500\nnorth_m = -100\nbottom_m = 0\ntop_m = 200\n"
MODEL = BOX + f"""
[[material]]
name = "rock"
[[field]]
name = "T"
tolerance = {TOLERANCE}
[field.of]
rock = """
X, Y, Z = [50, 130, 260, 400, 470, 620], [-510, -420, -250, -130, -90], [-20, 40, 90, 250]
LEVELS = [0, 50, 90, 200]


def trilinear(x, y, z):
    """A function that trilinear interpolation on any grid along the axes gives back exactly."""
    return 20 + 0.02 * x - 0.05 * y + 0.1 * z + 1e-4 * x * z - 2e-4 * y * z + 1e-6 * x * y * z


def vtr(packing, axes=(X, Y, Z), f=trilinear, kind="Float64"):
    """A rectilinear grid as `ascii`, `base64`, `zlib` (base64), `raw` or `raw zlib` (appended)."""
    z, y, x = np.meshgrid(*reversed(axes), indexing="ij")
    arrays = [("T", f(x, y, z).ravel())] + list(zip("xyz", axes))
    is_raw, is_zlib = "raw" in packing, "zlib" in packing
    appended = b""

    def element(name, values):
        nonlocal appended
        values = np.asarray(values, {"Float64": "<f8", "Float32": "<f4"}[kind])
        tag = f'<DataArray type="{kind}" Name="{name}" format='
        if packing == "ascii":
            return f'{tag}"ascii">{" ".join(map(repr, values.tolist()))}</DataArray>'
        data = values.tobytes()
        header = struct.pack("<Q", len(data))
        if is_zlib:  # blocks of 64 bytes, the last one shorter
            blocks = [data[at:at + 64] for at in range(0, len(data), 64)]
            packed = [zlib.compress(block) for block in blocks]
            header = struct.pack(f"<{3 + len(blocks)}Q", len(blocks), 64, len(data) % 64,
                                 *map(len, packed))
            data = b"".join(packed)
        if is_raw:
            offset = len(appended)
            appended += header + data
            return f'{tag}"appended" offset="{offset}"/>'
        coded = (base64.b64encode(header) + base64.b64encode(data)).decode()
        return f'{tag}"binary">{coded}</DataArray>'
    values, *places = [element(*array) for array in arrays]
    compressor = ' compressor="vtkZLibDataCompressor"' if is_zlib else ""
    extent = " ".join(f"0 {len(axis) - 1}" for axis in axes)
    text = (f'<?xml version="1.0"?>\n<VTKFile type="RectilinearGrid" version="1.0" '
            f'byte_order="LittleEndian" header_type="UInt64"{compressor}>\n'
            f'<RectilinearGrid WholeExtent="{extent}"><Piece Extent="{extent}">\n'
            f'<PointData>{values}</PointData>\n<Coordinates>{"".join(places)}</Coordinates>\n'
            f'</Piece></RectilinearGrid>\n').encode()
    if is_raw:
        text += b'<AppendedData encoding="raw">\n_' + appended + b"\n</AppendedData>\n"
    return text + b"</VTKFile>\n"


class FieldCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def raster(self, f=trilinear, levels=LEVELS, west=80, columns=45, extra="", crs=""):
        """One band for each level: cells of 10 m x 12 m, north-up; places are those of centres."""
        rows, north = 40, -50
        y, x = np.meshgrid(north - 12 * (np.arange(rows) + 0.5),
                           west + 10 * (np.arange(columns) + 0.5), indexing="ij")
        bands = ""
        for band, z in enumerate(levels, 1):
            (self.folder / f"{band}.raw").write_bytes(
                np.asarray(f(x, y, z) + 0 * x, "<f8").tobytes())
            bands += (f'<VRTRasterBand dataType="Float64" band="{band}" subClass="VRTRawRasterBand">'
                      f'<SourceFilename relativeToVRT="1">{band}.raw</SourceFilename>'
                      f"<ByteOrder>LSB</ByteOrder>{extra}</VRTRasterBand>")
        file = self.folder / "field.vrt"
        file.write_text(f'<VRTDataset rasterXSize="{columns}" rasterYSize="{rows}">{crs}'
                        f"<GeoTransform>{west}, 10, 0, {north}, 0, -12</GeoTransform>{bands}"
                        "</VRTDataset>")
        return f'{{ raster = "{file}", levels_m = {list(levels)} }}\n'

    def grid(self, data, array=""):
        file = self.folder / "field.vtr"
        file.write_bytes(data)
        return f'{{ grid = "{file}"{array} }}\n'

    def run_model(self, text, quiet=True):
        (self.folder / "model.toml").write_text(text)
        return terrane(*["--quiet"] * quiet, "volume", self.folder / "model.toml", "-o",
                       self.folder / "out")

    def build(self, text):
        status, _, said = self.run_model(text)
        self.assertEqual(status, 0, said)
        return meshio.read(self.folder / "out" / "materials.vtu")

    def assert_is(self, mesh, f, atol):
        """At the corners the field is f, and inside a cell within the tolerance of it."""
        values = mesh.point_data["T"].ravel()
        np.testing.assert_allclose(values, f(*mesh.points.T), rtol=1e-6, atol=atol)
        cells = mesh.cells_dict["tetra"]
        weights = np.random.default_rng(1).dirichlet([1, 1, 1, 1], len(cells))
        place = np.einsum("ck,ckd->cd", weights, mesh.points[cells])
        inside = np.einsum("ck,ck->c", weights, values[cells])
        self.assertLessEqual(np.abs(inside - f(*place.T)).max(), TOLERANCE + atol)
        told = json.loads((self.folder / "out" / "volume.json").read_text())
        self.assertLessEqual(told["fields"][0]["max_error"], TOLERANCE)
        self.assertGreater(len(cells), 100)  # the field made it refine

    def refuse(self, source, *words, status=INPUT):
        got, printed, said = self.run_model(MODEL + source)
        self.assertEqual((got, printed, len(said.strip().splitlines())), (status, "", 1), said)
        for word in words:
            self.assertIn(word, said)
        self.assertFalse((self.folder / "out").exists())


class Grids(FieldCase):
    def test_a_trilinear_function_is_met_exactly_in_every_encoding(self):
        for packing in ("ascii", "base64", "zlib", "raw", "raw zlib"):
            with self.subTest(packing):
                self.assert_is(self.build(MODEL + self.grid(vtr(packing))), trilinear, 1e-9)

    def test_another_array_is_left_alone(self):
        data = vtr("ascii", kind="Float32").replace(
            b"<PointData>", b'<PointData><DataArray type="Int8" Name="S" format="ascii"/>')
        self.assert_is(self.build(MODEL + self.grid(data, ', array = "T"')), trilinear, 1e-4)

    def test_beyond_its_ends_a_field_goes_on_and_that_is_said(self):
        data = vtr("raw", (X, Y, [80, 100]))
        status, _, said = self.run_model(MODEL + self.grid(data), quiet=False)
        self.assertEqual(status, 0, said)
        self.assertIn("reaches from z 80 to 100 m", said)
        self.assert_is(meshio.read(self.folder / "out" / "materials.vtu"),
                       lambda x, y, z: trilinear(x, y, np.clip(z, 80, 100)), 1e-9)

    def test_nan_within_reach_of_the_box(self):
        def hole(x, y, z):
            return np.where((x == 260) & (z == 90), np.nan, trilinear(x, y, z))
        self.refuse(self.grid(vtr("raw", f=hole)), "field T", "field.vtr", "(260,", "no number")

    def test_nan_that_the_box_does_not_need(self):
        def far(x, y, z):
            return np.where(x > 600, np.nan, trilinear(x, y, z))
        axes = (X[:-1] + [550, 620], Y, Z)
        self.assert_is(self.build(MODEL + self.grid(vtr("raw", axes, far))), trilinear, 1e-9)

    def test_axis_that_does_not_rise(self):
        for bad in ([620, 50], [50, 50, 620], [50, float("nan"), 620], [50]):
            self.refuse(self.grid(vtr("raw", (bad, Y, Z))), "field.vtr", "along x", "rising")

    def test_grid_that_the_box_misses(self):
        self.refuse(self.grid(vtr("raw", (X, Y, [300, 400]))), "field.vtr", "outside the box", "z")

    def test_array_that_is_not_there(self):
        self.refuse(self.grid(vtr("raw"), ', array = "S"'), "field.vtr", "'S'", "There are: T")

    def test_file_that_is_cut_off(self):
        self.refuse(self.grid(vtr("raw")[:-50]), "field.vtr", "end before")
        self.refuse(self.grid(vtr("ascii")[:400]), "field.vtr", "no VTK rectilinear grid")

    def test_file_that_is_not_there(self):
        self.refuse('{ grid = "gone.vtr" }\n', "gone.vtr", "cannot be read")


class Rasters(FieldCase):
    def test_a_trilinear_function_is_met_to_the_digits_of_a_float(self):
        self.assert_is(self.build(MODEL + self.raster()), trilinear, 1e-4)

    def test_one_band_is_the_same_at_all_heights(self):
        source = self.raster(lambda x, y, z: 0.02 * x + 1e-3 * x * y, [0])
        source = source.replace(", levels_m = [0]", "")
        self.assert_is(self.build(MODEL + source), lambda x, y, z: 0.02 * x + 1e-3 * x * y, 1e-4)

    def test_each_material_has_its_own(self):
        ground = ('[[surface]]\nname = "ground"\ndem = "synthetic:flat?size=65&spacing=10"\n'
                  "tolerance_m = 5\n")
        text = MODEL.replace("[[material]]", ground + '[[material]]', 1).replace(
            'name = "rock"\n', 'name = "rock"\nwhere = "below ground"\n[[material]]\nname = "air"\n')
        mesh = self.build(text + self.raster() + "air = " + self.grid(
            vtr("raw", f=lambda x, y, z: 3 - 0.01 * z + 0 * x)))
        values, corners = mesh.point_data["T"].ravel(), mesh.cells_dict["tetra"]
        material = mesh.cell_data["material"][0].ravel()
        for number, f in enumerate([trilinear, lambda x, y, z: 3 - 0.01 * z]):
            at = corners[material == number].ravel()
            self.assertGreater(at.size, 400)
            np.testing.assert_allclose(values[at], f(*mesh.points[at].T), atol=TOLERANCE + 1e-4)

    def test_on_earth_values_are_those_of_the_place(self):
        # 0.4 degrees of latitude and longitude in cells of 0.01: a function of latitude and height
        rows = 40
        y = np.repeat(44 - 0.01 * (np.arange(rows) + 0.5), 60)
        for band, z in enumerate((0, 1000), 1):
            (self.folder / f"{band}.raw").write_bytes(
                np.asarray(100 * (y - 43.8) * (1 + z / 1000), "<f8").tobytes())
        bands = "".join(f'<VRTRasterBand dataType="Float64" band="{band}" subClass="VRTRawRasterBand">'
                        f'<SourceFilename relativeToVRT="1">{band}.raw</SourceFilename>'
                        "<ByteOrder>LSB</ByteOrder></VRTRasterBand>" for band in (1, 2))
        file = self.folder / "earth.vrt"
        file.write_text(f'<VRTDataset rasterXSize="60" rasterYSize="{rows}"><SRS>EPSG:4326</SRS>'
                        f"<GeoTransform>10, 0.01, 0, 44, 0, -0.01</GeoTransform>{bands}</VRTDataset>")
        box = ("[box]\nwest_deg = 10.1\neast_deg = 10.5\nsouth_deg = 43.7\nnorth_deg = 43.9\n"
               "bottom_m = 0\ntop_m = 1000\n")
        mesh = self.build(MODEL.replace(BOX, box) +
                          f'{{ raster = "{file}", levels_m = [0, 1000] }}\n')
        x, y, z = mesh.points.T
        # an arc of the ellipsoid's meridian is 111,115 m a degree there; a parallel curves away from y
        degrees = (y - x ** 2 * np.tan(np.radians(43.8)) / (2 * 6_386_000)) / 111_115
        self.assertGreater(len(np.unique(mesh.points, axis=0)), 20)
        np.testing.assert_allclose(mesh.point_data["T"].ravel(), 100 * degrees * (1 + z / 1000),
                                   atol=0.005)

    def test_bands_and_levels_that_do_not_fit(self):
        self.refuse(self.raster().replace(", 200]", "]"), "field.vrt", "4 bands", "3 heights")
        self.refuse(self.raster(levels=[0, 90, 50, 200]), "field.vrt", "along z", "rising")

    def test_void_in_the_box(self):
        extra = "<NoDataValue>-1</NoDataValue>"

        def hole(x, y, z):
            return np.where((abs(x - 305) < 1) & (z == 50), -1, trilinear(x, y, z))
        self.refuse(self.raster(hole, extra=extra), "field T", "field.vrt", "(305,", "50)",
                    "no number")

    def test_undeclared_void(self):
        self.refuse(self.raster(lambda x, y, z: np.where(x > 300, -9999, 1.0)), "field.vrt", "-9999")

    def test_raster_that_the_box_misses(self):
        self.refuse(self.raster(west=800), "field.vrt", "outside the box")

    def test_raster_on_earth_in_a_box_of_metres(self):
        self.refuse(self.raster(crs="<SRS>EPSG:32633</SRS>"), "field.vrt", "has a CRS")

    def test_two_sources_at_once(self):
        self.refuse('{ grid = "a.vtr", raster = "b.tif" }\n', "model.toml:", "field.of.rock",
                    status=USAGE)
        self.refuse('{ gird = "a.vtr" }\n', "model.toml:", "field.of.rock.gird", status=USAGE)


if __name__ == "__main__":
    unittest.main()
