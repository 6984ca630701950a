"""Runs the program under test."""

import os
import pathlib
import subprocess

TERRANE = os.environ["TERRANE"]
DATA = pathlib.Path(os.environ["TERRANE_TEST_DATA"])
SKIPPED = 77


def terrane(*arguments, **options):
    """Runs `terrane ARGUMENTS`; gives its exit status, standard output and standard error."""
    done = subprocess.run([TERRANE, *map(str, arguments)], capture_output=True, text=True,
                          check=False, **options)
    return done.returncode, done.stdout, done.stderr


def bytes_below(folder):
    """Every file below a folder with its bytes."""
    return {str(file.relative_to(folder)): file.read_bytes()
            for file in sorted(pathlib.Path(folder).rglob("*")) if file.is_file()}
