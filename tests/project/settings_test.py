#!/usr/bin/env python3
"""Builds with each example of config/, its DEM replaced by a small synthetic one.

The examples must hold known keys only, and values that the program takes; what the file says must
be what the output states.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DEM = 'dem = ["synthetic:caldera?size=65&seed=1"]'
TERRANE = None


class ExampleSettings(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def build(self, text):
        text, replaced = re.subn(r"(?m)^dem = .*$", DEM, text)
        self.assertEqual(replaced, 1)
        # what only a file on disk can have
        text = re.sub(r"(?m)^(crs|band|nodata|vertical_unit) = .*$", r"# \g<0>", text)
        settings = self.folder / "settings.toml"
        settings.write_text(text)
        return subprocess.run([TERRANE, "build", "--config", settings, "-o", self.folder / "out"],
                              capture_output=True, text=True)

    def test_every_example_builds_with_the_tolerance_it_states(self):
        examples = sorted((ROOT / "config").glob("*.toml"))
        self.assertGreaterEqual(len(examples), 2)
        for example in examples:
            with self.subTest(example.name):
                done = self.build(example.read_text())
                self.assertEqual(done.returncode, 0, done.stderr)
                stated = json.loads((self.folder / "out/terrane.json").read_text())
                wanted = tomllib.loads(example.read_text())["build"]["tolerance_m"]
                self.assertEqual(stated["levels"][0]["tolerance_m"], wanted)

    def test_an_unknown_key_is_refused(self):
        done = self.build(f"[ingest]\n{DEM}\n[build]\ntolerance = 1\n")
        self.assertEqual(done.returncode, 2)
        self.assertIn("settings.toml:4", done.stderr)


if __name__ == "__main__":
    TERRANE = sys.argv.pop(1)
    unittest.main()
