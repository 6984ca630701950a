#!/usr/bin/env python3
"""Holds the source tree to its layout: who may include whom, and what files look like.

Run by ctest, or by hand: python3 tests/layout_test.py
"""

import pathlib
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent

# A file belongs to the longest of these folders that it lies in.
MAY_INCLUDE = {
    "core": set(),
    "core/deflate": set(),
    "ingest": {"core"},
    "hierarchy": {"core"},
    "model": {"core", "ingest", "hierarchy"},
    "tiler": {"core", "core/deflate", "hierarchy"},
    "tiler/verify": {"core"},  # the judge shares nothing with the builder
    "archive": {"core", "core/deflate"},
    "tiler/welded": {"core", "tiler/verify"},  # reads tiles, builds none
    "viewer": {"core", "core/deflate", "tiler", "archive"},
    "viewer/engine": {"core", "hierarchy"},
    "cli": {"core", "archive", "ingest", "hierarchy", "model", "tiler", "tiler/verify",
            "tiler/welded", "viewer"},
}
SOURCES = ("*.h", "*.cpp")
OTHER_CODE = ("*.ts", "*.mjs", "*.py", "*.cmake", "CMakeLists.txt")
NOT_OURS = {"node_modules", "build", "dist", "demo", ".git"}

INCLUDE = re.compile(r'\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')
# Standard C++ headers have neither '.' nor '/'. These are C's and the system's.
SYSTEM_HEADER = re.compile(
    r"(sys|netinet|arpa)/\w+\.h|(malloc|stdlib|unistd|fcntl|signal|errno|termios|poll)\.h")
VAGUE_WORDS = {"util", "utils", "helper", "helpers", "common", "misc", "manager"}
MOST_LINES = 600


def files(root, patterns, folders=("",)):
    for folder in folders:
        for pattern in patterns:
            for path in sorted((root / folder).rglob(pattern)):
                if not NOT_OURS & set(path.relative_to(root).parts):
                    yield path


def module_of(relative_path):
    """The module that a path (relative to the root) lies in, or None."""
    text = relative_path if isinstance(relative_path, str) else relative_path.as_posix()
    inside = [module for module in MAY_INCLUDE if text.startswith(module + "/")]
    return max(inside, key=len, default=None)


def includes(path):
    """Yields (line number, quoted path or None, angled path or None)."""
    for number, text in enumerate(path.read_text().splitlines(), 1):
        if match := INCLUDE.match(text):
            yield number, match[1], match[2]


def is_third_party(angled):
    is_standard = not re.search(r"[./]", angled)
    return not (is_standard or angled.startswith("Eigen/") or SYSTEM_HEADER.fullmatch(angled))


def top_folders(root):
    return [module for module in MAY_INCLUDE if "/" not in module and (root / module).is_dir()]


def modules_that_include_what_they_may_not(root):
    for path in files(root, SOURCES, top_folders(root)):
        relative = path.relative_to(root)
        module = module_of(relative)
        for line, quoted, _ in includes(path):
            if quoted is None:
                continue
            wanted = module_of(quoted)
            if wanted is None or not (root / quoted).exists():
                yield f"{relative}:{line}: {quoted} is no file of a module"
            elif wanted != module and wanted not in MAY_INCLUDE[module]:
                yield f"{relative}:{line}: {module} may not include {wanted}"


def installed_headers(root):
    """Headers that a CMakeLists.txt names after HEADERS, relative to the root."""
    for path in files(root, ("CMakeLists.txt",), top_folders(root)):
        block = re.search(r"\bHEADERS\b(.*?)(?:\bPUBLIC\b|\bPRIVATE\b|\bSOURCES\b|\))",
                          path.read_text(), re.S)
        for name in block[1].split() if block else ():
            yield (path.parent / name).relative_to(root)
    for path in files(root, ("*.h",), ["core"]):
        yield path.relative_to(root)


def installed_headers_that_need_more_than_is_installed(root):
    installed = set(installed_headers(root))
    for relative in sorted(installed):
        if not (root / relative).exists():
            yield f"{relative}: named in HEADERS, but not there"
            continue
        for line, quoted, angled in includes(root / relative):
            if quoted and pathlib.Path(quoted) not in installed:
                yield f"{relative}:{line}: installed, but {quoted} is not"
            if angled and is_third_party(angled):
                yield f"{relative}:{line}: installed, but <{angled}> is no header of ours"


def third_party_headers_that_leave_their_folder(root):
    """A header that includes a library's may be included by its own module only."""
    tainted = {}
    for path in files(root, ("*.h",), top_folders(root)):
        for _, _, angled in includes(path):
            if angled and is_third_party(angled):
                tainted[path.relative_to(root).as_posix()] = angled
    for path in files(root, SOURCES, top_folders(root)):
        relative = path.relative_to(root)
        for line, quoted, _ in includes(path):
            if quoted in tainted and module_of(quoted) != module_of(relative):
                yield f"{relative}:{line}: {quoted} brings <{tainted[quoted]}> along"


