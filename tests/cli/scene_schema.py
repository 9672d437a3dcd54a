#!/usr/bin/env python3
"""The shipped JSON Schema of scenes, judged by an independent validator, says of scenes what the program says.

Usage: scene_schema.py PROGRAM DATA_FOLDER

Takes the example scenes and one with every kind of thing in it, damages each in one place (a key misspelled or
left out, a value of another type, too large or too small), and compares the verdicts.
"""

import copy
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("SKIPPED: python3-jsonschema is not installed (scripts/setup test)")
    sys.exit(77)

EVERYTHING = {
    "levelray": 1, "frames": "1-4", "fps": 25.5,
    "camera": {"eye": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 30, "interpolation": "smooth",
               "keys": [{"frame": 1, "eye": [0, 0, 4], "target": [0, 1, 0], "up": [0, 2, 0], "fov": 20}]},
    "film": {"size": [64, 48], "samples": 4, "aov": ["Z", "id"]},
    "objects": [
        {"name": "a", "id": 3, "level_set": "a.####.vdb", "grid": "surface", "redistance": "never", "shadows": False,
         "transform": {"translate": [1, 0, 0], "rotate": {"axis": [0, 0, 1], "degrees": 3}, "scale": 2,
                       "interpolation": "linear",
                       "keys": [{"frame": 1, "translate": [0, 0, 0], "rotate": {"degrees": 1}, "scale": 1}]},
         "material": {"kind": "phong", "albedo": [0.5, 0.5, 0.5], "specular": 0.1, "exponent": 9}},
        {"mesh": "b.obj", "convert": {"voxel": "2mm", "band": "3vx", "sign": "auto", "units": "m", "thicken": "1mm"},
         "material": {"kind": "glass", "ior": 1.4, "tint": [1, 1, 1], "specular": 0, "exponent": 2}},
        {"mesh": "b.obj", "convert": {"resolution": 99}, "material": {"kind": "mirror", "tint": [1, 1, 1]}},
        {"mesh": "b.obj", "material": {"kind": "diffuse", "albedo": [0, 0, 1]}}],
    "lights": [{"kind": "point", "position": [0, 1, 2], "intensity": 3, "color": [1, 1, 1], "shadows": True},
               {"kind": "directional", "direction": [0, 1, 0], "intensity": 3}],
    "ambient": 0.1, "sky": {"radiance": [1, 1, 2], "visible": True},
    "ground": {"height": -1, "centre": [0, 0, 0], "radius": 2, "material": {"kind": "mirror", "tint": [1, 1, 0]}},
    "ambient_occlusion": {"samples": 3, "radius": 2},
    "render": {"intersector": "exact", "normals": "analytic", "max_depth": 3},
    "outputs": ["a.####.exr"], "limits": {"memory": "1.5GiB", "frame_seconds": 9}}

# Of another type, empty, or beyond every range.
VALUES = [None, True, "text", "", 7, 0.5, -1e11, 1e11, [], [1], [1, 2, 3], ["Z", "Z"], {}, {"kind": "glass"}]

# What JSON Schema does not say: between values, and inside texts. The program alone refuses these.
ONLY_PROGRAM = r"square number|has no direction|looks nowhere|frames must rise"


def places(value, path=()):
    """Paths of all values below this one."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for step, item in items:
        yield path + (step,)
        yield from places(item, path + (step,))


def damaged(scene):
    """(description, scene) pairs, each damaged in one place."""
    for path in places(scene):
        def changed(change):
            twin = copy.deepcopy(scene)
            at = twin
            for step in path[:-1]:
                at = at[step]
            change(at, path[-1])
            return twin
        yield f"{path} left out", changed(lambda at, step: at.pop(step))
        for value in VALUES:
            yield f"{path} = {value!r}", changed(lambda at, step: at.__setitem__(step, value))
        if isinstance(path[-1], str):
            yield f"{path} misspelled", changed(lambda at, step: at.__setitem__(step + "x", at.pop(step)))


def main(program, data):
    with open(os.path.join(data, "scene.schema.json"), encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)

    examples = sorted(glob.glob(os.path.join(data, "scenes", "*.json")))
    assert examples, "no example scenes"
    scenes = [EVERYTHING]
    for path in examples:
        with open(path, encoding="utf-8") as file:
            scenes.append(json.load(file))

    cases = [("whole", scene) for scene in scenes] + list(damaged(EVERYTHING))
    with tempfile.TemporaryDirectory() as folder:
        for number, (_, scene) in enumerate(cases):
            with open(os.path.join(folder, f"{number}.json"), "w", encoding="utf-8") as file:
                json.dump(scene, file)
        names = [f"{number}.json" for number in range(len(cases))]
        run = subprocess.run([program, "scene", "check", "-q"] + names, cwd=folder, capture_output=True, text=True)
    assert run.returncode == 2, f"exit {run.returncode}"
    said = dict(re.findall(r"^levelray: (\d+)\.json:(.*)$", run.stderr, re.M))
    assert run.stderr.count("\n") == len(said) + 1, "one line per refused scene, and one for all"

    wrong = refused = 0
    for number, (what, scene) in enumerate(cases):
        valid, message = validator.is_valid(scene), said.get(str(number), "")
        refused += not valid
        if valid == (message == "") or (valid and re.search(ONLY_PROGRAM, message)):
            continue
        wrong += 1
        print(f"{what}: the schema {'takes' if valid else 'refuses'} it; the program: {message or 'takes it'}")
    checked = len(cases)
    print(f"{checked} damaged scenes, {refused} refused by the schema, {wrong} disagreements")
    assert refused > checked / 2
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
