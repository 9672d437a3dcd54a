#!/usr/bin/env python3
"""Each rule of lint.py finds what it is for, and leaves a clean project alone."""

import os
import shutil
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lint  # noqa: E402

HEADER = "// What it is.\n#pragma once\n"
CLEAN = {
    "CMakeLists.txt": "add_compile_options(-Wall)\n",
    "README.md": "levelray\n",
    ".clang-format": "BasedOnStyle: LLVM\n",
    "lib/levelray/core/vec.hpp": HEADER,
    "lib/levelray/core/parallel.cpp": "#include <tbb/parallel_for.h>\n",
    "lib/levelray/grid/cell.hpp": HEADER + '\n#include "levelray/core/vec.hpp"\n#include "levelray/grid/coords.hpp"\n',
    "lib/levelray/vdb/write.cpp": '#include "levelray/io/output_file.hpp"\n#include <openvdb/openvdb.h>\n',
    "lib/levelray/trace/long.cpp": "// Above 400 lines because it is a table.\n" + "// row\n" * 500,
    "tests/unit/cell.cpp": '#include "support/catch.hpp"\nconst char *path = "XXXXXX";\n',
    "scripts/demo": "cd ${1}/tmp\n",
}

# rule -> files that must make it fail, with the line it must name
BROKEN = {
    "layers": [
        ("lib/levelray/core/a.hpp", HEADER + '#include "levelray/grid/cell.hpp"\n', 3),
        ("lib/levelray/mesh/a.cpp", '#include "levelray/grid/cell.hpp"\n', 1),
        ("lib/levelray/trace/a.cpp", "#include <levelray/io/mesh_reader.hpp>\n", 1),
        ("lib/levelray/io/a.cpp", '#include "levelray/vdb/vdb_file.hpp"\n', 1),
        ("lib/levelray/grid/a.cpp", '#include "cell.hpp"\n', 1),
        ("lib/levelray/misc/a.cpp", "\n", 1),
    ],
    "doors": [
        ("lib/levelray/convert/a.cpp", "\n#include <tbb/parallel_for.h>\n", 2),
        ("lib/levelray/convert/b.cpp", "#include <oneapi/tbb/parallel_for.h>\n", 1),
        ("lib/levelray/mesh/bvh.cpp", "#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>\n", 1),
        ("lib/levelray/render/a.cpp", "#include <ImfRgbaFile.h>\n", 1),
        ("lib/levelray/render/b.cpp", "#include <png.h>\n", 1),
        ("lib/levelray/core/a.cpp", "#include <nlohmann/json.hpp>\n", 1),
        ("lib/levelray/grid/a.cpp", "#include <openvdb/openvdb.h>\n", 1),
        ("apps/levelray/a.cpp", "#include <openvdb/openvdb.h>\n", 1),
        ("lib/levelray/io/a.cpp", "#include <CLI/CLI.hpp>\n", 1),
        ("lib/levelray/mesh/a.cpp", "#include <embree3/rtcore.h>\n", 1),
        ("tests/unit/a.cpp", "#include <catch2/catch.hpp>\n", 1),
    ],
    "length": [("lib/levelray/core/a.cpp", "\n" * 401, 401)],
    "words": [
        ("lib/levelray/core/a.cpp", "\n// TO" "DO later\n", 2),
        ("lib/levelray/core/b.cpp", "#if " "0\n#endif\n", 1),
        ("scripts/a", "cd /tm" "p/here\n", 1),
        ("README.md", "see `/wor" "k/main`\n", 1),
    ],
    "fast_math": [("CMakeLists.txt", "\nadd_compile_options(-f" "fast-math)\n", 2)],
    "names": [("lib/levelray/core/BlockGrid.cpp", "\n", 1), ("data/my-mesh.obj", "\n", 1)],
    "top_level": [("docs/index.md", "\n", 1)],
    "headers": [("lib/levelray/core/a.hpp", "#pragma once\n", 1), ("lib/levelray/core/b.hpp", "// What.\n", 1)],
    "format": [("lib/levelray/core/a.cpp", "int  main( ){return 0;}\n", 1)],
}


def make(root, files):
    for path, text in files.items():
        full = os.path.join(root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "w", encoding="utf-8") as file:
            file.write(text)


def findings_of(files):
    with tempfile.TemporaryDirectory() as root:
        make(root, files)
        return lint.lint(root)


def main():
    failures = []
    checked = 0
    clean = findings_of(CLEAN)
    if clean:
        failures.append(f"the clean project has findings: {clean}")
    for rule in lint.RULES:
        if rule not in BROKEN:
            failures.append(f"no example breaks the rule '{rule}'")
    for rule, examples in BROKEN.items():
        if rule == "format" and not shutil.which("clang-format-14"):
            print("self_test: rule format not tested, because clang-format-14 is not installed")
            continue
        for path, text, line in examples:
            checked += 1
            found = [(p, l) for p, l, r, _ in findings_of({**CLEAN, path: text}) if r == rule]
            if (path, line) not in found and (path.split("/")[0], line) not in found:
                failures.append(f"rule '{rule}' does not see {path}:{line}; it found {found}")
    for failure in failures:
        print(f"self_test: {failure}")
    print(f"self_test: {checked} broken examples, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
