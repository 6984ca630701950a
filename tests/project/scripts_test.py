#!/usr/bin/env python3
"""Runs the scripts as a user would, with the slow and far-reaching tools replaced by recorders."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

RECORDER = """#!/bin/sh
echo "$(basename "$0") $*" >> "$RECORD"
"""


class Script(unittest.TestCase):
    """A copy of scripts/ in a folder of its own; stand_in() replaces a command on PATH."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        shutil.copytree(ROOT / "scripts", self.root / "checkout/scripts")
        self.checkout = self.root / "checkout"
        self.tools = self.root / "tools"
        self.tools.mkdir()
        self.record = self.root / "record"
        self.record.touch()

    def stand_in(self, command, text=RECORDER, folder=None):
        path = (folder or self.tools) / command
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)

    def run_script(self, name, *arguments, cwd=None):
        environment = dict(os.environ, RECORD=str(self.record),
                           PATH=f"{self.tools}:{os.environ['PATH']}")
        return subprocess.run(["bash", self.checkout / "scripts" / name, *arguments],
                              env=environment, cwd=cwd or self.root, text=True,
                              capture_output=True, timeout=100)

    def recorded(self):
        return self.record.read_text().splitlines()


class Setup(Script):
    def packages_installed(self, *, but=()):
        listed = "".join(f"{name} not-installed\\n" for name in but)
        self.stand_in("dpkg-query", f"""#!/bin/sh
shift 3
for name; do
  case " {' '.join(but)} " in *" $name "*) ;; *) echo "$name:amd64 installed" ;; esac
done
printf '{listed}'
""")
        for command in ("apt-get", "sudo", "env", "node", "npm"):
            self.stand_in(command)

    def test_is_silent_and_quick_when_nothing_is_missing(self):
        self.packages_installed()
        begin = time.monotonic()
        done = self.run_script("setup")
        self.assertLess(time.monotonic() - begin, 1)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        self.assertEqual(self.recorded(), [])

    def test_installs_what_is_missing_and_nothing_else(self):
        self.packages_installed(but=["ninja-build", "libgdal-dev"])
        done = self.run_script("setup")
        self.assertEqual(done.returncode, 0, done.stderr)
        installs = [line for line in self.recorded() if " install " in line]
        self.assertEqual(len(installs), 1)
        self.assertTrue(installs[0].endswith("libgdal-dev ninja-build"), installs)

    def test_installs_what_only_the_peers_need_when_asked(self):
        self.packages_installed(but=["libcgal-dev"])
        self.run_script("setup")
        self.assertEqual(self.recorded(), [])
        self.run_script("setup", "--peers")
        self.assertTrue(any("install" in line and "libcgal-dev" in line
                            for line in self.recorded()))

    def test_installs_servers_only_when_asked(self):
        self.packages_installed(but=["nginx-light", "wrk"])
        self.run_script("setup")
        self.assertEqual(self.recorded(), [])
        self.run_script("setup", "--servers")
        self.assertTrue(any("install" in line and "nginx-light wrk" in line
                            for line in self.recorded()))

    def test_says_which_step_failed(self):
        self.packages_installed(but=["ninja-build"])
        self.stand_in("apt-get", "#!/bin/sh\nexit 100\n")
        self.stand_in("sudo", '#!/bin/sh\nexec "$@"\n')
        done = self.run_script("setup")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("apt-get update failed", done.stderr)


class Demo(Script):
    def setUp(self):
        super().setUp()
        self.stand_in("setup", folder=self.checkout / "scripts")
        self.stand_in("cmake")
        self.program = self.checkout / "build/release/bin"
        self.stand_in("terrane", folder=self.program)

    def terrane_calls(self):
        return [line for line in self.recorded() if line.startswith("terrane ")]

    def test_tiles_and_serves_trinidad_in_feet(self):
        done = self.run_script("demo")
        self.assertEqual(done.returncode, 0, done.stderr)
        out = self.checkout / "demo/trinidad"
        self.assertEqual(self.terrane_calls(), [
            "terrane build NETCDF:/usr/share/ncarg/data/cdf/trinidad.nc:data "
            f"-o {out} --crs EPSG:4326 --vertical-unit foot",
            f"terrane serve {out}"])

    def test_takes_the_file_of_a_user_who_is_elsewhere_and_their_options(self):
        (self.root / "my dem.tif").touch()
        done = self.run_script("demo", "my dem.tif", "--tolerance", "5")
        self.assertEqual(done.returncode, 0, done.stderr)
        out = self.checkout / "demo/my_dem"
        self.assertEqual(self.terrane_calls(), [
            f"terrane build {self.root}/my dem.tif -o {out} --tolerance 5",
            f"terrane serve {out}"])

    def test_stops_where_tiling_fails(self):
        self.stand_in("terrane", f"{RECORDER}exit 3\n", folder=self.program)
        done = self.run_script("demo", "none.tif")
        self.assertEqual(done.returncode, 3)
        self.assertIn("failed at: tiling of none.tif", done.stderr)
        self.assertEqual(len(self.terrane_calls()), 1)

    def test_says_where_the_log_of_a_failed_build_is(self):
        self.stand_in("cmake", "#!/bin/sh\nexit 1\n")
        done = self.run_script("demo")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("build/demo.log", done.stderr)
        self.assertEqual(self.terrane_calls(), [])

    def test_help_touches_nothing(self):
        done = self.run_script("demo", "--help")
        self.assertIn("scripts/demo [DEM", done.stdout)
        self.assertEqual(self.recorded(), [])


if __name__ == "__main__":
    unittest.main()
