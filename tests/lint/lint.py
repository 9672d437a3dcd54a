#!/usr/bin/env python3
"""House rules that a compiler does not know; see RULES at the end.

Usage: lint.py ROOT [RULE]...     prints "file:line: rule: what is wrong", exits 1 when there is any.
"""

import os
import re
import shutil
import subprocess
import sys

LAYERS = {
    "core": 0,
    "mesh": 1, "grid": 1, "field": 1,
    "convert": 2, "accel": 2, "intersect": 2, "normal": 2, "march": 2,
    "trace": 3,
    "render": 4,
    "measure": 5,
}
ADAPTERS = {"io": set(), "vdb": {"io"}}  # each may include every layer, and these adapters

# Headers of other people's packages, and the only files that may include them.
DOORS = [
    (r"(oneapi/)?tbb/", r"lib/levelray/core/parallel\.cpp|lib/levelray/vdb/|tests/", "TBB", "core/parallel"),
    (r"OpenMesh/", r"tests/", "OpenMesh", "tests"),
    (r"(OpenEXR/)?Imf|(OpenEXR/)?Iex|png\.h|setjmp\.h", r"lib/levelray/io/|tests/", "OpenEXR and libpng", "io/"),
    (r"nlohmann/", r"lib/levelray/io/json_parser\.cpp|apps/|tests/", "JSON", "io/json_parser.cpp, apps and tests"),
    (r"openvdb/", r"lib/levelray/vdb/|tests/", "OpenVDB", "vdb/ and tests"),
    (r"CLI/", r"apps/|tests/bench/", "CLI11", "apps and tests/bench"),
    (r"embree", r"tests/", "Embree", "tests"),
    (r"catch2/", r"tests/support/catch", "Catch2", "tests/support/catch.hpp"),
]

TOP_LEVEL = {"CMakeLists.txt", "CMakePresets.json", "README.md", "lib", "apps", "tests", "data", "scripts"}
FIXED_NAMES = {"CMakeLists.txt", "CMakePresets.json", "README.md"}
MAX_LINES = 400
CODE = (".hpp", ".cpp", ".inl")
BINARY = (".png", ".exr", ".vdb", ".ply", ".stl")

# Spelled in pieces, so that this file passes its own rules.
FORBIDDEN = re.compile(r"\b(TO" r"DO|FIX" r"ME|X" r"XX)\b|#if " r"0\b")
MACHINE_PATH = re.compile(r"(?<![\w.}\-$])/(wor" r"k|tm" r"p|hom" r"e|roo" r"t)(/|\b)")
FAST_MATH = re.compile(r"-f" r"fast-math|-O" r"fast|-funsafe" r"-math|-ffinite" r"-math|-fassociative" r"-math")
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')


def project_files(root):
    """Every file of the project, relative to root: those git knows, or without git all but builds and outputs."""
    if shutil.which("git") and os.path.exists(os.path.join(root, ".git")):
        command = ["git", "-C", root, "-c", "safe.directory=*", "ls-files", "-co", "--exclude-standard"]
        listing = subprocess.run(command, capture_output=True, text=True)
        if listing.returncode == 0:
            return sorted(f for f in listing.stdout.splitlines() if os.path.exists(os.path.join(root, f)))
    found = []
    for folder, folders, files in os.walk(root):
        relative = os.path.relpath(folder, root)
        folders[:] = [f for f in folders if not f.startswith(".") and (relative != "." or f not in ("build", "out"))]
        found += [os.path.normpath(os.path.join(relative, f)) for f in files]
    return sorted(found)


class Project:
    def __init__(self, root):
        self.root = root
        self.files = project_files(root)

    def code(self):
        return [f for f in self.files if f.endswith(CODE)]

    def text(self):
        return [f for f in self.files if not f.endswith(BINARY)]

    def lines(self, path):
        with open(os.path.join(self.root, path), encoding="utf-8", errors="replace") as file:
            return file.read().splitlines()

    def includes(self, path):
        for number, line in enumerate(self.lines(path), 1):
            match = INCLUDE.match(line)
            if match:
                yield number, match[1], match[2]


def may_include(own, other):
    if own == other:
        return True
    if own in ADAPTERS:
        return other in LAYERS or other in ADAPTERS[own]
    return other in LAYERS and LAYERS[other] < LAYERS[own]


