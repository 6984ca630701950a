#!/usr/bin/env python3
"""The same input gives the same bytes: with any number of threads, killed on the way or not."""

import pathlib
import random
import subprocess
import tempfile
import time
import unittest

from program import TERRANE, bytes_below, terrane

BUILD = ["--quiet", "build", "synthetic:caldera?size=321&seed=4&holes=3", "--tolerance", "2",
         "--tile-cells", "32"]


class SameBytes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def build(self, name, *more):
        status, _, said = terrane(*BUILD, "-o", self.folder / name, *more)
        self.assertEqual(status, 0, said)
        return bytes_below(self.folder / name)

    def test_with_one_thread_and_with_two(self):
        self.assertEqual(self.build("one", "--jobs", "1"), self.build("two", "--jobs", "2"))

    def test_of_builds_that_were_killed(self):
        started = time.monotonic()
        whole = self.build("whole")
        duration_s = time.monotonic() - started
        random.seed(7)
        for attempt in range(4):
            out = self.folder / f"killed{attempt}"
            kills = 0
            for _ in range(5):
                process = subprocess.Popen([TERRANE, *BUILD, "-o", out],
                                           stdout=subprocess.DEVNULL)
                time.sleep(random.uniform(0.05, 0.6) * duration_s)
                process.kill()
                kills += process.wait() != 0
                half_written = [file for file in bytes_below(out) if file.endswith(".glb")
                                and bytes_below(out)[file] != whole[file]]
                self.assertEqual(half_written, [])
            self.assertEqual(self.build(f"killed{attempt}"), whole)
            self.assertGreater(kills, 0)

    def test_of_a_build_from_the_settings_that_were_written(self):
        first = self.build("first", "--effort", "2")
        status, _, said = terrane("--quiet", "build", "--config",
                                  self.folder / "first" / "build.toml", "-o",
                                  self.folder / "again")
        self.assertEqual(status, 0, said)
        self.assertEqual(bytes_below(self.folder / "again"), first)


if __name__ == "__main__":
    unittest.main()
