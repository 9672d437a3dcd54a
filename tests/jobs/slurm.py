#!/usr/bin/env python3
"""A real Slurm renders a sequence by the script of `levelray farm slurm`, loses a node, and every frame is whole.

Usage: slurm.py PROGRAM     exit code 77: skipped, because Slurm is not installed or does not start here.

Two nodes run an array of tasks. Then the second node is lost: its slurmd is killed, and one of its two renders with it. The other
runs on as an orphan when Slurm has started its task again, as it does behind a broken network, so that frames are rendered
twice, at the same time. In the end the frames must be those of one unbroken run, byte for byte.
"""

import filecmp
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # the sources may be read-only, and are no place for it
from slurm_cluster import Cluster, Unavailable

FRAMES = 24
CHUNK = 3
# Names that a shell would take apart.
INPUT = "it's a \"box\".####.obj"
OUTPUT = "out put/$frame.####.exr"
RENDER = ["render", INPUT, "-o", OUTPUT, "--resolution", "100", "--shadows", "--ground"]


def box(x):
    """A closed box from the origin to (x, 2, 1)."""
    corners = [(x if c & 1 else 0, 2 if c & 2 else 0, 1 if c & 4 else 0) for c in range(8)]
    faces = "1 3 4 2|5 6 8 7|1 2 6 5|3 7 8 4|1 5 7 3|2 4 8 6"
    return "".join(f"v {a} {b} {c}\n" for a, b, c in corners) + "".join(f"f {f}\n" for f in faces.split("|"))


def check(condition, text):
    if not condition:
        raise AssertionError(text)


def levelray(program, *arguments, folder):
    result = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=150)
    check(result.returncode == 0, f"levelray {' '.join(arguments)}: exit {result.returncode}: {result.stderr}")
    return result.stdout


def output_of(frame):
    return OUTPUT.replace("####", f"{frame:04d}")


def size_for(program, folder, seconds):
    """A picture size that takes about so long on this machine, so that a node can be lost in the middle of a task."""
    begin = time.monotonic()
    levelray(program, *RENDER, "--frames=1", "--size", "256x192", folder=folder)
    took = time.monotonic() - begin
    os.remove(os.path.join(folder, output_of(1)))
    scale = min(max((seconds / took) ** 0.5, 1), 12)
    return f"{round(256 * scale)}x{round(192 * scale)}"


def lose_node(cluster, name):
    """Kills the node's daemon, tells the controller, kills all but one of the node's renders and stops that one. Returns
    it, or None when nothing is rendered there now."""
    renders = [p for p in cluster.processes()
               if environment(p).get("SLURMD_NODENAME") == name and program_of(p) == "levelray"]
    if not renders:
        return None
    os.kill(renders[0], signal.SIGSTOP)
    cluster.kill_daemon(name)
    cluster.run("scontrol", "update", f"nodename={name}", "state=down", "reason=lost")
    # Only now: a step that loses its task while the controller still trusts the node reports a failed task.
    for process in renders[1:]:
        os.kill(process, signal.SIGKILL)
    return renders[0]


def frames_written_twice(folder):
    """By what the tasks said; an orphan and its successor share a file."""
    written = []
    for name in os.listdir(folder):
        if name.startswith("slurm-"):
            with open(os.path.join(folder, name), errors="replace") as file:
                written += re.findall(r"^frame (\d+): wrote", file.read(), re.M)
    return sorted({int(frame) for frame in written if written.count(frame) > 1})


def environment(process):
    try:
        with open(f"/proc/{process}/environ", "rb") as file:
            return dict(v.split("=", 1) for v in file.read().decode(errors="replace").split("\0") if "=" in v)
    except OSError:
        return {}


def program_of(process):
    try:
        return os.path.basename(os.readlink(f"/proc/{process}/exe"))
    except OSError:
        return ""


def start_requeued_now(cluster, job):
    """Slurm lets requeued tasks wait for two minutes; the test does not."""
    for task in cluster.jobs(job):
        if task["JobState"] == "PENDING" and task.get("Reason") == "BeginTime":
            cluster.run("scontrol", "update", f"jobid={task['JobId']}", "starttime=now", check=False)


