#!/usr/bin/env python3
"""run_client.py SCRIPT ARGUMENTS...: runs SCRIPT of this folder with Node.

Ends with 77 (skipped) where Node, Chromium, the packages or the tile sets are missing.
"""

import pathlib
import shutil
import subprocess
import sys

import install

HERE = pathlib.Path(__file__).resolve().parent
SKIPPED = 77


def reason_to_skip(script, arguments):
    wanted = ["node"]
    if "withBrowser" in (HERE / script).read_text(encoding="utf-8"):
        wanted.append("chromium")
    for tool in wanted:
        if not shutil.which(tool):
            return f"{tool} is missing"
    if not install.is_installed():
        return "the packages of tests/clients/package.json are not installed"
    if not pathlib.Path(arguments[0]).is_dir():
        return f"{arguments[0]} was not built"
    return None


def main():
    script, arguments = sys.argv[1], sys.argv[2:]
    if reason := reason_to_skip(script, arguments):
        print(f"skipped: {reason}")
        return SKIPPED
    return subprocess.run(["node", HERE / script, *arguments], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
