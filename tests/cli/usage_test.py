#!/usr/bin/env python3
"""What the program says of itself, and where it says it."""

import pathlib
import re
import tempfile
import unittest

from program import terrane

DEM = "synthetic:caldera?size=65&seed=1"


class Usage(unittest.TestCase):
    def test_version(self):
        status, printed, _ = terrane("--version")
        self.assertEqual(status, 0)
        self.assertRegex(printed, r"^terrane \d+\.\d+\.\d+\n$")

    def test_help_of_every_subcommand_tells_units_and_defaults(self):
        for command in ("build", "simplify", "levels", "info", "verify", "serve", "pack", "unpack",
                        "export",
                        "volume"):
            status, printed, _ = terrane(command, "--help")
            self.assertEqual(status, 0)
            self.assertIn("--", printed)
        _, printed, _ = terrane("build", "--help")
        self.assertRegex(re.sub(r"\s+", " ", printed), r"--tolerance.*in metres.*\[1\]")

    def test_help_documents_the_exit_status(self):
        self.assertIn("Exit status", terrane("--help")[1])

    def test_no_arguments_is_a_usage_error(self):
        self.assertEqual(terrane()[0], 2)
        self.assertEqual(terrane("build", DEM)[0], 2)
        self.assertEqual(terrane("build", DEM, "-o", "x", "--tolerance", "much")[0], 2)

    def test_results_go_to_stdout_progress_to_stderr_and_quiet_silences_it(self):
        with tempfile.TemporaryDirectory() as folder:
            status, printed, said = terrane("build", DEM, "-o", folder)
            self.assertEqual(status, 0)
            self.assertEqual(len(printed.splitlines()), 1)
            self.assertIn("level 0", said)
            status, printed, said = terrane("--quiet", "build", DEM, "-o", folder)
            self.assertIn("up to date", printed)
            self.assertEqual(said, "")

    def test_info_describes_a_dem_and_an_output(self):
        status, printed, _ = terrane("info", DEM)
        self.assertEqual(status, 0)
        self.assertIn("65 x 65", printed)
        with tempfile.TemporaryDirectory() as folder:
            terrane("--quiet", "build", DEM, "-o", folder)
            status, printed, _ = terrane("info", folder)
            self.assertEqual(status, 0)
            self.assertIn("tolerance m", printed)
            self.assertRegex(printed, r"(?m)^  all +\d+ +\d+ +\d+\.\d+$")
            (pathlib.Path(folder) / "terrane.json").unlink()
            (pathlib.Path(folder) / ".work").mkdir()
            (pathlib.Path(folder) / ".work/key").write_text("key")
            status, _, said = terrane("info", folder)
            self.assertEqual(status, 3)
            self.assertIn("not finished", said)

    def test_verify_prints_a_table_and_holds(self):
        with tempfile.TemporaryDirectory() as folder:
            terrane("--quiet", "build", DEM, "-o", folder)
            status, printed, _ = terrane("--quiet", "verify", folder)
            self.assertEqual(status, 0, printed)
            self.assertIn("max_error_m", printed)


if __name__ == "__main__":
    unittest.main()
