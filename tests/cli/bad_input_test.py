#!/usr/bin/env python3
"""Bad input: one clear line that names the file and what to do, and nothing half-written."""

import contextlib
import fcntl
import os
import pathlib
import subprocess
import tempfile
import unittest

from program import DATA, terrane

USAGE, INPUT, OUTPUT = 2, 3, 5


def write_grid(file, columns, rows, value=lambda column, row: 7 * column + row * row):
    """An ESRI ASCII grid, -9999 for no data."""
    lines = [f"ncols {columns}", f"nrows {rows}", "xllcorner 0", "yllcorner 0", "cellsize 10",
             "NODATA_value -9999"]
    for row in range(rows):
        lines.append(" ".join(str(value(column, row)) for column in range(columns)))
    file.write_text("\n".join(lines) + "\n")


class BadInput(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.good = self.folder / "good.asc"
        write_grid(self.good, 40, 30)

    def refuse(self, arguments, status, *words, out="out"):
        """Expects one line of error with all the words, and that nothing was written."""
        out = self.folder / out
        before = set(self.folder.rglob("*"))
        got, printed, said = terrane("--quiet", "build", *arguments, "-o", out)
        self.assertEqual(got, status, said)
        self.assertEqual(printed, "")
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        for word in words:
            self.assertIn(word, said)
        self.assertEqual(set(self.folder.rglob("*")), before)

    def test_missing_file(self):
        self.refuse([self.folder / "gone.tif"], INPUT, "gone.tif")

    def test_not_a_raster(self):
        file = self.folder / "letter.txt"
        file.write_text("Dear Sir or Madam")
        self.refuse([file], INPUT, "letter.txt")

    def test_empty_raster(self):
        file = self.folder / "empty.vrt"
        file.write_text('<VRTDataset rasterXSize="0" rasterYSize="0"/>')
        self.refuse([file], INPUT, "empty.vrt")

    def test_more_samples_along_a_side_than_tiles_can_count(self):
        file = self.folder / "wide.vrt"
        file.write_text('''<VRTDataset rasterXSize="131073" rasterYSize="2">
            <GeoTransform>0, 1, 0, 0, 0, -1</GeoTransform>
            <VRTRasterBand dataType="Float32" band="1"/></VRTDataset>''')
        self.refuse([file], INPUT, "131073 x 2", "131072", "gdal_translate")

    def test_a_projection_that_tiles_cannot_follow_is_found_before_anything_is_built(self):
        file = self.folder / "pacific.vrt"
        file.write_text('''<VRTDataset rasterXSize="400" rasterYSize="400">
            <SRS>EPSG:3832</SRS><GeoTransform>-4e6, 2e4, 0, 4e6, 0, -2e4</GeoTransform>
            <VRTRasterBand dataType="Float32" band="1"/></VRTDataset>''')
        self.refuse([file], INPUT, "0 to 399", "bends", "gdalwarp")

    def test_one_column(self):
        file = self.folder / "line.asc"
        write_grid(file, 1, 9)
        self.refuse([file], INPUT, "line.asc", "2 x 2")

    def test_all_nodata(self):
        file = self.folder / "sea.asc"
        write_grid(file, 9, 9, lambda column, row: -9999)
        self.refuse([file], INPUT, "sea.asc")

    def test_band_out_of_range(self):
        self.refuse([self.good, "--band", "3"], INPUT, "good.asc", "--band")

    def test_unknown_crs(self):
        self.refuse([self.good, "--crs", "EPSG:99999999"], INPUT, "EPSG:99999999")

    def test_negative_tolerance(self):
        self.refuse([self.good, "--tolerance", "-1"], USAGE, "--tolerance")

    def test_an_effort_above_the_top(self):
        self.refuse([self.good, "--effort", "4"], USAGE, "--effort 4", "0 to 3")

    def test_formats_that_do_not_exist(self):
        self.refuse([self.good, "--compression", "zip"], USAGE, "--compression zip", "meshopt")
        self.refuse([self.good, "--skirts", "-3"], USAGE, "--skirts -3", "auto")
        self.refuse([self.good, "--implicit", "--levels-per-octave", "2"], USAGE, "--implicit")

    def test_a_texture_that_is_not_there(self):
        self.refuse([self.good, "--texture", self.folder / "gone.tif"], INPUT, "gone.tif")

    def test_a_texture_that_is_elsewhere(self):
        texture = self.folder / "far.ppm"
        texture.write_bytes(b"P6 2 2 255\n" + bytes(12))
        (self.folder / "far.wld").write_text("10\n0\n0\n-10\n900000\n900000\n")
        self.refuse([self.good, "--texture", texture], INPUT, "far.ppm",
                    "does not lie over the DEM")

    def test_unknown_vertical_unit(self):
        self.refuse([self.good, "--vertical-unit", "furlong"], USAGE, "furlong", "foot")

    def test_unknown_key_in_the_settings_names_file_and_line(self):
        config = self.folder / "my.toml"
        config.write_text("[build]\ntolerance_m = 2.0\ntolerence_m = 3.0\n")
        self.refuse([self.good, "--config", config], USAGE, "my.toml:3", "build.tolerence_m")

    def test_value_of_the_wrong_type_in_the_settings(self):
        config = self.folder / "my.toml"
        config.write_text('[build]\ntolerance_m = "small"\n')
        self.refuse([self.good, "--config", config], USAGE, "my.toml:2", "build.tolerance_m")

    def test_output_folder_with_files_of_others(self):
        (self.folder / "thesis").mkdir()
        (self.folder / "thesis" / "chapter1.tex").write_text("It was a dark and stormy night")
        self.refuse([self.good], OUTPUT, "thesis", "--force", out="thesis")

    def test_output_that_another_run_is_writing_to(self):
        (self.folder / "out").mkdir()
        descriptor = os.open(self.folder / "out", os.O_RDONLY)
        self.addCleanup(os.close, descriptor)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        self.refuse([self.good], OUTPUT, "another run")

    def test_output_that_is_a_file(self):
        (self.folder / "file").write_text("x")
        self.refuse([self.good], OUTPUT, "file", out="file")

    def test_unwritable_output(self):
        # /proc cannot be written to even by root
        got, _, said = terrane("--quiet", "build", self.good, "-o", "/proc/terrane")
        self.assertEqual(got, OUTPUT)
        self.assertIn("/proc/terrane", said)
        self.assertEqual(len(said.strip().splitlines()), 1, said)

    def test_truncated_geotiff(self):
        whole, cut = self.folder / "whole.tif", self.folder / "cut.tif"
        write_grid(self.good, 400, 300)
        subprocess.run(["gdal_translate", "-q", self.good, whole], check=True)
        cut.write_bytes(whole.read_bytes()[:whole.stat().st_size // 2])
        self.refuse([cut], INPUT, "cut.tif")

    def test_undeclared_nodata_is_reported_and_not_read_as_a_height(self):
        file = self.folder / "pit.asc"
        write_grid(file, 20, 20, lambda column, row: -32767 if column < 3 else 100 + row)
        self.refuse([file], INPUT, "pit.asc", "60", "-32767", "--nodata")
        status, _, said = terrane("--quiet", "build", file, "-o", self.folder / "out", "--nodata",
                                  "-32767")
        self.assertEqual(status, 0, said)

    def test_full_disk(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=900k", "tmpfs", disk],
                                 capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("this user may not mount a small disk")
        with contextlib.ExitStack() as stack:
            stack.callback(lambda: subprocess.run(["umount", disk], check=True))
            (disk / "ballast").write_bytes(b"x" * 100_000)
            (disk / "out").mkdir()
            status, _, said = terrane("--quiet", "build", "synthetic:caldera?size=513&seed=1", "-o",
                                      disk / "out", "--tolerance", "0.5")
            self.assertEqual(status, OUTPUT, said)
            self.assertIn("No space left on device", said)
            self.assertEqual(len(said.strip().splitlines()), 1, said)
            self.assertFalse(list(disk.rglob("*.tmp")))
            self.assertFalse((disk / "out" / "terrane.json").exists())


class RealBadInput(unittest.TestCase):
    """DEMs that are none, or lie about their voids."""

    def refuse(self, file, *words):
        if not (DATA / file).exists():
            self.skipTest(f"{file} is not there")
        with tempfile.TemporaryDirectory() as folder:
            status, _, said = terrane("--quiet", "build", DATA / file, "-o",
                                      os.path.join(folder, "out"))
            self.assertEqual(status, INPUT)
            self.assertFalse(os.path.exists(os.path.join(folder, "out")))
        for word in words:
            self.assertIn(word, said)

    def test_image_is_refused_with_how_to_pick_a_band(self):
        self.refuse("crater_lake/craterlake-imagery-30m.tif", "image", "--band")

    def test_undeclared_voids_of_the_lake_floor_are_reported(self):
        self.refuse("crater_lake/craterlake-bathymetry-elev-16bit-30m.tif", "-32767", "--nodata")

    def test_two_bands_need_a_choice(self):
        self.refuse("st_helens/before_after_2band.vrt", "2 bands", "--band")


class BadOutput(unittest.TestCase):
    def test_verify_of_a_folder_that_holds_no_output(self):
        with tempfile.TemporaryDirectory() as folder:
            status, _, said = terrane("verify", folder)
            self.assertEqual(status, INPUT)
            self.assertIn("terrane.json", said)

    def test_verify_against_another_dem_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            terrane("--quiet", "build", "synthetic:caldera?size=65&seed=1", "-o", folder)
            status, _, said = terrane("--quiet", "verify", folder, "--dem",
                                      "synthetic:caldera?size=65&seed=2")
            self.assertEqual(status, INPUT)
            self.assertIn("--dem", said)

    def test_verify_of_a_damaged_tile_fails_and_names_it(self):
        with tempfile.TemporaryDirectory() as folder:
            terrane("--quiet", "build", "synthetic:caldera?size=65&seed=1", "-o", folder)
            tile = next(pathlib.Path(folder).rglob("*.glb"))
            tile.write_bytes(tile.read_bytes()[:-40])
            status, _, said = terrane("--quiet", "verify", folder)
            self.assertNotEqual(status, 0)
            self.assertIn(".glb", said)


if __name__ == "__main__":
    unittest.main()
