"""Runs the program under test."""

import os
import pathlib
import random
import subprocess
import time

TERRANE = os.environ["TERRANE"]
DATA = pathlib.Path(os.environ["TERRANE_TEST_DATA"])
SKIPPED = 77


def terrane(*arguments, **options):
    """Runs `terrane ARGUMENTS`; gives its exit status, standard output and standard error."""
    done = subprocess.run([TERRANE, *map(str, arguments)], capture_output=True, text=True,
                          check=False, **options)
    return done.returncode, done.stdout, done.stderr


def finish_after_kills(arguments, duration_s, kills=3):
    """Runs `terrane ARGUMENTS`, killed that many times somewhere within the time that it takes, and then
    to its end. Gives what terrane() gives."""
    chance = random.Random(4)
    for _ in range(kills):
        process = subprocess.Popen([TERRANE, *map(str, arguments)], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        time.sleep(chance.uniform(0.2, 0.8) * duration_s)
        process.kill()
        process.wait()
    return terrane(*arguments)


def bytes_below(folder):
    """Every file below a folder with its bytes."""
    return {str(file.relative_to(folder)): file.read_bytes()
            for file in sorted(pathlib.Path(folder).rglob("*")) if file.is_file()}
