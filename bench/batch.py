#!/usr/bin/env python3
"""Measure what validating many small scenes costs beside POV-Ray itself on the same scenes.

  bench/batch.py PENUMBRA [--size WxH] [--jobs N]

100 cases: ten of scenes/*.toml, each with ten sidecars that move a light. CPU is user and system time
of all processes. The second run finds nothing changed.
"""
import argparse
import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def cpu(command, folder):
    """Runs a command; its seconds of CPU, with children, and of wall time."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run([str(word) for word in command], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
            time.perf_counter() - start)


def write_cases(folder, size):
    scenes = sorted((ROOT / "scenes").glob("*.toml"))[:10]
    for i in range(10):
        (folder / f"light{i}.toml").write_text(
            f"[[light]]\ntype = 'point'\nposition = [{i - 4}, 6, 5]\nintensity = 0.3\n")
    lights = ", ".join(f"'light{i}.toml'" for i in range(10))
    cases = "".join(f"[[case]]\nmodels = ['{scene}']\nsidecars = [{lights}]\n" for scene in scenes)
    (folder / "cases.toml").write_text(
        f"settings = ['render.size=[{size.replace('x', ',')}]']\n" + cases)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("penumbra", type=Path)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_cases(folder, options.size)
        command = [options.penumbra.resolve(), "validate", "--manifest", "cases.toml", "--jobs",
                   options.jobs, "--report", "all"]
        first, first_wall = cpu(command, folder)
        second, second_wall = cpu(command, folder)
        povray = sum(cpu(["povray", "scene.ini", "-V"], ini.parent)[0]
                     for ini in sorted(folder.glob("all/*/scene.ini")))
    print(f"100 scenes, {options.size}: validate {first:.1f} s of CPU ({first_wall:.1f} s), POV-Ray "
          f"alone {povray:.1f} s: {first / povray:.2f} times; again {second:.2f} s of CPU "
          f"({second_wall:.1f} s)")


main()