def test(program, cluster, folder):
    for frame in range(1, FRAMES + 1):
        with open(os.path.join(folder, INPUT.replace("####", f"{frame:04d}")), "w") as file:
            file.write(box(1 + frame / 8))
    os.mkdir(os.path.join(folder, os.path.dirname(OUTPUT)))
    size = size_for(program, folder, 1.0)
    command = [*RENDER, "--size", size]

    levelray(program, *command, f"--frames=1-{FRAMES}", "-q", folder=folder)
    expected = os.path.join(folder, "expected")
    os.rename(os.path.join(folder, os.path.dirname(OUTPUT)), expected)
    os.mkdir(os.path.join(folder, os.path.dirname(OUTPUT)))

    levelray(program, "farm", "slurm", f"--frames=1-{FRAMES}", "--chunk", str(CHUNK), "-o", "job.sh", "--", *command, "-j", "1",
             folder=folder)
    job = cluster.run("sbatch", "--parsable", f"--chdir={folder}", os.path.join(folder, "job.sh")).strip()

    lost, orphan = [], None
    begin = time.monotonic()
    while True:
        tasks = cluster.jobs(job)
        if not lost:
            here = [t["ArrayTaskId"] for t in tasks if t["JobState"] == "RUNNING" and t.get("NodeList") == "n2"]
            if here and os.listdir(os.path.join(folder, os.path.dirname(OUTPUT))):
                orphan = lose_node(cluster, "n2")
                lost = here if orphan else []
        start_requeued_now(cluster, job)
        if orphan and all(any(t["ArrayTaskId"] == task and t["JobState"] in ("RUNNING", "COMPLETED") and int(t["Restarts"]) > 0
                              for t in tasks) for task in lost):
            os.kill(orphan, signal.SIGCONT)
            orphan = None
        states = [task["JobState"] for task in tasks]
        check(all(state in ("PENDING", "CONFIGURING", "RUNNING", "COMPLETING", "COMPLETED") for state in states),
              f"a task failed: {states}")
        if states and all(state == "COMPLETED" for state in states):
            break
        check(time.monotonic() - begin < 120, f"not done within 120 s: {states}")
        time.sleep(0.2)
    cluster.wait(lambda: not any(program_of(p) == "levelray" for p in cluster.processes()), 60, "orphans to end")

    tasks = cluster.jobs(job)
    check(len(tasks) == (FRAMES + CHUNK - 1) // CHUNK, f"{len(tasks)} tasks")
    restarted = sorted(t["ArrayTaskId"] for t in tasks if int(t["Restarts"]) > 0)
    check(lost, "the node was not lost in the middle of the job")
    check(restarted, f"tasks {lost} ran on the lost node, none was started again")
    twice = frames_written_twice(folder)
    check(twice, "no frame was rendered twice")
    outputs = sorted(os.listdir(os.path.join(folder, os.path.dirname(OUTPUT))))
    names = [os.path.basename(output_of(frame)) for frame in range(1, FRAMES + 1)]
    others = [name for name in outputs if name not in names]
    # A render that was killed by force leaves its temporary file.
    check(len(others) <= 1 and all(name.startswith(".") for name in others), f"unexpected files: {others}")
    for name in names:
        rendered = os.path.join(folder, os.path.dirname(OUTPUT), name)
        check(os.path.exists(rendered), f"{name} is missing")
        check(filecmp.cmp(rendered, os.path.join(expected, name), shallow=False), f"{name} differs from an unbroken run's")
    levelray(program, "compare", output_of(FRAMES), os.path.join("expected", names[-1]), folder=folder)
    print(f"{FRAMES} frames of {size} pixels, {len(tasks)} tasks; lost with the node: {', '.join(lost)}; started again: "
          f"{', '.join(restarted)}; frames written twice: {', '.join(map(str, twice))}; all identical to an unbroken run, {time.monotonic() - begin:.0f} s")


def main(arguments):
    if len(arguments) != 2:
        print("usage: slurm.py PROGRAM", file=sys.stderr)
        return 2
    # Ends through `finally` and `with` when ctest gives up.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    folder = tempfile.mkdtemp(prefix="levelray farm ")
    try:
        with Cluster({"n1": FRAMES // CHUNK, "n2": 2}) as cluster:
            try:
                test(os.path.abspath(arguments[1]), cluster, folder)
            except Exception:
                print(cluster.logs())
                for name in sorted(os.listdir(folder)):
                    if name.startswith("slurm-"):
                        with open(os.path.join(folder, name), errors="replace") as file:
                            print(f"--- {name}\n{file.read()[-1000:]}")
                raise
    except Unavailable as reason:
        print(f"skipped: {reason}")
        return 77
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
