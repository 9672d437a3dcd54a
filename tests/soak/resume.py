#!/usr/bin/env python3
"""A soak that is broken off goes on where it was, and counts the same on any number of threads.

Usage: resume.py SOAK
"""

import os
import subprocess
import sys
import tempfile


def soak(*options):
    done = subprocess.run([sys.argv[1], *options], capture_output=True, text=True, timeout=300, check=False)
    return done.returncode, [line.split("  seconds")[0] for line in done.stdout.splitlines()], done.stderr


def main():
    with tempfile.TemporaryDirectory() as folder:
        state = os.path.join(folder, "soak.state")
        code, whole, _ = soak("--rays", "1e5", "--seed", "3", "--threads", "1")
        assert code == 0 and whole[-1].startswith("rays 100000  leaks 0  phantoms 0  wrong 0"), whole
        soak("--rays", "4e4", "--seed", "3", "--state", state, "--threads", "2")
        assert os.listdir(folder) == ["soak.state"], os.listdir(folder)
        code, resumed, told = soak("--rays", "1e5", "--seed", "3", "--state", state, "--threads", "2")
        assert "going on after 40000 rays" in told, told
        assert code == 0 and resumed == whole, (resumed, whole)
        # Another soak's state, and a damaged one, are refused and left alone.
        code, _, told = soak("--rays", "1e5", "--seed", "4", "--state", state)
        assert code == 3 and "another soak" in told, told
        with open(state, "r+", encoding="ascii") as file:
            file.truncate(200)
        code, _, told = soak("--rays", "1e5", "--seed", "3", "--state", state)
        assert code == 3 and "damaged" in told, told
        # A method that loses rays says so, and is no failure: it is a row of a table.
        code, lines, _ = soak("--rays", "1e5", "--seed", "3", "--method", "false-position-1")
        assert code == 0 and "leaks 0" not in lines[-1], lines
        for options in (["--rays", "many"], ["--method", "guess"], ["--rays"], ["--colour", "red"]):
            code, _, told = soak(*options)
            assert code == 2 and "usage:" in told, (options, told)


if __name__ == "__main__":
    main()
