#!/usr/bin/env python3
"""What terrane packs, read by others: the npm packages `pmtiles` and `3d-tiles-tools`.

Ends with 77 (skipped) where Node or the packages are missing.
"""

import fcntl
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
TERRANE = os.environ["TERRANE"]
DEM = "synthetic:caldera?size=257&seed=1"
SKIPPED = 77


def packages_are_there():
    lock, mark = HERE / "package-lock.json", HERE / "node_modules/.terrane-installed"
    # build folders share node_modules
    with open(HERE / "package.json", encoding="utf-8") as turn:
        fcntl.flock(turn, fcntl.LOCK_EX)
        if mark.exists() and mark.stat().st_mtime >= lock.stat().st_mtime:
            return True
        if not shutil.which("npm") or not shutil.which("node"):
            return False
        # scripts of packages are for pictures and Draco, which no archive needs
        done = subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund",
                               "--loglevel=error"], cwd=HERE, check=False)
        if done.returncode == 0:
            mark.touch()
        return done.returncode == 0


def terrane(*arguments):
    subprocess.run([TERRANE, "--quiet", *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def tools(*arguments):
    subprocess.run(["node", HERE / "node_modules/3d-tiles-tools/build/src/cli.mjs", *map(str, arguments)],
                   check=True, stdout=subprocess.DEVNULL)


def tile_set_below(folder):
    """tileset.json, terrane.json and tiles; the viewer and build.toml are no part of it."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*")
            if file.is_file() and file.suffix in (".glb", ".json")}


class Readers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.out = cls.folder / "out"
        terrane("build", DEM, "-o", cls.out)
        for name in ("x.pmtiles", "x.3tz"):
            terrane("pack", cls.out, "-o", cls.folder / name)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_pmtiles_reads_every_tile_by_range_requests(self):
        server = subprocess.Popen([TERRANE, "--quiet", "serve", self.folder / "x.pmtiles", "--port",
                                   "0"], stdout=subprocess.PIPE, text=True)
        try:
            url = re.match(r"http://\S+", server.stdout.readline())[0]
            subprocess.run(["node", HERE / "read_pmtiles.mjs", url + "x.pmtiles", self.out],
                           check=True, timeout=100)
        finally:
            server.send_signal(signal.SIGTERM)
            server.wait(timeout=20)
            server.stdout.close()

    def test_3d_tiles_tools_unpacks_our_3tz(self):
        tools("convert", "-f", "-i", self.folder / "x.3tz", "-o", self.folder / "theirs")
        self.assertEqual(tile_set_below(self.folder / "theirs"), tile_set_below(self.out))

    def test_we_unpack_the_3tz_of_3d_tiles_tools(self):
        tools("convert", "-f", "-i", self.out, "-o", self.folder / "theirs.3tz")
        terrane("unpack", self.folder / "theirs.3tz", "-o", self.folder / "ours")
        self.assertEqual(tile_set_below(self.folder / "ours"), tile_set_below(self.out))
        terrane("verify", self.folder / "theirs.3tz")


if __name__ == "__main__":
    if not packages_are_there():
        print("skipped: Node, npm or the packages of tests/archive/readers are missing")
        sys.exit(SKIPPED)
    unittest.main()
