#!/usr/bin/env python3
"""Fetches the packages of package-lock.json into node_modules, once. Ends with 77 where it cannot."""

import fcntl
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
INSTALLED = HERE / "node_modules/.terrane-installed"
SKIPPED = 77


def is_installed():
    lock = HERE / "package-lock.json"
    return INSTALLED.exists() and INSTALLED.stat().st_mtime >= lock.stat().st_mtime


def main():
    if is_installed():
        return 0
    if not shutil.which("npm"):
        print("skipped: npm is missing")
        return SKIPPED
    # build folders share node_modules
    with open(HERE / "package.json", encoding="utf-8") as turn:
        fcntl.flock(turn, fcntl.LOCK_EX)
        if is_installed():
            return 0
        done = subprocess.run(["npm", "ci", "--no-audit", "--no-fund", "--loglevel=error"],
                              cwd=HERE, check=False)
        if done.returncode != 0:
            print("skipped: npm cannot fetch the packages of tests/clients/package.json")
            return SKIPPED
        INSTALLED.touch()
    return 0


if __name__ == "__main__":
    sys.exit(main())
