#!/usr/bin/env python3
"""terrane pack and unpack, and what reads archives. Python's own zipfile and hashlib judge the 3tz."""

import hashlib
import http.client
import pathlib
import re
import signal
import struct
import subprocess
import tempfile
import unittest
import zipfile

from export_test import read_ply
from program import TERRANE, bytes_below, terrane

DEM = "synthetic:caldera?size=193&seed=1"
INDEX = "@3dtilesIndex1@"
USAGE, INPUT, OUTPUT = 2, 3, 5


def tiles_below(folder):
    return {name: content for name, content in bytes_below(folder).items() if name.endswith(".glb")}


class Archives(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.out = cls.folder / "out"
        assert terrane("--quiet", "build", DEM, "-o", cls.out)[0] == 0
        for name in ("x.pmtiles", "x.3tz"):
            status, printed, said = terrane("--quiet", "pack", cls.out, "-o", cls.folder / name)
            assert status == 0 and len(printed.splitlines()) == 1, said

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def refuse(self, status, word, *arguments):
        got, printed, said = terrane("--quiet", *arguments)
        self.assertEqual(got, status, said)
        self.assertEqual(printed, "")
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        self.assertIn(word, said)

    def test_a_3tz_is_a_zip_with_the_same_tiles(self):
        with zipfile.ZipFile(self.folder / "x.3tz") as archive:
            self.assertIsNone(archive.testzip())
            names = archive.namelist()
            tiles = {name: archive.read(name) for name in names if name.endswith(".glb")}
            self.assertEqual(tiles, tiles_below(self.out))
            self.assertEqual(archive.read("tileset.json"), (self.out / "tileset.json").read_bytes())
            self.assertNotIn("index.html", names)
            self.assertTrue(all(archive.getinfo(name).compress_type == zipfile.ZIP_STORED
                                for name in tiles))

    def test_the_index_of_a_3tz_leads_to_every_file(self):
        whole = (self.folder / "x.3tz").read_bytes()
        with zipfile.ZipFile(self.folder / "x.3tz") as archive:
            names = archive.namelist()
            self.assertEqual(names[-1], INDEX)
            index = archive.read(INDEX)
        lines = [struct.unpack_from("<QQQ", index, at) for at in range(0, len(index), 24)]
        self.assertEqual(lines, sorted(lines, key=lambda line: line[:2]))
        offsets = {index[at:at + 16]: struct.unpack_from("<Q", index, at + 16)[0]
                   for at in range(0, len(index), 24)}
        self.assertEqual(len(offsets), len(names) - 1)
        for name in names[:-1]:
            at = offsets[hashlib.md5(name.encode()).digest()]
            self.assertEqual(whole[at:at + 4], b"PK\3\4")
            length = struct.unpack_from("<H", whole, at + 26)[0]
            self.assertEqual(whole[at + 30:at + 30 + length].decode(), name)

    def test_unpacking_gives_the_tiles_and_the_same_archive_again(self):
        for name in ("x.pmtiles", "x.3tz"):
            unpacked = self.folder / f"unpacked {name}" / "out"
            self.assertEqual(terrane("--quiet", "unpack", self.folder / name, "-o", unpacked)[0], 0)
            self.assertEqual(tiles_below(unpacked), tiles_below(self.out))
            again = self.folder / f"again {name}"
            terrane("--quiet", "pack", unpacked, "-o", again)
            self.assertTrue(again.read_bytes() == (self.folder / name).read_bytes(), name)
        self.refuse(OUTPUT, "empty folder", "unpack", self.folder / "x.3tz", "-o", self.out)

    def test_info_and_verify_read_archives(self):
        for name in ("x.pmtiles", "x.3tz"):
            status, printed, _ = terrane("info", self.folder / name)
            self.assertEqual(status, 0)
            self.assertIn("tolerance m", printed)
            self.assertIn("193 x 193", printed)
            self.assertEqual("tiles/{l}/{x}/{y}.glb, zooms 0 to 2, clustered" in printed,
                             name == "x.pmtiles")
            status, printed, said = terrane("--quiet", "verify", self.folder / name)
            self.assertEqual(status, 0, printed + said)
            self.assertIn("All invariants hold", printed)

    def test_verify_of_an_archive_with_a_spoiled_tile_says_no_and_names_it(self):
        # the last byte of the first tile in the file: inside its glb, outside every directory
        whole = bytearray((self.folder / "x.pmtiles").read_bytes())
        tiles_at, = struct.unpack_from("<Q", whole, 56)
        whole[tiles_at + 200] ^= 0xff
        spoiled = self.folder / "spoiled.pmtiles"
        spoiled.write_bytes(whole)
        status, printed, said = terrane("--quiet", "verify", spoiled)
        self.assertNotEqual(status, 0)
        self.assertIn("spoiled.pmtiles/tiles/", printed + said)

    def test_bad_archives_get_one_clear_line(self):
        cut = self.folder / "cut.pmtiles"
        cut.write_bytes((self.folder / "x.pmtiles").read_bytes()[:-1])
        cut_zip = self.folder / "cut.3tz"
        cut_zip.write_bytes((self.folder / "x.3tz").read_bytes()[:-1])
        letter = self.folder / "letter.pmtiles"
        letter.write_text("Dear Sir or Madam")
        for file in (cut, cut_zip, letter, self.folder / "none.3tz"):
            for arguments in (("info", file), ("verify", file), ("serve", file, "--port", "0"),
                              ("unpack", file, "-o", self.folder / "never"),
                              ("export", file, "-o", self.folder / "never.ply")):
                self.refuse(INPUT, file.name, *arguments)
        self.assertFalse((self.folder / "never").exists())
        self.refuse(USAGE, ".pmtiles or .3tz", "pack", self.out, "-o", self.folder / "x.zip")
        (self.folder / "empty").mkdir()
        self.refuse(INPUT, "no tile set", "pack", self.folder / "empty", "-o",
                    self.folder / "y.3tz")

    def test_serve_sends_an_archive_and_a_folder_side_by_side(self):
        server = subprocess.Popen([TERRANE, "serve", self.out, self.folder / "x.pmtiles",
                                   "--port", "0"], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True)
        try:
            port = int(re.search(r":(\d+)/", server.stdout.readline())[1])
            addresses = [server.stdout.readline().strip() for _ in range(2)]
            self.assertEqual(addresses, [f"http://127.0.0.1:{port}/out/",
                                         f"http://127.0.0.1:{port}/x/"])
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
            bodies = []
            for path in ("/out/tiles/0/0/0.glb", "/x/tiles/0/0/0.glb", "/"):
                connection.request("GET", path)
                bodies.append(connection.getresponse().read())
            connection.close()
            self.assertEqual(bodies[0], (self.out / "tiles/0/0/0.glb").read_bytes())
            self.assertEqual(bodies[0], bodies[1])
            self.assertIn(b"/x/x.pmtiles", bodies[2])
            self.refuse(OUTPUT, f"127.0.0.1:{port}", "serve", self.out, "--port", port)
        finally:
            server.send_signal(signal.SIGINT)
            self.assertEqual(server.wait(timeout=20), 0)
            server.stdout.close()
            server.stderr.close()


class EveryTiling(unittest.TestCase):
    """However the tiles are written and listed, an archive holds them, and they are the same mesh."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.plain = cls.mesh_of(cls.build("plain"))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def build(cls, name, *options):
        status, _, said = terrane("--quiet", "build", DEM, "-o", cls.folder / name, *options)
        assert status == 0, said
        return cls.folder / name

    @classmethod
    def mesh_of(cls, out):
        status, _, said = terrane("--quiet", "export", out, "-o", cls.folder / "mesh.ply")
        assert status == 0, said
        points, triangles = read_ply(cls.folder / "mesh.ply")
        # tiles may list their triangles in another order, and begin at another corner
        return sorted(min((points[a], points[b], points[c]), (points[b], points[c], points[a]),
                          (points[c], points[a], points[b])) for a, b, c in triangles)

    def check(self, name, *options):
        out = self.build(name, *options)
        for extension in ("pmtiles", "3tz"):
            archive = self.folder / f"{name}.{extension}"
            self.assertEqual(terrane("--quiet", "pack", out, "-o", archive)[0], 0)
            unpacked = self.folder / f"{name} {extension}"
            terrane("--quiet", "unpack", archive, "-o", unpacked)
            self.assertEqual(tiles_below(unpacked), tiles_below(out))
            status, printed, said = terrane("--quiet", "verify", archive)
            self.assertEqual(status, 0, printed + said)
            self.assertTrue(self.mesh_of(archive) == self.plain)

    def test_implicit(self):
        self.check("implicit", "--implicit")

    def test_split_into_external_tilesets(self):
        self.check("split", "--tileset-tiles", 3)

    def test_uncompressed_with_skirts(self):
        self.check("skirts", "--skirts", "auto", "--compression", "none")


if __name__ == "__main__":
    unittest.main()