def check_layers(project):
    """lib/levelray: a file includes its own folder and lower layers only, by full names."""
    for path in project.code():
        parts = path.split("/")
        if parts[:2] != ["lib", "levelray"]:
            continue
        own = parts[2]
        if len(parts) < 4 or own not in LAYERS.keys() | ADAPTERS.keys():
            yield path, 1, "not in a folder with a layer"
            continue
        for number, quote, name in project.includes(path):
            if name.startswith("levelray/"):
                other = name.split("/")[1]
                if not may_include(own, other):
                    yield path, number, f"{own} may not include {other}"
            elif quote == '"' and not re.fullmatch(r"[\w./]*generated[\w./]*", name):
                yield path, number, f'include "{name}" by its full name, levelray/folder/file'


def check_doors(project):
    """Each third-party package is included in one place."""
    for path in project.code():
        for number, _, name in project.includes(path):
            for header, allowed, package, place in DOORS:
                if re.match(header, name) and not re.match(allowed, path):
                    yield path, number, f"{package} is included in {place} only"


def check_length(project):
    """Files stay within 400 lines, or a comment in them says 'Above 400 lines because …'."""
    for path in project.code():
        lines = project.lines(path)
        if len(lines) > MAX_LINES and not any(re.search(r"//.*\b[Aa]bove 400 lines because \w", l) for l in lines):
            yield path, len(lines), f"{len(lines)} lines; split it, or say '// Above 400 lines because …'"


def check_words(project):
    """No left-over marks, no dead branches, no paths of somebody's machine."""
    for path in project.text():
        for number, line in enumerate(project.lines(path), 1):
            match = FORBIDDEN.search(line) or MACHINE_PATH.search(line)
            if match:
                yield path, number, f"'{match[0]}' has no place here"


def check_fast_math(project):
    """IEEE arithmetic only."""
    for path in project.text():
        for number, line in enumerate(project.lines(path), 1):
            match = FAST_MATH.search(line)
            if match and not path.endswith(".md"):
                yield path, number, f"{match[0]} breaks IEEE arithmetic"


def check_names(project):
    """Files and folders are in snake_case."""
    for path in project.files:
        for part in path.split("/"):
            if part not in FIXED_NAMES and not part.startswith(".") and not re.fullmatch(r"[a-z0-9_]+(\.[a-z0-9_]+)*", part):
                yield path, 1, f"'{part}' is not snake_case"


def check_top_level(project):
    """The top level holds what it always holds, and dot-files."""
    for name in sorted({path.split("/")[0] for path in project.files}):
        if name not in TOP_LEVEL and not name.startswith("."):
            yield name, 1, "does not belong at the top level"


def check_headers(project):
    """Headers begin with a comment and are included once."""
    for path in project.code():
        if path.endswith(".hpp"):
            lines = project.lines(path)
            if "#pragma once" not in lines:
                yield path, 1, "no #pragma once"
            if not lines or not lines[0].startswith("//"):
                yield path, 1, "a header begins with a comment that says what it is"


def check_format(project):
    """clang-format-14 has nothing to change."""
    tool = shutil.which("clang-format-14")
    if not tool:
        print("lint: formatting not checked, because clang-format-14 is not installed (scripts/setup dev)")
        return
    files = project.code()
    for begin in range(0, len(files), 64):
        command = [tool, "--dry-run", "--ferror-limit=1", "--style=file"] + files[begin:begin + 64]
        output = subprocess.run(command, cwd=project.root, capture_output=True, text=True).stderr
        for path, number in dict(re.findall(r"^(\S+?):(\d+):\d+: warning: ", output, re.M)).items():
            yield path, int(number), "not formatted; run scripts/format"


RULES = {
    "layers": check_layers,
    "doors": check_doors,
    "length": check_length,
    "words": check_words,
    "fast_math": check_fast_math,
    "names": check_names,
    "top_level": check_top_level,
    "headers": check_headers,
    "format": check_format,
}


def lint(root, rules=RULES):
    """All findings as (file, line, rule, message)."""
    project = Project(root)
    return [(path, line, rule, message) for rule in rules for path, line, message in RULES[rule](project)]


def main(arguments):
    if not arguments or any(rule not in RULES for rule in arguments[1:]):
        print(f"usage: lint.py ROOT [{'|'.join(RULES)}]...", file=sys.stderr)
        return 2
    findings = lint(arguments[0], arguments[1:] or RULES)
    for path, line, rule, message in findings:
        print(f"{path}:{line}: {rule}: {message}")
    print(f"lint: {len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