def vague_names(root):
    for path in files(root, SOURCES + OTHER_CODE):
        relative = path.relative_to(root)
        words = re.split(r"[/_.\-]", relative.as_posix().lower())
        if vague := VAGUE_WORDS & set(words):
            yield f"{relative}: '{vague.pop()}' does not say what is in it"


def files_that_are_too_long(root):
    for path in files(root, SOURCES + OTHER_CODE):
        lines = len(path.read_text().splitlines())
        if lines > MOST_LINES:
            yield f"{path.relative_to(root)}: {lines} lines, more than {MOST_LINES}"


class ThisProject(unittest.TestCase):
    def holds(self, rule):
        self.assertEqual("", "\n".join(rule(ROOT)))

    def test_modules_include_only_what_they_may(self):
        self.holds(modules_that_include_what_they_may_not)

    def test_installed_headers_need_only_installed_headers(self):
        self.holds(installed_headers_that_need_more_than_is_installed)

    def test_third_party_headers_stay_in_their_module(self):
        self.holds(third_party_headers_that_leave_their_folder)

    def test_names_say_what_is_in_a_file(self):
        self.holds(vague_names)

    def test_no_file_is_too_long(self):
        self.holds(files_that_are_too_long)

    def test_there_is_something_to_check(self):
        self.assertGreater(len(list(files(ROOT, SOURCES, top_folders(ROOT)))), 20)
        self.assertGreater(len(list(installed_headers(ROOT))), 10)


class Rules(unittest.TestCase):
    """Each rule finds what it forbids in a tree made for it."""

    def broken(self, rule, tree):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            for name, text in tree.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return list(rule(root))

    def include(self, includer, included):
        tree = {included: "", includer: f'#include "{included}"\n'}
        return self.broken(modules_that_include_what_they_may_not, tree)

    def test_core_may_include_nobody(self):
        self.assertEqual(self.include("core/a.h", "ingest/b.h"),
                         ["core/a.h:1: core may not include ingest"])

    def test_ingest_and_hierarchy_do_not_know_each_other(self):
        self.assertTrue(self.include("ingest/a.cpp", "hierarchy/mesh/b.h"))
        self.assertTrue(self.include("hierarchy/a.cpp", "ingest/b.h"))

    def test_verify_knows_neither_tiler_nor_hierarchy(self):
        self.assertTrue(self.include("tiler/verify/a.cpp", "tiler/b.h"))
        self.assertTrue(self.include("tiler/verify/a.cpp", "hierarchy/b.h"))
        self.assertEqual(self.include("tiler/verify/a.cpp", "tiler/verify/b.h"), [])

    def test_only_cli_knows_verify(self):
        self.assertTrue(self.include("tiler/a.cpp", "tiler/verify/b.h"))
        self.assertTrue(self.include("viewer/a.cpp", "tiler/verify/b.h"))
        self.assertEqual(self.include("cli/a.cpp", "tiler/verify/b.h"), [])

    def test_allowed_includes_pass(self):
        self.assertEqual(self.include("tiler/a.cpp", "hierarchy/b.h"), [])
        self.assertEqual(self.include("ingest/x/a.cpp", "ingest/x/b.h"), [])

    def test_a_quoted_include_is_a_file_of_the_project(self):
        tree = {"core/a.h": '#include "gdal_priv.h"\n'}
        self.assertTrue(self.broken(modules_that_include_what_they_may_not, tree))

    def test_installed_headers_hold_no_third_party_header(self):
        cmake = "terrane_add_module(ingest\n  SOURCES a.cpp b.h\n  HEADERS a.h\n  PUBLIC x)\n"
        for header, is_good in [("<gdal.h>", False), ("<fmt/format.h>", False),
                                ('"ingest/b.h"', False), ("<vector>", True),
                                ("<Eigen/Core>", True)]:
            tree = {"ingest/CMakeLists.txt": cmake, "ingest/b.h": "",
                    "ingest/a.h": f"#include {header}\n"}
            broken = self.broken(installed_headers_that_need_more_than_is_installed, tree)
            self.assertEqual(broken == [], is_good, header)

    def test_a_header_with_a_third_party_header_stays_at_home(self):
        tree = {"ingest/gdal.h": "#include <gdal.h>\n",
                "ingest/a.cpp": '#include "ingest/gdal.h"\n'}
        rule = third_party_headers_that_leave_their_folder
        self.assertEqual(self.broken(rule, tree), [])
        tree["cli/a.cpp"] = '#include "ingest/gdal.h"\n'
        self.assertEqual(self.broken(rule, tree), ["cli/a.cpp:1: ingest/gdal.h brings <gdal.h> along"])

    def test_vague_names_are_found(self):
        for name in ("core/util.h", "tiler/tile_helpers.cpp", "core/common/a.h",
                     "viewer/web/src/manager.ts"):
            self.assertTrue(self.broken(vague_names, {name: ""}), name)
        self.assertEqual(self.broken(vague_names, {"core/utility_pole.h": ""}), [])

    def test_long_files_are_found(self):
        rule = files_that_are_too_long
        self.assertEqual(self.broken(rule, {"core/a.h": "\n" * 600}), [])
        self.assertTrue(self.broken(rule, {"core/a.h": "\n" * 601}))


if __name__ == "__main__":
    unittest.main()
